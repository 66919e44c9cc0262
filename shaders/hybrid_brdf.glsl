// hybrid_brdf.glsl: the parts a hybrid neural-microfacet BRDF is made of (De Oliveira et al., EGSR 2026).
// Include it first, then what `hnbrdf export` wrote for a scene: that calls these.
//
// The same functions as in the C library, named alike and in the same order of operations. Frame and units
// as there: n = +z, wi towards the light, wo towards the viewer, f in 1/sr without the cosine.
//
// Runs as Vulkan GLSL 450, desktop GLSL 330, GLSL ES 300. What can be defined before including:
//   HNBRDF_EXACT 1       the bits of the C library, on a device whose + - * / sqrt are correctly rounded:
//                        exp and log of exact operations, `precise` where the language has it.
//                        0 (default): the built-in exp and log, contraction allowed; fastest.
//   HNBRDF_EXP(x)        exp of a vec3 in [-80, 80]
//   HNBRDF_LOG(x)        log of a float in [1e-5, +inf], finite for +inf
//   HNBRDF_PRECISE       qualifier of every function and variable that holds arithmetic
// In GLSL ES the default precision of float and int becomes highp from here on.
#ifndef HNBRDF_HYBRID_BRDF_GLSL
#define HNBRDF_HYBRID_BRDF_GLSL

#ifndef HNBRDF_EXACT
#define HNBRDF_EXACT 0
#endif

#ifndef HNBRDF_PRECISE
#if HNBRDF_EXACT && ((defined(GL_ES) && __VERSION__ >= 320) || (!defined(GL_ES) && __VERSION__ >= 400))
#define HNBRDF_PRECISE precise
#else
#define HNBRDF_PRECISE
#endif
#endif

#ifndef HNBRDF_EXP
#if HNBRDF_EXACT
#define HNBRDF_EXP(x) hnbrdf_exp(x)
#else
#define HNBRDF_EXP(x) exp(x)
#endif
#endif

// The largest float in place of infinity: hnbrdf_log(+inf) is finite too.
#ifndef HNBRDF_LOG
#if HNBRDF_EXACT
#define HNBRDF_LOG(x) hnbrdf_log(x)
#else
#define HNBRDF_LOG(x) log(min(x, 3.40282347e38))
#endif
#endif

#ifdef GL_ES
precision highp float;
precision highp int;
#endif

#define HNBRDF_PI 3.14159265
#define HNBRDF_INV_PI 0.318309886
#define HNBRDF_MAX_EXPONENT 80.0
#define HNBRDF_MAX_VALUE 3.0e38

// ---- Functions of one number -------------------------------------------------------------------------

// x in [low, high]; a NaN becomes low, which clamp() does not promise.
float hnbrdf_clamp(float x, float low, float high)
{
    return x > low ? (x < high ? x : high) : low;
}

vec3 hnbrdf_clamp(vec3 x, float low, float high)
{
    return vec3(hnbrdf_clamp(x.x, low, high), hnbrdf_clamp(x.y, low, high), hnbrdf_clamp(x.z, low, high));
}

// exp(x) for x in [-80, 80]; within 1 ulp.
HNBRDF_PRECISE float hnbrdf_exp(float x)
{
    HNBRDF_PRECISE float y = x * 1.44269504;
    int k = int(y + (y >= 0.0 ? 0.5 : -0.5));
    HNBRDF_PRECISE float fk = float(k);
    HNBRDF_PRECISE float r = (x - fk * 0.693359375) - fk * -2.12194440e-4; // ln 2 in two parts, the first exact
    HNBRDF_PRECISE float q = 1.98909809e-4;
    q = q * r + 1.39336410e-3;
    q = q * r + 8.33331093e-3;
    q = q * r + 4.16664650e-2;
    q = q * r + 1.66666667e-1;
    q = q * r + 0.5;
    HNBRDF_PRECISE float e = (q * (r * r) + r) + 1.0;
    return e * intBitsToFloat((k + 127) * 0x800000);
}

vec3 hnbrdf_exp(vec3 x)
{
    return vec3(hnbrdf_exp(x.x), hnbrdf_exp(x.y), hnbrdf_exp(x.z));
}

// ln(x) for normal x > 0; error at most 1.05 ulp of the result plus 5e-8. +inf gives a finite 88.7.
HNBRDF_PRECISE float hnbrdf_log(float x)
{
    int i = floatBitsToInt(x) - 0x3f3504f3; // mantissa to [sqrt(1/2), sqrt(2))
    int e = i >> 23;
    HNBRDF_PRECISE float f = intBitsToFloat((i & 0x7fffff) + 0x3f3504f3) - 1.0;
    HNBRDF_PRECISE float s = f / (2.0 + f);
    HNBRDF_PRECISE float s2 = s * s;
    HNBRDF_PRECISE float p = 2.95799494e-1;
    p = p * s2 + 3.99887806e-1;
    p = p * s2 + 6.66666850e-1;
    return float(e) * 0.693147181 + (2.0 * s + s * (s2 * p));
}

// (sin, cos) of 2 pi u for u in [0, 1]; absolute error at most 1.1e-7. In every build: what is drawn must
// not depend on the device.
HNBRDF_PRECISE vec2 hnbrdf_sincos_turn(float u)
{
    int quadrant = int(4.0 * u + 0.5);
    HNBRDF_PRECISE float a = (u - 0.25 * float(quadrant)) * 6.28318531; // the difference is exact
    HNBRDF_PRECISE float a2 = a * a;
    HNBRDF_PRECISE float s = -1.95878909e-4;
    s = s * a2 + 8.33274827e-3;
    s = s * a2 - 1.66666647e-1;
    s = a + a * (a2 * s);
    HNBRDF_PRECISE float c = 2.45479421e-5;
    c = c * a2 - 1.38883030e-3;
    c = c * a2 + 4.16666647e-2;
    c = (1.0 - 0.5 * a2) + (a2 * a2) * c;
    bool swap = (quadrant & 1) != 0;
    float sine = swap ? c : s;
    float cosine = swap ? s : c;
    return vec2((quadrant & 2) != 0 ? -sine : sine, ((quadrant + 1) & 2) != 0 ? -cosine : cosine);
}

// x clamp(x/3 + 1/2, 0, 1), the paper's three-branch HardGELU.
HNBRDF_PRECISE float hnbrdf_hard_gelu(float x)
{
    return x * clamp(x * 0.333333333 + 0.5, 0.0, 1.0);
}

HNBRDF_PRECISE vec2 hnbrdf_hard_gelu(vec2 x)
{
    return x * clamp(x * 0.333333333 + 0.5, 0.0, 1.0);
}

HNBRDF_PRECISE vec3 hnbrdf_hard_gelu(vec3 x)
{
    return x * clamp(x * 0.333333333 + 0.5, 0.0, 1.0);
}

HNBRDF_PRECISE vec4 hnbrdf_hard_gelu(vec4 x)
{
    return x * clamp(x * 0.333333333 + 0.5, 0.0, 1.0);
}

// ---- A pair of directions ----------------------------------------------------------------------------

// Into the tangent frame of a material: turned about n by the angle with this (cosine, sine).
HNBRDF_PRECISE vec3 hnbrdf_to_tangent(vec2 rotation, vec3 w)
{
    return vec3(rotation.x * w.x + rotation.y * w.y, rotation.x * w.y - rotation.y * w.x, w.z);
}

// And back.
HNBRDF_PRECISE vec3 hnbrdf_from_tangent(vec2 rotation, vec3 t)
{
    return vec3(rotation.x * t.x - rotation.y * t.y, rotation.x * t.y + rotation.y * t.x, t.z);
}

HNBRDF_PRECISE float hnbrdf_dot3(vec3 v)
{
    return (v.x * v.x + v.y * v.y) + v.z * v.z;
}

// What the analytic part and the encodings share of one pair, in the tangent frame of the material.
struct hnbrdf_pair {
    vec3 wi, wo;
    vec3 s;        // wi + wo: the half vector, not normalised
    float length2; // s.s
    float c;       // cosine of the difference angle, wi.h = |s|/2 for unit vectors
};

HNBRDF_PRECISE hnbrdf_pair hnbrdf_pair_make(vec3 wi, vec3 wo)
{
    HNBRDF_PRECISE hnbrdf_pair p;
    p.wi = wi;
    p.wo = wo;
    p.s = wi + wo;
    p.length2 = hnbrdf_dot3(p.s);
    p.c = 0.5 * sqrt(p.length2);
    return p;
}

// ---- The analytic part: Lambert + GGX (Walter et al. 2007; Heitz 2014) ---------------------------------

// GGX normal density D(h), 1/sr (Walter 2007 Eq. 33, anisotropic: Heitz 2014 Eq. 86), in the
// tangent-frame form: 1 - (n.h)^2 would lose every digit of a narrow lobe. What depends on the material
// alone, area = pi ax ay here and e = eta^2 - 1 below, has a function of its own; where alpha is a float, the
// lobe is isotropic, with the same values.
HNBRDF_PRECISE float hnbrdf_ggx_area(vec2 alpha)
{
    return (HNBRDF_PI * alpha.x) * alpha.y;
}

HNBRDF_PRECISE float hnbrdf_ggx_area(float alpha)
{
    return (HNBRDF_PI * alpha) * alpha;
}

HNBRDF_PRECISE float hnbrdf_ggx_d_of_area(vec3 s, float length2, vec2 alpha, float area)
{
    HNBRDF_PRECISE float t = hnbrdf_dot3(vec3(s.xy / alpha, s.z)) / length2;
    return 1.0 / (area * (t * t));
}

HNBRDF_PRECISE float hnbrdf_ggx_d_of_area(vec3 s, float length2, float alpha, float area)
{
    HNBRDF_PRECISE float t = hnbrdf_dot3(vec3(s.xy / alpha, s.z)) / length2;
    return 1.0 / (area * (t * t));
}

float hnbrdf_ggx_d(vec3 s, float length2, vec2 alpha)
{
    return hnbrdf_ggx_d_of_area(s, length2, alpha, hnbrdf_ggx_area(alpha));
}

// Smith masking of one direction over its share of the denominator, V(w) = G1(w) / (2 w.z), so that
// G1 G1 / (4 wi.z wo.z) = V V, finite at grazing (Heitz 2014 Eq. 43).
HNBRDF_PRECISE float hnbrdf_smith_v(vec3 w, vec2 alpha)
{
    return 1.0 / (w.z + sqrt(hnbrdf_dot3(vec3(alpha * w.xy, w.z))));
}

HNBRDF_PRECISE float hnbrdf_smith_v(vec3 w, float alpha)
{
    return 1.0 / (w.z + sqrt(hnbrdf_dot3(vec3(alpha * w.xy, w.z))));
}

// Unpolarised Fresnel reflectance of a dielectric with index eta > 1 at cosine c = wi.h (Walter 2007
// Eq. 22). g - c is taken as (eta^2 - 1)/(g + c): the difference itself loses digits as eta nears 1.
HNBRDF_PRECISE vec3 hnbrdf_fresnel_e(vec3 eta)
{
    return (eta - 1.0) * (eta + 1.0);
}

HNBRDF_PRECISE vec3 hnbrdf_fresnel_of_e(vec3 e, float c)
{
    HNBRDF_PRECISE vec3 sum = sqrt(e + c * c) + c; // g + c
    HNBRDF_PRECISE vec3 difference = e / sum;      // g - c
    HNBRDF_PRECISE vec3 a = difference / sum;
    HNBRDF_PRECISE vec3 b = (c * sum - 1.0) / (c * difference + 1.0);
    return (0.5 * (a * a)) * (1.0 + b * b);
}

vec3 hnbrdf_fresnel_dielectric(vec3 eta, float c)
{
    return hnbrdf_fresnel_of_e(hnbrdf_fresnel_e(eta), c);
}

float hnbrdf_fresnel_dielectric(float eta, float c)
{
    return hnbrdf_fresnel_dielectric(vec3(eta), c).x;
}

// D V V, what the Fresnel factor of every channel multiplies; 1/sr.
HNBRDF_PRECISE float hnbrdf_specular_of_area(hnbrdf_pair p, vec2 alpha, float area)
{
    return hnbrdf_ggx_d_of_area(p.s, p.length2, alpha, area) *
           (hnbrdf_smith_v(p.wi, alpha) * hnbrdf_smith_v(p.wo, alpha));
}

HNBRDF_PRECISE float hnbrdf_specular_of_area(hnbrdf_pair p, float alpha, float area)
{
    return hnbrdf_ggx_d_of_area(p.s, p.length2, alpha, area) *
           (hnbrdf_smith_v(p.wi, alpha) * hnbrdf_smith_v(p.wo, alpha));
}

float hnbrdf_specular(hnbrdf_pair p, vec2 alpha)
{
    return hnbrdf_specular_of_area(p, alpha, hnbrdf_ggx_area(alpha));
}

float hnbrdf_specular(hnbrdf_pair p, float alpha)
{
    return hnbrdf_specular_of_area(p, alpha, hnbrdf_ggx_area(alpha));
}

// f_a, 1/sr. diffuse is kd/pi, e is eta^2 - 1.
HNBRDF_PRECISE vec3 hnbrdf_microfacet_of(vec3 diffuse, vec3 e, float c, float specular)
{
    return diffuse + hnbrdf_fresnel_of_e(e, c) * specular;
}

HNBRDF_PRECISE vec3 hnbrdf_microfacet(vec3 kd, vec3 eta, float c, float specular)
{
    return hnbrdf_microfacet_of(kd * HNBRDF_INV_PI, hnbrdf_fresnel_e(eta), c, specular);
}

// ---- Encodings: what the network sees of a pair, six numbers -------------------------------------------

// The paper's: the six Cartesian components.
void hnbrdf_encode_directions(hnbrdf_pair p, out vec3 x0, out vec3 x1)
{
    x0 = p.wi;
    x1 = p.wo;
}

// Functions of h and of the difference angle that do not change, to the last bit, when wi and wo swap:
//   1 + ln(1e-5 + tan^2 th)/4, sqrt(sin th), c, sqrt(1 - c), wi.z wo.z, wi.z + wo.z
// th is the angle between n and h, c = wi.h. sqrt(1 - c) is taken from |wi - wo|^2 = 4 (1 - c^2), exact
// where 1 - c would cancel (near retroreflection).
void hnbrdf_encode_half_difference(hnbrdf_pair p, out vec3 x0, out vec3 x1)
{
    HNBRDF_PRECISE float r2 = p.s.x * p.s.x + p.s.y * p.s.y;
    HNBRDF_PRECISE float d2 = hnbrdf_dot3(p.wi - p.wo);
    HNBRDF_PRECISE float tan2 = 1e-5 + r2 / (p.s.z * p.s.z);
    HNBRDF_PRECISE float x = 1.0 + 0.25 * HNBRDF_LOG(tan2);
    HNBRDF_PRECISE float y = sqrt(sqrt(r2 / p.length2));
    HNBRDF_PRECISE float z = sqrt((0.25 * d2) / (1.0 + p.c));
    HNBRDF_PRECISE float product = p.wi.z * p.wo.z;
    HNBRDF_PRECISE float sum = p.wi.z + p.wo.z;
    x0 = vec3(x, y, p.c);
    x1 = vec3(z, product, sum);
}

// What the encodings by angles share; the cosines of incidence are a and b:
//   1 + ln(1e-5 + tan^2 th)/4, sin th, ln(1e-3 + 1 - c)/4, 1 - c, a, b
void hnbrdf_encode_angle_terms(hnbrdf_pair p, float a, float b, out vec3 x0, out vec3 x1)
{
    HNBRDF_PRECISE float r2 = p.s.x * p.s.x + p.s.y * p.s.y;
    HNBRDF_PRECISE float d2 = hnbrdf_dot3(p.wi - p.wo);
    HNBRDF_PRECISE float q = (0.25 * d2) / (1.0 + p.c);
    HNBRDF_PRECISE float tan2 = 1e-5 + r2 / (p.s.z * p.s.z);
    HNBRDF_PRECISE float x = 1.0 + 0.25 * HNBRDF_LOG(tan2);
    HNBRDF_PRECISE float y = sqrt(r2 / p.length2);
    HNBRDF_PRECISE float off = 1e-3 + q;
    HNBRDF_PRECISE float z = 0.25 * HNBRDF_LOG(off);
    x0 = vec3(x, y, z);
    x1 = vec3(q, a, b);
}

// a = wi.z, b = wo.z: sees which of the two is the light.
void hnbrdf_encode_angles_directed(hnbrdf_pair p, out vec3 x0, out vec3 x1)
{
    hnbrdf_encode_angle_terms(p, p.wi.z, p.wo.z, x0, x1);
}

// a and b in order of size: reciprocal.
void hnbrdf_encode_angles(hnbrdf_pair p, out vec3 x0, out vec3 x1)
{
    bool swap = p.wo.z < p.wi.z;
    hnbrdf_encode_angle_terms(p, swap ? p.wo.z : p.wi.z, swap ? p.wi.z : p.wo.z, x0, x1);
}

// |h.x| for sin th and |h.y| for 1 - c: reciprocal, and mirror-symmetric about the tangent frame.
void hnbrdf_encode_angles_anisotropic(hnbrdf_pair p, out vec3 x0, out vec3 x1)
{
    hnbrdf_encode_angles(p, x0, x1);
    HNBRDF_PRECISE float len = sqrt(p.length2);
    HNBRDF_PRECISE float x = abs(p.s.x) / len;
    HNBRDF_PRECISE float y = abs(p.s.y) / len;
    x0.y = x;
    x1.x = y;
}

// ---- Composition ---------------------------------------------------------------------------------------

// [0, HNBRDF_MAX_VALUE]; a NaN becomes 0.
vec3 hnbrdf_finish(vec3 f)
{
    return hnbrdf_clamp(f, 0.0, HNBRDF_MAX_VALUE);
}

// exp of the exponent s c + m, clamped.
vec3 hnbrdf_correction(vec3 exponent)
{
    return HNBRDF_EXP(hnbrdf_clamp(exponent, -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT));
}

// sigmoid(g).
HNBRDF_PRECISE vec3 hnbrdf_gate(vec3 g)
{
    HNBRDF_PRECISE vec3 e = HNBRDF_EXP(hnbrdf_clamp(-g, -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT));
    return 1.0 / (1.0 + e);
}

// max(0, exp(s c + m) + sigmoid(g) f_a - b); the first argument is s c + m, the last b.
vec3 hnbrdf_compose_hybrid(vec3 exponent, vec3 g, vec3 analytic, float b)
{
    HNBRDF_PRECISE vec3 f = (hnbrdf_correction(exponent) + hnbrdf_gate(g) * analytic) - b;
    return hnbrdf_finish(f);
}

// max(0, exp(s c + m) - b).
vec3 hnbrdf_compose_neural(vec3 exponent, float b)
{
    HNBRDF_PRECISE vec3 f = hnbrdf_correction(exponent) - b;
    return hnbrdf_finish(f);
}

// ---- Edits ---------------------------------------------------------------------------------------------

// What a material was fitted with; where it differs from what the material is, the network's correction is carried
// along with f_a: the network sees the half vector that had its place before, and its correction less the floor
// changes as f_a does. Unedited, every ratio is x/x.
struct hnbrdf_fitted {
    vec3 kd, eta;
    vec2 alpha;
};

// What of an edit depends on the material alone. carried and added: of kd/pi, what carries the correction along,
// up to 4 times the fitted one, and the rest. The fitted eta is raised until the reflectance at normal incidence is
// at most 16 times its own.
struct hnbrdf_edit {
    vec2 warp, alpha;
    float area;
    vec3 diffuse, e, carried, added;
};

float hnbrdf_carried_kd(float kd, float fitted_kd)
{
    HNBRDF_PRECISE float most = 4.0 * abs(fitted_kd);
    return kd > most ? most : kd;
}

HNBRDF_PRECISE float hnbrdf_added_kd(float kd, float fitted_kd)
{
    HNBRDF_PRECISE float most = 4.0 * abs(fitted_kd);
    HNBRDF_PRECISE float added = kd - most;
    return kd > most ? added : 0.0;
}

HNBRDF_PRECISE float hnbrdf_carried_eta(float eta, float fitted_eta)
{
    HNBRDF_PRECISE float r = ((eta - 1.0) / (eta + 1.0)) / 4.0;
    HNBRDF_PRECISE float raised = (1.0 + r) / (1.0 - r);
    return eta > fitted_eta && raised > fitted_eta ? raised : fitted_eta;
}

HNBRDF_PRECISE float hnbrdf_warp_factor(float alpha, float fitted_alpha)
{
    HNBRDF_PRECISE float factor = fitted_alpha / alpha;
    return alpha != fitted_alpha ? factor : 1.0;
}

HNBRDF_PRECISE hnbrdf_edit hnbrdf_edit_make(vec3 kd, vec3 eta, vec2 alpha, hnbrdf_fitted fitted)
{
    HNBRDF_PRECISE hnbrdf_edit m;
    vec3 eta0 = vec3(hnbrdf_carried_eta(eta.x, fitted.eta.x), hnbrdf_carried_eta(eta.y, fitted.eta.y),
                     hnbrdf_carried_eta(eta.z, fitted.eta.z));
    vec3 carried = vec3(hnbrdf_carried_kd(kd.x, fitted.kd.x), hnbrdf_carried_kd(kd.y, fitted.kd.y),
                        hnbrdf_carried_kd(kd.z, fitted.kd.z));
    vec3 added = vec3(hnbrdf_added_kd(kd.x, fitted.kd.x), hnbrdf_added_kd(kd.y, fitted.kd.y),
                      hnbrdf_added_kd(kd.z, fitted.kd.z));
    m.warp = vec2(hnbrdf_warp_factor(alpha.x, fitted.alpha.x), hnbrdf_warp_factor(alpha.y, fitted.alpha.y));
    m.alpha = fitted.alpha;
    m.area = hnbrdf_ggx_area(fitted.alpha);
    m.diffuse = fitted.kd * HNBRDF_INV_PI;
    m.e = hnbrdf_fresnel_e(eta0);
    m.carried = carried * HNBRDF_INV_PI;
    m.added = added * HNBRDF_INV_PI;
    return m;
}

// How much of f_a, carried + specular, is specular, over the channels: in [0, 1].
HNBRDF_PRECISE float hnbrdf_specular_part(vec3 specular, vec3 carried)
{
    HNBRDF_PRECISE float shine = (specular.x + specular.y) + specular.z;
    HNBRDF_PRECISE float diffuse = (carried.x + carried.y) + carried.z;
    HNBRDF_PRECISE float part = shine / (shine + diffuse);
    return hnbrdf_clamp(part, 0.0, 1.0);
}

// s' of the same length as s, its tangents times those of `warp`. It comes no nearer to the horizon than s is, or
// than 45 degrees where s is higher.
HNBRDF_PRECISE vec3 hnbrdf_warp(hnbrdf_pair p, vec2 warp)
{
    HNBRDF_PRECISE float r2 = p.s.x * p.s.x + p.s.y * p.s.y;
    HNBRDF_PRECISE float z2 = p.s.z * p.s.z;
    float most = r2 > z2 ? r2 : z2;
    HNBRDF_PRECISE vec2 w = p.s.xy * warp;
    HNBRDF_PRECISE float w2 = w.x * w.x + w.y * w.y;
    HNBRDF_PRECISE float shrink = sqrt(w2 > most ? most / w2 : 1.0);
    w = w * shrink;
    HNBRDF_PRECISE float length2 = hnbrdf_dot3(vec3(w, p.s.z));
    HNBRDF_PRECISE float stretch = sqrt(length2 != p.length2 ? p.length2 / length2 : 1.0);
    return vec3(w, p.s.z) * stretch;
}

// The pair of s', its directions as they are. warp: the factors where all of f_a is specular.
hnbrdf_pair hnbrdf_warped(hnbrdf_pair p, vec2 warp, float part)
{
    HNBRDF_PRECISE vec2 by = 1.0 + part * (warp - 1.0);
    p.s = hnbrdf_warp(p, by);
    return p;
}

// Both directions turned with s to s', the shortest way. Where s' is s, both stay as they are.
HNBRDF_PRECISE hnbrdf_pair hnbrdf_turn_pair(hnbrdf_pair p, hnbrdf_pair q)
{
    HNBRDF_PRECISE vec3 d = p.wi - p.wo;
    HNBRDF_PRECISE float along = (d.x * p.s.x + d.y * p.s.y) + d.z * p.s.z;
    HNBRDF_PRECISE float across = (d.x * q.s.x + d.y * q.s.y) + d.z * q.s.z;
    HNBRDF_PRECISE float both = p.length2 + ((p.s.x * q.s.x + p.s.y * q.s.y) + p.s.z * q.s.z);
    HNBRDF_PRECISE float k = (along + across) / both;
    HNBRDF_PRECISE float j = (2.0 * along) / p.length2;
    HNBRDF_PRECISE vec3 turned = (d - k * (p.s + q.s)) + j * q.s;
    if (q.s == p.s)
        return q;
    q.wi = 0.5 * (q.s + turned);
    q.wo = 0.5 * (q.s - turned);
    return q;
}

// For encodings by angles: the cosines of incidence where s gets nearer to the normal. Their sum is s.z, and their
// difference goes with the sine of its angle, as if the pair were turned. What is left of wi - wo is laid along x, so
// that its length, and the difference angle, stay. Where s does not move, nothing does.
HNBRDF_PRECISE hnbrdf_pair hnbrdf_raise_pair(hnbrdf_pair p, hnbrdf_pair q)
{
    HNBRDF_PRECISE float r2 = p.s.x * p.s.x + p.s.y * p.s.y;
    HNBRDF_PRECISE float q2 = q.s.x * q.s.x + q.s.y * q.s.y;
    HNBRDF_PRECISE float shrink = sqrt(q2 < r2 ? q2 / r2 : 1.0);
    HNBRDF_PRECISE float less = shrink - 1.0;
    HNBRDF_PRECISE float sum = q.s.z - p.s.z;
    sum = sum > 0.0 ? sum : 0.0;
    HNBRDF_PRECISE vec3 d = p.wi - p.wo;
    HNBRDF_PRECISE float rest = (d.x * d.x + d.y * d.y) - (d.z * d.z) * (less * (1.0 + shrink));
    HNBRDF_PRECISE float along = 0.5 * sqrt(rest);
    HNBRDF_PRECISE float difference = less * d.z;
    HNBRDF_PRECISE float i = p.wi.z + 0.5 * (sum + difference);
    HNBRDF_PRECISE float o = p.wo.z + 0.5 * (sum - difference);
    if (less != 0.0 || sum > 0.0) {
        q.wi = vec3(along, 0.0, i);
        q.wo = vec3(-along, 0.0, o);
    }
    return q;
}

// f_a of the edited material, and of the fitted one at s' with masking at the directions as they are.
HNBRDF_PRECISE vec3 hnbrdf_microfacet_fitted(hnbrdf_pair p, hnbrdf_pair seen, hnbrdf_edit m)
{
    HNBRDF_PRECISE float specular = hnbrdf_ggx_d_of_area(seen.s, p.length2, m.alpha, m.area) *
                                    (hnbrdf_smith_v(p.wi, m.alpha) * hnbrdf_smith_v(p.wo, m.alpha));
    return hnbrdf_microfacet_of(m.diffuse, m.e, p.c, specular);
}

// f_a of the edited material over that of the fitted one, in [0, HNBRDF_MAX_VALUE].
HNBRDF_PRECISE float hnbrdf_carried_ratio(float edited, float fitted)
{
    HNBRDF_PRECISE float ratio = edited / fitted;
    return edited != fitted ? hnbrdf_clamp(ratio, 0.0, HNBRDF_MAX_VALUE) : 1.0;
}

// max(0, ratio (exp(s c + m) - b) + sigmoid(g) f_a + added); a ratio of 1 gives the bits of hnbrdf_compose_hybrid().
vec3 hnbrdf_compose_edited(vec3 exponent, vec3 g, vec3 edited, vec3 fitted, vec3 added, float b)
{
    vec3 ratio = vec3(hnbrdf_carried_ratio(edited.x, fitted.x), hnbrdf_carried_ratio(edited.y, fitted.y),
                      hnbrdf_carried_ratio(edited.z, fitted.z));
    vec3 c = hnbrdf_correction(exponent);
    HNBRDF_PRECISE vec3 gated = hnbrdf_gate(g) * edited;
    HNBRDF_PRECISE vec3 carried = ratio * (c - b) + gated;
    HNBRDF_PRECISE vec3 plain = (c + gated) - b;
    HNBRDF_PRECISE vec3 f = vec3(ratio.x != 1.0 ? carried.x : plain.x, ratio.y != 1.0 ? carried.y : plain.y,
                                 ratio.z != 1.0 ? carried.z : plain.z) + added;
    return hnbrdf_finish(f);
}

// ---- Sampling ------------------------------------------------------------------------------------------

// What hnbrdf_sample() of an exported scene returns.
struct hnbrdf_sample_result {
    vec3 wi;     // unit direction towards the light, wi.z > 0; (0, 0, 1) when pdf is 0
    float pdf;   // 1/sr; 0 means: no direction, weight is 0
    vec3 weight; // f wi.z / pdf
};

// The two GGX lobes of a material, beside the cosine lobe: of roughness |scale| alpha, with visible normals where
// the scale is positive, all normals where it is negative. Shares at wo.z = 0, 1/9, 4/9, 1; the rest is cosine.
struct hnbrdf_lobes {
    vec2 scale;
    vec4 share0, share1;
};

// Of a material without fitted lobes: one of roughness alpha, its share that of the reflectance at normal
// incidence, raised a little for what Fresnel adds towards grazing, against the diffuse albedo.
HNBRDF_PRECISE hnbrdf_lobes hnbrdf_lobes_guess(vec3 kd, vec3 eta)
{
    HNBRDF_PRECISE vec3 r = (eta - 1.0) / (eta + 1.0);
    HNBRDF_PRECISE vec3 r2 = r * r * 0.333333333;
    HNBRDF_PRECISE vec3 d = kd * 0.333333333;
    HNBRDF_PRECISE float specular = ((0.05 + r2.x) + r2.y) + r2.z;
    HNBRDF_PRECISE float diffuse = (d.x + d.y) + d.z;
    HNBRDF_PRECISE float share = specular / (specular + diffuse);
    share = hnbrdf_clamp(share, 0.2, 0.9);
    return hnbrdf_lobes(vec2(1.0, 0.0), vec4(share), vec4(0.0));
}

HNBRDF_PRECISE vec2 hnbrdf_lobe_alpha(float scale, vec2 alpha)
{
    HNBRDF_PRECISE vec2 a = abs(scale) * alpha;
    return vec2(hnbrdf_clamp(a.x, 1e-4, 1.0), hnbrdf_clamp(a.y, 1e-4, 1.0));
}

// Shares at this view, piecewise linear in sqrt(z): each knot weighs in by its distance.
HNBRDF_PRECISE vec2 hnbrdf_lobe_shares(hnbrdf_lobes lobes, float z)
{
    HNBRDF_PRECISE float x = hnbrdf_clamp(3.0 * sqrt(z), 0.0, 3.0);
    HNBRDF_PRECISE vec4 hat = clamp(1.0 - abs(x - vec4(0.0, 1.0, 2.0, 3.0)), 0.0, 1.0);
    HNBRDF_PRECISE vec4 s0 = hat * lobes.share0;
    HNBRDF_PRECISE vec4 s1 = hat * lobes.share1;
    return vec2(((s0.x + s0.y) + s0.z) + s0.w, ((s1.x + s1.y) + s1.z) + s1.w);
}

// Visible normals of w, D V(w)/2 of which is their density as reflections (Heitz 2018 Eq. 17): V(w), the cap of
// normals cut off where all reflections go below the horizon (Eto and Tokuyoshi 2023).
HNBRDF_PRECISE float hnbrdf_cap_bound(vec3 w, vec2 alpha)
{
    float a = alpha.x < alpha.y ? alpha.x : alpha.y;
    HNBRDF_PRECISE float a2 = a * a;
    HNBRDF_PRECISE float s = 1.0 + sqrt(w.x * w.x + w.y * w.y);
    HNBRDF_PRECISE float s2 = s * s;
    return ((1.0 - a2) * s2) / (s2 + a2 * (w.z * w.z));
}

HNBRDF_PRECISE float hnbrdf_visible_v(vec3 w, vec2 alpha)
{
    return 1.0 / (hnbrdf_cap_bound(w, alpha) * w.z + sqrt(hnbrdf_dot3(vec3(alpha * w.xy, w.z))));
}

// Of reflections about visible normals D V(wo)/2; about all normals D h.n / (4 wo.h).
HNBRDF_PRECISE float hnbrdf_lobe_density(hnbrdf_pair p, float scale, vec2 alpha)
{
    vec2 a = hnbrdf_lobe_alpha(scale, alpha);
    HNBRDF_PRECISE float d = hnbrdf_ggx_d(p.s, p.length2, a);
    HNBRDF_PRECISE float v = scale < 0.0 ? p.s.z / p.length2 : hnbrdf_visible_v(p.wo, a);
    return d * (0.5 * v);
}

// The one density that sample and pdf share; directions in the tangent frame, both above the horizon.
float hnbrdf_density(vec2 alpha, hnbrdf_lobes lobes, vec3 wi, vec3 wo)
{
    hnbrdf_pair p = hnbrdf_pair_make(wi, wo);
    vec2 share = hnbrdf_lobe_shares(lobes, wo.z);
    HNBRDF_PRECISE float pdf = 0.0;
    if (share.x > 0.0)
        pdf = pdf + share.x * hnbrdf_lobe_density(p, lobes.scale.x, alpha);
    if (share.y > 0.0)
        pdf = pdf + share.y * hnbrdf_lobe_density(p, lobes.scale.y, alpha);
    HNBRDF_PRECISE float rest = hnbrdf_clamp(1.0 - (share.x + share.y), 0.0, 1.0);
    pdf = pdf + rest * (wi.z * HNBRDF_INV_PI);
    return hnbrdf_clamp(pdf, 0.0, HNBRDF_MAX_VALUE);
}

// Cosine-distributed direction; u.y < 1 keeps z above 0.
HNBRDF_PRECISE vec3 hnbrdf_draw_cosine(vec2 u)
{
    HNBRDF_PRECISE vec2 turn = hnbrdf_sincos_turn(u.x);
    HNBRDF_PRECISE float r = sqrt(u.y);
    return vec3(r * turn.y, r * turn.x, sqrt(1.0 - u.y));
}

// A visible normal, not normalised: a point of a spherical cap (Dupuy and Benyoub 2023, Listing 3) above its
// bound, stretched. (0, 0, 0) where there is none.
HNBRDF_PRECISE vec3 hnbrdf_draw_visible(vec2 alpha, vec3 wo, vec2 u)
{
    HNBRDF_PRECISE vec3 w = vec3(alpha * wo.xy, wo.z);
    HNBRDF_PRECISE float len = sqrt(hnbrdf_dot3(w));
    if (!(len > 0.0))
        return vec3(0.0);
    w = w / len;
    HNBRDF_PRECISE vec2 turn = hnbrdf_sincos_turn(u.x);
    HNBRDF_PRECISE float low = hnbrdf_cap_bound(wo, alpha) * w.z;
    HNBRDF_PRECISE float cap = (1.0 - u.y) * (1.0 + low) - low;
    HNBRDF_PRECISE float radius = sqrt(hnbrdf_clamp(1.0 - cap * cap, 0.0, 1.0));
    return vec3(alpha * (radius * turn.yx + w.xy), cap + w.z);
}

// Any normal, with density D h.n: slopes tan^2 = u / (1 - u) (Walter 2007 Eqs. 35 and 36), not normalised.
HNBRDF_PRECISE vec3 hnbrdf_draw_normal(vec2 alpha, vec2 u)
{
    HNBRDF_PRECISE vec2 turn = hnbrdf_sincos_turn(u.x);
    HNBRDF_PRECISE float r = sqrt(u.y);
    return vec3(alpha * (r * turn.yx), sqrt(1.0 - u.y));
}

// Reflects wo about a normal of one lobe. (0, 0, 0) if no normal comes out.
HNBRDF_PRECISE vec3 hnbrdf_draw_lobe(float scale, vec2 alpha, vec3 wo, vec2 u)
{
    vec2 a = hnbrdf_lobe_alpha(scale, alpha);
    vec3 h = scale < 0.0 ? hnbrdf_draw_normal(a, u) : hnbrdf_draw_visible(a, wo, u);
    HNBRDF_PRECISE float h2 = hnbrdf_dot3(h);
    if (!(h2 > 0.0))
        return vec3(0.0);
    HNBRDF_PRECISE float k = 2.0 * (((wo.x * h.x + wo.y * h.y) + wo.z * h.z) / h2);
    return k * h - wo;
}

// What is left of u0 once it has chosen its part [low, low + size) of [0, 1), as an azimuth: a pair (u0, u1) that is
// stratified stays so in each lobe.
HNBRDF_PRECISE float hnbrdf_azimuth(float u0, float low, float size)
{
    HNBRDF_PRECISE float within = (u0 - low) / size;
    return hnbrdf_clamp(within, 0.0, 0.99999994);
}

// The lobe that u.x falls to, or cosine. NaN counts as 0.
vec3 hnbrdf_draw(vec2 alpha, hnbrdf_lobes lobes, vec3 wo, vec2 u)
{
    vec2 share = hnbrdf_lobe_shares(lobes, wo.z);
    HNBRDF_PRECISE float both = share.x + share.y;
    float u0 = hnbrdf_clamp(u.x, 0.0, 0.99999994), u1 = hnbrdf_clamp(u.y, 0.0, 0.99999994);
    if (u0 < both) {
        bool first = u0 < share.x;
        float turn = first ? hnbrdf_azimuth(u0, 0.0, share.x) : hnbrdf_azimuth(u0, share.x, share.y);
        return hnbrdf_draw_lobe(first ? lobes.scale.x : lobes.scale.y, alpha, wo, vec2(turn, u1));
    }
    HNBRDF_PRECISE float rest = 1.0 - both;
    return hnbrdf_draw_cosine(vec2(hnbrdf_azimuth(u0, both, rest), u1));
}

#endif
