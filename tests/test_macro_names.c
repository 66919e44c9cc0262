/* test_macro_names.c: what materials are called in GLSL, whatever their names and their order. */
#include "core_support.h"

#include "base/hash.h"
#include "glsl/macro_names.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 12 };
typedef char material_name[HNBRDF_MAX_NAME + 1];

static hnbrdf_model *model_of(const char *const *names, int count)
{
    hnbrdf_material materials[MOST];
    for (int m = 0; m < count; m++)
        hnbrdf_material_init(&materials[m]);
    const hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = count, .materials = materials, .names = names};
    hnbrdf_model *model = NULL;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    return model;
}

/* The macros of all of these. */
static void macros_of(const char *const *names, int count, hnbrdf_macro_name *macros)
{
    hnbrdf_model *model = model_of(names, count);
    assert_int_equal(hnbrdf_macro_names(model, NULL, count, macros, NULL), HNBRDF_OK);
    hnbrdf_model_free(model);
}

static void assert_macro(const char *const *names, int count, int k, const char *expected)
{
    hnbrdf_macro_name macros[MOST];
    macros_of(names, count, macros);
    assert_string_equal(macros[k], expected);
}

/* A part of an identifier, without what GLSL reserves. */
static void assert_identifier(const char *macro)
{
    const size_t length = strlen(macro);
    assert_int_equal(strspn(macro, "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_"), length);
    assert_true(length > 0 && macro[0] != '_' && macro[length - 1] != '_');
    assert_null(strstr(macro, "__"));
}

/* ---- Single names ---------------------------------------------------------------------------- */

static void a_name_alone_keeps_its_letters_and_digits(void **state)
{
    (void)state;
    static const char *const cases[][2] = {{"gold paint", "GOLD_PAINT"},
                                           {"__a--b__", "A_B"},
                                           {"7up", "7UP"}, /* HNBRDF_MATERIAL_ comes before it */
                                           {"float", "FLOAT"},
                                           {"gl_FragColor", "GL_FRAGCOLOR"},
                                           {"na\xc3\xafve", "NA_VE"},
                                           {"\xe9\x87\x91", "X"},
                                           {"-", "X"},
                                           {"...", "X"},
                                           {"counts", "COUNTS"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_macro(&cases[i][0], 1, 0, cases[i][1]);
}

static void the_longest_names_fit(void **state)
{
    (void)state;
    material_name a, b;
    memset(a, 'a', HNBRDF_MAX_NAME);
    a[HNBRDF_MAX_NAME] = '\0';
    strcpy(b, a);
    b[5] = 'A';
    const char *names[] = {a, b};
    hnbrdf_macro_name macros[2];
    macros_of(names, 2, macros);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(strlen(macros[k]), HNBRDF_MAX_NAME + 9);
        assert_identifier(macros[k]);
    }
    assert_string_not_equal(macros[0], macros[1]);
}

/* ---- Names that come to the same ------------------------------------------------------------- */

static void a_plain_name_keeps_its_macro(void **state)
{
    (void)state;
    static const char *const names[] = {"a-b", "a_b_13", "a_b", "a b"};
    hnbrdf_macro_name macros[4];
    macros_of(names, 4, macros);
    assert_string_equal(macros[1], "A_B_13");
    assert_string_equal(macros[2], "A_B");
    assert_string_equal(macros[0], "A_B_2A89DF63"); /* as glsl.h says */
    assert_memory_equal(macros[3], "A_B_", 4);
    assert_int_equal(strlen(macros[3]), strlen("A_B_01234567"));
}

/* Whoever wrote A_B for one of these must not get the other: better no such macro at all. */
static void of_equals_none_keeps_it(void **state)
{
    (void)state;
    static const char *const mixed[] = {"a-b", "a b"}, *const plain[] = {"a_b", "A_b"};
    hnbrdf_macro_name macros[2];
    for (int k = 0; k < 2; k++) {
        macros_of(k ? plain : mixed, 2, macros);
        assert_int_equal(strlen(macros[0]), strlen("A_B_01234567"));
        assert_int_equal(strlen(macros[1]), strlen("A_B_01234567"));
        assert_string_not_equal(macros[0], macros[1]);
    }
}

static void a_material_never_takes_the_name_of_the_count(void **state)
{
    (void)state;
    static const char *const names[] = {"count"};
    hnbrdf_macro_name macro;
    macros_of(names, 1, &macro);
    assert_memory_equal(macro, "COUNT_", 6);
}

static void a_plain_name_that_looks_like_a_hash_keeps_its_macro(void **state)
{
    (void)state;
    static const char *const pair[] = {"a-b", "a b"};
    hnbrdf_macro_name macros[4], first;
    macros_of(pair, 2, macros);
    memcpy(first, macros[0], sizeof first);
    hnbrdf_macro_name second;
    snprintf(second, sizeof second, "%.20s_2", first);
    const char *const names[] = {"a-b", "a b", first, second};
    macros_of(names, 4, macros);
    assert_string_equal(macros[2], first);
    assert_string_equal(macros[3], second);
    assert_int_equal(strlen(macros[0]), strlen(first) + 2);
    assert_string_equal(macros[0] + strlen(first), "_3");
}

/* ---- Equal hashes ---------------------------------------------------------------------------- */

enum { TRIED = 200000, MARKS = 9 };

typedef struct hashed {
    uint32_t hash;
    int number;
} hashed;

static int compare_hashed(const void *a, const void *b)
{
    const hashed *x = a, *y = b;
    return x->hash != y->hash ? (x->hash > y->hash) - (x->hash < y->hash)
                              : (x->number > y->number) - (x->number < y->number);
}

/* A, nine marks that spell the number, B. */
static void spell(int number, material_name name)
{
    static const char marks[] = "-+.,:;!?";
    name[0] = 'a';
    for (int i = 0; i < MARKS; i++)
        name[1 + i] = marks[(number >> 3 * i) & 7];
    name[1 + MARKS] = 'b';
    name[2 + MARKS] = '\0';
}

/* Of 200,000 names about TRIED^2/2^33 = 4.7 pairs have the same hash. */
static void equal_hashes_are_told_apart_in_every_order(void **state)
{
    (void)state;
    rng r = rng_make(5);
    hashed *all = malloc(TRIED * sizeof *all);
    assert_non_null(all);
    for (int k = 0; k < TRIED; k++) {
        material_name name;
        const int number = (int)(rng_u32(&r) & ((1u << 3 * MARKS) - 1));
        spell(number, name);
        all[k] = (hashed){hnbrdf_hash32(HNBRDF_HASH32_START, name, strlen(name)), number};
    }
    qsort(all, TRIED, sizeof *all, compare_hashed);
    int at = 1;
    while (at < TRIED && (all[at].hash != all[at - 1].hash || all[at].number == all[at - 1].number))
        at++;
    assert_true(at < TRIED);
    material_name a, b;
    spell(all[at - 1].number, a);
    spell(all[at].number, b);
    free(all);
    hnbrdf_macro_name one[2], other[2];
    macros_of((const char *const[]){a, b}, 2, one);
    macros_of((const char *const[]){b, a}, 2, other);
    assert_string_not_equal(one[0], one[1]);
    assert_memory_equal(one[0], one[1], strlen("A_B_01234567"));
    assert_string_equal(one[0], other[1]);
    assert_string_equal(one[1], other[0]);
}

/* ---- Any names in any order ------------------------------------------------------------------ */

/* Short names of few letters, so that most sets hold some that come to the same. */
static void draw_name(rng *r, material_name name)
{
    static const char *const letters[] = {"a", "A", "b", "_", "-", " ", "1", "\xc3\xa9", "count"};
    const int length = 1 + (int)(rng_u32(r) % 4);
    name[0] = '\0';
    for (int i = 0; i < length; i++)
        strcat(name, letters[rng_u32(r) % 9]);
}

static int draw_names(rng *r, material_name *names)
{
    const int count = 1 + (int)(rng_u32(r) % MOST);
    for (int k = 0; k < count; k++) {
        int same;
        do {
            draw_name(r, names[k]);
            same = 0;
            for (int i = 0; i < k; i++)
                same |= strcmp(names[i], names[k]) == 0;
        } while (same);
    }
    return count;
}

static void shuffle(rng *r, int *order, int count)
{
    for (int k = 0; k < count; k++) {
        const int other = k + (int)(rng_u32(r) % (unsigned)(count - k)), kept = order[k];
        order[k] = order[other];
        order[other] = kept;
    }
}

static void assert_distinct(hnbrdf_macro_name *macros, int count)
{
    for (int k = 0; k < count; k++) {
        assert_identifier(macros[k]);
        assert_string_not_equal(macros[k], "COUNT");
        for (int i = 0; i < k; i++)
            assert_string_not_equal(macros[i], macros[k]);
    }
}

/* Where no two names come to the same, each is called what it is called alone. */
static void assert_as_alone(const char *const *names, hnbrdf_macro_name *macros, int count)
{
    hnbrdf_macro_name alone[MOST];
    for (int k = 0; k < count; k++)
        macros_of(&names[k], 1, &alone[k]);
    for (int k = 0; k < count; k++) {
        int rivals = 0;
        for (int i = 0; i < count; i++)
            rivals += i != k && strcmp(alone[i], alone[k]) == 0;
        if (rivals == 0)
            assert_string_equal(macros[k], alone[k]);
    }
}

static void macros_are_distinct_and_the_same_in_every_order(void **state)
{
    (void)state;
    rng r = rng_make(11);
    for (int set = 0; set < 3000; set++) {
        material_name texts[MOST];
        const char *names[MOST], *moved[MOST];
        hnbrdf_macro_name macros[MOST], again[MOST];
        int order[MOST];
        const int count = draw_names(&r, texts);
        for (int k = 0; k < count; k++) {
            names[k] = texts[k];
            order[k] = k;
        }
        macros_of(names, count, macros);
        assert_distinct(macros, count);
        assert_as_alone(names, macros, count);
        for (int turn = 0; turn < 3; turn++) {
            shuffle(&r, order, count);
            for (int k = 0; k < count; k++)
                moved[k] = names[order[k]];
            macros_of(moved, count, again);
            for (int k = 0; k < count; k++)
                assert_string_equal(again[k], macros[order[k]]);
        }
    }
}

/* ---- Scenes ---------------------------------------------------------------------------------- */

static void a_part_of_the_model_has_the_macros_of_the_whole(void **state)
{
    (void)state;
    static const char *const names[] = {"a b", "velvet", "a-b", "a_b"};
    hnbrdf_model *model = model_of(names, 4);
    hnbrdf_macro_name all[4], one;
    assert_int_equal(hnbrdf_macro_names(model, NULL, 4, all, NULL), HNBRDF_OK);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(hnbrdf_macro_names(model, &k, 1, &one, NULL), HNBRDF_OK);
        assert_string_equal(one, all[k]);
    }
    hnbrdf_model_free(model);
}

/* "a" once more in place 1 would be A_1, which is another's; then that one more in place 4. */
static void a_material_that_is_listed_again_gets_another(void **state)
{
    (void)state;
    static const char *const names[] = {"a", "a_1", "a_1_2"};
    static const int indices[] = {0, 0, 1, 2, 1, 0};
    hnbrdf_model *model = model_of(names, 3);
    hnbrdf_macro_name macros[6];
    assert_int_equal(hnbrdf_macro_names(model, indices, 6, macros, NULL), HNBRDF_OK);
    assert_distinct(macros, 6);
    assert_string_equal(macros[0], "A");
    assert_string_equal(macros[2], "A_1");
    assert_string_equal(macros[3], "A_1_2");
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_name_alone_keeps_its_letters_and_digits),
        cmocka_unit_test(the_longest_names_fit),
        cmocka_unit_test(a_plain_name_keeps_its_macro),
        cmocka_unit_test(of_equals_none_keeps_it),
        cmocka_unit_test(a_material_never_takes_the_name_of_the_count),
        cmocka_unit_test(a_plain_name_that_looks_like_a_hash_keeps_its_macro),
        cmocka_unit_test(equal_hashes_are_told_apart_in_every_order),
        cmocka_unit_test(macros_are_distinct_and_the_same_in_every_order),
        cmocka_unit_test(a_part_of_the_model_has_the_macros_of_the_whole),
        cmocka_unit_test(a_material_that_is_listed_again_gets_another),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
