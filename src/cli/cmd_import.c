/* cmd_import.c: `hnbrdf import`: published .brdf shaders of one data set become one model file. */
#include "cli/cli.h"

#include "image/image.h"

#include <stdlib.h>
#include <string.h>

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

/* A published shader has some 60 KB. */
static const size_t max_text = (size_t)16 << 20;

typedef struct brdf_texts {
    int count;
    char **texts, **names, **paths;
    size_t *sizes;
    int renamed, first; /* files with published names; the number of the first, from 1 */
} brdf_texts;

/* The material of the file; malloc'ed, NULL after a message. */
static char *name_of(const char *path, int *published)
{
    const size_t size = strlen(path) + 1;
    char *name = malloc(size);
    if (name)
        *published = hnbrdf_import_name(path, name, size);
    else
        cli_fail("out of memory");
    return name;
}

static int read_all(brdf_texts *texts)
{
    hnbrdf_error error;
    char **paths = texts->paths;
    for (int k = 0; k < texts->count; k++) {
        int published = 0;
        texts->names[k] = name_of(paths[k], &published);
        if (!texts->names[k])
            return CLI_FAILURE;
        texts->renamed += published;
        texts->first = published && !texts->first ? k + 1 : texts->first;
        for (int other = 0; other < k; other++)
            if (strcmp(texts->names[other], texts->names[k]) == 0)
                return cli_fail("two materials have the name %s: %s and %s", texts->names[k],
                                paths[other], paths[k]);
        render_bytes bytes = {0};
        const hnbrdf_result result = render_file_read(paths[k], max_text, &bytes, &error);
        texts->texts[k] = (char *)bytes.data;
        texts->sizes[k] = bytes.size;
        if (result != HNBRDF_OK)
            return cli_fail("%s", error.text);
        if (bytes.size == 0)
            return cli_fail("%s: empty, expected a .brdf shader", paths[k]);
    }
    return CLI_OK;
}

static void tell_names(const brdf_texts *texts)
{
    const int k = texts->first - 1;
    if (texts->renamed > 0)
        printf("%d of %d materials are named without what published names add, as %s of %s\n",
               texts->renamed, texts->count, texts->names[k], texts->paths[k]);
}

static int import_and_save(const brdf_texts *texts, const char *out)
{
    const hnbrdf_import_options options = {.notes = CLI_NOTES,
                                           .files = (const char *const *)texts->paths};
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    hnbrdf_result result = hnbrdf_model_import_brdf((const char *const *)texts->texts, texts->sizes,
                                                    (const char *const *)texts->names, texts->count,
                                                    &options, &model, &error);
    if (result != HNBRDF_OK)
        return cli_fail("%s", error.text);
    int failed = cli_set_lobes(&model, HNBRDF_LOBES_FIT);
    if (!failed && hnbrdf_model_save(model, out, &error) != HNBRDF_OK)
        failed = cli_fail("%s", error.text);
    hnbrdf_model_free(model);
    if (failed)
        return failed;
    tell_names(texts);
    printf("%s: %d material%s\n", out, texts->count, texts->count == 1 ? "" : "s");
    return CLI_OK;
}

int cmd_import(int argc, char **argv)
{
    const char *out = NULL;
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_MODEL, &out, 0, 0, "FILE", "the model file to write (required)"},
        {0},
    };
    brdf_texts texts = {0};
    int result = cli_parse(&command, options, argc, argv, &texts.count);
    if (result >= 0)
        return result;
    if (texts.count < 1)
        return cli_usage(&command, "no .brdf file to import");
    if (!out)
        return cli_usage(&command, "no model file to write: -o MODEL.safetensors");

    size_t count = (size_t)texts.count;
    texts.paths = argv + 1;
    texts.texts = calloc(count, sizeof *texts.texts);
    texts.names = calloc(count, sizeof *texts.names);
    texts.sizes = calloc(count, sizeof *texts.sizes);
    if (!texts.texts || !texts.names || !texts.sizes)
        result = cli_fail("out of memory");
    else
        result = read_all(&texts);
    if (result == CLI_OK)
        result = import_and_save(&texts, out);
    for (size_t k = 0; k < count && texts.texts && texts.names; k++) {
        free(texts.texts[k]);
        free(texts.names[k]);
    }
    free(texts.texts);
    free(texts.names);
    free(texts.sizes);
    return result;
}
