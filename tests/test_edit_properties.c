/* test_edit_properties.c: what an artist expects of an edit, of every shipped and built-in
 * material. The built-in ones are fitted here, for a moment: what holds, holds of coarse fits. */
#include "hnbrdf/edit.h"
#include "hnbrdf/fit.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MODELS = 2, MOST_BUILTIN = 32 };
static hnbrdf_model *models[MODELS];

static hnbrdf_model *fit_builtin(void)
{
    hnbrdf_measured *data[MOST_BUILTIN];
    const hnbrdf_fit_options options = {
        .hidden = 16, .layers = 2, .steps = 1200, .pool = 8192, .seed = 1};
    hnbrdf_model *model = NULL;
    int count = 0;
    while (count < MOST_BUILTIN && hnbrdf_measured_builtin_name(count)) {
        if (hnbrdf_measured_open_builtin(count, &data[count], NULL))
            return NULL;
        count++;
    }
    hnbrdf_fit((const hnbrdf_measured *const *)data, count, &options, &model, NULL, NULL);
    for (int k = 0; k < count; k++)
        hnbrdf_measured_close(data[k]);
    return model;
}

static int open_models(void **state)
{
    (void)state;
    models[0] = fit_builtin();
    return !models[0] || hnbrdf_model_load(HNBRDF_EXAMPLE_MODEL, NULL, &models[1], NULL);
}

static int close_models(void **state)
{
    (void)state;
    for (int k = 0; k < MODELS; k++)
        hnbrdf_model_free(models[k]);
    return 0;
}

/* Calls `look` for every material of both models. */
static void each_material(void (*look)(const hnbrdf_model *, const char *, const hnbrdf_material *))
{
    for (int k = 0; k < MODELS; k++)
        for (int m = 0; m < hnbrdf_model_material_count(models[k]); m++)
            look(models[k], hnbrdf_model_material_name(models[k], m),
                 hnbrdf_model_material(models[k], m));
}

/* ---- Looking --------------------------------------------------------------------------------- */

/* Green at the light's angle t in the plane of incidence, the viewer at 20 degrees across. */
static double seen_at(const hnbrdf_prepared *prepared, double t)
{
    const double view = 0.35;
    const float wo[3] = {(float)-sin(view), 0.0f, (float)cos(view)};
    const float wi[3] = {(float)sin(t), 0.0f, (float)cos(t)};
    float f[3];
    hnbrdf_prepared_eval(prepared, wi, wo, f);
    return (double)f[1];
}

typedef struct highlight {
    double peak, base; /* the largest and the smallest value of the plane */
    double width;      /* between the half heights above the base, radians */
} highlight;

/* The peak on the mirror's side; 5e-4 rad is a fortieth of the narrowest one that is asked for. */
static highlight highlight_of(const hnbrdf_model *model, const hnbrdf_material *material)
{
    const double step = 5e-4, end = 1.4;
    hnbrdf_prepared prepared;
    highlight h = {0.0, INFINITY, 0.0};
    double at = 0.0;
    hnbrdf_prepare(model, material, &prepared);
    for (double t = -end; t < end; t += step) {
        const double v = seen_at(&prepared, t);
        h.base = fmin(h.base, v);
        if (t > 0.0 && v > h.peak) {
            h.peak = v;
            at = t;
        }
    }
    const double half = 0.5 * (h.peak + h.base);
    double low = at, high = at;
    while (low > -end && seen_at(&prepared, low) > half)
        low -= step;
    while (high < end && seen_at(&prepared, high) > half)
        high += step;
    h.width = high - low;
    return h;
}

/* A highlight that stands out, and that is not cut off by the horizon after all edits below. */
static int is_glossy(const highlight *h)
{
    return h->peak > 20.0 * h->base && h->width < 0.35;
}

static hnbrdf_material scaled_alpha(const hnbrdf_material *material, float factor)
{
    hnbrdf_material edited = *material;
    for (int k = 0; k < 2; k++)
        edited.alpha[k] =
            fminf(fmaxf(edited.alpha[k] * factor, HNBRDF_MIN_ALPHA), HNBRDF_MAX_ALPHA);
    return edited;
}

/* ---- Alpha ----------------------------------------------------------------------------------- */

static int glossy_tried;

static void look_at_width(const hnbrdf_model *model, const char *name, const hnbrdf_material *as_is)
{
    static const float factors[] = {0.5f, 0.75f, 1.0f, 1.5f, 2.0f};
    const highlight fitted = highlight_of(model, as_is);
    double before = 0.0;
    if (!is_glossy(&fitted))
        return;
    for (int k = 0; k < 5; k++) {
        const hnbrdf_material edited = scaled_alpha(as_is, factors[k]);
        const highlight h = highlight_of(model, &edited);
        const double share = h.width / (fitted.width * (double)factors[k]);
        if (!(h.width > before))
            fail_msg("%s: alpha times %g narrows the highlight: %g after %g", name,
                     (double)factors[k], h.width, before);
        before = h.width;
        if (!(fabs(share - 1.0) <= 0.15))
            fail_msg("%s: alpha times %g makes the highlight %g times as wide", name,
                     (double)factors[k], h.width / fitted.width);
        glossy_tried++;
    }
}

/* The width at half maximum follows alpha: monotonically, and by the factor asked for within 15 %.
 * (Measured: 12 % at twice the roughness, 3 % below the fitted one.) */
static void larger_alpha_widens_the_highlight_by_as_much(void **state)
{
    (void)state;
    each_material(look_at_width);
    print_message("    %d widths\n", glossy_tried);
    assert_true(glossy_tried >= 60);
}

/* Directional albedo, green, the viewer at 20 degrees: the mean of sampled weights. */
static double albedo(const hnbrdf_model *model, const hnbrdf_material *material)
{
    enum { SAMPLES = 1 << 13 };
    const float wo[3] = {(float)-sin(0.35), 0.0f, (float)cos(0.35)};
    hnbrdf_prepared prepared;
    hnbrdf_rng rng;
    double sum = 0.0;
    hnbrdf_prepare(model, material, &prepared);
    hnbrdf_rng_seed(&rng, 17, 0);
    for (int k = 0; k < SAMPLES; k++) {
        const float u[2] = {((float)k + hnbrdf_rng_float(&rng)) / SAMPLES, hnbrdf_rng_float(&rng)};
        hnbrdf_sample_result result;
        hnbrdf_prepared_sample(&prepared, wo, u, &result);
        sum += (double)result.weight[1];
    }
    return sum / SAMPLES;
}

/* Within an eighth (measured: a tenth) between half and one and a half times the roughness. Beyond,
 * wide lobes reach below the horizon, and light that would be scattered twice is lost, as with GGX
 * alone. */
static void conductors_reflect_as_much_as_before(void **state)
{
    static const char *const conductors[] = {"gold-two-lobe", "haze-aluminium",
                                             "near-mirror-chrome", "anodised-titanium"};
    static const float factors[] = {0.5f, 0.75f, 1.5f};
    (void)state;
    for (int k = 0; k < 4; k++) {
        const hnbrdf_material *as_is =
            hnbrdf_model_material(models[0], hnbrdf_model_find(models[0], conductors[k]));
        assert_non_null(as_is);
        for (int f = 0; f < 3; f++) {
            const hnbrdf_material edited = scaled_alpha(as_is, factors[f]);
            const double ratio = albedo(models[0], &edited) / albedo(models[0], as_is);
            if (!(fabs(ratio - 1.0) <= 0.125))
                fail_msg("%s: alpha times %g reflects %g times as much", conductors[k],
                         (double)factors[f], ratio);
        }
    }
}

/* ---- kd and eta ------------------------------------------------------------------------------ */

/* pi times f, green, over pairs far from the mirror and from retroreflection. */
static double diffuse_level(const hnbrdf_model *model, const hnbrdf_material *material)
{
    const float wo[3] = {0.70710678f, 0.0f, 0.70710678f};
    double sum = 0.0;
    for (int k = 0; k < 64; k++) {
        const double theta = (20.0 + 40.0 * (k % 8) / 7.0) * 0.0174532925;
        const double phi = (60.0 + 60.0 * (k / 8) / 7.0) * 0.0174532925;
        const float wi[3] = {(float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                             (float)cos(theta)};
        float f[3];
        hnbrdf_eval(model, material, wi, wo, f);
        sum += (double)f[1];
    }
    return 3.14159265358979 * sum / 64.0;
}

static double least_shift = INFINITY, largest_shift;

static void look_at_diffuse(const hnbrdf_model *model, const char *name,
                            const hnbrdf_material *as_is)
{
    hnbrdf_material brighter = *as_is;
    if (as_is->kd[1] > 0.9f)
        return;
    brighter.kd[1] += 0.1f;
    const double shift = diffuse_level(model, &brighter) - diffuse_level(model, as_is);
    if (!(shift >= 0.05 && shift <= 0.2))
        fail_msg("%s: 0.1 more of kd shifts the diffuse level by %g", name, shift);
    least_shift = fmin(least_shift, shift);
    largest_shift = fmax(largest_shift, shift);
}

/* Also where the fit put nothing into kd, or the network does nearly all: f_a alone would shift it
 * by as little as 0.01. */
static void kd_shifts_the_diffuse_level(void **state)
{
    (void)state;
    each_material(look_at_diffuse);
    print_message("    0.1 more of kd: %.3f to %.3f\n", least_shift, largest_shift);
}

static int reflectances_tried;

static void look_at_reflectance(const hnbrdf_model *model, const char *name,
                                const hnbrdf_material *as_is)
{
    const float n[3] = {0.0f, 0.0f, 1.0f};
    const highlight h = highlight_of(model, as_is);
    hnbrdf_material edited = *as_is;
    float before[3], after[3];
    if (!is_glossy(&h))
        return;
    for (int c = 0; c < 3; c++) {
        const double r = sqrt(0.5) * ((double)edited.eta[c] - 1.0) / ((double)edited.eta[c] + 1.0);
        edited.eta[c] = (float)((1.0 + r) / (1.0 - r));
    }
    hnbrdf_eval(model, as_is, n, n, before);
    hnbrdf_eval(model, &edited, n, n, after);
    const double ratio = (double)after[1] / (double)before[1];
    /* What is not reflected by the surface, up to a twentieth of the peak, stays. */
    if (!(ratio >= 0.5 - 1e-3 && ratio <= 0.5 + 0.5 * 1.5 / 20.0))
        fail_msg("%s: half the reflectance gives %g of the value", name, ratio);
    reflectances_tried++;
}

static void eta_scales_the_reflectance(void **state)
{
    (void)state;
    each_material(look_at_reflectance);
    assert_true(reflectances_tried >= 12);
}

/* ---- Any edit -------------------------------------------------------------------------------- */

static float between(hnbrdf_rng *rng, float low, float high)
{
    return low + (high - low) * hnbrdf_rng_float(rng);
}

/* Mostly of one field, as with sliders. */
static void any_edit(hnbrdf_rng *rng, hnbrdf_material *m)
{
    const unsigned what = hnbrdf_rng_u32(rng) % 4;
    for (int k = 0; k < 2 && what != 1 && what != 2; k++)
        m->alpha[k] = fmaxf(expf(between(rng, -9.2f, 0.0f)), HNBRDF_MIN_ALPHA);
    for (int c = 0; c < 3; c++) {
        if (what == 1 || what == 3)
            m->kd[c] = hnbrdf_rng_float(rng);
        if (what == 2 || what == 3)
            m->eta[c] = 1.0f + expf(between(rng, -8.0f, 6.9f));
    }
    if (what == 3)
        m->rotation = between(rng, -3.0f, 3.0f);
}

static int is_reciprocal(const hnbrdf_model *model)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    return hnbrdf_encoding_is_reciprocal(desc.encoding);
}

static void look_at_edits(const hnbrdf_model *model, const char *name, const hnbrdf_material *as_is)
{
    enum { EDITS = 24, PAIRS = 16 };
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 23, 0);
    for (int e = 0; e < EDITS; e++) {
        hnbrdf_material edited = *as_is;
        any_edit(&rng, &edited);
        assert_int_equal(hnbrdf_material_check(&edited, NULL), HNBRDF_OK);
        assert_int_equal(hnbrdf_material_is_edited(&edited), 1);
        for (int k = 0; k < PAIRS; k++) {
            float wi[3], wo[3], f[3], back[3], fitted[3];
            hnbrdf_sampler_draw(k % 2 ? HNBRDF_SAMPLER_GRID : HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
            hnbrdf_eval(model, &edited, wi, wo, f);
            for (int c = 0; c < 3; c++)
                if (!(f[c] >= 0.0f && isfinite(f[c])))
                    fail_msg("%s: an edit gives %g", name, (double)f[c]);
            hnbrdf_eval(model, &edited, wo, wi, back);
            if (is_reciprocal(model))
                assert_memory_equal(back, f, sizeof back);
            hnbrdf_material restored = edited;
            memcpy(restored.kd, as_is->kd, sizeof restored.kd);
            memcpy(restored.eta, as_is->eta, sizeof restored.eta);
            memcpy(restored.alpha, as_is->alpha, sizeof restored.alpha);
            restored.rotation = as_is->rotation;
            hnbrdf_eval(model, &restored, wi, wo, back);
            hnbrdf_eval(model, as_is, wi, wo, fitted);
            assert_memory_equal(back, fitted, sizeof back);
        }
        for (int k = 0; k < PAIRS; k++) {
            float wi[3], wo[3], f[3];
            const float u[2] = {hnbrdf_rng_float(&rng), hnbrdf_rng_float(&rng)};
            hnbrdf_sample_result drawn;
            hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
            hnbrdf_sample(model, &edited, wo, u, &drawn);
            if (!(drawn.pdf > 0.0f))
                continue;
            const float pdf = hnbrdf_pdf(model, &edited, drawn.wi, wo);
            assert_true(pdf == drawn.pdf);
            hnbrdf_eval(model, &edited, drawn.wi, wo, f);
            for (int c = 0; c < 3; c++) /* two roundings */
                assert_true(fabs((double)f[c] * (double)drawn.wi[2] / (double)pdf -
                                 (double)drawn.weight[c]) <= 2.4e-7 * (double)drawn.weight[c]);
        }
    }
}

static void any_edit_is_finite_sampled_and_taken_back(void **state)
{
    (void)state;
    each_material(look_at_edits);
}

/* A saved model knows what it was fitted with, and an unedited one is saved as before. */
static void a_file_keeps_what_a_material_was_fitted_with(void **state)
{
    static const char path[] = "test_edit_properties.safetensors";
    const hnbrdf_model *model = models[1];
    hnbrdf_material edited = scaled_alpha(hnbrdf_model_material(model, 2), 1.5f);
    const hnbrdf_material_change change = {.kind = HNBRDF_CHANGE_REPLACE,
                                           .name = hnbrdf_model_material_name(model, 2),
                                           .material = &edited};
    hnbrdf_model *changed, *loaded;
    hnbrdf_error error = {""};
    (void)state;
    assert_int_equal(hnbrdf_model_with_materials(model, &change, 1, NULL, &changed, &error),
                     HNBRDF_OK);
    assert_int_equal(hnbrdf_model_save(changed, path, &error), HNBRDF_OK);
    assert_int_equal(hnbrdf_model_load(path, NULL, &loaded, &error), HNBRDF_OK);
    for (int m = 0; m < hnbrdf_model_material_count(model); m++) {
        const hnbrdf_material *found = hnbrdf_model_material(loaded, m);
        assert_int_equal(hnbrdf_material_is_edited(found), m == 2);
        assert_memory_equal(found, hnbrdf_model_material(changed, m), sizeof *found);
    }
    remove(path);
    hnbrdf_model_free(changed);
    hnbrdf_model_free(loaded);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(larger_alpha_widens_the_highlight_by_as_much),
        cmocka_unit_test(conductors_reflect_as_much_as_before),
        cmocka_unit_test(kd_shifts_the_diffuse_level),
        cmocka_unit_test(eta_scales_the_reflectance),
        cmocka_unit_test(any_edit_is_finite_sampled_and_taken_back),
        cmocka_unit_test(a_file_keeps_what_a_material_was_fitted_with),
    };
    return cmocka_run_group_tests(tests, open_models, close_models);
}
