/* scene_compare.c: what models cost and what they lose in one scene, against the measurements in it. */
#include "cli/scene_compare.h"

#include <stdlib.h>
#include <string.h>

enum { MEASURED, AGAIN, MODEL, GGX, ROWS };
static const struct kind {
    const char *name, *what, *suffix;
    render_show show;
} kinds[ROWS] = {
    {"measured", "rendering measurements", "_measured", RENDER_SHOW_MEASURED},
    {"measured, another seed", "rendering measurements again", NULL, RENDER_SHOW_MEASURED},
    {"model", "rendering models", "", RENDER_SHOW_MODEL},
    {"GGX alone", "rendering GGX", "_ggx", RENDER_SHOW_ANALYTIC},
};

typedef struct row {
    hnbrdf_image_error linear; /* of radiance, PSNR with the largest radiance as peak */
    hnbrdf_image_error shown;  /* of the values in the PNG, 0 to 1 */
    scene_time time;
} row;

int scene_files_render(const scene_files *files, const scene_job *job, render_show show,
                       const char *folder, const char *what, render_image *image, scene_time *time)
{
    hnbrdf_error error;
    render_loaded loaded;
    const hnbrdf_measured_options reading = cli_reading_options();
    if (render_description_load(&files->description, show, folder, &reading, &loaded, &error) !=
        HNBRDF_OK)
        return cli_fail("%s", error.text);
    scene_job whole = *job;
    whole.transparent = files->description.hidden;
    if (!whole.bounces)
        whole.bounces = files->description.bounces;
    int code = scene_job_render(&whole, &loaded.scene, what, image, time);
    render_loaded_free(&loaded);
    return code;
}

/* "room_ggx.exr" for "room.exr". */
static char *suffixed(const char *output, const char *suffix)
{
    size_t length = strlen(output), size = length + strlen(suffix) + 1;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%.*s%s%s", (int)length - 4, output, suffix, output + length - 4);
    return path;
}

static int write_one(const scene_job *job, const render_image *image, const struct kind *kind,
                     double exposure)
{
    char comments[256];
    char *path = suffixed(job->output, kind->suffix);
    if (!path)
        return cli_fail("out of memory");
    snprintf(comments, sizeof comments, "hnbrdf %s scene --compare: %s, %ld samples a pixel, seed %ld",
             hnbrdf_version(), kind->name, job->spp, job->seed);
    const render_write_options options = {
        .exposure = exposure, .half = job->half, .comments = comments};
    int code = picture_write(image, path, &options);
    free(path);
    return code;
}

/* ---- Errors -------------------------------------------------------------------------------------- */

static void show(const render_image *image, double exposure, float *values)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        double x = (double)image->rgb[i] * exp2(exposure);
        x = x < 1.0 ? x : 1.0;
        values[i] = (float)(x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055);
    }
}

static int measure(const render_image *image, const render_image *reference, double exposure, row *r)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    float *values = malloc(2 * count * sizeof *values);
    if (!values)
        return cli_fail("out of memory");
    hnbrdf_image_compare(image->rgb, reference->rgb, count, &r->linear);
    show(image, exposure, values);
    show(reference, exposure, values + count);
    hnbrdf_image_compare(values, values + count, count, &r->shown);
    free(values);
    return CLI_OK;
}

/* ---- The table ----------------------------------------------------------------------------------- */

static void print_table(const row *rows)
{
    printf("%-24s %10s %10s %14s %8s %8s\n", "", "MAE", "PSNR, dB", "PNG: PSNR, dB", "CPU, s",
           "wall, s");
    for (int i = 0; i < ROWS; i++) {
        if (i == MEASURED)
            printf("%-24s %10s %10s %14s", kinds[i].name, "-", "-", "-");
        else
            printf("%-24s %10.5f %10.2f %14.2f", kinds[i].name, rows[i].linear.mae, rows[i].linear.psnr,
                   rows[i].shown.psnr);
        printf(" %8.1f %8.1f\n", rows[i].time.cpu, rows[i].time.wall);
    }
}

static int write_csv(const char *path, const row *rows)
{
    cli_output output;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    fputs("shown,mae,psnr,png_psnr,cpu_seconds,wall_seconds\n", output.file);
    for (int i = 0; i < ROWS; i++) {
        fprintf(output.file, "\"%s\"", kinds[i].name);
        if (i == MEASURED)
            fputs(",,,", output.file);
        else
            fprintf(output.file, ",%.9g,%.9g,%.9g", rows[i].linear.mae, rows[i].linear.psnr,
                    rows[i].shown.psnr);
        fprintf(output.file, ",%.3f,%.3f\n", rows[i].time.cpu, rows[i].time.wall);
    }
    return cli_output_close(&output);
}

static int write_json(const char *path, const row *rows)
{
    cli_output output;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    fputs("[\n", output.file);
    for (int i = 0; i < ROWS; i++) {
        fputs("  {\"shown\": ", output.file);
        cli_write_json_text(output.file, kinds[i].name);
        if (i != MEASURED)
            fprintf(output.file, ", \"mae\": %.9g, \"psnr\": %.9g, \"png_psnr\": %.9g",
                    rows[i].linear.mae, rows[i].linear.psnr, rows[i].shown.psnr);
        fprintf(output.file, ", \"cpu_seconds\": %.3f, \"wall_seconds\": %.3f}%s\n", rows[i].time.cpu,
                rows[i].time.wall, i + 1 < ROWS ? "," : "");
    }
    fputs("]\n", output.file);
    return cli_output_close(&output);
}

static int write_tables(const scene_files *files, const row *rows)
{
    int code = CLI_OK;
    print_table(rows);
    if (files->csv)
        code = write_csv(files->csv, rows);
    if (code == CLI_OK && files->json)
        code = write_json(files->json, rows);
    return code;
}

static int check_tables(const scene_files *files)
{
    int code = files->csv ? cli_output_check(files->csv) : CLI_OK;
    return code == CLI_OK && files->json ? cli_output_check(files->json) : code;
}

int scene_compare(const scene_files *files, const scene_job *job, const char *folder, double exposure)
{
    row rows[ROWS];
    memset(rows, 0, sizeof rows);
    render_image reference = {0};
    int code = check_tables(files);
    for (int i = 0; i < ROWS && code == CLI_OK; i++) {
        render_image image = {0};
        scene_job one = *job;
        one.output = NULL; /* no checkpoints */
        one.seed += i == AGAIN;
        code = scene_files_render(files, &one, kinds[i].show, folder, kinds[i].what, &image,
                                  &rows[i].time);
        if (code == CLI_OK && scene_job_interrupted())
            code = cli_fail("interrupted: nothing to compare");
        if (code == CLI_OK && kinds[i].suffix)
            code = write_one(job, &image, &kinds[i], exposure);
        if (code == CLI_OK && i != MEASURED)
            code = measure(&image, &reference, exposure, &rows[i]);
        if (i == MEASURED)
            reference = image;
        else
            render_image_free(&image);
    }
    render_image_free(&reference);
    return code == CLI_OK ? write_tables(files, rows) : code;
}
