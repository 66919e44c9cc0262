/* test_render_sphere.c: the estimator is unbiased, the picture depends on the seed alone, the
 * shading frame has no seam. */
#include "render/render.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;
static hnbrdf_model *ggx;
static render_environment sky, white;

static int open_lights(void **state)
{
    hnbrdf_material material;
    const char *name = "x";
    render_image image;
    (void)state;
    hnbrdf_material_init(&material);
    hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = 1, .materials = &material, .names = &name};
    if (hnbrdf_model_create(&desc, NULL, &ggx, NULL) ||
        render_environment_open("sky", 0.0, NULL, &sky, NULL) ||
        render_image_create(8, 4, 0, &image, NULL))
        return -1;
    for (int i = 0; i < 3 * 8 * 4; i++)
        image.rgb[i] = 2.5f;
    return render_environment_create(&image, 0.0, "white", &white, NULL) != HNBRDF_OK;
}

static int close_lights(void **state)
{
    (void)state;
    hnbrdf_model_free(ggx);
    render_environment_free(&sky);
    render_environment_free(&white);
    return 0;
}

static render_surface make_ggx(float kd, float eta, float alpha_x, float alpha_y)
{
    hnbrdf_material material;
    hnbrdf_material_init(&material);
    for (int k = 0; k < 3; k++) {
        material.kd[k] = kd * (k == 1 ? 0.5f : 1.0f);
        material.eta[k] = eta;
    }
    material.alpha[0] = alpha_x;
    material.alpha[1] = alpha_y;
    return render_surface_model(ggx, &material);
}

static render_image render(const render_surface *surface, const render_environment *environment,
                           render_strategy strategy, int size, int spp, uint64_t seed, int threads)
{
    render_image image;
    render_options options = {
        .size = size, .spp = spp, .seed = seed, .threads = threads, .strategy = strategy};
    assert_int_equal(render_sphere(surface, environment, &options, &image, NULL), HNBRDF_OK);
    return image;
}

/* ---- Random numbers -------------------------------------------------------------------------- */

/* 2^6 samples: one in each cell of every grid of 2^a x 2^(6-a). */
static void samples_of_a_pixel_are_stratified(void **state)
{
    (void)state;
    for (uint64_t pixel = 0; pixel < 20; pixel++) {
        render_stream stream;
        render_stream_begin(&stream, 5, pixel, 64);
        for (int pair = 0; pair < RENDER_PAIRS; pair++)
            for (int a = 0; a <= 6; a++) {
                int seen[64] = {0};
                for (uint32_t i = 0; i < 64; i++) {
                    uint32_t u[2];
                    render_stream_pair(&stream, pair, i, u);
                    uint32_t row = a ? u[0] >> (32 - a) : 0, column = a < 6 ? u[1] >> (26 + a) : 0;
                    seen[row << (6 - a) | column]++;
                }
                for (int i = 0; i < 64; i++)
                    assert_int_equal(seen[i], 1);
            }
    }
}

/* Correlation of two uniform numbers over N independent pixels: standard deviation 1/sqrt(N). */
static void pairs_are_not_tied_to_each_other(void **state)
{
    (void)state;
    enum { PIXELS = 400, COUNT = 16 };
    for (int a = 0; a < RENDER_PAIRS; a++)
        for (int b = a + 1; b < RENDER_PAIRS; b++)
            for (int dimensions = 0; dimensions < 4; dimensions++) {
                double sum = 0.0;
                for (uint64_t pixel = 0; pixel < PIXELS; pixel++) {
                    render_stream stream;
                    render_stream_begin(&stream, 1, pixel, COUNT);
                    for (uint32_t i = 0; i < COUNT; i++) {
                        uint32_t u[2], v[2];
                        render_stream_pair(&stream, a, i, u);
                        render_stream_pair(&stream, b, i, v);
                        sum += 12.0 * (u[dimensions & 1] * 0x1p-32 - 0.5) *
                               (v[dimensions >> 1] * 0x1p-32 - 0.5);
                    }
                }
                assert_true(fabs(sum / (PIXELS * COUNT)) < 5.0 / sqrt(PIXELS * COUNT));
            }
}

/* ---- The camera and the frame ---------------------------------------------------------------- */

static double dot(const float a[3], const float b[3])
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

static void shading_frame_is_right_handed_and_orthonormal(void **state)
{
    (void)state;
    int hits = 0;
    for (int i = 0; i < 200 * 200; i++) {
        render_point p;
        if (!render_sphere_hit((float)(2 * (i % 200) - 199) / 200.0f,
                               (float)(2 * (i / 200) - 199) / 200.0f, &p))
            continue;
        const float *t = p.tangent, *b = p.bitangent, *n = p.normal;
        float cross[3] = {t[1] * b[2] - t[2] * b[1], t[2] * b[0] - t[0] * b[2],
                          t[0] * b[1] - t[1] * b[0]};
        assert_true(fabs(dot(t, t) - 1.0) < 1e-6 && fabs(dot(b, b) - 1.0) < 1e-6 &&
                    fabs(dot(t, b)) < 1e-6 && fabs(dot(t, n)) < 1e-6);
        assert_true(fabs(dot(cross, n) - 1.0) < 1e-6);
        assert_true(t[1] == 0.0f && (t[0] > 0.0f || n[2] < 0.0f)); /* along increasing longitude */
        assert_true(fabs(dot(p.wo, p.wo) - 1.0) < 1e-6 && p.wo[2] > 0.0f);
        hits++;
    }
    /* The disc of radius 1 / RENDER_FRAME; a pixel's area is 1e-4, its edge is off by a few. */
    assert_true(fabs(hits * 1e-4 - pi / (double)(RENDER_FRAME * RENDER_FRAME)) < 0.01);
}

/* The ray meets the sphere where it does in doubles: in floats everything is off by a few 2^-24,
 * but D near the outline, the square root of what x and y leave to 1. */
static void hits_are_where_the_ray_meets_the_sphere(void **state)
{
    (void)state;
    for (float y = -0.95f; y < 0.95f; y += 0.0137f)
        for (float x = -0.95f; x < 0.95f; x += 0.0151f) {
            render_point p;
            double distance = (double)RENDER_DISTANCE, frame = (double)RENDER_FRAME;
            double scale = frame / sqrt(distance * distance - 1.0),
                   d[3] = {x * scale, y * scale, -1.0};
            double length = sqrt(d[0] * d[0] + d[1] * d[1] + 1.0), half = -distance / length;
            double inside = half * half - (distance * distance - 1.0);
            int hit = render_sphere_hit(x, y, &p);
            if (fabs(inside) < 1e-4)
                continue; /* the outline itself */
            assert_int_equal(hit, inside > 0.0);
            if (!hit)
                continue;
            double t = (-half - sqrt(inside)) / length, tolerance = 1e-6 / sqrt(inside);
            for (int k = 0; k < 3; k++) {
                double wo = (double)p.tangent[k] * (double)p.wo[0] +
                            (double)p.bitangent[k] * (double)p.wo[1] +
                            (double)p.normal[k] * (double)p.wo[2];
                assert_true(fabs((double)p.normal[k] - (t * d[k] + (k == 2 ? distance : 0.0))) <
                            tolerance);
                assert_true(fabs(wo + d[k] / length) < tolerance);
            }
        }
}

/* Neighbouring rays have neighbouring tangents: their angle is bounded by the step over the
 * distance from the axis. A seam would show as a jump. */
static void tangent_has_no_seam(void **state)
{
    (void)state;
    const float step = 1e-3f;
    for (float y = -0.94f; y < 0.94f; y += 0.0202f)
        for (float x = -0.94f; x < 0.94f; x += step) {
            render_point p, q;
            if (!render_sphere_hit(x, y, &p) || !render_sphere_hit(x + step, y, &q))
                continue;
            double moved = 0.0, turned = 0.0,
                   axis = hypot((double)p.normal[0], (double)p.normal[2]);
            for (int k = 0; k < 3; k++) {
                moved += pow((double)(p.normal[k] - q.normal[k]), 2.0);
                turned += pow((double)(p.tangent[k] - q.tangent[k]), 2.0);
            }
            assert_true(sqrt(turned) <= 1.1 * sqrt(moved) / axis + 1e-6);
        }
}

static void picture_is_upright(void **state)
{
    (void)state;
    render_point p;
    assert_true(render_sphere_hit(0.5f, 0.3f, &p));
    assert_true(p.normal[0] > 0.4f && p.normal[1] > 0.2f && p.normal[2] > 0.5f);
    render_surface surface = make_ggx(0.8f, 1.5f, 0.3f, 0.3f);
    render_image image = render(&surface, &sky, RENDER_MIS, 32, 16, 1, 1);
    double top = 0.0, bottom = 0.0;
    for (int x = 0; x < 32; x++) {
        top += (double)image.rgb[3 * (6 * 32 + x) + 2];
        bottom += (double)image.rgb[3 * (25 * 32 + x) + 2];
    }
    assert_true(top > 1.5 * bottom);
    render_image_free(&image);
}

/* ---- The estimator --------------------------------------------------------------------------- */

/* Two pictures of independent seeds: their mean over covered pixels, and the standard error of that
 * from the differences, since pixels are independent of each other. */
typedef struct estimate {
    double mean, error;
} estimate;

static estimate estimate_mean(const render_surface *surface, const render_environment *environment,
                              render_strategy strategy, int size, int spp, int channel)
{
    render_image a = render(surface, environment, strategy, size, spp, 11, 0);
    render_image b = render(surface, environment, strategy, size, spp, 12, 0);
    double sum = 0.0, squares = 0.0, covered = 0.0;
    for (int i = 0; i < size * size; i++) {
        double va = (double)a.rgb[3 * i + channel], vb = (double)b.rgb[3 * i + channel];
        sum += 0.5 * (va + vb);
        squares += 0.25 * (va - vb) * (va - vb);
        covered += 0.5 * (double)(a.alpha[i] + b.alpha[i]);
    }
    render_image_free(&a);
    render_image_free(&b);
    return (estimate){sum / covered, sqrt(squares) / covered};
}

static void lambert_eval(const render_surface *surface, size_t count, const float *wi,
                         const float *wo, float *f)
{
    (void)surface, (void)wo;
    for (size_t i = 0; i < 3 * count; i++)
        f[i] = wi[i / 3 * 3 + 2] > 0.0f ? 0.8f * 0.318309886f : 0.0f;
}

/* White furnace: 0.8 of 2.5 comes back everywhere. The density is that of the GGX mixture, not of
 * the cosine, so that the estimate is a real one; 5 standard errors. */
static void lambert_sphere_returns_its_albedo_in_a_furnace(void **state)
{
    (void)state;
    render_surface surface = make_ggx(0.5f, 1.5f, 0.3f, 0.3f);
    surface.eval = lambert_eval;
    for (int strategy = RENDER_MIS; strategy <= RENDER_BRDF; strategy++) {
        estimate e = estimate_mean(&surface, &white, (render_strategy)strategy, 48, 64, 1);
        assert_true(e.error < 0.01);
        assert_true(fabs(e.mean - 2.0) < 5.0 * e.error + 1e-6);
    }
}

/* Smooth, rough, anisotropic and the library's own sample() and pdf(): all three strategies
 * estimate the same mean, within 5 standard errors of the difference. The smoothest one leaves
 * out light sampling alone, whose error there has no finite sample size worth a test. */
static void strategies_agree(void **state)
{
    (void)state;
    static const struct {
        float kd, eta, alpha_x, alpha_y;
        int without_light;
    } cases[] = {{0.6f, 1.5f, 0.4f, 0.4f, 0},
                 {0.1f, 3.0f, 0.2f, 0.2f, 0},
                 {0.2f, 2.0f, 0.1f, 0.5f, 0},
                 {0.1f, 1.8f, 0.02f, 0.02f, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        render_surface surface =
            make_ggx(cases[i].kd, cases[i].eta, cases[i].alpha_x, cases[i].alpha_y);
        for (int channel = 0; channel < 3; channel += 2) {
            estimate mis = estimate_mean(&surface, &sky, RENDER_MIS, 32, 64, channel);
            estimate brdf = estimate_mean(&surface, &sky, RENDER_BRDF, 32, 256, channel);
            assert_true(fabs(mis.mean - brdf.mean) < 5.0 * hypot(mis.error, brdf.error));
            assert_true(mis.error < 0.02 * mis.mean);
            if (cases[i].without_light)
                continue;
            estimate light = estimate_mean(&surface, &sky, RENDER_LIGHT, 32, 256, channel);
            assert_true(fabs(mis.mean - light.mean) < 5.0 * hypot(mis.error, light.error));
        }
    }
}

/* The analytic part of a ggx model is the model. */
static void analytic_surface_equals_the_ggx_model(void **state)
{
    (void)state;
    render_surface model = make_ggx(0.3f, 1.6f, 0.15f, 0.3f);
    render_surface analytic = render_surface_analytic(ggx, &model.material);
    render_image a = render(&model, &sky, RENDER_MIS, 24, 16, 3, 1);
    render_image b = render(&analytic, &sky, RENDER_MIS, 24, 16, 3, 1);
    assert_memory_equal(a.rgb, b.rgb, sizeof(float) * 3 * 24 * 24);
    render_image_free(&a);
    render_image_free(&b);
}

/* ---- Threads, seeds, progress ---------------------------------------------------------------- */

static void picture_does_not_depend_on_threads(void **state)
{
    (void)state;
    render_surface surface = make_ggx(0.3f, 1.5f, 0.1f, 0.3f);
    render_image one = render(&surface, &sky, RENDER_MIS, 70, 20, 7, 1);
    for (int threads = 2; threads <= 5; threads += 3) {
        render_image other = render(&surface, &sky, RENDER_MIS, 70, 20, 7, threads);
        assert_memory_equal(one.rgb, other.rgb, sizeof(float) * 3 * 70 * 70);
        assert_memory_equal(one.alpha, other.alpha, sizeof(float) * 70 * 70);
        render_image_free(&other);
    }
    render_image different = render(&surface, &sky, RENDER_MIS, 70, 20, 8, 2);
    assert_memory_not_equal(one.rgb, different.rgb, sizeof(float) * 3 * 70 * 70);
    render_image_free(&different);
    render_image_free(&one);
}

static void any_number_of_samples_is_finite(void **state)
{
    (void)state;
    static const int counts[] = {1, 2, 3, 63, 64, 65, 200};
    render_surface surface = make_ggx(0.0f, 10.0f, 1e-4f, 1e-4f);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        render_image image = render(&surface, &sky, RENDER_MIS, 9, counts[i], 1, 1);
        for (int k = 0; k < 3 * 81; k++)
            assert_true(isfinite(image.rgb[k]) && image.rgb[k] >= 0.0f);
        for (int k = 0; k < 81; k++)
            assert_true(image.alpha[k] >= 0.0f && image.alpha[k] <= 1.0f);
        assert_true(image.alpha[40] == 1.0f && image.alpha[0] == 0.0f && image.rgb[0] == 0.0f);
        render_image_free(&image);
    }
}

typedef struct watcher {
    double last;
    int calls, stop_at;
} watcher;

static int watch(void *user, double share)
{
    watcher *w = user;
    assert_true(share > w->last && share <= 1.0);
    w->last = share;
    return ++w->calls == w->stop_at;
}

static void progress_rises_to_one_and_can_stop(void **state)
{
    (void)state;
    render_surface surface = make_ggx(0.3f, 1.5f, 0.3f, 0.3f);
    watcher w = {0.0, 0, 0};
    render_image image;
    hnbrdf_error error;
    render_options options = {
        .size = 64, .spp = 2, .threads = 1, .progress = watch, .progress_user = &w};
    assert_int_equal(render_sphere(&surface, &white, &options, &image, &error), HNBRDF_OK);
    assert_true(w.last == 1.0);
    render_image_free(&image);
    for (int threads = 1; threads <= 3; threads++) {
        w = (watcher){0.0, 0, 1};
        options.threads = threads;
        hnbrdf_result result = render_sphere(&surface, &white, &options, &image, &error);
        assert_int_equal(result, w.calls ? HNBRDF_ERROR_CANCELLED : HNBRDF_OK);
        if (result == HNBRDF_OK) /* the caller's thread never got a tile */
            render_image_free(&image);
    }
}

static void backdrops_fill_the_picture(void **state)
{
    (void)state;
    render_surface surface = make_ggx(0.5f, 1.5f, 0.3f, 0.3f);
    for (int kind = 0; kind < 2; kind++) {
        render_image image = render(&surface, &white, RENDER_MIS, 20, 16, 1, 1);
        float middle = image.rgb[3 * (10 * 20 + 10)];
        if (kind == 0)
            render_over_backdrop(&image, 0.2);
        else
            render_over_environment(&image, &white, 0.5);
        assert_null(image.alpha);
        assert_true(image.rgb[3 * (10 * 20 + 10)] == middle);
        for (int k = 0; k < 3 * 400; k++)
            assert_true(image.rgb[k] > 0.0f && image.rgb[k] < 10.0f);
        if (kind == 1)
            assert_true(fabs((double)image.rgb[0] - 1.25) < 1e-5);
        render_image_free(&image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_of_a_pixel_are_stratified),
        cmocka_unit_test(pairs_are_not_tied_to_each_other),
        cmocka_unit_test(shading_frame_is_right_handed_and_orthonormal),
        cmocka_unit_test(hits_are_where_the_ray_meets_the_sphere),
        cmocka_unit_test(tangent_has_no_seam),
        cmocka_unit_test(picture_is_upright),
        cmocka_unit_test(lambert_sphere_returns_its_albedo_in_a_furnace),
        cmocka_unit_test(strategies_agree),
        cmocka_unit_test(analytic_surface_equals_the_ggx_model),
        cmocka_unit_test(picture_does_not_depend_on_threads),
        cmocka_unit_test(any_number_of_samples_is_finite),
        cmocka_unit_test(progress_rises_to_one_and_can_stop),
        cmocka_unit_test(backdrops_fill_the_picture),
    };
    return cmocka_run_group_tests(tests, open_lights, close_lights);
}
