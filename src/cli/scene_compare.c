/* scene_compare.c: what models cost and what they lose in one scene, against the measurements in
 * it. */
#include "cli/scene_compare.h"
#include "base/write.h"

#include <stdlib.h>
#include <string.h>

enum { MEASURED, MODEL, GGX, ROWS };
static const struct kind {
    const char *name, *what, *suffix;
    render_show show;
} kinds[ROWS] = {
    {"measured", "rendering measurements", "_measured", RENDER_SHOW_MEASURED},
    {"model", "rendering models", "", RENDER_SHOW_MODEL},
    {"GGX alone", "rendering GGX", "_ggx", RENDER_SHOW_ANALYTIC},
};

/* Each kind is rendered twice, with half of the samples and seeds of their own. The noise of one
 * half has nothing to do with that of the other, so that the mean of (A1 - B1) (A2 - B2) is the
 * squared difference without noise; the same seeds for all kinds keep it small. */
typedef struct halves {
    render_image image[2];
    scene_time time; /* of both */
} halves;

typedef struct row {
    double mae;      /* of the means of both halves: with what noise is left */
    double psnr;     /* without noise; peak: the largest value of the measured picture */
    double png_psnr; /* of the values in the PNG, 0 to 1, peak 1; likewise */
    scene_time time;
} row;

int scene_files_render(const scene_files *files, const scene_job *job, render_show show,
                       const char *folder, const char *what, render_image *image, scene_time *time)
{
    hnbrdf_error error;
    render_loaded loaded;
    if (render_description_load(&files->description, show, folder, &cli_read, &loaded, &error) !=
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
    snprintf(comments, sizeof comments,
             "hnbrdf %s scene --compare: %s, %ld samples a pixel, seed %ld", hnbrdf_version(),
             kind->name, job->spp, job->seed);
    const render_write_options options = {
        .exposure = exposure, .half = job->half, .comments = comments};
    int code = picture_write(image, path, &options);
    free(path);
    return code;
}

/* ---- Errors ---------------------------------------------------------------------------------- */

/* What the PNG shows of a value, 0 to 1. */
static double shown(float value, double gain)
{
    double x = (double)value * gain;
    x = x < 1.0 ? x : 1.0;
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

/* dB; noise may leave less than nothing of a small error: infinite then. */
static double psnr(double mse, double peak)
{
    return mse > 0.0 ? 10.0 * log10(peak * peak / mse) : (double)INFINITY;
}

static void measure(const halves *test, const halves *reference, double exposure, row *r)
{
    const float *a = test->image[0].rgb, *b = test->image[1].rgb, *c = reference->image[0].rgb,
                *d = reference->image[1].rgb;
    size_t count = 3 * (size_t)test->image[0].width * (size_t)test->image[0].height;
    double gain = exp2(exposure), mae = 0.0, mse = 0.0, shown_mse = 0.0, peak = 0.0;
    for (size_t i = 0; i < count; i++) {
        double first = (double)a[i] - (double)c[i], second = (double)b[i] - (double)d[i];
        mae += fabs(0.5 * (first + second));
        mse += first * second;
        shown_mse +=
            (shown(a[i], gain) - shown(c[i], gain)) * (shown(b[i], gain) - shown(d[i], gain));
        peak = fmax(peak, 0.5 * ((double)c[i] + (double)d[i]));
    }
    r->mae = mae / (double)count;
    r->psnr = psnr(mse / (double)count, peak);
    r->png_psnr = psnr(shown_mse / (double)count, 1.0);
}

/* What two renderings of one scene with all samples and other seeds would differ by. */
static double noise_of(const halves *h)
{
    size_t count = 3 * (size_t)h->image[0].width * (size_t)h->image[0].height;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += fabs((double)h->image[0].rgb[i] - (double)h->image[1].rgb[i]);
    return sum / (double)count / sqrt(2.0);
}

/* ---- The table ------------------------------------------------------------------------------- */

/* Row MEASURED holds the noise as its MAE. */
static void print_table(const row *rows)
{
    printf("%-12s %10s %10s %14s %8s %8s\n", "", "MAE", "PSNR, dB", "PNG: PSNR, dB", "CPU, s",
           "wall, s");
    for (int i = 0; i < ROWS; i++) {
        if (i == MEASURED)
            printf("%-12s %10s %10s %14s", kinds[i].name, "-", "-", "-");
        else
            printf("%-12s %10.5f %10.2f %14.2f", kinds[i].name, rows[i].mae, rows[i].psnr,
                   rows[i].png_psnr);
        printf(" %8.1f %8.1f\n", rows[i].time.cpu, rows[i].time.wall);
    }
    printf("MAE between renderings with other seeds, noise alone: %.5f; PSNR is free of noise\n",
           rows[MEASURED].mae);
}

static int write_csv(const char *path, const row *rows)
{
    cli_output output;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    fputs("shown,mae,psnr,png_psnr,noise_mae,cpu_seconds,wall_seconds\n", output.file);
    for (int i = 0; i < ROWS; i++) {
        fprintf(output.file, "%s", kinds[i].name);
        if (i == MEASURED)
            fprintf(output.file, ",,,,%.9g", rows[i].mae);
        else
            fprintf(output.file, ",%.9g,%.9g,%.9g,", rows[i].mae, rows[i].psnr, rows[i].png_psnr);
        fprintf(output.file, ",%.3f,%.3f\n", rows[i].time.cpu, rows[i].time.wall);
    }
    return cli_output_close(&output);
}

/* JSON knows no infinity. */
static void write_decibel(FILE *file, const char *name, double value)
{
    if (isfinite(value))
        fprintf(file, ", \"%s\": %.9g", name, value);
    else
        fprintf(file, ", \"%s\": null", name);
}

static int write_json(const char *path, const row *rows)
{
    cli_output output;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    fputs("[\n", output.file);
    for (int i = 0; i < ROWS; i++) {
        fputs("  {\"shown\": ", output.file);
        hnbrdf_write_json_text(output.file, kinds[i].name);
        fprintf(output.file, ", \"%s\": %.9g", i == MEASURED ? "noise_mae" : "mae", rows[i].mae);
        if (i != MEASURED) {
            write_decibel(output.file, "psnr", rows[i].psnr);
            write_decibel(output.file, "png_psnr", rows[i].png_psnr);
        }
        fprintf(output.file, ", \"cpu_seconds\": %.3f, \"wall_seconds\": %.3f}%s\n",
                rows[i].time.cpu, rows[i].time.wall, i + 1 < ROWS ? "," : "");
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

/* ---- All of it ------------------------------------------------------------------------------- */

static int render_halves(const scene_files *files, const scene_job *job, const struct kind *kind,
                         const char *folder, halves *h)
{
    int code = CLI_OK;
    for (int half = 0; half < 2 && code == CLI_OK; half++) {
        scene_job one = *job;
        scene_time time;
        one.output = NULL; /* no checkpoints */
        one.spp = (job->spp + 1) / 2;
        one.seed += half;
        code =
            scene_files_render(files, &one, kind->show, folder, kind->what, &h->image[half], &time);
        if (code == CLI_OK && scene_job_interrupted())
            code = cli_fail("interrupted: nothing to compare");
        h->time.cpu += time.cpu;
        h->time.wall += time.wall;
    }
    return code;
}

/* The mean of both halves as a picture; the halves stay. */
static int write_mean(const scene_job *job, const halves *h, const struct kind *kind,
                      double exposure)
{
    hnbrdf_error error;
    render_image mean;
    if (render_image_create(h->image[0].width, h->image[0].height, 0, &mean, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    size_t count = 3 * (size_t)mean.width * (size_t)mean.height;
    for (size_t i = 0; i < count; i++)
        mean.rgb[i] = 0.5f * (h->image[0].rgb[i] + h->image[1].rgb[i]);
    int code = write_one(job, &mean, kind, exposure);
    render_image_free(&mean);
    return code;
}

static void free_halves(halves *h)
{
    render_image_free(&h->image[0]);
    render_image_free(&h->image[1]);
}

int scene_compare(const scene_files *files, const scene_job *job, const char *folder,
                  double exposure)
{
    row rows[ROWS];
    halves all[ROWS];
    memset(rows, 0, sizeof rows);
    memset(all, 0, sizeof all);
    int code = check_tables(files);
    for (int i = 0; i < ROWS && code == CLI_OK; i++) {
        code = render_halves(files, job, &kinds[i], folder, &all[i]);
        if (code == CLI_OK)
            code = write_mean(job, &all[i], &kinds[i], exposure);
        if (code != CLI_OK)
            break;
        rows[i].time = all[i].time;
        if (i == MEASURED)
            rows[i].mae = noise_of(&all[i]);
        else
            measure(&all[i], &all[MEASURED], exposure, &rows[i]);
    }
    for (int i = 0; i < ROWS; i++)
        free_halves(&all[i]);
    return code == CLI_OK ? write_tables(files, rows) : code;
}
