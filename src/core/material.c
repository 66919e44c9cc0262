/* material.c: make and check a material. */
#include "core/error.h"

#include <math.h>
#include <string.h>

void hnbrdf_material_init(hnbrdf_material *material)
{
    memset(material, 0, sizeof *material);
    for (int c = 0; c < 3; c++) {
        material->kd[c] = 0.5f;
        material->eta[c] = 1.5f;
    }
    material->alpha[0] = material->alpha[1] = 0.5f;
}

static hnbrdf_result range(const char *field, int index, float value, float low, float high,
                           hnbrdf_error *error)
{
    if (value >= low && value <= high)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s[%d] is %g, expected %g to %g", field, index,
                       (double)value, (double)low, (double)high);
}

hnbrdf_result hnbrdf_material_check(const hnbrdf_material *material, hnbrdf_error *error)
{
    hnbrdf_result result;
    for (int c = 0; c < 3; c++)
        if ((result = range("kd", c, material->kd[c], 0.0f, 1.0f, error)))
            return result;
    for (int c = 0; c < 3; c++)
        if (!(material->eta[c] > 1.0f && material->eta[c] <= HNBRDF_MAX_ETA))
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "eta[%d] is %g, expected above 1, at most %g",
                               c, (double)material->eta[c], (double)HNBRDF_MAX_ETA);
    for (int c = 0; c < 2; c++)
        if ((result = range("alpha", c, material->alpha[c], HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA, error)))
            return result;
    if (!isfinite(material->rotation))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "rotation is %g, expected a finite angle",
                           (double)material->rotation);
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        if (!isfinite(material->latent[i]))
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "latent[%d] is %g, expected a finite number",
                               i, (double)material->latent[i]);
    return HNBRDF_OK;
}
