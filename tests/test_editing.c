/* test_editing.c: the figures of `report editing` are those that one gets by hand: edits made on
 * fields, errors summed over directions of one's own, albedos of mixtures. */
#include "hnbrdf/metrics.h"
#include "hnbrdf/edit.h"
#include "report/editing.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int family_of(const char *name)
{
    int f = 0;
    while (hnbrdf_family_name(f) && strcmp(hnbrdf_family_name(f), name) != 0)
        f++;
    assert_non_null(hnbrdf_family_name(f));
    return f;
}

static int edit_of(editing_kind kind, double factor)
{
    for (int e = 0; e < editing_edit_count; e++)
        if (editing_edits[e].kind == kind && fabs(editing_edits[e].factor - factor) < 1e-9)
            return e;
    fail_msg("no such edit");
    return -1;
}

/* ---- Edits ----------------------------------------------------------------------------------- */

static double reflectance(float eta)
{
    double r = ((double)eta - 1.0) / ((double)eta + 1.0);
    return r * r;
}

static hnbrdf_material edited(editing_kind kind, double factor, const char *family, int *stopped)
{
    hnbrdf_material m;
    hnbrdf_error error;
    hnbrdf_material_init(&m);
    if (editing_edit_material(&(editing_edit){kind, factor}, family_of(family), &m, stopped,
                              &error))
        fail_msg("%s", error.text);
    return m;
}

static void a_material_is_edited_as_it_says(void **state)
{
    int stopped;
    hnbrdf_material m;
    (void)state;
    m = edited(EDITING_ALPHA, 1.5, "plastic", &stopped);
    assert_true(m.alpha[0] == 0.75f && m.alpha[1] == 0.75f && !stopped);
    m = edited(EDITING_ALPHA, 3.0, "plastic", &stopped);
    assert_true(m.alpha[0] == 1.0f && stopped);
    m = edited(EDITING_ANISOTROPY, 2.0, "plastic", &stopped);
    assert_true(m.alpha[0] == 1.0f && m.alpha[1] == 0.25f && !stopped);
    m = edited(EDITING_ETA, 2.0, "plastic", &stopped);
    assert_true(fabs(reflectance(m.eta[1]) / reflectance(1.5f) - 2.0) < 1e-5 && !stopped);
    m = edited(EDITING_ETA, 30.0, "plastic", &stopped);
    assert_true(m.eta[1] == HNBRDF_MAX_ETA && stopped);
    m = edited(EDITING_KD, 1.5, "plastic", &stopped);
    assert_true(m.kd[0] == 0.75f && m.kd[2] == 0.75f && m.eta[0] == 1.5f);
    m = edited(EDITING_COLOUR, 1.0, "plastic", &stopped);
    assert_true(m.kd[0] < m.kd[1] && m.kd[2] == 0.5f && m.eta[0] == 1.5f);
    m = edited(EDITING_COLOUR, 1.0, "two-lobe", &stopped);
    assert_true(m.eta[0] < m.eta[1] && m.kd[0] == 0.5f);
    assert_true(fabs(reflectance(m.eta[2]) - reflectance(1.5f)) < 1e-7);
    m = edited(EDITING_ROTATION, 0.5, "brushed", &stopped);
    assert_true(m.rotation == 0.5f);
}

static void the_truth_is_edited_alike(void **state)
{
    hnbrdf_family_parameters p;
    int brushed = family_of("brushed"), plastic = family_of("plastic");
    (void)state;
    hnbrdf_family_member(brushed, 0.16, &p);
    double before[2] = {p.alpha[0], p.alpha[1]}, rotation = p.rotation;
    assert_true(editing_edit_truth(&(editing_edit){EDITING_ALPHA, 2.0}, brushed, &p));
    assert_true(p.alpha[0] == 2 * before[0] && p.alpha[1] == 2 * before[1]);
    assert_true(editing_edit_truth(&(editing_edit){EDITING_ANISOTROPY, 2.0}, brushed, &p));
    assert_true(p.alpha[0] == 4 * before[0] && p.alpha[1] == before[1]);
    assert_true(editing_edit_truth(&(editing_edit){EDITING_ROTATION, 0.5}, brushed, &p));
    assert_true(p.rotation == rotation + 0.5);
    assert_false(editing_edit_truth(&(editing_edit){EDITING_ALPHA, 4.0}, brushed, &p));
    hnbrdf_family_member(plastic, 0.16, &p);
    assert_true(editing_edit_truth(&(editing_edit){EDITING_KD, 0.5}, plastic, &p));
    assert_true(editing_edit_truth(&(editing_edit){EDITING_ETA, 2.0}, plastic, &p));
    assert_true(p.diffuse[1] == 0.5 && p.reflectance[1] == 2.0);
}

/* Every edit that makes sense gives a truth that can be opened. */
static void every_edit_of_every_family_can_be_made(void **state)
{
    int made = 0;
    (void)state;
    for (int f = 0; hnbrdf_family_name(f); f++)
        for (int e = 0; e < editing_edit_count; e++) {
            hnbrdf_family_parameters p;
            hnbrdf_measured *truth;
            hnbrdf_error error;
            hnbrdf_family_member(f, 0.08, &p);
            if (!editing_makes_sense(&editing_edits[e], f) ||
                !editing_edit_truth(&editing_edits[e], f, &p))
                continue;
            if (hnbrdf_family_open(f, &p, "truth", &truth, &error))
                fail_msg("%s, edit %d: %s", hnbrdf_family_name(f), e, error.text);
            hnbrdf_measured_close(truth);
            made++;
        }
    assert_in_range(made, 120, 200);
}

/* ---- A tiny report --------------------------------------------------------------------------- */

typedef struct fixture {
    editing_report r;
    hnbrdf_error error;
    int families[32];
} fixture;

static int begin(void **state)
{
    fixture *t = calloc(1, sizeof *t);
    assert_non_null(t);
    t->r = (editing_report){.command_line = "test",
                            .families = t->families,
                            .net = {8, 2},
                            .alone = 1,
                            .steps = 60,
                            .frozen_steps = 20,
                            .pool = 128,
                            .pairs = 20000,
                            .seed = 1,
                            .sampler = HNBRDF_SAMPLER_GRID,
                            .error = &t->error};
    t->families[family_of("plastic")] = 1;
    if (editing_begin(&t->r) || editing_measure(&t->r, 0) || editing_measure_mixtures(&t->r))
        fail_msg("%s", t->error.text);
    *state = t;
    return 0;
}

static int end(void **state)
{
    fixture *t = *state;
    editing_free(&t->r);
    free(t);
    return 0;
}

/* SMAPE over pairs of one's own; analytic: of f_a. */
static double error_by_hand(const fixture *t, const hnbrdf_material *m, int analytic,
                            const hnbrdf_family_parameters *p)
{
    enum { PAIRS = 20000 };
    const hnbrdf_model *model = t->r.models[0].model;
    hnbrdf_measured *truth;
    hnbrdf_rng rng;
    double sum = 0.0;
    assert_int_equal(hnbrdf_family_open(family_of("plastic"), p, "truth", &truth, NULL), HNBRDF_OK);
    hnbrdf_rng_seed(&rng, 99, 7);
    for (int k = 0; k < PAIRS; k++) {
        float wi[3], wo[3], f[3], reference[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &rng, wi, wo);
        hnbrdf_measured_eval(truth, wi, wo, reference);
        if (analytic)
            hnbrdf_eval_analytic(model, m, wi, wo, f);
        else
            hnbrdf_eval(model, m, wi, wo, f);
        for (int c = 0; c < 3; c++)
            sum += 2 * fabs((double)f[c] - (double)reference[c]) /
                   ((double)f[c] + (double)reference[c]);
    }
    hnbrdf_measured_close(truth);
    return sum / (3 * PAIRS);
}

/* Two draws of 20000 pairs differ by about 1 %. */
static void expect_near(double value, double expected)
{
    if (!(fabs(value / expected - 1.0) < 0.05))
        fail_msg("found %g, expected %g", value, expected);
}

static const editing_case *case_of(const fixture *t, int edit)
{
    const editing_member *m = &t->r.members[0];
    for (int k = 0; k < m->count; k++)
        if (m->cases[k].edit == edit)
            return &m->cases[k];
    fail_msg("edit %d is missing", edit);
    return NULL;
}

static void errors_are_those_found_by_hand(void **state)
{
    const fixture *t = *state;
    const editing_case *c = case_of(t, edit_of(EDITING_ALPHA, 2.0));
    hnbrdf_material original, m;
    hnbrdf_family_parameters p;
    assert_int_equal(t->r.count, 3);
    assert_string_equal(t->r.members[0].name, "plastic-0.08");
    original = *hnbrdf_model_material(t->r.models[0].model,
                                      hnbrdf_model_find(t->r.models[0].model, "plastic-0.08"));
    hnbrdf_family_member(family_of("plastic"), 0.16, &p); /* 0.08 times 2 */
    m = original;
    m.alpha[0] *= 2.0f;
    m.alpha[1] *= 2.0f;
    expect_near(c->smape[EDITING_UNEDITED], error_by_hand(t, &original, 0, &p));
    expect_near(c->smape[EDITING_EDITED], error_by_hand(t, &m, 0, &p));
    expect_near(c->smape[EDITING_GGX], error_by_hand(t, &m, 1, &p));
    expect_near(c->smape[EDITING_FROZEN], error_by_hand(t, &c->materials[EDITING_FROZEN], 0, &p));
    assert_true(c->smape[EDITING_UNEDITED] > 2 * c->smape[EDITING_GGX]);

    c = case_of(t, edit_of(EDITING_KD, 0.5));
    hnbrdf_family_member(family_of("plastic"), 0.08, &p);
    p.diffuse[0] = p.diffuse[1] = p.diffuse[2] = 0.5;
    m = original;
    for (int k = 0; k < 3; k++)
        m.kd[k] *= 0.5f;
    expect_near(c->smape[EDITING_EDITED], error_by_hand(t, &m, 0, &p));
    expect_near(c->smape[EDITING_GGX], error_by_hand(t, &m, 1, &p));

    c = case_of(t, edit_of(EDITING_ALPHA, 1.0)); /* no edit */
    assert_true(c->smape[EDITING_UNEDITED] == c->smape[EDITING_EDITED]);
    assert_memory_equal(&c->materials[EDITING_EDITED], &original, sizeof original);
}

static void mixtures_are_those_found_by_hand(void **state)
{
    const fixture *t = *state;
    const hnbrdf_model *model = t->r.models[0].model;
    const editing_pairs *set = &t->r.pair_sets[0];
    const hnbrdf_material *ends[2];
    hnbrdf_material path[HNBRDF_MIX_KNOTS], mixed;
    hnbrdf_family_parameters p;
    int within = 0;
    assert_int_equal(t->r.pair_set_count, 1);
    assert_int_equal(set->pairs, 3);
    assert_int_equal(set->mixtures, 9);
    for (int k = 0; k < set->mixtures; k++) {
        const editing_mixture *x = &set->list[k];
        double beyond = 0.0;
        for (int e = 0; e < 2; e++)
            ends[e] = hnbrdf_model_material(model, x->ends[e]);
        assert_int_equal(hnbrdf_mix_path_fit(model, ends[0], ends[1], path, NULL), HNBRDF_OK);
        hnbrdf_mix_path_at(path, (float)x->t, &mixed);
        for (int v = 0; v < 3; v++) {
            double theta = v * 3.14159265358979323846 / 6, a[3], b[3], between[3];
            const float wo[3] = {(float)sin(theta), 0.0f, (float)cos(theta)};
            hnbrdf_albedo(model, ends[0], wo, a);
            hnbrdf_albedo(model, ends[1], wo, b);
            hnbrdf_albedo(model, &mixed, wo, between);
            for (int c = 0; c < 3; c++)
                beyond = fmax(beyond,
                              fmax(between[c] / fmax(a[c], b[c]), fmin(a[c], b[c]) / between[c]));
        }
        assert_true(fabs(x->t - (k % 3 + 1) / 4.0) < 1e-12);
        /* 60 degrees is not the same number here and there. */
        assert_true(fabs(x->beyond / beyond - 1.0) < 1e-4);
        within += beyond <= 1.1;
    }
    assert_int_equal(set->within, within);

    assert_int_equal(t->r.half_count, 1);
    ends[0] = hnbrdf_model_material(model, hnbrdf_model_find(model, "plastic-0.08"));
    ends[1] = hnbrdf_model_material(model, hnbrdf_model_find(model, "plastic-0.3"));
    assert_int_equal(hnbrdf_mix_path_fit(model, ends[0], ends[1], path, NULL), HNBRDF_OK);
    hnbrdf_mix_path_at(path, 0.5f, &mixed);
    hnbrdf_family_member(family_of("plastic"), sqrt(0.08 * 0.3), &p);
    expect_near(t->r.halves[0].smape, error_by_hand(t, &mixed, 0, &p));
    expect_near(t->r.halves[0].ggx, error_by_hand(t, &mixed, 1, &p));
}

/* Families count alike, however many members were measured. */
static void means_are_over_what_was_measured(void **state)
{
    const fixture *t = *state;
    int e = edit_of(EDITING_ETA, 2.0), members;
    double smape = case_of(t, e)->smape[EDITING_EDITED];
    assert_true(editing_mean(&t->r, -1, e, EDITING_EDITED, 0, &members) == smape);
    assert_int_equal(members, 1);
    assert_true(editing_mean(&t->r, family_of("plastic"), e, EDITING_EDITED, 0, NULL) == smape);
    assert_true(isnan(editing_mean(&t->r, family_of("film"), e, EDITING_EDITED, 0, NULL)));
    assert_true(
        isnan(editing_mean(&t->r, -1, edit_of(EDITING_ROTATION, 0.5), EDITING_EDITED, 0, NULL)));
}

int main(void)
{
    const struct CMUnitTest edits[] = {
        cmocka_unit_test(a_material_is_edited_as_it_says),
        cmocka_unit_test(the_truth_is_edited_alike),
        cmocka_unit_test(every_edit_of_every_family_can_be_made),
    };
    const struct CMUnitTest report[] = {
        cmocka_unit_test(errors_are_those_found_by_hand),
        cmocka_unit_test(mixtures_are_those_found_by_hand),
        cmocka_unit_test(means_are_over_what_was_measured),
    };
    int failed = cmocka_run_group_tests(edits, NULL, NULL);
    return failed + cmocka_run_group_tests(report, begin, end);
}
