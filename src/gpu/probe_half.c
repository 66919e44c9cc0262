/* probe_half.c: runs shaders/probe_half.comp and compares every operation with C. */
#include "gpu/probe_half.h"

#include "base/error.h"
#include "gpu/compile.h"
#include "gpu/compute.h"
#include "hnbrdf/measured.h"
#include "glsl/half.h"

#include <math.h>
#include <stdlib.h>

/* The text of shaders/probe_half.comp. */
extern const char hnbrdf_probe_half_comp[];

enum { VALUES = 1 << 14 };

typedef struct probe {
    gpu_buffer input, output;
    gpu_program program;
    VkPipeline pipeline;
    float operands[VALUES][4], results[VALUES][4];
} probe;

static float random_float(hnbrdf_rng *rng, int low_exponent, int high_exponent)
{
    uint32_t bits = hnbrdf_rng_u32(rng);
    uint32_t range = (uint32_t)(high_exponent - low_exponent + 1);
    int exponent = low_exponent + (int)(hnbrdf_rng_u32(rng) % range);
    float magnitude = ldexpf(1.0f + (float)(bits >> 9) * 0x1p-23f, exponent);
    return bits & 1 ? -magnitude : magnitude;
}

/* No result passes 65504. Every fourth conversion is of a number half way between two halves. */
static void draw_operands(hnbrdf_rng *rng, int k, float operands[4])
{
    static const int ranges[4][2] = {{-1, 0}, {-3, 3}, {-10, 6}, {-20, 0}};
    const int *range = ranges[k % 4];
    for (int i = 0; i < 3; i++)
        operands[i] = hnbrdf_round_to_half(random_float(rng, range[0], range[1]));
    float free = random_float(rng, -16, 14);
    operands[3] = k % 4 == 2 ? hnbrdf_round_to_half(free) + ldexpf(1.0f, ilogbf(free) - 11) : free;
}

static void compare(float reference, float device, check_arithmetic *seen)
{
    float rounded = hnbrdf_round_to_half(reference);
    if (rounded == device)
        return;
    if (fabsf(rounded) < 0x1p-14f)
        seen->keeps_half_denormals = 0;
    else
        seen->exact_half = 0;
}

/* Results of subnormal operands say nothing about what normal ones give. */
static void compare_all(const probe *p, check_arithmetic *seen)
{
    seen->has_half = seen->exact_half = seen->keeps_half_denormals = 1;
    for (int k = 0; k < VALUES; k++) {
        const float *o = p->operands[k], *device = p->results[k];
        int subnormal = 0;
        for (int i = 0; i < 3; i++)
            subnormal |= fabsf(o[i]) < 0x1p-14f;
        float product = hnbrdf_round_to_half(o[0] * o[1]);
        check_arithmetic here = {.exact_half = 1, .keeps_half_denormals = 1};
        compare(o[3], device[0], &here);
        seen->exact_half &= here.exact_half;
        compare(o[0] + o[1], device[1], &here);
        compare(o[0] * o[1], device[2], &here);
        compare(product + o[2], device[3], &here);
        subnormal |= fabsf(product) < 0x1p-14f;
        seen->exact_half &= here.exact_half || subnormal;
        seen->keeps_half_denormals &= here.keeps_half_denormals && (here.exact_half || !subnormal);
    }
}

static hnbrdf_result run(const gpu_device *device, const uint32_t *spirv, size_t size, probe *p,
                         hnbrdf_error *error)
{
    const gpu_buffer *const buffers[] = {&p->input, &p->output};
    uint32_t count = VALUES;
    hnbrdf_result result = gpu_buffer_open(device, sizeof p->operands, &p->input, error);
    if (!result)
        result = gpu_buffer_open(device, sizeof p->results, &p->output, error);
    if (!result)
        result =
            gpu_program_open(device, spirv, size, buffers, 2, sizeof count, &p->program, error);
    if (!result)
        result = gpu_pipeline_open(device, &p->program, 0, &p->pipeline, error);
    if (!result)
        result = gpu_upload(device, &p->input, p->operands, sizeof p->operands, error);
    if (!result)
        result = gpu_dispatch(device, &p->program, p->pipeline, &count, VALUES, 1, NULL, error);
    if (!result)
        result = gpu_download(device, &p->output, p->results, sizeof p->results, error);
    vkDestroyPipeline(device->handle, p->pipeline, NULL);
    gpu_program_close(device, &p->program);
    gpu_buffer_close(device, &p->input);
    gpu_buffer_close(device, &p->output);
    return result;
}

hnbrdf_result gpu_probe_half(const gpu_device *device, check_arithmetic *arithmetic,
                             hnbrdf_error *error)
{
    uint32_t *spirv = NULL;
    size_t size = 0;
    hnbrdf_rng rng;
    if (!device->has_half)
        return HNBRDF_OK;
    probe *p = calloc(1, sizeof *p);
    if (!p)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "probe: no memory");
    hnbrdf_rng_seed(&rng, 2, 0);
    for (int k = 0; k < VALUES; k++)
        draw_operands(&rng, k, p->operands[k]);
    hnbrdf_result result = gpu_compile(hnbrdf_probe_half_comp, NULL, 0, NULL, &spirv, &size, error);
    if (!result)
        result = run(device, spirv, size, p, error);
    if (!result)
        compare_all(p, arithmetic);
    free(spirv);
    free(p);
    return result;
}
