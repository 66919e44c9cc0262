/* sheet.h: a contact sheet: spheres of measured materials beside GGX alone and their models. */
#ifndef HNBRDF_REPORT_SHEET_H
#define HNBRDF_REPORT_SHEET_H

#include "image/sheet.h"
#include "report/spheres.h"

#include <stdio.h>

/* What a sphere shows. */
typedef enum report_sheet_kind {
    REPORT_SHEET_REFERENCE,
    REPORT_SHEET_GGX,
    REPORT_SHEET_MODEL,
    REPORT_SHEET_GGX_ERROR, /* 4 times the absolute difference to the reference */
    REPORT_SHEET_MODEL_ERROR,
    REPORT_SHEET_KINDS
} report_sheet_kind;

typedef struct report_sheet_material {
    const hnbrdf_measured *measured;
    int index, ggx_index; /* of the material in the models */
    hnbrdf_image_error errors[REPORT_SHEET_KINDS];
} report_sheet_material;

typedef struct report_sheet {
    /* To fill in. */
    const char *path, *ggx_path; /* of the model; of another one */
    const hnbrdf_model *model;
    const hnbrdf_model *ggx; /* whose analytic parts are shown as GGX alone; NULL: the model's */
    const int *chosen;       /* [chosen_count] materials of the model */
    int chosen_count;
    int named;      /* 1: a chosen material without a measurement is an error, else left out */
    int difference; /* 1: with the columns of errors */
    long columns;   /* cards beside each other; 0: for a page of about 3:2 */
    report_spheres spheres;

    /* Made by report_sheet_render(). */
    hnbrdf_model_desc desc;
    report_sheet_kind kinds[RENDER_SHEET_COLUMNS]; /* of the columns */
    int kind_count;
    report_sheet_material *materials;
    render_sheet_row *rows;
    int count;
} report_sheet;

/* Opens the light of sheet->spheres and renders all spheres. */
hnbrdf_result report_sheet_render(report_sheet *sheet, hnbrdf_error *error);
/* A line a material: MAE and PSNR. */
void report_sheet_print(const report_sheet *sheet, FILE *file);
/* Composes the page and writes it; the spheres are exposed by this, so once. Tells its paths. */
hnbrdf_result report_sheet_write(report_sheet *sheet, const char *path, hnbrdf_error *error);
/* Frees what was made, also after a failure. */
void report_sheet_free(report_sheet *sheet);

#endif
