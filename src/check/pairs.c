/* pairs.c: the direction pairs a shader is verified on. */
#include "check/pairs.h"

#include <math.h>
#include <string.h>

const char *check_pair_class_name(check_pair_class class_of_pair)
{
    static const char *const names[CHECK_PAIR_CLASSES] = {"uniform", "grid",    "mirror",
                                                          "grazing", "retro",   "normal",
                                                          "swapped", "extreme", "not finite"};
    return names[class_of_pair];
}

static void normalise(float w[3])
{
    float length = sqrtf(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int i = 0; i < 3; i++)
        w[i] /= length;
}

/* 10^-low to 10^-high. */
static float power_of_ten(hnbrdf_rng *rng, float low, float high)
{
    return (float)pow(10.0, (double)(-low - (high - low) * hnbrdf_rng_float(rng)));
}

static float sign(hnbrdf_rng *rng)
{
    return hnbrdf_rng_u32(rng) & 1 ? 1.0f : -1.0f;
}

/* Leaves a quarter as they are; the others are turned by 1e-7 to 0.1. */
static void disturb(hnbrdf_rng *rng, float w[3])
{
    if (hnbrdf_rng_u32(rng) % 4 == 0)
        return;
    float size = power_of_ten(rng, 1.0f, 7.0f);
    w[0] += size * (hnbrdf_rng_float(rng) - 0.5f);
    w[1] += size * (hnbrdf_rng_float(rng) - 0.5f);
    normalise(w);
}

static void graze(hnbrdf_rng *rng, float w[3])
{
    w[2] = 0.0f;
    if (w[0] == 0.0f && w[1] == 0.0f)
        w[0] = 1.0f;
    normalise(w);
    w[2] = power_of_ten(rng, 1.0f, 6.0f);
    normalise(w);
}

static void make_extreme(hnbrdf_rng *rng, float wi[3], float wo[3])
{
    static const float heights[] = {0.0f, -0.0f, -0.5f, 1e-20f, 1e-30f, 1e-38f, 1e-42f};
    switch (hnbrdf_rng_u32(rng) % 5) {
    case 0:
        wi[2] = heights[hnbrdf_rng_u32(rng) % 7];
        break;
    case 1:
        wi[2] = heights[hnbrdf_rng_u32(rng) % 7];
        wo[2] = heights[hnbrdf_rng_u32(rng) % 7];
        break;
    case 2: /* opposite along the horizon: wi + wo nearly vanishes */
        graze(rng, wi);
        wo[0] = -wi[0];
        wo[1] = -wi[1];
        wo[2] = wi[2];
        break;
    case 3:
        wi[0] = wi[1] = wo[0] = 0.0f;
        break;
    default:
        for (int i = 0; i < 3; i++) {
            wi[i] *= hnbrdf_rng_u32(rng) & 1 ? 1.5f : 0.5f;
            wo[i] *= 2.0f;
        }
    }
}

static void make_not_finite(hnbrdf_rng *rng, float pair[6])
{
    static const float values[] = {INFINITY, -INFINITY, NAN};
    pair[hnbrdf_rng_u32(rng) % 6] = values[hnbrdf_rng_u32(rng) % 3];
}

static check_pair_class class_of(size_t k)
{
    static const check_pair_class sixteen[16] = {
        CHECK_PAIR_UNIFORM, CHECK_PAIR_SWAPPED, CHECK_PAIR_GRID,    CHECK_PAIR_MIRROR,
        CHECK_PAIR_UNIFORM, CHECK_PAIR_GRAZING, CHECK_PAIR_SWAPPED, CHECK_PAIR_UNIFORM,
        CHECK_PAIR_GRID,    CHECK_PAIR_SWAPPED, CHECK_PAIR_RETRO,   CHECK_PAIR_UNIFORM,
        CHECK_PAIR_MIRROR,  CHECK_PAIR_GRID,    CHECK_PAIR_GRAZING, CHECK_PAIR_EXTREME};
    if (k % 64 == 63)
        return CHECK_PAIR_NOT_FINITE;
    return k % 32 == 16 ? CHECK_PAIR_NORMAL : sixteen[k % 16];
}

check_pair_class check_pair_draw(hnbrdf_rng *rng, size_t k, float pair[6])
{
    float *wi = pair, *wo = pair + 3, before[6];
    check_pair_class class_of_pair = class_of(k);
    memcpy(before, pair, sizeof before);
    hnbrdf_sampler_draw(class_of_pair == CHECK_PAIR_GRID ? HNBRDF_SAMPLER_GRID
                                                         : HNBRDF_SAMPLER_UNIFORM,
                        rng, wi, wo);
    switch (class_of_pair) {
    case CHECK_PAIR_MIRROR:
        wo[0] = -wi[0];
        wo[1] = -wi[1];
        wo[2] = wi[2];
        disturb(rng, wo);
        break;
    case CHECK_PAIR_RETRO:
        memcpy(wo, wi, 3 * sizeof *wo);
        disturb(rng, wo);
        break;
    case CHECK_PAIR_GRAZING:
        graze(rng, wi);
        if (sign(rng) > 0.0f)
            graze(rng, wo);
        break;
    case CHECK_PAIR_NORMAL:
        wi[0] = wi[1] = 0.0f;
        wi[2] = 1.0f;
        if (sign(rng) > 0.0f)
            memcpy(wo, wi, 3 * sizeof *wo);
        break;
    case CHECK_PAIR_SWAPPED:
        memcpy(wi, before + 3, 3 * sizeof *wi);
        memcpy(wo, before, 3 * sizeof *wo);
        break;
    case CHECK_PAIR_EXTREME:
        make_extreme(rng, wi, wo);
        break;
    case CHECK_PAIR_NOT_FINITE:
        make_not_finite(rng, pair);
        break;
    default:
        break;
    }
    return class_of_pair;
}
