/* test_growth.c: how bench_growth_exponents() fits, and that a quick run measures everything. */
#include "bench/growth.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>

static void exponents_of_powers_are_exact(void **state)
{
    growth_series s = {.what = "a power"};
    (void)state;
    for (int k = 0; k < 6; k++)
        bench_growth_point(&s, pow(3.0, k), 7.0 * pow(pow(3.0, k), 1.5), pow(pow(3.0, k), 2.0));
    const growth_exponents e = bench_growth_exponents(&s);
    assert_true(fabs(e.cost - 1.5) < 1e-12 && fabs(e.last_cost - 1.5) < 1e-12);
    assert_true(fabs(e.work - 2.0) < 1e-12 && fabs(e.last_work - 2.0) < 1e-12);
}

/* A constant part hides growth from the first sizes, not from the last. */
static void the_last_points_tell_growth_behind_a_constant(void **state)
{
    growth_series s = {.what = "a sum"};
    (void)state;
    for (int k = 0; k < 5; k++)
        bench_growth_point(&s, pow(10.0, k), 100.0 + pow(10.0, k), pow(10.0, k));
    const growth_exponents e = bench_growth_exponents(&s);
    assert_true(e.cost < 0.6 && e.last_cost > 0.95 && e.last_cost < 1.0);
}

static void too_few_points_have_no_exponent(void **state)
{
    growth_series s = {.what = "little"};
    (void)state;
    assert_true(isnan(bench_growth_exponents(&s).cost));
    bench_growth_point(&s, 1.0, 2.0, 1.0);
    assert_true(isnan(bench_growth_exponents(&s).cost));
    bench_growth_point(&s, 2.0, (double)NAN, 1.0);
    assert_true(isnan(bench_growth_exponents(&s).cost));
}

static int has(const growth *g, const char *what, const char *against)
{
    for (int k = 0; k < g->count; k++)
        if (strcmp(g->series[k].what, what) == 0 && strcmp(g->series[k].against, against) == 0)
            return 1;
    return 0;
}

static void a_quick_run_has_every_cost(void **state)
{
    static growth g;
    hnbrdf_error error;
    const bench_growth_options options = {.quick = 1, .device = "none"};
    (void)state;
    assert_int_equal(bench_growth(&options, &g, &error), HNBRDF_OK);
    for (int k = 0; k < g.count; k++) {
        assert_true(g.series[k].count >= 2);
        for (int i = 0; i < g.series[k].count; i++)
            assert_true(g.series[k].points[i].cost > 0.0 && g.series[k].points[i].work > 0.0);
    }
    static const char *const axes[] = {"H", "N", "l"};
    for (int a = 0; a < 3; a++)
        assert_true(has(&g, "evaluation, batch", axes[a]) && has(&g, "loading", axes[a]) &&
                    has(&g, "export to GLSL", axes[a]));
    static const char *const of_materials[] = {"evaluation, mixed batch",
                                               "saving",
                                               "loading",
                                               "export to GLSL",
                                               "edit of one material",
                                               "look-up by name",
                                               "info without physics",
                                               "fit, everything"};
    for (int k = 0; k < 8; k++)
        assert_true(has(&g, of_materials[k], "materials"));
    assert_true(has(&g, "evaluation of a batch", "pairs") && has(&g, "fit, everything", "pairs"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exponents_of_powers_are_exact),
        cmocka_unit_test(the_last_points_tell_growth_behind_a_constant),
        cmocka_unit_test(too_few_points_have_no_exponent),
        cmocka_unit_test(a_quick_run_has_every_cost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
