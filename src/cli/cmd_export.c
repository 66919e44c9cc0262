/* cmd_export.c: `hnbrdf export`: a model's materials as one GLSL include. */
#include "cli/cli.h"

#include <stdlib.h>

static const cli_command command = {
    "export",
    "MODEL [--materials A,B] [--standalone] -o FILE.glsl",
    "Writes one GLSL include: the network as constants, the chosen materials, and\n"
    "  vec3 hnbrdf_eval(hnbrdf_material m, vec3 wi, vec3 wo)      1/sr, without the cosine.\n"
    "Include shaders/hybrid_brdf.glsl before it, or take --standalone. The text compiles as Vulkan "
    "GLSL\n"
    "450, desktop GLSL 330 and GLSL ES 300; put it after #version. What the chosen materials do not\n"
    "need (anisotropy, rotation) is left out.",
    "hnbrdf export model.safetensors -o scene.glsl\n"
    "hnbrdf export model.safetensors --materials gold-paint,velvet --standalone -o scene.glsl",
};

typedef struct counted_file {
    FILE *file;
    size_t bytes;
} counted_file;

static int write_counted(void *user, const void *data, size_t size)
{
    counted_file *to = user;
    to->bytes += size;
    return fwrite(data, 1, size, to->file) != size;
}

static void print_summary(FILE *file, const hnbrdf_model *model, const char *path, int materials,
                          size_t bytes)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    fprintf(file, "%s: %s", path, hnbrdf_kind_name(desc.kind));
    if (desc.kind != HNBRDF_KIND_GGX)
        fprintf(file, " %dx%d, %s, %zu weights, %zu multiplications per evaluation", desc.hidden,
                desc.layers, hnbrdf_encoding_name(desc.encoding), hnbrdf_model_weight_count(model),
                hnbrdf_model_multiplications(model));
    fprintf(file, ", %d material%s, %zu bytes\n", materials, materials == 1 ? "" : "s", bytes);
}

static int export_to(const hnbrdf_model *model, const hnbrdf_glsl_options *options, const char *path)
{
    cli_output output;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    counted_file to = {.file = output.file};
    hnbrdf_error error;
    if (hnbrdf_export_glsl(model, options, write_counted, &to, &error)) {
        cli_output_discard(&output);
        return cli_fail("%s: %s", path, error.text);
    }
    FILE *told = output.file == stdout ? stderr : stdout;
    if (cli_output_close(&output) != CLI_OK)
        return CLI_FAILURE;
    print_summary(told, model, path, options->material_count, to.bytes);
    return CLI_OK;
}

int cmd_export(int argc, char **argv)
{
    const char *materials = NULL, *path = NULL;
    int standalone = 0, count;
    const cli_option options[] = {
        {"materials", 'm', CLI_TEXT, &materials, 0, 0, "A,B", "names of the materials (default: all)"},
        {"standalone", 0, CLI_FLAG, &standalone, 0, 0, NULL, "put the text of hybrid_brdf.glsl first"},
        {"output", 'o', CLI_TEXT, &path, 0, 0, "FILE", "where to write; - is standard output"},
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != 1)
        return cli_usage(&command, "found %d arguments, expected one MODEL", count);
    if (!path)
        return cli_usage(&command, "no -o FILE.glsl");
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    if (hnbrdf_model_load(argv[1], NULL, &model, &error))
        return cli_fail("%s", error.text);
    int *indices = NULL;
    hnbrdf_glsl_options glsl = {.standalone = standalone};
    result = cli_choose_materials(model, materials, &indices, &glsl.material_count);
    glsl.materials = indices;
    if (result == CLI_OK)
        result = export_to(model, &glsl, path);
    free(indices);
    hnbrdf_model_free(model);
    return result;
}
