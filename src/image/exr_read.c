/* exr_read.c: OpenEXR pictures from memory: the layer, its values, its colours, placed in the
 * display window. */
#include "image/exr.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

/* What of a window is asked for: its place and its size. */
typedef struct frame {
    int64_t x, y;
    int width, height;
} frame;

static hnbrdf_result check_window(const exr_input *in, const char *which,
                                  const exr_attr_box2i_t *window, frame *out)
{
    const int64_t w = (int64_t)window->max.x - window->min.x + 1;
    const int64_t h = (int64_t)window->max.y - window->min.y + 1;
    if (w < 1 || h < 1 || w > RENDER_MAX_SIDE || h > RENDER_MAX_SIDE ||
        w * h > (int64_t)in->options.max_pixels)
        return hnbrdf_fail(
            in->error, HNBRDF_ERROR_LIMIT,
            "%s: %s window of %lld x %lld: expected sides of 1 to %d and at most %zu pixels",
            in->name, which, (long long)w, (long long)h, RENDER_MAX_SIDE, in->options.max_pixels);
    *out = (frame){window->min.x, window->min.y, (int)w, (int)h};
    return HNBRDF_OK;
}

/* Everything that decides how much memory will be asked for. */
static hnbrdf_result read_header(const exr_input *in, exr_picture *picture, frame *data)
{
    const int part = picture->part;
    exr_result_t result = exr_get_storage(in->context, part, &picture->storage);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_compression(in->context, part, &picture->compression);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_data_window(in->context, part, &picture->window);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_display_window(in->context, part, &picture->display);
    if (result != EXR_ERR_SUCCESS)
        return exr_library_error(in, result);
    const hnbrdf_result checked = check_window(in, "data", &picture->window, data);
    if (checked != HNBRDF_OK)
        return checked;
    picture->width = data->width;
    picture->height = data->height;
    const exr_attr_chlist_t *list;
    exr_get_channels(in->context, part, &list);
    for (int i = 0; i < list->num_channels; i++) {
        const int u = list->entries[i].x_sampling, v = list->entries[i].y_sampling;
        if (u < 1 || v < 1 || data->x % u != 0 || data->width % u != 0 || data->y % v != 0 ||
            data->height % v != 0) /* the format forbids it, and planes rely on it */
            return exr_library_error(in, EXR_ERR_INVALID_ATTR);
    }
    return HNBRDF_OK;
}

/* The window that the picture fills: the display window, but for maps that say of themselves that
 * they are one, whose data window is the whole sphere. */
static hnbrdf_result read_shown(const exr_input *in, const exr_picture *picture, const frame *data,
                                frame *shown, render_map *map)
{
    exr_envmap_t kind;
    *map = RENDER_MAP_UNSAID;
    *shown = *data;
    if (exr_attr_get_envmap(in->context, picture->part, "envmap", &kind) == EXR_ERR_SUCCESS) {
        *map = kind == EXR_ENVMAP_CUBE ? RENDER_MAP_CUBE : RENDER_MAP_LATLONG;
        return HNBRDF_OK;
    }
    const hnbrdf_result result = check_window(in, "display", &picture->display, shown);
    if (result != HNBRDF_OK)
        return result;
    const int overlap = data->x < shown->x + shown->width && shown->x < data->x + data->width &&
                        data->y < shown->y + shown->height && shown->y < data->y + data->height;
    if (!overlap)
        hnbrdf_note(&in->options.notes,
                    "%s: its data window of %d x %d lies outside the display window: black",
                    in->name, data->width, data->height);
    else if (data->x > shown->x || data->y > shown->y ||
             data->x + data->width < shown->x + shown->width ||
             data->y + data->height < shown->y + shown->height)
        hnbrdf_note(&in->options.notes,
                    "%s: data window of %d x %d at (%lld, %lld), black outside it in %d x %d",
                    in->name, data->width, data->height, (long long)(data->x - shown->x),
                    (long long)(data->y - shown->y), shown->width, shown->height);
    return HNBRDF_OK;
}

/* Copies what the two windows share. */
static hnbrdf_result place(const exr_input *in, const exr_picture *picture, const frame *data,
                           const frame *shown, render_image *image)
{
    exr_colour colour;
    hnbrdf_result result = exr_colour_open(in, picture, &colour);
    if (result != HNBRDF_OK)
        return result;
    const int64_t left = data->x > shown->x ? data->x : shown->x;
    const int64_t data_end = data->x + data->width, shown_end = shown->x + shown->width;
    const int64_t right = data_end < shown_end ? data_end : shown_end;
    if (right <= left) {
        exr_colour_close(&colour);
        return HNBRDF_OK;
    }
    const size_t from = (size_t)(left - data->x), to = (size_t)(left - shown->x);
    const size_t count = (size_t)(right - left);
    const float *alpha = picture->planes[EXR_ALPHA].values;
    float *row = malloc(3 * sizeof *row * (size_t)data->width);
    if (!row)
        result = hnbrdf_fail(in->error, HNBRDF_ERROR_MEMORY, "%s: no memory for a row", in->name);
    for (int y = 0; y < shown->height && row; y++) {
        const int64_t line = shown->y + y - data->y;
        const size_t at = (size_t)y * (size_t)shown->width + to;
        if (line < 0 || line >= data->height)
            continue;
        exr_colour_row(&colour, (int)line, row);
        memcpy(image->rgb + 3 * at, row + 3 * from, 3 * sizeof *row * count);
        if (alpha)
            memcpy(image->alpha + at, alpha + (size_t)line * (size_t)data->width + from,
                   sizeof *alpha * count);
    }
    free(row);
    exr_colour_close(&colour);
    return result;
}

static hnbrdf_result read_picture(const exr_input *in, exr_picture *picture, render_image *image)
{
    frame data = {0}, shown = {0};
    render_map map = RENDER_MAP_UNSAID;
    hnbrdf_result result = exr_choose_layer(in, picture);
    if (result == HNBRDF_OK)
        result = read_header(in, picture, &data);
    if (result == HNBRDF_OK)
        result = read_shown(in, picture, &data, &shown, &map);
    if (result == HNBRDF_OK)
        result = exr_read_planes(in, picture);
    if (result != HNBRDF_OK)
        return result;
    render_image out;
    result = render_image_create(shown.width, shown.height,
                                 picture->planes[EXR_ALPHA].channel != NULL, &out, in->error);
    if (result != HNBRDF_OK)
        return result;
    result = place(in, picture, &data, &shown, &out);
    out.map = map;
    if (result == HNBRDF_OK)
        *image = out;
    else
        render_image_free(&out);
    return result;
}

hnbrdf_result render_exr_decode(const void *data, size_t size, const char *name,
                                const render_read_options *options, render_image *image,
                                hnbrdf_error *error)
{
    exr_memory memory = {.data = data, .size = size};
    exr_picture picture = {0};
    exr_input in = {.memory = &memory,
                    .name = name,
                    .options = render_read_options_settle(options),
                    .error = error};
    const exr_context_initializer_t init = exr_memory_start(&memory);
    exr_result_t started = exr_start_read(&in.context, "memory", &init);
    if (started == EXR_ERR_SUCCESS && memory.out_of_memory) { /* it goes on without attributes */
        exr_finish(&in.context);
        started = EXR_ERR_OUT_OF_MEMORY;
    }
    const hnbrdf_result result = started == EXR_ERR_SUCCESS ? read_picture(&in, &picture, image)
                                                            : exr_library_error(&in, started);
    exr_free_planes(&picture);
    if (started == EXR_ERR_SUCCESS)
        exr_finish(&in.context);
    exr_memory_done();
    return result;
}
