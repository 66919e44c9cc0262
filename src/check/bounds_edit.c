/* bounds_edit.c: carry.h once more with bounds: what an edit makes of a pair and of f_a. */
#include "check/bounds_edit.h"

/* min(a/b, 1), or a/b where both are 1. A device that takes the other of the two is no further off
 * than the quotient is. */
static num quotient_or_1(num quotient, int is_one, int is_certain)
{
    return (num){is_one ? 1.0f : quotient.v, is_one && is_certain ? 0.0 : quotient.e};
}

/* hnbrdf_specular_part(). */
static num specular_part(const check_rules *k, const num specular[3], const num carried[3])
{
    num shine = add(k, add(k, specular[0], specular[1]), specular[2]);
    num diffuse = add(k, add(k, carried[0], carried[1]), carried[2]);
    return clamp(divide(k, shine, add(k, shine, diffuse)), 0.0f, 1.0f);
}

/* 1 + part (factor - 1) of one axis. */
static num warp_factor(const check_rules *k, const hnbrdf_material *m, int axis, num part)
{
    num factor = same(1.0f), one = same(1.0f);
    if (m->alpha[axis] != m->fitted.alpha[axis])
        factor = divide(k, same(m->fitted.alpha[axis]), same(m->alpha[axis]));
    return add(k, one, multiply(k, part, subtract(k, factor, one)));
}

/* hnbrdf_warp(). */
static void warp(const check_rules *k, const hnbrdf_material *m, num part, const pair *p, num s[3])
{
    num r2 = add(k, multiply(k, p->s[0], p->s[0]), multiply(k, p->s[1], p->s[1]));
    num most = largest(r2, multiply(k, p->s[2], p->s[2])), w[2];
    for (int i = 0; i < 2; i++)
        w[i] = multiply(k, p->s[i], warp_factor(k, m, i, part));
    num w2 = add(k, multiply(k, w[0], w[0]), multiply(k, w[1], w[1]));
    num shrink = root(k, quotient_or_1(divide(k, most, w2), !(w2.v > most.v),
                                       (double)w2.v + w2.e < (double)most.v - most.e));
    for (int i = 0; i < 2; i++)
        w[i] = multiply(k, w[i], shrink);
    num length2 = dot3(k, w[0], w[1], p->s[2]);
    num stretch =
        root(k, quotient_or_1(divide(k, p->length2, length2), length2.v == p->length2.v, 0));
    s[0] = multiply(k, w[0], stretch);
    s[1] = multiply(k, w[1], stretch);
    s[2] = multiply(k, p->s[2], stretch);
}

/* C takes `taken`; a device that is not certain to may take the other. */
static num either(num taken, num other, int certain)
{
    double away = fabs((double)other.v - (double)taken.v) + other.e;
    return (num){taken.v, certain ? taken.e : fmax(taken.e, away)};
}

static num dot(const check_rules *k, const num a[3], const num b[3])
{
    num sum = add(k, multiply(k, a[0], b[0]), multiply(k, a[1], b[1]));
    return add(k, sum, multiply(k, a[2], b[2]));
}

/* hnbrdf_turn_pair(). */
static void turn(const check_rules *k, const pair *p, pair *q)
{
    num d[3];
    int moved = 0, exact = 1, far = 0; /* far: moved on any device */
    for (int i = 0; i < 3; i++) {
        double by = fabs((double)q->s[i].v - (double)p->s[i].v);
        d[i] = apart(k, p, i);
        moved |= by > 0.0;
        far |= by > q->s[i].e + p->s[i].e;
        exact &= q->s[i].e == 0.0 && p->s[i].e == 0.0;
    }
    const int certain = exact || far;
    num along = dot(k, d, p->s), both = add(k, p->length2, dot(k, p->s, q->s));
    num by = divide(k, add(k, along, dot(k, d, q->s)), both);
    num back = divide(k, multiply(k, same(2.0f), along), p->length2);
    for (int i = 0; i < 3; i++) {
        num turned = subtract(k, d[i], multiply(k, by, add(k, p->s[i], q->s[i])));
        turned = add(k, turned, multiply(k, back, q->s[i]));
        num wi = multiply(k, same(0.5f), add(k, q->s[i], turned));
        num wo = multiply(k, same(0.5f), subtract(k, q->s[i], turned));
        q->wi[i] = moved ? either(wi, p->wi[i], certain) : either(p->wi[i], wi, certain);
        q->wo[i] = moved ? either(wo, p->wo[i], certain) : either(p->wo[i], wo, certain);
    }
}

/* hnbrdf_cosine_held(): max(least - moved, 0). */
static num cosine_held(const check_rules *k, num cosine, num moved)
{
    num least = smallest(cosine, same(0.1f));
    return largest(subtract(k, least, moved), same(0.0f));
}

/* hnbrdf_incline_pair(). A device on which the pair stays where it moves in C, or the other way
 * round, is within rounding of it, but for x and y, which are of another form of the same
 * difference. */
static void incline(const check_rules *k, const pair *p, pair *q)
{
    num one = same(1.0f), d[3];
    num r2 = add(k, multiply(k, p->s[0], p->s[0]), multiply(k, p->s[1], p->s[1]));
    num q2 = add(k, multiply(k, q->s[0], q->s[0]), multiply(k, q->s[1], q->s[1]));
    const int along_normal = r2.v == 0.0f && r2.e == 0.0 && q2.v == 0.0f && q2.e == 0.0;
    num ratio = clamp(quotient_or_1(divide(k, q2, r2), q2.v == r2.v, along_normal), 0.0f, 1e8f);
    num sine = root(k, ratio), more = subtract(k, sine, one), sum = subtract(k, q->s[2], p->s[2]);
    for (int i = 0; i < 3; i++)
        d[i] = apart(k, p, i);
    num half = same(0.5f), difference = multiply(k, more, d[2]);
    num zi = add(k, p->wi[2], multiply(k, half, add(k, sum, difference)));
    num zo = add(k, p->wo[2], multiply(k, half, subtract(k, sum, difference)));
    num held_i = cosine_held(k, p->wi[2], zi), held_o = cosine_held(k, p->wo[2], zo);
    num held = subtract(k, held_i, held_o);
    num rest = subtract(k, add(k, multiply(k, d[0], d[0]), multiply(k, d[1], d[1])),
                        multiply(k, multiply(k, d[2], d[2]), multiply(k, more, add(k, one, sine))));
    num twice = multiply(k, multiply(k, same(2.0f), sine), d[2]);
    rest = subtract(k, rest, multiply(k, held, add(k, twice, held)));
    num along = multiply(k, half, root(k, largest(rest, same(0.0f))));
    if (more.v != 0.0f || sum.v != 0.0f) {
        q->wi[0] = along;
        q->wo[0] = (num){-along.v, along.e};
        q->wi[1] = q->wo[1] = same(0.0f);
    }
    q->wi[2] = add(k, zi, held_i);
    q->wo[2] = add(k, zo, held_o);
}

/* hnbrdf_keep_azimuth(). Where the device has d beside C's 0, nothing bounds the quotient. */
static void keep_azimuth(const check_rules *k, const pair *p, pair *q)
{
    num d[2], at[2];
    for (int i = 0; i < 2; i++) {
        d[i] = apart(k, p, i);
        at[i] = apart(k, q, i);
    }
    num d2 = add(k, multiply(k, d[0], d[0]), multiply(k, d[1], d[1]));
    num q2 = add(k, multiply(k, at[0], at[0]), multiply(k, at[1], at[1]));
    num by = {1.0f, d2.e == 0.0 ? 0.0 : (double)INFINITY};
    by = multiply(k, same(0.5f), root(k, d2.v > 0.0f ? divide(k, q2, d2) : by));
    for (int i = 0; i < 2; i++) {
        q->wi[i] = multiply(k, by, d[i]);
        q->wo[i] = (num){-q->wi[i].v, q->wi[i].e};
    }
}

/* hnbrdf_carried_eta(). */
static num fitted_eta(const check_rules *k, float eta, float fitted)
{
    num one = same(1.0f);
    num r = divide(k, divide(k, subtract(k, same(eta), one), add(k, same(eta), one)), same(4.0f));
    return largest(divide(k, add(k, one, r), subtract(k, one, r)), same(fitted));
}

static num masked(const check_rules *k, const pair *p, const pair *seen, const float alpha[2])
{
    num ax = same(alpha[0]), ay = same(alpha[1]);
    num masking = multiply(k, smith_v(k, p->wi, ax, ay), smith_v(k, p->wo, ax, ay));
    return multiply(k, ggx_d(k, seen, ax, ay), masking);
}

void check_edit_make(const check_rules *k, hnbrdf_encoding encoding,
                     const hnbrdf_material *material, const pair *p, check_edit *edit)
{
    const hnbrdf_fitted *fitted = &material->fitted;
    num now = masked(k, p, p, material->alpha), carried_kd[3], carried[3], specular[3];
    for (int c = 0; c < 3; c++) {
        num most = multiply(k, same(4.0f), given(k, fitted->kd[c]));
        carried_kd[c] = smallest(given(k, material->kd[c]), most);
        carried[c] = multiply(k, carried_kd[c], same(HNBRDF_INV_PI));
        specular[c] = multiply(k, fresnel_dielectric(k, same(material->eta[c]), p->c), now);
        edit->edited[c] = add(k, carried[c], specular[c]);
    }
    pair at_half = *p; /* D is asked at s', angles of incidence are as they were */
    warp(k, material, specular_part(k, specular, carried), p, at_half.s);
    edit->seen = at_half;
    if (encoding == HNBRDF_ENCODING_DIRECTIONS)
        turn(k, p, &edit->seen);
    else
        incline(k, p, &edit->seen);
    if (encoding == HNBRDF_ENCODING_ANGLES_AZIMUTHS)
        keep_azimuth(k, p, &edit->seen);
    num before = masked(k, p, &at_half, fitted->alpha);
    for (int c = 0; c < 3; c++) {
        num kd = given(k, material->kd[c]);
        num diffuse = multiply(k, given(k, fitted->kd[c]), same(HNBRDF_INV_PI));
        num f0 = fresnel_dielectric(k, fitted_eta(k, material->eta[c], fitted->eta[c]), p->c);
        num then = add(k, diffuse, multiply(k, f0, before));
        num quotient = divide(k, edit->edited[c], then);
        edit->ratio[c] =
            clamp(quotient_or_1(quotient, edit->edited[c].v == then.v, 0), 0.0f, HNBRDF_MAX_VALUE);
        edit->added[c] = multiply(k, subtract(k, kd, carried_kd[c]), same(HNBRDF_INV_PI));
    }
}

num check_edit_compose(const check_rules *k, const check_edit *edit, int c, num correction,
                       num sigmoid, num floor)
{
    num gated = multiply(k, sigmoid, edit->edited[c]);
    num carried = add(k, multiply(k, edit->ratio[c], subtract(k, correction, floor)), gated);
    num as_it_is = subtract(k, add(k, correction, gated), floor);
    int is_one = edit->ratio[c].v == 1.0f;
    int certain = edit->ratio[c].e == 0.0 ||
                  (!is_one && edit->ratio[c].e < fabs((double)edit->ratio[c].v - 1.0));
    num f = either(is_one ? as_it_is : carried, is_one ? carried : as_it_is, certain);
    return add(k, f, edit->added[c]);
}
