/* builtin_materials.c: the built-in procedural materials: what measurements contain and Lambert
 * plus one GGX lobe cannot follow. f may be negative where a colour is outside the sRGB gamut;
 * measured.c clips it to 0, and so do the RGB editions of real measurements. */
#include "measured/builtin_terms.h"

/* Titania on mica in a coat; the oxide of titanium on the metal, in air. */
static const film_stack PEARL_FILM = {1.5, 2.4, 255.0, 1.58, 0.0, 4};
static const film_stack TITANIUM_FILM = {1.0, 2.4, 178.0, 2.7, 3.6, 1};

static void add(double f[3], double value, const double colour[3])
{
    for (int c = 0; c < 3; c++)
        f[c] += value * colour[c];
}

/* Schlick's Fresnel with colour f0 at normal incidence, times value. */
static void add_schlick(double f[3], double value, const double f0[3], double cosine)
{
    for (int c = 0; c < 3; c++)
        f[c] += value * schlick(f0[c], cosine);
}

static void add_grey(double f[3], double value)
{
    for (int c = 0; c < 3; c++)
        f[c] += value;
}

/* A smooth or glossy coat of index 1.5: its own reflection. */
static void add_coat(double f[3], const pair *p, double alpha)
{
    add_grey(f, fresnel_dielectric(COAT_ETA, p->c) * ggx(p, alpha, alpha));
}

static void metal(double f[3], const pair *p, double lobe, const double n[3], const double k[3])
{
    for (int c = 0; c < 3; c++)
        f[c] += lobe * fresnel_conductor(n[c], k[c], p->c);
}

/* ---- Metals ---------------------------------------------------------------------------------- */

/* Aluminium flakes at two depths of a blue binder, no coat: two lobes of different width and colour
 * (as fitted to car paints by Ngan et al. 2005 and Guenther et al. 2005), over a dark diffuse
 * base. */
static void metallic_paint_blue(const pair *p, double f[3])
{
    static const double near_top[3] = {0.36, 0.48, 0.66}, deep[3] = {0.02, 0.09, 0.42};
    static const double base[3] = {0.004, 0.016, 0.08};
    add_schlick(f, 0.25 * ggx(p, 0.11, 0.11), near_top, p->c);
    add_schlick(f, 0.55 * ggx(p, 0.38, 0.38), deep, p->c);
    add(f, 1.0 / PI, base);
}

/* Worn gold leaf: polished and matt places side by side, the metal's own Fresnel. */
static void gold_two_lobe(const pair *p, double f[3])
{
    metal(f, p, 0.5 * ggx(p, 0.09, 0.09) + 0.5 * ggx(p, 0.36, 0.36), GOLD_N, GOLD_K);
}

/* Haze of anodised aluminium: a sharp lobe on a wide skirt (Barla, Pacanowski and Vangorp 2018, A
 * Composite BRDF Model for Hazy Gloss). */
static void haze_aluminium(const pair *p, double f[3])
{
    metal(f, p, 0.6 * ggx(p, 0.03, 0.03) + 0.4 * ggx(p, 0.3, 0.3), ALUMINIUM_N, ALUMINIUM_K);
}

/* Brushed steel: scratches at 30 degrees to the tangent, a fine grain within coarser, shallower
 * ones (two elliptical lobes: Ward 1992; Heitz 2014). */
static void brushed_steel(const pair *p, double f[3])
{
    pair grain = turned_pair(p, PI / 6);
    metal(f, p, 0.55 * ggx(&grain, 0.05, 0.32) + 0.45 * ggx(&grain, 0.2, 0.6), IRON_N, IRON_K);
}

/* Nearly a mirror, with the faint glow around highlights that polishing leaves. */
static void near_mirror_chrome(const pair *p, double f[3])
{
    metal(f, p, 0.96 * ggx(p, 0.006, 0.006) + 0.04 * ggx(p, 0.07, 0.07), CHROMIUM_N, CHROMIUM_K);
}

/* Anodised titanium: an oxide film on the metal; the colour runs through the spectrum with the
 * angle and leaves the gamut on the way. */
static void anodised_titanium(const pair *p, double f[3])
{
    double colour[3];
    hnbrdf_film_reflectance(p->film, p->c, colour);
    add(f, 0.7 * ggx(p, 0.16, 0.16) + 0.3 * ggx(p, 0.4, 0.4), colour);
}

/* ---- Under a coat ---------------------------------------------------------------------------- */

/* Red lacquer: a sharp coat over a saturated diffuse base, whose green lies outside the gamut. */
static void clear_coat_red(const pair *p, double f[3])
{
    static const double albedo[3] = {0.62, -0.012, 0.018};
    add_coat(f, p, 0.02);
    for (int c = 0; c < 3; c++)
        f[c] += diffuse_under_coat(p, albedo[c]);
}

/* Injection-moulded plastic: a glossy surface over a diffuse base of pigment; red outside the
 * gamut. */
static void glossy_plastic_green(const pair *p, double f[3])
{
    static const double albedo[3] = {-0.02, 0.34, 0.09};
    add_coat(f, p, 0.12);
    for (int c = 0; c < 3; c++)
        f[c] += diffuse_under_coat(p, albedo[c]);
}

/* Candy paint: metal flakes below a dyed clear coat. Light crosses the dye twice along slanted
 * paths, so the colour deepens towards grazing (Weidlich and Wilkie 2007, with Beer's law). */
static void candy_copper(const pair *p, double f[3])
{
    static const double depth[3] = {0.06, 0.55, 1.3}; /* optical, one way at normal incidence */
    pair inside = refracted_pair(p, COAT_ETA);
    double path = 1.0 / inside.wi[2] + 1.0 / inside.wo[2];
    double flakes = 0.5 * ggx(&inside, 0.12, 0.12) + 0.5 * ggx(&inside, 0.35, 0.35);
    double through = coat_transmission(p) / (COAT_ETA * COAT_ETA) * 0.9 * flakes;
    add_coat(f, p, 0.015);
    for (int c = 0; c < 3; c++)
        f[c] += through * exp(-depth[c] * path);
}

/* Pearl paint: mica flakes coated with titania below a clear coat. What interference does not
 * reflect goes on to a dark base. */
static void pearl_flake_paint(const pair *p, double f[3])
{
    static const double base[3] = {0.012, 0.012, 0.022};
    double colour[3];
    pair inside = refracted_pair(p, COAT_ETA);
    hnbrdf_film_reflectance(p->film, inside.c, colour);
    add_coat(f, p, 0.012);
    add(f, coat_transmission(p) / (COAT_ETA * COAT_ETA) * 0.9 * ggx(&inside, 0.24, 0.24), colour);
    for (int c = 0; c < 3; c++)
        f[c] += diffuse_under_coat(p, base[c]);
}

/* ---- Rough, woven and granular --------------------------------------------------------------- */

/* Fired clay: rough Lambertian facets, flat towards grazing and brighter towards the light. */
static void rough_clay(const pair *p, double f[3])
{
    static const double albedo[3] = {0.52, 0.24, 0.13};
    add(f, oren_nayar(p, 0.9), albedo);
}

/* Velvet: dark between the fibres, a bright rim where they are seen from the side. */
static void velvet_crimson(const pair *p, double f[3])
{
    static const double ground[3] = {0.11, 0.006, 0.012}, fibre[3] = {0.72, 0.10, 0.13};
    add(f, charlie_sheen(p, 0.3), fibre);
    add(f, 1.0 / PI, ground);
}

/* Satin weave: shiny warp threads across dull weft threads of another colour, each an elliptical
 * lobe (the two thread families of Irawan and Marschner 2012). */
static void satin_weave(const pair *p, double f[3])
{
    static const double warp[3] = {0.30, 0.34, 0.38}, weft[3] = {0.22, 0.07, 0.16};
    static const double body[3] = {0.02, 0.05, 0.07};
    add(f, ggx(p, 0.14, 0.5), warp);
    add(f, ggx(p, 0.6, 0.25), weft);
    add(f, oren_nayar(p, 0.6), body);
}

/* Retroreflecting tape: glass beads send light back to where it came from, below a plastic film
 * (the back vector of Belcour et al. 2014, BRDF Measurements and Analysis of Retroreflective
 * Materials). */
static void retro_tape(const pair *p, double f[3])
{
    static const double beads[3] = {0.62, 0.58, 0.44}, body[3] = {0.17, 0.16, 0.13};
    pair back = retro_pair(p);
    double through = coat_transmission(p);
    add_coat(f, p, 0.18);
    add(f, through * ggx(&back, 0.1, 0.1), beads);
    add(f, through / PI, body);
}

/* Cardboard: a broad highlight that peaks nearer to grazing than the mirror direction
 * (off-specular: Torrance and Sparrow 1967). */
static void off_specular_cardboard(const pair *p, double f[3])
{
    static const double fibre[3] = {0.36, 0.24, 0.14}, sheen[3] = {0.95, 0.9, 0.8};
    add(f, 1.0 / PI, fibre);
    add(f, 1.1 * lafortune(p, 0.7, 9.0), sheen);
}

/* Lunar dust: brightest at full moon, where every grain hides its own shadow, and flat to the
 * limb. */
static void moon_dust(const pair *p, double f[3])
{
    static const double albedo[3] = {0.34, 0.30, 0.25};
    for (int c = 0; c < 3; c++)
        f[c] += hapke(p, albedo[c], 1.0, 0.06, -0.3);
}

/* ---- The list -------------------------------------------------------------------------------- */

const builtin_material hnbrdf_builtin_materials[] = {
    {"metallic-paint-blue", "two flake lobes over a diffuse base", 1, NULL, metallic_paint_blue},
    {"gold-two-lobe", "two lobes with the Fresnel reflectance of gold", 1, NULL, gold_two_lobe},
    {"clear-coat-red", "sharp coat over a saturated diffuse base", 1, NULL, clear_coat_red},
    {"glossy-plastic-green", "glossy surface over a saturated diffuse base", 1, NULL,
     glossy_plastic_green},
    {"candy-copper", "metal flakes below a dyed clear coat", 1, NULL, candy_copper},
    {"pearl-flake-paint", "interference flakes below a clear coat", 1, &PEARL_FILM,
     pearl_flake_paint},
    {"anodised-titanium", "oxide film on metal, colours by interference", 1, &TITANIUM_FILM,
     anodised_titanium},
    {"haze-aluminium", "sharp lobe on a wide skirt", 1, NULL, haze_aluminium},
    {"near-mirror-chrome", "alpha 0.006 with a faint skirt", 1, NULL, near_mirror_chrome},
    {"brushed-steel", "two anisotropic lobes at 30 degrees to the tangent", 0, NULL, brushed_steel},
    {"satin-weave", "two crossed anisotropic thread families", 0, NULL, satin_weave},
    {"velvet-crimson", "fibre sheen over a dark base", 1, NULL, velvet_crimson},
    {"rough-clay", "rough diffuse, Oren-Nayar", 1, NULL, rough_clay},
    {"off-specular-cardboard", "highlight shifted towards grazing, over diffuse", 1, NULL,
     off_specular_cardboard},
    {"retro-tape", "retroreflecting beads below a plastic film", 1, NULL, retro_tape},
    {"moon-dust", "Hapke's dust with opposition surge", 1, NULL, moon_dust},
};
const int hnbrdf_builtin_material_count =
    (int)(sizeof hnbrdf_builtin_materials / sizeof hnbrdf_builtin_materials[0]);
