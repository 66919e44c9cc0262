/* merl.c: MERL .binary tables (Matusik et al. 2003): 90 x 90 x 180 bins over the half and
 * difference angles of Rusinkiewicz 1998. Nearest bin, as the database's own code looks up, or
 * trilinear. */
#include "measured/format.h"
#include "measured/merl_known.h"
#include "base/bytes.h"
#include "base/error.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

enum {
    THETA_H_BINS = 90, /* theta_h = (i/90)^2 pi/2 at the lower edge of bin i */
    THETA_D_BINS = 90, /* theta_d = (j/90) pi/2 */
    PHI_D_BINS = 180,  /* phi_d in [0, pi): f(phi_d + pi) = f(phi_d) is reciprocity */
    BINS = THETA_H_BINS * THETA_D_BINS * PHI_D_BINS,
    FULL_CIRCLE_BINS = 2 * PHI_D_BINS, /* of derived tables: phi_d in [0, 2 pi), all twice */
    HEADER_SIZE = 12,
    TYPICAL_VALID = 1111432 /* bins whose lower edge is above the horizon for wi and wo */
};
static const size_t FILE_SIZE = HEADER_SIZE + (size_t)BINS * 24;
static const size_t FULL_CIRCLE_SIZE = HEADER_SIZE + (size_t)BINS * 48;
static const double PI = 3.14159265358979323846;
/* What a stored sample is multiplied by to become f in 1/sr. */
static const double SCALE[3] = {1.00 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

/* f per bin; a bin that holds no measurement has a negative red. phi_d is the fastest axis. */
typedef struct merl_table {
    double node; /* where in its bin a sample counts as taken: 0.5 centre, 0 lower edge */
    float f[BINS][3];
} merl_table;

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

/* The place of two unit vectors above the horizon among the bins: their lower edges are at whole
 * numbers. With h the half vector, t and b the frame that carries z to h, wi.t = (wi - wo).t / 2:
 * swapping wi and wo negates both components to the last bit, and the fold to [0, pi) makes the
 * place the same. */
static void locate(const double wi[3], const double wo[3], double place[3])
{
    double s[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
    double d[3] = {wi[0] - wo[0], wi[1] - wo[1], wi[2] - wo[2]};
    double across2 = s[0] * s[0] + s[1] * s[1], across = sqrt(across2);
    double sum = sqrt(across2 + s[2] * s[2]);
    double theta_h = atan2(across, s[2]);
    double theta_d = atan2(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), sum);

    /* d.t and d.b, both times the same positive factor; phi_h = 0 at the pole */
    double x = d[0], y = d[1];
    if (across > 0.0) {
        x = (s[0] * d[0] + s[1] * d[1]) * s[2] / sum - across2 * d[2] / sum;
        y = s[0] * d[1] - s[1] * d[0];
    }
    if (y < 0.0) {
        x = -x;
        y = -y;
    }
    double phi_d = y == 0.0 ? 0.0 : atan2(y, x); /* pi is 0 */

    place[0] = THETA_H_BINS * sqrt(theta_h / (PI / 2));
    place[1] = THETA_D_BINS * theta_d / (PI / 2);
    place[2] = PHI_D_BINS * phi_d / PI;
}

static int bin_at(int i, int j, int k)
{
    return (i * THETA_D_BINS + j) * PHI_D_BINS + k;
}

static int is_valid(const float f[3])
{
    return f[0] >= 0.0f;
}

static int eval_nearest(const void *data, const double wi[3], const double wo[3], double f[3])
{
    double place[3];
    locate(wi, wo, place);
    const float *bin = ((const merl_table *)data)
                           ->f[bin_at(min_int((int)place[0], THETA_H_BINS - 1),
                                      min_int((int)place[1], THETA_D_BINS - 1),
                                      min_int((int)place[2], PHI_D_BINS - 1))];
    for (int c = 0; c < 3; c++)
        f[c] = (double)bin[c];
    return is_valid(bin);
}

/* Two samples of an axis and the weight of the second. */
typedef struct neighbours {
    int index[2];
    double weight;
} neighbours;

/* The last sample holds beyond it, as the first before it. */
static neighbours clamped_neighbours(double place, int count)
{
    double low = floor(place);
    int index = (int)low;
    return (neighbours){{index < 0 ? 0 : min_int(index, count - 1), min_int(index + 1, count - 1)},
                        place - low};
}

static neighbours wrapped_neighbours(double place, int count)
{
    double low = floor(place);
    int index = ((int)low + count) % count;
    return (neighbours){{index, (index + 1) % count}, place - low};
}

/* Bins without a measurement are left out, the weights of the others made 1 again. */
static int eval_trilinear(const void *data, const double wi[3], const double wo[3], double f[3])
{
    const merl_table *table = data;
    double place[3], total = 0.0;
    locate(wi, wo, place);
    neighbours i = clamped_neighbours(place[0] - table->node, THETA_H_BINS);
    neighbours j = clamped_neighbours(place[1] - table->node, THETA_D_BINS);
    neighbours k = wrapped_neighbours(place[2] - table->node, PHI_D_BINS);
    f[0] = f[1] = f[2] = 0.0;
    for (int corner = 0; corner < 8; corner++) {
        int a = corner >> 2, b = corner >> 1 & 1, c = corner & 1;
        const float *bin = table->f[bin_at(i.index[a], j.index[b], k.index[c])];
        double weight = (a ? i.weight : 1 - i.weight) * (b ? j.weight : 1 - j.weight) *
                        (c ? k.weight : 1 - k.weight);
        if (!is_valid(bin) || weight == 0.0)
            continue;
        total += weight;
        for (int channel = 0; channel < 3; channel++)
            f[channel] += weight * (double)bin[channel];
    }
    for (int channel = 0; channel < 3 && total > 0.0; channel++)
        f[channel] /= total;
    return total > 0.0;
}

static int merl_recognise(const measured_file *file)
{
    if (file->size == FILE_SIZE)
        return 1;
    if (file->size < HEADER_SIZE)
        return 0;
    uint64_t bins = 1;
    for (int axis = 0; axis < 3; axis++) {
        uint32_t dim = le32(file->bytes + 4 * axis);
        if (dim < 1 || dim > 4096)
            return 0;
        bins *= dim;
    }
    return bins == BINS || bins == (uint64_t)BINS * 2;
}

static hnbrdf_result check_header(const unsigned char *bytes, size_t size, const char *label,
                                  hnbrdf_error *error)
{
    uint32_t theta_h = le32(bytes), theta_d = le32(bytes + 4), phi_d = le32(bytes + 8);
    if (theta_h != THETA_H_BINS || theta_d != THETA_D_BINS ||
        (phi_d != PHI_D_BINS && phi_d != FULL_CIRCLE_BINS))
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: MERL header says %lu %lu %lu bins, expected 90 90 180", label,
                           (unsigned long)theta_h, (unsigned long)theta_d, (unsigned long)phi_d);
    const size_t expected = phi_d == PHI_D_BINS ? FILE_SIZE : FULL_CIRCLE_SIZE;
    if (size < expected)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: MERL table is truncated: %zu bytes, expected %zu", label, size,
                           expected);
    if (size == FULL_CIRCLE_SIZE && phi_d == PHI_D_BINS)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: MERL header says 90 90 180 bins, the size is that of 90 90 360, "
                           "expected %zu bytes",
                           label, expected);
    return HNBRDF_OK;
}

/* ---- The table ------------------------------------------------------------------------------- */

/* The samples of a file: three planes of [theta_h][theta_d][phi_d]. */
typedef struct merl_samples {
    const unsigned char *bytes;
    size_t phi_d; /* bins of the last axis */
} merl_samples;

/* The scaled sample of a bin; 1 if it is valid: finite, not negative, within a float. */
static int read_bin(const merl_samples *samples, size_t theta, size_t phi_d, double f[3])
{
    const size_t plane = THETA_H_BINS * THETA_D_BINS * samples->phi_d * 8;
    const unsigned char *at = samples->bytes + (theta * samples->phi_d + phi_d) * 8;
    int good = 1;
    for (size_t c = 0; c < 3; c++) {
        f[c] = le_double(at + c * plane) * SCALE[c];
        good &= f[c] >= 0.0 && f[c] <= (double)HNBRDF_MAX_VALUE; /* false for NaN */
    }
    return good;
}

/* Are these the value of one reciprocal BRDF for two directions and for the same swapped, worked
 * out in single precision? In each of the two a component of the half vector is off by at most four
 * roundings of 2^-24. The narrowest lobe that the table resolves is as wide as its first bin,
 * (1/90)^2 pi/2, and the logarithm of one of width w changes by at most 4/w a radian (GGX): 1 % in
 * all. What is computed as a difference of numbers near 1, as networks do, adds four roundings. */
static int agree(double a, double b)
{
    const double rounding = 1.0 / 16777216;
    const double first_bin = PI / 2 / (THETA_H_BINS * THETA_H_BINS);
    return fabs(a - b) <= 8 * rounding * (4 / first_bin * fmax(a, b) + 1);
}

/* Of one valid half that half, of two their mean; where they differ nothing, and it is counted. */
static int read_halves(const merl_samples *samples, size_t theta, size_t phi_d, double f[3],
                       int *differ)
{
    double other[3];
    const int good = read_bin(samples, theta, phi_d, f),
              other_good = read_bin(samples, theta, phi_d + PHI_D_BINS, other);
    int same = 1;
    for (int c = 0; c < 3 && other_good; c++) {
        same &= !good || agree(f[c], other[c]);
        f[c] = good ? (f[c] + other[c]) / 2 : other[c];
    }
    *differ += !same;
    return good || other_good;
}

/* Scales every sample; returns how many bins are valid. *differ: those of a full circle whose
 * halves are not one reciprocal value. */
static int fill_table(merl_table *table, const merl_samples *samples, int *differ)
{
    int valid = 0;
    *differ = 0;
    for (size_t bin = 0; bin < BINS; bin++) {
        const size_t theta = bin / PHI_D_BINS, phi_d = bin % PHI_D_BINS;
        double f[3];
        const int good = samples->phi_d == PHI_D_BINS
                             ? read_bin(samples, theta, phi_d, f)
                             : read_halves(samples, theta, phi_d, f, differ);
        for (int c = 0; c < 3; c++)
            table->f[bin][c] = good ? (float)f[c] : 0.0f;
        if (!good)
            table->f[bin][0] = -1.0f;
        valid += good;
    }
    return valid;
}

/* What the file holds can be told only when all of it was read. */
static hnbrdf_result read_table(merl_table *table, const measured_file *file, int *valid,
                                hnbrdf_error *error)
{
    const merl_samples samples = {file->bytes + HEADER_SIZE, le32(file->bytes + 8)};
    int differ;
    *valid = fill_table(table, &samples, &differ);
    if (differ > 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: MERL header says 90 90 360 bins, and %d of %d differ between "
                           "phi_d and phi_d + pi by more than rounding: this BRDF changes when "
                           "light and view are swapped, expected one that does not",
                           file->label, differ, BINS);
    if (*valid == 0)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_FORMAT,
            "%s: all %d MERL bins are negative or not finite, expected about %d valid ones",
            file->label, BINS, TYPICAL_VALID);
    return HNBRDF_OK;
}

static const char *lookup_name(const hnbrdf_measured_options *options)
{
    if (options->merl_lookup == HNBRDF_MERL_NEAREST)
        return "nearest bin";
    return options->merl_node == HNBRDF_MERL_CENTRE ? "trilinear between bin centres"
                                                    : "trilinear between lower edges of bins";
}

static void summarise(char summary[256], const hnbrdf_measured_options *options, int valid,
                      const measured_file *file)
{
    const int full = le32(file->bytes + 8) == FULL_CIRCLE_BINS;
    const size_t size = full ? FULL_CIRCLE_SIZE : FILE_SIZE;
    int permille = (int)((int64_t)valid * 1000 / BINS);
    int unusual = valid < TYPICAL_VALID / 10 * 9 || valid > TYPICAL_VALID / 10 * 11;
    int n = snprintf(
        summary, 256, "MERL 90 x 90 x %d bins (theta_h, theta_d, phi_d)%s, %d.%d %% valid%s, %s",
        full ? FULL_CIRCLE_BINS : PHI_D_BINS, full ? ", reciprocal" : "", permille / 10,
        permille % 10, unusual ? " (unusual: 76 % is typical)" : "", lookup_name(options));
    if (file->size > size && n > 0 && n < 256)
        snprintf(summary + n, (size_t)(256 - n), ", %zu bytes after the table ignored",
                 file->size - size);
}

static hnbrdf_result merl_open(const measured_file *file, const hnbrdf_measured_options *options,
                               measured_body *body, hnbrdf_error *error)
{
    int valid;
    hnbrdf_result result = check_header(file->bytes, file->size, file->label, error);
    if (result)
        return result;
    merl_table *table = malloc(sizeof *table);
    if (!table)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory (%zu bytes)", file->label,
                           sizeof *table);
    result = read_table(table, file, &valid, error);
    if (result) {
        free(table);
        return result;
    }
    table->node = options->merl_node == HNBRDF_MERL_CENTRE ? 0.5 : 0.0;
    body->data = table;
    body->eval = options->merl_lookup == HNBRDF_MERL_NEAREST ? eval_nearest : eval_trilinear;
    body->release = free;
    body->isotropic = 1;
    if (options->merl_identify)
        body->published = hnbrdf_merl_known(file->bytes, file->size);
    summarise(body->summary, options, valid, file);
    return HNBRDF_OK;
}

/* ---- The row of the format ------------------------------------------------------------------- */

const char *hnbrdf_merl_lookup_name(hnbrdf_merl_lookup lookup)
{
    switch (lookup) {
    case HNBRDF_MERL_NEAREST:
        return "nearest";
    case HNBRDF_MERL_TRILINEAR:
        return "trilinear";
    }
    return NULL;
}

const char *hnbrdf_merl_node_name(hnbrdf_merl_node node)
{
    switch (node) {
    case HNBRDF_MERL_CENTRE:
        return "centre";
    case HNBRDF_MERL_EDGE:
        return "edge";
    }
    return NULL;
}

static const char *lookup_word(int value)
{
    return hnbrdf_merl_lookup_name((hnbrdf_merl_lookup)value);
}

static const char *node_word(int value)
{
    return hnbrdf_merl_node_name((hnbrdf_merl_node)value);
}

static const hnbrdf_measured_option merl_options[] = {
    {.name = "merl",
     .help = "lookup in MERL files (default nearest)",
     .offset = offsetof(hnbrdf_measured_options, merl_lookup),
     .word = lookup_word},
    {.name = "merl-node",
     .help = "where in its bin a MERL sample lies, for trilinear (default centre)",
     .offset = offsetof(hnbrdf_measured_options, merl_node),
     .word = node_word,
     .needs = "merl"},
};
static const char *const endings[] = {".binary", NULL};

const measured_reader hnbrdf_merl_reader = {
    .info = {.format = HNBRDF_MEASURED_MERL,
             .name = "MERL",
             .files = "MERL .binary",
             .endings = endings,
             .options = merl_options,
             .option_count = sizeof merl_options / sizeof merl_options[0]},
    .expected = "a MERL .binary (starts with 90 90 180)",
    .recognise = merl_recognise,
    .open = merl_open,
};
