/* cmd_gallery.c: `hnbrdf gallery`: what can be done with fitted materials, as pages of spheres. */
#include "cli/picture.h"
#include "hnbrdf/fit.h"
#include "report/gallery.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "gallery",
    "MODEL|DATA [DATA...] [options] -o DIR",
    "Renders what can be done with fitted materials, as pages of spheres: edits-NAME.png with\n"
    "another roughness, diffuse colour and index of refraction, the hybrid above GGX alone;\n"
    "anisotropy.png with isotropic materials brushed; mixes.png with the way from one material to\n"
    "another. EXR beside each, and gallery.md with the commands that make the same edits. DATA, "
    "if\n"
    "given, shows the measurement beside its model. Where no materials or pairs are named, those\n"
    "are taken in which GGX and network both matter, and pairs that are far apart.\n"
    "\n"
    "MODEL is a model file. Without one, DATA alone (builtin, or measured files) is fitted first.",
    "hnbrdf gallery examples/models/rgl_32x2.safetensors -o gallery\n"
    "hnbrdf gallery builtin --seconds 60 -o gallery\n"
    "hnbrdf gallery rgl.safetensors measured/rgl --materials vch_silk_blue --env studio.hdr -o "
    "gallery\n"
    "hnbrdf gallery merl.safetensors --pairs gold-paint:blue-fabric,nickel:pvc -o gallery",
};

typedef struct gallery_command {
    report_gallery gallery;
    const char *materials, *pairs; /* as they are typed, or NULL */
    double seconds;
    char *fitted_path;
    hnbrdf_model *model;
    cli_data data;
} gallery_command;

/* 1 if this argument is DATA, 0 if it is a model file, -1 after a message. */
static int is_data(gallery_command *c, const char *argument)
{
    cli_source source;
    if (cli_is_collection(argument))
        return 1;
    if (cli_open_source(argument, &source) != CLI_OK)
        return -1;
    c->model = source.model;
    if (source.measured)
        cli_close_source(&source);
    return c->model == NULL;
}

static int show_fit(void *user, const hnbrdf_fit_progress *p)
{
    /* The network takes nearly all of the time. */
    cli_progress_update(user, strcmp(p->stage, "network") == 0 ? p->done : 0.0, p->stage);
    return 0;
}

static int fit(gallery_command *c)
{
    hnbrdf_error error;
    cli_progress line;
    const hnbrdf_fit_options options = {.seconds = c->seconds,
                                        .threads = (int)c->gallery.spheres.light.threads,
                                        .progress = show_fit,
                                        .progress_user = &line};
    cli_progress_begin(&line, "fitting");
    hnbrdf_result result = hnbrdf_fit((const hnbrdf_measured *const *)c->data.items, c->data.count,
                                      &options, &c->model, NULL, &error);
    cli_progress_end(&line);
    if (result == HNBRDF_OK)
        result = hnbrdf_model_save(c->model, c->fitted_path, &error);
    if (result == HNBRDF_OK)
        printf("%s\n", c->fitted_path);
    return cli_code(result, &error);
}

static int name_materials(report_gallery *g, const char *list)
{
    int *indices, count;
    if (cli_choose_materials(g->model, list, &indices, &count) != CLI_OK)
        return CLI_FAILURE;
    int code = count <= REPORT_GALLERY_MATERIALS
                   ? CLI_OK
                   : cli_fail("--materials: more than %d", (int)REPORT_GALLERY_MATERIALS);
    for (int k = 0; k < count && code == CLI_OK; k++)
        g->materials[g->material_count++] = indices[k];
    free(indices);
    return code;
}

/* "A:B,C:D". */
static int name_pairs(report_gallery *g, char *list)
{
    for (char *end; *list; list = end) {
        end = list + strcspn(list, ",");
        if (*end)
            *end++ = '\0';
        char *colon = strchr(list, ':');
        if (!colon)
            return cli_fail("--pairs: '%s' is not A:B", list);
        if (g->pair_count == REPORT_GALLERY_PAIRS)
            return cli_fail("--pairs: more than %d", (int)REPORT_GALLERY_PAIRS);
        *colon = '\0';
        int *pair = g->pairs[g->pair_count++];
        pair[0] = cli_choose_material(g->model, list);
        pair[1] = pair[0] < 0 ? -1 : cli_choose_material(g->model, colon + 1);
        if (pair[1] < 0)
            return CLI_FAILURE;
    }
    return CLI_OK;
}

static int choose(gallery_command *c)
{
    report_gallery *g = &c->gallery;
    hnbrdf_error error;
    int code = c->materials ? name_materials(g, c->materials)
                            : cli_code(report_gallery_choose_materials(g, 2, &error), &error);
    if (code != CLI_OK || !c->pairs)
        return code == CLI_OK ? cli_code(report_gallery_choose_pairs(g, 6, &error), &error) : code;
    char *copy = strdup(c->pairs);
    code = copy ? name_pairs(g, copy) : cli_fail("out of memory");
    free(copy);
    return code;
}

static int open_all(gallery_command *c, char **arguments, int count)
{
    report_gallery *g = &c->gallery;
    hnbrdf_error error;
    int data = is_data(c, arguments[0]), skip = data ? 0 : 1;
    if (data < 0 ||
        (count > skip && cli_open_data(arguments + skip, count - skip, &c->data) != CLI_OK) ||
        cli_make_folder(g->directory) != CLI_OK || (data && fit(c) != CLI_OK))
        return CLI_FAILURE;
    g->model_path = data ? c->fitted_path : arguments[0];
    g->model = c->model;
    hnbrdf_model_describe(g->model, &g->desc);
    g->spheres.data = c->data.items;
    g->spheres.data_count = c->data.count;
    return cli_code(report_spheres_open(&g->spheres, &error), &error);
}

static int write_pages(report_gallery *g)
{
    hnbrdf_error error;
    cli_progress line;
    g->spheres.watch = cli_watch(&line);
    cli_progress_begin(&line, "rendering");
    hnbrdf_result result = report_gallery_write(g, &error);
    cli_progress_end(&line);
    return cli_code(result, &error);
}

int cmd_gallery(int argc, char **argv)
{
    gallery_command c = {.gallery = {.spheres = {.size = 160, .light = PICTURE_DEFAULTS(64)}},
                         .seconds = 40.0};
    report_gallery *g = &c.gallery;
    int count;
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_FOLDER, &g->directory, 0, 0, "DIR",
         "the folder to write (required); made if missing"},
        {"materials", 0, CLI_TEXT, &c.materials, 0, 0, "A,B", "whose edits to show (default: two)"},
        {"pairs", 0, CLI_TEXT, &c.pairs, 0, 0, "A:B,C:D", "what to mix (default: up to six pairs)"},
        {"seconds", 0, CLI_REAL, &c.seconds, 0.1, 1e6, "S",
         "DATA alone: how long to fit (default 40)"},
        {"size", 0, CLI_INT, &g->spheres.size, 32, 1024, "N",
         "pixels of a sphere's side, default 160"},
        PICTURE_OPTIONS(g->spheres.light, "64"),
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {0},
    };
    int code = cli_parse(&command, options, argc, argv, &count);
    if (code < 0 && count < 1)
        code = cli_usage(&command, "no MODEL and no DATA");
    if (code < 0 && !g->directory)
        code = cli_usage(&command, "no folder given, expected -o DIR");
    if (code >= 0)
        return code;
    size_t size = strlen(g->directory) + sizeof "/model.safetensors";
    c.fitted_path = malloc(size);
    if (!c.fitted_path)
        return cli_fail("out of memory");
    snprintf(c.fitted_path, size, "%s/model.safetensors", g->directory);
    code = open_all(&c, argv + 1, count);
    if (code == CLI_OK)
        code = choose(&c);
    if (code == CLI_OK)
        code = write_pages(g);
    report_spheres_close(&g->spheres);
    hnbrdf_model_free(c.model);
    cli_close_data(&c.data);
    free(c.fitted_path);
    return code;
}
