/* oracle.c: the model of hnbrdf.h line by line, in real numbers of many digits. Slow, and meant
 * to be read. */
#include "check/oracle.h"

#include "check/real.h"

#include <string.h>

const char *oracle_arithmetic(void)
{
    return REAL_NAME;
}

/* The first 161 bits, in three doubles. */
static real pi(void)
{
    return (real)0x1.921fb54442d18p+1 + (real)0x1.1a62633145c07p-53 + (real)-0x1.f1976b7ed8fbcp-109;
}

typedef struct vec {
    real x, y, z;
} vec;

static real dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec sum(vec a, vec b)
{
    return (vec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static vec minus(vec a, vec b)
{
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static vec in_tangent_frame(const float w[3], real rotation)
{
    real cosine = real_cos(rotation), sine = real_sin(rotation);
    return (vec){cosine * w[0] + sine * w[1], cosine * w[1] - sine * w[0], w[2]};
}

static real limited(real x, real low, real high)
{
    return x < low ? low : x > high ? high : x;
}

/* ---- The analytic part ----------------------------------------------------------------------- */

static real D(vec h, real ax, real ay)
{
    real t = (h.x / ax) * (h.x / ax) + (h.y / ay) * (h.y / ay) + h.z * h.z;
    return 1 / (pi() * ax * ay * t * t);
}

static real G1(vec w, real ax, real ay)
{
    return 2 * w.z / (w.z + real_sqrt(w.z * w.z + ax * ax * w.x * w.x + ay * ay * w.y * w.y));
}

static real F(real eta, real c)
{
    real g = real_sqrt(eta * eta - 1 + c * c);
    real a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return a * a * (1 + b * b) / 2;
}

/* ---- Encodings ------------------------------------------------------------------------------- */

typedef struct angles {
    vec h;
    real c, one_minus_c, tan2, sine;
} angles;

static angles angles_of(vec wi, vec wo)
{
    angles a;
    vec s = sum(wi, wo), d = minus(wi, wo);
    real length = real_sqrt(dot(s, s));
    a.h = (vec){s.x / length, s.y / length, s.z / length};
    a.c = length / 2;
    a.one_minus_c = dot(d, d) / (4 * (1 + a.c));
    a.sine = real_sqrt(a.h.x * a.h.x + a.h.y * a.h.y);
    a.tan2 = (a.h.x * a.h.x + a.h.y * a.h.y) / (a.h.z * a.h.z);
    return a;
}

static void encode(hnbrdf_encoding encoding, vec wi, vec wo, const angles *a, real x[6])
{
    real low = wi.z < wo.z ? wi.z : wo.z, high = wi.z < wo.z ? wo.z : wi.z;
    real narrow = (real)1 / 100000, flat = (real)1 / 1000;
    switch (encoding) {
    case HNBRDF_ENCODING_DIRECTIONS:
        memcpy(x, &(real[6]){wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}, 6 * sizeof *x);
        return;
    case HNBRDF_ENCODING_HALF_DIFFERENCE:
        x[0] = 1 + real_log(narrow + a->tan2) / 4;
        x[1] = real_sqrt(a->sine);
        x[2] = a->c;
        x[3] = real_sqrt(a->one_minus_c);
        x[4] = wi.z * wo.z;
        x[5] = wi.z + wo.z;
        return;
    case HNBRDF_ENCODING_ANGLES_DIRECTED:
    case HNBRDF_ENCODING_ANGLES:
    case HNBRDF_ENCODING_ANGLES_ANISOTROPIC:
    case HNBRDF_ENCODING_ANGLES_AZIMUTHS:
        x[0] = 1 + real_log(narrow + a->tan2) / 4;
        x[1] = encoding == HNBRDF_ENCODING_ANGLES_ANISOTROPIC ? real_abs(a->h.x) : a->sine;
        x[2] = real_log(flat + a->one_minus_c) / 4;
        x[3] = encoding == HNBRDF_ENCODING_ANGLES_ANISOTROPIC ? real_abs(a->h.y) : a->one_minus_c;
        x[4] = encoding == HNBRDF_ENCODING_ANGLES_DIRECTED ? wi.z : low;
        x[5] = encoding == HNBRDF_ENCODING_ANGLES_DIRECTED ? wo.z : high;
        if (encoding == HNBRDF_ENCODING_ANGLES_AZIMUTHS) {
            x[1] = real_abs(a->h.x);
            x[5] = real_abs(wi.x - wo.x) / 2;
        }
        return;
    }
}

/* ---- The network ----------------------------------------------------------------------------- */

static real hard_gelu(real x)
{
    return x * limited(x / 3 + (real)1 / 2, 0, 1);
}

static void network(const hnbrdf_model_desc *desc, const float *latent, const real x[6],
                    real out[6])
{
    real from[HNBRDF_MAX_HIDDEN + 6 + HNBRDF_MAX_LATENT], to[HNBRDF_MAX_HIDDEN];
    int columns = 6 + desc->latent;
    for (int i = 0; i < 6; i++)
        from[i] = x[i];
    for (int i = 0; i < desc->latent; i++)
        from[6 + i] = latent[i];
    for (int k = 0; k <= desc->layers; k++) {
        int rows = k < desc->layers ? desc->hidden : desc->kind == HNBRDF_KIND_HYBRID ? 6 : 3;
        for (int r = 0; r < rows; r++) {
            to[r] = desc->biases[k][r];
            for (int i = 0; i < columns; i++)
                to[r] += (real)desc->weights[k][r * columns + i] * from[i];
        }
        for (int r = 0; r < rows; r++)
            from[r] = k < desc->layers ? hard_gelu(to[r]) : to[r];
        columns = rows;
    }
    memcpy(out, from, (size_t)columns * sizeof *out);
}

/* ---- All of it ------------------------------------------------------------------------------- */

static real specular_share(const hnbrdf_material *material)
{
    real specular = (real)5 / 100, diffuse = 0;
    for (int k = 0; k < 3; k++) {
        real r = ((real)material->eta[k] - 1) / ((real)material->eta[k] + 1);
        specular += r * r / 3;
        diffuse += (real)material->kd[k] / 3;
    }
    return limited(specular / (specular + diffuse), (real)2 / 10, (real)9 / 10);
}

/* The share of lobe k at this view: linear between knots at wo.z = (j/3)^2. */
static real share_at(const hnbrdf_lobes *lobes, int k, real z)
{
    real x = limited(3 * real_sqrt(z), 0, 3);
    int j = x < 1 ? 0 : x < 2 ? 1 : 2;
    return (1 - (x - j)) * lobes->share[k][j] + (x - j) * lobes->share[k][j + 1];
}

/* Density of reflections about normals drawn from D h.n, or about visible ones: D / (2 (k z +
 * |(ax x, ay y, z)|)) with the bound k of Eto and Tokuyoshi 2023. */
static real lobe_density(vec i, vec o, real scale, real ax, real ay)
{
    vec h = angles_of(i, o).h;
    real wo_h = angles_of(i, o).c, d = D(h, ax, ay);
    if (scale < 0)
        return d * h.z / (4 * wo_h);
    real a = ax < ay ? ax : ay, s = 1 + real_sqrt(o.x * o.x + o.y * o.y);
    real bound = (1 - a * a) * s * s / (s * s + a * a * o.z * o.z);
    real length = real_sqrt(ax * ax * o.x * o.x + ay * ay * o.y * o.y + o.z * o.z);
    return d / (2 * (bound * o.z + length));
}

double oracle_pdf(hnbrdf_kind kind, const hnbrdf_material *material, const float wi[3],
                  const float wo[3])
{
    if (!(wi[2] > 0.0f && wo[2] > 0.0f))
        return 0.0;
    vec i = in_tangent_frame(wi, material->rotation), o = in_tangent_frame(wo, material->rotation);
    const hnbrdf_lobes *lobes = &material->lobes;
    int neural = kind == HNBRDF_KIND_NEURAL, fitted = lobes->scale[0] != 0.0f;
    real sum = 0, rest = 1;
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        real scale = fitted ? (real)lobes->scale[k] : k == 0 ? 1 : 0;
        real share = fitted              ? share_at(lobes, k, o.z)
                     : k == 0 && !neural ? specular_share(material)
                                         : 0;
        real least = (real)HNBRDF_MIN_ALPHA, size = real_abs(scale);
        if (scale == 0 || share == 0)
            continue;
        sum +=
            share * lobe_density(i, o, scale,
                                 limited(size * (neural ? 1 : (real)material->alpha[0]), least, 1),
                                 limited(size * (neural ? 1 : (real)material->alpha[1]), least, 1));
        rest -= share;
    }
    return (double)limited(sum + limited(rest, 0, 1) * i.z / pi(), 0, HNBRDF_MAX_VALUE);
}

/* ---- Edits ----------------------------------------------------------------------------------- */

static real carried_kd(const hnbrdf_material *m, int k)
{
    real most = 4 * (real)m->fitted.kd[k];
    return m->kd[k] < most ? (real)m->kd[k] : most;
}

/* The specular share of f_a, over the channels, of the carried kd. */
static real specular_part(const hnbrdf_material *m, real c, real specular)
{
    real shine = 0, diffuse = 0;
    for (int k = 0; k < 3; k++) {
        diffuse += carried_kd(m, k) / pi();
        shine += F(m->eta[k], c) * specular;
    }
    return shine / (shine + diffuse);
}

/* h with its tangents times the ratios of fitted to present roughness, as far as f_a is specular,
 * no nearer to the horizon than h itself or 45 degrees. */
static vec fitted_half(const hnbrdf_material *m, vec h, real part)
{
    real x = 1 + part * ((real)m->fitted.alpha[0] / m->alpha[0] - 1);
    real y = 1 + part * ((real)m->fitted.alpha[1] / m->alpha[1] - 1);
    vec q = {h.x * x, h.y * y, h.z};
    real tan2 = (q.x * q.x + q.y * q.y) / (h.z * h.z), of_h = (h.x * h.x + h.y * h.y) / (h.z * h.z);
    real most = of_h > 1 ? of_h : 1, shrink = tan2 > most ? real_sqrt(most / tan2) : 1;
    q.x *= shrink;
    q.y *= shrink;
    real length = real_sqrt(dot(q, q));
    return (vec){q.x / length, q.y / length, q.z / length};
}

/* wi and wo turned with s to s', of the same length: d = wi - wo is turned by the rotation that
 * takes one to the other the shortest way. */
static void turn(vec *i, vec *o, vec s, vec to)
{
    vec d = minus(*i, *o), both = sum(s, to);
    real k = dot(d, both) / (dot(s, s) + dot(s, to)), j = 2 * dot(d, s) / dot(s, s);
    d = (vec){d.x - k * both.x + j * to.x, d.y - k * both.y + j * to.y,
              d.z - k * both.z + j * to.z};
    *i = (vec){(to.x + d.x) / 2, (to.y + d.y) / 2, (to.z + d.z) / 2};
    *o = (vec){(to.x - d.x) / 2, (to.y - d.y) / 2, (to.z - d.z) / 2};
}

/* A cosine that is lowered ends at 0.1, or where it is below. */
static real inclined_cosine(real cosine, real change)
{
    real moved = cosine + change / 2, least = cosine < 0.1f ? cosine : 0.1f;
    return moved > least ? moved : least;
}

/* What the network sees of an edited material in place of i and o, and of their angles. */
static void warp(const hnbrdf_model_desc *desc, const hnbrdf_material *m, real specular, vec *i,
                 vec *o, angles *a)
{
    vec s = sum(*i, *o), h = fitted_half(m, a->h, specular_part(m, a->c, specular));
    real length = real_sqrt(dot(s, s));
    a->h = h;
    a->sine = real_sqrt(h.x * h.x + h.y * h.y);
    a->tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
    vec to = {h.x * length, h.y * length, h.z * length};
    if (desc->encoding == HNBRDF_ENCODING_DIRECTIONS) {
        turn(i, o, s, to);
    } else { /* the cosines of incidence: their sum with s.z, their difference with its sine */
        real r2 = s.x * s.x + s.y * s.y, q2 = to.x * to.x + to.y * to.y;
        real sine = r2 > 0 ? real_sqrt(q2 / r2) : 1, grown = to.z - s.z;
        real difference = (sine - 1) * (i->z - o->z);
        real zi = inclined_cosine(i->z, grown + difference);
        real zo = inclined_cosine(o->z, grown - difference);
        vec d = minus(*i, *o); /* as long as it was, its azimuth too */
        real d2 = d.x * d.x + d.y * d.y, rest = d2 + (d.z - (zi - zo)) * (d.z + (zi - zo));
        real k = d2 > 0 ? real_sqrt((rest > 0 ? rest : 0) / d2) / 2 : (real)1 / 2;
        *i = (vec){k * d.x, k * d.y, zi};
        *o = (vec){-k * d.x, -k * d.y, zo};
    }
}

/* eta0, raised until the reflectance at normal incidence of eta is at most 16 times its own. */
static real fitted_eta(const hnbrdf_material *m, int k)
{
    real r = ((real)m->eta[k] - 1) / ((real)m->eta[k] + 1) / 4, raised = (1 + r) / (1 - r);
    return raised > m->fitted.eta[k] ? raised : m->fitted.eta[k];
}

static int is_edited(const hnbrdf_model_desc *desc, const hnbrdf_material *m)
{
    return desc->kind == HNBRDF_KIND_HYBRID && m->fitted.alpha[0] != 0.0f &&
           (memcmp(m->kd, m->fitted.kd, sizeof m->kd) != 0 ||
            memcmp(m->eta, m->fitted.eta, sizeof m->eta) != 0 ||
            memcmp(m->alpha, m->fitted.alpha, sizeof m->alpha) != 0);
}

/* Both parts of one channel of an edited material: what the correction less the floor is
 * multiplied by, and kd above 4 times the fitted one, over pi; *f_a with kd up to that. specular: D
 * G G over 4 wi.z wo.z of the material, fitted_specular: of the fitted one at the warped h. */
typedef struct edit {
    real ratio, added;
} edit;

static edit edit_of(const hnbrdf_material *m, int k, real c, real specular, real fitted_specular,
                    real *f_a)
{
    real kd0 = m->fitted.kd[k], kd = carried_kd(m, k);
    real fitted = kd0 / pi() + F(fitted_eta(m, k), c) * fitted_specular;
    *f_a = kd / pi() + F(m->eta[k], c) * specular;
    return (edit){limited(*f_a / fitted, 0, HNBRDF_MAX_VALUE), (m->kd[k] - kd) / pi()};
}

/* What f is multiplied by: k(wi.z) k(wo.z), k(z) = min(1, horizon + slope z). */
static real energy_factor(const hnbrdf_energy *energy, real zi, real zo)
{
    real horizon = energy->horizon, slope = energy->slope;
    if (energy->horizon == 0.0f && energy->slope == 0.0f)
        return 1;
    return limited(horizon + slope * zi, 0, 1) * limited(horizon + slope * zo, 0, 1);
}

void oracle_evaluate(const hnbrdf_model_desc *desc, const hnbrdf_material *material,
                     const float wi[3], const float wo[3], oracle_point *point)
{
    memset(point, 0, sizeof *point);
    if (!(wi[2] > 0.0f && wo[2] > 0.0f))
        return;
    int hybrid = desc->kind == HNBRDF_KIND_HYBRID, neural = desc->kind == HNBRDF_KIND_NEURAL;
    vec i = in_tangent_frame(wi, material->rotation), o = in_tangent_frame(wo, material->rotation);
    real ax = material->alpha[0], ay = material->alpha[1], limit = HNBRDF_MAX_EXPONENT;
    angles a = angles_of(i, o);
    point->pdf = oracle_pdf(desc->kind, material, wi, wo);

    real gg = G1(i, ax, ay) * G1(o, ax, ay) / (4 * i.z * o.z), d = D(a.h, ax, ay);
    real x[6] = {0}, out[6] = {0};
    const int edited = is_edited(desc, material);
    angles seen = a;
    if (desc->kind != HNBRDF_KIND_GGX) {
        vec seen_i = i, seen_o = o;
        if (edited)
            warp(desc, material, d * gg, &seen_i, &seen_o, &seen);
        encode(desc->encoding, seen_i, seen_o, &seen, x);
        network(desc, material->latent, x, out);
    }
    for (int k = 0; k < 6; k++) {
        point->encoded[k] = (double)x[k];
        point->outputs[k] = (double)out[k];
    }
    real before = 0;
    const real energy = energy_factor(&material->energy, i.z, o.z);
    if (edited) {
        real bx = material->fitted.alpha[0], by = material->fitted.alpha[1];
        before = D(seen.h, bx, by) * G1(i, bx, by) * G1(o, bx, by) / (4 * i.z * o.z);
    }
    for (int k = 0; k < 3; k++) {
        real f_a = neural ? 0 : (real)material->kd[k] / pi() + F(material->eta[k], a.c) * d * gg;
        real f = f_a;
        edit change = {1, 0};
        point->analytic[k] = (double)limited(f_a, 0, HNBRDF_MAX_VALUE);
        if (edited)
            change = edit_of(material, k, a.c, d * gg, before, &f_a);
        if (hybrid || neural) {
            real scale = desc->scale == 0.0f ? 1 : (real)desc->scale;
            f = change.ratio * real_exp(limited(scale * out[k] + desc->shift, -limit, limit));
            if (hybrid)
                f += f_a / (1 + real_exp(limited(-out[3 + k], -limit, limit))) + change.added;
        }
        point->ratio[k] = (double)change.ratio;
        real floor = hybrid || neural ? change.ratio * (real)desc->floor : 0;
        point->scale[k] = (double)(energy * limited(f, 0, HNBRDF_MAX_VALUE));
        point->value[k] = (double)(energy * limited(f - floor, 0, HNBRDF_MAX_VALUE));
    }
}
