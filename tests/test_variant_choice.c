/* test_variant_choice.c: how a variant is asked for, by description and by load options, and what
 * is said when it cannot be had. The environment has no say. */
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
    for (int m = 0; m < 2; m++)
        for (int v = HNBRDF_VARIANT_PLAIN; v <= HNBRDF_VARIANT_NEON_FUSED; v++) {
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

static void the_environment_has_no_say(void **state)
{
    (void)state;
    static const char *const values[] = {"plain", "avx2-fused", "no such variant"};
    hnbrdf_variant fastest = HNBRDF_VARIANT_AUTO, used = HNBRDF_VARIANT_AUTO;
    assert_int_equal(create(HNBRDF_VARIANT_AUTO, &fastest, NULL), HNBRDF_OK);
    assert_true(fastest != HNBRDF_VARIANT_AUTO && hnbrdf_variant_available(fastest));
    assert_true(hnbrdf_variant_is_exact(fastest));
    for (int k = 0; k < 3; k++) {
        setenv("HNBRDF_VARIANT", values[k], 1);
        for (int m = 0; m < 2; m++) {
            assert_int_equal(makers[m](HNBRDF_VARIANT_AUTO, &used, NULL), HNBRDF_OK);
            assert_int_equal(used, fastest);
        }
    }
    unsetenv("HNBRDF_VARIANT");
}

static void a_number_that_is_no_variant_is_an_error(void **state)
{
    (void)state;
    hnbrdf_variant used = HNBRDF_VARIANT_AUTO;
    for (int m = 0; m < 2; m++) {
        hnbrdf_error error = {""};
        assert_int_equal(makers[m]((hnbrdf_variant)77, &used, &error), HNBRDF_ERROR_UNSUPPORTED);
        assert_non_null(strstr(error.text, "variant is unknown, expected"));
        assert_null(strchr(error.text, '\n'));
        assert_int_equal(makers[m]((hnbrdf_variant)-1, &used, &error), HNBRDF_ERROR_UNSUPPORTED);
    }
    assert_null(hnbrdf_variant_name((hnbrdf_variant)77));
    assert_null(hnbrdf_variant_name((hnbrdf_variant)-1));
    assert_int_equal(hnbrdf_variant_available((hnbrdf_variant)77), 0);
    assert_int_equal(hnbrdf_variant_is_exact((hnbrdf_variant)77), 0);
    assert_int_equal(hnbrdf_variant_is_exact(HNBRDF_VARIANT_AVX2_FUSED), 0);
}

static void every_name_leads_back(void **state)
{
    (void)state;
    for (int v = 0; hnbrdf_variant_name((hnbrdf_variant)v); v++) {
        hnbrdf_variant back = (hnbrdf_variant)99;
        assert_int_equal(hnbrdf_variant_from_name(hnbrdf_variant_name((hnbrdf_variant)v), &back),
                         1);
        assert_int_equal(back, v);
    }
    for (int k = 0; hnbrdf_kind_name((hnbrdf_kind)k); k++) {
        hnbrdf_kind back = (hnbrdf_kind)99;
        assert_int_equal(hnbrdf_kind_from_name(hnbrdf_kind_name((hnbrdf_kind)k), &back), 1);
        assert_int_equal(back, k);
    }
    for (int e = 0; hnbrdf_encoding_name((hnbrdf_encoding)e); e++) {
        hnbrdf_encoding back = (hnbrdf_encoding)99;
        const char *name = hnbrdf_encoding_name((hnbrdf_encoding)e);
        assert_int_equal(hnbrdf_encoding_from_name(name, &back), 1);
        assert_int_equal(back, e);
    }
    hnbrdf_variant variant = (hnbrdf_variant)99;
    assert_int_equal(hnbrdf_variant_from_name("AVX2 ", &variant), 0);
    assert_int_equal(variant, 99);
    hnbrdf_encoding encoding = (hnbrdf_encoding)99;
    assert_int_equal(hnbrdf_encoding_from_name("", &encoding), 0);
    assert_int_equal(encoding, 99);
    hnbrdf_kind kind = (hnbrdf_kind)99;
    assert_int_equal(hnbrdf_kind_from_name("GGX", &kind), 0);
    assert_int_equal(kind, 99);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_available_variant_is_used_when_asked_for),
        cmocka_unit_test(the_environment_has_no_say),
        cmocka_unit_test(a_number_that_is_no_variant_is_an_error),
        cmocka_unit_test(every_name_leads_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
