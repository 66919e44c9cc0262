/* sample.c: draw wi given wo from a cosine lobe and the GGX lobes of the material, and the
 * density of that. */
#include "core/compose.h"
#include "core/prepared.h"

/* ---- Lobes ----------------------------------------------------------------------------------- */

void hnbrdf_lobes_paper(hnbrdf_lobes *lobes)
{
    static const hnbrdf_lobes paper = {{-1.0f, 0.0f}, {{0.5f, 0.5f, 0.5f, 0.5f}, {0.0f}}};
    *lobes = paper;
}

/* Shares at this view, piecewise linear: each knot weighs in by its distance. */
static void shares_at(const hnbrdf_lobes *lobes, float z, float share[HNBRDF_LOBES])
{
    float x = hnbrdf_clamp(3.0f * sqrtf(z), 0.0f, 3.0f), hat[HNBRDF_LOBE_KNOTS];
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
        hat[j] = hnbrdf_clamp(1.0f - fabsf(x - (float)j), 0.0f, 1.0f);
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        const float *s = lobes->share[k];
        share[k] = ((hat[0] * s[0] + hat[1] * s[1]) + hat[2] * s[2]) + hat[3] * s[3];
    }
}

/* ---- Density --------------------------------------------------------------------------------- */

/* Of reflections about visible normals D V(wo)/2; about all normals D h.n / (4 wo.h). */
HNBRDF_DIVIDES_AS_IEEE
static float lobe_density(const hnbrdf_prepared *m, int k, const hnbrdf_pair *p)
{
    float ax = m->lobe_alpha[k][0], ay = m->lobe_alpha[k][1];
    float d = hnbrdf_ggx_d_of_area(p->sx, p->sy, p->sz, p->length2, ax, ay, m->lobe_area[k]);
    return d * (0.5f * (m->lobes.scale[k] < 0.0f
                            ? p->sz / p->length2
                            : hnbrdf_visible_v(p->wo[0], p->wo[1], p->wo[2], ax, ay)));
}

/* The one density that sample and pdf share; directions in the tangent frame, both above the
 * horizon. */
static float density(const hnbrdf_prepared *m, const float wi[3], const float wo[3])
{
    float share[HNBRDF_LOBES], sum = 0.0f;
    hnbrdf_pair p = hnbrdf_pair_make(wi, wo);
    shares_at(&m->lobes, wo[2], share);
    for (int k = 0; k < HNBRDF_LOBES; k++)
        if (share[k] > 0.0f)
            sum += share[k] * lobe_density(m, k, &p);
    float rest = hnbrdf_clamp(1.0f - (share[0] + share[1]), 0.0f, 1.0f);
    return hnbrdf_finish(sum + rest * (wi[2] * HNBRDF_INV_PI));
}

float hnbrdf_prepared_pdf(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3])
{
    if (!(wi[2] > 0.0f && wo[2] > 0.0f))
        return 0.0f;
    const hnbrdf_frame frame = {prepared->cosine, prepared->sine};
    float i[3], o[3];
    hnbrdf_to_tangent(frame, wi, i);
    hnbrdf_to_tangent(frame, wo, o);
    return density(prepared, i, o);
}

float hnbrdf_pdf(const hnbrdf_model *model, const hnbrdf_material *material, const float wi[3],
                 const float wo[3])
{
    hnbrdf_prepared prepared;
    hnbrdf_prepare_analytic(model, material, &prepared);
    hnbrdf_prepare_lobes(model, material, &prepared);
    return hnbrdf_prepared_pdf(&prepared, wi, wo);
}

/* ---- Drawing --------------------------------------------------------------------------------- */

/* Cosine-distributed direction; u2 < 1 keeps z above 0. */
static void draw_cosine(float u1, float u2, float w[3])
{
    float sine, cosine, r = sqrtf(u2);
    hnbrdf_sincos_turn(u1, &sine, &cosine);
    w[0] = r * cosine;
    w[1] = r * sine;
    w[2] = sqrtf(1.0f - u2);
}

/* A visible normal, not normalised: a point of a spherical cap (Dupuy and Benyoub 2023, Listing
 * 3) above its bound, stretched. Returns 0 where there is none. */
static int draw_visible(float ax, float ay, const float wo[3], float u1, float u2, float h[3])
{
    float x = ax * wo[0], y = ay * wo[1], z = wo[2];
    float length = sqrtf(hnbrdf_dot3(x, y, z));
    if (!(length > 0.0f))
        return 0;
    x /= length;
    y /= length;
    z /= length;
    float sine, cosine, low = hnbrdf_cap_bound(wo[0], wo[1], wo[2], ax, ay) * z;
    hnbrdf_sincos_turn(u1, &sine, &cosine);
    float cap = (1.0f - u2) * (1.0f + low) - low;
    float radius = sqrtf(hnbrdf_clamp(1.0f - cap * cap, 0.0f, 1.0f));
    h[0] = ax * (radius * cosine + x);
    h[1] = ay * (radius * sine + y);
    h[2] = cap + z;
    return 1;
}

/* Any normal, with density D h.n: slopes tan^2 = u / (1 - u) (Walter 2007 Eqs. 35 and 36), not
 * normalised. */
static void draw_normal(float ax, float ay, float u1, float u2, float h[3])
{
    float sine, cosine, r = sqrtf(u2);
    hnbrdf_sincos_turn(u1, &sine, &cosine);
    h[0] = ax * (r * cosine);
    h[1] = ay * (r * sine);
    h[2] = sqrtf(1.0f - u2);
}

/* Reflects wo about a normal of lobe k. Returns 0 if no normal comes out. */
static int draw_lobe(const hnbrdf_prepared *m, int k, const float wo[3], float u1, float u2,
                     float w[3])
{
    float ax = m->lobe_alpha[k][0], ay = m->lobe_alpha[k][1], h[3];
    if (m->lobes.scale[k] < 0.0f)
        draw_normal(ax, ay, u1, u2, h);
    else if (!draw_visible(ax, ay, wo, u1, u2, h))
        return 0;
    float h2 = hnbrdf_dot3(h[0], h[1], h[2]);
    if (!(h2 > 0.0f))
        return 0;
    float c = 2.0f * (((wo[0] * h[0] + wo[1] * h[1]) + wo[2] * h[2]) / h2);
    for (int a = 0; a < 3; a++)
        w[a] = c * h[a] - wo[a];
    return 1;
}

/* What is left of u0 once it has chosen its part [low, low + size) of [0, 1) turns the azimuth
 * on: a pair (u0, u2) that is stratified stays so in each lobe. */
HNBRDF_DIVIDES_AS_IEEE /* with u0 no number and no share left */
    static float
    azimuth(float u0, float low, float size, float u1)
{
    float turn = u1 + hnbrdf_clamp((u0 - low) / size, 0.0f, 0.99999994f);
    turn = turn >= 1.0f ? turn - 1.0f : turn;
    return hnbrdf_clamp(turn, 0.0f, 1.0f);
}

float hnbrdf_prepared_draw(const hnbrdf_prepared *prepared, const float wo[3], const float u[3],
                           float wi[3])
{
    const hnbrdf_frame frame = {prepared->cosine, prepared->sine};
    float o[3], i[3], drawn[3], share[HNBRDF_LOBES];
    wi[0] = wi[1] = 0.0f;
    wi[2] = 1.0f;
    if (!(wo[2] > 0.0f))
        return 0.0f;
    hnbrdf_to_tangent(frame, wo, o);
    shares_at(&prepared->lobes, wo[2], share);
    float both = share[0] + share[1], u2 = hnbrdf_clamp(u[2], 0.0f, 0.99999994f); /* NaN: 0 */
    if (u[0] < both) {
        int k = u[0] < share[0] ? 0 : 1;
        float turn = azimuth(u[0], k ? share[0] : 0.0f, share[k], u[1]);
        if (!draw_lobe(prepared, k, o, turn, u2, i))
            return 0.0f;
    } else {
        draw_cosine(azimuth(u[0], both, 1.0f - both, u[1]), u2, i);
    }
    hnbrdf_from_tangent(frame, i, drawn);
    float pdf = hnbrdf_prepared_pdf(prepared, drawn, wo);
    for (int c = 0; c < 3 && pdf > 0.0f; c++)
        wi[c] = drawn[c];
    return pdf;
}

void hnbrdf_prepared_sample(const hnbrdf_prepared *prepared, const float wo[3], const float u[3],
                            hnbrdf_sample_result *result)
{
    float f[3];
    result->pdf = hnbrdf_prepared_draw(prepared, wo, u, result->wi);
    result->weight[0] = result->weight[1] = result->weight[2] = 0.0f;
    if (!(result->pdf > 0.0f))
        return;
    hnbrdf_prepared_eval(prepared, result->wi, wo, f);
    for (int c = 0; c < 3; c++)
        result->weight[c] = hnbrdf_finish(f[c] * result->wi[2] / result->pdf);
}

void hnbrdf_sample(const hnbrdf_model *model, const hnbrdf_material *material, const float wo[3],
                   const float u[3], hnbrdf_sample_result *result)
{
    hnbrdf_prepared prepared;
    hnbrdf_prepare(model, material, &prepared);
    hnbrdf_prepared_sample(&prepared, wo, u, result);
}
