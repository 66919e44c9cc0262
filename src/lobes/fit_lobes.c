/* fit_lobes.c: the lobes with which a material is sampled with the least variance.
 *
 * f is looked at once, in directions drawn from many lobes of all widths. The variance of any
 * mixture of those lobes is then a sum over these observations, convex in the shares, which a
 * multiplicative update minimises; the two widths are searched for. Plain arithmetic and the
 * library's own exp and log: the same lobes on every machine. */
#include "base/error.h"
#include "core/compose.h"
#include "core/math.h"
#include "core/prepared.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

enum {
    WIDTHS = 20,          /* roughnesses to choose from */
    SOURCES = WIDTHS + 1, /* and the cosine lobe, the last */
    VIEWS = 20,
    DRAWS = 16, /* of each source and view */
    COUNT = VIEWS * SOURCES * DRAWS,
    PARTS = HNBRDF_LOBES + 1, /* of a mixture: the lobes, then cosine */
    KNOTS = HNBRDF_LOBE_KNOTS
};
static const double least_share = 1.0 / 64.0;

/* One direction: where its view lies between the knots, and what it adds to the variance over the
 * density. */
typedef struct observation {
    int knot; /* the one below; the next is above */
    double near[2], size;
} observation;

typedef struct search {
    hnbrdf_prepared source; /* its lobes are changed from source to source */
    float alpha[2];
    observation seen[COUNT];
    float pairs[COUNT][2][3];  /* wi, wo */
    float pdf[SOURCES][COUNT]; /* of each source alone */
    float refined[HNBRDF_LOBES][COUNT];
} search;

typedef struct mixture {
    const float *pdf[PARTS];
    double share[PARTS][KNOTS];
    double variance; /* plus a constant */
} mixture;

/* ---- Observing ------------------------------------------------------------------------------- */

/* All samples into one lobe of this scale; 0 stands for cosine. */
static void use_source(search *s, float scale)
{
    hnbrdf_lobes *lobes = &s->source.lobes;
    memset(lobes, 0, sizeof *lobes);
    lobes->scale[0] = scale;
    for (int j = 0; j < KNOTS && scale > 0.0f; j++)
        lobes->share[0][j] = 1.0f;
    for (int a = 0; a < 2; a++)
        s->source.lobe_alpha[0][a] =
            hnbrdf_clamp(scale * s->alpha[a], HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
    s->source.lobe_area[0] =
        hnbrdf_ggx_area(s->source.lobe_alpha[0][0], s->source.lobe_alpha[0][1]);
}

/* Widths spread evenly in their logarithm, from well below the material's to the widest. */
static void make_scales(const search *s, float scales[SOURCES])
{
    float size = sqrtf(s->alpha[0] * s->alpha[1]);
    float low = hnbrdf_log(hnbrdf_clamp(size * 0.03125f, HNBRDF_MIN_ALPHA, 1.0f));
    for (int k = 0; k < WIDTHS; k++)
        scales[k] = hnbrdf_exp(low * (1.0f - (float)k / (WIDTHS - 1))) / size;
    scales[WIDTHS] = 0.0f;
}

/* Views spread evenly in sqrt(cosine), as the knots are, turned by the golden angle. */
static void make_view(int view, float wo[3])
{
    float sine, cosine, x = ((float)view + 0.5f) / VIEWS, turn = 0.618033989f * (float)view;
    wo[2] = x * x;
    hnbrdf_sincos_turn(turn - floorf(turn), &sine, &cosine);
    float r = sqrtf(1.0f - wo[2] * wo[2]);
    wo[0] = r * cosine;
    wo[1] = r * sine;
}

static float fraction(double x)
{
    return (float)(int)((x - floor(x)) * 16777216.0) * 0x1p-24f;
}

/* Draws of one view, in turn from each source; f wi.z of the three channels in values, its
 * luminance does not matter. What was rejected keeps a size of 0. Returns the sum over channels
 * of the albedo squared. */
static double observe_view(search *s, const float scales[SOURCES], int view, float values[][3])
{
    enum { EACH = SOURCES * DRAWS };
    double albedo[3] = {0.0, 0.0, 0.0}, size = 0.0;
    for (int i = 0; i < EACH; i++) {
        int n = view * EACH + i;
        float *wi = s->pairs[n][0], *wo = s->pairs[n][1];
        /* the R2 sequence (Roberts 2018) */
        double step = i / SOURCES + 1 + DRAWS * (i % SOURCES) + 7 * view;
        const float choice = scales[i % SOURCES] > 0.0f ? 0.0f : 0.5f;
        const float turn = fraction(0.5 + step * 0.7548776662466927);
        const float u = fraction(0.5 + step * 0.5698402909980532);
        make_view(view, wo);
        use_source(s, scales[i % SOURCES]);
        float pdf = hnbrdf_prepared_draw_turned(&s->source, wo, choice, u, turn, wi), f[3];
        hnbrdf_prepared_eval(&s->source, wi, wo, f);
        for (int c = 0; c < 3; c++)
            values[i][c] = pdf > 0.0f ? hnbrdf_finish(f[c] * wi[2] / pdf) * pdf : 0.0f;
    }
    for (int k = 0; k < SOURCES; k++) {
        use_source(s, scales[k]);
        for (int i = 0; i < EACH; i++) {
            int n = view * EACH + i;
            s->pdf[k][n] = hnbrdf_prepared_pdf(&s->source, s->pairs[n][0], s->pairs[n][1]);
        }
    }
    for (int i = 0; i < EACH; i++) {
        int n = view * EACH + i;
        double q = 0.0, square = 0.0;
        for (int k = 0; k < SOURCES; k++)
            q += (double)s->pdf[k][n] / SOURCES;
        for (int c = 0; c < 3 && q > 0.0; c++) {
            double value = (double)values[i][c];
            albedo[c] += value / q / EACH;
            square += value * value;
        }
        s->seen[n].size = q > 0.0 ? square / q : 0.0;
    }
    for (int c = 0; c < 3; c++)
        size += albedo[c] * albedo[c];
    return size;
}

/* Views count by the area that a sphere shows them on, grazing ones a little more. Returns how
 * much light there is at all. */
static double observe(search *s, const float scales[SOURCES])
{
    enum { EACH = SOURCES * DRAWS };
    double total = 0.0;
    for (int view = 0; view < VIEWS; view++) {
        float values[EACH][3], x = ((float)view + 0.5f) / VIEWS * (KNOTS - 1);
        double size = observe_view(s, scales, view, values), side = (double)x / (KNOTS - 1);
        double weight = size > 1e-30 ? (side * side * side + 0.05) / size : 0.0;
        total += weight * size;
        for (int n = view * EACH; n < (view + 1) * EACH; n++) {
            observation *o = &s->seen[n];
            o->knot = (int)x;
            o->near[1] = (double)x - o->knot;
            o->near[0] = 1.0 - o->near[1];
            o->size *= weight;
        }
    }
    return total;
}

/* ---- Shares ---------------------------------------------------------------------------------- */

/* At least least_share each, together 1. */
static void normalise(mixture *m, int knot)
{
    double sum = 0.0, spare = 0.0;
    for (int k = 0; k < PARTS; k++)
        sum += m->share[k][knot];
    for (int k = 0; k < PARTS; k++) {
        m->share[k][knot] = sum > 0.0 ? m->share[k][knot] / sum : 1.0 / PARTS;
        spare += fmax(0.0, m->share[k][knot] - least_share);
    }
    for (int k = 0; k < PARTS; k++)
        m->share[k][knot] = least_share + fmax(0.0, m->share[k][knot] - least_share) / spare *
                                              (1.0 - PARTS * least_share);
}

/* Of a mixture without a second lobe, pdf[1] is NULL, the share of that lobe stays with cosine.
 * `stride` takes every n-th observation, n = stride. Each share is multiplied by the root of its
 * own derivative over the mean one, which never increases the variance. */
static void fit_shares(const search *s, mixture *m, int steps, int stride)
{
    for (int k = 0; k < PARTS; k++)
        for (int j = 0; j < KNOTS; j++)
            m->share[k][j] = m->pdf[k] ? 1.0 : 0.0;
    for (int j = 0; j < KNOTS; j++)
        normalise(m, j);
    for (int step = 0; step <= steps; step++) {
        double slope[PARTS][KNOTS] = {{0.0}};
        m->variance = 0.0;
        for (int n = 0; n < COUNT; n += stride) {
            const observation *o = &s->seen[n];
            double p = 0.0, part[PARTS];
            if (!(o->size > 0.0))
                continue;
            for (int k = 0; k < PARTS; k++) {
                part[k] = m->pdf[k] ? (double)m->pdf[k][n] : 0.0;
                p += part[k] *
                     (o->near[0] * m->share[k][o->knot] + o->near[1] * m->share[k][o->knot + 1]);
            }
            double over = o->size / p;
            m->variance += over;
            over /= p;
            for (int k = 0; k < PARTS; k++) {
                slope[k][o->knot] += over * part[k] * o->near[0];
                slope[k][o->knot + 1] += over * part[k] * o->near[1];
            }
        }
        for (int j = 0; j < KNOTS && step < steps; j++) {
            for (int k = 0; k < PARTS; k++)
                m->share[k][j] *= sqrt(slope[k][j]);
            normalise(m, j);
        }
    }
}

/* ---- Widths ---------------------------------------------------------------------------------- */

enum { QUICK = 8, CAREFUL = 60 };

static double try_pair(const search *s, const float *first, const float *second)
{
    mixture m = {.pdf = {first, second, s->pdf[WIDTHS]}};
    fit_shares(s, &m, QUICK, 2);
    return m.variance;
}

/* The source that does best beside `other`, which may be NULL. */
static int best_beside(const search *s, const float *other)
{
    double least = INFINITY;
    int best = 0;
    for (int k = 0; k < WIDTHS; k++) {
        double variance = s->pdf[k] != other ? try_pair(s, s->pdf[k], other) : INFINITY;
        if (variance < least) {
            least = variance;
            best = k;
        }
    }
    return best;
}

static void measure(search *s, float scale, float *pdf)
{
    use_source(s, scale);
    for (int n = 0; n < COUNT; n++)
        pdf[n] = hnbrdf_prepared_pdf(&s->source, s->pairs[n][0], s->pairs[n][1]);
}

/* Moves one scale after the other by ever smaller factors while that helps. s->refined holds
 * their densities. */
static void refine(search *s, float scale[HNBRDF_LOBES], float spacing)
{
    float trial[COUNT];
    double least = try_pair(s, s->refined[0], s->refined[1]);
    for (int round = 0; round < 3; round++) {
        spacing = sqrtf(spacing);
        for (int k = 0; k < HNBRDF_LOBES; k++)
            for (int up = 0; up < 2; up++) {
                float moved = up ? scale[k] * spacing : scale[k] / spacing;
                measure(s, moved, trial);
                double variance =
                    try_pair(s, k == 0 ? trial : s->refined[0], k == 1 ? trial : s->refined[1]);
                if (variance < least) {
                    least = variance;
                    scale[k] = moved;
                    memcpy(s->refined[k], trial, sizeof trial);
                    break;
                }
            }
    }
}

static void search_lobes(search *s, const float scales[SOURCES], hnbrdf_lobes *lobes)
{
    int first = best_beside(s, NULL), second = best_beside(s, s->pdf[first]);
    first = best_beside(s, s->pdf[second]);
    float scale[HNBRDF_LOBES] = {scales[first], scales[second]};
    memcpy(s->refined[0], s->pdf[first], sizeof s->pdf[first]);
    memcpy(s->refined[1], s->pdf[second], sizeof s->pdf[second]);
    refine(s, scale, scales[1] / scales[0]);

    mixture m = {.pdf = {s->refined[0], s->refined[1], s->pdf[WIDTHS]}};
    fit_shares(s, &m, CAREFUL, 1);
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        lobes->scale[k] = hnbrdf_clamp(scale[k], 1e-4f, 1e4f);
        for (int j = 0; j < KNOTS; j++)
            lobes->share[k][j] = (float)m.share[k][j];
    }
}

hnbrdf_result hnbrdf_lobes_fit(const hnbrdf_model *model, const hnbrdf_material *material,
                               hnbrdf_lobes *lobes, hnbrdf_error *error)
{
    hnbrdf_lobes found = {{0.0f}, {{0.0f}}};
    float scales[SOURCES];
    if (!model || !material || !lobes)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s is NULL",
                           !model      ? "model"
                           : !material ? "material"
                                       : "lobes");
    hnbrdf_material straight = *material; /* in the tangent frame */
    straight.rotation = 0.0f;
    straight.lobes = found;
    hnbrdf_result result = hnbrdf_material_check(&straight, error);
    if (result)
        return result;
    search *s = (search *)hnbrdf_allocate(&model->allocator, sizeof *s);
    if (!s)
        return hnbrdf_fail_memory(error, sizeof *s, "fitting lobes");
    hnbrdf_prepare(model, &straight, &s->source);
    for (int a = 0; a < 2; a++)
        s->alpha[a] = model->desc.kind == HNBRDF_KIND_NEURAL ? 1.0f : material->alpha[a];
    make_scales(s, scales);
    if (observe(s, scales) > 0.0)
        search_lobes(s, scales, &found);
    hnbrdf_release(&model->allocator, s);
    *lobes = found;
    return HNBRDF_OK;
}
