/* sampling_strips.c: the noise to look at: spheres of some materials, drawn in every way with few
 * samples. */
#include "cli/sampling.h"

#include "image/draw.h"
#include "image/sheet.h"

#include <stdlib.h>
#include <string.h>

/* Columns of the sheet; guessed shares look like fitted lobes and are left to the numbers. */
static const int columns[] = {-1, SAMPLING_COSINE, SAMPLING_PAPER, SAMPLING_FITTED,
                              SAMPLING_TABULATED};
enum { COLUMNS = sizeof columns / sizeof columns[0], CELL = 160 };

static int fill_row(const sampling_report *r, const sampling_subject *s, int strip, char name[],
                    size_t size, render_sheet_row *row)
{
    hnbrdf_error error;
    int k = r->strips[strip];
    snprintf(name, size, "%s, %d samples", s->name, r->counts[k]);
    row->name = name;
    for (int c = 0; c < COLUMNS; c++) {
        const render_image *image = columns[c] < 0 ? &s->reference : &s->strips[strip][columns[c]];
        render_sheet_cell *cell = &row->cells[c];
        if (!image->rgb)
            continue;
        if (render_resize(image, CELL, exp2(r->light.exposure), &cell->image, &error) != HNBRDF_OK)
            return cli_fail("%s", error.text);
        if (columns[c] < 0) {
            snprintf(cell->caption, sizeof cell->caption, "%ld samples", r->light.spp);
        } else {
            double mse = s->runs[columns[c]].mse[k];
            snprintf(cell->caption, sizeof cell->caption, "MSE %.2g", mse);
        }
        memcpy(cell->short_caption, cell->caption, sizeof cell->short_caption - 1);
    }
    return CLI_OK;
}

static int compose(const sampling_report *r, const render_sheet_row *rows, int count)
{
    hnbrdf_error error;
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
    if (render_sheet_compose(&sheet, &image, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    size_t size = strlen(r->directory) + sizeof "/sampling-strips.exr";
    char *path = malloc(size);
    int code = path ? CLI_OK : cli_fail("out of memory");
    if (path) {
        snprintf(path, size, "%s/sampling-strips.%s", r->directory,
                 render_has_exr() ? "exr" : "png");
        code = picture_write(&image, path, &(render_write_options){.half = 1, .comments = what});
    }
    free(path);
    render_image_free(&image);
    return code;
}

int sampling_write_strips(const sampling_report *r)
{
    int count = 0, code = CLI_OK;
    render_sheet_row *rows = calloc((size_t)r->count * SAMPLING_STRIP_COUNTS, sizeof *rows);
    char(*names)[HNBRDF_MAX_NAME + 32] =
        calloc((size_t)r->count * SAMPLING_STRIP_COUNTS, sizeof *names);
    if (!rows || !names)
        code = cli_fail("out of memory");
    for (int m = 0; m < r->count && code == CLI_OK; m++)
        for (int n = 0; n < SAMPLING_STRIP_COUNTS && r->subjects[m].has_strip &&
                        r->subjects[m].done && code == CLI_OK;
             n++, count++)
            code = fill_row(r, &r->subjects[m], n, names[count], sizeof names[count], &rows[count]);
    if (code == CLI_OK && count > 0)
        code = compose(r, rows, count);
    for (int k = 0; k < count && rows; k++)
        for (int c = 0; c < COLUMNS; c++)
            render_image_free(&rows[k].cells[c].image);
    free(rows);
    free(names);
    return code;
}
