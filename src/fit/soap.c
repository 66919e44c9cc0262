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
/* What is smaller is 0: numbers of units that have died out would decay into denormal ones, and a
 * product of these takes fifty times as long. Such a mean moves a weight by 1e-11 of the rate. */
#define LEAST_NUMBER 1e-19f
#define LEAST_SQUARE 1e-35f
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
        *room += FIT_SOAP_SQUARES * (left > right ? left : right);
    }
}

int hnbrdf_fit_soap_make(fit_soap *s, const fit_layout *l, const fit_kernel *kernel)
{
    size_t weights, room;
    s->kernel = kernel;
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

/* b = a^T, a [rows][columns] */
static void transpose(const float *restrict a, float *restrict b, int rows, int columns)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++)
            b[j * rows + i] = a[i * columns + j];
}

static float or_zero(float x, float least)
{
    return fabsf(x) < least ? 0.0f : x;
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
static void follow(const fit_kernel *kernel, const float *mean, float *basis, int n, float *room)
{
    float *scaled = room, *moved = room + square(n), trace = 0.0f;
    for (int i = 0; i < n; i++)
        trace += mean[i * n + i];
    if (!(trace > 0.0f))
        return;
    for (size_t i = 0; i < square(n); i++)
        scaled[i] = or_zero(mean[i] / trace, LEAST_NUMBER);
    kernel->matrix(basis, scaled, moved, n, n, n);
    orthonormalise(basis, moved, n);
    for (size_t i = 0; i < square(n); i++)
        basis[i] = or_zero(moved[i], LEAST_NUMBER);
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
        mean[i] = or_zero(BETA_MEANS * mean[i] + (1.0f - BETA_MEANS) * now[i], LEAST_SQUARE);
}

/* A layer of a step. Its matrices, and `free` ones, are in the room. */
typedef struct stage {
    const fit_soap_layer *layer;
    const fit_kernel *kernel;
    float *state;
    float *gradient, *mean, *squares; /* [inputs][outputs] the gradient; Adam's m and v */
    float *across, *turned;           /* the right basis, transposed; what is turned */
    float *free;                      /* two squares */
} stage;

static stage set_stage(const fit_soap *s, int k)
{
    const fit_soap_layer *l = &s->layers[k];
    const size_t one = square(l->inputs > l->outputs ? l->inputs : l->outputs);
    float *room = s->room + l->room;
    return (stage){.layer = l,
                   .kernel = s->kernel,
                   .state = s->state,
                   .gradient = room,
                   .mean = room + one,
                   .squares = room + 2 * one,
                   .across = room + 3 * one,
                   .turned = room + 4 * one,
                   .free = room + 5 * one};
}

/* Means of products of the gradient. */
static void see_gradient(const stage *s)
{
    const int inputs = s->layer->inputs, outputs = s->layer->outputs;
    float *turned = s->turned, *now = s->free;
    transpose(s->gradient, turned, inputs, outputs);
    s->kernel->matrix(s->gradient, turned, now, inputs, outputs, inputs);
    run_mean(s->state + s->layer->left, now, square(inputs));
    s->kernel->matrix(turned, s->gradient, now, outputs, inputs, outputs);
    run_mean(s->state + s->layer->right, now, square(outputs));
}

/* turned = left a right^T: a in the eigenbases. */
static void turn(const stage *s, const float *a)
{
    const int inputs = s->layer->inputs, outputs = s->layer->outputs;
    s->kernel->matrix(s->state + s->layer->left_basis, a, s->free, inputs, inputs, outputs);
    s->kernel->matrix(s->free, s->across, s->turned, inputs, outputs, outputs);
}

/* turned = left^T turned right: back again. */
static void turn_back(const stage *s)
{
    const int inputs = s->layer->inputs, outputs = s->layer->outputs;
    float *left = s->across, *half = s->free;
    transpose(s->state + s->layer->left_basis, left, inputs, inputs);
    s->kernel->matrix(left, s->turned, half, inputs, inputs, outputs);
    s->kernel->matrix(half, s->state + s->layer->right_basis, s->turned, inputs, outputs, outputs);
}

/* to[i] = from[place[i]] */
static void gather(const float *restrict from, const size_t *restrict place, float *restrict to,
                   size_t count)
{
    for (size_t i = 0; i < count; i++)
        to[i] = from[place[i]];
}

/* to[place[i]] = from[i] */
static void scatter(const float *restrict from, const size_t *restrict place, float *restrict to,
                    size_t count)
{
    for (size_t i = 0; i < count; i++)
        to[place[i]] = from[i];
}

static int all_within(const float *values, size_t count, float most)
{
    int good = 1;
    for (size_t i = 0; i < count; i++)
        good &= fabsf(values[i]) <= most;
    return good;
}

/* mean and squares go on, and the step is left in `turned`. */
static void find_step(const stage *s, size_t count, long step)
{
    const float b1 = (float)BETA1, b2 = (float)BETA2;
    const float correct1 = (float)(1.0 / (1.0 - pow(BETA1, (double)step)));
    const float correct2 = (float)(1.0 / (1.0 - pow(BETA2, (double)step)));
    float *restrict mean = s->mean, *restrict squares = s->squares, *restrict turned = s->turned;
    transpose(s->state + s->layer->right_basis, s->across, s->layer->outputs, s->layer->outputs);
    turn(s, s->gradient);
    for (size_t i = 0; i < count; i++) {
        mean[i] = or_zero(b1 * mean[i] + (1.0f - b1) * s->gradient[i], LEAST_NUMBER);
        squares[i] = or_zero(b2 * squares[i] + (1.0f - b2) * (turned[i] * turned[i]), LEAST_SQUARE);
    }
    turn(s, mean);
    for (size_t i = 0; i < count; i++)
        turned[i] = turned[i] * correct1 / (sqrtf(squares[i] * correct2) + 1e-8f);
    turn_back(s);
}

void hnbrdf_fit_soap_step(const fit_soap *soap, int k, float *parameters, const float *gradient,
                          float *m, float *v, long step, double rate)
{
    const fit_soap_layer *l = &soap->layers[k];
    const size_t *place = soap->places + l->at, count = (size_t)l->inputs * (size_t)l->outputs;
    const stage s = set_stage(soap, k);
    if (step == 1) {
        memset(s.state + l->left, 0, sizeof(float) * (square(l->inputs) + square(l->outputs)));
        start_basis(s.state + l->left_basis, l->inputs);
        start_basis(s.state + l->right_basis, l->outputs);
    }
    gather(gradient, place, s.gradient, count);
    if (!all_within(s.gradient, count, MOST_GRADIENT))
        return;
    gather(m, place, s.mean, count);
    gather(v, place, s.squares, count);
    see_gradient(&s);
    find_step(&s, count, step);
    scatter(s.mean, place, m, count);
    scatter(s.squares, place, v, count);
    for (size_t i = 0; i < count; i++)
        parameters[place[i]] -= (float)rate * s.turned[i];
    if (step == 1 || step % FOLLOW_EVERY == 0) {
        follow(s.kernel, s.state + l->left, s.state + l->left_basis, l->inputs, s.free);
        follow(s.kernel, s.state + l->right, s.state + l->right_basis, l->outputs, s.free);
    }
}
