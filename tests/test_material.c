/* test_material.c: materials made, checked at the last float of every range, and mixed as the
 * formulas of hnbrdf_material_mix() say. */
#include "core_support.h"

#include "core/frame.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static void a_fresh_material_is_half_grey_and_rough(void **state)
{
    (void)state;
    hnbrdf_material m;
    memset(&m, 0x55, sizeof m);
    hnbrdf_material_init(&m);
    for (int c = 0; c < 3; c++)
        assert_true(m.kd[c] == 0.5f && m.eta[c] == 1.5f);
    assert_true(m.alpha[0] == 0.5f && m.alpha[1] == 0.5f && m.rotation == 0.0f);
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        assert_true(m.latent[i] == 0.0f);
    for (int k = 0; k < HNBRDF_LOBES; k++)
        assert_true(m.lobes.scale[k] == 0.0f && m.lobes.share[k][HNBRDF_LOBE_KNOTS - 1] == 0.0f);
}

/* ---- Ranges ---------------------------------------------------------------------------------- */

/* `field` of an otherwise good material: both ends are taken, the floats beyond them and no number
 * are refused by name. An end that is no number is open. */
static void check_range(hnbrdf_material *m, float *field, const char *name, float low, float high)
{
    const float kept = *field, beyond[] = {nextafterf(low, -INFINITY), nextafterf(high, INFINITY),
                                           -INFINITY, INFINITY, NAN};
    hnbrdf_error error = {""};
    *field = low;
    assert_int_equal(hnbrdf_material_check(m, &error), HNBRDF_OK);
    *field = high;
    assert_int_equal(hnbrdf_material_check(m, &error), HNBRDF_OK);
    for (size_t k = 0; k < sizeof beyond / sizeof beyond[0]; k++) {
        *field = beyond[k];
        if (beyond[k] >= low && beyond[k] <= high)
            continue;
        assert_int_equal(hnbrdf_material_check(m, &error), HNBRDF_ERROR_ARGUMENT);
        if (strncmp(error.text, name, strlen(name)))
            fail_msg("'%s', expected to begin with %s", error.text, name);
    }
    *field = kept;
}

static void every_range_is_held_to_its_last_float(void **state)
{
    (void)state;
    static const char *const kd[] = {"kd[0]", "kd[1]", "kd[2]"}, *const eta[] = {"eta[0]", "eta[1]",
                                                                                 "eta[2]"};
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    m.lobes = (hnbrdf_lobes){{1.0f, -2.0f}, {{0}}};
    for (int c = 0; c < 3; c++) {
        check_range(&m, &m.kd[c], kd[c], 0.0f, 1.0f);
        check_range(&m, &m.eta[c], eta[c], 1.0f + 0x1p-23f, HNBRDF_MAX_ETA);
    }
    check_range(&m, &m.alpha[0], "alpha[0]", HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
    check_range(&m, &m.alpha[1], "alpha[1]", HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
    check_range(&m, &m.rotation, "rotation", -3.4028235e38f, 3.4028235e38f);
    check_range(&m, &m.latent[0], "latent[0]", -3.4028235e38f, 3.4028235e38f);
    check_range(&m, &m.latent[HNBRDF_MAX_LATENT - 1], "latent[15]", -3.4028235e38f, 3.4028235e38f);
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        check_range(&m, &m.lobes.scale[k], k ? "lobes.scale[1]" : "lobes.scale[0]", 1e-4f, 1e4f);
        m.lobes.scale[k] = -1e4f; /* of all normals; 0 is no lobe */
        assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
        m.lobes.scale[k] = 0.0f;
        assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++) {
            char name[] = "lobes.share[0][0]";
            name[12] = (char)('0' + k);
            name[15] = (char)('0' + j);
            check_range(&m, &m.lobes.share[k][j], name, 0.0f, 1.0f);
        }
    }
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++) {
        hnbrdf_error error = {""};
        m.lobes.share[0][j] = 0.5f;
        m.lobes.share[1][j] = 0.5f;
        assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
        m.lobes.share[1][j] = 0.5f + 0x1p-23f; /* the first sum above 1 */
        assert_int_equal(hnbrdf_material_check(&m, &error), HNBRDF_ERROR_ARGUMENT);
        assert_non_null(strstr(error.text, "sum of lobes.share"));
        m.lobes.share[1][j] = 0.0f;
    }
}

static void a_rotation_that_is_no_angle_counts_as_none(void **state)
{
    (void)state;
    const float rotations[] = {0.0f, -0.0f, NAN, INFINITY, -INFINITY},
                angles[] = {1.0f, -1.0f, 7.0f};
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    for (size_t k = 0; k < sizeof rotations / sizeof rotations[0]; k++) {
        m.rotation = rotations[k];
        hnbrdf_frame frame = hnbrdf_frame_of(&m);
        assert_true(frame.cosine == 1.0f && frame.sine == 0.0f);
    }
    for (size_t k = 0; k < sizeof angles / sizeof angles[0]; k++) {
        m.rotation = angles[k];
        hnbrdf_frame frame = hnbrdf_frame_of(&m);
        assert_true(frame.cosine == (float)cos((double)angles[k]));
        assert_true(frame.sine == (float)sin((double)angles[k]));
    }
}

/* ---- Mixing ---------------------------------------------------------------------------------- */

static double reflectance(double eta)
{
    return (eta - 1.0) / (eta + 1.0) * ((eta - 1.0) / (eta + 1.0));
}

/* A few roundings each, and exp and log within 2 ulp of an argument up to 9: 1e-5 is plenty. */
static void near_to(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-5 * fabs(expected) + 1e-7))
        fail_msg("%.9g, expected %.9g", value, expected);
}

static void mixed_parameters_follow_their_formulas(void **state)
{
    (void)state;
    rng r = rng_make(91);
    for (int k = 0; k < 3000; k++) {
        hnbrdf_material a = random_material(&r, 1), b = random_material(&r, 1), m;
        const float t = rng_range(&r, 0.01f, 0.99f);
        const double s = (double)t;
        hnbrdf_material_mix(&a, &b, t, &m);
        for (int c = 0; c < 3; c++) {
            near_to((double)m.kd[c], (1 - s) * (double)a.kd[c] + s * (double)b.kd[c]);
            double mixed =
                (1 - s) * reflectance((double)a.eta[c]) + s * reflectance((double)b.eta[c]);
            /* eta is off by some 2^-23, which moves r^2 by about r times that */
            assert_true(fabs(reflectance((double)m.eta[c]) - mixed) <=
                        2e-5 * mixed + 1e-6 * sqrt(mixed));
        }
        near_to((double)m.alpha[0],
                exp((1 - s) * log((double)a.alpha[0]) + s * log((double)b.alpha[0])));
        assert_true(m.alpha[0] == m.alpha[1]);
        for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
            near_to((double)m.latent[i], (1 - s) * (double)a.latent[i] + s * (double)b.latent[i]);
    }
}

static void both_roughnesses_are_mixed_apart(void **state)
{
    (void)state;
    rng r = rng_make(92);
    hnbrdf_material a = random_material(&r, 0), b = random_material(&r, 0), m;
    hnbrdf_material_mix(&a, &b, 0.5f, &m);
    for (int k = 0; k < 2; k++)
        near_to((double)m.alpha[k], sqrt((double)a.alpha[k] * (double)b.alpha[k]));
}

/* A half turn is none: the shorter way. Of one isotropic and one anisotropic material the angle of
 * the latter. */
static void angles_are_mixed_the_shorter_way(void **state)
{
    (void)state;
    static const struct {
        float from, to, t, expected;
    } cases[] = {{0.2f, 1.0f, 0.25f, 0.4f},         {1.5f, -1.5f, 0.5f, 1.57079633f},
                 {-1.5f, 1.5f, 0.5f, -1.57079633f}, {0.0f, 3.14159265f, 0.5f, 0.0f},
                 {0.0f, 7.0f, 0.5f, 0.35840735f}, /* 7 - 2 pi, half of it */
                 {0.1f, -6.2831853f, 0.75f, 0.025f}};
    hnbrdf_material a, b, m;
    hnbrdf_material_init(&a);
    hnbrdf_material_init(&b);
    a.alpha[0] = b.alpha[0] = 0.2f;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        a.rotation = cases[k].from;
        b.rotation = cases[k].to;
        hnbrdf_material_mix(&a, &b, cases[k].t, &m);
        assert_true(fabsf(m.rotation - cases[k].expected) < 1e-6f);
    }
    a.rotation = 0.3f;
    b.rotation = 0.9f;
    b.alpha[0] = b.alpha[1];
    hnbrdf_material_mix(&a, &b, 0.5f, &m);
    assert_true(m.rotation == 0.3f);
    hnbrdf_material_mix(&b, &a, 0.5f, &m);
    assert_true(m.rotation == 0.3f);
}

static void beyond_the_ends_there_are_the_ends(void **state)
{
    (void)state;
    const float to_a[] = {0.0f, -0.0f, -1.0f, -INFINITY, NAN},
                to_b[] = {1.0f, 1.01f, 1.5f, INFINITY};
    rng r = rng_make(93);
    hnbrdf_material a = random_material(&r, 0), b = random_material(&r, 0), m;
    random_lobes(&r, &a.lobes); /* b has none: mixed there would be none */
    for (size_t k = 0; k < sizeof to_a / sizeof to_a[0]; k++) {
        hnbrdf_material_mix(&a, &b, to_a[k], &m);
        assert_memory_equal(&m, &a, sizeof m);
    }
    for (size_t k = 0; k < sizeof to_b / sizeof to_b[0]; k++) {
        hnbrdf_material_mix(&a, &b, to_b[k], &m);
        assert_memory_equal(&m, &b, sizeof m);
        hnbrdf_material_mix(&b, &a, to_b[k], &m);
        assert_memory_equal(&m, &a, sizeof m);
    }
    hnbrdf_material_mix(&a, &b, 0x1p-149f, &m); /* the smallest step in: a, but by mixing */
    for (int c = 0; c < 3; c++)
        assert_true(m.kd[c] == a.kd[c]);
    hnbrdf_material_mix(&a, &b, 0.5f, &a); /* in place */
    assert_true(a.kd[0] != b.kd[0]);
}

static void lobes_of_one_kind_are_mixed_and_others_are_left_out(void **state)
{
    (void)state;
    static const float signs[] = {-1.0f, 0.0f, 1.0f};
    static const hnbrdf_lobes none = {{0.0f, 0.0f}, {{0.0f}}};
    rng r = rng_make(94);
    for (int k = 0; k < 81; k++) {
        hnbrdf_material a = random_material(&r, 1), b = random_material(&r, 1), m;
        const float t = 0.25f;
        random_lobes(&r, &a.lobes);
        random_lobes(&r, &b.lobes);
        const float x[2] = {signs[k % 3] * fabsf(a.lobes.scale[0]),
                            signs[k / 3 % 3] * fabsf(a.lobes.scale[1])};
        const float y[2] = {signs[k / 9 % 3] * fabsf(b.lobes.scale[0]),
                            signs[k / 27] * fabsf(b.lobes.scale[1])};
        memcpy(a.lobes.scale, x, sizeof x);
        memcpy(b.lobes.scale, y, sizeof y);
        hnbrdf_material_mix(&a, &b, t, &m);
        if (k % 3 != k / 9 % 3 || k / 3 % 3 != k / 27) {
            assert_memory_equal(&m.lobes, &none, sizeof none);
            continue;
        }
        for (int l = 0; l < HNBRDF_LOBES; l++) {
            double size =
                x[l] == 0.0f ? 0.0
                             : exp(0.75 * log(fabs((double)x[l])) + 0.25 * log(fabs((double)y[l])));
            near_to((double)m.lobes.scale[l], x[l] < 0.0f ? -size : size);
            assert_int_equal(m.lobes.scale[l] == 0.0f, x[l] == 0.0f);
            for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
                near_to((double)m.lobes.share[l][j],
                        0.75 * (double)a.lobes.share[l][j] + 0.25 * (double)b.lobes.share[l][j]);
        }
    }
}

/* Shares that fill a sum of 1 at every knot: rounding must not take the mixed sum above it. */
static void mixed_shares_never_exceed_one(void **state)
{
    (void)state;
    rng r = rng_make(95);
    for (int k = 0; k < 5000; k++) {
        hnbrdf_material a = random_material(&r, 1), b = random_material(&r, 1), m;
        a.lobes.scale[0] = b.lobes.scale[0] = 1.0f; /* a scale of 1 is one too */
        a.lobes.scale[1] = b.lobes.scale[1] = -1.0f;
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++) {
            a.lobes.share[0][j] = 1.0f - (a.lobes.share[1][j] = rng_float(&r));
            b.lobes.share[0][j] = 1.0f - (b.lobes.share[1][j] = rng_float(&r));
        }
        hnbrdf_material_mix(&a, &b, rng_float(&r), &m);
        assert_true(m.lobes.scale[0] == 1.0f && m.lobes.scale[1] == -1.0f);
        assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fresh_material_is_half_grey_and_rough),
        cmocka_unit_test(every_range_is_held_to_its_last_float),
        cmocka_unit_test(a_rotation_that_is_no_angle_counts_as_none),
        cmocka_unit_test(mixed_parameters_follow_their_formulas),
        cmocka_unit_test(both_roughnesses_are_mixed_apart),
        cmocka_unit_test(angles_are_mixed_the_shorter_way),
        cmocka_unit_test(beyond_the_ends_there_are_the_ends),
        cmocka_unit_test(lobes_of_one_kind_are_mixed_and_others_are_left_out),
        cmocka_unit_test(mixed_shares_never_exceed_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
