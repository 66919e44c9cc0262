/* bake_teacher.c: a material of a model, to be learned from and compared with like a measurement.
 * */
#include "cli/bake.h"

#include <stdlib.h>

typedef struct teacher {
    const hnbrdf_model *model;
    const hnbrdf_material *material;
} teacher;

static int eval(const void *user, const float wi[3], const float wo[3], float f[3])
{
    const teacher *t = user;
    hnbrdf_eval(t->model, t->material, wi, wo, f);
    return 1;
}

/* Equal alphas, unless the network sees the azimuth of h. The encoding `directions` sees it too,
 * but only as far as training left a trace of it: such a material counts as isotropic if its GGX
 * part is. */
static int is_isotropic(const teacher *t)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(t->model, &desc);
    return t->material->alpha[0] == t->material->alpha[1] &&
           (desc.kind == HNBRDF_KIND_GGX || desc.encoding != HNBRDF_ENCODING_ANGLES_ANISOTROPIC);
}

int bake_teacher(const hnbrdf_model *model, int material, hnbrdf_measured **measured)
{
    hnbrdf_error error;
    teacher *t = malloc(sizeof *t);
    if (!t)
        return cli_fail("out of memory");
    t->model = model;
    t->material = hnbrdf_model_material(model, material);
    hnbrdf_measured_custom custom = {.name = hnbrdf_model_material_name(model, material),
                                     .summary = "a material of a model",
                                     .isotropic = is_isotropic(t),
                                     .eval = eval,
                                     .release = free,
                                     .user = t};
    if (hnbrdf_measured_create_custom(&custom, measured, &error) == HNBRDF_OK)
        return CLI_OK;
    free(t);
    return cli_fail("%s", error.text);
}
