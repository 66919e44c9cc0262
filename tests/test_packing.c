/* test_packing.c: hnbrdf_packing_init() spans just the materials it is told of, and
 * hnbrdf_packing_check() holds every range to its last float. */
#include "core_support.h"

#include "core/pack.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { MATERIALS = 6, LATENT = 3 };

static hnbrdf_model *model_of(rng *r, hnbrdf_kind kind, const hnbrdf_material *materials)
{
    static const char *const names[MATERIALS] = {"a", "b", "c", "d", "e", "f"};
    hnbrdf_model *one = random_model(r, kind, HNBRDF_ENCODING_ANGLES, 4, 1, LATENT), *made = NULL;
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(one, &desc);
    desc.material_count = MATERIALS;
    desc.materials = materials;
    desc.names = names;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &made, NULL), HNBRDF_OK);
    hnbrdf_model_free(one);
    return made;
}

static void same_range(const float range[2], float low, float high)
{
    if (!(range[0] == low && range[1] == high))
        fail_msg("%.9g to %.9g, expected %.9g to %.9g", (double)range[0], (double)range[1],
                 (double)low, (double)high);
}

/* Smallest and largest by looking at all. */
static void check_spans(const hnbrdf_packing *p, const hnbrdf_material *materials,
                        const int *chosen, int count)
{
    float low[3] = {9e9f, 9e9f, 9e9f}, high[3] = {-9e9f, -9e9f, -9e9f};
    int anisotropic = 0, rotated = 0;
    for (int k = 0; k < count; k++) {
        const hnbrdf_material *m = &materials[chosen ? chosen[k] : k];
        for (int c = 0; c < 3; c++) {
            const float values[3] = {m->kd[c], m->eta[c], m->alpha[c < 2 ? c : 1]};
            for (int f = 0; f < 3; f++) {
                low[f] = fminf(low[f], values[f]);
                high[f] = fmaxf(high[f], values[f]);
            }
        }
        anisotropic |= m->alpha[0] != m->alpha[1];
        rotated |= m->rotation != 0.0f;
    }
    same_range(p->kd, low[0], high[0]);
    same_range(p->eta, low[1], high[1]);
    same_range(p->alpha, low[2], high[2]);
    for (int i = 0; i < p->latent; i++) {
        float least = 9e9f, most = -9e9f;
        for (int k = 0; k < count; k++) {
            least = fminf(least, materials[chosen ? chosen[k] : k].latent[i]);
            most = fmaxf(most, materials[chosen ? chosen[k] : k].latent[i]);
        }
        same_range(p->latent_range[i], least, most);
    }
    assert_int_equal(p->anisotropic, p->analytic && anisotropic);
    assert_int_equal(p->rotated, rotated);
}

static void a_packing_spans_just_the_materials_chosen(void **state)
{
    (void)state;
    static const hnbrdf_kind kinds[] = {HNBRDF_KIND_HYBRID, HNBRDF_KIND_NEURAL, HNBRDF_KIND_GGX};
    static const int sets[][3] = {{0, 1, 2}, {5, 3, 4}, {2, 2, 2}, {1, 0, 5}};
    rng r = rng_make(101);
    for (int n = 0; n < 60; n++) {
        hnbrdf_material materials[MATERIALS];
        hnbrdf_packing p;
        hnbrdf_error error = {""};
        for (int m = 0; m < MATERIALS;
             m++) { /* in one case of three all isotropic, or not turned */
            materials[m] = random_material(&r, n % 3 == 0 || m < 3);
            if (n % 3 == 1 && m != 4)
                materials[m].rotation = 0.0f;
        }
        hnbrdf_model *model = model_of(&r, kinds[n / 3 % 3], materials);
        const hnbrdf_texel_format format = n & 1 ? HNBRDF_TEXEL_RGBA8 : HNBRDF_TEXEL_RGBA16F;
        assert_int_equal(hnbrdf_packing_init(model, NULL, 0, format, &p, &error), HNBRDF_OK);
        check_spans(&p, materials, NULL, MATERIALS);
        assert_int_equal(p.format, format);
        assert_int_equal(p.analytic, kinds[n / 3 % 3] != HNBRDF_KIND_NEURAL);
        assert_int_equal(p.latent, kinds[n / 3 % 3] == HNBRDF_KIND_GGX ? 0 : LATENT);
        for (size_t s = 0; s < sizeof sets / sizeof sets[0]; s++)
            for (int count = 1; count <= 3; count++) {
                assert_int_equal(hnbrdf_packing_init(model, sets[s], count, format, &p, &error),
                                 HNBRDF_OK);
                check_spans(&p, materials, sets[s], count);
            }
        hnbrdf_model_free(model);
    }
}

static void a_choice_of_no_material_is_refused(void **state)
{
    (void)state;
    static const int wrong[] = {MATERIALS, -1}, good[] = {MATERIALS - 1};
    rng r = rng_make(102);
    hnbrdf_material materials[MATERIALS];
    for (int m = 0; m < MATERIALS; m++)
        materials[m] = random_material(&r, 1);
    hnbrdf_model *model = model_of(&r, HNBRDF_KIND_HYBRID, materials);
    hnbrdf_packing p, before;
    memset(&p, 7, sizeof p);
    before = p;
    for (int k = 0; k < 2; k++) {
        hnbrdf_error error = {""};
        char text[64];
        assert_int_equal(hnbrdf_packing_init(model, wrong + k, 1, HNBRDF_TEXEL_RGBA8, &p, &error),
                         HNBRDF_ERROR_ARGUMENT);
        snprintf(text, sizeof text, "materials[0] is %d, expected 0 to 5", wrong[k]);
        assert_non_null(strstr(error.text, text));
    }
    assert_int_equal(hnbrdf_packing_init(model, good, 0, HNBRDF_TEXEL_RGBA8, &p, NULL),
                     HNBRDF_ERROR_ARGUMENT);
    assert_memory_equal(&p, &before, sizeof p);
    assert_int_equal(hnbrdf_packing_init(model, good, 1, HNBRDF_TEXEL_RGBA8, &p, NULL), HNBRDF_OK);
    hnbrdf_model_free(model);
}

/* The widest range is taken; beyond it by one float, upside down, or no number, it is refused by
 * name, in bytes; half floats need no range. */
static void check_range(hnbrdf_packing *p, float range[2], const char *name, float low, float high)
{
    const float bad[][2] = {{nextafterf(low, -INFINITY), high},
                            {low, nextafterf(high, INFINITY)},
                            {high, low},
                            {NAN, high},
                            {low, NAN}};
    const float kept[2] = {range[0], range[1]};
    range[0] = low;
    range[1] = high;
    assert_int_equal(hnbrdf_packing_check(p, NULL), HNBRDF_OK);
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        hnbrdf_error error = {""};
        memcpy(range, bad[k], sizeof bad[k]);
        p->format = HNBRDF_TEXEL_RGBA8;
        assert_int_equal(hnbrdf_packing_check(p, &error), HNBRDF_ERROR_ARGUMENT);
        assert_non_null(strstr(error.text, name));
        p->format = HNBRDF_TEXEL_RGBA16F;
        assert_int_equal(hnbrdf_packing_check(p, &error), HNBRDF_OK);
    }
    p->format = HNBRDF_TEXEL_RGBA8;
    range[0] = range[1] = low;
    assert_int_equal(hnbrdf_packing_check(p, NULL), HNBRDF_OK);
    memcpy(range, kept, sizeof kept);
}

static void every_range_is_held_to_its_last_float(void **state)
{
    (void)state;
    hnbrdf_packing p = {.format = HNBRDF_TEXEL_RGBA8,
                        .analytic = 1,
                        .latent = HNBRDF_MAX_LATENT,
                        .kd = {0.2f, 0.3f},
                        .eta = {1.5f, 1.5f},
                        .alpha = {0.1f, 0.2f}};
    check_range(&p, p.kd, "range of kd", 0.0f, 1.0f);
    check_range(&p, p.eta, "range of eta", 1.0f, HNBRDF_MAX_ETA);
    check_range(&p, p.alpha, "range of alpha", HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        check_range(&p, p.latent_range[i], "range of latent", -65504.0f, 65504.0f);
    p.analytic = 0; /* what is not stored needs no range */
    p.kd[0] = p.eta[0] = p.alpha[0] = NAN;
    assert_int_equal(hnbrdf_packing_check(&p, NULL), HNBRDF_OK);
    p.latent = 0;
    assert_int_equal(hnbrdf_packing_check(&p, NULL), HNBRDF_ERROR_ARGUMENT); /* nothing is left */
    p.latent = HNBRDF_MAX_LATENT + 1;
    assert_int_equal(hnbrdf_packing_check(&p, NULL), HNBRDF_ERROR_ARGUMENT);
    p.latent = -1;
    assert_int_equal(hnbrdf_packing_check(&p, NULL), HNBRDF_ERROR_ARGUMENT);
    p.latent = 1;
    p.format = (hnbrdf_texel_format)2;
    assert_int_equal(hnbrdf_packing_check(&p, NULL), HNBRDF_ERROR_ARGUMENT);
}

/* 1 to 9 texels: as many as the channels fill. */
static void texels_hold_the_channels_and_no_more(void **state)
{
    (void)state;
    assert_int_equal(hnbrdf_texel_bytes(HNBRDF_TEXEL_RGBA16F), 8);
    assert_int_equal(hnbrdf_texel_bytes(HNBRDF_TEXEL_RGBA8), 4);
    for (int bits = 0; bits < 16; bits++)
        for (int latent = 0; latent <= HNBRDF_MAX_LATENT; latent++) {
            const hnbrdf_packing p = {.analytic = bits & 1,
                                      .anisotropic = (bits & 1) && (bits & 2),
                                      .rotated = bits >> 2 & 1,
                                      .lobes = bits >> 3,
                                      .latent = latent};
            int channels = (bits & 1 ? 3 + 3 + (bits & 2 ? 2 : 1) : 0) + (bits & 4 ? 2 : 0) +
                           latent + (bits & 8 ? 10 : 0);
            hnbrdf_texel_layout layout;
            hnbrdf_texel_layout_make(&p, &layout);
            assert_int_equal(layout.channels, channels);
            assert_int_equal(hnbrdf_packing_texels(&p), (channels + 3) / 4);
        }
}

static void one_roughness_comes_back_as_both_and_no_angle_as_none(void **state)
{
    (void)state;
    hnbrdf_packing p = {.format = HNBRDF_TEXEL_RGBA16F, .analytic = 1, .rotated = 1};
    unsigned char texels[HNBRDF_MAX_TEXELS * 8];
    hnbrdf_material m, back;
    hnbrdf_material_init(&m);
    m.alpha[0] = m.alpha[1] = 0.25f;
    m.rotation = NAN;
    hnbrdf_material_pack(&p, &m, texels);
    hnbrdf_material_unpack(&p, texels, &back);
    assert_true(back.alpha[0] == 0.25f && back.alpha[1] == 0.25f);
    assert_true(back.rotation == 0.0f);
    m.rotation = 1.0f;
    hnbrdf_material_pack(&p, &m, texels);
    hnbrdf_material_unpack(&p, texels, &back);
    assert_true(fabsf(back.rotation - 1.0f) < 1e-3f); /* cosine and sine to 11 bits */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_packing_spans_just_the_materials_chosen),
        cmocka_unit_test(a_choice_of_no_material_is_refused),
        cmocka_unit_test(every_range_is_held_to_its_last_float),
        cmocka_unit_test(texels_hold_the_channels_and_no_more),
        cmocka_unit_test(one_roughness_comes_back_as_both_and_no_angle_as_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
