/* cmd_info.c: `hnbrdf info`: what a model, a measured file or a collection of them holds. */
#include "cli/cli.h"
#include "report/info.h"
#include "report/info_physics.h"

#include <stdlib.h>

static const cli_command command = {
    "info",
    "SOURCE [--without-physics] [--json]",
    "Tells what SOURCE holds: a model file, a measured file, builtin:NAME,\n"
    "builtin, builtin:anisotropic, or a directory of measured files. The checksum of a single "
    "MERL file\n"
    "is compared with those of the 100 published ones.\n"
    "\n"
    "Weights are the numbers shared by all materials, mults the multiplications of the network for "
    "one\n"
    "evaluation. Of each material of a model also: its directional albedo (above 1 it gives off "
    "more light\n"
    "than it gets), how far it is from reciprocal, how many of its values are 0. That takes about\n"
    "10 ms a material, on all processors; --without-physics leaves it out.\n"
    "JSON keys of a model: kind, net, encoding, latent, materials, weights, mults, scale, shift, "
    "floor,\n"
    "parameters; of a measured file: kind, format, name, isotropic, summary, of a single MERL file "
    "also\n"
    "published: the material's name, or null.",
    "hnbrdf info builtin\n"
    "hnbrdf info builtin:anisotropic\n"
    "hnbrdf info model.safetensors\n"
    "hnbrdf info alum-bronze.binary\n"
    "hnbrdf info model.safetensors --without-physics --json",
};

/* ---- Command --------------------------------------------------------------------------------- */

static int tell_collection(char **argument, int json)
{
    cli_data data = {0};
    if (cli_open_data(argument, 1, &data) != CLI_OK)
        return CLI_FAILURE;
    if (json)
        info_json_data(data.items, data.count, stdout);
    else
        info_print_data(data.items, data.count, stdout);
    cli_close_data(&data);
    return CLI_OK;
}

/* malloc'ed, NULL if memory is short. */
static hnbrdf_physics *measure_physics(const hnbrdf_model *model)
{
    cli_progress progress;
    const report_watch watch = cli_watch(&progress);
    cli_progress_begin(&progress, "albedo and reciprocity");
    hnbrdf_physics *physics = info_measure_physics(model, &watch);
    cli_progress_end(&progress);
    return physics;
}

static int tell_model(const char *path, const hnbrdf_model *model, int without_physics, int json)
{
    hnbrdf_physics *physics = without_physics ? NULL : measure_physics(model);
    if (!physics && !without_physics)
        return cli_fail("out of memory");
    if (json)
        info_json_model(model, physics, stdout);
    else
        info_print_model(path, model, physics, stdout);
    free(physics);
    return CLI_OK;
}

static int tell_source(const char *path, int without_physics, int json)
{
    cli_source source = {0};
    cli_read.merl_identify = 1;
    if (cli_open_source(path, &source) != CLI_OK)
        return CLI_FAILURE;
    int code = CLI_OK;
    if (source.model) {
        code = tell_model(path, source.model, without_physics, json);
    } else if (json) {
        info_json_measured(source.measured, cli_read.merl_identify, stdout);
        putchar('\n');
    } else {
        info_print_measured(path, source.measured, stdout);
    }
    cli_close_source(&source);
    return code;
}

int cmd_info(int argc, char **argv)
{
    int json = 0, without_physics = 0, count;
    const cli_option options[] = {
        {"json", 0, CLI_FLAG, &json, 0, 0, NULL, "print JSON (default: a table for people)"},
        {"without-physics", 0, CLI_FLAG, &without_physics, 0, 0, NULL,
         "of a model: do not measure albedo, reciprocity and black values"},
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != 1)
        return cli_usage(&command, "%s",
                         count ? "more than one SOURCE" : "no SOURCE to tell about");
    return cli_is_collection(argv[1]) ? tell_collection(argv + 1, json)
                                      : tell_source(argv[1], without_physics, json);
}
