/* flip.c: FLIP over the pixels of two pictures that count, exposure by exposure. */
#include "report/flip.h"

#include "base/error.h"
#include "hnbrdf/metrics.h"
#include "image/difference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct job {
    const render_image *image, *reference;
    const report_flip *options;
    const report_watch *watch;
    size_t pixels;
    float *map, *one; /* [pixels]: the largest so far; of one exposure */
    float *packed;    /* [2 pixels][3] */
} job;

static double mean_covered(const job *j)
{
    double sum = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < j->pixels; i++)
        if (render_covered(j->image, j->reference, i)) {
            sum += (double)j->map[i];
            count++;
        }
    return count ? sum / (double)count : 0.0;
}

static hnbrdf_result choose_exposures(const job *j, hnbrdf_flip_exposures *exposures,
                                      hnbrdf_error *error)
{
    size_t count = 0;
    for (size_t i = 0; i < j->pixels; i++)
        if (render_covered(j->image, j->reference, i))
            memcpy(j->packed + 3 * count++, j->reference->rgb + 3 * i, 3 * sizeof(float));
    return hnbrdf_flip_exposures_of(j->packed, count, exposures, error);
}

static hnbrdf_result compare_hdr(const job *j, hnbrdf_error *error)
{
    hnbrdf_flip_exposures all;
    hnbrdf_result result = choose_exposures(j, &all, error);
    for (int k = 0; result == HNBRDF_OK && k < all.count; k++) {
        const double stops = all.start + (all.stop - all.start) * k / fmax(all.count - 1, 1);
        const hnbrdf_flip_exposures one = {stops, stops, 1};
        if (j->watch)
            report_show(j->watch, (double)k / all.count, "FLIP");
        if (j->watch && report_stop(j->watch))
            return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED, "FLIP: interrupted");
        result =
            hnbrdf_flip_hdr(j->image->rgb, j->reference->rgb, j->image->width, j->image->height,
                            j->options->pixels_per_degree, &one, j->one, error);
        for (size_t i = 0; result == HNBRDF_OK && i < j->pixels; i++)
            j->map[i] = fmaxf(j->map[i], j->one[i]);
    }
    return result;
}

static hnbrdf_result compare_displayed(const job *j, hnbrdf_error *error)
{
    const float gain = (float)exp2(j->options->exposure);
    const size_t values = 3 * j->pixels;
    for (size_t i = 0; i < values; i++) {
        j->packed[i] = gain * j->image->rgb[i];
        j->packed[values + i] = gain * j->reference->rgb[i];
    }
    return hnbrdf_flip(j->packed, j->packed + values, j->image->width, j->image->height,
                       j->options->pixels_per_degree, j->map, error);
}

hnbrdf_result report_flip_compare(const render_image *image, const render_image *reference,
                                  const report_flip *options, const report_watch *watch,
                                  double *flip, hnbrdf_error *error)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    job j = {.image = image,
             .reference = reference,
             .options = options,
             .watch = watch,
             .pixels = pixels,
             .map = calloc(pixels, sizeof(float)),
             .one = malloc(pixels * sizeof(float)),
             .packed = malloc(6 * pixels * sizeof(float))};
    hnbrdf_result result = HNBRDF_ERROR_MEMORY;
    if (!j.map || !j.one || !j.packed)
        hnbrdf_fail(error, result, "FLIP: out of memory");
    else
        result = isnan(options->exposure) ? compare_hdr(&j, error) : compare_displayed(&j, error);
    if (result == HNBRDF_OK)
        *flip = mean_covered(&j);
    free(j.map);
    free(j.one);
    free(j.packed);
    return result;
}
