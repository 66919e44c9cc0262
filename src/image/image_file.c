/* image_file.c: images to and from files, by their format. */
#include "image/image.h"

#include "base/error.h"
#include "base/files.h"
#include "base/foreign.h"
#include "base/text.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

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
    FILE *file = hnbrdf_open_whole(path, path, error);
    if (!file)
        return HNBRDF_ERROR_IO;
    hnbrdf_result result = read_stream(file, path, limit, bytes, error);
    fclose(file);
    return result;
}

static hnbrdf_result fail_foreign(const char *path, const render_bytes *bytes, hnbrdf_error *error)
{
    const char *foreign = hnbrdf_foreign_file(bytes->data, bytes->size);
    if (!foreign)
        foreign = hnbrdf_own_file(bytes->data, bytes->size);
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                       "%s: %s%sneither OpenEXR nor Radiance .hdr (%zu bytes)", path,
                       foreign ? foreign : "", foreign ? "; " : "", bytes->size);
}

static hnbrdf_result decode(const render_bytes *bytes, const char *path,
                            const render_read_options *options, render_image *image,
                            hnbrdf_error *error)
{
    static const unsigned char exr_magic[4] = {0x76, 0x2f, 0x31, 0x01};
    if (bytes->size >= 4 && memcmp(bytes->data, exr_magic, 4) == 0)
        return render_exr_decode(bytes->data, bytes->size, path, options, image, error);
    if (!render_is_radiance(bytes->data, bytes->size))
        return fail_foreign(path, bytes, error);
    if (options && options->layer)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "%s: no layer '%s': a Radiance picture has none", path, options->layer);
    return render_radiance_decode(bytes->data, bytes->size, path, options, image, error);
}

hnbrdf_result render_image_read(const char *path, const render_read_options *options,
                                render_image *image, hnbrdf_error *error)
{
    const render_read_options settled = render_read_options_settle(options);
    render_bytes bytes = {0};
    render_image read = {0};
    hnbrdf_result result = render_file_read(path, settled.max_bytes, &bytes, error);
    if (result == HNBRDF_OK)
        result = decode(&bytes, path, &settled, &read, error);
    free(bytes.data);
    if (result == HNBRDF_OK && settled.repair)
        result = render_image_repair(&read, path, &settled.notes, error);
    if (result == HNBRDF_OK)
        *image = read;
    else
        render_image_free(&read);
    return result;
}

hnbrdf_result render_image_write(const render_image *image, const char *path,
                                 const render_write_options *options, hnbrdf_error *error)
{
    static const render_write_options defaults;
    options = options ? options : &defaults;
    render_bytes bytes = {0};
    hnbrdf_result result;
    if (hnbrdf_ends_with(path, ".exr"))
        result = render_exr_encode(image, options, &bytes, error);
    else if (hnbrdf_ends_with(path, ".png"))
        result = render_png_encode(image, options->exposure, &bytes, error);
    else
        result = hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                             "%s: expected a name ending in .exr or .png", path);
    if (result == HNBRDF_OK)
        result = hnbrdf_write_file(path, bytes.data, bytes.size, error);
    free(bytes.data);
    return result;
}
