/* test_core_fused.c: the fused variants against bounds that are derived pair by pair: the BRDF once
 * more, every number with what rounding can do to it, a product with its sum in one or in two
 * (check/bounds.c). The single call, batches and many materials; all kinds and encodings; edited,
 * anisotropic and turned materials. */
#include "core_support.h"

#include "check/bounds_draw.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>

enum { PAIRS = 70, MATERIALS = 7, CALLS = 3 };

/* IEEE 754 throughout, but a compiler may fuse: C's bits are not repeated. */
static const check_arithmetic CPU = {
    .exact_basic = 1, .exact_divide = 1, .exact_sqrt = 1, .keeps_denormals = 1};

typedef struct scene {
    hnbrdf_material materials[MATERIALS];
    int index[PAIRS];
    float wi[PAIRS][3], wo[PAIRS][3];
} scene;

static void fill(rng *r, scene *s)
{
    for (int m = 0; m < MATERIALS; m++) {
        s->materials[m] = random_material(r, m & 1);
        if (m % 3 == 2)
            s->materials[m] = edited_from(r, s->materials[m]);
    }
    for (int k = 0; k < PAIRS; k++) {
        direction_uniform(r, s->wi[k]);
        direction_uniform(r, s->wo[k]);
        s->index[k] = (int)(5u * (unsigned)k % MATERIALS);
    }
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

/* Pair k of the scene by one of the calls, with its own material. */
static void evaluate(const hnbrdf_model *model, const scene *s, int call, float f[PAIRS][3])
{
    for (int k = 0; k < PAIRS && call == 0; k++)
        hnbrdf_eval(model, &s->materials[s->index[k]], s->wi[k], s->wo[k], f[k]);
    for (int m = 0; m < MATERIALS && call == 1; m++) {
        float all[PAIRS][3];
        hnbrdf_eval_batch(model, &s->materials[m], PAIRS, s->wi[0], 0, s->wo[0], 0, all[0], 0);
        for (int k = 0; k < PAIRS; k++)
            if (s->index[k] == m)
                memcpy(f[k], all[k], sizeof f[k]);
    }
    if (call == 2)
        hnbrdf_eval_many(model, s->materials, s->index, PAIRS, s->wi[0], 0, s->wo[0], 0, f[0], 0);
}

/* The largest share of its bound that a value takes; differing: how many differ from exact ones. */
static double compare(const hnbrdf_model *exact, const scene *s, float f[PAIRS][3], long *differing)
{
    const check_rules rules = check_rules_unordered(&CPU);
    hnbrdf_model_desc desc;
    double worst = 0.0;
    hnbrdf_model_describe(exact, &desc);
    for (int k = 0; k < PAIRS; k++) {
        const hnbrdf_material *material = &s->materials[s->index[k]];
        check_bounds bounds;
        float value[3];
        hnbrdf_eval(exact, material, s->wi[k], s->wo[k], value);
        check_bounds_make(&rules, &desc, HNBRDF_GLSL_FLOAT, material, s->wi[k], s->wo[k], 0.0,
                          &bounds);
        for (int c = 0; c < 3; c++) {
            const check_tracked *bound = &bounds.value[c];
            assert_true(bound->v == value[c]);
            *differing += f[k][c] != value[c];
            double apart = fabs((double)f[k][c] - (double)value[c]);
            assert_true(apart <= bound->e);
            if (bound->e > 0.0 && bound->e < (double)INFINITY)
                worst = fmax(worst, apart / bound->e);
        }
    }
    return worst;
}

/* The densities of all pairs, likewise. */
static void compare_densities(const hnbrdf_model *exact, const hnbrdf_model *fused, const scene *s)
{
    const check_rules rules = check_rules_unordered(&CPU);
    float pdf[PAIRS];
    hnbrdf_pdf_many(fused, s->materials, s->index, PAIRS, s->wi[0], 0, s->wo[0], 0, pdf, 0);
    for (int k = 0; k < PAIRS; k++) {
        hnbrdf_prepared prepared;
        hnbrdf_prepare(exact, &s->materials[s->index[k]], &prepared);
        const check_tracked bound = check_density_make(&rules, &prepared, s->wi[k], s->wo[k], 0.0);
        assert_true(bound.v == hnbrdf_prepared_pdf(&prepared, s->wi[k], s->wo[k]));
        assert_true(fabs((double)pdf[k] - (double)bound.v) <= bound.e);
    }
}

static void check_variant(hnbrdf_variant variant)
{
    static const int sizes[][3] = {{32, 2, 4}, {16, 2, 4}, {13, 1, 0}, {64, 3, 12}};
    rng r = rng_make(77);
    double worst = 0.0;
    long differing[CALLS] = {0};
    static scene s;
    for (int kind = HNBRDF_KIND_HYBRID; kind <= HNBRDF_KIND_GGX; kind++)
        for (int encoding = 0; hnbrdf_encoding_name((hnbrdf_encoding)encoding); encoding++) {
            const int *size = sizes[(kind + encoding) % 4];
            hnbrdf_model *model = random_model(&r, (hnbrdf_kind)kind, (hnbrdf_encoding)encoding,
                                               kind == HNBRDF_KIND_GGX ? 0 : size[0],
                                               kind == HNBRDF_KIND_GGX ? 0 : size[1],
                                               kind == HNBRDF_KIND_GGX ? 0 : size[2]);
            hnbrdf_model *exact = in_variant(model, HNBRDF_VARIANT_PLAIN);
            hnbrdf_model *fused = in_variant(model, variant);
            fill(&r, &s);
            for (int call = 0; call < CALLS; call++) {
                static float f[PAIRS][3];
                evaluate(fused, &s, call, f);
                worst = fmax(worst, compare(exact, &s, f, &differing[call]));
            }
            compare_densities(exact, fused, &s);
            hnbrdf_model_free(fused);
            hnbrdf_model_free(exact);
            hnbrdf_model_free(model);
        }
    print_message("%s: at most %.3f of the bound; %ld, %ld, %ld of %d values differ\n",
                  hnbrdf_variant_name(variant), worst, differing[0], differing[1], differing[2],
                  3 * PAIRS * 15);
    for (int call = 0; call < CALLS; call++) /* it is fused */
        assert_true(differing[call] > 0);
}

static void values_are_within_their_bounds(void **state)
{
    (void)state;
    int tried = 0;
    for (int v = HNBRDF_VARIANT_PLAIN; hnbrdf_variant_name((hnbrdf_variant)v); v++)
        if (hnbrdf_variant_available((hnbrdf_variant)v) &&
            !hnbrdf_variant_is_exact((hnbrdf_variant)v)) {
            check_variant((hnbrdf_variant)v);
            tried++;
        }
    if (!tried)
        skip();
}

static void the_exact_variants_do_not_fuse(void **state)
{
    (void)state;
    rng r = rng_make(78);
    static scene s;
    static float f[PAIRS][3];
    fill(&r, &s);
    hnbrdf_model *model =
        random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES_DIRECTED, 32, 2, 4);
    hnbrdf_model *exact = in_variant(model, HNBRDF_VARIANT_PLAIN);
    for (int v = HNBRDF_VARIANT_PLAIN; hnbrdf_variant_name((hnbrdf_variant)v); v++) {
        if (!hnbrdf_variant_available((hnbrdf_variant)v) ||
            !hnbrdf_variant_is_exact((hnbrdf_variant)v))
            continue;
        hnbrdf_model *own = in_variant(model, (hnbrdf_variant)v);
        for (int call = 0; call < CALLS; call++) {
            long differing = 0;
            evaluate(own, &s, call, f);
            compare(exact, &s, f, &differing);
            assert_int_equal(differing, 0);
        }
        hnbrdf_model_free(own);
    }
    hnbrdf_model_free(exact);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_within_their_bounds),
        cmocka_unit_test(the_exact_variants_do_not_fuse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
