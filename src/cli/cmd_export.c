/* cmd_export.c: `hnbrdf export`: a model's materials as one GLSL include. */
#include "cli/cli.h"
#include "cli/words.h"
#include "hnbrdf/glsl.h"
#include "report/conserve.h"
#include "report/texels.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "export",
    "MODEL [--materials A,B] [--only eval|eval+sample] [--fixed|--editable] [--weights STYLE]\n"
    "              [--precision P] [--conserve] [--pack P] [--standalone] [--language L] "
    "[--exact]\n"
    "              [--prefix NAME] [--strip-comments] -o FILE\n"
    "       hnbrdf export --library [--language L] [--exact] -o FILE",
    "Writes one GLSL include: the network, the chosen materials, and\n"
    "  vec3 hnbrdf_eval(hnbrdf_material m, vec3 wi, vec3 wo)      1/sr, without the cosine\n"
    "  hnbrdf_sample_result hnbrdf_sample(hnbrdf_material m, vec3 wo, vec2 u)\n"
    "  float hnbrdf_pdf(hnbrdf_material m, vec3 wi, vec3 wo)\n"
    "for m = hnbrdf_scene_material(HNBRDF_MATERIAL_NAME). Include shaders/hybrid_brdf.glsl\n"
    "before it, or take --standalone. The text compiles as Vulkan GLSL 450, desktop GLSL 330\n"
    "and GLSL ES 300; put it after #version. Its first lines state what it holds and what was\n"
    "left out: always what the chosen materials do not need (anisotropy, rotation); with --only\n"
    "what is not asked for, in a standalone text also of hybrid_brdf.glsl; with --fixed the\n"
    "means to change a material, whose latent code is then folded into the first layer.\n"
    "hnbrdf_eval_NAME(wi, wo) of a fixed material takes no material at all. Whatever is left\n"
    "out, the values are the same to the last bit. Of edited materials (hnbrdf edit) the text\n"
    "has what carries the network's correction along; with --editable also where none is, for\n"
    "shaders that change m.kd, m.eta or m.alpha themselves, which moves the analytic part alone\n"
    "otherwise.\n"
    "\n"
    "--language hlsl (Shader Model 5.0, FXC, and newer), msl, wgsl and slang are made from the\n"
    "same GLSL: the same names, order and comments. What is not --standalone needs the text of\n"
    "--library in that language before it.\n"
    "--language brdf writes one material as a file for BRDF\n"
    "Explorer and its like, where kd, eta, alpha and the latent code are sliders;\n"
    "`hnbrdf import` reads it back as the same model. --exact: exp and log of exact operations,\n"
    "and `precise` where the language has it.\n"
    "\n"
    "--weights constants is the fastest, one shader a network; columns are the same constants\n"
    "in vec4. uniform reads them from a buffer whose bytes --weights-out writes: slower, but\n"
    "compiled soon, and any network of the same size can be loaded at run time (hnbrdf.h tells\n"
    "the layout). --precision half computes the hidden layers in float16 (GLSL 450) or mediump\n"
    "(ES): for GPUs that have it, a CPU driver becomes ten times slower. With columns four\n"
    "numbers at a time, for GPUs with packed halves.\n"
    "\n"
    "--prefix gold: all names of the text begin with gold instead of hnbrdf (gold_eval,\n"
    "gold_scene_material, GOLD_MATERIAL_NAME, GOLD_WEIGHTS_BINDING), so that many networks fit\n"
    "into one shader. Those of hybrid_brdf.glsl stay, it is there once. Several standalone\n"
    "texts need a prefix each.\n"
    "\n"
    "--conserve: materials that give off more light than they get are multiplied by a factor of\n"
    "both cosines, reciprocal, at most 1, and 1 but near the horizon. The model file stays as it\n"
    "is; `hnbrdf edit MODEL --conserve` puts the same factors into it, for C too.\n"
    "\n"
    "--pack is for scenes with a material of its own in every pixel: the include also has\n"
    "  hnbrdf_material hnbrdf_material_unpack(vec4 t0, vec4 t1, ...)      HNBRDF_TEXELS texels\n"
    "for what textures return: RGBA16F (half) or RGBA8 (byte). The ranges of RGBA8 are those of\n"
    "the exported materials. What is stored depends on the materials, one that is anisotropic\n"
    "adds to the texels of all; --texel-fields all stores two alphas, rotation, lobes and with\n"
    "--editable what it was fitted with, whatever they are. Fields and the cost in SMAPE are\n"
    "printed. --texels writes the packed materials without a header, numbers in the byte order\n"
    "of the machine: a row of texels each, or with --texel-layout planes one texel of each a\n"
    "row, as many rows as texels.",
    "hnbrdf export model.safetensors -o scene.glsl\n"
    "hnbrdf export model.safetensors --materials gold-two-lobe,moon-dust --standalone -o "
    "scene.glsl\n"
    "hnbrdf export model.safetensors --weights uniform --weights-out weights.bin -o scene.glsl\n"
    "hnbrdf export model.safetensors --materials moon-dust --only eval --fixed --standalone -o "
    "dust.glsl\n"
    "hnbrdf export model.safetensors --language hlsl --standalone -o scene.hlsl\n"
    "hnbrdf export --library --language hlsl -o hybrid_brdf.hlsl\n"
    "hnbrdf export model.safetensors --prefix dust --standalone -o dust.glsl\n"
    "hnbrdf export model.safetensors --materials moon-dust --language brdf -o moon-dust.brdf\n"
    "hnbrdf export model.safetensors --pack half --texels materials.bin -o scene.glsl",
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

static void print_summary(FILE *file, const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                          const char *path, size_t bytes)
{
    int materials = options->material_count;
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    /* As the heading of the text counts them: without those of latent codes folded into the bias.
     * */
    int folded = options->fixed && options->weights != HNBRDF_GLSL_UNIFORM &&
                 options->precision == HNBRDF_GLSL_FLOAT;
    size_t saved = folded ? (size_t)desc.hidden * (size_t)desc.latent : 0;
    fprintf(file, "%s: %s", path, hnbrdf_kind_name(desc.kind));
    if (desc.kind != HNBRDF_KIND_GGX)
        fprintf(file, " %dx%d, %s, %zu weights (%s, %s), %zu multiplications per evaluation",
                desc.hidden, desc.layers, hnbrdf_encoding_name(desc.encoding),
                hnbrdf_model_weight_count(model) - saved,
                hnbrdf_glsl_weights_name(options->weights),
                hnbrdf_glsl_precision_name(options->precision),
                hnbrdf_model_multiplications(model) - saved);
    fprintf(file, ", %d material%s, %zu bytes\n", materials, materials == 1 ? "" : "s", bytes);
}

/* What one who runs the text has to know besides. */
static void print_hints(FILE *file, const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                        const char *weights_path)
{
    const char *prefix = options->prefix ? options->prefix : "hnbrdf";
    if (options->weights == HNBRDF_GLSL_UNIFORM && hnbrdf_weights_size(model) > 0 && !weights_path)
        fprintf(file,
                "the shader reads its weights from the uniform block %s_weights_block, %zu bytes: "
                "--weights-out FILE writes them\n",
                prefix, hnbrdf_weights_size(model));
    if (options->precision == HNBRDF_GLSL_HALF)
        fprintf(file, "half precision is for GPUs that have it: a CPU driver emulates float16 and "
                      "takes ten times as long\n");
}

/* Measured with lavapipe (Mesa 22.3, `hnbrdf verify --weights STYLE`, one run): the first
 * dispatch of 64x3, 9414 constants, takes 5.5 times as long as that of its uniform form; 64x4 has
 * 13574. */
enum { MANY_CONSTANTS = 12000, SMALL_BLOCK = 16384 };

/* Why another style may be wanted; what was asked for is written all the same. */
static void warn(const hnbrdf_model *model, const hnbrdf_glsl_options *options)
{
    size_t numbers = hnbrdf_model_weight_count(model), bytes = hnbrdf_weights_size(model);
    if (options->weights == HNBRDF_GLSL_UNIFORM && bytes > SMALL_BLOCK)
        fprintf(stderr,
                "hnbrdf export: a uniform block of %zu bytes; devices need not take more than %d "
                "(desktop "
                "ones do, 65536)\n",
                bytes, SMALL_BLOCK);
    if (options->weights != HNBRDF_GLSL_UNIFORM && numbers > MANY_CONSTANTS)
        fprintf(
            stderr,
            "hnbrdf export: %zu constants: with 9414 a software driver's first dispatch took 5.5 "
            "times as long "
            "as with --weights uniform (`hnbrdf verify` measures it here)\n",
            numbers);
}

/* The buffer of --weights uniform. */
static int write_weights(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                         const char *path)
{
    cli_output output;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    counted_file to = {.file = output.file};
    hnbrdf_error error;
    if (hnbrdf_export_weights(model, options, write_counted, &to, &error) == HNBRDF_OK ||
        ferror(output.file)) /* closing says why */
        return cli_output_close(&output);
    cli_output_discard(&output);
    return cli_fail("%s: %s", path, error.text);
}

static int write_texels(const report_texels *texels, const char *path)
{
    hnbrdf_error error;
    return cli_code(texels_write(texels, path, &error), &error);
}

static void print_packing(const report_texels *texels, FILE *file)
{
    cli_progress progress;
    const report_watch watch = cli_watch(&progress);
    cli_progress_begin(&progress, "error of the packing");
    texels_print_cost(texels, &watch, file);
    cli_progress_end(&progress);
}

/* The text; *bytes: how many. */
static int write_shader(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                        const char *path, size_t *bytes)
{
    cli_output output;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    counted_file to = {.file = output.file};
    hnbrdf_error error;
    if (hnbrdf_export_shader(model, options, write_counted, &to, &error) &&
        !ferror(output.file)) { /* else closing says why */
        cli_output_discard(&output);
        return cli_fail("%s: %s", path, error.text);
    }
    *bytes = to.bytes;
    return cli_output_close(&output);
}

static int export_to(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                     const char *path, const char *weights_path, const report_texels *texels)
{
    size_t bytes = 0;
    if (write_shader(model, options, path, &bytes) != CLI_OK)
        return CLI_FAILURE;
    print_summary(cli_words(), model, options, path, bytes);
    print_hints(cli_words(), model, options, weights_path);
    if (texels)
        print_packing(texels, cli_words());
    return CLI_OK;
}

typedef struct settings {
    const char *materials, *path, *texels, *weights_path;
    int standalone, fixed, only; /* only: hnbrdf_glsl_only less one, -1 for everything */
    int pack;                    /* hnbrdf_texel_format, -1 for none */
    int editable;
    int conserve;
    int all_fields, planes; /* -1 or 0: as needed, rows; 1: all, planes */
    cli_word language;
    int exact, library;
    const char *prefix;
    int strip;
    cli_word weights, precision;
} settings;

/* --library: what all scenes share. */
static int export_library(const settings *set)
{
    const hnbrdf_glsl_options options = {.language = (hnbrdf_shading_language)set->language.value,
                                         .exact = set->exact,
                                         .library = 1};
    size_t bytes = 0;
    const int result = write_shader(NULL, &options, set->path, &bytes);
    if (result == CLI_OK)
        fprintf(cli_words(), "%s: the parts that all scenes share, %s%s, %zu bytes\n", set->path,
                hnbrdf_shading_language_name(options.language), set->exact ? ", exact" : "", bytes);
    return result;
}

/* *model with the factors that these of its materials need. */
static int conserve(hnbrdf_model **model, const int *materials, int count)
{
    cli_progress progress;
    const report_watch watch = cli_watch(&progress);
    hnbrdf_model *conserving = NULL;
    hnbrdf_error error;
    cli_progress_begin(&progress, "albedo");
    const hnbrdf_result result =
        report_conserve(*model, materials, count, &watch, cli_words(), &conserving, &error);
    cli_progress_end(&progress);
    if (result)
        return cli_fail("%s", error.text);
    hnbrdf_model_free(*model);
    *model = conserving;
    return CLI_OK;
}

/* The same layout whatever the materials are. */
static void take_all_fields(hnbrdf_packing *packing, const hnbrdf_model *model, const settings *set)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    packing->anisotropic = packing->analytic;
    packing->rotated = 1;
    packing->edited |= desc.kind == HNBRDF_KIND_HYBRID && set->editable;
    packing->lobes = set->only != HNBRDF_GLSL_EVAL - 1;
}

static int export_materials(const hnbrdf_model *model, const settings *set, const int *materials,
                            int count)
{
    report_texels texels = {.model = model, .materials = materials, .count = count};
    hnbrdf_error error;
    if (set->pack >= 0 &&
        hnbrdf_packing_init(model, materials, count, (hnbrdf_texel_format)set->pack,
                            &texels.packing, &error))
        return cli_fail("%s", error.text);
    texels.planes = set->planes == 1;
    if (set->all_fields == 1)
        take_all_fields(&texels.packing, model, set);
    const hnbrdf_glsl_options options = {.materials = materials,
                                         .material_count = count,
                                         .standalone = set->standalone,
                                         .only = (hnbrdf_glsl_only)(set->only + 1),
                                         .fixed = set->fixed,
                                         .prefix = set->prefix,
                                         .without_comments = set->strip,
                                         .editable = set->editable,
                                         .packing = set->pack >= 0 ? &texels.packing : NULL,
                                         .weights = (hnbrdf_glsl_weights)set->weights.value,
                                         .precision = (hnbrdf_glsl_precision)set->precision.value,
                                         .language = (hnbrdf_shading_language)set->language.value,
                                         .exact = set->exact};
    warn(model, &options);
    if (set->weights_path && write_weights(model, &options, set->weights_path) != CLI_OK)
        return CLI_FAILURE;
    if (set->texels && write_texels(&texels, set->texels) != CLI_OK)
        return CLI_FAILURE;
    return export_to(model, &options, set->path, set->weights_path,
                     set->pack >= 0 ? &texels : NULL);
}

int cmd_export(int argc, char **argv)
{
    settings set = {.only = -1,
                    .pack = -1,
                    .all_fields = -1,
                    .planes = -1,
                    .language = {HNBRDF_LANGUAGE_GLSL, cli_language_word},
                    .weights = {-1, cli_weights_word},
                    .precision = {HNBRDF_GLSL_FLOAT, cli_precision_word}};
    int count;
    const cli_option options[] = {
        {"materials", 'm', CLI_TEXT, &set.materials, 0, 0, "A,B",
         "names of the materials (default: all)"},
        {"only", 0, CLI_CHOICE, &set.only, 0, 0, "eval|eval+sample",
         "leave out what else there is (default: everything)"},
        {"fixed", 0, CLI_FLAG, &set.fixed, 0, 0, NULL,
         "materials are constants, not to be changed"},
        {"editable", 0, CLI_FLAG, &set.editable, 0, 0, NULL,
         "kd, eta, alpha that the shader changes carry the network's part along"},
        {"standalone", 0, CLI_FLAG, &set.standalone, 0, 0, NULL,
         "put the text of hybrid_brdf.glsl first"},
        {"language", 'l', CLI_WORD, &set.language, 0, 0, "glsl|hlsl|msl|wgsl|slang|brdf",
         "what to write (default glsl)"},
        {"exact", 0, CLI_FLAG, &set.exact, 0, 0, NULL,
         "the bits of C, on devices that round + - * / sqrt correctly"},
        {"library", 0, CLI_FLAG, &set.library, 0, 0, NULL,
         "what all scenes share, hybrid_brdf.glsl, in that language; takes no MODEL"},
        {"prefix", 0, CLI_TEXT, &set.prefix, 0, 0, "NAME",
         "names begin with NAME, not hnbrdf: many texts in one shader"},
        {"strip-comments", 0, CLI_FLAG, &set.strip, 0, 0, NULL, "no comments, no empty lines"},
        {"weights", 'w', CLI_WORD, &set.weights, 0, 0, "constants|columns|uniform",
         "how the shader holds the network (default constants in glsl, else columns)"},
        {"weights-out", 0, CLI_WRITE_BYTES, &set.weights_path, 0, 0, "FILE",
         "with --weights uniform: where to write the bytes of the buffer"},
        {"precision", 0, CLI_WORD, &set.precision, 0, 0, "float|half",
         "of the hidden layers (default float)"},
        {"conserve", 0, CLI_FLAG, &set.conserve, 0, 0, NULL,
         "hold materials whose albedo (hnbrdf info) is above 1 to it"},
        {"pack", 0, CLI_CHOICE, &set.pack, 0, 0, "half|byte",
         "with a function that unpacks texels"},
        {"texel-fields", 0, CLI_CHOICE, &set.all_fields, 0, 0, "needed|all",
         "with --pack: what these materials need (default), or the same whatever they are"},
        {"texel-layout", 0, CLI_CHOICE, &set.planes, 0, 0, "rows|planes",
         "with --texels: material after material (default), or texel after texel"},
        {"texels", 0, CLI_WRITE_BYTES, &set.texels, 0, 0, "FILE",
         "with --pack: where to write the materials as texels"},
        {"output", 'o', CLI_WRITE_TEXT, &set.path, 0, 0, "FILE",
         "where to write; - is standard output"},
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (set.weights.value < 0)
        set.weights.value =
            (int)hnbrdf_shading_language_weights((hnbrdf_shading_language)set.language.value);
    if (count != (set.library ? 0 : 1))
        return cli_usage(&command, "found %d arguments, expected %s", count,
                         set.library ? "none with --library" : "one MODEL");
    if (!set.path)
        return cli_usage(&command, "no -o FILE.glsl");
    if (set.library)
        return export_library(&set);
    if (set.exact && set.language.value == HNBRDF_LANGUAGE_GLSL && !set.standalone)
        return cli_usage(&command, "--exact in glsl is chosen where hybrid_brdf.glsl stands: "
                                   "--standalone, or #define HNBRDF_EXACT 1 before the include");
    if (set.weights_path && set.weights.value != HNBRDF_GLSL_UNIFORM)
        return cli_usage(&command, "--weights-out without --weights uniform");
    if (set.fixed && set.editable)
        return cli_usage(&command,
                         "--fixed and --editable: materials that are fixed do not change");
    if (set.fixed && set.pack >= 0)
        return cli_usage(&command, "--fixed and --pack: materials from textures are not fixed");
    if (set.texels && set.pack < 0)
        return cli_usage(&command, "--texels without --pack half or --pack byte");
    if (set.all_fields >= 0 && set.pack < 0)
        return cli_usage(&command, "--texel-fields without --pack half or --pack byte");
    if (set.planes >= 0 && !set.texels)
        return cli_usage(&command, "--texel-layout without --texels");
    hnbrdf_model *model = NULL;
    result = cli_open_model(argv[1], &model);
    if (result != CLI_OK)
        return result;
    int *materials = NULL, chosen = 0;
    result = cli_choose_materials(model, set.materials, &materials, &chosen);
    if (result == CLI_OK && set.conserve)
        result = conserve(&model, materials, chosen);
    if (result == CLI_OK)
        result = export_materials(model, &set, materials, chosen);
    free(materials);
    hnbrdf_model_free(model);
    return result;
}
