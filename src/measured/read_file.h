/* read_file.h: a whole file into memory, up to a limit. */
#ifndef HNBRDF_MEASURED_READ_FILE_H
#define HNBRDF_MEASURED_READ_FILE_H

#include "hnbrdf/hnbrdf.h"

#include <stddef.h>

/* Everything in the file at `path`, at most `limit` bytes, into *bytes (malloc'ed, also when
 * empty). `label` names the file in messages. */
hnbrdf_result hnbrdf_read_file(const char *path, size_t limit, const char *label,
                               unsigned char **bytes, size_t *size, hnbrdf_error *error);

#endif
