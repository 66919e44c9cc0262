/* cmd_verify.c: `hnbrdf verify`: the exported shader on this machine's GPUs, or wherever else it
 * was run, against the C library. */
#include "cli/cli.h"

#include "cli/verify_devices.h"
#include "cli/words.h"
#include "hnbrdf/glsl.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "verify",
    "MODEL [--materials A,B] [--weights STYLE] [--precision P] [--fixed|--editable]\n"
    "              [--api A] [--stage S] [--device N|all] [--pairs N]\n"
    "              [--hand-out DIR [--language L]]\n"
    "       hnbrdf verify MODEL --hand-in DIR",
    "Proves on every device that the exported shader gives what the C library gives. Compared\n"
    "are the encoding, the network alone, the analytic part, the whole BRDF, and what is\n"
    "sampled with its density and weight, on random, mirror, grazing, retroreflecting and\n"
    "extreme pairs of directions, in two builds: exact (HNBRDF_EXACT 1: the bits of C where the\n"
    "device rounds + - * / sqrt correctly, which is probed) and fast (built-in exp and log).\n"
    "How far a device may differ is derived for every pair from the error of each operation\n"
    "(Vulkan's limits).\n"
    "\n"
    "--api vulkan runs compute shaders, or with --stage fragment fragment shaders, and needs\n"
    "glslangValidator. gl and gles run fragment shaders through EGL without a window: GL 3.3\n"
    "and 4.5 core; GL ES 3.0 and 3.2 with float render targets, each as far as the driver has\n"
    "it. Before GLSL 400 and ES 320 there is no `precise`: compilers may order the exact build\n"
    "anew, and its bounds are wider.\n"
    "\n"
    "--hand-out is for engines, browsers and other languages: it writes into DIR, which is\n"
    "made, the scene and parity.glsl, or .hlsl and so on (scene_exact, parity_exact: the exact\n"
    "build), inputs.f32 (rows of 16 floats), probe.f32 (rows of 4), weights.bin with --weights\n"
    "uniform, and case.json, which counts all that. A program that includes the two texts\n"
    "writes back outputs.f32: for each row of inputs (a, b, c, d) the eight vec4 of\n"
    "hnbrdf_parity(a, b, c, d, slot), slot 0 to 7. The same of the exact build is\n"
    "outputs_exact.f32, which may be left out; hnbrdf_probe(operands, slot) of the exact build,\n"
    "slot 0 and 1, is probe_results.f32. All are raw little-endian float32. device.txt may name\n"
    "the device. --hand-in judges them as the values of a device here; it takes all options\n"
    "from DIR/case.json. Neither needs a device or compiler.\n"
    "\n"
    "Exit status 0 only if everything tried is within the bounds.",
    "hnbrdf verify model.safetensors\n"
    "hnbrdf verify model.safetensors --device 0 --pairs 100000 --json verify.json\n"
    "hnbrdf verify model.safetensors --weights uniform --precision half\n"
    "hnbrdf verify model.safetensors --api gl --pairs 1024\n"
    "hnbrdf verify model.safetensors --pairs 1024 --hand-out case\n"
    "hnbrdf verify model.safetensors --pairs 1024 --language wgsl --hand-out case-wgsl\n"
    "hnbrdf verify model.safetensors --hand-in case\n"
    "hnbrdf verify --list",
};

typedef struct settings {
    const char *materials, *device, *csv, *json, *hand_out, *hand_in;
    long pairs, seed;
    int api, device_number; /* -1: not given; all */
    int stage;              /* 0, compute, or 1, fragment; -1: not given */
    int validate, list, without_timing, fixed, editable;
    cli_word weights, precision, language;
} settings;

static void on_progress(void *user, double share)
{
    cli_progress_update(user, share, "");
}

/* What a command line asks for, whoever runs it. */
static check_exchange exchange_of(const settings *set, const int *materials, int count)
{
    return (check_exchange){.folder = set->hand_out,
                            .options = {.weights = (hnbrdf_glsl_weights)set->weights.value,
                                        .precision = (hnbrdf_glsl_precision)set->precision.value,
                                        .fixed = set->fixed,
                                        .editable = set->editable,
                                        .language = (hnbrdf_shading_language)set->language.value},
                            .check = {.precision = (hnbrdf_glsl_precision)set->precision.value,
                                      .materials = materials,
                                      .material_count = count,
                                      .pairs = (size_t)set->pairs,
                                      .seed = (uint64_t)set->seed}};
}

/* The number of --device, -1 for all. Returns -1 to go on, else the exit code. */
static int read_device(settings *set)
{
    char *end;
    set->device_number = -1;
    if (strcmp(set->device, "all") == 0)
        return -1;
    long number = strtol(set->device, &end, 10);
    if (end == set->device || *end || number < 0)
        return cli_usage(&command, "--device: found '%s', expected a number or all", set->device);
    if (set->api == VERIFY_ALL)
        return cli_usage(&command, "--device %s and --api all: each API has its own numbers",
                         set->device);
    set->device_number = number < INT_MAX ? (int)number : INT_MAX;
    return -1;
}

/* ---- Results --------------------------------------------------------------------------------- */

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

/* ---- Elsewhere ------------------------------------------------------------------------------- */

static int hand_out(const hnbrdf_model *model, const settings *set)
{
    int *materials = NULL, count;
    int result = cli_choose_materials(model, set->materials, &materials, &count);
    if (result != CLI_OK)
        return result;
    const check_exchange exchange = exchange_of(set, materials, count);
    hnbrdf_error error;
    result = cli_make_folder(set->hand_out);
    if (result == CLI_OK)
        result = cli_code(check_hand_out(model, &exchange, &error), &error);
    if (result == CLI_OK)
        printf("%s: scene and parity in %s, %zu rows of inputs\n", set->hand_out,
               hnbrdf_shading_language_name(exchange.options.language),
               exchange.check.pairs * (size_t)count);
    free(materials);
    return result;
}

static int hand_in(const hnbrdf_model *model, const settings *set, const char *path)
{
    check_handed_in found;
    hnbrdf_error error;
    cli_progress progress;
    cli_progress_begin(&progress, set->hand_in);
    hnbrdf_result failed =
        check_hand_in(model, set->hand_in, on_progress, &progress, &found, &error);
    cli_progress_end(&progress);
    if (failed)
        return cli_fail("%s", error.text);
    verified_device device = {.index = -1,
                              .name = found.device,
                              .api = hnbrdf_shading_language_name(found.exchange.options.language),
                              .kind = "handed in",
                              .driver = set->hand_in,
                              .report = found.report};
    const verification v = {.path = path,
                            .model = model,
                            .materials = found.materials,
                            .material_count = found.exchange.check.material_count,
                            .pairs = found.exchange.check.pairs,
                            .weights = found.exchange.options.weights,
                            .precision = found.exchange.options.precision,
                            .devices = &device,
                            .device_count = 1};
    int result = write_results(&v, set);
    check_handed_in_free(&found);
    return result;
}

/* ---- Here ------------------------------------------------------------------------------------ */

static int run_scene(const hnbrdf_model *model, const settings *set, verification *v,
                     verify_job *job)
{
    hnbrdf_text_buffer weights = {0};
    const check_exchange *exchange = &job->exchange;
    char *text = NULL;
    hnbrdf_error error;
    hnbrdf_result failed = check_exchange_scene(model, exchange, CHECK_BUILD_FAST, &text, &error);
    if (!failed && exchange->options.weights == HNBRDF_GLSL_UNIFORM &&
        hnbrdf_weights_size(model) > 0)
        failed = hnbrdf_export_weights(model, &exchange->options, hnbrdf_text_buffer_append,
                                       &weights, &error);
    job->text = text;
    job->weights = &weights;
    int result = cli_code(failed, &error);
    if (result == CLI_OK)
        result = verify_on_devices((verify_api)set->api, job, v);
    if (result == CLI_OK)
        result = write_results(v, set);
    verify_free_devices(v);
    free(text);
    free(weights.bytes);
    return result;
}

static int verify_here(const hnbrdf_model *model, const settings *set, const char *path)
{
    verification v = {.path = path,
                      .model = model,
                      .pairs = (size_t)set->pairs,
                      .validated = set->validate,
                      .weights = (hnbrdf_glsl_weights)set->weights.value,
                      .precision = (hnbrdf_glsl_precision)set->precision.value};
    int *materials = NULL;
    int result = cli_choose_materials(model, set->materials, &materials, &v.material_count);
    if (result == CLI_OK) {
        verify_job job = {.exchange = exchange_of(set, materials, v.material_count),
                          .device = set->device_number,
                          .fragment = set->stage == 1,
                          .validate = set->validate,
                          .without_timing = set->without_timing};
        v.materials = materials;
        result = run_scene(model, set, &v, &job);
    }
    free(materials);
    return result;
}

static int verify_model(const settings *set, const char *path)
{
    hnbrdf_model *model = NULL;
    if (cli_open_model(path, &model) != CLI_OK)
        return CLI_FAILURE;
    int result = set->hand_out  ? hand_out(model, set)
                 : set->hand_in ? hand_in(model, set, path)
                                : verify_here(model, set, path);
    hnbrdf_model_free(model);
    return result;
}

int cmd_verify(int argc, char **argv)
{
    settings set = {.api = -1,
                    .stage = -1,
                    .device = "all",
                    .pairs = 16384,
                    .seed = 1,
                    .weights = {HNBRDF_GLSL_CONSTANTS, cli_weights_word},
                    .precision = {HNBRDF_GLSL_FLOAT, cli_precision_word},
                    .language = {HNBRDF_LANGUAGE_GLSL, cli_language_word}};
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
        {"api", 0, CLI_CHOICE, &set.api, 0, 0, "vulkan|gl|gles|all",
         "by which devices are asked (default vulkan)"},
        {"stage", 0, CLI_CHOICE, &set.stage, 0, 0, "compute|fragment",
         "of Vulkan (default compute); GL has fragment shaders alone"},
        {"device", 'd', CLI_TEXT, &set.device, 0, 0, "N|all",
         "number of a device, see --list (default: all)"},
        {"pairs", 'n', CLI_INT, &set.pairs, 64, 1 << 22, "N",
         "direction pairs a material (default 16384)"},
        {"seed", 0, CLI_INT, &set.seed, 0, 9007199254740992.0, "N",
         "of the random pairs (default 1)"},
        {"language", 'l', CLI_WORD, &set.language, 0, 0, "glsl|hlsl|msl|wgsl|slang",
         "with --hand-out: of the texts (default glsl)"},
        {"hand-out", 0, CLI_WRITE_FOLDER, &set.hand_out, 0, 0, "DIR",
         "write there what another program is to run"},
        {"hand-in", 0, CLI_READ, &set.hand_in, 0, 0, "DIR", "judge what that program wrote there"},
        {"csv", 0, CLI_WRITE_TEXT, &set.csv, 0, 0, "FILE",
         "a row a device, material, build and stage; - is standard output"},
        {"json", 0, CLI_WRITE_TEXT, &set.json, 0, 0, "FILE",
         "everything found as JSON; - likewise"},
        {"validate", 0, CLI_FLAG, &set.validate, 0, 0, NULL,
         "with the Vulkan validation layer; any message fails"},
        {"without-timing", 0, CLI_FLAG, &set.without_timing, 0, 0, NULL,
         "do not measure the run time"},
        {"list", 0, CLI_FLAG, &set.list, 0, 0, NULL, "list the devices of every API and stop"},
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
    if (set.hand_out && set.hand_in)
        return cli_usage(&command, "--hand-out and --hand-in: one after the other");
    if (set.language.value == HNBRDF_LANGUAGE_BRDF)
        return cli_usage(&command, "--language brdf: a file of one material for viewers, expected "
                                   "another language");
    if (set.language.value != HNBRDF_LANGUAGE_GLSL && !set.hand_out)
        return cli_usage(&command, "--language without --hand-out: devices are tried in glsl");
    if (set.hand_out && (set.csv || set.json))
        return cli_usage(&command, "--hand-out has no results yet: found --csv or --json");
    if (set.list)
        return verify_list_devices(set.api < 0 ? VERIFY_ALL : (verify_api)set.api, set.validate);
    if (set.api < 0)
        set.api = VERIFY_VULKAN;
    if (set.stage == 0 && (set.api == VERIFY_GL || set.api == VERIFY_GLES))
        return cli_usage(&command, "--stage compute: GL is asked by fragment shaders");
    result = read_device(&set);
    return result >= 0 ? result : verify_model(&set, argv[1]);
}
