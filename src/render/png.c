/* png.c: 8-bit PNG of a linear image: exposure, clamp, sRGB curve. Compression by stb_image_write. */
#include "render/image.h"

#include "core/error.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>

static unsigned char to_byte(double unit)
{
    return (unsigned char)(unit * 255.0 + 0.5);
}

static double clamp_unit(double value)
{
    return value > 0.0 ? (value < 1.0 ? value : 1.0) : 0.0; /* NaN: 0 */
}

static double srgb_curve(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

static void append(void *user, void *data, int size)
{
    render_bytes *bytes = user;
    if (render_bytes_put(bytes, bytes->size, data, (size_t)size))
        bytes->size = SIZE_MAX / 2; /* makes every further put fail, and tells the caller */
}

hnbrdf_result render_png_encode(const render_image *image, double exposure, render_bytes *bytes,
                                hnbrdf_error *error)
{
    int channels = image->alpha ? 4 : 3;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    unsigned char *packed = malloc(pixels * (size_t)channels);
    if (!packed)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for a PNG of %d x %d", image->width,
                           image->height);
    double gain = exp2(exposure);
    for (size_t i = 0; i < pixels; i++) {
        double alpha = image->alpha ? clamp_unit(image->alpha[i]) : 1.0;
        double scale = alpha > 0.0 ? gain / alpha : 0.0;
        unsigned char *out = packed + i * (size_t)channels;
        for (int k = 0; k < 3; k++)
            out[k] = to_byte(srgb_curve(clamp_unit(scale * (double)image->rgb[3 * i + (size_t)k])));
        if (channels == 4)
            out[3] = to_byte(alpha);
    }
    render_bytes result = {0};
    int done = stbi_write_png_to_func(append, &result, image->width, image->height, channels, packed,
                                      image->width * channels);
    free(packed);
    if (!done || result.size >= SIZE_MAX / 2) {
        free(result.data);
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for a PNG of %d x %d", image->width,
                           image->height);
    }
    *bytes = result;
    return HNBRDF_OK;
}
