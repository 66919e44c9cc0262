/* kernel_body.h: the text of every kernel, included once per instruction set and once in double.
 * The includer defines REAL, REAL_EXP, REAL_EXP_INSIDE (for x in [-80, 80]), REAL_LOG, REAL_SQRT,
 * REAL_COS, REAL_SIN, and KERNEL_WIDTH, the numbers in one vector of its machine. */
#include "fit/kernel.h"

#include <string.h>

typedef REAL vector
    __attribute__((vector_size(KERNEL_WIDTH * sizeof(REAL)), aligned(sizeof(REAL)), may_alias));

/* Rows of a register tile: eight independent sums hide the latency of an addition. */
enum { KERNEL_ROWS = 8 };

/* y[b][u] = (bias[u] + sum over k of x[b][k] w[k][u]) times[b][u], b in the tile, u < columns (a
 * multiple of FIT_LANES); bias and times, laid out as y, may be NULL. Strides are in numbers. */
static void product(const REAL *restrict x, int x_stride, int depth, const REAL *restrict w,
                    int columns, const REAL *restrict bias, const REAL *restrict times,
                    REAL *restrict y, int y_stride)
{
    for (int u = 0; u < columns; u += KERNEL_WIDTH)
        for (int b = 0; b < FIT_TILE; b += KERNEL_ROWS) {
            vector sums[KERNEL_ROWS];
            for (int r = 0; r < KERNEL_ROWS; r++)
                if (bias)
                    sums[r] = *(const vector *)(bias + u);
                else
                    memset(&sums[r], 0, sizeof sums[r]);
            for (int k = 0; k < depth; k++) {
                vector row = *(const vector *)(w + k * columns + u);
                for (int r = 0; r < KERNEL_ROWS; r++)
                    sums[r] += row * x[(b + r) * x_stride + k];
            }
            if (times)
                for (int r = 0; r < KERNEL_ROWS; r++)
                    sums[r] *= *(const vector *)(times + (b + r) * y_stride + u);
            for (int r = 0; r < KERNEL_ROWS; r++)
                *(vector *)(y + (b + r) * y_stride + u) = sums[r];
        }
}

/* One block of outer(): `rows` of g from row k on, a constant where this is inlined. */
static inline __attribute__((always_inline)) void outer_block(const REAL *restrict a, int a_stride,
                                                              const REAL *restrict y, int y_stride,
                                                              REAL *restrict g, int columns,
                                                              int rows)
{
    vector sums[KERNEL_ROWS];
    memset(sums, 0, sizeof sums);
    for (int b = 0; b < FIT_TILE; b++) {
        vector row = *(const vector *)(y + b * y_stride);
        for (int r = 0; r < rows; r++)
            sums[r] += row * a[b * a_stride + r];
    }
    for (int r = 0; r < rows; r++)
        *(vector *)(g + r * columns) += sums[r];
}

/* g[k][u] += sum over b of a[b][k] y[b][u], k < rows, u < columns (a multiple of FIT_LANES). What
 * is left of whole blocks is mostly 6, the inputs or outputs of a network. */
static void outer(const REAL *restrict a, int a_stride, int rows, const REAL *restrict y,
                  int y_stride, int columns, REAL *restrict g)
{
    for (int u = 0; u < columns; u += KERNEL_WIDTH) {
        int k = 0;
        for (; k + KERNEL_ROWS <= rows; k += KERNEL_ROWS)
            outer_block(a + k, a_stride, y + u, y_stride, g + k * columns + u, columns,
                        KERNEL_ROWS);
        for (; k + 6 <= rows; k += 6)
            outer_block(a + k, a_stride, y + u, y_stride, g + k * columns + u, columns, 6);
        for (; k + 3 <= rows; k += 3)
            outer_block(a + k, a_stride, y + u, y_stride, g + k * columns + u, columns, 3);
        for (; k < rows; k++)
            outer_block(a + k, a_stride, y + u, y_stride, g + k * columns + u, columns, 1);
    }
}

/* column_sums() of so many vectors, a constant where this is inlined. */
static inline __attribute__((always_inline)) void sum_block(const REAL *restrict y, int stride,
                                                            REAL *restrict sums, int vectors)
{
    vector sum[4];
    for (int v = 0; v < vectors; v++)
        sum[v] = *(const vector *)(y + v * KERNEL_WIDTH);
    for (int b = 1; b < FIT_TILE; b++)
        for (int v = 0; v < vectors; v++)
            sum[v] += *(const vector *)(y + b * stride + v * KERNEL_WIDTH);
    for (int v = 0; v < vectors; v++)
        *(vector *)(sums + v * KERNEL_WIDTH) = sum[v];
}

/* sums[u] = sum over b of y[b][u]; four vectors at once hide the latency of an addition. */
static void column_sums(const REAL *restrict y, int stride, int columns, REAL *restrict sums)
{
    int u = 0;
    for (; u + 4 * KERNEL_WIDTH <= columns; u += 4 * KERNEL_WIDTH)
        sum_block(y + u, stride, sums + u, 4);
    for (; u + 2 * KERNEL_WIDTH <= columns; u += 2 * KERNEL_WIDTH)
        sum_block(y + u, stride, sums + u, 2);
    for (; u < columns; u += KERNEL_WIDTH)
        sum_block(y + u, stride, sums + u, 1);
}

/* HardGELU and its derivative, in place: pre becomes the activation. */
static void activate(REAL *restrict pre, REAL *restrict slope, int count)
{
    const REAL third = (REAL)0.333333333f, half = (REAL)0.5;
    for (int i = 0; i < count; i++) {
        REAL x = pre[i], t = x * third + half;
        REAL clamped = t < 0 ? 0 : t;
        clamped = clamped > 1 ? 1 : clamped;
        slope[i] = t > 0 && t < 1 ? t + x * third : clamped;
        pre[i] = x * clamped;
    }
}

/* Sum over a tile in one fixed order: FIT_LANES partial sums, then those in order. */
static REAL tile_sum(const REAL *restrict v)
{
    REAL partial[FIT_LANES], sum = 0;
    for (int l = 0; l < FIT_LANES; l++)
        partial[l] = v[l];
    for (int b = FIT_LANES; b < FIT_TILE; b += FIT_LANES)
        for (int l = 0; l < FIT_LANES; l++)
            partial[l] += v[b + l];
    for (int l = 0; l < FIT_LANES; l++)
        sum += partial[l];
    return sum;
}

/* Loss of one channel over the tile and its derivative by u; see kernel.h. */
static double channel_loss(const REAL *restrict u, const float *restrict target, REAL mix,
                           REAL *restrict slope)
{
    REAL loss[FIT_TILE];
    const REAL e1 = (REAL)FIT_LOG_OFFSET, e2 = (REAL)FIT_SMAPE_OFFSET;
    for (int b = 0; b < FIT_TILE; b++) {
        REAL t = (REAL)target[b];
        REAL f = u[b] > 0 ? u[b] : 0;
        f = f < (REAL)FIT_MOST ? f : (REAL)FIT_MOST;
        REAL difference = f - t;
        REAL sign = difference > 0 ? (REAL)1 : (difference < 0 ? (REAL)-1 : (REAL)0);
        REAL sum = f + t + e2;
        loss[b] = (1 - mix) * (sign * REAL_LOG((f + e1) / (t + e1))) +
                  mix * (2 * (sign * difference) / sum);
        slope[b] = sign * ((1 - mix) / (f + e1) + mix * (2 * (2 * t + e2) / (sum * sum)));
    }
    return (double)tile_sum(loss);
}

/* ---- The analytic part ----------------------------------------------------------------------- */

/* What the backward pass needs of one tile. */
typedef struct analytic_cache {
    REAL specular[FIT_TILE];    /* D V V */
    REAL by_alpha[2][FIT_TILE]; /* d ln(D V V) / d ln alpha */
    REAL by_rotation[FIT_TILE]; /* d ln(D V V) / d rotation */
    REAL fresnel[3][FIT_TILE];
    REAL by_eta[3][FIT_TILE]; /* d F / d ln(eta - 1) */
} analytic_cache;

static void analytic_forward(const REAL *p, const fit_tile *tile, analytic_cache *cache,
                             REAL value[3][FIT_TILE])
{
    const REAL pi = (REAL)3.14159265358979;
    REAL ax2 = REAL_EXP(2 * p[FIT_ALPHA]), ay2 = REAL_EXP(2 * p[FIT_ALPHA + 1]);
    REAL area = pi * REAL_EXP(p[FIT_ALPHA]) * REAL_EXP(p[FIT_ALPHA + 1]);
    REAL cosine = REAL_COS(p[FIT_ROTATION]), sine = REAL_SIN(p[FIT_ROTATION]);
    const float *wi = tile->wi, *wo = tile->wo;
    REAL c[FIT_TILE];
    for (int b = 0; b < FIT_TILE; b++) {
        REAL ix = cosine * (REAL)wi[b] + sine * (REAL)wi[FIT_TILE + b];
        REAL iy = cosine * (REAL)wi[FIT_TILE + b] - sine * (REAL)wi[b];
        REAL iz = (REAL)wi[2 * FIT_TILE + b];
        REAL ox = cosine * (REAL)wo[b] + sine * (REAL)wo[FIT_TILE + b];
        REAL oy = cosine * (REAL)wo[FIT_TILE + b] - sine * (REAL)wo[b];
        REAL oz = (REAL)wo[2 * FIT_TILE + b];
        REAL sx = ix + ox, sy = iy + oy, sz = iz + oz;
        REAL length2 = sx * sx + sy * sy + sz * sz;
        REAL tx = sx * sx / ax2, ty = sy * sy / ay2;
        REAL t = tx + ty + sz * sz; /* |s|^2 times the t of D */
        REAL ratio = t / length2;
        REAL qi = REAL_SQRT(iz * iz + ax2 * ix * ix + ay2 * iy * iy);
        REAL qo = REAL_SQRT(oz * oz + ax2 * ox * ox + ay2 * oy * oy);
        REAL vi = 1 / (iz + qi), vo = 1 / (oz + qo);
        REAL ki = vi / qi, ko = vo / qo;
        c[b] = (REAL)0.5 * REAL_SQRT(length2);
        cache->specular[b] = 1 / (area * ratio * ratio) * (vi * vo);
        cache->by_alpha[0][b] = 4 * tx / t - 1 - ax2 * (ki * ix * ix + ko * ox * ox);
        cache->by_alpha[1][b] = 4 * ty / t - 1 - ay2 * (ki * iy * iy + ko * oy * oy);
        cache->by_rotation[b] =
            -4 * sx * sy * (1 / ax2 - 1 / ay2) / t - (ax2 - ay2) * (ki * ix * iy + ko * ox * oy);
    }
    for (int k = 0; k < 3; k++) {
        REAL above = REAL_EXP(p[FIT_ETA + k]); /* eta - 1 */
        REAL eta = above + 1, e = above * (above + 2);
        REAL diffuse = p[FIT_KD + k] / pi;
        for (int b = 0; b < FIT_TILE; b++) {
            REAL g = REAL_SQRT(e + c[b] * c[b]), sum = g + c[b], difference = e / sum;
            REAL a = difference / sum;
            REAL below = c[b] * difference + 1;
            REAL d = (c[b] * sum - 1) / below;
            REAL a_g = 2 * c[b] / (sum * sum), d_g = 2 * c[b] * (1 - c[b] * c[b]) / (below * below);
            cache->fresnel[k][b] = (REAL)0.5 * a * a * (1 + d * d);
            cache->by_eta[k][b] = (a * a_g * (1 + d * d) + a * a * d * d_g) * (eta * above / g);
            value[k][b] = diffuse + cache->fresnel[k][b] * cache->specular[b];
        }
    }
}

/* Adds the gradient of the parameters, given the derivative of the loss by f_a. */
static void analytic_backward(const analytic_cache *cache, REAL slope[3][FIT_TILE], REAL *gradient)
{
    const REAL inv_pi = (REAL)(1 / 3.14159265358979);
    REAL lobe[FIT_TILE], v[FIT_TILE];
    memset(lobe, 0, sizeof lobe);
    for (int k = 0; k < 3; k++) {
        for (int b = 0; b < FIT_TILE; b++) {
            v[b] = slope[k][b] * cache->specular[b] * cache->by_eta[k][b];
            lobe[b] += slope[k][b] * cache->fresnel[k][b] * cache->specular[b];
        }
        gradient[FIT_KD + k] += tile_sum(slope[k]) * inv_pi;
        gradient[FIT_ETA + k] += tile_sum(v);
    }
    for (int axis = 0; axis < 2; axis++) {
        for (int b = 0; b < FIT_TILE; b++)
            v[b] = lobe[b] * cache->by_alpha[axis][b];
        gradient[FIT_ALPHA + axis] += tile_sum(v);
    }
    for (int b = 0; b < FIT_TILE; b++)
        v[b] = lobe[b] * cache->by_rotation[b];
    gradient[FIT_ROTATION] += tile_sum(v);
}

static double kernel_analytic(const REAL *parameters, const fit_tile *tile, REAL mix, REAL *scratch,
                              REAL *gradient)
{
    analytic_cache cache;
    REAL value[3][FIT_TILE], slope[3][FIT_TILE];
    double loss = 0.0;
    (void)scratch;
    analytic_forward(parameters, tile, &cache, value);
    for (int k = 0; k < 3; k++)
        loss += channel_loss(value[k], tile->target + k * FIT_TILE, mix, slope[k]);
    analytic_backward(&cache, slope, gradient);
    return loss;
}

/* ---- The network ----------------------------------------------------------------------------- */

/* derived: for k = 1 .. N-1 the hidden matrices output-major [padded][padded]; then the last one
 * input-major [padded][FIT_LANES], its unused columns 0. */
static void kernel_derive(const fit_layout *l, const REAL *parameters, REAL *derived)
{
    int n = l->padded;
    for (int k = 1; k < l->layers; k++, derived += n * n)
        for (int o = 0; o < n; o++)
            for (int i = 0; i < n; i++)
                derived[o * n + i] = parameters[l->hidden[k] + (size_t)(i * n + o)];
    for (int i = 0; i < n; i++)
        for (int o = 0; o < FIT_LANES; o++)
            derived[i * FIT_LANES + o] =
                o < l->outputs ? parameters[l->last + (size_t)(o * n + i)] : (REAL)0;
}

/* exp(x) and, where x is beyond what exp can take, 0 for its slope; x is `sign` times a column of
 * the network's outputs. Two loops: one would branch, which does not vectorise. */
static void bounded_exp(const REAL *restrict out, REAL sign, REAL *restrict e,
                        REAL *restrict inside)
{
    const REAL limit = 40;
    REAL x[FIT_TILE];
    for (int b = 0; b < FIT_TILE; b++) {
        REAL value = sign * out[b * FIT_LANES], low = value > -limit ? value : -limit;
        x[b] = low < limit ? low : limit;
        inside[b] = x[b] == value ? (REAL)1 : (REAL)0;
    }
    for (int b = 0; b < FIT_TILE; b++)
        e[b] = REAL_EXP_INSIDE(x[b]);
}

/* Values, loss and the derivative of the loss by the network's outputs (and by f_a, into
 * by_analytic). */
static double compose_loss(const fit_layout *l, const REAL *out, const fit_tile *tile,
                           REAL analytic[3][FIT_TILE], REAL mix, REAL *by_out,
                           REAL by_analytic[3][FIT_TILE])
{
    const int hybrid = l->kind == HNBRDF_KIND_HYBRID;
    double loss = 0.0;
    memset(by_out, 0, sizeof(REAL) * FIT_TILE * FIT_LANES);
    for (int k = 0; k < 3; k++) {
        REAL u[FIT_TILE], slope[FIT_TILE], e[FIT_TILE], gate[FIT_TILE], inside[FIT_TILE];
        if (hybrid) {
            bounded_exp(out + k + 3, -1, gate, inside);
            for (int b = 0; b < FIT_TILE; b++)
                gate[b] = 1 / (1 + gate[b]);
        }
        bounded_exp(out + k, 1, e, inside);
        for (int b = 0; b < FIT_TILE; b++)
            u[b] = e[b] + (hybrid ? gate[b] * analytic[k][b] : 0) - (REAL)l->floor;
        const float *target = tile->target + k * FIT_TILE;
        loss += channel_loss(u, target, mix, slope);
        for (int b = 0; b < FIT_TILE; b++) {
            REAL least = (REAL)l->lift * (hybrid ? gate[b] * analytic[k][b] : 0);
            REAL reach = u[b] * (REAL)FIT_LIFT_BELOW;
            REAL by = e[b] < least && reach < (REAL)target[b] ? least : e[b];
            by_out[b * FIT_LANES + k] = slope[b] * by * inside[b];
        }
        if (hybrid)
            for (int b = 0; b < FIT_TILE; b++) {
                by_out[b * FIT_LANES + k + 3] =
                    slope[b] * analytic[k][b] * (gate[b] * (1 - gate[b]));
                by_analytic[k][b] = slope[b] * gate[b];
            }
    }
    return loss;
}

/* What the hidden layers [layers][FIT_TILE][padded] and the outputs [FIT_TILE][FIT_LANES] come to.
 * The latent code is constant over the tile: it folds into the first bias, folded [padded]. */
static void forward(const fit_layout *l, const REAL *parameters, const REAL *derived,
                    const REAL *code, const REAL *x, REAL *activation, REAL *slope, REAL *folded,
                    REAL *out)
{
    const int n = l->padded, area = FIT_TILE * n;
    memcpy(folded, parameters + l->bias[0], sizeof(REAL) * (size_t)n);
    for (int j = 0; j < l->latent_size; j++)
        for (int u = 0; u < n; u++)
            folded[u] += parameters[l->latent + (size_t)(j * n + u)] * code[j];
    product(x, FIT_INPUTS, FIT_INPUTS, parameters + l->first, n, folded, NULL, activation, n);
    activate(activation, slope, area);
    for (int k = 1; k < l->layers; k++) {
        product(activation + (k - 1) * area, n, n, parameters + l->hidden[k], n,
                parameters + l->bias[k], NULL, activation + k * area, n);
        activate(activation + k * area, slope + k * area, area);
    }
    product(activation + (l->layers - 1) * area, n, n, derived + (l->layers - 1) * n * n, FIT_LANES,
            parameters + l->bias[l->layers], NULL, out, FIT_LANES);
}

static void copy_analytic(const fit_tile *tile, REAL analytic[3][FIT_TILE])
{
    for (int k = 0; k < 3; k++)
        for (int b = 0; b < FIT_TILE; b++)
            analytic[k][b] = (REAL)tile->analytic[k * FIT_TILE + b];
}

static double kernel_network(const fit_layout *l, const REAL *parameters, const REAL *derived,
                             const fit_tile *tile, int material, REAL mix, REAL *scratch,
                             REAL *gradient, REAL *by_own)
{
    const int n = l->padded, area = FIT_TILE * n;
    const size_t code = l->codes + (size_t)material * (size_t)l->latent_size;
    const size_t own = l->analytic + (size_t)material * FIT_ANALYTIC;
    REAL *activation = scratch, *slope = activation + l->layers * area,
         *back = slope + l->layers * area;
    REAL *next = back + area, *x = next + area, *out = x + FIT_TILE * FIT_INPUTS;
    REAL *by_out = out + FIT_TILE * FIT_LANES, *folded = by_out + FIT_TILE * FIT_LANES;
    REAL analytic[3][FIT_TILE], by_analytic[3][FIT_TILE];
    analytic_cache cache;

    for (int i = 0; i < FIT_TILE * FIT_INPUTS; i++)
        x[i] = (REAL)tile->x[i];
    forward(l, parameters, derived, parameters + code, x, activation, slope, folded, out);

    /* Loss. */
    if (l->kind == HNBRDF_KIND_HYBRID) {
        if (l->train_analytic)
            analytic_forward(parameters + own, tile, &cache, analytic);
        else
            copy_analytic(tile, analytic);
    }
    double loss = compose_loss(l, out, tile, analytic, mix, by_out, by_analytic);
    if (l->kind == HNBRDF_KIND_HYBRID && l->train_analytic)
        analytic_backward(&cache, by_analytic, by_own + l->latent_size);

    /* Backward: back holds the derivative by the pre-activation of the layer at hand. */
    outer(by_out, FIT_LANES, l->outputs, activation + (l->layers - 1) * area, n, n,
          gradient + l->last);
    REAL sums[HNBRDF_MAX_HIDDEN];
    column_sums(by_out, FIT_LANES, FIT_LANES, sums);
    for (int o = 0; o < l->outputs; o++)
        gradient[l->bias[l->layers] + (size_t)o] += sums[o];
    product(by_out, FIT_LANES, l->outputs, parameters + l->last, n, NULL,
            slope + (l->layers - 1) * area, back, n);
    for (int k = l->layers - 1; k >= 0; k--) {
        column_sums(back, n, n, sums);
        for (int u = 0; u < n; u++)
            gradient[l->bias[k] + (size_t)u] += sums[u];
        if (k == 0)
            break;
        outer(activation + (k - 1) * area, n, n, back, n, n, gradient + l->hidden[k]);
        product(back, n, n, derived + (k - 1) * n * n, n, NULL, slope + (k - 1) * area, next, n);
        REAL *swap = back;
        back = next;
        next = swap;
    }
    outer(x, FIT_INPUTS, FIT_INPUTS, back, n, n, gradient + l->first);
    for (int j = 0; j < l->latent_size; j++) {
        const REAL *row = parameters + l->latent + (size_t)(j * n);
        REAL *row_gradient = gradient + l->latent + (size_t)(j * n), by_code = 0;
        for (int u = 0; u < n; u++) {
            row_gradient[u] += sums[u] * parameters[code + (size_t)j];
            by_code += sums[u] * row[u];
        }
        by_own[j] += by_code;
    }
    return loss;
}

#include "fit/kernel_matrix.h"
#include "fit/kernel_own.h"
