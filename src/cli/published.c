/* published.c: published .brdf shaders of one data set as a model. */
#include "cli/cli.h"

#include "base/text.h"
#include "image/image.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A published shader has some 60 KB. */
static const size_t max_text = (size_t)16 << 20;

typedef struct brdf_texts {
    int count;
    char *const *paths;
    char **texts, **names;
    size_t *sizes;
    cli_imported *told;
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
    char *const *paths = texts->paths;
    for (int k = 0; k < texts->count; k++) {
        int published = 0;
        texts->names[k] = name_of(paths[k], &published);
        if (!texts->names[k])
            return CLI_FAILURE;
        texts->told->renamed += published;
        texts->told->first = published && !texts->told->first ? k + 1 : texts->told->first;
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

static int import(const brdf_texts *texts, hnbrdf_model **model)
{
    const hnbrdf_import_options options = {.notes = CLI_NOTES,
                                           .files = (const char *const *)texts->paths};
    hnbrdf_error error;
    return cli_code(hnbrdf_model_import_brdf((const char *const *)texts->texts, texts->sizes,
                                             (const char *const *)texts->names, texts->count,
                                             &options, model, &error),
                    &error);
}

int cli_import(char *const *paths, int count, hnbrdf_model **model, cli_imported *told)
{
    const size_t n = (size_t)count;
    brdf_texts texts = {.count = count,
                        .paths = paths,
                        .texts = calloc(n, sizeof *texts.texts),
                        .names = calloc(n, sizeof *texts.names),
                        .sizes = calloc(n, sizeof *texts.sizes),
                        .told = told};
    int result = CLI_OK;
    *told = (cli_imported){0};
    if (!texts.texts || !texts.names || !texts.sizes)
        result = cli_fail("out of memory");
    else
        result = read_all(&texts);
    if (result == CLI_OK)
        result = import(&texts, model);
    for (size_t k = 0; k < n && texts.texts && texts.names; k++) {
        free(texts.texts[k]);
        free(texts.names[k]);
    }
    free(texts.texts);
    free(texts.names);
    free(texts.sizes);
    return result;
}

/* ---- A folder -------------------------------------------------------------------------------- */

static int is_brdf(const struct dirent *entry)
{
    return hnbrdf_ends_with(entry->d_name, ".brdf");
}

static int compare_bytes(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static int import_folder(const char *folder, hnbrdf_model **model)
{
    struct dirent **entries = NULL;
    cli_imported told;
    const int count = scandir(folder, &entries, is_brdf, compare_bytes);
    if (count < 0)
        return cli_fail("%s: cannot read the directory: %s", folder, strerror(errno));
    char **paths = calloc((size_t)count + 1, sizeof *paths);
    int result = paths ? CLI_OK : cli_fail("out of memory");
    for (int k = 0; k < count; k++) {
        const size_t size = strlen(folder) + strlen(entries[k]->d_name) + 2;
        if (paths && (paths[k] = malloc(size)))
            snprintf(paths[k], size, "%s/%s", folder, entries[k]->d_name);
        else if (result == CLI_OK)
            result = cli_fail("out of memory");
        free(entries[k]);
    }
    if (result == CLI_OK)
        result = count ? cli_import(paths, count, model, &told)
                       : cli_fail("%s: the directory has no published shader: .brdf", folder);
    for (int k = 0; k < count && paths; k++)
        free(paths[k]);
    free(paths);
    free(entries);
    return result;
}

int cli_open_published(const char *path, hnbrdf_model **model)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode) ? import_folder(path, model)
                                                               : cli_open_model(path, model);
}
