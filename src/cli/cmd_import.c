/* cmd_import.c: `hnbrdf import`: published .brdf shaders of one data set become one model file. */
#include "cli/cli.h"

static const cli_command command = {
    "import",
    "FILE.brdf... -o MODEL.safetensors",
    "Reads published BRDF-Explorer shaders of this method, or those that\n"
    "`hnbrdf export --language brdf` wrote, of any kind and encoding, one material a file, all\n"
    "with the same network, and writes them as one model. A material is named after its file;\n"
    "of the published names Ours_ld4_32x2_NAME and Ours_ld4_32x2_NAME_rgb, whatever the\n"
    "numbers, only NAME is left, so that compare finds the measurement of the same name. A\n"
    "diffuse colour or an alpha above 1 by at most 0.01 becomes 1, an alpha below 0.0001\n"
    "becomes that, with a warning.",
    "hnbrdf import merl/*.brdf -o merl.safetensors\n"
    "hnbrdf compare merl.safetensors merl/",
};

static void tell_names(const hnbrdf_model *model, const cli_imported *told, char *const *paths,
                       int count)
{
    const int k = told->first - 1;
    if (told->renamed > 0)
        printf("%d of %d materials are named without what published names add, as %s of %s\n",
               told->renamed, count, hnbrdf_model_material_name(model, k), paths[k]);
}

static int import_and_save(char *const *paths, int count, const char *out)
{
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    cli_imported told;
    int failed = cli_import(paths, count, &model, &told);
    if (failed)
        return failed;
    failed = cli_set_lobes(&model, HNBRDF_LOBES_FIT);
    if (!failed)
        failed = cli_code(hnbrdf_model_save(model, out, &error), &error);
    if (!failed) {
        tell_names(model, &told, paths, count);
        printf("%s: %d material%s\n", out, count, count == 1 ? "" : "s");
    }
    hnbrdf_model_free(model);
    return failed;
}

int cmd_import(int argc, char **argv)
{
    const char *out = NULL;
    int count = 0;
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_MODEL, &out, 0, 0, "FILE", "the model file to write (required)"},
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count < 1)
        return cli_usage(&command, "no .brdf file to import");
    if (!out)
        return cli_usage(&command, "no model file to write: -o MODEL.safetensors");
    return import_and_save(argv + 1, count, out);
}
