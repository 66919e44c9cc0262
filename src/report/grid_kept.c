/* grid_kept.c: the figures of a finished model beside it, in models/NAME.figures, so that --resume
 * need not measure it again: what they were measured of, then a line of numbers each. */
#include "report/grid.h"

#include "base/hash.h"
#include "report/output.h"

#include <stdlib.h>
#include <string.h>

enum { SETTINGS = 1024, ERRORS = 5, PICTURE = 8 };

static int hash_bytes(void *user, const void *data, size_t size)
{
    uint64_t *hash = user;
    *hash = hnbrdf_hash(*hash, data, size);
    return 0;
}

/* What has to be the same for the figures to be taken. Of the data the record of the model
 * tells. */
static void describe(const report *r, const hnbrdf_model *model, char text[SETTINGS])
{
    uint64_t hash = HNBRDF_HASH_START;
    hnbrdf_model_write(model, hash_bytes, &hash, NULL);
    snprintf(
        text, SETTINGS,
        "hnbrdf %s, model %016llx, %d materials, %ld pairs, seed %ld, images %ld, %ld samples, "
        "seed %ld, ppd %.9g\n",
        hnbrdf_version(), (unsigned long long)hash, r->data.count, r->pairs, r->seed, r->image_size,
        r->light.spp, r->light.seed, r->flip.pixels_per_degree);
}

static void write_numbers(FILE *file, const double *numbers, int count)
{
    for (int k = 0; k < count; k++)
        fprintf(file, "%s%.17g", k ? " " : "", numbers[k]);
    putc('\n', file);
}

static int read_numbers(FILE *file, double *numbers, int count)
{
    int found = 0;
    while (found < count && fscanf(file, "%lf", &numbers[found]) == 1)
        found++;
    return found == count;
}

hnbrdf_result report_keep_figures(const report *r, const report_entry *e, const hnbrdf_model *model)
{
    char settings[SETTINGS];
    report_output output;
    char *path = report_path(r, e->name, "figures");
    hnbrdf_result result = path ? report_output_open(path, &output, r->error) : HNBRDF_ERROR_MEMORY;
    free(path);
    if (result != HNBRDF_OK)
        return result;
    describe(r, model, settings);
    fputs(settings, output.file);
    for (int k = 0; k < REPORT_SAMPLERS * r->data.count; k++) {
        const hnbrdf_comparison *c = &e->errors[k];
        const double numbers[ERRORS] = {c->smape, c->smape_analytic, c->mae, c->mse,
                                        (double)c->pairs};
        write_numbers(output.file, numbers, ERRORS);
    }
    for (int m = 0; r->image_size && m < r->data.count; m++) {
        const report_picture *p = &e->pictures[m];
        const double numbers[PICTURE] = {(double)p->done, p->mae,       p->mse,        p->psnr,
                                         p->psnr_error,   p->psnr_bias, p->peak_error, p->flip};
        write_numbers(output.file, numbers, PICTURE);
    }
    return report_output_close(&output, r->error);
}

/* Half a file changes nothing. */
static int read_figures(const report *r, FILE *file, hnbrdf_comparison *errors,
                        report_picture *pictures)
{
    double n[PICTURE];
    for (int k = 0; k < REPORT_SAMPLERS * r->data.count; k++) {
        if (!read_numbers(file, n, ERRORS))
            return 0;
        errors[k] = (hnbrdf_comparison){n[0], n[1], n[2], n[3], (size_t)n[4]};
    }
    for (int m = 0; r->image_size && m < r->data.count; m++) {
        if (!read_numbers(file, n, PICTURE) || n[0] != 1.0)
            return 0;
        pictures[m] = (report_picture){1, n[1], n[2], n[3], n[4], n[5], n[6], n[7]};
    }
    return 1;
}

int report_take_figures(const report *r, report_entry *e, const hnbrdf_model *model)
{
    char settings[SETTINGS], found[SETTINGS] = "";
    const size_t errors_size = REPORT_SAMPLERS * (size_t)r->data.count * sizeof *e->errors,
                 pictures_size = (size_t)r->data.count * sizeof *e->pictures;
    char *path = report_path(r, e->name, "figures");
    FILE *file = path ? fopen(path, "r") : NULL;
    hnbrdf_comparison *errors = malloc(errors_size);
    report_picture *pictures = calloc(1, pictures_size);
    free(path);
    describe(r, model, settings);
    const int taken = file && errors && pictures && fgets(found, sizeof found, file) &&
                      strcmp(found, settings) == 0 && read_figures(r, file, errors, pictures);
    if (taken) {
        memcpy(e->errors, errors, errors_size);
        memcpy(e->pictures, pictures, pictures_size);
    }
    if (file)
        fclose(file);
    free(errors);
    free(pictures);
    return taken;
}
