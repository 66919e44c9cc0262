/* image.c: images in memory. */
#include "image/image.h"

#include "base/error.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static size_t settle(size_t given, size_t most)
{
    return given && given < most ? given : most;
}

render_read_options render_read_options_settle(const render_read_options *options)
{
    render_read_options settled = {0};
    if (options)
        settled = *options;
    settled.max_bytes = settle(settled.max_bytes, RENDER_MAX_FILE);
    settled.max_pixels = settle(settled.max_pixels, RENDER_MAX_PIXELS);
    return settled;
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
