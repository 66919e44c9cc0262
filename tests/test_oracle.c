/* test_oracle.c: is the oracle right? Against facts that do not come from its formulas:
 * normalisation, Fresnel's amplitudes, closed forms, a network small enough to write out. */
#include "check/oracle.h"

#include "core_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

static oracle_point ggx_point(const hnbrdf_material *m, const float wi[3], const float wo[3])
{
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_GGX};
    oracle_point point;
    oracle_evaluate(&desc, m, wi, wo, &point);
    return point;
}

/* kd = 0, alpha = 1: D = 1/pi whatever h is, so f = F/pi * G1 G1/(4 wi.z wo.z), and with G1
 * written out by hand F is what is left. Compared with (|rs|^2 + |rp|^2)/2 of Fresnel's
 * amplitudes. */
static void fresnel_is_the_mean_of_the_squared_amplitudes(void **state)
{
    (void)state;
    static const float etas[] = {1.0001f, 1.33f, 1.5f, 3.0f, 100.0f};
    for (size_t e = 0; e < sizeof etas / sizeof etas[0]; e++)
        for (int k = 1; k < 200; k++) {
            hnbrdf_material m;
            hnbrdf_material_init(&m);
            m.alpha[0] = m.alpha[1] = 1.0f;
            for (int c = 0; c < 3; c++) {
                m.kd[c] = 0.0f;
                m.eta[c] = etas[e];
            }
            float wi[3], wo[3];
            direction(k / 200.0, 0.0, wi);
            direction(k / 200.0, pi, wo);
            double s[3], length = 0.0;
            for (int i = 0; i < 3; i++) {
                s[i] = (double)wi[i] + (double)wo[i];
                length += s[i] * s[i];
            }
            double eta = (double)etas[e], cosine = sqrt(length) / 2, sine2 = 1 - cosine * cosine;
            double inside = sqrt(1 - sine2 / (eta * eta));
            double rs = (cosine - eta * inside) / (cosine + eta * inside);
            double rp = (eta * cosine - inside) / (eta * cosine + inside);
            double g[2];
            for (int i = 0; i < 2; i++) {
                const float *w = i ? wo : wi;
                double z = (double)w[2],
                       w2 = z * z + (double)w[0] * (double)w[0] + (double)w[1] * (double)w[1];
                g[i] = 1 / (z + sqrt(w2));
            }
            double expected = (rs * rs + rp * rp) / 2 / pi * g[0] * g[1];
            oracle_point point = ggx_point(&m, wi, wo);
            /* rs and rp lose 1/(eta - 1) = 1e4 of a double's digits at most. */
            assert_true(fabs(point.value[1] - expected) <= 1e-11 * expected);
        }
}

/* Seen along n nothing is masked: of all normals the density of wi is D h.z/(4 wo.h); of the
 * visible ones that is over (1 + k)/2, k = (1 - a^2)/(1 + a^2) with the smaller roughness a: the
 * bound cuts off normals beyond 45 degrees, all of them where the lobe is round. In slopes r a
 * (cos, sin) with r^2 = v/(1 - v), D h.z dh = dv dphi/(2 pi): of a midpoint rule in v and phi
 * every point has the same share, so the mean of density over expectation, with the share of wi
 * below the horizon, is 1. */
static void the_density_is_that_of_mirrored_normals_and_integrates_to_one(void **state)
{
    const float wo[3] = {0.0f, 0.0f, 1.0f};
    static const float alphas[][2] = {{0.5f, 0.5f}, {0.3f, 0.1f}, {0.01f, 0.01f}, {0.2f, 0.002f}};
    enum { RINGS = 300, TURNS = 200 };
    const double point = 1.0 / RINGS / TURNS, specular = 0.05 + 0.2 * 0.2;
    assert_true(specular / (specular + 0.5) < 0.2); /* which is then held at its least */
    for (size_t a = 0; a < 2 * sizeof alphas / sizeof alphas[0]; a++) {
        hnbrdf_material m;
        hnbrdf_material_init(&m);
        memcpy(m.alpha, alphas[a / 2], sizeof m.alpha);
        if (a % 2)
            hnbrdf_lobes_paper(&m.lobes);
        double share = a % 2 ? 0.5 : 0.2, total = 0.0, above = 0.0,
               least = fmin((double)m.alpha[0], (double)m.alpha[1]);
        double visible = a % 2 ? 1.0 : 1 / (1 + least * least); /* (1 + k)/2 */
        for (int i = 0; i < RINGS; i++)
            for (int k = 0; k < TURNS; k++) {
                double v = (i + 0.5) / RINGS, r = sqrt(v / (1 - v)),
                       phi = 2 * pi * (k + 0.5) / TURNS;
                double ax = (double)m.alpha[0], ay = (double)m.alpha[1], t = 1 + r * r;
                double x = r * ax * cos(phi), y = r * ay * sin(phi), h2 = x * x + y * y + 1;
                const float wi[3] = {(float)(2 * x / h2), (float)(2 * y / h2), (float)(2 / h2 - 1)};
                double lobe = (ggx_point(&m, wi, wo).pdf - (1 - share) * (double)wi[2] / pi) /
                              share * visible;
                double all = point * lobe * 4 * pi * ax * ay * t * t / (h2 * h2);
                total += wi[2] > 0.0f ? all : point;
                above += wi[2] > 0.0f ? all / visible : 0.0;
            }
        /* Float directions, some 2^-24 off the mirror image, seen through slopes of size alpha. */
        assert_true(fabs(total - 1) <= 1e-4);
        if (m.alpha[0] == m.alpha[1] && a % 2 == 0) /* up to a ring of the rule */
            assert_true(fabs(above - 1) <= 2.0 / RINGS);
    }
    (void)state;
}

static void normal_incidence_has_its_closed_form(void **state)
{
    (void)state;
    const float n[3] = {0.0f, 0.0f, 1.0f};
    rng r = rng_make(3);
    for (int k = 0; k < 200; k++) {
        hnbrdf_material m = random_material(&r, 0);
        oracle_point point = ggx_point(&m, n, n);
        for (int c = 0; c < 3; c++) {
            double r0 = ((double)m.eta[c] - 1) / ((double)m.eta[c] + 1);
            double expected =
                (double)m.kd[c] / pi + r0 * r0 / (4 * pi * (double)m.alpha[0] * (double)m.alpha[1]);
            assert_true(fabs(point.value[c] - expected) <= 1e-12 * expected);
        }
    }
}

/* One hidden unit that passes its first input (HardGELU(x) = x from x = 3/2 on) to every output. */
static void a_network_of_one_unit_is_what_one_writes_out(void **state)
{
    (void)state;
    float first[6 + 2] = {0, 0, 1.0f, 0, 0, 0, 2.0f, 0.25f}, bias[1] = {1.0f}, last[6], biases[6];
    for (int k = 0; k < 6; k++) {
        last[k] = 0.5f * (float)(k + 1);
        biases[k] = -1.0f;
    }
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_HYBRID,
                              .hidden = 1,
                              .layers = 1,
                              .latent = 2,
                              .scale = 0.5f,
                              .shift = 0.25f,
                              .floor = 0.01f,
                              .weights = {first, last},
                              .biases = {bias, biases}};
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    m.latent[0] = 0.5f;
    m.latent[1] = 2.0f;
    float wi[3], wo[3];
    direction(0.8, 0.4, wi);
    direction(0.5, 2.0, wo);
    oracle_point point;
    oracle_evaluate(&desc, &m, wi, wo, &point);
    double unit = 1.0 + 0.5 * 2.0 + 2.0 * 0.25 + (double)wi[2]; /* 3.3 */
    for (int c = 0; c < 3; c++) {
        double exponent = 0.5 * (0.5 * (c + 1) * unit - 1) + 0.25, g = 0.5 * (c + 4) * unit - 1;
        double expected = exp(exponent) + point.analytic[c] / (1 + exp(-g)) - (double)0.01f;
        assert_true(fabs(point.value[c] - expected) <= 1e-14 * expected);
        assert_true(fabs(point.scale[c] - point.value[c] - (double)0.01f) <= 1e-14);
    }
}

/* Every kind, encoding and clamp against the library: they were written apart, so an error of one
 * of them shows. 2e-4 of the scale is what random networks of order 1 lose at most in floats; a
 * wrong formula is wrong in the first digits. */
static void library_and_oracle_agree_on_every_kind_and_encoding(void **state)
{
    (void)state;
    rng r = rng_make(5);
    for (int kind = HNBRDF_KIND_HYBRID; kind <= HNBRDF_KIND_GGX; kind++)
        for (int encoding = 0; encoding <= HNBRDF_ENCODING_ANGLES_AZIMUTHS; encoding++) {
            hnbrdf_model *model =
                random_model(&r, (hnbrdf_kind)kind, (hnbrdf_encoding)encoding, 16, 2, 4);
            hnbrdf_model_desc desc;
            hnbrdf_model_describe(model, &desc);
            for (int k = 0; k < 40; k++) {
                hnbrdf_material m = random_material(&r, k & 1);
                if (k & 2) { /* edited, by at most what an artist does */
                    m = edited_from(&r, m);
                    for (int a = 0; a < 2; a++)
                        m.fitted.alpha[a] = fmaxf(m.fitted.alpha[a], 0.02f);
                }
                m.alpha[0] = fmaxf(m.alpha[0], 0.02f);
                m.alpha[1] = k & 1 ? m.alpha[0] : fmaxf(m.alpha[1], 0.02f);
                float wi[3], wo[3], f[3];
                direction_uniform(&r, wi);
                direction_uniform(&r, wo);
                oracle_point point;
                oracle_evaluate(&desc, &m, wi, wo, &point);
                hnbrdf_eval(model, &m, wi, wo, f);
                for (int c = 0; c < 3; c++)
                    assert_true(fabs((double)f[c] - point.value[c]) <= 2e-4 * point.scale[c]);
                hnbrdf_eval_analytic(model, &m, wi, wo, f);
                for (int c = 0; c < 3; c++)
                    assert_true(fabs((double)f[c] - point.analytic[c]) <= 2e-5 * point.analytic[c]);
                double pdf = (double)hnbrdf_pdf(model, &m, wi, wo);
                assert_true(fabs(pdf - point.pdf) <= 2e-5 * point.pdf);
            }
            hnbrdf_model_free(model);
        }
}

static void below_the_horizon_everything_is_zero(void **state)
{
    (void)state;
    static const oracle_point zero;
    static const float heights[] = {0.0f, -0.0f, -0.5f, -1e-38f};
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    for (int k = 0; k < 4; k++) {
        const float above[3] = {0.6f, 0.0f, 0.8f}, below[3] = {0.6f, 0.0f, heights[k]};
        oracle_point a = ggx_point(&m, above, below), b = ggx_point(&m, below, above);
        assert_memory_equal(&a, &zero, sizeof a);
        assert_memory_equal(&b, &zero, sizeof b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fresnel_is_the_mean_of_the_squared_amplitudes),
        cmocka_unit_test(the_density_is_that_of_mirrored_normals_and_integrates_to_one),
        cmocka_unit_test(normal_incidence_has_its_closed_form),
        cmocka_unit_test(a_network_of_one_unit_is_what_one_writes_out),
        cmocka_unit_test(library_and_oracle_agree_on_every_kind_and_encoding),
        cmocka_unit_test(below_the_horizon_everything_is_zero),
    };
    print_message("    oracle in %s\n", oracle_arithmetic());
    return cmocka_run_group_tests(tests, NULL, NULL);
}
