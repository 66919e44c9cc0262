/* teacher.c: a material of a model, to be learned from and compared with like a measurement. */
#include "bake/task.h"

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

/* Equal alphas, unless the network sees azimuths. The encoding `directions` sees it too,
 * but only as far as training left a trace of it: such a material counts as isotropic if its GGX
 * part is. */
static int is_isotropic(const teacher *t)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(t->model, &desc);
    return t->material->alpha[0] == t->material->alpha[1] &&
           (desc.kind == HNBRDF_KIND_GGX || desc.encoding == HNBRDF_ENCODING_DIRECTIONS ||
            !hnbrdf_encoding_sees_azimuth(desc.encoding));
}

hnbrdf_result hnbrdf_bake_teacher(const hnbrdf_model *model, int material,
                                  hnbrdf_measured **measured, hnbrdf_error *error)
{
    teacher *t = malloc(sizeof *t);
    if (!t)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    t->model = model;
    t->material = hnbrdf_model_material(model, material);
    hnbrdf_measured_custom custom = {.name = hnbrdf_model_material_name(model, material),
                                     .summary = "a material of a model",
                                     .isotropic = is_isotropic(t),
                                     .eval = eval,
                                     .release = free,
                                     .user = t};
    hnbrdf_result result = hnbrdf_measured_create_custom(&custom, measured, error);
    if (result)
        free(t);
    return result;
}
