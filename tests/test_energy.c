/* test_energy.c: the factor that keeps a material from giving off more light than it gets: where
 * it is applied, what it leaves, where it is kept. */
#include "hnbrdf/edit.h"
#include "hnbrdf/glsl.h"
#include "hnbrdf/metrics.h"

#include "core_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

static hnbrdf_model *any_model(rng *r, int k)
{
    const hnbrdf_kind kind = (hnbrdf_kind)(k % 3);
    const hnbrdf_encoding encoding =
        k / 3 % 2 ? HNBRDF_ENCODING_ANGLES : HNBRDF_ENCODING_DIRECTIONS;
    return random_model(r, kind, encoding, 8, 2, 4);
}

/* ---- What it does ---------------------------------------------------------------------------- */

static float ramp(const hnbrdf_energy *e, float z)
{
    return fminf(e->horizon + e->slope * z, 1.0f);
}

/* f with it is f without it times k(wi.z) k(wo.z), to the bit, edited or not; the analytic part and
 * the density stay; the weights of samples have it. */
static void values_are_multiplied_by_both_factors(void **state)
{
    (void)state;
    rng r = rng_make(51);
    for (int k = 0; k < 12; k++) {
        hnbrdf_model *model = any_model(&r, k);
        hnbrdf_material plain = random_material(&r, k & 1);
        if (k % 2)
            plain = edited_from(&r, plain);
        hnbrdf_material m = plain;
        m.energy = (hnbrdf_energy){rng_float(&r), 4.0f * rng_float(&r)};
        for (int i = 0; i < 200; i++) {
            float wi[3], wo[3], f[2][3], f_a[2][3];
            direction_uniform(&r, wi);
            direction_uniform(&r, wo);
            hnbrdf_eval(model, &plain, wi, wo, f[0]);
            hnbrdf_eval(model, &m, wi, wo, f[1]);
            const float factor = ramp(&m.energy, wi[2]) * ramp(&m.energy, wo[2]);
            for (int c = 0; c < 3; c++)
                f[0][c] *= factor;
            assert_same_bits(f[0], f[1], 3);
            hnbrdf_eval_analytic(model, &plain, wi, wo, f_a[0]);
            hnbrdf_eval_analytic(model, &m, wi, wo, f_a[1]);
            assert_same_bits(f_a[0], f_a[1], 3);
            assert_true(hnbrdf_pdf(model, &plain, wi, wo) == hnbrdf_pdf(model, &m, wi, wo));
            const float u[2] = {rng_float(&r), rng_float(&r)};
            hnbrdf_sample_result a, b;
            hnbrdf_sample(model, &plain, wo, u, &a);
            hnbrdf_sample(model, &m, wo, u, &b);
            assert_true(a.pdf == b.pdf && memcmp(a.wi, b.wi, sizeof a.wi) == 0);
            hnbrdf_eval(model, &m, b.wi, wo, f[1]);
            for (int c = 0; c < 3 && b.pdf > 0.0f; c++)
                assert_true(b.weight[c] == f[1][c] * b.wi[2] / b.pdf);
        }
        hnbrdf_model_free(model);
    }
}

/* k = 1 and none are the same bits; f swaps where it did before. */
static void it_is_reciprocal(void **state)
{
    (void)state;
    rng r = rng_make(52);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES, 8, 2, 4);
    hnbrdf_material m = random_material(&r, 0), one = m;
    m.energy = (hnbrdf_energy){0.2f, 3.0f};
    one.energy = (hnbrdf_energy){1.0f, 0.0f};
    for (int i = 0; i < 1000; i++) {
        float wi[3], wo[3], f[2][3];
        direction_uniform(&r, wi);
        direction_uniform(&r, wo);
        hnbrdf_eval(model, &m, wi, wo, f[0]);
        hnbrdf_eval(model, &m, wo, wi, f[1]);
        assert_same_bits(f[0], f[1], 3);
        hnbrdf_eval(model, &one, wi, wo, f[0]);
        one.energy.horizon = 0.0f;
        hnbrdf_eval(model, &one, wi, wo, f[1]);
        one.energy.horizon = 1.0f;
        assert_same_bits(f[0], f[1], 3);
    }
    hnbrdf_model_free(model);
}

/* ---- What it leaves -------------------------------------------------------------------------- */

static double albedo_at(const hnbrdf_model *model, const hnbrdf_material *m, double degrees)
{
    float wo[3];
    double albedo[3];
    direction(cos(degrees * pi / 180.0), 0.4, wo);
    hnbrdf_albedo(model, m, wo, albedo);
    return fmax(albedo[0], fmax(albedo[1], albedo[2]));
}

static void conserve(const hnbrdf_model *model, hnbrdf_material *m)
{
    assert_int_equal(hnbrdf_energy_fit(model, m, &m->energy, NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_material_check(m, NULL), HNBRDF_OK);
}

/* White under gloss is above 1 at normal incidence too; at all angles, of which there are more here
 * than in the table. */
static void no_angle_gives_off_more_than_it_gets(void **state)
{
    (void)state;
    rng r = rng_make(53);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    static const float alphas[][2] = {
        {0.002f, 0.002f}, {0.05f, 0.05f}, {0.4f, 0.4f}, {1.0f, 1.0f}, {0.3f, 0.03f}};
    for (int k = 0; k < 15; k++) {
        hnbrdf_material m;
        hnbrdf_material_init(&m);
        memcpy(m.alpha, alphas[k % 5], sizeof m.alpha);
        m.rotation = 0.3f;
        m.kd[0] = 1.0f;
        for (int c = 0; c < 3; c++)
            m.eta[c] = k < 5 ? 1.3f : k < 10 ? 1.6f : 5.0f;
        conserve(model, &m);
        for (double degrees = 0.0; degrees < 89.95; degrees += degrees < 88.0 ? 1.7 : 0.19) {
            const double a = albedo_at(model, &m, degrees);
            if (!(a <= 1.0))
                fail_msg("material %d: albedo %.4f at %.2f degrees", k, a, degrees);
        }
        assert_true(albedo_at(model, &m, 0.0) > 0.9); /* no more than is asked */
    }
    hnbrdf_model_free(model);
}

/* A neural model of an f that grows towards the horizon without end but has an albedo of 0.6 from
 * above, made by hand: exp(c) with c linear in wo.z. Normal incidence stays within 1 %. */
static void normal_incidence_stays(void **state)
{
    static const char *const name = "steep";
    (void)state;
    /* x[5] = wo.z; two units: wo.z - 0.15 and -(wo.z - 0.15), of which HardGELU passes the first
     * fully where it is above 1.5: scaled by 30 */
    float first[2 * 6] = {0.0f}, first_bias[2] = {-4.5f, 4.5f};
    first[5] = 30.0f;
    first[6 + 5] = -30.0f;
    float last[3 * 2] = {0.0f, 0.4f, 0.0f, 0.4f, 0.0f, 0.2f};
    float last_bias[3] = {-1.65f, -1.65f, -3.0f};
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_NEURAL,
                              .encoding = HNBRDF_ENCODING_ANGLES_DIRECTED,
                              .hidden = 2,
                              .layers = 1,
                              .weights = {first, last},
                              .biases = {first_bias, last_bias},
                              .material_count = 1,
                              .materials = &m,
                              .names = &name};
    hnbrdf_model *model = NULL;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    const hnbrdf_material before = m;
    assert_true(albedo_at(model, &m, 89.9) > 3.0 && albedo_at(model, &m, 0.0) < 0.7);
    conserve(model, &m);
    for (double degrees = 0.0; degrees < 89.95; degrees += 0.1)
        assert_true(albedo_at(model, &m, degrees) <= 1.0);
    const double kept = albedo_at(model, &m, 0.0) / albedo_at(model, &before, 0.0);
    print_message("    of the albedo at normal incidence %.4f is kept\n", kept);
    assert_true(kept >= 0.99 && kept <= 1.0);
    const float n[3] = {0.0f, 0.0f, 1.0f};
    float f[2][3];
    hnbrdf_eval(model, &before, n, n, f[0]);
    hnbrdf_eval(model, &m, n, n, f[1]);
    assert_same_bits(f[0], f[1], 3);
    hnbrdf_material again = m; /* what it has does not matter */
    conserve(model, &again);
    assert_memory_equal(&again, &m, sizeof m);
    hnbrdf_model_free(model);
}

static void what_needs_none_gets_none(void **state)
{
    (void)state;
    rng r = rng_make(54);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    m.energy = (hnbrdf_energy){0.5f, 1.0f};
    conserve(model, &m);
    assert_true(m.energy.horizon == 0.0f && m.energy.slope == 0.0f);
    hnbrdf_model_free(model);
}

/* ---- Where it is kept ------------------------------------------------------------------------ */

typedef struct text {
    char bytes[65536];
    size_t size;
} text;

static int put(void *user, const void *data, size_t size)
{
    text *t = user;
    if (size > sizeof t->bytes - t->size)
        return 1;
    memcpy(t->bytes + t->size, data, size);
    t->size += size;
    return 0;
}

static hnbrdf_model *with_energy(const hnbrdf_model *model, const hnbrdf_energy *energy)
{
    hnbrdf_material m = *hnbrdf_model_material(model, 0);
    m.energy = *energy;
    const hnbrdf_material_change change = {.name = hnbrdf_model_material_name(model, 0),
                                           .material = &m};
    hnbrdf_model *made = NULL;
    assert_int_equal(hnbrdf_model_with_materials(model, &change, 1, NULL, &made, NULL), HNBRDF_OK);
    return made;
}

static int says(const text *t, const char *what)
{
    for (size_t k = 0; k + strlen(what) <= t->size; k++)
        if (memcmp(t->bytes + k, what, strlen(what)) == 0)
            return 1;
    return 0;
}

/* A file without it has the bytes of before; one with it gives it back; so does a .brdf. */
static void files_keep_it(void **state)
{
    static text file, brdf;
    (void)state;
    rng r = rng_make(55);
    const hnbrdf_energy energy = {0.125f, 3.3f};
    for (int k = 0; k < 3; k++) {
        hnbrdf_model *plain = any_model(&r, k), *back = NULL;
        hnbrdf_model *model = with_energy(plain, &energy);
        file.size = brdf.size = 0;
        assert_int_equal(hnbrdf_model_write(plain, put, &file, NULL), HNBRDF_OK);
        assert_false(says(&file, "material.energy"));
        file.size = 0;
        assert_int_equal(hnbrdf_model_write(model, put, &file, NULL), HNBRDF_OK);
        assert_true(says(&file, "material.energy"));
        assert_int_equal(hnbrdf_model_load_memory(file.bytes, file.size, NULL, &back, NULL),
                         HNBRDF_OK);
        assert_memory_equal(hnbrdf_model_material(back, 0), hnbrdf_model_material(model, 0),
                            sizeof(hnbrdf_material));
        hnbrdf_model_free(back);
        const hnbrdf_glsl_options options = {.language = HNBRDF_LANGUAGE_BRDF};
        assert_int_equal(hnbrdf_export_shader(model, &options, put, &brdf, NULL), HNBRDF_OK);
        const char *const texts[] = {brdf.bytes}, *const names[] = {"random"};
        hnbrdf_error error = {""};
        if (hnbrdf_model_import_brdf(texts, &brdf.size, names, 1, NULL, &back, &error))
            fail_msg("%s", error.text);
        assert_memory_equal(&hnbrdf_model_material(back, 0)->energy, &energy, sizeof energy);
        hnbrdf_model_free(back);
        hnbrdf_model_free(model);
        hnbrdf_model_free(plain);
    }
}

/* A shader has it only where a material of the scene does. */
static void shaders_have_it_where_it_is_wanted(void **state)
{
    static text glsl;
    (void)state;
    rng r = rng_make(56);
    const hnbrdf_energy energy = {0.125f, 3.25f};
    hnbrdf_model *plain = any_model(&r, 0), *model = with_energy(plain, &energy);
    assert_int_equal(hnbrdf_export_shader(plain, NULL, put, &glsl, NULL), HNBRDF_OK);
    assert_false(says(&glsl, "energy"));
    glsl.size = 0;
    assert_int_equal(hnbrdf_export_shader(model, NULL, put, &glsl, NULL), HNBRDF_OK);
    assert_true(says(&glsl, "vec2(0.125, 3.25)"));
    assert_true(
        says(&glsl, "hnbrdf_conserve(hnbrdf_energy_factor(material_in.energy_ramp, wi.z, wo.z), "));
    hnbrdf_model_free(model);
    hnbrdf_model_free(plain);
}

static void mixtures_go_from_one_to_the_other(void **state)
{
    (void)state;
    rng r = rng_make(57);
    hnbrdf_material a = random_material(&r, 1), b = random_material(&r, 1), m;
    hnbrdf_material_mix(&a, &b, 0.5f, &m);
    assert_true(m.energy.horizon == 0.0f && m.energy.slope == 0.0f);
    b.energy = (hnbrdf_energy){0.5f, 4.0f};
    hnbrdf_material_mix(&a, &b, 0.25f, &m);
    assert_true(m.energy.horizon == 0.875f && m.energy.slope == 1.0f);
    assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
    hnbrdf_material_mix(&a, &b, 1.0f, &m);
    assert_memory_equal(&m.energy, &b.energy, sizeof m.energy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_multiplied_by_both_factors),
        cmocka_unit_test(it_is_reciprocal),
        cmocka_unit_test(no_angle_gives_off_more_than_it_gets),
        cmocka_unit_test(normal_incidence_stays),
        cmocka_unit_test(what_needs_none_gets_none),
        cmocka_unit_test(files_keep_it),
        cmocka_unit_test(shaders_have_it_where_it_is_wanted),
        cmocka_unit_test(mixtures_go_from_one_to_the_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
