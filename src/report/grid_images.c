/* grid_images.c: a sphere of every material, beside the errors over directions: SMAPE looks at
 * dark directions, PSNR at highlights. Each sphere is rendered twice, with half of the samples
 * and a seed of its own: what differs between both is noise, and so the error by noise is known. */
#include "report/grid.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct report_images {
    render_environment environment;
    hnbrdf_model *guide_model;
    /* [materials]: they suit the measurement and GGX, and serve every model, so that all pictures
     * of a material share their random directions */
    render_guide *guides;
    render_image (*references)[2]; /* [materials] */
    /* pictures rendered so far, 2 a sphere; counted only by report_images_run() */
    int rendered, expected;
    const char *detail; /* the material whose spheres are rendered; NULL: nothing is shown */
};

hnbrdf_result report_images_open(report *r)
{
    size_t count = (size_t)r->data.count;
    report_images *images = r->images = calloc(1, sizeof *images);
    if (images) {
        images->guides = calloc(count, sizeof *images->guides);
        images->references = calloc(count, sizeof *images->references);
    }
    if (!images || !images->guides || !images->references)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    hnbrdf_result code = report_open_light(&r->light, &images->environment, r->error);
    return code == HNBRDF_OK ? render_guide_model(&images->guide_model, r->error) : code;
}

static int watch(void *user, double share)
{
    const report *r = user;
    const report_images *images = r->images;
    report_show(&r->watch, (images->rendered + share) / images->expected, images->detail);
    return report_stop(&r->watch);
}

/* ---- Rendering ------------------------------------------------------------------------------- */

static hnbrdf_result render_twice(report *r, int m, render_surface *surface,
                                  render_image pictures[2])
{
    hnbrdf_error error;
    report_images *images = r->images;
    render_surface_guide(surface, &images->guides[m]);
    for (int k = 0; k < 2; k++) {
        const render_options options = {.size = (int)r->image_size,
                                        .spp = (int)(r->light.spp + 1) / 2,
                                        .seed = 2 * (uint64_t)r->light.seed + (uint64_t)k,
                                        .threads = (int)r->threads,
                                        .progress = images->detail ? watch : NULL,
                                        .progress_user = r};
        hnbrdf_result result =
            render_sphere(surface, &images->environment, &options, &pictures[k], &error);
        if (result == HNBRDF_ERROR_CANCELLED)
            return report_interrupted(r);
        if (result != HNBRDF_OK)
            return hnbrdf_fail(r->error, result, "%s: %s", hnbrdf_measured_name(r->data.items[m]),
                               error.text);
        images->rendered++;
    }
    return HNBRDF_OK;
}

/* Into the first one; the second is freed. */
static void average(render_image pictures[2])
{
    size_t pixels = (size_t)pictures[0].width * (size_t)pictures[0].height;
    for (size_t i = 0; i < 3 * pixels; i++)
        pictures[0].rgb[i] = 0.5f * (pictures[0].rgb[i] + pictures[1].rgb[i]);
    for (size_t i = 0; i < pixels; i++)
        pictures[0].alpha[i] = 0.5f * (pictures[0].alpha[i] + pictures[1].alpha[i]);
    render_image_free(&pictures[1]);
}

hnbrdf_result report_images_reference(report *r, int m, const hnbrdf_model *ggx)
{
    render_surface measured = render_surface_measured(r->data.items[m]);
    render_surface analytic = render_surface_analytic(ggx, report_material(r, ggx, m));
    const render_surface *both[] = {&measured, &analytic};
    r->images->guides[m] = render_guide_fit(both, 2, r->images->guide_model);
    return render_twice(r, m, &measured, r->images->references[m]);
}

const render_image *report_images_mean_reference(report *r, int m)
{
    render_image *reference = r->images->references[m];
    if (reference[1].rgb)
        average(reference);
    return &reference[0];
}

void report_images_drop_reference(report *r, int m)
{
    for (int k = 0; k < 2; k++)
        render_image_free(&r->images->references[m][k]);
}

/* ---- Measuring ------------------------------------------------------------------------------- */

/* A picture with the mean of both renderings in values, which has room for 4 numbers a pixel. */
static render_image mean_of(const render_image pictures[2], float *values)
{
    const size_t pixels = (size_t)pictures[0].width * (size_t)pictures[0].height;
    render_image mean = {.width = pictures[0].width,
                         .height = pictures[0].height,
                         .rgb = values,
                         .alpha = values + 3 * pixels};
    for (size_t i = 0; i < 3 * pixels; i++)
        mean.rgb[i] = 0.5f * (pictures[0].rgb[i] + pictures[1].rgb[i]);
    for (size_t i = 0; i < pixels; i++)
        mean.alpha[i] = 0.5f * (pictures[0].alpha[i] + pictures[1].alpha[i]);
    return mean;
}

static hnbrdf_result measure_flip(const report *r, const render_image pictures[2],
                                  const render_image references[2], double *flip)
{
    const size_t pixels = (size_t)pictures[0].width * (size_t)pictures[0].height;
    float *values = malloc(8 * pixels * sizeof *values);
    if (!values)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    const render_image image = mean_of(pictures, values),
                       reference = mean_of(references, values + 4 * pixels);
    hnbrdf_result code = report_flip_compare(&image, &reference, &r->flip, NULL, flip, r->error);
    free(values);
    return code;
}

hnbrdf_result report_images_measure(report *r, int m, report_entry *e, const hnbrdf_model *model,
                                    render_image *mean)
{
    hnbrdf_image_error error;
    hnbrdf_image_noise noise;
    double flip = 0.0;
    render_image pictures[2] = {{0}, {0}};
    render_surface surface = render_surface_model(model, report_material(r, model, m));
    hnbrdf_result code = render_twice(r, m, &surface, pictures);
    if (code == HNBRDF_OK)
        code = report_picture_compare_twice(pictures, r->images->references[m], &error, &noise,
                                            r->error);
    if (code == HNBRDF_OK)
        code = measure_flip(r, pictures, r->images->references[m], &flip);
    if (code == HNBRDF_OK)
        e->pictures[m] = (report_picture){1,
                                          error.mae,
                                          error.mse,
                                          fmin(error.psnr, REPORT_PSNR_LIMIT),
                                          noise.psnr_error,
                                          noise.psnr_bias,
                                          noise.peak_error,
                                          flip};
    if (code == HNBRDF_OK && mean) {
        average(pictures);
        *mean = pictures[0];
        return code;
    }
    render_image_free(&pictures[0]);
    render_image_free(&pictures[1]);
    return code;
}

/* 1 if the picture of this entry is in the picture rows. */
static int is_shown(const report *r, const report_entry *e)
{
    return e == report_find(r, e->form, r->nets[r->net_count - 1], r->latents[0]);
}

static hnbrdf_result measure_and_keep(report *r, int m, report_entry *e, const hnbrdf_model *model)
{
    render_image picture = {0};
    int kept = render_has_exr() && report_rows_has(r, m) && is_shown(r, e);
    hnbrdf_result code = report_images_measure(r, m, e, model, kept ? &picture : NULL);
    if (code == HNBRDF_OK && kept)
        code = report_rows_keep(r, m, e->name, &picture);
    render_image_free(&picture);
    return code;
}

static hnbrdf_result measure_material(report *r, int m, hnbrdf_model *const *models)
{
    r->images->detail = hnbrdf_measured_name(r->data.items[m]);
    hnbrdf_result code = report_images_reference(r, m, models[0]);
    for (int k = 0; k < r->count && code == HNBRDF_OK; k++)
        code = measure_and_keep(r, m, &r->entries[k], models[k]);
    if (code == HNBRDF_OK && render_has_exr() && report_rows_has(r, m))
        code = report_rows_keep(r, m, "reference", report_images_mean_reference(r, m));
    report_images_drop_reference(r, m);
    for (int k = 0; code != HNBRDF_OK && k < r->count; k++)
        r->entries[k].pictures[m].done = 0;
    r->images->detail = NULL;
    return code;
}

static int is_left(const report *r, int m)
{
    return !report_images_is_done(r, m) || !report_rows_is_kept(r, m);
}

hnbrdf_result report_images_run(report *r, hnbrdf_model *const *models,
                                hnbrdf_result (*finished)(report *r))
{
    hnbrdf_result code = HNBRDF_OK;
    int left = 0;
    for (int m = 0; m < r->data.count; m++)
        left += is_left(r, m);
    r->images->rendered = 0;
    r->images->expected = left * 2 * (r->count + 1);
    for (int m = 0; m < r->data.count && code == HNBRDF_OK; m++) {
        if (!is_left(r, m))
            continue;
        code = measure_material(r, m, models);
        if (code == HNBRDF_OK)
            code = finished(r);
    }
    return code;
}

void report_images_average(const report *r, report_entry *e)
{
    int done = 0;
    double psnr = 0.0, mae = 0.0, flip = 0.0, variance = 0.0;
    for (int m = 0; m < r->data.count; m++) {
        const report_picture *p = &e->pictures[m];
        if (!p->done)
            continue;
        done++;
        psnr += p->psnr;
        mae += p->mae;
        flip += p->flip;
        variance += p->psnr_error * p->psnr_error + p->peak_error * p->peak_error;
    }
    double n = done ? (double)done : 1.0;
    e->mean_psnr = psnr / n;
    e->mean_mae = mae / n;
    e->mean_flip = flip / n;
    e->mean_psnr_error = sqrt(variance) / n;
}

hnbrdf_result report_images_entry(report *r, report_entry *e, const hnbrdf_model *model)
{
    hnbrdf_result code = HNBRDF_OK;
    if (!r->images) {
        code = report_images_open(r);
        for (int m = 0; m < r->data.count && code == HNBRDF_OK; m++)
            code = report_images_reference(r, m, r->ggx_model);
    }
    for (int m = 0; m < r->data.count && code == HNBRDF_OK; m++)
        code = report_images_measure(r, m, e, model, NULL);
    return code;
}

void report_images_end(report *r)
{
    report_images *images = r->images;
    if (!images)
        return;
    for (int m = 0; images->references && m < r->data.count; m++)
        report_images_drop_reference(r, m);
    free(images->references);
    free(images->guides);
    hnbrdf_model_free(images->guide_model);
    render_environment_free(&images->environment);
    free(images);
    r->images = NULL;
}
