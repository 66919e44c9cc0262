/* test_core_batches.c: batched evaluation, sampling and density, prepared and with a material for
 * each item: every item has the bits of the single call, in every variant. */
#include "core_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { ITEMS = 83, MATERIALS = 7, CALLS = 5, GAP = 2 };

typedef struct batch_inputs {
    float wi[ITEMS][3], wo[ITEMS][3], u[ITEMS][2];
    hnbrdf_material materials[ITEMS];
    int index[ITEMS];
} batch_inputs;

/* Blocks of 16 of one material before, between and after mixed ones: what a batch keeps from block
 * to block must not be taken for another material's. */
static void fill(rng *r, batch_inputs *in)
{
    static const float ends[] = {0.0f, 0x1.fffffep-1f, 0.5f, NAN, 2.0f, -1.0f};
    static const float odd[] = {0.0f, -0.3f, NAN, INFINITY, 1e-20f};
    for (int k = 0; k < ITEMS; k++) {
        direction_uniform(r, in->wi[k]);
        direction_uniform(r, in->wo[k]);
        for (int i = 0; i < 2; i++)
            in->u[k][i] = k % 5 == 0 ? ends[rng_u32(r) % 6] : rng_float(r);
        if (k % 11 == 3)
            in->wo[k][2] = odd[rng_u32(r) % 5];
        if (k % 13 == 4)
            in->wi[k][rng_u32(r) % 3] = odd[rng_u32(r) % 5];
        in->materials[k] = random_material(r, k & 1);
        if (k % 3)
            random_lobes(r, &in->materials[k].lobes);
        if (k % 4 == 1)
            in->materials[k].energy = (hnbrdf_energy){rng_float(r), 10.0f * rng_float(r)};
        int block = k / 16;
        in->index[k] = block % 2 == 0 ? 2 : (int)(rng_u32(r) % MATERIALS);
    }
}

static const hnbrdf_material *material_of(const batch_inputs *in, int call, int k)
{
    return call == 2   ? &in->materials[in->index[k]]
           : call == 3 ? &in->materials[k]
                       : &in->materials[1];
}

static void assert_bits(const void *found, const void *expected, size_t size, int call, int item)
{
    if (memcmp(found, expected, size) != 0)
        fail_msg("call %d, item %d: not the bits of the single call", call, item);
}

/* call 0: prepared; 1: a model and a material; 2: by index; 3: one for each item; 4: prepared,
 * with gaps between the items. */
static void check_eval(const hnbrdf_model *model, const batch_inputs *in, int count, int call)
{
    float f[ITEMS][3 + GAP], expected[3];
    const size_t n = (size_t)count, stride = sizeof f[0];
    hnbrdf_prepared prepared;
    hnbrdf_prepare(model, &in->materials[1], &prepared);
    memset(f, 0x55, sizeof f);
    if (call == 0 || call == 4)
        hnbrdf_prepared_eval_batch(&prepared, n, in->wi[0], 0, in->wo[0], 12, f[0], stride);
    else if (call == 1)
        hnbrdf_eval_batch(model, &in->materials[1], n, in->wi[0], 12, in->wo[0], 0, f[0], stride);
    else
        hnbrdf_eval_many(model, in->materials, call == 2 ? in->index : NULL, n, in->wi[0], 0,
                         in->wo[0], 0, f[0], stride);
    for (int k = 0; k < count; k++) {
        hnbrdf_eval(model, material_of(in, call, k), in->wi[k], in->wo[k], expected);
        assert_bits(f[k], expected, sizeof expected, call, k);
    }
    for (size_t i = 0; i < sizeof f; i++) /* nothing else is written */
        if (i % stride >= 12 || i / stride >= n)
            assert_int_equal(((unsigned char *)f)[i], 0x55);
}

static void check_pdf(const hnbrdf_model *model, const batch_inputs *in, int count, int call)
{
    float pdf[ITEMS][1 + GAP];
    const size_t n = (size_t)count, stride = call == 4 ? sizeof pdf[0] : sizeof(float);
    hnbrdf_prepared prepared;
    hnbrdf_prepare(model, &in->materials[1], &prepared);
    memset(pdf, 0x55, sizeof pdf);
    if (call == 2 || call == 3)
        hnbrdf_pdf_many(model, in->materials, call == 2 ? in->index : NULL, n, in->wi[0], 0,
                        in->wo[0], 0, pdf[0], 0);
    else
        hnbrdf_prepared_pdf_batch(&prepared, n, in->wi[0], 0, in->wo[0], 12, pdf[0],
                                  call == 4 ? stride : 0);
    for (int k = 0; k < count; k++) {
        float expected = hnbrdf_pdf(model, material_of(in, call, k), in->wi[k], in->wo[k]);
        assert_bits((char *)pdf + (size_t)k * stride, &expected, sizeof expected, call, k);
    }
    for (size_t i = 0; i < sizeof pdf; i++)
        if (i % stride >= sizeof(float) || i / stride >= n)
            assert_int_equal(((unsigned char *)pdf)[i], 0x55);
}

static void check_sample(const hnbrdf_model *model, const batch_inputs *in, int count, int call)
{
    struct {
        hnbrdf_sample_result result;
        float after[GAP];
    } drawn[ITEMS];
    hnbrdf_sample_result expected;
    const size_t n = (size_t)count, stride = sizeof drawn[0];
    hnbrdf_prepared prepared;
    hnbrdf_prepare(model, &in->materials[1], &prepared);
    memset(drawn, 0x55, sizeof drawn);
    if (call == 2 || call == 3)
        hnbrdf_sample_many(model, in->materials, call == 2 ? in->index : NULL, n, in->wo[0], 0,
                           in->u[0], 8, &drawn[0].result, stride);
    else
        hnbrdf_prepared_sample_batch(&prepared, n, in->wo[0], 12, in->u[0], 0, &drawn[0].result,
                                     stride);
    int some = 0;
    for (int k = 0; k < count; k++) {
        hnbrdf_sample(model, material_of(in, call, k), in->wo[k], in->u[k], &expected);
        assert_bits(drawn[k].result.wi, expected.wi, sizeof expected.wi, call, k);
        assert_bits(&drawn[k].result.pdf, &expected.pdf, sizeof expected.pdf, call, k);
        assert_bits(drawn[k].result.weight, expected.weight, sizeof expected.weight, call, k);
        some += expected.pdf > 0.0f;
    }
    assert_true(count < 8 || some > count / 2);
    for (size_t i = 0; i < sizeof drawn; i++)
        if (i % stride >= sizeof expected || i / stride >= n)
            assert_int_equal(((unsigned char *)drawn)[i], 0x55);
}

static hnbrdf_model *in_variant(const hnbrdf_model *model, hnbrdf_variant variant)
{
    hnbrdf_model_desc desc;
    hnbrdf_model *made = NULL;
    hnbrdf_model_describe(model, &desc);
    desc.variant = variant;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &made, NULL), HNBRDF_OK);
    return made;
}

static void every_item_has_the_bits_of_the_single_call(void **state)
{
    (void)state;
    static const struct {
        hnbrdf_kind kind;
        hnbrdf_encoding encoding;
        int hidden, layers, latent;
    } models[] = {{HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES_DIRECTED, 32, 2, 4},
                  {HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES_ANISOTROPIC, 13, 1, 0},
                  {HNBRDF_KIND_NEURAL, HNBRDF_ENCODING_HALF_DIFFERENCE, 16, 3, 12},
                  {HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0}};
    static const int counts[] = {0, 1, 15, 16, 17, ITEMS};
    static batch_inputs in;
    for (int m = 0; m < 4; m++) {
        rng r = rng_make(60 + (uint32_t)m);
        hnbrdf_model *model = random_model(&r, models[m].kind, models[m].encoding, models[m].hidden,
                                           models[m].layers, models[m].latent);
        fill(&r, &in);
        for (int v = HNBRDF_VARIANT_PLAIN; hnbrdf_variant_name((hnbrdf_variant)v); v++) {
            if (!hnbrdf_variant_available((hnbrdf_variant)v) ||
                !hnbrdf_variant_is_exact((hnbrdf_variant)v))
                continue;
            hnbrdf_model *own = in_variant(model, (hnbrdf_variant)v);
            for (int k = 0; k < 6; k++)
                for (int call = 0; call < CALLS; call++) {
                    check_eval(own, &in, counts[k], call);
                    check_pdf(own, &in, counts[k], call);
                    check_sample(own, &in, counts[k], call);
                }
            hnbrdf_model_free(own);
        }
        hnbrdf_model_free(model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_item_has_the_bits_of_the_single_call),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
