/* load.c: from a described scene to one that can be rendered: reads the files, fits guides,
 * builds. */
#include "scene/loader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Materials ------------------------------------------------------------------------------- */

static hnbrdf_result find_model(loader *l, const char *file, hnbrdf_model **model)
{
    for (int i = 0; i < l->out->model_count; i++)
        if (l->model_files[i] && strcmp(l->model_files[i], file) == 0) {
            *model = l->out->models[i];
            return HNBRDF_OK;
        }
    char path[2 * RENDER_MAX_PATH];
    render_description_path(l->d, file, path);
    const hnbrdf_load_options load = {.notes = l->reading.notes};
    hnbrdf_result result = hnbrdf_model_load(path, &load, model, l->error);
    if (result == HNBRDF_OK) {
        l->model_files[l->out->model_count] = file;
        l->out->models[l->out->model_count++] = *model;
    }
    return result;
}

static hnbrdf_model *plain(const loader *l)
{
    return l->out->models[0]; /* made first */
}

static void measured_surface(loader *l, hnbrdf_measured *measured, render_surface *surface)
{
    l->out->measured[l->out->measured_count++] = measured;
    *surface = render_surface_measured(measured);
    const render_surface *one = surface;
    render_guide guide = render_guide_fit(&one, 1, plain(l));
    render_surface_guide(surface, &guide);
}

/* The first of the files NAME and ENDING that is there; 0 if none is. */
static int find_counterpart(const loader *l, const char *name, const char *const *endings,
                            char path[2 * RENDER_MAX_PATH])
{
    for (int i = 0; endings && endings[i]; i++) {
        snprintf(path, 2 * RENDER_MAX_PATH, "%s/%s%s", l->folder, name, endings[i]);
        if (access(path, F_OK) == 0)
            return 1;
    }
    return 0;
}

/* The measurement of a model's material. */
static hnbrdf_result open_counterpart(loader *l, const char *name, hnbrdf_measured **measured)
{
    const hnbrdf_measured_format_info *info;
    char path[2 * RENDER_MAX_PATH], endings[128] = "", rgb[HNBRDF_MAX_NAME + 8];
    size_t length = 0;
    snprintf(rgb, sizeof rgb, "%s_rgb", name);
    for (int row = 0; (info = hnbrdf_measured_format_at(row)); row++) {
        if (find_counterpart(l, rgb, info->endings, path) ||
            find_counterpart(l, name, info->endings, path) ||
            find_counterpart(l, rgb, info->part_endings, path) ||
            find_counterpart(l, name, info->part_endings, path))
            return hnbrdf_measured_open(path, l->reading.measured, measured, l->error);
        for (int i = 0; info->endings && info->endings[i] && length < sizeof endings; i++)
            length += (size_t)snprintf(endings + length, sizeof endings - length, ", %s",
                                       info->endings[i]);
    }
    return hnbrdf_fail(l->error, HNBRDF_ERROR_IO,
                       "%s: no measurement of '%s' there: expected %s_rgb or %s and one of%s",
                       l->folder, name, name, name, endings + (endings[0] == ','));
}

static hnbrdf_result from_model(loader *l, const render_text_material *m, render_surface *surface)
{
    hnbrdf_model *model = NULL;
    hnbrdf_measured *measured = NULL;
    hnbrdf_result result = find_model(l, m->file, &model);
    if (result != HNBRDF_OK)
        return result;
    int count = hnbrdf_model_material_count(model), index = m->which[0]
                                                                ? hnbrdf_model_find(model, m->which)
                                                            : count == 1 ? 0
                                                                         : -1;
    if (index < 0 && !m->which[0])
        return hnbrdf_fail(l->error, HNBRDF_ERROR_ARGUMENT, "%s holds %d materials: name one",
                           m->file, count);
    if (index < 0)
        return hnbrdf_fail(l->error, HNBRDF_ERROR_ARGUMENT, "%s has no material '%s'", m->file,
                           m->which);
    const hnbrdf_material *material = hnbrdf_model_material(model, index);
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    switch (l->show) {
    case RENDER_SHOW_MODEL:
        *surface = render_surface_model(model, material);
        break;
    case RENDER_SHOW_ANALYTIC:
        if (desc.kind == HNBRDF_KIND_NEURAL)
            return hnbrdf_fail(l->error, HNBRDF_ERROR_ARGUMENT,
                               "%s is a neural model: it has no GGX part to show", m->file);
        *surface = render_surface_model(plain(l), material);
        break;
    case RENDER_SHOW_MEASURED:
        result = open_counterpart(l, hnbrdf_model_material_name(model, index), &measured);
        if (result == HNBRDF_OK)
            measured_surface(l, measured, surface);
        break;
    }
    return result;
}

static hnbrdf_result open_builtin(const loader *l, const char *name, hnbrdf_measured **measured)
{
    const char *candidate;
    for (int i = 0; (candidate = hnbrdf_measured_builtin_name(i)); i++)
        if (strcmp(candidate, name) == 0)
            return hnbrdf_measured_open_builtin(i, measured, l->error);
    return hnbrdf_fail(l->error, HNBRDF_ERROR_ARGUMENT,
                       "no built-in material '%s': `hnbrdf info builtin` and `hnbrdf info "
                       "builtin:anisotropic` list them",
                       name);
}

static hnbrdf_result load_material(loader *l, const render_text_material *m,
                                   render_surface *surface)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_result result = HNBRDF_OK;
    char path[2 * RENDER_MAX_PATH];
    switch (m->source) {
    case RENDER_FROM_MODEL:
        return from_model(l, m, surface);
    case RENDER_FROM_GGX:
        result = hnbrdf_material_check(&m->ggx, l->error);
        *surface = render_surface_model(plain(l), &m->ggx);
        return result;
    case RENDER_FROM_MEASURED:
        render_description_path(l->d, m->file, path);
        result = hnbrdf_measured_open(path, l->reading.measured, &measured, l->error);
        break;
    case RENDER_FROM_BUILTIN:
        result = open_builtin(l, m->which, &measured);
        break;
    }
    if (result == HNBRDF_OK)
        measured_surface(l, measured, surface);
    return result;
}

static hnbrdf_result load_materials(loader *l)
{
    const render_description *d = l->d;
    size_t room = (size_t)d->material_count + 1;
    l->out->models = calloc(room, sizeof *l->out->models);
    l->out->measured = calloc(room, sizeof *l->out->measured);
    l->out->scene.surfaces = calloc(room, sizeof *l->out->scene.surfaces);
    l->model_files = calloc(room, sizeof *l->model_files);
    if (!l->out->models || !l->out->measured || !l->out->scene.surfaces || !l->model_files)
        return hnbrdf_fail(l->error, HNBRDF_ERROR_MEMORY, "%s: no memory for its materials",
                           d->name);
    hnbrdf_result result = render_guide_model(&l->out->models[0], l->error);
    l->out->model_count = result == HNBRDF_OK;
    for (int i = 0; i < d->material_count && result == HNBRDF_OK; i++) {
        result = loader_at(l, d->materials[i].line,
                           load_material(l, &d->materials[i], &l->out->scene.surfaces[i].surface));
        l->out->scene.surface_count += result == HNBRDF_OK;
    }
    return result;
}

/* ---- The scene ------------------------------------------------------------------------------- */

static hnbrdf_result load_environment(const loader *l)
{
    const render_description *d = l->d;
    const char *source = d->environment;
    char path[2 * RENDER_MAX_PATH];
    if (!source[0])
        return HNBRDF_OK;
    if (strcmp(source, "sky") != 0 && strcmp(source, "furnace") != 0) {
        render_description_path(l->d, d->environment, path);
        source = path;
    }
    const render_read_options options = {.notes = l->reading.notes,
                                         .layer =
                                             d->environment_layer[0] ? d->environment_layer : NULL,
                                         .repair = d->environment_repair};
    hnbrdf_result result =
        render_environment_open(source, d->rotate * 3.14159265358979323846 / 180.0, &options,
                                &l->out->environment, l->error);
    if (result != HNBRDF_OK)
        return loader_at(l, d->environment_line, result);
    render_environment_scale(&l->out->environment, d->gain);
    l->out->scene.environment = &l->out->environment;
    return HNBRDF_OK;
}

hnbrdf_result render_description_load(const render_description *description, render_show show,
                                      const char *folder, const render_reading *reading,
                                      render_loaded *loaded, hnbrdf_error *error)
{
    loader l = {.d = description,
                .show = show,
                .folder = folder,
                .reading = reading ? *reading : (render_reading){0},
                .out = loaded,
                .error = error};
    memset(loaded, 0, sizeof *loaded);
    hnbrdf_result result = load_materials(&l);
    free(l.model_files);
    if (result == HNBRDF_OK)
        result = loader_shapes(&l);
    if (result == HNBRDF_OK)
        result = load_environment(&l);
    if (result == HNBRDF_OK) {
        loaded->scene.camera = description->camera;
        loaded->scene.portal_count = description->portal_count;
        memcpy(loaded->scene.portals, description->portals, sizeof loaded->scene.portals);
        result = render_scene_build(&loaded->scene, error);
    }
    if (result != HNBRDF_OK)
        render_loaded_free(loaded);
    return result;
}

void render_loaded_free(render_loaded *loaded)
{
    render_scene_free(&loaded->scene);
    render_environment_free(&loaded->environment);
    for (int i = 0; i < loaded->model_count; i++)
        hnbrdf_model_free(loaded->models[i]);
    for (int i = 0; i < loaded->measured_count; i++)
        hnbrdf_measured_close(loaded->measured[i]);
    free(loaded->models);
    free(loaded->measured);
    memset(loaded, 0, sizeof *loaded);
}
