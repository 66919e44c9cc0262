/* soap.c: Adam in the eigenbases of a layer's gradients. */
#include "fit/soap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BETA1 0.9
#define BETA2 0.98
#define BETA_MEANS 0.98f
enum { FOLLOW_EVERY = 10 }; /* steps */
#define MOST_GRADIENT 1e17f
/* What is left of a vector, squared, when its part along others is taken away, to be trusted. */
#define LEAST_LEFT 1e-6f

/* ---- Memory ---------------------------------------------------------------------------------- */

static size_t square(int side)
{
    return (size_t)side * (size_t)side;
}

/* Sizes of all layers, and their offsets. */
static void measure(fit_soap *s, const fit_layout *l, size_t *weights, size_t *room)
{
    *weights = *room = s->state_count = 0;
    s->count = l->kind == HNBRDF_KIND_GGX ? 0 : l->layers + 1;
    for (int k = 0; k < s->count; k++) {
        fit_soap_layer *layer = &s->layers[k];
        hnbrdf_fit_layer_size(l, k, &layer->outputs, &layer->inputs);
        layer->inputs++;
        const size_t left = square(layer->inputs), right = square(layer->outputs);
        layer->at = *weights;
        layer->left = s->state_count;
        layer->right = layer->left + left;
        layer->left_basis = layer->right + right;
        layer->right_basis = layer->left_basis + left;
        layer->room = *room;
        s->state_count = layer->right_basis + right;
        *weights += (size_t)layer->inputs * (size_t)layer->outputs;
        *room += 5 * (left > right ? left : right);
    }
}

int hnbrdf_fit_soap_make(fit_soap *s, const fit_layout *l)
{
    size_t weights, room;
    measure(s, l, &weights, &room);
    s->places = calloc(weights + 1, sizeof *s->places);
    s->state = calloc(s->state_count + 1, sizeof *s->state);
    s->room = calloc(room + 1, sizeof *s->room);
    if (!s->places || !s->state || !s->room)
        return 0;
    for (int k = 0; k < s->count; k++) {
        const fit_soap_layer *layer = &s->layers[k];
        size_t *place = s->places + layer->at;
        for (int i = 0; i < layer->inputs; i++)
            for (int o = 0; o < layer->outputs; o++)
                *place++ = i < layer->inputs - 1 ? hnbrdf_fit_weight_at(l, k, o, i)
                                                 : l->bias[k] + (size_t)o;
    }
    return 1;
}

void hnbrdf_fit_soap_free(fit_soap *s)
{
    free(s->places);
    free(s->state);
    free(s->room);
}

/* ---- Matrices, row by row -------------------------------------------------------------------- */

/* c = a b, a [rows][depth], b [depth][columns] */
static void product(const float *restrict a, const float *restrict b, float *restrict c, int rows,
                    int depth, int columns)
{
    memset(c, 0, sizeof(float) * (size_t)rows * (size_t)columns);
    for (int i = 0; i < rows; i++)
        for (int k = 0; k < depth; k++) {
            const float x = a[i * depth + k];
            for (int j = 0; j < columns; j++)
                c[i * columns + j] += x * b[k * columns + j];
        }
}

/* b = a^T, a [rows][columns] */
static void transpose(const float *restrict a, float *restrict b, int rows, int columns)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++)
            b[j * rows + i] = a[i * columns + j];
}

static float dot(const float *a, const float *b, int count)
{
    float partial[FIT_LANES] = {0}, sum = 0.0f;
    int i = 0;
    for (; i + FIT_LANES <= count; i += FIT_LANES)
        for (int l = 0; l < FIT_LANES; l++)
            partial[l] += a[i + l] * b[i + l];
    for (int l = 0; i + l < count; l++)
        partial[l] += a[i + l] * b[i + l];
    for (int l = 0; l < FIT_LANES; l++)
        sum += partial[l];
    return sum;
}

/* ---- Eigenvectors ---------------------------------------------------------------------------- */

/* Takes from v [n] what is along `count` rows, and makes it a unit vector. 0 if nothing is left. */
static int take_apart(const float *rows, int count, int n, float *v)
{
    const float before = dot(v, v, n);
    if (!(before > 0.0f))
        return 0;
    for (int pass = 0; pass < 2; pass++) /* the second: what rounding left */
        for (int r = 0; r < count; r++) {
            const float along = dot(rows + r * n, v, n);
            for (int j = 0; j < n; j++)
                v[j] -= along * rows[r * n + j];
        }
    const float after = dot(v, v, n);
    if (!(after > LEAST_LEFT * before))
        return 0;
    const float scale = 1.0f / sqrtf(after);
    for (int j = 0; j < n; j++)
        v[j] *= scale;
    return 1;
}

/* Makes `moved` [n][n] orthonormal, row by row: what has no direction of its own stays where it was
 * in `basis`, or goes along an axis. */
static void orthonormalise(const float *basis, float *moved, int n)
{
    for (int i = 0; i < n; i++) {
        float *v = moved + i * n;
        int good = take_apart(moved, i, n, v);
        if (!good) {
            memcpy(v, basis + i * n, sizeof(float) * (size_t)n);
            good = take_apart(moved, i, n, v);
        }
        for (int axis = 0; axis < n && !good; axis++) {
            memset(v, 0, sizeof(float) * (size_t)n);
            v[axis] = 1.0f;
            good = take_apart(moved, i, n, v);
        }
    }
}

/* One step of subspace iteration with the symmetric mean [n][n]. */
static void follow(const float *mean, float *basis, int n, float *room)
{
    float *scaled = room, *moved = room + square(n), trace = 0.0f;
    for (int i = 0; i < n; i++)
        trace += mean[i * n + i];
    if (!(trace > 0.0f))
        return;
    for (size_t i = 0; i < square(n); i++)
        scaled[i] = mean[i] / trace;
    product(basis, scaled, moved, n, n, n);
    orthonormalise(basis, moved, n);
    memcpy(basis, moved, sizeof(float) * square(n));
}

static void start_basis(float *basis, int n)
{
    memset(basis, 0, sizeof(float) * square(n));
    for (int i = 0; i < n; i++)
        basis[i * n + i] = 1.0f;
}

/* ---- A step ---------------------------------------------------------------------------------- */

/* mean += (1 - beta) (now - mean) */
static void run_mean(float *restrict mean, const float *restrict now, size_t count)
{
    for (size_t i = 0; i < count; i++)
        mean[i] = BETA_MEANS * mean[i] + (1.0f - BETA_MEANS) * now[i];
}

/* Means of products of the gradient g; room for two squares. */
static void see_gradient(const fit_soap_layer *l, const float *g, float *state, float *room)
{
    float *turned = room, *now = room + (size_t)l->inputs * (size_t)l->outputs;
    transpose(g, turned, l->inputs, l->outputs);
    product(g, turned, now, l->inputs, l->outputs, l->inputs);
    run_mean(state + l->left, now, square(l->inputs));
    product(turned, g, now, l->outputs, l->inputs, l->outputs);
    run_mean(state + l->right, now, square(l->outputs));
}

/* to = left a right^T: a in the eigenbases; `across` is right^T. Room for one matrix. */
static void turn(const fit_soap_layer *l, const float *state, const float *across, const float *a,
                 float *to, float *room)
{
    product(state + l->left_basis, a, room, l->inputs, l->inputs, l->outputs);
    product(room, across, to, l->inputs, l->outputs, l->outputs);
}

/* a = left^T a right: back again. Room for two matrices. */
static void turn_back(const fit_soap_layer *l, const float *state, float *a, float *room)
{
    float *left = room, *half = room + square(l->inputs);
    transpose(state + l->left_basis, left, l->inputs, l->inputs);
    product(left, a, half, l->inputs, l->inputs, l->outputs);
    product(half, state + l->right_basis, a, l->inputs, l->outputs, l->outputs);
}

void hnbrdf_fit_soap_step(const fit_soap *s, int k, float *parameters, const float *gradient,
                          float *m, float *v, long step, double rate)
{
    const fit_soap_layer *l = &s->layers[k];
    const size_t *place = s->places + l->at, count = (size_t)l->inputs * (size_t)l->outputs;
    const size_t side = (size_t)(l->inputs > l->outputs ? l->inputs : l->outputs);
    float *state = s->state, *g = s->room + l->room, *across = g + side * side;
    float *turned = across + side * side, *room = turned + side * side; /* two squares */
    const float b1 = (float)BETA1, b2 = (float)BETA2;
    const float correct1 = (float)(1.0 / (1.0 - pow(BETA1, (double)step)));
    const float correct2 = (float)(1.0 / (1.0 - pow(BETA2, (double)step)));
    if (step == 1) {
        memset(state + l->left, 0, sizeof(float) * (square(l->inputs) + square(l->outputs)));
        start_basis(state + l->left_basis, l->inputs);
        start_basis(state + l->right_basis, l->outputs);
    }
    for (size_t i = 0; i < count; i++) {
        g[i] = gradient[place[i]];
        if (!(fabsf(g[i]) <= MOST_GRADIENT))
            return;
    }
    see_gradient(l, g, state, room);
    transpose(state + l->right_basis, across, l->outputs, l->outputs);
    turn(l, state, across, g, turned, room);
    for (size_t i = 0; i < count; i++) {
        m[place[i]] = b1 * m[place[i]] + (1.0f - b1) * g[i];
        g[i] = m[place[i]];
        v[place[i]] = b2 * v[place[i]] + (1.0f - b2) * (turned[i] * turned[i]);
    }
    turn(l, state, across, g, turned, room);
    for (size_t i = 0; i < count; i++)
        turned[i] = turned[i] * correct1 / (sqrtf(v[place[i]] * correct2) + 1e-8f);
    turn_back(l, state, turned, room);
    for (size_t i = 0; i < count; i++)
        parameters[place[i]] -= (float)rate * turned[i];
    if (step == 1 || step % FOLLOW_EVERY == 0) {
        follow(state + l->left, state + l->left_basis, l->inputs, room);
        follow(state + l->right, state + l->right_basis, l->outputs, room);
    }
}
