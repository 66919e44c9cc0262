/* test_bake.c: hnbrdf_bake() gives what was wished for, the same on any number of threads and
 * ranks, says what it tried, stops when it is told to, and refuses bad options in one clear line.
 */
#include "hnbrdf/bake.h"
#include "hnbrdf/fit.h"
#include "ranks_support.h"
#include "sanitized.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MATERIALS = 3 };

static hnbrdf_measured *data[MATERIALS];
static hnbrdf_model *model; /* of all three, to bake from */

/* Small enough for a second; what a test wants is set on top. */
static hnbrdf_bake_options small(hnbrdf_bake_wish wish)
{
    return (hnbrdf_bake_options){.wish = wish,
                                 .pool = SANITIZED ? 256 : 1024,
                                 .pairs = 500,
                                 .steps = 160,
                                 .restarts = 2,
                                 .seed = 7,
                                 .threads = 2};
}

static void learn_from_data(hnbrdf_bake_options *o)
{
    o->data = (const hnbrdf_measured *const *)data;
    o->data_count = MATERIALS;
}

static hnbrdf_model *bake(const hnbrdf_bake_options *o, hnbrdf_bake_report *report)
{
    hnbrdf_error error = {""};
    hnbrdf_model *baked = NULL;
    if (hnbrdf_bake(model, o, &baked, report, &error))
        fail_msg("%s", error.text);
    return baked;
}

static const hnbrdf_bake_row *picked(const hnbrdf_bake_report *r)
{
    assert_in_range(r->picked, 0, r->row_count - 1);
    return &r->rows[r->picked];
}

/* What holds of every report: the errors are those of the materials, GGX comes first, and the model
 * returned is the picked one. */
static void check_report(const hnbrdf_bake_report *r, const hnbrdf_model *baked)
{
    assert_int_equal(r->rows[0].size.hidden, 0);
    assert_true(r->rows[0].full && r->model.ns > 0.0);
    for (int k = 0; k < r->row_count; k++) {
        const hnbrdf_bake_row *row = &r->rows[k];
        double mean = 0.0, worst = 0.0;
        for (int m = 0; m < r->material_count; m++) {
            mean += row->errors[m].smape / r->material_count;
            worst = fmax(worst, row->errors[m].smape);
        }
        assert_true(row->size.ns > 0.0);
        assert_true(fabs(row->smape - mean) < 1e-12 && row->worst == worst);
    }
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(baked, &desc);
    const hnbrdf_bake_row *row = picked(r);
    assert_int_equal(desc.hidden, row->size.hidden);
    assert_int_equal(desc.material_count, r->material_count);
    assert_int_equal(hnbrdf_model_multiplications(baked), row->size.multiplications);
    assert_int_equal(hnbrdf_model_weight_count(baked), row->size.weights);
    for (int m = 0; m < r->material_count; m++)
        assert_string_equal(desc.names[m], r->names[m]);
    assert_true(row->size.hidden ? r->half_smape > 0.0 : isnan(r->half_smape));
    /* Candidates have no lobes, what is returned has. */
    hnbrdf_lobes lobes;
    assert_int_equal(hnbrdf_lobes_fit(baked, &desc.materials[0], &lobes, NULL), HNBRDF_OK);
    if (row->size.hidden)
        assert_memory_equal(&lobes, &desc.materials[0].lobes, sizeof lobes);
}

static void end(hnbrdf_model *baked, hnbrdf_bake_report *report)
{
    hnbrdf_model_free(baked);
    hnbrdf_bake_report_free(report);
    assert_true(report->row_count == 0 && !report->rows && !report->names);
}

/* ---- Wishes ---------------------------------------------------------------------------------- */

/* A wish that GGX alone meets, then one that it does not. */
static void the_smallest_within_an_error(void **state)
{
    (void)state;
    hnbrdf_bake_options o = small(HNBRDF_BAKE_ERROR);
    hnbrdf_bake_report r;
    learn_from_data(&o);
    o.max_error = 2.0;
    hnbrdf_model *baked = bake(&o, &r);
    check_report(&r, baked);
    assert_true(r.met && r.row_count == 1);
    assert_int_equal(r.reason, HNBRDF_BAKE_GGX_IS_ENOUGH);
    o.max_error = 0.9 * r.rows[0].smape;
    end(baked, &r);

    baked = bake(&o, &r);
    check_report(&r, baked);
    const hnbrdf_bake_row *best = picked(&r);
    assert_true(r.met && r.from_data && !r.kept && r.model_smape > 0.0);
    assert_int_equal(r.reason, HNBRDF_BAKE_SMALLEST);
    assert_true(r.rows[0].smape > o.max_error && best->smape <= o.max_error);
    for (int k = 1; k < r.row_count; k++)
        assert_true(r.rows[k].smape > o.max_error ||
                    r.rows[k].size.multiplications >= best->size.multiplications);
    /* The report's error is what hnbrdf_compare() says of the model returned. */
    hnbrdf_comparison own;
    assert_int_equal(hnbrdf_compare(baked, hnbrdf_model_material(baked, 1), data[1], r.sampler,
                                    r.pairs, r.seed, &own, NULL),
                     HNBRDF_OK);
    assert_true(own.smape == best->errors[1].smape);
    end(baked, &r);
}

static void the_best_within_a_size(void **state)
{
    (void)state;
    hnbrdf_bake_options o = small(HNBRDF_BAKE_SIZE);
    hnbrdf_bake_report r;
    learn_from_data(&o);
    o.max_multiplications = 100;
    hnbrdf_model *baked = bake(&o, &r);
    check_report(&r, baked);
    assert_true(r.met && r.reason == HNBRDF_BAKE_MOST_ACCURATE);
    for (int k = 0; k < r.row_count; k++) {
        assert_true(r.rows[k].size.multiplications <= o.max_multiplications);
        assert_true(r.rows[k].smape >= picked(&r)->smape);
    }
    assert_true(picked(&r)->size.hidden > 0);
    end(baked, &r);
}

static void the_best_within_a_time(void **state)
{
    (void)state;
    hnbrdf_bake_options o = small(HNBRDF_BAKE_TIME);
    hnbrdf_bake_report r;
    o.max_ns = 1e-3; /* nothing is that fast */
    hnbrdf_model *baked = bake(&o, &r);
    check_report(&r, baked);
    assert_true(!r.met && r.reason == HNBRDF_BAKE_FASTEST && r.row_count == 1);
    end(baked, &r);
    o.max_ns = 1e9; /* everything is */
    baked = bake(&o, &r);
    check_report(&r, baked);
    assert_true(r.met && r.reason == HNBRDF_BAKE_MOST_ACCURATE && picked(&r)->size.hidden > 0);
    end(baked, &r);
}

static void the_balance_of_error_and_time(void **state)
{
    (void)state;
    hnbrdf_bake_options o = small(HNBRDF_BAKE_AUTO);
    hnbrdf_bake_report r;
    hnbrdf_model *baked = bake(&o, &r);
    check_report(&r, baked);
    assert_true(r.met && r.reason == HNBRDF_BAKE_BALANCED);
    const hnbrdf_bake_row *best = picked(&r);
    for (int k = 1; k < r.row_count; k++)
        if (r.rows[k].full)
            assert_true(r.rows[k].smape * r.rows[k].size.ns >= best->smape * best->size.ns);
    end(baked, &r);
}

/* ---- The model as the teacher ---------------------------------------------------------------- */

/* Chosen materials in their new order; the analytic part stays to the last bit. */
static void a_given_network_learned_from_the_model(void **state)
{
    static const int scene[] = {2, 0};
    (void)state;
    hnbrdf_bake_options o = small(HNBRDF_BAKE_NET);
    hnbrdf_bake_report r;
    o.hidden = 6;
    o.layers = 1;
    o.materials = scene;
    o.material_count = 2;
    o.encoding = "half-difference";
    hnbrdf_model *baked = bake(&o, &r);
    check_report(&r, baked);
    assert_true(r.met && r.kept && !r.from_data && isnan(r.model_smape));
    assert_int_equal(r.reason, HNBRDF_BAKE_GIVEN);
    const hnbrdf_bake_row *row = picked(&r);
    assert_int_equal(row->size.latent, 1); /* one less than there are materials */
    assert_int_equal(row->encoding, HNBRDF_ENCODING_HALF_DIFFERENCE);
    assert_int_equal(row->steps, o.steps);
    assert_true(row->smape < r.rows[0].smape);
    for (int m = 0; m < 2; m++) {
        const hnbrdf_material *is = hnbrdf_model_material(baked, m),
                              *was = hnbrdf_model_material(model, scene[m]);
        assert_memory_equal(is->kd, was->kd, sizeof is->kd);
        assert_memory_equal(is->eta, was->eta, sizeof is->eta);
        assert_memory_equal(is->alpha, was->alpha, sizeof is->alpha);
    }
    end(baked, &r);

    o.latent_none = 1;
    baked = bake(&o, &r);
    assert_int_equal(picked(&r)->size.latent, 0);
    end(baked, &r);
}

/* ---- Bits ------------------------------------------------------------------------------------ */

static int append(void *user, const void *bytes, size_t size)
{
    static const size_t ROOM = 1 << 16;
    char *to = user;
    size_t used;
    memcpy(&used, to, sizeof used);
    if (used + size > ROOM)
        return 1;
    memcpy(to + used, bytes, size);
    used += size;
    memcpy(to, &used, sizeof used);
    return 0;
}

/* What several processes make of a bake, here threads. */
typedef struct shared_bake {
    hnbrdf_bake_options options;
    hnbrdf_model *baked[2];
    hnbrdf_bake_report report[2];
} shared_bake;

static void bake_rank(void *context, const hnbrdf_communicator *ranks)
{
    shared_bake *s = context;
    hnbrdf_bake_options o = s->options;
    o.ranks = ranks;
    hnbrdf_bake(model, &o, &s->baked[ranks->rank], &s->report[ranks->rank], NULL);
}

static char *file_of(const hnbrdf_model *baked)
{
    size_t start = sizeof start;
    char *file = calloc(1, 1 << 16);
    assert_non_null(file);
    memcpy(file, &start, sizeof start);
    assert_int_equal(hnbrdf_model_write(baked, append, file, NULL), HNBRDF_OK);
    return file;
}

static void several_ranks_give_the_same_bits(void **state)
{
    (void)state;
    shared_bake s = {.options = small(HNBRDF_BAKE_SIZE)};
    hnbrdf_bake_report r;
    s.options.max_multiplications = 100;
    s.options.analytic = HNBRDF_BAKE_ANALYTIC_FIT;
    hnbrdf_model *alone = bake(&s.options, &r);
    char *wanted = file_of(alone);
    assert_true(test_ranks_run(2, bake_rank, &s));
    assert_true(s.report[0].model.ns == s.report[1].model.ns); /* one clock decides */
    for (int k = 0; k < 2; k++) {
        assert_non_null(s.baked[k]);
        char *found = file_of(s.baked[k]);
        assert_memory_equal(found, wanted, 1 << 16);
        assert_int_equal(s.report[k].row_count, r.row_count);
        for (int i = 0; i < r.row_count; i++)
            assert_true(s.report[k].rows[i].smape == r.rows[i].smape);
        free(found);
        end(s.baked[k], &s.report[k]);
    }
    free(wanted);
    end(alone, &r);
}

static void the_same_bits_on_any_number_of_threads(void **state)
{
    (void)state;
    char *files[2];
    for (int k = 0; k < 2; k++) {
        hnbrdf_bake_options o = small(HNBRDF_BAKE_SIZE);
        hnbrdf_bake_report r;
        o.max_multiplications = 100;
        o.threads = k + 1;
        hnbrdf_model *baked = bake(&o, &r);
        files[k] = file_of(baked);
        end(baked, &r);
    }
    assert_memory_equal(files[0], files[1], 1 << 16);
    free(files[0]);
    free(files[1]);
}

/* ---- The callback ---------------------------------------------------------------------------- */

typedef struct watched {
    int rows, calls, stop_stage, stop_row; /* -1: never */
    double last[HNBRDF_BAKE_FULL_FITS + 1];
} watched;

static int watch(void *user, const hnbrdf_bake_progress *p)
{
    watched *w = user;
    w->calls++;
    assert_true(p->done >= 0.0 && p->done <= 1.0);
    if (p->new_row) {
        w->rows++;
        assert_int_equal(p->report->row_count, w->rows);
        return w->rows == w->stop_row;
    }
    if (p->stage == HNBRDF_BAKE_SHORT_FITS || p->stage == HNBRDF_BAKE_FULL_FITS)
        assert_true(p->first && p->last && p->first->hidden > 0);
    return (int)p->stage == w->stop_stage;
}

static void progress_can_stop_it(void **state)
{
    (void)state;
    hnbrdf_bake_options o = small(HNBRDF_BAKE_SIZE);
    hnbrdf_bake_report r;
    hnbrdf_error error = {""};
    watched w = {.stop_stage = -1, .stop_row = -1};
    o.max_multiplications = 200;
    o.progress = watch;
    o.progress_user = &w;
    hnbrdf_model *baked = bake(&o, &r);
    assert_true(r.end == HNBRDF_BAKE_COMPLETE && w.rows == r.row_count && w.calls > w.rows);
    const int complete = r.row_count;
    end(baked, &r);

    /* After the second row, the first network: it is returned. */
    w = (watched){.stop_stage = -1, .stop_row = 2};
    baked = bake(&o, &r);
    assert_int_equal(r.end, HNBRDF_BAKE_STOPPED);
    assert_true(r.row_count >= 2 && r.row_count < complete && picked(&r)->size.hidden > 0);
    end(baked, &r);

    /* During the timing: there is no network, and GGX alone is not what was asked for. */
    o.wish = HNBRDF_BAKE_NET;
    o.hidden = o.layers = 2;
    w = (watched){.stop_stage = HNBRDF_BAKE_TIMING, .stop_row = -1};
    baked = (hnbrdf_model *)&o; /* any pointer */
    assert_int_equal(hnbrdf_bake(model, &o, &baked, NULL, &error), HNBRDF_ERROR_CANCELLED);
    assert_string_equal(error.text, "interrupted before a network was fitted");
    assert_ptr_equal(baked, &o);

    /* While GGX is fitted there is nothing at all. */
    learn_from_data(&o);
    w = (watched){.stop_stage = HNBRDF_BAKE_GGX, .stop_row = -1};
    assert_int_equal(hnbrdf_bake(model, &o, &baked, NULL, &error), HNBRDF_ERROR_CANCELLED);
    assert_string_equal(error.text, "interrupted before a network was fitted");
}

/* ---- Bad options ----------------------------------------------------------------------------- */

static void refuse(hnbrdf_bake_options o, const char *text)
{
    hnbrdf_error error = {""};
    hnbrdf_bake_report report = {.row_count = -5};
    hnbrdf_model *baked = NULL;
    assert_int_equal(hnbrdf_bake(model, &o, &baked, &report, &error), HNBRDF_ERROR_ARGUMENT);
    assert_null(baked);
    assert_int_equal(report.row_count, -5);
    if (!strstr(error.text, text) || strchr(error.text, '\n'))
        fail_msg("'%s' does not say '%s'", error.text, text);
}

#define REFUSE(text, ...) refuse((hnbrdf_bake_options){__VA_ARGS__}, text)

static void bad_options_are_refused(void **state)
{
    static const int twice[] = {1, 1}, beyond[] = {3};
    (void)state;
    REFUSE("max_error is 0,", .wish = HNBRDF_BAKE_ERROR);
    REFUSE("max_error is nan", .wish = HNBRDF_BAKE_ERROR, .max_error = (double)NAN);
    REFUSE("max_error is 2.5, expected a number above 0 and at most 2", .wish = HNBRDF_BAKE_ERROR,
           .max_error = 2.5);
    REFUSE("max_ns is -1", .wish = HNBRDF_BAKE_TIME, .max_ns = -1.0);
    REFUSE("max_multiplications is 0", .wish = HNBRDF_BAKE_SIZE);
    REFUSE("hidden is 0, expected a whole number from 1 to 64", .wish = HNBRDF_BAKE_NET);
    REFUSE("layers is 9", .wish = HNBRDF_BAKE_NET, .hidden = 8, .layers = 9);
    REFUSE("wish is 77", .wish = (hnbrdf_bake_wish)77);
    REFUSE("judge is 2", .judge = (hnbrdf_bake_judge)2);
    REFUSE("analytic is 3", .analytic = (hnbrdf_bake_analytic)3);
    REFUSE("sampler is 9", .sampler = (hnbrdf_sampler)9);
    REFUSE("latent is -1", .latent = -1);
    REFUSE("latent is 4 and latent_none is set", .latent = 4, .latent_none = 1);
    REFUSE("encoding is polar, expected one of directions, ", .encoding = "polar");
    REFUSE("restarts is 33", .restarts = 33);
    REFUSE("pool is 63", .pool = 63);
    REFUSE("threads is 257", .threads = 257);
    REFUSE("seconds is -1", .seconds = -1.0);
    REFUSE("material_count is 0", .materials = twice);
    REFUSE("twice", .materials = twice, .material_count = 2);
    REFUSE("an index in materials is 3, expected a whole number from 0 to 2", .materials = beyond,
           .material_count = 1);
    REFUSE("no measurement of", .data = (const hnbrdf_measured *const *)data, .data_count = 2);
    hnbrdf_error error;
    hnbrdf_model *baked = NULL;
    assert_int_equal(hnbrdf_bake(NULL, NULL, &baked, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    assert_string_equal(error.text, "model is NULL, expected a model");
    hnbrdf_bake_report_free(NULL);
}

/* ---------------------------------------------------------------------------------------------- */

static int set_up(void **state)
{
    hnbrdf_error error;
    (void)state;
    for (int m = 0; m < MATERIALS; m++)
        if (hnbrdf_measured_open_builtin(m, &data[m], &error))
            return -1;
    const hnbrdf_fit_options fit = {
        .hidden = 16, .layers = 2, .latent = 2, .steps = 300, .pool = 2048};
    return (int)hnbrdf_fit((const hnbrdf_measured *const *)data, MATERIALS, &fit, &model, NULL,
                           &error);
}

static int tear_down(void **state)
{
    (void)state;
    for (int m = 0; m < MATERIALS; m++)
        hnbrdf_measured_close(data[m]);
    hnbrdf_model_free(model);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_smallest_within_an_error),
        cmocka_unit_test(the_best_within_a_size),
        cmocka_unit_test(the_best_within_a_time),
        cmocka_unit_test(the_balance_of_error_and_time),
        cmocka_unit_test(a_given_network_learned_from_the_model),
        cmocka_unit_test(the_same_bits_on_any_number_of_threads),
        cmocka_unit_test(several_ranks_give_the_same_bits),
        cmocka_unit_test(progress_can_stop_it),
        cmocka_unit_test(bad_options_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
