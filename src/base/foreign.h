/* foreign.h: recognise files that people take for others: what a failed download, a version control
 * system or another program left under the name that was asked for. */
#ifndef HNBRDF_BASE_FOREIGN_H
#define HNBRDF_BASE_FOREIGN_H

#include <stddef.h>

/* What a message calls such a file, "a PNG picture", or NULL if its bytes
 * are none of those known. Nothing that this project reads is among them. */
const char *hnbrdf_foreign_file(const unsigned char *bytes, size_t size);

/* The same for what this project reads, "a published .brdf shader": for the reader of something
 * else. */
const char *hnbrdf_own_file(const unsigned char *bytes, size_t size);
/* 1 for a text of BRDF Explorer. */
int hnbrdf_is_brdf_text(const unsigned char *bytes, size_t size);

/* What the ending of a name says of reflectance data in formats that are not read, or NULL. */
const char *hnbrdf_foreign_name(const char *path, const unsigned char *bytes, size_t size);
/* 1 for those whose bytes may look like a format that is read. */
int hnbrdf_foreign_lookalike(const char *path);

#endif
