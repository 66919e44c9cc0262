/* procedural_draw.c: which terms a procedural material has. Kinds, shares and ranges are chosen
 * after what the measured databases contain: paints with interference flakes, near-mirrors, metals,
 * plastics, matte and fibrous materials, each with the irregularities of measurements. */
#include "measured/procedural.h"

#include "hnbrdf/measured.h"

#include <math.h>
#include <string.h>

/* ---- Random numbers -------------------------------------------------------------------------- */

static double between(hnbrdf_rng *rng, double low, double high)
{
    return low + (high - low) * (double)hnbrdf_rng_float(rng);
}

/* Even in the logarithm. */
static double log_between(hnbrdf_rng *rng, double low, double high)
{
    return low * pow(high / low, (double)hnbrdf_rng_float(rng));
}

static int one_of(hnbrdf_rng *rng, int count)
{
    return (int)(hnbrdf_rng_float(rng) * (float)count);
}

static int chance(hnbrdf_rng *rng, double probability)
{
    return (double)hnbrdf_rng_float(rng) < probability;
}

/* Of any hue; the largest channel is about `value`. Saturation 0: grey; above 1: a channel may be
 * negative. */
static void draw_colour(hnbrdf_rng *rng, double value, double saturation, double rgb[3])
{
    const double hue = between(rng, 0.0, 3.0);
    for (int c = 0; c < 3; c++) {
        double distance = fabs(hue - c);
        distance = fmin(distance, 3.0 - distance);
        const double share = fmin(fmax(1.75 - 1.5 * distance, 0.0), 1.0);
        rgb[c] = value * (1.0 - saturation * (1.0 - share));
    }
}

/* ---- Terms ----------------------------------------------------------------------------------- */

/* One more, white; the last one anew where there is no room. */
static procedural_term *add(procedural *m, term_kind kind)
{
    procedural_term *t = &m->terms[m->count < PROCEDURAL_TERMS ? m->count++ : m->count - 1];
    memset(t, 0, sizeof *t);
    t->kind = kind;
    for (int c = 0; c < 3; c++)
        t->weight[c] = 1.0;
    return t;
}

static void scale(procedural_term *t, double factor)
{
    for (int c = 0; c < 3; c++)
        t->weight[c] *= factor;
}

static procedural_term *add_lobe(hnbrdf_rng *rng, procedural *m, double smooth, double rough)
{
    static const term_kind kinds[] = {TERM_GGX, TERM_GGX, TERM_BECKMANN, TERM_LONG_TAIL};
    procedural_term *t = add(m, kinds[one_of(rng, 4)]);
    t->alpha = log_between(rng, smooth, rough);
    return t;
}

static void draw_film(hnbrdf_rng *rng, procedural_term *t)
{
    film_stack film = {.outside_n = chance(rng, 0.6) ? 1.5 : 1.0};
    film.n = between(rng, film.outside_n + 0.15, 2.6);
    film.thickness = between(rng, 80.0, 700.0);
    film.base_n = between(rng, 1.3, 2.8);
    film.base_k = chance(rng, 0.5) ? 0.0 : between(rng, 1.0, 4.0);
    film.plates = 1 + one_of(rng, 4);
    t->tint = TINT_FILM;
    hnbrdf_film_fill(&t->film, &film);
}

static void draw_flop(hnbrdf_rng *rng, procedural_term *t, double value)
{
    t->tint = TINT_FLOP;
    t->power = between(rng, 0.5, 6.0);
    t->by_tilt = chance(rng, 0.3);
    draw_colour(rng, value * between(rng, 0.3, 1.0), between(rng, 0.3, 1.15), t->facing);
    draw_colour(rng, value * between(rng, 0.3, 1.0), between(rng, 0.3, 1.15), t->grazing);
}

static void add_diffuse(hnbrdf_rng *rng, procedural *m, double darkest, double brightest,
                        double saturation)
{
    static const term_kind kinds[] = {TERM_LAMBERT, TERM_OREN_NAYAR, TERM_UNDER_COAT, TERM_HAPKE};
    procedural_term *t = add(m, kinds[one_of(rng, 4)]);
    double value = log_between(rng, darkest, brightest);
    t->inside = 1;
    if (t->kind == TERM_OREN_NAYAR)
        t->shape[0] = between(rng, 0.2, 1.0);
    if (t->kind == TERM_HAPKE) {
        t->shape[0] = between(rng, 0.2, 0.9);
        t->shape[1] = between(rng, 0.03, 0.3);
        t->shape[2] = between(rng, -0.4, 0.2);
        value = between(rng, 0.1, 1.0);
    }
    draw_colour(rng, value, between(rng, 0.0, saturation), t->weight);
}

/* One to three lobes side by side, mostly of one colour. */
static void add_metal(hnbrdf_rng *rng, procedural *m, double smooth, double rough,
                      double saturation)
{
    const int count = 1 + one_of(rng, 3);
    double rest = between(rng, 0.4, 1.0), colour[3];
    draw_colour(rng, between(rng, 0.4, 0.98), between(rng, 0.0, saturation), colour);
    for (int k = 0; k < count; k++) {
        procedural_term *t = add_lobe(rng, m, smooth, rough);
        const double share = k == count - 1 ? rest : rest * between(rng, 0.2, 0.95);
        if (chance(rng, 0.3))
            draw_colour(rng, between(rng, 0.2, 0.98), between(rng, 0.0, saturation), colour);
        scale(t, share);
        rest -= share;
        t->tint = TINT_SCHLICK;
        memcpy(t->facing, colour, sizeof colour);
    }
}

/* The reflection of a dielectric surface, four times in ten with a haze. */
static void add_surface(hnbrdf_rng *rng, procedural *m, double smooth, double rough, double share)
{
    procedural_term *t = add_lobe(rng, m, smooth, rough);
    t->tint = TINT_DIELECTRIC;
    t->eta = between(rng, 1.3, 1.8);
    scale(t, share);
    if (m->count == PROCEDURAL_TERMS || !chance(rng, 0.4))
        return;
    const double part = between(rng, 0.5, 0.95);
    procedural_term *haze = add_lobe(rng, m, fmin(2.0 * t->alpha, 0.6), fmin(12.0 * t->alpha, 0.9));
    haze->tint = TINT_DIELECTRIC;
    haze->eta = t->eta;
    scale(haze, share * (1.0 - part));
    scale(t, part);
}

/* ---- Kinds of materials ---------------------------------------------------------------------- */

static void flake_paint(hnbrdf_rng *rng, procedural *m)
{
    const int flakes = 1 + one_of(rng, 2);
    m->coated = chance(rng, 0.8);
    if (m->coated)
        add_surface(rng, m, 0.008, 0.3, 1.0);
    for (int k = 0; k < flakes; k++) {
        procedural_term *t = add_lobe(rng, m, 0.08, 0.6);
        t->inside = 1;
        scale(t, log_between(rng, 0.1, 1.0) / flakes);
        if (chance(rng, 0.6))
            draw_film(rng, t);
        else
            draw_flop(rng, t, 1.0);
    }
    if (chance(rng, 0.8))
        add_diffuse(rng, m, 0.003, 0.2, 1.1);
    for (int c = 0; c < 3 && m->coated; c++)
        m->dye[c] = chance(rng, 0.4) ? log_between(rng, 0.01, 0.8) : 0.0;
}

static void near_mirror(hnbrdf_rng *rng, procedural *m)
{
    add_metal(rng, m, 0.005, 0.06, 0.6);
    if (chance(rng, 0.85)) { /* no measurement is black beside the highlight */
        procedural_term *t = add(m, chance(rng, 0.5) ? TERM_LONG_TAIL : TERM_LAMBERT);
        t->alpha = between(rng, 0.2, 0.8);
        draw_colour(rng, log_between(rng, 0.003, 0.15), between(rng, 0.0, 0.7), t->weight);
    }
}

static void film_on_metal(hnbrdf_rng *rng, procedural *m)
{
    draw_film(rng, add_lobe(rng, m, 0.006, 0.1));
    if (chance(rng, 0.7))
        draw_flop(rng, add_lobe(rng, m, 0.1, 0.5), 0.3);
}

static void rough_metal(hnbrdf_rng *rng, procedural *m)
{
    add_metal(rng, m, 0.06, 0.6, 1.1);
    if (chance(rng, 0.5))
        add_diffuse(rng, m, 0.003, 0.1, 1.0);
}

static void plastic(hnbrdf_rng *rng, procedural *m)
{
    add_surface(rng, m, 0.01, 0.5, 1.0);
    add_diffuse(rng, m, 0.02, 0.9, 1.1);
    if (chance(rng, 0.2))
        add_diffuse(rng, m, 0.003, 0.3, 1.1);
}

static void matte(hnbrdf_rng *rng, procedural *m)
{
    add_diffuse(rng, m, 0.02, 0.9, 1.0);
    if (chance(rng, 0.7))
        add_surface(rng, m, 0.3, 0.9, between(rng, 0.05, 1.0));
    if (chance(rng, 0.3)) {
        procedural_term *t = add(m, TERM_LAFORTUNE);
        t->shape[0] = between(rng, 0.5, 0.95);
        t->shape[1] = log_between(rng, 2.0, 40.0);
        draw_colour(rng, log_between(rng, 0.05, 0.8), between(rng, 0.0, 0.5), t->weight);
    }
}

static void fibres(hnbrdf_rng *rng, procedural *m)
{
    procedural_term *t = add(m, TERM_SHEEN);
    t->alpha = between(rng, 0.1, 0.9);
    draw_colour(rng, log_between(rng, 0.02, 0.7), between(rng, 0.0, 1.0), t->weight);
    add_diffuse(rng, m, 0.003, 0.5, 1.1);
    if (chance(rng, 0.4))
        add_surface(rng, m, 0.3, 0.8, 1.0);
}

/* A bit of everything. */
static void mixture(hnbrdf_rng *rng, procedural *m)
{
    add_surface(rng, m, 0.05, 0.6, 1.0);
    draw_flop(rng, add_lobe(rng, m, 0.05, 0.7), 0.6);
    add_diffuse(rng, m, 0.003, 0.5, 1.1);
    if (chance(rng, 0.3)) {
        procedural_term *t = add(m, TERM_RETRO);
        t->alpha = between(rng, 0.08, 0.6);
        draw_colour(rng, log_between(rng, 0.02, 0.5), between(rng, 0.0, 0.7), t->weight);
    }
}

static void draw_irregularities(hnbrdf_rng *rng, procedural *m)
{
    m->saturation = chance(rng, 0.4) ? between(rng, 1.0, 1.5) : 1.0;
    const double imbalance = chance(rng, 0.5) ? between(rng, -0.4, 0.4) : 0.0;
    const double limb = chance(rng, 0.5) ? between(rng, -1.0, 0.7) : 0.0;
    for (int c = 0; c < 3; c++) {
        m->imbalance[c] = imbalance + between(rng, -0.1, 0.1);
        m->limb[c] = limb + between(rng, -0.2, 0.2);
    }
    m->incidence = between(rng, 1.0, 1.1);
}

void hnbrdf_procedural_draw(int number, procedural *m)
{
    static void (*const kinds[])(hnbrdf_rng *, procedural *) = {
        flake_paint, flake_paint,   flake_paint, flake_paint, flake_paint, flake_paint, near_mirror,
        near_mirror, film_on_metal, rough_metal, rough_metal, plastic,     plastic,     plastic,
        matte,       matte,         fibres,      fibres,      mixture,     mixture};
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, (uint64_t)number);
    memset(m, 0, sizeof *m);
    kinds[one_of(&rng, (int)(sizeof kinds / sizeof kinds[0]))](&rng, m);
    draw_irregularities(&rng, m);
}
