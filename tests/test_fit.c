/* test_fit.c: whole fits on built-in materials and on a table made from known parameters. */
#include "sanitized.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 3 };
static hnbrdf_measured *data[COUNT];

static int open_data(void **state)
{
    (void)state;
    for (int i = 0; i < COUNT; i++)
        if (hnbrdf_measured_open_builtin(i, &data[i], NULL))
            return -1;
    return 0;
}

static int close_data(void **state)
{
    (void)state;
    for (int i = 0; i < COUNT; i++)
        hnbrdf_measured_close(data[i]);
    return 0;
}

enum { BATCH = SANITIZED ? 512 : 2048 };

static hnbrdf_fit_options small(hnbrdf_kind kind)
{
    hnbrdf_fit_options o = {0};
    o.kind = kind;
    o.hidden = 16;
    o.layers = 2;
    o.steps = 600;
    o.batch = BATCH;
    o.pool = SANITIZED ? BATCH : 4 * BATCH;
    o.seed = 5;
    o.lobes_none = 1;
    return o;
}

static hnbrdf_model *fit(const hnbrdf_fit_options *options, hnbrdf_fit_report *report)
{
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    if (hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, options, &model, report, &error))
        fail_msg("%s", error.text);
    return model;
}

typedef struct bytes {
    unsigned char data[1 << 16];
    size_t size;
} bytes;

static int append(void *user, const void *from, size_t size)
{
    bytes *b = user;
    if (size > sizeof b->data - b->size)
        return 1;
    memcpy(b->data + b->size, from, size);
    b->size += size;
    return 0;
}

static void threads_do_not_change_the_model(void **state)
{
    (void)state;
    static bytes one, three;
    for (int joint = 0; joint < 2; joint++) {
        hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
        o.steps = 60;
        o.analytic = joint ? HNBRDF_FIT_JOINT : HNBRDF_FIT_FAITHFUL;
        o.lobes_none = joint;
        one.size = three.size = 0;
        o.threads = 1;
        hnbrdf_model *a = fit(&o, NULL);
        o.threads = 3;
        hnbrdf_model *b = fit(&o, NULL);
        assert_int_equal(hnbrdf_model_write(a, append, &one, NULL), HNBRDF_OK);
        assert_int_equal(hnbrdf_model_write(b, append, &three, NULL), HNBRDF_OK);
        assert_int_equal(one.size, three.size);
        assert_memory_equal(one.data, three.data, one.size);
        hnbrdf_model_free(a);
        hnbrdf_model_free(b);
    }
}

/* With lobes, or those made later, a model is the same; without, all of them are 0, those of given
 * materials too. */
static void lobes_can_be_left_out(void **state)
{
    (void)state;
    static const hnbrdf_lobes none;
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    o.steps = 60;
    o.lobes_none = 0;
    hnbrdf_model *with = fit(&o, NULL);
    o.lobes_none = 1;
    hnbrdf_model *without = fit(&o, NULL);
    o.materials = hnbrdf_model_material(with, 0);
    hnbrdf_model *given = fit(&o, NULL);
    for (int i = 0; i < COUNT; i++) {
        const hnbrdf_material *a = hnbrdf_model_material(with, i),
                              *b = hnbrdf_model_material(without, i);
        hnbrdf_lobes later;
        assert_memory_equal(a, b, offsetof(hnbrdf_material, lobes));
        assert_memory_equal(&b->lobes, &none, sizeof none);
        assert_memory_equal(&hnbrdf_model_material(given, i)->lobes, &none, sizeof none);
        assert_int_equal(hnbrdf_lobes_fit(without, b, &later, NULL), HNBRDF_OK);
        assert_memory_equal(&later, &a->lobes, sizeof later);
        assert_memory_not_equal(&later, &none, sizeof later);
    }
    hnbrdf_model_free(with);
    hnbrdf_model_free(without);
    hnbrdf_model_free(given);
}

static double smape(const hnbrdf_model *model, int i)
{
    hnbrdf_comparison c;
    assert_int_equal(hnbrdf_compare(model, hnbrdf_model_material(model, i), data[i],
                                    HNBRDF_SAMPLER_GRID, 20000, 3, &c, NULL),
                     HNBRDF_OK);
    return c.smape;
}

static void hybrid_is_closer_than_ggx_and_keeps_its_analytic_part(void **state)
{
    (void)state;
    hnbrdf_fit_options o = small(HNBRDF_KIND_GGX);
    hnbrdf_model *ggx = fit(&o, NULL);
    o = small(HNBRDF_KIND_HYBRID);
    hnbrdf_fit_report report;
    hnbrdf_model *hybrid = fit(&o, &report);
    assert_int_equal(report.steps, 600);
    for (int i = 0; i < COUNT; i++) {
        const hnbrdf_material *a = hnbrdf_model_material(ggx, i),
                              *b = hnbrdf_model_material(hybrid, i);
        assert_true(smape(hybrid, i) < 0.9 * smape(ggx, i));
        assert_memory_equal(a->kd, b->kd, sizeof a->kd);
        assert_memory_equal(a->eta, b->eta, sizeof a->eta);
        assert_memory_equal(a->alpha, b->alpha, sizeof a->alpha);
        assert_string_equal(hnbrdf_model_material_name(hybrid, i), hnbrdf_measured_name(data[i]));
    }
    hnbrdf_model_free(ggx);
    hnbrdf_model_free(hybrid);
}

static void every_kind_and_encoding_fits(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        hnbrdf_fit_options o = small(k < 2 ? HNBRDF_KIND_NEURAL : HNBRDF_KIND_HYBRID);
        o.steps = 100;
        o.layers = 1 + k;
        o.encoding = k % 2 ? "directions" : "half-difference";
        o.analytic = k == 3 ? HNBRDF_FIT_JOINT : HNBRDF_FIT_FAITHFUL;
        o.floor_none = k == 2;
        hnbrdf_fit_report report;
        hnbrdf_model *model = fit(&o, &report);
        hnbrdf_model_desc desc;
        hnbrdf_model_describe(model, &desc);
        assert_int_equal(desc.kind, o.kind);
        assert_string_equal(hnbrdf_encoding_name(desc.encoding), o.encoding);
        assert_int_equal(desc.layers, o.layers);
        assert_int_equal(desc.latent, k < 2 ? 12 : 4);
        assert_true(desc.floor == (k == 2 ? 0.0f : 0.003f));
        assert_true(isfinite(report.final_loss) && report.final_loss < 2.0);
        hnbrdf_model_free(model);
    }
}

/* A MERL table filled with Lambert + GGX of known parameters; the bins' centres are what is
 * stored. */
static hnbrdf_measured *known_table(const hnbrdf_material *material)
{
    enum { N = 90 * 90 * 180 };
    static const double scale[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
    size_t size = 12 + 24 * (size_t)N;
    unsigned char *file = calloc(size, 1);
    hnbrdf_model_desc desc = {0};
    const char *name = "known";
    desc.kind = HNBRDF_KIND_GGX;
    desc.material_count = 1;
    desc.materials = material;
    desc.names = &name;
    hnbrdf_model *model;
    assert_non_null(file);
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    file[0] = file[4] = 90;
    file[8] = 180;
    const double half_pi = 1.57079632679489662;
    for (int i = 0; i < 90; i++)
        for (int j = 0; j < 90; j++)
            for (int k = 0; k < 180; k++) {
                double th = (i + 0.5) / 90 * (i + 0.5) / 90 * half_pi,
                       td = (j + 0.5) / 90 * half_pi;
                double pd = (k + 0.5) / 180 * 2 * half_pi;
                double a = cos(th) * cos(td), b = sin(th) * sin(td) * cos(pd);
                double c = sin(th) * cos(td), d = cos(th) * sin(td) * cos(pd),
                       y = sin(td) * sin(pd);
                float wi[3] = {(float)(c + d), (float)y, (float)(a - b)}, f[3];
                float wo[3] = {(float)(c - d), (float)-y, (float)(a + b)};
                hnbrdf_eval(model, material, wi, wo, f);
                for (int ch = 0; ch < 3; ch++) {
                    double v = wi[2] > 0 && wo[2] > 0 ? (double)f[ch] / scale[ch] : -1.0;
                    uint64_t bits;
                    memcpy(&bits, &v, sizeof bits);
                    size_t at = 12 + 8 * ((size_t)ch * N + (size_t)(k + 180 * (j + 90 * i)));
                    for (int byte = 0; byte < 8; byte++)
                        file[at + (size_t)byte] = (unsigned char)(bits >> (8 * byte));
                }
            }
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error;
    if (hnbrdf_measured_open_memory(file, size, "known.binary", NULL, &measured, &error))
        fail_msg("%s", error.text);
    free(file);
    hnbrdf_model_free(model);
    return measured;
}

/* Nearest-bin lookup quantises theta_h: near the peak a bin is about 2 sqrt(theta_h) / 90 wide,
 * up to 10 % of a lobe of alpha 0.1; the parameters come back within that. */
static void ggx_fit_recovers_known_parameters(void **state)
{
    (void)state;
    static const float alphas[] = {0.1f, 0.4f};
    for (int k = 0; k < 2; k++) {
        hnbrdf_material known;
        hnbrdf_material_init(&known);
        known.alpha[0] = known.alpha[1] = alphas[k];
        for (int c = 0; c < 3; c++) {
            known.kd[c] = 0.1f + 0.2f * (float)c;
            known.eta[c] = 1.4f + 0.6f * (float)c;
        }
        hnbrdf_measured *table = known_table(&known);
        hnbrdf_fit_options o = small(HNBRDF_KIND_GGX);
        hnbrdf_fit_search search = {0};
        hnbrdf_model *model;
        o.search = &search;
        assert_int_equal(
            hnbrdf_fit((const hnbrdf_measured *const *)&table, 1, &o, &model, NULL, NULL),
            HNBRDF_OK);
        assert_int_equal(search.starts, 8);
        assert_true(search.best >= 0.0 && search.best <= search.second);
        const hnbrdf_material *m = hnbrdf_model_material(model, 0);
        assert_true(fabsf(m->alpha[0] / known.alpha[0] - 1.0f) < 0.1f);
        assert_true(m->alpha[0] == m->alpha[1] && m->rotation == 0.0f);
        for (int c = 0; c < 3; c++) {
            assert_true(fabsf(m->kd[c] - known.kd[c]) < 0.02f);
            assert_true(fabsf((m->eta[c] - 1.0f) / (known.eta[c] - 1.0f) - 1.0f) < 0.1f);
        }
        hnbrdf_model_free(model);
        hnbrdf_measured_close(table);
    }
}

/* The parts are processor time and the elapsed time is a wall clock's: processor time never
 * exceeds it but for the clocks' grain, for which a hundredth is plenty. */
static void times_of_a_fit_add_up_to_its_threads(void **state)
{
    (void)state;
    hnbrdf_fit_report report;
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    o.threads = 2;
    o.steps = 100;
    o.batch = 2048; /* long beside what is not counted */
    o.pool = 8192;
    hnbrdf_model_free(fit(&o, &report));
    const hnbrdf_fit_times *t = &report.times;
    double work = t->drawing + t->ggx + t->encoding + t->network + t->update;
    assert_true(t->drawing > 0.0 && t->ggx > 0.0 && t->encoding > 0.0 && t->network > 0.0 &&
                t->update > 0.0 && t->waiting >= 0.0);
    assert_int_equal(report.threads, 2);
    assert_true(work <= 1.01 * report.threads * report.seconds);
    assert_true(fabs(work + t->waiting - report.threads * report.seconds) <=
                0.01 * report.threads * report.seconds);
    assert_true(report.pairs == 100.0 * 2048.0);
    /* 16x2, 6 inputs, 6 outputs: forward 6 16 + 16 16 + 16 6 multiply-adds; backward the gradient
     * of every weight as many, and of the hidden units 16 16 + 16 6. */
    assert_true(report.flops == report.pairs * 2.0 * (2.0 * (96 + 256 + 96) + 256 + 96));
}

static void learning_rate_100_times_too_large_stays_finite(void **state)
{
    (void)state;
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    o.learning_rate = 6.0f;
    o.steps = 300;
    hnbrdf_fit_report report;
    hnbrdf_model *model = fit(&o, &report); /* create() refuses a weight that is not finite */
    assert_true(isfinite(report.final_loss));
    hnbrdf_model_free(model);
}

static int stop_in_network(void *user, const hnbrdf_fit_progress *p)
{
    int *calls = user;
    assert_true(p->done >= 0.0 && p->done <= 1.0);
    if (strcmp(p->stage, "network"))
        return 0;
    ++*calls;
    return 1;
}

static void progress_can_stop_and_the_model_so_far_is_returned(void **state)
{
    (void)state;
    int calls = 0;
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    o.steps = 1000000;
    o.progress = stop_in_network;
    o.progress_user = &calls;
    hnbrdf_fit_report report;
    hnbrdf_model *model = fit(&o, &report);
    assert_int_equal(calls, 1);
    assert_int_equal(report.stopped, 1);
    assert_true(report.steps < 1000000);
    hnbrdf_model_free(model);
}

static int stop_at_step(void *user, const hnbrdf_fit_progress *p)
{
    return p->step >= *(const long *)user;
}

static void resumed_fit_gives_the_same_model(void **state)
{
    (void)state;
    static bytes whole, resumed;
    const char *path = "test_fit.checkpoint";
    long stop = 150;
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    o.steps = 300;
    hnbrdf_model *a = fit(&o, NULL);
    o.checkpoint = path;
    o.progress = stop_at_step;
    o.progress_user = &stop;
    hnbrdf_fit_report report;
    hnbrdf_model_free(fit(&o, &report));
    assert_int_equal(report.stopped, 1);
    assert_true(report.steps >= 150 && report.steps < 300);
    o.progress = NULL;
    o.resume = 1;
    hnbrdf_model *b = fit(&o, &report);
    assert_int_equal(report.steps, 300);
    whole.size = resumed.size = 0;
    assert_int_equal(hnbrdf_model_write(a, append, &whole, NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_model_write(b, append, &resumed, NULL), HNBRDF_OK);
    assert_int_equal(whole.size, resumed.size);
    assert_memory_equal(whole.data, resumed.data, whole.size);
    hnbrdf_model_free(a);
    hnbrdf_model_free(b);

    /* Another seed, a cut file, no file: refused with a message. */
    hnbrdf_model *none = NULL;
    hnbrdf_error error;
    o.seed++;
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, &o, &none, NULL, &error),
        HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, path));
    o.seed--;
    FILE *file = fopen(path, "rb");
    static char cut[200];
    assert_int_equal(fread(cut, 1, sizeof cut, file), sizeof cut);
    fclose(file);
    file = fopen(path, "wb");
    fwrite(cut, 1, sizeof cut, file);
    fclose(file);
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, &o, &none, NULL, &error),
        HNBRDF_ERROR_FORMAT);
    remove(path);
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, &o, &none, NULL, &error),
        HNBRDF_ERROR_IO);
    assert_null(none);
}

/* A network trained on two materials, a third fitted on it: the network's bits stay, the third
 * gains on GGX or is left to it, and the two that were there stay as they are. */
static void frozen_network_takes_a_new_material(void **state)
{
    (void)state;
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    o.horizon_none =
        1; /* the comparison below draws no more pairs near the horizon than elsewhere */
    hnbrdf_model *two = NULL, *three = NULL;
    assert_int_equal(hnbrdf_fit((const hnbrdf_measured *const *)data, 2, &o, &two, NULL, NULL),
                     HNBRDF_OK);
    hnbrdf_fit_worth worth;
    o.freeze = two;
    o.worth = &worth;
    o.steps = 0;   /* as many as such fits take */
    o.hidden = 64; /* the frozen model's sizes count */
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)&data[2], 1, &o, &three, NULL, NULL), HNBRDF_OK);
    hnbrdf_model_desc a, b;
    hnbrdf_model_describe(two, &a);
    hnbrdf_model_describe(three, &b);
    assert_int_equal(b.material_count, 3);
    assert_int_equal(b.hidden, 16);
    assert_memory_equal(a.weights[1], b.weights[1], 16 * 16 * sizeof(float));
    assert_memory_equal(a.weights[0], b.weights[0], 16 * 10 * sizeof(float));
    assert_string_equal(b.names[0], hnbrdf_measured_name(data[2]));
    assert_string_equal(b.names[1], a.names[0]);
    assert_memory_equal(&b.materials[1], &a.materials[0], sizeof(hnbrdf_material));
    hnbrdf_comparison c;
    assert_int_equal(
        hnbrdf_compare(three, &b.materials[0], data[2], HNBRDF_SAMPLER_GRID, 20000, 3, &c, NULL),
        HNBRDF_OK);
    assert_true(worth.alone || worth.smape < worth.ggx_smape);
    /* of GGX only rounding is left where the network made it no better */
    assert_true(worth.alone ? fabs(c.smape / c.smape_analytic - 1.0) < 1e-5
                            : c.smape < c.smape_analytic);
    hnbrdf_model_free(three);
    three = NULL; /* fitted again, a material of the same name is replaced */
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)&data[1], 1, &o, &three, NULL, NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_model_material_count(three), 2);
    hnbrdf_model_free(two);
    hnbrdf_model_free(three);
}

static int stop_at_once(void *user, const hnbrdf_fit_progress *p)
{
    (void)user;
    (void)p;
    return 1;
}

/* An untrained network is not a model: it must not take the place of a good one. */
static void stopped_before_the_first_step_there_is_no_model(void **state)
{
    (void)state;
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    o.progress = stop_at_once;
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {{0}};
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, &o, &model, NULL, &error),
        HNBRDF_ERROR_CANCELLED);
    assert_null(model);
    assert_true(error.text[0] != '\0');
}

static void a_given_analytic_part_is_kept_and_one_material_needs_no_latent_code(void **state)
{
    (void)state;
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    hnbrdf_model *model = NULL;
    hnbrdf_material given;
    hnbrdf_model_desc desc;
    hnbrdf_error error;
    hnbrdf_material_init(&given);
    given.alpha[0] = given.alpha[1] = 0.37f;
    given.kd[1] = 0.123f;
    given.eta[2] = 2.5f;
    given.latent[0] = 7.0f; /* is not taken */
    o.materials = &given;
    o.latent_none = 1;
    o.steps = 200;
    assert_int_equal(hnbrdf_fit((const hnbrdf_measured *const *)data, 1, &o, &model, NULL, &error),
                     HNBRDF_OK);
    hnbrdf_model_describe(model, &desc);
    assert_int_equal(desc.latent, 0);
    given.latent[0] = 0.0f;
    assert_memory_equal(hnbrdf_model_material(model, 0), &given, offsetof(hnbrdf_material, lobes));

    /* Such a network can be frozen as any other. */
    hnbrdf_model *more = NULL;
    hnbrdf_fit_options frozen = {.freeze = model, .steps = 10, .pool = 1024, .lobes_none = 1};
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)data + 1, 1, &frozen, &more, NULL, &error),
        HNBRDF_OK);
    hnbrdf_model_describe(more, &desc);
    assert_int_equal(desc.latent, 0);
    hnbrdf_model_free(more);
    hnbrdf_model_free(model);

    /* Where GGX is trained along, the given part is where it starts. */
    o.analytic = HNBRDF_FIT_JOINT;
    o.steps = 1;
    o.learning_rate = 1e-6f;
    assert_int_equal(hnbrdf_fit((const hnbrdf_measured *const *)data, 1, &o, &model, NULL, &error),
                     HNBRDF_OK);
    assert_float_equal(hnbrdf_model_material(model, 0)->alpha[0], 0.37f, 1e-4f);
    assert_float_equal(hnbrdf_model_material(model, 0)->eta[2], 2.5f, 1e-4f);
    hnbrdf_model_free(model);

    given.alpha[0] = 2.0f;
    assert_int_equal(hnbrdf_fit((const hnbrdf_measured *const *)data, 1, &o, &model, NULL, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "alpha"));
}

static void bad_options_are_refused_with_a_message(void **state)
{
    (void)state;
    static const struct {
        hnbrdf_fit_options set;
        const char *message; /* part of it */
    } bad[] = {
        {{.hidden = HNBRDF_MAX_HIDDEN + 1}, "network 65x"},
        {{.layers = -1}, "x-1, expected 1x1"},
        {{.latent = HNBRDF_MAX_LATENT + 1}, "latent code of 17 floats"},
        {{.latent = -1}, "latent code of -1 floats"},
        {{.latent = 4, .latent_none = 1}, "latent is 4 and latent_none is set"},
        {{.learning_rate = NAN}, "learning rate"},
        {{.seconds = -1.0}, "seconds"},
        {{.kind = (hnbrdf_kind)9}, "out of its range"},
        {{.encoding = "angle"}, "encoding is \"angle\", expected one of"},
        {{.encoding = ""}, "encoding is \"\", expected one of"},
        {{.batch = -5}, "batch"},
        {{.floor = -0.1f}, "floor"},
        {{.floor = 1.0f}, "floor"},
        {{.floor = NAN}, "floor"},
        {{.floor = 0.5f, .floor_none = 1}, "floor is 0.5 and floor_none is set"},
        {{.uniform_share = -0.1f}, "shares"},
        {{.uniform_share = 1.1f}, "shares"},
        {{.bright_share = -0.1f}, "shares"},
        {{.bright_share = 1.1f}, "shares"},
        {{.bright_share = 0.5f, .bright_none = 1}, "bright_share is 0.5 and bright_none is"},
        {{.horizon_share = 1.1f}, "shares"},
        {{.horizon_share = 0.5f, .horizon_none = 1}, "horizon_share is 0.5 and horizon_none is"},
        {{.lift = -0.1f}, "lift"},
        {{.lift = 1.1f}, "lift"},
        {{.lift = 0.5f, .lift_none = 1}, "lift is 0.5 and lift_none is"},
        {{.uniform_share = 0.5f, .uniform_none = 1}, "uniform_share is 0.5 and uniform_none is"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        const hnbrdf_fit_options o = bad[k].set;
        hnbrdf_model *model = NULL;
        hnbrdf_error error = {{0}};
        assert_int_equal(
            hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, &o, &model, NULL, &error),
            HNBRDF_ERROR_ARGUMENT);
        assert_null(model);
        if (!strstr(error.text, bad[k].message))
            fail_msg("\"%s\" does not say \"%s\"", error.text, bad[k].message);
    }
    assert_int_equal(hnbrdf_fit((const hnbrdf_measured *const *)data, 0, NULL, NULL, NULL, NULL),
                     HNBRDF_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_do_not_change_the_model),
        cmocka_unit_test(lobes_can_be_left_out),
        cmocka_unit_test(hybrid_is_closer_than_ggx_and_keeps_its_analytic_part),
        cmocka_unit_test(every_kind_and_encoding_fits),
        cmocka_unit_test(ggx_fit_recovers_known_parameters),
        cmocka_unit_test(times_of_a_fit_add_up_to_its_threads),
        cmocka_unit_test(learning_rate_100_times_too_large_stays_finite),
        cmocka_unit_test(progress_can_stop_and_the_model_so_far_is_returned),
        cmocka_unit_test(resumed_fit_gives_the_same_model),
        cmocka_unit_test(frozen_network_takes_a_new_material),
        cmocka_unit_test(stopped_before_the_first_step_there_is_no_model),
        cmocka_unit_test(a_given_analytic_part_is_kept_and_one_material_needs_no_latent_code),
        cmocka_unit_test(bad_options_are_refused_with_a_message),
    };
    return cmocka_run_group_tests(tests, open_data, close_data);
}
