/* sheet.h: a contact sheet, one card a material with its spheres side by side. */
#ifndef HNBRDF_IMAGE_SHEET_H
#define HNBRDF_IMAGE_SHEET_H

#include "image/image.h"

enum { RENDER_SHEET_COLUMNS = 10, RENDER_SHEET_LINES = 3 };

typedef struct render_sheet_cell {
    /* cell x cell pixels, premultiplied, as it shall look; rgb NULL: empty */
    render_image image;
    char caption[48];       /* under it */
    char short_caption[24]; /* instead, where that one is too wide */
} render_sheet_cell;

typedef struct render_sheet_row {
    const char *name; /* shortened if it is wider than its card */
    render_sheet_cell cells[RENDER_SHEET_COLUMNS];
} render_sheet_row;

typedef struct render_sheet {
    const char *lines[RENDER_SHEET_LINES]; /* above everything, the first one larger; NULL: none */
    const char *titles[RENDER_SHEET_COLUMNS]; /* above the cards, by column; NULL: none */
    int columns;                              /* cells in a row */
    int cell;                                 /* pixels of a cell's side */
    int blocks; /* cards beside each other; 0: chosen for a picture of about 3:2 */
    const render_sheet_row *rows;
    int count;
} render_sheet;

/* Linear, opaque. Text and margins grow with the cells. */
hnbrdf_result render_sheet_compose(const render_sheet *sheet, render_image *image,
                                   hnbrdf_error *error);

#endif
