/* nbrdf.c: networks of Neural-BRDF (Sztrajman et al. 2021, Neural BRDF Representation and
 * Importance Sampling): from the half and the difference vector to f through two layers of
 * rectified units. nbrdf_npy.c and room hdf5 read the numbers; here they become a network and are
 * evaluated. */
#include "measured/nbrdf.h"
#include "base/error.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    INPUTS = 6, /* the half vector with phi_h = 0, then the difference vector */
    OUTPUTS = 3,
    LANES = 8 /* units that are summed side by side; columns are padded to a multiple of it */
};

typedef struct layer {
    size_t inputs, columns; /* columns: the units, padded */
    const float *weights;   /* [inputs][columns] */
    const float *bias;      /* [columns] */
} layer;

typedef struct network {
    layer layers[NBRDF_LAYERS];
    float numbers[];
} network;

/* ---- Evaluation ------------------------------------------------------------------------------ */

/* Sums in the order of the inputs, as Neural-BRDF's own renderer adds them; a unit is never spread
 * over lanes, so that every machine gives the same bits. */
static void apply(const layer *l, const float *in, float *out, int rectify)
{
    for (size_t first = 0; first < l->columns; first += LANES) {
        float sum[LANES] = {0.0f};
        const float *weights = l->weights + first;
        for (size_t i = 0; i < l->inputs; i++, weights += l->columns)
            for (int lane = 0; lane < LANES; lane++)
                sum[lane] += in[i] * weights[lane];
        for (int lane = 0; lane < LANES; lane++) {
            float unit = sum[lane] + l->bias[first + (size_t)lane];
            out[first + (size_t)lane] = rectify && !(unit > 0.0f) ? 0.0f : unit;
        }
    }
}

/* max(0, exp(x) - 1) to about 2 units in the last place, without the C library's exp, which is not
 * the same everywhere: x = k ln 2 + r, and 2^k (e^r - 1) + (2^k - 1). */
static double positive_expm1(double x)
{
    static const double LN2_HIGH = 0x1.62e42fee00000p-1, LN2_LOW = 0x1.a39ef35793c76p-33;
    if (!(x > 0.0))
        return 0.0;
    if (x > 100.0)
        return INFINITY; /* far above HNBRDF_MAX_VALUE */
    int k = (int)(x * 1.4426950408889634 + 0.5);
    double r = (x - k * LN2_HIGH) - k * LN2_LOW, series = 1.0;
    for (int n = 14; n >= 2; n--) /* r^14 / 14! < 1e-16 r */
        series = 1.0 + r / n * series;
    uint64_t bits = (uint64_t)(k + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power * (r * series) + (power - 1.0);
}

/* The half vector h turned to phi_h = 0 and wi in the frame that carries z to h, from square roots
 * alone. With t and b the other axes of the frame: wi.t = (wi - wo).t / 2, likewise b. */
static void half_and_difference(const double wi[3], const double wo[3], float x[INPUTS])
{
    double s[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
    double d[3] = {wi[0] - wo[0], wi[1] - wo[1], wi[2] - wo[2]};
    double across2 = s[0] * s[0] + s[1] * s[1], across = sqrt(across2);
    double sum = sqrt(across2 + s[2] * s[2]);
    double along_t = d[0], along_b = d[1];
    if (across > 0.0) {
        double outward = (s[0] * d[0] + s[1] * d[1]) / across;
        along_t = (outward * s[2] - across * d[2]) / sum;
        along_b = (s[0] * d[1] - s[1] * d[0]) / across;
    }
    x[0] = (float)(across / sum);
    x[1] = 0.0f;
    x[2] = (float)(s[2] / sum);
    x[3] = (float)(along_t / 2);
    x[4] = (float)(along_b / 2);
    x[5] = (float)(sum / 2);
}

static int nbrdf_eval(const void *data, const double wi[3], const double wo[3], double f[3])
{
    const layer *layers = ((const network *)data)->layers;
    float x[INPUTS], first[NBRDF_MAX_UNITS], second[NBRDF_MAX_UNITS], out[LANES];
    half_and_difference(wi, wo, x);
    apply(&layers[0], x, first, 1);
    apply(&layers[1], first, second, 1);
    apply(&layers[2], second, out, 0);
    for (int c = 0; c < OUTPUTS; c++)
        f[c] = positive_expm1((double)out[c]);
    return 1;
}

/* ---- From arrays to a network ---------------------------------------------------------------- */

/* "6 x 21", or "21" */
static void print_shape(const nbrdf_array *array, char text[48])
{
    if (array->axes == 2)
        snprintf(text, 48, "%zu x %zu", array->shape[0], array->shape[1]);
    else
        snprintf(text, 48, "%zu", array->shape[0]);
}

static hnbrdf_result check_shape(const nbrdf_arrays *arrays, int k, size_t inputs, size_t units,
                                 hnbrdf_error *error)
{
    const nbrdf_array *array = &arrays->array[k];
    const int axes = k % 2 ? 1 : 2;
    char found[48], expected[64];
    print_shape(array, found);
    if (axes == 1)
        snprintf(expected, sizeof expected, "%zu", units);
    else if (units)
        snprintf(expected, sizeof expected, "%zu x %zu", inputs, units);
    else
        snprintf(expected, sizeof expected, "%zu x N, N from 1 to %d", inputs, NBRDF_MAX_UNITS);
    size_t columns = axes == 2 ? array->shape[1] : array->shape[0];
    int right = array->axes == axes && (axes == 1 || array->shape[0] == inputs) &&
                (units ? columns == units : columns >= 1 && columns <= NBRDF_MAX_UNITS);
    if (right)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %s%sshape %s, expected %s",
                       arrays->label[k], array->what, array->what[0] ? " has " : "", found,
                       expected);
}

/* The shapes fit together, and every number is finite. */
static hnbrdf_result check_arrays(const nbrdf_arrays *arrays, hnbrdf_error *error)
{
    size_t inputs = INPUTS;
    for (int k = 0; k < NBRDF_ARRAYS; k++) {
        const nbrdf_array *array = &arrays->array[k];
        size_t units = k % 2 ? inputs : k == NBRDF_ARRAYS - 2 ? OUTPUTS : 0;
        hnbrdf_result result = check_shape(arrays, k, inputs, units, error);
        if (result)
            return result;
        size_t count = array->shape[0] * (array->axes == 2 ? array->shape[1] : 1);
        for (size_t i = 0; i < count; i++)
            if (!isfinite(array->values[i]))
                return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                                   "%s: %s%snumber %zu of %zu is not finite, expected a weight",
                                   arrays->label[k], array->what, array->what[0] ? ", " : "", i + 1,
                                   count);
        if (k % 2 == 0)
            inputs = array->shape[1];
    }
    return HNBRDF_OK;
}

static size_t padded(size_t units)
{
    return (units + LANES - 1) / LANES * LANES;
}

/* The network of arrays that have been checked; NULL without memory. */
static network *build(const nbrdf_arrays *arrays)
{
    size_t total = 0;
    for (int k = 0; k < NBRDF_ARRAYS; k += 2)
        total += (arrays->array[k].shape[0] + 1) * padded(arrays->array[k].shape[1]);
    network *made = calloc(1, sizeof *made + total * sizeof(float));
    float *next = made ? made->numbers : NULL;
    for (int k = 0; made && k < NBRDF_ARRAYS; k += 2) {
        const nbrdf_array *kernel = &arrays->array[k], *bias = &arrays->array[k + 1];
        size_t rows = kernel->shape[0], units = kernel->shape[1], columns = padded(units);
        for (size_t i = 0; i < rows; i++)
            memcpy(next + i * columns, kernel->values + i * units, units * sizeof(float));
        memcpy(next + rows * columns, bias->values, units * sizeof(float));
        made->layers[k / 2] = (layer){rows, columns, next, next + rows * columns};
        next += (rows + 1) * columns;
    }
    return made;
}

/* ---- Opening --------------------------------------------------------------------------------- */

static const unsigned char NPY[] = {0x93, 'N', 'U', 'M', 'P', 'Y'};
static const unsigned char HDF5[] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};

/* The magic, or as much of it as there is, of four bytes or more. */
static int starts_with(const measured_file *file, const unsigned char *magic, size_t length)
{
    size_t compared = file->size < length ? file->size : length;
    return compared >= 4 && memcmp(file->bytes, magic, compared) == 0;
}

static int nbrdf_recognise(const measured_file *file)
{
    return starts_with(file, NPY, sizeof NPY) || starts_with(file, HDF5, sizeof HDF5);
}

hnbrdf_result hnbrdf_nbrdf_open_arrays(const nbrdf_arrays *arrays, const char *container,
                                       measured_body *body, hnbrdf_error *error)
{
    hnbrdf_result result = check_arrays(arrays, error);
    if (result)
        return result;
    network *made = build(arrays);
    if (!made)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", arrays->label[0]);
    body->data = made;
    body->eval = nbrdf_eval;
    body->release = free;
    body->isotropic = 1;
    for (int k = 0; k < NBRDF_ARRAYS; k++)
        body->bytes += sizeof(float) * arrays->array[k].shape[0] *
                       (arrays->array[k].axes == 2 ? arrays->array[k].shape[1] : 1);
    snprintf(body->summary, sizeof body->summary,
             "NBRDF network 6-%zu-%zu-3 from %s, rectified units, exp(x) - 1, not exactly "
             "reciprocal",
             arrays->array[0].shape[1], arrays->array[2].shape[1], container);
    return HNBRDF_OK;
}

static hnbrdf_result read_hdf5(const measured_file *file, const hnbrdf_measured_options *options,
                               nbrdf_arrays *arrays, hnbrdf_error *error)
{
    if (options->read_hdf5)
        return options->read_hdf5(file->bytes, file->size, file->label, arrays, error);
    return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                       "%s: an HDF5 file, and libhdf5 is not used here (HNBRDF_WITH_HDF5, "
                       "hnbrdf/hdf5.h); the six .npy files of a material are read without",
                       file->label);
}

static hnbrdf_result nbrdf_open(const measured_file *file, const hnbrdf_measured_options *options,
                                measured_body *body, hnbrdf_error *error)
{
    int npy = starts_with(file, NPY, sizeof NPY);
    nbrdf_arrays *arrays = calloc(1, sizeof *arrays);
    if (!arrays)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", file->label);
    hnbrdf_result result = npy ? hnbrdf_nbrdf_read_npy(file, options, arrays, error)
                               : read_hdf5(file, options, arrays, error);
    if (!result)
        result =
            hnbrdf_nbrdf_open_arrays(arrays, npy ? "six .npy files" : "Keras HDF5", body, error);
    for (int k = 0; k < NBRDF_ARRAYS; k++)
        free(arrays->array[k].values);
    free(arrays);
    return result;
}

/* ---- The row of the format ------------------------------------------------------------------- */

static const char *const endings[] = {".h5", NULL};

const measured_reader hnbrdf_nbrdf_reader = {
    .info =
        {
            .format = HNBRDF_MEASURED_NBRDF,
            .name = "NBRDF",
            .files = "NBRDF .h5/.npy",
            .endings = endings,
            .part_endings = hnbrdf_nbrdf_part_endings,
        },
    .expected = "an NBRDF .h5/.npy (HDF, NUMPY)",
    .recognise = nbrdf_recognise,
    .open = nbrdf_open,
};
