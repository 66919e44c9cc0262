/* exr_planes.c: the values of an OpenEXR picture, block by block, by the C library; by the C++
 * library where this one cannot.
 *
 * The library reads and decompresses a block; taking it apart is done here. Its own routines for
 * that (3.1) write through NULL where three half channels are not all wanted. */
#include "image/exr.h"

#include "base/error.h"
#include "core/half.h"

#include <stdlib.h>
#include <string.h>

/* Bytes of the largest block that is decoded at once, per pixel that a picture may have. */
enum { MAX_CHUNK_SHARE = 16 };

/* ---- One block ------------------------------------------------------------------------------- */

/* Where the block lies that is being decoded, in the data window. */
typedef struct block {
    const exr_picture *picture;
    int x, y;
} block;

static float float_at(const uint8_t *bytes, int is_half)
{
    if (is_half)
        return hnbrdf_float_of_half((uint16_t)(bytes[0] | bytes[1] << 8));
    return hnbrdf_bits_to_float((int32_t)((uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 |
                                          (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24));
}

static const exr_plane *plane_of(const exr_picture *picture, const char *channel)
{
    for (int k = 0; k < EXR_PLANES; k++)
        if (picture->planes[k].channel && strcmp(picture->planes[k].channel, channel) == 0)
            return &picture->planes[k];
    return NULL;
}

/* A line of one channel: count samples, the first one at (x, y) of the window. */
static exr_result_t put_line(const exr_plane *plane, int x, int y, int count, int is_half,
                             const uint8_t *bytes)
{
    const int row = y / plane->step, column = x / plane->step;
    if (row >= plane->height || count > plane->width - column)
        return EXR_ERR_CORRUPT_CHUNK;
    float *to = plane->values + (size_t)row * (size_t)plane->width + column;
    for (int i = 0; i < count; i++)
        to[i] = float_at(bytes + (is_half ? 2 : 4) * (size_t)i, is_half);
    return EXR_ERR_SUCCESS;
}

/* A block holds line after line, each channel after channel, little end first; of a channel that
 * is subsampled only the lines and pixels whose place is divisible. */
static exr_result_t take_apart(exr_decode_pipeline_t *pipe)
{
    const block *b = pipe->decoding_user_data;
    const uint8_t *at = pipe->unpacked_buffer;
    size_t left = pipe->chunk.unpacked_size;
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int y = b->y; y < b->y + pipe->chunk.height; y++)
        for (int c = 0; c < pipe->channel_count && result == EXR_ERR_SUCCESS; c++) {
            const exr_coding_channel_info_t *channel = &pipe->channels[c];
            const int is_half = channel->data_type == EXR_PIXEL_HALF;
            const int x_step = channel->x_samples, y_step = channel->y_samples;
            if (x_step < 1 || y_step < 1 || (b->picture->window.min.y + y) % y_step != 0)
                continue;
            const int count = (pipe->chunk.width + x_step - 1) / x_step;
            const size_t size = (size_t)count * (is_half ? 2 : 4);
            const exr_plane *plane = plane_of(b->picture, channel->channel_name);
            if (size > left)
                return EXR_ERR_CORRUPT_CHUNK;
            if (plane)
                result = put_line(plane, b->x, y, count, is_half, at);
            at += size;
            left -= size;
        }
    return result == EXR_ERR_SUCCESS && left > 0 ? EXR_ERR_CORRUPT_CHUNK : result;
}

/* The routines of the library for all but taking apart; no channel has a destination for its own.
 * A block that did not get smaller is stored as it is: the library (3.1) decodes it nevertheless
 * where it is B44. */
static exr_result_t choose_routines(const exr_input *in, exr_decode_pipeline_t *pipe,
                                    const exr_picture *picture)
{
    const int is_stored = pipe->chunk.packed_size == pipe->chunk.unpacked_size;
    if (pipe->chunk.packed_size > pipe->chunk.unpacked_size ||
        (!is_stored && picture->compression == EXR_COMPRESSION_NONE))
        return EXR_ERR_CORRUPT_CHUNK;
    for (int c = 0; c < pipe->channel_count; c++)
        pipe->channels[c].decode_to_ptr = NULL;
    const exr_result_t result =
        exr_decoding_choose_default_routines(in->context, picture->part, pipe);
    pipe->unpack_and_convert_fn = take_apart;
    if (is_stored)
        pipe->decompress_fn = NULL;
    return result;
}

/* Decodes the block whose top left corner is (x, y) in the data window. */
static exr_result_t read_block(const exr_input *in, const exr_picture *picture,
                               exr_decode_pipeline_t *pipe, const exr_chunk_info_t *chunk, int x,
                               int y)
{
    block b = {picture, x, y};
    if (x < 0 || y < 0 || chunk->width < 1 || chunk->height < 1 ||
        chunk->width > picture->width - x || chunk->height > picture->height - y)
        return EXR_ERR_CORRUPT_CHUNK;
    exr_result_t result = pipe->context
                              ? exr_decoding_update(in->context, picture->part, chunk, pipe)
                              : exr_decoding_initialize(in->context, picture->part, chunk, pipe);
    if (result == EXR_ERR_SUCCESS)
        result = choose_routines(in, pipe, picture);
    pipe->decoding_user_data = &b;
    if (result == EXR_ERR_SUCCESS)
        result = exr_decoding_run(in->context, picture->part, pipe);
    pipe->decoding_user_data = NULL;
    return result;
}

static exr_result_t read_lines(const exr_input *in, const exr_picture *picture,
                               exr_decode_pipeline_t *pipe)
{
    int32_t step;
    exr_result_t result = exr_get_scanlines_per_chunk(in->context, picture->part, &step);
    if (result == EXR_ERR_SUCCESS && step < 1)
        result = EXR_ERR_CORRUPT_CHUNK;
    for (int y = 0; y < picture->height && result == EXR_ERR_SUCCESS; y += step) {
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(in->context, picture->part, y + picture->window.min.y,
                                              &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = read_block(in, picture, pipe, &chunk, 0, y);
    }
    return result;
}

/* Of the largest level. */
static exr_result_t read_tiles(const exr_input *in, const exr_picture *picture,
                               exr_decode_pipeline_t *pipe)
{
    int32_t width, height;
    exr_result_t result = exr_get_tile_sizes(in->context, picture->part, 0, 0, &width, &height);
    if (result == EXR_ERR_SUCCESS && (width < 1 || height < 1))
        result = EXR_ERR_CORRUPT_CHUNK;
    for (int64_t y = 0; result == EXR_ERR_SUCCESS && y * height < picture->height; y++)
        for (int64_t x = 0; result == EXR_ERR_SUCCESS && x * width < picture->width; x++) {
            exr_chunk_info_t chunk;
            result =
                exr_read_tile_chunk_info(in->context, picture->part, (int)x, (int)y, 0, 0, &chunk);
            if (result == EXR_ERR_SUCCESS)
                result = read_block(in, picture, pipe, &chunk, (int)(x * width), (int)(y * height));
        }
    return result;
}

static hnbrdf_result read_by_c(const exr_input *in, const exr_picture *picture)
{
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t result = picture->storage == EXR_STORAGE_TILED ? read_tiles(in, picture, &pipe)
                                                                : read_lines(in, picture, &pipe);
    exr_decoding_destroy(in->context, &pipe);
    return result == EXR_ERR_SUCCESS ? HNBRDF_OK : exr_library_error(in, result);
}

/* ---- By which library ------------------------------------------------------------------------ */

/* Version 3.1 of the C library does not know DWAA and DWAB. */
static int is_beyond_c(const exr_picture *picture)
{
    int major = 0, minor = 0, patch;
    const char *extra;
    exr_get_library_version(&major, &minor, &patch, &extra);
    return (picture->compression == EXR_COMPRESSION_DWAA ||
            picture->compression == EXR_COMPRESSION_DWAB) &&
           (major < 3 || (major == 3 && minor < 2));
}

#if defined(HNBRDF_WITH_OPENEXR_CXX)
static hnbrdf_result read_by_cxx(const exr_input *in, const exr_picture *picture)
{
    char message[200] = "";
    switch (
        exr_read_planes_cxx(in->memory->data, in->memory->size, picture, message, sizeof message)) {
    case 0:
        return HNBRDF_OK;
    case EXR_CXX_MEMORY:
        return hnbrdf_fail(in->error, HNBRDF_ERROR_MEMORY, "%s: no memory to decode it", in->name);
    default:
        return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT, "%s: OpenEXR: %s", in->name, message);
    }
}
#else
static hnbrdf_result read_by_cxx(const exr_input *in, const exr_picture *picture)
{
    return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                       "%s: %s compression, which the OpenEXR C library cannot decode, and this "
                       "program was built without the C++ one: save the file again with ZIP or PIZ "
                       "compression, or as Radiance .hdr",
                       in->name, picture->compression == EXR_COMPRESSION_DWAA ? "DWAA" : "DWAB");
}
#endif

static hnbrdf_result check_block_size(const exr_input *in, const exr_picture *picture)
{
    const uint64_t most = MAX_CHUNK_SHARE * (uint64_t)in->options.max_pixels;
    uint64_t size;
    const exr_result_t result = exr_get_chunk_unpacked_size(in->context, picture->part, &size);
    if (result != EXR_ERR_SUCCESS)
        return exr_library_error(in, result);
    if (size > most)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_LIMIT,
                           "%s: blocks of %llu bytes: expected at most %llu", in->name,
                           (unsigned long long)size, (unsigned long long)most);
    return HNBRDF_OK;
}

hnbrdf_result exr_read_planes(const exr_input *in, exr_picture *picture)
{
    const hnbrdf_result checked = check_block_size(in, picture);
    if (checked != HNBRDF_OK)
        return checked;
    for (int k = 0; k < EXR_PLANES; k++) {
        exr_plane *plane = &picture->planes[k];
        if (!plane->channel)
            continue;
        plane->width = (picture->width + plane->step - 1) / plane->step;
        plane->height = (picture->height + plane->step - 1) / plane->step;
        plane->values = calloc((size_t)plane->width * (size_t)plane->height, sizeof(float));
        if (!plane->values)
            return hnbrdf_fail(in->error, HNBRDF_ERROR_MEMORY, "%s: no memory for %d x %d pixels",
                               in->name, picture->width, picture->height);
    }
    in->memory->message[0] = 0; /* of attributes that are not there */
    return is_beyond_c(picture) ? read_by_cxx(in, picture) : read_by_c(in, picture);
}

void exr_free_planes(exr_picture *picture)
{
    for (int k = 0; k < EXR_PLANES; k++) {
        free(picture->planes[k].values);
        picture->planes[k].values = NULL;
    }
}
