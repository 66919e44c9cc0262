/* test_measured_procedural.c: procedural materials are what measurements could be, the same each
 * time, and their simulated measurement is one of the same surface. */
#include "measured/procedural.h"
#include "measured_support.h"

enum { MATERIALS = 40, PAIRS = 2000 };

static hnbrdf_measured *open_number(int number)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error;
    if (hnbrdf_measured_open_procedural(number, &measured, &error) != HNBRDF_OK)
        fail_msg("%d: %s", number, error.text);
    return measured;
}

/* As they lie in the tables: every fourth is the formula itself. */
static int is_measured(const hnbrdf_measured *measured)
{
    return strstr(hnbrdf_measured_summary(measured), "as RGL would measure it") != NULL;
}

static void a_number_is_a_material(void **state)
{
    (void)state;
    for (int number = 0; number < 12; number++) {
        hnbrdf_measured *first = open_number(number), *again = open_number(number);
        hnbrdf_measured *next = open_number(number + 1);
        hnbrdf_rng rng;
        char name[32];
        int differ = 0;
        snprintf(name, sizeof name, "procedural-%d", number);
        assert_string_equal(hnbrdf_measured_name(first), name);
        assert_int_equal(hnbrdf_measured_is_isotropic(first), 1);
        assert_int_equal(is_measured(first), number % 4 != 3);
        hnbrdf_rng_seed(&rng, 1, 1);
        for (int k = 0; k < 100; k++) {
            float wi[3], wo[3], f[3], g[3], h[3];
            hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
            assert_int_equal(hnbrdf_measured_eval(first, wi, wo, f), 1);
            assert_int_equal(hnbrdf_measured_eval(again, wi, wo, g), 1);
            assert_int_equal(hnbrdf_measured_eval(next, wi, wo, h), 1);
            assert_memory_equal(f, g, sizeof f);
            differ += memcmp(f, h, sizeof f) != 0;
        }
        assert_true(differ > 90);
        hnbrdf_measured_close(first);
        hnbrdf_measured_close(again);
        hnbrdf_measured_close(next);
    }
}

/* Of light from everywhere, at normal incidence; by the cosine sampler, so that f times pi is its
 * estimate. */
static double albedo_from_above(const hnbrdf_measured *measured)
{
    const float up[3] = {0.0f, 0.0f, 1.0f};
    hnbrdf_rng rng;
    double sum = 0.0;
    hnbrdf_rng_seed(&rng, 2, 1);
    for (int k = 0; k < PAIRS; k++) {
        float wi[3], wo[3], f[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_COSINE, &rng, wi, wo);
        assert_int_equal(hnbrdf_measured_eval(measured, wi, up, f), 1);
        for (int c = 0; c < 3; c++) {
            assert_true(isfinite(f[c]) && f[c] >= 0.0f);
            sum += (double)f[c] * 3.14159265 / (3 * PAIRS);
        }
    }
    return sum;
}

/* A sharp highlight is met by few of the directions, so that only the rougher ones are judged from
 * above; all of them are neither black nor brighter than snow on the whole. */
static void they_reflect_some_light_and_not_too_much(void **state)
{
    double mean = 0.0;
    (void)state;
    for (int number = 0; number < MATERIALS; number++) {
        hnbrdf_measured *measured = open_number(number);
        const double albedo = albedo_from_above(measured);
        assert_true(albedo > 1e-4);
        mean += fmin(albedo, 2.0) / MATERIALS;
        hnbrdf_measured_close(measured);
    }
    assert_in_range((int)(100.0 * mean), 5, 60);
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double luminance(const float f[3])
{
    return 0.2126 * (double)f[0] + 0.7152 * (double)f[1] + 0.0722 * (double)f[2];
}

/* |ln(f / f of the formula)| in the middle of all pairs away from the horizon. */
static double typical_difference(int number, const hnbrdf_measured *measured)
{
    static double differences[PAIRS];
    procedural *drawn = calloc(1, sizeof *drawn);
    hnbrdf_rng rng;
    int count = 0;
    assert_non_null(drawn);
    hnbrdf_procedural_draw(number, drawn);
    hnbrdf_rng_seed(&rng, 3, 1);
    for (int k = 0; k < PAIRS; k++) {
        float wi[3], wo[3], f[3], g[3];
        double i[3], o[3], value[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        if (wi[2] < 0.3f || wo[2] < 0.3f)
            continue;
        for (int c = 0; c < 3; c++) {
            i[c] = (double)wi[c];
            o[c] = (double)wo[c];
        }
        assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
        hnbrdf_procedural_eval(drawn, i, o, value);
        for (int c = 0; c < 3; c++)
            g[c] = (float)fmax(value[c], 0.0);
        if (luminance(g) > 0.0)
            differences[count++] = fabs(log((luminance(f) + 1e-4) / (luminance(g) + 1e-4)));
    }
    free(drawn);
    assert_true(count > PAIRS / 4);
    qsort(differences, (size_t)count, sizeof *differences, compare_doubles);
    return differences[count / 2];
}

/* Eight directions of incidence and 32 x 32 colours are not the surface, but they are one of it:
 * what a shader of the wrong frame, or tables in the wrong order, would be off by is several times
 * as large as this. */
static void a_simulated_measurement_is_near_its_formula(void **state)
{
    int near = 0, all = 0;
    (void)state;
    for (int number = 0; number < MATERIALS; number++) {
        hnbrdf_measured *measured = open_number(number);
        if (is_measured(measured)) {
            const double difference = typical_difference(number, measured);
            assert_true(difference < 1.0);
            near += difference < 0.1;
            all++;
        }
        hnbrdf_measured_close(measured);
    }
    assert_int_equal(all, MATERIALS * 3 / 4);
    assert_true(near > all / 2);
}

static void numbers_out_of_range_are_refused(void **state)
{
    static const int wrong[] = {-1, HNBRDF_MAX_PROCEDURAL + 1};
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error;
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        assert_int_equal(hnbrdf_measured_open_procedural(wrong[k], &measured, &error),
                         HNBRDF_ERROR_ARGUMENT);
        assert_non_null(strstr(error.text, "expected 0 to 999999"));
        assert_null(measured);
    }
    assert_int_equal(hnbrdf_measured_open_procedural(0, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    measured = open_number(HNBRDF_MAX_PROCEDURAL);
    hnbrdf_measured_close(measured);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_number_is_a_material),
        cmocka_unit_test(they_reflect_some_light_and_not_too_much),
        cmocka_unit_test(a_simulated_measurement_is_near_its_formula),
        cmocka_unit_test(numbers_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
