/* quality.c: the errors that stand beside the run times: SMAPE of values, PSNR of rendered
 * spheres. */
#include "base/error.h"
#include "base/threads.h"
#include "bench/baselines.h"
#include "hnbrdf/metrics.h"
#include "image/difference.h"
#include "render/render.h"
#ifdef HNBRDF_WITH_VULKAN
#include "check/half.h"
#endif

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char MEASURING[] = "measuring errors";

/* A model that is measured, and where its means go. */
typedef struct subject {
    const hnbrdf_model *model;
    hnbrdf_model *owned;     /* peers are made for this */
    int half;                /* 1: its network in half precision, as shaders have it */
    bench_baseline baseline; /* where model is NULL */
    double *smape, *psnr;    /* psnr NULL: no picture is made of it */
} subject;

typedef struct quality {
    const bench *b;
    hnbrdf_measured *const *data;
    int data_count;
    subject subjects[3 * BENCH_MODELS + BENCH_BASELINES];
    int count;
    double *smape, *psnr; /* [subjects][materials]; NaN where a model has no such material */
    render_environment environment;
    hnbrdf_model *guide;
    bench_stand_in stand_ins[BENCH_BASELINES]; /* of the material at hand */
} quality;

/* ---- Half precision, as the exported shaders compute where + and * round correctly ----------- */

#ifdef HNBRDF_WITH_VULKAN
static const int has_half = 1;
#define EVAL_HALF check_half_eval
#else
static const int has_half = 0;
#define EVAL_HALF hnbrdf_eval
#endif

static const uint64_t compare_sequence = 0x636f6d70617265u; /* of hnbrdf_compare() */

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
    hnbrdf_rng_seed(&rng, 1, compare_sequence);
    for (long draws = 0; valid < HALF_PAIRS && draws < 1000L * HALF_PAIRS; draws++) {
        float wi[3], wo[3], half[3], f[3], reference[3];
        hnbrdf_sampler_draw(q->b->sampler, &rng, wi, wo);
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

/* SMAPE of a baseline on the pairs of hnbrdf_compare(); where it has no value it is black. */
static double smape_of(const quality *q, const hnbrdf_measured *baseline,
                       const hnbrdf_measured *measured)
{
    double sum = 0.0;
    long valid = 0;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, compare_sequence);
    for (long draws = 0; valid < q->b->pairs && draws < 1000L * q->b->pairs; draws++) {
        float wi[3], wo[3], f[3], reference[3];
        hnbrdf_sampler_draw(q->b->sampler, &rng, wi, wo);
        if (!hnbrdf_measured_eval(measured, wi, wo, reference))
            continue;
        hnbrdf_measured_eval(baseline, wi, wo, f);
        for (int c = 0; c < 3; c++)
            sum += hnbrdf_smape((double)f[c], (double)reference[c]);
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
        add_subject(q, &(subject){m->model, NULL, 0, BENCH_BASELINES, &m->smape, &m->psnr});
        if (has_half && m->desc.kind != HNBRDF_KIND_GGX)
            add_subject(q, &(subject){m->model, NULL, 1, BENCH_BASELINES, &m->half_smape, NULL});
        if (peer)
            add_subject(q,
                        &(subject){peer, peer, 0, BENCH_BASELINES, &m->peer_smape, &m->peer_psnr});
    }
    for (bench_baseline k = BENCH_MEASUREMENT; k < BENCH_BASELINES; k++) {
        bench_model *m = &b->baselines[k];
        if (m->is_baseline)
            add_subject(q, &(subject){NULL, NULL, 0, k, &m->smape, &m->psnr});
    }
}

/* The subject's material of this measurement; NULL: it has none. */
static const hnbrdf_material *material_of(const quality *q, int s, int m)
{
    const hnbrdf_model *model = q->subjects[s].model;
    if (!model)
        return NULL;
    return hnbrdf_model_material(model, hnbrdf_model_find(model, hnbrdf_measured_name(q->data[m])));
}

/* ---- SMAPE ----------------------------------------------------------------------------------- */

static void compare_one(void *context, int index, int worker)
{
    quality *q = context;
    int s = index / q->data_count, m = index % q->data_count;
    const hnbrdf_material *material = material_of(q, s, m);
    hnbrdf_comparison error;
    (void)worker;
    if (material && hnbrdf_compare(q->subjects[s].model, material, q->data[m], q->b->sampler,
                                   (size_t)q->b->pairs, 1, &error, NULL) == HNBRDF_OK)
        q->smape[index] =
            error.smape + (q->subjects[s].half
                               ? smape_added_by_half(q, q->subjects[s].model, material, q->data[m])
                               : 0.0);
}

static hnbrdf_result measure_smape(quality *q, hnbrdf_error *error)
{
    hnbrdf_threads *threads = hnbrdf_threads_start(0);
    if (!threads)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int s = 0; s < q->count; s++)
        for (int m = 0; m < q->data_count; m++)
            q->smape[s * q->data_count + m] = (double)NAN;
    hnbrdf_threads_run(threads, q->count * q->data_count, compare_one, q);
    hnbrdf_threads_stop(threads);
    return HNBRDF_OK;
}

/* ---- PSNR ------------------------------------------------------------------------------------ */

static hnbrdf_result render(const quality *q, const render_surface *surface, render_image *image,
                            hnbrdf_error *error)
{
    const render_options options = {.size = (int)q->b->size, .spp = (int)q->b->spp, .seed = 1};
    return render_sphere(surface, &q->environment, &options, image, error);
}

/* The pixels of `image` that render_covered() counts, one after the other; returns how many. */
static size_t pack(const render_image *image, const render_image *a, const render_image *b,
                   float *out)
{
    size_t pixels = (size_t)image->width * (size_t)image->height, count = 0;
    for (size_t i = 0; i < pixels; i++)
        if (render_covered(a, b, i))
            memcpy(out + 3 * count++, image->rgb + 3 * i, 3 * sizeof(float));
    return count;
}

static hnbrdf_result compare_images(const render_image *image, const render_image *reference,
                                    double *psnr, hnbrdf_error *error)
{
    hnbrdf_image_error difference;
    size_t values = 3 * (size_t)image->width * (size_t)image->height;
    float *packed = malloc(2 * values * sizeof *packed);
    if (!packed)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    size_t pixels = pack(image, image, reference, packed);
    pack(reference, image, reference, packed + values);
    hnbrdf_image_compare(packed, packed + values, 3 * pixels, &difference);
    *psnr = difference.psnr;
    free(packed);
    return HNBRDF_OK;
}

/* The PSNR of a surface's sphere. */
static hnbrdf_result measure_sphere(const quality *q, const render_surface *surface,
                                    const render_image *reference, double *psnr,
                                    hnbrdf_error *error)
{
    render_image image = {0};
    hnbrdf_result result = render(q, surface, &image, error);
    if (!result)
        result = compare_images(&image, reference, psnr, error);
    render_image_free(&image);
    return result;
}

/* The surface of a subject that is drawn. Returns 0 where it is not. */
static int surface_of(const quality *q, int s, int m, render_surface *surface)
{
    const subject *of = &q->subjects[s];
    const hnbrdf_material *material = material_of(q, s, m);
    if (!of->model && q->stand_ins[of->baseline].measured)
        *surface = render_surface_measured(q->stand_ins[of->baseline].measured);
    else if (material && of->psnr)
        *surface = render_surface_model(of->model, material);
    else
        return 0;
    return 1;
}

/* Spheres of one material: the measurement, then every subject, along the same random directions.
 * */
static hnbrdf_result compare_spheres(quality *q, int m, render_surface *surfaces,
                                     const render_surface **all, hnbrdf_error *error)
{
    int count = 0;
    render_image reference = {0};
    memset(surfaces, 0, ((size_t)q->count + 1) * sizeof *surfaces);
    surfaces[0] = render_surface_measured(q->data[m]);
    all[count++] = &surfaces[0];
    for (int s = 0; s < q->count; s++)
        if (surface_of(q, s, m, &surfaces[s + 1]))
            all[count++] = &surfaces[s + 1];
    render_guide guide = render_guide_fit(all, count, q->guide);
    for (int s = 0; s <= q->count; s++)
        if (surfaces[s].eval)
            render_surface_guide(&surfaces[s], &guide);
    hnbrdf_result result = render(q, &surfaces[0], &reference, error);
    for (int s = 0; s < q->count && !result; s++) {
        double *psnr = &q->psnr[s * q->data_count + m];
        *psnr = (double)NAN;
        if (surfaces[s + 1].eval)
            result = measure_sphere(q, &surfaces[s + 1], &reference, psnr, error);
        if (!result)
            result = bench_show(&q->b->watch, MEASURING, (m + (s + 1.0) / q->count) / q->data_count,
                                hnbrdf_measured_name(q->data[m]), error);
    }
    render_image_free(&reference);
    return result;
}

typedef struct opening {
    quality *q;
    int material;
    hnbrdf_result result[BENCH_BASELINES];
    hnbrdf_error error[BENCH_BASELINES];
} opening;

/* Makes a baseline of the material at hand, and measures it. */
static void open_one(void *context, int index, int worker)
{
    opening *o = context;
    quality *q = o->q;
    const int m = o->material;
    (void)worker;
    for (int s = 0; s < q->count; s++) {
        if (q->subjects[s].model || (int)q->subjects[s].baseline != index)
            continue;
        o->result[index] = bench_stand_in_open(q->b, q->subjects[s].baseline, q->data[m],
                                               &q->stand_ins[index], &o->error[index]);
        if (q->stand_ins[index].measured)
            q->smape[s * q->data_count + m] = smape_of(q, q->stand_ins[index].measured, q->data[m]);
    }
}

static hnbrdf_result open_stand_ins(quality *q, int m, hnbrdf_error *error)
{
    opening o = {.q = q, .material = m};
    hnbrdf_result result = bench_show(&q->b->watch, MEASURING, (double)m / q->data_count,
                                      hnbrdf_measured_name(q->data[m]), error);
    hnbrdf_threads *threads = result ? NULL : hnbrdf_threads_start(0);
    if (!result && !threads)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    if (!result)
        hnbrdf_threads_run(threads, BENCH_BASELINES, open_one, &o);
    hnbrdf_threads_stop(threads);
    for (int k = 0; k < BENCH_BASELINES && !result; k++)
        if (o.result[k])
            result = hnbrdf_fail(error, o.result[k], "%s", o.error[k].text);
    return result;
}

static void close_stand_ins(quality *q)
{
    for (int k = 0; k < BENCH_BASELINES; k++)
        bench_stand_in_close(&q->stand_ins[k]);
}

static hnbrdf_result measure_psnr(quality *q, hnbrdf_error *error)
{
    hnbrdf_result result = render_environment_open("sky", 0.0, NULL, &q->environment, error);
    if (!result)
        result = render_guide_model(&q->guide, error);
    if (result)
        return result;
    render_surface *surfaces = calloc((size_t)q->count + 1, sizeof *surfaces);
    const render_surface **all = calloc((size_t)q->count + 1, sizeof *all);
    if (!surfaces || !all)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int m = 0; m < q->data_count && !result; m++) {
        result = open_stand_ins(q, m, error);
        if (!result)
            result = compare_spheres(q, m, surfaces, all, error);
        close_stand_ins(q);
    }
    free(surfaces);
    free(all);
    return result;
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

hnbrdf_result bench_measure_quality(bench *b, hnbrdf_measured *const *data, int count, int peers,
                                    hnbrdf_error *error)
{
    quality q = {.b = b, .data = data, .data_count = count};
    b->data = data;
    b->data_count = count;
    choose_subjects(&q, b, peers);
    size_t items = (size_t)q.count * (size_t)count;
    q.smape = malloc(items * sizeof *q.smape);
    q.psnr = malloc(items * sizeof *q.psnr);
    hnbrdf_result result = bench_show(&b->watch, MEASURING, 0.0, NULL, error);
    if (!q.smape || !q.psnr)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    if (!result)
        result = measure_smape(&q, error);
    if (!result)
        result = measure_psnr(&q, error);
    for (int s = 0; s < q.count; s++) {
        if (!result) {
            *q.subjects[s].smape = mean(q.smape + s * count, count);
            if (q.subjects[s].psnr)
                *q.subjects[s].psnr = mean(q.psnr + s * count, count);
        }
        hnbrdf_model_free(q.subjects[s].owned);
    }
    render_environment_free(&q.environment);
    hnbrdf_model_free(q.guide);
    free(q.smape);
    free(q.psnr);
    return result;
}
