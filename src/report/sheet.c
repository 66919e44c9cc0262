/* sheet.c: a contact sheet: spheres of measured materials beside GGX alone and their models. */
#include "report/sheet.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float difference_gain = 4.0f;

/* ---- What is shown --------------------------------------------------------------------------- */

static int has_model(const report_sheet *s)
{
    return s->desc.kind != HNBRDF_KIND_GGX || s->ggx;
}

/* The model whose analytic part is shown as GGX alone; NULL: none. */
static const hnbrdf_model *ggx_model(const report_sheet *s)
{
    return s->ggx ? s->ggx : s->desc.kind != HNBRDF_KIND_NEURAL ? s->model : NULL;
}

static void choose_columns(report_sheet *s)
{
    s->kinds[s->kind_count++] = REPORT_SHEET_REFERENCE;
    if (ggx_model(s))
        s->kinds[s->kind_count++] = REPORT_SHEET_GGX;
    if (has_model(s))
        s->kinds[s->kind_count++] = REPORT_SHEET_MODEL;
    if (s->difference && ggx_model(s))
        s->kinds[s->kind_count++] = REPORT_SHEET_GGX_ERROR;
    if (s->difference && has_model(s))
        s->kinds[s->kind_count++] = REPORT_SHEET_MODEL_ERROR;
}

/* Adds the material if there is a measurement of it. */
static hnbrdf_result add_material(report_sheet *s, int index, hnbrdf_error *error)
{
    const char *name = hnbrdf_model_material_name(s->model, index);
    report_sheet_material *material = &s->materials[s->count];
    material->measured = report_spheres_find(&s->spheres, name);
    material->index = material->ggx_index = index;
    if (!material->measured && s->named)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s: none of the data has this name",
                           name);
    if (material->measured && s->ggx) {
        material->ggx_index = hnbrdf_model_find(s->ggx, name);
        if (material->ggx_index < 0)
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s: has no material %s", s->ggx_path,
                               name);
    }
    s->count += material->measured != NULL;
    return HNBRDF_OK;
}

static hnbrdf_result choose_materials(report_sheet *s, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    s->materials = calloc((size_t)s->chosen_count, sizeof *s->materials);
    s->rows = calloc((size_t)s->chosen_count, sizeof *s->rows);
    if (!s->materials || !s->rows)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int i = 0; i < s->chosen_count && !result; i++)
        result = add_material(s, s->chosen[i], error);
    if (!result && s->count == 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "%s: none of its materials is among the data", s->path);
    return result;
}

/* ---- One material ---------------------------------------------------------------------------- */

/* All surfaces of a row draw the same directions, which suit all of them. */
static void make_surfaces(const report_sheet *s, const report_sheet_material *m,
                          render_surface surfaces[REPORT_SHEET_KINDS])
{
    const hnbrdf_model *ggx = ggx_model(s);
    surfaces[REPORT_SHEET_REFERENCE] = render_surface_measured(m->measured);
    surfaces[REPORT_SHEET_MODEL] =
        render_surface_model(s->model, hnbrdf_model_material(s->model, m->index));
    /* The model again unless there is something to show. */
    surfaces[REPORT_SHEET_GGX] = surfaces[REPORT_SHEET_MODEL];
    if (ggx)
        surfaces[REPORT_SHEET_GGX] =
            render_surface_analytic(ggx, hnbrdf_model_material(ggx, m->ggx_index));
    const render_surface *all[] = {&surfaces[REPORT_SHEET_REFERENCE], &surfaces[REPORT_SHEET_GGX],
                                   &surfaces[REPORT_SHEET_MODEL]};
    render_guide guide = render_guide_fit(all, 3, s->spheres.guide);
    for (int kind = REPORT_SHEET_REFERENCE; kind <= REPORT_SHEET_MODEL; kind++)
        render_surface_guide(&surfaces[kind], &guide);
}

static void write_captions(const hnbrdf_image_error *error, render_sheet_cell *cell)
{
    if (isinf(error->psnr))
        snprintf(cell->short_caption, sizeof cell->short_caption, "equal");
    else
        snprintf(cell->short_caption, sizeof cell->short_caption, "%.1f dB", error->psnr);
    snprintf(cell->caption, sizeof cell->caption, "MAE %.4f  %s", error->mae, cell->short_caption);
}

static hnbrdf_result make_difference(const render_image *a, const render_image *reference,
                                     render_image *out, hnbrdf_error *error)
{
    hnbrdf_result result = render_image_create(a->width, a->height, 1, out, error);
    if (result)
        return result;
    size_t pixels = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < 3 * pixels; i++)
        out->rgb[i] = difference_gain * fabsf(a->rgb[i] - reference->rgb[i]);
    memcpy(out->alpha, a->alpha, pixels * sizeof(float));
    return HNBRDF_OK;
}

/* Fills one cell; the columns to its left, of which it may need the pictures, are done. */
static hnbrdf_result fill_cell(report_sheet *s, report_sheet_material *m,
                               const render_surface *surfaces,
                               render_sheet_cell *const cells[REPORT_SHEET_KINDS],
                               report_sheet_kind kind, hnbrdf_error *error)
{
    render_sheet_cell *cell = cells[kind];
    const render_image *reference = &cells[REPORT_SHEET_REFERENCE]->image;
    if (kind == REPORT_SHEET_GGX_ERROR)
        return make_difference(&cells[REPORT_SHEET_GGX]->image, reference, &cell->image, error);
    if (kind == REPORT_SHEET_MODEL_ERROR)
        return make_difference(&cells[REPORT_SHEET_MODEL]->image, reference, &cell->image, error);
    hnbrdf_result result = report_spheres_render(&s->spheres, &surfaces[kind], &cell->image, error);
    if (result)
        return result;
    s->spheres.first++;
    if (kind != REPORT_SHEET_REFERENCE) {
        result = report_picture_compare(&cell->image, reference, &m->errors[kind], error);
        if (!result)
            write_captions(&m->errors[kind], cell);
    }
    return result;
}

static hnbrdf_result fill_row(report_sheet *s, report_sheet_material *m, render_sheet_row *row,
                              hnbrdf_error *error)
{
    render_surface surfaces[REPORT_SHEET_KINDS];
    render_sheet_cell *cells[REPORT_SHEET_KINDS] = {NULL};
    hnbrdf_result result = HNBRDF_OK;
    row->name = s->spheres.detail = hnbrdf_measured_name(m->measured);
    make_surfaces(s, m, surfaces);
    for (int c = 0; c < s->kind_count && !result; c++) {
        cells[s->kinds[c]] = &row->cells[c];
        result = fill_cell(s, m, surfaces, cells, s->kinds[c], error);
    }
    return result;
}

hnbrdf_result report_sheet_render(report_sheet *s, hnbrdf_error *error)
{
    hnbrdf_model_describe(s->model, &s->desc);
    choose_columns(s);
    hnbrdf_result result = choose_materials(s, error);
    if (!result)
        result = report_spheres_open(&s->spheres, error);
    if (result)
        return result;
    int differences = s->kinds[s->kind_count - 1] > REPORT_SHEET_MODEL;
    s->spheres.count = s->count * (differences ? (s->kind_count + 1) / 2 : s->kind_count);
    for (int i = 0; i < s->count && !result; i++)
        result = fill_row(s, &s->materials[i], &s->rows[i], error);
    return result;
}

/* ---- The page -------------------------------------------------------------------------------- */

static void expose(report_sheet *s)
{
    float gain = (float)exp2(s->spheres.light.exposure);
    for (int i = 0; i < s->count; i++)
        for (int c = 0; c < s->kind_count; c++) {
            render_image *image = &s->rows[i].cells[c].image;
            size_t values = 3 * (size_t)image->width * (size_t)image->height;
            for (size_t k = 0; k < values; k++)
                image->rgb[k] *= gain;
        }
}

/* 1 for the columns with an error under each sphere. */
static int has_error(report_sheet_kind kind)
{
    return kind == REPORT_SHEET_GGX || kind == REPORT_SHEET_MODEL;
}

void report_sheet_print(const report_sheet *s, FILE *file)
{
    fprintf(file, "%-32s", "material");
    for (int c = 0; c < s->kind_count; c++)
        if (has_error(s->kinds[c]))
            fprintf(file, "  %s",
                    s->kinds[c] == REPORT_SHEET_GGX ? "  MAE GGX     PSNR" : "MAE model     PSNR");
    fprintf(file, "\n");
    for (int i = 0; i < s->count; i++) {
        fprintf(file, "%-32s", s->rows[i].name);
        for (int c = 0; c < s->kind_count; c++) {
            const hnbrdf_image_error *error = &s->materials[i].errors[s->kinds[c]];
            if (has_error(s->kinds[c]))
                fprintf(file, "  %9.5f  %7.2f", error->mae, error->psnr);
        }
        fprintf(file, "\n");
    }
}

static double mean_psnr(const report_sheet *s, report_sheet_kind kind)
{
    double mean = 0.0;
    for (int i = 0; i < s->count; i++)
        mean += s->materials[i].errors[kind].psnr / s->count;
    return mean;
}

/* "mean PSNR of GGX 28.1 dB, model 37.4 dB; light sky, 32 samples a pixel". */
static void describe_light(const report_sheet *s, char *text, size_t size)
{
    int length = snprintf(text, size, "mean PSNR of");
    for (int c = 1; c < s->kind_count && s->kinds[c] <= REPORT_SHEET_MODEL; c++)
        length +=
            snprintf(text + length, size - (size_t)length, "%s %s %.1f dB", c > 1 ? "," : "",
                     s->kinds[c] == REPORT_SHEET_GGX ? "GGX" : "model", mean_psnr(s, s->kinds[c]));
    snprintf(text + length, size - (size_t)length, "; light %.60s, %ld samples a pixel",
             report_base_name(s->spheres.light.env), s->spheres.light.spp);
}

hnbrdf_result report_sheet_write(report_sheet *s, const char *path, hnbrdf_error *error)
{
    char kind[96], what[192], light[192], ggx_error[32], model_error[32];
    const char *titles[REPORT_SHEET_KINDS] = {"reference", "GGX alone", kind, ggx_error,
                                              model_error};
    render_sheet sheet = {.lines = {report_base_name(s->path), what, light},
                          .columns = s->kind_count,
                          .cell = (int)s->spheres.size,
                          .blocks = (int)s->columns,
                          .rows = s->rows,
                          .count = s->count};
    expose(s);
    snprintf(kind, sizeof kind, "%s", hnbrdf_kind_name(s->desc.kind));
    snprintf(what, sizeof what, "%s", kind);
    if (s->desc.kind != HNBRDF_KIND_GGX) {
        snprintf(kind, sizeof kind, "%s %dx%d", hnbrdf_kind_name(s->desc.kind), s->desc.hidden,
                 s->desc.layers);
        snprintf(what, sizeof what, "%s, %s encoding, %zu weights for %d materials", kind,
                 hnbrdf_encoding_name(s->desc.encoding), hnbrdf_model_weight_count(s->model),
                 hnbrdf_model_material_count(s->model));
    }
    describe_light(s, light, sizeof light);
    snprintf(ggx_error, sizeof ggx_error, "GGX error \xc3\x97 %g", (double)difference_gain);
    snprintf(model_error, sizeof model_error, "%s error \xc3\x97 %g",
             hnbrdf_kind_name(s->desc.kind), (double)difference_gain);
    for (int c = 0; c < s->kind_count; c++)
        sheet.titles[c] = titles[s->kinds[c]];

    render_image image;
    hnbrdf_result result = render_sheet_compose(&sheet, &image, error);
    if (result)
        return result;
    const render_write_options options = {.half = 1, .comments = what};
    result = report_write_told(&image, path, &options, &s->spheres.watch, error);
    render_image_free(&image);
    return result;
}

void report_sheet_free(report_sheet *s)
{
    for (int i = 0; i < s->count && s->rows; i++)
        for (int c = 0; c < RENDER_SHEET_COLUMNS; c++)
            render_image_free(&s->rows[i].cells[c].image);
    free(s->rows);
    free(s->materials);
    s->rows = NULL;
    s->materials = NULL;
    report_spheres_close(&s->spheres);
}
