/* test_fit_ranks.c: a fit by several ranks gives what one process gives, to the last bit, whoever
 * has the data; goes on from a checkpoint of any number of them; and ends on all when it fails on
 * one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fit/share.h"
#include "ranks_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 3 };
static const char checkpoint[] = "test_fit_ranks.checkpoint";
static hnbrdf_measured *data[COUNT], *empty;
static hnbrdf_material given[COUNT];

/* What several ranks are to do, and what came of it. */
typedef struct job {
    hnbrdf_fit_options options;
    hnbrdf_measured *const *data;
    int all_have_all; /* 1: every rank has every material; 0: each has its share */
    int other;        /* the rank with another seed; -1: none */
    hnbrdf_result result[TEST_RANKS_MOST];
    hnbrdf_error error[TEST_RANKS_MOST];
    hnbrdf_model *model[TEST_RANKS_MOST];
    hnbrdf_fit_report report[TEST_RANKS_MOST];
} job;

static int open_data(void **state)
{
    (void)state;
    for (int i = 0; i < COUNT; i++) {
        if (hnbrdf_measured_open_builtin(5 * i, &data[i], NULL))
            return -1;
        hnbrdf_material_init(&given[i]);
        given[i].alpha[0] = given[i].alpha[1] = 0.1f + 0.1f * (float)i;
    }
    return 0;
}

static int close_data(void **state)
{
    (void)state;
    for (int i = 0; i < COUNT; i++)
        hnbrdf_measured_close(data[i]);
    remove(checkpoint);
    return 0;
}

static void fit_rank(void *context, const hnbrdf_communicator *ranks)
{
    job *j = context;
    const hnbrdf_measured *mine[COUNT];
    const int r = ranks->rank;
    hnbrdf_fit_options o = j->options;
    for (int m = 0; m < COUNT; m++)
        mine[m] = j->all_have_all || (m * 7 + 1) % ranks->size == r ? j->data[m] : NULL;
    o.ranks = ranks;
    o.seed += j->other == r;
    j->result[r] = hnbrdf_fit(mine, COUNT, &o, &j->model[r], &j->report[r], &j->error[r]);
}

static void assert_same_model(const hnbrdf_model *a, const hnbrdf_model *b)
{
    hnbrdf_model_desc x, y;
    hnbrdf_model_describe(a, &x);
    hnbrdf_model_describe(b, &y);
    assert_int_equal(x.kind, y.kind);
    assert_int_equal(x.encoding, y.encoding);
    assert_int_equal(x.material_count, y.material_count);
    for (int m = 0; m < x.material_count; m++) {
        assert_string_equal(x.names[m], y.names[m]);
        assert_memory_equal(&x.materials[m], &y.materials[m], sizeof x.materials[m]);
    }
    for (int k = 0; k <= x.layers && x.kind != HNBRDF_KIND_GGX; k++) {
        const size_t out = (size_t)(k < x.layers ? x.hidden : x.kind == HNBRDF_KIND_HYBRID ? 6 : 3);
        const size_t in = (size_t)(k > 0 ? x.hidden : 6 + x.latent);
        assert_memory_equal(x.weights[k], y.weights[k], out * in * sizeof(float));
        assert_memory_equal(x.biases[k], y.biases[k], out * sizeof(float));
    }
}

static void drop_models(job *j, int count)
{
    for (int r = 0; r < count; r++) {
        hnbrdf_model_free(j->model[r]);
        j->model[r] = NULL;
    }
}

/* So many ranks make the model of one process. */
static void expect_model(job *j, int count, const hnbrdf_model *wanted,
                         const hnbrdf_fit_report *report)
{
    j->other = -1;
    assert_true(test_ranks_run(count, fit_rank, j));
    for (int r = 0; r < count; r++) {
        if (j->result[r])
            print_error("rank %d of %d: %s\n", r, count, j->error[r].text);
        assert_int_equal(j->result[r], HNBRDF_OK);
        assert_same_model(j->model[r], wanted);
        assert_memory_equal(&j->report[r].best_loss, &report->best_loss, sizeof(double));
        assert_int_equal(j->report[r].steps, report->steps);
    }
    drop_models(j, count);
}

static hnbrdf_fit_options tiny(void)
{
    return (hnbrdf_fit_options){.hidden = 9,
                                .layers = 2,
                                .steps = 230, /* past a judgement and a second window */
                                .batch = 2048,
                                .pool = 640,
                                .threads = 1,
                                .seed = 3,
                                .materials = given,
                                .lobes_none = 1};
}

static hnbrdf_model *fit_alone(const hnbrdf_fit_options *o, hnbrdf_fit_report *report)
{
    hnbrdf_model *model = NULL;
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, o, &model, report, NULL),
        HNBRDF_OK);
    return model;
}

/* ---- Bits ------------------------------------------------------------------------------------ */

static void expect_same_bits(const hnbrdf_fit_options *options, const int *counts, size_t size)
{
    hnbrdf_fit_report report;
    job j = {.options = *options, .data = data};
    hnbrdf_model *wanted = fit_alone(options, &report);
    for (size_t k = 0; k < size; k++) {
        j.options.threads = 1 + (int)(k % 2);
        j.all_have_all = k % 3 == 1;
        expect_model(&j, counts[k], wanted, &report);
    }
    hnbrdf_model_free(wanted);
}

static void any_number_of_ranks_and_threads_gives_the_same_bits(void **state)
{
    (void)state;
    static const int counts[] = {2, 2, 3, 3, 8};
    const hnbrdf_fit_options o = tiny();
    expect_same_bits(&o, counts, sizeof counts / sizeof counts[0]);
}

/* More than there are chunks: tiles are then apart. */
static void more_ranks_than_chunks_give_the_same_bits(void **state)
{
    (void)state;
    static const int counts[] = {FIT_CHUNKS + 3};
    hnbrdf_fit_options o = tiny();
    o.analytic = HNBRDF_FIT_JOINT;
    o.steps = 40;
    o.batch = 3 * FIT_CHUNKS * 64;
    expect_same_bits(&o, counts, 1);
}

static void more_threads_than_chunks_give_the_same_bits(void **state)
{
    (void)state;
    hnbrdf_fit_report report, again;
    hnbrdf_fit_options o = tiny();
    o.steps = 40;
    hnbrdf_model *wanted = fit_alone(&o, &report);
    o.threads = FIT_CHUNKS + 1;
    hnbrdf_model *found = fit_alone(&o, &again);
    assert_same_model(found, wanted);
    hnbrdf_model_free(wanted);
    hnbrdf_model_free(found);
}

static void every_kind_of_fit_gives_the_same_bits(void **state)
{
    (void)state;
    static const int two[] = {2}, three[] = {3};
    hnbrdf_fit_options o = tiny();
    o.steps = 40;
    o.analytic = HNBRDF_FIT_JOINT;
    expect_same_bits(&o, three, 1);
    o.analytic = HNBRDF_FIT_FAITHFUL;
    o.kind = HNBRDF_KIND_NEURAL;
    expect_same_bits(&o, two, 1);
    o = (hnbrdf_fit_options){.steps = 20, .pool = 320, .threads = 1, .seed = 5, .hidden = 5};
    expect_same_bits(&o, three, 1); /* with fits of GGX */
    o.kind = HNBRDF_KIND_GGX;
    expect_same_bits(&o, two, 1);
}

static void a_frozen_network_gives_the_same_bits(void **state)
{
    (void)state;
    static const int counts[] = {3};
    hnbrdf_fit_report report;
    hnbrdf_fit_options o = tiny();
    o.steps = 20;
    hnbrdf_model *known = fit_alone(&o, &report);
    o.freeze = known;
    o.steps = 30;
    expect_same_bits(&o, counts, 1);
    hnbrdf_model_free(known);
}

/* ---- Memory ---------------------------------------------------------------------------------- */

/* Of no material, or of the first one, there is room for all pairs. */
static void pairs_that_are_drawn_again_give_the_same_bits(void **state)
{
    (void)state;
    static const int two[] = {2};
    hnbrdf_fit_report report, again;
    hnbrdf_fit_options o = tiny();
    o.analytic = HNBRDF_FIT_JOINT;
    hnbrdf_model *wanted = fit_alone(&o, &report);
    assert_int_equal(report.redrawn, 0);
    assert_true(report.kept == 72.0 * o.pool * COUNT);
    o.memory = (size_t)(1.5 * 72.0 * o.pool);
    hnbrdf_model *found = fit_alone(&o, &again);
    assert_same_model(found, wanted);
    assert_int_equal(again.redrawn, COUNT - 1);
    assert_true(again.kept == 72.0 * o.pool);
    hnbrdf_model_free(found);
    o = (hnbrdf_fit_options){.steps = 20, .pool = 320, .threads = 1, .seed = 5, .hidden = 5};
    hnbrdf_model_free(wanted);
    wanted = fit_alone(&o, &report);
    job j = {.options = o, .data = data};
    j.options.memory = 1;
    expect_model(&j, 2, wanted, &report);
    o.freeze = wanted; /* starts from codes that the first pairs choose */
    o.steps = 10;
    o.memory = 1;
    hnbrdf_model *frozen = fit_alone(&o, &report);
    o.memory = 0;
    expect_same_bits(&o, two, 1);
    found = fit_alone(&o, &again);
    assert_same_model(found, frozen);
    hnbrdf_model_free(found);
    hnbrdf_model_free(frozen);
    hnbrdf_model_free(wanted);
}

static int stop_at_100(void *user, const hnbrdf_fit_progress *p);

/* The tiles that come next are not the first ones. */
static void a_fit_goes_on_with_less_memory(void **state)
{
    (void)state;
    hnbrdf_fit_report report;
    hnbrdf_fit_options o = tiny();
    hnbrdf_model *wanted = fit_alone(&o, &report);
    o.checkpoint = checkpoint;
    o.progress = stop_at_100;
    hnbrdf_model_free(fit_alone(&o, &report));
    assert_true(report.stopped);
    o.progress = NULL;
    o.resume = 1;
    o.memory = 1;
    hnbrdf_model *found = fit_alone(&o, &report);
    assert_same_model(found, wanted);
    hnbrdf_model_free(found);
    hnbrdf_model_free(wanted);
}

/* ---- What is written for the caller ---------------------------------------------------------- */

typedef struct findings {
    job job;
    hnbrdf_fit_search search[TEST_RANKS_MOST][COUNT];
    hnbrdf_fit_drawn drawn[TEST_RANKS_MOST][COUNT];
} findings;

static void find_rank(void *context, const hnbrdf_communicator *ranks)
{
    findings *f = context;
    job j = f->job;
    j.options.search = f->search[ranks->rank];
    j.options.drawn = f->drawn[ranks->rank];
    fit_rank(&j, ranks);
    f->job.result[ranks->rank] = j.result[ranks->rank];
    f->job.model[ranks->rank] = j.model[ranks->rank];
}

static void every_rank_hears_what_was_found_in_all_data(void **state)
{
    (void)state;
    hnbrdf_fit_report report;
    hnbrdf_fit_search search[COUNT];
    hnbrdf_fit_drawn drawn[COUNT];
    findings f = {.job = {.data = data, .other = -1}};
    f.job.options =
        (hnbrdf_fit_options){.kind = HNBRDF_KIND_GGX, .pool = 128, .threads = 1, .seed = 2};
    hnbrdf_fit_options o = f.job.options;
    o.search = search;
    o.drawn = drawn;
    hnbrdf_model_free(fit_alone(&o, &report));
    assert_true(test_ranks_run(3, find_rank, &f));
    for (int r = 0; r < 3; r++) {
        assert_int_equal(f.job.result[r], HNBRDF_OK);
        for (int m = 0; m < COUNT; m++) {
            assert_true(f.search[r][m].starts == search[m].starts && search[m].starts > 0);
            assert_true(f.search[r][m].best == search[m].best);
            assert_true(f.drawn[r][m].largest == drawn[m].largest);
            assert_true(f.drawn[r][m].valid == drawn[m].valid);
        }
    }
    drop_models(&f.job, 3);
}

/* ---- Checkpoints ----------------------------------------------------------------------------- */

static int stop_at_100(void *user, const hnbrdf_fit_progress *p)
{
    (void)user;
    return p->step >= 100;
}

/* Only one rank is asked to stop. */
static void stop_rank(void *context, const hnbrdf_communicator *ranks)
{
    job *j = context;
    job mine = *j;
    mine.options.progress = ranks->rank == 1 ? stop_at_100 : NULL;
    fit_rank(&mine, ranks);
    j->result[ranks->rank] = mine.result[ranks->rank];
    j->report[ranks->rank] = mine.report[ranks->rank];
    hnbrdf_model_free(mine.model[ranks->rank]);
}

static void a_checkpoint_goes_on_with_any_number_of_ranks(void **state)
{
    (void)state;
    static const int counts[] = {1, 3};
    hnbrdf_fit_report report;
    hnbrdf_fit_options o = tiny();
    hnbrdf_model *wanted = fit_alone(&o, &report);
    job j = {.options = o, .data = data, .other = -1};
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++) {
        j.options.checkpoint = checkpoint;
        j.options.resume = 0;
        assert_true(test_ranks_run(2, stop_rank, &j));
        for (int r = 0; r < 2; r++) {
            assert_int_equal(j.result[r], HNBRDF_OK);
            assert_true(j.report[r].stopped);
            assert_int_equal(j.report[r].steps, 101); /* the others hear of it with a step */
        }
        j.options.resume = 1;
        expect_model(&j, counts[k], wanted, &report);
    }
    hnbrdf_model_free(wanted);
}

/* ---- Failures -------------------------------------------------------------------------------- */

static void expect_failure(job *j, int count, hnbrdf_result result, const char *text)
{
    assert_true(test_ranks_run(count, fit_rank, j));
    for (int r = 0; r < count; r++) {
        assert_int_equal(j->result[r], result);
        assert_non_null(strstr(j->error[r].text, text));
        assert_null(j->model[r]);
    }
}

static int no_value(const void *user, const float wi[3], const float wo[3], float f[3])
{
    (void)user;
    (void)wi;
    (void)wo;
    (void)f;
    return 0;
}

static void all_ranks_say_what_is_wrong_with_one(void **state)
{
    (void)state;
    hnbrdf_measured *some[COUNT];
    const hnbrdf_measured_custom nothing = {.name = "nothing", .isotropic = 1, .eval = no_value};
    assert_int_equal(hnbrdf_measured_create_custom(&nothing, &empty, NULL), HNBRDF_OK);
    job j = {.options = tiny(), .data = some, .other = -1};
    memcpy(some, data, sizeof some);
    some[2] = empty;
    expect_failure(&j, 3, HNBRDF_ERROR_FORMAT, "nothing: 0 % of the directions drawn are valid");
    some[2] = NULL;
    expect_failure(&j, 3, HNBRDF_ERROR_ARGUMENT, "material 2 of 3 to fit is NULL on every rank");
    j.data = data;
    j.other = 2;
    expect_failure(&j, 3, HNBRDF_ERROR_ARGUMENT, "rank 2 of 3 was given other options");
    j.other = -1;
    j.options.checkpoint = "no/such/folder/x.checkpoint";
    j.options.resume = 1;
    expect_failure(&j, 2, HNBRDF_ERROR_IO, "no checkpoint to resume from");
    hnbrdf_measured_close(empty);
}

/* A rank that dies: its communicator stops answering at the given number of gathers. */
typedef struct mortal {
    const hnbrdf_communicator *inner;
    int left;
} mortal;

static int mortal_gather(void *user, const void *mine, void *all, const size_t *bytes)
{
    mortal *m = user;
    return m->left-- <= 0 || m->inner->gather(m->inner->user, mine, all, bytes);
}

static int mortal_exchange(void *user, const void *send, const size_t *send_bytes, void *received,
                           const size_t *received_bytes)
{
    mortal *m = user;
    return m->inner->exchange(m->inner->user, send, send_bytes, received, received_bytes);
}

static int mortal_broadcast(void *user, void *sent, size_t bytes, int root)
{
    mortal *m = user;
    return m->inner->broadcast(m->inner->user, sent, bytes, root);
}

static void die_rank(void *context, const hnbrdf_communicator *ranks)
{
    mortal m = {ranks, ranks->rank == 1 ? 150 : 1 << 30};
    const hnbrdf_communicator shorter = {ranks->rank,     ranks->size,      mortal_gather,
                                         mortal_exchange, mortal_broadcast, &m};
    fit_rank(context, &shorter);
}

static void a_rank_that_dies_ends_the_fit_and_leaves_a_checkpoint(void **state)
{
    (void)state;
    hnbrdf_fit_report report;
    hnbrdf_fit_options o = tiny();
    hnbrdf_model *wanted = fit_alone(&o, &report);
    job j = {.options = o, .data = data, .other = -1};
    j.options.checkpoint = checkpoint;
    remove(checkpoint);
    assert_true(test_ranks_run(3, die_rank, &j));
    for (int r = 0; r < 3; r++) {
        assert_int_equal(j.result[r], HNBRDF_ERROR_IO);
        assert_non_null(strstr(j.error[r].text, "has ended or cannot be reached"));
    }
    assert_non_null(strstr(j.error[0].text, "test_fit_ranks.checkpoint holds the"));
    j.options.resume = 1;
    expect_model(&j, 2, wanted, &report);
    hnbrdf_model_free(wanted);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_ranks_and_threads_gives_the_same_bits),
        cmocka_unit_test(more_ranks_than_chunks_give_the_same_bits),
        cmocka_unit_test(more_threads_than_chunks_give_the_same_bits),
        cmocka_unit_test(every_kind_of_fit_gives_the_same_bits),
        cmocka_unit_test(a_frozen_network_gives_the_same_bits),
        cmocka_unit_test(pairs_that_are_drawn_again_give_the_same_bits),
        cmocka_unit_test(a_fit_goes_on_with_less_memory),
        cmocka_unit_test(every_rank_hears_what_was_found_in_all_data),
        cmocka_unit_test(a_checkpoint_goes_on_with_any_number_of_ranks),
        cmocka_unit_test(all_ranks_say_what_is_wrong_with_one),
        cmocka_unit_test(a_rank_that_dies_ends_the_fit_and_leaves_a_checkpoint)};
    return cmocka_run_group_tests(tests, open_data, close_data);
}
