/* kernel_lanes.h: a block of pairs, arrays over lanes: gathered, encoded, evaluated, drawn; and
 * what their materials and sampling lobes are. Part of kernel_body.h, after kernel_network.h. */
#include "core/compose.h"
#include "core/encoding.h"
#include "core/sampling.h"

/* The materials of a block. */
typedef struct lane_materials {
    lane cosine, sine, ax, ay, area, diffuse[3], e[3];
} lane_materials;

/* Pairs in the tangent frames of their materials, and what comes of them. Lanes that have no pair
 * above the horizon hold wi = wo = n, and 0 in `above`. */
typedef struct lane_pairs {
    lane wi[3], wo[3], sx, sy, sz, length2, c, specular, f[3];
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

/* What edits add to the materials of a block of which some are edited; the others have numbers that
 * change no bit. */
typedef struct lane_edits {
    lane x, y, ax, ay, area, diffuse[3], e[3], carried[3], added[3];
    int other_eta; /* 1: the eta of some lane is edited */
} lane_edits;

static void put_edit(const hnbrdf_prepared *prepared, int l, lane_edits *m)
{
    const hnbrdf_prepared_edit edit = hnbrdf_edit_of(prepared);
    m->other_eta = l > 0 && m->other_eta; /* lanes come in order */
    m->x[l] = edit.warp[0];
    m->y[l] = edit.warp[1];
    m->ax[l] = edit.alpha[0];
    m->ay[l] = edit.alpha[1];
    m->area[l] = edit.area;
    for (int c = 0; c < 3; c++) {
        m->diffuse[c][l] = edit.diffuse[c];
        m->e[c][l] = edit.e[c];
        m->other_eta |= edit.e[c] != prepared->e[c];
        m->carried[c][l] = edit.carried[c];
        m->added[c][l] = edit.added[c];
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

/* Lanes without a pair above the horizon: wi = wo = n. */
KERNEL_APART void mark_lanes(lane_pairs *b)
{
    for (int l = 0; l < LANES; l++) {
        int above = (b->wi[2][l] > 0.0f) & (b->wo[2][l] > 0.0f);
        b->above[l] = above;
        for (int k = 0; k < 3; k++) {
            b->wi[k][l] = above ? b->wi[k][l] : k == 2 ? 1.0f : 0.0f;
            b->wo[k][l] = above ? b->wo[k][l] : k == 2 ? 1.0f : 0.0f;
        }
    }
}

/* Directions first to first + count. */
KERNEL_APART void gather_directions(const float *w, size_t stride, size_t first, size_t count,
                                    lane to[3])
{
    if (stride == 3 * sizeof(float) && count == LANES) {
        w += 3 * first; /* without gaps, as most are: a loop of its own, in vectors */
        for (int l = 0; l < LANES; l++)
            for (int k = 0; k < 3; k++)
                to[k][l] = w[3 * l + k];
        return;
    }
    for (size_t l = 0; l < LANES; l++) {
        const float *from = at(w, stride, first + (l < count ? l : 0));
        for (int k = 0; k < 3; k++)
            to[k][l] = l < count ? from[k] : 0.0f;
    }
}

static void gather(const hnbrdf_pairs *pairs, size_t first, size_t count, lane_pairs *b)
{
    gather_directions(pairs->wi, pairs->wi_stride, first, count, b->wi);
    gather_directions(pairs->wo, pairs->wo_stride, first, count, b->wo);
}

KERNEL_APART void scatter(const hnbrdf_pairs *pairs, size_t first, size_t count, lane_pairs *b)
{
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++)
            b->f[c][l] = b->above[l] ? b->f[c][l] : 0.0f;
    if (pairs->f_stride == 3 * sizeof(float) && count == LANES) {
        float *to = pairs->f + 3 * first;
        for (int l = 0; l < LANES; l++)
            for (int c = 0; c < 3; c++)
                to[3 * l + c] = b->f[c][l];
        return;
    }
    for (size_t l = 0; l < count; l++) {
        float *to = (float *)((char *)pairs->f + (first + l) * pairs->f_stride);
        for (int c = 0; c < 3; c++)
            to[c] = b->f[c][l];
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

/* wi from what was chosen and the second number; `above` falls to 0 where nothing above the horizon
 * comes out, and wi is n there. */
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

/* What the Fresnel factors multiply, then f = f_a. */
KERNEL_APART void specular_lanes(const lane_materials *restrict m, lane_pairs *restrict b)
{
    for (int l = 0; l < LANES; l++) {
        hnbrdf_pair pair = pair_of(b, l);
        b->specular[l] = hnbrdf_specular_of_area(&pair, m->ax[l], m->ay[l], m->area[l]);
    }
}

KERNEL_APART void fresnel_lanes(const lane_materials *restrict m, lane_pairs *restrict b)
{
    for (int l = 0; l < LANES; l++)
        for (int c = 0; c < 3; c++)
            b->f[c][l] =
                hnbrdf_microfacet_of(m->diffuse[c][l], m->e[c][l], b->c[l], b->specular[l]);
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

/* What a block of which some lanes are edited is worked out by: Fresnel terms of the materials as
 * they are, and how much of f_a is specular. */
typedef struct lane_shine {
    lane fresnel[3], part;
} lane_shine;

/* b->f: f_a of the materials, kd only as far as it carries the correction along. */
KERNEL_APART void edited_lanes(const lane_materials *restrict m, const lane_edits *restrict edits,
                               lane_pairs *restrict b, lane_shine *restrict shine)
{
    for (int l = 0; l < LANES; l++) {
        const float carried[3] = {edits->carried[0][l], edits->carried[1][l], edits->carried[2][l]};
        const hnbrdf_pair p = pair_of(b, l);
        float now = hnbrdf_specular_of_area(&p, m->ax[l], m->ay[l], m->area[l]), specular[3];
        for (int c = 0; c < 3; c++) {
            float fresnel = hnbrdf_fresnel_of_e(m->e[c][l], p.c);
            shine->fresnel[c][l] = fresnel;
            specular[c] = fresnel * now;
            b->f[c][l] = carried[c] + specular[c];
        }
        shine->part[l] = hnbrdf_specular_part(specular, carried);
    }
}

/* seen: the pairs as the networks of edited materials see them. */
KERNEL_APART void seen_lanes(hnbrdf_encoding encoding, const lane_edits *restrict m,
                             const lane_shine *restrict shine, const lane_pairs *restrict b,
                             lane_pairs *restrict seen)
{
    memcpy(seen, b, offsetof(lane_pairs, f));
    for (int l = 0; l < LANES; l++) {
        const hnbrdf_pair p = pair_of(b, l);
        const hnbrdf_pair q = hnbrdf_warped(&p, m->x[l], m->y[l], shine->part[l]);
        seen->sx[l] = q.sx;
        seen->sy[l] = q.sy;
        seen->sz[l] = q.sz;
    }
    for (int l = 0; l < LANES && encoding == HNBRDF_ENCODING_DIRECTIONS; l++) {
        const hnbrdf_pair p = pair_of(b, l);
        hnbrdf_pair q = pair_of(seen, l);
        hnbrdf_turn_pair(&p, &q);
        for (int k = 0; k < 3; k++) {
            seen->wi[k][l] = q.wi[k];
            seen->wo[k][l] = q.wo[k];
        }
    }
    for (int l = 0; l < LANES && encoding != HNBRDF_ENCODING_DIRECTIONS; l++) {
        const hnbrdf_pair p = pair_of(b, l);
        hnbrdf_pair q = pair_of(seen, l);
        hnbrdf_incline_pair(&p, &q);
        for (int k = 0; k < 3; k++) {
            seen->wi[k][l] = q.wi[k];
            seen->wo[k][l] = q.wo[k];
        }
    }
    for (int l = 0; l < LANES && encoding == HNBRDF_ENCODING_ANGLES_AZIMUTHS; l++) {
        const hnbrdf_pair p = pair_of(b, l);
        hnbrdf_pair q = pair_of(seen, l);
        hnbrdf_keep_azimuth(&p, &q);
        for (int k = 0; k < 2; k++) {
            seen->wi[k][l] = q.wi[k];
            seen->wo[k][l] = q.wo[k];
        }
    }
}

/* seen->f: f_a of the fitted materials, at s' and the directions as they are. Where no eta is
 * edited, shine has their Fresnel terms. */
KERNEL_APART void fitted_lanes(const lane_edits *restrict edits, lane_shine *restrict shine,
                               const lane_pairs *restrict b, lane_pairs *restrict seen)
{
    for (int c = 0; c < 3 && edits->other_eta; c++)
        for (int l = 0; l < LANES; l++)
            shine->fresnel[c][l] = hnbrdf_fresnel_of_e(edits->e[c][l], b->c[l]);
    for (int l = 0; l < LANES; l++) {
        const hnbrdf_pair p = pair_of(b, l), q = pair_of(seen, l);
        float before = hnbrdf_fitted_specular(&p, &q, edits->ax[l], edits->ay[l], edits->area[l]);
        for (int c = 0; c < 3; c++)
            seen->f[c][l] = edits->diffuse[c][l] + shine->fresnel[c][l] * before;
    }
}

/* One channel. */
KERNEL_APART void compose_edited_lanes(const hnbrdf_model_desc *desc, int c,
                                       const lane_edits *edits, const lane_pairs *seen,
                                       lane_pairs *b)
{
    const float scale = desc->scale, shift = desc->shift, lowest = desc->floor;
    for (int l = 0; l < LANES; l++)
        b->f[c][l] = hnbrdf_compose_edited(b->out[c][l], b->out[c + 3][l], b->f[c][l],
                                           seen->f[c][l], edits->added[c][l], scale, shift, lowest);
}

#if KERNEL_WIDTH > 1

enum { COMPOSE_SIDE = KERNEL_WIDTH == 16 ? 6 : 3 };

/* exp() of the exponents of three channels, c, and of their gates, g; of neural models of c. */
KERNEL_INLINE void compose_vectors(const hnbrdf_model_desc *desc, int hybrid, int l, lane_pairs *b)
{
    const float scale = desc->scale, shift = desc->shift, lowest = desc->floor;
    tile_vector e[6], f;
    for (int c = 0; c < 3; c++) {
        e[c] = scale * *(const tile_memory *)(b->out[c] + l) + shift;
        if (hybrid)
            e[c + 3] = -*(const tile_memory *)(b->out[c + 3] + l);
    }
    tile_exp(e, hybrid ? COMPOSE_SIDE : 3);
    if (hybrid && COMPOSE_SIDE == 3)
        tile_exp(e + 3, 3);
    for (int c = 0; c < 3; c++) {
        tile_memory *to = (tile_memory *)(b->f[c] + l);
        f = hybrid ? e[c] + (1.0f / (1.0f + e[c + 3])) * *to : e[c];
        *to = tile_clamp(f - lowest, 0.0f, HNBRDF_MAX_VALUE);
    }
}

KERNEL_APART void compose_lanes(const hnbrdf_model_desc *desc, lane_pairs *b)
{
    for (int l = 0; l < LANES; l += KERNEL_WIDTH)
        if (desc->kind == HNBRDF_KIND_HYBRID)
            compose_vectors(desc, 1, l, b);
        else
            compose_vectors(desc, 0, l, b);
}

#else

KERNEL_APART void compose_lanes(const hnbrdf_model_desc *desc, lane_pairs *b)
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

#endif
