/* judge.c: whether training still leads anywhere. The best state so far is kept; a training that
 * has diverged is set back to it; what the fit returns is never clearly worse than it, nor than
 * GGX alone. */
#include "fit/ggx.h"
#include "fit/trainer.h"

#include <math.h>
#include <string.h>

/* A judgement costs about a step: half a per cent of a long training. The first ones after a
 * start come early, because a rate that is far too large does its harm within the warm-up. */
enum { JUDGE_EVERY = 200 };

/* A judgement sees a sample of pairs, so states whose losses differ by less count as equal; 1e-3 of
 * SMAPE is invisible. The later state is then kept: it was trained at the lower rate. */
#define SLACK_SHARE 0.05
#define SLACK 1e-3

/* Diverged: a loss above that of the untrained start and this far above the best, or units that
 * died since the best state. In trainings at the default rate (16 built-in and 12 RGL materials,
 * 4x1 to 64x4) the loss never rose above 1.4 times the best, but for black channels, where 1e-4
 * is a SMAPE of 1, and at most 3 % of a layer's units were dead; at 10 times that rate more than
 * half of them die for good within 200 steps, most without the loss doubling. */
#define FAR_FACTOR 2.0
#define FAR_OFFSET 0.1
#define DEAD_SHARE 0.125 /* of a layer */
#define DEAD_LOSS 0.01   /* data that need no network (all black, constant) may leave it dead */
enum { DEAD_UNITS = 3 }; /* or so many, in small layers */

#define SET_BACK_RATE 0.3 /* 100 times too much is back within four of them */
#define LEAST_RATE 1e-20

static int is_due(const trainer *t)
{
    long since = t->step - t->since;
    return since == 25 || since == 50 || since == 100 || t->step % JUDGE_EVERY == 0;
}

/* Mean loss of t->parameters over the first tiles of all materials, by what training ends with
 * (SMAPE unless the loss is the logarithm), so that all states can be compared. *dead: in the
 * worst layer, the units whose gradient was zero throughout; they are off for every pair, or
 * nothing behind them is on. */
static double loss_now(trainer *t, int *dead)
{
    const fit_layout *l = &t->layout;
    const int rounds = hnbrdf_fit_supply_rounds(t);
    char moved[HNBRDF_MAX_LAYERS][HNBRDF_MAX_HIDDEN] = {{0}};
    double loss = 0.0;
    t->mix = t->options.loss == HNBRDF_FIT_LOG ? 0.0f : 1.0f;
    for (int r = 0; r < rounds; r++) {
        hnbrdf_fit_supply_round(t, r);
        loss += hnbrdf_fit_step_gradient(t) / rounds;
        for (int k = 0; k < l->layers; k++)
            for (int u = 0; u < l->hidden_size; u++) {
                float g = t->gradient[l->bias[k] + (size_t)u];
                moved[k][u] |= isfinite(g) && g != 0.0f;
            }
    }
    *dead = 0;
    for (int k = 0; k < l->layers; k++) {
        int still = 0;
        for (int u = 0; u < l->hidden_size; u++)
            still += !moved[k][u];
        *dead = still > *dead ? still : *dead;
    }
    return loss;
}

static void keep_as_best(trainer *t, double loss, int dead)
{
    memcpy(t->best, t->parameters, t->layout.count * sizeof(float));
    t->best_loss = loss;
    t->best_dead = dead;
    t->best_step = t->step;
}

void hnbrdf_fit_judge_start(trainer *t)
{
    int dead;
    t->start_loss = loss_now(t, &dead);
    keep_as_best(t, t->start_loss, dead);
}

static int has_diverged(const trainer *t, double loss, int dead)
{
    const int units = t->layout.hidden_size;
    const int many = (int)fmax(DEAD_UNITS, DEAD_SHARE * units);
    if (!(loss <= fmax(t->start_loss, FAR_FACTOR * t->best_loss + FAR_OFFSET)))
        return 1;
    return loss > DEAD_LOSS && dead > t->best_dead && (dead == units || dead > t->best_dead + many);
}

void hnbrdf_fit_set_back(trainer *t)
{
    memcpy(t->parameters, t->best, t->layout.count * sizeof(float));
    memset(t->moments, 0, 2 * t->layout.count * sizeof(float));
    t->peak = fmax(SET_BACK_RATE * t->peak, LEAST_RATE);
    t->running = t->best_loss;
    t->since = t->step;
    t->set_backs++;
}

void hnbrdf_fit_judge(trainer *t)
{
    if (!is_due(t))
        return;
    int dead;
    double loss = loss_now(t, &dead);
    if (has_diverged(t, loss, dead))
        hnbrdf_fit_set_back(t);
    else if (loss < t->best_loss)
        keep_as_best(t, loss, dead);
}

/* The network that leaves the analytic part as it is: gates open, the correction equal to the
 * floor. */
static void leave_ggx_alone(const fit_layout *l, float *p)
{
    const float open = 40.0f; /* sigmoid(40) is 1, and exp(-40) is nothing */
    memset(p, 0, l->network_count * sizeof(float));
    for (int c = 0; c < 3; c++) {
        p[l->bias[l->layers] + (size_t)c] = l->floor > 0.0f ? logf(l->floor) : -open;
        p[l->bias[l->layers] + (size_t)c + 3] = open;
    }
}

static int clearly_worse(double loss, double than)
{
    return !(loss <= (1.0 + SLACK_SHARE) * than + SLACK);
}

void hnbrdf_fit_judge_end(trainer *t, hnbrdf_fit_report *report)
{
    const size_t bytes = t->layout.count * sizeof(float);
    int dead;
    double loss = loss_now(t, &dead);
    report->best_step = t->step;
    report->ggx_loss = NAN;
    report->final_loss = t->running;
    if (clearly_worse(loss, t->best_loss)) {
        memcpy(t->parameters, t->best, bytes);
        report->best_step = t->best_step;
        report->final_loss = loss = t->best_loss;
    }
    if (t->layout.kind == HNBRDF_KIND_HYBRID) {
        /* best was its last; from here on it is the other one */
        memcpy(t->best, t->parameters, bytes);
        for (int m = 0; m < t->count && t->layout.train_analytic;
             m++) /* back from where it was trained to */
            hnbrdf_fit_ggx_parameters(&t->found[m].material, t->parameters + t->layout.analytic +
                                                                 (size_t)m * FIT_ANALYTIC);
        leave_ggx_alone(&t->layout, t->parameters);
        report->ggx_loss = loss_now(t, &dead);
        if (clearly_worse(loss, report->ggx_loss)) {
            report->best_step = 0;
            report->final_loss = loss = report->ggx_loss;
            report->ggx_alone = 1;
        } else {
            memcpy(t->parameters, t->best, bytes);
        }
    }
    report->best_loss = loss;
    report->set_backs = t->set_backs;
    report->rate = t->peak;
}
