/* bench_quality.c: the errors that stand beside the run times: SMAPE of values, PSNR of rendered
 * spheres. */
#include "cli/bench.h"
#include "cli/picture.h"
#include "base/threads.h"
#include "hnbrdf/metrics.h"
#ifdef HNBRDF_WITH_VULKAN
#include "check/half.h"
#endif

#include <math.h>
#include <stdlib.h>

/* A model that is measured, and where its means go. */
typedef struct subject {
    const hnbrdf_model *model;
    hnbrdf_model *owned;  /* peers are made for this */
    int half;             /* 1: its network in half precision, as shaders have it */
    double *smape, *psnr; /* psnr NULL: no picture is made of it */
} subject;

typedef struct quality {
    const bench *b;
    const cli_data *data;
    subject subjects[3 * BENCH_MODELS];
    int count;
    double *smape, *psnr; /* [subjects][materials]; NaN where a model has no such material */
    render_environment environment;
    hnbrdf_model *guide;
    cli_progress line;
} quality;

/* ---- Half precision, as the exported shaders compute where + and * round correctly ----------- */

#ifdef HNBRDF_WITH_VULKAN
static const int has_half = 1;
#define EVAL_HALF check_half_eval
#else
static const int has_half = 0;
#define EVAL_HALF hnbrdf_eval
#endif

/* What half precision adds to the SMAPE of a material: the difference on the first pairs of
 * hnbrdf_compare(), few of them because the emulation is slow (a millisecond at 64x3) and the
 * difference varies little. NaN without a valid pair. */
static double smape_added_by_half(const quality *q, const hnbrdf_model *model,
                                  const hnbrdf_material *material, const hnbrdf_measured *measured)
{
    enum { HALF_PAIRS = 1000 };
    double sum = 0.0;
    long valid = 0;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0x636f6d70617265u); /* its sequence */
    for (long draws = 0; valid < HALF_PAIRS && draws < 1000L * HALF_PAIRS; draws++) {
        float wi[3], wo[3], half[3], f[3], reference[3];
        hnbrdf_sampler_draw((hnbrdf_sampler)q->b->sampler, &rng, wi, wo);
        if (!hnbrdf_measured_eval(measured, wi, wo, reference))
            continue;
        EVAL_HALF(model, material, wi, wo, half);
        hnbrdf_eval(model, material, wi, wo, f);
        for (int c = 0; c < 3; c++)
            sum += hnbrdf_smape((double)half[c], (double)reference[c]) -
                   hnbrdf_smape((double)f[c], (double)reference[c]);
        valid++;
    }
    return valid ? sum / (3.0 * (double)valid) : (double)NAN;
}

/* ---- Who is measured ------------------------------------------------------------------------- */

static void add_subject(quality *q, const subject *s)
{
    q->subjects[q->count++] = *s;
}

static void choose_subjects(quality *q, bench *b, int peers)
{
    for (int k = 0; k < b->model_count; k++) {
        bench_model *m = &b->models[k];
        int has_peer = m->desc.kind == HNBRDF_KIND_HYBRID && m->desc.hidden % 4 == 0 &&
                       m->desc.encoding == HNBRDF_ENCODING_DIRECTIONS;
        hnbrdf_model *peer = peers && has_peer ? bench_peer_model(&m->desc) : NULL;
        add_subject(q, &(subject){m->model, NULL, 0, &m->smape, &m->psnr});
        if (has_half && m->desc.kind != HNBRDF_KIND_GGX)
            add_subject(q, &(subject){m->model, NULL, 1, &m->half_smape, NULL});
        if (peer)
            add_subject(q, &(subject){peer, peer, 0, &m->peer_smape, &m->peer_psnr});
    }
}

/* The subject's material of this measurement; NULL: it has none. */
static const hnbrdf_material *material_of(const quality *q, int s, int m)
{
    const hnbrdf_model *model = q->subjects[s].model;
    return hnbrdf_model_material(model,
                                 hnbrdf_model_find(model, hnbrdf_measured_name(q->data->items[m])));
}

/* ---- SMAPE ----------------------------------------------------------------------------------- */

static void compare_one(void *context, int index, int worker)
{
    quality *q = context;
    int s = index / q->data->count, m = index % q->data->count;
    const hnbrdf_material *material = material_of(q, s, m);
    hnbrdf_comparison error;
    (void)worker;
    if (material && hnbrdf_compare(q->subjects[s].model, material, q->data->items[m],
                                   (hnbrdf_sampler)q->b->sampler, (size_t)q->b->pairs, 1, &error,
                                   NULL) == HNBRDF_OK)
        q->smape[index] =
            error.smape + (q->subjects[s].half ? smape_added_by_half(q, q->subjects[s].model,
                                                                     material, q->data->items[m])
                                               : 0.0);
}

static int measure_smape(quality *q)
{
    hnbrdf_threads *workers = hnbrdf_threads_start(0);
    if (!workers)
        return cli_fail("out of memory");
    for (int s = 0; s < q->count; s++)
        for (int m = 0; m < q->data->count; m++)
            q->smape[s * q->data->count + m] = (double)NAN;
    hnbrdf_threads_run(workers, q->count * q->data->count, compare_one, q);
    hnbrdf_threads_stop(workers);
    return CLI_OK;
}

/* ---- PSNR ------------------------------------------------------------------------------------ */

static int render(quality *q, const render_surface *surface, render_image *image)
{
    hnbrdf_error error;
    const render_options options = {.size = (int)q->b->size, .spp = (int)q->b->spp, .seed = 1};
    if (render_sphere(surface, &q->environment, &options, image, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    return CLI_OK;
}

/* Spheres of one material: the measurement, then every subject, along the same random directions.
 * */
static int compare_spheres(quality *q, int m, render_surface *surfaces, const render_surface **all)
{
    int count = 0;
    render_image reference = {0};
    surfaces[0] = render_surface_measured(q->data->items[m]);
    all[count++] = &surfaces[0];
    for (int s = 0; s < q->count; s++)
        if (material_of(q, s, m) && q->subjects[s].psnr) {
            surfaces[s + 1] = render_surface_model(q->subjects[s].model, material_of(q, s, m));
            all[count++] = &surfaces[s + 1];
        }
    render_guide guide = render_guide_fit(all, count, q->guide);
    for (int s = 0; s <= q->count; s++)
        render_surface_guide(&surfaces[s], &guide);
    int code = render(q, &surfaces[0], &reference);
    for (int s = 0; s < q->count && code == CLI_OK; s++) {
        render_image image = {0};
        hnbrdf_image_error error = {.psnr = (double)NAN};
        if (material_of(q, s, m) && q->subjects[s].psnr &&
            (code = render(q, &surfaces[s + 1], &image)) == CLI_OK)
            code = picture_compare(&image, &reference, &error);
        q->psnr[s * q->data->count + m] = error.psnr;
        render_image_free(&image);
        cli_progress_update(&q->line, (m + (s + 1.0) / q->count) / q->data->count,
                            hnbrdf_measured_name(q->data->items[m]));
    }
    render_image_free(&reference);
    return code;
}

static int measure_psnr(quality *q)
{
    picture_options light = PICTURE_DEFAULTS(0);
    hnbrdf_error error;
    if (picture_open_light(&light, &q->environment) != CLI_OK)
        return CLI_FAILURE;
    if (render_guide_model(&q->guide, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    render_surface *surfaces = calloc((size_t)q->count + 1, sizeof *surfaces);
    const render_surface **all = calloc((size_t)q->count + 1, sizeof *all);
    int code = surfaces && all ? CLI_OK : cli_fail("out of memory");
    for (int m = 0; m < q->data->count && code == CLI_OK; m++)
        code = compare_spheres(q, m, surfaces, all);
    free(surfaces);
    free(all);
    return code;
}

/* ---- Both ------------------------------------------------------------------------------------ */

/* Over the materials that have a value; NaN without any. */
static double mean(const double *values, int count)
{
    double sum = 0.0;
    int known = 0;
    for (int k = 0; k < count; k++)
        if (!isnan(values[k])) {
            sum += values[k];
            known++;
        }
    return known ? sum / known : (double)NAN;
}

int bench_measure_quality(bench *b, const cli_data *data, int peers)
{
    quality q = {.b = b, .data = data};
    choose_subjects(&q, b, peers);
    size_t items = (size_t)q.count * (size_t)data->count;
    q.smape = malloc(items * sizeof *q.smape);
    q.psnr = malloc(items * sizeof *q.psnr);
    int code = q.smape && q.psnr ? CLI_OK : cli_fail("out of memory");
    cli_progress_begin(&q.line, "measuring errors");
    if (code == CLI_OK)
        code = measure_smape(&q);
    if (code == CLI_OK)
        code = measure_psnr(&q);
    cli_progress_end(&q.line);
    for (int s = 0; s < q.count; s++) {
        if (code == CLI_OK) {
            *q.subjects[s].smape = mean(q.smape + s * data->count, data->count);
            if (q.subjects[s].psnr)
                *q.subjects[s].psnr = mean(q.psnr + s * data->count, data->count);
        }
        hnbrdf_model_free(q.subjects[s].owned);
    }
    render_environment_free(&q.environment);
    hnbrdf_model_free(q.guide);
    free(q.smape);
    free(q.psnr);
    return code;
}
