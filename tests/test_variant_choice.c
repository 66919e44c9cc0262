/* test_variant_choice.c: how a variant is asked for, by description, by load options and by
 * environment, and what is said when it cannot be had. */
#include "hnbrdf/hnbrdf.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static hnbrdf_result create(hnbrdf_variant asked, hnbrdf_variant *used, hnbrdf_error *error)
{
    static const char *const names[] = {"m"};
    hnbrdf_material material;
    hnbrdf_model *model = NULL;
    hnbrdf_material_init(&material);
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_GGX,
                              .material_count = 1,
                              .materials = &material,
                              .names = names,
                              .variant = asked};
    hnbrdf_result result = hnbrdf_model_create(&desc, NULL, &model, error);
    if (!result) {
        hnbrdf_model_describe(model, &desc);
        *used = desc.variant;
    }
    hnbrdf_model_free(model);
    return result;
}

typedef struct bytes {
    unsigned char data[4096];
    size_t size;
} bytes;

static int keep(void *user, const void *data, size_t size)
{
    bytes *to = user;
    if (size > sizeof to->data - to->size)
        return 1;
    memcpy(to->data + to->size, data, size);
    to->size += size;
    return 0;
}

static hnbrdf_result load(hnbrdf_variant asked, hnbrdf_variant *used, hnbrdf_error *error)
{
    static const char *const names[] = {"m"};
    bytes file = {.size = 0};
    hnbrdf_material material;
    hnbrdf_model *model = NULL;
    hnbrdf_material_init(&material);
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_GGX,
                              .material_count = 1,
                              .materials = &material,
                              .names = names,
                              .variant = HNBRDF_VARIANT_PLAIN};
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_model_write(model, keep, &file, NULL), HNBRDF_OK);
    hnbrdf_model_free(model);
    model = NULL;
    const hnbrdf_load_options options = {.variant = asked};
    hnbrdf_result result = hnbrdf_model_load_memory(file.data, file.size, &options, &model, error);
    if (!result) {
        hnbrdf_model_describe(model, &desc);
        *used = desc.variant;
    }
    hnbrdf_model_free(model);
    return result;
}

typedef hnbrdf_result make(hnbrdf_variant asked, hnbrdf_variant *used, hnbrdf_error *error);
static make *const makers[] = {create, load};

static void every_available_variant_is_used_when_asked_for(void **state)
{
    (void)state;
    unsetenv("HNBRDF_VARIANT");
    for (int m = 0; m < 2; m++)
        for (int v = HNBRDF_VARIANT_PLAIN; v <= HNBRDF_VARIANT_NEON; v++) {
            hnbrdf_variant used = HNBRDF_VARIANT_AUTO;
            hnbrdf_error error = {""};
            hnbrdf_result result = makers[m]((hnbrdf_variant)v, &used, &error);
            if (hnbrdf_variant_available((hnbrdf_variant)v)) {
                assert_int_equal(result, HNBRDF_OK);
                assert_int_equal(used, v);
            } else {
                assert_int_equal(result, HNBRDF_ERROR_UNSUPPORTED);
                assert_non_null(strstr(error.text, hnbrdf_variant_name((hnbrdf_variant)v)));
                assert_non_null(strstr(error.text, "plain"));
            }
        }
}

static void the_environment_decides_where_the_caller_does_not(void **state)
{
    (void)state;
    for (int m = 0; m < 2; m++)
        for (int v = HNBRDF_VARIANT_PLAIN; v <= HNBRDF_VARIANT_NEON; v++) {
            const char *name = hnbrdf_variant_name((hnbrdf_variant)v);
            hnbrdf_variant used = HNBRDF_VARIANT_AUTO;
            hnbrdf_error error = {""};
            setenv("HNBRDF_VARIANT", name, 1);
            if (hnbrdf_variant_available((hnbrdf_variant)v)) {
                assert_int_equal(makers[m](HNBRDF_VARIANT_AUTO, &used, &error), HNBRDF_OK);
                assert_int_equal(used, v);
            } else {
                assert_int_equal(makers[m](HNBRDF_VARIANT_AUTO, &used, &error),
                                 HNBRDF_ERROR_UNSUPPORTED);
                assert_non_null(strstr(error.text, "HNBRDF_VARIANT"));
            }
            assert_int_equal(makers[m](HNBRDF_VARIANT_PLAIN, &used, &error), HNBRDF_OK);
            assert_int_equal(used, HNBRDF_VARIANT_PLAIN);
        }
}

static void no_name_and_auto_take_an_available_one(void **state)
{
    (void)state;
    static const char *const names[] = {NULL, "", "auto"};
    hnbrdf_variant first = HNBRDF_VARIANT_AUTO, used = HNBRDF_VARIANT_AUTO;
    for (int k = 0; k < 3; k++) {
        unsetenv("HNBRDF_VARIANT");
        if (names[k])
            setenv("HNBRDF_VARIANT", names[k], 1);
        assert_int_equal(create(HNBRDF_VARIANT_AUTO, &used, NULL), HNBRDF_OK);
        assert_true(used != HNBRDF_VARIANT_AUTO && hnbrdf_variant_available(used));
        first = k == 0 ? used : first;
        assert_int_equal(used, first);
    }
}

static void an_unknown_name_is_an_error_that_repeats_it(void **state)
{
    (void)state;
    hnbrdf_variant used = HNBRDF_VARIANT_AUTO;
    for (int m = 0; m < 2; m++) {
        hnbrdf_error error = {""};
        setenv("HNBRDF_VARIANT", "AVX2 ", 1);
        assert_int_equal(makers[m](HNBRDF_VARIANT_AUTO, &used, &error), HNBRDF_ERROR_UNSUPPORTED);
        assert_non_null(strstr(error.text, "HNBRDF_VARIANT is AVX2 , expected"));
        assert_null(strchr(error.text, '\n'));
        unsetenv("HNBRDF_VARIANT");
        assert_int_equal(makers[m]((hnbrdf_variant)77, &used, &error), HNBRDF_ERROR_UNSUPPORTED);
        assert_int_equal(makers[m]((hnbrdf_variant)-1, &used, &error), HNBRDF_ERROR_UNSUPPORTED);
    }
    assert_null(hnbrdf_variant_name((hnbrdf_variant)77));
    assert_int_equal(hnbrdf_variant_available((hnbrdf_variant)77), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_available_variant_is_used_when_asked_for),
        cmocka_unit_test(the_environment_decides_where_the_caller_does_not),
        cmocka_unit_test(no_name_and_auto_take_an_available_one),
        cmocka_unit_test(an_unknown_name_is_an_error_that_repeats_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
