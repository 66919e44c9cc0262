/* test_measured_nbrdf_hdf5.c: networks of Neural-BRDF from HDF5 files as Keras writes them. The
 * files are made here with libhdf5; without it only the message is looked at. */
#include "nbrdf_support.h"

#include <unistd.h>

#ifdef HNBRDF_WITH_HDF5

#include "hnbrdf/hdf5.h"

#include <fcntl.h>
#include <hdf5.h>

static const hnbrdf_measured_options WITH_HDF5 = {.read_hdf5 = hnbrdf_hdf5_read};
static const char PATH[] = "hnbrdf_nbrdf_test.h5"; /* in memory only */

/* What is unusual about a file; 0 in all is as Keras writes it. */
typedef struct variant {
    const char *inside;               /* a group around the layers */
    const char *names[3];             /* of the layers; NULL: dense_1 ... dense_3 */
    hid_t type;                       /* stored; 0: a little-endian float */
    int layers;                       /* how many are written; 0: three */
    int without;                      /* array 1 to 6 is left out */
    int chunked, linked, axes, empty; /* of array 5 (bias of the last layer: 6) */
} variant;

static void write_array(hid_t group, const variant *v, const test_network *network, int k)
{
    const hsize_t shape[3] = {network->rows[k], network->columns[k], 1};
    const int axes = k % 2 ? 1 : 2;
    hid_t type = v->type ? v->type : H5T_IEEE_F32LE;
    hid_t plist = H5Pcreate(H5P_DATASET_CREATE);
    hid_t space =
        H5Screate_simple(v->axes && k == 4 ? v->axes : axes, k % 2 ? shape + 1 : shape, NULL);
    if (v->chunked && k == 4)
        assert_true(H5Pset_chunk(plist, axes, shape) >= 0 && H5Pset_deflate(plist, 1) >= 0);
    hid_t set = H5Dcreate2(group, k % 2 ? "bias:0" : "kernel:0", type, space, H5P_DEFAULT, plist,
                           H5P_DEFAULT);
    assert_true(set >= 0);
    if (!(v->empty && k == 4))
        assert_true(H5Dwrite(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                             network->values[k]) >= 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(plist);
}

static void write_layer(hid_t where, const variant *v, const test_network *network, int k)
{
    static const char *const usual[] = {"dense_1", "dense_2", "dense_3", "dense_4"};
    const char *name = k < 3 && v->names[k] ? v->names[k] : usual[k];
    hid_t outer = H5Gcreate2(where, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    hid_t group = H5Gcreate2(outer, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(outer >= 0 && group >= 0);
    for (int part = 2 * (k % 3); part < 2 * (k % 3) + 2; part++) {
        if (part + 1 == v->without)
            continue;
        if (v->linked && part == 4) {
            assert_true(H5Lcreate_external("other.h5", "/kernel", group, "kernel:0", H5P_DEFAULT,
                                           H5P_DEFAULT) >= 0);
            continue;
        }
        write_array(group, v, network, part);
    }
    H5Gclose(group);
    H5Gclose(outer);
}

/* The bytes of the file. */
static test_bytes make_file(const variant *v, const test_network *network)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    assert_true(H5Pset_fapl_core(access, 4096, 0) >= 0);
    hid_t file = H5Fcreate(PATH, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    assert_true(file >= 0);
    hid_t where =
        v->inside ? H5Gcreate2(file, v->inside, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT) : file;
    /* a group beside the layers, as lambda_1 in the published files */
    H5Gclose(H5Gcreate2(where, "lambda_1", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    for (int k = 0; k < (v->layers ? v->layers : 3); k++)
        write_layer(where, v, network, k);
    if (v->inside)
        H5Gclose(where);
    H5Fflush(file, H5F_SCOPE_GLOBAL);
    ssize_t size = H5Fget_file_image(file, NULL, 0);
    assert_true(size > 0);
    test_bytes bytes = {malloc((size_t)size), (size_t)size};
    assert_non_null(bytes.data);
    assert_int_equal(H5Fget_file_image(file, bytes.data, bytes.size), size);
    H5Fclose(file);
    H5Pclose(access);
    return bytes;
}

/* ---- What is read ---------------------------------------------------------------------------- */

static void expect_network(const variant *v, const test_network *network)
{
    hnbrdf_rng rng;
    test_bytes file = make_file(v, network);
    hnbrdf_measured *measured =
        expect_opens_with(file.data, file.size, "x/maple_rgb.h5", &WITH_HDF5);
    assert_string_equal(hnbrdf_measured_name(measured), "maple");
    assert_int_equal(hnbrdf_measured_format_of(measured), HNBRDF_MEASURED_NBRDF);
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < 200; k++) {
        float wi[3], wo[3], f[3];
        double i[3], o[3], expected[3], bound[3], li = 0.0, lo = 0.0;
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        for (int c = 0; c < 3; c++) {
            li += (double)wi[c] * (double)wi[c];
            lo += (double)wo[c] * (double)wo[c];
        }
        for (int c = 0; c < 3; c++) {
            i[c] = (double)wi[c] / sqrt(li);
            o[c] = (double)wo[c] / sqrt(lo);
        }
        test_network_eval(network, i, o, expected, bound);
        assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)f[c] - expected[c]) <= bound[c]);
    }
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* Keras counts its layers over a run of the program; a saved model holds its weights in a group. */
static void layers_are_found_whatever_they_are_called(void **state)
{
    test_network network;
    (void)state;
    test_network_make(&network, 21, 21, 1);
    expect_network(&(variant){0}, &network);
    expect_network(&(variant){.names = {"dense", "dense_1", "dense_2"}}, &network);
    expect_network(&(variant){.names = {"dense_8", "dense_9", "dense_10"}}, &network);
    expect_network(&(variant){.inside = "model_weights"}, &network);
    expect_network(&(variant){.type = H5T_IEEE_F32BE}, &network);
    expect_network(&(variant){.type = H5T_IEEE_F64LE}, &network);
    test_network_make(&network, 9, 32, 2);
    expect_network(&(variant){0}, &network);
}

/* ---- What is refused ------------------------------------------------------------------------- */

static void expect_variant_refused(const variant *v, const test_network *network, const char *words)
{
    test_bytes file = make_file(v, network);
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    hnbrdf_result result =
        hnbrdf_measured_open_memory(file.data, file.size, "x/a.h5", &WITH_HDF5, &measured, &error);
    assert_null(measured);
    if (result != HNBRDF_ERROR_FORMAT || !strstr(error.text, words) ||
        strncmp(error.text, "x/a.h5: ", 8) != 0)
        fail_msg("result %d, expected \"%s\": %s", (int)result, words, error.text);
    free(file.data);
}

static void what_is_no_network_is_named(void **state)
{
    test_network good, bad;
    (void)state;
    test_network_make(&good, 21, 20, 1);
    expect_variant_refused(&(variant){.layers = 2}, &good,
                           "2 groups dense_1, dense_2 ..., expected");
    expect_variant_refused(&(variant){.layers = 4}, &good, "more than 3 groups");
    expect_variant_refused(&(variant){.without = 4}, &good,
                           "dense_2/dense_2/bias:0 is missing, expected a data set");
    expect_variant_refused(&(variant){.linked = 1}, &good,
                           "dense_3/dense_3/kernel:0 is missing, expected a data set");
    expect_variant_refused(&(variant){.chunked = 1}, &good,
                           "dense_3/dense_3/kernel:0 is in pieces, filtered or in another file");
    expect_variant_refused(&(variant){.type = H5T_STD_I32LE}, &good,
                           "dense_1/dense_1/kernel:0 has no floats of 4 or 8 bytes");
    expect_variant_refused(&(variant){.axes = 3}, &good, "has no shape of 1 or 2 axes");
    expect_variant_refused(&(variant){.empty = 1}, &good,
                           "dense_3/dense_3/kernel:0 has 0 bytes in a file of");
    bad = good;
    bad.rows[2] = 20;
    expect_variant_refused(&(variant){0}, &bad,
                           "dense_2/dense_2/kernel:0 has shape 20 x 20, expected 21 x N");
    bad = good;
    bad.columns[5] = 4;
    expect_variant_refused(&(variant){0}, &bad, "dense_3/dense_3/bias:0 has shape 4, expected 3");
    bad = good;
    bad.values[4][7] = NAN;
    expect_variant_refused(&(variant){0}, &bad,
                           "dense_3/dense_3/kernel:0, number 8 of 60 is not finite");
}

/* Every beginning of the file, and files with bytes changed at random: refused in one line or
 * opened with sane values; libhdf5 says nothing on stderr. */
static void damaged_files_are_refused_in_silence(void **state)
{
    test_network network;
    char text[] = "/tmp/hnbrdf_hdf5_XXXXXX";
    hnbrdf_rng rng;
    int log = mkstemp(text), kept = dup(2);
    (void)state;
    assert_true(log >= 0 && kept >= 0);
    test_network_make(&network, 21, 21, 1);
    test_bytes file = make_file(&(variant){0}, &network);
    unsigned char *copy = malloc(file.size);
    assert_non_null(copy);
    fflush(stderr);
    assert_true(dup2(log, 2) == 2);
    for (size_t size = 8; size < file.size; size += size < 256 ? 1 : 61)
        expect_sane_with(file.data, size, "a.h5", &WITH_HDF5);
    hnbrdf_rng_seed(&rng, 7, 0);
    for (int k = 0; k < 600; k++) {
        memcpy(copy, file.data, file.size);
        for (unsigned n = 1 + hnbrdf_rng_u32(&rng) % 4; n > 0; n--) {
            /* half of them where the structure is: the numbers fill most of the file */
            size_t room = k % 2 ? file.size : 4096 < file.size ? 4096 : file.size;
            copy[8 + hnbrdf_rng_u32(&rng) % (room - 8)] = (unsigned char)hnbrdf_rng_u32(&rng);
        }
        expect_sane_with(copy, file.size, "a.h5", &WITH_HDF5);
    }
    fflush(stderr);
    assert_true(dup2(kept, 2) == 2);
    off_t printed = lseek(log, 0, SEEK_END);
    close(log);
    close(kept);
    remove(text);
    free(copy);
    free(file.data);
    assert_int_equal(printed, 0);
}

/* A program that does not use the part of hdf5.h. */
static void without_the_reader_the_message_says_so(void **state)
{
    test_network network;
    (void)state;
    test_network_make(&network, 21, 21, 1);
    test_bytes file = make_file(&(variant){0}, &network);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_UNSUPPORTED, "HNBRDF_WITH_HDF5");
    free(file.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_the_reader_the_message_says_so),
        cmocka_unit_test(layers_are_found_whatever_they_are_called),
        cmocka_unit_test(what_is_no_network_is_named),
        cmocka_unit_test(damaged_files_are_refused_in_silence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

static void without_libhdf5_the_message_says_so(void **state)
{
    static const char magic[] = "\211HDF\r\n\032\n                        ";
    (void)state;
    expect_refusal(magic, sizeof magic, HNBRDF_ERROR_UNSUPPORTED, "HNBRDF_WITH_HDF5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(without_libhdf5_the_message_says_so)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
