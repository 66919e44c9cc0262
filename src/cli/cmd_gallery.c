/* cmd_gallery.c: `hnbrdf gallery`: what can be done with fitted materials, as pages of spheres. */
#include "cli/gallery.h"
#include "hnbrdf/fit.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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

/* ---- The model ------------------------------------------------------------------------------- */

/* 1 if this argument is DATA, 0 if it is a model file, -1 after a message. */
static int is_data(gallery *g, const char *argument)
{
    struct stat status;
    cli_source source;
    if (strcmp(argument, "builtin") == 0 ||
        (stat(argument, &status) == 0 && S_ISDIR(status.st_mode)))
        return 1;
    if (cli_open_source(argument, &source) != CLI_OK)
        return -1;
    g->model = source.model;
    if (source.measured)
        cli_close_source(&source);
    return g->model == NULL;
}

static int show_fit(void *user, const hnbrdf_fit_progress *p)
{
    /* The network takes nearly all of the time. */
    cli_progress_update(user, strcmp(p->stage, "network") == 0 ? p->done : 0.0, p->stage);
    return 0;
}

static int fit(gallery *g, double seconds)
{
    hnbrdf_error error;
    cli_progress line;
    const hnbrdf_fit_options options = {.seconds = seconds,
                                        .threads = (int)g->light.threads,
                                        .progress = show_fit,
                                        .progress_user = &line};
    cli_progress_begin(&line, "fitting");
    hnbrdf_result result = hnbrdf_fit((const hnbrdf_measured *const *)g->data.items, g->data.count,
                                      &options, &g->model, NULL, &error);
    cli_progress_end(&line);
    if (result == HNBRDF_OK)
        result = hnbrdf_model_save(g->model, g->model_path, &error);
    if (result != HNBRDF_OK)
        return cli_fail("%s", error.text);
    printf("%s\n", g->model_path);
    return CLI_OK;
}

/* ---- What is shown --------------------------------------------------------------------------- */

static int name_materials(gallery *g, const char *list)
{
    int *indices, count;
    if (cli_choose_materials(g->model, list, &indices, &count) != CLI_OK)
        return CLI_FAILURE;
    int code = count <= GALLERY_MATERIALS
                   ? CLI_OK
                   : cli_fail("--materials: more than %d", (int)GALLERY_MATERIALS);
    for (int k = 0; k < count && code == CLI_OK; k++)
        g->materials[g->material_count++] = indices[k];
    free(indices);
    return code;
}

/* "A:B,C:D". */
static int name_pairs(gallery *g, char *list)
{
    for (char *end; *list; list = end) {
        end = list + strcspn(list, ",");
        if (*end)
            *end++ = '\0';
        char *colon = strchr(list, ':');
        if (!colon)
            return cli_fail("--pairs: '%s' is not A:B", list);
        if (g->pair_count == GALLERY_PAIRS)
            return cli_fail("--pairs: more than %d", (int)GALLERY_PAIRS);
        *colon = '\0';
        int *pair = g->pairs[g->pair_count++];
        pair[0] = cli_choose_material(g->model, list);
        pair[1] = pair[0] < 0 ? -1 : cli_choose_material(g->model, colon + 1);
        if (pair[1] < 0)
            return CLI_FAILURE;
    }
    return CLI_OK;
}

static int choose(gallery *g, const char *materials, const char *pairs)
{
    int code = materials ? name_materials(g, materials) : gallery_choose_materials(g, 2);
    if (code != CLI_OK || !pairs)
        return code == CLI_OK ? gallery_choose_pairs(g, 6) : code;
    char *copy = strdup(pairs);
    code = copy ? name_pairs(g, copy) : cli_fail("out of memory");
    free(copy);
    return code;
}

/* ---- Command --------------------------------------------------------------------------------- */

static int open_all(gallery *g, char **arguments, int count, double seconds, char *fitted_path)
{
    hnbrdf_error error;
    int data = is_data(g, arguments[0]), skip = data ? 0 : 1;
    if (data < 0 ||
        (count > skip && cli_open_data(arguments + skip, count - skip, &g->data) != CLI_OK))
        return CLI_FAILURE;
    if (cli_make_folder(g->directory) != CLI_OK)
        return CLI_FAILURE;
    g->model_path = data ? fitted_path : arguments[0];
    if (data && fit(g, seconds) != CLI_OK)
        return CLI_FAILURE;
    hnbrdf_model_describe(g->model, &g->desc);
    if (picture_open_light(&g->light, &g->environment) != CLI_OK)
        return CLI_FAILURE;
    return render_guide_model(&g->guide, &error) == HNBRDF_OK ? CLI_OK : cli_fail("%s", error.text);
}

int cmd_gallery(int argc, char **argv)
{
    gallery g = {.size = 160, .light = PICTURE_DEFAULTS(64)};
    const char *materials = NULL, *pairs = NULL;
    double seconds = 40.0;
    int count;
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &g.directory, 0, 0, "DIR",
         "the folder to write (required); made if missing"},
        {"materials", 0, CLI_TEXT, &materials, 0, 0, "A,B", "whose edits to show (default: two)"},
        {"pairs", 0, CLI_TEXT, &pairs, 0, 0, "A:B,C:D", "what to mix (default: up to six pairs)"},
        {"seconds", 0, CLI_REAL, &seconds, 0.1, 1e6, "S",
         "DATA alone: how long to fit (default 40)"},
        {"size", 0, CLI_INT, &g.size, 32, 1024, "N", "pixels of a sphere's side, default 160"},
        PICTURE_OPTIONS(g.light, "64"),
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {0},
    };
    int code = cli_parse(&command, options, argc, argv, &count);
    if (code < 0 && count < 1)
        code = cli_usage(&command, "no MODEL and no DATA");
    if (code < 0 && !g.directory)
        code = cli_usage(&command, "no folder given, expected -o DIR");
    if (code >= 0)
        return code;
    size_t size = strlen(g.directory) + sizeof "/model.safetensors";
    char *fitted_path = malloc(size);
    if (!fitted_path)
        return cli_fail("out of memory");
    snprintf(fitted_path, size, "%s/model.safetensors", g.directory);
    code = open_all(&g, argv + 1, count, seconds, fitted_path);
    if (code == CLI_OK)
        code = choose(&g, materials, pairs);
    if (code == CLI_OK)
        code = gallery_write(&g);
    render_environment_free(&g.environment);
    hnbrdf_model_free(g.guide);
    hnbrdf_model_free(g.model);
    cli_close_data(&g.data);
    free(fitted_path);
    return code;
}
