/* compare_images.c: `hnbrdf compare --images`: MAE, MSE, PSNR and FLIP of pictures against a
 * reference, and where a picture differs, in false colours. */
#include "report/compare_images.h"

#include "base/error.h"
#include "base/text.h"
#include "image/difference.h"
#include "base/write.h"
#include "report/output.h"
#include "report/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct picture {
    const char *path;
    render_image image;
    hnbrdf_image_error error;
    double flip;
    size_t pixels; /* that count */
} picture;

typedef struct job {
    const compare_images_options *options;
    picture *pictures; /* [count] */
    picture reference;
    int count;
} job;

/* ---- Reading --------------------------------------------------------------------------------- */

static hnbrdf_result read_picture(const job *j, picture *p, const char *path, hnbrdf_error *error)
{
    const compare_images_options *o = j->options;
    const render_read_options options = {.notes = o->notes, .layer = o->layer, .repair = o->repair};
    p->path = path;
    hnbrdf_result result = render_image_read(path, &options, &p->image, error);
    return result == HNBRDF_OK ? render_image_check(&p->image, path, error) : result;
}

static hnbrdf_result measure(const job *j, picture *p, hnbrdf_error *error)
{
    const picture *reference = &j->reference;
    const render_image *a = &p->image, *b = &reference->image;
    if (a->width != b->width || a->height != b->height)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "%s is %d x %d, the reference %s %d x %d: expected the same size",
                           p->path, a->width, a->height, reference->path, b->width, b->height);
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++)
        p->pixels += (size_t)render_covered(a, b, i);
    if (p->pixels == 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "%s and %s: alpha is 0 everywhere in both, there is nothing to compare",
                           p->path, reference->path);
    const hnbrdf_result result = report_picture_compare(a, b, &p->error, error);
    return result == HNBRDF_OK
               ? report_flip_compare(a, b, &j->options->flip, &j->options->watch, &p->flip, error)
               : result;
}

/* ---- Tables ---------------------------------------------------------------------------------- */

static void write_table(const job *j)
{
    FILE *file = j->options->table;
    int width = (int)strlen("image");
    for (int k = 0; k < j->count; k++) {
        int length = (int)strlen(j->pictures[k].path);
        width = length > width ? length : width;
    }
    fprintf(file, "%-*s  %11s  %11s  %8s  %6s  %9s\n", width, "image", "MAE", "MSE", "PSNR", "FLIP",
            "pixels");
    for (int k = 0; k < j->count; k++) {
        const picture *p = &j->pictures[k];
        fprintf(file, "%-*s  %11.5g  %11.5g  ", width, p->path, p->error.mae, p->error.mse);
        if (isinf(p->error.psnr))
            fprintf(file, "%8s", p->error.psnr > 0.0 ? "equal" : "-inf");
        else
            fprintf(file, "%8.2f", p->error.psnr);
        fprintf(file, "  %6.4f  %9zu\n", p->flip, p->pixels);
    }
    fprintf(file,
            "\nagainst %s; PSNR in dB, its peak the reference's largest value; FLIP (ours): 0 is "
            "equal, 1 the worst\n",
            j->reference.path);
}

static void write_number(FILE *file, const char *before, double value, const char *infinite)
{
    char text[HNBRDF_NUMBER_TEXT];
    hnbrdf_format_float(text, sizeof text, (float)value);
    fprintf(file, "%s%s", before, isinf(value) ? infinite : text);
}

static void write_csv(const void *what, FILE *file)
{
    const job *j = what;
    fputs("image,reference,mae,mse,psnr,pixels,flip\n", file);
    for (int k = 0; k < j->count; k++) {
        const picture *p = &j->pictures[k];
        hnbrdf_write_csv_text(file, p->path);
        putc(',', file);
        hnbrdf_write_csv_text(file, j->reference.path);
        write_number(file, ",", p->error.mae, "inf");
        write_number(file, ",", p->error.mse, "inf");
        write_number(file, ",", p->error.psnr, p->error.psnr > 0.0 ? "inf" : "-inf");
        fprintf(file, ",%zu", p->pixels);
        write_number(file, ",", p->flip, "nan");
        putc('\n', file);
    }
}

static void write_json(const void *what, FILE *file)
{
    const job *j = what;
    fputs("{\n  \"reference\": ", file);
    hnbrdf_write_json_text(file, j->reference.path);
    fputs(",\n  \"images\": [", file);
    for (int k = 0; k < j->count; k++) {
        const picture *p = &j->pictures[k];
        fprintf(file, "%s\n    {\"name\": ", k ? "," : "");
        hnbrdf_write_json_text(file, p->path);
        write_number(file, ", \"mae\": ", p->error.mae, "null");
        write_number(file, ", \"mse\": ", p->error.mse, "null");
        write_number(file, ", \"psnr\": ", p->error.psnr, "null");
        write_number(file, ", \"flip\": ", p->flip, "null");
        fprintf(file, ", \"pixels\": %zu}", p->pixels);
    }
    fputs("\n  ]\n}\n", file);
}

/* ---- The difference -------------------------------------------------------------------------- */

static hnbrdf_result draw_difference(const job *j, hnbrdf_error *error)
{
    const picture *p = &j->pictures[0];
    const char *path = j->options->difference;
    char what[256], figures[128];
    const char *lines[RENDER_DIFFERENCE_LINES] = {what, figures,
                                                  "|difference|, mean of R, G and B"};
    render_image page = {0};
    snprintf(what, sizeof what, "%.100s against %.100s", p->path, j->reference.path);
    snprintf(figures, sizeof figures, "MAE %.4g, MSE %.4g, PSNR %.2f dB, FLIP %.4f", p->error.mae,
             p->error.mse, p->error.psnr, p->flip);
    hnbrdf_result result = render_difference_page(&p->image, &j->reference.image, j->options->top,
                                                  lines, &page, error);
    if (result != HNBRDF_OK)
        return result;
    render_write_options options = {.half = 1, .comments = what};
    result = report_picture_write(&page, path, &options, error);
    render_image_free(&page);
    if (result == HNBRDF_OK && j->options->table)
        report_print_pictures(path, j->options->table);
    return result;
}

static hnbrdf_result read_and_measure(job *j, hnbrdf_error *error)
{
    char *const *paths = j->options->paths;
    hnbrdf_result result = read_picture(j, &j->reference, paths[j->count], error);
    for (int k = 0; k < j->count && result == HNBRDF_OK; k++) {
        result = read_picture(j, &j->pictures[k], paths[k], error);
        if (result == HNBRDF_OK)
            result = measure(j, &j->pictures[k], error);
        if (result == HNBRDF_OK && !j->options->difference)
            render_image_free(&j->pictures[k].image);
    }
    return result;
}

hnbrdf_result compare_images(const compare_images_options *options, hnbrdf_error *error)
{
    job j = {.options = options, .count = options->count - 1};
    j.pictures = calloc((size_t)j.count, sizeof *j.pictures);
    if (!j.pictures)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    hnbrdf_result result = read_and_measure(&j, error);
    if (result == HNBRDF_OK && options->table)
        write_table(&j);
    if (result == HNBRDF_OK && options->csv)
        result = report_write_file(options->csv, write_csv, &j, error);
    if (result == HNBRDF_OK && options->json)
        result = report_write_file(options->json, write_json, &j, error);
    if (result == HNBRDF_OK && options->difference)
        result = draw_difference(&j, error);
    for (int k = 0; k < j.count; k++)
        render_image_free(&j.pictures[k].image);
    render_image_free(&j.reference.image);
    free(j.pictures);
    return result;
}
