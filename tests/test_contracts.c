/* test_contracts.c: sentences of the public headers that no other test holds. Each test quotes the
 * sentence that it is about. */
#include "core_support.h"

#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

/* A neural 1x1 model of weights 0: f = exp(bias) - floor, the same for every pair. */
static hnbrdf_model *constant_model(const float bias[3], float scale, float floor)
{
    static const float first[6] = {0}, last[3] = {0}, first_bias[1] = {0};
    static const char *const name = "constant";
    hnbrdf_material material;
    hnbrdf_material_init(&material);
    const hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_NEURAL,
                                    .hidden = 1,
                                    .layers = 1,
                                    .scale = scale,
                                    .floor = floor,
                                    .weights = {first, last},
                                    .biases = {first_bias, bias},
                                    .material_count = 1,
                                    .materials = &material,
                                    .names = &name};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_model_create(&desc, NULL, &model, &error))
        fail_msg("%s", error.text);
    return model;
}

static const float UP[3] = {0.0f, 0.0f, 1.0f};

/* ---- hnbrdf.h: results and limits ------------------------------------------------------------ */

/* "What a person is told ... Filled on failure only." */
static void success_leaves_the_error_alone(void **state)
{
    (void)state;
    static const float bias[3] = {0};
    hnbrdf_error error = {"before"};
    hnbrdf_material m;
    hnbrdf_model *model = constant_model(bias, 0.0f, 0.0f), *copy = NULL;
    hnbrdf_model_desc desc;
    hnbrdf_lobes lobes;
    hnbrdf_material_init(&m);
    hnbrdf_model_describe(model, &desc);
    assert_int_equal(hnbrdf_material_check(&m, &error), HNBRDF_OK);
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &copy, &error), HNBRDF_OK);
    assert_int_equal(hnbrdf_lobes_fit(model, &m, &lobes, &error), HNBRDF_OK);
    assert_string_equal(error.text, "before");
    hnbrdf_model_free(copy);
    hnbrdf_model_free(model);
}

/* "The exponent s c + m is clamped to [-HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT] before exp()." */
static void the_exponent_is_clamped_at_both_ends(void **state)
{
    (void)state;
    static const float beyond[3] = {100.0f, -100.0f, 3e38f};
    static const float ends[3] = {HNBRDF_MAX_EXPONENT, -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT};
    hnbrdf_model *far = constant_model(beyond, 0.0f, 0.0f),
                 *near = constant_model(ends, 0.0f, 0.0f);
    float f[3], g[3];
    hnbrdf_eval(far, hnbrdf_model_material(far, 0), UP, UP, f);
    hnbrdf_eval(near, hnbrdf_model_material(near, 0), UP, UP, g);
    assert_same_bits(f, g, 3);
    assert_true(fabs((double)f[0] / exp(80.0) - 1.0) < 4 * UNIT); /* exp to 2 ulp */
    assert_true(fabs((double)f[1] / exp(-80.0) - 1.0) < 4 * UNIT);
    hnbrdf_model_free(far);
    hnbrdf_model_free(near);
}

/* "float scale; s; 0 stands for 1" */
static void a_scale_of_0_stands_for_1(void **state)
{
    (void)state;
    static const float bias[3] = {0.5f, -0.5f, 2.0f};
    hnbrdf_model *zero = constant_model(bias, 0.0f, 0.0f), *one = constant_model(bias, 1.0f, 0.0f);
    hnbrdf_model_desc desc;
    float f[3], g[3];
    hnbrdf_model_describe(zero, &desc);
    assert_true(desc.scale == 1.0f);
    hnbrdf_eval(zero, hnbrdf_model_material(zero, 0), UP, UP, f);
    hnbrdf_eval(one, hnbrdf_model_material(one, 0), UP, UP, g);
    assert_same_bits(f, g, 3);
    hnbrdf_model_free(zero);
    hnbrdf_model_free(one);
}

/* ---- hnbrdf.h: materials --------------------------------------------------------------------- */

/* "40 bytes"; "32 bytes"; "8 bytes"; "45 floats"; "kd 0.5, eta 1.5, alpha 0.5, no rotation,
 * latent 0, lobes 0, fitted 0, energy 0." */
static void a_material_is_45_floats_with_the_documented_start(void **state)
{
    (void)state;
    float expected[45] = {0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 0.5f, 0.5f};
    hnbrdf_material m;
    assert_int_equal(sizeof(hnbrdf_lobes), 40);
    assert_int_equal(sizeof(hnbrdf_fitted), 32);
    assert_int_equal(sizeof(hnbrdf_energy), 8);
    assert_int_equal(sizeof m, sizeof expected);
    memset(&m, 0xa5, sizeof m);
    hnbrdf_material_init(&m);
    assert_memory_equal(&m, expected, sizeof m);
    assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
}

/* "out may be a or b." */
static void a_mixture_may_replace_either_end(void **state)
{
    (void)state;
    rng r = rng_make(901);
    for (int k = 0; k < 1000; k++) {
        const hnbrdf_material a = random_material(&r, k & 1), b = random_material(&r, k & 2);
        hnbrdf_material over_a = a, over_b = b, apart;
        const float t = rng_range(&r, -0.2f, 1.2f);
        hnbrdf_material_mix(&a, &b, t, &apart);
        hnbrdf_material_mix(&over_a, &b, t, &over_a);
        hnbrdf_material_mix(&a, &over_b, t, &over_b);
        assert_memory_equal(&over_a, &apart, sizeof apart);
        assert_memory_equal(&over_b, &apart, sizeof apart);
    }
}

/* "The value f does not depend on them." */
static void lobes_do_not_change_the_value(void **state)
{
    (void)state;
    rng r = rng_make(902);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES, 8, 2, 4);
    for (int k = 0; k < 500; k++) {
        hnbrdf_material m = random_material(&r, 0), other = m;
        float wi[3], wo[3], f[3], g[3];
        random_lobes(&r, &other.lobes);
        direction_uniform(&r, wi);
        direction_uniform(&r, wo);
        hnbrdf_eval(model, &m, wi, wo, f);
        hnbrdf_eval(model, &other, wi, wo, g);
        assert_same_bits(f, g, 3);
    }
    hnbrdf_model_free(model);
}

/* "two GGX lobes ... of roughness clamp(|scale| alpha) (|scale| itself in a neural model, whose
 * alpha means nothing)"; "an edit of alpha carries them along" */
static void lobes_have_the_roughness_the_header_gives_them(void **state)
{
    (void)state;
    rng r = rng_make(903);
    for (int kind = 0; kind < 3; kind++) {
        hnbrdf_model *model = random_model(&r, (hnbrdf_kind)kind, HNBRDF_ENCODING_ANGLES, 8, 1, 4);
        const int neural = kind == HNBRDF_KIND_NEURAL;
        for (int k = 0; k < 2000; k++) {
            hnbrdf_material m = random_material(&r, 0), edited;
            float wi[3], wo[3];
            direction_uniform(&r, wo);
            if (!direction_near_mirror(&r, m.alpha, wo, wi))
                continue;
            random_lobes(&r, &m.lobes);
            edited = m;
            for (int a = 0; a < 2; a++) { /* half as rough, by lobes twice as wide */
                m.alpha[a] = rng_range(&r, 2 * HNBRDF_MIN_ALPHA, 0.5f);
                edited.alpha[a] = neural ? rng_range(&r, 0.1f, 1.0f) : 0.5f * m.alpha[a];
            }
            for (int l = 0; l < HNBRDF_LOBES && !neural; l++)
                edited.lobes.scale[l] = 2.0f * m.lobes.scale[l];
            const float p = hnbrdf_pdf(model, &m, wi, wo), q = hnbrdf_pdf(model, &edited, wi, wo);
            assert_same_bits(&p, &q, 1);
        }
        hnbrdf_model_free(model);
    }
}

/* pdf in double with both shares the same at every knot. */
static double pdf_with(const hnbrdf_model *model, const hnbrdf_material *material, float first,
                       float second, const float wi[3], const float wo[3])
{
    hnbrdf_material m = *material;
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++) {
        m.lobes.share[0][j] = first;
        m.lobes.share[1][j] = second;
    }
    return (double)hnbrdf_pdf(model, &m, wi, wo);
}

/* "Each gets a share of the samples that depends on the view: given at wo.z = 0, 1/9, 4/9 and 1,
 * linear in sqrt(wo.z) between; what is left of 1 is cosine." A share is two products with weights
 * that are off by 5.5 u at most, u the unit round-off: 16 u with its sum; each density is read off
 * with such a share of 1; three roundings for the mixture: below 40 u of all three densities. */
static void shares_are_linear_between_their_knots(void **state)
{
    (void)state;
    rng r = rng_make(904);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_ANGLES, 0, 0, 0);
    for (int k = 0; k < 4000; k++) {
        const double wanted = k % 2 ? k / 2 % 4 : 3.0 * (double)rng_float(&r);
        hnbrdf_material m = random_material(&r, 1);
        float wi[3], wo[3], share[2];
        m.alpha[0] = m.alpha[1] = rng_range(&r, 0.05f, 0.9f);
        direction(fmax(wanted * wanted / 9.0, 1e-20), 1.0, wo);
        const double x = 3.0 * sqrt((double)wo[2]);
        const int below = x < 3.0 ? (int)x : 2;
        direction_uniform(&r, wi);
        random_lobes(&r, &m.lobes);
        for (int l = 0; l < 2; l++)
            share[l] = (float)((double)m.lobes.share[l][below] * (below + 1 - x) +
                               (double)m.lobes.share[l][below + 1] * (x - below));
        const double lobe[2] = {pdf_with(model, &m, 1, 0, wi, wo),
                                pdf_with(model, &m, 0, 1, wi, wo)};
        const double cosine = pdf_with(model, &m, 0, 0, wi, wo);
        const double rest = 1.0 - (double)share[0] - (double)share[1];
        const double expected =
            (double)share[0] * lobe[0] + (double)share[1] * lobe[1] + rest * cosine;
        assert_true(fabs(cosine - (double)wi[2] / pi) <= 4 * UNIT * cosine);
        assert_true(fabs((double)hnbrdf_pdf(model, &m, wi, wo) - expected) <=
                    40 * UNIT * (lobe[0] + lobe[1] + cosine));
    }
    hnbrdf_model_free(model);
}

/* "All zeros ...: one lobe of roughness alpha, whose share is guessed from kd and eta (none in a
 * neural model)." */
static void without_lobes_a_neural_model_samples_by_the_cosine(void **state)
{
    (void)state;
    rng r = rng_make(905);
    hnbrdf_model *neural = random_model(&r, HNBRDF_KIND_NEURAL, HNBRDF_ENCODING_ANGLES, 8, 1, 4);
    hnbrdf_model *ggx = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_ANGLES, 0, 0, 0);
    for (int k = 0; k < 1000; k++) {
        hnbrdf_material m = random_material(&r, 0), one = m;
        float wi[3], wo[3];
        direction_uniform(&r, wi);
        direction_uniform(&r, wo);
        const double p = (double)hnbrdf_pdf(neural, &m, wi, wo);
        assert_true(fabs(p - (double)wi[2] / pi) <= 4 * UNIT * p);
        /* the guess is one share: p = s lobe + (1 - s) cosine with 0.2 <= s <= 0.9 */
        one.lobes.scale[0] = 1.0f;
        const double lobe = pdf_with(ggx, &one, 1, 0, wi, wo), cosine = (double)wi[2] / pi;
        const double q = (double)hnbrdf_pdf(ggx, &m, wi, wo), slack = 40 * UNIT * (lobe + cosine);
        assert_true(q >= fmin(0.2 * lobe + 0.8 * cosine, 0.9 * lobe + 0.1 * cosine) - slack);
        assert_true(q <= fmax(0.2 * lobe + 0.8 * cosine, 0.9 * lobe + 0.1 * cosine) + slack);
    }
    hnbrdf_model_free(neural);
    hnbrdf_model_free(ggx);
}

/* "half of the samples cosine, half GGX with normals drawn from D, all of them and not only the
 * visible ones": pdf = cos/(2 pi) + D h.z/(8 wo.h), in double, with wo.h = |wi + wo|/2. t is a
 * sum of three squares and off by 6 u, D by twice that and 4 u of pi ax ay, the rest by less than
 * 16 u. */
static void the_papers_lobes_have_the_papers_density(void **state)
{
    (void)state;
    rng r = rng_make(906);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_ANGLES, 0, 0, 0);
    for (int k = 0; k < 2000; k++) {
        hnbrdf_material m = random_material(&r, 1);
        float wi[3], wo[3];
        double h[3], length = 0.0, t = 0.0;
        m.alpha[0] = rng_range(&r, 0.05f, 1.0f);
        m.alpha[1] = rng_range(&r, 0.05f, 1.0f);
        hnbrdf_lobes_paper(&m.lobes);
        assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
        direction_uniform(&r, wi);
        direction_uniform(&r, wo);
        for (int c = 0; c < 3; c++) {
            h[c] = (double)wi[c] + (double)wo[c];
            length += h[c] * h[c];
        }
        for (int c = 0; c < 3; c++) {
            h[c] /= sqrt(length);
            t += pow(h[c] / (c < 2 ? (double)m.alpha[c] : 1.0), 2);
        }
        const double d = 1.0 / (pi * (double)m.alpha[0] * (double)m.alpha[1] * t * t);
        const double expected = (double)wi[2] / (2 * pi) + d * h[2] / (4 * sqrt(length));
        assert_true(fabs((double)hnbrdf_pdf(model, &m, wi, wo) - expected) <= 32 * UNIT * expected);
    }
    hnbrdf_model_free(model);
}

/* "No share is under 1/64, so that no weight exceeds 64 pi f." Two roundings of the weight, and
 * the shares are rounded to float. */
static void weights_of_fitted_lobes_are_bounded(void **state)
{
    (void)state;
    rng r = rng_make(907);
    for (int n = 0; n < 3; n++) {
        hnbrdf_model *model = random_model(&r, n == 1 ? HNBRDF_KIND_NEURAL : HNBRDF_KIND_HYBRID,
                                           HNBRDF_ENCODING_ANGLES, 8, 2, 4);
        hnbrdf_material m = random_material(&r, n != 2);
        assert_int_equal(hnbrdf_lobes_fit(model, &m, &m.lobes, NULL), HNBRDF_OK);
        for (int k = 0; k < 20000; k++) {
            const float u[2] = {rng_float(&r), rng_float(&r)};
            hnbrdf_sample_result s;
            float wo[3], f[3];
            direction_uniform(&r, wo);
            hnbrdf_sample(model, &m, wo, u, &s);
            hnbrdf_eval(model, &m, s.wi, wo, f);
            for (int c = 0; c < 3; c++)
                assert_true((double)s.weight[c] <= 64 * pi * (double)f[c] * (1 + 1e-5));
        }
        hnbrdf_model_free(model);
    }
}

/* ---- hnbrdf.h: prepared materials and batches ------------------------------------------------ */

/* "Plain data that the caller owns; copy it freely. It holds what it needs of the material"; "give
 * the bits of their namesakes"; "hnbrdf_prepared_sample() without the weight" */
static void prepared_materials_stand_alone(void **state)
{
    (void)state;
    rng r = rng_make(908);
    for (int kind = 0; kind < 3; kind++) {
        hnbrdf_model *model =
            random_model(&r, (hnbrdf_kind)kind, HNBRDF_ENCODING_ANGLES_ANISOTROPIC, 9, 2, 4);
        for (int k = 0; k < 500; k++) {
            hnbrdf_material m = random_material(&r, 0), spoiled;
            hnbrdf_prepared first, copy;
            hnbrdf_sample_result s, t;
            const float u[2] = {rng_float(&r), rng_float(&r)};
            float wi[3], wo[3], f[3], g[3], drawn[3];
            if (k & 1)
                random_lobes(&r, &m.lobes);
            spoiled = m;
            hnbrdf_prepare(model, &spoiled, &first);
            copy = first;
            memset(&spoiled, 0xff, sizeof spoiled);
            memset(&first, 0xff, sizeof first);
            direction_uniform(&r, wi);
            direction_uniform(&r, wo);
            if (k % 5 == 0)
                wo[2] = -wo[2];
            hnbrdf_eval(model, &m, wi, wo, f);
            hnbrdf_prepared_eval(&copy, wi, wo, g);
            assert_same_bits(f, g, 3);
            const float p = hnbrdf_pdf(model, &m, wi, wo), q = hnbrdf_prepared_pdf(&copy, wi, wo);
            assert_same_bits(&p, &q, 1);
            hnbrdf_sample(model, &m, wo, u, &s);
            hnbrdf_prepared_sample(&copy, wo, u, &t);
            assert_memory_equal(&s, &t, sizeof s);
            const float density = hnbrdf_prepared_draw(&copy, wo, u, drawn);
            assert_same_bits(&density, &s.pdf, 1);
            assert_same_bits(drawn, s.wi, 3);
        }
        hnbrdf_model_free(model);
    }
}

/* "count values of hnbrdf_eval_analytic()." */
static void analytic_batches_have_the_bits_of_single_values(void **state)
{
    (void)state;
    enum { COUNT = 37 };
    rng r = rng_make(909);
    for (int kind = 0; kind < 3; kind++) {
        hnbrdf_model *model = random_model(&r, (hnbrdf_kind)kind, HNBRDF_ENCODING_ANGLES, 8, 1, 4);
        for (int k = 0; k < 50; k++) {
            const hnbrdf_material m = random_material(&r, k & 1);
            float wi[COUNT][3], wo[COUNT][4], f[COUNT][5], g[3];
            for (int i = 0; i < COUNT; i++) {
                direction_uniform(&r, wi[i]);
                direction_uniform(&r, wo[i]);
                if (i % 7 == 3)
                    wi[i][2] = -wi[i][2];
            }
            hnbrdf_eval_analytic_batch(model, &m, COUNT, wi[0], 0, wo[0], sizeof wo[0], f[0],
                                       sizeof f[0]);
            for (int i = 0; i < COUNT; i++) {
                hnbrdf_eval_analytic(model, &m, wi[i], wo[i], g);
                assert_same_bits(f[i], g, 3);
            }
        }
        hnbrdf_model_free(model);
    }
}

/* ---- measured.h ------------------------------------------------------------------------------ */

/* "(u32 >> 8) * 2^-24, in [0, 1)"; "the lowest bit of the stream counts as set"; "the top bit of
 * sequence is not used" */
static void random_numbers_are_made_as_stated(void **state)
{
    (void)state;
    hnbrdf_rng a, b;
    hnbrdf_rng_seed(&a, 5, 9);
    b = a;
    for (int k = 0; k < 100; k++)
        assert_true(hnbrdf_rng_float(&a) == (float)(hnbrdf_rng_u32(&b) >> 8) * 0x1p-24f);
    b = a;
    b.stream &= ~UINT64_C(1);
    for (int k = 0; k < 100; k++)
        assert_int_equal(hnbrdf_rng_u32(&a), hnbrdf_rng_u32(&b));
    hnbrdf_rng_seed(&a, 5, 9);
    hnbrdf_rng_seed(&b, 5, 9 | UINT64_C(1) << 63);
    assert_int_equal(hnbrdf_rng_u32(&a), hnbrdf_rng_u32(&b));
    int equal = 0; /* another sequence is another stream */
    hnbrdf_rng_seed(&b, 5, 10);
    for (int k = 0; k < 100; k++)
        equal += hnbrdf_rng_u32(&a) == hnbrdf_rng_u32(&b);
    assert_true(equal < 3);
}

/* "Draw one pair of unit vectors with wi.z >= 0.01 and wo.z >= 0.01." A component rounds to half
 * an ulp. */
static void samplers_draw_unit_vectors_away_from_the_horizon(void **state)
{
    (void)state;
    for (hnbrdf_sampler s = HNBRDF_SAMPLER_UNIFORM; hnbrdf_sampler_name(s); s++) {
        hnbrdf_rng pcg;
        float lowest = 1.0f;
        hnbrdf_rng_seed(&pcg, 3, s);
        for (int k = 0; k < 50000; k++) {
            float w[2][3];
            hnbrdf_sampler_draw(s, &pcg, w[0], w[1]);
            for (int i = 0; i < 2; i++) {
                const double x = (double)w[i][0], y = (double)w[i][1], z = (double)w[i][2];
                assert_true(w[i][2] >= 0.01f);
                assert_true(fabs(sqrt(x * x + y * y + z * z) - 1.0) <= 4 * UNIT);
                lowest = fminf(lowest, w[i][2]);
            }
        }
        assert_true(lowest < 0.02f); /* and they go down to it */
    }
}

/* ---- metrics.h ------------------------------------------------------------------------------- */

/* "share of those values that are exactly 0"; "1: no value seen was negative or not finite"; "0
 * where the encoding is reciprocal"; albedo of a constant c is pi c, "good to 0.5 %". */
static void physics_of_a_constant_are_known(void **state)
{
    (void)state;
    const float bias[3] = {logf(0.1f), logf(0.2f), logf(0.3f)}, dark[3] = {-9.0f, -9.0f, -9.0f};
    hnbrdf_model *model = constant_model(bias, 0.0f, 0.0f),
                 *black = constant_model(dark, 0.0f, 1.0f);
    hnbrdf_physics physics;
    double albedo[3];
    hnbrdf_physics_of(model, hnbrdf_model_material(model, 0), &physics);
    assert_true(fabs(physics.albedo / (0.3 * pi) - 1.0) < 0.005);
    assert_int_equal(physics.albedo_channel, 2);
    assert_true(physics.black == 0.0 && physics.valid == 1);
    assert_true(physics.reciprocity == 0.0 && physics.reciprocity_worst == 0.0);
    hnbrdf_albedo(model, hnbrdf_model_material(model, 0), UP, albedo);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(albedo[c] / (0.1 * (c + 1) * pi) - 1.0) < 0.005);
    hnbrdf_physics_of(black, hnbrdf_model_material(black, 0), &physics);
    assert_true(physics.black == 1.0 && physics.albedo == 0.0 && physics.valid == 1);
    hnbrdf_model_free(model);
    hnbrdf_model_free(black);
}

/* ---- fit.h ----------------------------------------------------------------------------------- */

/* A short fit of two built-in materials; the analytic part is given, as a search for it is slow. */
static hnbrdf_model *short_fit(hnbrdf_fit_options o)
{
    hnbrdf_measured *data[2];
    hnbrdf_material given[2];
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    for (int m = 0; m < 2; m++) {
        assert_int_equal(hnbrdf_measured_open_builtin(m, &data[m], NULL), HNBRDF_OK);
        hnbrdf_material_init(&given[m]);
    }
    o.materials = given;
    o.steps = 12;
    if (hnbrdf_fit((const hnbrdf_measured *const *)data, 2, &o, &model, NULL, &error))
        fail_msg("%s", error.text);
    for (int m = 0; m < 2; m++)
        hnbrdf_measured_close(data[m]);
    return model;
}

/* 1 if both fits give the same network and latent codes. */
static int same_fit(hnbrdf_fit_options a, hnbrdf_fit_options b)
{
    hnbrdf_model *models[2] = {short_fit(a), short_fit(b)};
    hnbrdf_model_desc x, y;
    hnbrdf_model_describe(models[0], &x);
    hnbrdf_model_describe(models[1], &y);
    int same = x.hidden == y.hidden && x.layers == y.layers && x.latent == y.latent &&
               x.encoding == y.encoding && x.floor == y.floor;
    for (int k = 0; same && k <= x.layers; k++) {
        const int in = k == 0 ? 6 + x.latent : x.hidden;
        const int out = k < x.layers ? x.hidden : x.kind == HNBRDF_KIND_HYBRID ? 6 : 3;
        same = memcmp(x.weights[k], y.weights[k], sizeof(float) * (size_t)(in * out)) == 0;
    }
    for (int m = 0; same && m < 2; m++)
        same =
            memcmp(x.materials[m].latent, y.materials[m].latent, sizeof x.materials[m].latent) == 0;
    hnbrdf_model_free(models[0]);
    hnbrdf_model_free(models[1]);
    return same;
}

/* "0 stands for" of every number in hnbrdf_fit_options, one by one. */
static void options_of_0_stand_for_their_defaults(void **state)
{
    (void)state;
    const hnbrdf_fit_options hybrid = {.pool = 2048, .seed = 4},
                             neural = {.kind = HNBRDF_KIND_NEURAL, .pool = 2048, .seed = 4};
    hnbrdf_fit_options o = hybrid;
    o.hidden = 32;
    o.layers = 2;
    o.latent = 4;
    o.floor = 0.003f;
    o.batch = 2048;
    o.learning_rate = 6e-2f;
    o.uniform_share = 0.667f;
    o.horizon_share = 0.03f;
    o.bright_share = 0.25f;
    o.lift = 1.0f;
    o.encoding = "angles";
    assert_true(same_fit(o, hybrid));
    o = neural;
    o.latent = 12;
    assert_true(same_fit(o, neural));
    o.hidden = 64; /* the rate falls with HN above 64 */
    hnbrdf_fit_options half = o;
    half.learning_rate = 3e-2f;
    assert_true(same_fit(o, half));
    o = half = neural;
    o.pool = 0;
    half.pool = 131072;
    assert_true(same_fit(o, half));
}

/* "flag named ..._none asks for it"; "rounded up to a multiple of 1024" */
static void other_options_change_the_fit_as_stated(void **state)
{
    (void)state;
    const hnbrdf_fit_options neural = {.kind = HNBRDF_KIND_NEURAL, .pool = 2048, .seed = 4};
    hnbrdf_fit_options o = neural, p = neural;
    o.uniform_none = 1;
    assert_false(same_fit(o, neural));
    p.uniform_share = 1.0f;
    assert_false(same_fit(o, p));
    o = neural;
    o.floor_none = 1;
    assert_false(same_fit(o, neural));
    o = neural;
    o.latent_none = 1;
    assert_false(same_fit(o, neural));
    o = p = neural;
    o.batch = 1;
    p.batch = 1024;
    assert_true(same_fit(o, p));
    o.batch = 1025;
    assert_false(same_fit(o, p));
    p.batch = 2048;
    assert_true(same_fit(o, p));
    p.seed = 5;
    assert_false(same_fit(o, p));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(success_leaves_the_error_alone),
        cmocka_unit_test(the_exponent_is_clamped_at_both_ends),
        cmocka_unit_test(a_scale_of_0_stands_for_1),
        cmocka_unit_test(a_material_is_45_floats_with_the_documented_start),
        cmocka_unit_test(a_mixture_may_replace_either_end),
        cmocka_unit_test(lobes_do_not_change_the_value),
        cmocka_unit_test(lobes_have_the_roughness_the_header_gives_them),
        cmocka_unit_test(shares_are_linear_between_their_knots),
        cmocka_unit_test(without_lobes_a_neural_model_samples_by_the_cosine),
        cmocka_unit_test(the_papers_lobes_have_the_papers_density),
        cmocka_unit_test(weights_of_fitted_lobes_are_bounded),
        cmocka_unit_test(prepared_materials_stand_alone),
        cmocka_unit_test(analytic_batches_have_the_bits_of_single_values),
        cmocka_unit_test(random_numbers_are_made_as_stated),
        cmocka_unit_test(samplers_draw_unit_vectors_away_from_the_horizon),
        cmocka_unit_test(physics_of_a_constant_are_known),
        cmocka_unit_test(options_of_0_stand_for_their_defaults),
        cmocka_unit_test(other_options_change_the_fit_as_stated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
