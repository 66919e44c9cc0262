/* gpu_run.c: a compute shader of a test, with an exported scene, on every Vulkan device of this
 * machine. */
#include "gpu_run.h"
#include "sanitized.h"

#include "gpu/compile.h"
#include "gpu/compute.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(__SSE__) || defined(__x86_64__)
#include <xmmintrin.h>
#define CAN_FLUSH 1
#else
#define CAN_FLUSH 0
#endif

/* The text of shaders/hybrid_brdf.glsl. */
extern const char hnbrdf_hybrid_brdf_glsl[];

static gpu_device device;
static check_arithmetic arithmetic;

static const char SHADER[] =
    "#version 450\n"
    "#extension GL_GOOGLE_include_directive : require\n"
    "#include \"hybrid_brdf.glsl\"\n"
    "#include \"scene.glsl\"\n"
    "layout(local_size_x = 64) in;\n"
    "layout(std430, set = 0, binding = 0) readonly buffer In { uint in_words[]; };\n"
    "layout(std430, set = 0, binding = 1) writeonly buffer Results { float results[]; };\n"
    "layout(push_constant) uniform Push { uint count; int material; };\n"
    "float in_float(uint at) { return uintBitsToFloat(in_words[at]); }\n"
    "vec3 in_vec3(uint at) { return vec3(in_float(at), in_float(at + 1), in_float(at + 2)); }\n"
    "void store3(uint at, vec3 v) { results[at] = v.x; results[at + 1] = v.y; results[at + 2] = "
    "v.z; "
    "}\n"
    "#include \"body.glsl\"\n";

static void check(hnbrdf_result result, const hnbrdf_error *error)
{
    if (result)
        fail_msg("%s", error->text);
}

int gpu_run_exact(void)
{
    return arithmetic.exact_basic && arithmetic.exact_divide && arithmetic.exact_sqrt &&
           (arithmetic.keeps_denormals || (CAN_FLUSH && arithmetic.flushes_denormals));
}

const gpu_device *gpu_run_device(void)
{
    return &device;
}

check_rules gpu_run_rules(int exact)
{
    return exact ? check_rules_exact(&arithmetic)
                 : check_rules_fast(&arithmetic, device.driver_id == VK_DRIVER_ID_MESA_LLVMPIPE);
}

#if CAN_FLUSH
static unsigned state_before;

void gpu_run_c_begin(void)
{
    const unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x40;
    state_before = _mm_getcsr();
    if (arithmetic.flushes_denormals)
        _mm_setcsr(state_before | flush_to_zero | denormals_are_zero);
}

void gpu_run_c_end(void)
{
    _mm_setcsr(state_before);
}
#else
void gpu_run_c_begin(void)
{
}

void gpu_run_c_end(void)
{
}
#endif

uint32_t *gpu_run_compile(const char *scene, const char *body, int exact, size_t *bytes)
{
    const gpu_include includes[] = {
        {"hybrid_brdf.glsl", hnbrdf_hybrid_brdf_glsl}, {"scene.glsl", scene}, {"body.glsl", body}};
    const char *const defines[] = {exact ? "HNBRDF_EXACT=1" : "HNBRDF_EXACT=0", NULL};
    uint32_t *spirv = NULL;
    hnbrdf_error error = {""};
    check(gpu_compile(SHADER, includes, 3, defines, &spirv, bytes, &error), &error);
    return spirv;
}

void gpu_run_compiled(const uint32_t *spirv, size_t bytes, int material, uint32_t count,
                      const void *in, size_t in_words, float *results, size_t result_words)
{
    const struct {
        uint32_t count;
        int32_t material;
    } push = {count, material};
    gpu_buffer input, output;
    const gpu_buffer *const buffers[] = {&input, &output};
    gpu_program program;
    VkPipeline pipeline;
    hnbrdf_error error = {""};
    check(gpu_buffer_open(&device, in_words * 4, &input, &error), &error);
    check(gpu_buffer_open(&device, result_words * 4, &output, &error), &error);
    check(gpu_upload(&device, &input, in, in_words * 4, &error), &error);
    check(gpu_program_open(&device, spirv, bytes, buffers, 2, sizeof push, &program, &error),
          &error);
    check(gpu_pipeline_open(&device, &program, 0, &pipeline, &error), &error);
    check(gpu_dispatch(&device, &program, pipeline, &push, count, 1, NULL, &error), &error);
    check(gpu_download(&device, &output, results, result_words * 4, &error), &error);
    vkDestroyPipeline(device.handle, pipeline, NULL);
    gpu_program_close(&device, &program);
    gpu_buffer_close(&device, &input);
    gpu_buffer_close(&device, &output);
}

void gpu_run(const char *scene, const char *body, int exact, int material, uint32_t count,
             const void *in, size_t in_words, float *results, size_t result_words)
{
    size_t bytes;
    uint32_t *spirv = gpu_run_compile(scene, body, exact, &bytes);
    gpu_run_compiled(spirv, bytes, material, count, in, in_words, results, result_words);
    free(spirv);
}

int gpu_run_append(void *user, const void *data, size_t size)
{
    gpu_run_text *text = user;
    char *grown = realloc(text->bytes, text->size + size + 1);
    if (!grown)
        return 1;
    memcpy(grown + text->size, data, size);
    text->bytes = grown;
    text->size += size;
    grown[text->size] = '\0';
    return 0;
}

char *gpu_run_export(const hnbrdf_model *model, const hnbrdf_glsl_options *options)
{
    gpu_run_text text = {0};
    hnbrdf_error error = {""};
    check(hnbrdf_export_shader(model, options, gpu_run_append, &text, &error), &error);
    return text.bytes;
}

void gpu_run_assert_same(const char *what, const float *on_device, const float *reference,
                         size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (memcmp(&on_device[i], &reference[i], sizeof(float)) != 0 &&
            on_device[i] != reference[i])
            fail_msg("%s: number %zu is %.9g on the device, %.9g in C", what, i,
                     (double)on_device[i], (double)reference[i]);
}

/* ---- Devices --------------------------------------------------------------------------------- */

static int run_on(const gpu_instance *instance, int index, const struct CMUnitTest *tests,
                  size_t count)
{
    hnbrdf_error error = {""};
    const char *name = instance->properties[index].deviceName;
    printf("device %d: %s\n", index, name);
    if (gpu_device_open(instance, index, &device, &error) ||
        gpu_probe(&device, &arithmetic, &error)) {
        printf("%s\n", error.text);
        return 1;
    }
    int failed = _cmocka_run_group_tests(name, tests, count, NULL, NULL);
    gpu_device_close(&device);
    return failed;
}

int gpu_run_tests(const struct CMUnitTest *tests, size_t count)
{
    gpu_instance instance;
    hnbrdf_error error = {""};
    int failed = 0;
    if (!gpu_compiler_found()) {
        printf("skipped: no glslangValidator\n");
        return 77;
    }
    /* Kept loaded, or LeakSanitizer cannot tell what the driver still holds from a leak. */
    dlopen("libvulkan_lvp.so", RTLD_NOW | RTLD_NODELETE);
    if (gpu_open(SANITIZED ? GPU_VALIDATED : GPU_VALIDATED_SYNC, &instance, &error) &&
        gpu_open(GPU_NOT_VALIDATED, &instance, &error)) {
        printf("%s\n", error.text);
        return 1;
    }
    for (int i = 0; i < instance.count; i++)
        failed += run_on(&instance, i, tests, count);
    int devices = instance.count, messages = instance.messages;
    gpu_close(&instance);
    if (devices == 0)
        printf("skipped: no Vulkan device\n");
    return devices == 0 ? 77 : failed + messages;
}
