/* test_model_file.c: a model survives its file to the last bit, whichever way the bytes come, and
 * no failure on the way leaks, crashes or spoils the file that was there. */
#include "model_support.h"

#include <fcntl.h>
#include <locale.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static const struct {
    hnbrdf_kind kind;
    int hidden, layers, latent, materials, special;
} EXAMPLES[] = {
    {HNBRDF_KIND_HYBRID, 32, 2, 4, 3, 0},  {HNBRDF_KIND_HYBRID, 64, 4, 16, 5, 1},
    {HNBRDF_KIND_HYBRID, 1, 1, 0, 1, 0},   {HNBRDF_KIND_HYBRID, 13, 3, 7, 100, 1},
    {HNBRDF_KIND_NEURAL, 16, 2, 12, 4, 1}, {HNBRDF_KIND_GGX, 0, 0, 0, 9, 1},
};
enum { EXAMPLE_COUNT = sizeof EXAMPLES / sizeof *EXAMPLES };

static hnbrdf_model *example(int i)
{
    return example_model((uint64_t)i + 1, EXAMPLES[i].kind, EXAMPLES[i].hidden, EXAMPLES[i].layers,
                         EXAMPLES[i].latent, EXAMPLES[i].materials, EXAMPLES[i].special);
}

/* A directory of its own under the one the test runs in. */
static char directory[] = "test_model_file_XXXXXX";

static int make_directory(void **state)
{
    (void)state;
    return mkdtemp(directory) ? 0 : 1;
}

static int remove_directory(void **state)
{
    (void)state;
    return rmdir(directory); /* fails if a test left anything behind */
}

static void in_directory(const char *name, char path[256])
{
    snprintf(path, 256, "%s/%s", directory, name);
}

static bytes file_bytes(const char *path)
{
    bytes b = {NULL, 0};
    unsigned char buffer[4096];
    size_t count;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    while ((count = fread(buffer, 1, sizeof buffer, file)) > 0)
        write_bytes(&b, buffer, count);
    fclose(file);
    return b;
}

static int exists(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (file)
        fclose(file);
    return file != NULL;
}

/* ---- Round trips ----------------------------------------------------------------------------- */

static void a_model_survives_its_bytes_and_gives_the_same_again(void **state)
{
    (void)state;
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        hnbrdf_model *model = example(i), *back = NULL;
        hnbrdf_error error = {""};
        bytes first = model_bytes(model), second;
        if (hnbrdf_model_load_memory(first.data, first.size, NULL, &back, &error))
            fail_msg("%s", error.text);
        assert_same_model(model, back);
        second = model_bytes(back);
        assert_int_equal(first.size, second.size);
        assert_memory_equal(first.data, second.data, first.size);
        free_bytes(&first);
        free_bytes(&second);
        hnbrdf_model_free(model);
        hnbrdf_model_free(back);
    }
}

static void a_file_holds_the_bytes_that_are_written(void **state)
{
    char path[256], aside[256];
    (void)state;
    in_directory("a.safetensors", path);
    in_directory("a.safetensors.hnbrdf-part", aside);
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        hnbrdf_model *model = example(i), *back = NULL;
        assert_int_equal(hnbrdf_model_save(model, path, NULL), HNBRDF_OK);
        assert_false(exists(aside));
        bytes saved = file_bytes(path), written = model_bytes(model);
        assert_int_equal(saved.size, written.size);
        assert_memory_equal(saved.data, written.data, saved.size);
        assert_int_equal(hnbrdf_model_load(path, NULL, &back, NULL), HNBRDF_OK);
        assert_same_model(model, back);
        free_bytes(&saved);
        free_bytes(&written);
        hnbrdf_model_free(model);
        hnbrdf_model_free(back);
    }
    remove(path);
}

/* What the public specification of safetensors asks of a file. */
static void a_file_is_laid_out_as_safetensors_asks(void **state)
{
    (void)state;
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        hnbrdf_model *model = example(i);
        bytes b = model_bytes(model);
        size_t length = 0;
        for (int k = 7; k >= 0; k--)
            length = length << 8 | b.data[k];
        assert_int_equal(length % 8, 0);
        assert_true(length < b.size);
        assert_int_equal(b.data[8], '{');
        size_t last = 8 + length - 1;
        while (b.data[last] == ' ')
            last--;
        assert_int_equal(b.data[last], '}');
        free_bytes(&b);
        hnbrdf_model_free(model);
    }
}

static void the_header_reads_as_the_design_says(void **state)
{
    static const char EXPECTED[] =
        "{\"__metadata__\":{\"format\":\"hnbrdf/"
        "1\",\"kind\":\"hybrid\",\"encoding\":\"half-difference\","
        "\"scale\":\"0.699999988\",\"shift\":\"-1.10000002\",\"floor\":\"0.00300000003\","
        "\"materials\":\"[\\\"gold \\\\\\\"24\\\\\\\"\\\", \\\"back\\\\\\\\slash\\\"]\"},"
        "\"net.0.weight\":{\"dtype\":\"F32\",\"shape\":[3,8],\"data_offsets\":[0,96]},"
        "\"net.0.bias\":{\"dtype\":\"F32\",\"shape\":[3],\"data_offsets\":[96,108]},"
        "\"net.1.weight\":{\"dtype\":\"F32\",\"shape\":[6,3],\"data_offsets\":[108,180]},"
        "\"net.1.bias\":{\"dtype\":\"F32\",\"shape\":[6],\"data_offsets\":[180,204]},"
        "\"material.kd\":{\"dtype\":\"F32\",\"shape\":[2,3],\"data_offsets\":[204,228]},"
        "\"material.eta\":{\"dtype\":\"F32\",\"shape\":[2,3],\"data_offsets\":[228,252]},"
        "\"material.alpha\":{\"dtype\":\"F32\",\"shape\":[2,2],\"data_offsets\":[252,268]},"
        "\"material.rotation\":{\"dtype\":\"F32\",\"shape\":[2],\"data_offsets\":[268,276]},"
        "\"material.latent\":{\"dtype\":\"F32\",\"shape\":[2,2],\"data_offsets\":[276,292]}}";
    hnbrdf_model *model = example_model(1, HNBRDF_KIND_HYBRID, 3, 1, 2, 2, 1);
    bytes b = model_bytes(model);
    (void)state;
    assert_memory_equal(b.data + 8, EXPECTED, sizeof EXPECTED - 1);
    free_bytes(&b);
    hnbrdf_model_free(model);
}

/* ---- Where bytes come from ------------------------------------------------------------------- */

typedef struct stream {
    const bytes *b;
    size_t at, step, fail_at; /* fails when `at` reaches fail_at */
} stream;

static size_t read_stream(void *user, void *buffer, size_t size)
{
    stream *s = user;
    size_t count = s->b->size - s->at;
    if (s->at >= s->fail_at)
        return (size_t)-1;
    count = count > size ? size : count;
    count = count > s->step ? s->step : count;
    memcpy(buffer, s->b->data + s->at, count);
    s->at += count;
    return count;
}

static void a_callback_may_give_any_number_of_bytes(void **state)
{
    static const size_t STEPS[] = {1, 7, 4096, 65536, 1000000};
    /* above one chunk */
    hnbrdf_model *model = example_model(3, HNBRDF_KIND_HYBRID, 64, 4, 16, 200, 0);
    bytes b = model_bytes(model);
    (void)state;
    assert_true(b.size > 70000);
    for (int i = 0; i < 5; i++) {
        stream s = {&b, 0, STEPS[i], (size_t)-1};
        const hnbrdf_load_options options = {.read = read_stream, .read_user = &s};
        hnbrdf_model *back = NULL;
        assert_int_equal(hnbrdf_model_load(NULL, &options, &back, NULL), HNBRDF_OK);
        assert_same_model(model, back);
        hnbrdf_model_free(back);
    }
    free_bytes(&b);
    hnbrdf_model_free(model);
}

static void a_callback_that_fails_is_an_io_error(void **state)
{
    hnbrdf_model *model = example(0), *back = NULL;
    bytes b = model_bytes(model);
    stream s = {&b, 0, 100, 500};
    const hnbrdf_load_options options = {.read = read_stream, .read_user = &s};
    hnbrdf_error error = {""};
    (void)state;
    assert_int_equal(hnbrdf_model_load("my pack", &options, &back, &error), HNBRDF_ERROR_IO);
    assert_string_equal(error.text, "my pack: cannot be read beyond byte 500");
    assert_null(back);
    free_bytes(&b);
    hnbrdf_model_free(model);
}

static void input_above_max_bytes_is_refused(void **state)
{
    hnbrdf_model *model = example(0), *back = NULL;
    bytes b = model_bytes(model);
    char path[256];
    hnbrdf_load_options options = {.max_bytes = b.size - 1};
    hnbrdf_error error = {""};
    (void)state;
    in_directory("large.safetensors", path);
    assert_int_equal(hnbrdf_model_save(model, path, NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_model_load(path, &options, &back, &error), HNBRDF_ERROR_LIMIT);
    assert_non_null(strstr(error.text, path));
    assert_int_equal(hnbrdf_model_load_memory(b.data, b.size, &options, &back, NULL),
                     HNBRDF_ERROR_LIMIT);
    assert_null(back);
    options.max_bytes = b.size;
    assert_int_equal(hnbrdf_model_load(path, &options, &back, NULL), HNBRDF_OK);
    hnbrdf_model_free(back);
    remove(path);
    free_bytes(&b);
    hnbrdf_model_free(model);
}

static void missing_files_and_directories_are_io_errors(void **state)
{
    hnbrdf_model *back = NULL;
    hnbrdf_error error = {""};
    char path[256];
    (void)state;
    in_directory("missing", path);
    assert_int_equal(hnbrdf_model_load(path, NULL, &back, &error), HNBRDF_ERROR_IO);
    assert_non_null(strstr(error.text, path));
    assert_int_equal(hnbrdf_model_load(directory, NULL, &back, &error), HNBRDF_ERROR_IO);
    assert_int_equal(hnbrdf_model_load(NULL, NULL, &back, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_model_load_memory(NULL, 0, NULL, &back, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_model_load_memory("", 0, NULL, &back, &error), HNBRDF_ERROR_FORMAT);
    assert_null(back);
}

/* ---- Failures while saving ------------------------------------------------------------------- */

static void what_cannot_be_saved_to_is_refused(void **state)
{
    hnbrdf_model *model = example(0);
    hnbrdf_error error = {""};
    char path[256];
    (void)state;
    in_directory("missing/a.safetensors", path);
    assert_int_equal(hnbrdf_model_save(model, path, &error), HNBRDF_ERROR_IO);
    in_directory("folder", path);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(hnbrdf_model_save(model, path, &error), HNBRDF_ERROR_IO);
    assert_non_null(strstr(error.text, "Is a directory"));
    assert_int_equal(rmdir(path), 0);
    hnbrdf_model_free(model);
}

/* /dev/full takes no byte: a large file fails while it is written, one that fits the stream's
 * buffer only when it is closed. Only where there is such a device. */
static void a_full_disk_is_noticed(void **state)
{
    char path[256];
    (void)state;
    in_directory("full", path);
    for (int small = 0; small < 2; small++) {
        hnbrdf_model *model = example(small ? 2 : 0);
        hnbrdf_error error = {""};
        if (symlink("/dev/full", path) != 0 || !exists(path)) {
            remove(path);
            hnbrdf_model_free(model);
            skip();
        }
        assert_int_equal(hnbrdf_model_save(model, path, &error), HNBRDF_ERROR_IO);
        assert_non_null(strstr(error.text, "No space left on device"));
        assert_int_equal(remove(path), 0);
        hnbrdf_model_free(model);
    }
}

/* A pipe stays one: it is not replaced by a file. The model fits its buffer. */
static void a_pipe_is_written_as_it_is(void **state)
{
    char path[256], aside[256];
    unsigned char buffer[65536];
    hnbrdf_model *model = example(2);
    bytes b = model_bytes(model);
    struct stat info;
    (void)state;
    in_directory("pipe", path);
    in_directory("pipe.hnbrdf-part", aside);
    assert_true(b.size < 4096);
    assert_int_equal(mkfifo(path, 0600), 0);
    const int reader = open(path, O_RDONLY | O_NONBLOCK);
    assert_true(reader >= 0);
    assert_int_equal(hnbrdf_model_save(model, path, NULL), HNBRDF_OK);
    assert_int_equal(read(reader, buffer, sizeof buffer), (int)b.size);
    assert_memory_equal(buffer, b.data, b.size);
    assert_int_equal(stat(path, &info), 0);
    assert_true(S_ISFIFO(info.st_mode));
    assert_false(exists(aside));
    close(reader);
    remove(path);
    free_bytes(&b);
    hnbrdf_model_free(model);
}

static int refuse(void *user, const void *data, size_t size)
{
    long *left = user;
    (void)data;
    *left -= (long)size;
    return *left < 0;
}

static void a_write_callback_can_stop_anywhere(void **state)
{
    hnbrdf_model *model = example(0);
    bytes b = model_bytes(model);
    hnbrdf_error error = {""};
    (void)state;
    for (long room = 0; room < (long)b.size; room += 512) {
        long left = room;
        assert_int_equal(hnbrdf_model_write(model, refuse, &left, &error), HNBRDF_ERROR_IO);
    }
    long left = (long)b.size;
    assert_int_equal(hnbrdf_model_write(model, refuse, &left, &error), HNBRDF_OK);
    assert_int_equal(hnbrdf_model_write(NULL, refuse, &left, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_model_write(model, NULL, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_model_save(model, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    free_bytes(&b);
    hnbrdf_model_free(model);
}

/* ---- Memory ---------------------------------------------------------------------------------- */

static void every_failed_allocation_is_reported_without_a_leak(void **state)
{
    (void)state;
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        hnbrdf_model *model = example(i);
        bytes b = model_bytes(model);
        for (int from_callback = 0; from_callback < 2; from_callback++) {
            hnbrdf_result result = HNBRDF_ERROR_MEMORY;
            long k;
            for (k = 0; result == HNBRDF_ERROR_MEMORY && k < 50; k++) {
                counting count = {.fail_at = k};
                stream s = {&b, 0, 100000, (size_t)-1};
                hnbrdf_load_options options = {.allocator = counting_allocator(&count)};
                hnbrdf_model *back = NULL;
                hnbrdf_error error = {""};
                if (from_callback) {
                    options.read = read_stream;
                    options.read_user = &s;
                    result = hnbrdf_model_load("x", &options, &back, &error);
                } else {
                    result = hnbrdf_model_load_memory(b.data, b.size, &options, &back, &error);
                }
                if (result == HNBRDF_OK) {
                    assert_int_equal(count.alive, 1); /* the model is one block */
                    assert_same_model(model, back);
                } else {
                    assert_int_equal(result, HNBRDF_ERROR_MEMORY);
                    assert_non_null(strstr(error.text, "cannot allocate"));
                    assert_null(back);
                }
                hnbrdf_model_free(back);
                assert_int_equal(count.alive, 0);
            }
            assert_int_equal(result, HNBRDF_OK);
            assert_true(k > 4); /* several places did fail */
        }
        free_bytes(&b);
        hnbrdf_model_free(model);
    }
}

static void saving_allocates_nothing(void **state)
{
    hnbrdf_model *model = example(0), *own = NULL;
    hnbrdf_model_desc desc;
    counting count = {.fail_at = 1};
    const hnbrdf_allocator allocator = counting_allocator(&count);
    char path[256];
    (void)state;
    in_directory("own.safetensors", path);
    hnbrdf_model_describe(model, &desc);
    assert_int_equal(hnbrdf_model_create(&desc, &allocator, &own, NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_model_save(own, path, NULL), HNBRDF_OK);
    assert_int_equal(count.alive, 1);
    remove(path);
    hnbrdf_model_free(own);
    hnbrdf_model_free(model);
    assert_int_equal(count.alive, 0);
}

/* Skipped where no locale with another separator is installed. */
static void a_comma_locale_changes_no_byte(void **state)
{
    hnbrdf_model *model = example(1), *back = NULL;
    bytes plain = model_bytes(model);
    const int found = setlocale(LC_ALL, "de_DE.UTF-8") || setlocale(LC_ALL, "fr_FR.UTF-8");
    (void)state;
    if (found) {
        bytes comma = model_bytes(model);
        assert_int_equal(plain.size, comma.size);
        assert_memory_equal(plain.data, comma.data, plain.size);
        assert_int_equal(hnbrdf_model_load_memory(comma.data, comma.size, NULL, &back, NULL),
                         HNBRDF_OK);
        assert_same_model(model, back);
        free_bytes(&comma);
    }
    setlocale(LC_ALL, "C");
    free_bytes(&plain);
    hnbrdf_model_free(model);
    hnbrdf_model_free(back);
    if (!found)
        skip();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_model_survives_its_bytes_and_gives_the_same_again),
        cmocka_unit_test(a_file_holds_the_bytes_that_are_written),
        cmocka_unit_test(a_file_is_laid_out_as_safetensors_asks),
        cmocka_unit_test(the_header_reads_as_the_design_says),
        cmocka_unit_test(a_callback_may_give_any_number_of_bytes),
        cmocka_unit_test(a_callback_that_fails_is_an_io_error),
        cmocka_unit_test(input_above_max_bytes_is_refused),
        cmocka_unit_test(missing_files_and_directories_are_io_errors),
        cmocka_unit_test(what_cannot_be_saved_to_is_refused),
        cmocka_unit_test(a_full_disk_is_noticed),
        cmocka_unit_test(a_pipe_is_written_as_it_is),
        cmocka_unit_test(a_write_callback_can_stop_anywhere),
        cmocka_unit_test(every_failed_allocation_is_reported_without_a_leak),
        cmocka_unit_test(saving_allocates_nothing),
        cmocka_unit_test(a_comma_locale_changes_no_byte),
    };
    return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
