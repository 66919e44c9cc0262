/* bounds.c: the BRDF evaluated once more, every number with a bound on the distance between
 * device and C.
 *
 * Both round: a device result is (a' o b')(1 + d) + t with |d| and |t| from the rules and a', b'
 * the device's operands; C's is (a o b)(1 + d) with |d| <= 2^-24. What the operands differ by is
 * carried through the operation exactly, |a' o b' - a o b|, to first and second order. Where
 * operands are equal and the rules say that the device repeats C's bits, the difference is 0. */
#include "check/bounds.h"

#include "core/compose.h"
#include "core/encoding.h"
#include "core/frame.h"
#include "check/half.h"

#include <float.h>

typedef check_tracked num;

static const double HALF_ULP = 0x1p-24;
static const double SLACK = 1.0 + 1e-6; /* for products of rounding errors, which are not carried */

static num same(float v)
{
    return (num){v, 0.0};
}

static int subnormal(float v)
{
    return v != 0.0f && fabsf(v) < FLT_MIN;
}

/* A number given to the device: 0 there if it is subnormal and those are flushed. */
static num given(const check_rules *rules, float v)
{
    return (num){v, rules->tiny > 0.0 && subnormal(v) ? fabs((double)v) : 0.0};
}

/* v: C's result; spread: |a' o b' - a o b|; relative: the device's rounding; repeats: see above. */
static num result_of(float v, double spread, double relative, int repeats, double tiny)
{
    num r = {v, spread};
    double size = fabs((double)v);
    if (!(spread == 0.0 && repeats && !(tiny > 0.0 && subnormal(v))))
        r.e = (spread + relative * (size + spread) + HALF_ULP * size) * SLACK + tiny;
    if (!(r.e >= 0.0) || !isfinite(v))
        r.e = (double)INFINITY;
    return r;
}

static num basic(const check_rules *rules, float v, double spread)
{
    return result_of(v, spread, rules->basic, rules->repeats_basic, rules->tiny);
}

static num add(const check_rules *rules, num a, num b)
{
    return basic(rules, a.v + b.v, a.e + b.e);
}

static num subtract(const check_rules *rules, num a, num b)
{
    return basic(rules, a.v - b.v, a.e + b.e);
}

static num multiply(const check_rules *rules, num a, num b)
{
    return basic(rules, a.v * b.v, fabs((double)a.v) * b.e + fabs((double)b.v) * a.e + a.e * b.e);
}

HNBRDF_DIVIDES_AS_IEEE
static num divide(const check_rules *rules, num a, num b)
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

static num root(const check_rules *rules, num a)
{
    double size = (double)a.v, least = size > a.e ? size - a.e : 0.0;
    return result_of(sqrtf(a.v), sqrt(size) - sqrt(least), rules->sqrt, rules->repeats_sqrt,
                     rules->tiny);
}

static num clamp(num a, float low, float high)
{
    float v = hnbrdf_clamp(a.v, low, high);
    double l = (double)low, h = (double)high;
    double up = fmin(fmax((double)a.v + a.e, l), h) - (double)v;
    double down = (double)v - fmin(fmax((double)a.v - a.e, l), h);
    return (num){v, a.e < (double)INFINITY ? fmax(up, down) : (double)INFINITY};
}

/* exp and log: both sides approximate the same function. */
static num exponential(const check_rules *rules, num a)
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

static num logarithm(const check_rules *rules, num a)
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

/* ---- The BRDF, in the words of microfacet.h, encoding.h, network.h and compose.h ------------- */

typedef struct pair {
    num wi[3], wo[3], s[3];
    num length2, c;
} pair;

static num dot3(const check_rules *k, num x, num y, num z)
{
    return add(k, add(k, multiply(k, x, x), multiply(k, y, y)), multiply(k, z, z));
}

static void to_tangent(const check_rules *k, hnbrdf_frame frame, const float w[3], num t[3])
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

static pair make_pair(const check_rules *k, hnbrdf_frame frame, const float wi[3],
                      const float wo[3])
{
    pair p;
    to_tangent(k, frame, wi, p.wi);
    to_tangent(k, frame, wo, p.wo);
    if (p.wi[2].e > 0.0 || p.wo[2].e > 0.0) /* flushed, it is not above the horizon */
        p.wi[2].e = p.wo[2].e = (double)INFINITY;
    for (int i = 0; i < 3; i++)
        p.s[i] = add(k, p.wi[i], p.wo[i]);
    p.length2 = dot3(k, p.s[0], p.s[1], p.s[2]);
    p.c = multiply(k, same(0.5f), root(k, p.length2));
    return p;
}

static num ggx_d(const check_rules *k, const pair *p, num ax, num ay)
{
    num t = divide(k, dot3(k, divide(k, p->s[0], ax), divide(k, p->s[1], ay), p->s[2]), p->length2);
    num area = multiply(k, multiply(k, same(HNBRDF_PI), ax), ay);
    return divide(k, same(1.0f), multiply(k, area, multiply(k, t, t)));
}

static num smith_v(const check_rules *k, const num w[3], num ax, num ay)
{
    num length = root(k, dot3(k, multiply(k, ax, w[0]), multiply(k, ay, w[1]), w[2]));
    return divide(k, same(1.0f), add(k, w[2], length));
}

static num fresnel_dielectric(const check_rules *k, num eta, num c)
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

static void analytic(const check_rules *k, const hnbrdf_material *material, const pair *p, num f[3])
{
    num ax = same(material->alpha[0]), ay = same(material->alpha[1]);
    num masking = multiply(k, smith_v(k, p->wi, ax, ay), smith_v(k, p->wo, ax, ay));
    num specular = multiply(k, ggx_d(k, p, ax, ay), masking);
    for (int c = 0; c < 3; c++) {
        num diffuse = multiply(k, given(k, material->kd[c]), same(HNBRDF_INV_PI));
        num fresnel = fresnel_dielectric(k, same(material->eta[c]), p->c);
        f[c] = add(k, diffuse, multiply(k, fresnel, specular));
    }
}

static void encode_half_difference(const check_rules *k, const pair *p, num x[HNBRDF_ENCODING_SIZE])
{
    num r2 = add(k, multiply(k, p->s[0], p->s[0]), multiply(k, p->s[1], p->s[1]));
    num d2 = dot3(k, subtract(k, p->wi[0], p->wo[0]), subtract(k, p->wi[1], p->wo[1]),
                  subtract(k, p->wi[2], p->wo[2]));
    num tan2 = add(k, same(1e-5f), divide(k, r2, multiply(k, p->s[2], p->s[2])));
    x[0] = add(k, same(1.0f), multiply(k, same(0.25f), logarithm(k, tan2)));
    x[1] = root(k, root(k, divide(k, r2, p->length2)));
    x[2] = p->c;
    x[3] = root(k, divide(k, multiply(k, same(0.25f), d2), add(k, same(1.0f), p->c)));
    x[4] = multiply(k, p->wi[2], p->wo[2]);
    x[5] = p->s[2];
}

/* a, b: the cosines of incidence in the order of the encoding. */
static void encode_angles(const check_rules *k, const pair *p, num a, num b,
                          num x[HNBRDF_ENCODING_SIZE])
{
    num r2 = add(k, multiply(k, p->s[0], p->s[0]), multiply(k, p->s[1], p->s[1]));
    num d2 = dot3(k, subtract(k, p->wi[0], p->wo[0]), subtract(k, p->wi[1], p->wo[1]),
                  subtract(k, p->wi[2], p->wo[2]));
    num q = divide(k, multiply(k, same(0.25f), d2), add(k, same(1.0f), p->c));
    num tan2 = add(k, same(1e-5f), divide(k, r2, multiply(k, p->s[2], p->s[2])));
    x[0] = add(k, same(1.0f), multiply(k, same(0.25f), logarithm(k, tan2)));
    x[1] = root(k, divide(k, r2, p->length2));
    x[2] = multiply(k, same(0.25f), logarithm(k, add(k, same(1e-3f), q)));
    x[3] = q;
    x[4] = a;
    x[5] = b;
}

static num magnitude(num a)
{
    return (num){fabsf(a.v), a.e};
}

static void encode(const check_rules *k, hnbrdf_encoding encoding, const pair *p,
                   num x[HNBRDF_ENCODING_SIZE])
{
    int swap = encoding != HNBRDF_ENCODING_ANGLES_DIRECTED && p->wo[2].v < p->wi[2].v;
    switch (encoding) {
    case HNBRDF_ENCODING_DIRECTIONS:
        for (int i = 0; i < 3; i++) {
            x[i] = p->wi[i];
            x[3 + i] = p->wo[i];
        }
        break;
    case HNBRDF_ENCODING_HALF_DIFFERENCE:
        encode_half_difference(k, p, x);
        break;
    case HNBRDF_ENCODING_ANGLES_DIRECTED:
    case HNBRDF_ENCODING_ANGLES:
    case HNBRDF_ENCODING_ANGLES_ANISOTROPIC:
        encode_angles(k, p, swap ? p->wo[2] : p->wi[2], swap ? p->wi[2] : p->wo[2], x);
        if (encoding == HNBRDF_ENCODING_ANGLES_ANISOTROPIC) {
            num length = root(k, p->length2);
            x[1] = divide(k, magnitude(p->s[0]), length);
            x[3] = divide(k, magnitude(p->s[1]), length);
        }
        break;
    }
}

/* Adds `count` products to a sum in C's order, and to the two sums that the bound is made of. */
typedef struct row_sum {
    float v;
    double size, spread; /* sum of |w||a|, of |w| e(a) */
    int flushes;         /* 1 if a subnormal number came up */
} row_sum;

static void add_products(row_sum *sum, const float *w, const num *a, int count)
{
    for (int i = 0; i < count; i++) {
        double weight = fabs((double)w[i]);
        float product = w[i] * a[i].v;
        sum->v += product;
        sum->flushes |= subnormal(w[i]) || subnormal(product) || subnormal(sum->v);
        sum->size += weight * fabs((double)a[i].v);
        sum->spread += weight * a[i].e;
    }
}

/* n products and a bias, summed in any order with or without contraction, err by at most
 * n u / (1 - n u) times the sum of sizes (Higham 2002, 3.1), here n + 1 roundings; on both sides.
 */
static num finish_row(const check_rules *rules, const row_sum *sum, int terms)
{
    num r = {sum->v, sum->spread};
    if (!(sum->spread == 0.0 && rules->repeats_basic && !(rules->tiny > 0.0 && sum->flushes))) {
        double roundings = (terms + 1) * SLACK;
        double device = roundings * rules->basic * (sum->size + sum->spread);
        r.e =
            (sum->spread + device + roundings * HALF_ULP * sum->size) * SLACK + terms * rules->tiny;
    }
    if (!(r.e >= 0.0) || !isfinite(r.v))
        r.e = (double)INFINITY;
    return r;
}

static num hard_gelu(const check_rules *k, num x)
{
    num t = add(k, multiply(k, x, same(0.333333333f)), same(0.5f));
    return multiply(k, x, clamp(t, 0.0f, 1.0f));
}

/* The sums of one layer; codes are the inputs that come first, latent code or none. */
static void layer_sums(const check_rules *rules, const hnbrdf_model_desc *desc, int layer,
                       const num *codes, const num *from, num *to)
{
    int columns = hnbrdf_layer_inputs(desc, layer), rows = hnbrdf_layer_outputs(desc, layer);
    for (int row = 0; row < rows; row++) {
        const float *w = desc->weights[layer] + (size_t)row * (size_t)columns;
        float bias = desc->biases[layer][row];
        row_sum sum = {bias, fabs((double)bias), 0.0, subnormal(bias)};
        if (layer == 0)
            add_products(&sum, w + HNBRDF_ENCODING_SIZE, codes, desc->latent);
        add_products(&sum, w, from, layer == 0 ? HNBRDF_ENCODING_SIZE : columns);
        to[row] = finish_row(rules, &sum, columns);
    }
}

static void network(const check_rules *rules, const hnbrdf_model_desc *desc,
                    hnbrdf_glsl_precision precision, const float *latent,
                    const num x[HNBRDF_ENCODING_SIZE], num out[HNBRDF_MAX_OUTPUTS])
{
    num layers[2][HNBRDF_MAX_HIDDEN], codes[HNBRDF_MAX_LATENT];
    const num *from = x;
    if (precision == HNBRDF_GLSL_HALF) {
        check_half_hidden(rules, desc, latent, x, layers[0]);
        layer_sums(rules, desc, desc->layers, NULL, layers[0], out);
        return;
    }
    for (int i = 0; i < desc->latent; i++)
        codes[i] = given(rules, latent[i]);
    for (int layer = 0; layer < desc->layers; layer++) {
        num *to = layers[layer % 2];
        layer_sums(rules, desc, layer, codes, from, to);
        for (int row = 0; row < desc->hidden; row++)
            to[row] = hard_gelu(rules, to[row]);
        from = to;
    }
    layer_sums(rules, desc, desc->layers, NULL, from, out);
}

static num correction(const check_rules *k, const hnbrdf_model_desc *desc, num c)
{
    num exponent = c;
    if (desc->scale != 1.0f)
        exponent = multiply(k, same(desc->scale), exponent);
    if (desc->shift != 0.0f)
        exponent = add(k, exponent, same(desc->shift));
    return exponential(k, clamp(exponent, -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT));
}

static num gate(const check_rules *k, num g)
{
    num exponent = clamp((num){-g.v, g.e}, -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT);
    num sigmoid = divide(k, same(1.0f), add(k, same(1.0f), exponential(k, exponent)));
    if (g.e < (double)INFINITY) /* both sides are in [0, 1], as far as 1/(1 + e) rounds */
        sigmoid.e = fmin(sigmoid.e, 1.0 + k->divide);
    return sigmoid;
}

static num finish(num f)
{
    return clamp(f, 0.0f, HNBRDF_MAX_VALUE);
}

void check_bounds_make(const check_rules *rules, const hnbrdf_model_desc *desc,
                       hnbrdf_glsl_precision precision, const hnbrdf_material *material,
                       const float wi[3], const float wo[3], check_bounds *bounds)
{
    static const check_bounds zero;
    *bounds = zero;
    pair p = make_pair(rules, hnbrdf_frame_of(material), wi, wo);
    num f_a[3], out[HNBRDF_MAX_OUTPUTS], exact[HNBRDF_ENCODING_SIZE];
    analytic(rules, material, &p, f_a);
    for (int c = 0; c < 3 && desc->kind != HNBRDF_KIND_NEURAL; c++)
        bounds->analytic[c] = finish(f_a[c]);
    if (desc->kind == HNBRDF_KIND_GGX) {
        for (int c = 0; c < 3; c++)
            bounds->value[c] = bounds->analytic[c];
        return;
    }
    encode(rules, desc->encoding, &p, bounds->encoding);
    for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++)
        exact[i] = given(rules, bounds->encoding[i].v);
    network(rules, desc, precision, material->latent, exact, bounds->fed);
    network(rules, desc, precision, material->latent, bounds->encoding, out);
    for (int c = 0; c < 3; c++) {
        num f = correction(rules, desc, out[c]);
        if (desc->kind == HNBRDF_KIND_HYBRID)
            f = add(rules, f, multiply(rules, gate(rules, out[3 + c]), f_a[c]));
        bounds->value[c] = finish(subtract(rules, f, same(desc->floor)));
    }
}
