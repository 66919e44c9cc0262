/* foreign.h: recognise files that people take for others: what a failed download, a version control
 * system or another program left under the name that was asked for. */
#ifndef HNBRDF_BASE_FOREIGN_H
#define HNBRDF_BASE_FOREIGN_H

#include <stddef.h>

/* What a message calls such a file, "a PNG picture", or NULL if its bytes
 * are none of those known. Nothing that this project reads is among them. */
const char *hnbrdf_foreign_file(const unsigned char *bytes, size_t size);

#endif
