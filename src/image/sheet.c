/* sheet.c: where everything stands on a contact sheet. */
#include "image/sheet.h"

#include "image/draw.h"
#include "image/label.h"

#include <math.h>
#include <stdio.h>

static const float page_colour[3] = {0.016f, 0.017f, 0.019f},
                   card_colour[3] = {0.040f, 0.042f, 0.046f};
static const float bright[3] = {0.80f, 0.80f, 0.80f}, plain[3] = {0.50f, 0.50f, 0.52f},
                   dim[3] = {0.26f, 0.27f, 0.29f};

/* All in pixels, from the cell's side alone, but for the counts and the page. */
typedef struct layout {
    int text, name_text, title_text; /* heights of small letters */
    int pad, margin, gap;            /* inside a card; around the page; between cards */
    int header, titles;              /* heights of what stands above the cards */
    int name_line, caption_line;     /* heights above and below a card's cells */
    int card_width, card_height, blocks, lines;
    int width, height; /* of the page */
} layout;

static int rounded(double x)
{
    return (int)floor(x + 0.5);
}

static void set_blocks(layout *l, int count, int blocks)
{
    l->blocks = blocks;
    l->lines = (count + blocks - 1) / blocks;
    l->width = 2 * l->margin + blocks * l->card_width + (blocks - 1) * l->gap;
    l->height =
        2 * l->margin + l->header + l->titles + l->lines * l->card_height + (l->lines - 1) * l->gap;
}

static layout lay_out(const render_sheet *sheet)
{
    layout l = {0};
    double text = sheet->cell * 7.0 / 160.0;
    l.text = rounded(fmin(14.0, fmax(6.0, text)));
    l.name_text = l.text + 1;
    l.title_text = rounded(l.text * 1.5);
    l.pad = rounded(fmax(6.0, sheet->cell * 0.07));
    l.margin = 2 * l.pad;
    l.gap = l.pad;
    for (int i = 0; i < RENDER_SHEET_LINES; i++)
        if (sheet->lines[i])
            l.header += i == 0 ? rounded(2.6 * l.title_text) : rounded(2.6 * l.text);
    for (int c = 0; c < sheet->columns; c++)
        if (sheet->titles[c])
            l.titles = rounded(4.2 * l.text);
    l.name_line = rounded(2.0 * l.name_text) + l.pad;
    l.caption_line = rounded(2.0 * l.text);
    l.card_width = sheet->columns * (sheet->cell + l.pad) + l.pad;
    l.card_height = l.pad + l.name_line + sheet->cell + l.caption_line + l.pad;
    int best = 1;
    double nearest = INFINITY;
    for (int blocks = 1; blocks <= sheet->count && sheet->blocks == 0; blocks++) {
        set_blocks(&l, sheet->count, blocks);
        double off = fabs(log((double)l.width / l.height / 1.5));
        if (off < nearest) {
            nearest = off;
            best = blocks;
        }
    }
    if (sheet->blocks > 0)
        best = sheet->blocks < sheet->count ? sheet->blocks : sheet->count;
    set_blocks(&l, sheet->count, best);
    return l;
}

/* Centred on a cell that begins at x, and never wider than cells are apart. */
static void draw_label(render_image *image, const render_sheet *sheet, const layout *l, int x,
                       int y, const char *label, const float colour[3])
{
    char text[64];
    render_text_shorten(label, l->text, sheet->cell + l->pad - 2.0, text, sizeof text);
    render_text_at(image, x + 0.5 * sheet->cell, y, 0.5, text, l->text, colour);
}

static void draw_header(const render_sheet *sheet, const layout *l, render_image *image)
{
    int y = l->margin;
    for (int i = 0; i < RENDER_SHEET_LINES; i++) {
        if (!sheet->lines[i])
            continue;
        int size = i == 0 ? l->title_text : l->text;
        char text[256];
        render_text_shorten(sheet->lines[i], size, l->width - 2 * l->margin, text, sizeof text);
        render_text(image, l->margin, y + rounded(1.4 * size), text, size, i == 0 ? bright : plain);
        y += rounded(2.6 * size);
    }
    int baseline = l->margin + l->header + rounded(2.8 * l->text);
    for (int block = 0; block < l->blocks; block++)
        for (int c = 0; c < sheet->columns; c++) {
            int x =
                l->margin + block * (l->card_width + l->gap) + l->pad + c * (sheet->cell + l->pad);
            if (sheet->titles[c])
                draw_label(image, sheet, l, x, baseline, sheet->titles[c], plain);
        }
}

static void draw_card(const render_sheet *sheet, const layout *l, const render_sheet_row *row,
                      int x, int y, render_image *image)
{
    char name[256];
    render_fill(image, x, y, l->card_width, l->card_height, card_colour);
    render_text_shorten(row->name, l->name_text, l->card_width - 2 * l->pad, name, sizeof name);
    render_text(image, x + l->pad, y + l->pad + rounded(1.4 * l->name_text), name, l->name_text,
                bright);
    int top = y + l->pad + l->name_line;
    for (int c = 0; c < sheet->columns; c++) {
        const render_sheet_cell *cell = &row->cells[c];
        int left = x + l->pad + c * (sheet->cell + l->pad);
        if (cell->image.rgb)
            render_paste(image, left, top, &cell->image);
        int fits = render_text_width(cell->caption, l->text) <= sheet->cell + l->pad;
        draw_label(image, sheet, l, left, top + sheet->cell + rounded(1.7 * l->text),
                   fits ? cell->caption : cell->short_caption, cell->image.rgb ? plain : dim);
    }
}

hnbrdf_result render_sheet_compose(const render_sheet *sheet, render_image *image,
                                   hnbrdf_error *error)
{
    layout l = lay_out(sheet);
    hnbrdf_result result = render_image_create(l.width, l.height, 0, image, error);
    if (result != HNBRDF_OK)
        return result;
    render_fill(image, 0, 0, l.width, l.height, page_colour);
    draw_header(sheet, &l, image);
    for (int i = 0; i < sheet->count; i++) {
        int block = i / l.lines, line = i % l.lines;
        int x = l.margin + block * (l.card_width + l.gap);
        int y = l.margin + l.header + l.titles + line * (l.card_height + l.gap);
        draw_card(sheet, &l, &sheet->rows[i], x, y, image);
    }
    return HNBRDF_OK;
}
