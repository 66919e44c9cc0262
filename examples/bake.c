/* bake.c: fit a model to some built-in materials, bake a smaller network for two of them, and print
 * what was tried.
 *
 *   build/examples/bake MODEL.safetensors [STEPS] */
#include <hnbrdf/bake.h>
#include <hnbrdf/fit.h>

#include <stdio.h>
#include <stdlib.h>

/* Print every row as soon as it is there; returning 1 would stop the search. */
static int progress(void *user, const hnbrdf_bake_progress *p)
{
    char name[16];
    (void)user;
    if (p->new_row) {
        const hnbrdf_bake_row *row = &p->report->rows[p->report->row_count - 1];
        printf("%-5s %-5s  %5zu multiplications  SMAPE %.4f  %6.1f ns\n",
               hnbrdf_bake_size_name(&row->size, name), row->full ? "full" : "short",
               row->size.multiplications, row->smape, row->size.ns);
    }
    return 0;
}

static int fail(const hnbrdf_error *error)
{
    fprintf(stderr, "%s\n", error->text);
    return 1;
}

int main(int argc, char **argv)
{
    enum { COUNT = 4 };
    hnbrdf_measured *data[COUNT];
    hnbrdf_model *model, *baked;
    hnbrdf_bake_report report;
    hnbrdf_error error;
    if (argc < 2) {
        fprintf(stderr, "usage: %s MODEL.safetensors [STEPS]\n", argv[0]);
        return 2;
    }
    const long steps = argc > 2 ? strtol(argv[2], NULL, 10) : 8000;

    /* A model that four materials share. */
    for (int i = 0; i < COUNT; i++)
        if (hnbrdf_measured_open_builtin(i, &data[i], &error))
            return fail(&error);
    const hnbrdf_fit_options fit = {.hidden = 16, .layers = 2, .steps = steps, .pool = 8192};
    if (hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, &fit, &model, NULL, &error))
        return fail(&error);

    /* The scene uses the first two. What is not set has its default. */
    static const int scene[] = {0, 1};
    const hnbrdf_bake_options options = {.wish = HNBRDF_BAKE_SIZE,
                                         .max_multiplications = 120,
                                         .materials = scene,
                                         .material_count = 2,
                                         .data = (const hnbrdf_measured *const *)data,
                                         .data_count = COUNT,
                                         .sampler = HNBRDF_SAMPLER_GRID,
                                         .steps = steps,
                                         .pool = 8192,
                                         .pairs = 20000,
                                         .restarts = 2,
                                         .seed = 1,
                                         .progress = progress};
    if (hnbrdf_bake(model, &options, &baked, &report, &error))
        return fail(&error);
    const hnbrdf_bake_row *row = &report.rows[report.picked];
    printf("picked %dx%d: SMAPE %.4f, that of the larger model %.4f\n", row->size.hidden,
           row->size.layers, row->smape, report.model_smape);
    int code = hnbrdf_model_save(baked, argv[1], &error) ? fail(&error) : 0;

    hnbrdf_bake_report_free(&report);
    hnbrdf_model_free(baked);
    hnbrdf_model_free(model);
    for (int i = 0; i < COUNT; i++)
        hnbrdf_measured_close(data[i]);
    return code;
}
