/* kernel_own.h: one material's own numbers on a network that stays. Part of kernel_body.h, and
 * included by it alone. */

/* rows [padded][FIT_LANES]: the weights of the latent code, unit by unit; the rest is 0. */
static void kernel_own_rows(const fit_layout *l, const REAL *parameters, REAL *rows)
{
    for (int u = 0; u < l->padded; u++)
        for (int j = 0; j < FIT_LANES; j++)
            rows[u * FIT_LANES + j] =
                j < l->latent_size ? parameters[l->latent + (size_t)(j * l->padded + u)] : (REAL)0;
}

/* f of a channel before it is clipped at 0, and its derivatives by the outputs c and g. */
static void own_channel(const fit_layout *l, const REAL *out, int k, const REAL *analytic, REAL *u,
                        REAL *by_c, REAL *by_g, REAL *gate)
{
    const int hybrid = l->kind == HNBRDF_KIND_HYBRID;
    REAL e[FIT_TILE], inside[FIT_TILE];
    if (hybrid) {
        bounded_exp(out + k + 3, -1, gate, inside);
        for (int b = 0; b < FIT_TILE; b++)
            gate[b] = 1 / (1 + gate[b]);
    }
    bounded_exp(out + k, 1, e, inside);
    for (int b = 0; b < FIT_TILE; b++) {
        u[b] = e[b] + (hybrid ? gate[b] * analytic[b] : 0) - (REAL)l->floor;
        by_c[b] = e[b] * inside[b];
        by_g[b] = hybrid ? analytic[b] * (gate[b] * (1 - gate[b])) : 0;
    }
}

/* Weights of squares that have the slope of the loss. */
static void own_weights(const REAL *u, const float *target, const REAL *slope, REAL width,
                        REAL *weight)
{
    for (int b = 0; b < FIT_TILE; b++) {
        const REAL t = (REAL)target[b], f = u[b] > 0 ? u[b] : 0;
        const REAL off = f > t ? f - t : t - f;
        const REAL least = width * (f + t + (REAL)FIT_SMAPE_OFFSET);
        weight[b] = (slope[b] > 0 ? slope[b] : -slope[b]) / (off > least ? off : least);
    }
}

/* Derivatives of f of channel k by the latent code, to columns 0 to FIT_LANES - 1 of
 * by_own [FIT_TILE][stride]; back and next [FIT_TILE][padded] are room. */
static void own_backward(const fit_layout *l, const REAL *parameters, const REAL *derived,
                         const REAL *rows, const REAL *slope, int k, const REAL *by_c,
                         const REAL *by_g, REAL *back, REAL *next, REAL *by_own, int stride)
{
    const int n = l->padded, area = FIT_TILE * n;
    const REAL *c = parameters + l->last + (size_t)(k * n), *g = c + 3 * n;
    const REAL *first = slope + (l->layers - 1) * area;
    for (int b = 0; b < FIT_TILE; b++)
        for (int u = 0; u < n; u++)
            back[b * n + u] = (l->outputs > 3 ? by_c[b] * c[u] + by_g[b] * g[u] : by_c[b] * c[u]) *
                              first[b * n + u];
    for (int layer = l->layers - 1; layer > 0; layer--) {
        product(back, n, n, derived + (layer - 1) * n * n, n, NULL, slope + (layer - 1) * area,
                next, n);
        REAL *swap = back;
        back = next;
        next = swap;
    }
    product(back, n, n, rows, FIT_LANES, NULL, NULL, by_own, stride);
}

/* Derivatives of f of channel k by kd, eta and alpha, to columns FIT_LANES and up. */
static void own_analytic(const analytic_cache *cache, int k, const REAL *gate, REAL *by_own,
                         int stride)
{
    const REAL inv_pi = (REAL)(1 / 3.14159265358979);
    for (int b = 0; b < FIT_TILE; b++) {
        REAL *row = by_own + b * stride + FIT_LANES;
        const REAL open = gate ? gate[b] : 1, lobe = open * cache->specular[b];
        memset(row, 0, sizeof(REAL) * FIT_LANES);
        row[FIT_KD + k] = open * inv_pi;
        row[FIT_ETA + k] = lobe * cache->by_eta[k][b];
        for (int axis = 0; axis < 2; axis++)
            row[FIT_ALPHA + axis] = lobe * cache->fresnel[k][b] * cache->by_alpha[axis][b];
    }
}

/* Adds to normal: first the gradient, [stride], then the matrix [stride][stride], of which the
 * first `used` rows are filled. */
static void own_sum(const REAL *by_own, int stride, int used, const REAL *slope, const REAL *weight,
                    REAL *normal)
{
    REAL weighed[FIT_TILE * FIT_OWN];
    for (int b = 0; b < FIT_TILE; b++)
        for (int j = 0; j < stride; j++)
            weighed[b * stride + j] = weight[b] * by_own[b * stride + j];
    outer(slope, 1, 1, by_own, stride, stride, normal);
    outer(weighed, stride, used, by_own, stride, stride, normal + stride);
}

/* What both kernels of this section begin with. */
typedef struct own_pass {
    int n, stride, used;
    REAL *slope, *back, *next, *out;
    REAL analytic[3][FIT_TILE];
    analytic_cache cache;
} own_pass;

static void own_forward(const fit_layout *l, const REAL *parameters, const REAL *derived,
                        const fit_tile *tile, const REAL *own, REAL *scratch, own_pass *p)
{
    const int area = FIT_TILE * l->padded;
    REAL *x = scratch + (2 * l->layers + 2) * area;
    p->n = l->padded;
    p->stride = hnbrdf_fit_own_stride(l);
    p->used = p->stride > FIT_LANES ? FIT_LANES + FIT_ROTATION : l->latent_size;
    p->slope = scratch + l->layers * area;
    p->back = p->slope + l->layers * area;
    p->next = p->back + area;
    p->out = x + FIT_TILE * FIT_INPUTS;
    for (int i = 0; i < FIT_TILE * FIT_INPUTS; i++)
        x[i] = (REAL)tile->x[i];
    forward(l, parameters, derived, own, x, scratch, p->slope, p->out + 2 * FIT_TILE * FIT_LANES,
            p->out);
    if (p->stride > FIT_LANES)
        analytic_forward(own + FIT_LANES, tile, &p->cache, p->analytic);
    else if (l->kind == HNBRDF_KIND_HYBRID)
        copy_analytic(tile, p->analytic);
}

/* The analytic part alone: its loss, and what it adds to normal. */
static double own_alone(const own_pass *p, const fit_tile *tile, REAL width, REAL *by_own,
                        REAL *normal)
{
    REAL by_f[FIT_TILE], weight[FIT_TILE];
    double loss = 0.0;
    memset(by_own, 0, sizeof(REAL) * FIT_TILE * FIT_OWN);
    for (int k = 0; k < 3; k++) {
        const float *target = tile->target + k * FIT_TILE;
        loss += channel_loss(p->analytic[k], target, 1, by_f);
        own_weights(p->analytic[k], target, by_f, width, weight);
        own_analytic(&p->cache, k, NULL, by_own, FIT_OWN);
        own_sum(by_own, FIT_OWN, p->used, by_f, weight, normal);
    }
    return loss;
}

static double kernel_own(const fit_layout *l, const REAL *parameters, const REAL *derived,
                         const REAL *rows, const fit_tile *tile, const REAL *own, REAL mix,
                         REAL width, REAL *scratch, REAL *normal, double *alone)
{
    REAL u[FIT_TILE], by_f[FIT_TILE], weight[FIT_TILE], by_c[FIT_TILE], by_g[FIT_TILE];
    REAL gate[FIT_TILE], by_own[FIT_TILE * FIT_OWN];
    own_pass p;
    double loss = 0.0;
    own_forward(l, parameters, derived, tile, own, scratch, &p);
    for (int k = 0; k < 3; k++) {
        const float *target = tile->target + k * FIT_TILE;
        own_channel(l, p.out, k, p.analytic[k], u, by_c, by_g, gate);
        loss += channel_loss(u, target, mix, by_f);
        if (!normal)
            continue;
        own_weights(u, target, by_f, width, weight);
        own_backward(l, parameters, derived, rows, p.slope, k, by_c, by_g, p.back, p.next, by_own,
                     p.stride);
        if (p.stride > FIT_LANES)
            own_analytic(&p.cache, k, gate, by_own, p.stride);
        own_sum(by_own, p.stride, p.used, by_f, weight, normal);
    }
    if (normal && alone && p.stride > FIT_LANES)
        *alone += own_alone(&p, tile, width, by_own, normal + (FIT_OWN + 1) * FIT_OWN);
    return loss;
}

/* One light of a pixel: its squared error, and what it adds to normal. */
static double own_light(const REAL *error, const REAL *light, REAL weight, const REAL *by_own,
                        int stride, int used, REAL *normal)
{
    REAL by[FIT_OWN] = {0}, products[FIT_TILE];
    for (int b = 0; b < FIT_TILE; b++)
        products[b] = light[b] * error[b];
    const REAL sum = tile_sum(products);
    outer(light, 1, 1, by_own, stride, stride, by);
    for (int j = 0; j < stride; j++)
        normal[j] += 2 * weight * sum * by[j];
    for (int i = 0; i < used; i++)
        for (int j = 0; j < stride; j++)
            normal[(i + 1) * stride + j] += 2 * weight * by[i] * by[j];
    return (double)sum * (double)sum;
}

static void kernel_pixel(const fit_layout *l, const REAL *parameters, const REAL *derived,
                         const REAL *rows, const fit_tile *tile, const float *lights,
                         const float *weights, const REAL *own, REAL *scratch, REAL *normal,
                         double *squares)
{
    REAL u[FIT_TILE], by_c[FIT_TILE], by_g[FIT_TILE], gate[FIT_TILE], by_own[FIT_TILE * FIT_OWN];
    REAL light[FIT_TILE];
    own_pass p;
    own_forward(l, parameters, derived, tile, own, scratch, &p);
    for (int k = 0; k < 3; k++) {
        own_channel(l, p.out, k, p.analytic[k], u, by_c, by_g, gate);
        for (int b = 0; b < FIT_TILE; b++) {
            const REAL f = u[b] > 0 ? u[b] : 0;
            u[b] = (f < (REAL)FIT_MOST ? f : (REAL)FIT_MOST) - (REAL)tile->target[k * FIT_TILE + b];
        }
        own_backward(l, parameters, derived, rows, p.slope, k, by_c, by_g, p.back, p.next, by_own,
                     p.stride);
        if (p.stride > FIT_LANES)
            own_analytic(&p.cache, k, gate, by_own, p.stride);
        for (int s = 0; s < FIT_LIGHTS; s++) {
            for (int b = 0; b < FIT_TILE; b++)
                light[b] = (REAL)lights[s * FIT_TILE + b];
            squares[s] += own_light(u, light, (REAL)weights[s], by_own, p.stride, p.used, normal);
        }
    }
}
