/* utia.c: UTIA .bin tables (Filip and Vavra 2014, Template-Based Sampling of Anisotropic BRDFs):
 * 5-D grids of doubles without a header, and the three readings of their numbers that public
 * readers have. */
#include "measured/format.h"
#include "base/bytes.h"
#include "base/error.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

enum {
    THETAS = 6, /* every 15 degrees, 0 to 75 */
    PHIS = 48,  /* every 7.5 degrees */
    DIRECTIONS = THETAS * PHIS,
    PAIRS = DIRECTIONS * DIRECTIONS,
    SAMPLES = 3 * PAIRS,
    ALBEDO_AZIMUTHS = 8, /* of the light */
    /* of the viewer, of equal projected solid angle; PHIS directions in each */
    ALBEDO_RINGS = 24
};
static const size_t FILE_SIZE = (size_t)SAMPLES * 8;
static const uint64_t DENSE_FILE_SIZE = 1505433600; /* 44 x 180 directions, 2 degrees apart */
static const double PI = 3.14159265358979323846;

typedef struct utia_table {
    hnbrdf_utia_mode mode;
    double scale, max_theta; /* of the lookup, in steps of the grid */
    float v[PAIRS][3];       /* [theta_i][phi_i][theta_v][phi_v]; i is the light, v the viewer */
} utia_table;

/* ---- What the numbers mean ------------------------------------------------------------------- */

/* IEC 61966-2-1 from `threshold` on, where the two branches of the standard meet near 0.04045. */
static double decode(double v, double threshold)
{
    return v > threshold ? pow((v + 0.055) / 1.055, 2.4) : v / 12.92;
}

static double sample_value(hnbrdf_utia_mode mode, double stored)
{
    switch (mode) {
    case HNBRDF_UTIA_DJB:
        return stored > 0.0 ? stored / 140.0 : 0.0;
    case HNBRDF_UTIA_SRGB:
        return decode(stored, 0.04045);
    case HNBRDF_UTIA_RAW:
        break;
    }
    return stored;
}

static double brdf_value(const utia_table *table, double interpolated)
{
    if (table->mode == HNBRDF_UTIA_DJB)
        interpolated = 100.0 * decode(interpolated, 0.0375);
    return table->scale * interpolated;
}

/* ---- Lookup ---------------------------------------------------------------------------------- */

/* The four neighbours of one direction. Weights are negative where theta is beyond the last
 * sample. */
typedef struct corners {
    int direction[4];
    double weight[4];
} corners;

static corners neighbours(const double w[3], double max_theta)
{
    double theta = atan2(sqrt(w[0] * w[0] + w[1] * w[1]), w[2]) * (12 / PI);
    double phi = atan2(w[1], w[0]) * (PHIS / (2 * PI));
    theta = theta < max_theta ? theta : max_theta;
    phi = phi < 0.0 ? phi + PHIS : phi;
    int t = (int)theta < THETAS - 2 ? (int)theta : THETAS - 2, p = (int)phi;
    double a = theta - t, b = phi - p;
    int p0 = p % PHIS, p1 = (p + 1) % PHIS; /* a tiny negative phi rounds to PHIS */
    return (corners){{t * PHIS + p0, t * PHIS + p1, (t + 1) * PHIS + p0, (t + 1) * PHIS + p1},
                     {(1 - a) * (1 - b), (1 - a) * b, a * (1 - b), a * b}};
}

static int utia_eval(const void *data, const double wi[3], const double wo[3], double f[3])
{
    const utia_table *table = data;
    corners light = neighbours(wi, table->max_theta), viewer = neighbours(wo, table->max_theta);
    double sum[3] = {0};
    for (int i = 0; i < 4; i++)
        for (int v = 0; v < 4; v++) {
            const float *sample = table->v[light.direction[i] * DIRECTIONS + viewer.direction[v]];
            for (int c = 0; c < 3; c++)
                sum[c] += light.weight[i] * viewer.weight[v] * (double)sample[c];
        }
    for (int c = 0; c < 3; c++)
        f[c] = brdf_value(table, sum[c]);
    return 1;
}

/* ---- Energy ---------------------------------------------------------------------------------- */

static void direction(double sine2, double phi, double w[3])
{
    double sine = sqrt(sine2);
    w[0] = sine * cos(phi);
    w[1] = sine * sin(phi);
    w[2] = sqrt(1.0 - sine2);
}

/* Directional albedo of the brightest channel, mean over the azimuths of the light: midpoint
 * rule, to about 1 % on smooth materials. sine2 is that of the light's theta. */
static double albedo(const utia_table *table, double sine2)
{
    double sum[3] = {0};
    for (int a = 0; a < ALBEDO_AZIMUTHS; a++)
        for (int k = 0; k < ALBEDO_RINGS * PHIS; k++) {
            double wi[3], wo[3], f[3];
            direction(sine2, 2 * PI * a / ALBEDO_AZIMUTHS, wi);
            direction((k / PHIS + 0.5) / ALBEDO_RINGS, 2 * PI * (k % PHIS + 0.5) / PHIS, wo);
            utia_eval(table, wi, wo, f);
            for (int c = 0; c < 3; c++)
                sum[c] += f[c] > 0.0 ? f[c] : 0.0;
        }
    return PI * fmax(sum[0], fmax(sum[1], sum[2])) / (ALBEDO_AZIMUTHS * ALBEDO_RINGS * PHIS);
}

/* ---- Opening --------------------------------------------------------------------------------- */

static int utia_recognise(const measured_file *file)
{
    size_t length = strlen(file->label);
    return file->size == FILE_SIZE || (uint64_t)file->size == DENSE_FILE_SIZE ||
           (file->size > 0 && length > 4 && strcmp(file->label + length - 4, ".bin") == 0);
}

static hnbrdf_result fill_table(utia_table *table, const unsigned char *bytes, const char *label,
                                int *negative, hnbrdf_error *error)
{
    for (size_t k = 0; k < SAMPLES; k++) {
        double stored = le_double(bytes + 8 * k);
        if (!(fabs(stored) <= (double)HNBRDF_MAX_VALUE))
            return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                               "%s: UTIA sample %zu of %d is not finite or beyond 3e38, expected a "
                               "number of order 1",
                               label, k, SAMPLES);
        *negative += stored < 0.0;
        double value = sample_value(table->mode, stored);
        table->v[k % PAIRS][k / PAIRS] =
            value < (double)HNBRDF_MAX_VALUE ? (float)value : HNBRDF_MAX_VALUE;
    }
    return HNBRDF_OK;
}

/* "0.123", whatever the locale. */
static void print_albedo(char text[16], double value)
{
    if (value > 9999.0) {
        memcpy(text, "over 9999", sizeof "over 9999");
        return;
    }
    unsigned thousandths = (unsigned)(value * 1000.0 + 0.5);
    snprintf(text, 16, "%u.%03u", thousandths / 1000, thousandths % 1000);
}

static void summarise(char summary[256], const utia_table *table, int negative)
{
    double at_0 = albedo(table, 0.0), at_45 = albedo(table, 0.5);
    char text_0[16], text_45[16];
    print_albedo(text_0, at_0);
    print_albedo(text_45, at_45);
    snprintf(summary, 256,
             "UTIA 6 x 48 directions of light and view, mode %s%s%s, directional albedo %s at 0 "
             "and %s at 45 degrees%s; %d of %d samples negative",
             hnbrdf_utia_mode_name(table->mode), table->scale != 1.0 ? " scaled" : "",
             table->max_theta < THETAS ? ", not extrapolated" : "", text_0, text_45,
             at_0 > 1.0 || at_45 > 1.0 ? " (WARNING: more than arrives)" : "", negative, SAMPLES);
}

static hnbrdf_result utia_open(const measured_file *file, const hnbrdf_measured_options *options,
                               measured_body *body, hnbrdf_error *error)
{
    const size_t size = file->size;
    const char *label = file->label;
    if ((uint64_t)size == DENSE_FILE_SIZE)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_UNSUPPORTED,
            "%s: %zu bytes, the size of the dense UTIA set (2 degrees), which is not read; "
            "expected the set of 150 materials, %zu bytes",
            label, size, FILE_SIZE);
    if (size != FILE_SIZE)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_FORMAT,
            "%s: %zu bytes, expected a UTIA .bin of exactly %zu (the dense set of %llu is not "
            "read)",
            label, size, FILE_SIZE, (unsigned long long)DENSE_FILE_SIZE);
    utia_table *table = malloc(sizeof *table);
    if (!table)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory (%zu bytes)", label,
                           sizeof *table);
    table->mode = options->utia_mode;
    table->scale = options->utia_scale;
    table->max_theta = options->utia_no_extrapolate ? THETAS - 1 : THETAS;
    int negative = 0;
    hnbrdf_result result = fill_table(table, file->bytes, label, &negative, error);
    if (result) {
        free(table);
        return result;
    }
    body->data = table;
    body->eval = utia_eval;
    body->release = free;
    body->isotropic = 0;
    summarise(body->summary, table, negative);
    return HNBRDF_OK;
}

/* ---- The row of the format ------------------------------------------------------------------- */

const char *hnbrdf_utia_mode_name(hnbrdf_utia_mode mode)
{
    switch (mode) {
    case HNBRDF_UTIA_DJB:
        return "djb";
    case HNBRDF_UTIA_RAW:
        return "raw";
    case HNBRDF_UTIA_SRGB:
        return "srgb";
    }
    return NULL;
}

static const char *mode_word(int value)
{
    return hnbrdf_utia_mode_name((hnbrdf_utia_mode)value);
}

static const hnbrdf_measured_option utia_options[] = {
    {.name = "utia",
     .help = "what the numbers in UTIA files mean; their scale is uncertain (default djb)",
     .offset = offsetof(hnbrdf_measured_options, utia_mode),
     .word = mode_word},
    {.name = "utia-scale",
     .help = "factor on UTIA values (default 1)",
     .offset = offsetof(hnbrdf_measured_options, utia_scale),
     .usual = 1.0,
     .low = 1e-6,
     .high = 1e6},
    {.name = "utia-no-extrapolate",
     .help = "hold UTIA values beyond 75 degrees (default: go on linearly)",
     .offset = offsetof(hnbrdf_measured_options, utia_no_extrapolate)},
};
static const char *const endings[] = {".bin", NULL};

const measured_reader hnbrdf_utia_reader = {
    .info = {.format = HNBRDF_MEASURED_UTIA,
             .name = "UTIA",
             .files = "UTIA .bin",
             .endings = endings,
             .options = utia_options,
             .option_count = sizeof utia_options / sizeof utia_options[0]},
    .expected = "a UTIA .bin (1990656 bytes)",
    .recognise = utia_recognise,
    .open = utia_open,
};
