/* test_fit_checkpoint.c: a checkpoint is taken up by the very fit that wrote it and by no other,
 * and one whose numbers no training could have is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hnbrdf/fit.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 2 };
static const char path[] = "test_fit_checkpoint.bin";
static hnbrdf_measured *data[COUNT + 1];
static hnbrdf_material given[COUNT];
static unsigned char saved[1 << 16];
static size_t size;

static int stop_at_100(void *user, const hnbrdf_fit_progress *p)
{
    (void)user;
    return p->step >= 100;
}

static hnbrdf_fit_options tiny(void)
{
    return (hnbrdf_fit_options){.hidden = 5,
                                .layers = 2,
                                .latent = 3,
                                .encoding = "angles",
                                .steps = 200,
                                .batch = 1024,
                                .pool = 2048,
                                .threads = 1,
                                .seed = 4,
                                .learning_rate = 0.01f,
                                .materials = given,
                                .checkpoint = path};
}

static hnbrdf_result fit(const hnbrdf_fit_options *o, const hnbrdf_measured *const *of, int count,
                         hnbrdf_fit_report *report, hnbrdf_error *error)
{
    hnbrdf_model *model = NULL;
    hnbrdf_result result = hnbrdf_fit(of, count, o, &model, report, error);
    hnbrdf_model_free(model);
    return result;
}

static void write_file(const void *bytes, size_t count)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    assert_int_equal(fclose(file), 0);
}

/* A checkpoint of step 100, read into `saved`. */
static int save(void **state)
{
    (void)state;
    for (int i = 0; i <= COUNT; i++)
        if (hnbrdf_measured_open_builtin(i, &data[i], NULL))
            return -1;
    for (int i = 0; i < COUNT; i++)
        hnbrdf_material_init(&given[i]);
    hnbrdf_fit_options o = tiny();
    hnbrdf_fit_report report;
    o.progress = stop_at_100;
    if (fit(&o, (const hnbrdf_measured *const *)data, COUNT, &report, NULL) || !report.stopped)
        return -1;
    FILE *file = fopen(path, "rb");
    size = file ? fread(saved, 1, sizeof saved, file) : 0;
    return !file || fclose(file) || size == sizeof saved ? -1 : 0;
}

static int clean_up(void **state)
{
    (void)state;
    for (int i = 0; i <= COUNT; i++)
        hnbrdf_measured_close(data[i]);
    remove(path);
    return 0;
}

static hnbrdf_result resume(hnbrdf_error *error)
{
    hnbrdf_fit_options o = tiny();
    hnbrdf_fit_report report;
    o.resume = 1;
    hnbrdf_result result = fit(&o, (const hnbrdf_measured *const *)data, COUNT, &report, error);
    if (!result)
        assert_int_equal(report.steps, 200);
    return result;
}

/* ---- Soundness ------------------------------------------------------------------------------- */

/* Where things lie in the file, in bytes: after the name of the format (16), the fingerprint (8)
 * and the random numbers (16) come 10 numbers of 8 bytes; then the arrays. */
enum { SHARE = 40, PEAK = 48, RUNNING = 56, STEP = 64, ORDER_AT = 72, SINCE = 80, BEST_STEP = 88 };
enum { BEST_DEAD = 96, SET_BACKS = 104, BEST_LOSS = 112, PARAMETERS = 120 };

/* Means and eigenbases of the layers, two squares for the inputs with the bias and two for the
 * outputs: 10 and 5, 6 and 5, 6 and 6. */
enum { BASES = 2 * (100 + 25 + 36 + 25 + 36 + 36) };

/* Parameters, their moments and squares, and the best ones: as many of each; then order and cursor,
 * and the bases. */
static size_t parameter_count(void)
{
    return (size - PARAMETERS - 2 * COUNT * sizeof(int) - BASES * sizeof(float)) /
           (4 * sizeof(float));
}

static void refuse(size_t at, const void *value, size_t bytes)
{
    static unsigned char changed[sizeof saved];
    hnbrdf_error error = {""};
    memcpy(changed, saved, size);
    memcpy(changed + at, value, bytes);
    write_file(changed, size);
    if (resume(&error) != HNBRDF_ERROR_FORMAT || !strstr(error.text, "no training has") ||
        !strstr(error.text, path))
        fail_msg("byte %zu: '%s'", at, error.text);
}

static void refuse_double(size_t at, double value)
{
    refuse(at, &value, sizeof value);
}

static void refuse_whole(size_t at, int64_t value)
{
    refuse(at, &value, sizeof value);
}

static void refuse_float(size_t index, float value)
{
    refuse(PARAMETERS + index * sizeof value, &value, sizeof value);
}

static void numbers_that_no_training_has_are_refused(void **state)
{
    (void)state;
    hnbrdf_error error = {""};
    write_file(saved, size);
    if (resume(&error)) /* as it was written it is good */
        fail_msg("%s", error.text);
    const double bad[] = {NAN, INFINITY, -INFINITY, -1.0};
    for (size_t k = 0; k < 4; k++) {
        refuse_double(SHARE, bad[k]);
        refuse_double(PEAK, bad[k]);
        refuse_double(BEST_LOSS, bad[k]);
    }
    refuse_double(SHARE, 1.0);
    refuse_double(PEAK, 0.0);
    refuse_double(RUNNING, INFINITY); /* NaN is what it starts with */
    const size_t wholes[] = {STEP, ORDER_AT, SINCE, BEST_STEP, BEST_DEAD, SET_BACKS};
    for (size_t k = 0; k < sizeof wholes / sizeof wholes[0]; k++) {
        refuse_whole(wholes[k], -1);
        refuse_whole(wholes[k], INT64_MAX);
    }
    refuse_whole(ORDER_AT, COUNT);
    refuse_whole(SINCE, 101);
    refuse_whole(BEST_STEP, 101);
    refuse_whole(SET_BACKS, 101);
    refuse_whole(BEST_DEAD, HNBRDF_MAX_HIDDEN + 1);

    const size_t count = parameter_count();
    const size_t ends[] = {0, count - 1, count, 2 * count, 3 * count - 1, 3 * count, 4 * count - 1};
    for (size_t k = 0; k < sizeof ends / sizeof ends[0]; k++) {
        refuse_float(ends[k], NAN);
        refuse_float(ends[k], INFINITY);
    }
    refuse_float(2 * count, -1e-30f); /* squares have roots */
    refuse_float(3 * count - 1, -1.0f);

    const size_t order = PARAMETERS + 4 * count * sizeof(float);
    const int outside[] = {-1, INT_MAX, COUNT, 32}; /* 2048 pairs are 32 tiles */
    const float endless = INFINITY;
    refuse(size - BASES * sizeof(float), &endless, sizeof endless);
    refuse(size - sizeof(float), &endless, sizeof endless);
    for (size_t k = 0; k < 2 * COUNT; k++)
        for (size_t v = 0; v < 4; v++)
            if (k < COUNT || outside[v] != COUNT) /* the third tile is one */
                refuse(order + k * sizeof(int), &outside[v], sizeof(int));
}

static void a_file_of_another_size_is_refused(void **state)
{
    (void)state;
    hnbrdf_error error = {""};
    const size_t sizes[] = {0, 15, 100, PARAMETERS - 1, PARAMETERS, size - 1, size + 1};
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        write_file(saved, sizes[k]);
        assert_int_equal(resume(&error), HNBRDF_ERROR_FORMAT);
        assert_non_null(strstr(error.text, path));
    }
    write_file(saved, size);
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    fputc('x', file); /* another format */
    fclose(file);
    assert_int_equal(resume(&error), HNBRDF_ERROR_FORMAT);
}

/* ---- Fingerprint ----------------------------------------------------------------------------- */

enum { CHANGES = 19 };

static void change_option(hnbrdf_fit_options *o, int k)
{
    switch (k) {
    case 0:
        o->kind = HNBRDF_KIND_NEURAL;
        break;
    case 1:
        o->hidden++;
        break;
    case 2:
        o->layers++;
        break;
    case 3:
        o->latent++;
        break;
    case 4:
        o->encoding = "directions";
        break;
    case 5:
        o->floor = 0.01f;
        break;
    case 6:
        o->analytic = HNBRDF_FIT_JOINT;
        break;
    case 7:
        o->steps++;
        break;
    case 8:
        o->seconds = 100.0;
        break;
    case 9:
        o->batch = 4096;
        break;
    case 10:
        o->pool = 4096;
        break;
    case 11:
        o->learning_rate *= 1.01f;
        break;
    case 12:
        o->seed++;
        break;
    case 13:
        o->loss = HNBRDF_FIT_SMAPE;
        break;
    case 14:
        o->schedule = HNBRDF_FIT_LINEAR;
        break;
    case 15:
        o->uniform_share = 0.75f;
        break;
    case 16:
        o->bright_share = 0.5f;
        break;
    case 17:
        o->lift = 0.5f;
        break;
    case 18:
        o->horizon_share = 0.5f;
        break;
    default:
        o->materials = NULL;
        break;
    }
}

static void refused_as_of_another_fit(const hnbrdf_fit_options *o, int which,
                                      const hnbrdf_measured *const *of, int count)
{
    hnbrdf_error error = {""};
    if (fit(o, of, count, NULL, &error) != HNBRDF_ERROR_ARGUMENT ||
        !strstr(error.text, "other data, options or seed"))
        fail_msg("change %d: '%s'", which, error.text);
}

static void a_fit_with_any_other_option_or_data_does_not_take_it_up(void **state)
{
    (void)state;
    write_file(saved, size);
    for (int k = 0; k < CHANGES; k++) {
        hnbrdf_fit_options o = tiny();
        o.resume = 1;
        change_option(&o, k);
        refused_as_of_another_fit(&o, k, (const hnbrdf_measured *const *)data, COUNT);
    }
    hnbrdf_fit_options o = tiny();
    const hnbrdf_measured *swapped[] = {data[1], data[0]}, *other[] = {data[0], data[2]};
    o.resume = 1;
    refused_as_of_another_fit(&o, -1, swapped, COUNT);
    refused_as_of_another_fit(&o, -2, other, COUNT);
    refused_as_of_another_fit(&o, -3, (const hnbrdf_measured *const *)data, COUNT - 1);
    /* threads do not change the result: taken up */
    o.threads = 2;
    assert_int_equal(fit(&o, (const hnbrdf_measured *const *)data, COUNT, NULL, NULL), HNBRDF_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_that_no_training_has_are_refused),
        cmocka_unit_test(a_file_of_another_size_is_refused),
        cmocka_unit_test(a_fit_with_any_other_option_or_data_does_not_take_it_up),
    };
    return cmocka_run_group_tests(tests, save, clean_up);
}
