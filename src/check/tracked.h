/* tracked.h: arithmetic on numbers with a bound on the distance between device and C, for bounds.c.
 *
 * Both round: a device result is (a' o b')(1 + d) + t with |d| and |t| from the rules and a', b'
 * the device's operands; C's is (a o b)(1 + d) with |d| <= 2^-24. What the operands differ by is
 * carried through the operation exactly, |a' o b' - a o b|, to first and second order. Where
 * operands are equal and the rules say that the device repeats C's bits, the difference is 0. */
#ifndef HNBRDF_CHECK_TRACKED_H
#define HNBRDF_CHECK_TRACKED_H

#include "check/bounds.h"

#include "core/compose.h"
#include "core/frame.h"
#include "core/microfacet.h"

#include <float.h>

typedef check_tracked num;

static const double HALF_ULP = 0x1p-24;
static const double SLACK = 1.0 + 1e-6; /* for products of rounding errors, which are not carried */

static inline num same(float v)
{
    return (num){v, 0.0};
}

static inline int subnormal(float v)
{
    return v != 0.0f && fabsf(v) < FLT_MIN;
}

/* A number given to the device: 0 there if it is subnormal and those are flushed. */
static inline num given(const check_rules *rules, float v)
{
    return (num){v, rules->tiny > 0.0 && subnormal(v) ? fabs((double)v) : 0.0};
}

/* v: C's result; spread: |a' o b' - a o b|; relative: the device's rounding; repeats: see above. */
static inline num result_of(float v, double spread, double relative, int repeats, double tiny)
{
    num r = {v, spread};
    double size = fabs((double)v);
    if (!(spread == 0.0 && repeats && !(tiny > 0.0 && subnormal(v))))
        r.e = (spread + relative * (size + spread) + HALF_ULP * size) * SLACK + tiny;
    if (!(r.e >= 0.0) || !isfinite(v))
        r.e = (double)INFINITY;
    return r;
}

static inline num basic(const check_rules *rules, float v, double spread)
{
    return result_of(v, spread, rules->basic, rules->repeats_basic, rules->tiny);
}

static inline num add(const check_rules *rules, num a, num b)
{
    return basic(rules, a.v + b.v, a.e + b.e);
}

static inline num subtract(const check_rules *rules, num a, num b)
{
    return basic(rules, a.v - b.v, a.e + b.e);
}

static inline num multiply(const check_rules *rules, num a, num b)
{
    return basic(rules, a.v * b.v, fabs((double)a.v) * b.e + fabs((double)b.v) * a.e + a.e * b.e);
}

HNBRDF_DIVIDES_AS_IEEE
static inline num divide(const check_rules *rules, num a, num b)
{
    double size_a = fabs((double)a.v), size_b = fabs((double)b.v), least_b = size_b - b.e;
    double spread =
        a.e == 0.0 && b.e == 0.0 ? 0.0 : (size_a * b.e + size_b * a.e) / (size_b * least_b);
    /* Vulkan promises nothing for divisors outside of this range, nor the formula if b' can be 0.
     * */
    if ((!rules->repeats_divide || b.e > 0.0) && !(least_b >= 0x1p-126 && size_b + b.e <= 0x1p126))
        spread = (double)INFINITY;
    return result_of(a.v / b.v, spread, rules->divide, rules->repeats_divide, rules->tiny);
}

static inline num root(const check_rules *rules, num a)
{
    double size = (double)a.v, least = size > a.e ? size - a.e : 0.0;
    return result_of(sqrtf(a.v), sqrt(size) - sqrt(least), rules->sqrt, rules->repeats_sqrt,
                     rules->tiny);
}

static inline num clamp(num a, float low, float high)
{
    float v = hnbrdf_clamp(a.v, low, high);
    double l = (double)low, h = (double)high;
    double up = fmin(fmax((double)a.v + a.e, l), h) - (double)v;
    double down = (double)v - fmin(fmax((double)a.v - a.e, l), h);
    return (num){v, a.e < (double)INFINITY ? fmax(up, down) : (double)INFINITY};
}

static inline num magnitude(num a)
{
    return (num){fabsf(a.v), a.e};
}

/* exp and log: both sides approximate the same function. */
static inline num exponential(const check_rules *rules, num a)
{
    const double c_error = 1.1 * 0x1p-23; /* hnbrdf_exp */
    num r = {hnbrdf_exp(a.v), 0.0};
    double size = (double)r.v, x = fabs((double)a.v) + a.e;
    if (a.e == 0.0 && rules->repeats_functions && rules->repeats_basic)
        return r;
    double grown = size * exp(a.e); /* the device's true result is at most that */
    r.e = (grown - size + c_error * size + check_exp_error(rules, x, grown)) * SLACK + rules->tiny;
    return r;
}

static inline num logarithm(const check_rules *rules, num a)
{
    num r = {hnbrdf_log(a.v), 0.0};
    double x = (double)a.v, size = fabs((double)r.v), least = x - a.e;
    if (a.e == 0.0 && rules->repeats_functions && rules->repeats_basic && rules->repeats_divide)
        return r;
    if (!(least > 0.0) || !isfinite(a.v)) {
        r.e = (double)INFINITY;
        return r;
    }
    double spread = log(x / least), c_error = 1.05 * 0x1p-23 * size + 5e-8; /* hnbrdf_log */
    double near_1 = check_log_error(rules, 1.0, size + spread),
           far = check_log_error(rules, 4.0, size + spread);
    double device = least <= 2.0 && x + a.e >= 0.5 ? fmax(near_1, far) : far;
    r.e = (spread + c_error + device) * SLACK + rules->tiny;
    return r;
}

/* The larger or the smaller of two, whichever it is on either side. */
static inline num largest(num a, num b)
{
    return (num){a.v > b.v ? a.v : b.v, fmax(a.e, b.e)};
}

static inline num smallest(num a, num b)
{
    return (num){a.v < b.v ? a.v : b.v, fmax(a.e, b.e)};
}

/* ---- The BRDF, in the words of microfacet.h -------------------------------------------------- */

/* drift: how far wi is from what sum and difference of the directions are made of; see
 * check_bounds_make(). */
typedef struct pair {
    num wi[3], wo[3], s[3];
    num length2, c;
    double drift;
} pair;

static inline num dot3(const check_rules *k, num x, num y, num z)
{
    return add(k, add(k, multiply(k, x, x), multiply(k, y, y)), multiply(k, z, z));
}

static inline void to_tangent(const check_rules *k, hnbrdf_frame frame, const float w[3], num t[3])
{
    num x = given(k, w[0]), y = given(k, w[1]);
    num cosine = given(k, frame.cosine), sine = given(k, frame.sine);
    for (int i = 0; i < 3; i++)
        t[i] = given(k, w[i]);
    if (frame.cosine == 1.0f && frame.sine == 0.0f)
        return;
    t[0] = add(k, multiply(k, cosine, x), multiply(k, sine, y));
    t[1] = subtract(k, multiply(k, cosine, y), multiply(k, sine, x));
}

/* The sum or the difference of wi and wo, with the drift between them. */
static inline num drifted(num a, double drift)
{
    return (num){a.v, a.e + drift};
}

static inline num apart(const check_rules *k, const pair *p, int i)
{
    return drifted(subtract(k, p->wi[i], p->wo[i]), p->drift);
}

static inline pair make_pair(const check_rules *k, hnbrdf_frame frame, const float wi[3],
                             const float wo[3], double drift)
{
    pair p = {.drift = drift};
    to_tangent(k, frame, wi, p.wi);
    to_tangent(k, frame, wo, p.wo);
    if (p.wi[2].e > 0.0 || p.wo[2].e > 0.0) /* flushed, it is not above the horizon */
        p.wi[2].e = p.wo[2].e = (double)INFINITY;
    for (int i = 0; i < 3; i++)
        p.s[i] = drifted(add(k, p.wi[i], p.wo[i]), drift);
    p.length2 = dot3(k, p.s[0], p.s[1], p.s[2]);
    p.c = multiply(k, same(0.5f), root(k, p.length2));
    return p;
}

static inline num ggx_d(const check_rules *k, const pair *p, num ax, num ay)
{
    num t = divide(k, dot3(k, divide(k, p->s[0], ax), divide(k, p->s[1], ay), p->s[2]), p->length2);
    num area = multiply(k, multiply(k, same(HNBRDF_PI), ax), ay);
    return divide(k, same(1.0f), multiply(k, area, multiply(k, t, t)));
}

static inline num smith_v(const check_rules *k, const num w[3], num ax, num ay)
{
    num length = root(k, dot3(k, multiply(k, ax, w[0]), multiply(k, ay, w[1]), w[2]));
    return divide(k, same(1.0f), add(k, w[2], length));
}

static inline num fresnel_dielectric(const check_rules *k, num eta, num c)
{
    num one = same(1.0f);
    num e = multiply(k, subtract(k, eta, one), add(k, eta, one));
    num sum = add(k, root(k, add(k, e, multiply(k, c, c))), c);
    num difference = divide(k, e, sum);
    num a = divide(k, difference, sum);
    num b =
        divide(k, subtract(k, multiply(k, c, sum), one), add(k, multiply(k, c, difference), one));
    return multiply(k, multiply(k, same(0.5f), multiply(k, a, a)), add(k, one, multiply(k, b, b)));
}

#endif
