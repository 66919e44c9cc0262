/* test_measured_spectral.c: spectral RGL files: the values of the reference loader at each
 * wavelength, and linear sRGB as the CIE's observer sees it. The files are made here: no real one
 * was at hand. */
#include "measured_support.h"
#include "measured/cie.h"

static const double PI = 3.14159265358979323846;

static hnbrdf_measured *open_spectral(const test_bytes *file, int spectra, int with_sign)
{
    return expect_opens_with(
        file->data, file->size, "synthetic_spec.bsdf",
        &(hnbrdf_measured_options){.rgl_spectra = spectra, .rgl_signed = with_sign});
}

static void set_spectra(test_bytes *file, float value)
{
    size_t first = test_data_at(file, "spectra");
    for (size_t i = 0; i < 5 * 3 * 4 * 4 * 4; i++)
        put_float(file->data + first + 4 * i, value);
}

/* ---- Spectra --------------------------------------------------------------------------------- */

/* f wo.z at 400 to 700 nm from the reference loader of the database on the same formulas, six
 * digits, computed in float. */
static void spectra_are_those_of_the_reference_loader(void **state)
{
    static const struct {
        float wi[3], wo[3];
        double fcos[4];
    } rows[] = {{{0.383022219f, 0.321393818f, 0.866025388f},
                 {-0.769751132f, -0.280166507f, 0.57357645f},
                 {0.194415, 0.286776, 0.334076, 0.170029}},
                {{-0.567547798f, -0.676377118f, 0.469471574f},
                 {0.0885213241f, 0.330366075f, 0.939692616f},
                 {0.277765, 0.324772, 0.214633, 0.335187}},
                {{-0.167731255f, 0.951251268f, 0.258819044f},
                 {-0.0818996057f, -0.936116815f, 0.342020154f},
                 {0.494394, 0.264224, 0.215067, 0.27637}},
                {{0.195373088f, -0.0711099878f, 0.978147626f},
                 {0.969846308f, 0.171010077f, 0.173648179f},
                 {0.225206, 0.280076, 0.365735, 0.266583}},
                {{-0.731854796f, 0.12904574f, 0.669130623f},
                 {0.694272041f, -0.323744357f, 0.642787635f},
                 {0.154631, 0.17664, 0.278386, 0.118924}}};
    test_bytes file = test_rgl_spectral(0);
    hnbrdf_measured *measured = open_spectral(&file, 1, 0);
    const float *nm = NULL;
    (void)state;
    assert_int_equal(hnbrdf_measured_wavelengths(measured, &nm), 4);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        float spectrum[4];
        assert_int_equal(
            hnbrdf_measured_eval_spectrum(measured, rows[i].wi, rows[i].wo, 4, nm, spectrum), 1);
        for (int l = 0; l < 4; l++) {
            assert_true(nm[l] == 400.0f + 100.0f * (float)l);
            assert_true(fabs((double)spectrum[l] * (double)rows[i].wo[2] - rows[i].fcos[l]) <
                        1e-5 * rows[i].fcos[l]);
        }
    }
    hnbrdf_measured_close(measured);
    free(file.data);
}

static void between_wavelengths_spectra_are_linear_and_beyond_them_constant(void **state)
{
    static const float wi[3] = {0.3f, 0.2f, 0.9f}, wo[3] = {-0.5f, 0.1f, 0.6f};
    static const float nm[] = {700, 650, 400, 425, 360, 1e30f, -5};
    test_bytes file = test_rgl_spectral(0);
    hnbrdf_measured *measured = open_spectral(&file, 1, 0);
    float at[4], f[7];
    (void)state;
    hnbrdf_measured_eval_spectrum(measured, wi, wo, 4, (float[4]){400, 500, 600, 700}, at);
    hnbrdf_measured_eval_spectrum(measured, wi, wo, 7, nm, f);
    assert_true(f[0] == at[3] && f[2] == at[0] && f[4] == at[0] && f[5] == at[3] && f[6] == at[0]);
    assert_true(fabs((double)f[1] - 0.5 * (double)(at[2] + at[3])) < 1e-6);
    assert_true(fabs((double)f[3] - (0.75 * (double)at[0] + 0.25 * (double)at[1])) < 1e-6);
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* Noise of either sign belongs to a spectrum; RGB is clipped unless asked. */
static void spectra_keep_their_sign_and_rgb_on_request(void **state)
{
    const double angles[4] = {0.5, 0.1, 0.7, 2.0};
    const float wi[3] = {0, 0, 1}, wo[3] = {0, 0.6f, 0.8f};
    test_bytes file = test_rgl_spectral(0);
    float f[3], spectrum[2];
    (void)state;
    set_spectra(&file, -1.0f);
    hnbrdf_measured *clipped = open_spectral(&file, 1, 0), *kept = open_spectral(&file, 0, 1);
    assert_int_equal(eval_angles(clipped, angles, f), 1);
    assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    assert_int_equal(
        hnbrdf_measured_eval_spectrum(clipped, wi, wo, 2, (float[2]){450, 550}, spectrum), 1);
    assert_true(spectrum[0] < 0.0f && spectrum[1] < 0.0f);
    assert_int_equal(eval_angles(kept, angles, f), 1);
    assert_true(f[0] < 0.0f && f[1] < 0.0f && f[2] < 0.0f);
    assert_non_null(strstr(hnbrdf_measured_summary(clipped), "100.0 % of them negative (clipped)"));
    assert_non_null(strstr(hnbrdf_measured_summary(kept), "100.0 % of them negative (kept)"));
    hnbrdf_measured_close(clipped);
    hnbrdf_measured_close(kept);
    free(file.data);
}

/* Spectra 7 and RGB of the formulas in one file: RGB wins unless the spectra are asked for; without
 * that they are not even looked at. */
static void of_rgb_and_spectra_rgb_is_the_default(void **state)
{
    const double angles[4] = {0.5, 0.1, 0.7, 2.0};
    test_bytes both = test_rgl_spectral(1), only = test_rgl(TEST_WHOLE);
    float f[3], g[3];
    (void)state;
    set_spectra(&both, 7.0f);
    hnbrdf_measured *rgb = expect_opens(only.data, only.size, "x");
    hnbrdf_measured *first = open_spectral(&both, 0, 0), *second = open_spectral(&both, 1, 0);
    eval_angles(rgb, angles, f);
    eval_angles(first, angles, g);
    assert_memory_equal(f, g, sizeof f);
    assert_int_equal(hnbrdf_measured_wavelengths(first, NULL), 0);
    eval_angles(second, angles, g);
    assert_true(g[0] == g[1] && g[1] == g[2] && g[0] > 2 * f[0]);
    assert_int_equal(hnbrdf_measured_wavelengths(second, NULL), 4);
    hnbrdf_measured_close(first);
    hnbrdf_measured_close(second);
    put_float(both.data + test_data_at(&both, "spectra"), NAN);
    hnbrdf_measured_close(open_spectral(&both, 0, 0));
    hnbrdf_measured_close(rgb);
    free(both.data);
    free(only.data);
}

static void without_spectra_there_is_no_spectrum(void **state)
{
    const float wi[3] = {0, 0, 1}, below[3] = {0, 0, -1}, *nm = wi;
    test_bytes file = test_rgl(TEST_WHOLE), spectral = test_rgl_spectral(0);
    hnbrdf_measured *dropped = open_spectral(&spectral, 0, 0), *items[2];
    float f[2] = {1, 1};
    (void)state;
    items[0] = open_spectral(&file, 1, 0); /* asked for, but there are none: RGB it is */
    assert_int_equal(hnbrdf_measured_open_builtin(0, &items[1], NULL), HNBRDF_OK);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(hnbrdf_measured_wavelengths(items[k], &nm), 0);
        assert_ptr_equal(nm, wi);
        assert_int_equal(
            hnbrdf_measured_eval_spectrum(items[k], wi, wi, 2, (float[2]){450, 550}, f), 0);
        assert_true(f[0] == 0.0f && f[1] == 0.0f);
        hnbrdf_measured_close(items[k]);
    }
    assert_int_equal(hnbrdf_measured_wavelengths(dropped, NULL), 0);
    hnbrdf_measured *kept = open_spectral(&spectral, 1, 0);
    assert_int_equal(hnbrdf_measured_eval_spectrum(kept, wi, below, 2, (float[2]){450, 550}, f), 0);
    hnbrdf_measured_close(kept);
    hnbrdf_measured_close(dropped);
    free(file.data);
    free(spectral.data);
}

/* ---- Colour ---------------------------------------------------------------------------------- */

static void a_flat_spectrum_is_grey_to_the_last_bit(void **state)
{
    static const float levels[] = {0.25f, 1.0f, 0.1f, 0.7531f};
    test_bytes file = test_rgl_spectral(0);
    (void)state;
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; i++) {
        float f[3], spectrum[1];
        const float wi[3] = {0, 0, 1}, wo[3] = {0, 0.6f, 0.8f};
        set_spectra(&file, levels[i]);
        hnbrdf_measured *measured = open_spectral(&file, 1, 0);
        hnbrdf_measured_eval(measured, wi, wo, f);
        hnbrdf_measured_eval_spectrum(measured, wi, wo, 1, (float[1]){555}, spectrum);
        assert_true(f[0] == f[1] && f[1] == f[2]);
        assert_true(fabs((double)f[0] / (double)spectrum[0] - 1) <
                    2e-7); /* one rounding to float each */
        hnbrdf_measured_close(measured);
    }
    free(file.data);
}

enum { LINES = 401 };

/* XYZ of monochromatic light of D65's power at 380 to 780 nm, from the weights by the published
 * matrix of sRGB (IEC 61966-2-1, four digits). */
static void monochromatic_xyz(double xyz[LINES][3])
{
    static const double M[3][3] = {
        {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    float nodes[LINES];
    double weights[LINES][3];
    for (int k = 0; k < LINES; k++)
        nodes[k] = 380.0f + (float)k;
    hnbrdf_cie_weights(nodes, LINES, weights);
    for (int k = 0; k < LINES; k++)
        for (int c = 0; c < 3; c++)
            xyz[k][c] = M[c][0] * weights[k][0] + M[c][1] * weights[k][1] + M[c][2] * weights[k][2];
}

/* Chromaticities of the spectral locus (CIE 15:2004, table T.6); the matrix's four digits and its
 * white (0.9505, 1, 1.0890) allow 1e-3. */
static void monochromatic_light_lies_on_the_spectral_locus(void **state)
{
    static const struct {
        int nm;
        double x, y;
    } locus[] = {{420, 0.1714, 0.0051}, {440, 0.1644, 0.0109}, {460, 0.1440, 0.0297},
                 {480, 0.0913, 0.1327}, {500, 0.0082, 0.5384}, {520, 0.0743, 0.8338},
                 {540, 0.2296, 0.7543}, {560, 0.3731, 0.6245}, {580, 0.5125, 0.4866},
                 {600, 0.6270, 0.3725}, {620, 0.6915, 0.3083}, {650, 0.7260, 0.2740}};
    static double xyz[LINES][3];
    (void)state;
    monochromatic_xyz(xyz);
    for (size_t i = 0; i < sizeof locus / sizeof locus[0]; i++) {
        const double *v = xyz[locus[i].nm - 380];
        double sum = v[0] + v[1] + v[2];
        assert_true(fabs(v[0] / sum - locus[i].x) < 1e-3 && fabs(v[1] / sum - locus[i].y) < 1e-3);
    }
}

/* Luminance over V(lambda) is the illuminant: D65 is 117.812, 100 and 87.6987 at 460, 560 and 620
 * nm; V is 0.06, 0.995 and 0.381. In the blue, luminance is what the matrix's fourth digit leaves
 * of two large terms: 1 %. */
static void the_light_is_d65(void **state)
{
    static double xyz[LINES][3];
    (void)state;
    monochromatic_xyz(xyz);
    double at_460 = xyz[80][1] / 0.06, at_560 = xyz[180][1] / 0.995, at_620 = xyz[240][1] / 0.381;
    assert_true(fabs(at_460 / at_560 / 1.17812 - 1) < 1e-2);
    assert_true(fabs(at_620 / at_560 / 0.876987 - 1) < 1e-3);
}

/* Hat functions of coarse nodes share out the same integral: a linear spectrum has the same
 * colour on any. */
static void the_spacing_of_the_wavelengths_does_not_matter(void **state)
{
    float fine[LINES], coarse[] = {360, 433, 500, 641, 720, 1000};
    double weights[LINES][3], few[6][3];
    (void)state;
    for (int k = 0; k < LINES; k++)
        fine[k] = 380.0f + (float)k;
    hnbrdf_cie_weights(fine, LINES, weights);
    hnbrdf_cie_weights(coarse, 6, few);
    for (int c = 0; c < 3; c++) {
        double a = 0.0, b = 0.0;
        for (int k = 0; k < LINES; k++)
            a += weights[k][c] * (0.1 + 0.001 * (double)fine[k]);
        for (int k = 0; k < 6; k++)
            b += few[k][c] * (0.1 + 0.001 * (double)coarse[k]);
        assert_true(fabs(a - b) < 1e-12);
    }
}

/* One wavelength is a flat spectrum; none of them in the visible range: the nearest end is. */
static void odd_wavelengths_stay_grey(void **state)
{
    static const float single[] = {550}, infrared[] = {900, 950, 1000}, ultraviolet[] = {100, 200};
    double weights[3][3];
    (void)state;
    hnbrdf_cie_weights(single, 1, weights);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(weights[0][c] - 1) < 1e-12);
    hnbrdf_cie_weights(infrared, 3, weights);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(weights[0][c] - 1) < 1e-12 && weights[1][c] == 0.0 &&
                    weights[2][c] == 0.0);
    hnbrdf_cie_weights(ultraviolet, 2, weights);
    for (int c = 0; c < 3; c++)
        assert_true(weights[0][c] == 0.0 && fabs(weights[1][c] - 1) < 1e-12);
}

static void the_summary_tells_the_wavelengths(void **state)
{
    test_bytes file = test_rgl_spectral(0);
    hnbrdf_measured *measured = open_spectral(&file, 0, 0);
    float f[3];
    (void)state;
    assert_non_null(strstr(hnbrdf_measured_summary(measured),
                           "RGL anisotropic spectral (4 wavelengths, 400 to 700 nm, made sRGB)"));
    assert_int_equal(eval_angles(measured, (double[4]){0.5, 0.1, PI / 3, 2.0}, f), 1);
    hnbrdf_measured_close(measured);
    free(file.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spectra_are_those_of_the_reference_loader),
        cmocka_unit_test(between_wavelengths_spectra_are_linear_and_beyond_them_constant),
        cmocka_unit_test(spectra_keep_their_sign_and_rgb_on_request),
        cmocka_unit_test(of_rgb_and_spectra_rgb_is_the_default),
        cmocka_unit_test(without_spectra_there_is_no_spectrum),
        cmocka_unit_test(a_flat_spectrum_is_grey_to_the_last_bit),
        cmocka_unit_test(monochromatic_light_lies_on_the_spectral_locus),
        cmocka_unit_test(the_light_is_d65),
        cmocka_unit_test(the_spacing_of_the_wavelengths_does_not_matter),
        cmocka_unit_test(odd_wavelengths_stay_grey),
        cmocka_unit_test(the_summary_tells_the_wavelengths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
