/* frozen.c: the network stage of a fit on a network that stays: starts, phases, and what comes of
 * them. */
#include "fit/frozen.h"

#include "base/clock.h"
#include "base/error.h"
#include "fit/switch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_TILES = 8 }; /* that starts are chosen by */
#define NO_WORSE 0.95     /* in pictures than GGX alone, by the pixels seen here */
#define CHECKPOINT_SECONDS 30.0

/* ---- The network ----------------------------------------------------------------------------- */

/* The weights of options.freeze into the flat array. */
static void take_network(trainer *t)
{
    const fit_layout *l = &t->layout;
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(t->options.freeze, &desc);
    float *p = t->parameters;
    for (int k = 0; k <= l->layers; k++) {
        int rows, columns;
        hnbrdf_fit_layer_size(l, k, &rows, &columns);
        const float *w = desc.weights[k];
        for (int o = 0; o < rows; o++) {
            for (int i = 0; i < columns; i++)
                p[hnbrdf_fit_weight_at(l, k, o, i)] = *w++;
            p[l->bias[k] + (size_t)o] = desc.biases[k][o];
        }
    }
    t->frozen->most = hnbrdf_fit_switch_most(&desc);
    t->kernel->derive(l, p, t->derived);
    t->kernel->own_rows(l, p, t->frozen->rows);
}

/* ---- Starts ---------------------------------------------------------------------------------- */

/* Of the codes seen so far the best, best first. */
typedef struct ranking {
    int count;
    double loss[FIT_STARTS];
    float code[FIT_STARTS][FIT_LANES];
} ranking;

static void rank(ranking *r, double loss, const float *code)
{
    int i = r->count;
    while (i > 0 && loss < r->loss[i - 1])
        i--;
    if (i == FIT_STARTS || !isfinite(loss))
        return;
    const int moved = (r->count < FIT_STARTS ? r->count : FIT_STARTS - 1) - i;
    memmove(r->loss + i + 1, r->loss + i, (size_t)moved * sizeof r->loss[0]);
    memmove(r->code + i + 1, r->code + i, (size_t)moved * sizeof r->code[0]);
    r->loss[i] = loss;
    memcpy(r->code[i], code, sizeof r->code[i]);
    r->count += r->count < FIT_STARTS;
}

/* The codes of the known materials, and their mean, by their loss. One that turns the network off
 * leads nowhere: its derivative is 0. */
static void rank_codes(trainer *t, const float *const *tiles, int count, float *scratch,
                       ranking *best)
{
    const int latent = t->layout.latent_size;
    float code[FIT_OWN] = {0};
    double mean[FIT_LANES] = {0.0};
    int seen = 0;
    hnbrdf_model_desc network;
    hnbrdf_model_describe(t->options.freeze, &network);
    for (int i = 0; i < network.material_count; i++) {
        memcpy(code, network.materials[i].latent, sizeof(float) * (size_t)latent);
        if (hnbrdf_fit_switch_is_on(&network, code))
            continue;
        for (int j = 0; j < latent; j++)
            mean[j] += (double)code[j];
        seen++;
        rank(best, hnbrdf_fit_loss_of(t, code, tiles, count, scratch), code);
    }
    for (int j = 0; j < latent; j++)
        code[j] = seen > 0 ? (float)(mean[j] / seen) : 0.0f;
    rank(best, hnbrdf_fit_loss_of(t, code, tiles, count, scratch), code);
    if (best->count == 0) { /* nothing is finite */
        memcpy(best->code[0], code, sizeof best->code[0]);
        best->count = 1;
    }
}

static void start_one(void *context, int k, int worker)
{
    trainer *t = context;
    const int m = t->held[k], count = t->pool.tiles < FIRST_TILES ? t->pool.tiles : FIRST_TILES;
    float room[FIRST_TILES][FIT_POOL_TILE], own[FIT_OWN] = {0};
    const float *tiles[FIRST_TILES];
    ranking best = {0};
    for (int i = 0; i < count; i++)
        tiles[i] = hnbrdf_fit_pool_fetch(&t->pool, k, i, room[i]);
    rank_codes(t, tiles, count, t->scratch + (size_t)worker * t->layout.scratch_count, &best);
    fit_searches *s = &t->frozen->of[m];
    s->count = best.count;
    memcpy(own + FIT_LANES, t->found[m].parameters, sizeof t->found[m].parameters);
    for (int i = 0; i < best.count; i++) {
        memcpy(own, best.code[i], sizeof best.code[i]);
        hnbrdf_fit_point_start(&s->point[i], own);
    }
    if (t->layout.kind == HNBRDF_KIND_HYBRID)
        t->frozen->views[k].failed = !hnbrdf_fit_views_make(&t->frozen->views[k], &t->pool, k);
}

/* ---- Phases ---------------------------------------------------------------------------------- */

static int phase_of(double share)
{
    int phase = 0;
    while (phase < FIT_PHASES - 1 && share >= hnbrdf_fit_phases[phase].until)
        phase++;
    return phase;
}

/* The best `count` searches, best first; the number of those that there are. */
static int sort_best(fit_searches *s, int count)
{
    int sorted = 0;
    for (; sorted < count && sorted < s->count; sorted++) {
        int best = sorted;
        for (int i = sorted + 1; i < s->count; i++)
            if (s->point[i].normal.loss < s->point[best].normal.loss)
                best = i;
        const fit_point moved = s->point[best];
        s->point[best] = s->point[sorted];
        s->point[sorted] = moved;
    }
    return sorted;
}

/* A material's best searches go on; in the last phase the best one does, pulled differently. */
static void enter(fit_searches *s, int phase)
{
    const int last = phase == FIT_PHASES - 1;
    s->count = sort_best(s, last ? 1 : hnbrdf_fit_phases[phase].searches);
    for (int i = 1; i < FIT_PULLS && last; i++)
        s->point[i] = s->point[0];
    s->count = last ? FIT_PULLS : s->count;
    s->phase = phase;
    for (int i = 0; i < s->count; i++) {
        s->point[i].pull = hnbrdf_fit_phases[phase].pulls[i % FIT_PULLS];
        hnbrdf_fit_point_renew(&s->point[i]);
    }
}

static void enter_phase(trainer *t, int phase)
{
    for (int k = 0; k < t->held_count && phase != t->frozen->phase; k++)
        enter(&t->frozen->of[t->held[k]], phase);
    t->frozen->phase = phase;
}

/* ---- What comes of it ------------------------------------------------------------------------ */

static double worst_of(const fit_point *p)
{
    double worst = 0.0;
    for (int k = 0; k < FIT_LIGHTS; k++)
        worst = fmax(worst, p->normal.worth[k]);
    return worst;
}

/* Of the searches that make no picture worse the one with the least loss of pairs; where there is
 * none, the one whose worst picture is best. */
static const fit_point *chosen_of(const fit_searches *s)
{
    const fit_point *best = &s->point[0];
    for (int i = 1; i < s->count; i++) {
        const fit_point *p = &s->point[i];
        const int good = worst_of(p) <= NO_WORSE, best_good = worst_of(best) <= NO_WORSE;
        if (good && best_good ? p->normal.pairs < best->normal.pairs
                              : good || (!best_good && worst_of(p) < worst_of(best)))
            best = p;
    }
    return best;
}

/* Of one material, by its rank. */
typedef struct outcome {
    double loss, pairs;
    float own[FIT_OWN];
} outcome;

/* Codes and analytic parts of all materials to where they are wanted; the mean loss. */
static hnbrdf_result spread(trainer *t, double *pairs, hnbrdf_error *error)
{
    const fit_layout *l = &t->layout;
    const size_t latent = (size_t)l->latent_size;
    outcome *all = calloc((size_t)t->count, sizeof *all);
    hnbrdf_result result =
        all ? HNBRDF_OK
            : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for %d materials", t->count);
    result = hnbrdf_fit_agree(t, result, error);
    for (int k = 0; k < t->held_count && !result; k++) {
        const fit_point *p = chosen_of(&t->frozen->of[t->held[k]]);
        outcome *o = &all[t->held[k]];
        o->loss = p->normal.pairs;
        o->pairs = k == 0 ? t->frozen->pairs : 0.0;
        memcpy(o->own, p->at, sizeof o->own);
    }
    if (!result)
        result = hnbrdf_fit_share_records(t, all, sizeof *all, error);
    t->running = *pairs = 0.0;
    for (int m = 0; m < t->count && !result; m++) {
        memcpy(t->parameters + l->codes + (size_t)m * latent, all[m].own, sizeof(float) * latent);
        memcpy(t->parameters + l->analytic + (size_t)m * FIT_ANALYTIC, all[m].own + FIT_LANES,
               sizeof(float) * FIT_ANALYTIC);
        t->running += all[m].loss / t->count;
        *pairs += all[m].pairs;
    }
    free(all);
    return result;
}

/* ---- Steps ----------------------------------------------------------------------------------- */

/* Of this rank's materials, for the progress. */
static double loss_now(const trainer *t)
{
    double sum = 0.0;
    for (int k = 0; k < t->held_count; k++)
        sum += chosen_of(&t->frozen->of[t->held[k]])->normal.pairs;
    return t->held_count > 0 ? sum / t->held_count : NAN;
}

/* By steps, or by the time that is over since this call began, by the clock of rank 0. */
static int see_share(trainer *t, double share_before)
{
    t->elapsed = hnbrdf_fit_stage_seconds(t);
    if (t->options.seconds > 0.0 && !hnbrdf_fit_broadcast(t, &t->elapsed, sizeof t->elapsed))
        return 0;
    t->share = t->options.seconds > 0.0 ? share_before + t->elapsed / t->options.seconds
                                        : (double)t->step / (double)t->options.steps;
    return 1;
}

/* All ranks hear whether to stop and whether rank 0 is about to write a checkpoint, which holds the
 * searches of all. */
static hnbrdf_result hear(trainer *t, double *saved, hnbrdf_error *error)
{
    enum { STOP = 1, SAVE = 2 };
    const double now = hnbrdf_seconds(), before = t->exchange;
    const int due = t->ranks.rank == 0 && now - *saved > CHECKPOINT_SECONDS;
    int flags = (t->asked ? STOP : 0) | (due ? SAVE : 0);
    hnbrdf_result result = hnbrdf_ranks_agree(&t->ranks, t->trouble, &flags, error);
    t->exchange = hnbrdf_fit_is_alone(t) ? before : before + hnbrdf_seconds() - now;
    t->stopped |= (flags & STOP) != 0;
    if (result || !t->options.checkpoint || t->share >= 1.0 || !(t->stopped || flags & SAVE))
        return result;
    result = hnbrdf_fit_share_records(t, t->frozen->of, sizeof *t->frozen->of, error);
    if (!result && t->ranks.rank == 0) {
        t->trouble = hnbrdf_fit_checkpoint_save(t, error);
        *saved = now;
    }
    return hnbrdf_fit_agree(t, result ? result : t->trouble, error);
}

static hnbrdf_result run_steps(trainer *t, hnbrdf_error *error)
{
    const double share_before = t->share, pairs_before = t->frozen->pairs;
    double saved = hnbrdf_seconds();
    hnbrdf_result result = HNBRDF_OK;
    while (t->share < 1.0 && !t->stopped && !result) {
        enter_phase(t, phase_of(t->share));
        hnbrdf_fit_look(t);
        t->step++;
        t->running = loss_now(t);
        if (!see_share(t, share_before))
            return hnbrdf_fit_fail_lost(t, error);
        hnbrdf_fit_tell(t, "network", fmin(t->share, 1.0), t->running,
                        t->frozen->pairs - pairs_before, 1);
        result = hear(t, &saved, error);
    }
    if (!result && t->frozen->phase < FIT_PHASES - 1) { /* the same measure whenever it ends */
        enter_phase(t, FIT_PHASES - 1);
        hnbrdf_fit_look(t);
    }
    return result;
}

/* ---- The whole ------------------------------------------------------------------------------- */

static hnbrdf_result make(trainer *t, hnbrdf_error *error)
{
    struct fit_frozen *f = t->frozen = calloc(1, sizeof *t->frozen);
    const size_t held = (size_t)t->held_count + 1,
                 stride = (size_t)hnbrdf_fit_own_stride(&t->layout);
    if (f) {
        f->slots = hnbrdf_fit_slots();
        f->ggx_phase = -1;
        f->normal_size = (stride + 1) * stride * (stride > FIT_LANES ? 2 : 1);
        f->ggx = calloc(held, sizeof *f->ggx);
        f->of = calloc((size_t)t->count, sizeof *f->of);
        f->rows = calloc((size_t)t->layout.padded * FIT_LANES, sizeof(float));
        f->views = calloc(held, sizeof *f->views);
        f->normals = calloc(held * (size_t)f->slots * f->normal_size, sizeof(float));
        f->sums = calloc(held * (size_t)f->slots, sizeof *f->sums);
        f->units = calloc(held * (size_t)f->slots, sizeof *f->units);
    }
    if (!f || !f->of || !f->rows || !f->ggx || !f->views || !f->normals || !f->sums || !f->units)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY,
                           "out of memory for the codes of %d materials", t->held_count);
    return HNBRDF_OK;
}

void hnbrdf_fit_frozen_free(trainer *t)
{
    struct fit_frozen *f = t->frozen;
    if (!f)
        return;
    for (int k = 0; k < t->held_count && f->views; k++)
        free(f->views[k].of);
    void *all[] = {f->of, f->rows, f->ggx, f->views, f->normals, f->sums, f->units, f};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        free(all[i]);
}

static hnbrdf_result start(trainer *t, hnbrdf_error *error)
{
    hnbrdf_result result = hnbrdf_fit_agree(t, make(t, error), error);
    if (result)
        return result;
    t->peak = (double)t->options.learning_rate;
    t->running = NAN;
    take_network(t);
    hnbrdf_threads_run(t->workers, t->held_count, start_one, t);
    for (int k = 0; k < t->held_count && !result; k++)
        if (t->frozen->views[k].failed)
            result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for pictures of %s",
                                 t->known[t->held[k]].name);
    result = hnbrdf_fit_agree(t, result, error);
    if (!result && t->options.resume && !(result = hnbrdf_fit_checkpoint_load(t, error)))
        t->frozen->phase = (int)t->frozen->of[0].phase;
    return result;
}

hnbrdf_result hnbrdf_fit_frozen(trainer *t, hnbrdf_fit_report *report, hnbrdf_error *error)
{
    const double busy_before = hnbrdf_threads_busy(t->workers);
    hnbrdf_fit_stage_begin(t);
    hnbrdf_result result = start(t, error);
    if (!result)
        result = run_steps(t, error);
    if (!result)
        result = spread(t, &report->pairs, error);
    if (result)
        return result;
    const double elapsed = hnbrdf_fit_stage_seconds(t);
    report->steps = report->best_step = t->step;
    report->final_loss = report->best_loss = t->running;
    report->rate = t->peak;
    report->pairs_per_s = elapsed > 0.0 ? report->pairs / elapsed : 0.0;
    report->flops = report->pairs * hnbrdf_fit_own_flops(&t->layout);
    report->times.network = hnbrdf_threads_busy(t->workers) - busy_before;
    return HNBRDF_OK;
}
