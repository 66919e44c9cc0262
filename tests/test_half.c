/* test_half.c: core/half.h against the definition of binary16: every half becomes the number it
 * stands for, and every float the nearest half. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/half.h"

#include <math.h>

/* sign, exponent, fraction by IEEE 754, in double. */
static double number_of(unsigned half)
{
    int exponent = (int)(half >> 10 & 31), fraction = (int)(half & 1023);
    double size = exponent == 0    ? ldexp(fraction, -24)
                  : exponent == 31 ? (fraction ? (double)NAN : (double)INFINITY)
                                   : ldexp(1024 + fraction, exponent - 25);
    return half & 0x8000 ? -size : size;
}

static void every_half_is_the_number_it_stands_for(void **state)
{
    (void)state;
    for (unsigned half = 0; half < 0x10000; half++) {
        double number = number_of(half), value = (double)hnbrdf_float_of_half((uint16_t)half);
        if (isnan(number))
            assert_true(isnan(value));
        else
            assert_true(value == number && signbit(value) == signbit(number));
    }
}

/* The floats at and beside every half and every middle between two: to the nearer one, from the
 * middle to the even one. */
static void every_float_goes_to_the_nearest_half(void **state)
{
    (void)state;
    for (unsigned half = 0; half < 0x7bff; half++) {
        float low = (float)number_of(half), high = (float)number_of(half + 1);
        float middle = low + (high - low) / 2; /* exact: 11 bits and one more */
        unsigned even = half & 1 ? half + 1 : half;
        const struct {
            float value;
            unsigned expected;
        } cases[] = {{low, half},
                     {nextafterf(low, INFINITY), half},
                     {nextafterf(middle, 0.0f), half},
                     {middle, even},
                     {nextafterf(middle, INFINITY), half + 1},
                     {nextafterf(high, 0.0f), half + 1}};
        for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
            assert_int_equal(hnbrdf_half_of(cases[k].value), cases[k].expected);
            assert_int_equal(hnbrdf_half_of(-cases[k].value), cases[k].expected | 0x8000);
        }
    }
}

static void what_no_half_holds_becomes_the_largest_or_zero(void **state)
{
    (void)state;
    const float over[] = {65504.0f, 65505.0f, 65519.996f, 65520.0f, 65536.0f, 3.402e+38f, INFINITY};
    for (size_t k = 0; k < sizeof over / sizeof over[0]; k++) {
        assert_int_equal(hnbrdf_half_of(over[k]), 0x7bff);
        assert_int_equal(hnbrdf_half_of(-over[k]), 0xfbff);
    }
    const uint32_t nans[] = {0x7fc00000u, 0x7f800001u, 0xffc00000u, 0xff800001u, 0x7fffffffu};
    for (size_t k = 0; k < sizeof nans / sizeof nans[0]; k++)
        assert_int_equal(hnbrdf_half_of(hnbrdf_bits_to_float((int32_t)nans[k])), 0);
    assert_int_equal(hnbrdf_half_of(1e-45f), 0);
    assert_int_equal(hnbrdf_half_of(-0.0f), 0x8000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_is_the_number_it_stands_for),
        cmocka_unit_test(every_float_goes_to_the_nearest_half),
        cmocka_unit_test(what_no_half_holds_becomes_the_largest_or_zero),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
