/* test_edit_materials.c: hnbrdf_model_with_materials() makes the changes it is told and no other,
 * and leaves nothing behind where it refuses; hnbrdf_material_set() likewise. */
#include "hnbrdf/edit.h"
#include "fitted_support.h"
#include "model_support.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MATERIALS = 4 };

static hnbrdf_model *start(hnbrdf_kind kind)
{
    return kind == HNBRDF_KIND_GGX ? example_model(5, kind, 0, 0, 0, MATERIALS, 0)
                                   : example_model(5, kind, 8, 2, 4, MATERIALS, 0);
}

static hnbrdf_material other_material(void)
{
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    m.alpha[0] = 0.25f;
    m.kd[1] = 0.125f;
    m.lobes.scale[0] = 2.0f;
    m.lobes.share[0][1] = 0.5f;
    return as_fitted(m);
}

static hnbrdf_model *with(const hnbrdf_model *model, const hnbrdf_material_change *changes,
                          int count)
{
    hnbrdf_model *made = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_model_with_materials(model, changes, count, NULL, &made, &error))
        fail_msg("%s", error.text);
    assert_non_null(made);
    return made;
}

static void assert_names(const hnbrdf_model *model, const char *const *names, int count)
{
    assert_int_equal(hnbrdf_model_material_count(model), count);
    for (int k = 0; k < count; k++)
        assert_string_equal(hnbrdf_model_material_name(model, k), names[k]);
}

/* All but the materials, to the bit: shape, constants, weights, biases. */
static void assert_same_network(const hnbrdf_model *a, const hnbrdf_model *b)
{
    hnbrdf_model_desc x, y;
    hnbrdf_model_describe(a, &x);
    hnbrdf_model_describe(b, &y);
    assert_int_equal(x.kind, y.kind);
    assert_int_equal(x.encoding, y.encoding);
    assert_int_equal(x.latent, y.latent);
    assert_int_equal(x.variant, y.variant);
    assert_memory_equal(&x.scale, &y.scale, 3 * sizeof(float)); /* scale, shift, floor */
    for (int k = 0; k <= x.layers && x.kind != HNBRDF_KIND_GGX; k++) {
        size_t in = (size_t)(k == 0 ? 6 + x.latent : x.hidden);
        size_t out = (size_t)(k < x.layers ? x.hidden : x.kind == HNBRDF_KIND_HYBRID ? 6 : 3);
        assert_memory_equal(x.weights[k], y.weights[k], in * out * sizeof(float));
        assert_memory_equal(x.biases[k], y.biases[k], out * sizeof(float));
    }
}

/* Material `of` of model b is material `index` of a, to the bit. */
static void assert_kept(const hnbrdf_model *a, int index, const hnbrdf_model *b, int of)
{
    assert_memory_equal(hnbrdf_model_material(a, index), hnbrdf_model_material(b, of),
                        sizeof(hnbrdf_material));
}

/* ---- Each change ----------------------------------------------------------------------------- */

static void no_changes_give_a_copy(void **state)
{
    static const hnbrdf_kind kinds[] = {HNBRDF_KIND_HYBRID, HNBRDF_KIND_NEURAL, HNBRDF_KIND_GGX};
    (void)state;
    for (int k = 0; k < 3; k++) {
        hnbrdf_model *model = start(kinds[k]), *made = with(model, NULL, 0);
        assert_same_model(model, made);
        hnbrdf_model_free(model);
        hnbrdf_model_free(made);
    }
}

static void a_material_is_added_at_the_end(void **state)
{
    static const char *const names[] = {"m0", "m1", "m2", "m3", "new"};
    static const hnbrdf_change_kind kinds[] = {HNBRDF_CHANGE_ADD, HNBRDF_CHANGE_PUT};
    const hnbrdf_material m = other_material();
    (void)state;
    for (int k = 0; k < 2; k++) {
        const hnbrdf_material_change change = {.kind = kinds[k], .name = "new", .material = &m};
        hnbrdf_model *model = start(HNBRDF_KIND_HYBRID), *made = with(model, &change, 1);
        assert_names(made, names, 5);
        assert_memory_equal(hnbrdf_model_material(made, 4), &m, sizeof m);
        for (int i = 0; i < MATERIALS; i++)
            assert_kept(model, i, made, i);
        assert_same_network(model, made);
        hnbrdf_model_free(model); /* the new one needs neither it nor the caller's material */
        assert_string_equal(hnbrdf_model_material_name(made, 0), "m0");
        hnbrdf_model_free(made);
    }
}

static void a_material_is_replaced_in_its_place(void **state)
{
    static const char *const names[] = {"m0", "m1", "m2", "m3"};
    static const hnbrdf_change_kind kinds[] = {HNBRDF_CHANGE_REPLACE, HNBRDF_CHANGE_PUT};
    const hnbrdf_material m = other_material();
    (void)state;
    for (int k = 0; k < 2; k++) {
        const hnbrdf_material_change change = {.kind = kinds[k], .name = "m1", .material = &m};
        hnbrdf_model *model = start(HNBRDF_KIND_HYBRID), *made = with(model, &change, 1);
        assert_names(made, names, 4);
        assert_memory_equal(hnbrdf_model_material(made, 1), &m, sizeof m);
        assert_kept(model, 0, made, 0);
        assert_kept(model, 2, made, 2);
        assert_same_network(model, made);
        hnbrdf_model_free(model);
        hnbrdf_model_free(made);
    }
}

static void a_material_is_removed_and_others_move_up(void **state)
{
    static const char *const names[] = {"m0", "m3"};
    static const hnbrdf_material_change changes[] = {{.kind = HNBRDF_CHANGE_REMOVE, .name = "m2"},
                                                     {.kind = HNBRDF_CHANGE_REMOVE, .name = "m1"}};
    hnbrdf_model *model = start(HNBRDF_KIND_NEURAL), *made = with(model, changes, 2);
    (void)state;
    assert_names(made, names, 2);
    assert_kept(model, 0, made, 0);
    assert_kept(model, 3, made, 1);
    assert_same_network(model, made);
    hnbrdf_model_free(model);
    hnbrdf_model_free(made);
}

static void a_material_is_renamed_in_its_place(void **state)
{
    static const char *const names[] = {"m0", "gold \xc3\xa9", "m2", "m3"};
    static const hnbrdf_material_change changes[] = {
        {.kind = HNBRDF_CHANGE_RENAME, .name = "m1", .new_name = "gold \xc3\xa9"},
        {.kind = HNBRDF_CHANGE_RENAME, .name = "m2", .new_name = "m2"}};
    hnbrdf_model *model = start(HNBRDF_KIND_GGX), *made = with(model, changes, 2);
    (void)state;
    assert_names(made, names, 4);
    for (int i = 0; i < MATERIALS; i++)
        assert_kept(model, i, made, i);
    hnbrdf_model_free(model);
    hnbrdf_model_free(made);
}

static void lobes_are_kept_fitted_or_set(void **state)
{
    hnbrdf_model *model = start(HNBRDF_KIND_HYBRID);
    hnbrdf_lobes wanted[4] = {other_material().lobes};
    (void)state;
    for (int scheme = HNBRDF_LOBES_KEEP; scheme <= HNBRDF_LOBES_GUESS; scheme++) {
        const hnbrdf_material m = other_material();
        const hnbrdf_material_change changes[] = {
            {.name = "new", .material = &m, .lobes = (hnbrdf_lobes_scheme)scheme},
            {.name = "m2", .material = &m},
            {.kind = HNBRDF_CHANGE_LOBES, .name = "m2", .lobes = (hnbrdf_lobes_scheme)scheme}};
        hnbrdf_model *made = with(model, changes, 3);
        if (scheme == HNBRDF_LOBES_FIT)
            assert_int_equal(hnbrdf_lobes_fit(model, &m, &wanted[scheme], NULL), HNBRDF_OK);
        if (scheme == HNBRDF_LOBES_PAPER)
            hnbrdf_lobes_paper(&wanted[scheme]);
        assert_memory_equal(&hnbrdf_model_material(made, 4)->lobes, &wanted[scheme],
                            sizeof(hnbrdf_lobes));
        assert_memory_equal(&hnbrdf_model_material(made, 2)->lobes, &wanted[scheme],
                            sizeof(hnbrdf_lobes));
        assert_memory_equal(hnbrdf_model_material(made, 4)->kd, m.kd, sizeof m.kd);
        assert_kept(model, 1, made, 1);
        hnbrdf_model_free(made);
    }
    for (int a = 0; a < 4; a++) /* so that taking one for another is seen */
        for (int b = 0; b < a; b++)
            assert_memory_not_equal(&wanted[a], &wanted[b], sizeof(hnbrdf_lobes));
    hnbrdf_model_free(model);
}

static void the_lobes_of_all_are_set_without_a_name(void **state)
{
    static const hnbrdf_material_change change = {.kind = HNBRDF_CHANGE_LOBES,
                                                  .lobes = HNBRDF_LOBES_PAPER};
    hnbrdf_model *model = start(HNBRDF_KIND_HYBRID), *made = with(model, &change, 1);
    (void)state;
    for (int i = 0; i < MATERIALS; i++) {
        hnbrdf_material wanted = *hnbrdf_model_material(model, i);
        hnbrdf_lobes_paper(&wanted.lobes);
        assert_memory_equal(hnbrdf_model_material(made, i), &wanted, sizeof wanted);
    }
    assert_same_network(model, made);
    hnbrdf_model_free(model);
    hnbrdf_model_free(made);
}

/* ---- Several --------------------------------------------------------------------------------- */

static void changes_are_made_in_order(void **state)
{
    static const char *const names[] = {"b", "m2", "m1"};
    hnbrdf_material m = other_material(), n = m;
    n.kd[0] = 0.75f;
    const hnbrdf_material_change changes[] = {
        {.kind = HNBRDF_CHANGE_RENAME, .name = "m1", .new_name = "b"},
        {.kind = HNBRDF_CHANGE_ADD, .name = "m1", .material = &m}, /* free again */
        {.kind = HNBRDF_CHANGE_REMOVE, .name = "m0"},
        {.kind = HNBRDF_CHANGE_ADD, .name = "m0", .material = &m},
        {.kind = HNBRDF_CHANGE_REPLACE, .name = "m1", .material = &n},
        {.kind = HNBRDF_CHANGE_REMOVE, .name = "m0"},
        {.kind = HNBRDF_CHANGE_REMOVE, .name = "m3"},
    };
    hnbrdf_model *model = start(HNBRDF_KIND_HYBRID), *made = with(model, changes, 7);
    (void)state;
    assert_names(made, names, 3);
    assert_kept(model, 1, made, 0);
    assert_kept(model, 2, made, 1);
    assert_memory_equal(hnbrdf_model_material(made, 2), &n, sizeof n);
    hnbrdf_model_free(model);
    hnbrdf_model_free(made);
}

static void all_materials_may_go_when_others_come(void **state)
{
    static const char *const names[] = {"new"};
    const hnbrdf_material m = other_material();
    hnbrdf_material_change changes[MATERIALS + 1] = {{.kind = HNBRDF_CHANGE_PUT}};
    static const char *const old[] = {"m3", "m0", "m2", "m1"};
    (void)state;
    for (int k = 0; k < MATERIALS; k++)
        changes[k] = (hnbrdf_material_change){.kind = HNBRDF_CHANGE_REMOVE, .name = old[k]};
    changes[MATERIALS] = (hnbrdf_material_change){.name = "new", .material = &m};
    hnbrdf_model *model = start(HNBRDF_KIND_HYBRID), *made = with(model, changes, MATERIALS + 1);
    assert_names(made, names, 1);
    hnbrdf_model_free(model);
    hnbrdf_model_free(made);
}

/* ---- A material by a text -------------------------------------------------------------------- */

static void a_text_sets_multiplies_and_adds(void **state)
{
    hnbrdf_material m = other_material(), wanted = m;
    hnbrdf_error error = {""};
    (void)state;
    m.rotation = 1.0f;
    m.latent[3] = wanted.latent[3] = 5.0f;
    if (hnbrdf_material_set(&m,
                            "kd=0.1:0.2:0.3,eta=2,alpha=0.25:0.5,alpha_x*=2,alpha_y+=0.25,"
                            "rotation+=90deg,kd*=2,eta+=0:1:2,rotation+=0.5rad",
                            &error))
        fail_msg("%s", error.text);
    for (int c = 0; c < 3; c++) {
        wanted.kd[c] = 2.0f * (c == 0 ? 0.1f : c == 1 ? 0.2f : 0.3f);
        wanted.eta[c] = 2.0f + (float)c;
    }
    wanted.alpha[0] = 0.5f;
    wanted.alpha[1] = 0.75f;
    wanted.rotation = 1.0f + (float)(90.0 * (3.14159265358979324 / 180.0)) + 0.5f;
    assert_memory_equal(&m, &wanted, sizeof m);
}

static void a_field_goes_back_to_what_was_fitted(void **state)
{
    const hnbrdf_material fitted = other_material();
    hnbrdf_material m = fitted;
    (void)state;
    assert_int_equal(hnbrdf_material_set(&m, "alpha=0.5,kd*=0.5,eta=2,alpha_y+=0.1", NULL), 0);
    assert_int_equal(hnbrdf_material_set(&m, "alpha_x=fitted,kd=fitted", NULL), 0);
    assert_true(m.alpha[0] == fitted.alpha[0] && m.alpha[1] == 0.5f + 0.1f);
    assert_memory_equal(m.kd, fitted.kd, sizeof m.kd);
    assert_int_equal(hnbrdf_material_set(&m, "alpha=fitted,eta=fitted", NULL), 0);
    assert_memory_equal(&m, &fitted, sizeof m);
}

static void a_wrong_text_changes_nothing(void **state)
{
    static const struct {
        const char *text, *message;
    } cases[] = {{"", "'' is not FIELD=VALUE"},
                 {"kd", "'kd' is not FIELD=VALUE"},
                 {"kd=1,", "'' is not FIELD=VALUE"},
                 {"kd=1,kf=1", "no field 'kf', expected kd, eta, alpha, alpha_x, alpha_y or "
                               "rotation (did you mean kd?)"},
                 {"=1", "no field ''"},
                 {"kd=", "kd: '' is not a number"},
                 {"kd=1:", "is not a number"},
                 {"kd=1:2", "kd: found 2 values, expected 1 or 3, R:G:B"},
                 {"kd=1:2:3:4", "found 4 values"},
                 {"alpha=1:2:3", "alpha: found 3 values, expected 1 or 2, x:y"},
                 {"alpha_x=1:2", "alpha_x: found 2 values, expected 1"},
                 {"alpha=1deg", "is not a number"},
                 {"rotation*=30deg", "is not a number"},
                 {"eta=inf", "is not a number"},
                 {"eta=0x1", "is not a number"},
                 {"alpha=0.2 ", "is not a number"},
                 {"rotation=fitted", "is not a number"},
                 {"kd*=fitted", "is not a number"},
                 {"kd=fitted:1", "is not a number"},
                 {"kd=fitted", "it is not known what the material was fitted with"}};
    hnbrdf_material before = other_material();
    memset(&before.fitted, 0, sizeof before.fitted);
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        hnbrdf_material m = before;
        hnbrdf_error error = {""};
        assert_int_equal(hnbrdf_material_set(&m, cases[k].text, &error), HNBRDF_ERROR_ARGUMENT);
        if (!strstr(error.text, cases[k].message))
            fail_msg("found \"%s\", expected it to say \"%s\"", error.text, cases[k].message);
        assert_memory_equal(&m, &before, sizeof m);
    }
    hnbrdf_material m = before;
    assert_int_equal(hnbrdf_material_set(NULL, "kd=1", NULL), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_material_set(&m, NULL, NULL), HNBRDF_ERROR_ARGUMENT);
}

/* ---- Refusals -------------------------------------------------------------------------------- */

static void assert_refused(const hnbrdf_model *model, const hnbrdf_material_change *changes,
                           int count, hnbrdf_result wanted, const char *text)
{
    counting memory = {.fail_at = -1};
    const hnbrdf_edit_options options = {.allocator = counting_allocator(&memory)};
    hnbrdf_model *untouched = (hnbrdf_model *)(void *)&memory, *made = untouched;
    hnbrdf_error error = {""};
    assert_int_equal(hnbrdf_model_with_materials(model, changes, count, &options, &made, &error),
                     wanted);
    if (!strstr(error.text, text))
        fail_msg("found \"%s\", expected it to say \"%s\"", error.text, text);
    assert_ptr_equal(made, untouched);
    assert_int_equal(memory.alive, 0);
    assert_int_equal(hnbrdf_model_with_materials(model, changes, count, &options, &made, NULL),
                     wanted);
}

static void wrong_changes_are_refused(void **state)
{
    char longest[HNBRDF_MAX_NAME + 2];
    const hnbrdf_material good = other_material();
    hnbrdf_material bad = good, bad_lobes = good;
    (void)state;
    bad.kd[1] = 2.0f;
    bad_lobes.lobes.share[0][0] = 3.0f;
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    const struct {
        hnbrdf_material_change change;
        const char *text;
    } cases[] = {
        {{HNBRDF_CHANGE_REPLACE, "gold", &good, NULL, HNBRDF_LOBES_KEEP}, "no material gold"},
        {{HNBRDF_CHANGE_REMOVE, "gold", NULL, NULL, HNBRDF_LOBES_KEEP}, "no material gold"},
        {{HNBRDF_CHANGE_RENAME, "gold", NULL, "x", HNBRDF_LOBES_KEEP}, "no material gold"},
        {{HNBRDF_CHANGE_LOBES, "gold", NULL, NULL, HNBRDF_LOBES_FIT}, "no material gold"},
        {{HNBRDF_CHANGE_ADD, "m2", &good, NULL, HNBRDF_LOBES_KEEP}, "material m2 already"},
        {{HNBRDF_CHANGE_RENAME, "m1", NULL, "m2", HNBRDF_LOBES_KEEP}, "material m2 already"},
        {{HNBRDF_CHANGE_RENAME, "m1", NULL, NULL, HNBRDF_LOBES_KEEP}, "is NULL"},
        {{HNBRDF_CHANGE_RENAME, "m1", NULL, "", HNBRDF_LOBES_KEEP}, "is empty"},
        {{HNBRDF_CHANGE_RENAME, "m1", NULL, "a\nb", HNBRDF_LOBES_KEEP}, "control character"},
        {{HNBRDF_CHANGE_RENAME, "m1", NULL, "\xff", HNBRDF_LOBES_KEEP}, "UTF-8"},
        {{HNBRDF_CHANGE_ADD, longest, &good, NULL, HNBRDF_LOBES_KEEP}, "longer"},
        {{HNBRDF_CHANGE_PUT, "", &good, NULL, HNBRDF_LOBES_KEEP}, "is empty"},
        {{HNBRDF_CHANGE_ADD, NULL, &good, NULL, HNBRDF_LOBES_KEEP}, "name NULL"},
        {{HNBRDF_CHANGE_REMOVE, NULL, NULL, NULL, HNBRDF_LOBES_KEEP}, "name NULL"},
        {{HNBRDF_CHANGE_PUT, "x", NULL, NULL, HNBRDF_LOBES_KEEP}, "x: material is NULL"},
        {{HNBRDF_CHANGE_REPLACE, "m1", &bad, NULL, HNBRDF_LOBES_KEEP}, "m1: kd"},
        {{HNBRDF_CHANGE_ADD, "x", &bad_lobes, NULL, HNBRDF_LOBES_FIT}, "x: lobes"},
        {{HNBRDF_CHANGE_PUT, "x", &good, NULL, (hnbrdf_lobes_scheme)7}, "lobes is 7"},
        {{HNBRDF_CHANGE_LOBES, NULL, NULL, NULL, (hnbrdf_lobes_scheme)-1}, "lobes is -1"},
        {{(hnbrdf_change_kind)9, "m1", &good, NULL, HNBRDF_LOBES_KEEP}, "kind 9"},
        {{(hnbrdf_change_kind)-1, "m1", &good, NULL, HNBRDF_LOBES_KEEP}, "kind -1"},
    };
    hnbrdf_model *model = start(HNBRDF_KIND_HYBRID);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const hnbrdf_material_change both[] = {{.name = "before", .material = &good},
                                               cases[k].change};
        assert_refused(model, &cases[k].change, 1, HNBRDF_ERROR_ARGUMENT, cases[k].text);
        assert_refused(model, both, 2, HNBRDF_ERROR_ARGUMENT, cases[k].text);
    }
    hnbrdf_model_free(model);
}

static void a_model_without_materials_is_refused(void **state)
{
    static const hnbrdf_material_change changes[] = {{.kind = HNBRDF_CHANGE_REMOVE, .name = "m0"},
                                                     {.kind = HNBRDF_CHANGE_REMOVE, .name = "m1"},
                                                     {.kind = HNBRDF_CHANGE_REMOVE, .name = "m2"},
                                                     {.kind = HNBRDF_CHANGE_REMOVE, .name = "m3"},
                                                     {.kind = HNBRDF_CHANGE_REMOVE, .name = "m3"}};
    hnbrdf_model *model = start(HNBRDF_KIND_HYBRID);
    (void)state;
    assert_refused(model, changes, 4, HNBRDF_ERROR_ARGUMENT, "no material, expected at least one");
    assert_refused(model, changes, 5, HNBRDF_ERROR_ARGUMENT, "no material m3");
    hnbrdf_model_free(model);
}

static void wrong_arguments_are_refused(void **state)
{
    static const hnbrdf_material_change change = {.kind = HNBRDF_CHANGE_REMOVE, .name = "m0"};
    counting memory = {.fail_at = -1};
    hnbrdf_edit_options half = {.allocator = counting_allocator(&memory)};
    hnbrdf_model *model = start(HNBRDF_KIND_HYBRID), *made = NULL;
    hnbrdf_error error;
    (void)state;
    half.allocator.release = NULL;
    assert_refused(NULL, &change, 1, HNBRDF_ERROR_ARGUMENT, "model is NULL");
    assert_refused(model, NULL, 1, HNBRDF_ERROR_ARGUMENT, "changes is NULL");
    assert_refused(model, &change, -1, HNBRDF_ERROR_ARGUMENT, "count is -1");
    assert_int_equal(hnbrdf_model_with_materials(model, &change, 1, NULL, NULL, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_model_with_materials(model, &change, 1, &half, &made, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_null(made);
    hnbrdf_model_free(model);
}

static void more_materials_than_the_limit_are_refused(void **state)
{
    enum { ADDED = HNBRDF_MAX_MATERIALS - MATERIALS + 1 };
    hnbrdf_material_change *changes = calloc(ADDED, sizeof *changes);
    char(*names)[8] = calloc(ADDED, sizeof *names);
    const hnbrdf_material m = other_material();
    hnbrdf_model *model = start(HNBRDF_KIND_GGX);
    (void)state;
    assert_non_null(changes);
    assert_non_null(names);
    for (int k = 0; k < ADDED; k++) {
        snprintf(names[k], sizeof names[k], "%d", k);
        changes[k] = (hnbrdf_material_change){.name = names[k], .material = &m};
    }
    assert_refused(model, changes, ADDED, HNBRDF_ERROR_LIMIT, "65536 materials already");
    hnbrdf_model_free(model);
    free(changes);
    free(names);
}

/* ---- Memory and progress --------------------------------------------------------------------- */

static void a_failed_allocation_is_an_error_and_leaks_nothing(void **state)
{
    const hnbrdf_material m = other_material();
    const hnbrdf_material_change change = {
        .name = "new", .material = &m, .lobes = HNBRDF_LOBES_PAPER};
    hnbrdf_model *model = start(HNBRDF_KIND_HYBRID), *made = NULL;
    long fail_at = 0;
    (void)state;
    for (;; fail_at++) {
        counting memory = {.fail_at = fail_at};
        const hnbrdf_edit_options options = {.allocator = counting_allocator(&memory)};
        hnbrdf_error error = {""};
        hnbrdf_result result =
            hnbrdf_model_with_materials(model, &change, 1, &options, &made, &error);
        if (result == HNBRDF_OK) {
            assert_int_equal(memory.alive, 1); /* the model and nothing else */
            hnbrdf_model_free(made);
            assert_int_equal(memory.alive, 0);
            break;
        }
        assert_int_equal(result, HNBRDF_ERROR_MEMORY);
        assert_true(strlen(error.text) > 10);
        assert_int_equal(memory.alive, 0);
        assert_null(made);
    }
    assert_int_equal(fail_at, 2);
    hnbrdf_model_free(model);
}

typedef struct watcher {
    int calls, stop_at;
    double share;
    char last[HNBRDF_MAX_NAME + 1];
} watcher;

static int watch(void *user, double share, const char *name)
{
    watcher *w = user;
    assert_true(share > w->share && share <= 1.0);
    w->share = share;
    snprintf(w->last, sizeof w->last, "%s", name);
    return w->calls++ == w->stop_at;
}

static void progress_is_told_and_can_stop(void **state)
{
    static const hnbrdf_material_change changes[] = {
        {.kind = HNBRDF_CHANGE_REMOVE, .name = "m1"},
        {.kind = HNBRDF_CHANGE_LOBES, .lobes = HNBRDF_LOBES_GUESS}};
    hnbrdf_model *model = start(HNBRDF_KIND_HYBRID), *made = NULL;
    hnbrdf_error error;
    (void)state;
    for (int stop_at = 0; stop_at <= 4; stop_at++) {
        watcher w = {.stop_at = stop_at};
        const hnbrdf_edit_options options = {.progress = watch, .progress_user = &w};
        hnbrdf_result result =
            hnbrdf_model_with_materials(model, changes, 2, &options, &made, &error);
        assert_int_equal(result, stop_at < 4 ? HNBRDF_ERROR_CANCELLED : HNBRDF_OK);
        assert_int_equal(w.calls, stop_at < 4 ? stop_at + 1 : 4);
        if (stop_at == 0)
            assert_string_equal(w.last, "m1");
        if (stop_at < 4)
            assert_null(made);
        else
            assert_true(w.share == 1.0);
    }
    hnbrdf_model_free(made);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_changes_give_a_copy),
        cmocka_unit_test(a_material_is_added_at_the_end),
        cmocka_unit_test(a_material_is_replaced_in_its_place),
        cmocka_unit_test(a_material_is_removed_and_others_move_up),
        cmocka_unit_test(a_material_is_renamed_in_its_place),
        cmocka_unit_test(lobes_are_kept_fitted_or_set),
        cmocka_unit_test(the_lobes_of_all_are_set_without_a_name),
        cmocka_unit_test(changes_are_made_in_order),
        cmocka_unit_test(all_materials_may_go_when_others_come),
        cmocka_unit_test(a_text_sets_multiplies_and_adds),
        cmocka_unit_test(a_field_goes_back_to_what_was_fitted),
        cmocka_unit_test(a_wrong_text_changes_nothing),
        cmocka_unit_test(wrong_changes_are_refused),
        cmocka_unit_test(a_model_without_materials_is_refused),
        cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(more_materials_than_the_limit_are_refused),
        cmocka_unit_test(a_failed_allocation_is_an_error_and_leaks_nothing),
        cmocka_unit_test(progress_is_told_and_can_stop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
