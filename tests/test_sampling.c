/* test_sampling.c: what hnbrdf_sample() and hnbrdf_pdf() promise of every single result: the
 * edges of u, of views and of materials. That samples follow the density:
 * test_sampling_density.c. */
#include "core_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

/* What hnbrdf.h promises of every result, whatever u and wo: one place for all tests below. */
static void check_result(const hnbrdf_model *model, const hnbrdf_material *m, const float wo[3],
                         const hnbrdf_sample_result *s)
{
    float f[3], pdf = hnbrdf_pdf(model, m, s->wi, wo);
    assert_true(s->pdf >= 0.0f && s->pdf <= HNBRDF_MAX_VALUE);
    if (s->pdf == 0.0f) {
        const hnbrdf_sample_result nothing = {{0.0f, 0.0f, 1.0f}, 0.0f, {0.0f, 0.0f, 0.0f}};
        assert_same_bits(&s->wi[0], &nothing.wi[0], 3);
        assert_same_bits(&s->weight[0], &nothing.weight[0], 3);
        return;
    }
    assert_same_bits(&s->pdf, &pdf, 1);
    assert_true(s->wi[2] > 0.0f);
    hnbrdf_eval(model, m, s->wi, wo, f);
    for (int c = 0; c < 3; c++) {
        double weight = (double)f[c] * (double)s->wi[2] / (double)s->pdf;
        assert_true(s->weight[c] >= 0.0f && s->weight[c] <= HNBRDF_MAX_VALUE);
        if (weight > 1e-30 && weight < 1e38 && (double)f[c] * (double)s->wi[2] < 1e38)
            /* two roundings */
            assert_true(fabs((double)s->weight[c] - weight) <= 2.01 * UNIT * weight);
    }
}

/* |2 (wo.h) h - wo| = |wo|: the rounding of k, of the products and of the differences stays below
 * 8 u. */
static void check_unit(const float w[3])
{
    double length = sqrt((double)w[0] * (double)w[0] + (double)w[1] * (double)w[1] +
                         (double)w[2] * (double)w[2]);
    assert_true(fabs(length - 1.0) <= 8 * UNIT);
}

static void every_sample_keeps_the_promises_of_the_header(void **state)
{
    (void)state;
    static const hnbrdf_kind kinds[] = {HNBRDF_KIND_HYBRID, HNBRDF_KIND_NEURAL, HNBRDF_KIND_GGX};
    rng r = rng_make(45);
    for (int n = 0; n < 6; n++) {
        hnbrdf_model *model = random_model(&r, kinds[n % 3], (hnbrdf_encoding)(n / 3), 8, 2, 4);
        for (int k = 0; k < 20000; k++) {
            hnbrdf_material m = random_material(&r, k & 1);
            if (k & 2)
                random_lobes(&r, &m.lobes);
            const float u[2] = {rng_float(&r), rng_float(&r)};
            hnbrdf_sample_result s;
            float wo[3];
            if (k % 3)
                direction_uniform(&r, wo);
            else
                direction_grazing(&r, wo);
            hnbrdf_sample(model, &m, wo, u, &s);
            check_result(model, &m, wo, &s);
            check_unit(s.wi);
        }
        hnbrdf_model_free(model);
    }
}

/* Every combination of the ends of u, with roughness and view at their ends too. */
static void ends_of_u_give_finite_directions_and_densities(void **state)
{
    (void)state;
    static const float ends[] = {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1.0f - 0x1p-24f};
    static const float alphas[] = {HNBRDF_MIN_ALPHA, 0.03f, HNBRDF_MAX_ALPHA};
    static const double cosines[] = {1.0, 0.5, 1e-2, 1e-4, 1e-7, 1e-30};
    enum { ENDS = sizeof ends / sizeof ends[0] };
    rng r = rng_make(46);
    hnbrdf_model *model =
        random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_HALF_DIFFERENCE, 8, 2, 4);
    int drawn = 0, total = 0;
    for (int a = 0; a < 9; a++)
        for (int v = 0; v < 6; v++)
            for (int k = 0; k < ENDS * ENDS; k++) {
                hnbrdf_material m = random_material(&r, 1);
                if (k & 1)
                    random_lobes(&r, &m.lobes);
                const float u[2] = {ends[k % ENDS], ends[k / ENDS]};
                hnbrdf_sample_result s;
                float wo[3];
                m.alpha[0] = alphas[a % 3];
                m.alpha[1] = alphas[a / 3];
                direction(cosines[v], 1.3 * v, wo);
                hnbrdf_sample(model, &m, wo, u, &s);
                check_result(model, &m, wo, &s);
                check_unit(s.wi);
                drawn += s.pdf > 0.0f;
                total++;
            }
    assert_true(drawn > total / 2); /* finite because drawn, not because refused */
    hnbrdf_model_free(model);
}

/* u[1] = 0 is the normal between n and wo (turned no farther from n than wo is): its reflection
 * is above the horizon, so a refusal would mean that the radicand fell below 0. */
static void smallest_u_is_never_refused(void **state)
{
    (void)state;
    rng r = rng_make(50);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    for (int k = 0; k < 20000; k++) {
        hnbrdf_material m = random_material(&r, 1);
        const float u[2] = {rng_float(&r), 0.0f};
        hnbrdf_sample_result s;
        float wo[3];
        direction_uniform(&r, wo);
        hnbrdf_sample(model, &m, wo, u, &s);
        assert_true(s.pdf > 0.0f);
    }
    hnbrdf_model_free(model);
}

static void bad_numbers_give_a_result_that_can_be_used(void **state)
{
    (void)state;
    static const float bad[] = {0.0f, -0.0f, -1.0f, 2.0f, 1e-38f, 3e38f, INFINITY, -INFINITY, NAN};
    const uint32_t n = sizeof bad / sizeof bad[0];
    rng r = rng_make(47);
    hnbrdf_model *model =
        random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_HALF_DIFFERENCE, 8, 2, 4);
    for (int k = 0; k < 50000; k++) {
        hnbrdf_material m = random_material(&r, 0);
        if (k & 8)
            random_lobes(&r, &m.lobes);
        const float u[2] = {rng_float(&r), rng_float(&r)};
        hnbrdf_sample_result s;
        float wo[3];
        direction_uniform(&r, wo);
        wo[rng_u32(&r) % 3] = bad[rng_u32(&r) % n];
        if (k % 4 == 0)
            ((float *)&m)[rng_u32(&r) % (sizeof m / sizeof(float))] = bad[rng_u32(&r) % n];
        hnbrdf_sample(model, &m, wo, u, &s);
        check_result(model, &m, wo, &s);
        for (int c = 0; c < 3; c++)
            assert_true(isfinite(s.wi[c]));
    }
    hnbrdf_model_free(model);
}

static void density_is_zero_below_the_horizon(void **state)
{
    (void)state;
    rng r = rng_make(48);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    static const float below[] = {0.0f, -0.0f, -0.3f, -INFINITY, NAN};
    for (size_t k = 0; k < sizeof below / sizeof below[0]; k++) {
        hnbrdf_material m = random_material(&r, 1);
        float w[3], v[3];
        direction_uniform(&r, w);
        direction_uniform(&r, v);
        v[2] = below[k];
        assert_true(hnbrdf_pdf(model, &m, w, v) == 0.0f);
        assert_true(hnbrdf_pdf(model, &m, v, w) == 0.0f);
    }
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_sample_keeps_the_promises_of_the_header),
        cmocka_unit_test(ends_of_u_give_finite_directions_and_densities),
        cmocka_unit_test(smallest_u_is_never_refused),
        cmocka_unit_test(bad_numbers_give_a_result_that_can_be_used),
        cmocka_unit_test(density_is_zero_below_the_horizon),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
