/* test_fit_stiff.c: data that are hard to fit or hardly data: mirrors, black, gaps, outliers,
 * numbers that are none. Each converges to the error stated beside it, or the fit says why not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static hnbrdf_model *plain_model; /* evaluates the GGX materials below */

static int make_plain_model(void **state)
{
    (void)state;
    hnbrdf_material material;
    const char *const name = "plain";
    hnbrdf_material_init(&material);
    hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = 1, .materials = &material, .names = &name};
    return hnbrdf_model_create(&desc, NULL, &plain_model, NULL) ? -1 : 0;
}

static int free_plain_model(void **state)
{
    (void)state;
    hnbrdf_model_free(plain_model);
    return 0;
}

/* ---- Sources --------------------------------------------------------------------------------- */

typedef enum trouble {
    NONE,
    DARK_CHANNEL, /* green 1e-6 */
    ZERO_CHANNEL, /* blue 0 */
    CONSTANT,     /* 0.3 */
    BLACK,        /* 0 */
    OUTLIERS,     /* one pair in 1000 is the largest value there is */
    INFINITE,     /* one in 100 is infinite in red */
    NOT_A_NUMBER, /* one in 10 is NaN in one channel */
    NEGATIVE,     /* one in 3 is -5 */
    GAPS,         /* 49 in 50 have no value */
    HARDLY_ANY,   /* 249 in 250 have none */
    ONLY_NAN,     /* all NaN */
    NO_VALUE,     /* none */
    HUGE_VALUES,  /* all times 1e20 */
    TINY_VALUES,  /* all times 1e-6 */
    GAUSSIAN_PEAK /* 0.01 and a peak of 1e6, exp(-(tan th/1e-3)^2), which GGX has not */
} trouble;

typedef struct source {
    trouble trouble;
    hnbrdf_material material;
} source;

/* A number that depends on the pair of directions alone. */
static unsigned mixed(const float wi[3], const float wo[3])
{
    unsigned h = 2166136261u, bits;
    for (int k = 0; k < 6; k++) {
        memcpy(&bits, k < 3 ? wi + k : wo + k - 3, sizeof bits);
        h = (h ^ bits) * 16777619u;
    }
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    return h ^ h >> 12;
}

static int eval(const void *user, const float wi[3], const float wo[3], float f[3])
{
    const source *s = user;
    const unsigned h = mixed(wi, wo);
    hnbrdf_eval_analytic(plain_model, &s->material, wi, wo, f);
    switch (s->trouble) {
    case NONE:
        break;
    case DARK_CHANNEL:
        f[1] = 1e-6f;
        break;
    case ZERO_CHANNEL:
        f[2] = 0.0f;
        break;
    case CONSTANT:
        f[0] = f[1] = f[2] = 0.3f;
        break;
    case BLACK:
        f[0] = f[1] = f[2] = 0.0f;
        break;
    case OUTLIERS:
        if (h % 1000 == 0)
            f[0] = f[1] = f[2] = HNBRDF_MAX_VALUE;
        break;
    case INFINITE:
        if (h % 100 == 0)
            f[0] = INFINITY;
        break;
    case NOT_A_NUMBER:
        if (h % 10 == 0)
            f[h / 10 % 3] = NAN;
        break;
    case NEGATIVE:
        if (h % 3 == 0)
            f[0] = f[1] = f[2] = -5.0f;
        break;
    case GAPS:
        return h % 50 == 0;
    case HARDLY_ANY:
        return h % 250 == 0;
    case ONLY_NAN:
        f[0] = f[1] = f[2] = NAN;
        break;
    case NO_VALUE:
        return 0;
    case HUGE_VALUES:
    case TINY_VALUES:
        for (int c = 0; c < 3; c++)
            f[c] *= s->trouble == HUGE_VALUES ? 1e20f : 1e-6f;
        break;
    case GAUSSIAN_PEAK: {
        float x = wi[0] + wo[0], y = wi[1] + wo[1], z = wi[2] + wo[2];
        f[0] = f[1] = f[2] = 0.01f + 1e6f * expf(-(x * x + y * y) / (z * z) * 1e6f);
        break;
    }
    }
    return 1;
}

static source make_source(trouble kind, float alpha, float kd, float eta)
{
    source s;
    s.trouble = kind;
    hnbrdf_material_init(&s.material);
    s.material.alpha[0] = s.material.alpha[1] = alpha;
    for (int c = 0; c < 3; c++) {
        s.material.kd[c] = kd;
        s.material.eta[c] = eta;
    }
    return s;
}

static hnbrdf_measured *measured_of(source *s, const char *name)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_measured_custom custom = {.name = name, .isotropic = 1, .eval = eval, .user = s};
    assert_int_equal(hnbrdf_measured_create_custom(&custom, &measured, NULL), HNBRDF_OK);
    return measured;
}

/* ---- Fits ------------------------------------------------------------------------------------ */

static hnbrdf_fit_options small(hnbrdf_kind kind)
{
    hnbrdf_fit_options o = {0};
    o.kind = kind;
    o.hidden = 16;
    o.steps = 600;
    o.pool = 4096;
    o.batch = 1024;
    o.seed = 3;
    o.threads = 2;
    return o;
}

static void expect_sound(const hnbrdf_model *model)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    for (int m = 0; m < desc.material_count; m++) {
        assert_int_equal(hnbrdf_material_check(&desc.materials[m], NULL), HNBRDF_OK);
        for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
            assert_true(isfinite(desc.materials[m].latent[i]));
    }
    for (int k = 0; desc.kind != HNBRDF_KIND_GGX && k <= desc.layers; k++) {
        int rows = k < desc.layers ? desc.hidden : desc.kind == HNBRDF_KIND_HYBRID ? 6 : 3;
        int columns = k ? desc.hidden : 6 + desc.latent;
        for (int i = 0; i < rows * columns; i++)
            assert_true(isfinite(desc.weights[k][i]));
        for (int i = 0; i < rows; i++)
            assert_true(isfinite(desc.biases[k][i]));
    }
}

typedef struct outcome {
    hnbrdf_fit_drawn drawn;
    hnbrdf_fit_report report;
    hnbrdf_material material;
    double smape, mae;
} outcome;

/* Fits s and compares with `truth`, which may be s itself. */
static outcome fit_source(source *s, source *truth, const hnbrdf_fit_options *options)
{
    outcome result;
    hnbrdf_fit_options o = *options;
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    hnbrdf_comparison c;
    hnbrdf_measured *measured = measured_of(s, "hard"), *true_one = measured_of(truth, "true");
    const hnbrdf_measured *const data = measured;
    o.drawn = &result.drawn;
    if (hnbrdf_fit(&data, 1, &o, &model, &result.report, &error))
        fail_msg("%s", error.text);
    expect_sound(model);
    result.material = *hnbrdf_model_material(model, 0);
    assert_int_equal(
        hnbrdf_compare(model, &result.material, true_one, HNBRDF_SAMPLER_GRID, 10000, 9, &c, NULL),
        HNBRDF_OK);
    result.smape = c.smape;
    result.mae = c.mae;
    if (o.kind != HNBRDF_KIND_GGX) {
        assert_true(isfinite(result.report.final_loss) && isfinite(result.report.best_loss));
        if (o.kind == HNBRDF_KIND_HYBRID && !o.freeze)
            assert_true(result.report.best_loss <= 1.05 * result.report.ggx_loss + 1e-3);
    }
    print_message("trouble %d kind %d: loss %.4f SMAPE %.4f, MAE %.3g, alpha %.5f, drawn %.3f dark "
                  "%.2f cut %.4f\n",
                  (int)s->trouble, (int)o.kind, result.report.best_loss, result.smape, result.mae,
                  (double)result.material.alpha[0], result.drawn.valid, result.drawn.dark,
                  result.drawn.cut);
    hnbrdf_model_free(model);
    hnbrdf_measured_close(measured);
    hnbrdf_measured_close(true_one);
    return result;
}

static void fit_all_kinds(source *s, source *truth, double ggx, double hybrid, double neural)
{
    const double most[] = {hybrid, neural, ggx}; /* by hnbrdf_kind */
    for (int kind = 0; kind < 3; kind++) {
        hnbrdf_fit_options o = small((hnbrdf_kind)kind);
        o.latent_none = kind != HNBRDF_KIND_HYBRID;
        outcome r = fit_source(s, truth, &o);
        assert_true(r.smape <= most[kind]);
    }
}

/* ---- What converges -------------------------------------------------------------------------- */

/* The last steps of the GGX fit move ln alpha, kd and ln(eta - 1) by 0.03 * 0.02 = 6e-4 each, which
 * moves f by at most 3, 1/kd and 2 times that: under 5e-3 in all for kd 0.5; kd 0.01 is searched
 * more finely, see the results. */
#define GGX_BOUND 5e-3
/* A hybrid keeps that or leaves it by at most 5 % and 1e-3, judged by other pairs: */
#define HYBRID_BOUND 1e-2

/* Peaks of 1e4 to 1e8 1/sr in a thousandth of the directions. The neural model has to find the peak
 * alone, in 600 steps; 0.2 is what a mirror may cost it, a tenth of the worst.
 *
 * The Gaussian peak leaves the ground of 0.01 below tan th = 4.3e-3, 5.2 % of the grid sampler's
 * pairs. To ignore it costs a SMAPE of 0.105 there; as training sees it, half of the pairs being
 * uniform, a loss of 0.026 (0.7 * 2 + 0.3 * 12), the last the mean logarithm. GGX, whose tail is
 * another, must not cost more: 0.13 in all, if all were SMAPE 0.13/0.7, twice that on the grid. A
 * network is held to twice 0.105. */
static void mirrors_are_found(void **state)
{
    (void)state;
    static const float alphas[] = {2e-4f, HNBRDF_MIN_ALPHA};
    for (int k = 0; k < 2; k++) {
        source s = make_source(NONE, alphas[k], 0.05f, 8.0f);
        hnbrdf_fit_options o = small(HNBRDF_KIND_GGX);
        outcome r = fit_source(&s, &s, &o);
        assert_true(r.smape <= 2 * GGX_BOUND);
        assert_true(fabsf(r.material.alpha[0] / alphas[k] - 1.0f) < 0.01f);
    }
    source s = make_source(NONE, 1e-3f, 0.05f, 8.0f);
    fit_all_kinds(&s, &s, 2 * GGX_BOUND, 2 * HYBRID_BOUND, 0.2);
    s = make_source(GAUSSIAN_PEAK, 0.5f, 0.5f, 1.5f);
    fit_all_kinds(&s, &s, 0.37, 0.21, 0.21);
}

static void zero_black_and_constant_data_converge(void **state)
{
    (void)state;
    source s = make_source(CONSTANT, 0.2f, 0.5f, 1.5f);
    fit_all_kinds(&s, &s, GGX_BOUND, HYBRID_BOUND, 0.02);
    /* GGX has eta >= 1.001 and so is never black: a third of the worst, 2; the network is exactly 0
     * there. */
    s.trouble = ZERO_CHANNEL;
    fit_all_kinds(&s, &s, 2.0 / 3.0 + GGX_BOUND, HYBRID_BOUND, 0.05);
    s.trouble = BLACK;
    fit_all_kinds(&s, &s, 2.0, 0.0, 0.0);
}

/* Values below the offsets of the losses are matched to about 1e-4. With a mean of 2 |f - t|/(f +
 * t + 1e-4) of at most 0.1, all of it from the dark channel, that channel is off by 1.5e-5 on
 * average. */
static void what_is_nearly_black_is_matched_to_1e_4(void **state)
{
    (void)state;
    source s = make_source(DARK_CHANNEL, 0.2f, 0.5f, 1.5f);
    for (int kind = 0; kind < 2; kind++) {
        hnbrdf_fit_options o = small((hnbrdf_kind)kind);
        o.latent_none = 1;
        outcome r = fit_source(&s, &s, &o);
        assert_true(r.report.best_loss <= 0.1);
        assert_true(fabs(r.drawn.dark - 1.0 / 3.0) < 1e-6 && r.drawn.cut == 0.0);
    }
    s.trouble = TINY_VALUES;
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    outcome r = fit_source(&s, &s, &o);
    assert_true(r.drawn.dark > 0.99 && r.drawn.largest < 1e-3); /* by which the caller knows */
}

/* Wild samples hardly pull: the fit is that of the good ones, which it is compared with. */
static void wild_samples_do_not_pull(void **state)
{
    (void)state;
    static const trouble troubles[] = {OUTLIERS, INFINITE, NOT_A_NUMBER, GAPS};
    static const double valid[] = {1.0, 0.99, 0.9, 0.02}; /* of 4096: 3 deviations, 1.5 % */
    source truth = make_source(NONE, 0.2f, 0.5f, 1.5f);
    for (int k = 0; k < 4; k++) {
        source s = truth;
        s.trouble = troubles[k];
        hnbrdf_fit_options o = small(HNBRDF_KIND_GGX);
        outcome r = fit_source(&s, &truth, &o);
        assert_true(r.smape <= GGX_BOUND);
        assert_true(fabs(r.drawn.valid - valid[k]) < 0.015);
        /* one of 8 candidates of a bright pair is enough: 0.25 0.008 + 0.75 0.001 = 0.0027, and
         * three deviations */
        assert_true(s.trouble == OUTLIERS ? r.drawn.cut > 0.0 && r.drawn.cut < 0.0052
                                          : r.drawn.cut == 0.0);
    }
    source s = truth;
    s.trouble = OUTLIERS;
    fit_all_kinds(&s, &truth, GGX_BOUND, HYBRID_BOUND, 0.1);
    /* A negative third is black: SMAPE's best answer is the median, so the lobe of the two thirds
     * stays, at the cost of 2 for each third. */
    s.trouble = NEGATIVE;
    hnbrdf_fit_options o = small(HNBRDF_KIND_GGX);
    outcome r = fit_source(&s, &truth, &o);
    assert_true(r.smape <= GGX_BOUND);
}

/* More than 1e15 1/sr everywhere: cut there and said; nothing overflows. */
static void values_beyond_any_brdf_are_cut_and_told(void **state)
{
    (void)state;
    source s = make_source(HUGE_VALUES, 0.2f, 0.5f, 1.5f);
    for (int kind = 0; kind < 3; kind++) {
        hnbrdf_fit_options o = small((hnbrdf_kind)kind);
        outcome r = fit_source(&s, &s, &o);
        assert_true(r.drawn.cut == 1.0 && r.drawn.largest > 1e18);
    }
}

/* ---- What is refused, and several at once ---------------------------------------------------- */

static void too_few_samples_are_refused_by_name_and_share(void **state)
{
    (void)state;
    static const trouble troubles[] = {HARDLY_ANY, ONLY_NAN, NO_VALUE};
    static const char *const shares[] = {"lost: 0.", "lost: 0 %", "lost: 0 %"};
    source good = make_source(NONE, 0.2f, 0.5f, 1.5f);
    hnbrdf_measured *fine = measured_of(&good, "fine");
    for (int k = 0; k < 3; k++) {
        source s = make_source(troubles[k], 0.2f, 0.5f, 1.5f);
        hnbrdf_measured *lost = measured_of(&s, "lost"), *gone = measured_of(&s, "gone");
        for (int kind = 0; kind < 3; kind++) {
            const hnbrdf_measured *const data[] = {fine, lost, gone};
            hnbrdf_fit_options o = small((hnbrdf_kind)kind);
            hnbrdf_model *model = NULL;
            hnbrdf_error error = {""};
            o.pool = 256;
            assert_int_equal(hnbrdf_fit(data, 3, &o, &model, NULL, &error), HNBRDF_ERROR_FORMAT);
            assert_null(model);
            assert_non_null(strstr(error.text, shares[k]));
            assert_non_null(strstr(error.text, "at least 1 %; so it is with 1 other material"));
        }
        hnbrdf_measured_close(lost);
        hnbrdf_measured_close(gone);
    }
    hnbrdf_measured_close(fine);
}

/* Two of the same name would be refused when the model is made, after training: they are before. */
static void names_and_missing_materials_are_checked_before_training(void **state)
{
    (void)state;
    source s = make_source(NONE, 0.2f, 0.5f, 1.5f);
    hnbrdf_measured *one = measured_of(&s, "same"), *two = measured_of(&s, "same");
    const hnbrdf_measured *const twins[] = {one, two}, *const hole[] = {one, NULL};
    hnbrdf_fit_options o = small(HNBRDF_KIND_HYBRID);
    hnbrdf_model *model = NULL;
    hnbrdf_fit_report report = {.seconds = -1.0};
    hnbrdf_error error = {""};
    o.steps = 1000000000; /* would not end */
    assert_int_equal(hnbrdf_fit(twins, 2, &o, &model, &report, &error), HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "same"));
    assert_int_equal(hnbrdf_fit(hole, 2, &o, &model, &report, &error), HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "material 1 of 2"));
    assert_int_equal(hnbrdf_fit(NULL, 2, &o, &model, &report, &error), HNBRDF_ERROR_ARGUMENT);
    assert_null(model);
    assert_true(report.seconds == -1.0);
    hnbrdf_measured_close(one);
    hnbrdf_measured_close(two);
}

/* Two identical materials beside hard ones share a network with them; both come out alike, though
 * their pairs and first codes are different: within 0.05, a fifth of what GGX data cost so small
 * a network in so few steps. */
static void identical_and_hard_materials_share_a_network(void **state)
{
    (void)state;
    static const char *const names[] = {"one", "two", "black", "mirror", "wild", "constant"};
    source sources[] = {
        make_source(NONE, 0.2f, 0.5f, 1.5f),     make_source(NONE, 0.2f, 0.5f, 1.5f),
        make_source(BLACK, 0.2f, 0.5f, 1.5f),    make_source(NONE, 1e-3f, 0.05f, 8.0f),
        make_source(OUTLIERS, 0.2f, 0.5f, 1.5f), make_source(CONSTANT, 0.2f, 0.5f, 1.5f)};
    enum { COUNT = sizeof sources / sizeof sources[0] };
    static const int latents[] = {0, 16};
    hnbrdf_measured *data[COUNT];
    for (int m = 0; m < COUNT; m++)
        data[m] = measured_of(&sources[m], names[m]);
    for (int kind = 0; kind < 2; kind++)
        for (int l = 0; l < 2; l++) {
            hnbrdf_fit_options o = small((hnbrdf_kind)kind);
            hnbrdf_model *model = NULL, *more = NULL;
            hnbrdf_error error;
            hnbrdf_comparison c[2];
            o.latent = latents[l];
            o.latent_none = latents[l] == 0;
            o.analytic = l == 1 ? HNBRDF_FIT_JOINT : HNBRDF_FIT_FAITHFUL;
            assert_int_equal(
                hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, &o, &model, NULL, &error),
                HNBRDF_OK);
            expect_sound(model);
            for (int m = 0; m < 2; m++)
                assert_int_equal(hnbrdf_compare(model, hnbrdf_model_material(model, m), data[m],
                                                HNBRDF_SAMPLER_GRID, 5000, 9, &c[m], NULL),
                                 HNBRDF_OK);
            print_message("kind %d latent %d: %.4f %.4f\n", kind, o.latent, c[0].smape, c[1].smape);
            assert_true(fabs(c[0].smape - c[1].smape) < 0.05);
            /* And the hard ones again, alone on the network that they shaped. */
            hnbrdf_fit_options frozen = {
                .freeze = model, .steps = 60, .pool = 2048, .analytic = o.analytic};
            assert_int_equal(hnbrdf_fit((const hnbrdf_measured *const *)data + 2, 3, &frozen, &more,
                                        NULL, &error),
                             HNBRDF_OK);
            expect_sound(more);
            assert_int_equal(hnbrdf_model_material_count(more), COUNT);
            hnbrdf_model_free(more);
            hnbrdf_model_free(model);
        }
    for (int m = 0; m < COUNT; m++)
        hnbrdf_measured_close(data[m]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrors_are_found),
        cmocka_unit_test(zero_black_and_constant_data_converge),
        cmocka_unit_test(what_is_nearly_black_is_matched_to_1e_4),
        cmocka_unit_test(wild_samples_do_not_pull),
        cmocka_unit_test(values_beyond_any_brdf_are_cut_and_told),
        cmocka_unit_test(too_few_samples_are_refused_by_name_and_share),
        cmocka_unit_test(names_and_missing_materials_are_checked_before_training),
        cmocka_unit_test(identical_and_hard_materials_share_a_network),
    };
    return cmocka_run_group_tests(tests, make_plain_model, free_plain_model);
}
