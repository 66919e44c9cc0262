/* png.c: 8-bit PNG of a linear image: exposure, clamp, sRGB curve. Compression by
 * stb_image_write. */
#include "image/image.h"

#include "base/error.h"
#include "image/png_memory.h"

#include <math.h>
#include <string.h>

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

/* The whole file; 0 without memory. rows: [height][width][channels]. */
static int compress(const render_image *image, const unsigned char *rows, int channels,
                    render_bytes *bytes)
{
    png_memory memory;
    int size;
    memory.blocks = NULL;
    png_current = &memory;
    if (setjmp(memory.exhausted)) {
        png_current = NULL;
        return 0;
    }
    unsigned char *file = stbi_write_png_to_mem(rows, image->width * channels, image->width,
                                                image->height, channels, &size);
    const int done = render_bytes_put(bytes, 0, file, (size_t)size) == 0;
    png_free(file);
    png_current = NULL;
    return done;
}

hnbrdf_result render_png_encode(const render_image *image, double exposure, render_bytes *bytes,
                                hnbrdf_error *error)
{
    int channels = image->alpha ? 4 : 3;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    unsigned char *packed = malloc(pixels * (size_t)channels);
    if (!packed)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for a PNG of %d x %d",
                           image->width, image->height);
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
    const int done = compress(image, packed, channels, &result);
    free(packed);
    if (!done)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for a PNG of %d x %d",
                           image->width, image->height);
    *bytes = result;
    return HNBRDF_OK;
}
