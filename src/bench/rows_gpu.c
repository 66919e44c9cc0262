/* rows_gpu.c: what exported shaders take on the machine's Vulkan devices, in every style there
 * is. */
#include "base/error.h"
#include "bench/bench.h"

#ifdef HNBRDF_WITH_VULKAN
#include "base/clock.h"
#include "base/text_buffer.h"
#include "base/threads.h"
#include "gpu/compile.h"
#include "gpu/timed.h"
#include "hnbrdf/glsl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Two materials, told apart when the shader runs: a lone one would be folded into the network's
 * constants. */
enum { SCENE_MATERIALS = 2 };

typedef struct gpu_item {
    const struct gpu_bench_device *on;
    gpu_timed timed;
    struct gpu_item *next;
} gpu_item;

typedef struct gpu_bench_device {
    gpu_device device;
    gpu_timed_buffers buffers;
    gpu_item *items;
    char name[BENCH_NAME];
    int is_cpu;
} gpu_bench_device;

struct bench_gpu {
    gpu_instance instance;
    gpu_bench_device devices[BENCH_DEVICES];
    int count;
};

/* A device in software runs on this process's threads: what they use of the processors, shared
 * out to all of them, is what the device takes when nobody else wants the machine. Others tell by
 * their timestamps. */
static double run_item(void *context, long repeats)
{
    gpu_item *item = context;
    double ns = (double)NAN, used = -hnbrdf_process_seconds();
    if (gpu_timed_run(&item->on->device, &item->on->buffers, &item->timed, (int)repeats, &ns, NULL))
        return (double)NAN;
    used += hnbrdf_process_seconds();
    return item->on->is_cpu ? 1e9 * used / hnbrdf_processors() : ns;
}

/* ---- Scenes ---------------------------------------------------------------------------------- */

static hnbrdf_result open_item(gpu_bench_device *on, const gpu_scene *scene, gpu_work work,
                               gpu_item **opened, hnbrdf_error *error)
{
    hnbrdf_error inner;
    gpu_item *item = calloc(1, sizeof *item);
    if (!item)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    hnbrdf_result result =
        gpu_timed_open(&on->device, &on->buffers, scene, work, &item->timed, &inner);
    if (result) {
        free(item);
        return hnbrdf_fail(error, result, "%s: %s", on->name, inner.text);
    }
    item->on = on;
    item->next = on->items;
    *opened = on->items = item;
    return HNBRDF_OK;
}

static hnbrdf_probe probe_of(gpu_item *item)
{
    return hnbrdf_probe_make(run_item, item, (long)item->on->buffers.count);
}

static hnbrdf_result add_scene(bench *b, gpu_bench_device *on, const bench_model *model,
                               const gpu_scene *scene, const char *weights, const char *precision,
                               hnbrdf_error *error)
{
    bench_row *row;
    gpu_item *whole = NULL, *network = NULL;
    hnbrdf_result result =
        bench_add_row(b, model, on->name, "shader", weights, precision, &row, error);
    if (!result)
        result = open_item(on, scene, GPU_WORK_VALUE, &whole, error);
    if (!result && model->desc.kind != HNBRDF_KIND_GGX)
        result = open_item(on, scene, GPU_WORK_NETWORK, &network, error);
    if (result)
        return result;
    row->threads = on->is_cpu ? hnbrdf_processors() : 0;
    row->io = &b->io[b->io_count - 1];
    row->whole = probe_of(whole);
    if (network)
        row->network = probe_of(network);
    row->compile_ms = whole->timed.compile_ms;
    row->first_ms = whole->timed.first_ms;
    row->bytes = whole->timed.spirv_bytes + scene->weights_size;
    return HNBRDF_OK;
}

typedef struct exported_scene {
    hnbrdf_text_buffer text, weights;
} exported_scene;

static void free_scene(exported_scene *scene)
{
    free(scene->text.bytes);
    free(scene->weights.bytes);
}

static hnbrdf_result export_scene(const bench_model *model, hnbrdf_glsl_weights weights,
                                  hnbrdf_glsl_precision precision, int fixed, exported_scene *scene,
                                  hnbrdf_error *error)
{
    static const int first[SCENE_MATERIALS] = {0, 1};
    int count = model->desc.material_count;
    const hnbrdf_glsl_options options = {.materials = first,
                                         .material_count =
                                             count < SCENE_MATERIALS ? count : SCENE_MATERIALS,
                                         .standalone = 1,
                                         .weights = weights,
                                         .precision = precision,
                                         .fixed = fixed};
    hnbrdf_error inner;
    hnbrdf_result result = hnbrdf_export_shader(model->model, &options, hnbrdf_text_buffer_append,
                                                &scene->text, &inner);
    if (!result && weights == HNBRDF_GLSL_UNIFORM)
        result = hnbrdf_export_weights(model->model, &options, hnbrdf_text_buffer_append,
                                       &scene->weights, &inner);
    return result ? hnbrdf_fail(error, result, "%s: %s", model->name, inner.text) : HNBRDF_OK;
}

static hnbrdf_result add_style(bench *b, gpu_bench_device *on, const bench_model *model,
                               hnbrdf_glsl_weights weights, hnbrdf_glsl_precision precision,
                               int fixed, hnbrdf_error *error)
{
    exported_scene scene = {{0}, {0}};
    hnbrdf_result result = export_scene(model, weights, precision, fixed, &scene, error);
    const gpu_scene exported = {scene.text.bytes, scene.weights.bytes, scene.weights.size};
    if (!result)
        result = add_scene(b, on, model, &exported,
                           fixed ? "columns-fixed" : hnbrdf_glsl_weights_name(weights),
                           hnbrdf_glsl_precision_name(precision), error);
    if (!result && precision == HNBRDF_GLSL_HALF) {
        bench_row *row = &b->rows[b->row_count - 1];
        row->smape = model->half_smape;
        row->psnr = (double)NAN; /* the emulation is too slow for pictures */
    }
    free_scene(&scene);
    return result;
}

/* Every storage of the weights, the fastest one in half precision too; GGX has none to store. */
static hnbrdf_result add_model(bench *b, gpu_bench_device *on, const bench_model *model,
                               hnbrdf_error *error)
{
    hnbrdf_result result =
        add_style(b, on, model, HNBRDF_GLSL_CONSTANTS, HNBRDF_GLSL_FLOAT, 0, error);
    if (model->desc.kind == HNBRDF_KIND_GGX)
        return result;
    if (!result && on->device.has_half)
        result = add_style(b, on, model, HNBRDF_GLSL_CONSTANTS, HNBRDF_GLSL_HALF, 0, error);
    if (!result)
        result = add_style(b, on, model, HNBRDF_GLSL_COLUMNS, HNBRDF_GLSL_FLOAT, 0, error);
    if (!result)
        result = add_style(b, on, model, HNBRDF_GLSL_COLUMNS, HNBRDF_GLSL_FLOAT, 1, error);
    if (!result)
        result = add_style(b, on, model, HNBRDF_GLSL_UNIFORM, HNBRDF_GLSL_FLOAT, 0, error);
    return result;
}

/* Its errors are known where the model's are: the published style has the encoding `directions`, no
 * floor. */
static hnbrdf_result add_peer(bench *b, gpu_bench_device *on, const bench_model *model,
                              hnbrdf_error *error)
{
    int count = model->desc.material_count;
    if (model->desc.kind != HNBRDF_KIND_HYBRID || model->desc.hidden % 4 != 0)
        return HNBRDF_OK;
    char *text = bench_peer_shader(&model->desc, count < SCENE_MATERIALS ? count : SCENE_MATERIALS);
    const gpu_scene scene = {.text = text};
    hnbrdf_result result = text ? add_scene(b, on, model, &scene, "published-style", "float", error)
                                : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    free(text);
    if (result)
        return result;
    bench_row *row = &b->rows[b->row_count - 1];
    row->encoding = HNBRDF_ENCODING_DIRECTIONS;
    row->smape = model->peer_smape;
    row->psnr = model->peer_psnr;
    return HNBRDF_OK;
}

/* ---- Devices --------------------------------------------------------------------------------- */

/* Without what it says about its driver: "vulkan:llvmpipe (LLVM 15.0.6, 256 bits)" is
 * "vulkan:llvmpipe". */
static void name_device(const gpu_instance *instance, int index, char name[BENCH_NAME])
{
    char full[VK_MAX_PHYSICAL_DEVICE_NAME_SIZE];
    memcpy(full, instance->properties[index].deviceName, sizeof full);
    char *bracket = strstr(full, " (");
    if (bracket)
        *bracket = '\0';
    snprintf(name, BENCH_NAME, "vulkan:%.80s", full);
}

static void tell_device(const bench *b, const gpu_bench_device *on, const gpu_instance *instance,
                        int index)
{
    char line[512];
    snprintf(line, sizeof line, "%s: %s, %s, %s", on->name, on->device.properties.deviceName,
             gpu_kind_name(instance, index), instance->drivers[index]);
    if (b->watch.tell)
        b->watch.tell(b->watch.user, line);
}

static hnbrdf_result open_device(bench *b, struct bench_gpu *gpu, int index,
                                 const bench_gpu_options *options, hnbrdf_error *error)
{
    gpu_bench_device *on = &gpu->devices[gpu->count];
    hnbrdf_error inner;
    name_device(&gpu->instance, index, on->name);
    hnbrdf_result result = gpu_device_open(&gpu->instance, index, &on->device, &inner);
    if (result)
        return hnbrdf_fail(error, result, "%s: %s", on->name, inner.text);
    gpu->count++;
    result =
        gpu_timed_buffers_open(&on->device, (uint32_t)options->evaluations, &on->buffers, &inner);
    if (result)
        return hnbrdf_fail(error, result, "%s: %s", on->name, inner.text);
    on->is_cpu = on->device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    tell_device(b, on, &gpu->instance, index);
    exported_scene scene = {{0}, {0}};
    gpu_item *copy = NULL;
    result =
        export_scene(&b->models[0], HNBRDF_GLSL_CONSTANTS, HNBRDF_GLSL_FLOAT, 0, &scene, error);
    if (!result)
        result = open_item(on, &(gpu_scene){.text = scene.text.bytes}, GPU_WORK_COPY, &copy, error);
    free_scene(&scene);
    if (!result)
        b->io[b->io_count++] = probe_of(copy);
    return result;
}

static hnbrdf_result add_device(bench *b, struct bench_gpu *gpu, int index,
                                const bench_gpu_options *options, hnbrdf_error *error)
{
    if (gpu->count == BENCH_DEVICES)
        return HNBRDF_OK;
    gpu_bench_device *on = &gpu->devices[gpu->count];
    hnbrdf_result result = open_device(b, gpu, index, options, error);
    for (int k = 0; k < b->model_count && !result; k++) {
        result = bench_show(&b->watch, "compiling shaders", (double)k / b->model_count,
                            b->models[k].name, error);
        if (!result)
            result = add_model(b, on, &b->models[k], error);
        if (!result && options->peer)
            result = add_peer(b, on, &b->models[k], error);
    }
    return result;
}

/* Which devices: the first and how many. */
static hnbrdf_result choose(const gpu_instance *instance, const char *text, int *first, int *count,
                            hnbrdf_error *error)
{
    *first = 0;
    *count = instance->count;
    if (strcmp(text, "all") == 0)
        return HNBRDF_OK;
    char *end;
    long number = strtol(text, &end, 10);
    if (end == text || *end || number < 0 || number >= instance->count)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "--device %s: expected all, none, or a number below %d (hnbrdf verify --list)", text,
            instance->count);
    *first = (int)number;
    *count = 1;
    return HNBRDF_OK;
}

hnbrdf_result bench_gpu_open(bench *b, const bench_gpu_options *options, bench_gpu **opened,
                             hnbrdf_error *error)
{
    struct bench_gpu *gpu = *opened = calloc(1, sizeof *gpu);
    int first = 0, count = 0;
    if (!gpu)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    if (strcmp(options->device, "none") == 0)
        return HNBRDF_OK;
    if (!gpu_compiler_found()) {
        if (b->watch.warn)
            b->watch.warn(b->watch.user, "no glslangValidator (Debian: apt-get install "
                                         "glslang-tools), so no Vulkan rows");
        return HNBRDF_OK;
    }
    hnbrdf_result result = gpu_open(GPU_NOT_VALIDATED, &gpu->instance, error);
    if (!result)
        result = choose(&gpu->instance, options->device, &first, &count, error);
    for (int k = 0; k < count && !result; k++)
        result = add_device(b, gpu, first + k, options, error);
    return result;
}

static void close_device(gpu_bench_device *on)
{
    for (gpu_item *item = on->items; item;) {
        gpu_item *next = item->next;
        gpu_timed_close(&on->device, &item->timed);
        free(item);
        item = next;
    }
    gpu_timed_buffers_close(&on->device, &on->buffers);
    gpu_device_close(&on->device);
}

void bench_gpu_close(bench_gpu *gpu)
{
    for (int k = 0; gpu && k < gpu->count; k++)
        close_device(&gpu->devices[k]);
    if (gpu && gpu->instance.handle)
        gpu_close(&gpu->instance);
    free(gpu);
}

#else

#include <stdlib.h>
#include <string.h>

struct bench_gpu {
    int unused;
};

hnbrdf_result bench_gpu_open(bench *b, const bench_gpu_options *options, bench_gpu **opened,
                             hnbrdf_error *error)
{
    (void)error;
    *opened = NULL;
    if (strcmp(options->device, "none") != 0 && b->watch.warn)
        b->watch.warn(b->watch.user,
                      "built without Vulkan (HNBRDF_WITH_VULKAN), so no Vulkan rows");
    return HNBRDF_OK;
}

void bench_gpu_close(bench_gpu *gpu)
{
    free(gpu);
}

#endif
