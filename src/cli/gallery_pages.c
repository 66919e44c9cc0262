/* gallery_pages.c: renders strips of edited materials and writes them as pages, with gallery.md
 * to tell how each is made. */
#include "cli/gallery.h"

#include <stdlib.h>
#include <string.h>

/* Strips of a page at most: two rows each. */
enum { STRIPS = 32 };

typedef struct page {
    char file[HNBRDF_MAX_NAME + 16]; /* without extension */
    char title[HNBRDF_MAX_NAME + 32];
    const char *about;
    gallery_strip strips[STRIPS];
    int materials[STRIPS]; /* whose measurement stands before the strip; -1: none */
    char subjects[STRIPS][2 * HNBRDF_MAX_NAME + 8]; /* what the strip is of */
    int count;
    int beside; /* 1: each strip again with GGX alone */
} page;

/* ---- Which pages ----------------------------------------------------------------------------- */

static int is_hybrid(const gallery *g)
{
    return g->desc.kind == HNBRDF_KIND_HYBRID;
}

static int has_analytic(const gallery *g)
{
    return g->desc.kind != HNBRDF_KIND_NEURAL;
}

static gallery_strip *add_strip(page *p, int material)
{
    p->materials[p->count] = material;
    return &p->strips[p->count++];
}

/* Names the strip that was added last. */
static void name_strip(page *p, const gallery *g, const char *edit)
{
    int s = p->count - 1;
    snprintf(p->subjects[s], sizeof p->subjects[0], "%s%s%s",
             hnbrdf_model_material_name(g->model, p->materials[s]), *edit ? ": " : "", edit);
}

static void plan_edits(const gallery *g, int material, page *p)
{
    const hnbrdf_material *m = hnbrdf_model_material(g->model, material);
    const char *name = hnbrdf_model_material_name(g->model, material);
    memset(p, 0, sizeof *p);
    snprintf(p->file, sizeof p->file, "edits-%s", name);
    snprintf(p->title, sizeof p->title, "Editing %s", name);
    p->about = "one number of its GGX part changed at a time; the network keeps what it learned";
    p->beside = is_hybrid(g);
    gallery_strip_alpha(m, add_strip(p, material));
    name_strip(p, g, "roughness");
    gallery_strip_kd(m, add_strip(p, material));
    name_strip(p, g, "diffuse colour");
    gallery_strip_eta(m, add_strip(p, material));
    name_strip(p, g, "index of refraction");
}

static void plan_anisotropy(const gallery *g, page *p)
{
    memset(p, 0, sizeof *p);
    snprintf(p->file, sizeof p->file, "anisotropy");
    snprintf(p->title, sizeof p->title, "Isotropic materials made anisotropic");
    p->about = "alpha_x : alpha_y, x along the parallels; then the brushing is turned";
    p->beside = is_hybrid(g);
    for (int k = 0; k < g->material_count; k++) {
        gallery_strip_anisotropy(hnbrdf_model_material(g->model, g->materials[k]),
                                 add_strip(p, g->materials[k]));
        name_strip(p, g, "");
    }
}

static void plan_mixes(const gallery *g, page *p)
{
    memset(p, 0, sizeof *p);
    snprintf(p->file, sizeof p->file, "mixes");
    snprintf(p->title, sizeof p->title, "Between two materials");
    p->about = "albedo, reflectance and latent code go linearly, roughness in its logarithm";
    for (int k = 0; k < g->pair_count; k++) {
        int a = g->pairs[k][0], b = g->pairs[k][1];
        gallery_strip_mix(hnbrdf_model_material(g->model, a), hnbrdf_model_material(g->model, b),
                          &p->strips[k]);
        p->materials[k] = -1;
        snprintf(p->subjects[k], sizeof p->subjects[k], "%s to %s",
                 hnbrdf_model_material_name(g->model, a), hnbrdf_model_material_name(g->model, b));
    }
    p->count = g->pair_count;
}

static const hnbrdf_measured *measurement(const gallery *g, int material)
{
    return material < 0 ? NULL
                        : cli_find_data(&g->data, hnbrdf_model_material_name(g->model, material));
}

/* Spheres to render, measurements aside. */
static int work_of(const gallery *g)
{
    int edits = has_analytic(g) ? 4 * g->material_count : 0;
    return GALLERY_EDITS * (edits * (is_hybrid(g) ? 2 : 1) + g->pair_count);
}

/* ---- Rendering ------------------------------------------------------------------------------- */

static int render_cell(gallery *g, render_surface *surface, render_sheet_cell *cell)
{
    hnbrdf_error error;
    const render_options options = {.size = (int)g->size,
                                    .spp = (int)g->light.spp,
                                    .seed = (uint64_t)g->light.seed,
                                    .threads = (int)g->light.threads,
                                    .progress = picture_report,
                                    .progress_user = &g->progress};
    if (render_sphere(surface, &g->environment, &options, &cell->image, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    float gain = (float)exp2(g->light.exposure);
    for (size_t k = 0; k < 3 * (size_t)g->size * (size_t)g->size; k++)
        cell->image.rgb[k] *= gain;
    return CLI_OK;
}

/* What suits the picture, and the material's own lobe beside: guides know no turned brushing. */
static render_guide make_guide(const gallery *g, const render_surface *shown,
                               const hnbrdf_material *material)
{
    static const float own = 0.3f;
    render_guide guide = render_guide_fit(&shown, 1, g->guide);
    if (guide.count == RENDER_LOBES)
        guide.count--;
    float rest = 0.0f;
    for (int k = 0; k < guide.count; k++)
        rest += guide.lobes[k].share;
    for (int k = 0; k < guide.count; k++)
        guide.lobes[k].share *= (1.0f - own) / rest;
    guide.lobes[guide.count].material = *material;
    guide.lobes[guide.count].retro = 0;
    guide.lobes[guide.count++].share = own;
    return guide;
}

static int render_material(gallery *g, const hnbrdf_material *material, int analytic,
                           render_sheet_cell *cell)
{
    render_surface shown = analytic ? render_surface_analytic(g->model, material)
                                    : render_surface_model(g->model, material);
    if (!analytic) { /* GGX alone draws from itself */
        render_guide guide = make_guide(g, &shown, material);
        render_surface_guide(&shown, &guide);
    }
    int code = render_cell(g, &shown, cell);
    g->progress.first++;
    return code;
}

static int render_measurement(gallery *g, const hnbrdf_measured *measured, render_sheet_cell *cell)
{
    render_surface surface = render_surface_measured(measured);
    const render_surface *one = &surface;
    render_guide guide = render_guide_fit(&one, 1, g->guide);
    render_surface_guide(&surface, &guide);
    snprintf(cell->caption, sizeof cell->caption, "measured");
    memcpy(cell->short_caption, cell->caption, sizeof cell->short_caption);
    return render_cell(g, &surface, cell);
}

/* shift: 1 if the first column is for measurements. */
static int render_row(gallery *g, const gallery_strip *strip, int analytic, int shift,
                      render_sheet_row *row)
{
    int code = CLI_OK;
    for (int k = 0; k < GALLERY_EDITS && code == CLI_OK; k++) {
        render_sheet_cell *cell = &row->cells[shift + k];
        code = render_material(g, &strip->materials[k], analytic, cell);
        snprintf(cell->caption, sizeof cell->caption, "%s", strip->captions[k]);
        snprintf(cell->short_caption, sizeof cell->short_caption, "%.*s",
                 (int)sizeof cell->short_caption - 1, strip->captions[k]);
    }
    return code;
}

/* ---- A page ---------------------------------------------------------------------------------- */

static const char *kind_of(const gallery *g, int analytic)
{
    return analytic ? "GGX alone" : hnbrdf_kind_name(g->desc.kind);
}

typedef char row_name[2 * HNBRDF_MAX_NAME + 64];

static int render_rows(gallery *g, const page *p, int shift, render_sheet_row *rows,
                       row_name *names)
{
    int code = CLI_OK, count = 0;
    for (int s = 0; s < p->count && code == CLI_OK; s++)
        for (int analytic = 0; analytic <= p->beside && code == CLI_OK; analytic++) {
            const hnbrdf_measured *measured = measurement(g, p->materials[s]);
            render_sheet_row *row = &rows[count];
            snprintf(names[count], sizeof *names, "%s%s%s", p->subjects[s], p->beside ? ", " : "",
                     p->beside ? kind_of(g, analytic) : "");
            row->name = g->progress.detail = names[count++];
            code = render_row(g, &p->strips[s], analytic, shift, row);
            if (code == CLI_OK && shift && measured && !analytic)
                code = render_measurement(g, measured, &row->cells[0]);
        }
    return code;
}

static int write_page(const gallery *g, const page *p, int shift, const render_sheet_row *rows)
{
    hnbrdf_error error;
    render_image image;
    char what[192];
    const char *slash = strrchr(g->model_path, '/'), *light = strrchr(g->light.env, '/');
    render_sheet sheet = {.lines = {p->title, p->about, what},
                          .columns = GALLERY_EDITS + shift,
                          .cell = (int)g->size,
                          .blocks = 1,
                          .rows = rows,
                          .count = p->count * (1 + p->beside)};
    snprintf(what, sizeof what, "%.60s, light %.40s, %ld samples a pixel",
             slash ? slash + 1 : g->model_path, light ? light + 1 : g->light.env, g->light.spp);
    if (render_sheet_compose(&sheet, &image, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    size_t size = strlen(g->directory) + sizeof p->file + 8;
    char *path = malloc(size);
    int code = path ? CLI_OK : cli_fail("out of memory");
    if (path) {
        snprintf(path, size, "%s/%s.%s", g->directory, p->file, render_has_exr() ? "exr" : "png");
        code = picture_write(&image, path, &(render_write_options){.half = 1, .comments = what});
    }
    free(path);
    render_image_free(&image);
    return code;
}

static int make_page(gallery *g, const page *p)
{
    int count = p->count * (1 + p->beside), shift = 0;
    render_sheet_row *rows = calloc((size_t)count + 1, sizeof *rows);
    row_name *names = calloc((size_t)count + 1, sizeof *names);
    for (int s = 0; s < p->count; s++)
        shift |= measurement(g, p->materials[s]) != NULL;
    int code = rows && names ? render_rows(g, p, shift, rows, names) : cli_fail("out of memory");
    cli_progress_end(&g->progress.line);
    if (code == CLI_OK)
        code = write_page(g, p, shift, rows);
    for (int k = 0; k < count && rows; k++)
        for (int c = 0; c < RENDER_SHEET_COLUMNS; c++)
            render_image_free(&rows[k].cells[c].image);
    free(rows);
    free(names);
    return code;
}

/* ---- All of them ----------------------------------------------------------------------------- */

/* The page in gallery.md, with the commands that make the last sphere of each strip. */
static void describe_page(const gallery *g, const page *p, FILE *file)
{
    fprintf(file, "\n## %s\n\n%c%s.\n\n![%s](%s.png)\n\n", p->title, p->about[0] - 'a' + 'A',
            p->about + 1, p->title, p->file);
    for (int s = 0; s < p->count; s++) {
        if (p->materials[s] >= 0)
            fprintf(file, "    hnbrdf edit %s --material %s %s --as NEW -o edited.safetensors\n",
                    g->model_path, hnbrdf_model_material_name(g->model, p->materials[s]),
                    p->strips[s].command);
        else
            fprintf(file, "    hnbrdf mix %s %s %s %s -o mixed.safetensors\n", g->model_path,
                    hnbrdf_model_material_name(g->model, g->pairs[s][0]),
                    hnbrdf_model_material_name(g->model, g->pairs[s][1]), p->strips[s].command);
    }
}

static int finish_page(gallery *g, const page *p, FILE *file)
{
    int code = p->count ? make_page(g, p) : CLI_OK;
    if (code == CLI_OK && p->count)
        describe_page(g, p, file);
    return code;
}

static int make_pages(gallery *g, page *p, FILE *file)
{
    int code = CLI_OK;
    fprintf(file,
            "# Gallery\n\nEdits and mixtures of `%s`, by `hnbrdf gallery` %s. Below each page "
            "stands what "
            "makes the last\nsphere of each of its strips.\n",
            g->model_path, hnbrdf_version());
    for (int k = 0; k < g->material_count && has_analytic(g) && code == CLI_OK; k++) {
        plan_edits(g, g->materials[k], p);
        code = finish_page(g, p, file);
    }
    if (code == CLI_OK && has_analytic(g)) {
        plan_anisotropy(g, p);
        code = finish_page(g, p, file);
    }
    if (code == CLI_OK) {
        plan_mixes(g, p);
        code = finish_page(g, p, file);
    }
    return code;
}

int gallery_write(gallery *g)
{
    cli_output output;
    size_t size = strlen(g->directory) + sizeof "/gallery.md";
    char *path = malloc(size);
    page *p = malloc(sizeof *p);
    int code = path && p ? CLI_OK : cli_fail("out of memory");
    if (code == CLI_OK) {
        snprintf(path, size, "%s/gallery.md", g->directory);
        code = cli_output_open(path, &output);
    }
    if (code == CLI_OK) {
        g->progress.count = work_of(g);
        cli_progress_begin(&g->progress.line, "rendering");
        code = make_pages(g, p, output.file);
        if (code == CLI_OK)
            code = cli_output_close(&output);
        else
            cli_output_discard(&output);
    }
    if (code == CLI_OK)
        printf("%s\n", path);
    free(path);
    free(p);
    return code;
}
