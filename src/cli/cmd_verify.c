/* cmd_verify.c: `hnbrdf verify`: the exported shader on this machine's GPUs against the C
 * library. */
#include "cli/cli.h"

#ifdef HNBRDF_WITH_VULKAN
#include "cli/words.h"
#include "report/verify_report.h"
#include "gpu/compile.h"
#include "hnbrdf/glsl.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "verify",
    "MODEL [--materials A,B] [--weights STYLE] [--precision P] [--fixed|--editable]\n"
    "              [--device N|all] [--pairs N]",
    "Proves on every Vulkan device that the exported shader gives what the C library gives. "
    "Compared "
    "are\n"
    "the encoding, the network alone, the analytic part and the whole BRDF, on random, mirror, "
    "grazing,\n"
    "retroreflecting and extreme pairs of directions, in two builds: exact (HNBRDF_EXACT 1: the "
    "bits "
    "of C\n"
    "where the device rounds + - * / sqrt correctly, which is probed) and fast (built-in exp and "
    "log). "
    "How\n"
    "far a device may differ is derived for every pair from the error of each operation (Vulkan's "
    "limits).\n"
    "\n"
    "Exit status 0 only if every device tried is within the bounds. Needs glslangValidator.",
    "hnbrdf verify model.safetensors\n"
    "hnbrdf verify model.safetensors --device 0 --pairs 100000 --json verify.json\n"
    "hnbrdf verify model.safetensors --weights uniform --precision half\n"
    "hnbrdf verify --list",
};

typedef struct settings {
    const char *materials, *device, *csv, *json;
    long pairs, seed;
    int validate, list, without_timing, fixed, editable;
    cli_word weights, precision;
} settings;

/* ---- The scene ------------------------------------------------------------------------------- */

typedef struct exported_scene {
    gpu_text text, weights;
} exported_scene;

static int export_scene(const hnbrdf_model *model, const settings *set, const int *materials,
                        int count, exported_scene *scene)
{
    const hnbrdf_glsl_options options = {.materials = materials,
                                         .material_count = count,
                                         .weights = (hnbrdf_glsl_weights)set->weights.value,
                                         .precision = (hnbrdf_glsl_precision)set->precision.value,
                                         .fixed = set->fixed,
                                         .editable = set->editable};
    hnbrdf_error error;
    hnbrdf_result result =
        hnbrdf_export_shader(model, &options, gpu_text_append, &scene->text, &error);
    if (!result && options.weights == HNBRDF_GLSL_UNIFORM && hnbrdf_weights_size(model) > 0)
        result = hnbrdf_export_weights(model, &options, gpu_text_append, &scene->weights, &error);
    return result ? cli_fail("%s", error.text) : CLI_OK;
}

/* ---- Devices --------------------------------------------------------------------------------- */

static void list_devices(const gpu_instance *instance)
{
    for (int i = 0; i < instance->count; i++)
        printf("%d: %s, %s, %s\n", i, instance->properties[i].deviceName,
               gpu_kind_name(instance, i), instance->drivers[i]);
}

/* Numbers of the devices meant: all, or one. Returns -1 to go on, else the exit code. */
static int choose_devices(const gpu_instance *instance, const char *text, int *first, int *count)
{
    *first = 0;
    *count = instance->count;
    if (instance->count == 0)
        return cli_fail(
            "no Vulkan device found (Debian: apt-get install mesa-vulkan-drivers brings "
            "one in software)");
    if (strcmp(text, "all") == 0)
        return -1;
    char *end;
    long number = strtol(text, &end, 10);
    if (end == text || *end)
        return cli_usage(&command, "--device: found '%s', expected a number or all", text);
    if (number < 0 || number >= instance->count)
        return cli_fail("--device %ld: this machine has devices 0 to %d (hnbrdf verify --list)",
                        number, instance->count - 1);
    *first = (int)number;
    *count = 1;
    return -1;
}

static void on_progress(void *user, double share)
{
    cli_progress_update(user, share, "");
}

static void verify_device(const gpu_instance *instance, const verification *v, const settings *set,
                          const exported_scene *scene, verified_device *to)
{
    cli_progress progress;
    gpu_device device;
    const gpu_verify_options options = {
        .scene = {scene->text.bytes, scene->weights.bytes, scene->weights.size},
        .precision = v->precision,
        .materials = v->materials,
        .material_count = v->material_count,
        .pairs = v->pairs,
        .seed = (uint64_t)set->seed,
        .without_timing = set->without_timing,
        .progress = on_progress,
        .progress_user = &progress};
    to->name = instance->properties[to->index].deviceName;
    to->kind = gpu_kind_name(instance, to->index);
    to->driver = instance->drivers[to->index];
    if (gpu_device_open(instance, to->index, &device, &to->failed))
        return;
    cli_progress_begin(&progress, to->name);
    if (gpu_verify(&device, v->model, &options, &to->report, &to->failed) == HNBRDF_OK)
        to->failed.text[0] = '\0';
    cli_progress_end(&progress);
    gpu_device_close(&device);
}

/* ---- All of it ------------------------------------------------------------------------------- */

static int write_results(const verification *v, const settings *set)
{
    if (!cli_is_stdout(set->csv) && !cli_is_stdout(set->json))
        verification_print(v, stdout);
    int result = cli_write_file(set->csv, verification_write_csv, v);
    if (result == CLI_OK)
        result = cli_write_file(set->json, verification_write_json, v);
    if (result != CLI_OK || verification_passed(v))
        return result;
    return cli_fail("%s: the shader is not proven equal to the C library on every device tried",
                    v->path);
}

static int verify_scene(gpu_instance *instance, verification *v, const settings *set, int first,
                        const exported_scene *scene)
{
    v->devices = calloc((size_t)v->device_count, sizeof *v->devices);
    if (!v->devices)
        return cli_fail("out of memory");
    for (int d = 0; d < v->device_count; d++) {
        v->devices[d].index = first + d;
        verify_device(instance, v, set, scene, &v->devices[d]);
    }
    v->messages = instance->messages;
    int result = write_results(v, set);
    for (int d = 0; d < v->device_count; d++)
        gpu_report_free(&v->devices[d].report);
    free(v->devices);
    return result;
}

static int verify_model(gpu_instance *instance, const settings *set, const char *path)
{
    verification v = {.path = path,
                      .pairs = (size_t)set->pairs,
                      .validated = set->validate,
                      .weights = (hnbrdf_glsl_weights)set->weights.value,
                      .precision = (hnbrdf_glsl_precision)set->precision.value};
    int first, *materials = NULL;
    hnbrdf_model *model = NULL;
    if (cli_open_model(path, &model) != CLI_OK)
        return CLI_FAILURE;
    v.model = model;
    int result = choose_devices(instance, set->device, &first, &v.device_count);
    if (result < 0)
        result = cli_choose_materials(model, set->materials, &materials, &v.material_count);
    if (result == CLI_OK) {
        v.materials = materials;
        exported_scene scene = {0};
        result = export_scene(model, set, materials, v.material_count, &scene);
        if (result == CLI_OK)
            result = verify_scene(instance, &v, set, first, &scene);
        free(scene.text.bytes);
        free(scene.weights.bytes);
    }
    free(materials);
    hnbrdf_model_free(model);
    return result;
}

int cmd_verify(int argc, char **argv)
{
    settings set = {.device = "all",
                    .pairs = 16384,
                    .seed = 1,
                    .weights = {HNBRDF_GLSL_CONSTANTS, cli_weights_word},
                    .precision = {HNBRDF_GLSL_FLOAT, cli_precision_word}};
    const cli_option options[] = {
        {"materials", 'm', CLI_TEXT, &set.materials, 0, 0, "A,B",
         "names of the materials (default: all)"},
        {"weights", 'w', CLI_WORD, &set.weights, 0, 0, "constants|columns|uniform",
         "style of the exported shader (default constants)"},
        {"precision", 0, CLI_WORD, &set.precision, 0, 0, "float|half",
         "of its hidden layers (default float)"},
        {"fixed", 0, CLI_FLAG, &set.fixed, 0, 0, NULL,
         "materials as constants, as export --fixed writes them"},
        {"editable", 0, CLI_FLAG, &set.editable, 0, 0, NULL, "as export --editable writes them"},
        {"device", 'd', CLI_TEXT, &set.device, 0, 0, "N|all",
         "number of a device, see --list (default: all)"},
        {"pairs", 'n', CLI_INT, &set.pairs, 64, 1 << 22, "N",
         "direction pairs a material (default 16384)"},
        {"seed", 0, CLI_INT, &set.seed, 0, 9007199254740992.0, "N",
         "of the random pairs (default 1)"},
        {"csv", 0, CLI_WRITE_TEXT, &set.csv, 0, 0, "FILE",
         "a row a device, material, build and stage; - is standard output"},
        {"json", 0, CLI_WRITE_TEXT, &set.json, 0, 0, "FILE",
         "everything found as JSON; - likewise"},
        {"validate", 0, CLI_FLAG, &set.validate, 0, 0, NULL,
         "with the Vulkan validation layer; any message fails"},
        {"without-timing", 0, CLI_FLAG, &set.without_timing, 0, 0, NULL,
         "do not measure the run time"},
        {"list", 0, CLI_FLAG, &set.list, 0, 0, NULL, "list the devices and stop"},
        {0},
    };
    int count, result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != (set.list ? 0 : 1))
        return cli_usage(&command,
                         set.list ? "found %d arguments, expected none with --list"
                                  : "found %d arguments, expected one MODEL",
                         count);
    gpu_instance instance;
    hnbrdf_error error;
    if (gpu_open(set.validate ? GPU_VALIDATED_SYNC : GPU_NOT_VALIDATED, &instance, &error))
        return cli_fail("%s", error.text);
    if (set.list)
        list_devices(&instance);
    else
        result = verify_model(&instance, &set, argv[1]);
    gpu_close(&instance);
    return set.list ? CLI_OK : result;
}

#else

int cmd_verify(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    return cli_fail("verify: this hnbrdf was built without Vulkan (HNBRDF_WITH_VULKAN)");
}

#endif
