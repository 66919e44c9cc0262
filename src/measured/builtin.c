/* builtin.c: open a built-in procedural material. The materials themselves are in
 * builtin_materials.c and builtin_anisotropic.c. */
#include "measured/builtin_terms.h"
#include "measured/format.h"
#include "base/error.h"

#include <stdlib.h>

typedef struct builtin {
    const builtin_material *material;
    film_table film; /* all 0 where the material has none */
} builtin;

int hnbrdf_measured_builtin_count(void)
{
    return hnbrdf_builtin_material_count;
}

int hnbrdf_measured_builtin_anisotropic_count(void)
{
    return hnbrdf_builtin_anisotropic_count;
}

const builtin_material *hnbrdf_builtin_at(int index)
{
    int second = index - hnbrdf_builtin_material_count;
    if (index >= 0 && second < 0)
        return &hnbrdf_builtin_materials[index];
    return second >= 0 && second < hnbrdf_builtin_anisotropic_count
               ? &hnbrdf_builtin_anisotropic[second]
               : NULL;
}

const char *hnbrdf_measured_builtin_name(int index)
{
    const builtin_material *material = hnbrdf_builtin_at(index);
    return material ? material->name : NULL;
}

static int builtin_eval(const void *data, const double wi[3], const double wo[3], double f[3])
{
    const builtin *opened = data;
    pair p = make_pair(wi, wo);
    p.film = &opened->film;
    f[0] = f[1] = f[2] = 0.0;
    opened->material->eval(&p, f);
    return 1;
}

hnbrdf_result hnbrdf_builtin_open(int index, measured_body *body, hnbrdf_error *error)
{
    const builtin_material *material = hnbrdf_builtin_at(index);
    builtin *opened = calloc(1, sizeof *opened);
    if (!opened)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", material->name);
    opened->material = material;
    if (material->film)
        hnbrdf_film_fill(&opened->film, material->film);
    body->data = opened;
    body->eval = builtin_eval;
    body->release = free;
    body->isotropic = material->isotropic;
    snprintf(body->summary, sizeof body->summary, "built-in: %s", material->about);
    return HNBRDF_OK;
}

const measured_reader hnbrdf_builtin_reader = {
    .info = {.format = HNBRDF_MEASURED_BUILTIN, .name = "builtin"},
};
