/* test_measured_families.c: members of the families are what a measurement could be at every
 * parameter, and their parameters do what their names say. */
#include "measured/families.h"
#include "measured_support.h"

static const double pi = 3.14159265358979323846;

static hnbrdf_measured *open_member(int family, const hnbrdf_family_parameters *parameters)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error;
    if (hnbrdf_family_open(family, parameters, "member", &measured, &error) != HNBRDF_OK)
        fail_msg("%s: %s", hnbrdf_family_name(family), error.text);
    return measured;
}

/* All factors as large as they may be, or the member itself. */
static hnbrdf_family_parameters parameters_at(int family, double alpha, int most)
{
    hnbrdf_family_parameters p;
    int has = hnbrdf_family_has(family);
    hnbrdf_family_member(family, alpha, &p);
    for (int k = 0; k < 2; k++)
        p.alpha[k] = fmin(p.alpha[k], 1.0);
    for (int c = 0; c < 3 && most; c++) {
        p.reflectance[c] = has & HNBRDF_FAMILY_ETA ? 2.0 : 1.0;
        p.diffuse[c] = has & HNBRDF_FAMILY_DIFFUSE ? 1.5 : 1.0;
    }
    return p;
}

static void names_are_short_unique_and_plain(void **state)
{
    int count = 0;
    (void)state;
    for (; hnbrdf_family_name(count); count++) {
        const char *name = hnbrdf_family_name(count);
        assert_in_range(strlen(name), 3, 15);
        assert_int_equal(strspn(name, "abcdefghijklmnopqrstuvwxyz-"), strlen(name));
        assert_true(strlen(hnbrdf_family_about(count)) > 5);
        for (int k = 0; k < count; k++)
            assert_string_not_equal(name, hnbrdf_family_name(k));
    }
    assert_true(count >= 11);
    assert_null(hnbrdf_family_name(-1));
}

static void values_are_reciprocal_to_the_last_bit(void **state)
{
    (void)state;
    for (int f = 0; hnbrdf_family_name(f); f++) {
        hnbrdf_family_parameters p = parameters_at(f, 0.16, 1);
        if (hnbrdf_family_has(f) & HNBRDF_FAMILY_STRETCH)
            p.alpha[0] = 0.05;
        p.rotation = 0.7;
        hnbrdf_measured *measured = open_member(f, &p);
        assert_int_equal(hnbrdf_measured_is_isotropic(measured), p.alpha[0] == p.alpha[1]);
        assert_reciprocal(measured, (uint64_t)f, 10000);
        hnbrdf_measured_close(measured);
    }
}

/* Down to the smallest alpha, where f may pass 1e6. */
static void values_are_finite_up_to_the_horizon(void **state)
{
    static const float heights[] = {1.0f, 0.7f, 1e-2f, 1e-4f, 1e-8f};
    static const double alphas[] = {1e-3, 0.08, 1.0};
    (void)state;
    for (int f = 0; hnbrdf_family_name(f); f++)
        for (int a = 0; a < 3; a++) {
            hnbrdf_family_parameters p = parameters_at(f, alphas[a], 1);
            hnbrdf_measured *measured = open_member(f, &p);
            for (int i = 0; i < 25; i++) {
                float zi = heights[i / 5], zo = heights[i % 5], value[3];
                const float wi[3] = {sqrtf(1.0f - zi * zi), 0.0f, zi};
                const float wo[3] = {-sqrtf(1.0f - zo * zo), 0.0f, zo};
                const float back[3] = {sqrtf(1.0f - zo * zo), 0.0f, zo};
                assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, value), 1);
                assert_int_equal(hnbrdf_measured_eval(measured, wi, back, value), 1);
            }
            hnbrdf_measured_close(measured);
        }
}

/* 100 rings are within 0.03 of 800 for these alphas; the largest albedo is 0.97. */
static void no_member_reflects_more_than_arrives(void **state)
{
    static const double alphas[] = {0.005, 0.02, 0.1, 0.3, 1.0}, degrees[] = {0, 40, 70, 85, 89};
    (void)state;
    for (int f = 0; hnbrdf_family_name(f); f++)
        for (int k = 0; k < 25; k++) {
            double albedo[3];
            hnbrdf_family_parameters p = parameters_at(f, alphas[k / 5], 1);
            /* The lobe of the beads is not about n, and too narrow for these rings. */
            if (strcmp(hnbrdf_family_name(f), "retro") == 0 && alphas[k / 5] < 0.1)
                continue;
            hnbrdf_measured *measured = open_member(f, &p);
            directional_albedo(measured, 100, degrees[k % 5] * pi / 180, 0.4, albedo);
            for (int c = 0; c < 3; c++)
                if (!(albedo[c] > 0.02 && albedo[c] <= 1.0))
                    fail_msg("%s, alpha %g: albedo %.3f at %.0f degrees", hnbrdf_family_name(f),
                             alphas[k / 5], albedo[c], degrees[k % 5]);
            hnbrdf_measured_close(measured);
        }
}

/* ---- What parameters do ---------------------------------------------------------------------- */

static void eval_at(int family, const hnbrdf_family_parameters *p, const float wi[3],
                    const float wo[3], float f[3])
{
    hnbrdf_measured *measured = open_member(family, p);
    assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
    hnbrdf_measured_close(measured);
}

/* Near normal incidence a lobe of twice the alpha is twice as wide and a quarter as high. */
static void lobes_scale_with_alpha(void **state)
{
    (void)state;
    for (int f = 0; hnbrdf_family_name(f); f++) {
        float values[2][3];
        hnbrdf_family_parameters p;
        if (hnbrdf_family_has(f) & HNBRDF_FAMILY_DIFFUSE)
            continue;
        for (int k = 0; k < 2; k++) {
            double slope = 0.004 * (k + 1);
            const float wi[3] = {(float)sin(2 * slope), 0.0f, (float)cos(2 * slope)};
            const float wo[3] = {0.0f, 0.0f, 1.0f};
            hnbrdf_family_member(f, 0.01 * (k + 1), &p);
            eval_at(f, &p, wi, wo, values[k]);
        }
        for (int c = 0; c < 3; c++)
            if (fabs((double)values[0][c] / (double)values[1][c] - 4.0) > 0.04)
                fail_msg("%s: %g at alpha 0.01, %g at 0.02", hnbrdf_family_name(f),
                         (double)values[0][c], (double)values[1][c]);
    }
}

static void reflectance_scales_what_is_mirrored(void **state)
{
    static const float up[3] = {0.0f, 0.0f, 1.0f};
    (void)state;
    for (int f = 0; hnbrdf_family_name(f); f++) {
        hnbrdf_family_parameters p;
        float whole[3], half[3];
        /* Fibres and beads are no surface of an index. */
        if (strcmp(hnbrdf_family_name(f), "sheen") == 0 ||
            strcmp(hnbrdf_family_name(f), "retro") == 0)
            continue;
        hnbrdf_family_member(f, 0.16, &p);
        for (int c = 0; c < 3 && hnbrdf_family_has(f) & HNBRDF_FAMILY_DIFFUSE; c++)
            p.diffuse[c] = 0.0;
        eval_at(f, &p, up, up, whole);
        p.reflectance[1] = 0.5;
        eval_at(f, &p, up, up, half);
        assert_true(fabs((double)half[1] / (double)whole[1] - 0.5) < 1e-5);
        assert_true(half[0] == whole[0] && half[2] == whole[2]);
    }
}

static void the_diffuse_part_is_linear_in_its_factor(void **state)
{
    static const float wi[3] = {0.6f, 0.0f, 0.8f}, wo[3] = {0.0f, 0.28f, 0.96f};
    (void)state;
    for (int f = 0; hnbrdf_family_name(f); f++) {
        hnbrdf_family_parameters p;
        float values[3][3];
        if (!(hnbrdf_family_has(f) & HNBRDF_FAMILY_DIFFUSE))
            continue;
        for (int k = 0; k < 3; k++) {
            hnbrdf_family_member(f, 0.16, &p);
            p.diffuse[2] = k * 0.75;
            eval_at(f, &p, wi, wo, values[k]);
        }
        assert_true(values[0][0] == values[2][0]);
        assert_true(values[1][2] > values[0][2]);
        double steps[2] = {(double)(values[1][2] - values[0][2]),
                           (double)(values[2][2] - values[1][2])};
        assert_true(fabs(steps[0] / steps[1] - 1.0) < 1e-4);
    }
}

/* Turning the tangent frame is turning both directions back. */
static void rotation_turns_the_frame(void **state)
{
    static const double angle = 0.5;
    (void)state;
    for (int f = 0; hnbrdf_family_name(f); f++) {
        if (!(hnbrdf_family_has(f) & HNBRDF_FAMILY_STRETCH))
            continue;
        hnbrdf_family_parameters p = parameters_at(f, 0.16, 0);
        float turned[3], straight[3], w[2][3] = {{0.3f, 0.1f, 0.0f}, {-0.2f, 0.05f, 0.0f}},
                                      back[2][3];
        p.alpha[0] = 0.1;
        p.alpha[1] = 0.3;
        p.rotation = 0.0;
        for (int k = 0; k < 2; k++) {
            w[k][2] = sqrtf(1.0f - w[k][0] * w[k][0] - w[k][1] * w[k][1]);
            back[k][0] = (float)(cos(angle) * (double)w[k][0] + sin(angle) * (double)w[k][1]);
            back[k][1] = (float)(cos(angle) * (double)w[k][1] - sin(angle) * (double)w[k][0]);
            back[k][2] = w[k][2];
        }
        eval_at(f, &p, back[0], back[1], straight);
        p.rotation = angle;
        eval_at(f, &p, w[0], w[1], turned);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)turned[c] / (double)straight[c] - 1.0) < 1e-4);
    }
}

static void refuses(int family, const hnbrdf_family_parameters *p, const char *words)
{
    hnbrdf_measured *untouched = (hnbrdf_measured *)(void *)&untouched, *measured = untouched;
    hnbrdf_error error = {""};
    assert_int_equal(hnbrdf_family_open(family, p, "member", &measured, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_ptr_equal(measured, untouched);
    assert_non_null(strstr(error.text, hnbrdf_family_name(family)));
    if (!strstr(error.text, words))
        fail_msg("'%s' does not hold '%s'", error.text, words);
}

static void parameters_out_of_range_are_refused(void **state)
{
    (void)state;
    for (int f = 0; hnbrdf_family_name(f); f++) {
        hnbrdf_family_parameters good, p;
        int has = hnbrdf_family_has(f);
        hnbrdf_family_member(f, 0.16, &good);
        p = good;
        p.alpha[1] = 1.01;
        refuses(f, &p, "alpha_y is 1.01, expected from 0.0001 to 1");
        p.alpha[1] = (double)NAN;
        refuses(f, &p, "alpha_y is nan");
        p = good;
        p.reflectance[2] = has & HNBRDF_FAMILY_ETA ? 2.1 : 1.1;
        refuses(f, &p, "the factor on the reflectance is");
        p = good;
        p.diffuse[0] = has & HNBRDF_FAMILY_DIFFUSE ? 1.6 : 0.9;
        refuses(f, &p, "the factor on the diffuse part is");
        p = good;
        p.rotation = (double)INFINITY;
        refuses(f, &p, "rotation");
        p = good;
        p.alpha[0] = 0.1;
        if (!(has & HNBRDF_FAMILY_STRETCH))
            refuses(f, &p, "one alpha");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_short_unique_and_plain),
        cmocka_unit_test(values_are_reciprocal_to_the_last_bit),
        cmocka_unit_test(values_are_finite_up_to_the_horizon),
        cmocka_unit_test(no_member_reflects_more_than_arrives),
        cmocka_unit_test(lobes_scale_with_alpha),
        cmocka_unit_test(reflectance_scales_what_is_mirrored),
        cmocka_unit_test(the_diffuse_part_is_linear_in_its_factor),
        cmocka_unit_test(rotation_turns_the_frame),
        cmocka_unit_test(parameters_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
