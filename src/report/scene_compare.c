/* scene_compare.c: what models cost and what they lose in one scene, against the measurements in
 * it. */
#include "report/scene_compare.h"

#include "base/error.h"
#include "base/write.h"
#include "report/spheres.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct kind {
    const char *name, *suffix;
    render_show show;
} kinds[REPORT_SCENE_ROWS] = {
    {"measured", "_measured", RENDER_SHOW_MEASURED},
    {"model", "", RENDER_SHOW_MODEL},
    {"GGX alone", "_ggx", RENDER_SHOW_ANALYTIC},
};

/* Each kind is rendered twice, with half of the samples and seeds of their own. The noise of one
 * half has nothing to do with that of the other, so that the mean of (A1 - B1) (A2 - B2) is the
 * squared difference without noise; the same seeds for all kinds keep it small. */
typedef struct halves {
    render_image image[2];
    double cpu, wall; /* seconds, of both */
} halves;

/* ---- Rendering ------------------------------------------------------------------------------- */

/* How far all renderings together are. */
typedef struct place {
    const report_watch *watch;
    int done;
    const char *name;
} place;

static int show(void *user, double share)
{
    const place *p = user;
    report_show(p->watch, (p->done + share) / (2 * REPORT_SCENE_ROWS), p->name);
    return report_stop(p->watch);
}

static hnbrdf_result render_halves(const report_scene *scene, int kind, halves *h,
                                   hnbrdf_error *error)
{
    for (int half = 0; half < 2; half++) {
        place p = {&scene->watch, 2 * kind + half, kinds[kind].name};
        render_job one = scene->job;
        render_outcome outcome;
        one.output = NULL; /* no checkpoints */
        one.spp = (scene->job.spp + 1) / 2;
        one.seed += half;
        one.progress = show;
        one.progress_user = &p;
        hnbrdf_result result =
            render_job_run_description(&one, scene->description, kinds[kind].show, scene->folder,
                                       scene->reading, &h->image[half], &outcome, error);
        if (result)
            return result;
        if (!outcome.complete)
            return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED, "interrupted: nothing to compare");
        h->cpu += outcome.cpu;
        h->wall += outcome.wall;
    }
    return HNBRDF_OK;
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

static hnbrdf_result write_one(const report_scene *scene, const render_image *image,
                               const struct kind *kind, hnbrdf_error *error)
{
    char comments[256];
    char *path = suffixed(scene->job.output, kind->suffix);
    if (!path)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    snprintf(comments, sizeof comments,
             "hnbrdf %s scene --compare: %s, %ld samples a pixel, seed %ld", hnbrdf_version(),
             kind->name, scene->job.spp, scene->job.seed);
    const render_write_options options = {
        .exposure = scene->exposure, .half = scene->half, .comments = comments};
    hnbrdf_result result = report_write_told(image, path, &options, &scene->watch, error);
    free(path);
    return result;
}

/* The mean of both halves as a picture; the halves stay. */
static hnbrdf_result write_mean(const report_scene *scene, const halves *h, const struct kind *kind,
                                hnbrdf_error *error)
{
    render_image mean;
    hnbrdf_result result =
        render_image_create(h->image[0].width, h->image[0].height, 0, &mean, error);
    if (result)
        return result;
    size_t count = 3 * (size_t)mean.width * (size_t)mean.height;
    for (size_t i = 0; i < count; i++)
        mean.rgb[i] = 0.5f * (h->image[0].rgb[i] + h->image[1].rgb[i]);
    result = write_one(scene, &mean, kind, error);
    render_image_free(&mean);
    return result;
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

static void measure(const halves *test, const halves *reference, double exposure,
                    report_scene_row *r)
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

static void free_halves(halves *h)
{
    render_image_free(&h->image[0]);
    render_image_free(&h->image[1]);
}

hnbrdf_result report_scene_compare(const report_scene *scene,
                                   report_scene_row rows[REPORT_SCENE_ROWS], hnbrdf_error *error)
{
    halves all[REPORT_SCENE_ROWS];
    hnbrdf_result result = HNBRDF_OK;
    memset(all, 0, sizeof all);
    for (int i = 0; i < REPORT_SCENE_ROWS && !result; i++) {
        result = render_halves(scene, i, &all[i], error);
        if (!result)
            result = write_mean(scene, &all[i], &kinds[i], error);
        if (result)
            break;
        rows[i] = (report_scene_row){.cpu = all[i].cpu, .wall = all[i].wall};
        if (i == REPORT_SCENE_MEASURED)
            rows[i].mae = noise_of(&all[i]);
        else
            measure(&all[i], &all[REPORT_SCENE_MEASURED], scene->exposure, &rows[i]);
    }
    for (int i = 0; i < REPORT_SCENE_ROWS; i++)
        free_halves(&all[i]);
    return result;
}

/* ---- The table ------------------------------------------------------------------------------- */

void report_scene_print(const void *table, FILE *file)
{
    const report_scene_row *rows = table;
    fprintf(file, "%-12s %10s %10s %14s %8s %8s\n", "", "MAE", "PSNR, dB", "PNG: PSNR, dB",
            "CPU, s", "wall, s");
    for (int i = 0; i < REPORT_SCENE_ROWS; i++) {
        if (i == REPORT_SCENE_MEASURED)
            fprintf(file, "%-12s %10s %10s %14s", kinds[i].name, "-", "-", "-");
        else
            fprintf(file, "%-12s %10.5f %10.2f %14.2f", kinds[i].name, rows[i].mae, rows[i].psnr,
                    rows[i].png_psnr);
        fprintf(file, " %8.1f %8.1f\n", rows[i].cpu, rows[i].wall);
    }
    fprintf(file,
            "MAE between renderings with other seeds, noise alone: %.5f; PSNR is free of noise\n",
            rows[REPORT_SCENE_MEASURED].mae);
}

void report_scene_write_csv(const void *table, FILE *file)
{
    const report_scene_row *rows = table;
    fputs("shown,mae,psnr,png_psnr,noise_mae,cpu_seconds,wall_seconds\n", file);
    for (int i = 0; i < REPORT_SCENE_ROWS; i++) {
        fprintf(file, "%s", kinds[i].name);
        if (i == REPORT_SCENE_MEASURED)
            fprintf(file, ",,,,%.9g", rows[i].mae);
        else
            fprintf(file, ",%.9g,%.9g,%.9g,", rows[i].mae, rows[i].psnr, rows[i].png_psnr);
        fprintf(file, ",%.3f,%.3f\n", rows[i].cpu, rows[i].wall);
    }
}

/* JSON knows no infinity. */
static void write_decibel(FILE *file, const char *name, double value)
{
    if (isfinite(value))
        fprintf(file, ", \"%s\": %.9g", name, value);
    else
        fprintf(file, ", \"%s\": null", name);
}

void report_scene_write_json(const void *table, FILE *file)
{
    const report_scene_row *rows = table;
    fputs("[\n", file);
    for (int i = 0; i < REPORT_SCENE_ROWS; i++) {
        fputs("  {\"shown\": ", file);
        hnbrdf_write_json_text(file, kinds[i].name);
        fprintf(file, ", \"%s\": %.9g", i == REPORT_SCENE_MEASURED ? "noise_mae" : "mae",
                rows[i].mae);
        if (i != REPORT_SCENE_MEASURED) {
            write_decibel(file, "psnr", rows[i].psnr);
            write_decibel(file, "png_psnr", rows[i].png_psnr);
        }
        fprintf(file, ", \"cpu_seconds\": %.3f, \"wall_seconds\": %.3f}%s\n", rows[i].cpu,
                rows[i].wall, i + 1 < REPORT_SCENE_ROWS ? "," : "");
    }
    fputs("]\n", file);
}
