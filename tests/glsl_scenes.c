/* glsl_scenes.c: writes scenes of many shapes into a directory, for the tests that are shell
 * scripts: NAME.glsl (include), NAME.alone.glsl (standalone), NAME.safetensors (the model). With a
 * language after the directory in that: NAME.hlsl, NAME.alone.hlsl, NAME.exact.hlsl (standalone),
 * and what they share, hybrid_brdf.hlsl. */
#include "gpu_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Neither units nor latent code fill their vectors. */
#define UNEVEN                                                                                    \
    {                                                                                             \
        .encoding = HNBRDF_ENCODING_ANGLES, .hidden = 11, .layers = 2, .latent = 5, .shift = 0.5f \
    }

static const struct {
    const char *name;
    scene_shape shape;
    hnbrdf_glsl_weights weights;
    hnbrdf_glsl_precision precision;
    hnbrdf_glsl_only only;
    int fixed, packed;
} scenes[] = {
    {.name = "hybrid_32x2",
     .shape = {.encoding = HNBRDF_ENCODING_HALF_DIFFERENCE,
               .hidden = 32,
               .layers = 2,
               .latent = 4,
               .floor = 0.003f}},
    {.name = "hybrid_8x4_rotated",
     .shape = {.encoding = HNBRDF_ENCODING_HALF_DIFFERENCE,
               .hidden = 8,
               .layers = 4,
               .latent = 6,
               .anisotropic = 1,
               .rotated = 1,
               .scale = 2.0f,
               .shift = 1.0f}},
    {.name = "neural_16x3_directions",
     .shape = {.kind = HNBRDF_KIND_NEURAL,
               .encoding = HNBRDF_ENCODING_DIRECTIONS,
               .hidden = 16,
               .layers = 3,
               .latent = 12}},
    {.name = "ggx", .shape = {.kind = HNBRDF_KIND_GGX}},
    {.name = "ggx_rotated", .shape = {.kind = HNBRDF_KIND_GGX, .anisotropic = 1, .rotated = 1}},
    {.name = "columns",
     .shape = UNEVEN,
     .weights = HNBRDF_GLSL_COLUMNS,
     .precision = HNBRDF_GLSL_FLOAT},
    {.name = "uniform",
     .shape = UNEVEN,
     .weights = HNBRDF_GLSL_UNIFORM,
     .precision = HNBRDF_GLSL_FLOAT},
    {.name = "half",
     .shape = UNEVEN,
     .weights = HNBRDF_GLSL_CONSTANTS,
     .precision = HNBRDF_GLSL_HALF},
    {.name = "half_columns",
     .shape = UNEVEN,
     .weights = HNBRDF_GLSL_COLUMNS,
     .precision = HNBRDF_GLSL_HALF},
    {.name = "half_uniform",
     .shape = UNEVEN,
     .weights = HNBRDF_GLSL_UNIFORM,
     .precision = HNBRDF_GLSL_HALF},
    {.name = "stripped", .shape = UNEVEN, .only = HNBRDF_GLSL_EVAL, .fixed = 1},
    {.name = "fixed_columns", .shape = UNEVEN, .weights = HNBRDF_GLSL_COLUMNS, .fixed = 1},
    {.name = "edited",
     .shape = {.encoding = HNBRDF_ENCODING_DIRECTIONS,
               .hidden = 8,
               .layers = 1,
               .latent = 2,
               .anisotropic = 1,
               .edited = 1},
     .packed = 1},
    {.name = "edited_fixed",
     .shape =
         {.encoding = HNBRDF_ENCODING_ANGLES, .hidden = 8, .layers = 1, .latent = 2, .edited = 1},
     .only = HNBRDF_GLSL_EVAL_SAMPLE,
     .fixed = 1},
    {.name = "packed", .shape = UNEVEN, .only = HNBRDF_GLSL_EVAL_SAMPLE, .packed = 1},
};

static int write_text(const char *directory, const char *name, const char *ending, const char *text)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s%s", directory, name, ending);
    FILE *file = fopen(path, "wb");
    int written = file && fputs(text, file) >= 0;
    return file && fclose(file) == 0 && written;
}

/* The text of these options with this ending. */
static int write_styled(const char *directory, const char *name, const char *ending,
                        const hnbrdf_model *model, const hnbrdf_glsl_options *options)
{
    char after[64];
    char *text = styled_text(model, options);
    snprintf(after, sizeof after, "%s.%s", ending, hnbrdf_shading_language_name(options->language));
    const int written = write_text(directory, name, after, text);
    free(text);
    return written;
}

static int write_scene(const char *directory, const char *name, const scene_shape *shape,
                       hnbrdf_glsl_options options, int packed)
{
    char path[1024];
    hnbrdf_packing packing;
    hnbrdf_model *model = scene_model(shape);
    if (hnbrdf_packing_init(model, NULL, 0, HNBRDF_TEXEL_RGBA8, &packing, NULL))
        return 0;
    options.packing = packed ? &packing : NULL;
    int written = write_styled(directory, name, "", model, &options);
    options.standalone = 1;
    written &= write_styled(directory, name, ".alone", model, &options);
    options.exact = 1;
    if (options.language != HNBRDF_LANGUAGE_GLSL)
        written &= write_styled(directory, name, ".exact", model, &options);
    snprintf(path, sizeof path, "%s/%s.safetensors", directory, name);
    written &= hnbrdf_model_save(model, path, NULL) == HNBRDF_OK;
    hnbrdf_model_free(model);
    return written;
}

int main(int argc, char **argv)
{
    hnbrdf_shading_language language = HNBRDF_LANGUAGE_GLSL;
    if (argc < 2 || argc > 3 ||
        (argc == 3 && !hnbrdf_shading_language_from_name(argv[2], &language)))
        return 2;
    const hnbrdf_glsl_options shared = {.language = language, .library = 1};
    if (language != HNBRDF_LANGUAGE_GLSL &&
        !write_styled(argv[1], "hybrid_brdf", "", NULL, &shared))
        return 1;
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        const hnbrdf_glsl_options options = {.weights = scenes[i].weights,
                                             .precision = scenes[i].precision,
                                             .only = scenes[i].only,
                                             .fixed = scenes[i].fixed,
                                             .language = language};
        if (!write_scene(argv[1], scenes[i].name, &scenes[i].shape, options, scenes[i].packed))
            return 1;
        printf("%s\n", scenes[i].name);
    }
    return 0;
}
