/* test_parity_draw.c: the bounds on directions that are drawn and on densities, against a device
 * that rounds nothing. */
#include "gpu_support.h"

#include "core/prepared.h"
#include "check/bounds_draw.h"
#include "check/pairs.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS = 4096 };

static const check_arithmetic NOTHING_EXACT = {0};

/* ---- The formulas of sampling in double, from the same float inputs -------------------------- */

typedef struct lobe {
    double a[2], scale;
    const float *share;
} lobe;

static double clamp_to(double x, double low, double high)
{
    return x > low ? (x < high ? x : high) : low;
}

static lobe lobe_of(const hnbrdf_prepared *m, int which)
{
    lobe l = {.scale = (double)m->lobes.scale[which], .share = m->lobes.share[which]};
    const int neural = m->model->desc.kind == HNBRDF_KIND_NEURAL;
    for (int i = 0; i < 2; i++)
        l.a[i] = clamp_to(fabs(l.scale) * (neural ? 1.0 : (double)m->alpha[i]), (double)1e-4f, 1.0);
    return l;
}

static double share_at(const lobe *l, double z)
{
    double x = clamp_to(3.0 * sqrt(z), 0.0, 3.0), sum = 0.0;
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
        sum += clamp_to(1.0 - fabs(x - j), 0.0, 1.0) * (double)l->share[j];
    return sum;
}

static double cap_bound(const double w[3], const lobe *l)
{
    double a2 = pow(fmin(l->a[0], l->a[1]), 2.0), s2 = pow(1.0 + hypot(w[0], w[1]), 2.0);
    return (1.0 - a2) * s2 / (s2 + a2 * w[2] * w[2]);
}

static double stretched(const double w[3], const lobe *l)
{
    return sqrt(pow(l->a[0] * w[0], 2.0) + pow(l->a[1] * w[1], 2.0) + w[2] * w[2]);
}

static void to_tangent(const hnbrdf_prepared *m, const double w[3], double t[3])
{
    const double c = (double)m->cosine, s = (double)m->sine;
    t[0] = c * w[0] + s * w[1];
    t[1] = c * w[1] - s * w[0];
    t[2] = w[2];
}

static double density_of(const hnbrdf_prepared *m, const double wi[3], const double wo[3])
{
    double i[3], o[3], s[3], sum = 0.0, rest = 1.0, length2 = 0.0;
    to_tangent(m, wi, i);
    to_tangent(m, wo, o);
    for (int k = 0; k < 3; k++) {
        s[k] = i[k] + o[k];
        length2 += s[k] * s[k];
    }
    for (int which = 0; which < HNBRDF_LOBES; which++) {
        const lobe l = lobe_of(m, which);
        double share = share_at(&l, o[2]);
        double t = (pow(s[0] / l.a[0], 2.0) + pow(s[1] / l.a[1], 2.0) + s[2] * s[2]) / length2;
        double d = 1.0 / ((double)3.14159265f * l.a[0] * l.a[1] * t * t);
        double v =
            l.scale < 0.0 ? s[2] / length2 : 1.0 / (cap_bound(o, &l) * o[2] + stretched(o, &l));
        sum += share > 0.0 ? share * d * 0.5 * v : 0.0;
        rest -= share;
    }
    return clamp_to(sum + clamp_to(rest, 0.0, 1.0) * i[2] * (double)0.318309886f, 0.0, 3e38);
}

/* As hnbrdf_draw_chosen(), in the tangent frame. */
static void draw_chosen(const lobe *l, const double o[3], double turn, double u, double w[3])
{
    const double azimuth = 2.0 * acos(-1.0) * turn;
    double h[3], along = 0.0, h2 = 0.0;
    if (!l) {
        w[0] = sqrt(u) * cos(azimuth);
        w[1] = sqrt(u) * sin(azimuth);
        w[2] = sqrt(1.0 - u);
        return;
    }
    if (l->scale < 0.0) {
        h[0] = l->a[0] * sqrt(u) * cos(azimuth);
        h[1] = l->a[1] * sqrt(u) * sin(azimuth);
        h[2] = sqrt(1.0 - u);
    } else {
        double length = stretched(o, l), bound = cap_bound(o, l) * o[2] / length;
        double cap = (1.0 - u) * (1.0 + bound) - bound;
        double radius = sqrt(clamp_to(1.0 - cap * cap, 0.0, 1.0));
        h[0] = l->a[0] * (radius * cos(azimuth) + l->a[0] * o[0] / length);
        h[1] = l->a[1] * (radius * sin(azimuth) + l->a[1] * o[1] / length);
        h[2] = cap + o[2] / length;
    }
    for (int k = 0; k < 3; k++) {
        along += o[k] * h[k];
        h2 += h[k] * h[k];
    }
    for (int k = 0; k < 3; k++)
        w[k] = 2.0 * along / h2 * h[k] - o[k];
}

static void draw_of(const hnbrdf_prepared *m, const double wo[3], const float u[2], double wi[3])
{
    const lobe lobes[] = {lobe_of(m, 0), lobe_of(m, 1)};
    double o[3], w[3], u0 = clamp_to((double)u[0], 0.0, (double)0.99999994f);
    double u1 = clamp_to((double)u[1], 0.0, (double)0.99999994f);
    to_tangent(m, wo, o);
    double first = share_at(&lobes[0], o[2]), second = share_at(&lobes[1], o[2]);
    double both = first + second, low = u0 < first ? 0.0 : u0 < both ? first : both;
    double size = u0 < first ? first : u0 < both ? second : 1.0 - both;
    double turn = clamp_to((u0 - low) / size, 0.0, (double)0.99999994f);
    draw_chosen(u0 < first ? &lobes[0] : u0 < both ? &lobes[1] : NULL, o, turn, u1, w);
    wi[0] = (double)m->cosine * w[0] - (double)m->sine * w[1];
    wi[1] = (double)m->cosine * w[1] + (double)m->sine * w[0];
    wi[2] = w[2];
    if (!(wi[2] > 0.0)) {
        wi[0] = wi[1] = 0.0;
        wi[2] = 1.0;
    }
}

/* ---- Properties ------------------------------------------------------------------------------ */

static const scene_shape SHAPES[] = {
    {.encoding = HNBRDF_ENCODING_ANGLES, .hidden = 2, .layers = 1, .latent = 1},
    {.kind = HNBRDF_KIND_GGX, .anisotropic = 1, .rotated = 1},
    {.kind = HNBRDF_KIND_NEURAL, .hidden = 2, .layers = 1, .latent = 1, .rotated = 1}};

static int is_usual(check_pair_class class_of_pair)
{
    return class_of_pair != CHECK_PAIR_EXTREME && class_of_pair != CHECK_PAIR_NOT_FINITE;
}

typedef struct tally {
    int bounded, unbounded, narrow; /* narrow: within 1e-3 of the number, or of 1e-3 */
} tally;

static void count(tally *t, const char *what, int k, check_tracked bound, double exact)
{
    if (!(bound.e < (double)INFINITY)) {
        t->unbounded++;
        return;
    }
    if (!(fabs(exact - (double)bound.v) <= bound.e))
        fail_msg("%s %d: %.17g, C %.9g, bound %g", what, k, exact, (double)bound.v, bound.e);
    t->bounded++;
    t->narrow += bound.e <= 1e-3 * fmax(fabs((double)bound.v), 1.0);
}

static void as_doubles(const float w[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = (double)w[i];
}

static void check_pair(const check_rules *rules, const hnbrdf_prepared *m, const float pair[6],
                       const float u[2], tally *directions, tally *densities)
{
    double wi[3], wo[3], drawn[3];
    check_tracked draw[3];
    as_doubles(pair, wi);
    as_doubles(pair + 3, wo);
    check_tracked density = check_density_make(rules, m, pair, pair + 3, 0.0);
    assert_true(density.v == hnbrdf_prepared_pdf(m, pair, pair + 3));
    count(densities, "density", 0, density, density_of(m, wi, wo));
    check_draw_make(rules, m, pair + 3, u, draw);
    draw_of(m, wo, u, drawn);
    for (int i = 0; i < 3; i++)
        count(directions, "direction", i, draw[i], drawn[i]);
}

/* Real arithmetic is a device whose every error is below its limit, so it must lie within the
 * bounds; and these must say something about nearly all pairs. */
static void bounds_cover_a_device_without_rounding(void **state)
{
    (void)state;
    const check_rules sets[] = {check_rules_fast(&NOTHING_EXACT, 0),
                                check_rules_unordered(&NOTHING_EXACT)};
    for (size_t shape = 0; shape < sizeof SHAPES / sizeof SHAPES[0]; shape++) {
        hnbrdf_model *model = scene_model(&SHAPES[shape]);
        tally directions = {0}, densities = {0};
        for (int k = 0; k < SCENE_MATERIALS; k++) {
            hnbrdf_prepared m;
            hnbrdf_rng rng;
            float pair[6] = {0, 0, 1, 0, 0, 1};
            hnbrdf_prepare_analytic(model, hnbrdf_model_material(model, k), &m);
            hnbrdf_prepare_lobes(model, hnbrdf_model_material(model, k), &m);
            hnbrdf_rng_seed(&rng, 3, (uint64_t)k);
            for (size_t i = 0; i < PAIRS; i++) {
                int usual = is_usual(check_pair_draw(&rng, i, pair));
                const float u[2] = {hnbrdf_rng_float(&rng), hnbrdf_rng_float(&rng)};
                if (usual)
                    check_pair(&sets[i % 2], &m, pair, u, &directions, &densities);
            }
        }
        assert_true(directions.unbounded * 50 < directions.bounded);
        assert_true(densities.unbounded * 50 < densities.bounded);
        assert_true(directions.narrow * 20 > directions.bounded * 19);
        assert_true(densities.narrow * 20 > densities.bounded * 19);
        hnbrdf_model_free(model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_cover_a_device_without_rounding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
