/* test_glsl_world.c: evaluation and sampling with directions of the world: the frame that the
 * shader makes of a normal and a tangent, and values and samples in it, beside C. */
#include "gpu_run.h"
#include "gpu_support.h"

#include "hnbrdf/measured.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CASES = 2048, WORDS = 14, RESULTS = 26 };

/* Places in a row of results. */
enum { X_AXIS = 0, Y_AXIS = 3, Z_AXIS = 6, WI = 9, WO = 12, VALUE = 15, PDF = 18, DRAWN = 19 };
enum { WEIGHT = 22, DRAWN_PDF = 25 };

static const scene_shape SHAPE = {.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
                                  .hidden = 8,
                                  .layers = 1,
                                  .latent = 2,
                                  .anisotropic = 1,
                                  .rotated = 1};

static const char BODY[] =
    "void main()\n"
    "{\n"
    "    uint k = gl_GlobalInvocationID.x;\n"
    "    if (k >= count)\n"
    "        return;\n"
    "    uint at = 14 * k, to = 26 * k;\n"
    "    vec3 n = in_vec3(at), t = in_vec3(at + 3), wi = in_vec3(at + 6), wo = in_vec3(at + 9);\n"
    "    vec2 u = vec2(in_float(at + 12), in_float(at + 13));\n"
    "    hnbrdf_material m = hnbrdf_scene_material(material);\n"
    "    hnbrdf_world_frame f = hnbrdf_world_frame_make(n, t);\n"
    "    store3(to, f.x_axis);\n"
    "    store3(to + 3, f.y_axis);\n"
    "    store3(to + 6, f.z_axis);\n"
    "    store3(to + 9, hnbrdf_to_frame(n, t, wi));\n"
    "    store3(to + 12, hnbrdf_to_frame(n, t, wo));\n"
    "    store3(to + 15, hnbrdf_eval_world(m, n, t, wi, wo));\n"
    "    results[to + 18] = hnbrdf_pdf_world(m, n, t, wi, wo);\n"
    "    hnbrdf_sample_result s = hnbrdf_sample_world(m, n, t, wo, u);\n"
    "    store3(to + 19, s.wi);\n"
    "    store3(to + 22, s.weight);\n"
    "    results[to + 25] = s.pdf;\n"
    "}\n";

static void random_direction(hnbrdf_rng *rng, float w[3])
{
    double z = 2.0 * (double)hnbrdf_rng_float(rng) - 1.0, r = sqrt(1.0 - z * z);
    double turn = 6.283185307179586 * (double)hnbrdf_rng_float(rng);
    w[0] = (float)(r * cos(turn));
    w[1] = (float)(r * sin(turn));
    w[2] = (float)z;
}

/* Normals and tangents as meshes have them, and as they should not. */
static void draw_case(hnbrdf_rng *rng, int k, float *in)
{
    static const float lengths[] = {1.0f, 0.3f, 1e-18f, 1e18f, 1.0f, 40.0f};
    for (int v = 0; v < 4; v++)
        random_direction(rng, in + 3 * v);
    for (int c = 0; c < 3; c++) {
        if (k % 8 == 1) /* along the normal, all but a little */
            in[3 + c] = in[c] + powf(10.0f, -(float)(k / 8 % 9)) * in[3 + c];
        in[c] *= lengths[k % 6];
        in[3 + c] *= lengths[k / 6 % 6];
        if (k % 32 == 3)
            in[3 + c] = 0.0f;
        if (k % 32 == 19)
            in[3 + c] = c == k / 32 % 3 ? NAN : 1.0f;
        if (k % 32 == 11)
            in[3 + c] = INFINITY;
        if (k % 32 == 27)
            in[c] = 0.0f;
    }
    in[12] = hnbrdf_rng_float(rng);
    in[13] = hnbrdf_rng_float(rng);
}

static double dot(const float *a, const float *b)
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

/* Unit vectors at right angles, right-handed. z and x come from hnbrdf_unit(): no number of them is
 * off by more than 4 roundings, u = 2^-24 each; x and y are cross products of such, with two more.
 * So lengths and angles are off by at most 8 u for every number, 3 of them. */
static void assert_frame(int k, const float *r)
{
    const double most = 24.0 * 0x1p-24;
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++) {
            const double found = dot(r + 3 * a, r + 3 * b);
            if (!(fabs(found - (a == b)) <= most))
                fail_msg("case %d: axes %d and %d: %.9g", k, a, b, found);
        }
    const float *x = r + X_AXIS, *y = r + Y_AXIS;
    const float cross[3] = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                            x[0] * y[1] - x[1] * y[0]};
    assert_true(dot(cross, r + Z_AXIS) > 0.99);
}

/* The normal is the z axis, and the tangent has no part along y and a positive one along x. */
static void assert_follows(int k, const float *in, const float *r)
{
    const double n_length = sqrt(dot(in, in)), t_length = sqrt(dot(in + 3, in + 3));
    const double most = 24.0 * 0x1p-24;
    if (!(n_length > 0.0) || !(t_length > 0.0 && t_length < INFINITY))
        return;
    if (!(fabs(dot(in, r + Z_AXIS) / n_length - 1.0) <= most))
        fail_msg("case %d: the normal has moved", k);
    const double along = dot(in + 3, in) / (n_length * t_length), sine = sqrt(1.0 - along * along);
    /* The direction of a cross product is off by what it cancels. */
    if (sine > 2e-3 && !(fabs(dot(in + 3, r + Y_AXIS)) / t_length <= most / sine &&
                         dot(in + 3, r + X_AXIS) / t_length > 0.5 * sine))
        fail_msg("case %d: the tangent has moved", k);
}

static void values_and_samples_are_those_of_c(int material, const hnbrdf_model *model,
                                              const float *in, const float *results)
{
    static float device[10 * CASES], expected[10 * CASES];
    const hnbrdf_material *m = hnbrdf_model_material(model, material);
    gpu_run_c_begin();
    for (int k = 0; k < CASES; k++) {
        const float *r = results + RESULTS * k, *u = in + WORDS * k + 12;
        float *d = device + 10 * k, *e = expected + 10 * k;
        hnbrdf_sample_result s;
        memcpy(d, r + VALUE, 3 * sizeof *d);
        memcpy(d + 3, r + DRAWN, 3 * sizeof *d);
        memcpy(d + 6, r + WEIGHT, 3 * sizeof *d);
        d[9] = r[DRAWN_PDF] + r[PDF];
        hnbrdf_eval(model, m, r + WI, r + WO, e);
        hnbrdf_sample(model, m, r + WO, u, &s);
        for (int c = 0; c < 3; c++)
            e[3 + c] =
                (s.wi[0] * r[X_AXIS + c] + s.wi[1] * r[Y_AXIS + c]) + s.wi[2] * r[Z_AXIS + c];
        memcpy(e + 6, s.weight, sizeof s.weight);
        e[9] = s.pdf + hnbrdf_pdf(model, m, r + WI, r + WO);
    }
    gpu_run_c_end();
    gpu_run_assert_same("the world", device, expected, 10 * CASES);
}

static void the_world_is_the_frame_of_the_surface(void **state)
{
    (void)state;
    static float in[WORDS * CASES], results[RESULTS * CASES];
    hnbrdf_model *model = scene_model(&SHAPE);
    char *scene = gpu_run_export(model, NULL);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 5, 0);
    for (int k = 0; k < CASES; k++)
        draw_case(&rng, k, in + WORDS * k);
    for (int exact = 0; exact < 2; exact++)
        for (int material = 0; material < 2; material++) {
            gpu_run(scene, BODY, exact, material, CASES, in, WORDS * CASES, results,
                    RESULTS * CASES);
            for (int k = 0; k < CASES && gpu_run_exact(); k++) {
                assert_frame(k, results + RESULTS * k);
                assert_follows(k, in + WORDS * k, results + RESULTS * k);
            }
            if (exact && gpu_run_exact())
                values_and_samples_are_those_of_c(material, model, in, results);
        }
    free(scene);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_world_is_the_frame_of_the_surface),
    };
    return gpu_run_tests(tests, sizeof tests / sizeof tests[0]);
}
