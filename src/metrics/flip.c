/* flip.c: FLIP, the difference that a person sees who lets two pictures alternate on a display
 * (Andersson et al. 2020). Written from the paper: sections 4.1 (colour) and 4.2 (features). Both
 * pictures go through the same filters in strips of rows; Gaussians and their derivatives are
 * products of a function of x and one of y, so that each filter is two passes over a row. */
#include "hnbrdf/metrics.h"

#include "base/error.h"
#include "metrics/flip_colour.h"
#include "metrics/flip_displayed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* An observer at 0.7 m from a display 0.7 m wide of 3840 pixels. */
#define PIXELS_PER_DEGREE (0.7 * 3840.0 / 0.7 * PI / 180.0)
enum { LEAST_PER_DEGREE = 1, MOST_PER_DEGREE = 2000 };

/* Of features: their width in degrees, and the exponent of their differences. */
static const double FEATURE_DEGREES = 0.082, FEATURE_POWER = 0.5;

/* ---- Filters --------------------------------------------------------------------------------- */

/* The eye's sensitivity to contrast, a Gaussian a channel and two of blue-yellow; then what finds
 * edges and points. */
enum { LIGHT, RED_GREEN, BLUE_WIDE, BLUE_NARROW, SMOOTH, EDGE, POINT, PASSES };
enum { GAUSSIANS = SMOOTH };

/* a sqrt(pi/b) exp(-pi^2 x^2/b), x in degrees: the transform of a Gaussian of the frequency. */
static const double AMPLITUDE[GAUSSIANS] = {1.0, 1.0, 34.1, 13.5},
                    SPREAD[GAUSSIANS] = {0.0047, 0.0053, 0.04, 0.025};
static const double LARGEST_SPREAD = 0.04;

/* The channel of opponent colours that each of them is applied to. */
static const int CHANNEL[PASSES] = {0, 1, 2, 2, 0, 0, 0};

typedef struct filters {
    int radius[PASSES], margin;
    double *weights[PASSES]; /* [2 radius + 1] */
    double share[2];         /* of both Gaussians of blue-yellow */
} filters;

static double sum_of(const double *weights, int radius)
{
    double sum = 0.0;
    for (int k = 0; k <= 2 * radius; k++)
        sum += weights[k];
    return sum;
}

static void scale(double *weights, int radius, double by)
{
    for (int k = 0; k <= 2 * radius; k++)
        weights[k] *= by;
}

/* Each sums to 1; the shares are the parts that both have in a filter over the whole square. */
static void fill_sensitivity(filters *f, double ppd)
{
    double part[GAUSSIANS];
    for (int p = 0; p < GAUSSIANS; p++) {
        for (int k = -f->margin; k <= f->margin; k++)
            f->weights[p][k + f->margin] = exp(-PI * PI * (k / ppd) * (k / ppd) / SPREAD[p]);
        const double sum = sum_of(f->weights[p], f->margin);
        part[p] = AMPLITUDE[p] * sqrt(PI / SPREAD[p]) * sum * sum;
        scale(f->weights[p], f->margin, 1.0 / sum);
    }
    for (int k = 0; k < 2; k++)
        f->share[k] = part[BLUE_WIDE + k] / (part[BLUE_WIDE] + part[BLUE_NARROW]);
}

/* Positive weights sum to 1 and negative ones to -1. */
static void balance(double *weights, int radius)
{
    double above = 0.0, below = 0.0;
    for (int k = 0; k <= 2 * radius; k++)
        *(weights[k] > 0.0 ? &above : &below) += fabs(weights[k]);
    for (int k = 0; k <= 2 * radius; k++)
        weights[k] /= weights[k] > 0.0 ? above : below;
}

/* A Gaussian, and its first and second derivative, of a standard deviation in pixels. */
static void fill_features(filters *f, double deviation)
{
    const int r = f->radius[SMOOTH];
    for (int k = -r; k <= r; k++) {
        const double t = k / deviation, g = exp(-0.5 * t * t);
        f->weights[SMOOTH][k + r] = g;
        f->weights[EDGE][k + r] = -k * g;
        f->weights[POINT][k + r] = (t * t - 1.0) * g;
    }
    scale(f->weights[SMOOTH], r, 1.0 / sum_of(f->weights[SMOOTH], r));
    balance(f->weights[EDGE], r);
    balance(f->weights[POINT], r);
}

static int make_filters(filters *f, double ppd)
{
    const double deviation = 0.5 * FEATURE_DEGREES * ppd;
    f->margin = (int)ceil(3.0 * sqrt(LARGEST_SPREAD / (2.0 * PI * PI)) * ppd);
    for (int p = 0; p < PASSES; p++) {
        f->radius[p] = p < GAUSSIANS ? f->margin : (int)ceil(3.0 * deviation);
        f->weights[p] = (double *)malloc((2 * (size_t)f->radius[p] + 1) * sizeof(double));
        if (!f->weights[p])
            return 0;
    }
    fill_sensitivity(f, ppd);
    fill_features(f, deviation);
    return 1;
}

/* ---- A strip of rows of one picture ---------------------------------------------------------- */

typedef struct strip {
    double *rows[PASSES]; /* [height][width]: the first pass of each, along x */
    double *line;         /* [3][width + 2 margin]: a row of opponent colours */
    double *out[5];       /* [width]: L*, a*, b*, edge, point of one row */
    double *part;         /* [width] */
} strip;

typedef struct job {
    filters filters;
    flip_colours colours;
    int width, height, rows; /* rows: of a strip without its margins */
    strip strips[2];
} job;

/* One block for everything of a picture. */
static int make_strip(const job *j, strip *s)
{
    const size_t width = (size_t)j->width, margin = (size_t)j->filters.margin,
                 plane = ((size_t)j->rows + 2 * margin) * width;
    double *block =
        (double *)malloc((PASSES * plane + 3 * (width + 2 * margin) + 6 * width) * sizeof(double));
    if (!block)
        return 0;
    for (int p = 0; p < PASSES; p++, block += plane)
        s->rows[p] = block;
    s->line = block;
    block += 3 * (width + 2 * margin);
    for (int k = 0; k < 5; k++, block += width)
        s->out[k] = block;
    s->part = block;
    return 1;
}

/* out += by in, along x: in points to the first of `width` values that have neighbours. */
static void add_along(const double *in, const double *weights, int radius, int width, double *out)
{
    memset(out, 0, (size_t)width * sizeof *out);
    for (int k = -radius; k <= radius; k++) {
        const double w = weights[k + radius];
        const double *from = in + k;
        for (int x = 0; x < width; x++)
            out[x] += w * from[x];
    }
}

/* Beyond the rim a picture goes on with the value there. */
static void fill_line(const job *j, const float *rgb, const flip_display *display, double *line)
{
    const int margin = j->filters.margin, stride = j->width + 2 * margin;
    for (int x = 0; x < j->width; x++) {
        double shown[3], opponent[3];
        hnbrdf_flip_show(display, rgb + 3 * (size_t)x, shown);
        hnbrdf_flip_opponent(&j->colours, shown, opponent);
        for (int c = 0; c < 3; c++)
            line[c * stride + margin + x] = opponent[c];
    }
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < margin; k++) {
            double *row = line + (ptrdiff_t)c * stride;
            row[k] = row[margin];
            row[margin + j->width + k] = row[margin + j->width - 1];
        }
}

/* Rows from `first` to `last`, their margins included. */
static void fill_strip(const job *j, const float *picture, const flip_display *display, int first,
                       int last, strip *s)
{
    const filters *f = &j->filters;
    const ptrdiff_t stride = j->width + 2 * f->margin;
    for (int y = first; y <= last; y++) {
        fill_line(j, picture + 3 * (size_t)y * (size_t)j->width, display, s->line);
        for (int p = 0; p < PASSES; p++)
            add_along(s->line + CHANNEL[p] * stride + f->margin, f->weights[p], f->radius[p],
                      j->width, s->rows[p] + (ptrdiff_t)(y - first) * j->width);
    }
}

static int clamp_row(int y, int height)
{
    return y < 0 ? 0 : y < height ? y : height - 1;
}

/* The second pass: along y, with the weights of `across`. */
static void add_across(const job *j, const strip *s, int first, int y, int pass, int across,
                       double *out)
{
    const filters *f = &j->filters;
    const int radius = f->radius[across];
    memset(out, 0, (size_t)j->width * sizeof *out);
    for (int k = -radius; k <= radius; k++) {
        const double w = f->weights[across][k + radius];
        const double *from =
            s->rows[pass] + (ptrdiff_t)(clamp_row(y + k, j->height) - first) * j->width;
        for (int x = 0; x < j->width; x++)
            out[x] += w * from[x];
    }
}

/* Colours of row y as the eye resolves them. */
static void see_colours(const job *j, strip *s, int first, int y)
{
    const double *share = j->filters.share;
    add_across(j, s, first, y, LIGHT, LIGHT, s->out[0]);
    add_across(j, s, first, y, RED_GREEN, RED_GREEN, s->out[1]);
    add_across(j, s, first, y, BLUE_WIDE, BLUE_WIDE, s->out[2]);
    add_across(j, s, first, y, BLUE_NARROW, BLUE_NARROW, s->part);
    for (int x = 0; x < j->width; x++) {
        const double seen[3] = {s->out[0][x], s->out[1][x],
                                share[0] * s->out[2][x] + share[1] * s->part[x]};
        double lab[3];
        hnbrdf_flip_lab(&j->colours, seen, lab);
        for (int c = 0; c < 3; c++)
            s->out[c][x] = lab[c];
    }
}

/* How strong an edge, a point is. The weights sum to 0, so that (Y + 16)/116 is Y/116. */
static void see_features(const job *j, strip *s, int first, int y)
{
    for (int p = EDGE; p <= POINT; p++) {
        double *out = s->out[3 + p - EDGE];
        add_across(j, s, first, y, p, SMOOTH, out);
        add_across(j, s, first, y, SMOOTH, p, s->part);
        for (int x = 0; x < j->width; x++)
            out[x] = sqrt(out[x] * out[x] + s->part[x] * s->part[x]) / 116.0;
    }
}

/* ---- Both ------------------------------------------------------------------------------------ */

static double difference(const job *j, int x)
{
    double a[3], b[3];
    const strip *s = j->strips;
    for (int c = 0; c < 3; c++) {
        a[c] = s[0].out[c][x];
        b[c] = s[1].out[c][x];
    }
    const double colour = hnbrdf_flip_spread(&j->colours, hnbrdf_flip_distance(a, b));
    const double edge = fabs(s[0].out[3][x] - s[1].out[3][x]),
                 point = fabs(s[0].out[4][x] - s[1].out[4][x]);
    const double feature = pow(fmax(edge, point) / sqrt(2.0), FEATURE_POWER);
    return pow(colour, 1.0 - fmin(feature, 1.0));
}

static void compare(job *j, const float *const pictures[2], const flip_display *display, float *map)
{
    const int margin = j->filters.margin;
    for (int top = 0; top < j->height; top += j->rows) {
        const int bottom = top + j->rows < j->height ? top + j->rows : j->height;
        const int first = clamp_row(top - margin, j->height),
                  last = clamp_row(bottom - 1 + margin, j->height);
        for (int k = 0; k < 2; k++)
            fill_strip(j, pictures[k], display, first, last, &j->strips[k]);
        for (int y = top; y < bottom; y++) {
            for (int k = 0; k < 2; k++) {
                see_colours(j, &j->strips[k], first, y);
                see_features(j, &j->strips[k], first, y);
            }
            float *out = map + (size_t)y * (size_t)j->width;
            for (int x = 0; x < j->width; x++)
                out[x] = fmaxf(out[x], (float)difference(j, x));
        }
    }
}

hnbrdf_result hnbrdf_flip_displayed(const float *image, const float *reference, int width,
                                    int height, double pixels_per_degree,
                                    const flip_display *displays, int count, float *map,
                                    hnbrdf_error *error)
{
    enum { STRIP_VALUES = 1 << 17, LEAST_ROWS = 8 };
    if (!image || !reference || !map || width < 1 || height < 1)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "FLIP: an argument is NULL, or a side of the pictures is not positive");
    const double ppd = pixels_per_degree == 0.0 ? PIXELS_PER_DEGREE : pixels_per_degree;
    if (!(ppd >= LEAST_PER_DEGREE && ppd <= MOST_PER_DEGREE))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "FLIP: found %s pixels per degree, expected %d to %d",
                           HNBRDF_NUMBER(ppd), (int)LEAST_PER_DEGREE, (int)MOST_PER_DEGREE);
    const float *const pictures[2] = {image, reference};
    job j = {.width = width, .height = height, .rows = STRIP_VALUES / width};
    j.rows = j.rows < LEAST_ROWS ? LEAST_ROWS : j.rows < height ? j.rows : height;
    hnbrdf_flip_colours(&j.colours);
    int made = make_filters(&j.filters, ppd);
    for (int k = 0; k < 2; k++)
        made = made && make_strip(&j, &j.strips[k]);
    if (made) {
        memset(map, 0, (size_t)width * (size_t)height * sizeof *map);
        for (int k = 0; k < count; k++)
            compare(&j, pictures, &displays[k], map);
    }
    for (int k = 0; k < 2; k++)
        free(j.strips[k].rows[0]);
    for (int p = 0; p < PASSES; p++)
        free(j.filters.weights[p]);
    return made ? HNBRDF_OK : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "FLIP: out of memory");
}
