/* test_physics.c: directional albedo against closed forms and against another integrator,
 * reciprocity. */
#include "hnbrdf/metrics.h"

#include "core_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

/* eta = 1 + 2^-23 reflects nothing: Lambert alone, whose albedo is kd towards every angle. */
static void the_albedo_of_lambert_is_kd(void **state)
{
    (void)state;
    rng r = rng_make(1);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    static const float alphas[] = {1e-4f, 0.01f, 0.2f, 1.0f};
    for (int a = 0; a < 4; a++)
        for (int t = 0; t < 26; t++) {
            hnbrdf_material m;
            hnbrdf_material_init(&m);
            m.alpha[0] = m.alpha[1] = fmaxf(alphas[a], HNBRDF_MIN_ALPHA);
            for (int c = 0; c < 3; c++) {
                m.kd[c] = 0.25f + 0.25f * (float)c;
                m.eta[c] = 1.00000012f;
            }
            float wo[3];
            double albedo[3];
            const double degrees = t < 23 ? 4.0 * t : t < 25 ? 77.5 + 0.5 * t : 89.9;
            direction(cos(degrees * pi / 180), 1.0, wo);
            hnbrdf_albedo(model, &m, wo, albedo);
            for (int c = 0; c < 3; c++) /* the accuracy that metrics.h states */
                if (!(fabs(albedo[c] / (double)m.kd[c] - 1) <= 0.005))
                    fail_msg("alpha %g, %g degrees: %g, expected %g", (double)m.alpha[0], degrees,
                             albedo[c], (double)m.kd[c]);
        }
    hnbrdf_model_free(model);
}

/* GGX that reflects everything (eta 1000: 0.996 at normal incidence) against hnbrdf_sample(): the
 * mean of its weights is the albedo. 20000 draws with weights of at most about 5 (share 0.2 at
 * least): a standard deviation under 5/sqrt(20000) = 0.035, in fact near 0.005; judged by their
 * own scatter, four times. */
static void the_albedo_is_the_mean_weight_of_samples(void **state)
{
    (void)state;
    rng r = rng_make(2);
    hnbrdf_model *models[] = {
        random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0),
        random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES_ANISOTROPIC, 8, 2, 4)};
    static const float alphas[][2] = {
        {0.001f, 0.001f}, {0.05f, 0.05f}, {0.5f, 0.5f}, {0.3f, 0.03f}};
    for (int k = 0; k < 2 * 4 * 3; k++) {
        const hnbrdf_model *model = models[k % 2];
        hnbrdf_material m = random_material(&r, 1);
        m.alpha[0] = alphas[k / 2 % 4][0];
        m.alpha[1] = alphas[k / 2 % 4][1];
        m.rotation = 0.5f;
        float wo[3];
        double albedo[3], sum = 0, square = 0;
        enum { DRAWS = 20000 };
        direction(0.15 + 0.4 * (k / 8), 0.7, wo);
        hnbrdf_albedo(model, &m, wo, albedo);
        for (int i = 0; i < DRAWS; i++) {
            const float u[2] = {rng_float(&r), rng_float(&r)};
            hnbrdf_sample_result s;
            hnbrdf_sample(model, &m, wo, u, &s);
            sum += (double)s.weight[1];
            square += (double)s.weight[1] * (double)s.weight[1];
        }
        double mean = sum / DRAWS, deviation = sqrt((square / DRAWS - mean * mean) / DRAWS);
        if (!(fabs(albedo[1] - mean) <= 4 * deviation + 0.005 * mean))
            fail_msg("configuration %d: %g, samples say %g +- %g", k, albedo[1], mean, deviation);
    }
    hnbrdf_model_free(models[0]);
    hnbrdf_model_free(models[1]);
}

static void energy_above_one_is_found(void **state)
{
    (void)state;
    rng r = rng_make(3);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    hnbrdf_physics physics;
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    for (int c = 0; c < 3; c++)
        m.kd[c] = 0.2f;
    hnbrdf_physics_of(model, &m, &physics);
    assert_true(physics.valid && physics.albedo > 0.2 && physics.albedo < 1.0);
    m.kd[1] = 1.0f; /* white, and a gloss on top */
    hnbrdf_physics_of(model, &m, &physics);
    assert_true(physics.albedo > 1.04);
    assert_int_equal(physics.albedo_channel, 1);
    hnbrdf_model_free(model);
}

static void reciprocity_is_exact_for_reciprocal_encodings_and_measured_for_others(void **state)
{
    (void)state;
    rng r = rng_make(4);
    for (int encoding = 0; encoding <= HNBRDF_ENCODING_ANGLES_AZIMUTHS; encoding++) {
        hnbrdf_model *model =
            random_model(&r, HNBRDF_KIND_HYBRID, (hnbrdf_encoding)encoding, 8, 2, 4);
        hnbrdf_material m = random_material(&r, 1);
        hnbrdf_physics physics;
        hnbrdf_physics_of(model, &m, &physics);
        int directed =
            encoding == HNBRDF_ENCODING_DIRECTIONS || encoding == HNBRDF_ENCODING_ANGLES_DIRECTED;
        assert_true(directed ? physics.reciprocity > 1e-3 : physics.reciprocity_worst == 0.0);
        assert_true(physics.reciprocity <= physics.reciprocity_worst &&
                    physics.reciprocity_worst <= 2.0);
        hnbrdf_model_free(model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_albedo_of_lambert_is_kd),
        cmocka_unit_test(the_albedo_is_the_mean_weight_of_samples),
        cmocka_unit_test(energy_above_one_is_found),
        cmocka_unit_test(reciprocity_is_exact_for_reciprocal_encodings_and_measured_for_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
