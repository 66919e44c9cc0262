/* kernel_body.h: the text of the evaluation kernels, included once per instruction set.
 *
 * The includer defines KERNEL_TABLE and KERNEL_VARIANT, the table to fill and what it is called;
 * KERNEL_WIDTH, the floats in a vector (1: plain loops, no compiler extension), KERNEL_ROWS x
 * KERNEL_WIDE vectors, the register tile of the network, and KERNEL_SINGLE, the floats in a
 * vector of the network of one evaluation. Everything but the network is loops over lanes of the
 * same inline functions that define it, which compilers vectorise. */
#include "core/compose.h"
#include "core/encoding.h"
#include "core/kernel.h"
#include "core/sampling.h"

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

/* hnbrdf_hard_gelu() of every number of a vector. maxps and minps give the second operand where
 * one is NaN and where both are 0, as its comparisons do; elsewhere the comparisons themselves,
 * as masks. */
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
    int k = 0;
    for (; k + 4 <= depth; k += 4) /* fewer instructions to wait with the sums */
        for (int i = 0; i < 4; i++, w += stride)
            for (int v = 0; v < vectors; v++)
                sums[v] += *(const unit_memory *)(w + v * KERNEL_SINGLE) * x[k + i];
    for (; k < depth; k++, w += stride)
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

/* The network where every layer is `vectors` vectors wide, 0 for any width. Inlined where that is
 * known: the layers then follow each other without a call or a choice between them. */
KERNEL_INLINE void network_of(const hnbrdf_prepared *prepared, const float *x, int vectors,
                              float *out)
{
    const hnbrdf_model *model = prepared->model;
    const hnbrdf_model_desc *desc = &model->desc;
    const int stride = hnbrdf_packed_outputs(desc, 0), hidden = desc->hidden, last = desc->layers;
    float buffers[2][HNBRDF_MAX_HIDDEN];
    any_units(model->packed[0] + desc->latent * stride, stride, HNBRDF_ENCODING_SIZE, x,
              prepared->first, hidden, 1, vectors, buffers[0]);
    for (int k = 1; k < last; k++)
        any_units(model->packed[k], stride, hidden, buffers[(k - 1) & 1], model->packed_biases[k],
                  hidden, 1, vectors, buffers[k & 1]);
    any_units(model->packed[last], HNBRDF_PACK, hidden, buffers[(last - 1) & 1],
              model->packed_biases[last], HNBRDF_MAX_OUTPUTS, 0, OUTPUT_VECTORS, out);
}

/* A width that is rounded up stays within what the layers are padded to. */
static void network_single(const hnbrdf_prepared *prepared, const float *x, float *out)
{
#if KERNEL_WIDTH > 1
    switch ((prepared->model->desc.hidden + KERNEL_SINGLE - 1) / KERNEL_SINGLE) {
    case 1:
    case 2:
        network_of(prepared, x, 2, out);
        return;
    case 3:
    case 4:
        network_of(prepared, x, 4, out);
        return;
    case 7:
    case 8:
        network_of(prepared, x, 8, out);
        return;
    default:
        break;
    }
#endif
    network_of(prepared, x, 0, out);
}

/* The network first: its sums are one long wait, and f_a is worked out in its shadow. */
static void kernel_single(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3],
                          float f[3])
{
    const hnbrdf_model_desc *desc = &prepared->model->desc;
    const float scale = desc->scale, shift = desc->shift, lowest = desc->floor;
    float f_a[4], value[4], out[HNBRDF_MAX_HIDDEN]; /* the fourth channel is filling */
    hnbrdf_pair pair = hnbrdf_pair_in_frame(prepared, wi, wo);
    if (desc->kind != HNBRDF_KIND_GGX) {
        float x[HNBRDF_ENCODING_SIZE];
        out[3] = out[6] = 0.0f;
        hnbrdf_encode(desc->encoding, &pair, x);
        network_single(prepared, x, out);
    }
    if (desc->kind != HNBRDF_KIND_NEURAL)
        hnbrdf_prepared_analytic(prepared, &pair, f_a);
    if (desc->kind == HNBRDF_KIND_HYBRID)
        for (int c = 0; c < 4; c++)
            value[c] = hnbrdf_compose_hybrid(out[c], out[c + 3], f_a[c], scale, shift, lowest);
    else if (desc->kind == HNBRDF_KIND_NEURAL)
        for (int c = 0; c < 4; c++)
            value[c] = hnbrdf_compose_neural(out[c], scale, shift, lowest);
    else
        for (int c = 0; c < 4; c++)
            value[c] = hnbrdf_finish(f_a[c]);
    memcpy(f, value, 3 * sizeof *f);
}

/* ---- The network of a block of evaluations, vectors over lanes ------------------------------- */

typedef float lane[LANES];

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
                         int count, int activate, lane *y)
{
    for (int l = 0; l < LANES; l += KERNEL_WIDE * KERNEL_WIDTH) {
        lane *from = (lane *)(void *)((float *)x + l);
        lane *to = (lane *)(void *)((float *)y + l);
        int r = 0;
        for (; r + KERNEL_ROWS <= count; r += KERNEL_ROWS)
            tile(w + r, stride, depth, from, biases + r, activate, KERNEL_ROWS, to + r);
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
                        const float *biases, int count, int activate, lane *restrict y)
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
    }
}

#endif

KERNEL_APART void hidden_layer(const float *w, int stride, int depth, lane *x, const float *biases,
                               int count, lane *y)
{
    layer(w, stride, depth, x, biases, count, 1, y);
}

/* The first layer sums `depth` inputs from `biases` with the weights w. */
KERNEL_APART void network_lanes(const hnbrdf_model *model, const float *w, int depth, lane *x,
                                const float *biases, lane *out)
{
    const hnbrdf_model_desc *desc = &model->desc;
    const int stride = hnbrdf_packed_outputs(desc, 0), hidden = desc->hidden, last = desc->layers;
    lane buffers[2][HNBRDF_MAX_HIDDEN];
    hidden_layer(w, stride, depth, x, biases, hidden, buffers[0]);
    for (int k = 1; k < last; k++)
        hidden_layer(model->packed[k], stride, hidden, buffers[(k - 1) & 1],
                     model->packed_biases[k], hidden, buffers[k & 1]);
    layer(model->packed[last], HNBRDF_PACK, hidden, buffers[(last - 1) & 1],
          model->packed_biases[last], hnbrdf_layer_outputs(desc, last), 0, out);
}

static void network_folded(const hnbrdf_prepared *prepared, lane *x, lane *out)
{
    const hnbrdf_model *model = prepared->model;
    const float *w = model->packed[0] + model->desc.latent * hnbrdf_packed_outputs(&model->desc, 0);
    network_lanes(model, w, HNBRDF_ENCODING_SIZE, x, prepared->first, out);
}

static void kernel_network(const hnbrdf_prepared *prepared,
                           float x[HNBRDF_ENCODING_SIZE][HNBRDF_LANES],
                           float out[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES])
{
    network_folded(prepared, x, out);
}

/* ---- A block of pairs, arrays over lanes ----------------------------------------------------- */

/* The materials of a block. */
typedef struct lane_materials {
    lane cosine, sine, ax, ay, area, diffuse[3], e[3];
} lane_materials;

/* Pairs in the tangent frames of their materials, and what comes of them. Lanes that have no pair
 * above the horizon hold wi = wo = n, and 0 in `above`. */
typedef struct lane_pairs {
    lane wi[3], wo[3], sx, sy, sz, length2, c, f[3];
    lane x[HNBRDF_MAX_LATENT + HNBRDF_ENCODING_SIZE]; /* the latent code, then what is encoded */
    lane out[HNBRDF_MAX_OUTPUTS];
    int above[LANES];
} lane_pairs;

static void put_material(const hnbrdf_prepared *prepared, int l, lane_materials *m)
{
    m->cosine[l] = prepared->cosine;
    m->sine[l] = prepared->sine;
    m->ax[l] = prepared->alpha[0];
    m->ay[l] = prepared->alpha[1];
    m->area[l] = prepared->area;
    for (int c = 0; c < 3; c++) {
        m->diffuse[c][l] = prepared->diffuse[c];
        m->e[c][l] = prepared->e[c];
    }
}

/* The sampling lobes of a block. */
typedef struct lane_lobes {
    lane ax[HNBRDF_LOBES], ay[HNBRDF_LOBES], area[HNBRDF_LOBES], scale[HNBRDF_LOBES];
    lane share[HNBRDF_LOBES][HNBRDF_LOBE_KNOTS];
} lane_lobes;

static void put_lobes(const hnbrdf_prepared *prepared, int l, lane_lobes *m)
{
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        m->ax[k][l] = prepared->lobe_alpha[k][0];
        m->ay[k][l] = prepared->lobe_alpha[k][1];
        m->area[k][l] = prepared->lobe_area[k];
        m->scale[k][l] = prepared->lobes.scale[k];
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
            m->share[k][j][l] = prepared->lobes.share[k][j];
    }
}

static inline void lobes_of(const lane_lobes *m, int l, hnbrdf_lobe lobes[HNBRDF_LOBES])
{
    for (int k = 0; k < HNBRDF_LOBES; k++)
        lobes[k] = (hnbrdf_lobe){
            m->ax[k][l],
            m->ay[k][l],
            m->area[k][l],
            m->scale[k][l],
            {m->share[k][0][l], m->share[k][1][l], m->share[k][2][l], m->share[k][3][l]}};
}

static const float *at(const float *first, size_t stride, size_t index)
{
    return (const float *)((const char *)first + index * stride);
}

KERNEL_APART void gather(const hnbrdf_pairs *pairs, size_t first, size_t count, lane_pairs *b)
{
    static const float normal[3] = {0.0f, 0.0f, 1.0f};
    for (size_t l = 0; l < LANES; l++) {
        const float *wi = normal, *wo = normal;
        b->above[l] = 0;
        if (l < count) {
            const float *i = at(pairs->wi, pairs->wi_stride, first + l);
            const float *o = at(pairs->wo, pairs->wo_stride, first + l);
            int above = hnbrdf_above_horizon(i, o);
            b->above[l] = above;
            wi = above ? i : normal;
            wo = above ? o : normal;
        }
        for (int k = 0; k < 3; k++) {
            b->wi[k][l] = wi[k];
            b->wo[k][l] = wo[k];
        }
    }
}

KERNEL_APART void scatter(const hnbrdf_pairs *pairs, size_t first, size_t count,
                          const lane_pairs *b)
{
    for (size_t l = 0; l < count; l++) {
        float *to = (float *)((char *)pairs->f + (first + l) * pairs->f_stride);
        for (int c = 0; c < 3; c++)
            to[c] = b->above[l] ? b->f[c][l] : 0.0f;
    }
}

KERNEL_APART void make_pairs(const lane_materials *restrict m, lane_pairs *restrict b)
{
    for (int l = 0; l < LANES; l++) {
        const hnbrdf_frame frame = {m->cosine[l], m->sine[l]};
        const float wi[3] = {b->wi[0][l], b->wi[1][l], b->wi[2][l]};
        const float wo[3] = {b->wo[0][l], b->wo[1][l], b->wo[2][l]};
        float i[3], o[3];
        hnbrdf_to_tangent(frame, wi, i);
        hnbrdf_to_tangent(frame, wo, o);
        hnbrdf_pair pair = hnbrdf_pair_make(i, o);
        b->wi[0][l] = pair.wi[0];
        b->wi[1][l] = pair.wi[1];
        b->wo[0][l] = pair.wo[0];
        b->wo[1][l] = pair.wo[1];
        b->sx[l] = pair.sx;
        b->sy[l] = pair.sy;
        b->sz[l] = pair.sz;
        b->length2[l] = pair.length2;
        b->c[l] = pair.c;
    }
}

static inline hnbrdf_pair pair_of(const lane_pairs *b, int l)
{
    return (hnbrdf_pair){.wi = {b->wi[0][l], b->wi[1][l], b->wi[2][l]},
                         .wo = {b->wo[0][l], b->wo[1][l], b->wo[2][l]},
                         .sx = b->sx[l],
                         .sy = b->sy[l],
                         .sz = b->sz[l],
                         .length2 = b->length2[l],
                         .c = b->c[l]};
}

/* Of pairs in the tangent frame. */
KERNEL_APART void density_lanes(const lane_lobes *restrict m, const lane_pairs *restrict b,
                                float *restrict pdf)
{
    for (int l = 0; l < LANES; l++) {
        hnbrdf_lobe lobes[HNBRDF_LOBES];
        hnbrdf_pair pair = pair_of(b, l);
        lobes_of(m, l, lobes);
        pdf[l] = hnbrdf_density(lobes, &pair);
    }
}

/* wo, and the two random numbers in wi. */
KERNEL_APART void gather_draws(const hnbrdf_draws *draws, size_t first, size_t count, lane_pairs *b)
{
    static const float normal[3] = {0.0f, 0.0f, 1.0f};
    for (size_t l = 0; l < LANES; l++) {
        const float *wo = normal, *u = normal;
        b->above[l] = 0;
        if (l < count) {
            const float *o = at(draws->wo, draws->wo_stride, first + l);
            b->above[l] = o[2] > 0.0f;
            wo = b->above[l] ? o : normal;
            u = at(draws->u, draws->u_stride, first + l);
        }
        for (int k = 0; k < 3; k++)
            b->wo[k][l] = wo[k];
        for (int k = 0; k < 2; k++)
            b->wi[k][l] = u[k];
    }
}

/* The lobe of each draw from the first number. */
typedef struct lane_choices {
    lane ax, ay, azimuth;
    int is_lobe[LANES], is_all[LANES];
} lane_choices;

KERNEL_APART void choose_lanes(const lane_lobes *restrict s, const lane_pairs *restrict b,
                               lane_choices *restrict to)
{
    for (int l = 0; l < LANES; l++) {
        hnbrdf_lobe lobes[HNBRDF_LOBES];
        lobes_of(s, l, lobes);
        hnbrdf_choice choice = hnbrdf_choose(lobes, b->wo[2][l], b->wi[0][l], 0.0f);
        to->ax[l] = choice.ax;
        to->ay[l] = choice.ay;
        to->azimuth[l] = choice.azimuth;
        to->is_lobe[l] = choice.is_lobe;
        to->is_all[l] = choice.is_all;
    }
}

/* wi from what was chosen and the second number; `above` falls to 0 where nothing above the
 * horizon comes out, and wi is n there. */
KERNEL_APART void draw_lanes(const lane_materials *restrict m, const lane_choices *restrict from,
                             lane_pairs *restrict b)
{
    for (int l = 0; l < LANES; l++) {
        const hnbrdf_frame frame = {m->cosine[l], m->sine[l]};
        const hnbrdf_choice choice = {from->ax[l], from->ay[l], from->azimuth[l], from->is_lobe[l],
                                      from->is_all[l]};
        const float wo[3] = {b->wo[0][l], b->wo[1][l], b->wo[2][l]};
        float o[3], i[3], wi[3];
        hnbrdf_to_tangent(frame, wo, o);
        int drawn = hnbrdf_draw_chosen(&choice, o, b->wi[1][l], i);
        hnbrdf_from_tangent(frame, i, wi);
        int above = b->above[l] & drawn & (wi[2] > 0.0f);
        b->above[l] = above;
        b->wi[0][l] = above ? wi[0] : 0.0f;
        b->wi[1][l] = above ? wi[1] : 0.0f;
        b->wi[2][l] = above ? wi[2] : 1.0f;
    }
}

/* f = f_a */
KERNEL_APART void analytic_lanes(const lane_materials *restrict m, lane_pairs *restrict b)
{
    for (int l = 0; l < LANES; l++) {
        hnbrdf_pair pair = pair_of(b, l);
        float specular = hnbrdf_specular_of_area(&pair, m->ax[l], m->ay[l], m->area[l]);
        for (int c = 0; c < 3; c++)
            b->f[c][l] = hnbrdf_microfacet_of(m->diffuse[c][l], m->e[c][l], pair.c, specular);
    }
}

KERNEL_APART void finish_lanes(lane_pairs *b)
{
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++)
            b->f[c][l] = hnbrdf_finish(b->f[c][l]);
}

/* One loop an encoding: none asks within it. */
#define ENCODE_LANES(encode)                           \
    for (int l = 0; l < LANES; l++) {                  \
        hnbrdf_pair pair = pair_of(b, l);              \
        float encoded[HNBRDF_ENCODING_SIZE];           \
        encode(&pair, encoded);                        \
        for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++) \
            x[i][l] = encoded[i];                      \
    }

static void encode_lanes(hnbrdf_encoding encoding, lane_pairs *restrict b, lane *restrict x)
{
#define ENCODE_CASE(ENUM, function, name, reciprocal, azimuth) \
    case HNBRDF_ENCODING_##ENUM:                               \
        ENCODE_LANES(hnbrdf_encode_##function)                 \
        break;
    switch (encoding) {
        HNBRDF_ENCODINGS(ENCODE_CASE)
    }
#undef ENCODE_CASE
}

static void compose_lanes(const hnbrdf_model_desc *desc, lane_pairs *b)
{
    const float scale = desc->scale, shift = desc->shift, lowest = desc->floor;
    if (desc->kind == HNBRDF_KIND_HYBRID)
        for (int c = 0; c < 3; c++)
            for (int l = 0; l < LANES; l++)
                b->f[c][l] = hnbrdf_compose_hybrid(b->out[c][l], b->out[c + 3][l], b->f[c][l],
                                                   scale, shift, lowest);
    else
        for (int c = 0; c < 3; c++)
            for (int l = 0; l < LANES; l++)
                b->f[c][l] = hnbrdf_compose_neural(b->out[c][l], scale, shift, lowest);
}

/* Everything between gather and scatter. shared: the one material of all lanes, or NULL, then b->x
 * begins with the latent codes. */
KERNEL_APART void evaluate_lanes(const hnbrdf_model *model, const hnbrdf_prepared *shared,
                                 const lane_materials *m, lane_pairs *b)
{
    const hnbrdf_model_desc *desc = &model->desc;
    lane *encoded = b->x + desc->latent;
    make_pairs(m, b);
    if (desc->kind != HNBRDF_KIND_NEURAL)
        analytic_lanes(m, b);
    if (desc->kind == HNBRDF_KIND_GGX) {
        finish_lanes(b);
        return;
    }
    encode_lanes(desc->encoding, b, encoded);
    if (shared)
        network_folded(shared, encoded, b->out);
    else
        network_lanes(model, model->packed[0], desc->latent + HNBRDF_ENCODING_SIZE, b->x,
                      model->packed_biases[0], b->out);
    compose_lanes(desc, b);
}

/* ---- Batches --------------------------------------------------------------------------------- */

static void spread_material(const hnbrdf_prepared *prepared, lane_materials *m)
{
    for (int l = 0; l < LANES; l++)
        put_material(prepared, l, m);
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

static void kernel_analytic(const hnbrdf_prepared *prepared, const hnbrdf_pairs *pairs)
{
    const int none = prepared->model->desc.kind == HNBRDF_KIND_NEURAL;
    lane_materials materials;
    lane_pairs block;
    spread_material(prepared, &materials);
    for (size_t k = 0; k < pairs->count; k += LANES) {
        size_t count = smaller(LANES, pairs->count - k);
        gather(pairs, k, count, &block);
        make_pairs(&materials, &block);
        analytic_lanes(&materials, &block);
        finish_lanes(&block);
        if (none)
            memset(block.above, 0, sizeof block.above);
        scatter(pairs, k, count, &block);
    }
}

/* The materials of the blocks of one batch, by lane. */
typedef struct block_materials {
    const hnbrdf_materials *of;
    const hnbrdf_prepared *shared; /* that of all lanes, or NULL */
    const hnbrdf_material *held;   /* what `prepared` was made from, or NULL */
    hnbrdf_prepared prepared;
    lane_materials by_lane;
    lane_lobes lobes;
    int sampled; /* 1: the lobes are wanted */
} block_materials;

static void begin_materials(const hnbrdf_materials *of, int sampled, block_materials *m)
{
    m->of = of;
    m->held = NULL;
    m->sampled = sampled;
    m->shared = of->prepared;
    if (!m->shared)
        return;
    spread_material(m->shared, &m->by_lane);
    for (int l = 0; l < LANES && sampled; l++)
        put_lobes(m->shared, l, &m->lobes);
}

/* Those of items first to first + count of the batch. Where all lanes have the same one, that is
 * prepared (unless it is already) and `shared`; else the latent codes are put before what will be
 * encoded. */
static void take_materials(block_materials *m, size_t first, size_t count, lane_pairs *b)
{
    const hnbrdf_materials *of = m->of;
    const hnbrdf_material *own[LANES];
    int same = 1;
    if (of->prepared)
        return;
    for (size_t l = 0; l < LANES; l++) {
        size_t item = first + smaller(l, count - 1);
        own[l] = of->index ? of->materials + of->index[item] : of->materials + item;
        same &= own[l] == own[0];
    }
    m->shared = same ? &m->prepared : NULL;
    if (same && m->held == own[0])
        return;
    m->held = same ? own[0] : NULL;
    for (int l = 0; l < LANES; l++) {
        if (l == 0 && same)
            hnbrdf_prepare(of->model, own[0], &m->prepared);
        else if (l == 0 || own[l] != own[l - 1]) {
            hnbrdf_prepare_analytic(of->model, own[l], &m->prepared);
            if (m->sampled)
                hnbrdf_prepare_lobes(of->model, own[l], &m->prepared);
        }
        put_material(&m->prepared, l, &m->by_lane);
        if (m->sampled)
            put_lobes(&m->prepared, l, &m->lobes);
        for (int i = 0; i < of->model->desc.latent && !same; i++)
            b->x[i][l] = own[l]->latent[i];
    }
}

static void kernel_eval(const hnbrdf_materials *of, const hnbrdf_pairs *pairs)
{
    block_materials materials;
    lane_pairs block;
    begin_materials(of, 0, &materials);
    for (size_t k = 0; k < pairs->count; k += LANES) {
        size_t count = smaller(LANES, pairs->count - k);
        take_materials(&materials, k, count, &block);
        gather(pairs, k, count, &block);
        evaluate_lanes(of->model, materials.shared, &materials.by_lane, &block);
        scatter(pairs, k, count, &block);
    }
}

static void kernel_pdf(const hnbrdf_materials *of, const hnbrdf_pairs *pairs)
{
    block_materials materials;
    lane_pairs block;
    begin_materials(of, 1, &materials);
    for (size_t k = 0; k < pairs->count; k += LANES) {
        size_t count = smaller(LANES, pairs->count - k);
        take_materials(&materials, k, count, &block);
        gather(pairs, k, count, &block);
        make_pairs(&materials.by_lane, &block);
        lane pdf;
        density_lanes(&materials.lobes, &block, pdf);
        for (size_t l = 0; l < count; l++)
            *(float *)((char *)pairs->f + (k + l) * pairs->f_stride) =
                block.above[l] ? pdf[l] : 0.0f;
    }
}

/* Draws, then evaluates what was drawn. */
static void kernel_sample(const hnbrdf_materials *of, const hnbrdf_draws *draws)
{
    block_materials materials;
    lane_pairs block;
    begin_materials(of, 1, &materials);
    for (size_t k = 0; k < draws->count; k += LANES) {
        size_t count = smaller(LANES, draws->count - k);
        lane_choices choices;
        lane wi[3], wo[3], pdf;
        take_materials(&materials, k, count, &block);
        gather_draws(draws, k, count, &block);
        memcpy(wo, block.wo, sizeof wo);
        choose_lanes(&materials.lobes, &block, &choices);
        draw_lanes(&materials.by_lane, &choices, &block);
        memcpy(wi, block.wi, sizeof wi);
        make_pairs(&materials.by_lane, &block);
        density_lanes(&materials.lobes, &block, pdf);
        for (int l = 0; l < LANES; l++)
            block.above[l] &= pdf[l] > 0.0f;
        memcpy(block.wi, wi, sizeof wi);
        memcpy(block.wo, wo, sizeof wo);
        evaluate_lanes(of->model, materials.shared, &materials.by_lane, &block);
        for (size_t l = 0; l < count; l++) {
            hnbrdf_sample_result *to =
                (hnbrdf_sample_result *)(void *)((char *)draws->results +
                                                 (k + l) * draws->result_stride);
            const int drawn = block.above[l];
            to->pdf = drawn ? pdf[l] : 0.0f;
            for (int c = 0; c < 3; c++) {
                to->wi[c] = drawn ? wi[c][l] : c == 2 ? 1.0f : 0.0f;
                to->weight[c] = drawn ? hnbrdf_finish(block.f[c][l] * wi[2][l] / pdf[l]) : 0.0f;
            }
        }
    }
}

const hnbrdf_kernel KERNEL_TABLE = {.variant = KERNEL_VARIANT,
                                    .fold = kernel_fold,
                                    .single = kernel_single,
                                    .eval = kernel_eval,
                                    .analytic = kernel_analytic,
                                    .pdf = kernel_pdf,
                                    .sample = kernel_sample,
                                    .network = kernel_network};
