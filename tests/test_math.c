/* test_math.c: exp, log, sin and cos of core/math.h against libm in double, over dense sweeps of
 * the bit patterns of their arguments. The stated errors were found by trying every float once;
 * the sweeps take a stride that is prime, so that they meet every exponent and all low bits. */
#include "core/compose.h"
#include "core/math.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

/* Distance between floats at a value, in double. */
static double ulp(double value)
{
    int exponent;
    frexp(value, &exponent);
    return ldexp(1.0, (exponent < -125 ? -125 : exponent) - 24);
}

static double worst;

static void check_exp(float x)
{
    double expected = exp((double)x);
    double error = fabs((double)hnbrdf_exp(x) - expected) / ulp(expected);
    worst = fmax(worst, error);
    if (!(error <= 1.0))
        fail_msg("exp(%.9g): %.9g, off by %.3f ulp", (double)x, (double)hnbrdf_exp(x), error);
}

static void exp_is_within_its_stated_error(void **state)
{
    (void)state;
    worst = 0.0;
    for (int32_t bits = 0; bits <= 0x42a00000; bits += 499) { /* 0 to 80 */
        check_exp(hnbrdf_bits_to_float(bits));
        check_exp(-hnbrdf_bits_to_float(bits));
    }
    check_exp(80.0f);
    check_exp(-80.0f);
    print_message("    exp: worst %.3f ulp\n", worst);
    assert_true(hnbrdf_exp(0.0f) == 1.0f);
}

static void exp_never_decreases_by_more_than_its_error(void **state)
{
    (void)state;
    /* Around the points where the reduction changes its integer, neighbours must not jump. */
    for (int k = -114; k < 115; k++) {
        float x = ((float)k + 0.5f) * 0.693147181f;
        for (int i = -50; i < 50; i++) {
            float low = hnbrdf_bits_to_float(hnbrdf_float_to_bits(x) + i);
            float next = nextafterf(low, 100.0f);
            check_exp(low);
            assert_true((double)hnbrdf_exp(next) >=
                        (double)hnbrdf_exp(low) - 2.0 * ulp((double)hnbrdf_exp(low)));
        }
    }
}

static void check_log(float x)
{
    double expected = log((double)x);
    double error = fabs((double)hnbrdf_log(x) - expected);
    worst = fmax(worst, error - 1.05 * ulp(expected));
    if (!(error <= 1.05 * ulp(expected) + 5e-8))
        fail_msg("log(%.9g): %.9g, expected %.9g", (double)x, (double)hnbrdf_log(x), expected);
}

static void log_is_within_its_stated_error(void **state)
{
    (void)state;
    worst = 0.0;
    for (int32_t bits = 0x00800000; bits < 0x7f800000; bits += 499)
        check_log(hnbrdf_bits_to_float(bits));
    for (int32_t bits = 0x3f700000; bits < 0x3f900000; bits += 7) /* around 1 */
        check_log(hnbrdf_bits_to_float(bits));
    print_message("    log: worst %.3g beyond 1.05 ulp\n", worst);
    assert_true(hnbrdf_log(1.0f) == 0.0f);
    assert_true(isfinite(hnbrdf_log(INFINITY)));
}

static void sine_and_cosine_are_within_their_stated_error(void **state)
{
    (void)state;
    worst = 0.0;
    double off_circle = 0.0;
    for (int32_t k = 0; k <= 0x1000000; k += 3) { /* the u = k 2^-24 that sampling is given */
        float u = (float)k * 0x1p-24f, sine, cosine;
        double angle = 2.0 * 3.14159265358979323846 * (double)u;
        hnbrdf_sincos_turn(u, &sine, &cosine);
        worst = fmax(worst, fabs((double)sine - sin(angle)));
        worst = fmax(worst, fabs((double)cosine - cos(angle)));
        off_circle = fmax(
            off_circle, fabs((double)sine * (double)sine + (double)cosine * (double)cosine - 1.0));
    }
    print_message("    sin, cos: worst %.3g absolute, %.3g off the circle\n", worst, off_circle);
    assert_true(worst <= 1.1e-7);
    assert_true(off_circle <= 2 * 1.1e-7 * 1.4142136); /* both errors along the radius */
}

static void sine_and_cosine_are_exact_at_quarter_turns(void **state)
{
    (void)state;
    static const float turns[5][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}, {0, 1}};
    for (int k = 0; k < 5; k++) {
        float sine, cosine;
        hnbrdf_sincos_turn(0.25f * (float)k, &sine, &cosine);
        assert_true(sine == turns[k][0] && cosine == turns[k][1]);
    }
}

static void clamp_returns_its_low_end_for_nan(void **state)
{
    (void)state;
    assert_true(hnbrdf_clamp(NAN, -2.0f, 3.0f) == -2.0f);
    assert_true(hnbrdf_clamp(INFINITY, -2.0f, 3.0f) == 3.0f);
    assert_true(hnbrdf_clamp(-INFINITY, -2.0f, 3.0f) == -2.0f);
    assert_true(hnbrdf_clamp(1.0f, -2.0f, 3.0f) == 1.0f);
    assert_true(hnbrdf_finish(NAN) == 0.0f);
    assert_true(hnbrdf_finish(INFINITY) == HNBRDF_MAX_VALUE);
}

/* sigmoid(g) = 1/(1 + exp(-g)): exp within 1 ulp (2 u), its weight e/(1+e) at most 1, the sum and
 * the quotient u each, relative: 4 u, and 1 % for the second order. */
static void gate_is_the_sigmoid(void **state)
{
    (void)state;
    for (int k = -4000; k <= 4000; k++) {
        float g = (float)k * 0.02f;
        double expected = 1.0 / (1.0 + exp(-(double)g));
        assert_true(fabs((double)hnbrdf_gate(g) - expected) <= 4.04 * 0x1p-24 * expected);
    }
    assert_true(hnbrdf_gate(1e30f) == 1.0f);
    assert_true(hnbrdf_gate(-1e30f) >= 0.0f && hnbrdf_gate(-1e30f) < 1e-34f);
}

static void composition_stays_finite_whatever_the_network_says(void **state)
{
    (void)state;
    static const float values[] = {0.0f,  -1.0f,  1.0f,     80.0f,     -80.0f,
                                   1e30f, -1e30f, INFINITY, -INFINITY, NAN};
    const int n = sizeof values / sizeof values[0];
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++)
            for (int c = 0; c < n; c++) {
                float f =
                    hnbrdf_compose_hybrid(values[a], values[b], values[c], 1.0f, 0.0f, 0.003f);
                assert_true(f >= 0.0f && f <= HNBRDF_MAX_VALUE);
                f = hnbrdf_compose_neural(values[a], values[b], values[c], 0.003f);
                assert_true(f >= 0.0f && f <= HNBRDF_MAX_VALUE);
            }
}

/* The floor lets the value reach exactly 0, and takes exactly b where it does not. */
static void floor_is_subtracted_last(void **state)
{
    (void)state;
    assert_true(hnbrdf_compose_neural(-7.0f, 1.0f, 0.0f, 0.003f) == 0.0f);
    assert_true(hnbrdf_compose_hybrid(-80.0f, -80.0f, 1.0f, 1.0f, 0.0f, 0.003f) == 0.0f);
    assert_true(hnbrdf_compose_neural(0.0f, 1.0f, 0.0f, 0.25f) == 0.75f);
    assert_true(hnbrdf_compose_hybrid(0.0f, 0.0f, 2.0f, 1.0f, 0.0f, 0.25f) == 1.75f);
    assert_true(hnbrdf_compose_neural(1.0f, 2.0f, -2.0f, 0.0f) == 1.0f); /* exp(s c + m) */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exp_is_within_its_stated_error),
        cmocka_unit_test(exp_never_decreases_by_more_than_its_error),
        cmocka_unit_test(log_is_within_its_stated_error),
        cmocka_unit_test(sine_and_cosine_are_within_their_stated_error),
        cmocka_unit_test(sine_and_cosine_are_exact_at_quarter_turns),
        cmocka_unit_test(clamp_returns_its_low_end_for_nan),
        cmocka_unit_test(gate_is_the_sigmoid),
        cmocka_unit_test(composition_stays_finite_whatever_the_network_says),
        cmocka_unit_test(floor_is_subtracted_last),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
