/* info_physics.c: what `hnbrdf info` says about energy, reciprocity and black values of a model's
 * materials. */
#include "report/info_physics.h"

#include "base/threads.h"

#include <stdlib.h>

static const double DEGREES = 57.295779513082320877;

/* ---- Measuring ------------------------------------------------------------------------------- */

enum { BATCH = 64 }; /* materials between two looks at the clock */

typedef struct measuring {
    const hnbrdf_model *model;
    hnbrdf_physics *physics;
    int first;
} measuring;

static void measure(void *context, int index, int worker)
{
    const measuring *m = context;
    const int k = m->first + index;
    (void)worker;
    hnbrdf_physics_of(m->model, hnbrdf_model_material(m->model, k), &m->physics[k]);
}

hnbrdf_physics *info_measure_physics(const hnbrdf_model *model, const report_watch *watch)
{
    const int count = hnbrdf_model_material_count(model);
    measuring m = {.model = model, .physics = malloc((size_t)count * sizeof *m.physics)};
    hnbrdf_threads *threads = m.physics ? hnbrdf_threads_start(0) : NULL;
    for (; threads && m.first < count; m.first += BATCH) {
        report_show(watch, (double)m.first / count, "");
        hnbrdf_threads_run(threads, count - m.first < BATCH ? count - m.first : BATCH, measure, &m);
    }
    if (!threads) {
        free(m.physics);
        return NULL;
    }
    hnbrdf_threads_stop(threads);
    return m.physics;
}

/* ---- Writing --------------------------------------------------------------------------------- */

void info_print_physics(const hnbrdf_model *model, const hnbrdf_physics *physics, int width,
                        FILE *file)
{
    int count = hnbrdf_model_material_count(model), above = 0, invalid = 0;
    fprintf(file, "\n%-*s  %-18s  %-9s  %-20s  %6s\n", width, "material", "albedo (at)", "energy",
            "not reciprocal by", "black");
    for (int k = 0; k < count; k++) {
        const hnbrdf_physics p = physics[k];
        fprintf(file, "%-*s  %6.3f %c (%4.3g deg)  %-9s  ", width,
                hnbrdf_model_material_name(model, k), p.albedo, "RGB"[p.albedo_channel],
                p.albedo_theta * DEGREES, p.albedo > 1.0 ? "ABOVE 1" : "kept");
        if (p.reciprocity_worst == 0.0)
            fprintf(file, "%-20s", "0, exactly");
        else
            fprintf(file, "%.3f (worst %.2f) %4s", p.reciprocity, p.reciprocity_worst, "");
        fprintf(file, "  %5.1f%%%s\n", 100.0 * p.black, p.valid ? "" : "  INVALID VALUES");
        above += p.albedo > 1.0;
        invalid += !p.valid;
    }
    fputs(
        "\nalbedo: the largest share of light from everywhere that leaves towards one direction, "
        "that many\n"
        "degrees from n, of those up to 89.9. Not reciprocal by: |f - f swapped| over the mean of "
        "both, averaged. Black: "
        "values of 0.\n",
        file);
    if (above)
        fprintf(
            file,
            "%d of %d materials give off more light than they get: `hnbrdf edit MODEL --conserve` "
            "holds them to it.\n",
            above, count);
    if (invalid)
        fprintf(file, "%d of %d materials have negative or infinite values.\n", invalid, count);
}

void info_json_physics(const hnbrdf_physics *physics, FILE *file)
{
    const hnbrdf_physics p = *physics;
    fprintf(file,
            ", \"albedo\": %.6g, \"albedo_degrees\": %.3g, \"albedo_channel\": %d, "
            "\"conserves_energy\": %s",
            p.albedo, p.albedo_theta * DEGREES, p.albedo_channel,
            p.albedo > 1.0 ? "false" : "true");
    fprintf(file,
            ", \"reciprocity_error\": %.6g, \"reciprocity_worst\": %.6g, \"black\": %.6g, "
            "\"valid\": %s",
            p.reciprocity, p.reciprocity_worst, p.black, p.valid ? "true" : "false");
}
