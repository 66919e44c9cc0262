/* half.c: the half-precision variant of a network as exported, in C, each number with a bound.
 *
 * A sum or product of two halves, taken in float and then rounded, is the correctly rounded one:
 * float has more than twice the digits. So each operation here is what a device with exact half
 * arithmetic does. */
#include "check/half.h"

#include "core/compose.h"
#include "core/encoding.h"
#include "core/prepared.h"
#include "glsl/half.h"

typedef check_tracked num;

/* Of this file's own rounding: relative, and absolute among the subnormal halves. */
static const double NEAREST = 0x1p-11, TINY = 0x1p-25;

/* How far a device that rounds as hnbrdf_round_to_half() does can be from its result for v, when
 * what it rounds is within spread of v: rounding is monotonic, so only the ends count. Mostly 0. */
static double moved(float v, double spread)
{
    float high = nextafterf((float)((double)v + spread), INFINITY);
    float low = nextafterf((float)((double)v - spread), -INFINITY), here = hnbrdf_round_to_half(v);
    if (!(spread < (double)INFINITY))
        return (double)INFINITY;
    return fmax((double)(hnbrdf_round_to_half(high) - here),
                (double)(here - hnbrdf_round_to_half(low)));
}

/* v before it is rounded here; spread: what the operands differ by, carried through. */
static num rounded(const check_rules *rules, float v, double spread)
{
    num r = {hnbrdf_round_to_half(v), 0.0};
    double size = fabs((double)v);
    if (!rules->repeats_half)
        r.e = spread + rules->half * (size + spread) + NEAREST * size + rules->half_tiny + TINY;
    else if (spread != 0.0)
        r.e = moved(v, spread);
    return r;
}

static double product_spread(num a, num b)
{
    return fabs((double)a.v) * b.e + fabs((double)b.v) * a.e + a.e * b.e;
}

/* min(x clamp(x/3 + 1/2, 0, 1), limit), as hnbrdf_half_unit() in the shader. */
static num half_unit(const check_rules *rules, num x, float limit)
{
    float third = hnbrdf_round_to_half(0.333251953f);
    num t = rounded(rules, x.v * third, x.e * (double)third);
    t = rounded(rules, t.v + 0.5f, t.e);
    t.v = fminf(fmaxf(t.v, 0.0f), 1.0f);
    num y = rounded(rules, x.v * t.v, product_spread(x, t));
    y.v = fminf(y.v, limit);
    return y;
}

/* In the order of summation, each kept within the limit of the first layer. */
static void half_inputs(const check_rules *rules, const hnbrdf_model_desc *desc,
                        const float *latent, const num x[HNBRDF_ENCODING_SIZE], num *inputs)
{
    float limit = hnbrdf_half_limit(desc, 0);
    for (int i = 0; i < desc->latent; i++)
        inputs[i] = rounded(rules, hnbrdf_clamp(latent[i], -limit, limit), 0.0);
    for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++)
        inputs[desc->latent + i] = rounded(rules, hnbrdf_clamp(x[i].v, -limit, limit), x[i].e);
}

/* n products and a bias in any order, contracted or not, err by at most r u / (1 - r u) times the
 * sum of sizes, r = n + 1 (Higham 2002, 3.1). */
static double growth(int terms, double unit)
{
    double r = (terms + 1) * unit;
    return r / (1.0 - r);
}

static num half_row(const check_rules *rules, const hnbrdf_model_desc *desc, int layer, int row,
                    const num *inputs)
{
    int columns = hnbrdf_layer_inputs(desc, layer), first = layer == 0 ? desc->latent : 0;
    const float *w = desc->weights[layer] + (size_t)row * (size_t)columns;
    num sum = {hnbrdf_half_bias(desc, layer, desc->biases[layer][row]), 0.0};
    double size = fabs((double)sum.v), spread = 0.0;
    for (int i = 0; i < columns; i++) {
        int column = layer > 0 ? i : i < first ? HNBRDF_ENCODING_SIZE + i : i - first;
        float weight = hnbrdf_half_weight(desc, layer, w[column]);
        num product = rounded(rules, weight * inputs[i].v, fabs((double)weight) * inputs[i].e);
        sum = rounded(rules, sum.v + product.v, sum.e + product.e);
        size += fabs((double)weight * (double)inputs[i].v);
        spread += fabs((double)weight) * inputs[i].e;
    }
    if (!rules->repeats_half) /* nor perhaps the order of the sum */
        sum.e = spread + growth(columns, rules->half) * (size + spread) +
                growth(columns, NEAREST) * size + columns * (rules->half_tiny + TINY);
    return sum;
}

void check_half_hidden(const check_rules *rules, const hnbrdf_model_desc *desc, const float *latent,
                       const check_tracked x[HNBRDF_ENCODING_SIZE],
                       check_tracked units[HNBRDF_MAX_HIDDEN])
{
    num from[HNBRDF_MAX_HIDDEN];
    half_inputs(rules, desc, latent, x, from);
    for (int layer = 0; layer < desc->layers; layer++) {
        float limit = hnbrdf_half_limit(desc, layer + 1);
        for (int row = 0; row < desc->hidden; row++)
            units[row] = half_unit(rules, half_row(rules, desc, layer, row, from), limit);
        for (int row = 0; row < desc->hidden; row++)
            from[row] = units[row];
    }
}

void check_half_network(const hnbrdf_model_desc *desc, const float *latent,
                        const float x[HNBRDF_ENCODING_SIZE], float out[HNBRDF_MAX_OUTPUTS])
{
    static const check_rules exact = {.repeats_half = 1};
    num inputs[HNBRDF_ENCODING_SIZE], units[HNBRDF_MAX_HIDDEN];
    for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++)
        inputs[i] = (num){x[i], 0.0};
    check_half_hidden(&exact, desc, latent, inputs, units);
    for (int row = 0; row < hnbrdf_layer_outputs(desc, desc->layers); row++) {
        const float *w = desc->weights[desc->layers] + (size_t)row * (size_t)desc->hidden;
        float sum = desc->biases[desc->layers][row];
        for (int i = 0; i < desc->hidden; i++)
            sum += w[i] * units[i].v;
        out[row] = sum;
    }
}

void check_half_eval(const hnbrdf_model *model, const hnbrdf_material *material, const float wi[3],
                     const float wo[3], float f[3])
{
    const hnbrdf_model_desc *desc = &model->desc;
    if (desc->kind == HNBRDF_KIND_GGX || !(wi[2] > 0.0f && wo[2] > 0.0f)) {
        hnbrdf_eval(model, material, wi, wo, f);
        return;
    }
    hnbrdf_prepared prepared;
    float x[HNBRDF_ENCODING_SIZE], out[HNBRDF_MAX_OUTPUTS], f_a[4], fitted[4];
    hnbrdf_prepare_analytic(model, material, &prepared);
    hnbrdf_pair pair = hnbrdf_pair_in_frame(&prepared, wi, wo);
    hnbrdf_pair seen = pair;
    if (prepared.edited)
        seen = hnbrdf_prepared_edited(&prepared, &pair, f_a, fitted);
    else
        hnbrdf_prepared_analytic(&prepared, &pair, f_a);
    hnbrdf_encode(desc->encoding, &seen, x);
    check_half_network(desc, material->latent, x, out);
    for (int c = 0; c < 3; c++)
        f[c] = desc->kind == HNBRDF_KIND_NEURAL
                   ? hnbrdf_compose_neural(out[c], desc->scale, desc->shift, desc->floor)
               : prepared.edited ? hnbrdf_compose_edited(out[c], out[3 + c], f_a[c], fitted[c],
                                                         prepared.edit.added[c], desc->scale,
                                                         desc->shift, desc->floor)
                                 : hnbrdf_compose_hybrid(out[c], out[3 + c], f_a[c], desc->scale,
                                                         desc->shift, desc->floor);
    if (prepared.conserved)
        hnbrdf_prepared_conserve(&prepared, wi, wo, f);
}
