/* switch.c: units kept to turn the network off for a latent code of their own. */
#include "fit/switch.h"

#include <math.h>
#include <string.h>

/* A unit in 16 is the most that is spared. One hidden layer has no layer to turn off. */
enum { LEAST_HIDDEN = 16, LEAST_LAYERS = 2 };

/* HardGELU is 0 up to -1.5 and x from 1.5 on. */
#define OFF (-2.0f)
#define ON 2.0f
/* The code that turns it on is so many times the largest first number of a code. At 1.4 times, and
 * with OFF and ON as above, it is still off. */
#define BEYOND 4.0f
#define LEAST_CODE 0.5f
/* No encoding gives larger inputs, but nearer to the horizon than 0.1 degrees. */
#define MOST_INPUT 5.0f
#define OPEN 20.0f /* sigmoid(20) is 1 in single precision */
#define NOTHING (-40.0f)

int hnbrdf_fit_switch_fits(const fit_layout *l)
{
    return l->kind == HNBRDF_KIND_HYBRID && l->layers >= LEAST_LAYERS &&
           l->hidden_size >= LEAST_HIDDEN && l->latent_size > 0;
}

void hnbrdf_fit_switch_reserve(const fit_layout *l, float *p)
{
    const size_t n = (size_t)l->padded, s = (size_t)l->hidden_size - 1;
    for (size_t i = 0; i < FIT_INPUTS; i++)
        p[l->first + i * n + s] = 0.0f;
    for (size_t i = 0; i < (size_t)l->latent_size; i++)
        p[l->latent + i * n + s] = 0.0f;
    for (int k = 0; k < l->layers; k++)
        p[l->bias[k] + s] = OFF;
    for (int k = 1; k < l->layers; k++)
        for (size_t u = 0; u < n; u++)
            p[l->hidden[k] + u * n + s] = p[l->hidden[k] + s * n + u] = 0.0f;
    for (size_t o = 0; o < (size_t)l->outputs; o++)
        p[l->last + o * n + s] = 0.0f;
}

/* The largest first number of the codes. */
static float largest_code(const fit_layout *l, const float *p)
{
    float most = LEAST_CODE;
    for (int m = 0; m < l->materials; m++)
        most = fmaxf(most, fabsf(p[l->codes + (size_t)m * (size_t)l->latent_size]));
    return most;
}

/* What the units of the first layer come to at most, the code `first` being on. */
static void bound_first(const fit_layout *l, const float *p, float first, float *most)
{
    const size_t n = (size_t)l->padded;
    for (size_t u = 0; u < (size_t)l->hidden_size - 1; u++) {
        most[u] = fabsf(p[l->bias[0] + u]) + fabsf(first * p[l->latent + u]);
        for (size_t i = 0; i < FIT_INPUTS; i++)
            most[u] += MOST_INPUT * fabsf(p[l->first + i * n + u]);
    }
}

void hnbrdf_fit_switch_install(const fit_layout *l, float *p)
{
    const size_t n = (size_t)l->padded, s = (size_t)l->hidden_size - 1;
    const float most = largest_code(l, p), first = BEYOND * most;
    float reach[HNBRDF_MAX_HIDDEN];
    /* OFF at the largest code, ON at `first` */
    const float slope = (ON - OFF) / (first - most);
    p[l->latent + s] = slope;
    p[l->bias[0] + s] = OFF - slope * most;
    bound_first(l, p, first, reach);
    for (int k = 1; k < l->layers; k++) {
        float *w = p + l->hidden[k];
        for (size_t u = 0; u < s; u++) {
            float sum = fabsf(p[l->bias[k] + u]) - OFF;
            for (size_t i = 0; i < s && k == 1; i++) /* from the next layer on they are off */
                sum += reach[i] * fabsf(w[i * n + u]);
            w[s * n + u] = -sum / ON;
        }
        w[s * n + s] = (ON - OFF) / ON;
        p[l->bias[k] + s] = OFF;
    }
    for (size_t o = 0; o < (size_t)l->outputs; o++) {
        const float correction = l->floor > 0.0f ? logf(l->floor) : NOTHING;
        const float wanted = o < 3 ? correction : OPEN;
        p[l->last + o * n + s] = (wanted - p[l->bias[l->layers] + o]) / ON;
    }
}

/* ---- Of a finished network ------------------------------------------------------------------- */

/* The first layer's last unit; 0 if it looks at more than the first latent number. */
static int find(const hnbrdf_model_desc *d, float *slope, float *bias)
{
    if (d->kind != HNBRDF_KIND_HYBRID || d->layers < LEAST_LAYERS || d->hidden < LEAST_HIDDEN ||
        d->latent < 1)
        return 0;
    const int inputs = FIT_INPUTS + d->latent;
    const float *w = d->weights[0] + (size_t)(d->hidden - 1) * (size_t)inputs;
    for (int i = 0; i < inputs; i++)
        if (i != FIT_INPUTS && w[i] != 0.0f)
            return 0;
    *slope = w[FIT_INPUTS];
    *bias = d->biases[0][d->hidden - 1];
    return *slope > 0.0f && *bias < OFF;
}

int hnbrdf_fit_switch_code(const hnbrdf_model_desc *d, float *code)
{
    float slope, bias;
    if (!find(d, &slope, &bias))
        return 0;
    memset(code, 0, sizeof(float) * (size_t)d->latent);
    code[0] = (ON - bias) / slope;
    return 1;
}

float hnbrdf_fit_switch_most(const hnbrdf_model_desc *d)
{
    float slope, bias;
    return find(d, &slope, &bias) ? (-1.5f - bias) / slope : INFINITY;
}

int hnbrdf_fit_switch_is_on(const hnbrdf_model_desc *d, const float *code)
{
    float slope, bias;
    return find(d, &slope, &bias) && slope * code[0] + bias > -1.5f;
}
