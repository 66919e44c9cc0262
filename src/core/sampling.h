/* sampling.h: the lobes of a material as sampling sees them: shares, density, drawing. Written
 * without branches, so that the kernels draw many at once with the bits of a single draw.
 * shaders/hybrid_brdf.glsl holds the same functions in the same order of operations. */
#ifndef HNBRDF_CORE_SAMPLING_H
#define HNBRDF_CORE_SAMPLING_H

#include "core/compose.h"
#include "core/prepared.h"

/* The largest float below 1. */
#define HNBRDF_BELOW_1 0.99999994f

/* One GGX lobe of a prepared material. */
typedef struct hnbrdf_lobe {
    float ax, ay, area;
    float scale; /* < 0: all normals; > 0: visible ones */
    float share[HNBRDF_LOBE_KNOTS];
} hnbrdf_lobe;

static inline hnbrdf_lobe hnbrdf_lobe_of(const hnbrdf_prepared *m, int k)
{
    const float *share = m->lobes.share[k];
    return (hnbrdf_lobe){m->lobe_alpha[k][0],
                         m->lobe_alpha[k][1],
                         m->lobe_area[k],
                         m->lobes.scale[k],
                         {share[0], share[1], share[2], share[3]}};
}

/* The share at a view, piecewise linear in sqrt(z): each knot weighs in by its distance. */
static inline float hnbrdf_lobe_share(const hnbrdf_lobe *lobe, float z)
{
    float x = hnbrdf_clamp(3.0f * sqrtf(z), 0.0f, 3.0f), hat[HNBRDF_LOBE_KNOTS];
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
        hat[j] = hnbrdf_clamp(1.0f - fabsf(x - (float)j), 0.0f, 1.0f);
    const float *s = lobe->share;
    return ((hat[0] * s[0] + hat[1] * s[1]) + hat[2] * s[2]) + hat[3] * s[3];
}

/* ---- Density --------------------------------------------------------------------------------- */

/* Of reflections about visible normals D V(wo)/2; about all normals D h.n / (4 wo.h). */
HNBRDF_DIVIDES_AS_IEEE
static inline float hnbrdf_lobe_density(const hnbrdf_lobe *lobe, const hnbrdf_pair *p)
{
    float d = hnbrdf_ggx_d_of_area(p->sx, p->sy, p->sz, p->length2, lobe->ax, lobe->ay, lobe->area);
    float all = p->sz / p->length2;
    float visible = hnbrdf_visible_v(p->wo[0], p->wo[1], p->wo[2], lobe->ax, lobe->ay);
    return d * (0.5f * (lobe->scale < 0.0f ? all : visible));
}

/* The one density that sample and pdf share; both directions of the pair above the horizon. */
static inline float hnbrdf_density(const hnbrdf_lobe lobes[HNBRDF_LOBES], const hnbrdf_pair *p)
{
    float first = hnbrdf_lobe_share(&lobes[0], p->wo[2]);
    float second = hnbrdf_lobe_share(&lobes[1], p->wo[2]);
    float of_first = first * hnbrdf_lobe_density(&lobes[0], p);
    float of_second = second * hnbrdf_lobe_density(&lobes[1], p);
    float sum = (first > 0.0f ? of_first : 0.0f) + (second > 0.0f ? of_second : 0.0f);
    float rest = hnbrdf_clamp(1.0f - (first + second), 0.0f, 1.0f);
    return hnbrdf_finish(sum + rest * (p->wi[2] * HNBRDF_INV_PI));
}

/* ---- Drawing --------------------------------------------------------------------------------- */

/* What is left of u0 once it has chosen its part [low, low + size) of [0, 1), as an azimuth, plus
 * `turn`: a pair (u0, u1) that is stratified stays so in each lobe. */
HNBRDF_DIVIDES_AS_IEEE /* with u0 no number and no share left */
    static inline float
    hnbrdf_azimuth(float u0, float low, float size, float turn)
{
    float sum = turn + hnbrdf_clamp((u0 - low) / size, 0.0f, HNBRDF_BELOW_1);
    sum = sum >= 1.0f ? sum - 1.0f : sum;
    return hnbrdf_clamp(sum, 0.0f, 1.0f);
}

/* What a draw is made from: the lobe that u0 falls to, or cosine, and the azimuth. */
typedef struct hnbrdf_choice {
    float ax, ay, azimuth;
    int is_lobe, is_all; /* 0: cosine; 1: about all normals */
} hnbrdf_choice;

static inline hnbrdf_choice hnbrdf_choose(const hnbrdf_lobe lobes[HNBRDF_LOBES], float z, float u0,
                                          float turn)
{
    float first = hnbrdf_lobe_share(&lobes[0], z), second = hnbrdf_lobe_share(&lobes[1], z);
    float both = first + second;
    u0 = hnbrdf_clamp(u0, 0.0f, HNBRDF_BELOW_1); /* NaN: 0 */
    int is_first = u0 < first, is_lobe = u0 < both;
    float low = is_lobe ? (is_first ? 0.0f : first) : both;
    float size = is_lobe ? (is_first ? first : second) : 1.0f - both;
    float scale = is_first ? lobes[0].scale : lobes[1].scale;
    return (hnbrdf_choice){.ax = is_first ? lobes[0].ax : lobes[1].ax,
                           .ay = is_first ? lobes[0].ay : lobes[1].ay,
                           .azimuth = hnbrdf_azimuth(u0, low, size, turn),
                           .is_lobe = is_lobe,
                           .is_all = scale < 0.0f};
}

/* Draws w, in the tangent frame, given wo with wo.z > 0. Returns 0 if no normal comes out, and w
 * is then of no use.
 *   visible normals  a point of a spherical cap (Dupuy and Benyoub 2023, Listing 3) above its
 *                    bound, stretched
 *   all normals      with density D h.n: slopes tan^2 = u/(1 - u) (Walter 2007 Eqs. 35 and 36)
 *   cosine           u1 < 1 keeps z above 0 */
HNBRDF_DIVIDES_AS_IEEE
static inline int hnbrdf_draw_chosen(const hnbrdf_choice *from, const float wo[3], float u1,
                                     float w[3])
{
    float ax = from->ax, ay = from->ay, sine, cosine;
    float u = hnbrdf_clamp(u1, 0.0f, HNBRDF_BELOW_1);
    hnbrdf_sincos_turn(from->azimuth, &sine, &cosine);

    float disc = sqrtf(u), up = sqrtf(1.0f - u);
    float x = ax * wo[0], y = ay * wo[1], z = wo[2];
    float length = sqrtf(hnbrdf_dot3(x, y, z));
    x /= length;
    y /= length;
    z /= length;
    float bound = hnbrdf_cap_bound(wo[0], wo[1], wo[2], ax, ay) * z;
    float cap = (1.0f - u) * (1.0f + bound) - bound;
    float radius = sqrtf(hnbrdf_clamp(1.0f - cap * cap, 0.0f, 1.0f));

    float all_x = ax * (disc * cosine), visible_x = ax * (radius * cosine + x);
    float all_y = ay * (disc * sine), visible_y = ay * (radius * sine + y);
    float visible_z = cap + z;
    float hx = from->is_all ? all_x : visible_x, hy = from->is_all ? all_y : visible_y;
    float hz = from->is_all ? up : visible_z;
    float h2 = hnbrdf_dot3(hx, hy, hz);
    float c = 2.0f * (((wo[0] * hx + wo[1] * hy) + wo[2] * hz) / h2);
    float lobe_x = c * hx - wo[0], lobe_y = c * hy - wo[1], lobe_z = c * hz - wo[2];
    float cosine_x = disc * cosine, cosine_y = disc * sine;
    w[0] = from->is_lobe ? lobe_x : cosine_x;
    w[1] = from->is_lobe ? lobe_y : cosine_y;
    w[2] = from->is_lobe ? lobe_z : up;
    int has_normal = (from->is_all | (length > 0.0f)) & (h2 > 0.0f);
    return (from->is_lobe == 0) | has_normal;
}

#endif
