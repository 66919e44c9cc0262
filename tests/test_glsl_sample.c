/* test_glsl_sample.c: hnbrdf_sample() and hnbrdf_pdf() of an exported scene against C: where the
 * device's operations are exact, the same direction, density and weight to the last bit. */
#include "gpu_run.h"
#include "gpu_support.h"

#include "hnbrdf/measured.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* in: wo, u, some wi; out: wi, pdf, weight, pdf of that wi */
enum { DRAWS = 4096, IN = 9, OUT = 8 };

static const char BODY[] =
    "void main() {\n"
    "    uint k = gl_GlobalInvocationID.x;\n"
    "    if (k >= count)\n        return;\n"
    "    hnbrdf_material m = hnbrdf_scene_material(material);\n"
    "    vec3 wo = in_vec3(9 * k);\n"
    "    hnbrdf_sample_result r = hnbrdf_sample(m, wo, in_vec3(9 * k + 3).xy);\n"
    "    store3(8 * k, r.wi);\n"
    "    results[8 * k + 3] = r.pdf;\n"
    "    store3(8 * k + 4, r.weight);\n"
    "    results[8 * k + 7] = hnbrdf_pdf(m, in_vec3(9 * k + 6), wo);\n"
    "}\n";

/* u = 0, the largest u, 1/4 and 3/4 where a quadrant ends; wo along n, grazing, on and below the
 * horizon, not finite. */
static void draw_input(hnbrdf_rng *rng, int k, float in[IN])
{
    static const float us[] = {0.0f, 0x1.fffffep-1f, 0.25f, 0.75f, 0.125f, 0x1p-24f};
    static const float wos[][3] = {{0, 0, 1},       {1, 0, 1e-6f},    {0.6f, -0.8f, 1e-20f},
                                   {0, 1, 0},       {0, 0.6f, -0.8f}, {NAN, 0.1f, 0.9f},
                                   {INFINITY, 0, 1}};
    hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, rng, in, in + 6);
    for (int i = 3; i < 6; i++)
        in[i] = k % 5 == 0 ? us[hnbrdf_rng_u32(rng) % 6] : hnbrdf_rng_float(rng);
    if (k % 7 == 0)
        memcpy(in, wos[hnbrdf_rng_u32(rng) % 7], sizeof wos[0]);
    if (k % 11 == 0) /* a direction where the GGX lobe is: near the mirror of wo */
        for (int c = 0; c < 3; c++)
            in[6 + c] = c < 2 ? -in[c] : in[c];
}

static int finite3(const float *v)
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static void reference(const hnbrdf_model *model, int material, const float *in, float *out)
{
    hnbrdf_sample_result r;
    const hnbrdf_material *m = hnbrdf_model_material(model, material);
    hnbrdf_sample(model, m, in, in + 3, &r);
    memcpy(out, r.wi, sizeof r.wi);
    out[3] = r.pdf;
    memcpy(out + 4, r.weight, sizeof r.weight);
    out[7] = hnbrdf_pdf(model, m, in + 6, in);
}

static void check_draws(const hnbrdf_model *model, int material, int exact, const float *in,
                        const float *out)
{
    float expected[OUT];
    for (int k = 0; k < DRAWS; k++, in += IN, out += OUT) {
        if (!finite3(in)) { /* something finite, without a promise what */
            assert_true(finite3(out) && finite3(out + 4) && isfinite(out[3]));
            continue;
        }
        for (int i = 3; i < OUT; i++)
            assert_true(isfinite(out[i]) && out[i] >= 0.0f);
        assert_true(out[2] > 0.0f &&
                    (out[3] > 0.0f || (out[4] == 0.0f && out[5] == 0.0f && out[6] == 0.0f)));
        if (!exact)
            continue;
        gpu_run_c_begin();
        reference(model, material, in, expected);
        gpu_run_c_end();
        gpu_run_assert_same("wi, pdf, weight, pdf", out, expected, OUT);
    }
}

static void samples_as_in_c(const scene_shape *shape, const hnbrdf_glsl_options *options)
{
    hnbrdf_model *model = scene_model(shape);
    float *in = calloc(DRAWS, IN * sizeof *in), *out = calloc(DRAWS, OUT * sizeof *out);
    assert_true(in && out);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 21, 0);
    for (int k = 0; k < DRAWS; k++)
        draw_input(&rng, k, in + k * IN);
    char *scene = gpu_run_export(model, options);
    for (int exact = 0; exact < 2; exact++)
        for (int m = 0; m < (exact ? hnbrdf_model_material_count(model) : 1); m++) {
            gpu_run(scene, BODY, exact, m, DRAWS, in, DRAWS * IN, out, DRAWS * OUT);
            check_draws(model, m, exact && gpu_run_exact(), in, out);
        }
    free(scene);
    free(in);
    free(out);
    hnbrdf_model_free(model);
}

static const scene_shape
    HYBRID = {.encoding = HNBRDF_ENCODING_ANGLES, .hidden = 8, .layers = 2, .latent = 4},
    ROTATED = {.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
               .hidden = 8,
               .layers = 2,
               .latent = 4,
               .anisotropic = 1,
               .rotated = 1},
    GGX = {.kind = HNBRDF_KIND_GGX, .anisotropic = 1},
    NEURAL = {.kind = HNBRDF_KIND_NEURAL, .hidden = 4, .layers = 1, .latent = 5, .rotated = 1};

static void isotropic_hybrid_samples_as_in_c(void **state)
{
    (void)state;
    samples_as_in_c(&HYBRID, NULL);
}

static void anisotropic_rotated_hybrid_samples_as_in_c(void **state)
{
    (void)state;
    samples_as_in_c(&ROTATED, &(hnbrdf_glsl_options){.only = HNBRDF_GLSL_EVAL_SAMPLE});
}

static void ggx_and_neural_sample_as_in_c(void **state)
{
    (void)state;
    samples_as_in_c(&GGX, NULL);
    samples_as_in_c(&NEURAL, NULL);
}

static void fixed_materials_sample_as_in_c(void **state)
{
    (void)state;
    samples_as_in_c(&ROTATED, &(hnbrdf_glsl_options){.only = HNBRDF_GLSL_EVAL_SAMPLE, .fixed = 1});
    samples_as_in_c(&NEURAL, &(hnbrdf_glsl_options){.fixed = 1});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(isotropic_hybrid_samples_as_in_c),
        cmocka_unit_test(anisotropic_rotated_hybrid_samples_as_in_c),
        cmocka_unit_test(ggx_and_neural_sample_as_in_c),
        cmocka_unit_test(fixed_materials_sample_as_in_c),
    };
    return gpu_run_tests(tests, sizeof tests / sizeof tests[0]);
}
