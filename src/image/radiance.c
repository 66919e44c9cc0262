/* radiance.c: read Radiance .hdr pictures (RGBE; Ward 1991), flat or run-length coded. */
#include "image/image.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct reader {
    const unsigned char *data;
    size_t size, at;
    const char *name;
    hnbrdf_error *error;
} reader;

static hnbrdf_result bad(const reader *in, const char *what)
{
    return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT, "%s: at byte %zu: %s", in->name, in->at,
                       what);
}

/* Copies one header line without its end into text, truncated to size, control characters made
 * '?'; 0 at the end of the file. */
static int header_line(reader *in, char *text, size_t size)
{
    size_t length = 0;
    while (in->at < in->size) {
        char c = (char)in->data[in->at++];
        if (c == '\n') {
            if (length > 0 && in->data[in->at - 2] == '\r')
                length--;
            text[length] = 0;
            return 1;
        }
        if (length + 1 < size)
            text[length++] = (unsigned char)c < ' ' ? '?' : c;
    }
    return 0;
}

static int positive(const char **text)
{
    long value = 0;
    const char *c = *text;
    while (*c >= '0' && *c <= '9' && value <= RENDER_MAX_SIDE)
        value = 10 * value + (*c++ - '0');
    int complete = c != *text && !(*c >= '0' && *c <= '9');
    *text = c;
    return complete && value <= RENDER_MAX_SIDE ? (int)value : 0;
}

/* "-Y 512 +X 1024": top row first; "+Y": bottom row first. Turned pictures are not environments. */
static hnbrdf_result resolution(reader *in, int *width, int *height, int *bottom_up)
{
    char line[128];
    if (!header_line(in, line, sizeof line))
        return bad(in, "the file ends before the line with the resolution");
    const char *text = line + 3;
    if ((strncmp(line, "-Y ", 3) != 0 && strncmp(line, "+Y ", 3) != 0) ||
        !(*height = positive(&text)) || strncmp(text, " +X ", 4) != 0 ||
        (text += 4, !(*width = positive(&text))))
        return hnbrdf_fail(
            in->error, HNBRDF_ERROR_FORMAT,
            "%s: resolution '%s': expected '-Y HEIGHT +X WIDTH' with sides of 1 to %d", in->name,
            line, RENDER_MAX_SIDE);
    *bottom_up = line[0] == '+';
    return HNBRDF_OK;
}

static hnbrdf_result header(reader *in, int *width, int *height, int *bottom_up)
{
    char line[128];
    if (!header_line(in, line, sizeof line) || strncmp(line, "#?", 2) != 0)
        return bad(in, "no Radiance header: expected a first line that starts with '#?'");
    for (;;) {
        if (!header_line(in, line, sizeof line))
            return bad(in, "the file ends inside the header");
        if (line[0] == 0)
            return resolution(in, width, height, bottom_up);
        if (strncmp(line, "FORMAT=", 7) == 0 && strcmp(line + 7, "32-bit_rle_rgbe") != 0)
            return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                               "%s: FORMAT '%s': expected 32-bit_rle_rgbe", in->name, line + 7);
    }
}

/* One of the four planes of a run-length coded scanline, to every fourth byte of row. */
static hnbrdf_result plane(reader *in, unsigned char *row, int width)
{
    for (int x = 0; x < width;) {
        if (in->at + 2 > in->size)
            return bad(in, "the file ends inside a scanline");
        int count = in->data[in->at++];
        int run = count > 128;
        count = run ? count - 128 : count;
        if (count == 0 || count > width - x)
            return bad(in, "a run that does not fit its scanline");
        if (!run && in->at + (size_t)count > in->size)
            return bad(in, "the file ends inside a scanline");
        for (int i = 0; i < count; i++, x++)
            row[4 * x] = run ? in->data[in->at] : in->data[in->at + (size_t)i];
        in->at += run ? 1 : (size_t)count;
    }
    return HNBRDF_OK;
}

static hnbrdf_result scanline(reader *in, unsigned char *row, int width)
{
    const unsigned char *start = in->data + in->at;
    size_t left = in->size - in->at, flat = 4 * (size_t)width;
    if (left >= 4 && start[0] == 2 && start[1] == 2 && start[2] < 128 && width >= 8 &&
        width < 32768) {
        if (start[2] * 256 + start[3] != width)
            return bad(in, "a scanline of another width than the picture's");
        in->at += 4;
        for (int k = 0; k < 4; k++) {
            hnbrdf_result result = plane(in, row + k, width);
            if (result != HNBRDF_OK)
                return result;
        }
        return HNBRDF_OK;
    }
    if (left < flat)
        return bad(in, "the file ends inside a scanline");
    memcpy(row, start, flat);
    in->at += flat;
    for (int x = 0; x < width; x++)
        if (row[4 * x] == 1 && row[4 * x + 1] == 1 && row[4 * x + 2] == 1)
            return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                               "%s: coded with the run lengths of Radiance before 1991", in->name);
    return HNBRDF_OK;
}

/* value = mantissa / 256 * 2^(exponent - 128); exponent 0 is black. */
static void to_float(const unsigned char *rgbe, float *rgb)
{
    float scale = rgbe[3] ? ldexpf(1.0f, rgbe[3] - 136) : 0.0f;
    for (int k = 0; k < 3; k++)
        rgb[k] = scale * (float)rgbe[k];
}

static hnbrdf_result pixels(reader *in, render_image *image, int bottom_up)
{
    unsigned char *row = malloc(4 * (size_t)image->width);
    if (!row)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_MEMORY, "%s: no memory for a scanline",
                           in->name);
    hnbrdf_result result = HNBRDF_OK;
    for (int y = 0; y < image->height && result == HNBRDF_OK; y++) {
        result = scanline(in, row, image->width);
        size_t line = (size_t)(bottom_up ? image->height - 1 - y : y);
        float *out = image->rgb + 3 * (size_t)image->width * line;
        for (int x = 0; x < image->width && result == HNBRDF_OK; x++)
            to_float(row + 4 * x, out + 3 * x);
    }
    free(row);
    return result;
}

hnbrdf_result render_radiance_decode(const void *data, size_t size, const char *name,
                                     const render_read_options *options, render_image *image,
                                     hnbrdf_error *error)
{
    const size_t max_pixels = render_read_options_settle(options).max_pixels;
    reader in = {.data = data, .size = size, .name = name, .error = error};
    int width = 0, height = 0, bottom_up = 0;
    hnbrdf_result result = header(&in, &width, &height, &bottom_up);
    if (result != HNBRDF_OK)
        return result;
    /* The shortest coding of a scanline: 2 bytes for 127 pixels, in each of 4 planes. */
    size_t least =
        (size_t)height * (width < 8 ? 4 * (size_t)width : 4 + 8 * (((size_t)width + 126) / 127));
    if ((size_t)width * (size_t)height > max_pixels)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "%s: %d x %d pixels: expected at most %zu",
                           name, width, height, max_pixels);
    if (size - in.at < least)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: %zu bytes of pixels, expected at least %zu for %d x %d", name,
                           size - in.at, least, width, height);
    render_image out;
    result = render_image_create(width, height, 0, &out, error);
    if (result != HNBRDF_OK)
        return result;
    result = pixels(&in, &out, bottom_up);
    if (result == HNBRDF_OK)
        *image = out;
    else
        render_image_free(&out);
    return result;
}
