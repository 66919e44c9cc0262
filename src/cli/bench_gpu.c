/* bench_gpu.c: what exported shaders take on the machine's Vulkan devices, in every style there
 * is. */
#include "cli/bench.h"

#ifdef HNBRDF_WITH_VULKAN
#include "base/clock.h"
#include "base/text_buffer.h"
#include "gpu/compile.h"
#include "gpu/timed.h"

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

static double process_ns(void)
{
    return 1e9 * hnbrdf_process_seconds();
}

/* A device in software runs on this process's threads: what they use of the processors, shared
 * out to all of them, is what the device takes when nobody else wants the machine. Others tell by
 * their timestamps. */
static double run_item(void *context, long repeats)
{
    gpu_item *item = context;
    double ns = (double)NAN, used = -process_ns();
    hnbrdf_error error;
    if (gpu_timed_run(&item->on->device, &item->on->buffers, &item->timed, (int)repeats, &ns,
                      &error))
        return (double)NAN;
    used += process_ns();
    return item->on->is_cpu ? used / cli_processors() : ns;
}

/* ---- Scenes ---------------------------------------------------------------------------------- */

/* NULL after a message. */
static gpu_item *open_item(gpu_bench_device *on, const gpu_scene *scene, gpu_work work)
{
    hnbrdf_error error;
    gpu_item *item = calloc(1, sizeof *item);
    if (!item) {
        cli_fail("out of memory");
        return NULL;
    }
    if (gpu_timed_open(&on->device, &on->buffers, scene, work, &item->timed, &error)) {
        free(item);
        cli_fail("%s: %s", on->name, error.text);
        return NULL;
    }
    item->on = on;
    item->next = on->items;
    return on->items = item;
}

static bench_probe probe_of(gpu_item *item)
{
    return bench_probe_make(run_item, item, (long)item->on->buffers.count);
}

static int add_scene(bench *b, gpu_bench_device *on, const bench_model *model,
                     const gpu_scene *scene, const char *weights, const char *precision)
{
    bench_row *row = bench_add_row(b, model, on->name, "shader", weights, precision);
    gpu_item *whole = row ? open_item(on, scene, GPU_WORK_VALUE) : NULL;
    gpu_item *network = NULL;
    int has_network = model->desc.kind != HNBRDF_KIND_GGX;
    if (whole && has_network)
        network = open_item(on, scene, GPU_WORK_NETWORK);
    if (!whole || (has_network && !network))
        return CLI_FAILURE;
    row->threads = on->is_cpu ? cli_processors() : 0;
    row->io = &b->io[b->io_count - 1];
    row->whole = probe_of(whole);
    if (network)
        row->network = probe_of(network);
    row->compile_ms = whole->timed.compile_ms;
    row->first_ms = whole->timed.first_ms;
    row->bytes = whole->timed.spirv_bytes + scene->weights_size;
    return CLI_OK;
}

typedef struct exported_scene {
    hnbrdf_text_buffer text, weights;
} exported_scene;

static void free_scene(exported_scene *scene)
{
    free(scene->text.bytes);
    free(scene->weights.bytes);
}

static int export_scene(const bench_model *model, hnbrdf_glsl_weights weights,
                        hnbrdf_glsl_precision precision, exported_scene *scene)
{
    static const int first[SCENE_MATERIALS] = {0, 1};
    int count = model->desc.material_count;
    const hnbrdf_glsl_options options = {.materials = first,
                                         .material_count =
                                             count < SCENE_MATERIALS ? count : SCENE_MATERIALS,
                                         .standalone = 1,
                                         .weights = weights,
                                         .precision = precision};
    hnbrdf_error error;
    hnbrdf_result result =
        hnbrdf_export_glsl(model->model, &options, hnbrdf_text_buffer_append, &scene->text, &error);
    if (!result && weights == HNBRDF_GLSL_UNIFORM)
        result = hnbrdf_export_weights(model->model, &options, hnbrdf_text_buffer_append,
                                       &scene->weights, &error);
    return result ? cli_fail("%s: %s", model->name, error.text) : CLI_OK;
}

static int add_style(bench *b, gpu_bench_device *on, const bench_model *model,
                     hnbrdf_glsl_weights weights, hnbrdf_glsl_precision precision)
{
    exported_scene scene = {{0}, {0}};
    int code = export_scene(model, weights, precision, &scene);
    const gpu_scene exported = {scene.text.bytes, scene.weights.bytes, scene.weights.size};
    if (code == CLI_OK)
        code = add_scene(b, on, model, &exported, hnbrdf_glsl_weights_name(weights),
                         hnbrdf_glsl_precision_name(precision));
    if (code == CLI_OK && precision == HNBRDF_GLSL_HALF) {
        bench_row *row = &b->rows[b->row_count - 1];
        row->smape = model->half_smape;
        row->psnr = (double)NAN; /* the emulation is too slow for pictures */
    }
    free_scene(&scene);
    return code;
}

/* Every storage of the weights, the fastest one in half precision too; GGX has none to store. */
static int add_model(bench *b, gpu_bench_device *on, const bench_model *model)
{
    int code = add_style(b, on, model, HNBRDF_GLSL_CONSTANTS, HNBRDF_GLSL_FLOAT);
    if (model->desc.kind == HNBRDF_KIND_GGX)
        return code;
    if (code == CLI_OK && on->device.has_half)
        code = add_style(b, on, model, HNBRDF_GLSL_CONSTANTS, HNBRDF_GLSL_HALF);
    if (code == CLI_OK)
        code = add_style(b, on, model, HNBRDF_GLSL_COLUMNS, HNBRDF_GLSL_FLOAT);
    if (code == CLI_OK)
        code = add_style(b, on, model, HNBRDF_GLSL_UNIFORM, HNBRDF_GLSL_FLOAT);
    return code;
}

/* Its errors are known where the model's are: the published style has the encoding `directions`, no
 * floor. */
static int add_peer(bench *b, gpu_bench_device *on, const bench_model *model)
{
    int count = model->desc.material_count;
    if (model->desc.kind != HNBRDF_KIND_HYBRID || model->desc.hidden % 4 != 0)
        return CLI_OK;
    char *text = bench_peer_shader(&model->desc, count < SCENE_MATERIALS ? count : SCENE_MATERIALS);
    const gpu_scene scene = {.text = text};
    int code = text ? add_scene(b, on, model, &scene, "published-style", "float")
                    : cli_fail("out of memory");
    free(text);
    if (code != CLI_OK)
        return code;
    bench_row *row = &b->rows[b->row_count - 1];
    row->encoding = HNBRDF_ENCODING_DIRECTIONS;
    row->smape = model->peer_smape;
    row->psnr = model->peer_psnr;
    return CLI_OK;
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

static int open_device(bench *b, struct bench_gpu *gpu, int index, const bench_gpu_options *options)
{
    gpu_bench_device *on = &gpu->devices[gpu->count];
    hnbrdf_error error;
    name_device(&gpu->instance, index, on->name);
    if (gpu_device_open(&gpu->instance, index, &on->device, &error))
        return cli_fail("%s: %s", on->name, error.text);
    gpu->count++;
    if (gpu_timed_buffers_open(&on->device, (uint32_t)options->evaluations, &on->buffers, &error))
        return cli_fail("%s: %s", on->name, error.text);
    on->is_cpu = on->device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    printf("%s: %s, %s, %s\n", on->name, on->device.properties.deviceName,
           gpu_kind_name(&gpu->instance, index), gpu->instance.drivers[index]);
    exported_scene scene = {{0}, {0}};
    gpu_item *copy = NULL;
    if (export_scene(&b->models[0], HNBRDF_GLSL_CONSTANTS, HNBRDF_GLSL_FLOAT, &scene) == CLI_OK)
        copy = open_item(on, &(gpu_scene){.text = scene.text.bytes}, GPU_WORK_COPY);
    free_scene(&scene);
    if (!copy)
        return CLI_FAILURE;
    b->io[b->io_count++] = probe_of(copy);
    return CLI_OK;
}

static int add_device(bench *b, struct bench_gpu *gpu, int index, const bench_gpu_options *options)
{
    if (gpu->count == BENCH_DEVICES)
        return CLI_OK;
    int code = open_device(b, gpu, index, options);
    gpu_bench_device *on = &gpu->devices[gpu->count - 1];
    cli_progress line;
    cli_progress_begin(&line, "compiling shaders");
    for (int k = 0; k < b->model_count && code == CLI_OK; k++) {
        cli_progress_update(&line, (double)k / b->model_count, b->models[k].name);
        code = add_model(b, on, &b->models[k]);
        if (code == CLI_OK && options->peer)
            code = add_peer(b, on, &b->models[k]);
    }
    cli_progress_end(&line);
    return code;
}

/* Which devices: the first and how many. 0, or an exit code after a message. */
static int choose(const gpu_instance *instance, const char *text, int *first, int *count)
{
    *first = 0;
    *count = instance->count;
    if (strcmp(text, "all") == 0)
        return CLI_OK;
    char *end;
    long number = strtol(text, &end, 10);
    if (end == text || *end || number < 0 || number >= instance->count)
        return cli_fail(
            "--device %s: expected all, none, or a number below %d (hnbrdf verify --list)", text,
            instance->count);
    *first = (int)number;
    *count = 1;
    return CLI_OK;
}

bench_gpu *bench_gpu_open(bench *b, const bench_gpu_options *options)
{
    struct bench_gpu *gpu = calloc(1, sizeof *gpu);
    hnbrdf_error error;
    int first = 0, count = 0, code = gpu ? CLI_OK : cli_fail("out of memory");
    if (code != CLI_OK || strcmp(options->device, "none") == 0)
        return gpu;
    if (!gpu_compiler_found()) {
        cli_warn("no glslangValidator (Debian: apt-get install glslang-tools), so no Vulkan rows");
        return gpu;
    }
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 0); /* the first dispatch is timed */
    if (gpu_open(GPU_NOT_VALIDATED, &gpu->instance, &error))
        code = cli_fail("%s", error.text);
    if (code == CLI_OK)
        code = choose(&gpu->instance, options->device, &first, &count);
    for (int k = 0; k < count && code == CLI_OK; k++)
        code = add_device(b, gpu, first + k, options);
    if (code == CLI_OK)
        return gpu;
    bench_gpu_close(gpu);
    return NULL;
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

bench_gpu *bench_gpu_open(bench *b, const bench_gpu_options *options)
{
    (void)b;
    struct bench_gpu *gpu = calloc(1, sizeof *gpu);
    if (!gpu)
        cli_fail("out of memory");
    else if (strcmp(options->device, "none") != 0)
        cli_warn("built without Vulkan (HNBRDF_WITH_VULKAN), so no Vulkan rows");
    return gpu;
}

void bench_gpu_close(bench_gpu *gpu)
{
    free(gpu);
}

#endif
