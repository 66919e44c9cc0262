/* test_measured_trilinear.c: the trilinear lookup in MERL tables: between samples
 * at bin centres or at lower edges, around the seam of phi_d, without the bins that hold no
 * measurement. */
#include "measured_support.h"

static const double PI = 3.14159265358979323846;
enum { TH = 90, TD = 90, PD = 180, BINS = TH * TD * PD, FILE_SIZE = 12 + 24 * BINS };

static size_t sample_at(int channel, int i, int j, int k)
{
    return 12 + 8 * ((size_t)channel * BINS + (size_t)((i * TD + j) * PD + k));
}

static test_bytes table;

/* In the bin coordinates: red 1 + i, green 1 + j, blue a tent of phi_d around 90, each in 1/sr. */
static int set_up(void **state)
{
    (void)state;
    table = (test_bytes){calloc(1, FILE_SIZE), FILE_SIZE};
    put_le(table.data, TH, 4);
    put_le(table.data + 4, TD, 4);
    put_le(table.data + 8, PD, 4);
    for (int i = 0; i < TH; i++)
        for (int j = 0; j < TD; j++)
            for (int k = 0; k < PD; k++) {
                put_double(table.data + sample_at(0, i, j, k), 1500 * (1.0 + i));
                put_double(table.data + sample_at(1, i, j, k), 1500 / 1.15 * (1.0 + j));
                put_double(table.data + sample_at(2, i, j, k), 1500 / 1.66 * (100.0 - abs(k - 90)));
            }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(table.data);
    return 0;
}

static hnbrdf_measured *open_lookup(hnbrdf_merl_lookup lookup, hnbrdf_merl_node node)
{
    return expect_opens_with(table.data, table.size, "ramp.binary",
                             &(hnbrdf_measured_options){.merl_lookup = lookup, .merl_node = node});
}

/* At bin coordinates; they may be any real numbers that lie above the horizon. */
static int eval_at(const hnbrdf_measured *measured, double u, double v, double w, float f[3])
{
    float wi[3], wo[3];
    double theta_h = u / TH * u / TH * PI / 2;
    if (!pair_at(theta_h, v / TD * PI / 2, w / PD * PI, 0.7, wi, wo))
        fail_msg("%g %g %g lies below the horizon", u, v, w);
    return hnbrdf_measured_eval(measured, wi, wo, f);
}

/* Float directions know theta_h = (u/90)^2 pi/2 to 1e-7: u to 1e-3 at u = 5, and less above. */
static void values_are_linear_between_nodes(void **state)
{
    static const double places[][3] = {{5.25, 40.5, 60.25},
                                       {20.8, 30.1, 120.75},
                                       {33.3, 10.9, 99.5},
                                       {45.0, 45.0, 45.0},
                                       {61.6, 20.2, 89.3}};
    (void)state;
    for (int node = 0; node < 2; node++) {
        double shift = node == HNBRDF_MERL_CENTRE ? 0.5 : 0.0;
        hnbrdf_measured *measured = open_lookup(HNBRDF_MERL_TRILINEAR, (hnbrdf_merl_node)node);
        for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
            const double *p = places[i];
            float f[3];
            assert_int_equal(eval_at(measured, p[0], p[1], p[2], f), 1);
            assert_true(fabs((double)f[0] - (1 + p[0] - shift)) < 2e-3);
            assert_true(fabs((double)f[1] - (1 + p[1] - shift)) < 2e-3);
            double before = floor(p[2] - shift), t = p[2] - shift - before;
            double tent = (1 - t) * (100 - fabs(before - 90)) + t * (100 - fabs(before + 1 - 90));
            assert_true(fabs((double)f[2] - tent) < 2e-3);
        }
        hnbrdf_measured_close(measured);
    }
}

/* Blue is 10 at k = 0 and 11 at k = 179: between 179 and 180, which is 0, it is between. */
static void phi_d_goes_on_around_its_seam(void **state)
{
    hnbrdf_measured *edge = open_lookup(HNBRDF_MERL_TRILINEAR, HNBRDF_MERL_EDGE);
    hnbrdf_measured *centre = open_lookup(HNBRDF_MERL_TRILINEAR, HNBRDF_MERL_CENTRE);
    float f[3];
    (void)state;
    eval_at(edge, 30, 30, 179.25, f);
    assert_true(fabs((double)f[2] - 10.75) < 2e-3);
    eval_at(centre, 30, 30, 0.25, f); /* a quarter below the centre of bin 0 */
    assert_true(fabs((double)f[2] - 10.25) < 2e-3);
    eval_at(centre, 30, 30, 179.75, f);
    assert_true(fabs((double)f[2] - 10.75) < 2e-3);
    hnbrdf_measured_close(edge);
    hnbrdf_measured_close(centre);
}

/* Beyond the outermost samples of theta_h and theta_d there is nothing to go to. */
static void the_outermost_samples_hold(void **state)
{
    hnbrdf_measured *centre = open_lookup(HNBRDF_MERL_TRILINEAR, HNBRDF_MERL_CENTRE);
    hnbrdf_measured *edge = open_lookup(HNBRDF_MERL_TRILINEAR, HNBRDF_MERL_EDGE);
    const float n[3] = {0, 0, 1};
    float f[3];
    (void)state;
    assert_int_equal(hnbrdf_measured_eval(centre, n, n, f), 1);
    assert_true(f[0] == 1.0f && f[1] == 1.0f);
    eval_at(edge, 2, 89.9, 90, f);
    assert_true(fabs((double)f[1] - 90) < 2e-3);
    eval_at(edge, 89.6, 0.2, 90, f);
    assert_true(fabs((double)f[0] - 90) < 2e-3);
    hnbrdf_measured_close(centre);
    hnbrdf_measured_close(edge);
}

static void a_bin_centre_gives_the_value_of_the_nearest_lookup(void **state)
{
    hnbrdf_measured *nearest = open_lookup(HNBRDF_MERL_NEAREST, HNBRDF_MERL_CENTRE);
    hnbrdf_measured *trilinear = open_lookup(HNBRDF_MERL_TRILINEAR, HNBRDF_MERL_CENTRE);
    (void)state;
    for (int i = 5; i < 60; i += 7)
        for (int j = 5; j < 30; j += 6) {
            float f[3], g[3];
            eval_at(nearest, i + 0.5, j + 0.5, 77.5, f);
            eval_at(trilinear, i + 0.5, j + 0.5, 77.5, g);
            for (int c = 0; c < 3; c++)
                assert_true(fabs((double)(f[c] - g[c])) < 2e-3);
        }
    hnbrdf_measured_close(nearest);
    hnbrdf_measured_close(trilinear);
}

static void swapping_directions_gives_the_same_bits(void **state)
{
    hnbrdf_measured *measured = open_lookup(HNBRDF_MERL_TRILINEAR, HNBRDF_MERL_CENTRE);
    hnbrdf_rng rng;
    (void)state;
    hnbrdf_rng_seed(&rng, 5, 6);
    for (int i = 0; i < 100000; i++) {
        float wi[3], wo[3], f[3], g[3];
        hnbrdf_sampler_draw((hnbrdf_sampler)(i % 3), &rng, wi, wo);
        hnbrdf_measured_eval(measured, wi, wo, f);
        hnbrdf_measured_eval(measured, wo, wi, g);
        assert_memory_equal(f, g, sizeof f);
    }
    hnbrdf_measured_close(measured);
}

/* Of the eight corners around (30.25, 30, 60) at lower edges, those of i = 31 are spoilt: red is
 * then that of i = 30, not drawn towards a missing value; with i = 30 spoilt too nothing is left.
 */
static void bins_without_a_measurement_are_left_out(void **state)
{
    float f[3];
    (void)state;
    for (int spoilt = 31; spoilt >= 30; spoilt--) {
        for (int j = 29; j <= 31; j++)
            for (int k = 59; k <= 61; k++)
                put_double(table.data + sample_at(1, spoilt, j, k), -1.0);
        hnbrdf_measured *measured = open_lookup(HNBRDF_MERL_TRILINEAR, HNBRDF_MERL_EDGE);
        int valid = eval_at(measured, 30.25, 30, 60, f);
        assert_int_equal(valid, spoilt == 31);
        if (valid)
            assert_true(f[0] == 31.0f);
        else
            assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
        hnbrdf_measured_close(measured);
    }
    tear_down(state);
    set_up(state);
}

static void the_summary_tells_the_lookup(void **state)
{
    static const struct {
        hnbrdf_merl_lookup lookup;
        hnbrdf_merl_node node;
        const char *words;
    } rows[] = {
        {HNBRDF_MERL_NEAREST, HNBRDF_MERL_CENTRE, ", nearest bin"},
        {HNBRDF_MERL_TRILINEAR, HNBRDF_MERL_CENTRE, ", trilinear between bin centres"},
        {HNBRDF_MERL_TRILINEAR, HNBRDF_MERL_EDGE, ", trilinear between lower edges of bins"}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        hnbrdf_measured *measured = open_lookup(rows[i].lookup, rows[i].node);
        assert_non_null(strstr(hnbrdf_measured_summary(measured), rows[i].words));
        hnbrdf_measured_close(measured);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_linear_between_nodes),
        cmocka_unit_test(phi_d_goes_on_around_its_seam),
        cmocka_unit_test(the_outermost_samples_hold),
        cmocka_unit_test(a_bin_centre_gives_the_value_of_the_nearest_lookup),
        cmocka_unit_test(swapping_directions_gives_the_same_bits),
        cmocka_unit_test(bins_without_a_measurement_are_left_out),
        cmocka_unit_test(the_summary_tells_the_lookup),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
