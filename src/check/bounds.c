/* bounds.c: the BRDF evaluated once more, every number with a bound on the distance between
 * device and C: tracked.h says how. */
#include "check/bounds.h"

#include "core/encoding.h"
#include "core/frame.h"
#include "check/bounds_edit.h"
#include "check/half.h"

/* ---- The BRDF, in the words of encoding.h, network.h and compose.h --------------------------- */

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
    num d2 = dot3(k, apart(k, p, 0), apart(k, p, 1), apart(k, p, 2));
    num tan2 = add(k, same(1e-5f), divide(k, r2, multiply(k, p->s[2], p->s[2])));
    x[0] = add(k, same(1.0f), multiply(k, same(0.25f), logarithm(k, tan2)));
    x[1] = root(k, root(k, divide(k, r2, p->length2)));
    x[2] = p->c;
    x[3] = root(k, divide(k, multiply(k, same(0.25f), d2), add(k, same(1.0f), p->c)));
    x[4] = multiply(k, p->wi[2], p->wo[2]);
    x[5] = add(k, p->wi[2], p->wo[2]);
}

/* a, b: the cosines of incidence in the order of the encoding. */
static void encode_angles(const check_rules *k, const pair *p, num a, num b,
                          num x[HNBRDF_ENCODING_SIZE])
{
    num r2 = add(k, multiply(k, p->s[0], p->s[0]), multiply(k, p->s[1], p->s[1]));
    num d2 = dot3(k, apart(k, p, 0), apart(k, p, 1), apart(k, p, 2));
    num q = divide(k, multiply(k, same(0.25f), d2), add(k, same(1.0f), p->c));
    num tan2 = add(k, same(1e-5f), divide(k, r2, multiply(k, p->s[2], p->s[2])));
    x[0] = add(k, same(1.0f), multiply(k, same(0.25f), logarithm(k, tan2)));
    x[1] = root(k, divide(k, r2, p->length2));
    x[2] = multiply(k, same(0.25f), logarithm(k, add(k, same(1e-3f), q)));
    x[3] = q;
    x[4] = a;
    x[5] = b;
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
    case HNBRDF_ENCODING_ANGLES_AZIMUTHS:
        encode_angles(k, p, swap ? p->wo[2] : p->wi[2], swap ? p->wi[2] : p->wo[2], x);
        if (encoding == HNBRDF_ENCODING_ANGLES_ANISOTROPIC) {
            num length = root(k, p->length2);
            x[1] = divide(k, magnitude(p->s[0]), length);
            x[3] = divide(k, magnitude(p->s[1]), length);
        }
        if (encoding == HNBRDF_ENCODING_ANGLES_AZIMUTHS) {
            x[1] = divide(k, magnitude(p->s[0]), root(k, p->length2));
            x[5] = multiply(k, same(0.5f), magnitude(apart(k, p, 0)));
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

/* k(z) of one cosine, as hnbrdf_energy_at() has it. */
static num energy_at(const check_rules *rules, const hnbrdf_energy *energy, num z)
{
    const num slope = given(rules, energy->slope), horizon = given(rules, energy->horizon);
    return clamp(add(rules, horizon, multiply(rules, slope, z)), 0.0f, 1.0f);
}

static void conserve(const check_rules *rules, const hnbrdf_energy *energy, const pair *p,
                     check_bounds *bounds)
{
    const num factor =
        multiply(rules, energy_at(rules, energy, p->wi[2]), energy_at(rules, energy, p->wo[2]));
    for (int c = 0; c < 3; c++)
        bounds->value[c] = multiply(rules, bounds->value[c], factor);
}

/* All but the factor of a material that conserves energy. */
static void make_value(const check_rules *rules, const hnbrdf_model_desc *desc,
                       hnbrdf_glsl_precision precision, const hnbrdf_material *material,
                       const pair *p, check_bounds *bounds)
{
    num f_a[3], out[HNBRDF_MAX_OUTPUTS], exact[HNBRDF_ENCODING_SIZE];
    analytic(rules, material, p, f_a);
    for (int c = 0; c < 3 && desc->kind != HNBRDF_KIND_NEURAL; c++)
        bounds->analytic[c] = finish(f_a[c]);
    if (desc->kind == HNBRDF_KIND_GGX) {
        for (int c = 0; c < 3; c++)
            bounds->value[c] = bounds->analytic[c];
        return;
    }
    check_edit edit;
    const int edited = desc->kind == HNBRDF_KIND_HYBRID && hnbrdf_material_is_edited(material);
    if (edited)
        check_edit_make(rules, desc->encoding, material, p, &edit);
    encode(rules, desc->encoding, edited ? &edit.seen : p, bounds->encoding);
    for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++)
        exact[i] = given(rules, bounds->encoding[i].v);
    network(rules, desc, precision, material->latent, exact, bounds->fed);
    network(rules, desc, precision, material->latent, bounds->encoding, out);
    for (int c = 0; c < 3; c++) {
        num f = correction(rules, desc, out[c]), floor = same(desc->floor);
        if (edited) {
            num sigmoid = gate(rules, out[3 + c]);
            bounds->value[c] = finish(check_edit_compose(rules, &edit, c, f, sigmoid, floor));
            continue;
        }
        if (desc->kind == HNBRDF_KIND_HYBRID)
            f = add(rules, f, multiply(rules, gate(rules, out[3 + c]), f_a[c]));
        bounds->value[c] = finish(subtract(rules, f, floor));
    }
}

void check_bounds_make(const check_rules *rules, const hnbrdf_model_desc *desc,
                       hnbrdf_glsl_precision precision, const hnbrdf_material *material,
                       const float wi[3], const float wo[3], double drift, check_bounds *bounds)
{
    static const check_bounds zero;
    const pair p = make_pair(rules, hnbrdf_frame_of(material), wi, wo, drift);
    *bounds = zero;
    make_value(rules, desc, precision, material, &p, bounds);
    if (hnbrdf_has_energy(&material->energy))
        conserve(rules, &material->energy, &p, bounds);
}
