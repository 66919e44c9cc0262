/* test_measured_shared.c: the readers meet the reference values of real RGL files and of MERL
 * stand-ins. Skipped without the shared data: HNBRDF_DATA_DIR, or the folder beside the checkout.
 */
#include "measured_support.h"
#include "measured/merl_known.h"

#include <sys/stat.h>
#include <unistd.h>

static const double PI = 3.14159265358979323846;
static const char *shared;

static void shared_path(char path[600], const char *format, ...)
{
    va_list arguments;
    int n = snprintf(path, 600, "%s/", shared);
    va_start(arguments, format);
    vsnprintf(path + n, (size_t)(600 - n), format, arguments);
    va_end(arguments);
}

static FILE *open_table(const char *name)
{
    char path[600], header[400];
    shared_path(path, "data/%s", name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(header, sizeof header, file));
    return file;
}

static hnbrdf_measured *open_path(const char *path)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_measured_open(path, NULL, &measured, &error) != HNBRDF_OK)
        fail_msg("%s", error.text);
    return measured;
}

/* One row: name, wi, wo, f (and perhaps more). */
typedef struct row {
    char name[100];
    float wi[3], wo[3];
    double f[3];
} row;

static int parse_row(const char *line, row *r)
{
    return sscanf(line, "%99[^,],%f,%f,%f,%f,%f,%f,%lf,%lf,%lf", r->name, &r->wi[0], &r->wi[1],
                  &r->wi[2], &r->wo[0], &r->wo[1], &r->wo[2], &r->f[0], &r->f[1], &r->f[2]) == 10;
}

static int read_row(FILE *file, row *r)
{
    char line[400];
    return fgets(line, sizeof line, file) && parse_row(line, r);
}

static double largest(const double f[3])
{
    return fmax(f[0], fmax(f[1], f[2]));
}

/* Tolerance: 1e-4 of the largest channel; the reference computes in float. */
static void rgl_files_give_the_reference_values(void **state)
{
    FILE *file = open_table("rgl_checkpoints.csv");
    hnbrdf_measured *measured = NULL;
    double worst = 0.0;
    int rows = 0;
    row r;
    (void)state;
    for (; read_row(file, &r); rows++) {
        float f[3];
        if (!measured || strcmp(hnbrdf_measured_name(measured), r.name) != 0) {
            char path[600];
            hnbrdf_measured_close(measured);
            shared_path(path, "data/rgl/%s_rgb.bsdf", r.name);
            measured = open_path(path);
            assert_string_equal(hnbrdf_measured_name(measured), r.name);
            assert_int_equal(hnbrdf_measured_is_isotropic(measured), 1);
        }
        assert_int_equal(hnbrdf_measured_eval(measured, r.wi, r.wo, f), 1);
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs((double)f[c] - r.f[c]) / largest(r.f));
    }
    hnbrdf_measured_close(measured);
    fclose(file);
    print_message("    worst %.2g of the largest channel\n", worst);
    assert_int_equal(rows, 240);
    assert_true(worst <= 1e-4);
}

/* f wo.z at the four wavelengths, signed, six digits: the reference is a float loader. */
static void check_spectral(const char *path, const char *line)
{
    const hnbrdf_measured_options options = {.rgl_spectra = 1, .rgl_signed = 1};
    hnbrdf_measured *measured = NULL;
    float wi[3], wo[3], spectrum[4];
    double reference[4], most = 0.0;
    const float *nm = NULL;
    assert_int_equal(sscanf(line, "%*[^,],%f,%f,%f,%f,%f,%f,%lf,%lf,%lf,%lf", &wi[0], &wi[1],
                            &wi[2], &wo[0], &wo[1], &wo[2], &reference[0], &reference[1],
                            &reference[2], &reference[3]),
                     10);
    assert_int_equal(hnbrdf_measured_open(path, &options, &measured, NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_measured_wavelengths(measured, &nm), 4);
    assert_int_equal(hnbrdf_measured_eval_spectrum(measured, wi, wo, 4, nm, spectrum), 1);
    for (int l = 0; l < 4; l++)
        most = fmax(most, fabs(reference[l]));
    for (int l = 0; l < 4; l++)
        assert_true(fabs((double)spectrum[l] * (double)wo[2] - reference[l]) <= 1e-5 * most);
    hnbrdf_measured_close(measured);
}

/* f wo.z, six digits. */
static void synthetic_rgl_files_give_the_reference_values(void **state)
{
    FILE *file = open_table("synthetic/rgl_synthetic_checkpoints.csv");
    char line[400];
    int rows = 0, spectral = 0;
    row r;
    (void)state;
    while (fgets(line, sizeof line, file) && parse_row(line, &r)) {
        char path[600];
        float f[3];
        shared_path(path, "data/synthetic/%s.bsdf", r.name);
        if (strcmp(r.name, "aniso_spec") == 0) {
            check_spectral(path, line);
            spectral++;
            continue;
        }
        hnbrdf_measured *measured = open_path(path);
        assert_int_equal(hnbrdf_measured_eval(measured, r.wi, r.wo, f), 1);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)f[c] * (double)r.wo[2] - r.f[c]) <= 1e-5 * largest(r.f));
        hnbrdf_measured_close(measured);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, 20);
    assert_int_equal(spectral, 5);
}

/* Signed f wo.z of the 240 rows: what the default clips, the option keeps. */
static void rgl_files_keep_their_sign_on_request(void **state)
{
    const hnbrdf_measured_options options = {.rgl_signed = 1};
    FILE *file = open_table("rgl_checkpoints_extra.csv");
    hnbrdf_measured *measured = NULL;
    char line[400], name[100], path[600];
    int rows = 0, negative = 0;
    (void)state;
    for (; fgets(line, sizeof line, file); rows++) {
        float wi[3], wo[3], f[3];
        double reference[3];
        assert_int_equal(sscanf(line, "%99[^,],%f,%f,%f,%f,%f,%f,%*f,%*f,%*f,%lf,%lf,%lf", name,
                                &wi[0], &wi[1], &wi[2], &wo[0], &wo[1], &wo[2], &reference[0],
                                &reference[1], &reference[2]),
                         10);
        if (!measured || strcmp(hnbrdf_measured_name(measured), name) != 0) {
            hnbrdf_measured_close(measured);
            shared_path(path, "data/rgl/%s_rgb.bsdf", name);
            assert_int_equal(hnbrdf_measured_open(path, &options, &measured, NULL), HNBRDF_OK);
        }
        hnbrdf_measured_eval(measured, wi, wo, f);
        double most = fmax(fabs(reference[0]), fmax(fabs(reference[1]), fabs(reference[2])));
        for (int c = 0; c < 3; c++) {
            assert_true(fabs((double)f[c] * (double)wo[2] - reference[c]) <= 1e-4 * most);
            negative += f[c] < 0.0f;
        }
    }
    hnbrdf_measured_close(measured);
    fclose(file);
    print_message("    %d negative values\n", negative);
    assert_int_equal(rows, 240);
    assert_true(negative > 8);
}

/* The table in the library against the list it was made from. */
static void published_checksums_are_those_of_the_list(void **state)
{
    char path[600], digest[65], file_name[100];
    int rows = 0;
    (void)state;
    shared_path(path, "data/MERL.sha256");
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    for (; fscanf(file, "%64s %99s", digest, file_name) == 2; rows++) {
        const char *name = hnbrdf_merl_known_digest(digest);
        assert_non_null(name);
        *strstr(file_name, ".binary") = 0;
        assert_string_equal(name, file_name);
    }
    fclose(file);
    assert_int_equal(rows, 100);
}

/* ---- MERL stand-ins, decoded by the program in shared/tools ---------------------------------- */

static char folder[] = "measured-XXXXXX";
static const char *const STAND_INS[] = {"alum-bronze", "gold-metallic-paint", "red-phenolic"};

static int run(const char *format, ...)
{
    char command[3000];
    va_list arguments;
    va_start(arguments, format);
    int n = vsnprintf(command, sizeof command, format, arguments);
    va_end(arguments);
    return n > 0 && (size_t)n < sizeof command && system(command) == 0;
}

static hnbrdf_measured *decode_stand_in(const char *name)
{
    char path[200];
    if (access(folder, F_OK) != 0) {
        assert_non_null(mkdtemp(folder));
        if (!run("cc -O2 -std=c11 -ffp-contract=off '%s/tools/nbrdf_to_merl.c' -o %s/decode -lm",
                 shared, folder))
            return NULL;
    }
    if (!run(
            "./%s/decode '%s/data/nbrdf/nbrdf_merl.f32' '%s/data/nbrdf/nbrdf_merl.names.txt' %s %s "
            ">/dev/null",
            folder, shared, shared, folder, name))
        return NULL;
    snprintf(path, sizeof path, "%s/nbrdf_%s.binary", folder, name);
    hnbrdf_measured *measured = open_path(path);
    remove(path);
    return measured;
}

static int clean_up(void **state)
{
    char path[200];
    (void)state;
    snprintf(path, sizeof path, "%s/decode", folder);
    remove(path);
    rmdir(folder);
    return 0;
}

static double within(int edge, double share, double bins)
{
    return ((double)edge + share) / bins;
}

/* f somewhere in bin (i, j, k): at its centre, or nearer to its lower edge where the centre is
 * below the horizon. Returns 0 if no point tried is above. */
static int eval_in_bin(const hnbrdf_measured *measured, const int ijk[3], float f[3])
{
    static const double shares[] = {0.5, 0.1, 0.01, 0.001};
    for (int n = 0; n < 64; n++) {
        double u = within(ijk[0], shares[n / 16], 90),
               theta_d = within(ijk[1], shares[n / 4 % 4], 90) * PI / 2;
        float wi[3], wo[3];
        if (pair_at(u * u * PI / 2, theta_d, within(ijk[2], shares[n % 4], 180) * PI, 0.3, wi,
                    wo) &&
            hnbrdf_measured_eval(measured, wi, wo, f))
            return 1;
    }
    return 0;
}

/* Six digits are printed; a float holds seven. Rows stored as -1 lie below the horizon: no
 * pair finds them. */
static void check_stand_in(const char *wanted)
{
    hnbrdf_measured *measured = decode_stand_in(wanted);
    if (!measured)
        skip();
    assert_int_equal(hnbrdf_measured_format_of(measured), HNBRDF_MEASURED_MERL);
    assert_non_null(strstr(hnbrdf_measured_summary(measured), "76.2 % valid"));
    FILE *file = open_table("merl_checkpoints.csv");
    char line[400], name[100];
    int rows = 0;
    while (fgets(line, sizeof line, file)) {
        int ijk[3];
        double stored, reference[3];
        float f[3];
        assert_int_equal(sscanf(line, "%99[^,],%d,%d,%d,%*d,%lf,%*f,%*f,%lf,%lf,%lf", name, &ijk[0],
                                &ijk[1], &ijk[2], &stored, &reference[0], &reference[1],
                                &reference[2]),
                         8);
        if (strcmp(name, wanted) != 0)
            continue;
        int valid = eval_in_bin(measured, ijk, f);
        assert_int_equal(valid, stored >= 0.0);
        for (int c = 0; valid && c < 3; c++)
            assert_true(fabs((double)f[c] - reference[c]) <= 1e-5 * reference[c]);
        rows++;
    }
    fclose(file);
    hnbrdf_measured_close(measured);
    print_message("    %s: %d rows\n", wanted, rows);
    assert_int_equal(rows, 30);
}

static void merl_stand_in_alum_bronze_gives_the_reference_values(void **state)
{
    (void)state;
    check_stand_in(STAND_INS[0]);
}

static void merl_stand_in_gold_metallic_paint_gives_the_reference_values(void **state)
{
    (void)state;
    check_stand_in(STAND_INS[1]);
}

static void merl_stand_in_red_phenolic_gives_the_reference_values(void **state)
{
    (void)state;
    check_stand_in(STAND_INS[2]);
}

int main(void)
{
    char path[600];
    const char *given = getenv("HNBRDF_DATA_DIR");
    shared = given && *given ? given : HNBRDF_SHARED_DEFAULT;
    shared_path(path, "data/rgl_checkpoints.csv");
    if (access(path, R_OK) != 0) {
        print_message("no shared data at %s: skipped\n", shared);
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rgl_files_give_the_reference_values),
        cmocka_unit_test(synthetic_rgl_files_give_the_reference_values),
        cmocka_unit_test(rgl_files_keep_their_sign_on_request),
        cmocka_unit_test(published_checksums_are_those_of_the_list),
        cmocka_unit_test(merl_stand_in_alum_bronze_gives_the_reference_values),
        cmocka_unit_test(merl_stand_in_gold_metallic_paint_gives_the_reference_values),
        cmocka_unit_test(merl_stand_in_red_phenolic_gives_the_reference_values),
    };
    return cmocka_run_group_tests(tests, NULL, clean_up);
}
