/* core_support.c: random numbers, directions, materials and models for the core tests. */
#include "core_support.h"

#include "core/model.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

rng rng_make(uint64_t seed)
{
    rng r = {seed * 0x9e3779b97f4a7c15u + 0x2545f4914f6cdd1du};
    r.state += r.state == 0;
    for (int i = 0; i < 8; i++)
        rng_u32(&r);
    return r;
}

uint32_t rng_u32(rng *r)
{
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return (uint32_t)((r->state * 0x2545f4914f6cdd1du) >> 32);
}

float rng_float(rng *r)
{
    return (float)(rng_u32(r) >> 8) * 0x1p-24f;
}

float rng_range(rng *r, float low, float high)
{
    return low + (high - low) * rng_float(r);
}

float rng_log_range(rng *r, float low, float high)
{
    return expf(rng_range(r, logf(low), logf(high)));
}

float rng_normal(rng *r)
{
    float sum = rng_float(r) + rng_float(r) + rng_float(r) + rng_float(r);
    return (sum - 2.0f) * 1.7320508f;
}

void direction(double cos_theta, double phi, float w[3])
{
    double sine = sqrt(1.0 - cos_theta * cos_theta);
    w[0] = (float)(sine * cos(phi));
    w[1] = (float)(sine * sin(phi));
    w[2] = (float)cos_theta;
}

void direction_uniform(rng *r, float w[3])
{
    double cos_theta = 1.0 - (double)rng_float(r);
    direction(cos_theta, 2.0 * pi * (double)rng_float(r), w);
}

void direction_grazing(rng *r, float w[3])
{
    double cos_theta = (double)rng_log_range(r, 1e-6f, 0.1f);
    direction(cos_theta, 2.0 * pi * (double)rng_float(r), w);
}

int direction_near_mirror(rng *r, const float alpha[2], const float wo[3], float wi[3])
{
    double radius = 4.0 * (double)rng_float(r), phi = 2.0 * pi * (double)rng_float(r);
    double h[3] = {(double)alpha[0] * radius * cos(phi), (double)alpha[1] * radius * sin(phi), 1.0};
    double h2 = h[0] * h[0] + h[1] * h[1] + 1.0;
    double k = 2.0 * ((double)wo[0] * h[0] + (double)wo[1] * h[1] + (double)wo[2] * h[2]) / h2;
    for (int i = 0; i < 3; i++)
        wi[i] = (float)(k * h[i] - (double)wo[i]);
    return wi[2] > 0.0f;
}

hnbrdf_material random_material(rng *r, int isotropic)
{
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    for (int c = 0; c < 3; c++) {
        m.kd[c] = rng_float(r);
        m.eta[c] = 1.0f + rng_log_range(r, 1e-3f, 9.0f);
    }
    m.alpha[0] = fmaxf(rng_log_range(r, HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA), HNBRDF_MIN_ALPHA);
    m.alpha[1] =
        isotropic ? m.alpha[0]
                  : fmaxf(rng_log_range(r, HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA), HNBRDF_MIN_ALPHA);
    m.rotation = isotropic ? 0.0f : rng_range(r, -4.0f, 4.0f);
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        m.latent[i] = rng_normal(r);
    return m;
}

hnbrdf_material edited_from(rng *r, hnbrdf_material m)
{
    const hnbrdf_material other = random_material(r, m.alpha[0] == m.alpha[1]);
    m.fitted = as_fitted(other).fitted;
    return m;
}

void random_lobes(rng *r, hnbrdf_lobes *lobes)
{
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        lobes->scale[k] = (rng_u32(r) % 4 ? 1.0f : -1.0f) * rng_log_range(r, 0.05f, 20.0f);
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
            lobes->share[k][j] = 0.5f * rng_float(r);
    }
}

hnbrdf_model *random_model(rng *r, hnbrdf_kind kind, hnbrdf_encoding encoding, int hidden,
                           int layers, int latent)
{
    static float weights[HNBRDF_MAX_LAYERS + 1][HNBRDF_MAX_HIDDEN * HNBRDF_MAX_HIDDEN];
    static float biases[HNBRDF_MAX_LAYERS + 1][HNBRDF_MAX_HIDDEN];
    static const char *const name = "random";
    hnbrdf_material material = random_material(r, 1);
    hnbrdf_model_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.kind = kind;
    desc.encoding = encoding;
    desc.materials = &material;
    desc.names = &name;
    desc.material_count = 1;
    desc.scale = 1.0f;
    if (kind != HNBRDF_KIND_GGX) {
        desc.hidden = hidden;
        desc.layers = layers;
        desc.latent = latent;
        desc.floor = 0.003f;
        for (int k = 0; k <= layers; k++) {
            int in = hnbrdf_layer_inputs(&desc, k), out = hnbrdf_layer_outputs(&desc, k);
            float deviation = sqrtf(2.0f / (float)in); /* He initialisation */
            for (int i = 0; i < in * out; i++)
                weights[k][i] = deviation * rng_normal(r);
            for (int i = 0; i < out; i++)
                biases[k][i] = 0.3f * rng_normal(r);
            desc.weights[k] = weights[k];
            desc.biases[k] = biases[k];
        }
    }
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_model_create(&desc, NULL, &model, &error))
        fail_msg("hnbrdf_model_create: %s", error.text);
    return model;
}

void assert_same_bits(const float *a, const float *b, int count)
{
    for (int i = 0; i < count; i++) {
        uint32_t x, y;
        memcpy(&x, &a[i], sizeof x);
        memcpy(&y, &b[i], sizeof y);
        if (x != y)
            fail_msg("value %d: %.9g and %.9g differ", i, (double)a[i], (double)b[i]);
    }
}
