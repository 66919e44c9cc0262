/* picture.c: light, files and comparison of pictures. */
#include "report/picture.h"

#include "base/error.h"
#include "base/text.h"
#include "image/difference.h"
#include "report/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

hnbrdf_result report_open_light(report_light *options, render_environment *environment,
                                hnbrdf_error *error)
{
    static const double sky_level = 0.56; /* what render_environment_level() gives for the sky */
    double radians = options->rotate * 3.14159265358979323846 / 180.0;
    const render_read_options reading = {
        .notes = options->notes, .layer = options->layer, .repair = options->repair};
    hnbrdf_result result =
        render_environment_open(options->env, radians, &reading, environment, error);
    if (result != HNBRDF_OK)
        return result;
    if (isnan(options->exposure))
        options->exposure = log2(sky_level / render_environment_level(environment));
    return HNBRDF_OK;
}

hnbrdf_result report_picture_write(const render_image *image, const char *path,
                                   const render_write_options *options, hnbrdf_error *error)
{
    hnbrdf_result result = render_image_write(image, path, options, error);
    if (result != HNBRDF_OK || hnbrdf_ends_with(path, ".png"))
        return result;
    char *beside = report_png_beside(path);
    if (!beside)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    result = render_image_write(image, beside, options, error);
    free(beside);
    return result;
}

void report_print_pictures(const char *path, FILE *file)
{
    char *beside = hnbrdf_ends_with(path, ".png") ? NULL : report_png_beside(path);
    fprintf(file, "%s\n", path);
    if (beside)
        fprintf(file, "%s\n", beside);
    free(beside);
}

/* The pixels of image that count, one after the other; returns how many. */
static size_t pack(const render_image *image, const render_image *a, const render_image *b,
                   float *out)
{
    size_t pixels = (size_t)image->width * (size_t)image->height, count = 0;
    for (size_t i = 0; i < pixels; i++)
        if (render_covered(a, b, i))
            memcpy(out + 3 * count++, image->rgb + 3 * i, 3 * sizeof(float));
    return count;
}

hnbrdf_result report_picture_compare(const render_image *image, const render_image *reference,
                                     hnbrdf_image_error *difference, hnbrdf_error *error)
{
    size_t values = 3 * (size_t)image->width * (size_t)image->height;
    float *packed = malloc(2 * values * sizeof *packed);
    if (!packed)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    pack(reference, image, reference, packed + values);
    hnbrdf_image_compare(packed, packed + values, 3 * pack(image, image, reference, packed),
                         difference);
    free(packed);
    return HNBRDF_OK;
}

hnbrdf_result report_picture_compare_twice(const render_image image[2],
                                           const render_image reference[2],
                                           hnbrdf_image_error *difference,
                                           hnbrdf_image_noise *noise, hnbrdf_error *error)
{
    size_t values = 3 * (size_t)image->width * (size_t)image->height, count = 0;
    float *packed = malloc(4 * values * sizeof *packed);
    if (!packed)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    const float *images[2] = {packed, packed + values},
                *references[2] = {packed + 2 * values, packed + 3 * values};
    for (int k = 0; k < 2; k++) {
        count = pack(&image[k], &image[0], &image[1], packed + (size_t)k * values);
        pack(&reference[k], &image[0], &image[1], packed + (size_t)(2 + k) * values);
    }
    hnbrdf_image_compare_twice(images, references, count, difference, noise);
    free(packed);
    return HNBRDF_OK;
}
