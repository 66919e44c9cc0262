/* test_glsl_brdf.c: the shader of a written .brdf file gives the values of C, also when its sliders
 * are moved. Parameters are uniforms in programs that read such files, here constants. */
#include "core_support.h"
#include "gpu_run.h"
#include "gpu_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS = 512, TEXT = 1 << 18 };

static const scene_shape SHAPES[] = {
    {.encoding = HNBRDF_ENCODING_DIRECTIONS, .hidden = 8, .layers = 2, .latent = 4, .scale = 0.5f},
    {.encoding = HNBRDF_ENCODING_ANGLES,
     .hidden = 9,
     .layers = 2,
     .latent = 11,
     .shift = -1.5f,
     .edited = 1},
    {.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
     .hidden = 5,
     .layers = 1,
     .latent = 1,
     .anisotropic = 1,
     .rotated = 1,
     .floor = 0.0025f},
    {.kind = HNBRDF_KIND_NEURAL,
     .encoding = HNBRDF_ENCODING_HALF_DIFFERENCE,
     .hidden = 6,
     .layers = 2,
     .latent = 12,
     .rotated = 1},
    {.kind = HNBRDF_KIND_GGX, .anisotropic = 1, .rotated = 1}};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

static const char BODY[] =
    "void main()\n{\n"
    "    uint k = gl_GlobalInvocationID.x;\n"
    "    if (k >= count)\n        return;\n"
    "    store3(3 * k, BRDF(in_vec3(6 * k), in_vec3(6 * k + 3), vec3(0, 0, 1), vec3(1, 0, 0),\n"
    "                       vec3(0, 1, 0)));\n}\n";

/* ---- The text -------------------------------------------------------------------------------- */

/* What a slider stands at: that of its parameter, or what it was moved to. */
static double slider(const char *name, double value, const hnbrdf_material *m)
{
    const char *end = name + strlen(name) - 1;
    const int channel = *end == 'g' ? 1 : *end == 'b' ? 2 : 0;
    if (strncmp(name, "diffuse_", 8) == 0)
        return (double)m->kd[channel];
    if (strncmp(name, "eta_", 4) == 0)
        return (double)m->eta[channel];
    if (strncmp(name, "alpha", 5) == 0)
        return (double)m->alpha[*end == 'y'];
    return value;
}

/* The file as a scene of gpu_run(): constants for its parameters, then its shader. That has names
 * of its own, as the shared part is there already. */
static char *scene_of(char *file, const hnbrdf_material *m)
{
    char *scene = calloc(1, TEXT), *to = scene, name[64];
    double low, high, value;
    assert_non_null(scene);
    for (char *line = strstr(file, "::begin parameters\n"); strncmp(line, "::end", 5) != 0;
         line = strchr(line, '\n') + 1)
        if (sscanf(line, "float %60s %lf %lf %lf", name, &low, &high, &value) == 4) {
            assert_true(low <= value && value <= high);
            to += sprintf(to, "const float %s = %.9e;\n", name, slider(name, value, m));
        }
    const char *from = strstr(file, "::begin shader\n") + strlen("::begin shader\n");
    while (strncmp(from, "::end shader", 12) != 0) {
        const int ours = strncmp(from, "hnbrdf_", 7) == 0 || strncmp(from, "HNBRDF_", 7) == 0;
        from += ours ? 2 : 0;
        *to++ = ours ? 'f' : *from++;
    }
    return scene;
}

/* ---- Values ---------------------------------------------------------------------------------- */

/* Moved far enough that nothing of it can be lost in a tolerance. */
static hnbrdf_material moved(const hnbrdf_material *material)
{
    hnbrdf_material m = *material;
    for (int c = 0; c < 3; c++) {
        m.kd[c] = 0.5f * m.kd[c] + 0.1f * (float)c;
        m.eta[c] = 1.0f + 0.7f * (m.eta[c] - 1.0f);
    }
    m.alpha[0] *= 0.6f;
    m.alpha[1] *= 0.6f;
    return m;
}

/* Sums are in the order of matrices, exp and log the built-in ones, within 16 ulp and 6e-7; the
 * network enlarges both by its weights, of order 1: 1e-4 has room for that and none for a wrong
 * weight, factor or channel. */
static void check(const hnbrdf_model *model, char *file, const hnbrdf_material *m, double least)
{
    static float in[6 * PAIRS], out[3 * PAIRS];
    rng r = rng_make(5);
    double worst = 0, sum = 0;
    for (int k = 0; k < PAIRS; k++) {
        direction_uniform(&r, in + 6 * k);
        direction_uniform(&r, in + 6 * k + 3);
    }
    char *scene = scene_of(file, m);
    gpu_run(scene, BODY, 0, 0, PAIRS, in, 6 * PAIRS, out, 3 * PAIRS);
    for (int k = 0; k < PAIRS; k++) {
        float f[3];
        hnbrdf_eval(model, m, in + 6 * k, in + 6 * k + 3, f);
        for (int c = 0; c < 3; c++) {
            worst = fmax(worst,
                         fabs((double)out[3 * k + c] - (double)f[c]) / (fabs((double)f[c]) + 0.01));
            sum += (double)f[c];
        }
    }
    assert_true(sum > 0);
    if (worst > least)
        fail_msg("off by %g of f + 0.01", worst);
    free(scene);
}

static void shaders_of_files_give_the_values_of_c(void **state)
{
    (void)state;
    for (int s = 0; s < SHAPE_COUNT; s++) {
        hnbrdf_model *model = scene_model(&SHAPES[s]);
        for (int k = 0; k < 2; k++) {
            const hnbrdf_material *m = hnbrdf_model_material(model, k), edited = moved(m);
            char *file = gpu_run_export(
                model, &(hnbrdf_glsl_options){
                           .materials = &k, .material_count = 1, .language = HNBRDF_LANGUAGE_BRDF});
            check(model, file, m, 1e-4);
            if (SHAPES[s].kind != HNBRDF_KIND_NEURAL)
                check(model, file, &edited, 1e-4);
            free(file);
        }
        hnbrdf_model_free(model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(shaders_of_files_give_the_values_of_c)};
    return gpu_run_tests(tests, sizeof tests / sizeof tests[0]);
}
