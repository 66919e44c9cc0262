/* test_writes.c: files that stop short and disks that are full, at any byte: reading and writing
 * fail in words, and the old file stays as it was, also when the process ends in the middle. The
 * limit on the size of files (RLIMIT_FSIZE) stands for the full disk: it needs no rights, and can
 * be had at every byte. */
#include "model_support.h"

#include "image/image.h"
#include "hnbrdf/glsl.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static char directory[] = "/tmp/hnbrdf_writes_XXXXXX";

static hnbrdf_model *old_model, *new_model;

static int set_up(void **state)
{
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    old_model = example_model(1, HNBRDF_KIND_HYBRID, 4, 2, 2, 3, 0);
    new_model = example_model(2, HNBRDF_KIND_HYBRID, 8, 2, 2, 60, 1); /* beyond one stream buffer */
    return mkdtemp(directory) == NULL;
}

static int tear_down(void **state)
{
    (void)state;
    hnbrdf_model_free(old_model);
    hnbrdf_model_free(new_model);
    return rmdir(directory); /* whatever failed left nothing behind */
}

/* Files may grow to `most` bytes from now on; RLIM_INFINITY: without end. */
static void limit_files(rlim_t most)
{
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = most < limit.rlim_max ? most : limit.rlim_max;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static bytes read_file(const char *path)
{
    bytes b = {NULL, 0};
    unsigned char block[4096];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    for (size_t count; (count = fread(block, 1, sizeof block, file)) > 0;)
        write_bytes(&b, block, count);
    fclose(file);
    return b;
}

static void assert_file(const char *path, const bytes *expected)
{
    bytes found = read_file(path);
    assert_int_equal(found.size, expected->size);
    assert_memory_equal(found.data, expected->data, found.size);
    free_bytes(&found);
}

/* One kind of file: how the old and the new one are written. */
typedef struct writer {
    const char *name;
    hnbrdf_result (*write)(const char *path, int is_new, hnbrdf_error *error);
    size_t step; /* of the byte where writing fails */
} writer;

static hnbrdf_result save_model(const char *path, int is_new, hnbrdf_error *error)
{
    return hnbrdf_model_save(is_new ? new_model : old_model, path, error);
}

static hnbrdf_result write_picture(const char *path, int is_new, hnbrdf_error *error)
{
    render_image image;
    hnbrdf_result result = render_image_create(is_new ? 40 : 5, 40, 0, &image, error);
    for (int i = 0; !result && i < 3 * image.width * image.height; i++)
        image.rgb[i] = (float)((i * 7919) % 1009) / 1009.0f; /* hard to compress */
    if (!result)
        result = render_image_write(&image, path, NULL, error);
    render_image_free(&image);
    return result;
}

static const writer writers[] = {{"a.safetensors", save_model, 1},
                                 {"a.png", write_picture, 61},
#ifdef HNBRDF_WITH_OPENEXR
                                 {"a.exr", write_picture, 211}
#endif
};
enum { WRITERS = sizeof writers / sizeof writers[0] };

/* The path of the writer's file, with the old content, which is also given back; *size that of
 * the new one. */
static bytes begin(const writer *w, char path[256], size_t *size)
{
    snprintf(path, 256, "%s/%s", directory, w->name);
    assert_int_equal(w->write(path, 1, NULL), HNBRDF_OK);
    bytes b = read_file(path);
    *size = b.size;
    free_bytes(&b);
    assert_int_equal(w->write(path, 0, NULL), HNBRDF_OK);
    return read_file(path);
}

static void a_full_disk_leaves_the_old_file(void **state)
{
    (void)state;
    for (int i = 0; i < WRITERS; i++) {
        char path[256];
        size_t size;
        bytes old = begin(&writers[i], path, &size);
        for (size_t room = 0; room < size; room += writers[i].step) {
            hnbrdf_error error = {""};
            limit_files(room);
            const hnbrdf_result result = writers[i].write(path, 1, &error);
            limit_files(RLIM_INFINITY);
            if (result != HNBRDF_ERROR_IO || !strstr(error.text, path))
                fail_msg("%s: room for %zu of %zu bytes: result %d \"%s\"", path, room, size,
                         (int)result, error.text);
            assert_file(path, &old);
        }
        limit_files(size);
        const hnbrdf_result result = writers[i].write(path, 1, NULL);
        limit_files(RLIM_INFINITY);
        assert_int_equal(result, HNBRDF_OK);
        free_bytes(&old);
        remove(path);
        assert_int_equal(rmdir(directory), 0); /* nothing is left aside */
        assert_int_equal(mkdir(directory, 0700), 0);
    }
}

/* The signal for a file that grows too large ends the child in the middle of a write. */
static void a_process_that_is_killed_leaves_the_old_file(void **state)
{
    (void)state;
    for (int i = 0; i < WRITERS; i++) {
        char path[256];
        size_t size;
        bytes old = begin(&writers[i], path, &size);
        for (int part = 0; part < 8; part++) {
            int status;
            const pid_t child = fork();
            assert_true(child >= 0);
            if (child == 0) {
                const struct rlimit none = {0, 0};
                setrlimit(RLIMIT_CORE, &none);
                signal(SIGXFSZ, SIG_DFL);
                limit_files(size * (size_t)part / 8);
                writers[i].write(path, 1, NULL);
                _exit(0);
            }
            assert_int_equal(waitpid(child, &status, 0), child);
            assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ);
            assert_file(path, &old);
        }
        /* what is left aside hinders nobody, and goes */
        assert_int_equal(writers[i].write(path, 1, NULL), HNBRDF_OK);
        remove(path);
        assert_int_equal(rmdir(directory), 0);
        assert_int_equal(mkdir(directory, 0700), 0);
        free_bytes(&old);
    }
}

/* ---- Callbacks ------------------------------------------------------------------------------- */

static int refuse(void *user, const void *data, size_t size)
{
    size_t *left = user;
    (void)data;
    if (size > *left)
        return 1;
    *left -= size;
    return 0;
}

static size_t total(hnbrdf_result (*write)(hnbrdf_write_fn, void *, hnbrdf_error *))
{
    size_t left = (size_t)-1;
    assert_int_equal(write(refuse, &left, NULL), HNBRDF_OK);
    return (size_t)-1 - left;
}

static hnbrdf_result write_model(hnbrdf_write_fn write, void *user, hnbrdf_error *error)
{
    return hnbrdf_model_write(old_model, write, user, error);
}

static hnbrdf_result write_glsl(hnbrdf_write_fn write, void *user, hnbrdf_error *error)
{
    return hnbrdf_export_shader(old_model, NULL, write, user, error);
}

static hnbrdf_result write_weights(hnbrdf_write_fn write, void *user, hnbrdf_error *error)
{
    return hnbrdf_export_weights(old_model, NULL, write, user, error);
}

static void a_callback_may_refuse_at_every_byte(void **state)
{
    hnbrdf_result (*const all[])(hnbrdf_write_fn, void *,
                                 hnbrdf_error *) = {write_model, write_glsl, write_weights};
    (void)state;
    for (int i = 0; i < 3; i++) {
        const size_t size = total(all[i]);
        for (size_t room = 0; room < size; room++) {
            hnbrdf_error error = {""};
            size_t left = room;
            assert_int_equal(all[i](refuse, &left, &error), HNBRDF_ERROR_IO);
            assert_true(strlen(error.text) > 10);
        }
    }
}

typedef struct stream {
    const bytes *b;
    size_t at, end;
    int fails;
} stream;

/* One to three bytes at a time up to `end`, where it fails or is over. */
static size_t give_little(void *user, void *buffer, size_t size)
{
    stream *s = user;
    size_t count = 1 + s->at % 3;
    if (s->at >= s->end)
        return s->fails ? (size_t)-1 : 0;
    count = count < size ? count : size;
    count = count < s->end - s->at ? count : s->end - s->at;
    memcpy(buffer, s->b->data + s->at, count);
    s->at += count;
    return count;
}

static void a_read_may_stop_or_fail_at_every_byte(void **state)
{
    bytes b = model_bytes(old_model);
    (void)state;
    for (size_t end = 0; end <= b.size; end++)
        for (int fails = 0; fails < 2; fails++) {
            stream s = {&b, 0, end, fails};
            const hnbrdf_load_options options = {.read = give_little, .read_user = &s};
            hnbrdf_model *model = NULL;
            const hnbrdf_result expected = fails          ? HNBRDF_ERROR_IO
                                           : end < b.size ? HNBRDF_ERROR_FORMAT
                                                          : HNBRDF_OK;
            assert_int_equal(hnbrdf_model_load("pack", &options, &model, NULL), expected);
            assert_int_equal(model != NULL, expected == HNBRDF_OK);
            hnbrdf_model_free(model);
        }
    free_bytes(&b);
}

/* ---- Pipes ----------------------------------------------------------------------------------- */

static void a_pipe_is_written_and_stays_one(void **state)
{
    char path[256], found[4096];
    struct stat status;
    bytes expected = model_bytes(old_model);
    (void)state;
    snprintf(path, sizeof path, "%s/pipe", directory);
    assert_int_equal(mkfifo(path, 0600), 0);
    int reader = open(path, O_RDWR | O_NONBLOCK); /* it fits the pipe's buffer */
    assert_true(reader >= 0 && expected.size < sizeof found);
    assert_int_equal(hnbrdf_model_save(old_model, path, NULL), HNBRDF_OK);
    assert_int_equal(read(reader, found, sizeof found), expected.size);
    assert_memory_equal(found, expected.data, expected.size);
    assert_int_equal(stat(path, &status), 0);
    assert_true(S_ISFIFO(status.st_mode));
    close(reader);
    remove(path);
    free_bytes(&expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_disk_leaves_the_old_file),
        cmocka_unit_test(a_process_that_is_killed_leaves_the_old_file),
        cmocka_unit_test(a_callback_may_refuse_at_every_byte),
        cmocka_unit_test(a_read_may_stop_or_fail_at_every_byte),
        cmocka_unit_test(a_pipe_is_written_and_stays_one),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
