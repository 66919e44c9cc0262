/* merl_known.h: the published files of the MERL BRDF database, by their checksums. */
#ifndef HNBRDF_MEASURED_MERL_KNOWN_H
#define HNBRDF_MEASURED_MERL_KNOWN_H

#include <stddef.h>

/* The material whose published file has this SHA-256 (64 lower-case digits), NULL if none of the
 * 100 has. */
const char *hnbrdf_merl_known_digest(const char *sha256);
/* The material whose published file has these bytes, NULL if none of the 100 has. */
const char *hnbrdf_merl_known(const unsigned char *bytes, size_t size);

#endif
