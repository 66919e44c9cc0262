/* rounding.c: the network in double, forwards for its partial sums and backwards for what each of
 * them means to f. */
#include "check/rounding.h"

#include <math.h>
#include <string.h>

static const double UNIT = 0x1p-24;

/* Inputs come with errors of their own: a few roundings, and 1e-7 of the logarithms (math.h). */
static const double ROUNDINGS_OF_INPUT = 4.0, ERROR_OF_INPUT = 1e-7;

enum { WIDEST = HNBRDF_MAX_HIDDEN + 6 + HNBRDF_MAX_LATENT };

typedef struct layer_sums {
    double values[WIDEST];             /* what enters the layer */
    double slopes[HNBRDF_MAX_HIDDEN];  /* of its activation */
    double squares[HNBRDF_MAX_HIDDEN]; /* of all that is rounded in a unit, summed */
    double bias[HNBRDF_MAX_HIDDEN];    /* the mean error, in units of UNIT */
} layer_sums;

/* The mean of what a state does to a rounded number, in units of UNIT: it rounds by up to two of
 * them. */
static double push(stability_state state, double value)
{
    switch (state) {
    case STABILITY_UP:
        return fabs(value);
    case STABILITY_DOWN:
        return -fabs(value);
    case STABILITY_TO_ZERO:
        return -value;
    default:
        return 0.0;
    }
}

static void round_off(layer_sums *l, int unit, stability_state state, double value)
{
    l->squares[unit] += value * value;
    l->bias[unit] += push(state, value);
}

/* x clamp(x/3 + 1/2, 0, 1), and its slope. */
static double hard_gelu(double x, double *slope)
{
    double gate = fmin(fmax(x / 3.0 + 0.5, 0.0), 1.0);
    *slope = gate <= 0.0 ? 0.0 : gate >= 1.0 ? 1.0 : 2.0 * x / 3.0 + 0.5;
    return x * gate;
}

/* Products one by one onto the bias, latent code first, as the library does. */
static void forwards(const hnbrdf_model_desc *desc, int k, int rows, int columns,
                     stability_state state, layer_sums *l, double next[WIDEST])
{
    for (int r = 0; r < rows; r++) {
        double sum = (double)desc->biases[k][r];
        l->squares[r] = l->bias[r] = 0.0;
        for (int i = 0; i < columns; i++) {
            int from = k > 0 ? i : i < desc->latent ? 6 + i : i - desc->latent;
            double product = (double)desc->weights[k][r * columns + from] * l->values[from];
            sum += product;
            round_off(l, r, state, product);
            round_off(l, r, state, sum);
        }
        l->slopes[r] = 1.0;
        next[r] = k < desc->layers ? hard_gelu(sum, &l->slopes[r]) : sum;
        if (k < desc->layers) /* x/3, + 1/2 and the product with x: each worth up to x */
            for (int rounding = 0; rounding < 3; rounding++)
                round_off(l, r, state, sum);
    }
}

/* d f / d output over the scale. */
static void slopes_of_outputs(const hnbrdf_model_desc *desc, const oracle_point *point, int channel,
                              double slopes[WIDEST])
{
    double scale = desc->scale == 0.0f ? 1.0 : (double)desc->scale;
    double exponent = scale * point->outputs[channel] + (double)desc->shift;
    double size = fmax(point->scale[channel], 1e-38);
    memset(slopes, 0, WIDEST * sizeof *slopes);
    slopes[channel] = fabs(exponent) < (double)HNBRDF_MAX_EXPONENT
                          ? scale * point->ratio[channel] * exp(exponent) / size
                          : 0.0;
    if (desc->kind == HNBRDF_KIND_HYBRID) {
        double gate = 1.0 / (1.0 + exp(-point->outputs[3 + channel]));
        slopes[3 + channel] = gate * (1.0 - gate) * point->analytic[channel] / size;
    }
}

stability_rounding stability_rounding_of(const hnbrdf_model_desc *desc,
                                         const hnbrdf_material *material, const oracle_point *point,
                                         int channel, stability_state state)
{
    layer_sums layers[HNBRDF_MAX_LAYERS + 1];
    double next[WIDEST], behind[WIDEST], before[WIDEST];
    int columns[HNBRDF_MAX_LAYERS + 1], outputs = desc->kind == HNBRDF_KIND_HYBRID ? 6 : 3;
    double variance = 0.0, mean = 0.0;
    if (desc->kind == HNBRDF_KIND_GGX)
        return (stability_rounding){0.0, 0.0};
    for (int i = 0; i < 6; i++)
        next[i] = point->encoded[i];
    for (int i = 0; i < desc->latent; i++)
        next[6 + i] = (double)material->latent[i];
    for (int k = 0; k <= desc->layers; k++) {
        columns[k] = k ? desc->hidden : 6 + desc->latent;
        memcpy(layers[k].values, next, sizeof next);
        forwards(desc, k, k < desc->layers ? desc->hidden : outputs, columns[k], state, &layers[k],
                 next);
    }
    slopes_of_outputs(desc, point, channel, behind);
    for (int k = desc->layers; k >= 0; k--) {
        memset(before, 0, sizeof before);
        for (int r = 0; r < (k < desc->layers ? desc->hidden : outputs); r++) {
            double slope = behind[r] * layers[k].slopes[r];
            variance += slope * slope * layers[k].squares[r];
            mean += slope * layers[k].bias[r];
            for (int i = 0; i < columns[k]; i++)
                before[i] += slope * (double)desc->weights[k][r * columns[k] + i];
        }
        memcpy(behind, before, sizeof behind);
    }
    for (int i = 0; i < 6; i++) {
        double off =
            before[i] * (ROUNDINGS_OF_INPUT * fabs(layers[0].values[i]) + ERROR_OF_INPUT / UNIT);
        variance += off * off;
        mean += state == STABILITY_NEAREST || state == STABILITY_FLUSH ? 0.0 : fabs(off);
    }
    return (stability_rounding){fabs(mean) * UNIT, sqrt(variance / 3.0) * UNIT};
}
