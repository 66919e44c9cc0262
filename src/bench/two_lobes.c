/* two_lobes.c: Lambert and two GGX lobes fitted to a measurement: what one takes where one lobe is
 * not enough. Adam on the loss of `hnbrdf fit`, from several starts. */
#include "base/error.h"
#include "bench/baselines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* kd of the whole; logarithms of eta - 1 and alpha of either lobe */
enum { KD = 0, ETA = 3, ALPHA = 9, PARAMETERS = 11 };
enum { PAIRS = 4096, SCOUTS = 1024, STARTS = 5, SCOUT_STEPS = 80, STEPS = 200 };
/* The loss of GGX fits (fit/ggx.c): 0.7 SMAPE, 0.3 of the logarithm's error. */
#define SMAPE_SHARE 0.7f
#define SMAPE_OFFSET 1e-4f
#define LOG_OFFSET 1e-3f

typedef struct search {
    const hnbrdf_model *ggx;
    hnbrdf_material like; /* rotation and the two alphas' ratio */
    int count;            /* of pairs that are looked at */
    float wi[PAIRS][3], wo[PAIRS][3], target[PAIRS][3], f[PAIRS][3], second[PAIRS][3];
} search;

static float clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

static void lobes_of(const search *s, const float *p, bench_two_lobes *lobes)
{
    for (int l = 0; l < 2; l++) {
        hnbrdf_material *m = &lobes->lobe[l];
        *m = s->like;
        for (int c = 0; c < 3; c++) {
            m->kd[c] = l == 0 ? p[KD + c] : 0.0f;
            m->eta[c] = clamp(1.0f + expf(p[ETA + 3 * l + c]), 1.0001f, HNBRDF_MAX_ETA);
        }
        float alpha = expf(p[ALPHA + l]), aspect = sqrtf(s->like.alpha[0] / s->like.alpha[1]);
        m->alpha[0] = clamp(alpha * aspect, HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
        m->alpha[1] = clamp(alpha / aspect, HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
    }
}

static double loss_of(search *s, const float *p)
{
    bench_two_lobes lobes;
    double sum = 0.0;
    lobes_of(s, p, &lobes);
    bench_two_lobes_eval(s->ggx, &lobes, (size_t)s->count, s->wi[0], s->wo[0], s->f[0],
                         s->second[0]);
    for (int k = 0; k < s->count; k++)
        for (int c = 0; c < 3; c++) {
            float f = s->f[k][c], t = s->target[k][c];
            sum +=
                (double)(SMAPE_SHARE * 2.0f * fabsf(f - t) / (f + t + SMAPE_OFFSET) +
                         (1.0f - SMAPE_SHARE) * fabsf(logf((f + LOG_OFFSET) / (t + LOG_OFFSET))));
        }
    return sum / (3.0 * s->count);
}

static void project(float *p)
{
    for (int c = 0; c < 3; c++)
        p[KD + c] = clamp(p[KD + c], 0.0f, 1.0f);
    for (int k = ETA; k < ALPHA; k++)
        p[k] = clamp(p[k], -9.0f, 4.595f); /* eta - 1 to 99 */
    for (int l = 0; l < 2; l++)
        p[ALPHA + l] = clamp(p[ALPHA + l], -9.2103f, 0.0f);
}

/* Adam with differences for derivatives; p ends as the best that was seen. Returns its loss. */
static double descend(search *s, int steps, double rate, float *p)
{
    double m[PARAMETERS] = {0}, v[PARAMETERS] = {0}, least = loss_of(s, p), loss = least;
    float best[PARAMETERS];
    memcpy(best, p, sizeof best);
    for (int step = 1; step <= steps; step++) {
        double gradient[PARAMETERS];
        for (int k = 0; k < PARAMETERS; k++) {
            const float before = p[k], by = 2e-3f;
            p[k] = before + by;
            gradient[k] = (loss_of(s, p) - loss) / (double)by;
            p[k] = before;
        }
        for (int k = 0; k < PARAMETERS; k++) {
            m[k] += 0.1 * (gradient[k] - m[k]);
            v[k] += 0.01 * (gradient[k] * gradient[k] - v[k]);
            double first = m[k] / (1.0 - pow(0.9, step)), second = v[k] / (1.0 - pow(0.99, step));
            double by = rate * (1.02 - (double)step / steps) * (k < ETA ? 0.3 : 1.0);
            p[k] -= (float)(by * first / (sqrt(second) + 1e-12));
        }
        project(p);
        loss = loss_of(s, p);
        if (loss < least) {
            least = loss;
            memcpy(best, p, sizeof best);
        }
    }
    memcpy(p, best, sizeof best);
    return least;
}

/* Start k: the lobe of the GGX fit, and another one that is faint and of another width. */
static void start(const search *s, int k, float *p)
{
    static const float widths[STARTS] = {0.15f, 0.4f, 1.0f, 2.5f, 6.0f};
    for (int c = 0; c < 3; c++) {
        p[KD + c] = s->like.kd[c];
        p[ETA + c] = logf(s->like.eta[c] - 1.0f);
        p[ETA + 3 + c] = logf(0.2f);
    }
    p[ALPHA] = 0.5f * logf(s->like.alpha[0] * s->like.alpha[1]);
    p[ALPHA + 1] = p[ALPHA] + logf(widths[k]);
    project(p);
}

/* Pairs as fits draw them, every other one by the one and the other sampler; fewer where most of
 * the material was not measured. */
static int draw(search *s, const hnbrdf_measured *measured)
{
    hnbrdf_rng rng;
    int count = 0;
    hnbrdf_rng_seed(&rng, 1, 0x6c6f626573u); /* "lobes" */
    for (long draws = 0; count < PAIRS && draws < 1000L * PAIRS; draws++) {
        hnbrdf_sampler_draw(draws % 2 ? HNBRDF_SAMPLER_UNIFORM : HNBRDF_SAMPLER_GRID, &rng,
                            s->wi[count], s->wo[count]);
        count += hnbrdf_measured_eval(measured, s->wi[count], s->wo[count], s->target[count]) != 0;
    }
    return count;
}

hnbrdf_result bench_two_lobes_fit(const hnbrdf_model *ggx, const hnbrdf_material *one,
                                  const hnbrdf_measured *measured, bench_two_lobes *fitted,
                                  hnbrdf_error *error)
{
    search *s = malloc(sizeof *s);
    if (!s)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    s->ggx = ggx;
    s->like = *one;
    const int pairs = draw(s, measured);
    float best[PARAMETERS], p[PARAMETERS];
    double least = INFINITY;
    s->count = pairs < SCOUTS ? pairs : SCOUTS;
    start(s, 0, best);
    for (int k = 0; k < STARTS && s->count > 0; k++) {
        start(s, k, p);
        double loss = descend(s, SCOUT_STEPS, 0.1, p);
        if (loss < least) {
            least = loss;
            memcpy(best, p, sizeof best);
        }
    }
    s->count = pairs;
    if (pairs > 0)
        descend(s, STEPS, 0.04, best);
    lobes_of(s, best, fitted);
    free(s);
    return HNBRDF_OK;
}

void bench_two_lobes_eval(const hnbrdf_model *ggx, const bench_two_lobes *lobes, size_t count,
                          const float *wi, const float *wo, float *f, float *scratch)
{
    hnbrdf_eval_batch(ggx, &lobes->lobe[0], count, wi, 0, wo, 0, f, 0);
    hnbrdf_eval_batch(ggx, &lobes->lobe[1], count, wi, 0, wo, 0, scratch, 0);
    for (size_t i = 0; i < 3 * count; i++)
        f[i] += scratch[i];
}
