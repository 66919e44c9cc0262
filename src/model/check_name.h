/* check_name.h: what may be the name of a material. */
#ifndef HNBRDF_MODEL_CHECK_NAME_H
#define HNBRDF_MODEL_CHECK_NAME_H

#include "hnbrdf/hnbrdf.h"

/* HNBRDF_OK for 1 to HNBRDF_MAX_NAME bytes of UTF-8 without control characters; otherwise a
 * message that goes on after "the name of material 3 ". */
hnbrdf_result hnbrdf_check_name(const char *name, hnbrdf_error *error);

#endif
