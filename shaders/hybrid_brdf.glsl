// hybrid_brdf.glsl: the parts a hybrid neural-microfacet BRDF is made of (De Oliveira et al., EGSR 2026).
// Include it first, then what `hnbrdf export` wrote for a scene: that calls these.
//
// The same functions as in the C library, named alike and in the same order of operations. Frame and units
// as there: n = +z, wi towards the light, wo towards the viewer, f in 1/sr without the cosine.
//
// Runs as Vulkan GLSL 450, desktop GLSL 330, GLSL ES 300. What can be defined before including:
//   HNBRDF_EXACT 1       the bits of the C library, on a device whose + - * / sqrt are correctly rounded:
//                        exp and log of exact operations, `precise` where the language has it.
//                        0 (default): the built-in exp and log, contraction allowed. Fastest.
//   HNBRDF_EXP(x)        exp of a vec3 in [-80, 80]
//   HNBRDF_LOG(x)        log of a float in [1e-5, +inf], finite for +inf
//   HNBRDF_PRECISE       qualifier of every variable that holds arithmetic
// In GLSL ES the default precision of float and int becomes highp from here on.
//
// Names: what is defined here begins with hnbrdf_ or HNBRDF_. Parameters, locals and members have an underscore, or are
// a single letter that GLSL itself uses for components (x y z w, r g b a, s t p q), or one of kd, eta, alpha, rotation,
// wi, wo, pdf, weight. So macros of the program around it may be called like any other plain word (c, low, first, sum).
#ifndef HNBRDF_HYBRID_BRDF_GLSL
#define HNBRDF_HYBRID_BRDF_GLSL
#ifdef HNBRDF_HYBRID_BRDF_PARTS
#error a standalone text came before hybrid_brdf.glsl: include that first, or export all with --prefix
#endif

#ifndef HNBRDF_EXACT
#define HNBRDF_EXACT 0
#endif

#ifndef HNBRDF_PRECISE
#if HNBRDF_EXACT == 1 && ((defined(GL_ES) && __VERSION__ >= 320) || (!defined(GL_ES) && __VERSION__ >= 400))
#define HNBRDF_PRECISE precise
#else
#define HNBRDF_PRECISE
#endif
#endif

#ifndef HNBRDF_EXP
#if HNBRDF_EXACT == 1
#define HNBRDF_EXP(x) hnbrdf_exp(x)
#else
#define HNBRDF_EXP(x) exp(x)
#endif
#endif

// The largest float in place of infinity: hnbrdf_log(+inf) is finite too.
#ifndef HNBRDF_LOG
#if HNBRDF_EXACT == 1
#define HNBRDF_LOG(x) hnbrdf_log(x)
#else
#define HNBRDF_LOG(x) log(min(x, 3.402823e38))
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

// x in [x_low, x_high]. A NaN becomes x_low, which clamp() does not promise.
float hnbrdf_clamp(float x, float x_low, float x_high)
{
    return x > x_low ? (x < x_high ? x : x_high) : x_low;
}

vec3 hnbrdf_clamp(vec3 x, float x_low, float x_high)
{
    return vec3(hnbrdf_clamp(x.x, x_low, x_high), hnbrdf_clamp(x.y, x_low, x_high), hnbrdf_clamp(x.z, x_low, x_high));
}

// exp(x) for x in [-80, 80], within 1 ulp.
float hnbrdf_exp(float x)
{
    HNBRDF_PRECISE float y = x * 1.44269504;
    int k_int = int(y + (y >= 0.0 ? 0.5 : -0.5));
    HNBRDF_PRECISE float k_float = float(k_int);
    HNBRDF_PRECISE float r = (x - k_float * 0.693359375) - k_float * -2.12194440e-4; // ln 2 in two parts
    HNBRDF_PRECISE float q = 1.98909809e-4;
    q = q * r + 1.39336410e-3;
    q = q * r + 8.33331093e-3;
    q = q * r + 4.16664650e-2;
    q = q * r + 1.66666667e-1;
    q = q * r + 0.5;
    HNBRDF_PRECISE float exp_r = (q * (r * r) + r) + 1.0;
    HNBRDF_PRECISE float value_out = exp_r * intBitsToFloat((k_int + 127) * 0x800000);
    return value_out;
}

vec3 hnbrdf_exp(vec3 x)
{
    return vec3(hnbrdf_exp(x.x), hnbrdf_exp(x.y), hnbrdf_exp(x.z));
}

// ln(x) for normal x > 0, error at most 1.05 ulp of the result plus 5e-8. +inf gives a finite 88.7.
float hnbrdf_log(float x)
{
    int bits_x = floatBitsToInt(x) - 0x3f3504f3; // mantissa to [sqrt(1/2), sqrt(2))
    int exponent_2 = bits_x >> 23;
    HNBRDF_PRECISE float mantissa_1 = intBitsToFloat((bits_x & 0x7fffff) + 0x3f3504f3) - 1.0;
    HNBRDF_PRECISE float s = mantissa_1 / (2.0 + mantissa_1);
    HNBRDF_PRECISE float s_2 = s * s;
    HNBRDF_PRECISE float p = 2.95799494e-1;
    p = p * s_2 + 3.99887806e-1;
    p = p * s_2 + 6.66666850e-1;
    HNBRDF_PRECISE float value_out = float(exponent_2) * 0.693147181 + (2.0 * s + s * (s_2 * p));
    return value_out;
}

// (sin, cos) of 2 pi u for u in [0, 1], absolute error at most 1.1e-7. In every build: what is drawn must
// not depend on the device.
vec2 hnbrdf_sincos_turn(float turn_u)
{
    int quarter_turn = int(4.0 * turn_u + 0.5);
    HNBRDF_PRECISE float a = (turn_u - 0.25 * float(quarter_turn)) * 6.28318531; // the difference is exact
    HNBRDF_PRECISE float a_2 = a * a;
    HNBRDF_PRECISE float sin_a = -1.95878909e-4;
    sin_a = sin_a * a_2 + 8.33274827e-3;
    sin_a = sin_a * a_2 - 1.66666647e-1;
    sin_a = a + a * (a_2 * sin_a);
    HNBRDF_PRECISE float cos_a = 2.45479421e-5;
    cos_a = cos_a * a_2 - 1.38883030e-3;
    cos_a = cos_a * a_2 + 4.16666647e-2;
    cos_a = (1.0 - 0.5 * a_2) + (a_2 * a_2) * cos_a;
    bool do_swap = (quarter_turn & 1) != 0;
    float sin_u = do_swap ? cos_a : sin_a;
    float cos_u = do_swap ? sin_a : cos_a;
    HNBRDF_PRECISE vec2 value_out = vec2((quarter_turn & 2) != 0 ? -sin_u : sin_u,
                                         ((quarter_turn + 1) & 2) != 0 ? -cos_u : cos_u);
    return value_out;
}

// x clamp(x/3 + 1/2, 0, 1), the paper's three-branch HardGELU.
float hnbrdf_hard_gelu(float x)
{
    HNBRDF_PRECISE float value_out = x * clamp(x * 0.333333333 + 0.5, 0.0, 1.0);
    return value_out;
}

vec2 hnbrdf_hard_gelu(vec2 x)
{
    HNBRDF_PRECISE vec2 value_out = x * clamp(x * 0.333333333 + 0.5, 0.0, 1.0);
    return value_out;
}

vec3 hnbrdf_hard_gelu(vec3 x)
{
    HNBRDF_PRECISE vec3 value_out = x * clamp(x * 0.333333333 + 0.5, 0.0, 1.0);
    return value_out;
}

vec4 hnbrdf_hard_gelu(vec4 x)
{
    HNBRDF_PRECISE vec4 value_out = x * clamp(x * 0.333333333 + 0.5, 0.0, 1.0);
    return value_out;
}

// ---- A pair of directions ----------------------------------------------------------------------------

// Into the tangent frame of a material: turned about n by the angle with this (cosine, sine).
vec3 hnbrdf_to_tangent(vec2 rotation, vec3 w)
{
    HNBRDF_PRECISE vec3 value_out = vec3(rotation.x * w.x + rotation.y * w.y, rotation.x * w.y - rotation.y * w.x, w.z);
    return value_out;
}

// And back.
vec3 hnbrdf_from_tangent(vec2 rotation, vec3 t)
{
    HNBRDF_PRECISE vec3 value_out = vec3(rotation.x * t.x - rotation.y * t.y, rotation.x * t.y + rotation.y * t.x, t.z);
    return value_out;
}

float hnbrdf_dot3(vec3 w)
{
    HNBRDF_PRECISE float value_out = (w.x * w.x + w.y * w.y) + w.z * w.z;
    return value_out;
}

float hnbrdf_dot3(vec3 a, vec3 b)
{
    HNBRDF_PRECISE float value_out = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return value_out;
}

// What the analytic part and the encodings share of one pair, in the tangent frame of the material.
struct hnbrdf_pair {
    vec3 wi, wo;
    vec3 s;         // wi + wo: the half vector, not normalised
    float length_2; // s.s
    float cos_d;    // cosine of the difference angle, wi.h = |s|/2 for unit vectors
};

hnbrdf_pair hnbrdf_pair_make(vec3 wi, vec3 wo)
{
    HNBRDF_PRECISE hnbrdf_pair p;
    p.wi = wi;
    p.wo = wo;
    p.s = wi + wo;
    p.length_2 = hnbrdf_dot3(p.s);
    p.cos_d = 0.5 * sqrt(p.length_2);
    return p;
}

// ---- The analytic part: Lambert + GGX (Walter et al. 2007, Heitz 2014) ---------------------------------

// GGX normal density D(h), 1/sr (Walter 2007 Eq. 33, anisotropic: Heitz 2014 Eq. 86), in the
// tangent-frame form: 1 - (n.h)^2 would lose every digit of a narrow lobe. What depends on the material
// alone, area = pi ax ay here and e = eta^2 - 1 below, has a function of its own. Where alpha is a float, the
// lobe is isotropic, with the same values.
float hnbrdf_ggx_area(vec2 alpha)
{
    HNBRDF_PRECISE float value_out = (HNBRDF_PI * alpha.x) * alpha.y;
    return value_out;
}

float hnbrdf_ggx_area(float alpha)
{
    HNBRDF_PRECISE float value_out = (HNBRDF_PI * alpha) * alpha;
    return value_out;
}

float hnbrdf_ggx_d_of_area(vec3 s, float length_2, vec2 alpha, float ggx_area)
{
    HNBRDF_PRECISE float t = hnbrdf_dot3(vec3(s.xy / alpha, s.z)) / length_2;
    HNBRDF_PRECISE float value_out = 1.0 / (ggx_area * (t * t));
    return value_out;
}

float hnbrdf_ggx_d_of_area(vec3 s, float length_2, float alpha, float ggx_area)
{
    HNBRDF_PRECISE float t = hnbrdf_dot3(vec3(s.xy / alpha, s.z)) / length_2;
    HNBRDF_PRECISE float value_out = 1.0 / (ggx_area * (t * t));
    return value_out;
}

float hnbrdf_ggx_d(vec3 s, float length_2, vec2 alpha)
{
    return hnbrdf_ggx_d_of_area(s, length_2, alpha, hnbrdf_ggx_area(alpha));
}

// Smith masking of one direction over its share of the denominator, V(w) = G1(w) / (2 w.z), so that
// G1 G1 / (4 wi.z wo.z) = V V, finite at grazing (Heitz 2014 Eq. 43).
float hnbrdf_smith_v(vec3 w, vec2 alpha)
{
    HNBRDF_PRECISE float value_out = 1.0 / (w.z + sqrt(hnbrdf_dot3(vec3(alpha * w.xy, w.z))));
    return value_out;
}

float hnbrdf_smith_v(vec3 w, float alpha)
{
    HNBRDF_PRECISE float value_out = 1.0 / (w.z + sqrt(hnbrdf_dot3(vec3(alpha * w.xy, w.z))));
    return value_out;
}

// Unpolarised Fresnel reflectance of a dielectric with index eta > 1 at cosine c = wi.h (Walter 2007
// Eq. 22). g - c is taken as (eta^2 - 1)/(g + c): the difference itself loses digits as eta nears 1.
vec3 hnbrdf_fresnel_e(vec3 eta)
{
    HNBRDF_PRECISE vec3 value_out = (eta - 1.0) * (eta + 1.0);
    return value_out;
}

vec3 hnbrdf_fresnel_of_e(vec3 eta_e, float cos_d)
{
    HNBRDF_PRECISE vec3 g_plus_c = sqrt(eta_e + cos_d * cos_d) + cos_d;
    HNBRDF_PRECISE vec3 g_less_c = eta_e / g_plus_c; // g - c
    HNBRDF_PRECISE vec3 a = g_less_c / g_plus_c;
    HNBRDF_PRECISE vec3 b = (cos_d * g_plus_c - 1.0) / (cos_d * g_less_c + 1.0);
    HNBRDF_PRECISE vec3 value_out = (0.5 * (a * a)) * (1.0 + b * b);
    return value_out;
}

vec3 hnbrdf_fresnel_dielectric(vec3 eta, float cos_d)
{
    return hnbrdf_fresnel_of_e(hnbrdf_fresnel_e(eta), cos_d);
}

float hnbrdf_fresnel_dielectric(float eta, float cos_d)
{
    return hnbrdf_fresnel_dielectric(vec3(eta), cos_d).x;
}

// D V V, what the Fresnel factor of every channel multiplies, 1/sr.
float hnbrdf_specular_of_area(hnbrdf_pair p, vec2 alpha, float ggx_area)
{
    HNBRDF_PRECISE float value_out = hnbrdf_ggx_d_of_area(p.s, p.length_2, alpha, ggx_area) *
           (hnbrdf_smith_v(p.wi, alpha) * hnbrdf_smith_v(p.wo, alpha));
    return value_out;
}

float hnbrdf_specular_of_area(hnbrdf_pair p, float alpha, float ggx_area)
{
    HNBRDF_PRECISE float value_out = hnbrdf_ggx_d_of_area(p.s, p.length_2, alpha, ggx_area) *
           (hnbrdf_smith_v(p.wi, alpha) * hnbrdf_smith_v(p.wo, alpha));
    return value_out;
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
vec3 hnbrdf_microfacet_of(vec3 kd_pi, vec3 eta_e, float cos_d, float d_v_v)
{
    HNBRDF_PRECISE vec3 value_out = kd_pi + hnbrdf_fresnel_of_e(eta_e, cos_d) * d_v_v;
    return value_out;
}

vec3 hnbrdf_microfacet(vec3 kd, vec3 eta, float cos_d, float d_v_v)
{
    HNBRDF_PRECISE vec3 value_out = hnbrdf_microfacet_of(kd * HNBRDF_INV_PI, hnbrdf_fresnel_e(eta), cos_d, d_v_v);
    return value_out;
}

// ---- Encodings: what the network sees of a pair, six numbers -------------------------------------------

// The paper's: the six Cartesian components.
void hnbrdf_encode_directions(hnbrdf_pair p, out vec3 x_0, out vec3 x_1)
{
    x_0 = p.wi;
    x_1 = p.wo;
}

// Functions of h and of the difference angle that do not change, to the last bit, when wi and wo swap:
//   1 + ln(1e-5 + tan^2 th)/4, sqrt(sin th), c, sqrt(1 - c), wi.z wo.z, wi.z + wo.z
// th is the angle between n and h, c = wi.h. sqrt(1 - c) is taken from |wi - wo|^2 = 4 (1 - c^2), exact
// where 1 - c would cancel (near retroreflection).
void hnbrdf_encode_half_difference(hnbrdf_pair p, out vec3 x_0, out vec3 x_1)
{
    HNBRDF_PRECISE float r_2 = p.s.x * p.s.x + p.s.y * p.s.y;
    HNBRDF_PRECISE float d_2 = hnbrdf_dot3(p.wi - p.wo);
    HNBRDF_PRECISE float tan_2 = 1e-5 + r_2 / (p.s.z * p.s.z);
    HNBRDF_PRECISE float x = 1.0 + 0.25 * HNBRDF_LOG(tan_2);
    HNBRDF_PRECISE float y = sqrt(sqrt(r_2 / p.length_2));
    HNBRDF_PRECISE float z = sqrt((0.25 * d_2) / (1.0 + p.cos_d));
    HNBRDF_PRECISE float z_product = p.wi.z * p.wo.z;
    HNBRDF_PRECISE float z_sum = p.wi.z + p.wo.z;
    x_0 = vec3(x, y, p.cos_d);
    x_1 = vec3(z, z_product, z_sum);
}

// What the encodings by angles share. The cosines of incidence are a and b:
//   1 + ln(1e-5 + tan^2 th)/4, sin th, ln(1e-3 + 1 - c)/4, 1 - c, a, b
void hnbrdf_encode_angle_terms(hnbrdf_pair p, float a, float b, out vec3 x_0, out vec3 x_1)
{
    HNBRDF_PRECISE float r_2 = p.s.x * p.s.x + p.s.y * p.s.y;
    HNBRDF_PRECISE float d_2 = hnbrdf_dot3(p.wi - p.wo);
    HNBRDF_PRECISE float q = (0.25 * d_2) / (1.0 + p.cos_d);
    HNBRDF_PRECISE float tan_2 = 1e-5 + r_2 / (p.s.z * p.s.z);
    HNBRDF_PRECISE float x = 1.0 + 0.25 * HNBRDF_LOG(tan_2);
    HNBRDF_PRECISE float y = sqrt(r_2 / p.length_2);
    HNBRDF_PRECISE float off_mirror = 1e-3 + q;
    HNBRDF_PRECISE float z = 0.25 * HNBRDF_LOG(off_mirror);
    x_0 = vec3(x, y, z);
    x_1 = vec3(q, a, b);
}

// a = wi.z, b = wo.z: sees which of the two is the light.
void hnbrdf_encode_angles_directed(hnbrdf_pair p, out vec3 x_0, out vec3 x_1)
{
    hnbrdf_encode_angle_terms(p, p.wi.z, p.wo.z, x_0, x_1);
}

// a and b in order of size: reciprocal.
void hnbrdf_encode_angles(hnbrdf_pair p, out vec3 x_0, out vec3 x_1)
{
    bool do_swap = p.wo.z < p.wi.z;
    hnbrdf_encode_angle_terms(p, do_swap ? p.wo.z : p.wi.z, do_swap ? p.wi.z : p.wo.z, x_0, x_1);
}

// |h.x| for sin th and |h.y| for 1 - c: reciprocal, and mirror-symmetric about the tangent frame.
void hnbrdf_encode_angles_anisotropic(hnbrdf_pair p, out vec3 x_0, out vec3 x_1)
{
    hnbrdf_encode_angles(p, x_0, x_1);
    HNBRDF_PRECISE float s_length = sqrt(p.length_2);
    HNBRDF_PRECISE float x = abs(p.s.x) / s_length;
    HNBRDF_PRECISE float y = abs(p.s.y) / s_length;
    x_0.y = x;
    x_1.x = y;
}

// |h.x| for sin th and |wi.x - wo.x|/2 for the larger cosine: sees the azimuths of h and of wi - wo: reciprocal, and
// mirror-symmetric about the tangent frame.
void hnbrdf_encode_angles_azimuths(hnbrdf_pair p, out vec3 x_0, out vec3 x_1)
{
    hnbrdf_encode_angles(p, x_0, x_1);
    HNBRDF_PRECISE float x = abs(p.s.x) / sqrt(p.length_2);
    HNBRDF_PRECISE float y = 0.5 * abs(p.wi.x - p.wo.x);
    x_0.y = x;
    x_1.z = y;
}

// ---- Composition ---------------------------------------------------------------------------------------

// [0, HNBRDF_MAX_VALUE]. A NaN becomes 0.
vec3 hnbrdf_finish(vec3 f_sum)
{
    return hnbrdf_clamp(f_sum, 0.0, HNBRDF_MAX_VALUE);
}

// exp of the exponent s c + m, clamped.
vec3 hnbrdf_correction(vec3 exp_arg)
{
    return HNBRDF_EXP(hnbrdf_clamp(exp_arg, -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT));
}

// sigmoid(g).
vec3 hnbrdf_gate(vec3 g)
{
    HNBRDF_PRECISE vec3 exp_g = HNBRDF_EXP(hnbrdf_clamp(-g, -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT));
    HNBRDF_PRECISE vec3 value_out = 1.0 / (1.0 + exp_g);
    return value_out;
}

// max(0, exp(s c + m) + sigmoid(g) f_a - b). The first argument is s c + m, the last b.
vec3 hnbrdf_compose_hybrid(vec3 exp_arg, vec3 g, vec3 f_analytic, float b)
{
    HNBRDF_PRECISE vec3 f_sum = (hnbrdf_correction(exp_arg) + hnbrdf_gate(g) * f_analytic) - b;
    return hnbrdf_finish(f_sum);
}

// max(0, exp(s c + m) - b).
vec3 hnbrdf_compose_neural(vec3 exp_arg, float b)
{
    HNBRDF_PRECISE vec3 f_sum = hnbrdf_correction(exp_arg) - b;
    return hnbrdf_finish(f_sum);
}

// What f of a material that conserves energy is multiplied by: k(wi.z) k(wo.z), k(z) = min(1, ramp.x + ramp.y z).
float hnbrdf_energy_factor(vec2 energy_ramp, float z_i, float z_o)
{
    HNBRDF_PRECISE float k_i = energy_ramp.x + energy_ramp.y * z_i;
    HNBRDF_PRECISE float k_o = energy_ramp.x + energy_ramp.y * z_o;
    HNBRDF_PRECISE float k_both = hnbrdf_clamp(k_i, 0.0, 1.0) * hnbrdf_clamp(k_o, 0.0, 1.0);
    return k_both;
}

vec3 hnbrdf_conserve(float k_both, vec3 f_sum)
{
    HNBRDF_PRECISE vec3 f_kept = k_both * f_sum;
    return f_kept;
}

// ---- Edits ---------------------------------------------------------------------------------------------

// What a material was fitted with. Where it differs from what the material is, the network's correction is carried
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
    vec2 warp_by, alpha;
    float area_fitted;
    vec3 kd_fitted, e_fitted, kd_carried, kd_added;
};

float hnbrdf_carried_kd(float kd, float fitted_kd)
{
    HNBRDF_PRECISE float kd_most = 4.0 * abs(fitted_kd);
    return kd > kd_most ? kd_most : kd;
}

float hnbrdf_added_kd(float kd, float fitted_kd)
{
    HNBRDF_PRECISE float kd_most = 4.0 * abs(fitted_kd);
    HNBRDF_PRECISE float kd_added = kd - kd_most;
    return kd > kd_most ? kd_added : 0.0;
}

float hnbrdf_carried_eta(float eta, float fitted_eta)
{
    HNBRDF_PRECISE float r = ((eta - 1.0) / (eta + 1.0)) / 4.0;
    HNBRDF_PRECISE float eta_raised = (1.0 + r) / (1.0 - r);
    return eta > fitted_eta && eta_raised > fitted_eta ? eta_raised : fitted_eta;
}

float hnbrdf_warp_factor(float alpha, float fitted_alpha)
{
    HNBRDF_PRECISE float warp_ratio = fitted_alpha / alpha;
    return alpha != fitted_alpha ? warp_ratio : 1.0;
}

hnbrdf_edit hnbrdf_edit_make(vec3 kd, vec3 eta, vec2 alpha, hnbrdf_fitted as_fitted)
{
    HNBRDF_PRECISE hnbrdf_edit edit_out;
    vec3 eta_0 = vec3(hnbrdf_carried_eta(eta.x, as_fitted.eta.x), hnbrdf_carried_eta(eta.y, as_fitted.eta.y),
                      hnbrdf_carried_eta(eta.z, as_fitted.eta.z));
    vec3 kd_carried = vec3(hnbrdf_carried_kd(kd.x, as_fitted.kd.x), hnbrdf_carried_kd(kd.y, as_fitted.kd.y),
                           hnbrdf_carried_kd(kd.z, as_fitted.kd.z));
    vec3 kd_added = vec3(hnbrdf_added_kd(kd.x, as_fitted.kd.x), hnbrdf_added_kd(kd.y, as_fitted.kd.y),
                         hnbrdf_added_kd(kd.z, as_fitted.kd.z));
    edit_out.warp_by = vec2(hnbrdf_warp_factor(alpha.x, as_fitted.alpha.x),
                            hnbrdf_warp_factor(alpha.y, as_fitted.alpha.y));
    edit_out.alpha = as_fitted.alpha;
    edit_out.area_fitted = hnbrdf_ggx_area(as_fitted.alpha);
    edit_out.kd_fitted = as_fitted.kd * HNBRDF_INV_PI;
    edit_out.e_fitted = hnbrdf_fresnel_e(eta_0);
    edit_out.kd_carried = kd_carried * HNBRDF_INV_PI;
    edit_out.kd_added = kd_added * HNBRDF_INV_PI;
    return edit_out;
}

// How much of f_a, carried + specular, is specular, over the channels: in [0, 1].
float hnbrdf_specular_part(vec3 f_specular, vec3 kd_carried)
{
    HNBRDF_PRECISE float sum_specular = (f_specular.x + f_specular.y) + f_specular.z;
    HNBRDF_PRECISE float sum_diffuse = (kd_carried.x + kd_carried.y) + kd_carried.z;
    HNBRDF_PRECISE float part_specular = sum_specular / (sum_specular + sum_diffuse);
    return hnbrdf_clamp(part_specular, 0.0, 1.0);
}

// s' of the same length as s, its tangents times those of `warp`. It comes no nearer to the horizon than s is, or
// than 45 degrees where s is higher.
vec3 hnbrdf_warp(hnbrdf_pair p, vec2 warp_by)
{
    HNBRDF_PRECISE float r_2 = p.s.x * p.s.x + p.s.y * p.s.y;
    HNBRDF_PRECISE float z_2 = p.s.z * p.s.z;
    float most_2 = r_2 > z_2 ? r_2 : z_2;
    HNBRDF_PRECISE vec2 w = p.s.xy * warp_by;
    HNBRDF_PRECISE float w_2 = w.x * w.x + w.y * w.y;
    HNBRDF_PRECISE float shrink_by = sqrt(w_2 > most_2 ? most_2 / w_2 : 1.0);
    w = w * shrink_by;
    HNBRDF_PRECISE float length_2 = hnbrdf_dot3(vec3(w, p.s.z));
    HNBRDF_PRECISE float stretch_by = sqrt(length_2 != p.length_2 ? p.length_2 / length_2 : 1.0);
    HNBRDF_PRECISE vec3 value_out = vec3(w, p.s.z) * stretch_by;
    return value_out;
}

// The pair of s', its directions as they are. warp: the factors where all of f_a is specular.
hnbrdf_pair hnbrdf_warped(hnbrdf_pair p, vec2 warp_by, float part_specular)
{
    HNBRDF_PRECISE vec2 warp_part = 1.0 + part_specular * (warp_by - 1.0);
    p.s = hnbrdf_warp(p, warp_part);
    return p;
}

// Both directions turned with s to s', the shortest way. Where s' is s, both stay as they are.
hnbrdf_pair hnbrdf_turn_pair(hnbrdf_pair p, hnbrdf_pair q)
{
    HNBRDF_PRECISE vec3 d_pair = p.wi - p.wo;
    HNBRDF_PRECISE float along_s = (d_pair.x * p.s.x + d_pair.y * p.s.y) + d_pair.z * p.s.z;
    HNBRDF_PRECISE float along_q = (d_pair.x * q.s.x + d_pair.y * q.s.y) + d_pair.z * q.s.z;
    HNBRDF_PRECISE float both_s = p.length_2 + ((p.s.x * q.s.x + p.s.y * q.s.y) + p.s.z * q.s.z);
    HNBRDF_PRECISE float k_both = (along_s + along_q) / both_s;
    HNBRDF_PRECISE float k_along = (2.0 * along_s) / p.length_2;
    HNBRDF_PRECISE vec3 d_turned = (d_pair - k_both * (p.s + q.s)) + k_along * q.s;
    if (q.s == p.s)
        return q;
    HNBRDF_PRECISE vec3 wi_turned = 0.5 * (q.s + d_turned);
    HNBRDF_PRECISE vec3 wo_turned = 0.5 * (q.s - d_turned);
    q.wi = wi_turned;
    q.wo = wo_turned;
    return q;
}

// A cosine of incidence that an edit lowers comes no lower than this, or stays where it is below: a network has seen few
// pairs beyond.
#define HNBRDF_LOWEST_SEEN 0.1
#define HNBRDF_MOST_INCLINED 1e8

// How far it stays above.
float hnbrdf_cosine_held(float cos_now, float cos_moved)
{
    float cos_least = cos_now < HNBRDF_LOWEST_SEEN ? cos_now : HNBRDF_LOWEST_SEEN;
    HNBRDF_PRECISE float cos_below = cos_least - cos_moved;
    return cos_below > 0.0 ? cos_below : 0.0;
}

// For encodings by angles: the cosines of incidence go with s. Their sum is s.z, and their difference goes with the sine
// of its angle, as if the pair were turned. What is left of wi - wo is laid along x, so that its length, and the
// difference angle, stay. Where s does not move, nothing does.
hnbrdf_pair hnbrdf_incline_pair(hnbrdf_pair p, hnbrdf_pair q)
{
    HNBRDF_PRECISE float r_2 = p.s.x * p.s.x + p.s.y * p.s.y;
    HNBRDF_PRECISE float q_2 = q.s.x * q.s.x + q.s.y * q.s.y;
    HNBRDF_PRECISE float sin_ratio = sqrt(hnbrdf_clamp(q_2 != r_2 ? q_2 / r_2 : 1.0, 0.0, HNBRDF_MOST_INCLINED));
    HNBRDF_PRECISE float sin_more = sin_ratio - 1.0;
    HNBRDF_PRECISE float z_sum = q.s.z - p.s.z;
    HNBRDF_PRECISE vec3 d_pair = p.wi - p.wo;
    HNBRDF_PRECISE float z_difference = sin_more * d_pair.z;
    HNBRDF_PRECISE float z_i = p.wi.z + 0.5 * (z_sum + z_difference);
    HNBRDF_PRECISE float z_o = p.wo.z + 0.5 * (z_sum - z_difference);
    HNBRDF_PRECISE float held_i = hnbrdf_cosine_held(p.wi.z, z_i);
    HNBRDF_PRECISE float held_o = hnbrdf_cosine_held(p.wo.z, z_o);
    HNBRDF_PRECISE float z_held = held_i - held_o;
    HNBRDF_PRECISE float x_2 = (d_pair.x * d_pair.x + d_pair.y * d_pair.y) -
                               (d_pair.z * d_pair.z) * (sin_more * (1.0 + sin_ratio));
    HNBRDF_PRECISE float x_2_held = x_2 - z_held * (2.0 * sin_ratio * d_pair.z + z_held);
    HNBRDF_PRECISE float x_half = 0.5 * sqrt(x_2_held > 0.0 ? x_2_held : 0.0);
    HNBRDF_PRECISE float z_i_held = z_i + held_i;
    HNBRDF_PRECISE float z_o_held = z_o + held_o;
    if (sin_more != 0.0 || z_sum != 0.0) {
        q.wi = vec3(x_half, 0.0, z_i_held);
        q.wo = vec3(-x_half, 0.0, z_o_held);
    }
    return q;
}

// For an encoding that sees the azimuth of wi - wo: what is left of wi - wo is laid along that instead.
hnbrdf_pair hnbrdf_incline_along(hnbrdf_pair p, hnbrdf_pair q)
{
    hnbrdf_pair inclined_pair = hnbrdf_incline_pair(p, q);
    HNBRDF_PRECISE vec3 d_pair = p.wi - p.wo;
    HNBRDF_PRECISE vec3 d_inclined = inclined_pair.wi - inclined_pair.wo;
    HNBRDF_PRECISE float d_2 = d_pair.x * d_pair.x + d_pair.y * d_pair.y;
    HNBRDF_PRECISE float q_2 = d_inclined.x * d_inclined.x + d_inclined.y * d_inclined.y;
    HNBRDF_PRECISE float k_half = 0.5 * sqrt(d_2 > 0.0 ? q_2 / d_2 : 1.0);
    HNBRDF_PRECISE float x_half = k_half * d_pair.x;
    HNBRDF_PRECISE float y_half = k_half * d_pair.y;
    inclined_pair.wi = vec3(x_half, y_half, inclined_pair.wi.z);
    inclined_pair.wo = vec3(-x_half, -y_half, inclined_pair.wo.z);
    return inclined_pair;
}

// f_a of the edited material, and of the fitted one at s' with masking at the directions as they are.
vec3 hnbrdf_microfacet_fitted(hnbrdf_pair p, hnbrdf_pair pair_seen, hnbrdf_edit edit_in)
{
    HNBRDF_PRECISE float d_v_v = hnbrdf_ggx_d_of_area(pair_seen.s, p.length_2, edit_in.alpha, edit_in.area_fitted) *
                                 (hnbrdf_smith_v(p.wi, edit_in.alpha) * hnbrdf_smith_v(p.wo, edit_in.alpha));
    HNBRDF_PRECISE vec3 value_out = hnbrdf_microfacet_of(edit_in.kd_fitted, edit_in.e_fitted, p.cos_d, d_v_v);
    return value_out;
}

// f_a of the edited material over that of the fitted one, in [0, HNBRDF_MAX_VALUE].
float hnbrdf_carried_ratio(float f_edited, float f_fitted)
{
    HNBRDF_PRECISE float f_ratio = f_edited / f_fitted;
    return f_edited != f_fitted ? hnbrdf_clamp(f_ratio, 0.0, HNBRDF_MAX_VALUE) : 1.0;
}

// max(0, ratio (exp(s c + m) - b) + sigmoid(g) f_a + added). A ratio of 1 gives the bits of hnbrdf_compose_hybrid().
vec3 hnbrdf_compose_edited(vec3 exp_arg, vec3 g, vec3 f_edited, vec3 f_fitted, vec3 f_added, float b)
{
    vec3 f_ratio = vec3(hnbrdf_carried_ratio(f_edited.x, f_fitted.x), hnbrdf_carried_ratio(f_edited.y, f_fitted.y),
                        hnbrdf_carried_ratio(f_edited.z, f_fitted.z));
    vec3 f_network = hnbrdf_correction(exp_arg);
    HNBRDF_PRECISE vec3 f_gated = hnbrdf_gate(g) * f_edited;
    HNBRDF_PRECISE vec3 f_carried = f_ratio * (f_network - b) + f_gated;
    HNBRDF_PRECISE vec3 f_plain = (f_network + f_gated) - b;
    HNBRDF_PRECISE vec3 f_sum = vec3(f_ratio.x != 1.0 ? f_carried.x : f_plain.x,
                                     f_ratio.y != 1.0 ? f_carried.y : f_plain.y,
                                     f_ratio.z != 1.0 ? f_carried.z : f_plain.z) + f_added;
    return hnbrdf_finish(f_sum);
}

// ---- Sampling ------------------------------------------------------------------------------------------

// What hnbrdf_sample() of an exported scene returns.
struct hnbrdf_sample_result {
    vec3 wi;     // unit direction towards the light, wi.z > 0. (0, 0, 1) when pdf is 0
    float pdf;   // 1/sr. 0 means: no direction, weight is 0
    vec3 weight; // f wi.z / pdf
};

// The two GGX lobes of a material, beside the cosine lobe: of roughness |scale| alpha, with visible normals where
// the scale is positive, all normals where it is negative. Shares at wo.z = 0, 1/9, 4/9, 1. The rest is cosine.
struct hnbrdf_lobes {
    vec2 lobe_scale;
    vec4 share_0, share_1;
};

// Of a material without fitted lobes: one of roughness alpha, its share that of the reflectance at normal
// incidence, raised a little for what Fresnel adds towards grazing, against the diffuse albedo.
hnbrdf_lobes hnbrdf_lobes_guess(vec3 kd, vec3 eta)
{
    HNBRDF_PRECISE vec3 r = (eta - 1.0) / (eta + 1.0);
    HNBRDF_PRECISE vec3 r_2 = r * r * 0.333333333;
    HNBRDF_PRECISE vec3 kd_3 = kd * 0.333333333;
    HNBRDF_PRECISE float sum_r = ((0.05 + r_2.x) + r_2.y) + r_2.z;
    HNBRDF_PRECISE float sum_kd = (kd_3.x + kd_3.y) + kd_3.z;
    HNBRDF_PRECISE float lobe_share = sum_r / (sum_r + sum_kd);
    lobe_share = hnbrdf_clamp(lobe_share, 0.2, 0.9);
    return hnbrdf_lobes(vec2(1.0, 0.0), vec4(lobe_share), vec4(0.0));
}

// Shares in [0, share_most].
vec4 hnbrdf_clamp_shares(vec4 share_in, vec4 share_most)
{
    return vec4(hnbrdf_clamp(share_in.x, 0.0, share_most.x), hnbrdf_clamp(share_in.y, 0.0, share_most.y),
                hnbrdf_clamp(share_in.z, 0.0, share_most.z), hnbrdf_clamp(share_in.w, 0.0, share_most.w));
}

vec2 hnbrdf_lobe_alpha(float lobe_scale, vec2 alpha)
{
    HNBRDF_PRECISE vec2 a = abs(lobe_scale) * alpha;
    return vec2(hnbrdf_clamp(a.x, 1e-4, 1.0), hnbrdf_clamp(a.y, 1e-4, 1.0));
}

// Shares at this view, piecewise linear in sqrt(z): each knot weighs in by its distance.
vec2 hnbrdf_lobe_shares(hnbrdf_lobes ggx_lobes, float z)
{
    HNBRDF_PRECISE float x = hnbrdf_clamp(3.0 * sqrt(z), 0.0, 3.0);
    HNBRDF_PRECISE vec4 knot_hat = clamp(1.0 - abs(x - vec4(0.0, 1.0, 2.0, 3.0)), 0.0, 1.0);
    HNBRDF_PRECISE vec4 s_0 = knot_hat * ggx_lobes.share_0;
    HNBRDF_PRECISE vec4 s_1 = knot_hat * ggx_lobes.share_1;
    HNBRDF_PRECISE vec2 value_out = vec2(((s_0.x + s_0.y) + s_0.z) + s_0.w, ((s_1.x + s_1.y) + s_1.z) + s_1.w);
    return value_out;
}

// Visible normals of w, D V(w)/2 of which is their density as reflections (Heitz 2018 Eq. 17): V(w), the cap of
// normals cut off where all reflections go below the horizon (Eto and Tokuyoshi 2023).
float hnbrdf_cap_bound(vec3 w, vec2 alpha)
{
    float a = alpha.x < alpha.y ? alpha.x : alpha.y;
    HNBRDF_PRECISE float a_2 = a * a;
    HNBRDF_PRECISE float s = 1.0 + sqrt(w.x * w.x + w.y * w.y);
    HNBRDF_PRECISE float s_2 = s * s;
    HNBRDF_PRECISE float value_out = ((1.0 - a_2) * s_2) / (s_2 + a_2 * (w.z * w.z));
    return value_out;
}

float hnbrdf_visible_v(vec3 w, vec2 alpha)
{
    HNBRDF_PRECISE float value_out = 1.0 / (hnbrdf_cap_bound(w, alpha) * w.z +
                                            sqrt(hnbrdf_dot3(vec3(alpha * w.xy, w.z))));
    return value_out;
}

// Of reflections about visible normals D V(wo)/2, about all normals D h.n / (4 wo.h).
float hnbrdf_lobe_density(hnbrdf_pair p, float lobe_scale, vec2 alpha)
{
    vec2 a = hnbrdf_lobe_alpha(lobe_scale, alpha);
    HNBRDF_PRECISE float d_ggx = hnbrdf_ggx_d(p.s, p.length_2, a);
    HNBRDF_PRECISE float v_ggx = lobe_scale < 0.0 ? p.s.z / p.length_2 : hnbrdf_visible_v(p.wo, a);
    HNBRDF_PRECISE float value_out = d_ggx * (0.5 * v_ggx);
    return value_out;
}

// The one density that sample and pdf share. Directions in the tangent frame, both above the horizon.
float hnbrdf_density(vec2 alpha, hnbrdf_lobes ggx_lobes, vec3 wi, vec3 wo)
{
    hnbrdf_pair p = hnbrdf_pair_make(wi, wo);
    vec2 lobe_share = hnbrdf_lobe_shares(ggx_lobes, wo.z);
    HNBRDF_PRECISE float pdf = 0.0;
    if (lobe_share.x > 0.0)
        pdf = pdf + lobe_share.x * hnbrdf_lobe_density(p, ggx_lobes.lobe_scale.x, alpha);
    if (lobe_share.y > 0.0)
        pdf = pdf + lobe_share.y * hnbrdf_lobe_density(p, ggx_lobes.lobe_scale.y, alpha);
    HNBRDF_PRECISE float share_rest = hnbrdf_clamp(1.0 - (lobe_share.x + lobe_share.y), 0.0, 1.0);
    pdf = pdf + share_rest * (wi.z * HNBRDF_INV_PI);
    return hnbrdf_clamp(pdf, 0.0, HNBRDF_MAX_VALUE);
}

// Cosine-distributed direction. u.y < 1 keeps z above 0.
vec3 hnbrdf_draw_cosine(vec2 u_rand)
{
    HNBRDF_PRECISE vec2 sin_cos = hnbrdf_sincos_turn(u_rand.x);
    HNBRDF_PRECISE float r = sqrt(u_rand.y);
    HNBRDF_PRECISE vec3 value_out = vec3(r * sin_cos.y, r * sin_cos.x, sqrt(1.0 - u_rand.y));
    return value_out;
}

// A visible normal, not normalised: a point of a spherical cap (Dupuy and Benyoub 2023, Listing 3) above its
// bound, stretched. (0, 0, 0) where there is none.
vec3 hnbrdf_draw_visible(vec2 alpha, vec3 wo, vec2 u_rand)
{
    HNBRDF_PRECISE vec3 w = vec3(alpha * wo.xy, wo.z);
    HNBRDF_PRECISE float w_length = sqrt(hnbrdf_dot3(w));
    if (!(w_length > 0.0))
        return vec3(0.0);
    w = w / w_length;
    HNBRDF_PRECISE vec2 sin_cos = hnbrdf_sincos_turn(u_rand.x);
    HNBRDF_PRECISE float cap_low = hnbrdf_cap_bound(wo, alpha) * w.z;
    HNBRDF_PRECISE float cap_z = (1.0 - u_rand.y) * (1.0 + cap_low) - cap_low;
    HNBRDF_PRECISE float cap_radius = sqrt(hnbrdf_clamp(1.0 - cap_z * cap_z, 0.0, 1.0));
    HNBRDF_PRECISE vec3 value_out = vec3(alpha * (cap_radius * sin_cos.yx + w.xy), cap_z + w.z);
    return value_out;
}

// Any normal, with density D h.n: slopes tan^2 = u / (1 - u) (Walter 2007 Eqs. 35 and 36), not normalised.
vec3 hnbrdf_draw_normal(vec2 alpha, vec2 u_rand)
{
    HNBRDF_PRECISE vec2 sin_cos = hnbrdf_sincos_turn(u_rand.x);
    HNBRDF_PRECISE float r = sqrt(u_rand.y);
    HNBRDF_PRECISE vec3 value_out = vec3(alpha * (r * sin_cos.yx), sqrt(1.0 - u_rand.y));
    return value_out;
}

// Reflects wo about a normal of one lobe. (0, 0, 0) if no normal comes out.
vec3 hnbrdf_draw_lobe(float lobe_scale, vec2 alpha, vec3 wo, vec2 u_rand)
{
    vec2 a = hnbrdf_lobe_alpha(lobe_scale, alpha);
    vec3 half_v = lobe_scale < 0.0 ? hnbrdf_draw_normal(a, u_rand) : hnbrdf_draw_visible(a, wo, u_rand);
    HNBRDF_PRECISE float h_2 = hnbrdf_dot3(half_v);
    if (!(h_2 > 0.0))
        return vec3(0.0);
    HNBRDF_PRECISE float k_h = 2.0 * (((wo.x * half_v.x + wo.y * half_v.y) + wo.z * half_v.z) / h_2);
    HNBRDF_PRECISE vec3 value_out = k_h * half_v - wo;
    return value_out;
}

// What is left of u0 once it has chosen its part [low, low + size) of [0, 1), as an azimuth: a pair (u0, u1) that is
// stratified stays so in each lobe.
float hnbrdf_azimuth(float u_0, float part_low, float part_size)
{
    HNBRDF_PRECISE float u_within = (u_0 - part_low) / part_size;
    return hnbrdf_clamp(u_within, 0.0, 0.99999994);
}

// The lobe that u.x falls to, or cosine. NaN counts as 0. One return: FXC warns of two around calls that return early.
vec3 hnbrdf_draw(vec2 alpha, hnbrdf_lobes ggx_lobes, vec3 wo, vec2 u_rand)
{
    vec2 lobe_share = hnbrdf_lobe_shares(ggx_lobes, wo.z);
    HNBRDF_PRECISE float share_both = lobe_share.x + lobe_share.y;
    float u_0 = hnbrdf_clamp(u_rand.x, 0.0, 0.99999994), u_1 = hnbrdf_clamp(u_rand.y, 0.0, 0.99999994);
    vec3 wi_drawn;
    if (u_0 < share_both) {
        bool is_first = u_0 < lobe_share.x;
        float u_turn = is_first ? hnbrdf_azimuth(u_0, 0.0, lobe_share.x)
                                : hnbrdf_azimuth(u_0, lobe_share.x, lobe_share.y);
        float scale_drawn = is_first ? ggx_lobes.lobe_scale.x : ggx_lobes.lobe_scale.y;
        wi_drawn = hnbrdf_draw_lobe(scale_drawn, alpha, wo, vec2(u_turn, u_1));
    } else {
        HNBRDF_PRECISE float share_rest = 1.0 - share_both;
        wi_drawn = hnbrdf_draw_cosine(vec2(hnbrdf_azimuth(u_0, share_both, share_rest), u_1));
    }
    return wi_drawn;
}

// ---- World space ---------------------------------------------------------------------------------------

// The frame of a surface, right-handed, of unit vectors at right angles: x along the tangent, z along the normal.
struct hnbrdf_world_frame {
    vec3 x_axis, y_axis, z_axis;
};

vec3 hnbrdf_cross(vec3 a, vec3 b)
{
    HNBRDF_PRECISE vec3 value_out = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return value_out;
}

// w of length 1, or instead_of where it has no direction: 0, not finite. Scaled first, so that no square overflows or
// vanishes. Never divided by 0: of a constant 0, as for no tangent, a compiler would see and warn (FXC, X4008).
vec3 hnbrdf_unit(vec3 w, vec3 instead_of)
{
    float r = max(max(abs(w.x), abs(w.y)), abs(w.z));
    HNBRDF_PRECISE vec3 w_scaled = w / (r > 0.0 ? r : 1.0);
    float length_2 = hnbrdf_dot3(w_scaled);
    bool is_unit = length_2 > 0.5; // at least 1, but for roundings
    HNBRDF_PRECISE vec3 value_out = w_scaled / sqrt(is_unit ? length_2 : 1.0);
    return is_unit ? value_out : instead_of;
}

// From a normal and a tangent as they come from a mesh, interpolated or not: of any length, at any angle. A tangent
// without a direction, or along the normal, is replaced by some other one.
hnbrdf_world_frame hnbrdf_world_frame_make(vec3 n_world, vec3 t_world)
{
    hnbrdf_world_frame frame_out;
    frame_out.z_axis = hnbrdf_unit(n_world, vec3(0.0, 0.0, 1.0));
    vec3 t_other = abs(frame_out.z_axis.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 y_wanted = hnbrdf_cross(frame_out.z_axis, hnbrdf_unit(t_world, t_other));
    if (!(hnbrdf_dot3(y_wanted) > 1e-6)) // within 1e-3 of the normal
        y_wanted = hnbrdf_cross(frame_out.z_axis, t_other);
    y_wanted = hnbrdf_unit(y_wanted, vec3(0.0, 1.0, 0.0));
    frame_out.x_axis = hnbrdf_unit(hnbrdf_cross(y_wanted, frame_out.z_axis), t_other);
    frame_out.y_axis = hnbrdf_cross(frame_out.z_axis, frame_out.x_axis); // at a right angle to the last digit
    return frame_out;
}

// A direction of the world in the frame of the surface, as hnbrdf_eval() wants it.
vec3 hnbrdf_to_frame(hnbrdf_world_frame frame_in, vec3 w)
{
    return vec3(hnbrdf_dot3(w, frame_in.x_axis), hnbrdf_dot3(w, frame_in.y_axis), hnbrdf_dot3(w, frame_in.z_axis));
}

vec3 hnbrdf_to_frame(vec3 n_world, vec3 t_world, vec3 w)
{
    return hnbrdf_to_frame(hnbrdf_world_frame_make(n_world, t_world), w);
}

// And back.
vec3 hnbrdf_from_frame(hnbrdf_world_frame frame_in, vec3 w)
{
    HNBRDF_PRECISE vec3 value_out = (w.x * frame_in.x_axis + w.y * frame_in.y_axis) + w.z * frame_in.z_axis;
    return value_out;
}

vec3 hnbrdf_from_frame(vec3 n_world, vec3 t_world, vec3 w)
{
    return hnbrdf_from_frame(hnbrdf_world_frame_make(n_world, t_world), w);
}

#endif
