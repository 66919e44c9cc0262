/* test_glsl_unpack.c: a material that the shader unpacks from texels is the one that C unpacks,
 * and so are the values of the BRDF with it. */
#include "gpu_run.h"
#include "gpu_support.h"

#include "core/half.h"
#include "core/prepared.h"
#include "hnbrdf/measured.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Per material: kd, eta, alpha, rotation as (cos, sin), latent code; then f of one pair; lobes. */
enum { MATERIALS = 512, FIELDS = 3 + 3 + 2 + 2 + HNBRDF_MAX_LATENT, RESULTS = FIELDS + 3 + 10 };

/* Texels as a texture's sampler returns them: its channels as floats. UNORM bytes are b / 255. */
static const char BODY[] =
    "vec4 texel(uint k, uint t) {\n"
    "    uint at = 4u * (uint(HNBRDF_TEXELS) * k + t);\n"
    "    return vec4(in_float(at), in_float(at + 1), in_float(at + 2), in_float(at + 3));\n"
    "}\n"
    "void main() {\n"
    "    uint k = gl_GlobalInvocationID.x, at = k * uint(RESULTS);\n"
    "    if (k >= count)\n        return;\n"
    "    hnbrdf_material m = hnbrdf_material_unpack(TEXELS);\n"
    "    store3(at, m.kd);\n"
    "    store3(at + 3, m.eta);\n"
    "    results[at + 6] = vec2(m.alpha).x;\n"
    "    results[at + 7] = vec2(m.alpha).y;\n"
    "    results[at + 8] = ROTATION.x;\n"
    "    results[at + 9] = ROTATION.y;\n"
    "    LATENT\n"
    "    store3(at + 26, hnbrdf_eval(m, vec3(0.6, 0.0, 0.8), vec3(-0.48, 0.36, 0.8)));\n"
    "    for (int i = 0; i < 2; i++)\n        results[at + 29 + i] = m.lobe_scale[i];\n"
    "    for (int i = 0; i < 4; i++) {\n        results[at + 31 + i] = m.lobe_share_0[i];\n"
    "        results[at + 35 + i] = m.lobe_share_1[i];\n    }\n"
    "}\n";

static const scene_shape PLAIN = {
    .encoding = HNBRDF_ENCODING_ANGLES, .hidden = 8, .layers = 2, .latent = 4};
static const scene_shape RICH = {.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
                                 .hidden = 8,
                                 .layers = 2,
                                 .latent = 6,
                                 .anisotropic = 1,
                                 .rotated = 1};

static char *body_for(const hnbrdf_packing *packing)
{
    char *text = malloc(8192);
    assert_non_null(text);
    char texels[256] = "";
    for (int t = 0; t < hnbrdf_packing_texels(packing); t++)
        snprintf(texels + strlen(texels), 32, "%stexel(k, %du)", t ? ", " : "", t);
    int length = snprintf(
        text, 8192, "#define RESULTS %d\n#define TEXELS %s\n#define ROTATION %s\n#define LATENT",
        RESULTS, texels, packing->rotated ? "m.rotation" : "vec2(1.0, 0.0)");
    for (int i = 0; i < packing->latent; i++)
        length += snprintf(text + length, 64, " results[at + %d] = m.latent%d.%c;", 10 + i, i / 4,
                           "xyzw"[i % 4]);
    snprintf(text + length, 8192 - (size_t)length, "\n%s", BODY);
    return text;
}

static void draw_channels(const hnbrdf_packing *packing, const hnbrdf_model *model, float *channels)
{
    int width = 4 * hnbrdf_packing_texels(packing);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 11, 0);
    for (int k = 0; k < MATERIALS * width; k++) {
        if (k < SCENE_MATERIALS * width && k % width == 0) { /* first the materials of the model */
            unsigned char texels[HNBRDF_MAX_TEXELS * 8];
            hnbrdf_material_pack(packing, hnbrdf_model_material(model, k / width), texels);
            for (int c = 0; c < width; c++) {
                uint16_t half;
                memcpy(&half, texels + 2 * c, sizeof half);
                channels[k + c] = packing->format == HNBRDF_TEXEL_RGBA16F
                                      ? hnbrdf_float_of_half(half)
                                      : (float)texels[c] / 255.0f;
            }
        }
        if (k >= SCENE_MATERIALS * width) /* then anything, also out of range */
            channels[k] = k % 97 == 0 ? -0.5f : k % 89 == 0 ? 3.0f : hnbrdf_rng_float(&rng);
    }
}

static void expect(const hnbrdf_packing *packing, const hnbrdf_model *model, const float *channels,
                   float *e)
{
    hnbrdf_material m;
    hnbrdf_lobes lobes;
    const float wi[3] = {0.6f, 0.0f, 0.8f}, wo[3] = {-0.48f, 0.36f, 0.8f};
    hnbrdf_material_unpack_channels(packing, channels, &m);
    memset(e, 0, RESULTS * sizeof *e);
    memcpy(e, m.kd, sizeof m.kd);
    memcpy(e + 3, m.eta, sizeof m.eta);
    memcpy(e + 6, m.alpha, sizeof m.alpha);
    e[8] = (float)cos((double)m.rotation);
    e[9] = (float)sin((double)m.rotation);
    memcpy(e + 10, m.latent, (size_t)packing->latent * sizeof(float));
    hnbrdf_eval(model, &m, wi, wo, e + 26);
    hnbrdf_lobes_used(!packing->analytic, &m, &lobes);
    memcpy(e + 29, lobes.scale, sizeof lobes.scale);
    memcpy(e + 31, lobes.share, sizeof lobes.share);
}

/* An angle between -pi and pi is known to half an ulp of pi, 1.2e-7; cosine and sine in the
 * shader are within three roundings of numbers below 1 of their true values, 1.8e-7. */
static const double ROTATION_BOUND = 3.2e-7;

static void compare(const hnbrdf_packing *packing, const float *device, const float *c)
{
    gpu_run_assert_same("kd, eta, alpha", device, c, 8);
    for (int i = 8; i < 10; i++)
        assert_true(fabs((double)device[i] - (double)c[i]) <=
                    (packing->rotated ? ROTATION_BOUND : 0.0));
    gpu_run_assert_same("latent", device + 10, c + 10, (size_t)packing->latent);
    gpu_run_assert_same("lobes", device + 29, c + 29, 10);
    if (!packing->rotated)
        gpu_run_assert_same("f", device + 26, c + 26, 3);
}

/* all: fields that these materials do not need too. */
static void unpacks_as_in_c(const scene_shape *shape, hnbrdf_texel_format format, int all)
{
    hnbrdf_model *model = scene_model(shape);
    hnbrdf_packing packing;
    assert_int_equal(hnbrdf_packing_init(model, NULL, 0, format, &packing, NULL), HNBRDF_OK);
    if (all)
        packing.anisotropic = packing.rotated = packing.edited = packing.lobes = 1;
    size_t width = 4 * (size_t)hnbrdf_packing_texels(&packing);
    float *channels = calloc(MATERIALS * width, sizeof *channels);
    float *results = calloc(MATERIALS * RESULTS, sizeof *results), expected[RESULTS];
    assert_true(channels && results);
    draw_channels(&packing, model, channels);
    char *scene = gpu_run_export(model, &(hnbrdf_glsl_options){.packing = &packing}),
         *body = body_for(&packing);
    gpu_run(scene, body, 1, 0, MATERIALS, channels, MATERIALS * width, results,
            MATERIALS * RESULTS);
    for (int k = 0; k < MATERIALS && gpu_run_exact(); k++) {
        gpu_run_c_begin();
        expect(&packing, model, channels + (size_t)k * width, expected);
        gpu_run_c_end();
        compare(&packing, results + k * RESULTS, expected);
    }
    free(scene);
    free(body);
    free(channels);
    free(results);
    hnbrdf_model_free(model);
}

static void half_floats_unpack_as_in_c(void **state)
{
    (void)state;
    scene_shape edited = PLAIN;
    edited.edited = 1;
    unpacks_as_in_c(&PLAIN, HNBRDF_TEXEL_RGBA16F, 0);
    unpacks_as_in_c(&PLAIN, HNBRDF_TEXEL_RGBA16F, 1);
    unpacks_as_in_c(&RICH, HNBRDF_TEXEL_RGBA16F, 0);
    unpacks_as_in_c(&edited, HNBRDF_TEXEL_RGBA16F, 0);
}

static void bytes_unpack_as_in_c(void **state)
{
    (void)state;
    unpacks_as_in_c(&PLAIN, HNBRDF_TEXEL_RGBA8, 0);
    unpacks_as_in_c(&PLAIN, HNBRDF_TEXEL_RGBA8, 1);
    scene_shape edited = PLAIN;
    edited.edited = edited.anisotropic = 1;
    unpacks_as_in_c(&RICH, HNBRDF_TEXEL_RGBA8, 0);
    unpacks_as_in_c(&edited, HNBRDF_TEXEL_RGBA8, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_floats_unpack_as_in_c),
        cmocka_unit_test(bytes_unpack_as_in_c),
    };
    return gpu_run_tests(tests, sizeof tests / sizeof tests[0]);
}
