/* test_gpu_sphere.c: the sphere rendered by a Vulkan device against the CPU's: the same
 * directions, BRDF values and pictures, to the bit where the device's operations are exact. */
#include "gpu_run.h"
#include "gpu_support.h"

#include "check/bounds.h"
#include "gpu/sphere.h"
#include "hnbrdf/measured.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const scene_shape GGX = {.kind = HNBRDF_KIND_GGX, .anisotropic = 1};
static const scene_shape NEURAL = {
    .kind = HNBRDF_KIND_NEURAL, .hidden = 6, .layers = 1, .latent = 3, .rotated = 1};
static const scene_shape HYBRID = {
    .encoding = HNBRDF_ENCODING_ANGLES, .hidden = 9, .layers = 2, .latent = 4};
static const scene_shape ROTATED = {.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
                                    .hidden = 8,
                                    .layers = 3,
                                    .latent = 5,
                                    .anisotropic = 1,
                                    .rotated = 1};

/* Three decades of light, texels and a whole row without any; an odd height has a row across the
 * equator. */
static render_environment make_light(int width, int height, double rotation)
{
    render_image image;
    render_environment environment;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 3, (uint64_t)height);
    assert_int_equal(render_image_create(width, height, 0, &image, NULL), HNBRDF_OK);
    for (int i = 0; i < width * height; i++)
        for (int k = 0; k < 3; k++)
            image.rgb[3 * i + k] = i % 5 == 4 || i / width == 2
                                       ? 0.0f
                                       : powf(10.0f, 3.0f * hnbrdf_rng_float(&rng) - 2.0f);
    assert_int_equal(render_environment_create(&image, rotation, "light", &environment, NULL),
                     HNBRDF_OK);
    return environment;
}

static gpu_sphere open_sphere(const hnbrdf_model *model, int material,
                              const render_environment *light, render_strategy strategy, int exact,
                              gpu_sphere_mode mode)
{
    gpu_sphere sphere;
    hnbrdf_error error = {""};
    if (gpu_sphere_open(gpu_run_device(), model, material, light, strategy,
                        exact ? CHECK_BUILD_EXACT : CHECK_BUILD_FAST, mode, &sphere, &error))
        fail_msg("%s", error.text);
    return sphere;
}

/* ---- Sample by sample ------------------------------------------------------------------------ */

/* 80 samples: one block and a part of the next, so that hits are counted anew in between. */
enum { SIDE = 16, SPP = 80, DRAWS = SIDE * SIDE * SPP * 2 };
static const render_options recorded = {
    .size = SIDE, .spp = SPP, .seed = UINT64_C(0x123456789abcdef), .threads = 1};

/* What render_shade() evaluates, in its order. */
static struct {
    gpu_sphere_draw *draws;
    size_t count;
} seen;

static void eval_and_keep(const render_surface *surface, size_t count, const float *wi,
                          const float *wo, float *f)
{
    render_surface plain = render_surface_model(surface->model, &surface->material);
    plain.eval(&plain, count, wi, wo, f);
    for (size_t i = 0; i < count; i++) {
        gpu_sphere_draw *d = &seen.draws[seen.count++];
        memcpy(d->wi, wi + 3 * i, sizeof d->wi);
        memcpy(d->wo, wo + 3 * i, sizeof d->wo);
        memcpy(d->f, f + 3 * i, sizeof d->f);
        d->counts = 1.0f;
    }
}

/* One pixel's samples as the CPU draws them: of each block those of the environment, then those
 * of the BRDF. */
static void shade_pixel(const render_surface *surface, const render_environment *light,
                        render_strategy strategy, uint32_t pixel)
{
    render_stream stream;
    render_stream_begin(&stream, recorded.seed, pixel, SPP);
    for (uint32_t first = 0; first < SPP; first += RENDER_BLOCK) {
        render_point points[RENDER_BLOCK];
        double sum[3] = {0.0, 0.0, 0.0};
        int hits = 0;
        for (uint32_t i = first; i < SPP && i < first + RENDER_BLOCK; i++) {
            float at[2];
            render_sphere_place(&recorded, pixel, &stream, i, at);
            hits += render_sphere_hit(at[0], at[1], &points[hits]);
        }
        render_shade(surface, light, strategy, &stream, first, points, hits, sum);
    }
}

/* The device's draws of one pixel in that order; returns how many. */
static size_t in_order_of_blocks(const gpu_sphere_draw *draws, gpu_sphere_draw *ordered)
{
    size_t count = 0;
    for (size_t first = 0; first < SPP; first += RENDER_BLOCK)
        for (size_t part = 0; part < 2; part++)
            for (size_t i = first; i < SPP && i < first + RENDER_BLOCK; i++)
                if (draws[2 * i + part].counts > 0.0f)
                    ordered[count++] = draws[2 * i + part];
    return count;
}

static void compare_bits(const hnbrdf_model *model, int material, const render_environment *light,
                         render_strategy strategy, const gpu_sphere_draw *draws)
{
    static gpu_sphere_draw ordered[2 * SPP], expected[2 * SPP];
    render_surface surface = render_surface_model(model, hnbrdf_model_material(model, material));
    size_t all = 0;
    surface.eval = eval_and_keep;
    for (uint32_t pixel = 0; pixel < SIDE * SIDE; pixel++) {
        seen.draws = expected;
        seen.count = 0;
        gpu_run_c_begin();
        shade_pixel(&surface, light, strategy, pixel);
        gpu_run_c_end();
        size_t count = in_order_of_blocks(draws + pixel * 2 * SPP, ordered);
        assert_int_equal(count, seen.count);
        for (size_t i = 0; i < count; i++)
            gpu_run_assert_same("wi, wo, f", ordered[i].wi, expected[i].wi, 10);
        all += count;
    }
    assert_true(all > DRAWS / 8);
}

/* On every device and in both builds: what the device says of its own directions against C. */
static void compare_values(const hnbrdf_model *model, int material, int exact,
                           const gpu_sphere_draw *draws)
{
    const hnbrdf_material *m = hnbrdf_model_material(model, material);
    const check_rules rules = gpu_run_rules(exact);
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    for (int i = 0; i < DRAWS; i++) {
        check_bounds bounds;
        if (!(draws[i].counts > 0.0f))
            continue;
        assert_true(draws[i].wi[2] > 0.0f && draws[i].wo[2] > 0.0f);
        check_bounds_make(&rules, &desc, HNBRDF_GLSL_FLOAT, m, draws[i].wi, draws[i].wo, 0.0,
                          &bounds);
        for (int k = 0; k < 3; k++)
            if (!(fabs((double)draws[i].f[k] - (double)bounds.value[k].v) <= bounds.value[k].e))
                fail_msg("draw %d, channel %d: %.9g on the device, %.9g in C, bound %g", i, k,
                         (double)draws[i].f[k], (double)bounds.value[k].v, bounds.value[k].e);
    }
}

static void draws_as_on_the_cpu(const scene_shape *shape, int material, render_strategy strategy)
{
    hnbrdf_model *model = scene_model(shape);
    render_environment light = make_light(37, strategy == RENDER_LIGHT ? 18 : 19, 1.3);
    gpu_sphere_draw *draws = calloc(DRAWS, sizeof *draws);
    assert_non_null(draws);
    for (int exact = 0; exact < 2; exact++) {
        hnbrdf_error error = {""};
        gpu_sphere sphere =
            open_sphere(model, material, &light, strategy, exact, GPU_SPHERE_RECORD);
        if (gpu_sphere_record(&sphere, &recorded, 0, SIDE * SIDE, draws, &error))
            fail_msg("%s", error.text);
        gpu_sphere_close(&sphere);
        compare_values(model, material, exact, draws);
        if (exact && gpu_run_exact())
            compare_bits(model, material, &light, strategy, draws);
    }
    free(draws);
    render_environment_free(&light);
    hnbrdf_model_free(model);
}

static void every_strategy_draws_as_on_the_cpu(void **state)
{
    (void)state;
    for (int strategy = RENDER_MIS; strategy <= RENDER_BRDF; strategy++)
        draws_as_on_the_cpu(&HYBRID, 1, (render_strategy)strategy);
}

static void every_kind_of_model_draws_as_on_the_cpu(void **state)
{
    (void)state;
    draws_as_on_the_cpu(&ROTATED, 0, RENDER_MIS);
    draws_as_on_the_cpu(&GGX, 2, RENDER_MIS);
    draws_as_on_the_cpu(&NEURAL, 1, RENDER_MIS);
}

/* ---- Pictures -------------------------------------------------------------------------------- */

static render_image on_cpu(const hnbrdf_model *model, const render_environment *light,
                           const render_options *options)
{
    render_image image;
    render_surface surface = render_surface_model(model, hnbrdf_model_material(model, 0));
    gpu_run_c_begin();
    hnbrdf_result result = render_sphere(&surface, light, options, &image, NULL);
    gpu_run_c_end();
    assert_int_equal(result, HNBRDF_OK);
    return image;
}

static render_image on_device(const hnbrdf_model *model, const render_environment *light, int exact,
                              const render_options *options)
{
    render_image image;
    double ns;
    hnbrdf_error error = {""};
    gpu_sphere sphere = open_sphere(model, 0, light, options->strategy, exact, GPU_SPHERE_PICTURE);
    if (gpu_sphere_render(&sphere, options, &image, &ns, &error))
        fail_msg("%s", error.text);
    assert_true(ns > 0.0);
    gpu_sphere_close(&sphere);
    return image;
}

/* What every sample adds has the bits of the CPU's, and is not negative. The CPU sums N of them
 * in a double and loses at most N 2^-53 of the sum, the device in two floats and loses at most N
 * 2^-47. For 2^21 directions that is at most a quarter of the distance between floats, so the
 * rounded means are the same float or neighbours. */
static void picture_is_the_cpus(void **state)
{
    (void)state;
    const render_options options = {.size = 33, .spp = 150, .seed = 5, .threads = 1};
    hnbrdf_model *model = scene_model(&ROTATED);
    /* small texels: the last bits of angles tell */
    render_environment light = make_light(1023, 511, -2.0);
    render_image cpu = on_cpu(model, &light, &options),
                 device = on_device(model, &light, 1, &options);
    int differ = 0;
    for (int i = 0; i < 33 * 33 && gpu_run_exact(); i++) {
        assert_true(cpu.alpha[i] == device.alpha[i]);
        for (int k = 0; k < 3; k++) {
            float a = cpu.rgb[3 * i + k], b = device.rgb[3 * i + k];
            assert_true(a == b || nextafterf(a, b) == b);
            differ += a != b;
        }
    }
    print_message("%d of %d numbers are the neighbouring float\n", differ, 3 * 33 * 33);
    render_image_free(&cpu);
    render_image_free(&device);
    render_environment_free(&light);
    hnbrdf_model_free(model);
}

/* Mean difference of two pictures of other seeds over its standard error, which the differences
 * give: pixels are independent. */
static void assert_within_noise(const render_image *a, const render_image *b, int pixels)
{
    for (int k = 0; k < 3; k++) {
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < pixels; i++) {
            double difference = (double)a->rgb[3 * i + k] - (double)b->rgb[3 * i + k];
            sum += difference;
            squares += difference * difference;
        }
        assert_true(squares > 0.0 && fabs(sum) < 5.0 * sqrt(squares));
    }
}

static void pictures_of_other_seeds_agree_within_noise(void **state)
{
    (void)state;
    render_options options = {.size = 40, .spp = 64, .seed = 1, .threads = 1};
    hnbrdf_model *model = scene_model(&HYBRID);
    render_environment light = make_light(64, 32, 0.4);
    render_image cpu = on_cpu(model, &light, &options);
    options.seed = 2;
    for (int exact = 0; exact < 2; exact++) {
        render_image device = on_device(model, &light, exact, &options);
        assert_within_noise(&cpu, &device, 40 * 40);
        render_image_free(&device);
    }
    render_image_free(&cpu);
    render_environment_free(&light);
    hnbrdf_model_free(model);
}

/* The shares that were reported; the last call of `most` stops. */
enum { REPORTS = 4096 };
static struct {
    double shares[REPORTS];
    int count, most;
} told;

static int note(void *user, double share)
{
    (void)user;
    told.shares[told.count++] = share;
    return told.count == told.most;
}

/* However fast the device: the first dispatch is 256 pixels by 64 samples, the second at most the
 * other 66, the third begins on other pixels. */
static void progress_rises_to_one_and_can_stop(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&GGX);
    render_environment light = make_light(8, 4, 0.0);
    gpu_sphere sphere = open_sphere(model, 0, &light, RENDER_MIS, 1, GPU_SPHERE_PICTURE);
    const render_options options = {.size = 24, .spp = 130, .progress = note};
    const int limits[] = {REPORTS, 1, 2};
    for (int i = 0; i < 3; i++) {
        render_image image;
        hnbrdf_error error;
        told.count = 0;
        told.most = limits[i];
        hnbrdf_result result = gpu_sphere_render(&sphere, &options, &image, NULL, &error);
        assert_int_equal(result, i > 0 ? HNBRDF_ERROR_CANCELLED : HNBRDF_OK);
        for (int k = 1; k < told.count; k++)
            assert_true(told.shares[k] > told.shares[k - 1]);
        if (i > 0) {
            assert_int_equal(told.count, limits[i]);
            continue;
        }
        assert_true(told.count >= 3 && told.shares[told.count - 1] == 1.0);
        render_image_free(&image);
    }
    gpu_sphere_close(&sphere);
    render_environment_free(&light);
    hnbrdf_model_free(model);
}

static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&GGX);
    render_environment light = make_light(64, 32, 0.0);
    gpu_device small = *gpu_run_device();
    gpu_sphere sphere;
    hnbrdf_error error = {""};
    small.properties.limits.maxStorageBufferRange = 64 * 32 * 16 - 1;
    assert_int_equal(gpu_sphere_open(&small, model, 0, &light, RENDER_MIS, CHECK_BUILD_EXACT,
                                     GPU_SPHERE_PICTURE, &sphere, &error),
                     HNBRDF_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.text, "64 x 32"));
    sphere = open_sphere(model, 0, &light, RENDER_MIS, 1, GPU_SPHERE_RECORD);
    gpu_sphere_draw draw;
    const render_options options = {.size = 1024, .spp = 1};
    assert_int_equal(gpu_sphere_record(&sphere, &options, 0, GPU_SPHERE_DRAWS, &draw, &error),
                     HNBRDF_ERROR_LIMIT);
    gpu_sphere_close(&sphere);
    render_environment_free(&light);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_strategy_draws_as_on_the_cpu),
        cmocka_unit_test(every_kind_of_model_draws_as_on_the_cpu),
        cmocka_unit_test(picture_is_the_cpus),
        cmocka_unit_test(pictures_of_other_seeds_agree_within_noise),
        cmocka_unit_test(progress_rises_to_one_and_can_stop),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return gpu_run_tests(tests, sizeof tests / sizeof tests[0]);
}
