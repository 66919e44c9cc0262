/* procedural.c: what a procedural material reflects. */
#include "measured/procedural.h"

#include "measured/builtin_terms.h"

/* ---- Terms ----------------------------------------------------------------------------------- */

static double lobe(const procedural_term *t, const pair *p)
{
    const double a = t->alpha;
    pair back;
    switch (t->kind) {
    case TERM_GGX:
        return ggx(p, a, a);
    case TERM_BECKMANN:
        return beckmann(p, a, a);
    case TERM_LONG_TAIL:
        return long_tail(p, a, a);
    case TERM_SHEEN: /* gains energy at grazing as 1/sqrt(roughness) */
        return charlie_sheen(p, a) * fmin(sqrt(a / 0.2), 1.0);
    case TERM_LAFORTUNE:
        return lafortune(p, t->shape[0], t->shape[1]);
    case TERM_RETRO:
        back = retro_pair(p);
        return ggx(&back, a, a);
    case TERM_LAMBERT:
        return 1.0 / PI;
    case TERM_OREN_NAYAR:
        return oren_nayar(p, t->shape[0]);
    case TERM_HAPKE:
        return hapke(p, t->shape[0], 1.0, t->shape[1], t->shape[2]);
    case TERM_UNDER_COAT:
        break; /* not linear in its colour */
    }
    return 1.0;
}

static void tint(const procedural_term *t, const pair *p, double rgb[3])
{
    double blend = 0.0;
    if (t->tint == TINT_FILM)
        hnbrdf_film_reflectance(&t->film, p->c, rgb);
    if (t->tint == TINT_FLOP)
        blend = pow(t->by_tilt ? p->h[2] : p->c, t->power);
    for (int c = 0; c < 3; c++)
        switch (t->tint) {
        case TINT_NONE:
            rgb[c] = 1.0;
            break;
        case TINT_SCHLICK:
            rgb[c] = schlick(t->facing[c], p->c);
            break;
        case TINT_DIELECTRIC:
            rgb[c] = fresnel_dielectric(t->eta, p->c);
            break;
        case TINT_FLOP:
            rgb[c] = t->facing[c] * blend + t->grazing[c] * (1.0 - blend);
            break;
        case TINT_FILM:
            break;
        }
}

/* Adds a term seen at `p`; `through` is what a coat above it lets pass. */
static void add_term(const procedural_term *t, const pair *p, const double through[3], double f[3])
{
    double value = lobe(t, p), rgb[3];
    tint(t, p, rgb);
    for (int c = 0; c < 3; c++)
        f[c] += t->kind == TERM_UNDER_COAT ? diffuse_under_coat(p, t->weight[c])
                                           : through[c] * value * rgb[c] * t->weight[c];
}

void hnbrdf_procedural_eval(const procedural *m, const double wi[3], const double wo[3],
                            double f[3])
{
    const double clear[3] = {1.0, 1.0, 1.0};
    const pair outside = make_pair(wi, wo), inside = refracted_pair(&outside, COAT_ETA);
    const double pass = coat_transmission(&outside) / square(COAT_ETA);
    const double path = 1.0 / inside.wi[2] + 1.0 / inside.wo[2];
    double through[3];
    for (int c = 0; c < 3; c++) {
        through[c] = pass * exp(-m->dye[c] * path);
        f[c] = 0.0;
    }
    for (int k = 0; k < m->count; k++) {
        const procedural_term *t = &m->terms[k];
        const int below = m->coated && t->inside && t->kind != TERM_UNDER_COAT;
        add_term(t, below ? &inside : &outside, below ? through : clear, f);
    }
    const double luminance = 0.2126 * f[0] + 0.7152 * f[1] + 0.0722 * f[2];
    const double difference = wi[2] - wo[2], limb = square((1.0 - wi[2]) * (1.0 - wo[2]));
    for (int c = 0; c < 3; c++)
        f[c] = (luminance + m->saturation * (f[c] - luminance)) *
               exp(m->imbalance[c] * difference + m->limb[c] * limb);
}
