/* pairs.c: random numbers and the three ways to draw pairs of directions. Every error figure
 * names one of them, so what they draw from a seed must never change. */
#include "hnbrdf/measured.h"

#include <math.h>

static const double PI = 3.14159265358979323846;
static const float MIN_Z = 0.01f; /* nearer to the horizon measurements are extrapolated */

/* ---- PCG32: M. O'Neill, PCG: A Family of Simple Fast Space-Efficient Statistically Good
 * Algorithms for Random Number Generation, 2014; the XSH-RR variant with 64 bits of state.
 * ------------------- */

uint32_t hnbrdf_rng_u32(hnbrdf_rng *rng)
{
    uint64_t old = rng->state;
    rng->state = old * 6364136223846793005u + (rng->stream | 1u);
    uint32_t shifted = (uint32_t)(((old >> 18) ^ old) >> 27);
    uint32_t turn = (uint32_t)(old >> 59);
    return shifted >> turn | shifted << (-turn & 31u);
}

void hnbrdf_rng_seed(hnbrdf_rng *rng, uint64_t seed, uint64_t sequence)
{
    rng->state = 0;
    rng->stream = sequence << 1 | 1u;
    hnbrdf_rng_u32(rng);
    rng->state += seed;
    hnbrdf_rng_u32(rng);
}

float hnbrdf_rng_float(hnbrdf_rng *rng)
{
    return (float)(hnbrdf_rng_u32(rng) >> 8) * 0x1p-24f;
}

/* ---- Samplers -------------------------------------------------------------------------------- */

const char *hnbrdf_sampler_name(hnbrdf_sampler sampler)
{
    switch (sampler) {
    case HNBRDF_SAMPLER_UNIFORM:
        return "uniform";
    case HNBRDF_SAMPLER_COSINE:
        return "cosine";
    case HNBRDF_SAMPLER_GRID:
        return "grid";
    }
    return NULL;
}

static double uniform(hnbrdf_rng *rng)
{
    return (double)hnbrdf_rng_float(rng);
}

static void from_height(double z, double phi, float w[3])
{
    double across = sqrt(1.0 - z * z); /* z is in [0, 1] */
    w[0] = (float)(across * cos(phi));
    w[1] = (float)(across * sin(phi));
    w[2] = (float)z;
}

/* Uniform in solid angle: z is uniform. */
static void draw_uniform(hnbrdf_rng *rng, float w[3])
{
    double z = 1.0 - uniform(rng);
    from_height(z, 2 * PI * uniform(rng), w);
}

/* Density cos/pi: z^2 is uniform. */
static void draw_cosine(hnbrdf_rng *rng, float w[3])
{
    double z = sqrt(1.0 - uniform(rng));
    from_height(z, 2 * PI * uniform(rng), w);
}

static void turn(double x, double y, double z, double phi, float w[3])
{
    double c = cos(phi), s = sin(phi);
    w[0] = (float)(c * x - s * y);
    w[1] = (float)(s * x + c * y);
    w[2] = (float)z;
}

/* Uniform in MERL's bins (theta_h grows as the square of its bin), over the full circle of phi_d,
 * so that neither direction is preferred; then turned about n as a whole. May fall below the
 * horizon. */
static void draw_grid(hnbrdf_rng *rng, float wi[3], float wo[3])
{
    double u = uniform(rng), theta_h = u * u * PI / 2, theta_d = uniform(rng) * PI / 2;
    double phi_d = 2 * PI * uniform(rng), phi_h = 2 * PI * uniform(rng);
    double ch = cos(theta_h), sh = sin(theta_h), cd = cos(theta_d), sd = sin(theta_d);
    double x = sd * cos(phi_d), y = sd * sin(phi_d);
    turn(sh * cd + ch * x, y, ch * cd - sh * x, phi_h, wi);
    turn(sh * cd - ch * x, -y, ch * cd + sh * x, phi_h, wo);
}

void hnbrdf_sampler_draw(hnbrdf_sampler sampler, hnbrdf_rng *rng, float wi[3], float wo[3])
{
    do {
        if (sampler == HNBRDF_SAMPLER_GRID) {
            draw_grid(rng, wi, wo);
        } else if (sampler == HNBRDF_SAMPLER_COSINE) {
            draw_cosine(rng, wi);
            draw_cosine(rng, wo);
        } else {
            draw_uniform(rng, wi);
            draw_uniform(rng, wo);
        }
    } while (!(wi[2] >= MIN_Z && wo[2] >= MIN_Z));
}
