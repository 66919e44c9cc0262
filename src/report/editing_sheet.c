/* editing_sheet.c: spheres to look at: the truth after an edit, the edited material, and its GGX
 * part alone. */
#include "report/editing.h"

#include "base/error.h"
#include "image/sheet.h"
#include "report/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 3 };

/* The members of the middle alpha, each with two edits of alpha, and with one of every other
 * kind. */
static int is_shown(const editing_member *m, int edit, int others)
{
    const editing_edit *e = &editing_edits[edit];
    if (m->alpha != editing_alphas[EDITING_ALPHAS / 2] || others == (e->kind == EDITING_ALPHA))
        return 0;
    switch (e->kind) {
    case EDITING_ALPHA:
        return e->factor == 0.5 || e->factor == 3.0;
    case EDITING_ETA:
    case EDITING_ANISOTROPY:
        return e->factor == 2.0;
    case EDITING_KD:
        return e->factor == 0.5;
    default:
        return 1;
    }
}

static hnbrdf_result fill_row(editing_report *r, const editing_member *m, const editing_case *c,
                              render_sheet_row *row)
{
    const hnbrdf_model *network = r->models[m->model].model;
    const hnbrdf_material *edited = &c->materials[EDITING_EDITED];
    render_surface surfaces[COLUMNS] = {render_surface_measured(c->truth),
                                        render_surface_model(network, edited),
                                        render_surface_analytic(network, edited)};
    const render_surface *all[COLUMNS] = {&surfaces[0], &surfaces[1], &surfaces[2]};
    render_guide guide = render_guide_fit(all, COLUMNS, r->spheres.guide);
    hnbrdf_result result = HNBRDF_OK;
    row->name = hnbrdf_measured_name(c->truth);
    for (int k = 0; k < COLUMNS && !result; k++) {
        render_sheet_cell *cell = &row->cells[k];
        hnbrdf_image_error error;
        render_surface_guide(&surfaces[k], &guide);
        result = report_spheres_render(&r->spheres, &surfaces[k], &cell->image, r->error);
        if (!result && k > 0)
            result = report_picture_compare(&cell->image, &row->cells[0].image, &error, r->error);
        if (!result && k > 0)
            snprintf(cell->short_caption, sizeof cell->short_caption, "%.1f dB", error.psnr);
        memcpy(cell->caption, cell->short_caption, sizeof cell->short_caption);
    }
    return result == HNBRDF_ERROR_CANCELLED ? editing_interrupted(r) : result;
}

static void expose(const editing_report *r, render_sheet_row *rows, int count)
{
    float gain = (float)exp2(r->spheres.light.exposure);
    for (int k = 0; k < count * COLUMNS; k++) {
        render_image *image = &rows[k / COLUMNS].cells[k % COLUMNS].image;
        size_t values = 3 * (size_t)image->width * (size_t)image->height;
        for (size_t i = 0; i < values; i++)
            image->rgb[i] *= gain;
    }
}

static hnbrdf_result write_sheet(editing_report *r, render_sheet_row *rows, int count,
                                 const char *name)
{
    char what[200], file[48];
    render_image image;
    render_sheet sheet = {.lines = {"Edited materials", what},
                          .titles = {"truth", "edited", "GGX alone, edited"},
                          .columns = COLUMNS,
                          .cell = (int)r->sheet_size,
                          .rows = rows,
                          .count = count};
    snprintf(what, sizeof what,
             "the truth after the edit, the edited model, its analytic part; light %s, %ld samples "
             "a pixel; PSNR",
             report_base_name(r->light.env), r->light.spp);
    expose(r, rows, count);
    hnbrdf_result result = render_sheet_compose(&sheet, &image, r->error);
    if (result)
        return result;
    snprintf(file, sizeof file, "%s.%s", name, render_has_exr() ? "exr" : "png");
    char *path = report_path_join(r->directory, file, r->error);
    result =
        path ? report_write_told(&image, path, &(render_write_options){.half = 1, .comments = what},
                                 &r->watch, r->error)
             : HNBRDF_ERROR_MEMORY;
    free(path);
    render_image_free(&image);
    return result;
}

static hnbrdf_result make_sheet(editing_report *r, int others, const char *name)
{
    hnbrdf_result result = HNBRDF_OK;
    int count = 0;
    render_sheet_row *rows =
        calloc((size_t)r->count * (size_t)editing_edit_count + 1, sizeof *rows);
    if (!rows)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int m = 0; m < r->count && !result; m++)
        for (int k = 0; k < r->members[m].count && !result; k++)
            if (is_shown(&r->members[m], r->members[m].cases[k].edit, others))
                result = fill_row(r, &r->members[m], &r->members[m].cases[k], &rows[count++]);
    if (!result && count)
        result = write_sheet(r, rows, count, name);
    for (int k = 0; k < count * COLUMNS; k++)
        render_image_free(&rows[k / COLUMNS].cells[k % COLUMNS].image);
    free(rows);
    return result;
}

hnbrdf_result editing_write_sheets(editing_report *r)
{
    r->spheres.size = r->sheet_size;
    hnbrdf_result result = make_sheet(r, 0, "editing-alpha");
    return result ? result : make_sheet(r, 1, "editing-others");
}
