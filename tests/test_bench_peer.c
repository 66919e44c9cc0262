/* test_bench_peer.c: what `hnbrdf bench` times is what it says: the peer's shader gives the
 * values of the peer's model, an exported one those of its model. Skipped where there is no
 * Vulkan device or no glslangValidator. */
#include "gpu_support.h"

#include "bench/bench.h"
#include "gpu/compile.h"
#include "gpu/timed.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS = 4096 };

static gpu_instance instance;
static gpu_device device;
static float pairs[PAIRS][6], values[PAIRS][3];

static hnbrdf_model *make_model(hnbrdf_encoding encoding, int hidden, int layers, int latent)
{
    const scene_shape shape = {
        .encoding = encoding, .hidden = hidden, .layers = layers, .latent = latent};
    return scene_model(&shape);
}

/* Runs a scene over the timed directions. */
static void run_scene(const char *scene)
{
    hnbrdf_error error = {""};
    gpu_timed_buffers buffers;
    gpu_timed timed;
    double ns = -1.0;
    const gpu_scene exported = {.text = scene};
    if (gpu_timed_buffers_open(&device, PAIRS, &buffers, &error) ||
        gpu_timed_open(&device, &buffers, &exported, GPU_WORK_VALUE, &timed, &error) ||
        gpu_timed_run(&device, &buffers, &timed, 2, &ns, &error) ||
        gpu_timed_download(&device, &buffers, PAIRS, pairs, values, &error))
        fail_msg("%s", error.text);
    assert_true(timed.spirv_bytes > 0 && timed.compile_ms > 0.0 && timed.first_ms > 0.0);
    assert_true(ns > 0.0 || isnan(ns));
    gpu_timed_close(&device, &timed);
    gpu_timed_buffers_close(&device, &buffers);
}

/* The worst |device - C| / (|C| + 0.01) over all pairs. */
static double worst_error(const hnbrdf_model *model)
{
    double worst = 0.0;
    for (int k = 0; k < PAIRS; k++) {
        float f[3];
        hnbrdf_eval(model, hnbrdf_model_material(model, 0), pairs[k], pairs[k] + 3, f);
        for (int c = 0; c < 3; c++)
            worst = fmax(worst,
                         fabs((double)values[k][c] - (double)f[c]) / (fabs((double)f[c]) + 0.01));
    }
    return worst;
}

/* alpha is 0.35. The tangent of an angle loses digits near the normal: 1 - cos^2 has an error of
 * 1e-7, 1e-6 of alpha^2. g - c loses as many where eta is near 1. exp and pow are within 35 ulp,
 * 4e-6, on the one device known; sums are in another order. 1e-4 has room for all of that and
 * none for a wrong weight, factor or channel, nor for weights that were not rounded. */
static void peer_shader_gives_the_values_of_the_rounded_model(void **state)
{
    (void)state;
    static const int shapes[][3] = {{8, 2, 4}, {4, 1, 3}, {16, 3, 1}, {12, 1, 6}, {8, 4, 16}};
    for (size_t s = 0; s < sizeof shapes / sizeof shapes[0]; s++) {
        hnbrdf_model *model =
            make_model(HNBRDF_ENCODING_DIRECTIONS, shapes[s][0], shapes[s][1], shapes[s][2]);
        hnbrdf_model_desc desc;
        hnbrdf_model_describe(model, &desc);
        char *scene = bench_peer_shader(&desc, 2);
        hnbrdf_model *peer = bench_peer_model(&desc);
        assert_non_null(scene);
        assert_non_null(peer);
        run_scene(scene);
        double worst = worst_error(peer), unrounded = worst_error(model);
        print_message(
            "%dx%d l = %d: peer against its model %.2g, against the one it is rounded from %.2g\n",
            shapes[s][0], shapes[s][1], shapes[s][2], worst, unrounded);
        assert_true(worst < 1e-4);
        assert_true(unrounded > 1e-4);
        free(scene);
        hnbrdf_model_free(peer);
        hnbrdf_model_free(model);
    }
}

/* Within the fast build's errors of exp and log, 16 ulp and 6e-7, which the network magnifies. */
static void exported_shader_is_the_one_that_is_timed(void **state)
{
    (void)state;
    hnbrdf_model *model = make_model(HNBRDF_ENCODING_ANGLES, 8, 2, 4);
    char *scene = scene_text(model, 1);
    run_scene(scene);
    assert_true(worst_error(model) < 1e-3);
    free(scene);
    hnbrdf_model_free(model);
}

static void network_and_copy_are_timed_too(void **state)
{
    (void)state;
    hnbrdf_error error = {""};
    gpu_timed_buffers buffers;
    hnbrdf_model *model = make_model(HNBRDF_ENCODING_ANGLES, 8, 2, 4);
    char *scene = scene_text(model, 1);
    const gpu_scene exported = {.text = scene};
    assert_int_equal(gpu_timed_buffers_open(&device, PAIRS, &buffers, &error), HNBRDF_OK);
    for (int work = GPU_WORK_NETWORK; work <= GPU_WORK_COPY; work++) {
        gpu_timed timed;
        double ns;
        if (gpu_timed_open(&device, &buffers, &exported, (gpu_work)work, &timed, &error) ||
            gpu_timed_run(&device, &buffers, &timed, 1, &ns, &error) ||
            gpu_timed_download(&device, &buffers, PAIRS, pairs, values, &error))
            fail_msg("%s", error.text);
        for (int c = 0; c < 3 && work == GPU_WORK_COPY; c++)
            assert_true(values[PAIRS - 1][c] == pairs[PAIRS - 1][c] + pairs[PAIRS - 1][c + 3]);
        gpu_timed_close(&device, &timed);
    }
    gpu_timed_buffers_close(&device, &buffers);
    free(scene);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(peer_shader_gives_the_values_of_the_rounded_model),
        cmocka_unit_test(exported_shader_is_the_one_that_is_timed),
        cmocka_unit_test(network_and_copy_are_timed_too),
    };
    hnbrdf_error error = {""};
    if (!gpu_compiler_found()) {
        print_message("skipped: no glslangValidator\n");
        return 77;
    }
    /* Kept loaded, or LeakSanitizer cannot tell what the driver still holds from a leak. */
    dlopen("libvulkan_lvp.so", RTLD_NOW | RTLD_NODELETE);
    if (gpu_open(GPU_NOT_VALIDATED, &instance, &error) || instance.count == 0) {
        print_message("skipped: no Vulkan device %s\n", error.text);
        return 77;
    }
    if (gpu_device_open(&instance, 0, &device, &error)) {
        print_message("%s\n", error.text);
        return 1;
    }
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gpu_device_close(&device);
    gpu_close(&instance);
    return failed;
}
