/* fit.c: fits a built-in material with the installed libraries and asks how far off the result
 * is. */
#include <hnbrdf/fit.h>
#include <hnbrdf/metrics.h>

#include <stdio.h>
#include <string.h>

int main(void)
{
    hnbrdf_measured *data;
    hnbrdf_fit_options options;
    hnbrdf_model *model;
    hnbrdf_comparison comparison;
    hnbrdf_error error;

    memset(&options, 0, sizeof options);
    options.kind = HNBRDF_KIND_GGX;
    options.pool = 4096;
    if (hnbrdf_measured_open_builtin(0, &data, &error) ||
        hnbrdf_fit((const hnbrdf_measured *const *)&data, 1, &options, &model, NULL, &error) ||
        hnbrdf_compare(model, hnbrdf_model_material(model, 0), data, HNBRDF_SAMPLER_UNIFORM, 1000,
                       1, &comparison, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    hnbrdf_model_free(model);
    hnbrdf_measured_close(data);
    return comparison.smape >= 0.0 && comparison.smape < 2.0 ? 0 : 1;
}
