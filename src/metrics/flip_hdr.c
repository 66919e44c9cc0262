/* flip_hdr.c: FLIP of what a display shows of linear pictures: as they are, or at the exposures
 * that HDR-FLIP chooses (Andersson et al. 2021). */
#include "hnbrdf/metrics.h"

#include "base/error.h"
#include "metrics/flip_displayed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The exposures begin where the curve takes the largest luminance to this, and end where it takes
 * the median there. */
static const double SHOWN = 0.85;

/* At most so many stops: pictures that are nearly black have a median of nearly 0. */
static const double MOST_STOPS = 16.0;

hnbrdf_result hnbrdf_flip(const float *image, const float *reference, int width, int height,
                          double pixels_per_degree, float *map, hnbrdf_error *error)
{
    const flip_display plain = {1.0, 0};
    return hnbrdf_flip_displayed(image, reference, width, height, pixels_per_degree, &plain, 1, map,
                                 error);
}

/* ---- Exposures ------------------------------------------------------------------------------- */

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

hnbrdf_result hnbrdf_flip_exposures_of(const float *reference, size_t pixels,
                                       hnbrdf_flip_exposures *exposures, hnbrdf_error *error)
{
    if (!reference || pixels == 0 || !exposures)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "FLIP: an argument is NULL, or there is no pixel");
    float *luminance = (float *)malloc(pixels * sizeof *luminance);
    if (!luminance)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "FLIP: out of memory");
    for (size_t i = 0; i < pixels; i++) {
        const float *rgb = reference + 3 * i;
        luminance[i] = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
    }
    qsort(luminance, pixels, sizeof *luminance, compare_floats);
    const double most = (double)luminance[pixels - 1],
                 median = fmax((double)luminance[pixels / 2], most * exp2(-MOST_STOPS));
    free(luminance);
    const double level = hnbrdf_flip_film_inverse(SHOWN);
    exposures->start = most > 0.0 ? log2(level / most) : 0.0;
    exposures->stop = most > 0.0 ? log2(level / median) : 0.0;
    exposures->count = (int)fmax(2.0, ceil(exposures->stop - exposures->start));
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_flip_hdr(const float *image, const float *reference, int width, int height,
                              double pixels_per_degree, const hnbrdf_flip_exposures *exposures,
                              float *map, hnbrdf_error *error)
{
    enum { MOST = 64 };
    hnbrdf_flip_exposures own;
    flip_display displays[MOST];
    hnbrdf_result result = HNBRDF_OK;
    if (!exposures && width > 0 && height > 0) {
        result = hnbrdf_flip_exposures_of(reference, (size_t)width * (size_t)height, &own, error);
        exposures = &own;
    }
    if (result != HNBRDF_OK)
        return result;
    if (!exposures || exposures->count < 1 || exposures->count > MOST)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "FLIP: found %d exposures, expected 1 to %d",
                           exposures ? exposures->count : 0, (int)MOST);
    const int steps = exposures->count > 1 ? exposures->count - 1 : 1;
    for (int k = 0; k < exposures->count; k++)
        displays[k] = (flip_display){
            exp2(exposures->start + (exposures->stop - exposures->start) * k / steps), 1};
    return hnbrdf_flip_displayed(image, reference, width, height, pixels_per_degree, displays,
                                 exposures->count, map, error);
}
