/* test_model_create.c: a model holds what its description says, and every wrong description is
 * refused with a message and nothing made. */
#include "model_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A valid 4x2 hybrid with two materials, to be spoiled. */
typedef struct sample {
    float numbers[256];
    hnbrdf_material materials[2];
    const char *names[2];
    hnbrdf_model_desc desc;
} sample;

static void make_sample(sample *s)
{
    memset(s, 0, sizeof *s);
    for (int i = 0; i < 256; i++)
        s->numbers[i] = (float)i / 16;
    hnbrdf_material_init(&s->materials[0]);
    hnbrdf_material_init(&s->materials[1]);
    s->materials[1].latent[1] = 3;
    s->names[0] = "one";
    s->names[1] = "two";
    s->desc.hidden = 4;
    s->desc.layers = 2;
    s->desc.latent = 4;
    s->desc.material_count = 2;
    s->desc.materials = s->materials;
    s->desc.names = s->names;
    for (int k = 0; k < 3; k++) {
        s->desc.weights[k] = s->numbers + 64 * k;
        s->desc.biases[k] = s->numbers + 64 * k + 40;
    }
}

static void a_model_holds_copies_of_its_description(void **state)
{
    sample s;
    hnbrdf_model *model = NULL, *same = NULL;
    hnbrdf_model_desc desc;
    (void)state;
    make_sample(&s);
    assert_int_equal(hnbrdf_model_create(&s.desc, NULL, &model, NULL), HNBRDF_OK);
    hnbrdf_model_describe(model, &desc);
    assert_memory_equal(desc.weights[1], s.desc.weights[1], 16 * sizeof(float));
    assert_memory_equal(desc.biases[2], s.desc.biases[2], 6 * sizeof(float));
    assert_ptr_not_equal(desc.weights[1], s.desc.weights[1]);
    assert_ptr_not_equal(desc.names[1], s.names[1]);
    assert_true(desc.scale == 1);
    assert_null(desc.weights[3]);
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &same, NULL), HNBRDF_OK);
    assert_same_model(model, same);
    hnbrdf_model_free(model);
    hnbrdf_model_free(same);
    hnbrdf_model_free(NULL);
}

static void materials_are_found_by_name_and_index(void **state)
{
    hnbrdf_model *model = example_model(1, HNBRDF_KIND_HYBRID, 4, 1, 2, 100, 1);
    (void)state;
    assert_int_equal(hnbrdf_model_material_count(model), 100);
    for (int i = 0; i < 100; i++) {
        assert_int_equal(hnbrdf_model_find(model, hnbrdf_model_material_name(model, i)), i);
        assert_non_null(hnbrdf_model_material(model, i));
    }
    assert_int_equal(hnbrdf_model_find(model, "nothing"), -1);
    assert_int_equal(hnbrdf_model_find(model, ""), -1);
    assert_int_equal(hnbrdf_model_find(model, NULL), -1);
    assert_null(hnbrdf_model_material(model, -1));
    assert_null(hnbrdf_model_material(model, 100));
    assert_null(hnbrdf_model_material_name(model, -1));
    assert_null(hnbrdf_model_material_name(model, 100));
    hnbrdf_model_free(model);
}

/* The published models: 10->32->32->6, 1606 numbers, 10*32 + 32*32 + 32*6 products. */
static void counts_are_those_of_the_paper(void **state)
{
    hnbrdf_model *hybrid = example_model(2, HNBRDF_KIND_HYBRID, 32, 2, 4, 1, 0);
    hnbrdf_model *neural = example_model(2, HNBRDF_KIND_NEURAL, 16, 3, 12, 1, 0);
    hnbrdf_model *ggx = example_model(2, HNBRDF_KIND_GGX, 0, 0, 0, 1, 0);
    (void)state;
    assert_int_equal(hnbrdf_model_weight_count(hybrid), 1606);
    assert_int_equal(hnbrdf_model_multiplications(hybrid), 1536);
    assert_int_equal(hnbrdf_model_weight_count(neural), (18 + 1 + 17 + 17) * 16 + 17 * 3);
    assert_int_equal(hnbrdf_model_multiplications(neural), (18 + 16 + 16 + 3) * 16);
    assert_int_equal(hnbrdf_model_weight_count(ggx), 0);
    assert_int_equal(hnbrdf_model_multiplications(ggx), 0);
    hnbrdf_model_free(hybrid);
    hnbrdf_model_free(neural);
    hnbrdf_model_free(ggx);
}

static void one_allocation_holds_a_model_with_aligned_weights(void **state)
{
    sample s;
    hnbrdf_model *model = NULL;
    hnbrdf_model_desc desc;
    counting count = {.fail_at = -1};
    const hnbrdf_allocator allocator = counting_allocator(&count);
    (void)state;
    make_sample(&s);
    assert_int_equal(hnbrdf_model_create(&s.desc, &allocator, &model, NULL), HNBRDF_OK);
    assert_int_equal(count.calls, 1);
    hnbrdf_model_describe(model, &desc);
    for (int k = 0; k < 3; k++) {
        assert_int_equal((uintptr_t)desc.weights[k] % 64, 0);
        assert_int_equal((uintptr_t)desc.biases[k] % 64, 0);
    }
    hnbrdf_model_free(model);
    assert_int_equal(count.alive, 0);
}

static void latents_beyond_l_and_negative_zeros_are_cleared(void **state)
{
    sample s;
    hnbrdf_model *model = NULL;
    hnbrdf_model_desc desc;
    (void)state;
    make_sample(&s);
    s.materials[0].latent[3] = 1;
    s.materials[0].latent[4] = 2;
    s.desc.shift = -0.0f;
    s.desc.floor = -0.0f;
    assert_int_equal(hnbrdf_model_create(&s.desc, NULL, &model, NULL), HNBRDF_OK);
    assert_true(hnbrdf_model_material(model, 0)->latent[3] == 1);
    assert_true(hnbrdf_model_material(model, 0)->latent[4] == 0);
    hnbrdf_model_describe(model, &desc);
    assert_false(signbit(desc.shift));
    assert_false(signbit(desc.floor));
    hnbrdf_model_free(model);
}

/* ---- Refusals -------------------------------------------------------------------------------- */

static void expect(const sample *s, hnbrdf_result expected, const char *part)
{
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    counting count = {.fail_at = -1};
    const hnbrdf_allocator allocator = counting_allocator(&count);
    const hnbrdf_result result = hnbrdf_model_create(&s->desc, &allocator, &model, &error);
    if (result != expected || !strstr(error.text, part))
        fail_msg("result %d \"%s\", expected %d with \"%s\"", (int)result, error.text,
                 (int)expected, part);
    assert_null(model);
    assert_int_equal(count.alive, 0);
    assert_int_equal(hnbrdf_model_create(&s->desc, NULL, &model, NULL), expected);
}

#define REFUSES(edit, result, part) \
    do {                            \
        sample s;                   \
        make_sample(&s);            \
        edit;                       \
        expect(&s, result, part);   \
    } while (0)

static void wrong_shapes_are_refused(void **state)
{
    (void)state;
    REFUSES(s.desc.kind = (hnbrdf_kind)3, HNBRDF_ERROR_ARGUMENT, "kind is 3");
    REFUSES(s.desc.encoding = (hnbrdf_encoding)-1, HNBRDF_ERROR_ARGUMENT, "encoding is");
    REFUSES(s.desc.hidden = 0, HNBRDF_ERROR_ARGUMENT, "hidden is 0, expected 1 to 64");
    REFUSES(s.desc.hidden = 65, HNBRDF_ERROR_LIMIT, "hidden is 65");
    REFUSES(s.desc.hidden = -2147483647, HNBRDF_ERROR_ARGUMENT, "hidden is");
    REFUSES(s.desc.layers = 0, HNBRDF_ERROR_ARGUMENT, "layers is 0, expected 1 to 4");
    REFUSES(s.desc.layers = 5, HNBRDF_ERROR_LIMIT, "layers is 5");
    REFUSES(s.desc.latent = -1, HNBRDF_ERROR_ARGUMENT, "latent is -1, expected 0 to 16");
    REFUSES(s.desc.latent = 17, HNBRDF_ERROR_LIMIT, "latent is 17");
    REFUSES(s.desc.kind = HNBRDF_KIND_GGX, HNBRDF_ERROR_ARGUMENT, "expected 0, 0, 0");
    REFUSES(s.desc.material_count = 0, HNBRDF_ERROR_ARGUMENT, "material_count is 0");
    REFUSES(s.desc.material_count = -1, HNBRDF_ERROR_ARGUMENT, "material_count is -1");
    REFUSES(s.desc.material_count = 65537, HNBRDF_ERROR_LIMIT, "material_count is 65537");
    REFUSES(s.desc.weights[1] = NULL, HNBRDF_ERROR_ARGUMENT, "weights[1] is NULL");
    REFUSES(s.desc.biases[2] = NULL, HNBRDF_ERROR_ARGUMENT, "biases[2] is NULL");
    REFUSES(s.desc.materials = NULL, HNBRDF_ERROR_ARGUMENT, "materials is NULL");
    REFUSES(s.desc.names = NULL, HNBRDF_ERROR_ARGUMENT, "names is NULL");
}

static void numbers_that_are_not_finite_are_refused(void **state)
{
    (void)state;
    REFUSES(s.numbers[39] = NAN, HNBRDF_ERROR_ARGUMENT, "weights[0] holds");
    REFUSES(s.numbers[64] = INFINITY, HNBRDF_ERROR_ARGUMENT, "weights[1] holds inf at index 0");
    REFUSES(s.numbers[128 + 40 + 5] = -INFINITY, HNBRDF_ERROR_ARGUMENT,
            "biases[2] holds -inf at index 5");
    REFUSES(s.desc.scale = NAN, HNBRDF_ERROR_ARGUMENT, "scale is");
    REFUSES(s.desc.shift = INFINITY, HNBRDF_ERROR_ARGUMENT, "shift is inf");
    REFUSES(s.desc.floor = NAN, HNBRDF_ERROR_ARGUMENT, "floor is");
    REFUSES(s.desc.floor = -0.1f, HNBRDF_ERROR_ARGUMENT, "floor is -0.1");
}

static void materials_out_of_range_are_refused_by_name(void **state)
{
    (void)state;
    REFUSES(s.materials[1].kd[2] = 1.5f, HNBRDF_ERROR_ARGUMENT, "material 1 (two): kd");
    REFUSES(s.materials[0].eta[1] = 1, HNBRDF_ERROR_ARGUMENT, "material 0 (one): eta");
    REFUSES(s.materials[0].alpha[0] = 1e-5f, HNBRDF_ERROR_ARGUMENT, "alpha");
    REFUSES(s.materials[0].rotation = NAN, HNBRDF_ERROR_ARGUMENT, "rotation");
    REFUSES(s.materials[0].latent[0] = INFINITY, HNBRDF_ERROR_ARGUMENT, "latent");
}

static void bad_names_are_refused(void **state)
{
    char longest[HNBRDF_MAX_NAME + 2];
    hnbrdf_model *model = NULL;
    sample good;
    (void)state;
    memset(longest, 'a', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    REFUSES(s.names[0] = NULL, HNBRDF_ERROR_ARGUMENT, "name of material 0 is NULL");
    REFUSES(s.names[1] = "", HNBRDF_ERROR_ARGUMENT, "name of material 1 is empty");
    REFUSES(s.names[1] = longest, HNBRDF_ERROR_ARGUMENT, "longer, expected 1 to 127 bytes");
    REFUSES(s.names[1] = "one", HNBRDF_ERROR_ARGUMENT, "two materials are named one");
    REFUSES(s.names[1] = "a\nb", HNBRDF_ERROR_ARGUMENT, "control character at byte 1");
    REFUSES(s.names[1] = "a\x7f", HNBRDF_ERROR_ARGUMENT, "control character at byte 1");
    REFUSES(s.names[1] = "\xc2\x85", HNBRDF_ERROR_ARGUMENT, "control character at byte 0");
    REFUSES(s.names[1] = "\xff", HNBRDF_ERROR_ARGUMENT, "byte 0xff at 0, expected UTF-8");
    REFUSES(s.names[1] = "ab\xc3", HNBRDF_ERROR_ARGUMENT, "byte 0xc3 at 2, expected UTF-8");
    make_sample(&good);
    good.names[1] = longest + 1;
    assert_int_equal(hnbrdf_model_create(&good.desc, NULL, &model, NULL), HNBRDF_OK);
    hnbrdf_model_free(model);
}

static void one_duplicate_among_many_names_is_found(void **state)
{
    enum { COUNT = 5000 };
    static char text[COUNT][8];
    static const char *names[COUNT];
    hnbrdf_material *materials = malloc(COUNT * sizeof *materials);
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_GGX, .material_count = COUNT, .names = names};
    (void)state;
    assert_non_null(materials);
    for (int i = 0; i < COUNT; i++) {
        hnbrdf_material_init(&materials[i]);
        snprintf(text[i], sizeof text[i], "%d", i * 7919 % COUNT);
        names[i] = text[i];
    }
    desc.materials = materials;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, &error), HNBRDF_OK);
    for (int i = 0; i < COUNT; i++)
        assert_string_equal(hnbrdf_model_material_name(model, i), names[i]);
    hnbrdf_model_free(model);
    names[17] = names[4321];
    model = NULL;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, &error), HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, names[17]));
    assert_null(model);
    free(materials);
}

static void half_an_allocator_is_refused(void **state)
{
    sample s;
    hnbrdf_model *model = NULL;
    counting count = {.fail_at = 0};
    hnbrdf_allocator allocator = counting_allocator(&count);
    hnbrdf_error error;
    (void)state;
    make_sample(&s);
    assert_int_equal(hnbrdf_model_create(&s.desc, &allocator, &model, &error), HNBRDF_ERROR_MEMORY);
    allocator.release = NULL;
    assert_int_equal(hnbrdf_model_create(&s.desc, &allocator, &model, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_model_create(NULL, NULL, &model, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_model_create(&s.desc, NULL, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    assert_null(model);
}

static void every_result_kind_and_encoding_has_its_word(void **state)
{
    (void)state;
    for (int i = 0; i <= HNBRDF_ERROR_CANCELLED; i++) {
        assert_true(strlen(hnbrdf_strerror((hnbrdf_result)i)) > 0);
        for (int k = 0; k < i; k++)
            assert_string_not_equal(hnbrdf_strerror((hnbrdf_result)i),
                                    hnbrdf_strerror((hnbrdf_result)k));
    }
    assert_non_null(hnbrdf_strerror((hnbrdf_result)-1));
    assert_string_equal(hnbrdf_kind_name(HNBRDF_KIND_HYBRID), "hybrid");
    assert_string_equal(hnbrdf_kind_name(HNBRDF_KIND_NEURAL), "neural");
    assert_string_equal(hnbrdf_kind_name(HNBRDF_KIND_GGX), "ggx");
    assert_null(hnbrdf_kind_name((hnbrdf_kind)3));
    assert_string_equal(hnbrdf_encoding_name(HNBRDF_ENCODING_DIRECTIONS), "directions");
    assert_string_equal(hnbrdf_encoding_name(HNBRDF_ENCODING_HALF_DIFFERENCE), "half-difference");
    assert_string_equal(hnbrdf_encoding_name(HNBRDF_ENCODING_ANGLES), "angles");
    assert_string_equal(hnbrdf_encoding_name(HNBRDF_ENCODING_ANGLES_DIRECTED), "angles-directed");
    assert_string_equal(hnbrdf_encoding_name(HNBRDF_ENCODING_ANGLES_ANISOTROPIC),
                        "angles-anisotropic");
    assert_string_equal(hnbrdf_encoding_name(HNBRDF_ENCODING_ANGLES_AZIMUTHS), "angles-azimuths");
    assert_null(hnbrdf_encoding_name((hnbrdf_encoding)6));
    assert_string_equal(hnbrdf_version(), HNBRDF_VERSION_STRING);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_model_holds_copies_of_its_description),
        cmocka_unit_test(materials_are_found_by_name_and_index),
        cmocka_unit_test(counts_are_those_of_the_paper),
        cmocka_unit_test(one_allocation_holds_a_model_with_aligned_weights),
        cmocka_unit_test(latents_beyond_l_and_negative_zeros_are_cleared),
        cmocka_unit_test(wrong_shapes_are_refused),
        cmocka_unit_test(numbers_that_are_not_finite_are_refused),
        cmocka_unit_test(materials_out_of_range_are_refused_by_name),
        cmocka_unit_test(bad_names_are_refused),
        cmocka_unit_test(one_duplicate_among_many_names_is_found),
        cmocka_unit_test(half_an_allocator_is_refused),
        cmocka_unit_test(every_result_kind_and_encoding_has_its_word),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
