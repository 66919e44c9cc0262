/* bounds_draw.c: sampling.h once more with bounds. */
#include "check/bounds_draw.h"

#include "core/sampling.h"
#include "check/tracked.h"

/* ---- Lobes ----------------------------------------------------------------------------------- */

typedef struct lobe {
    num ax, ay;
    float scale;
    const float *share;
} lobe;

/* The roughness of the material, which a neural one does not have, times the scale. */
static num lobe_alpha(const check_rules *k, const hnbrdf_prepared *m, int axis, float scale)
{
    int neural = m->model->desc.kind == HNBRDF_KIND_NEURAL;
    num alpha = same(neural ? 1.0f : m->alpha[axis]);
    return clamp(multiply(k, same(fabsf(scale)), alpha), HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
}

static lobe make_lobe(const check_rules *k, const hnbrdf_prepared *m, int which)
{
    float scale = m->lobes.scale[which];
    return (lobe){lobe_alpha(k, m, 0, scale), lobe_alpha(k, m, 1, scale), scale,
                  m->lobes.share[which]};
}

static num share_at(const check_rules *k, const lobe *l, num z)
{
    num x = clamp(multiply(k, same(3.0f), root(k, z)), 0.0f, 3.0f), sum = same(0.0f);
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++) {
        num away = magnitude(subtract(k, x, same((float)j)));
        num hat = clamp(subtract(k, same(1.0f), away), 0.0f, 1.0f);
        num part = multiply(k, hat, given(k, l->share[j]));
        sum = j == 0 ? part : add(k, sum, part);
    }
    return sum;
}

/* hnbrdf_cap_bound(). */
static num cap_bound(const check_rules *k, const num w[3], const lobe *l)
{
    num one = same(1.0f), a = smallest(l->ax, l->ay), a2 = multiply(k, a, a);
    num s = add(k, one, root(k, add(k, multiply(k, w[0], w[0]), multiply(k, w[1], w[1]))));
    num s2 = multiply(k, s, s);
    return divide(k, multiply(k, subtract(k, one, a2), s2),
                  add(k, s2, multiply(k, a2, multiply(k, w[2], w[2]))));
}

static num stretched_length(const check_rules *k, const num w[3], const lobe *l)
{
    return root(k, dot3(k, multiply(k, l->ax, w[0]), multiply(k, l->ay, w[1]), w[2]));
}

/* ---- Density --------------------------------------------------------------------------------- */

static num lobe_density(const check_rules *k, const lobe *l, const pair *p)
{
    num v = divide(k, p->s[2], p->length2);
    if (!(l->scale < 0.0f))
        v = divide(
            k, same(1.0f),
            add(k, multiply(k, cap_bound(k, p->wo, l), p->wo[2]), stretched_length(k, p->wo, l)));
    return multiply(k, ggx_d(k, p, l->ax, l->ay), multiply(k, same(0.5f), v));
}

/* A share that is 0 on both sides adds nothing, whatever its lobe is. */
static num shared(const check_rules *k, num share, const lobe *l, const pair *p)
{
    if (share.v == 0.0f && share.e == 0.0)
        return same(0.0f);
    num part = multiply(k, share, lobe_density(k, l, p));
    part.v = share.v > 0.0f ? part.v : 0.0f;
    return part;
}

check_tracked check_density_make(const check_rules *rules, const hnbrdf_prepared *prepared,
                                 const float wi[3], const float wo[3], double drift)
{
    const check_rules *k = rules;
    const hnbrdf_frame frame = {prepared->cosine, prepared->sine};
    const lobe lobes[HNBRDF_LOBES] = {make_lobe(k, prepared, 0), make_lobe(k, prepared, 1)};
    pair p = make_pair(k, frame, wi, wo, drift);
    num first = share_at(k, &lobes[0], p.wo[2]), second = share_at(k, &lobes[1], p.wo[2]);
    num sum = add(k, shared(k, first, &lobes[0], &p), shared(k, second, &lobes[1], &p));
    num rest = clamp(subtract(k, same(1.0f), add(k, first, second)), 0.0f, 1.0f);
    num cosine = multiply(k, p.wi[2], same(HNBRDF_INV_PI));
    return clamp(add(k, sum, multiply(k, rest, cosine)), 0.0f, HNBRDF_MAX_VALUE);
}

/* ---- Drawing --------------------------------------------------------------------------------- */

/* Sine and cosine of 2 pi u. Both sides are within 1.1e-7 of the truth where their operations round
 * as C's do; another order of the sums of numbers up to 1 costs a device one more rounding. */
static void sincos_turn(const check_rules *k, num u, num *sine, num *cosine)
{
    const double two_pi = 6.2831853071795865, c_error = 1.1e-7;
    double e = k->tiny;
    if (!(u.e == 0.0 && k->repeats_basic))
        e += two_pi * u.e + 2 * c_error + 0x1p-24;
    hnbrdf_sincos_turn(u.v, &sine->v, &cosine->v);
    sine->e = cosine->e = e;
}

/* What C chose, and whether every device must. */
typedef struct choice {
    int is_lobe, certain;
    lobe from;
    num azimuth;
} choice;

static int on_one_side(float u0, num border)
{
    return border.e == 0.0 || fabs((double)u0 - (double)border.v) > border.e;
}

/* hnbrdf_choose(). */
static choice choose(const check_rules *k, const lobe lobes[HNBRDF_LOBES], num z, float u0)
{
    num first = share_at(k, &lobes[0], z), second = share_at(k, &lobes[1], z);
    num both = add(k, first, second), low = both, size = subtract(k, same(1.0f), both);
    int is_first = u0 < first.v, is_lobe = u0 < both.v;
    if (is_lobe) {
        low = is_first ? same(0.0f) : first;
        size = is_first ? first : second;
    }
    num within = divide(k, subtract(k, given(k, u0), low), size);
    return (choice){.is_lobe = is_lobe,
                    .certain = on_one_side(u0, first) && on_one_side(u0, both),
                    .from = lobes[is_first ? 0 : 1],
                    .azimuth = clamp(within, 0.0f, HNBRDF_BELOW_1)};
}

/* A normal, not normalised, of the lobe: hnbrdf_draw_visible(), hnbrdf_draw_normal(). */
static void draw_normal(const check_rules *k, const choice *c, const num wo[3], num u, num h[3])
{
    const lobe *l = &c->from;
    num one = same(1.0f), turn[2], rest = subtract(k, one, u);
    sincos_turn(k, c->azimuth, &turn[1], &turn[0]);
    const num alpha[2] = {l->ax, l->ay};
    if (l->scale < 0.0f) {
        num radius = root(k, u);
        for (int i = 0; i < 2; i++)
            h[i] = multiply(k, alpha[i], multiply(k, radius, turn[i]));
        h[2] = root(k, rest);
        return;
    }
    num length = stretched_length(k, wo, l), w[3];
    for (int i = 0; i < 3; i++)
        w[i] = divide(k, i < 2 ? multiply(k, alpha[i], wo[i]) : wo[i], length);
    num bound = multiply(k, cap_bound(k, wo, l), w[2]);
    num cap = subtract(k, multiply(k, rest, add(k, one, bound)), bound);
    num radius = root(k, clamp(subtract(k, one, multiply(k, cap, cap)), 0.0f, 1.0f));
    for (int i = 0; i < 2; i++)
        h[i] = multiply(k, alpha[i], add(k, multiply(k, radius, turn[i]), w[i]));
    h[2] = add(k, cap, w[2]);
}

/* wo reflected about h. Returns 1 where h is a normal on every device, 0 where on none, -1 where
 * that is not known. */
static int reflect(const check_rules *k, const num wo[3], const num h[3], num w[3])
{
    num h2 = dot3(k, h[0], h[1], h[2]);
    num along = add(k, multiply(k, wo[0], h[0]), multiply(k, wo[1], h[1]));
    along = add(k, along, multiply(k, wo[2], h[2]));
    num twice = multiply(k, same(2.0f), divide(k, along, h2));
    for (int i = 0; i < 3; i++)
        w[i] = subtract(k, multiply(k, twice, h[i]), wo[i]);
    return h2.e == 0.0 ? h2.v > 0.0f : (double)h2.v > h2.e ? 1 : -1;
}

/* In the tangent frame. Returns as reflect(). */
static int draw(const check_rules *k, const choice *c, const num wo[3], float u1, num w[3])
{
    num u = given(k, hnbrdf_clamp(u1, 0.0f, HNBRDF_BELOW_1)), h[3], turn[2];
    if (c->is_lobe) {
        draw_normal(k, c, wo, u, h);
        return reflect(k, wo, h, w);
    }
    sincos_turn(k, c->azimuth, &turn[1], &turn[0]);
    num radius = root(k, u);
    for (int i = 0; i < 2; i++)
        w[i] = multiply(k, radius, turn[i]);
    w[2] = root(k, subtract(k, same(1.0f), u));
    return 1;
}

static void from_tangent(const check_rules *k, hnbrdf_frame frame, num w[3])
{
    num x = w[0], y = w[1], cosine = given(k, frame.cosine), sine = given(k, frame.sine);
    if (frame.cosine == 1.0f && frame.sine == 0.0f)
        return;
    w[0] = subtract(k, multiply(k, cosine, x), multiply(k, sine, y));
    w[1] = add(k, multiply(k, cosine, y), multiply(k, sine, x));
}

/* Whether z > 0 on every device (1), on none (0), or not known (-1). */
static int is_above(num z)
{
    if (z.e == 0.0)
        return z.v > 0.0f;
    return (double)z.v > z.e ? 1 : (double)z.v < -z.e ? 0 : -1;
}

void check_draw_make(const check_rules *rules, const hnbrdf_prepared *prepared, const float wo[3],
                     const float u[2], check_tracked wi[3])
{
    const check_rules *k = rules;
    const hnbrdf_frame frame = {prepared->cosine, prepared->sine};
    const lobe lobes[HNBRDF_LOBES] = {make_lobe(k, prepared, 0), make_lobe(k, prepared, 1)};
    num o[3], w[3];
    to_tangent(k, frame, wo, o);
    choice c = choose(k, lobes, o[2], hnbrdf_clamp(u[0], 0.0f, HNBRDF_BELOW_1));
    int has_normal = draw(k, &c, o, u[1], w), above = is_above(w[2]);
    int certain = c.certain && has_normal >= 0 && (has_normal == 0 || above >= 0) &&
                  o[2].e == 0.0; /* flushed, wo is not above the horizon */
    from_tangent(k, frame, w);
    float drawn[3];
    double density = 0.0;
    if (has_normal != 0 && w[2].v > 0.0f) {
        for (int i = 0; i < 3; i++)
            drawn[i] = w[i].v;
        /* a density that rounding may bring to 0 is none */
        num at = check_density_make(k, prepared, drawn, wo, 0.0);
        density = (double)at.v;
        certain = certain && (density > 0x1p-100 || (at.e == 0.0 && w[0].e == 0.0));
    }
    for (int i = 0; i < 3; i++) {
        wi[i] = density > 0.0 ? w[i] : same(i == 2 ? 1.0f : 0.0f);
        if (!certain)
            wi[i].e = (double)INFINITY;
    }
}
