/* rgl.c: read RGL .bsdf files (Dupuy and Jakob 2018), RGB editions: check every field, and build the
 * warp tables that rgl_eval.c looks up. */
#include "measured/rgl.h"
#include "measured/bytes.h"
#include "measured/format.h"
#include "measured/tensor_file.h"
#include "core/error.h"

#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;
static const double THETA_SLACK = 1e-4; /* real files end a few float roundings beyond pi/2 */

/* The fields of one file; those after rgb may be missing. */
typedef struct rgl_fields {
    const tensor *phi_i, *theta_i, *ndf, *sigma, *vndf, *luminance, *rgb;
    const tensor *jacobian;
} rgl_fields;

/* What reading one file needs at hand. */
typedef struct reader {
    const tensor_file *file;
    const char *label;
    hnbrdf_error *error;
} reader;

int hnbrdf_rgl_recognise(const unsigned char *bytes, size_t size)
{
    return hnbrdf_tensor_file_recognise(bytes, size);
}

/* ---- Fields and shapes --------------------------------------------------------------------------- */

static hnbrdf_result check_kind(const reader *r, const tensor *field, tensor_type type, int dims)
{
    if (field->type == type && field->dims == dims)
        return HNBRDF_OK;
    return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                       "%s: field \"%s\" is %s with %d axes, expected %s with %d", r->label,
                       field->shown, hnbrdf_tensor_type_name(field->type), field->dims,
                       hnbrdf_tensor_type_name(type), dims);
}

static hnbrdf_result find_fields(const reader *r, rgl_fields *fields)
{
    if (!hnbrdf_tensor_file_find(r->file, "rgb") && hnbrdf_tensor_file_find(r->file, "spectra"))
        return hnbrdf_fail(
            r->error, HNBRDF_ERROR_UNSUPPORTED,
            "%s: spectral RGL file (field \"spectra\"), expected the RGB edition (\"rgb\")", r->label);
    const struct {
        const char *name;
        const tensor **place;
        tensor_type type;
        int dims, optional;
    } wanted[] = {
        {"phi_i", &fields->phi_i, TENSOR_F32, 1, 0},
        {"theta_i", &fields->theta_i, TENSOR_F32, 1, 0},
        {"ndf", &fields->ndf, TENSOR_F32, 2, 0},
        {"sigma", &fields->sigma, TENSOR_F32, 2, 0},
        {"vndf", &fields->vndf, TENSOR_F32, 4, 0},
        {"luminance", &fields->luminance, TENSOR_F32, 4, 0},
        {"rgb", &fields->rgb, TENSOR_F32, 5, 0},
        {"jacobian", &fields->jacobian, TENSOR_U8, 1, 1},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        const tensor *field = hnbrdf_tensor_file_find(r->file, wanted[i].name);
        if (!field && !wanted[i].optional)
            return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                               "%s: no field \"%s\" among %zu, expected one in an RGL material",
                               r->label, wanted[i].name, r->file->count);
        hnbrdf_result result = field ? check_kind(r, field, wanted[i].type, wanted[i].dims) : HNBRDF_OK;
        if (result)
            return result;
        *wanted[i].place = field;
    }
    return HNBRDF_OK;
}

static hnbrdf_result check_axis(const reader *r, const tensor *field, int axis, size_t expected,
                                const char *why)
{
    if (field->shape[axis] == expected)
        return HNBRDF_OK;
    return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                       "%s: field \"%s\" has size %zu along axis %d, expected %zu (%s)", r->label,
                       field->shown, field->shape[axis], axis, expected, why);
}

static hnbrdf_result check_sides(const reader *r, const tensor *field)
{
    for (int axis = field->dims - 2; axis < field->dims; axis++)
        if (field->shape[axis] < 2)
            return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                               "%s: field \"%s\" has size %zu along axis %d, expected at least 2",
                               r->label, field->shown, field->shape[axis], axis);
    return HNBRDF_OK;
}

static hnbrdf_result check_shapes(const reader *r, const rgl_fields *fields)
{
    const tensor *grids[] = {fields->ndf, fields->sigma, fields->vndf, fields->luminance, fields->rgb};
    const tensor *luminance = fields->luminance, *rgb = fields->rgb;
    hnbrdf_result result = HNBRDF_OK;
    for (size_t i = 0; !result && i < sizeof grids / sizeof grids[0]; i++)
        result = check_sides(r, grids[i]);
    for (size_t i = 2; !result && i < sizeof grids / sizeof grids[0]; i++) {
        result = check_axis(r, grids[i], 0, fields->phi_i->count, "one a phi_i node");
        if (!result)
            result = check_axis(r, grids[i], 1, fields->theta_i->count, "one a theta_i node");
    }
    if (!result)
        result = check_axis(r, luminance, 3, luminance->shape[2], "square");
    if (!result)
        result = check_axis(r, rgb, 2, 3, "red, green, blue");
    if (!result)
        result = check_axis(r, rgb, 3, luminance->shape[2], "as luminance");
    if (!result)
        result = check_axis(r, rgb, 4, luminance->shape[2], "as luminance");
    return result;
}

/* ---- Values -------------------------------------------------------------------------------------- */

static float element(const tensor *field, size_t i)
{
    return le_float(field->data + 4 * i);
}

static hnbrdf_result bad_value(const reader *r, const tensor *field, size_t i, const char *found,
                               const char *expected)
{
    return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                       "%s: field \"%s\", element %zu of %zu is %s, expected %s", r->label,
                       field->shown, i, field->count, found, expected);
}

static hnbrdf_result out_of_memory(const reader *r, const tensor *field)
{
    return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY,
                       "%s: out of memory for field \"%s\" (%zu elements)", r->label, field->shown,
                       field->count);
}

static hnbrdf_result check_finite(const reader *r, const tensor *field)
{
    for (size_t i = 0; i < field->count; i++)
        if (!isfinite(element(field, i)))
            return bad_value(r, field, i, "not finite", "a finite number");
    return HNBRDF_OK;
}

static hnbrdf_result check_values(const reader *r, const rgl_fields *fields)
{
    const tensor *finite[] = {fields->phi_i, fields->theta_i, fields->ndf,      fields->sigma,
                              fields->vndf,  fields->rgb,     fields->luminance};
    for (size_t k = 0; k < sizeof finite / sizeof finite[0]; k++) {
        hnbrdf_result result = check_finite(r, finite[k]);
        if (result)
            return result;
    }
    for (size_t i = 0; i < fields->ndf->count; i++)
        if (element(fields->ndf, i) < 0.0f)
            return bad_value(r, fields->ndf, i, "negative", "a density");
    for (size_t i = 0; i < fields->sigma->count; i++)
        if (!(element(fields->sigma, i) > 0.0f))
            return bad_value(r, fields->sigma, i, "not positive", "an area");
    for (size_t i = 0; i < fields->vndf->count; i++)
        if (element(fields->vndf, i) < 0.0f)
            return bad_value(r, fields->vndf, i, "negative", "a density");
    return HNBRDF_OK;
}

/* Node positions, strictly increasing. */
static hnbrdf_result read_nodes(const reader *r, const tensor *field, double **nodes)
{
    *nodes = malloc(field->count * sizeof **nodes);
    if (!*nodes)
        return out_of_memory(r, field);
    for (size_t i = 0; i < field->count; i++) {
        (*nodes)[i] = (double)element(field, i);
        if (i > 0 && !((*nodes)[i] > (*nodes)[i - 1]))
            return bad_value(r, field, i, "not larger than the one before", "increasing nodes");
    }
    return HNBRDF_OK;
}

static hnbrdf_result read_grid(const reader *r, const tensor *field, rgl_grid *grid)
{
    grid->height = field->shape[0];
    grid->width = field->shape[1];
    grid->values = malloc(field->count * sizeof *grid->values);
    if (!grid->values)
        return out_of_memory(r, field);
    for (size_t i = 0; i < field->count; i++)
        grid->values[i] = element(field, i);
    return HNBRDF_OK;
}

/* ---- Building ------------------------------------------------------------------------------------ */

static hnbrdf_result read_directions(const reader *r, const rgl_fields *fields, rgl *material)
{
    material->phi_count = fields->phi_i->count;
    material->theta_count = fields->theta_i->count;
    hnbrdf_result result = read_nodes(r, fields->phi_i, &material->phi);
    if (!result)
        result = read_nodes(r, fields->theta_i, &material->theta);
    if (result)
        return result;
    size_t last = material->theta_count - 1;
    if (material->theta[0] < 0.0)
        return bad_value(r, fields->theta_i, 0, "negative", "angles in [0, pi/2]");
    if (material->theta[last] > PI / 2 + THETA_SLACK)
        return bad_value(r, fields->theta_i, last, "larger than pi/2", "angles in [0, pi/2]");

    material->isotropic = material->phi_count <= 2;
    material->reduction = 1;
    if (material->isotropic)
        return HNBRDF_OK;
    double turns = floor(2 * PI / (material->phi[material->phi_count - 1] - material->phi[0]) + 0.5);
    if (turns != 1.0 && turns != 2.0 && turns != 4.0)
        return hnbrdf_fail(
            r->error, HNBRDF_ERROR_UNSUPPORTED,
            "%s: field \"phi_i\" covers an unknown part of the circle, expected the whole, "
            "a half or a quarter",
            r->label);
    material->reduction = (int)turns;
    return HNBRDF_OK;
}

/* One slice of the density by the trapezoid rule, summed in double; returns its integral. */
static double sum_slice(const tensor *field, size_t slice, size_t width, size_t height, double *cells,
                        double *rows)
{
    double total = 0.0, previous = 0.0;
    for (size_t y = 0; y < height; y++) {
        size_t first = (slice * height + y) * width;
        double along = 0.0;
        cells[y * width] = 0.0;
        for (size_t x = 1; x < width; x++) {
            along += ((double)element(field, first + x - 1) + (double)element(field, first + x)) / 2;
            cells[y * width + x] = along;
        }
        if (y > 0)
            total += (previous + along) / 2;
        rows[y] = total;
        previous = along;
    }
    return total;
}

static hnbrdf_result fill_warp(const reader *r, const tensor *field, rgl *material, double *cells,
                               double *rows)
{
    size_t width = material->warp_width, height = material->warp_height;
    for (size_t slice = 0; slice < material->phi_count * material->theta_count; slice++) {
        double total = sum_slice(field, slice, width, height, cells, rows);
        if (!(total > 0.0))
            return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                               "%s: field \"%s\" is 0 all over slice %zu, expected a density", r->label,
                               field->shown, slice);
        rgl_node *nodes = material->nodes + slice * height * width;
        for (size_t i = 0; i < height * width; i++)
            nodes[i] = (rgl_node){(float)((double)element(field, slice * height * width + i) / total),
                                  (float)(cells[i] / total)};
        for (size_t y = 0; y < height; y++)
            material->rows[slice * height + y] =
                (rgl_row){(float)(cells[y * width + width - 1] / total), (float)(rows[y] / total)};
    }
    return HNBRDF_OK;
}

static hnbrdf_result build_warp(const reader *r, const tensor *field, rgl *material)
{
    size_t width = field->shape[3], height = field->shape[2];
    material->warp_width = width;
    material->warp_height = height;
    material->nodes = malloc(field->count * sizeof *material->nodes);
    material->rows = malloc(field->count / width * sizeof *material->rows);
    double *cells = malloc(width * height * sizeof *cells), *rows = malloc(height * sizeof *rows);
    hnbrdf_result result = material->nodes && material->rows && cells && rows
                               ? fill_warp(r, field, material, cells, rows)
                               : out_of_memory(r, field);
    free(cells);
    free(rows);
    return result;
}

/* From planes [slice][3][y][x] to pixels [slice][y][x][3]; counts the negative values. */
static hnbrdf_result read_colours(const reader *r, const tensor *field, rgl *material, size_t *negative)
{
    material->side = field->shape[3];
    material->rgb = malloc(field->count * sizeof *material->rgb);
    if (!material->rgb)
        return out_of_memory(r, field);
    size_t plane = material->side * material->side;
    for (size_t i = 0; i < field->count; i++) {
        size_t slice = i / (3 * plane), c = i / plane % 3, pixel = i % plane;
        float value = element(field, i);
        material->rgb[(slice * plane + pixel) * 3 + c] = value;
        *negative += value < 0.0f;
    }
    return HNBRDF_OK;
}

static int rows_equal(const rgl_grid *grid)
{
    for (size_t i = grid->width; i < grid->width * grid->height; i++)
        if (grid->values[i] != grid->values[i - grid->width])
            return 0;
    return 1;
}

static hnbrdf_result build(const reader *r, rgl *material, size_t *negative)
{
    rgl_fields fields;
    hnbrdf_result result = find_fields(r, &fields);
    if (!result)
        result = check_shapes(r, &fields);
    if (!result)
        result = check_values(r, &fields);
    if (!result)
        result = read_directions(r, &fields, material);
    if (!result)
        result = read_grid(r, fields.ndf, &material->ndf);
    if (!result)
        result = read_grid(r, fields.sigma, &material->sigma);
    if (!result)
        result = build_warp(r, fields.vndf, material);
    if (!result)
        result = read_colours(r, fields.rgb, material, negative);
    if (!result) {
        material->jacobian = !fields.jacobian || fields.jacobian->data[0] != 0;
        material->needs_phi_i = material->phi_count > 1 || !rows_equal(&material->sigma);
    }
    return result;
}

static void release(void *data)
{
    rgl *material = data;
    if (!material)
        return;
    free(material->phi);
    free(material->theta);
    free(material->ndf.values);
    free(material->sigma.values);
    free(material->nodes);
    free(material->rows);
    free(material->rgb);
    free(material);
}

static void summarise(char summary[256], const rgl *material, size_t negative, unsigned minor)
{
    size_t values = material->phi_count * material->theta_count * material->side * material->side * 3;
    unsigned permille = (unsigned)((double)negative / (double)values * 1000.0);
    int n =
        snprintf(summary, 256,
                 "RGL %s RGB, %zu x %zu incident directions (phi_i, theta_i), %zu x %zu colours each, "
                 "%u.%u %% of them negative (clipped)",
                 material->isotropic ? "isotropic" : "anisotropic", material->phi_count,
                 material->theta_count, material->side, material->side, permille / 10, permille % 10);
    if (minor && n > 0 && n < 256)
        snprintf(summary + n, (size_t)(256 - n), ", file version 1.%u read as 1.0", minor);
}

hnbrdf_result hnbrdf_rgl_open(const unsigned char *bytes, size_t size, const char *label,
                              measured_body *body, hnbrdf_error *error)
{
    tensor_file file;
    hnbrdf_result result = hnbrdf_tensor_file_parse(bytes, size, label, &file, error);
    if (result)
        return result;
    reader r = {&file, label, error};
    size_t negative = 0;
    rgl *material = calloc(1, sizeof *material);
    result = material ? build(&r, material, &negative)
                      : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", label);
    if (result) {
        release(material);
    } else {
        body->data = material;
        body->eval = hnbrdf_rgl_eval;
        body->release = release;
        body->isotropic = !material->needs_phi_i;
        summarise(body->summary, material, negative, file.minor);
    }
    hnbrdf_tensor_file_free(&file);
    return result;
}
