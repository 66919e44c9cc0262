/* grid_figures.c: the figures of spheres that an earlier run left in the folder, and whether they
 * were made with the same settings. */
#include "report/grid.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/text.h"
#include "base/write.h"
#include "report/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- What figures were made with ------------------------------------------------------------- */

static int hash_bytes(void *user, const void *data, size_t size)
{
    uint64_t *hash = user;
    *hash = hnbrdf_hash(*hash, data, size);
    return 0;
}

/* images.txt: what has to be the same for figures to be reused. */
static void write_settings(const report *r, hnbrdf_model *const *models, FILE *file)
{
    fprintf(file, "hnbrdf %s\nenv %s\nrotate %.9g\nsize %ld\nspp %ld\nseed %ld\nppd %.9g\n",
            hnbrdf_version(), r->light.env, r->light.rotate, r->image_size, r->light.spp,
            r->light.seed, r->flip.pixels_per_degree);
    for (int m = 0; m < r->data.count; m++)
        fprintf(file, "material %s: %s\n", hnbrdf_measured_name(r->data.items[m]),
                hnbrdf_measured_summary(r->data.items[m]));
    for (int k = 0; k < r->count; k++) {
        uint64_t hash = HNBRDF_HASH_START;
        hnbrdf_model_write(models[k], hash_bytes, &hash, NULL);
        fprintf(file, "model %s %016llx\n", r->entries[k].name, (unsigned long long)hash);
    }
}

hnbrdf_result report_images_same_settings(const report *r, hnbrdf_model *const *models, int *same)
{
    char *wanted = NULL, *path = report_path_in(r, "images.txt");
    size_t size = 0, count = 0;
    FILE *file = path ? fopen(path, "rb") : NULL, *memory = open_memstream(&wanted, &size);
    free(path);
    if (memory) {
        write_settings(r, models, memory);
        fclose(memory);
    }
    int equal = file && wanted;
    for (int c; equal && (c = getc(file)) != EOF; count++)
        equal = count < size && (unsigned char)wanted[count] == c;
    if (file)
        fclose(file);
    free(wanted);
    if (!memory || !path)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    *same = equal && count == size;
    return HNBRDF_OK;
}

hnbrdf_result report_images_keep_settings(const report *r, hnbrdf_model *const *models)
{
    report_output output;
    char *path = report_path_in(r, "images.txt");
    hnbrdf_result result = path ? report_output_open(path, &output, r->error) : HNBRDF_ERROR_MEMORY;
    free(path);
    if (result != HNBRDF_OK)
        return result;
    write_settings(r, models, output.file);
    return report_output_close(&output, r->error);
}

/* ---- Figures of an earlier run --------------------------------------------------------------- */

static report_picture *find_picture(report *r, const char *material, const char *name)
{
    for (int m = 0; m < r->data.count; m++)
        for (int k = 0; k < r->count; k++)
            if (strcmp(material, hnbrdf_measured_name(r->data.items[m])) == 0 &&
                strcmp(name, r->entries[k].name) == 0)
                return &r->entries[k].pictures[m];
    return NULL;
}

static int read_number(const char *text, double *value)
{
    const char *end = text + strlen(text);
    return hnbrdf_parse_double(text, end, value) == end;
}

/* A row of images.csv; what is not one is made again. */
static void read_row(report *r, const hnbrdf_csv_reader *reader)
{
    enum { VALUES = 7, FIRST = 5, NAME = FIRST + VALUES };
    double values[VALUES];
    report_picture *p =
        reader->count == NAME + 1 ? find_picture(r, reader->fields[0], reader->fields[NAME]) : NULL;
    for (int k = 0; k < VALUES && p; k++)
        if (strcmp(reader->fields[FIRST + k], "inf") == 0)
            values[k] = (double)INFINITY;
        else if (!read_number(reader->fields[FIRST + k], &values[k]))
            p = NULL;
    if (p)
        *p = (report_picture){1,         values[0], values[1], values[2],
                              values[3], values[4], values[5], values[6]};
}

hnbrdf_result report_images_read_figures(report *r)
{
    hnbrdf_csv_reader *reader = malloc(sizeof *reader);
    char *path = report_path_in(r, "images.csv");
    FILE *file = path ? fopen(path, "r") : NULL;
    hnbrdf_result result = HNBRDF_OK;
    int found;
    if (!reader || !path)
        result = hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    if (result == HNBRDF_OK && file) {
        hnbrdf_csv_begin(reader, file, path);
        while ((found = hnbrdf_csv_next(reader, r->error)) == 1)
            read_row(r, reader);
        result = found < 0 ? HNBRDF_ERROR_FORMAT : HNBRDF_OK;
    }
    if (file)
        fclose(file);
    free(reader);
    free(path);
    return result;
}

int report_images_is_done(const report *r, int m)
{
    int done = 1;
    for (int k = 0; k < r->count; k++)
        done &= r->entries[k].pictures[m].done;
    return done;
}
