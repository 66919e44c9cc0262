/* conserve.c: the factors on energy of a model's materials. */
#include "report/conserve.h"

#include "base/error.h"
#include "core/compose.h"
#include "hnbrdf/edit.h"
#include "hnbrdf/metrics.h"

#include <math.h>
#include <stdlib.h>

/* The largest channel of the albedo at normal incidence. */
static double normal_albedo(const hnbrdf_model *model, const hnbrdf_material *material)
{
    const float n[3] = {0.0f, 0.0f, 1.0f};
    double albedo[3];
    hnbrdf_albedo(model, material, n, albedo);
    return fmax(albedo[0], fmax(albedo[1], albedo[2]));
}

static void tell(const hnbrdf_model *model, const char *name, const hnbrdf_material *before,
                 const hnbrdf_material *after, FILE *file)
{
    hnbrdf_physics was, is;
    hnbrdf_physics_of(model, before, &was);
    hnbrdf_physics_of(model, after, &is);
    fprintf(file,
            "%s: albedo %.3f becomes %.3f, %.4f of it at normal incidence is kept; "
            "k = min(1, %.4f + %.4f cos)\n",
            name, was.albedo, is.albedo,
            normal_albedo(model, after) / fmax(normal_albedo(model, before), 1e-30),
            (double)after->energy.horizon, (double)after->energy.slope);
}

static hnbrdf_result find_all(const hnbrdf_model *model, const int *indices, int count,
                              const report_watch *watch, FILE *file, hnbrdf_material *made,
                              hnbrdf_material_change *changes, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; k < count && !result; k++) {
        const char *name = hnbrdf_model_material_name(model, indices[k]);
        const hnbrdf_energy none = {0.0f, 0.0f};
        made[k] = *hnbrdf_model_material(model, indices[k]);
        made[k].energy = none;
        hnbrdf_material plain = made[k];
        changes[k] = (hnbrdf_material_change){
            .kind = HNBRDF_CHANGE_REPLACE, .name = name, .material = &made[k]};
        result = hnbrdf_energy_fit(model, &plain, &made[k].energy, error);
        if (hnbrdf_has_energy(&made[k].energy))
            tell(model, name, &plain, &made[k], file);
        report_show(watch, (k + 1.0) / count, "");
    }
    return result;
}

hnbrdf_result report_conserve(const hnbrdf_model *model, const int *materials, int count,
                              const report_watch *watch, FILE *file, hnbrdf_model **conserving,
                              hnbrdf_error *error)
{
    hnbrdf_material *made = calloc((size_t)count, sizeof *made);
    hnbrdf_material_change *changes = calloc((size_t)count, sizeof *changes);
    hnbrdf_result result =
        made && changes
            ? find_all(model, materials, count, watch, file, made, changes, error)
            : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for %d materials", count);
    if (!result)
        result = hnbrdf_model_with_materials(model, changes, count, NULL, conserving, error);
    free(made);
    free(changes);
    return result;
}
