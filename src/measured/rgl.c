/* rgl.c: read RGL .bsdf files (Dupuy and Jakob 2018), RGB and spectral: check every field, and
 * build the tables that rgl_eval.c looks up. */
#include "measured/rgl.h"
#include "base/bytes.h"
#include "measured/cie.h"
#include "measured/format.h"
#include "measured/tensor_file.h"
#include "base/error.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;
static const double THETA_SLACK = 1e-4; /* real files end a few float roundings beyond pi/2 */

/* The fields of one file; the last two may be missing. */
typedef struct rgl_fields {
    const tensor *phi_i, *theta_i, *ndf, *sigma, *vndf, *luminance;
    const tensor *colours; /* "rgb" or "spectra" */
    const tensor *wavelengths, *jacobian;
} rgl_fields;

/* What reading one file needs at hand. */
typedef struct reader {
    const tensor_file *file;
    const hnbrdf_measured_options *options;
    const char *label;
    hnbrdf_error *error;
} reader;

/* ---- Fields and shapes ----------------------------------------------------------------------- */

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
    int has_rgb = hnbrdf_tensor_file_find(r->file, "rgb") != NULL;
    int has_spectra = hnbrdf_tensor_file_find(r->file, "spectra") != NULL;
    int spectral = has_spectra && (r->options->rgl_spectra || !has_rgb);
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
        {spectral ? "spectra" : "rgb", &fields->colours, TENSOR_F32, 5, 0},
        {spectral ? "wavelengths" : NULL, &fields->wavelengths, TENSOR_F32, 1, !spectral},
        {"jacobian", &fields->jacobian, TENSOR_U8, 1, 1},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        const char *name = wanted[i].name;
        const tensor *field = name ? hnbrdf_tensor_file_find(r->file, name) : NULL;
        if (!field && !wanted[i].optional)
            return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                               "%s: no field \"%s\" among %zu, expected one in an RGL material",
                               r->label, name, r->file->count);
        hnbrdf_result result =
            field ? check_kind(r, field, wanted[i].type, wanted[i].dims) : HNBRDF_OK;
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
    const tensor *luminance = fields->luminance, *colours = fields->colours;
    const tensor *grids[] = {fields->ndf, fields->sigma, fields->vndf, luminance, colours};
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
        result = fields->wavelengths
                     ? check_axis(r, colours, 2, fields->wavelengths->count, "one a wavelength")
                     : check_axis(r, colours, 2, 3, "red, green, blue");
    if (!result)
        result = check_axis(r, colours, 3, luminance->shape[2], "as luminance");
    if (!result)
        result = check_axis(r, colours, 4, luminance->shape[2], "as luminance");
    return result;
}

/* ---- Values ---------------------------------------------------------------------------------- */

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
    const tensor *finite[] = {fields->phi_i,     fields->theta_i,    fields->ndf,
                              fields->sigma,     fields->vndf,       fields->colours,
                              fields->luminance, fields->wavelengths};
    for (size_t k = 0; k < sizeof finite / sizeof finite[0]; k++) {
        hnbrdf_result result = finite[k] ? check_finite(r, finite[k]) : HNBRDF_OK;
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

/* ---- Building -------------------------------------------------------------------------------- */

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
    double turns =
        floor(2 * PI / (material->phi[material->phi_count - 1] - material->phi[0]) + 0.5);
    if (turns != 1.0 && turns != 2.0 && turns != 4.0)
        return hnbrdf_fail(
            r->error, HNBRDF_ERROR_UNSUPPORTED,
            "%s: field \"phi_i\" covers an unknown part of the circle, expected the whole, "
            "a half or a quarter",
            r->label);
    material->reduction = (int)turns;
    return HNBRDF_OK;
}

static hnbrdf_result fill_warp(const reader *r, const tensor *field, rgl *material, float *density)
{
    const size_t size = material->warp_width * material->warp_height;
    for (size_t slice = 0; slice < material->phi_count * material->theta_count; slice++) {
        for (size_t i = 0; i < size; i++)
            density[i] = element(field, slice * size + i);
        if (!hnbrdf_rgl_warp(material, slice, density))
            return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                               "%s: field \"%s\" is 0 all over slice %zu, expected a density",
                               r->label, field->shown, slice);
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
    float *density = malloc(width * height * sizeof *density);
    hnbrdf_result result = material->nodes && material->rows && density
                               ? fill_warp(r, field, material, density)
                               : out_of_memory(r, field);
    free(density);
    return result;
}

/* From planes [slice][3][y][x] to pixels [slice][y][x][3]; counts the negative values. */
static void read_rgb(const tensor *field, rgl *material, size_t *negative)
{
    size_t plane = material->side * material->side;
    for (size_t i = 0; i < field->count; i++) {
        size_t slice = i / (3 * plane), c = i / plane % 3, pixel = i % plane;
        float value = element(field, i);
        material->rgb[(slice * plane + pixel) * 3 + c] = value;
        *negative += value < 0.0f;
    }
}

/* From planes [slice][wavelength][y][x] to linear sRGB pixels, and to spectra where they are
 * kept. One slice is summed at a time, in double. */
static void read_spectra(const tensor *field, rgl *material, double (*weights)[3], double *sum,
                         size_t *negative)
{
    size_t plane = material->side * material->side, channels = material->wavelength_count;
    for (size_t slice = 0; slice < material->phi_count * material->theta_count; slice++) {
        memset(sum, 0, 3 * plane * sizeof *sum);
        for (size_t i = 0; i < channels * plane; i++) {
            size_t l = i / plane, pixel = i % plane;
            float value = element(field, slice * channels * plane + i);
            for (size_t c = 0; c < 3; c++)
                sum[3 * pixel + c] += weights[l][c] * (double)value;
            if (material->spectra)
                material->spectra[(slice * plane + pixel) * channels + l] = value;
        }
        for (size_t i = 0; i < 3 * plane; i++) {
            double limit = (double)HNBRDF_MAX_VALUE;
            material->rgb[slice * 3 * plane + i] = (float)fmax(-limit, fmin(sum[i], limit));
            *negative += sum[i] < 0.0;
        }
    }
}

static hnbrdf_result convert_spectra(const reader *r, const rgl_fields *fields, rgl *material,
                                     size_t *negative)
{
    size_t count = fields->wavelengths->count;
    material->wavelength_count = count;
    material->wavelengths = malloc(count * sizeof *material->wavelengths);
    if (!material->wavelengths)
        return out_of_memory(r, fields->wavelengths);
    for (size_t l = 0; l < count; l++) {
        material->wavelengths[l] = element(fields->wavelengths, l);
        if (l > 0 && !(material->wavelengths[l] > material->wavelengths[l - 1]))
            return bad_value(r, fields->wavelengths, l, "not larger than the one before",
                             "increasing wavelengths");
    }
    if (r->options->rgl_spectra) {
        material->spectra = malloc(fields->colours->count * sizeof *material->spectra);
        if (!material->spectra)
            return out_of_memory(r, fields->colours);
    }
    double(*weights)[3] = calloc(count, sizeof *weights);
    double *sum = calloc(3 * material->side * material->side, sizeof *sum);
    if (weights && sum) {
        hnbrdf_cie_weights(material->wavelengths, count, weights);
        read_spectra(fields->colours, material, weights, sum, negative);
    }
    hnbrdf_result result = weights && sum ? HNBRDF_OK : out_of_memory(r, fields->colours);
    free(weights);
    free(sum);
    return result;
}

static hnbrdf_result read_colours(const reader *r, const rgl_fields *fields, rgl *material,
                                  size_t *negative)
{
    const tensor *field = fields->colours;
    material->side = field->shape[3];
    material->rgb = malloc(field->count / field->shape[2] * 3 * sizeof *material->rgb);
    if (!material->rgb)
        return out_of_memory(r, field);
    if (fields->wavelengths)
        return convert_spectra(r, fields, material, negative);
    read_rgb(field, material, negative);
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
        result = read_colours(r, &fields, material, negative);
    if (!result) {
        material->jacobian = !fields.jacobian || fields.jacobian->data[0] != 0;
        material->needs_phi_i = material->phi_count > 1 || !rows_equal(&material->sigma);
    }
    return result;
}

/* For people; what is no wavelength at all is cut. */
static int nearest_nm(float nm)
{
    return nm >= 0.0f && nm < 1e6f ? (int)(nm + 0.5f) : -1;
}

static void summarise(char summary[256], const rgl *material,
                      const hnbrdf_measured_options *options, size_t negative, unsigned minor)
{
    size_t values =
        material->phi_count * material->theta_count * material->side * material->side * 3;
    unsigned permille = (unsigned)((double)negative / (double)values * 1000.0);
    char kind[96] = "RGB";
    if (material->wavelengths)
        snprintf(kind, sizeof kind, "spectral (%zu wavelengths, %d to %d nm, made sRGB)",
                 material->wavelength_count, nearest_nm(material->wavelengths[0]),
                 nearest_nm(material->wavelengths[material->wavelength_count - 1]));
    int n = snprintf(
        summary, 256,
        "RGL %s %s, %zu x %zu incident directions (phi_i, theta_i), %zu x %zu colours each, "
        "%u.%u %% of them negative (%s)",
        material->isotropic ? "isotropic" : "anisotropic", kind, material->phi_count,
        material->theta_count, material->side, material->side, permille / 10, permille % 10,
        options->rgl_signed ? "kept" : "clipped");
    if (material->reduction > 1 && n > 0 && n < 256)
        n += snprintf(summary + n, (size_t)(256 - n), ", 1/%d of the circle", material->reduction);
    if (minor && n > 0 && n < 256)
        snprintf(summary + n, (size_t)(256 - n), ", file version 1.%u read as 1.0", minor);
}

static hnbrdf_result rgl_open(const measured_file *source, const hnbrdf_measured_options *options,
                              measured_body *body, hnbrdf_error *error)
{
    const char *label = source->label;
    tensor_file file;
    hnbrdf_result result =
        hnbrdf_tensor_file_parse(source->bytes, source->size, label, &file, error);
    if (result)
        return result;
    reader r = {&file, options, label, error};
    size_t negative = 0;
    rgl *material = calloc(1, sizeof *material);
    result = material ? build(&r, material, &negative)
                      : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", label);
    if (result) {
        hnbrdf_rgl_release(material);
    } else {
        body->data = material;
        body->eval = hnbrdf_rgl_eval;
        body->release = hnbrdf_rgl_release;
        body->isotropic = !material->needs_phi_i;
        body->is_signed = options->rgl_signed;
        if (material->spectra) {
            body->wavelength_count = material->wavelength_count;
            body->wavelengths = material->wavelengths;
            body->eval_spectrum = hnbrdf_rgl_eval_spectrum;
        }
        summarise(body->summary, material, options, negative, file.minor);
    }
    hnbrdf_tensor_file_free(&file);
    return result;
}

/* ---- The row of the format ------------------------------------------------------------------- */

static int rgl_recognise(const measured_file *file)
{
    return hnbrdf_tensor_file_recognise(file->bytes, file->size);
}

static const hnbrdf_measured_option rgl_options[] = {
    {.name = "spectra",
     .help = "RGL files that have RGB and spectra: use the spectra",
     .offset = offsetof(hnbrdf_measured_options, rgl_spectra)},
    {.name = "signed",
     .help = "keep negative values of RGL files: colours outside the gamut (default: clipped to 0)",
     .offset = offsetof(hnbrdf_measured_options, rgl_signed),
     .makes_negative = 1},
};
static const char *const endings[] = {".bsdf", NULL};

const measured_reader hnbrdf_rgl_reader = {
    .info = {.format = HNBRDF_MEASURED_RGL,
             .name = "RGL",
             .files = "RGL .bsdf",
             .endings = endings,
             .options = rgl_options,
             .option_count = sizeof rgl_options / sizeof rgl_options[0]},
    .expected = "an RGL .bsdf (starts with \"tensor_file\")",
    .recognise = rgl_recognise,
    .open = rgl_open,
};
