/* kernel_network.h: the network of the evaluation kernels, one evaluation at a time and side by
 * side. Part of kernel_body.h, which says what is defined before. */
#include "core/kernel.h"

#include <stdint.h>
#include <stddef.h>
#include <string.h>

enum { LANES = HNBRDF_LANES };

#if defined(__GNUC__)
#define KERNEL_INLINE static inline __attribute__((always_inline))
#define KERNEL_APART static __attribute__((noinline)) /* one copy is enough */
#else
#define KERNEL_INLINE static inline
#define KERNEL_APART static
#endif

#if KERNEL_WIDTH > 1
/* A vector in a register; the same vector in memory, at any address of a float. */
typedef float tile_vector __attribute__((vector_size(KERNEL_WIDTH * sizeof(float))));
typedef float unit_vector __attribute__((vector_size(KERNEL_SINGLE * sizeof(float))));
typedef float tile_memory
    __attribute__((vector_size(KERNEL_WIDTH * sizeof(float)), aligned(4), may_alias));
typedef float unit_memory
    __attribute__((vector_size(KERNEL_SINGLE * sizeof(float)), aligned(4), may_alias));
#if defined(__SSE2__)
#include <immintrin.h>
#define KERNEL_MAX_4 _mm_max_ps
#define KERNEL_MIN_4 _mm_min_ps
#define KERNEL_MAX_8 _mm256_max_ps
#define KERNEL_MIN_8 _mm256_min_ps
#define KERNEL_MAX_16 _mm512_max_ps
#define KERNEL_MIN_16 _mm512_min_ps
#define KERNEL_JOIN(name, width) name##width
#define KERNEL_FOR(name, width) KERNEL_JOIN(name, width)
#endif

/* hnbrdf_hard_gelu() of every number of a vector. maxps and minps give the second operand where one
 * is NaN and where both are 0, as its comparisons do; elsewhere the comparisons themselves, as
 * masks. */
#if defined(__SSE2__)
#define KERNEL_CLAMP_01(t, zero, one, width) \
    KERNEL_FOR(KERNEL_MIN_, width)(one, KERNEL_FOR(KERNEL_MAX_, width)(zero, t))
#else
typedef int32_t kernel_mask __attribute__((vector_size(KERNEL_WIDTH * sizeof(int32_t))));
KERNEL_INLINE tile_vector clamp_01(tile_vector t, tile_vector zero, tile_vector one)
{
    t = (tile_vector)(~(kernel_mask)(t < zero) & (kernel_mask)t);
    kernel_mask over = (kernel_mask)(t > one);
    return (tile_vector)((over & (kernel_mask)one) | (~over & (kernel_mask)t));
}
#define KERNEL_CLAMP_01(t, zero, one, width) clamp_01(t, zero, one)
#endif

KERNEL_INLINE tile_vector activate_tile(tile_vector x)
{
    const tile_vector zero = {0}, one = zero + 1.0f;
    return x * KERNEL_CLAMP_01(x * 0.333333333f + 0.5f, zero, one, KERNEL_WIDTH);
}

KERNEL_INLINE unit_vector activate_units(unit_vector x)
{
    const unit_vector zero = {0}, one = zero + 1.0f;
    return x * KERNEL_CLAMP_01(x * 0.333333333f + 0.5f, zero, one, KERNEL_SINGLE);
}
#endif

/* ---- The network of one evaluation, vectors over units --------------------------------------- */

#if KERNEL_WIDTH > 1

/* y[u] = biases[u] + sum over k of x[k] w[k][u] for `vectors` vectors of units. */
KERNEL_INLINE void unit_vectors(const float *w, int stride, int depth, const float *x,
                                const float *biases, int activate, int vectors, float *y)
{
    unit_vector sums[8];
    for (int v = 0; v < vectors; v++)
        sums[v] = *(const unit_memory *)(biases + v * KERNEL_SINGLE);
    const int whole = depth - depth % 4;
    for (int k = 0; k < whole; k += 4) /* fewer instructions to wait with the sums */
        for (int i = 0; i < 4; i++, w += stride)
            for (int v = 0; v < vectors; v++)
                sums[v] += *(const unit_memory *)(w + v * KERNEL_SINGLE) * x[k + i];
    for (int k = whole; k < depth; k++, w += stride)
        for (int v = 0; v < vectors; v++)
            sums[v] += *(const unit_memory *)(w + v * KERNEL_SINGLE) * x[k];
    for (int v = 0; v < vectors; v++)
        *(unit_memory *)(y + v * KERNEL_SINGLE) = activate ? activate_units(sums[v]) : sums[v];
}

/* Writes whole vectors: y has room for a multiple of HNBRDF_PACK, and so have w and biases. */
KERNEL_APART void units(const float *w, int stride, int depth, const float *x, const float *biases,
                        int count, int activate, float *y)
{
    int left = (count + KERNEL_SINGLE - 1) / KERNEL_SINGLE, u = 0;
    for (; left >= 8; left -= 8, u += 8 * KERNEL_SINGLE)
        unit_vectors(w + u, stride, depth, x, biases + u, activate, 8, y + u);
    if (left & 4) {
        unit_vectors(w + u, stride, depth, x, biases + u, activate, 4, y + u);
        u += 4 * KERNEL_SINGLE;
    }
    if (left & 2) {
        unit_vectors(w + u, stride, depth, x, biases + u, activate, 2, y + u);
        u += 2 * KERNEL_SINGLE;
    }
    if (left & 1)
        unit_vectors(w + u, stride, depth, x, biases + u, activate, 1, y + u);
}

enum { OUTPUT_VECTORS = (HNBRDF_MAX_OUTPUTS + KERNEL_SINGLE - 1) / KERNEL_SINGLE };

KERNEL_INLINE void any_units(const float *w, int stride, int depth, const float *x,
                             const float *biases, int count, int activate, int vectors, float *y)
{
    if (vectors)
        unit_vectors(w, stride, depth, x, biases, activate, vectors, y);
    else
        units(w, stride, depth, x, biases, count, activate, y);
}

#else

KERNEL_APART void units(const float *w, int stride, int depth, const float *x, const float *biases,
                        int count, int activate, float *restrict y)
{
    for (int u = 0; u < count; u++)
        y[u] = biases[u];
    for (int k = 0; k < depth; k++)
        for (int u = 0; u < count; u++)
            y[u] += w[k * stride + u] * x[k];
    for (int u = 0; activate && u < count; u++)
        y[u] = hnbrdf_hard_gelu(y[u]);
}

enum { OUTPUT_VECTORS = 0 };

static void any_units(const float *w, int stride, int depth, const float *x, const float *biases,
                      int count, int activate, int vectors, float *y)
{
    (void)vectors;
    units(w, stride, depth, x, biases, count, activate, y);
}

#endif

static void kernel_fold(const hnbrdf_model *model, const float *latent, float *first)
{
    const int stride = hnbrdf_packed_outputs(&model->desc, 0);
    units(model->packed[0], stride, model->desc.latent, latent, model->packed_biases[0], stride, 0,
          first);
}

/* The network where every layer is `vectors` vectors wide and takes `hidden` inputs, 0 for any
 * width. Inlined where that is known: the layers then follow each other without a call, a loop or a
 * choice between them. */
KERNEL_INLINE void network_of(const hnbrdf_prepared *prepared, const float *x, int vectors,
                              int hidden, float *out)
{
    const hnbrdf_model *model = prepared->model;
    const hnbrdf_model_desc *desc = &model->desc;
    const int depth = hidden ? hidden : desc->hidden, stride = hnbrdf_padded(depth),
              last = desc->layers;
    float buffers[2][HNBRDF_MAX_HIDDEN];
    any_units(model->packed[0] + desc->latent * stride, stride, HNBRDF_ENCODING_SIZE, x,
              prepared->first, depth, 1, vectors, buffers[0]);
    for (int k = 1; k < last; k++)
        any_units(model->packed[k], stride, depth, buffers[(k - 1) & 1], model->packed_biases[k],
                  depth, 1, vectors, buffers[k & 1]);
    any_units(model->packed[last], HNBRDF_PACK, depth, buffers[(last - 1) & 1],
              model->packed_biases[last], HNBRDF_MAX_OUTPUTS, 0, OUTPUT_VECTORS, out);
}

KERNEL_APART void network_single(const hnbrdf_prepared *prepared, const float *x, float *out)
{
#if KERNEL_WIDTH > 1
    switch (prepared->model->desc.hidden) {
    case 16:
        network_of(prepared, x, 16 / KERNEL_SINGLE, 16, out);
        return;
    case 32:
        network_of(prepared, x, 32 / KERNEL_SINGLE, 32, out);
        return;
    default:
        break;
    }
#endif
    network_of(prepared, x, 0, 0, out);
}

/* ---- The network of a block of evaluations, vectors over lanes ------------------------------- */

typedef float lane[LANES];

/* What else is to be done while a network keeps the units for sums and products busy: steps of
 * another block, which wait for divisions, roots and memory. NULL: nothing. */
typedef struct lane_work lane_work;

/* After so many products of each lane: does the steps that are due. */
static void work_beside(lane_work *work, int products);

#if KERNEL_WIDTH > 1

/* y[r][l] = biases[r] + sum over k of w[k][r] x[k][l] for `rows` rows and KERNEL_WIDE vectors of
 * lanes. */
KERNEL_INLINE void tile(const float *w, int stride, int depth, lane *x, const float *biases,
                        int activate, int rows, lane *y)
{
    const tile_vector zero = {0}; /* b - 0 is b to the bit, -0 too */
    tile_vector sums[KERNEL_ROWS][KERNEL_WIDE];
    for (int r = 0; r < rows; r++)
        for (int v = 0; v < KERNEL_WIDE; v++)
            sums[r][v] = biases[r] - zero;
    for (int k = 0; k < depth; k++) {
        tile_vector in[KERNEL_WIDE];
        for (int v = 0; v < KERNEL_WIDE; v++)
            in[v] = *(const tile_memory *)((const float *)(x + k) + v * KERNEL_WIDTH);
        for (int r = 0; r < rows; r++)
            for (int v = 0; v < KERNEL_WIDE; v++)
                sums[r][v] += in[v] * w[k * stride + r];
    }
    for (int r = 0; r < rows; r++)
        for (int v = 0; v < KERNEL_WIDE; v++)
            *(tile_memory *)((float *)(y + r) + v * KERNEL_WIDTH) =
                activate ? activate_tile(sums[r][v]) : sums[r][v];
}

/* y is [count], of HardGELU if `activate`; inlined where that is known. */
KERNEL_INLINE void layer(const float *w, int stride, int depth, lane *x, const float *biases,
                         int count, int activate, lane *y, lane_work *work)
{
    for (int l = 0; l < LANES; l += KERNEL_WIDE * KERNEL_WIDTH) {
        lane *from = (lane *)(void *)((float *)x + l);
        lane *to = (lane *)(void *)((float *)y + l);
        int r = 0;
        for (; r + KERNEL_ROWS <= count; r += KERNEL_ROWS) {
            tile(w + r, stride, depth, from, biases + r, activate, KERNEL_ROWS, to + r);
            if (work)
                work_beside(work, depth * KERNEL_ROWS * KERNEL_WIDE * KERNEL_WIDTH / LANES);
        }
#if KERNEL_ROWS > 6
        for (; r + 6 <= count; r += 6)
            tile(w + r, stride, depth, from, biases + r, activate, 6, to + r);
#endif
        for (; r + 4 <= count; r += 4)
            tile(w + r, stride, depth, from, biases + r, activate, 4, to + r);
        for (; r + 2 <= count; r += 2)
            tile(w + r, stride, depth, from, biases + r, activate, 2, to + r);
        for (; r < count; r++)
            tile(w + r, stride, depth, from, biases + r, activate, 1, to + r);
    }
}

#else

/* Two rows at a time: every input is loaded once for both. */
KERNEL_APART void layer(const float *w, int stride, int depth, lane *restrict x,
                        const float *biases, int count, int activate, lane *restrict y,
                        lane_work *work)
{
    for (int r = 0; r < count; r += 2) {
        int next = r + 1 < count ? r + 1 : r; /* an odd last row is computed twice */
        lane s, t;
        for (int l = 0; l < LANES; l++) {
            s[l] = biases[r];
            t[l] = biases[next];
        }
        for (int k = 0; k < depth; k++)
            for (int l = 0; l < LANES; l++) {
                s[l] += w[k * stride + r] * x[k][l];
                t[l] += w[k * stride + next] * x[k][l];
            }
        for (int l = 0; activate && l < LANES; l++) {
            s[l] = hnbrdf_hard_gelu(s[l]);
            t[l] = hnbrdf_hard_gelu(t[l]);
        }
        memcpy(y[r], s, sizeof s);
        memcpy(y[next], t, sizeof t);
        if (work)
            work_beside(work, 2 * depth);
    }
}

#endif

KERNEL_APART void hidden_layer(const float *w, int stride, int depth, lane *x, const float *biases,
                               int count, lane *y, lane_work *work)
{
    layer(w, stride, depth, x, biases, count, 1, y, work);
}

/* The first layer sums `depth` inputs from `biases` with the weights w. */
KERNEL_APART void network_lanes(const hnbrdf_model *model, const float *w, int depth, lane *x,
                                const float *biases, lane *out, lane_work *work)
{
    const hnbrdf_model_desc *desc = &model->desc;
    const int stride = hnbrdf_packed_outputs(desc, 0), hidden = desc->hidden, last = desc->layers;
    lane buffers[2][HNBRDF_MAX_HIDDEN];
    hidden_layer(w, stride, depth, x, biases, hidden, buffers[0], work);
    for (int k = 1; k < last; k++)
        hidden_layer(model->packed[k], stride, hidden, buffers[(k - 1) & 1],
                     model->packed_biases[k], hidden, buffers[k & 1], work);
    layer(model->packed[last], HNBRDF_PACK, hidden, buffers[(last - 1) & 1],
          model->packed_biases[last], hnbrdf_layer_outputs(desc, last), 0, out, work);
}

static void network_folded(const hnbrdf_prepared *prepared, lane *x, lane *out, lane_work *work)
{
    const hnbrdf_model *model = prepared->model;
    const float *w = model->packed[0] + model->desc.latent * hnbrdf_packed_outputs(&model->desc, 0);
    network_lanes(model, w, HNBRDF_ENCODING_SIZE, x, prepared->first, out, work);
}

static void kernel_network(const hnbrdf_prepared *prepared,
                           float x[HNBRDF_ENCODING_SIZE][HNBRDF_LANES],
                           float out[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES])
{
    network_folded(prepared, x, out, NULL);
}
