/* radiance.c: read Radiance .hdr pictures (RGBE and XYZE; Ward 1991): where their pixels belong and
 * what colours they are.
 *
 * Radiance's own primaries are nearly those of Rec. 709, about another white, which is a monitor's
 * white when shown; like everybody we take RGB without PRIMARIES for Rec. 709, and with them if
 * they are the usual ones, which programs write without converting anything. XYZ goes the way
 * back that Radiance's ra_xyze came: to these primaries, about equal energy. Other primaries are
 * converted, their white to white. */
#include "image/radiance.h"

#include "base/error.h"
#include "base/number.h"

#include <math.h>
#include <stdlib.h>

/* value = mantissa / 256 * 2^(exponent - 128); exponent 0 is black. */
static void to_float(const unsigned char *rgbe, float *rgb)
{
    const float scale = rgbe[3] ? ldexpf(1.0f, rgbe[3] - 136) : 0.0f;
    for (int k = 0; k < 3; k++)
        rgb[k] = scale * (float)rgbe[k];
}

/* Puts a scanline where it belongs. */
static void place(const radiance_header *header, int line, const unsigned char *rgbe,
                  render_image *image)
{
    const int length = header->by_columns ? header->height : header->width;
    for (int i = 0; i < length; i++) {
        const int u = header->by_columns ? line : i, v = header->by_columns ? i : line;
        const int x = header->from_right ? header->width - 1 - u : u;
        const int y = header->from_bottom ? header->height - 1 - v : v;
        to_float(rgbe + 4 * i, image->rgb + 3 * ((size_t)y * (size_t)header->width + (size_t)x));
    }
}

static hnbrdf_result read_pixels(radiance_input *in, const radiance_header *header,
                                 render_image *image)
{
    const int lines = header->by_columns ? header->width : header->height;
    const int length = header->by_columns ? header->height : header->width;
    const int is_flat = in->size - in->at == 4 * (size_t)lines * (size_t)length;
    unsigned char *rgbe = malloc(4 * (size_t)length);
    if (!rgbe)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_MEMORY, "%s: no memory for a scanline",
                           in->name);
    hnbrdf_result result = HNBRDF_OK;
    for (int line = 0; line < lines && result == HNBRDF_OK; line++) {
        result = radiance_read_scanline(in, is_flat, length, rgbe);
        if (result == HNBRDF_OK)
            place(header, line, rgbe, image);
    }
    free(rgbe);
    return result;
}

static void convert(const radiance_input *in, const radiance_header *header, render_image *image)
{
    const colour_primaries *own = &header->primaries;
    const int is_balanced = colour_is_near(own->white, colour_rec709.white);
    const float *neutral = is_balanced ? NULL : own->white;
    colour_matrix to_xyz = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, from_xyz;
    float matrix[3][3];
    if (!header->is_xyz && (!header->has_primaries || colour_are_near(own, &colour_rec709)))
        return;
    if (!header->is_xyz) {
        (void)colour_to_xyz(own, to_xyz);
        colour_to_rec709(to_xyz, neutral, matrix);
        colour_tell(&in->notes, in->name, own, neutral ? ", adapted from its white" : "");
    } else if (header->has_primaries) {
        colour_to_rec709(to_xyz, neutral, matrix);
        hnbrdf_note(&in->notes, "%s: converted to Rec. 709 from CIE XYZ of white (%s, %s)",
                    in->name, HNBRDF_NUMBER(own->white[0]), HNBRDF_NUMBER(own->white[1]));
    } else {
        (void)colour_from_xyz(own, from_xyz);
        for (int i = 0; i < 9; i++)
            matrix[i / 3][i % 3] = (float)from_xyz[i / 3][i % 3];
        hnbrdf_note(&in->notes,
                    "%s: converted to RGB from CIE XYZ by Radiance's primaries, equal energy white",
                    in->name);
    }
    colour_convert(matrix, image->rgb, image->width * image->height);
}

static hnbrdf_result check_size(const radiance_input *in, const radiance_header *header,
                                size_t max_pixels)
{
    const int width = header->width, height = header->height;
    const size_t left = in->size - in->at;
    const size_t least = radiance_least_size((size_t)(header->by_columns ? width : height),
                                             header->by_columns ? height : width);
    if ((size_t)width * (size_t)height > max_pixels)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_LIMIT,
                           "%s: %d x %d pixels: expected at most %zu", in->name, width, height,
                           max_pixels);
    if (left < least)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT,
                           "%s: %zu bytes of pixels, expected at least %zu for %d x %d", in->name,
                           left, least, width, height);
    return HNBRDF_OK;
}

hnbrdf_result render_radiance_decode(const void *data, size_t size, const char *name,
                                     const render_read_options *options, render_image *image,
                                     hnbrdf_error *error)
{
    const render_read_options settled = render_read_options_settle(options);
    radiance_input in = {
        .data = data, .size = size, .name = name, .notes = settled.notes, .error = error};
    radiance_header header;
    render_image out;
    hnbrdf_result result = radiance_read_header(&in, &header);
    if (result == HNBRDF_OK)
        result = check_size(&in, &header, settled.max_pixels);
    if (result == HNBRDF_OK)
        result = render_image_create(header.width, header.height, 0, &out, error);
    if (result != HNBRDF_OK)
        return result;
    result = read_pixels(&in, &header, &out);
    if (result == HNBRDF_OK) {
        convert(&in, &header, &out);
        *image = out;
    } else {
        render_image_free(&out);
    }
    return result;
}
