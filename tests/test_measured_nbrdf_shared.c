/* test_measured_nbrdf_shared.c: the published networks of Neural-BRDF: .h5, .npy and the packed
 * weights agree to the last bit, and a MERL table that another program made of one holds the same
 * values. Skipped without the shared data: HNBRDF_DATA_DIR, or the folder beside the checkout. */
#include "nbrdf_support.h"

#include "measured/nbrdf.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef HNBRDF_WITH_HDF5
#include "hnbrdf/hdf5.h"
static const hnbrdf_measured_options usual = {.read_hdf5 = hnbrdf_hdf5_read};
#else
static const hnbrdf_measured_options usual;
#endif

extern const measured_reader hnbrdf_nbrdf_reader;

static const char *shared;
static char directory[64];

static hnbrdf_measured *open_path(const char *path)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_measured_open(path, &usual, &measured, &error) != HNBRDF_OK)
        fail_msg("%s", error.text);
    return measured;
}

static test_bytes read_whole(const char *name)
{
    char path[600];
    snprintf(path, sizeof path, "%s/data/nbrdf/%s", shared, name);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    test_bytes bytes = {malloc(1 << 20), 0};
    assert_non_null(bytes.data);
    bytes.size = fread(bytes.data, 1, (1 << 20) - 1, file);
    bytes.data[bytes.size] = 0;
    fclose(file);
    return bytes;
}

/* Network `index` of a packed set. */
static void packed_network(test_network *network, const test_bytes *weights, size_t index)
{
    assert_true(2700 * (index + 1) <= weights->size);
    test_network_from_floats(network, weights->data + 2700 * index);
}

/* The packed network of this name. */
static void find_packed(test_network *network, const char *set, const char *name)
{
    char file[64], *line;
    size_t index = 0;
    snprintf(file, sizeof file, "nbrdf_%s.names.txt", set);
    test_bytes names = read_whole(file);
    snprintf(file, sizeof file, "nbrdf_%s.f32", set);
    test_bytes weights = read_whole(file);
    for (line = strtok((char *)names.data, "\n"); line && strcmp(line, name) != 0;
         line = strtok(NULL, "\n"))
        index++;
    assert_non_null(line);
    packed_network(network, &weights, index);
    free(names.data);
    free(weights.data);
}

static void expect_same_values(const hnbrdf_measured *a, const hnbrdf_measured *b)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 5, 0);
    for (int k = 0; k < 2000; k++) {
        float wi[3], wo[3], first[3], second[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &rng, wi, wo);
        assert_int_equal(hnbrdf_measured_eval(a, wi, wo, first), 1);
        assert_int_equal(hnbrdf_measured_eval(b, wi, wo, second), 1);
        assert_memory_equal(first, second, sizeof first);
    }
}

static void published_files_agree_with_the_packed_weights(void **state)
{
    static const char *const cases[][3] = {
        {"npy/blue-acrylic_fc1.npy", "merl", "blue-acrylic"},
        {"npy/blue-acrylic", "merl", "blue-acrylic"},
        {"keras/blue-acrylic.h5", "merl", "blue-acrylic"},
        {"keras/leaf_maple_rgb.h5", "rgl", "leaf_maple"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char path[600];
        test_network network;
#ifndef HNBRDF_WITH_HDF5
        if (strstr(cases[i][0], ".h5"))
            continue;
#endif
        find_packed(&network, cases[i][1], cases[i][2]);
        test_write_npy(directory, "packed", &network);
        snprintf(path, sizeof path, "%s/packed", directory);
        hnbrdf_measured *packed = open_path(path);
        snprintf(path, sizeof path, "%s/data/nbrdf/%s", shared, cases[i][0]);
        hnbrdf_measured *published = open_path(path);
        expect_same_values(packed, published);
        hnbrdf_measured_close(packed);
        hnbrdf_measured_close(published);
        test_remove_npy(directory, "packed");
    }
}

static void every_published_network_follows_the_formulas(void **state)
{
    static const char *const sets[] = {"merl", "rgl", "nielsen"};
    int count = 0;
    (void)state;
    for (size_t s = 0; s < sizeof sets / sizeof sets[0]; s++) {
        char path[128];
        snprintf(path, sizeof path, "nbrdf_%s.f32", sets[s]);
        test_bytes weights = read_whole(path);
        snprintf(path, sizeof path, "%s/n", directory);
        for (size_t index = 0; 2700 * (index + 1) <= weights.size; index++, count++) {
            test_network network;
            hnbrdf_rng rng;
            packed_network(&network, &weights, index);
            test_write_npy(directory, "n", &network);
            hnbrdf_measured *measured = open_path(path);
            hnbrdf_rng_seed(&rng, index, s);
            for (int k = 0; k < 40; k++) {
                float wi[3], wo[3], f[3];
                double i[3], o[3], expected[3], bound[3], li = 0.0, lo = 0.0;
                hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &rng, wi, wo);
                for (int c = 0; c < 3; c++) {
                    li += (double)wi[c] * (double)wi[c];
                    lo += (double)wo[c] * (double)wo[c];
                }
                for (int c = 0; c < 3; c++) {
                    i[c] = (double)wi[c] / sqrt(li);
                    o[c] = (double)wo[c] / sqrt(lo);
                }
                test_network_eval(&network, i, o, expected, bound);
                assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
                for (int c = 0; c < 3; c++)
                    if (!(fabs((double)f[c] - expected[c]) <= bound[c]))
                        fail_msg("%s %zu: %.9g, expected %.9g within %.3g", sets[s], index,
                                 (double)f[c], expected[c], bound[c]);
            }
            hnbrdf_measured_close(measured);
            test_remove_npy(directory, "n");
        }
        free(weights.data);
    }
    assert_int_equal(count, 153);
}

#ifdef HNBRDF_WITH_HDF5

static void open_damaged(const test_bytes *file)
{
    unsigned char *copy = malloc(file->size);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; copy && k < 500; k++) {
        hnbrdf_measured *measured = NULL;
        memcpy(copy, file->data, file->size);
        for (unsigned n = 1 + hnbrdf_rng_u32(&rng) % 4; n > 0; n--)
            copy[8 + hnbrdf_rng_u32(&rng) % 8184] = (unsigned char)hnbrdf_rng_u32(&rng);
        hnbrdf_measured_open_memory(copy, file->size, "a.h5", &usual, &measured, NULL);
        hnbrdf_measured_close(measured);
    }
    free(copy);
}

/* In a process of its own, which ends as a program does: libhdf5 says nothing, then neither. Runs
 * first: this process must not have used libhdf5. */
static void damaged_files_leave_no_message_at_exit(void **state)
{
    char text[] = "/tmp/hnbrdf_nbrdf_XXXXXX";
    int log = mkstemp(text), status = -1;
    test_bytes file = read_whole("keras/blue-acrylic.h5");
    (void)state;
    assert_true(log >= 0);
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        if (dup2(log, 2) != 2)
            _exit(1);
        open_damaged(&file);
        exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    off_t printed = lseek(log, 0, SEEK_END);
    close(log);
    remove(text);
    free(file.data);
    assert_int_equal(status, 0);
    assert_int_equal(printed, 0);
}

#endif

#ifdef HNBRDF_NBRDF_TO_MERL
static const double PI = 3.14159265358979323846;

/* Every 7th bin of the table that the decoder writes, at the lower edges where it evaluates. The
 * same sums of floats: 1e-12 relative, but for the few inputs that round to another float there,
 * where sin(), cos() and square roots differ by 1e-16. */
static void a_decoded_table_holds_the_same_values(void **state)
{
    static const char *const names[] = {"alum-bronze", "blue-acrylic", "chrome-steel"};
    static const double scale[3] = {1.00 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
    enum { BINS = 90 * 90 * 180 };
    hnbrdf_measured_options options = {.max_bytes = (size_t)1 << 20};
    (void)state;
    for (size_t m = 0; m < sizeof names / sizeof names[0]; m++) {
        char command[2048], path[256];
        test_network network;
        snprintf(command, sizeof command,
                 "'%s' '%s/data/nbrdf/nbrdf_merl.f32' '%s/data/nbrdf/nbrdf_merl.names.txt' '%s' %s"
                 " > /dev/null",
                 HNBRDF_NBRDF_TO_MERL, shared, shared, directory, names[m]);
        assert_int_equal(system(command), 0);
        snprintf(path, sizeof path, "%s/nbrdf_%s.binary", directory, names[m]);
        unsigned char *table = malloc(12 + (size_t)BINS * 24);
        FILE *file = fopen(path, "rb");
        assert_non_null(table);
        assert_non_null(file);
        assert_int_equal(fread(table, 1, 12 + (size_t)BINS * 24, file), 12 + (size_t)BINS * 24);
        fclose(file);
        remove(path);

        find_packed(&network, "merl", names[m]);
        test_write_npy(directory, "t", &network);
        snprintf(path, sizeof path, "%s/t_fc1.npy", directory);
        test_bytes first = test_npy(&network, 0, "<f4", 0, 1);
        measured_file part = {first.data, first.size, path, path};
        measured_body body = {0};
        hnbrdf_error error = {""};
        if (hnbrdf_nbrdf_reader.open(&part, &options, &body, &error) != HNBRDF_OK)
            fail_msg("%s", error.text);
        int compared = 0, other = 0;
        for (int bin = 0; bin < BINS; bin += 7) {
            double th = bin / 16200 / 90.0, td = bin / 180 % 90 / 90.0 * PI / 2;
            double pd = bin % 180 * PI / 180, f[3], stored[3];
            th = th * th * PI / 2;
            double a = cos(th) * cos(td), b = sin(th) * sin(td) * cos(pd);
            double c = sin(th) * cos(td), d = cos(th) * sin(td) * cos(pd);
            double wi[3] = {c + d, sin(td) * sin(pd), a - b};
            double wo[3] = {c - d, -sin(td) * sin(pd), a + b};
            for (int k = 0; k < 3; k++)
                memcpy(&stored[k], table + 12 + 8 * ((size_t)k * BINS + (size_t)bin), 8);
            if (stored[0] < 0.0 || wi[2] < 1e-9 || wo[2] < 1e-9)
                continue;
            body.eval(body.data, wi, wo, f);
            compared++;
            for (int k = 0; k < 3; k++) {
                double expected = stored[k] * scale[k], far = fabs(f[k] - expected);
                other += far > 1e-12 * expected;
                if (!(far <= 1e-12 * expected + 1e-4 * (expected + 0.02)))
                    fail_msg("%s, bin %d: %.9g, expected %.9g", names[m], bin, f[k], expected);
            }
        }
        if (compared < 150000 || other > compared / 1000)
            fail_msg("%s: %d bins compared, %d values differ by more than 1e-12", names[m],
                     compared, other);
        body.release(body.data);
        free(first.data);
        free(table);
        test_remove_npy(directory, "t");
    }
}

#endif

int main(void)
{
    struct stat status;
    char path[600];
    shared = getenv("HNBRDF_DATA_DIR");
    shared = shared ? shared : HNBRDF_SHARED_DEFAULT;
    snprintf(path, sizeof path, "%s/data/nbrdf/nbrdf_merl.f32", shared);
    if (stat(path, &status) != 0) {
        printf("skipped: no %s\n", path);
        return 77;
    }
    snprintf(directory, sizeof directory, "/tmp/hnbrdf_nbrdf_XXXXXX");
    if (!mkdtemp(directory))
        return 1;
    const struct CMUnitTest tests[] = {
#ifdef HNBRDF_WITH_HDF5
        cmocka_unit_test(damaged_files_leave_no_message_at_exit),
#endif
        cmocka_unit_test(published_files_agree_with_the_packed_weights),
        cmocka_unit_test(every_published_network_follows_the_formulas),
#ifdef HNBRDF_NBRDF_TO_MERL
        cmocka_unit_test(a_decoded_table_holds_the_same_values),
#endif
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return rmdir(directory) || failed;
}
