/* carry.h: an edit carries the network's correction along.
 *
 * A material that was fitted with (kd0, eta0, alpha0) and is now (kd, eta, alpha) shows the network
 * the half vector that had its place before: D(h) of GGX, and of every distribution that only
 * scales with roughness, depends on tan th / alpha, so that the two tangents of s = wi + wo are
 * multiplied by alpha0/alpha, each by its own, as far as f_a is specular there: diffuse light does
 * not move with roughness. The correction less the floor then changes as f_a does, by f_a of the
 * edited material at s over f_a of the fitted one at the warped s.
 * `hnbrdf report editing` measures it. Unedited, every ratio is x/x: the same bits.
 *
 * shaders/hybrid_brdf.glsl holds the same functions, named alike and in the same order of
 * operations. */
#ifndef HNBRDF_CORE_CARRY_H
#define HNBRDF_CORE_CARRY_H

#include "core/compose.h"
#include "core/microfacet.h"

/* hnbrdf_material_is_edited(); kd, eta and alpha come first in a material, and so in `fitted`. */
static inline int hnbrdf_is_edited(const hnbrdf_material *material)
{
    float now[8], then[8];
    int differ = 0;
    memcpy(now, material, sizeof now);
    memcpy(then, &material->fitted, sizeof then);
    for (int k = 0; k < 8; k++)
        differ |= now[k] != then[k];
    return differ & (then[6] != 0.0f);
}

/* A diffuse part that was (nearly) black, or a reflectance that was (nearly) nothing, has no
 * correction that could be scaled: f_a of the fitted material is then a small number that divides.
 * kd carries the correction up to 4 times what it was; what is above is added as it is. The
 * reflectance at normal incidence carries it up to 16 times. */
#define HNBRDF_CARRIED_KD 4.0f
#define HNBRDF_CARRIED_AMPLITUDE 4.0f

static inline float hnbrdf_carried_kd(float kd, float fitted_kd)
{
    float most = HNBRDF_CARRIED_KD * fabsf(fitted_kd);
    return kd > most ? most : kd;
}

/* kd less that; 0 to the bit where all of it is carried. */
static inline float hnbrdf_added_kd(float kd, float fitted_kd)
{
    float most = HNBRDF_CARRIED_KD * fabsf(fitted_kd);
    return kd > most ? kd - most : 0.0f;
}

/* eta0, raised until the reflectance of eta is at most 16 times its own. */
HNBRDF_DIVIDES_AS_IEEE
static inline float hnbrdf_carried_eta(float eta, float fitted_eta)
{
    float r = ((eta - 1.0f) / (eta + 1.0f)) / HNBRDF_CARRIED_AMPLITUDE;
    float raised = (1.0f + r) / (1.0f - r);
    return ((eta > fitted_eta) & (raised > fitted_eta)) ? raised : fitted_eta;
}

/* What the tangents of s are multiplied by; 1 to the bit where the roughness is that of the fit,
 * whatever it is. */
HNBRDF_DIVIDES_AS_IEEE
static inline float hnbrdf_warp_factor(float alpha, float fitted_alpha)
{
    return alpha != fitted_alpha ? fitted_alpha / alpha : 1.0f;
}

/* How much of f_a is specular, over the channels: in [0, 1]. f_a is carried + specular. Not as a
 * difference: what is left would be multiplied by up to 1e4. */
HNBRDF_DIVIDES_AS_IEEE
static inline float hnbrdf_specular_part(const float specular[3], const float carried[3])
{
    float shine = (specular[0] + specular[1]) + specular[2];
    float diffuse = (carried[0] + carried[1]) + carried[2];
    return hnbrdf_clamp(shine / (shine + diffuse), 0.0f, 1.0f);
}

/* s' of the same length as s, its tangents times x and y. It comes no nearer to the horizon than s
 * is, or than 45 degrees where s is higher: the network never saw much beyond, and is asked there
 * only by edits to a smaller alpha, whose highlight is far away. */
HNBRDF_DIVIDES_AS_IEEE
static inline void hnbrdf_warp(const hnbrdf_pair *p, float x, float y, float s[3])
{
    float r2 = p->sx * p->sx + p->sy * p->sy, z2 = p->sz * p->sz;
    float most = r2 > z2 ? r2 : z2;
    float wx = p->sx * x, wy = p->sy * y;
    float w2 = wx * wx + wy * wy;
    float shrink = sqrtf(w2 > most ? most / w2 : 1.0f);
    wx = wx * shrink;
    wy = wy * shrink;
    float length2 = hnbrdf_dot3(wx, wy, p->sz);
    float stretch = sqrtf(length2 != p->length2 ? p->length2 / length2 : 1.0f);
    s[0] = wx * stretch;
    s[1] = wy * stretch;
    s[2] = p->sz * stretch;
}

/* The pair of s', its directions as they are. x, y: the factors where all is specular. */
static inline hnbrdf_pair hnbrdf_warped(const hnbrdf_pair *p, float x, float y, float part)
{
    hnbrdf_pair q = *p;
    float s[3];
    hnbrdf_warp(p, 1.0f + part * (x - 1.0f), 1.0f + part * (y - 1.0f), s);
    q.sx = s[0];
    q.sy = s[1];
    q.sz = s[2];
    return q;
}

/* A cosine of incidence that an edit lowers comes no lower than this, or stays where it is below: a
 * network has seen few pairs beyond. */
#define HNBRDF_LOWEST_SEEN 0.1f
#define HNBRDF_MOST_INCLINED 1e8f /* the square of a factor of roughness */

/* How far it stays above. */
static inline float hnbrdf_cosine_held(float cosine, float moved)
{
    float least = cosine < HNBRDF_LOWEST_SEEN ? cosine : HNBRDF_LOWEST_SEEN;
    float below = least - moved;
    return below > 0.0f ? below : 0.0f;
}

/* For encodings by angles: the cosines of incidence go with s. Their sum is s.z, and their
 * difference goes with the sine of its angle, as if the pair were turned. What is left of wi - wo
 * is laid along x, so that its length, and the difference angle, stay. Where s does not move,
 * nothing does. */
HNBRDF_DIVIDES_AS_IEEE
static inline void hnbrdf_incline_pair(const hnbrdf_pair *p, hnbrdf_pair *q)
{
    float r2 = p->sx * p->sx + p->sy * p->sy, q2 = q->sx * q->sx + q->sy * q->sy;
    float ratio = hnbrdf_clamp(q2 != r2 ? q2 / r2 : 1.0f, 0.0f, HNBRDF_MOST_INCLINED);
    float sine = sqrtf(ratio), more = sine - 1.0f, sum = q->sz - p->sz;
    float dx = p->wi[0] - p->wo[0], dy = p->wi[1] - p->wo[1], dz = p->wi[2] - p->wo[2];
    float difference = more * dz;
    float zi = p->wi[2] + 0.5f * (sum + difference), zo = p->wo[2] + 0.5f * (sum - difference);
    float held_i = hnbrdf_cosine_held(p->wi[2], zi), held_o = hnbrdf_cosine_held(p->wo[2], zo);
    float held = held_i - held_o;
    float rest = (dx * dx + dy * dy) - (dz * dz) * (more * (1.0f + sine));
    rest = rest - held * (2.0f * sine * dz + held);
    float along = 0.5f * sqrtf(rest > 0.0f ? rest : 0.0f);
    int moved = (more != 0.0f) | (sum != 0.0f);
    q->wi[0] = moved ? along : p->wi[0];
    q->wo[0] = moved ? -along : p->wo[0];
    q->wi[1] = moved ? 0.0f : p->wi[1];
    q->wo[1] = moved ? 0.0f : p->wo[1];
    q->wi[2] = zi + held_i;
    q->wo[2] = zo + held_o;
}

/* After it: what is left of wi - wo along its own azimuth instead. */
HNBRDF_DIVIDES_AS_IEEE
static inline void hnbrdf_keep_azimuth(const hnbrdf_pair *p, hnbrdf_pair *q)
{
    float dx = p->wi[0] - p->wo[0], dy = p->wi[1] - p->wo[1];
    float qx = q->wi[0] - q->wo[0], qy = q->wi[1] - q->wo[1];
    float d2 = dx * dx + dy * dy, q2 = qx * qx + qy * qy;
    float k = 0.5f * sqrtf(d2 > 0.0f ? q2 / d2 : 1.0f);
    q->wi[0] = k * dx;
    q->wi[1] = k * dy;
    q->wo[0] = -q->wi[0];
    q->wo[1] = -q->wi[1];
}

/* Both directions turned with s to s', the shortest way. One of them may go below the horizon.
 * Where s' is s, both stay as they are. d = wi - wo is at right angles to s for unit vectors, but
 * need not be. */
HNBRDF_DIVIDES_AS_IEEE
static inline void hnbrdf_turn_pair(const hnbrdf_pair *p, hnbrdf_pair *q)
{
    float d[3] = {p->wi[0] - p->wo[0], p->wi[1] - p->wo[1], p->wi[2] - p->wo[2]};
    float from[3] = {p->sx, p->sy, p->sz}, to[3] = {q->sx, q->sy, q->sz};
    float along = (d[0] * from[0] + d[1] * from[1]) + d[2] * from[2];
    float across = (d[0] * to[0] + d[1] * to[1]) + d[2] * to[2];
    float both = p->length2 + ((from[0] * to[0] + from[1] * to[1]) + from[2] * to[2]);
    float k = (along + across) / both, j = (2.0f * along) / p->length2;
    int moved = (to[0] != from[0]) | (to[1] != from[1]) | (to[2] != from[2]);
    for (int i = 0; i < 3; i++) {
        float turned = (d[i] - k * (from[i] + to[i])) + j * to[i];
        q->wi[i] = moved ? 0.5f * (to[i] + turned) : p->wi[i];
        q->wo[i] = moved ? 0.5f * (to[i] - turned) : p->wo[i];
    }
}

/* D V V of the fitted material: D at s', masking at the directions as they are. */
static inline float hnbrdf_fitted_specular(const hnbrdf_pair *p, const hnbrdf_pair *warped,
                                           float ax, float ay, float area)
{
    return hnbrdf_ggx_d_of_area(warped->sx, warped->sy, warped->sz, p->length2, ax, ay, area) *
           (hnbrdf_smith_v(p->wi[0], p->wi[1], p->wi[2], ax, ay) *
            hnbrdf_smith_v(p->wo[0], p->wo[1], p->wo[2], ax, ay));
}

/* f_a of the edited material over that of the fitted one, in [0, HNBRDF_MAX_VALUE]. */
HNBRDF_DIVIDES_AS_IEEE
static inline float hnbrdf_carried_ratio(float edited, float fitted)
{
    return hnbrdf_clamp(edited != fitted ? edited / fitted : 1.0f, 0.0f, HNBRDF_MAX_VALUE);
}

/* max(0, ratio (exp(s c + m) - b) + sigmoid(g) f_a + added): f_a of the carried kd, and what is
 * above it over pi. A ratio of 1 gives the bits of hnbrdf_compose_hybrid(). */
static inline float hnbrdf_compose_edited(float c, float g, float edited, float fitted, float added,
                                          float scale, float shift, float floor)
{
    float ratio = hnbrdf_carried_ratio(edited, fitted);
    float correction = hnbrdf_correction(c, scale, shift), gated = hnbrdf_gate(g) * edited;
    float carried = ratio * (correction - floor) + gated;
    float as_it_is = (correction + gated) - floor;
    return hnbrdf_finish((ratio != 1.0f ? carried : as_it_is) + added);
}

#endif
