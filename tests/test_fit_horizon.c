/* test_fit_horizon.c: data near the horizon are held to an albedo below 1 and continued to it,
 * and so what is fitted to them gives off no more light than it gets. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fit/horizon.h"
#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"

#include <math.h>
#include <stdlib.h>

static const float PI = 3.14159265f;

/* ---- Materials ------------------------------------------------------------------------------- */

static int lambert(const void *user, const float wi[3], const float wo[3], float f[3])
{
    (void)wi;
    (void)wo;
    f[0] = f[1] = f[2] = *(const float *)user / PI;
    return 1;
}

/* As RGL files are read: what is in their last table over wo.z. An albedo of 0.9 down to 84
 * degrees, of 9 at 89.4. */
static int steep(const void *user, const float wi[3], const float wo[3], float f[3])
{
    (void)user;
    (void)wi;
    f[0] = f[1] = 0.9f / PI * fmaxf(1.0f, 0.1f / wo[2]);
    f[2] = 0.1f / PI;
    return 1;
}

/* The same with wi and wo in each other's place. */
static int steep_light(const void *user, const float wi[3], const float wo[3], float f[3])
{
    return steep(user, wo, wi, f);
}

/* Measured down to 75 degrees. */
static int ends_early(const void *user, const float wi[3], const float wo[3], float f[3])
{
    (void)user;
    f[0] = f[1] = wo[2] * wi[2];
    f[2] = 0.25f;
    return wi[2] >= 0.26f && wo[2] >= 0.26f;
}

static hnbrdf_measured *material(int (*eval)(const void *, const float *, const float *, float *),
                                 const float *albedo)
{
    static float unused;
    const hnbrdf_measured_custom custom = {.name = "custom",
                                           .isotropic = 1,
                                           .eval = eval,
                                           .user = albedo ? (void *)(uintptr_t)albedo : &unused};
    hnbrdf_measured *measured = NULL;
    assert_int_equal(hnbrdf_measured_create_custom(&custom, &measured, NULL), HNBRDF_OK);
    return measured;
}

/* ---- Holding --------------------------------------------------------------------------------- */

static void direction(float z, float azimuth, float w[3])
{
    const float sine = sqrtf(1.0f - z * z);
    w[0] = sine * cosf(azimuth);
    w[1] = sine * sinf(azimuth);
    w[2] = z;
}

/* The first channel of what this pair is taken as. */
static double held(const fit_horizon *h, const hnbrdf_measured *measured, float wi_z, float wo_z)
{
    float wi[3], wo[3], f[3];
    direction(wi_z, 2.0f, wi);
    direction(wo_z, 0.0f, wo);
    assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
    hnbrdf_fit_horizon_hold(h, wi, wo, f);
    return (double)f[0];
}

/* f depends on the cosines alone: a midpoint rule over wi.z, or over wo.z where that is the light's
 * side. */
static double albedo(const fit_horizon *h, const hnbrdf_measured *measured, float z, int swapped)
{
    enum { COUNT = 4000 };
    double sum = 0.0;
    for (int k = 0; k < COUNT; k++) {
        const float other = ((float)k + 0.5f) / COUNT;
        sum +=
            (double)other * (swapped ? held(h, measured, z, other) : held(h, measured, other, z));
    }
    return 2.0 * (double)PI * sum / COUNT;
}

static void assert_stays(int (*eval)(const void *, const float *, const float *, float *),
                         const float *number)
{
    hnbrdf_measured *measured = material(eval, number);
    fit_horizon h;
    hnbrdf_fit_horizon_make(measured, &h);
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < FIT_HORIZON_KNOTS; k++)
            if (h.most[side][k] != 1.0f)
                fail_msg("%g, side %d, knot %d: %g", (double)*number, side, k,
                         (double)h.most[side][k]);
    hnbrdf_measured_close(measured);
}

/* GGX that reflects all: nothing is held of lobes narrower than the grid of the quadrature. */
static int mirror(const void *user, const float wi[3], const float wo[3], float f[3])
{
    static const char *const name = "mirror";
    static hnbrdf_model *model;
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    for (int c = 0; c < 3; c++) {
        m.kd[c] = 0.0f;
        m.eta[c] = HNBRDF_MAX_ETA;
    }
    m.alpha[0] = m.alpha[1] = *(const float *)user;
    const hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = 1, .materials = &m, .names = &name};
    if (!model)
        assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    hnbrdf_eval(model, &m, wi, wo, f);
    return 1;
}

/* Also where nothing is lost, or all is in another unit. */
static void data_that_conserve_energy_stay(void **state)
{
    static const float kds[] = {0.7f, 1.0f, 100.0f}, alphas[] = {1e-4f, 1e-3f, 0.03f, 0.5f, 1.0f};
    (void)state;
    for (size_t k = 0; k < sizeof kds / sizeof kds[0]; k++)
        assert_stays(lambert, &kds[k]);
    for (size_t k = 0; k < sizeof alphas / sizeof alphas[0]; k++)
        assert_stays(mirror, &alphas[k]);
}

/* Down to 89.4 degrees, where samplers end. Above the last knot, a cosine of 0.2, nothing
 * changes. */
static void data_beyond_the_last_sample_are_held(void **state)
{
    int (*const evals[2])(const void *, const float *, const float *, float *) = {steep,
                                                                                  steep_light};
    (void)state;
    for (int side = 0; side < 2; side++) {
        hnbrdf_measured *measured = material(evals[side], NULL);
        fit_horizon h;
        hnbrdf_fit_horizon_make(measured, &h);
        for (float z = 0.01f; z < 0.3f; z *= 1.1f) {
            const double a = albedo(&h, measured, z, side);
            if (!(a > 0.45 && a < 1.0))
                fail_msg("side %d: albedo %.3f at %.2f degrees", side, a,
                         acos((double)z) * 180.0 / (double)PI);
        }
        assert_true(fabs(held(&h, measured, 0.5f, 0.25f) * (double)PI - 0.9) < 1e-6);
        hnbrdf_measured_close(measured);
    }
}

/* ---- Continuing ------------------------------------------------------------------------------ */

static void pairs_reach_the_horizon(void **state)
{
    enum { PAIRS = 4000 };
    hnbrdf_measured *measured = material(ends_early, NULL);
    hnbrdf_rng rng;
    int low[2] = {0, 0}, lowest = 0;
    fit_horizon h;
    (void)state;
    hnbrdf_fit_horizon_make(measured, &h);
    assert_int_equal(h.held, 0);
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < PAIRS; k++) {
        float wi[3], wo[3], f[3];
        assert_int_equal(hnbrdf_fit_horizon_draw(&h, measured, &rng, wi, wo, f), 1);
        for (int c = 0; c < 2; c++) {
            const float *w = c ? wo : wi;
            const double length2 = (double)w[0] * (double)w[0] + (double)w[1] * (double)w[1] +
                                   (double)w[2] * (double)w[2];
            assert_true(fabs(length2 - 1.0) < 1e-6 && w[2] >= 0.0099f);
            low[c] += w[2] < 0.1f;
        }
        lowest += fminf(wi[2], wo[2]) < 0.03f;
        /* the nearest measured: 0.26 where a cosine is below, up to the step of the search */
        assert_true(f[2] == 0.25f);
        const double nearest = fmax((double)wi[2], 0.26) * fmax((double)wo[2], 0.26);
        assert_true((double)f[0] >= nearest * 0.9999 && (double)f[0] <= nearest * 2.26);
    }
    /* one of the two always, each as often, most of them below 1.7 degrees */
    assert_true(low[0] + low[1] >= PAIRS && abs(low[0] - low[1]) < PAIRS / 10);
    assert_true(lowest > PAIRS / 3);
    hnbrdf_measured_close(measured);
}

/* ---- Fits ------------------------------------------------------------------------------------ */

static double fitted_albedo(const hnbrdf_measured *measured, int without)
{
    const hnbrdf_fit_options options = {
        .steps = 1000, .pool = 8192, .hidden = 16, .horizon_none = without};
    hnbrdf_model *model = NULL;
    hnbrdf_physics physics;
    assert_int_equal(hnbrdf_fit(&measured, 1, &options, &model, NULL, NULL), HNBRDF_OK);
    hnbrdf_physics_of(model, hnbrdf_model_material(model, 0), &physics);
    hnbrdf_model_free(model);
    return physics.albedo;
}

static void what_is_fitted_conserves_energy(void **state)
{
    hnbrdf_measured *measured = material(steep, NULL);
    (void)state;
    const double with = fitted_albedo(measured, 0), without = fitted_albedo(measured, 1);
    print_message("    the largest albedo is %.3f, of data as they are read %.3f\n", with, without);
    assert_true(with <= 1.0 && without > 1.5);
    hnbrdf_measured_close(measured);
}

/* All together, in one short fit. */
static void built_ins_conserve_energy(void **state)
{
    enum { MOST = 64 };
    hnbrdf_measured *data[MOST];
    const int count =
        hnbrdf_measured_builtin_count() < MOST ? hnbrdf_measured_builtin_count() : MOST;
    const hnbrdf_fit_options options = {.steps = 1500, .pool = 8192};
    hnbrdf_model *model = NULL;
    (void)state;
    for (int k = 0; k < count; k++)
        assert_int_equal(hnbrdf_measured_open_builtin(k, &data[k], NULL), HNBRDF_OK);
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)data, count, &options, &model, NULL, NULL),
        HNBRDF_OK);
    for (int k = 0; k < count; k++) {
        hnbrdf_physics physics;
        hnbrdf_physics_of(model, hnbrdf_model_material(model, k), &physics);
        if (!(physics.albedo <= 1.0))
            fail_msg("%s: albedo %.3f at %.1f degrees", hnbrdf_model_material_name(model, k),
                     physics.albedo, physics.albedo_theta * 180.0 / (double)PI);
        hnbrdf_measured_close(data[k]);
    }
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(data_that_conserve_energy_stay),
        cmocka_unit_test(data_beyond_the_last_sample_are_held),
        cmocka_unit_test(pairs_reach_the_horizon),
        cmocka_unit_test(what_is_fitted_conserves_energy),
        cmocka_unit_test(built_ins_conserve_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
