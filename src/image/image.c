/* image.c: images in memory, and their way to and from files. */
#include "image/image.h"

#include "base/error.h"
#include "base/files.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static size_t settle(size_t given, size_t most)
{
    return given && given < most ? given : most;
}

render_limits render_limits_settle(const render_limits *limits)
{
    const render_limits none = {0, 0}, *given = limits ? limits : &none;
    return (render_limits){settle(given->max_bytes, RENDER_MAX_FILE),
                           settle(given->max_pixels, RENDER_MAX_PIXELS)};
}

hnbrdf_result render_image_create(int width, int height, int alpha, render_image *image,
                                  hnbrdf_error *error)
{
    if (width < 1 || height < 1 || width > RENDER_MAX_SIDE || height > RENDER_MAX_SIDE ||
        (size_t)width * (size_t)height > RENDER_MAX_PIXELS)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT,
                           "an image of %d x %d: expected sides of 1 to %d and at most %zu pixels",
                           width, height, RENDER_MAX_SIDE, RENDER_MAX_PIXELS);
    size_t pixels = (size_t)width * (size_t)height;
    render_image result = {.width = width, .height = height};
    result.rgb = calloc(pixels, 3 * sizeof(float));
    result.alpha = alpha ? calloc(pixels, sizeof(float)) : NULL;
    if (!result.rgb || (alpha && !result.alpha)) {
        render_image_free(&result);
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for an image of %d x %d", width,
                           height);
    }
    *image = result;
    return HNBRDF_OK;
}

hnbrdf_result render_image_add_layer(render_image *image, const char *name, float *rgb,
                                     hnbrdf_error *error)
{
    render_layer *layer = &image->layers[image->layer_count];
    if (image->layer_count == RENDER_MAX_LAYERS)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "more than %d layers in an image",
                           RENDER_MAX_LAYERS);
    if (!*name || strlen(name) >= sizeof layer->name)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "layer name '%s': expected 1 to %zu bytes",
                           name, sizeof layer->name - 1);
    strcpy(layer->name, name);
    layer->rgb = rgb;
    image->layer_count++;
    return HNBRDF_OK;
}

void render_image_free(render_image *image)
{
    for (int i = 0; i < image->layer_count; i++)
        free(image->layers[i].rgb);
    free(image->rgb);
    free(image->alpha);
    memset(image, 0, sizeof *image);
}

int render_bytes_put(render_bytes *bytes, size_t offset, const void *data, size_t size)
{
    if (size > SIZE_MAX / 4 || offset > SIZE_MAX / 4)
        return -1;
    size_t end = offset + size;
    if (end > bytes->capacity) {
        size_t capacity = end + end / 2 + 4096;
        unsigned char *grown = realloc(bytes->data, capacity);
        if (!grown)
            return -1;
        bytes->data = grown;
        bytes->capacity = capacity;
    }
    if (offset > bytes->size)
        memset(bytes->data + bytes->size, 0, offset - bytes->size);
    if (size)
        memcpy(bytes->data + offset, data, size);
    if (end > bytes->size)
        bytes->size = end;
    return 0;
}

static int lower(int c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

int render_has_extension(const char *path, const char *extension)
{
    size_t length = strlen(path), count = strlen(extension);
    if (length < count)
        return 0;
    for (size_t i = 0; i < count; i++)
        if (lower(path[length - count + i]) != lower(extension[i]))
            return 0;
    return 1;
}

/* ---- Files ----------------------------------------------------------------------------------- */

static hnbrdf_result read_stream(FILE *file, const char *path, size_t limit, render_bytes *bytes,
                                 hnbrdf_error *error)
{
    unsigned char block[65536];
    size_t count;
    while ((count = fread(block, 1, sizeof block, file)) > 0) {
        if (bytes->size + count > limit)
            return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "%s: larger than %zu bytes", path, limit);
        if (render_bytes_put(bytes, bytes->size, block, count))
            return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: no memory for its bytes", path);
    }
    if (ferror(file))
        return hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: cannot be read: %s", path, strerror(errno));
    return HNBRDF_OK;
}

hnbrdf_result render_file_read(const char *path, size_t limit, render_bytes *bytes,
                               hnbrdf_error *error)
{
    FILE *file = hnbrdf_open_to_read(path);
    if (!file)
        return hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: cannot be opened: %s", path,
                           strerror(errno));
    hnbrdf_result result = read_stream(file, path, limit, bytes, error);
    fclose(file);
    return result;
}

hnbrdf_result render_image_read(const char *path, const render_limits *limits, render_image *image,
                                hnbrdf_error *error)
{
    render_bytes bytes = {0};
    hnbrdf_result result =
        render_file_read(path, render_limits_settle(limits).max_bytes, &bytes, error);
    if (result == HNBRDF_OK) {
        static const unsigned char exr_magic[4] = {0x76, 0x2f, 0x31, 0x01};
        if (bytes.size >= 4 && memcmp(bytes.data, exr_magic, 4) == 0)
            result = render_exr_decode(bytes.data, bytes.size, path, limits, image, error);
        else if (bytes.size >= 2 && memcmp(bytes.data, "#?", 2) == 0)
            result = render_radiance_decode(bytes.data, bytes.size, path, limits, image, error);
        else
            result =
                hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                            "%s: neither OpenEXR nor Radiance .hdr (%zu bytes)", path, bytes.size);
    }
    free(bytes.data);
    return result;
}

hnbrdf_result render_image_write(const render_image *image, const char *path,
                                 const render_write_options *options, hnbrdf_error *error)
{
    static const render_write_options defaults;
    options = options ? options : &defaults;
    render_bytes bytes = {0};
    hnbrdf_result result;
    if (render_has_extension(path, ".exr"))
        result = render_exr_encode(image, options, &bytes, error);
    else if (render_has_extension(path, ".png"))
        result = render_png_encode(image, options->exposure, &bytes, error);
    else
        result = hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                             "%s: expected a name ending in .exr or .png", path);
    if (result == HNBRDF_OK)
        result = hnbrdf_write_file(path, bytes.data, bytes.size, error);
    free(bytes.data);
    return result;
}
