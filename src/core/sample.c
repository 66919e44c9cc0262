/* sample.c: draw wi given wo from a cosine lobe and GGX visible normals, and the density of that. */
#include "core/compose.h"
#include "core/prepared.h"

float hnbrdf_specular_share(const hnbrdf_model *model, const hnbrdf_material *material)
{
    if (model->desc.kind == HNBRDF_KIND_NEURAL)
        return 0.0f;
    float specular = 0.05f, diffuse = 0.0f;
    for (int c = 0; c < 3; c++) {
        float r = (material->eta[c] - 1.0f) / (material->eta[c] + 1.0f);
        specular += r * r * (1.0f / 3.0f);
        diffuse += material->kd[c] * (1.0f / 3.0f);
    }
    return hnbrdf_clamp(specular / (specular + diffuse), 0.2f, 0.9f);
}

/* The one density that sample and pdf share; directions in the tangent frame, both above the horizon.
 * Visible normals: D G1(wo) / (4 wo.z) = D V(wo) / 2 (Heitz 2018 Eq. 17). */
static float density(const hnbrdf_prepared *m, const float wi[3], const float wo[3])
{
    float ax = m->alpha[0], ay = m->alpha[1];
    hnbrdf_pair p = hnbrdf_pair_make(wi, wo);
    float visible = hnbrdf_ggx_d_of_area(p.sx, p.sy, p.sz, p.length2, ax, ay, m->area) *
                    (0.5f * hnbrdf_smith_v(wo[0], wo[1], wo[2], ax, ay));
    return hnbrdf_finish(m->share * visible + (1.0f - m->share) * (wi[2] * HNBRDF_INV_PI));
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
    prepared.share = hnbrdf_specular_share(model, material);
    return hnbrdf_prepared_pdf(&prepared, wi, wo);
}

/* Cosine-distributed direction; u2 < 1 keeps z above 0. */
static void draw_cosine(float u1, float u2, float w[3])
{
    float sine, cosine, r = sqrtf(u2);
    hnbrdf_sincos_turn(u1, &sine, &cosine);
    w[0] = r * cosine;
    w[1] = r * sine;
    w[2] = sqrtf(1.0f - u2);
}

/* Reflect wo about a visible GGX normal, drawn as a spherical cap (Dupuy and Benyoub 2023, Listing 3).
 * Returns 0 if no normal comes out. */
static int draw_ggx(float ax, float ay, const float wo[3], float u1, float u2, float w[3])
{
    float x = ax * wo[0], y = ay * wo[1], z = wo[2];
    float length = sqrtf(hnbrdf_dot3(x, y, z));
    if (!(length > 0.0f))
        return 0;
    x /= length;
    y /= length;
    z /= length;
    float sine, cosine;
    hnbrdf_sincos_turn(u1, &sine, &cosine);
    float cap = (1.0f - u2) * (1.0f + z) - z;
    float radius = sqrtf(hnbrdf_clamp(1.0f - cap * cap, 0.0f, 1.0f));
    float hx = ax * (radius * cosine + x), hy = ay * (radius * sine + y), hz = cap + z;
    float h2 = hnbrdf_dot3(hx, hy, hz);
    if (!(h2 > 0.0f))
        return 0;
    float k = 2.0f * (((wo[0] * hx + wo[1] * hy) + wo[2] * hz) / h2);
    w[0] = k * hx - wo[0];
    w[1] = k * hy - wo[1];
    w[2] = k * hz - wo[2];
    return 1;
}

void hnbrdf_prepared_sample(const hnbrdf_prepared *prepared, const float wo[3], const float u[3],
                            hnbrdf_sample_result *result)
{
    static const hnbrdf_sample_result nothing = {{0.0f, 0.0f, 1.0f}, 0.0f, {0.0f, 0.0f, 0.0f}};
    *result = nothing;
    if (!(wo[2] > 0.0f))
        return;
    const hnbrdf_frame frame = {prepared->cosine, prepared->sine};
    float o[3], i[3], wi[3], f[3];
    hnbrdf_to_tangent(frame, wo, o);
    if (u[0] < prepared->share) {
        if (!draw_ggx(prepared->alpha[0], prepared->alpha[1], o, u[1], u[2], i))
            return;
    } else {
        draw_cosine(u[1], u[2], i);
    }
    hnbrdf_from_tangent(frame, i, wi);
    float pdf = hnbrdf_prepared_pdf(prepared, wi, wo);
    if (!(pdf > 0.0f))
        return;
    hnbrdf_prepared_eval(prepared, wi, wo, f);
    for (int c = 0; c < 3; c++) {
        result->wi[c] = wi[c];
        result->weight[c] = hnbrdf_finish(f[c] * wi[2] / pdf);
    }
    result->pdf = pdf;
}

void hnbrdf_sample(const hnbrdf_model *model, const hnbrdf_material *material, const float wo[3],
                   const float u[3], hnbrdf_sample_result *result)
{
    hnbrdf_prepared prepared;
    hnbrdf_prepare(model, material, &prepared);
    hnbrdf_prepared_sample(&prepared, wo, u, result);
}
