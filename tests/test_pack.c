/* test_pack.c: materials as texels: what comes back, how near, and that any bits are a legal
 * material. Bounds are those that hnbrdf.h states; beside them stands the rounding of float: a
 * few operations, each within 2^-24 relative, on numbers along the curve that are at most 9.3
 * (the logarithm of 1e-4). */
#include "core_support.h"

#include "core/half.h"
#include "core/prepared.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>

enum { TRIALS = 2000 };

static const double FLOAT_ERROR = 4e-6;

/* Everything stored, the whole of every legal range, latent codes in [-3, 5]. */
static hnbrdf_packing full_packing(hnbrdf_texel_format format)
{
    hnbrdf_packing packing = {.format = format,
                              .analytic = 1,
                              .anisotropic = 1,
                              .rotated = 1,
                              .edited = 1,
                              .lobes = 1,
                              .latent = HNBRDF_MAX_LATENT,
                              .kd = {0.0f, 1.0f},
                              .eta = {1.0f, HNBRDF_MAX_ETA},
                              .alpha = {HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA}};
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++) {
        packing.latent_range[i][0] = -3.0f;
        packing.latent_range[i][1] = 5.0f;
    }
    assert_int_equal(hnbrdf_packing_check(&packing, NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_packing_texels(&packing), HNBRDF_MAX_TEXELS - 1);
    return packing;
}

static hnbrdf_material any_material(rng *r)
{
    hnbrdf_material material = random_material(r, 0);
    for (int c = 0; c < 3; c++)
        material.eta[c] = 1.0f + rng_log_range(r, 2e-4f, 900.0f);
    material.rotation = rng_range(r, -3.1f, 3.1f);
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        material.latent[i] = rng_range(r, -3.0f, 5.0f);
    if (rng_u32(r) % 4)
        random_lobes(r, &material.lobes);
    if (rng_u32(r) % 4) {
        material = edited_from(r, material);
        for (int c = 0; c < 3; c++)
            material.fitted.eta[c] = 1.0f + rng_log_range(r, 2e-4f, 900.0f);
    }
    return material;
}

static hnbrdf_material round_trip(const hnbrdf_packing *packing, const hnbrdf_material *material)
{
    unsigned char texels[HNBRDF_MAX_TEXELS * 8];
    hnbrdf_material back;
    hnbrdf_error error = {""};
    hnbrdf_material_pack(packing, material, texels);
    hnbrdf_material_unpack(packing, texels, &back);
    if (hnbrdf_material_check(&back, &error))
        fail_msg("%s", error.text);
    return back;
}

static double amplitude(float eta)
{
    return ((double)eta - 1.0) / ((double)eta + 1.0);
}

static void assert_near(const char *field, float value, float back, double error, double bound)
{
    if (!(error <= bound))
        fail_msg("%s: %.9g comes back as %.9g: %g, allowed %g", field, (double)value, (double)back,
                 error, bound);
}

static double turn_between(float a, float b)
{
    return fabs(remainder((double)a - (double)b, 2.0 * 3.14159265358979324));
}

/* What a material was fitted with, in the fields of what it is: stored by the same rules. One that
 * does not know is stored as it is. */
static hnbrdf_material fitted_fields(hnbrdf_material m)
{
    if (m.fitted.alpha[0] == 0.0f)
        return m;
    memcpy(m.kd, m.fitted.kd, sizeof m.kd);
    memcpy(m.eta, m.fitted.eta, sizeof m.eta);
    memcpy(m.alpha, m.fitted.alpha, sizeof m.alpha);
    return m;
}

/* ---- The stated errors ----------------------------------------------------------------------- */

static void half_floats_keep_every_field_within_what_the_header_states(void **state)
{
    (void)state;
    hnbrdf_packing packing = full_packing(HNBRDF_TEXEL_RGBA16F);
    rng r = rng_make(1);
    for (int k = 0; k < TRIALS; k++) {
        hnbrdf_material m = any_material(&r), b = round_trip(&packing, &m);
        if (m.fitted.alpha[0] == 0.0f)
            assert_false(hnbrdf_material_is_edited(&b));
        if (k % 2) { /* then of what it was fitted with */
            m = fitted_fields(m);
            b = fitted_fields(b);
        }
        for (int c = 0; c < 3; c++) {
            double a = fmax(fmin(amplitude(m.eta[c]), 0.998), 1e-4);
            assert_near("kd", m.kd[c], b.kd[c], fabs((double)m.kd[c] - (double)b.kd[c]), 0x1p-12);
            /* eta is a float near 1: its own rounding moves r by up to 2^-24 */
            assert_near("eta", m.eta[c], b.eta[c], fabs(amplitude(b.eta[c]) - a),
                        a * (0x1p-11 + FLOAT_ERROR) + 0x1p-25 + 0x1p-23);
        }
        for (int c = 0; c < 2; c++)
            assert_near("alpha", m.alpha[c], b.alpha[c],
                        fabs((double)m.alpha[c] - (double)b.alpha[c]),
                        (double)m.alpha[c] * 0x1p-11);
        assert_near("rotation", m.rotation, b.rotation, turn_between(m.rotation, b.rotation),
                    3.5e-4);
        for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
            assert_near("latent", m.latent[i], b.latent[i],
                        fabs((double)m.latent[i] - (double)b.latent[i]),
                        fmax(fabs((double)m.latent[i]) * 0x1p-11, 0x1p-25));
    }
}

static void bytes_keep_every_field_within_what_the_header_states(void **state)
{
    (void)state;
    hnbrdf_packing packing = full_packing(HNBRDF_TEXEL_RGBA8);
    rng r = rng_make(2);
    const double root_r = sqrt(0.998) - sqrt(1e-4), log_alpha = log(1e4);
    for (int k = 0; k < TRIALS; k++) {
        hnbrdf_material m = any_material(&r), b = round_trip(&packing, &m);
        if (m.fitted.alpha[0] == 0.0f)
            assert_false(hnbrdf_material_is_edited(&b));
        if (k % 2) { /* then of what it was fitted with */
            m = fitted_fields(m);
            b = fitted_fields(b);
        }
        for (int c = 0; c < 3; c++) {
            double a = fmax(fmin(amplitude(m.eta[c]), 0.998), 1e-4);
            assert_near("kd", m.kd[c], b.kd[c], fabs(sqrt((double)m.kd[c]) - sqrt((double)b.kd[c])),
                        1.0 / 510.0 + FLOAT_ERROR);
            /* sqrt(r) of an r that is uncertain by 2^-24, at least 1e-4: 2^-24 / (2 sqrt(1e-4)) */
            assert_near("eta", m.eta[c], b.eta[c], fabs(sqrt(amplitude(b.eta[c])) - sqrt(a)),
                        root_r / 510.0 + FLOAT_ERROR + 3e-6);
        }
        for (int c = 0; c < 2; c++)
            assert_near("alpha", m.alpha[c], b.alpha[c],
                        fabs(log((double)m.alpha[c]) - log((double)b.alpha[c])),
                        log_alpha / 510.0 + FLOAT_ERROR);
        assert_near("rotation", m.rotation, b.rotation, turn_between(m.rotation, b.rotation),
                    5.6e-3);
        for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
            assert_near("latent", m.latent[i], b.latent[i],
                        fabs((double)m.latent[i] - (double)b.latent[i]), 8.0 / 510.0 + FLOAT_ERROR);
    }
}

/* v = s/(1 + |s|) within 2^-12 or 1/254, shares within 2^-12 or 1/510: the clamp of their sum moves
 * the second no farther than the first was off. What has no lobes comes back with those that are
 * sampled. */
static void lobes_come_back_within_what_the_header_states(void **state)
{
    (void)state;
    rng r = rng_make(6);
    for (int k = 0; k < 2 * TRIALS; k++) {
        const int half = k % 2;
        hnbrdf_packing packing = full_packing(half ? HNBRDF_TEXEL_RGBA16F : HNBRDF_TEXEL_RGBA8);
        hnbrdf_material m = any_material(&r), b = round_trip(&packing, &m);
        hnbrdf_lobes used;
        hnbrdf_lobes_used(0, &m, &used);
        for (int l = 0; l < HNBRDF_LOBES; l++) {
            const double s = (double)used.scale[l], t = (double)b.lobes.scale[l];
            const double v = s / (1.0 + fabs(s)), w = t / (1.0 + fabs(t));
            assert_near("scale", used.scale[l], b.lobes.scale[l], fabs(v - w),
                        (half ? 0x1p-12 : 1.0 / 254.0) + FLOAT_ERROR);
            for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
                assert_near("share", used.share[l][j], b.lobes.share[l][j],
                            fabs((double)used.share[l][j] - (double)b.lobes.share[l][j]),
                            (half ? 0x1p-12 : 1.0 / 510.0) + FLOAT_ERROR);
        }
    }
}

static void a_narrow_lobe_of_bytes_is_still_there(void **state)
{
    (void)state;
    hnbrdf_packing packing = full_packing(HNBRDF_TEXEL_RGBA8);
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    m.lobes = (hnbrdf_lobes){{-1e-4f, 1e-4f}, {{0.5f, 0.5f, 0.5f, 0.5f}, {0.25f}}};
    const hnbrdf_material b = round_trip(&packing, &m);
    assert_true(b.lobes.scale[0] < 0.0f && b.lobes.scale[1] > 0.0f);
    assert_true(fabsf(b.lobes.share[1][0] - 0.25f) < 1.0f / 500.0f);
}

/* ---- Edges ----------------------------------------------------------------------------------- */

static void ends_of_the_ranges_come_back_as_they_are(void **state)
{
    (void)state;
    for (hnbrdf_texel_format format = HNBRDF_TEXEL_RGBA16F; format <= HNBRDF_TEXEL_RGBA8;
         format++) {
        hnbrdf_packing packing = full_packing(format);
        hnbrdf_material m;
        hnbrdf_material_init(&m);
        m.kd[0] = 0.0f;
        m.kd[1] = 1.0f;
        m.alpha[0] = HNBRDF_MIN_ALPHA;
        m.alpha[1] = HNBRDF_MAX_ALPHA;
        m.latent[0] = -3.0f;
        m.latent[1] = 5.0f;
        hnbrdf_material b = round_trip(&packing, &m);
        assert_true(b.kd[0] == 0.0f && b.kd[1] == 1.0f);
        assert_true(b.alpha[1] == HNBRDF_MAX_ALPHA && b.alpha[0] < HNBRDF_MIN_ALPHA * 1.0005f);
        assert_true(b.latent[0] == -3.0f && b.latent[1] == 5.0f);
        assert_true(b.rotation == 0.0f);
    }
}

/* The reflectance at normal incidence is what an index means: of nearly nothing, and of nearly
 * all. */
static void extreme_indices_keep_their_reflectance(void **state)
{
    (void)state;
    for (hnbrdf_texel_format format = HNBRDF_TEXEL_RGBA16F; format <= HNBRDF_TEXEL_RGBA8;
         format++) {
        hnbrdf_packing packing = full_packing(format);
        hnbrdf_material m;
        hnbrdf_material_init(&m);
        const float etas[3] = {1.001f, 100.0f, HNBRDF_MAX_ETA};
        memcpy(m.eta, etas, sizeof etas);
        hnbrdf_material b = round_trip(&packing, &m);
        for (int c = 0; c < 3; c++) {
            /* r^2 = (sqrt r)^4: 4 r^(3/2) w/510 for bytes; r^2 2^-10 for half floats, 0.998 for
             * 0.9980 */
            double before = pow(amplitude(m.eta[c]), 2.0), after = pow(amplitude(b.eta[c]), 2.0);
            assert_near("reflectance", m.eta[c], b.eta[c], fabs(after - before),
                        format == HNBRDF_TEXEL_RGBA16F ? 0x1p-10 * before + 1e-5
                                                       : 4.0 * pow(before, 0.75) / 510.0 + 4e-5);
        }
    }
}

static void what_is_out_of_range_is_clamped(void **state)
{
    (void)state;
    hnbrdf_packing packing = full_packing(HNBRDF_TEXEL_RGBA8);
    packing.alpha[0] = 0.25f;
    packing.alpha[1] = 0.5f;
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    m.alpha[0] = 0.01f;
    m.alpha[1] = 0.9f;
    m.latent[0] = 1e30f;
    m.latent[1] = -7.0f;
    m.latent[2] = NAN;
    m.latent[3] = -INFINITY;
    hnbrdf_material b = round_trip(&packing, &m);
    assert_true(fabs((double)b.alpha[0] - 0.25) < 1e-6 && fabs((double)b.alpha[1] - 0.5) < 1e-6);
    assert_true(b.latent[0] == 5.0f && b.latent[1] == -3.0f && b.latent[3] == -3.0f);
    packing.format = HNBRDF_TEXEL_RGBA16F;
    b = round_trip(&packing, &m);
    assert_true(b.latent[0] == 65504.0f && b.latent[3] == -65504.0f);
}

/* What a texture can hold after a bad file, a filter or a blend: any bits, any floats. */
static void any_bits_are_a_legal_material(void **state)
{
    (void)state;
    rng r = rng_make(3);
    unsigned char texels[HNBRDF_MAX_TEXELS * 8];
    float channels[HNBRDF_MAX_TEXELS * 4];
    for (int k = 0; k < 4 * TRIALS; k++) {
        hnbrdf_packing packing = full_packing(k % 2 ? HNBRDF_TEXEL_RGBA8 : HNBRDF_TEXEL_RGBA16F);
        hnbrdf_material m;
        for (size_t i = 0; i < sizeof texels; i++)
            texels[i] = (unsigned char)(k < 8 ? k * 0x24 : (int)(rng_u32(&r) >> 24));
        hnbrdf_material_unpack(&packing, texels, &m);
        assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
        for (int i = 0; i < HNBRDF_MAX_TEXELS * 4; i++)
            channels[i] = hnbrdf_bits_to_float((int32_t)rng_u32(&r));
        hnbrdf_material_unpack_channels(&packing, channels, &m);
        assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
    }
}

/* Linear filtering of two materials stays between them, in every field but the rotation. */
static void filtered_texels_lie_between(void **state)
{
    (void)state;
    hnbrdf_packing packing = full_packing(HNBRDF_TEXEL_RGBA8);
    rng r = rng_make(4);
    for (int k = 0; k < TRIALS; k++) {
        hnbrdf_material ends[2] = {any_material(&r), any_material(&r)}, mixed;
        unsigned char texels[2][HNBRDF_MAX_TEXELS * 8];
        float channels[HNBRDF_MAX_TEXELS * 4], t = rng_float(&r);
        for (int e = 0; e < 2; e++) {
            hnbrdf_material_pack(&packing, &ends[e], texels[e]);
            hnbrdf_material_unpack(&packing, texels[e], &ends[e]);
        }
        for (int i = 0; i < HNBRDF_MAX_TEXELS * 4; i++)
            channels[i] = ((1.0f - t) * (float)texels[0][i] + t * (float)texels[1][i]) / 255.0f;
        hnbrdf_material_unpack_channels(&packing, channels, &mixed);
        assert_int_equal(hnbrdf_material_check(&mixed, NULL), HNBRDF_OK);
        double low = fmin((double)ends[0].alpha[0], (double)ends[1].alpha[0]);
        double high = fmax((double)ends[0].alpha[0], (double)ends[1].alpha[0]);
        assert_true((double)mixed.alpha[0] >= low * (1.0 - FLOAT_ERROR));
        assert_true((double)mixed.alpha[0] <= high * (1.0 + FLOAT_ERROR));
    }
}

/* ---- Layout ---------------------------------------------------------------------------------- */

static int texels_of(int analytic, int anisotropic, int rotated, int edited, int latent, int lobes)
{
    const hnbrdf_packing packing = {.analytic = analytic,
                                    .anisotropic = anisotropic,
                                    .rotated = rotated,
                                    .edited = edited,
                                    .latent = latent,
                                    .lobes = lobes};
    return hnbrdf_packing_texels(&packing);
}

static void a_material_takes_no_more_texels_than_its_channels(void **state)
{
    (void)state;
    assert_int_equal(texels_of(1, 0, 0, 0, 0, 0), 2);  /* GGX: 7 channels */
    assert_int_equal(texels_of(1, 0, 0, 0, 4, 0), 3);  /* 11 */
    assert_int_equal(texels_of(1, 1, 0, 0, 4, 0), 3);  /* 12 */
    assert_int_equal(texels_of(1, 1, 1, 0, 4, 0), 4);  /* 14 */
    assert_int_equal(texels_of(1, 1, 1, 0, 4, 1), 6);  /* 24 */
    assert_int_equal(texels_of(1, 0, 0, 1, 4, 0), 5);  /* 18 */
    assert_int_equal(texels_of(0, 0, 0, 0, 12, 0), 3); /* neural */
    assert_int_equal(texels_of(1, 1, 1, 1, 16, 1), HNBRDF_MAX_TEXELS - 1);
    hnbrdf_packing all = full_packing(HNBRDF_TEXEL_RGBA16F);
    all.energy = 1;
    assert_int_equal(hnbrdf_packing_texels(&all), HNBRDF_MAX_TEXELS);
}

/* What conserves energy comes back within what the header states, what does not with k = 1. */
static void energy_comes_back(void **state)
{
    static const hnbrdf_energy given[] = {
        {0.0f, 0.0f}, {1.0f, 0.0f}, {0.3f, 9.7f}, {0.0f, 200.0f}, {0.77f, 0.01f}};
    (void)state;
    for (int format = 0; format < 2; format++)
        for (size_t k = 0; k < sizeof given / sizeof given[0]; k++) {
            hnbrdf_packing packing = full_packing((hnbrdf_texel_format)format);
            hnbrdf_material m;
            hnbrdf_material_init(&m);
            m.energy = given[k];
            assert_true(round_trip(&packing, &m).energy.horizon == 0.0f);
            packing.energy = 1;
            const hnbrdf_energy e = round_trip(&packing, &m).energy;
            const double horizon = k == 0 ? 1.0 : (double)given[k].horizon;
            const double off = fabs((double)e.horizon - horizon), slope = (double)given[k].slope;
            assert_true(off <= (format ? 1.0 / 509.0 : 0x1p-12));
            if (format)
                assert_true(fabs(sqrt((double)e.slope) - sqrt(slope)) <= 1.0 / 31.0);
            else
                assert_true(fabs((double)e.slope - slope) <= 0x1p-11 * slope);
        }
}

static void channels_lie_where_the_header_says(void **state)
{
    (void)state;
    hnbrdf_packing packing = full_packing(HNBRDF_TEXEL_RGBA16F);
    hnbrdf_material m;
    uint16_t texels[HNBRDF_MAX_TEXELS * 4];
    hnbrdf_material_init(&m);
    for (int c = 0; c < 3; c++)
        m.kd[c] = 0.125f * (float)(c + 1);
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        m.latent[i] = (float)(i + 1);
    m.eta[0] = 3.0f;
    m.alpha[0] = 0.25f;
    m.fitted = as_fitted(m).fitted;
    m.fitted.kd[0] = 0.75f;
    m.fitted.alpha[1] = 0.125f;
    m.lobes = (hnbrdf_lobes){{1.0f, -3.0f}, {{0.5f}, {0.0f, 0.0f, 0.0f, 0.25f}}};
    hnbrdf_material_pack(&packing, &m, texels);
    const int places[] = {0, 2, 3, 6, 7, 8, 9, 10, 12, 13, 16, 17, 18, 33, 34, 35, 36, 37, 43};
    const float expected[] = {0.125f, 0.375f, 0.5f, 0.25f, 0.5f, 1.0f,   0.0f, 0.75f, 0.375f, 0.5f,
                              0.25f,  0.125f, 1.0f, 16.0f, 0.5f, -0.75f, 0.5f, 0.0f,  0.25f};
    for (int k = 0; k < 19; k++)
        assert_true(hnbrdf_float_of_half(texels[places[k]]) == expected[k]);
}

static void a_packing_of_a_model_holds_its_materials(void **state)
{
    (void)state;
    rng r = rng_make(5);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES, 8, 2, 4);
    hnbrdf_packing packing;
    hnbrdf_error error = {""};
    const int wrong = 1, first = 0;
    assert_int_equal(hnbrdf_packing_init(model, NULL, 0, HNBRDF_TEXEL_RGBA8, &packing, &error),
                     HNBRDF_OK);
    const hnbrdf_material *m = hnbrdf_model_material(model, 0);
    assert_true(packing.latent == 4 && packing.analytic);
    assert_true(packing.latent_range[2][0] <= m->latent[2] &&
                m->latent[2] <= packing.latent_range[2][1]);
    assert_true(packing.eta[0] <= m->eta[0] && m->eta[0] <= packing.eta[1]);
    hnbrdf_material b = round_trip(&packing, m); /* a range of one number is that number */
    assert_same_bits(&b.latent[0], &m->latent[0], 4);
    assert_int_equal(hnbrdf_packing_init(model, &wrong, 1, HNBRDF_TEXEL_RGBA8, &packing, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "expected 0 to 0"));
    assert_int_equal(hnbrdf_packing_init(model, &first, 0, HNBRDF_TEXEL_RGBA8, &packing, NULL),
                     HNBRDF_ERROR_ARGUMENT);
    hnbrdf_model_free(model);
}

static void impossible_packings_are_refused(void **state)
{
    (void)state;
    hnbrdf_packing good = full_packing(HNBRDF_TEXEL_RGBA8), bad[6];
    for (int k = 0; k < 6; k++)
        bad[k] = good;
    bad[0].kd[1] = 1.5f;
    bad[1].alpha[0] = 0.0f;
    bad[2].eta[0] = 2.0f, bad[2].eta[1] = 1.5f;
    bad[3].latent_range[7][1] = NAN;
    bad[4].latent = HNBRDF_MAX_LATENT + 1;
    bad[5].analytic = bad[5].rotated = bad[5].latent = bad[5].lobes = 0;
    for (int k = 0; k < 6; k++) {
        hnbrdf_error error = {""};
        assert_int_equal(hnbrdf_packing_check(&bad[k], &error), HNBRDF_ERROR_ARGUMENT);
        assert_true(error.text[0] != '\0');
    }
}

/* ---- Half floats ----------------------------------------------------------------------------- */

static void every_half_float_survives(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 0x10000; h++) {
        float value = hnbrdf_float_of_half((uint16_t)h);
        if ((h & 0x7fff) < 0x7c00)
            assert_int_equal(hnbrdf_half_of(value), h);
        else
            assert_true((h & 0x3ff) ? isnan(value) : isinf(value));
    }
}

/* Between two neighbours the nearer one, halfway the even one. */
static void half_floats_round_to_nearest_even(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 0x7bff; h++) {
        double low = (double)hnbrdf_float_of_half((uint16_t)h);
        double high = (double)hnbrdf_float_of_half((uint16_t)(h + 1));
        float middle = (float)(0.5 * (low + high)); /* exact: half floats have 11 bits */
        assert_int_equal(hnbrdf_half_of(middle), h + (h & 1));
        assert_int_equal(hnbrdf_half_of(nextafterf(middle, 0.0f)), h);
        assert_int_equal(hnbrdf_half_of(nextafterf(middle, INFINITY)), h + 1);
        assert_int_equal(hnbrdf_half_of(-middle), 0x8000u + h + (h & 1));
    }
    assert_int_equal(hnbrdf_half_of(65519.9f), 0x7bff);
    assert_int_equal(hnbrdf_half_of(INFINITY), 0x7bff);
    assert_int_equal(hnbrdf_half_of(NAN), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_floats_keep_every_field_within_what_the_header_states),
        cmocka_unit_test(bytes_keep_every_field_within_what_the_header_states),
        cmocka_unit_test(energy_comes_back),
        cmocka_unit_test(lobes_come_back_within_what_the_header_states),
        cmocka_unit_test(a_narrow_lobe_of_bytes_is_still_there),
        cmocka_unit_test(ends_of_the_ranges_come_back_as_they_are),
        cmocka_unit_test(extreme_indices_keep_their_reflectance),
        cmocka_unit_test(what_is_out_of_range_is_clamped),
        cmocka_unit_test(any_bits_are_a_legal_material),
        cmocka_unit_test(filtered_texels_lie_between),
        cmocka_unit_test(a_material_takes_no_more_texels_than_its_channels),
        cmocka_unit_test(channels_lie_where_the_header_says),
        cmocka_unit_test(a_packing_of_a_model_holds_its_materials),
        cmocka_unit_test(impossible_packings_are_refused),
        cmocka_unit_test(every_half_float_survives),
        cmocka_unit_test(half_floats_round_to_nearest_even),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
