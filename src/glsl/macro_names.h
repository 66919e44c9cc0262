/* macro_names.h: what the materials of a model are called in GLSL. */
#ifndef HNBRDF_GLSL_MACRO_NAMES_H
#define HNBRDF_GLSL_MACRO_NAMES_H

#include "core/model.h"

enum { HNBRDF_MACRO_NAME_SIZE = HNBRDF_MAX_NAME + 32 };
typedef char hnbrdf_macro_name[HNBRDF_MACRO_NAME_SIZE]; /* what follows HNBRDF_MATERIAL_ */

/* names[k] for the material indices[k] of the model (NULL: k itself), all distinct and none of them
 * COUNT: its name in capitals, with one '_' for what is neither a letter nor a digit. Where several
 * materials of the model come to the same, that belongs to the one whose name was already written
 * so but for capitals, or to none; the others end in a hash of their name. So a macro depends on
 * which names the model holds and neither on their order nor on what is exported. Of a material
 * that is listed twice, the second macro ends in its place k.
 *
 * HNBRDF_ERROR_MEMORY if there is no room for the names of the model. */
hnbrdf_result hnbrdf_macro_names(const hnbrdf_model *model, const int *indices, int count,
                                 hnbrdf_macro_name *names, hnbrdf_error *error);

#endif
