/* palette.c: open a model's list of materials, put edited ones into it, save it. */
#include "edit/palette.h"

#include <stdlib.h>
#include <string.h>

static int append(palette *p, const char *name, const hnbrdf_material *material)
{
    size_t size = (size_t)p->count + 1;
    hnbrdf_material *materials = realloc(p->materials, size * sizeof *materials);
    if (materials)
        p->materials = materials;
    char **names = realloc(p->names, size * sizeof *names);
    if (names)
        p->names = names;
    char *copy = strdup(name);
    if (!materials || !names || !copy) {
        free(copy);
        return cli_fail("out of memory");
    }
    p->materials[p->count] = *material;
    p->names[p->count++] = copy;
    return CLI_OK;
}

int palette_open(palette *p, const char *path)
{
    cli_source source;
    memset(p, 0, sizeof *p);
    p->path = path;
    if (cli_open_source(path, &source) != CLI_OK)
        return CLI_FAILURE;
    if (!source.model) {
        cli_close_source(&source);
        return cli_fail("%s: measured data, expected a model file", path);
    }
    p->model = source.model;
    int result = CLI_OK;
    for (int k = 0; k < hnbrdf_model_material_count(p->model) && result == CLI_OK; k++)
        result =
            append(p, hnbrdf_model_material_name(p->model, k), hnbrdf_model_material(p->model, k));
    if (result != CLI_OK)
        palette_close(p);
    return result;
}

int palette_put(palette *p, const char *name, const hnbrdf_material *material, int replace)
{
    hnbrdf_error error;
    int k = 0;
    hnbrdf_material fitted = *material;
    if (hnbrdf_material_check(material, &error) != HNBRDF_OK ||
        hnbrdf_lobes_fit(p->model, material, &fitted.lobes, &error) != HNBRDF_OK)
        return cli_fail("%s: %s", name, error.text);
    while (k < p->count && strcmp(p->names[k], name) != 0)
        k++;
    if (k == p->count)
        return append(p, name, &fitted);
    if (!replace)
        return cli_fail("%s: there is a material %s already (--replace overwrites it)", p->path,
                        name);
    p->materials[k] = fitted;
    return CLI_OK;
}

int palette_save(const palette *p, const char *path)
{
    hnbrdf_model_desc desc;
    hnbrdf_model *made;
    hnbrdf_error error;
    hnbrdf_model_describe(p->model, &desc);
    desc.material_count = p->count;
    desc.materials = p->materials;
    desc.names = (const char *const *)p->names;
    hnbrdf_result result = hnbrdf_model_create(&desc, NULL, &made, &error);
    if (result == HNBRDF_OK) {
        result = hnbrdf_model_save(made, path, &error);
        hnbrdf_model_free(made);
    }
    return result == HNBRDF_OK ? CLI_OK : cli_fail("%s", error.text);
}

void palette_close(palette *p)
{
    for (int k = 0; k < p->count; k++)
        free(p->names[k]);
    free(p->names);
    free(p->materials);
    hnbrdf_model_free(p->model);
    memset(p, 0, sizeof *p);
}
