/* grid_rows.c: the picture rows of `report images`: measurement, models and where they differ. */
#include "report/grid.h"

#include "base/error.h"
#include "image/difference.h"
#include "image/draw.h"
#include "image/sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Pixels of a sphere's side in a row: room for what stands below. */
enum { LEAST_CELL = 136, MOST_CELL = 192 };

/* ---- What is kept ---------------------------------------------------------------------------- */

int report_rows_has(const report *r, int m)
{
    int count = r->data.count, most = (int)r->rows;
    if (most >= count)
        return most > 0;
    /* Spread evenly over the materials. */
    return (long)(m + 1) * most / count > (long)m * most / count;
}

static char *row_path(const report *r, int m, const char *name)
{
    const char *material = hnbrdf_measured_name(r->data.items[m]);
    size_t size = strlen(r->directory) + strlen(material) + strlen(name) + sizeof "/pictures/-.exr";
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s/pictures/%s-%s.exr", r->directory, material, name);
    else
        hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    return path;
}

hnbrdf_result report_rows_keep(const report *r, int m, const char *name, const render_image *image)
{
    char *path = row_path(r, m, name);
    hnbrdf_result result =
        path ? render_image_write(image, path, NULL, r->error) : HNBRDF_ERROR_MEMORY;
    free(path);
    return result;
}

int report_rows_is_kept(const report *r, int m)
{
    char *path = row_path(r, m, "reference");
    int kept = !render_has_exr() || !report_rows_has(r, m) || (path && access(path, R_OK) == 0);
    free(path);
    return kept;
}

/* ---- One row --------------------------------------------------------------------------------- */

/* What the columns show: the measurement, the models, and their differences. */
typedef struct row_plan {
    const report_entry *entries[REPORT_FORMS];
    int count, size;
    char titles[RENDER_SHEET_COLUMNS][48];
} row_plan;

static row_plan make_plan(const report *r)
{
    static const report_form order[REPORT_FORMS] = {REPORT_HYBRID, REPORT_PAPER, REPORT_NEURAL,
                                                    REPORT_GGX};
    long size = r->image_size;
    row_plan plan = {.size = size < LEAST_CELL  ? LEAST_CELL
                             : size > MOST_CELL ? MOST_CELL
                                                : (int)size};
    for (int k = 0; k < REPORT_FORMS; k++) {
        const report_entry *e = report_find(r, order[k], r->nets[r->net_count - 1], r->latents[0]);
        if (e && e->pictures[0].done)
            plan.entries[plan.count++] = e;
    }
    snprintf(plan.titles[0], sizeof plan.titles[0], "reference");
    for (int k = 0; k < plan.count; k++) {
        const report_entry *e = plan.entries[k];
        const char *title = report_form_title(e->form);
        if (e->form == REPORT_GGX)
            snprintf(plan.titles[1 + k], sizeof plan.titles[0], "%s", title);
        else
            snprintf(plan.titles[1 + k], sizeof plan.titles[0], "%s l=%d", title, e->latent);
        snprintf(plan.titles[1 + plan.count + k], sizeof plan.titles[0], "%s, error",
                 e->form == REPORT_GGX ? "GGX" : title);
    }
    return plan;
}

static hnbrdf_result read_kept(const report *r, int m, const char *name, render_image *image)
{
    char *path = row_path(r, m, name);
    hnbrdf_result result =
        path ? render_image_read(path, NULL, image, r->error) : HNBRDF_ERROR_MEMORY;
    free(path);
    return result;
}

static hnbrdf_result resize(render_image *image, int size, double gain, hnbrdf_error *error)
{
    render_image small;
    hnbrdf_result result = render_resize(image, size, gain, &small, error);
    if (result != HNBRDF_OK)
        return result;
    render_image_free(image);
    *image = small;
    return HNBRDF_OK;
}

static hnbrdf_result fill_errors(const row_plan *plan, const render_image *reference,
                                 const render_image *models, render_sheet_row *row,
                                 hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    /* One scale for the row: that of its worst model. */
    double top = 0.0;
    for (int k = 0; k < plan->count; k++)
        top = fmax(top, render_difference_top(&models[k], reference));
    for (int k = 0; k < plan->count && result == HNBRDF_OK; k++) {
        render_sheet_cell *cell = &row->cells[1 + plan->count + k];
        result = render_difference_map(&models[k], reference, top, &cell->image, error);
        snprintf(cell->caption, sizeof cell->caption, "0 to %g", top);
        snprintf(cell->short_caption, sizeof cell->short_caption, "0 to %g", top);
        if (result == HNBRDF_OK)
            result = resize(&cell->image, plan->size, 1.0, error);
    }
    return result;
}

static hnbrdf_result fill_row(const report *r, const row_plan *plan, int m, double gain,
                              render_sheet_row *row)
{
    render_image pictures[1 + REPORT_FORMS] = {{0}};
    row->name = hnbrdf_measured_name(r->data.items[m]);
    hnbrdf_result code = read_kept(r, m, "reference", &pictures[0]);
    for (int k = 0; k < plan->count && code == HNBRDF_OK; k++)
        code = read_kept(r, m, plan->entries[k]->name, &pictures[1 + k]);
    if (code == HNBRDF_OK)
        code = fill_errors(plan, &pictures[0], pictures + 1, row, r->error);
    for (int k = 0; k <= plan->count && code == HNBRDF_OK; k++) {
        render_sheet_cell *cell = &row->cells[k];
        code = resize(&pictures[k], plan->size, gain, r->error);
        cell->image = pictures[k];
        pictures[k] = (render_image){0};
        if (k == 0)
            continue;
        const report_picture *p = &plan->entries[k - 1]->pictures[m];
        snprintf(cell->caption, sizeof cell->caption, "MAE %.4f  %.1f dB", p->mae, p->psnr);
        snprintf(cell->short_caption, sizeof cell->short_caption, "%.4f  %.1f dB", p->mae, p->psnr);
    }
    for (int k = 0; k <= plan->count; k++)
        render_image_free(&pictures[k]);
    return code;
}

/* ---- Pages ----------------------------------------------------------------------------------- */

static hnbrdf_result write_page(const report *r, const row_plan *plan, const render_sheet_row *rows,
                                int count, int page)
{
    render_image image;
    char what[160], light[160], name[64];
    render_sheet sheet = {.lines = {"Image error", what, light},
                          .columns = 1 + 2 * plan->count,
                          .cell = plan->size,
                          .blocks = 1,
                          .rows = rows,
                          .count = count};
    const int *net = r->nets[r->net_count - 1];
    snprintf(what, sizeof what,
             "networks of %dx%d; under each model its MAE in radiance and its PSNR (peak: the "
             "reference's largest value)",
             net[0], net[1]);
    snprintf(
        light, sizeof light,
        "errors: |difference|, mean of R, G and B; from dark, 0, to yellow, the number below it; "
        "%ld samples a pixel",
        r->light.spp);
    for (int c = 0; c < sheet.columns; c++)
        sheet.titles[c] = plan->titles[c];
    hnbrdf_result code = render_sheet_compose(&sheet, &image, r->error);
    if (code != HNBRDF_OK)
        return code;
    snprintf(name, sizeof name, "images-%d.exr", page);
    char *path = report_path_in(r, name);
    code = path ? report_picture_write(
                      &image, path, &(render_write_options){.half = 1, .comments = what}, r->error)
                : HNBRDF_ERROR_MEMORY;
    if (code == HNBRDF_OK)
        report_tell(&r->watch, path);
    free(path);
    render_image_free(&image);
    return code;
}

/* Pages behind the last one show what an earlier run had, which is not in this report. */
static void remove_pages(const report *r, int page)
{
    static const char *const ends[] = {"png", "exr"};
    for (int found = 1; found; page++) {
        found = 0;
        for (int k = 0; k < 2; k++) {
            char name[64];
            snprintf(name, sizeof name, "images-%d.%s", page, ends[k]);
            char *path = report_path_in(r, name);
            found |= path && remove(path) == 0;
            free(path);
        }
    }
}

hnbrdf_result report_rows_write(const report *r)
{
    row_plan plan = make_plan(r);
    hnbrdf_result code = HNBRDF_OK;
    int count = 0, page = 0, left = 0;
    double gain = exp2(r->light.exposure);
    for (int m = 0; m < r->data.count; m++)
        left += report_rows_has(r, m);
    render_sheet_row *rows = calloc(REPORT_ROWS_A_PAGE, sizeof *rows);
    if (!rows)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int m = 0; m < r->data.count && code == HNBRDF_OK; m++) {
        if (!report_rows_has(r, m))
            continue;
        code = fill_row(r, &plan, m, gain, &rows[count++]);
        left--;
        if (code == HNBRDF_OK && (count == REPORT_ROWS_A_PAGE || left == 0))
            code = write_page(r, &plan, rows, count, ++page);
        if (code != HNBRDF_OK || count == REPORT_ROWS_A_PAGE || left == 0) {
            for (int k = 0; k < count; k++)
                for (int c = 0; c < RENDER_SHEET_COLUMNS; c++)
                    render_image_free(&rows[k].cells[c].image);
            memset(rows, 0, REPORT_ROWS_A_PAGE * sizeof *rows);
            count = 0;
        }
    }
    free(rows);
    if (code == HNBRDF_OK)
        remove_pages(r, page + 1);
    return code;
}

hnbrdf_result report_interrupted(const report *r)
{
    return hnbrdf_fail(r->error, HNBRDF_ERROR_CANCELLED,
                       "%s: interrupted; what is finished is there, --resume goes on",
                       r->directory);
}
