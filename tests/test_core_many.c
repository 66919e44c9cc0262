/* test_core_many.c: hnbrdf_eval_many() gives each lane the value of its own material, however runs
 * of one material and mixed blocks follow each other. */
#include "core_support.h"

#include "core/kernel.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

enum { MATERIALS = 5, BLOCKS = 12, PAIRS = BLOCKS * HNBRDF_LANES + 3 };

/* One block a letter: A to E the same material in all lanes, - mixed lanes, whose last one has
 * material B. A kernel keeps the material it prepared last; each case here would find it stale if
 * one way of losing it was overlooked. */
static const char *const orders[] = {"A-AB-BA--AAB", "AAAABBBB----", "B-BB-BAAB-BA",
                                     "------------", "ABCDEABCDEAB", "-A-A-B-B-A-A"};

static int material_of(const char *order, int lane)
{
    char block = order[lane / HNBRDF_LANES < BLOCKS ? lane / HNBRDF_LANES : BLOCKS - 1];
    if (block != '-')
        return block - 'A';
    return lane % HNBRDF_LANES == HNBRDF_LANES - 1 ? 1 : lane % MATERIALS;
}

static hnbrdf_model *of_variant(const hnbrdf_model *model, hnbrdf_variant variant)
{
    hnbrdf_model_desc desc;
    hnbrdf_model *made = NULL;
    hnbrdf_model_describe(model, &desc);
    desc.variant = variant;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &made, NULL), HNBRDF_OK);
    return made;
}

static void check_orders(rng *r, const hnbrdf_model *model)
{
    hnbrdf_material materials[MATERIALS];
    static float wi[PAIRS][3], wo[PAIRS][3], f[PAIRS][3];
    int index[PAIRS];
    for (int m = 0; m < MATERIALS; m++)
        materials[m] = random_material(r, m & 1);
    for (int k = 0; k < PAIRS; k++) {
        direction_uniform(r, wi[k]);
        direction_uniform(r, wo[k]);
    }
    for (size_t n = 0; n < sizeof orders / sizeof orders[0]; n++) {
        for (int k = 0; k < PAIRS; k++)
            index[k] = material_of(orders[n], k);
        hnbrdf_eval_many(model, materials, index, PAIRS, wi[0], 0, wo[0], 0, f[0], 0);
        for (int k = 0; k < PAIRS; k++) {
            float single[3];
            hnbrdf_eval(model, &materials[index[k]], wi[k], wo[k], single);
            assert_same_bits(f[k], single, 3);
        }
    }
}

static void every_lane_has_its_own_material_whatever_came_before(void **state)
{
    (void)state;
    static const hnbrdf_kind kinds[] = {HNBRDF_KIND_HYBRID, HNBRDF_KIND_NEURAL, HNBRDF_KIND_GGX};
    static const hnbrdf_encoding encodings[] = {HNBRDF_ENCODING_ANGLES,
                                                HNBRDF_ENCODING_ANGLES_ANISOTROPIC};
    rng r = rng_make(81);
    for (int v = HNBRDF_VARIANT_PLAIN; v <= HNBRDF_VARIANT_NEON; v++)
        for (int k = 0; k < 6 && hnbrdf_variant_available((hnbrdf_variant)v); k++) {
            hnbrdf_model *plain = random_model(&r, kinds[k % 3], encodings[k / 3], 16, 2, 4);
            hnbrdf_model *model = of_variant(plain, (hnbrdf_variant)v);
            check_orders(&r, model);
            hnbrdf_model_free(model);
            hnbrdf_model_free(plain);
        }
}

static void a_prepared_material_is_black_below_the_horizon(void **state)
{
    (void)state;
    static const float up[3] = {0.6f, 0.0f, 0.8f}, down[3] = {0.6f, 0.0f, -0.8f};
    rng r = rng_make(82);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES, 8, 1, 4);
    hnbrdf_prepared prepared;
    hnbrdf_prepare(model, hnbrdf_model_material(model, 0), &prepared);
    for (int k = 1; k < 4; k++) {
        float f[3] = {7.0f, 7.0f, 7.0f};
        hnbrdf_prepared_eval(&prepared, k & 1 ? down : up, k & 2 ? down : up, f);
        assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
        assert_true(hnbrdf_prepared_pdf(&prepared, k & 1 ? down : up, k & 2 ? down : up) == 0.0f);
    }
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_lane_has_its_own_material_whatever_came_before),
        cmocka_unit_test(a_prepared_material_is_black_below_the_horizon),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
