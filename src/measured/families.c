/* families.c: the families themselves, out of the terms of the built-in materials. */
#include "measured/families.h"

#include "base/error.h"
#include "measured/builtin_terms.h"

#include <stdlib.h>

/* ---- One member ------------------------------------------------------------------------------ */

typedef struct member {
    void (*eval)(const struct member *m, const pair *p, double f[3]);
    hnbrdf_family_parameters at;
    film_table film; /* all 0 where the family has none */
} member;

/* A lobe of `width` times the member's roughness. */
static double lobe_alpha(const member *m, int axis, double width)
{
    return fmin(width * m->at.alpha[axis], 1.0);
}

static double ggx_lobe(const member *m, const pair *p, double width)
{
    return ggx(p, lobe_alpha(m, 0, width), lobe_alpha(m, 1, width));
}

/* A metal or a film whose colour is changed: Schlick's blend, so that the factor fades towards
 * grazing, where every surface is a mirror. */
static double tinted(double fresnel, double factor, double c)
{
    return fresnel * schlick(factor, c);
}

static void add_metal(const member *m, const pair *p, double lobe, const double n[3],
                      const double k[3], double f[3])
{
    for (int c = 0; c < 3; c++)
        f[c] += lobe * tinted(fresnel_conductor(n[c], k[c], p->c), m->at.reflectance[c], p->c);
}

/* A dielectric surface that reflects r0 at normal incidence, times the member's factor. */
static void add_dielectric(const member *m, const pair *p, double lobe, double r0, double f[3])
{
    for (int c = 0; c < 3; c++) {
        double r = sqrt(r0 * m->at.reflectance[c]);
        f[c] += lobe * fresnel_dielectric((1.0 + r) / (1.0 - r), p->c);
    }
}

/* Of index 1.5 before any edit. */
static void add_surface(const member *m, const pair *p, double lobe, double f[3])
{
    add_dielectric(m, p, lobe, square((COAT_ETA - 1.0) / (COAT_ETA + 1.0)), f);
}

/* albedo times `through`, what an even layer above lets pass. */
static void add_diffuse(const member *m, double through, const double albedo[3], double f[3])
{
    for (int c = 0; c < 3; c++)
        f[c] += through * m->at.diffuse[c] * albedo[c] / PI;
}

/* ---- Conductors ------------------------------------------------------------------------------ */

/* Worn gold leaf: two roughnesses side by side. */
static void two_lobe(const member *m, const pair *p, double f[3])
{
    add_metal(m, p, 0.5 * ggx_lobe(m, p, 1.0) + 0.5 * ggx_lobe(m, p, 3.0), GOLD_N, GOLD_K, f);
}

/* Sand-blasted aluminium: no tail at all. What is scattered by several facets in turn, which
 * microfacet models leave out, comes back from everywhere: a few percent, without which values a
 * little off the highlight would be below any measurement's noise. */
static void beckmann_metal(const member *m, const pair *p, double f[3])
{
    static const double scattered = 0.03;
    double lobe = (1.0 - scattered) * beckmann(p, m->at.alpha[0], m->at.alpha[1]);
    add_metal(m, p, lobe, ALUMINIUM_N, ALUMINIUM_K, f);
    for (int c = 0; c < 3; c++)
        f[c] += scattered / PI * m->at.reflectance[c] *
                fresnel_conductor(ALUMINIUM_N[c], ALUMINIUM_K[c], 1.0);
}

/* Polished copper: a tail longer than that of GGX. */
static void long_tailed_metal(const member *m, const pair *p, double f[3])
{
    add_metal(m, p, long_tail(p, m->at.alpha[0], m->at.alpha[1]), COPPER_N, COPPER_K, f);
}

/* A sharp lobe on a wide skirt (Barla, Pacanowski and Vangorp 2018). */
static void haze(const member *m, const pair *p, double f[3])
{
    double lobe = 0.6 * ggx_lobe(m, p, 1.0) + 0.4 * ggx_lobe(m, p, 6.0);
    add_metal(m, p, lobe, CHROMIUM_N, CHROMIUM_K, f);
}

/* A clear film on iron, from violet to orange with the angle, all inside the gamut. */
static const film_stack CLEAR_FILM = {1.0, 1.8, 220.0, 2.9, 3.3, 1};

/* With a long tail. */
static void film(const member *m, const pair *p, double f[3])
{
    double colour[3], lobe = long_tail(p, m->at.alpha[0], m->at.alpha[1]);
    hnbrdf_film_reflectance(&m->film, p->c, colour);
    for (int c = 0; c < 3; c++)
        f[c] += lobe * tinted(colour[c], m->at.reflectance[c], p->c);
}

/* Brushed iron: a fine grain within coarser, shallower scratches. */
static void brushed(const member *m, const pair *p, double f[3])
{
    double lobe = 0.55 * ggx_lobe(m, p, 1.0) + 0.45 * ggx_lobe(m, p, 2.5);
    add_metal(m, p, lobe, IRON_N, IRON_K, f);
}

/* ---- Dielectrics ----------------------------------------------------------------------------- */

/* Pigment under a glossy surface. */
static void plastic(const member *m, const pair *p, double f[3])
{
    static const double albedo[3] = {0.05, 0.34, 0.09};
    add_surface(m, p, ggx_lobe(m, p, 1.0), f);
    for (int c = 0; c < 3; c++)
        f[c] += m->at.diffuse[c] * diffuse_under_coat(p, albedo[c]);
}

/* A glossy coat over rough coloured flakes (Weidlich and Wilkie 2007). The flakes are part of what
 * the eye takes for the reflection, so they take its factor too. */
static void coated(const member *m, const pair *p, double f[3])
{
    static const double flakes[3] = {0.46, 0.12, 0.06};
    pair inside = refracted_pair(p, COAT_ETA);
    double base = coat_transmission(p) / square(COAT_ETA) * ggx_lobe(m, &inside, 1.5);
    add_surface(m, p, ggx_lobe(m, p, 0.4), f);
    for (int c = 0; c < 3; c++)
        f[c] += base * m->at.reflectance[c] * flakes[c];
}

/* Fibres standing up on a dark ground. Estevez and Kulla's lobe gains energy at grazing as
 * 1/sqrt(roughness); straighter fibres than those of 0.2 are thinner instead. */
static void sheen(const member *m, const pair *p, double f[3])
{
    static const double fibres[3] = {0.55, 0.22, 0.34}, ground[3] = {0.16, 0.03, 0.06};
    double roughness = lobe_alpha(m, 0, 2.5);
    double lobe = charlie_sheen(p, roughness) * fmin(sqrt(roughness / 0.2), 1.0);
    for (int c = 0; c < 3; c++)
        f[c] += lobe * fibres[c];
    add_diffuse(m, 1.0, ground, f);
}

/* A cosine lobe that peaks nearer to the horizon than the mirror direction (Lafortune et al. 1997),
 * by a share of its own width, as in Torrance and Sparrow 1967. Divided by what bending does to
 * the lengths of wi and wo, so that its peak is about the same at all angles. */
static double bent_lobe(const pair *p, double alpha)
{
    double bend = 1.0 - 0.7 * alpha, exponent = 1.0 / (2.0 * square(alpha));
    double mirrored = p->wi[0] * p->wo[0] + p->wi[1] * p->wo[1];
    double li = 1.0 - (1.0 - square(bend)) * square(p->wi[2]);
    double lo = 1.0 - (1.0 - square(bend)) * square(p->wo[2]);
    double cosine = (bend * (p->wi[2] * p->wo[2]) - mirrored) / sqrt(sqrt(li * lo));
    return cosine > 0.0 ? (exponent + 2.0) / (2.0 * PI) * pow(fmin(cosine, 1.0), exponent) : 0.0;
}

/* Coated cardboard. */
static void off_specular(const member *m, const pair *p, double f[3])
{
    static const double fibre[3] = {0.36, 0.24, 0.14};
    add_dielectric(m, p, bent_lobe(p, m->at.alpha[0]), 0.12, f);
    add_diffuse(m, 1.0, fibre, f);
}

/* Glass beads below a plastic film (Belcour et al. 2014). */
static void retro(const member *m, const pair *p, double f[3])
{
    static const double beads[3] = {0.45, 0.40, 0.28}, body[3] = {0.17, 0.16, 0.13};
    pair back = retro_pair(p);
    double through = coat_transmission(p), lobe = through * ggx_lobe(m, &back, 0.6);
    add_surface(m, p, ggx_lobe(m, p, 1.0), f);
    for (int c = 0; c < 3; c++)
        f[c] += lobe * beads[c];
    add_diffuse(m, through, body, f);
}

/* ---- The table ------------------------------------------------------------------------------- */

typedef struct family {
    const char *name, *about;
    int has;
    const film_stack *film;
    void (*eval)(const member *m, const pair *p, double f[3]);
} family;

enum {
    ETA = HNBRDF_FAMILY_ETA,
    TINT = HNBRDF_FAMILY_TINT,
    DIFFUSE = HNBRDF_FAMILY_DIFFUSE,
    STRETCH = HNBRDF_FAMILY_STRETCH,
    BRUSHED = HNBRDF_FAMILY_BRUSHED
};

static const family families[] = {
    {"two-lobe", "gold with two roughnesses", TINT | STRETCH, NULL, two_lobe},
    {"beckmann", "aluminium without a tail", TINT | STRETCH, NULL, beckmann_metal},
    {"long-tail", "copper with a long tail", TINT | STRETCH, NULL, long_tailed_metal},
    {"haze", "chromium, sharp on a wide skirt", TINT | STRETCH, NULL, haze},
    {"film", "interference, long tail", TINT | STRETCH, &CLEAR_FILM, film},
    {"plastic", "glossy surface over pigment", ETA | DIFFUSE | STRETCH, NULL, plastic},
    {"coated", "coat over rough flakes", ETA | STRETCH, NULL, coated},
    {"sheen", "fibres over a ground", DIFFUSE, NULL, sheen},
    {"off-specular", "lobe bent to the horizon over diffuse", ETA | DIFFUSE, NULL, off_specular},
    {"retro", "beads below a film", ETA | DIFFUSE | STRETCH, NULL, retro},
    {"brushed", "iron, two stretched lobes", TINT | STRETCH | BRUSHED, NULL, brushed},
};
enum { FAMILIES = sizeof families / sizeof families[0] };

/* alpha_y over alpha_x of a brushed member, and its rotation. */
static const double brushed_stretch = 4.0, brushed_rotation = PI / 6;

const char *hnbrdf_family_name(int index)
{
    return index >= 0 && index < FAMILIES ? families[index].name : NULL;
}

const char *hnbrdf_family_about(int index)
{
    return families[index].about;
}

int hnbrdf_family_has(int index)
{
    return families[index].has;
}

void hnbrdf_family_member(int index, double alpha, hnbrdf_family_parameters *parameters)
{
    *parameters = (hnbrdf_family_parameters){
        .alpha = {alpha, alpha}, .reflectance = {1.0, 1.0, 1.0}, .diffuse = {1.0, 1.0, 1.0}};
    if (families[index].has & BRUSHED) {
        parameters->alpha[0] = alpha / sqrt(brushed_stretch);
        parameters->alpha[1] = alpha * sqrt(brushed_stretch);
        parameters->rotation = brushed_rotation;
    }
}

/* ---- Opening --------------------------------------------------------------------------------- */

static int member_eval(const void *user, const float wi[3], const float wo[3], float f[3])
{
    const member *m = user;
    double i[3], o[3], value[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 3; k++) {
        i[k] = (double)wi[k];
        o[k] = (double)wo[k];
    }
    pair p = make_pair(i, o);
    if (m->at.rotation != 0.0)
        p = turned_pair(&p, m->at.rotation);
    m->eval(m, &p, value);
    for (int c = 0; c < 3; c++)
        f[c] = (float)value[c];
    return 1;
}

static hnbrdf_result check_range(const char *name, const char *what, double value, double low,
                                 double high, hnbrdf_error *error)
{
    if (value >= low && value <= high)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s: %s is %s, expected from %s to %s", name,
                       what, HNBRDF_NUMBER(value), HNBRDF_NUMBER(low), HNBRDF_NUMBER(high));
}

static hnbrdf_result check(const family *f, const hnbrdf_family_parameters *at, hnbrdf_error *error)
{
    static const char *const axes[2] = {"alpha_x", "alpha_y"};
    double least = 1.0, most = 1.0; /* of the factor on the reflectance */
    hnbrdf_result result = HNBRDF_OK;
    if (f->has & (ETA | TINT)) {
        least = 1e-3;
        most = f->has & ETA ? 2.0 : 1.0;
    }
    for (int k = 0; k < 2 && !result; k++)
        result = check_range(f->name, axes[k], at->alpha[k], (double)HNBRDF_MIN_ALPHA, 1.0, error);
    for (int c = 0; c < 3 && !result; c++)
        result = check_range(f->name, "the factor on the reflectance", at->reflectance[c], least,
                             most, error);
    for (int c = 0; c < 3 && !result; c++)
        result = f->has & DIFFUSE ? check_range(f->name, "the factor on the diffuse part",
                                                at->diffuse[c], 0.0, 1.5, error)
                                  : check_range(f->name, "the factor on the diffuse part",
                                                at->diffuse[c], 1.0, 1.0, error);
    if (!result && at->alpha[0] != at->alpha[1] && !(f->has & STRETCH))
        result = hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s: has one alpha, found two", f->name);
    return result || isfinite(at->rotation)
               ? result
               : hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s: its rotation is not finite",
                             f->name);
}

hnbrdf_result hnbrdf_family_open(int index, const hnbrdf_family_parameters *parameters,
                                 const char *name, hnbrdf_measured **measured, hnbrdf_error *error)
{
    const family *f = &families[index];
    hnbrdf_result result = check(f, parameters, error);
    if (result)
        return result;
    member *m = calloc(1, sizeof *m);
    if (!m)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", name);
    m->eval = f->eval;
    m->at = *parameters;
    if (f->film)
        hnbrdf_film_fill(&m->film, f->film);
    const hnbrdf_measured_custom custom = {.name = name,
                                           .summary = f->about,
                                           .isotropic =
                                               parameters->alpha[0] == parameters->alpha[1],
                                           .eval = member_eval,
                                           .release = free,
                                           .user = m};
    result = hnbrdf_measured_create_custom(&custom, measured, error);
    if (result)
        free(m);
    return result;
}
