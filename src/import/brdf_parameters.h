/* brdf_parameters.h: the parameter lines of a published shader. */
#ifndef HNBRDF_IMPORT_BRDF_PARAMETERS_H
#define HNBRDF_IMPORT_BRDF_PARAMETERS_H

#include "import/brdf_text.h"

typedef struct hnbrdf_brdf_parameters {
    hnbrdf_material *material; /* to fill */
    const char *name;          /* of the material, for notes */
    const hnbrdf_notes *notes; /* told of values that were moved into their range */
    hnbrdf_kind kind;          /* as the heading says */
    int has_rotation;          /* a parameter called rotation is that of the tangent frame */
    unsigned long seen;        /* which there were, a bit each; 0 to begin with */
} hnbrdf_brdf_parameters;

/* NAME MIN MAX DEFAULT, from behind float; anything else is left where it is. A diffuse colour or
 * an alpha above 1 by at most 0.01 becomes 1, an alpha below HNBRDF_MIN_ALPHA becomes that, an eta
 * of 1 the next float, and the notes are told. */
hnbrdf_result hnbrdf_brdf_read_parameter(hnbrdf_words *words, hnbrdf_brdf_parameters *p,
                                         hnbrdf_error *error);

/* Is everything there? alpha, or alpha_x and alpha_y; *latent numbers latent_0 ... without a gap;
 * all others but the rotation. A neural material needs latent numbers alone. */
hnbrdf_result hnbrdf_brdf_check_parameters(const char *file, const hnbrdf_brdf_parameters *p,
                                           int *latent, hnbrdf_error *error);

#endif
