/* kernel_single.h: one evaluation in vectors of four: what a pair of directions has several of
 * (directions, squares, quotients, logarithms, channels) side by side. A renderer waits for the
 * result, so that operations count by how long they keep the next one waiting. Every number has the
 * bits of the inline functions that define it. Part of kernel_body.h. */

/* One pair in the tangent frame; terms of hnbrdf_pair, microfacet.h and encoding.h. */
typedef struct single_pair {
    quad xy;    /* wi.x, wi.y, wo.x, wo.y */
    quad sum;   /* s.x, s.y, twice */
    quad z;     /* s.z, wi.z - wo.z, wi.z, wo.z */
    quad root;  /* lengths: |s|, |wi - wo|, of (ax wi.x, ay wi.y, wi.z), of wo
                 likewise */
    quad ratio; /* t of hnbrdf_ggx_d(), 1 - c, tan^2 th, sin^2 th */
} single_pair;

KERNEL_INLINE single_pair single_pair_of(const hnbrdf_prepared *prepared, const float wi[3],
                                         const float wo[3])
{
    const float sine = prepared->sine, sz = wi[2] + wo[2], dz = wi[2] - wo[2];
    const quad w = quad_of_two(wi, wo), alpha = quad_of_two(prepared->alpha, prepared->alpha);
    const quad sines = {sine, -sine, sine, -sine};
    single_pair p;
    p.xy = prepared->cosine * w + sines * QUAD_OF(w, w, 1, 0, 3, 2);
    const quad other = QUAD_OF(p.xy, p.xy, 2, 3, 0, 1), apart = p.xy - other;
    p.sum = p.xy + other;
    p.z = (quad){sz, dz, wi[2], wo[2]};
    const quad stretched = alpha * p.xy, halves = QUAD_OF(p.sum, apart, 0, 4, 1, 5);
    const quad x = QUAD_OF(halves, stretched, 0, 1, 4, 6),
               y = QUAD_OF(halves, stretched, 2, 3, 5, 7);
    const quad flat = x * x + y * y, z2 = p.z * p.z, length2 = flat + z2;
    p.root = quad_root(length2);
    const quad slope = p.sum / alpha, slope2 = slope * slope;
    const quad t = (slope2 + QUAD_ALL(slope2, 1)) + z2;
    const quad c1 = 1.0f + 0.5f * p.root;
    const quad from = QUAD_OF(t, 0.25f * length2, 0, 5, 0, 5);
    const quad over = QUAD_OF(QUAD_OF(length2, c1, 0, 4, 0, 0), z2, 0, 1, 4, 0);
    p.ratio = QUAD_OF(from, flat, 0, 1, 4, 4) / over;
    return p;
}

/* f_a; the fourth channel is filling. */
KERNEL_INLINE quad single_analytic(const hnbrdf_prepared *prepared, const single_pair *p)
{
    const quad lowest = prepared->area * (p->ratio * p->ratio), v = p->z + p->root;
    const quad inverse = 1.0f / QUAD_OF(lowest, v, 0, 0, 6, 7);
    const quad specular = QUAD_ALL(inverse, 0) * (QUAD_ALL(inverse, 2) * QUAD_ALL(inverse, 3));
    const quad c = 0.5f * QUAD_ALL(p->root, 0), e = quad_at(prepared->e);
    const quad sum = quad_root(e + c * c) + c, difference = e / sum, a = difference / sum;
    const quad b = (c * sum - 1.0f) / (c * difference + 1.0f);
    const quad fresnel = (0.5f * (a * a)) * (1.0f + b * b);
    return quad_at(prepared->diffuse) + fresnel * specular;
}

/* hnbrdf_encode(). */
KERNEL_INLINE void single_encode(hnbrdf_encoding encoding, const single_pair *p,
                                 float x[HNBRDF_ENCODING_SIZE])
{
    const float a = p->z[2], b = p->z[3];
    if (encoding == HNBRDF_ENCODING_DIRECTIONS) {
        const hnbrdf_pair pair = {.wi = {p->xy[0], p->xy[1], a}, .wo = {p->xy[2], p->xy[3], b}};
        hnbrdf_encode_directions(&pair, x);
        return;
    }
    const quad above = {1.0f, 1e-3f, 1e-5f, 1.0f};
    const quad h = (quad)((quad_bits)p->sum & INT32_MAX) / QUAD_ALL(p->root, 0);
    const quad logs = 0.25f * quad_log(p->ratio + above), roots = quad_root(p->ratio);
    x[0] = 1.0f + logs[2];
    x[1] = roots[3];
    x[2] = logs[1];
    x[3] = p->ratio[1];
    x[4] = a;
    x[5] = b;
    switch (encoding) {
    case HNBRDF_ENCODING_DIRECTIONS:
    case HNBRDF_ENCODING_ANGLES_DIRECTED:
        break;
    case HNBRDF_ENCODING_HALF_DIFFERENCE:
        x[1] = sqrtf(roots[3]);
        x[2] = 0.5f * p->root[0];
        x[3] = roots[1];
        x[4] = a * b;
        x[5] = p->z[0];
        break;
    case HNBRDF_ENCODING_ANGLES_ANISOTROPIC:
        x[1] = h[0];
        x[3] = h[1];
        /* fall through */
    case HNBRDF_ENCODING_ANGLES:
        x[4] = b < a ? b : a;
        x[5] = b < a ? a : b;
        break;
    case HNBRDF_ENCODING_ANGLES_AZIMUTHS:
        x[1] = h[0];
        x[4] = b < a ? b : a;
        x[5] = 0.5f * fabsf(p->xy[0] - p->xy[2]);
        break;
    }
}

enum { SINGLE_VECTORS = 8 / KERNEL_SINGLE };

/* exp() of the exponents of what the network gives: s c + m of three channels, then -g of three;
 * the rest is filling. Of -0 for 0 it is the same. */
KERNEL_INLINE void single_exponentials(const hnbrdf_model_desc *desc, const float *out,
                                       unit_vector e[SINGLE_VECTORS])
{
    const float s = desc->scale, m = desc->shift;
#if KERNEL_SINGLE == 8
    const unit_vector factors[] = {{s, s, s, -1.0f, -1.0f, -1.0f, -1.0f, -1.0f}};
    const unit_vector terms[] = {{m, m, m, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}};
#else
    const unit_vector factors[] = {{s, s, s, -1.0f}, {-1.0f, -1.0f, -1.0f, -1.0f}};
    const unit_vector terms[] = {{m, m, m, 0.0f}, {0.0f, 0.0f, 0.0f, 0.0f}};
#endif
    for (int v = 0; v < SINGLE_VECTORS; v++)
        e[v] = factors[v] * *(const unit_memory *)(out + v * KERNEL_SINGLE) + terms[v];
    units_exp(e, SINGLE_VECTORS);
}

/* The first three channels, and the fourth to sixth. */
KERNEL_INLINE quad single_first(const unit_vector v[SINGLE_VECTORS])
{
#if KERNEL_SINGLE == 8
    return _mm256_castps256_ps128(v[0]);
#else
    return v[0];
#endif
}

KERNEL_INLINE quad single_second(const unit_vector v[SINGLE_VECTORS])
{
#if KERNEL_SINGLE == 8
    const __m256i places = _mm256_setr_epi32(3, 4, 5, 5, 5, 5, 5, 5);
    return _mm256_castps256_ps128(_mm256_permutevar8x32_ps(v[0], places));
#else
    return QUAD_OF(v[0], v[1], 3, 4, 5, 5);
#endif
}

/* The network's sums are one long wait, in whose shadow f_a is worked out. */
static void kernel_single(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3],
                          float f[3])
{
    const hnbrdf_model_desc *desc = &prepared->model->desc;
    const single_pair pair = single_pair_of(prepared, wi, wo);
    quad value;
    if (desc->kind == HNBRDF_KIND_GGX) {
        value = single_analytic(prepared, &pair);
    } else {
        float x[HNBRDF_ENCODING_SIZE], out[HNBRDF_MAX_HIDDEN];
        unit_vector e[SINGLE_VECTORS], gate[SINGLE_VECTORS];
        quad f_a = {0};
        single_encode(desc->encoding, &pair, x);
        if (desc->kind == HNBRDF_KIND_HYBRID)
            f_a = single_analytic(prepared, &pair);
        network_single(prepared, x, out);
        single_exponentials(desc, out, e);
        value = single_first(e);
        if (desc->kind == HNBRDF_KIND_HYBRID) {
            for (int v = 0; v < SINGLE_VECTORS; v++)
                gate[v] = 1.0f / (1.0f + e[v]);
            value = value + single_second(gate) * f_a;
        }
        value = value - desc->floor;
    }
    value = quad_clamp(value, 0.0f, HNBRDF_MAX_VALUE);
    f[0] = value[0];
    f[1] = value[1];
    f[2] = value[2];
}
