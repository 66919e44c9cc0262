/* report_images.c: a sphere of every material, beside the errors over directions: SMAPE looks at
 * dark directions, PSNR at highlights. Each sphere is rendered twice, with half of the samples
 * and a seed of its own: what differs between both is noise, and so the error by noise is known. */
#include "cli/report.h"

#include <stdlib.h>
#include <string.h>

struct report_images {
    render_environment environment;
    hnbrdf_model *guide_model;
    /* [materials]: they suit the measurement and GGX, and serve every model, so that all pictures
     * of a material share their random directions */
    render_guide *guides;
    render_image (*references)[2]; /* [materials] */
    picture_progress *progress;    /* or NULL */
};

int report_images_open(report *r)
{
    hnbrdf_error error;
    size_t count = (size_t)r->data.count;
    report_images *images = r->images = calloc(1, sizeof *images);
    if (images) {
        images->guides = calloc(count, sizeof *images->guides);
        images->references = calloc(count, sizeof *images->references);
    }
    if (!images || !images->guides || !images->references)
        return cli_fail("out of memory");
    int code = picture_open_light(&r->light, &images->environment);
    if (code == CLI_OK && render_guide_model(&images->guide_model, &error) != HNBRDF_OK)
        code = cli_fail("%s", error.text);
    return code;
}

void report_images_watch(report *r, picture_progress *progress)
{
    r->images->progress = progress;
}

static int watch(void *progress, double share)
{
    picture_report(progress, share);
    return report_interrupted();
}

/* ---- Rendering ------------------------------------------------------------------------------- */

static int render_twice(const report *r, int m, render_surface *surface, render_image pictures[2])
{
    hnbrdf_error error;
    const report_images *images = r->images;
    render_surface_guide(surface, &images->guides[m]);
    for (int k = 0; k < 2; k++) {
        const render_options options = {.size = (int)r->image_size,
                                        .spp = (int)(r->light.spp + 1) / 2,
                                        .seed = 2 * (uint64_t)r->light.seed + (uint64_t)k,
                                        .threads = (int)r->threads,
                                        .progress = images->progress ? watch : NULL,
                                        .progress_user = images->progress};
        hnbrdf_result result =
            render_sphere(surface, &images->environment, &options, &pictures[k], &error);
        if (result == HNBRDF_ERROR_CANCELLED)
            return cli_fail("%s: interrupted; what is finished is there, --resume goes on",
                            r->directory);
        if (result != HNBRDF_OK)
            return cli_fail("%s: %s", hnbrdf_measured_name(r->data.items[m]), error.text);
        if (images->progress)
            images->progress->first++;
    }
    return CLI_OK;
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

int report_images_reference(report *r, int m, const hnbrdf_model *ggx)
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

int report_images_measure(report *r, int m, report_entry *e, const hnbrdf_model *model,
                          render_image *mean)
{
    hnbrdf_image_error error;
    hnbrdf_image_noise noise;
    render_image pictures[2] = {{0}, {0}};
    render_surface surface = render_surface_model(model, report_material(r, model, m));
    int code = render_twice(r, m, &surface, pictures);
    if (code == CLI_OK)
        code = picture_compare_twice(pictures, r->images->references[m], &error, &noise);
    if (code == CLI_OK)
        e->pictures[m] = (report_picture){1,
                                          error.mae,
                                          error.mse,
                                          fmin(error.psnr, REPORT_PSNR_LIMIT),
                                          noise.psnr_error,
                                          noise.psnr_bias,
                                          noise.peak_error};
    if (code == CLI_OK && mean) {
        average(pictures);
        *mean = pictures[0];
        return code;
    }
    render_image_free(&pictures[0]);
    render_image_free(&pictures[1]);
    return code;
}

void report_images_average(const report *r, report_entry *e)
{
    int done = 0;
    double psnr = 0.0, mae = 0.0, variance = 0.0;
    for (int m = 0; m < r->data.count; m++) {
        const report_picture *p = &e->pictures[m];
        if (!p->done)
            continue;
        done++;
        psnr += p->psnr;
        mae += p->mae;
        variance += p->psnr_error * p->psnr_error + p->peak_error * p->peak_error;
    }
    double n = done ? (double)done : 1.0;
    e->mean_psnr = psnr / n;
    e->mean_mae = mae / n;
    e->mean_psnr_error = sqrt(variance) / n;
}

int report_images_entry(report *r, report_entry *e, const hnbrdf_model *model)
{
    int code = CLI_OK;
    if (e->form == REPORT_GGX) {
        code = report_images_open(r);
        for (int m = 0; m < r->data.count && code == CLI_OK; m++)
            code = report_images_reference(r, m, model);
    }
    for (int m = 0; m < r->data.count && code == CLI_OK; m++)
        code = report_images_measure(r, m, e, model, NULL);
    report_images_average(r, e);
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
