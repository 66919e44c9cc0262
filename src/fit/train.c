/* train.c: the network stage: SOAP on the shared network, Adam on the latent codes, in fixed
 * chunks. */
#include "fit/trainer.h"

#include "base/clock.h"
#include "base/error.h"
#include "fit/adam.h"
#include "fit/ggx.h"
#include "fit/switch.h"

#include <math.h>
#include <string.h>

enum {
    WARM_UP = 100,   /* steps */
    LOG_EVERY = 100, /* steps between entries of a log */
    SHARED_STEPS = 4 /* threads from which on they share a step's layers; fewer lose by meeting */
};
#define LAST_RATE 1e-4 /* schedules that fall end at this share of the peak rate */
#define CHECKPOINT_SECONDS 30.0
#define NETWORK_RATE 2.0 /* of the network's weights, in the rate of the rest */

static float uniform(hnbrdf_rng *rng, double deviation)
{
    return (float)((2.0 * (double)hnbrdf_rng_float(rng) - 1.0) * deviation * 1.7320508);
}

/* He initialisation (2015); the correction starts near exp(-3), the gate near open. */
static void initialise(trainer *t)
{
    const fit_layout *l = &t->layout;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, t->options.seed, UINT64_C(1) << 40);
    float *p = t->parameters;
    size_t n = (size_t)l->padded, h = (size_t)l->hidden_size;
    double deviation = sqrt(2.0 / (FIT_INPUTS + l->latent_size));
    for (size_t i = 0; i < FIT_INPUTS; i++)
        for (size_t u = 0; u < h; u++)
            p[l->first + i * n + u] = uniform(&rng, deviation);
    for (size_t i = 0; i < (size_t)l->latent_size; i++)
        for (size_t u = 0; u < h; u++)
            p[l->latent + i * n + u] = uniform(&rng, deviation);
    for (int k = 1; k < l->layers; k++)
        for (size_t i = 0; i < h; i++)
            for (size_t u = 0; u < h; u++)
                p[l->hidden[k] + i * n + u] = uniform(&rng, sqrt(2.0 / (double)h));
    for (size_t o = 0; o < (size_t)l->outputs; o++) {
        for (size_t u = 0; u < h; u++)
            p[l->last + o * n + u] = uniform(&rng, sqrt(0.5 / (double)h));
        p[l->bias[l->layers] + o] = o < 3 ? -3.0f : 1.5f;
    }
    for (size_t i = 0; i < (size_t)l->materials * (size_t)l->latent_size; i++)
        p[l->codes + i] = uniform(&rng, 0.5);
}

/* ---- Steps ----------------------------------------------------------------------------------- */

/* The analytic parameters after a step: ranges, ties, rotation. */
static void settle_analytic(trainer *t)
{
    for (int m = 0; m < t->count; m++) {
        float *p = t->parameters + t->layout.analytic + (size_t)m * FIT_ANALYTIC;
        /* the encoded directions were turned by it */
        p[FIT_ROTATION] = t->found[m].material.rotation;
        hnbrdf_fit_ggx_project(p, t->known[m].isotropic);
    }
}

static int all_finite(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return 0;
    return 1;
}

static double rate_now(const trainer *t)
{
    double shape = 1.0;
    if (t->options.schedule == HNBRDF_FIT_COSINE)
        shape = 0.5 + 0.5 * cos(3.14159265358979 * t->share);
    else if (t->options.schedule == HNBRDF_FIT_LINEAR)
        shape = 1.0 - t->share;
    return t->peak * (LAST_RATE + (1.0 - LAST_RATE) * shape) *
           fmin(1.0, (double)(t->step - t->since) / WARM_UP);
}

/* How much of the loss is SMAPE now. */
static float mix_now(const trainer *t)
{
    if (t->options.loss == HNBRDF_FIT_LOG_TO_SMAPE)
        return (float)fmin(1.0, fmax(0.0, (t->share - 0.3) / 0.4));
    return t->options.loss == HNBRDF_FIT_SMAPE ? 1.0f : 0.0f;
}

static void step_layer(void *context, int k, int worker)
{
    trainer *t = context;
    (void)worker;
    hnbrdf_fit_soap_step(&t->soap, k, t->parameters, t->gradient, t->moments,
                         t->moments + t->layout.count, t->step - t->since,
                         NETWORK_RATE * rate_now(t));
}

/* One step: of the network, and of what the materials have of their own. It leaves finite numbers:
 * gradients beyond 1e17 or 1e18 are passed over, so that moments are floats. */
static void take_step(trainer *t)
{
    const size_t at = t->layout.network_count;
    const double before = hnbrdf_threads_busy(t->workers);
    if (hnbrdf_threads_count(t->workers) < SHARED_STEPS)
        for (int k = 0; k < t->soap.count; k++)
            step_layer(t, k, 0);
    else
        hnbrdf_threads_run(t->workers, t->soap.count, step_layer, t);
    t->stepping += hnbrdf_threads_busy(t->workers) - before;
    hnbrdf_fit_adam(t->parameters + at, t->gradient + at, t->moments + at,
                    t->moments + t->layout.count + at, hnbrdf_fit_trained(&t->layout) - at,
                    t->step - t->since, rate_now(t));
}

static void advance(trainer *t, double loss)
{
    take_step(t);
    if (t->layout.train_analytic)
        settle_analytic(t);
    t->running = isfinite(t->running) ? 0.98 * t->running + 0.02 * loss : loss;
    if (!isfinite(loss) || !all_finite(t->parameters, hnbrdf_fit_trained(&t->layout)))
        hnbrdf_fit_set_back(t);
    else
        hnbrdf_fit_judge(t);
}

static hnbrdf_result start(trainer *t, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    t->peak = (double)t->options.learning_rate;
    t->running = NAN;
    initialise(t);
    if (hnbrdf_fit_switch_fits(&t->layout))
        hnbrdf_fit_switch_reserve(&t->layout, t->parameters);
    result = hnbrdf_fit_supply_make(t, error);
    if (result)
        return result;
    hnbrdf_fit_judge_start(t);
    if (t->options.resume)
        result = hnbrdf_fit_checkpoint_load(t, error);
    hnbrdf_fit_supply_restart(t);
    return result;
}

double hnbrdf_fit_pair_flops(const fit_layout *l)
{
    double h = l->hidden_size, hidden = (l->layers - 1) * h * h;
    double forward = FIT_INPUTS * h + hidden + h * l->outputs;
    double backward = FIT_INPUTS * h + 2.0 * hidden + 2.0 * h * l->outputs;
    return 2.0 * (forward + backward);
}

/* By steps, or by the time that is over since this call began, at this share. */
static void see_share(trainer *t, double share_before)
{
    const double elapsed = hnbrdf_fit_is_alone(t) ? hnbrdf_fit_stage_seconds(t) : t->elapsed;
    t->share = t->options.seconds > 0.0 ? share_before + elapsed / t->options.seconds
                                        : (double)t->step / (double)t->options.steps;
}

/* By rank 0; the others hear of a failure with the next step. */
static void save(trainer *t, double *saved, hnbrdf_error *error)
{
    const double now = hnbrdf_seconds();
    if (t->ranks.rank > 0 || !t->options.checkpoint || t->share >= 1.0 ||
        !(t->stopped || now - *saved > CHECKPOINT_SECONDS))
        return;
    t->trouble = hnbrdf_fit_checkpoint_save(t, error);
    *saved = now;
}

/* What is left to save when a rank is lost: the state before the step that failed. */
static hnbrdf_result fail_lost(trainer *t, hnbrdf_error *error)
{
    if (t->ranks.rank == 0 && t->options.checkpoint && t->step > 0 &&
        hnbrdf_fit_checkpoint_save(t, error) == HNBRDF_OK)
        return hnbrdf_fail(error, HNBRDF_ERROR_IO,
                           "another of %d ranks has ended or cannot be reached; %s holds the %ld "
                           "steps that were made",
                           t->ranks.size, t->options.checkpoint, t->step);
    return hnbrdf_fit_fail_lost(t, error);
}

/* Steps until the end, or until one is not made. */
static hnbrdf_result run_steps(trainer *t, double *pairs, hnbrdf_error *error)
{
    const double share_before = t->share, each = (double)t->shares.tiles * FIT_TILE;
    double saved = hnbrdf_seconds();
    while (t->share < 1.0 && !t->stopped && !t->trouble && !t->troubled) {
        t->mix = mix_now(t);
        double loss = hnbrdf_fit_supply_step(t) ? hnbrdf_fit_step_gradient(t) : 0.0;
        if (t->lost)
            return fail_lost(t, error);
        hnbrdf_fit_schedule_step(&t->schedule, t->shares.tiles, NULL, NULL);
        t->step++;
        *pairs += each;
        advance(t, loss);
        if (t->lost) /* in the middle of a judgement: an earlier checkpoint is better */
            return hnbrdf_fit_fail_lost(t, error);
        see_share(t, share_before);
        hnbrdf_fit_tell(t, "network", fmin(t->share, 1.0), t->running, *pairs,
                        t->step % LOG_EVERY == 0);
        save(t, &saved, error);
    }
    return hnbrdf_fit_agree(t, t->trouble, error);
}

hnbrdf_result hnbrdf_fit_train(trainer *t, hnbrdf_fit_report *report, hnbrdf_error *error)
{
    const double busy_before = hnbrdf_threads_busy(t->workers), exchange_before = t->exchange;
    const double alone_before = hnbrdf_thread_seconds() - hnbrdf_threads_busy_here(t->workers);
    hnbrdf_result result = start(t, error);
    if (result)
        return result;
    hnbrdf_fit_stage_begin(t);
    double pairs = 0.0;
    if ((result = run_steps(t, &pairs, error)))
        return result;
    double elapsed = hnbrdf_fit_stage_seconds(t);
    hnbrdf_fit_judge_end(t, report);
    if (hnbrdf_fit_switch_fits(&t->layout))
        hnbrdf_fit_switch_install(&t->layout, t->parameters);
    if (t->lost)
        return hnbrdf_fit_fail_lost(t, error);
    report->pairs_per_s = elapsed > 0.0 ? pairs / elapsed : 0.0;
    report->steps = t->step;
    report->pairs = pairs;
    report->flops = pairs * hnbrdf_fit_pair_flops(&t->layout);
    report->times.drawing += t->redrawing;
    report->times.network =
        hnbrdf_threads_busy(t->workers) - busy_before - t->redrawing - t->stepping;
    /* of this thread; it waits for others awake */
    report->times.update =
        t->stepping + fmax(0.0, hnbrdf_thread_seconds() - hnbrdf_threads_busy_here(t->workers) -
                                    alone_before - (t->exchange - exchange_before));
    return HNBRDF_OK;
}
