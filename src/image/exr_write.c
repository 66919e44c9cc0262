/* exr_write.c: OpenEXR pictures into memory: ZIP-compressed scanlines, half or float. */
#include "image/exr.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

int render_has_exr(void)
{
    return 1;
}

/* Where a channel's floats lie in an image. */
typedef struct exr_source {
    char name[40];
    const float *data; /* first value */
    int stride;        /* floats from pixel to pixel */
} exr_source;

static int image_planes(const render_image *image, exr_source *planes)
{
    int count = 0;
    for (int k = 0; k < 3; k++)
        planes[count++] = (exr_source){{"RGB"[k]}, image->rgb + k, 3};
    if (image->alpha)
        planes[count++] = (exr_source){"A", image->alpha, 1};
    for (int i = 0; i < image->layer_count; i++)
        for (int k = 0; k < 3; k++) {
            exr_source *plane = &planes[count++];
            snprintf(plane->name, sizeof plane->name, "%s.%c", image->layers[i].name, "RGB"[k]);
            plane->data = image->layers[i].rgb + k;
            plane->stride = 3;
        }
    return count;
}

static exr_result_t write_header(exr_context_t context, const render_image *image,
                                 const render_write_options *options, const exr_source *planes,
                                 int count)
{
    static const exr_attr_chromaticities_t rec709 = {.64f, .33f, .30f,   .60f,
                                                     .15f, .06f, .3127f, .3290f};
    exr_pixel_type_t type = options->half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    int part;
    exr_result_t result = exr_add_part(context, "image", EXR_STORAGE_SCANLINE, &part);
    if (result == EXR_ERR_SUCCESS)
        result = exr_initialize_required_attr_simple(context, part, image->width, image->height,
                                                     EXR_COMPRESSION_ZIP);
    if (result == EXR_ERR_SUCCESS)
        result = exr_attr_set_chromaticities(context, part, "chromaticities", &rec709);
    if (result == EXR_ERR_SUCCESS && options->comments)
        result = exr_attr_set_string(context, part, "comments", options->comments);
    for (int i = 0; i < count && result == EXR_ERR_SUCCESS; i++)
        result =
            exr_add_channel(context, part, planes[i].name, type, EXR_PERCEPTUALLY_LINEAR, 1, 1);
    return result == EXR_ERR_SUCCESS ? exr_write_header(context) : result;
}

/* The library casts floats to half as they come, to infinity beyond 65504: clamp them before. */
static void gather_lines(const exr_source *plane, int width, int y, int lines, int half, float *out)
{
    const float *from = plane->data + (size_t)y * (size_t)width * (size_t)plane->stride;
    size_t count = (size_t)width * (size_t)lines;
    for (size_t i = 0; i < count; i++) {
        float value = from[i * (size_t)plane->stride];
        if (half && value > 65504.0f)
            value = 65504.0f;
        if (half && value < -65504.0f)
            value = -65504.0f;
        out[i] = value;
    }
}

static const exr_source *find_plane(const exr_source *planes, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(planes[i].name, name) == 0)
            return &planes[i];
    return NULL;
}

/* One chunk of lines: lines is scratch for all its channels. */
static exr_result_t write_chunk(exr_context_t context, exr_encode_pipeline_t *pipe, int y,
                                int width, int half, const exr_source *planes, int count,
                                float *lines)
{
    exr_chunk_info_t chunk;
    int first = pipe->context == NULL;
    exr_result_t result = exr_write_scanline_chunk_info(context, 0, y, &chunk);
    if (result == EXR_ERR_SUCCESS)
        result = first ? exr_encoding_initialize(context, 0, &chunk, pipe)
                       : exr_encoding_update(context, 0, &chunk, pipe);
    if (result != EXR_ERR_SUCCESS)
        return result;
    for (int i = 0; i < pipe->channel_count; i++) {
        exr_coding_channel_info_t *channel = &pipe->channels[i];
        gather_lines(find_plane(planes, count, channel->channel_name), width, y, chunk.height, half,
                     lines);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_pixel_stride = sizeof(float);
        channel->user_line_stride = (int32_t)(sizeof(float) * (size_t)width);
        channel->encode_from_ptr = (const uint8_t *)lines;
        lines += (size_t)width * (size_t)chunk.height;
    }
    if (first)
        result = exr_encoding_choose_default_routines(context, 0, pipe);
    return result == EXR_ERR_SUCCESS ? exr_encoding_run(context, 0, pipe) : result;
}

static exr_result_t write_pixels(exr_context_t context, const render_image *image, int half,
                                 const exr_source *planes, int count)
{
    int32_t step;
    exr_result_t result = exr_get_scanlines_per_chunk(context, 0, &step);
    if (result != EXR_ERR_SUCCESS)
        return result;
    float *lines = malloc(sizeof(float) * (size_t)image->width * (size_t)step * (size_t)count);
    if (!lines)
        return EXR_ERR_OUT_OF_MEMORY;
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    for (int y = 0; y < image->height && result == EXR_ERR_SUCCESS; y += step)
        result = write_chunk(context, &pipe, y, image->width, half, planes, count, lines);
    exr_encoding_destroy(context, &pipe);
    free(lines);
    return result;
}

hnbrdf_result render_exr_encode(const render_image *image, const render_write_options *options,
                                render_bytes *bytes, hnbrdf_error *error)
{
    exr_source planes[4 + 3 * RENDER_MAX_LAYERS];
    int count = image_planes(image, planes);
    render_bytes output = {0};
    exr_memory memory = {.bytes = &output};
    exr_context_initializer_t init = exr_memory_start(&memory);
    exr_context_t context = NULL;
    exr_result_t result = exr_start_write(&context, "image", EXR_WRITE_FILE_DIRECTLY, &init);
    if (result == EXR_ERR_SUCCESS)
        result = write_header(context, image, options, planes, count);
    if (result == EXR_ERR_SUCCESS)
        result = write_pixels(context, image, options->half, planes, count);
    if (context) {
        exr_result_t finished = exr_finish(&context);
        result = result == EXR_ERR_SUCCESS ? finished : result;
    }
    exr_memory_done();
    if (result != EXR_ERR_SUCCESS) {
        free(output.data);
        const int exhausted = memory.out_of_memory || result == EXR_ERR_OUT_OF_MEMORY;
        return hnbrdf_fail(error, exhausted ? HNBRDF_ERROR_MEMORY : HNBRDF_ERROR_IO, "OpenEXR: %s",
                           memory.message[0] ? memory.message
                                             : exr_get_default_error_message(result));
    }
    *bytes = output;
    return HNBRDF_OK;
}
