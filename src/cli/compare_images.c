/* compare_images.c: `hnbrdf compare --images`: MAE, MSE and PSNR of pictures against a reference,
 * and where a picture differs, in false colours. */
#include "cli/compare_images.h"

#include "cli/csv.h"
#include "cli/picture.h"
#include "base/text.h"
#include "image/difference.h"

#include <stdlib.h>
#include <string.h>

typedef struct picture {
    const char *path;
    render_image image;
    hnbrdf_image_error error;
    size_t pixels; /* that count */
} picture;

typedef struct job {
    const compare_images_options *options;
    picture *pictures; /* [count] */
    picture reference;
    int count;
} job;

/* ---- Reading --------------------------------------------------------------------------------- */

static int check_values(const picture *p)
{
    size_t width = (size_t)p->image.width, bad = 0, first = 0;
    for (size_t i = 0; i < width * (size_t)p->image.height; i++) {
        const float *rgb = p->image.rgb + 3 * i;
        int finite = isfinite(rgb[0]) && isfinite(rgb[1]) && isfinite(rgb[2]) &&
                     (!p->image.alpha || isfinite(p->image.alpha[i]));
        if (!finite && bad++ == 0)
            first = i;
    }
    if (!bad)
        return CLI_OK;
    const float *rgb = p->image.rgb + 3 * first;
    return cli_fail("%s: %zu pixel%s not finite, the first at column %zu, row %zu: (%g, %g, %g)",
                    p->path, bad, bad == 1 ? " is" : "s are", first % width, first / width,
                    (double)rgb[0], (double)rgb[1], (double)rgb[2]);
}

static int read_picture(picture *p, const char *path)
{
    hnbrdf_error error;
    p->path = path;
    if (render_image_read(path, NULL, &p->image, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    return check_values(p);
}

static int measure(picture *p, const picture *reference)
{
    const render_image *a = &p->image, *b = &reference->image;
    if (a->width != b->width || a->height != b->height)
        return cli_fail("%s is %d x %d, the reference %s %d x %d: expected the same size", p->path,
                        a->width, a->height, reference->path, b->width, b->height);
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++)
        p->pixels += (size_t)render_covered(a, b, i);
    if (p->pixels == 0)
        return cli_fail("%s and %s: alpha is 0 everywhere in both, there is nothing to compare",
                        p->path, reference->path);
    return picture_compare(a, b, &p->error);
}

/* ---- Tables ---------------------------------------------------------------------------------- */

static void write_table(const job *j)
{
    int width = (int)strlen("image");
    for (int k = 0; k < j->count; k++) {
        int length = (int)strlen(j->pictures[k].path);
        width = length > width ? length : width;
    }
    printf("%-*s  %11s  %11s  %8s  %9s\n", width, "image", "MAE", "MSE", "PSNR", "pixels");
    for (int k = 0; k < j->count; k++) {
        const picture *p = &j->pictures[k];
        printf("%-*s  %11.5g  %11.5g  ", width, p->path, p->error.mae, p->error.mse);
        if (isinf(p->error.psnr))
            printf("%8s", p->error.psnr > 0.0 ? "equal" : "-inf");
        else
            printf("%8.2f", p->error.psnr);
        printf("  %9zu\n", p->pixels);
    }
    printf("\nagainst %s; PSNR in dB, its peak the reference's largest value\n", j->reference.path);
}

static void write_number(FILE *file, const char *before, double value, const char *infinite)
{
    char text[HNBRDF_NUMBER_TEXT];
    hnbrdf_format_float(text, sizeof text, (float)value);
    fprintf(file, "%s%s", before, isinf(value) ? infinite : text);
}

static void write_csv(const job *j, FILE *file)
{
    fputs("image,reference,mae,mse,psnr,pixels\n", file);
    for (int k = 0; k < j->count; k++) {
        const picture *p = &j->pictures[k];
        csv_write_text(file, p->path);
        putc(',', file);
        csv_write_text(file, j->reference.path);
        write_number(file, ",", p->error.mae, "inf");
        write_number(file, ",", p->error.mse, "inf");
        write_number(file, ",", p->error.psnr, p->error.psnr > 0.0 ? "inf" : "-inf");
        fprintf(file, ",%zu\n", p->pixels);
    }
}

static void write_json(const job *j, FILE *file)
{
    fputs("{\n  \"reference\": ", file);
    cli_write_json_text(file, j->reference.path);
    fputs(",\n  \"images\": [", file);
    for (int k = 0; k < j->count; k++) {
        const picture *p = &j->pictures[k];
        fprintf(file, "%s\n    {\"name\": ", k ? "," : "");
        cli_write_json_text(file, p->path);
        write_number(file, ", \"mae\": ", p->error.mae, "null");
        write_number(file, ", \"mse\": ", p->error.mse, "null");
        write_number(file, ", \"psnr\": ", p->error.psnr, "null");
        fprintf(file, ", \"pixels\": %zu}", p->pixels);
    }
    fputs("\n  ]\n}\n", file);
}

static int write_file(const job *j, const char *path, void (*write)(const job *j, FILE *file))
{
    cli_output output;
    if (!path)
        return CLI_OK;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    write(j, output.file);
    return cli_output_close(&output);
}

/* 1 if a table goes to standard output, which then holds nothing else. */
static int is_machine_read(const compare_images_options *options)
{
    return (options->csv && strcmp(options->csv, "-") == 0) ||
           (options->json && strcmp(options->json, "-") == 0);
}

/* ---- The difference -------------------------------------------------------------------------- */

static int draw_difference(const job *j)
{
    const picture *p = &j->pictures[0];
    char what[256], figures[128];
    const char *lines[RENDER_DIFFERENCE_LINES] = {what, figures,
                                                  "|difference|, mean of R, G and B"};
    render_image page = {0};
    hnbrdf_error error;
    snprintf(what, sizeof what, "%.100s against %.100s", p->path, j->reference.path);
    snprintf(figures, sizeof figures, "MAE %.4g, MSE %.4g, PSNR %.2f dB", p->error.mae,
             p->error.mse, p->error.psnr);
    if (render_difference_page(&p->image, &j->reference.image, j->options->top, lines, &page,
                               &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    render_write_options options = {.half = 1, .comments = what};
    int code = is_machine_read(j->options)
                   ? picture_write_quietly(&page, j->options->difference, &options)
                   : picture_write(&page, j->options->difference, &options);
    render_image_free(&page);
    return code;
}

int compare_images(const compare_images_options *options)
{
    job j = {.options = options, .count = options->count - 1};
    int code = CLI_OK;
    j.pictures = calloc((size_t)j.count, sizeof *j.pictures);
    if (!j.pictures)
        return cli_fail("out of memory");
    code = read_picture(&j.reference, options->paths[j.count]);
    for (int k = 0; k < j.count && code == CLI_OK; k++) {
        code = read_picture(&j.pictures[k], options->paths[k]);
        if (code == CLI_OK)
            code = measure(&j.pictures[k], &j.reference);
        if (code == CLI_OK && !options->difference)
            render_image_free(&j.pictures[k].image);
    }
    if (code == CLI_OK && !is_machine_read(options))
        write_table(&j);
    if (code == CLI_OK)
        code = write_file(&j, options->csv, write_csv);
    if (code == CLI_OK)
        code = write_file(&j, options->json, write_json);
    if (code == CLI_OK && options->difference)
        code = draw_difference(&j);
    for (int k = 0; k < j.count; k++)
        render_image_free(&j.pictures[k].image);
    render_image_free(&j.reference.image);
    free(j.pictures);
    return code;
}
