/* brdf_heading.h: what a .brdf file that hnbrdf wrote says of its model beyond the published form:
 * comment lines "# hnbrdf/1 KEY VALUES" before the first section. */
#ifndef HNBRDF_IMPORT_BRDF_HEADING_H
#define HNBRDF_IMPORT_BRDF_HEADING_H

#include "hnbrdf/hnbrdf.h"

/* As without a heading: what the published files are. */
typedef struct hnbrdf_brdf_heading {
    int present;
    hnbrdf_kind kind;
    hnbrdf_encoding encoding;
    float scale, shift, floor;
    int has_fitted, has_lobes;
    hnbrdf_fitted fitted;
    hnbrdf_lobes lobes;
    hnbrdf_energy energy;
} hnbrdf_brdf_heading;

#define HNBRDF_BRDF_HEADING "# hnbrdf/1 "

/* A key that is not known, or a value that is none, is HNBRDF_ERROR_FORMAT. */
hnbrdf_result hnbrdf_brdf_read_heading(const char *file, const char *text, size_t size,
                                       hnbrdf_brdf_heading *heading, hnbrdf_error *error);

#endif
