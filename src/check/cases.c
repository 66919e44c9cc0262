/* cases.c: the hard cases: what each does to a material, and which pairs of directions it looks
 * at. */
#include "check/cases.h"

#include "base/hash.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const float TAU = 6.28318531f;

static float uniform(hnbrdf_rng *rng, float low, float high)
{
    return low + (high - low) * hnbrdf_rng_float(rng);
}

/* 10^low to 10^high, uniform in the exponent. */
static float power(hnbrdf_rng *rng, float low, float high)
{
    return powf(10.0f, uniform(rng, low, high));
}

static unsigned pick(hnbrdf_rng *rng, unsigned count)
{
    return hnbrdf_rng_u32(rng) % count;
}

/* ---- Materials ------------------------------------------------------------------------------- */

static void as_it_is(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    (void)rng;
    (void)number;
    (void)m;
}

static float any_alpha(hnbrdf_rng *rng)
{
    return fminf(fmaxf(power(rng, -4.0f, 0.0f), HNBRDF_MIN_ALPHA), HNBRDF_MAX_ALPHA);
}

static void any_material(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    for (int c = 0; c < 3; c++) {
        m->kd[c] = hnbrdf_rng_float(rng);
        m->eta[c] = fmaxf(1.0f + power(rng, -3.0f, 1.0f), 1.0f + FLT_EPSILON);
    }
    m->alpha[0] = any_alpha(rng);
    m->alpha[1] = number % 2 ? any_alpha(rng) : m->alpha[0];
    m->rotation = 0.0f;
}

/* One decade after the other from the floor to 1, exactly. */
static void each_alpha(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    static const float alphas[] = {HNBRDF_MIN_ALPHA, 3e-4f, 1e-3f, 1e-2f, 0.1f, 1.0f};
    any_material(rng, 0, m);
    m->alpha[0] = m->alpha[1] = alphas[number % 6];
}

static void needle(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    static const float alphas[][2] = {
        {HNBRDF_MIN_ALPHA, 1.0f}, {1.0f, HNBRDF_MIN_ALPHA}, {1e-3f, 1.0f}, {1e-4f, 1e-2f}};
    any_material(rng, 0, m);
    memcpy(m->alpha, alphas[number % 4], sizeof m->alpha);
}

static void turned_needle(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    needle(rng, number, m);
    m->rotation = number == 0 ? TAU / 4.0f : uniform(rng, -TAU, TAU);
}

static void near_mirror(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    static const float alphas[] = {HNBRDF_MIN_ALPHA, 3e-4f, 1e-3f};
    any_material(rng, 0, m);
    m->alpha[0] = m->alpha[1] = alphas[number % 3];
    if (number % 4 == 3)
        m->alpha[1] = alphas[(number + 1) % 3];
}

/* Indices from the least above 1 to the greatest, apart from channel to channel; kd all or
 * nothing. */
static void far_channels(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    static const float etas[] = {1.0f + FLT_EPSILON, HNBRDF_MAX_ETA, 1.0001f, 1.5f, 30.0f};
    m->alpha[0] = m->alpha[1] = any_alpha(rng);
    m->rotation = 0.0f;
    for (int c = 0; c < 3; c++) {
        m->eta[c] = etas[(number + c) % 5];
        m->kd[c] = (float)(number / 5 % 2);
    }
}

static void great_latent(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    float factor = powf(10.0f, (float)(number % 24) * 0.5f);
    (void)rng;
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        m->latent[i] *= factor;
}

/* As an artist does. */
static void other_alpha(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    for (int k = 0; k < 2; k++)
        m->alpha[k] =
            fminf(fmaxf(m->alpha[k] * power(rng, -0.6f, 0.6f), HNBRDF_MIN_ALPHA), HNBRDF_MAX_ALPHA);
    if (number % 2)
        m->alpha[1] = m->alpha[0];
}

/* From one end to the other: what was fitted is at the other end, or where it was. */
static void far_edit(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    const float low = HNBRDF_MIN_ALPHA, high = HNBRDF_MAX_ALPHA;
    const float kd = (float)(number % 2), eta = number / 2 % 2 ? HNBRDF_MAX_ETA : 1.0001f;
    for (int k = 0; k < 2; k++)
        m->alpha[k] = pick(rng, 2) ? low : high;
    for (int c = 0; c < 3; c++) {
        m->kd[c] = kd;
        m->eta[c] = eta;
        if (number % 3 == 0) {
            m->fitted.kd[c] = 1.0f - kd;
            m->fitted.eta[c] = 2.5f - kd;
        }
    }
    if (number % 3 == 0)
        m->fitted.alpha[0] = m->fitted.alpha[1] = m->alpha[0] > 0.5f ? low : high;
}

/* Any factor on energy that is allowed, or none; any lobes: narrow and wide, all normals or
 * visible ones; at some views all samples or none. */
static void any_lobes(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    any_material(rng, number, m);
    for (int k = 0; k < HNBRDF_LOBES; k++)
        m->lobes.scale[k] =
            (pick(rng, 4) ? 1.0f : -1.0f) * fminf(fmaxf(power(rng, -4.0f, 4.0f), 1e-4f), 1e4f);
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++) {
        m->lobes.share[0][j] = pick(rng, 4) ? hnbrdf_rng_float(rng) : (float)pick(rng, 2);
        m->lobes.share[1][j] =
            (1.0f - m->lobes.share[0][j]) * (pick(rng, 4) ? hnbrdf_rng_float(rng) : 1.0f);
    }
    if (number % 2) {
        m->energy.horizon = pick(rng, 4) ? hnbrdf_rng_float(rng) : (float)pick(rng, 2);
        m->energy.slope = power(rng, -2.0f, 4.0f);
    }
}

/* NaN or an infinity in one field after the other, then in none. */
static void broken_field(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    static const float values[] = {NAN, INFINITY, -INFINITY};
    float fields[STABILITY_FIELDS], value = values[pick(rng, 3)];
    memcpy(fields, m, sizeof fields);
    if (number < STABILITY_FIELDS)
        fields[number] = value;
    memcpy(m, fields, sizeof fields);
}

/* Zero, negative and huge: what hnbrdf_material_check() refuses. */
static void forbidden(hnbrdf_rng *rng, int number, hnbrdf_material *m)
{
    static const float values[] = {0.0f, -1.0f, 1.0f, 1e-30f, 1e30f, -1e-30f, 1e-42f, FLT_MAX};
    float fields[8], value = values[pick(rng, 8)];
    memcpy(fields, m, sizeof fields);
    fields[number % 8] = value;
    if (number >= 8)
        fields[pick(rng, 8)] = values[pick(rng, 8)];
    memcpy(m, fields, sizeof fields);
}

/* ---- Pairs of directions --------------------------------------------------------------------- */

static void to_length(float w[3], double length)
{
    double now = sqrt((double)w[0] * w[0] + (double)w[1] * w[1] + (double)w[2] * w[2]);
    for (int i = 0; i < 3; i++)
        w[i] = (float)(w[i] * (length / now));
}

/* Height z, any azimuth. */
static void at_height(hnbrdf_rng *rng, float z, float w[3])
{
    float phi = TAU * hnbrdf_rng_float(rng);
    double across = sqrt(fmax(0.0, 1.0 - (double)z * z));
    w[0] = (float)(across * cos((double)phi));
    w[1] = (float)(across * sin((double)phi));
    w[2] = z;
}

static void any_direction(hnbrdf_rng *rng, float w[3])
{
    at_height(rng, 1.0f - hnbrdf_rng_float(rng), w);
}

static void any_pair(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    (void)m;
    (void)k;
    any_direction(rng, wi);
    any_direction(rng, wo);
}

/* Half vectors over the whole lobe, up to slopes of 8 alpha. */
static void lobe_pair(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    double radius = k ? 8.0 * (double)hnbrdf_rng_float(rng) : 0.0,
           phi = (double)(TAU * hnbrdf_rng_float(rng));
    double x = (double)m->alpha[0] * radius * cos(phi), y = (double)m->alpha[1] * radius * sin(phi);
    double cosine = cos((double)m->rotation), sine = sin((double)m->rotation);
    double h[3] = {cosine * x - sine * y, cosine * y + sine * x, 1.0};
    any_direction(rng, wo);
    double twice = 2.0 * (wo[0] * h[0] + wo[1] * h[1] + wo[2]) / (x * x + y * y + 1.0);
    for (int i = 0; i < 3; i++)
        wi[i] = (float)(twice * h[i] - wo[i]);
    wi[2] = fabsf(wi[2]);
}

static void mirror(const float w[3], float to[3])
{
    to[0] = -w[0];
    to[1] = -w[1];
    to[2] = w[2];
}

/* One component of a direction to the next float. */
static void nudge(hnbrdf_rng *rng, float w[3])
{
    float *component = &w[pick(rng, 3)];
    *component = nextafterf(*component, pick(rng, 2) ? 2.0f : -2.0f);
}

static void mirror_pair(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    any_pair(rng, k, m, wi, wo);
    mirror(wo, wi);
    if (k % 2)
        nudge(rng, wi);
}

static void half_at_normal(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3],
                           float wo[3])
{
    any_pair(rng, k, m, wi, wo);
    mirror(wo, wi);
    wi[0] += 2e-7f * uniform(rng, -1.0f, 1.0f);
    wi[1] += 2e-7f * uniform(rng, -1.0f, 1.0f);
}

/* Both within 1e-7 of the horizon, on one side. */
static void half_at_horizon(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3],
                            float wo[3])
{
    (void)m;
    at_height(rng, power(rng, -9.0f, -7.0f), wi);
    memcpy(wo, wi, 3 * sizeof *wo);
    wo[2] = power(rng, -9.0f, -7.0f);
    if (k % 2) {
        wo[0] += uniform(rng, -0.5f, 0.5f);
        to_length(wo, 1.0);
    }
}

static void grazing(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    any_pair(rng, k, m, wi, wo);
    at_height(rng, power(rng, -7.0f, -1.0f), k % 2 ? wi : wo);
    if (k % 3 == 0)
        at_height(rng, power(rng, -7.0f, -1.0f), wi);
}

static void smallest_cosine(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3],
                            float wo[3])
{
    static const float heights[] = {FLT_MIN, 1e-37f, 1e-30f, 1e-20f, 1e-12f, 1e-7f};
    any_pair(rng, k, m, wi, wo);
    at_height(rng, heights[pick(rng, 6)], k % 2 ? wi : wo);
}

static void both_smallest(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3],
                          float wo[3])
{
    static const float heights[] = {FLT_MIN, 1e-37f, 1e-30f, 1e-20f, 1e-12f};
    (void)m;
    at_height(rng, heights[pick(rng, 5)], wi);
    at_height(rng, heights[pick(rng, 5)], wo);
    if (k % 4 == 0) { /* opposite but for their heights */
        wo[0] = -wi[0];
        wo[1] = -wi[1];
    }
}

static void at_zero(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    static const float heights[] = {0.0f, -0.0f, 1e-42f, FLT_TRUE_MIN, -FLT_TRUE_MIN, -1e-7f};
    any_pair(rng, k, m, wi, wo);
    (k % 2 ? wi : wo)[2] = heights[pick(rng, 6)];
    if (k % 5 == 0)
        for (int i = 0; i < 3; i++)
            wo[i] = -wi[i];
}

static void retro(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    any_pair(rng, k, m, wi, wo);
    if (k % 3 == 0)
        at_height(rng, power(rng, -7.0f, -1.0f), wi);
    memcpy(wo, wi, 3 * sizeof *wo);
    if (k % 2)
        nudge(rng, wo);
    wo[2] = fmaxf(wo[2], FLT_MIN);
}

/* wi = -wo but for heights of 1e-7 to 1e-2, and within an ulp of that. */
static void nearly_opposite(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3],
                            float wo[3])
{
    (void)m;
    at_height(rng, power(rng, -7.0f, -2.0f), wi);
    mirror(wi, wo);
    if (k % 2)
        wo[2] = power(rng, -7.0f, -2.0f);
    if (k % 3)
        nudge(rng, wo);
}

/* One is the other's negative, or was before a component moved by an ulp; at the horizon too. */
static void opposite(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    static const float heights[] = {0.0f, -0.0f, FLT_TRUE_MIN, FLT_MIN, 1e-7f};
    any_pair(rng, k, m, wi, wo);
    if (k % 2)
        at_height(rng, heights[pick(rng, 5)], wi);
    for (int i = 0; i < 3; i++)
        wo[i] = -wi[i];
    if (k % 3)
        nudge(rng, wo);
}

/* Where a mirror sends what grazes it: wi within an ulp of there. */
static void grazing_mirror(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3],
                           float wo[3])
{
    (void)m;
    at_height(rng, power(rng, -7.0f, -2.0f), wo);
    mirror(wo, wi);
    if (k % 2)
        nudge(rng, wi);
}

static void not_unit(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    static const double off[] = {1e-6, 1e-3, 0.1};
    any_pair(rng, k, m, wi, wo);
    if (k % 2)
        mirror(wo, wi);
    to_length(wi, 1.0 + off[pick(rng, 3)] * (pick(rng, 2) ? 1.0 : -1.0));
    to_length(wo, 1.0 + off[pick(rng, 3)] * (pick(rng, 2) ? 1.0 : -1.0));
}

static void any_length(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    any_pair(rng, k, m, wi, wo);
    to_length(wi, pow(10.0, (double)uniform(rng, -38.0f, 38.0f)));
    if (k % 2)
        to_length(wo, pow(10.0, (double)uniform(rng, -38.0f, 38.0f)));
}

static void broken_pair(hnbrdf_rng *rng, int k, const hnbrdf_material *m, float wi[3], float wo[3])
{
    static const float values[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -NAN};
    any_pair(rng, k, m, wi, wo);
    wi[k % 3] = values[pick(rng, 5)];
    if (k % 2)
        wo[pick(rng, 3)] = values[pick(rng, 5)];
}

/* ---- The table ------------------------------------------------------------------------------- */

#define OFTEN_CANCELS                                                                           \
    "an exponent that is a small difference of great terms: what the network sums up has lost " \
    "its "                                                                                      \
    "digits"

const stability_case stability_cases[] = {
    {"ordinary", "any material, any directions", NULL, STABILITY_ACCURATE, STABILITY_ACCURATE,
     .change = any_material, .pair = any_pair},
    {"as-fitted", "the model's materials as they are, any directions", NULL, STABILITY_ACCURATE,
     STABILITY_ACCURATE, .change = as_it_is, .pair = any_pair},
    {"alpha", "alpha 1e-4 to 1, half vectors over the lobe", NULL, STABILITY_ACCURATE,
     STABILITY_ACCURATE, .change = each_alpha, .pair = lobe_pair},
    {"anisotropy", "alpha_x : alpha_y to 1e4 : 1, half vectors over the lobe", NULL,
     STABILITY_ACCURATE, STABILITY_ACCURATE, .change = needle, .pair = lobe_pair},
    {"turned", "the same in a turned tangent frame",
     "turning rounds x and y of each direction: that moves h across the needle, by 9 2^-24/(alpha "
     "s.z) "
     "of its width",
     STABILITY_TURNED, STABILITY_TURNED, .change = turned_needle, .pair = lobe_pair},
    {"half-at-normal", "half vector within 1e-7 of n", NULL, STABILITY_ACCURATE, STABILITY_ACCURATE,
     .change = each_alpha, .pair = half_at_normal},
    {"half-at-horizon", "half vector within 1e-7 of the horizon", NULL, STABILITY_ACCURATE,
     STABILITY_ACCURATE, .change = each_alpha, .pair = half_at_horizon},
    {"grazing", "one or both cosines 1e-7 to 0.1", NULL, STABILITY_ACCURATE, STABILITY_ACCURATE,
     .change = any_material, .pair = grazing},
    {"smallest-cosine", "one cosine down to the smallest normal float", NULL, STABILITY_ACCURATE,
     STABILITY_ACCURATE, .change = any_material, .pair = smallest_cosine},
    {"both-smallest", "both cosines 1e-12 to the smallest normal float",
     "below 1e-19 the squares of wi.z + wo.z, and of |wi + wo| of opposite directions, are no "
     "floats",
     STABILITY_FINITE, STABILITY_FINITE, .change = any_material, .pair = both_smallest},
    {"at-zero", "a cosine 0, -0, subnormal or negative; wi = -wo",
     "a subnormal cosine may be flushed to 0, which is below the horizon", STABILITY_FINITE,
     STABILITY_FINITE, .change = any_material, .pair = at_zero},
    {"retro", "wi = wo, and within an ulp", NULL, STABILITY_ACCURATE, STABILITY_ACCURATE,
     .change = each_alpha, .pair = retro},
    {"mirror", "wi the mirror image of wo, and within an ulp", NULL, STABILITY_ACCURATE,
     STABILITY_ACCURATE, .change = each_alpha, .pair = mirror_pair},
    {"opposite", "wi = -wo but for cosines of 1e-7 to 0.01, and within an ulp", NULL,
     STABILITY_ACCURATE, STABILITY_ACCURATE, .change = each_alpha, .pair = nearly_opposite},
    {"opposite-exact", "wi = -wo exactly and within an ulp: one of them is not above the horizon",
     NULL, STABILITY_ACCURATE, STABILITY_ACCURATE, .change = any_material, .pair = opposite},
    {"mirror-grazing",
     "alpha 1e-4 to 1e-3, mirror image at cosines 1e-7 to 0.01, and within an ulp", NULL,
     STABILITY_ACCURATE, STABILITY_ACCURATE, .change = near_mirror, .pair = grazing_mirror},
    {"edited", "kd, eta and alpha edited to anything, any directions", NULL, STABILITY_ACCURATE,
     STABILITY_ACCURATE, .change = any_material, .pair = any_pair, .edited = 1},
    {"edited-alpha", "alpha edited by up to 4 times, half vectors over the lobe", NULL,
     STABILITY_ACCURATE, STABILITY_ACCURATE, .change = other_alpha, .pair = lobe_pair, .edited = 1},
    {"edited-far",
     "alpha edited to 1e-4 and to 1, eta and kd to their ends, half vectors over the "
     "lobe",
     NULL, STABILITY_ACCURATE, STABILITY_ACCURATE, .change = far_edit, .pair = lobe_pair,
     .edited = 1},
    {"edited-grazing", "edited to anything, one or both cosines 1e-7 to 0.1", NULL,
     STABILITY_ACCURATE, STABILITY_ACCURATE, .change = any_material, .pair = grazing, .edited = 1},
    {"lobes", "lobes for sampling 1e-4 to 1e4 times as wide as alpha, shares 0 to 1", NULL,
     STABILITY_ACCURATE, STABILITY_ACCURATE, .change = any_lobes, .pair = lobe_pair},
    {"eta", "eta 1 + 2^-23 to 1000, channels far apart; kd 0 and 1", NULL, STABILITY_ACCURATE,
     STABILITY_ACCURATE, .change = far_channels, .pair = lobe_pair},
    {"latent", "latent code times 1 to 3e11", OFTEN_CANCELS, STABILITY_ACCURATE, STABILITY_FINITE,
     .change = great_latent, .pair = any_pair},
    {"weights-12", "the largest weight 12, as in published models", OFTEN_CANCELS,
     STABILITY_ACCURATE, STABILITY_FINITE, .change = as_it_is, .pair = any_pair,
     .largest_weight = 12.0f},
    {"weights-1200", "the largest weight 1200: half precision overflows", OFTEN_CANCELS,
     STABILITY_ACCURATE, STABILITY_FINITE, .change = as_it_is, .pair = any_pair,
     .largest_weight = 1200.0f},
    {"weights-100", "weights and biases times 100", OFTEN_CANCELS, STABILITY_ACCURATE,
     STABILITY_FINITE, .change = as_it_is, .pair = any_pair, .weight_factor = 100.0f},
    {"weights-1e12", "weights and biases times 1e12: products overflow", OFTEN_CANCELS,
     STABILITY_ACCURATE, STABILITY_FINITE, .change = as_it_is, .pair = any_pair,
     .weight_factor = 1e12f},
    {"not-unit", "lengths off by 1e-6, 1e-3, 10 %", NULL, STABILITY_ACCURATE, STABILITY_ACCURATE,
     .change = any_material, .pair = not_unit},
    {"any-length", "lengths of 1e-38 to 1e38", "squares overflow and underflow", STABILITY_FINITE,
     STABILITY_FINITE, .change = any_material, .pair = any_length},
    {"forbidden", "materials out of their ranges", "evaluation trusts the ranges", STABILITY_FINITE,
     STABILITY_FINITE, .change = forbidden, .pair = lobe_pair, .not_a_number = 1},
    {"not-finite", "NaN and infinity in directions", "there is no true value", STABILITY_FINITE,
     STABILITY_FINITE, .change = as_it_is, .pair = broken_pair, .not_a_number = 1},
    {"not-finite-field", "NaN and infinity in each field of a material", "there is no true value",
     STABILITY_FINITE, STABILITY_FINITE, .change = broken_field, .pair = any_pair,
     .not_a_number = 1},
    {"not-finite-u", "NaN, infinity and numbers outside of [0, 1) for sampling",
     "there is no true value", STABILITY_FINITE, STABILITY_FINITE, .change = any_material,
     .pair = any_pair, .not_a_number = 1, .broken_u = 1},
};
const int stability_case_count = sizeof stability_cases / sizeof stability_cases[0];

/* What a case draws does not depend on its place in the table. */
static uint64_t hash_of(const char *name)
{
    return hnbrdf_hash(HNBRDF_HASH_START, name, strlen(name));
}

void stability_block_make(const stability_case *what, int number, const hnbrdf_material *material,
                          stability_block *block)
{
    static const float ends[] = {0.0f, 1.0f - 0x1p-24f, 0.5f},
                       broken[] = {NAN, -NAN, INFINITY, -INFINITY, 1.0f, -0.5f, 1e9f, FLT_MAX};
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, hash_of(what->name), (uint64_t)number);
    block->material = *material;
    if (!what->edited)
        memset(&block->material.fitted, 0, sizeof block->material.fitted);
    what->change(&rng, number, &block->material);
    for (int k = 0; k < STABILITY_BLOCK; k++) {
        what->pair(&rng, k, &block->material, block->pairs[k], block->pairs[k] + 3);
        for (int i = 0; i < 2; i++) {
            float u = hnbrdf_rng_float(&rng);
            block->u[k][i] = what->broken_u && k % 2 ? broken[pick(&rng, 8)]
                             : k % 3 == 0            ? ends[pick(&rng, 3)]
                                                     : u;
        }
    }
}
