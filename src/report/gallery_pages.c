/* gallery_pages.c: renders strips of edited materials and writes them as pages, with gallery.md
 * to tell how each is made. */
#include "report/gallery.h"

#include "base/error.h"
#include "image/sheet.h"
#include "report/output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Strips of a page at most: two rows each. */
enum { STRIPS = 32 };

typedef struct page {
    char file[HNBRDF_MAX_NAME + 16]; /* without extension */
    char title[HNBRDF_MAX_NAME + 32];
    const char *about;
    report_strip strips[STRIPS];
    int materials[STRIPS]; /* whose measurement stands before the strip; -1: none */
    char subjects[STRIPS][2 * HNBRDF_MAX_NAME + 8]; /* what the strip is of */
    int count;
    int beside; /* 1: each strip again with GGX alone */
} page;

/* ---- Which pages ----------------------------------------------------------------------------- */

static int is_hybrid(const report_gallery *g)
{
    return g->desc.kind == HNBRDF_KIND_HYBRID;
}

static int has_analytic(const report_gallery *g)
{
    return g->desc.kind != HNBRDF_KIND_NEURAL;
}

static report_strip *add_strip(page *p, int material)
{
    p->materials[p->count] = material;
    return &p->strips[p->count++];
}

/* Names the strip that was added last. */
static void name_strip(page *p, const report_gallery *g, const char *edit)
{
    int s = p->count - 1;
    snprintf(p->subjects[s], sizeof p->subjects[0], "%s%s%s",
             hnbrdf_model_material_name(g->model, p->materials[s]), *edit ? ": " : "", edit);
}

static void plan_edits(const report_gallery *g, int material, page *p)
{
    const hnbrdf_material *m = hnbrdf_model_material(g->model, material);
    const char *name = hnbrdf_model_material_name(g->model, material);
    memset(p, 0, sizeof *p);
    snprintf(p->file, sizeof p->file, "edits-%s", name);
    snprintf(p->title, sizeof p->title, "Editing %s", name);
    p->about = "one number changed at a time; what the network adds is carried along";
    p->beside = is_hybrid(g);
    report_strip_alpha(m, add_strip(p, material));
    name_strip(p, g, "roughness");
    report_strip_kd(m, add_strip(p, material));
    name_strip(p, g, "diffuse colour");
    report_strip_eta(m, add_strip(p, material));
    name_strip(p, g, "index of refraction");
}

static void plan_anisotropy(const report_gallery *g, page *p)
{
    memset(p, 0, sizeof *p);
    snprintf(p->file, sizeof p->file, "anisotropy");
    snprintf(p->title, sizeof p->title, "Isotropic materials made anisotropic");
    p->about = "alpha_x : alpha_y, x along the parallels; then the brushing is turned";
    p->beside = is_hybrid(g);
    for (int k = 0; k < g->material_count; k++) {
        report_strip_anisotropy(hnbrdf_model_material(g->model, g->materials[k]),
                                add_strip(p, g->materials[k]));
        name_strip(p, g, "");
    }
}

static hnbrdf_result plan_mixes(const report_gallery *g, page *p, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    memset(p, 0, sizeof *p);
    snprintf(p->file, sizeof p->file, "mixes");
    snprintf(p->title, sizeof p->title, "Between two materials");
    p->about = "on a path through the latent space on which albedo stays between the ends'";
    for (int k = 0; k < g->pair_count && !result; k++) {
        int a = g->pairs[k][0], b = g->pairs[k][1];
        result = report_strip_mix(g->model, hnbrdf_model_material(g->model, a),
                                  hnbrdf_model_material(g->model, b), &p->strips[k], error);
        p->materials[k] = -1;
        snprintf(p->subjects[k], sizeof p->subjects[k], "%s to %s",
                 hnbrdf_model_material_name(g->model, a), hnbrdf_model_material_name(g->model, b));
    }
    p->count = g->pair_count;
    return result;
}

static const hnbrdf_measured *measurement(const report_gallery *g, int material)
{
    return material < 0
               ? NULL
               : report_spheres_find(&g->spheres, hnbrdf_model_material_name(g->model, material));
}

/* Spheres to render, measurements aside. */
static int work_of(const report_gallery *g)
{
    int edits = has_analytic(g) ? 4 * g->material_count : 0;
    return REPORT_GALLERY_EDITS * (edits * (is_hybrid(g) ? 2 : 1) + g->pair_count);
}

/* ---- Rendering ------------------------------------------------------------------------------- */

static hnbrdf_result render_cell(report_gallery *g, render_surface *surface,
                                 render_sheet_cell *cell, hnbrdf_error *error)
{
    hnbrdf_result result = report_spheres_render(&g->spheres, surface, &cell->image, error);
    if (result != HNBRDF_OK)
        return result;
    float gain = (float)exp2(g->spheres.light.exposure);
    for (size_t k = 0; k < 3 * (size_t)cell->image.width * (size_t)cell->image.height; k++)
        cell->image.rgb[k] *= gain;
    return HNBRDF_OK;
}

/* What suits the picture, and the material's own lobe beside: guides know no turned brushing. */
static render_guide make_guide(const report_gallery *g, const render_surface *shown,
                               const hnbrdf_material *material)
{
    static const float own = 0.3f;
    render_guide guide = render_guide_fit(&shown, 1, g->spheres.guide);
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

static hnbrdf_result render_material(report_gallery *g, const hnbrdf_material *material,
                                     int analytic, render_sheet_cell *cell, hnbrdf_error *error)
{
    render_surface shown = analytic ? render_surface_analytic(g->model, material)
                                    : render_surface_model(g->model, material);
    if (!analytic) { /* GGX alone draws from itself */
        render_guide guide = make_guide(g, &shown, material);
        render_surface_guide(&shown, &guide);
    }
    hnbrdf_result result = render_cell(g, &shown, cell, error);
    g->spheres.first++;
    return result;
}

static hnbrdf_result render_measurement(report_gallery *g, const hnbrdf_measured *measured,
                                        render_sheet_cell *cell, hnbrdf_error *error)
{
    render_surface surface = render_surface_measured(measured);
    const render_surface *one = &surface;
    render_guide guide = render_guide_fit(&one, 1, g->spheres.guide);
    render_surface_guide(&surface, &guide);
    snprintf(cell->caption, sizeof cell->caption, "measured");
    memcpy(cell->short_caption, cell->caption, sizeof cell->short_caption);
    return render_cell(g, &surface, cell, error);
}

/* shift: 1 if the first column is for measurements. */
static hnbrdf_result render_row(report_gallery *g, const report_strip *strip, int analytic,
                                int shift, render_sheet_row *row, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; k < REPORT_GALLERY_EDITS && !result; k++) {
        render_sheet_cell *cell = &row->cells[shift + k];
        result = render_material(g, &strip->materials[k], analytic, cell, error);
        snprintf(cell->caption, sizeof cell->caption, "%s", strip->captions[k]);
        snprintf(cell->short_caption, sizeof cell->short_caption, "%.*s",
                 (int)sizeof cell->short_caption - 1, strip->captions[k]);
    }
    return result;
}

/* ---- A page ---------------------------------------------------------------------------------- */

static const char *kind_of(const report_gallery *g, int analytic)
{
    return analytic ? "GGX alone" : hnbrdf_kind_name(g->desc.kind);
}

typedef char row_name[2 * HNBRDF_MAX_NAME + 64];

static hnbrdf_result render_rows(report_gallery *g, const page *p, int shift,
                                 render_sheet_row *rows, row_name *names, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    int count = 0;
    for (int s = 0; s < p->count && !result; s++)
        for (int analytic = 0; analytic <= p->beside && !result; analytic++) {
            const hnbrdf_measured *measured = measurement(g, p->materials[s]);
            render_sheet_row *row = &rows[count];
            snprintf(names[count], sizeof *names, "%s%s%s", p->subjects[s], p->beside ? ", " : "",
                     p->beside ? kind_of(g, analytic) : "");
            row->name = g->spheres.detail = names[count++];
            result = render_row(g, &p->strips[s], analytic, shift, row, error);
            if (!result && shift && measured && !analytic)
                result = render_measurement(g, measured, &row->cells[0], error);
        }
    return result;
}

static hnbrdf_result write_page(const report_gallery *g, const page *p, int shift,
                                const render_sheet_row *rows, hnbrdf_error *error)
{
    const report_light *light = &g->spheres.light;
    render_image image;
    char what[192];
    render_sheet sheet = {.lines = {p->title, p->about, what},
                          .columns = REPORT_GALLERY_EDITS + shift,
                          .cell = (int)g->spheres.size,
                          .blocks = 1,
                          .rows = rows,
                          .count = p->count * (1 + p->beside)};
    snprintf(what, sizeof what, "%.60s, light %.40s, %ld samples a pixel",
             report_base_name(g->model_path), report_base_name(light->env), light->spp);
    hnbrdf_result result = render_sheet_compose(&sheet, &image, error);
    if (result)
        return result;
    size_t size = strlen(g->directory) + sizeof p->file + 8;
    char *path = malloc(size);
    if (path) {
        snprintf(path, size, "%s/%s.%s", g->directory, p->file, render_has_exr() ? "exr" : "png");
        result =
            report_write_told(&image, path, &(render_write_options){.half = 1, .comments = what},
                              &g->spheres.watch, error);
    } else {
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    }
    free(path);
    render_image_free(&image);
    return result;
}

static hnbrdf_result make_page(report_gallery *g, const page *p, hnbrdf_error *error)
{
    int count = p->count * (1 + p->beside), shift = 0;
    render_sheet_row *rows = calloc((size_t)count + 1, sizeof *rows);
    row_name *names = calloc((size_t)count + 1, sizeof *names);
    for (int s = 0; s < p->count; s++)
        shift |= measurement(g, p->materials[s]) != NULL;
    hnbrdf_result result = rows && names ? render_rows(g, p, shift, rows, names, error)
                                         : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    if (!result)
        result = write_page(g, p, shift, rows, error);
    for (int k = 0; k < count && rows; k++)
        for (int c = 0; c < RENDER_SHEET_COLUMNS; c++)
            render_image_free(&rows[k].cells[c].image);
    free(rows);
    free(names);
    return result;
}

/* ---- All of them ----------------------------------------------------------------------------- */

/* The page in gallery.md, with the commands that make the last sphere of each strip. */
static void describe_page(const report_gallery *g, const page *p, FILE *file)
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

static hnbrdf_result finish_page(report_gallery *g, const page *p, FILE *file, hnbrdf_error *error)
{
    hnbrdf_result result = p->count ? make_page(g, p, error) : HNBRDF_OK;
    if (!result && p->count)
        describe_page(g, p, file);
    return result;
}

static hnbrdf_result make_pages(report_gallery *g, page *p, FILE *file, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    fprintf(file,
            "# Gallery\n\nEdits and mixtures of `%s`, by `hnbrdf gallery` %s. Below each page "
            "stands what "
            "makes the last\nsphere of each of its strips.\n",
            g->model_path, hnbrdf_version());
    for (int k = 0; k < g->material_count && has_analytic(g) && !result; k++) {
        plan_edits(g, g->materials[k], p);
        result = finish_page(g, p, file, error);
    }
    if (!result && has_analytic(g)) {
        plan_anisotropy(g, p);
        result = finish_page(g, p, file, error);
    }
    if (!result)
        result = plan_mixes(g, p, error);
    if (!result)
        result = finish_page(g, p, file, error);
    return result;
}

static hnbrdf_result write_all(report_gallery *g, page *p, const char *path, hnbrdf_error *error)
{
    report_output output;
    hnbrdf_result result = report_output_open(path, &output, error);
    if (result)
        return result;
    g->spheres.count = work_of(g);
    result = make_pages(g, p, output.file, error);
    if (result)
        report_output_discard(&output);
    else
        result = report_output_close(&output, error);
    if (!result)
        report_tell(&g->spheres.watch, path);
    return result;
}

hnbrdf_result report_gallery_write(report_gallery *g, hnbrdf_error *error)
{
    size_t size = strlen(g->directory) + sizeof "/gallery.md";
    char *path = malloc(size);
    page *p = malloc(sizeof *p);
    hnbrdf_result result = HNBRDF_ERROR_MEMORY;
    if (path && p) {
        snprintf(path, size, "%s/gallery.md", g->directory);
        result = write_all(g, p, path, error);
    } else {
        hnbrdf_fail(error, result, "out of memory");
    }
    free(path);
    free(p);
    return result;
}
