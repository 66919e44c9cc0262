/* builtin_anisotropic.c: the second set of built-in materials: threads, grooves, brushed and
 * rolled metal, wood, hair. Not only their highlights have a direction, what looks diffuse has one
 * too. */
#include "measured/builtin_relief.h"

#define DEGREES (PI / 180)

static void add_colour(double f[3], double value, const double colour[3])
{
    for (int c = 0; c < 3; c++)
        f[c] += value * colour[c];
}

static void add_metal(double f[3], const pair *p, double lobe, const double n[3], const double k[3])
{
    for (int c = 0; c < 3; c++)
        f[c] += lobe * fresnel_conductor(n[c], k[c], p->c);
}

/* ---- Cloth: warp along x, weft along y ------------------------------------------------------- */

/* Plain weave of flax, the crimp of the weft stronger than that of the warp. */
static const thread FLAX_WARP = {1.46, 0.30, 0.55, 0.35, {0.70, 0.58, 0.41}};
static const thread FLAX_WEFT = {1.46, 0.26, 0.50, 0.35, {0.62, 0.47, 0.30}};

static void flax_warp(const pair *p, double weight, double f[3])
{
    add_thread(p, &FLAX_WARP, weight, f);
}

static void flax_weft(const pair *p, double weight, double f[3])
{
    add_thread(p, &FLAX_WEFT, weight, f);
}

static void plain_weave_linen(const pair *p, double f[3])
{
    static const strand threads[] = {{0, 0, 0.58, -0.3, 0.3, 6, flax_warp},
                                     {PI / 2, 0, 0.42, -0.5, 0.5, 8, flax_weft}};
    add_relief(p, threads, 2, 1.0, f);
}

/* Denim: a 3/1 twill. Two thirds of what is seen is dyed warp, in ribs at 63 degrees to it, so that
 * no mirror leaves the cloth as it is, only half a turn. */
static const thread INDIGO = {1.53, 0.34, 0.60, 0.45, {0.05, 0.085, 0.19}};
static const thread COTTON = {1.53, 0.34, 0.60, 0.45, {0.66, 0.64, 0.58}};
#define RIB (63 * DEGREES)

static void indigo(const pair *p, double weight, double f[3])
{
    add_thread(p, &INDIGO, weight, f);
}

static void cotton(const pair *p, double weight, double f[3])
{
    add_thread(p, &COTTON, weight, f);
}

static void denim_twill(const pair *p, double f[3])
{
    static const strand threads[] = {{RIB - PI / 2, PI / 2 - RIB, 0.68, -0.45, 0.45, 8, indigo},
                                     {PI / 2, 0, 0.32, -0.25, 0.25, 4, cotton}};
    add_relief(p, threads, 2, 1.0, f);
}

/* Satin: long smooth floats of polyester, their ends bent down, hardly any weft. */
static const thread FLOAT = {1.539, 0.09, 0.20, 0.15, {0.62, 0.13, 0.20}};
static const thread FLOAT_END = {1.539, 0.16, 0.30, 0.20, {0.58, 0.12, 0.19}};

static void float_flat(const pair *p, double weight, double f[3])
{
    add_thread(p, &FLOAT, weight, f);
}

static void float_end(const pair *p, double weight, double f[3])
{
    add_thread(p, &FLOAT_END, weight, f);
}

static void satin_charmeuse(const pair *p, double f[3])
{
    static const strand threads[] = {{0, 0, 0.62, -0.08, 0.08, 3, float_flat},
                                     {0, 0, 0.26, -0.5, 0.5, 10, float_end},
                                     {PI / 2, 0, 0.12, -0.2, 0.2, 4, float_end}};
    add_relief(p, threads, 3, 1.0, f);
}

/* Shot silk: red warp and green weft, which is seen depends on where one looks from. */
static const thread RED_SILK = {1.345, 0.14, 0.28, 0.2, {0.66, 0.05, 0.09}};
static const thread GREEN_SILK = {1.345, 0.14, 0.28, 0.2, {0.06, 0.40, 0.26}};

static void red_silk(const pair *p, double weight, double f[3])
{
    add_thread(p, &RED_SILK, weight, f);
}

static void green_silk(const pair *p, double weight, double f[3])
{
    add_thread(p, &GREEN_SILK, weight, f);
}

static void shot_silk(const pair *p, double f[3])
{
    static const strand threads[] = {{0, 0, 0.5, -0.3, 0.3, 6, red_silk},
                                     {PI / 2, 0, 0.5, -0.15, 0.15, 4, green_silk}};
    add_relief(p, threads, 2, 1.0, f);
}

/* Corduroy: round wales of cut pile along y. All of it is diffuse or sheen, and still it has a
 * direction. */
static void pile(const pair *p, double weight, double f[3])
{
    static const double ground[3] = {0.30, 0.16, 0.06}, tips[3] = {0.30, 0.20, 0.10};
    add_colour(f, weight * oren_nayar(p, 0.5), ground);
    add_colour(f, weight * charlie_sheen(p, 0.5), tips);
}

static void corduroy(const pair *p, double f[3])
{
    static const strand wales[] = {{0, 0, 0.8, -0.9, 0.9, 16, pile},
                                   {0, 0, 0.2, -0.1, 0.1, 1, pile}};
    add_relief(p, wales, 2, 1.0, f);
}

/* Twill of carbon fibres below satin epoxy. Graphite's index over that of the resin. */
static void carbon(const pair *p, double weight, double f[3])
{
    double lobe = fresnel_conductor(1.8, 0.95, p->c) * fibre_azimuth(p) * fibre_lobe(p, 0.11, 0.0);
    for (int c = 0; c < 3; c++)
        f[c] += weight * (lobe * fibre_spread(p) + 0.012 / PI);
}

static void carbon_fibre(const pair *p, double f[3])
{
    static const strand tows[] = {{0, 0, 0.5, -0.15, 0.15, 4, carbon},
                                  {PI / 2, 0, 0.5, -0.15, 0.15, 4, carbon}};
    pair inside = refracted_pair(p, COAT_ETA);
    double coat = fresnel_dielectric(COAT_ETA, p->c) * ggx(p, 0.14, 0.14);
    add_relief(&inside, tows, 2, coat_transmission(p) / square(COAT_ETA), f);
    for (int c = 0; c < 3; c++)
        f[c] += coat;
}

/* ---- Metal ----------------------------------------------------------------------------------- */

/* Brushed along x; the brush leaves a tail longer than that of GGX (Ribardiere et al. 2017) and a
 * few scratches in all directions. */
static void brushed_aluminium(const pair *p, double f[3])
{
    double lobe = 0.85 * long_tail(p, 0.09, 0.34) + 0.15 * ggx(p, 0.3, 0.3);
    add_metal(f, p, lobe, ALUMINIUM_N, ALUMINIUM_K);
}

/* Cold-rolled steel: Gaussian slopes, smoother along the rolling (Ward 1992, Measuring and Modeling
 * Anisotropic Reflection), and what several facets in turn scatter, which comes back from
 * everywhere. */
static void rolled_steel(const pair *p, double f[3])
{
    static const double scattered[3] = {0.031, 0.030, 0.029};
    double lobe = 0.6 * beckmann(p, 0.14, 0.3) + 0.35 * beckmann(p, 0.34, 0.55);
    add_metal(f, p, lobe, IRON_N, IRON_K);
    add_colour(f, 1.0 / PI, scattered);
}

/* Turned on a lathe: round grooves of the tool along y, with a grain of their own (Poulin and
 * Fournier 1990, A Model for Anisotropic Reflection). */
static const double BRASS_N[3] = {0.44, 0.53, 1.09}, BRASS_K[3] = {3.69, 2.76, 1.83};

static void turned_facet(const pair *p, double weight, double f[3])
{
    add_metal(f, p, weight * ggx(p, 0.12, 0.08), BRASS_N, BRASS_K);
}

static void turned_brass(const pair *p, double f[3])
{
    static const strand groove[] = {{0, 0, 1.0, -0.3, 0.3, 6, turned_facet}};
    add_relief(p, groove, 1, 1.0, f);
}

/* Vinyl pressed with V-shaped grooves along y, flat lands between them (facets of two slopes:
 * Torrance and Sparrow 1967). */
static void vinyl(const pair *p, double weight, double f[3])
{
    double lobe = fresnel_dielectric(1.55, p->c) * ggx(p, 0.18, 0.14);
    for (int c = 0; c < 3; c++)
        f[c] += weight * (lobe + 0.025 / PI);
}

static void grooved_vinyl(const pair *p, double f[3])
{
    static const strand flanks[] = {{0, 0, 0.3, 0.3, 0.6, 4, vinyl},
                                    {0, 0, 0.3, -0.6, -0.3, 4, vinyl},
                                    {0, 0, 0.4, -0.06, 0.06, 1, vinyl}};
    add_relief(p, flanks, 3, 1.0, f);
}

/* ---- Wood and hair --------------------------------------------------------------------------- */

/* Light that fibres along (cos tilt, 0, sin tilt) scatter into a cone, below a finish: Marschner et
 * al. 2005, Measuring and Modeling the Appearance of Finished Wood, Eq. 4 and 5. */
static double wood_fibres(const pair *inside, double tilt, double width)
{
    double si = cos(tilt) * inside->wi[0] + sin(tilt) * inside->wi[2];
    double so = cos(tilt) * inside->wo[0] + sin(tilt) * inside->wo[2];
    double ai = asin(fmax(-1.0, fmin(1.0, si))), ao = asin(fmax(-1.0, fmin(1.0, so)));
    double off = (ai + ao) / width, across = cos((ai - ao) / 2);
    return exp(-off * off / 2) / (width * sqrt(2 * PI)) / square(across);
}

/* Maple whose grain waves: fibres lean both ways out of the surface. */
static void curly_maple(const pair *p, double f[3])
{
    static const double fibre[3] = {0.24, 0.16, 0.085}, body[3] = {0.36, 0.22, 0.11};
    pair inside = refracted_pair(p, COAT_ETA);
    double through = coat_transmission(p) / square(COAT_ETA);
    double lobe = 0.5 * (wood_fibres(&inside, 0.12, 0.2) + wood_fibres(&inside, -0.12, 0.2));
    double coat = fresnel_dielectric(COAT_ETA, p->c) * ggx(p, 0.16, 0.2);
    add_colour(f, through * lobe, fibre);
    for (int c = 0; c < 3; c++)
        f[c] += coat + diffuse_under_coat(p, body[c]);
}

/* Hair combed along x, its scales leaning by 3 degrees: a white reflection towards the roots, a
 * coloured one from within towards the tips (Marschner et al. 2003), and light that many hairs
 * scattered (Kajiya and Kay 1989, Rendering Fur with Three Dimensional Textures). */
static void combed_hair(const pair *p, double f[3])
{
    static const double inner[3] = {0.20, 0.11, 0.045}, many[3] = {0.17, 0.095, 0.045};
    double spread = fibre_spread(p), azimuth = fibre_azimuth(p);
    double surface = fresnel_dielectric(1.55, p->c) * fibre_lobe(p, 0.2, -0.1);
    double within = fibre_lobe(p, 0.32, 0.15);
    double ci = sqrt(square(p->wi[1]) + square(p->wi[2]));
    double co = sqrt(square(p->wo[1]) + square(p->wo[2]));
    add_colour(f, spread * azimuth * within, inner);
    add_colour(f, ci * co / PI, many);
    for (int c = 0; c < 3; c++)
        f[c] += spread * azimuth * surface;
}

/* ---- The list -------------------------------------------------------------------------------- */

const builtin_material hnbrdf_builtin_anisotropic[] = {
    {"plain-weave-linen", "two crossed families of flax threads", 0, NULL, plain_weave_linen},
    {"denim-twill", "dyed warp in slanted ribs, white weft", 0, NULL, denim_twill},
    {"satin-charmeuse", "long glossy floats with bent ends", 0, NULL, satin_charmeuse},
    {"shot-silk", "red warp, green weft", 0, NULL, shot_silk},
    {"corduroy", "wales of diffuse pile", 0, NULL, corduroy},
    {"carbon-fibre", "crossed carbon fibres below epoxy", 0, NULL, carbon_fibre},
    {"brushed-aluminium", "long tail along and across the brush", 0, NULL, brushed_aluminium},
    {"rolled-steel", "Gaussian slopes, two widths", 0, NULL, rolled_steel},
    {"turned-brass", "round grooves of a lathe", 0, NULL, turned_brass},
    {"grooved-vinyl", "V-shaped grooves between flat lands", 0, NULL, grooved_vinyl},
    {"curly-maple", "wood fibres of two tilts below a finish", 0, NULL, curly_maple},
    {"combed-hair", "two tilted cones of hair fibres", 0, NULL, combed_hair},
};
const int hnbrdf_builtin_anisotropic_count =
    (int)(sizeof hnbrdf_builtin_anisotropic / sizeof hnbrdf_builtin_anisotropic[0]);
