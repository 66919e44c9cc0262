/* exr.c: OpenEXR in memory through the OpenEXR Core C library. Without HNBRDF_WITH_OPENEXR every
 * call fails with a message that says so. */
#include "image/image.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

#if !defined(HNBRDF_WITH_OPENEXR)

int render_has_exr(void)
{
    return 0;
}

hnbrdf_result render_exr_encode(const render_image *image, const render_write_options *options,
                                render_bytes *bytes, hnbrdf_error *error)
{
    (void)image, (void)options, (void)bytes;
    return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                       "this program was built without OpenEXR: write a .png instead");
}

hnbrdf_result render_exr_decode(const void *data, size_t size, const char *name,
                                const render_limits *limits, render_image *image,
                                hnbrdf_error *error)
{
    (void)data, (void)size, (void)limits, (void)image;
    return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                       "%s: this program was built without OpenEXR: use a Radiance .hdr file",
                       name);
}

#else

#include <openexr.h>

/* Bytes of the largest block of lines or tile that is decoded at once, per pixel that a picture may
 * have, and the most channels of a file. */
enum { MAX_CHUNK_SHARE = 16, MAX_CHANNELS = 64 };

int render_has_exr(void)
{
    return 1;
}

/* What the library's callbacks see: the bytes, and where its own message goes. */
typedef struct exr_memory {
    const unsigned char *data; /* reading */
    size_t size;
    render_bytes *bytes; /* writing */
    int out_of_memory;
    char message[160];
} exr_memory;

/* Of the call under way. The library may hold its lock while it reports, and would wait for
 * itself if it were asked for its user data then. */
static _Thread_local exr_memory *reporting;

static void keep_message(exr_const_context_t context, exr_result_t code, const char *text)
{
    (void)context;
    if (reporting && code == EXR_ERR_OUT_OF_MEMORY)
        reporting->out_of_memory = 1;        /* what is returned in the end may be another error */
    if (reporting && !reporting->message[0]) /* the first one names the cause */
        snprintf(reporting->message, sizeof reporting->message, "%s", text ? text : "");
}

/* Like pread: fewer bytes near the end, 0 beyond it; the library asks for headers block by block.
 * */
static int64_t read_memory(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    const exr_memory *memory = user;
    (void)context, (void)fail;
    if (offset >= memory->size)
        return 0;
    if (size > memory->size - offset)
        size = memory->size - offset;
    memcpy(buffer, memory->data + offset, size);
    return (int64_t)size;
}

static int64_t memory_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const exr_memory *)user)->size;
}

static int64_t write_memory(exr_const_context_t context, void *user, const void *buffer,
                            uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    exr_memory *memory = user;
    if (render_bytes_put(memory->bytes, offset, buffer, size)) {
        memory->out_of_memory = 1;
        fail(context, EXR_ERR_OUT_OF_MEMORY, "no memory");
        return -1;
    }
    return (int64_t)size;
}

static exr_context_initializer_t initializer(exr_memory *memory)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.user_data = memory;
    init.error_handler_fn = keep_message;
    reporting = memory;
    init.max_image_width = init.max_image_height = RENDER_MAX_SIDE;
    init.max_tile_width = init.max_tile_height = RENDER_MAX_SIDE;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return init;
}

/* ---- Writing --------------------------------------------------------------------------------- */

/* Where a channel's floats lie in an image. */
typedef struct exr_plane {
    char name[40];
    const float *data; /* first value */
    int stride;        /* floats from pixel to pixel */
} exr_plane;

static int image_planes(const render_image *image, exr_plane *planes)
{
    int count = 0;
    for (int k = 0; k < 3; k++)
        planes[count++] = (exr_plane){{"RGB"[k]}, image->rgb + k, 3};
    if (image->alpha)
        planes[count++] = (exr_plane){"A", image->alpha, 1};
    for (int i = 0; i < image->layer_count; i++)
        for (int k = 0; k < 3; k++) {
            exr_plane *plane = &planes[count++];
            snprintf(plane->name, sizeof plane->name, "%s.%c", image->layers[i].name, "RGB"[k]);
            plane->data = image->layers[i].rgb + k;
            plane->stride = 3;
        }
    return count;
}

static exr_result_t write_header(exr_context_t context, const render_image *image,
                                 const render_write_options *options, const exr_plane *planes,
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
static void gather_lines(const exr_plane *plane, int width, int y, int lines, int half, float *out)
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

static const exr_plane *find_plane(const exr_plane *planes, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(planes[i].name, name) == 0)
            return &planes[i];
    return NULL;
}

/* One chunk of lines: lines is scratch for all its channels. */
static exr_result_t write_chunk(exr_context_t context, exr_encode_pipeline_t *pipe, int y,
                                int width, int half, const exr_plane *planes, int count,
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
                                 const exr_plane *planes, int count)
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
    exr_plane planes[4 + 3 * RENDER_MAX_LAYERS];
    int count = image_planes(image, planes);
    render_bytes output = {0};
    exr_memory memory = {.bytes = &output};
    exr_context_initializer_t init = initializer(&memory);
    init.write_fn = write_memory;
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
    reporting = NULL;
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

/* ---- Reading --------------------------------------------------------------------------------- */

typedef struct exr_input {
    exr_context_t context;
    const exr_memory *memory;
    const char *name;
    hnbrdf_error *error;
    size_t max_pixels;
    exr_attr_box2i_t window;
    exr_storage_t storage;
    int grey; /* Y alone */
} exr_input;

static hnbrdf_result library_error(const exr_input *in, exr_result_t result)
{
    return hnbrdf_fail(
        in->error,
        in->memory->out_of_memory || result == EXR_ERR_OUT_OF_MEMORY ? HNBRDF_ERROR_MEMORY
                                                                     : HNBRDF_ERROR_FORMAT,
        "%s: OpenEXR: %s", in->name,
        in->memory->message[0] ? in->memory->message : exr_get_default_error_message(result));
}

static hnbrdf_result check_compression(const exr_input *in)
{
    exr_compression_t compression;
    exr_result_t result = exr_get_compression(in->context, 0, &compression);
    if (result != EXR_ERR_SUCCESS)
        return library_error(in, result);
    if (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB)
        return hnbrdf_fail(
            in->error, HNBRDF_ERROR_UNSUPPORTED,
            "%s: %s compression, which the OpenEXR C library cannot decode: save the file "
            "again with ZIP or PIZ compression, or as Radiance .hdr",
            in->name, compression == EXR_COMPRESSION_DWAA ? "DWAA" : "DWAB");
    return HNBRDF_OK;
}

static hnbrdf_result check_channels(exr_input *in)
{
    const exr_attr_chlist_t *list;
    exr_result_t result = exr_get_channels(in->context, 0, &list);
    if (result != EXR_ERR_SUCCESS)
        return library_error(in, result);
    if (list->num_channels < 1 || list->num_channels > MAX_CHANNELS)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_LIMIT, "%s: %d channels: expected 1 to %d",
                           in->name, list->num_channels, MAX_CHANNELS);
    int colours = 0, grey = 0;
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        int colour = entry->name.length == 1 && strchr("RGB", entry->name.str[0]) != NULL;
        int luminance = entry->name.length == 1 && entry->name.str[0] == 'Y';
        int used = colour || luminance || (entry->name.length == 1 && entry->name.str[0] == 'A');
        if (used && (entry->x_sampling != 1 || entry->y_sampling != 1 ||
                     (entry->pixel_type != EXR_PIXEL_HALF && entry->pixel_type != EXR_PIXEL_FLOAT)))
            return hnbrdf_fail(
                in->error, HNBRDF_ERROR_UNSUPPORTED,
                "%s: channel %s is subsampled or of integers: expected half or float values "
                "for every pixel",
                in->name, entry->name.str);
        colours += colour;
        grey += luminance;
    }
    in->grey = colours == 0 && grey == 1;
    if (colours != 3 && !in->grey)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: no colour picture: expected the channels R, G, B, or Y alone",
                           in->name);
    return HNBRDF_OK;
}

/* Everything that decides how much memory will be asked for. */
static hnbrdf_result check_size(exr_input *in, int *width, int *height)
{
    exr_result_t result = exr_get_storage(in->context, 0, &in->storage);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_data_window(in->context, 0, &in->window);
    if (result != EXR_ERR_SUCCESS)
        return library_error(in, result);
    if (in->storage != EXR_STORAGE_SCANLINE && in->storage != EXR_STORAGE_TILED)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: deep data: expected a flat picture", in->name);
    int64_t w = (int64_t)in->window.max.x - in->window.min.x + 1;
    int64_t h = (int64_t)in->window.max.y - in->window.min.y + 1;
    if (w < 1 || h < 1 || w > RENDER_MAX_SIDE || h > RENDER_MAX_SIDE ||
        w * h > (int64_t)in->max_pixels)
        return hnbrdf_fail(
            in->error, HNBRDF_ERROR_LIMIT,
            "%s: data window of %lld x %lld: expected sides of 1 to %d and at most %zu pixels",
            in->name, (long long)w, (long long)h, RENDER_MAX_SIDE, in->max_pixels);
    const uint64_t most = MAX_CHUNK_SHARE * (uint64_t)in->max_pixels;
    uint64_t chunk;
    result = exr_get_chunk_unpacked_size(in->context, 0, &chunk);
    if (result != EXR_ERR_SUCCESS)
        return library_error(in, result);
    if (chunk > most)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_LIMIT,
                           "%s: blocks of %llu bytes: expected at most %llu", in->name,
                           (unsigned long long)chunk, (unsigned long long)most);
    *width = (int)w;
    *height = (int)h;
    return HNBRDF_OK;
}

static void point_channel(const exr_input *in, exr_coding_channel_info_t *channel,
                          const render_image *image, size_t pixel)
{
    const char *name = channel->channel_name;
    const char *colours = in->grey ? "Y" : "RGB";
    const char *place = name[0] && !name[1] ? strchr(colours, name[0]) : NULL;
    int alpha = strcmp(name, "A") == 0 && image->alpha;
    int stride = alpha ? 1 : 3;
    channel->decode_to_ptr = NULL; /* skipped */
    if (!place && !alpha)
        return;
    float *to = alpha ? image->alpha + pixel : image->rgb + 3 * pixel + (place - colours);
    channel->decode_to_ptr = (uint8_t *)to;
    channel->user_data_type = EXR_PIXEL_FLOAT;
    channel->user_bytes_per_element = sizeof(float);
    channel->user_pixel_stride = stride * (int32_t)sizeof(float);
    channel->user_line_stride = stride * image->width * (int32_t)sizeof(float);
}

/* Decodes one chunk to the pixels whose top left corner is (x, y) in the image. */
static exr_result_t read_chunk(const exr_input *in, exr_decode_pipeline_t *pipe,
                               const exr_chunk_info_t *chunk, const render_image *image, int x,
                               int y)
{
    if (x < 0 || y < 0 || chunk->width < 1 || chunk->height < 1 ||
        chunk->width > image->width - x || chunk->height > image->height - y)
        return EXR_ERR_CORRUPT_CHUNK;
    int first = pipe->context == NULL;
    exr_result_t result = first ? exr_decoding_initialize(in->context, 0, chunk, pipe)
                                : exr_decoding_update(in->context, 0, chunk, pipe);
    if (result != EXR_ERR_SUCCESS)
        return result;
    size_t pixel = (size_t)y * (size_t)image->width + (size_t)x;
    for (int i = 0; i < pipe->channel_count; i++)
        point_channel(in, &pipe->channels[i], image, pixel);
    if (first)
        result = exr_decoding_choose_default_routines(in->context, 0, pipe);
    return result == EXR_ERR_SUCCESS ? exr_decoding_run(in->context, 0, pipe) : result;
}

static exr_result_t read_scanlines(const exr_input *in, exr_decode_pipeline_t *pipe,
                                   const render_image *image)
{
    int32_t step;
    exr_result_t result = exr_get_scanlines_per_chunk(in->context, 0, &step);
    if (result == EXR_ERR_SUCCESS && step < 1)
        result = EXR_ERR_CORRUPT_CHUNK;
    for (int y = 0; y < image->height && result == EXR_ERR_SUCCESS; y += step) {
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(in->context, 0, y + in->window.min.y, &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = read_chunk(in, pipe, &chunk, image, 0, y);
    }
    return result;
}

static exr_result_t read_tiles(const exr_input *in, exr_decode_pipeline_t *pipe,
                               const render_image *image)
{
    int32_t width, height;
    exr_result_t result = exr_get_tile_sizes(in->context, 0, 0, 0, &width, &height);
    if (result == EXR_ERR_SUCCESS && (width < 1 || height < 1))
        result = EXR_ERR_CORRUPT_CHUNK;
    for (int64_t y = 0; result == EXR_ERR_SUCCESS && y * height < image->height; y++)
        for (int64_t x = 0; result == EXR_ERR_SUCCESS && x * width < image->width; x++) {
            exr_chunk_info_t chunk;
            result = exr_read_tile_chunk_info(in->context, 0, (int)x, (int)y, 0, 0, &chunk);
            if (result == EXR_ERR_SUCCESS)
                result = read_chunk(in, pipe, &chunk, image, (int)(x * width), (int)(y * height));
        }
    return result;
}

static void spread_grey(render_image *image)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++)
        image->rgb[3 * i + 1] = image->rgb[3 * i + 2] = image->rgb[3 * i];
}

static hnbrdf_result read_image(exr_input *in, render_image *image)
{
    int width = 0, height = 0;
    hnbrdf_result result = check_compression(in);
    if (result == HNBRDF_OK)
        result = check_channels(in);
    if (result == HNBRDF_OK)
        result = check_size(in, &width, &height);
    if (result != HNBRDF_OK)
        return result;
    const exr_attr_chlist_t *list;
    int alpha = 0;
    exr_get_channels(in->context, 0, &list);
    for (int i = 0; i < list->num_channels; i++)
        alpha |= strcmp(list->entries[i].name.str, "A") == 0;
    render_image out;
    result = render_image_create(width, height, alpha, &out, in->error);
    if (result != HNBRDF_OK)
        return result;
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t read = in->storage == EXR_STORAGE_TILED ? read_tiles(in, &pipe, &out)
                                                         : read_scanlines(in, &pipe, &out);
    exr_decoding_destroy(in->context, &pipe);
    if (read != EXR_ERR_SUCCESS) {
        render_image_free(&out);
        return library_error(in, read);
    }
    if (in->grey)
        spread_grey(&out);
    *image = out;
    return HNBRDF_OK;
}

hnbrdf_result render_exr_decode(const void *data, size_t size, const char *name,
                                const render_limits *limits, render_image *image,
                                hnbrdf_error *error)
{
    exr_memory memory = {.data = data, .size = size};
    exr_context_initializer_t init = initializer(&memory);
    init.read_fn = read_memory;
    init.size_fn = memory_size;
    exr_input in = {.memory = &memory,
                    .name = name,
                    .error = error,
                    .max_pixels = render_limits_settle(limits).max_pixels};
    const exr_result_t started = exr_start_read(&in.context, "memory", &init);
    hnbrdf_result result =
        started == EXR_ERR_SUCCESS ? read_image(&in, image) : library_error(&in, started);
    if (started == EXR_ERR_SUCCESS)
        exr_finish(&in.context);
    reporting = NULL;
    return result;
}

#endif
