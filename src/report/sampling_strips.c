/* sampling_strips.c: the noise to look at: spheres of some materials, drawn in every way with few
 * samples. */
#include "report/sampling.h"

#include "base/error.h"
#include "image/draw.h"
#include "image/sheet.h"
#include "report/output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Columns of the sheet; guessed shares look like fitted lobes and are left to the numbers. */
static const int columns[] = {-1, SAMPLING_COSINE, SAMPLING_PAPER, SAMPLING_FITTED,
                              SAMPLING_TABULATED};
enum { COLUMNS = sizeof columns / sizeof columns[0], CELL = 160 };

static hnbrdf_result fill_row(const sampling_report *r, const sampling_subject *s, int strip,
                              char name[], size_t size, render_sheet_row *row)
{
    hnbrdf_result result = HNBRDF_OK;
    int k = r->strips[strip];
    snprintf(name, size, "%s, %d samples", s->name, r->counts[k]);
    row->name = name;
    for (int c = 0; c < COLUMNS && result == HNBRDF_OK; c++) {
        const render_image *image = columns[c] < 0 ? &s->reference : &s->strips[strip][columns[c]];
        render_sheet_cell *cell = &row->cells[c];
        if (!image->rgb)
            continue;
        result = render_resize(image, CELL, exp2(r->light.exposure), &cell->image, r->error);
        if (columns[c] < 0) {
            snprintf(cell->caption, sizeof cell->caption, "%ld samples", r->light.spp);
        } else {
            double mse = s->runs[columns[c]].mse[k];
            snprintf(cell->caption, sizeof cell->caption, "MSE %.2g", mse);
        }
        memcpy(cell->short_caption, cell->caption, sizeof cell->short_caption - 1);
    }
    return result;
}

static hnbrdf_result compose(const sampling_report *r, const render_sheet_row *rows, int count)
{
    render_image image;
    char what[200];
    render_sheet sheet = {.lines = {"Noise of sampling", what},
                          .titles = {"reference"},
                          .columns = COLUMNS,
                          .cell = CELL,
                          .blocks = 1,
                          .rows = rows,
                          .count = count};
    snprintf(what, sizeof what,
             "directions from the BRDF alone, under %s; MSE against the reference", r->light.env);
    for (int c = 1; c < COLUMNS; c++)
        sheet.titles[c] = sampling_title((sampling_way)columns[c]);
    hnbrdf_result code = render_sheet_compose(&sheet, &image, r->error);
    if (code != HNBRDF_OK)
        return code;
    char *path = report_path_join(
        r->directory, render_has_exr() ? "sampling-strips.exr" : "sampling-strips.png", r->error);
    if (!path)
        code = HNBRDF_ERROR_MEMORY;
    if (path) {
        code = report_picture_write(&image, path,
                                    &(render_write_options){.half = 1, .comments = what}, r->error);
        if (code == HNBRDF_OK)
            report_tell(&r->watch, path);
    }
    free(path);
    render_image_free(&image);
    return code;
}

hnbrdf_result sampling_write_strips(const sampling_report *r)
{
    hnbrdf_result code = HNBRDF_OK;
    int count = 0;
    render_sheet_row *rows = calloc((size_t)r->count * SAMPLING_STRIP_COUNTS, sizeof *rows);
    char(*names)[HNBRDF_MAX_NAME + 32] =
        calloc((size_t)r->count * SAMPLING_STRIP_COUNTS, sizeof *names);
    if (!rows || !names)
        code = hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int m = 0; m < r->count && code == HNBRDF_OK; m++)
        for (int n = 0; n < SAMPLING_STRIP_COUNTS && r->subjects[m].has_strip &&
                        r->subjects[m].done && code == HNBRDF_OK;
             n++, count++)
            code = fill_row(r, &r->subjects[m], n, names[count], sizeof names[count], &rows[count]);
    if (code == HNBRDF_OK && count > 0)
        code = compose(r, rows, count);
    for (int k = 0; k < count && rows; k++)
        for (int c = 0; c < COLUMNS; c++)
            render_image_free(&rows[k].cells[c].image);
    free(rows);
    free(names);
    return code;
}
