/* radiance_writer.c: Radiance pictures for the tests. */
#include "radiance_writer.h"

char radiance_notes[2000];

void radiance_put(render_bytes *bytes, const void *data, size_t size)
{
    assert_int_equal(render_bytes_put(bytes, bytes->size, data, size), 0);
}

static void put_bytes(render_bytes *out, int a, int b)
{
    const unsigned char bytes[2] = {(unsigned char)a, (unsigned char)b};
    radiance_put(out, bytes, 2);
}

/* Runs (1, 1, 1, n), of more than 255 pixels as several whose counts are digits to the base 256. */
static void put_old_runs(render_bytes *out, const unsigned char *rgbe, int length)
{
    for (int x = 0, count; x < length; x += count) {
        for (count = 1; x + count < length; count++)
            if (memcmp(rgbe + 4 * (x + count), rgbe + 4 * x, 4) != 0)
                break;
        radiance_put(out, rgbe + 4 * x, 4);
        for (int left = count - 1; left > 0; left /= 256) {
            put_bytes(out, 1, 1);
            put_bytes(out, 1, left % 256);
        }
    }
}

/* A plane as runs of at most 127 and, one byte after the other, what does not repeat. */
static void put_plane(render_bytes *out, const unsigned char *rgbe, int length)
{
    for (int x = 0, count; x < length; x += count) {
        for (count = 1; x + count < length && count < 127; count++)
            if (rgbe[4 * (x + count)] != rgbe[4 * x])
                break;
        put_bytes(out, count > 1 ? 128 + count : 1, rgbe[4 * x]);
    }
}

static void put_scanline(render_bytes *out, const unsigned char *rgbe, int length,
                         radiance_coding coding)
{
    if (coding == RADIANCE_OLD_RUNS) {
        put_old_runs(out, rgbe, length);
    } else if (coding == RADIANCE_PLANES && length >= 8 && length <= 32767) {
        put_bytes(out, 2, 2);
        put_bytes(out, length / 256, length % 256);
        for (int k = 0; k < 4; k++)
            put_plane(out, rgbe + k, length);
    } else {
        radiance_put(out, rgbe, 4 * (size_t)length);
    }
}

static void put_resolution(render_bytes *out, int width, int height, int orientation)
{
    char x[32], y[32];
    snprintf(x, sizeof x, "%cX %d", orientation & 1 ? '-' : '+', width);
    snprintf(y, sizeof y, "%cY %d", orientation & 2 ? '+' : '-', height);
    char line[80];
    const int size =
        snprintf(line, sizeof line, "%s %s\n", orientation & 4 ? x : y, orientation & 4 ? y : x);
    radiance_put(out, line, (size_t)size);
}

render_bytes radiance_write(const char *header, int width, int height, int orientation,
                            radiance_coding coding, radiance_pixel *pixel)
{
    const int lines = orientation & 4 ? width : height, length = orientation & 4 ? height : width;
    unsigned char *rgbe = malloc(4 * (size_t)length);
    render_bytes out = {0};
    assert_non_null(rgbe);
    radiance_put(&out, header, strlen(header));
    put_resolution(&out, width, height, orientation);
    for (int line = 0; line < lines; line++) {
        for (int i = 0; i < length; i++) {
            const int u = orientation & 4 ? line : i, v = orientation & 4 ? i : line;
            pixel(orientation & 1 ? width - 1 - u : u, orientation & 2 ? height - 1 - v : v,
                  rgbe + 4 * i);
        }
        put_scanline(&out, rgbe, length, coding);
    }
    free(rgbe);
    return out;
}

static void keep_note(void *user, const char *line)
{
    (void)user;
    assert_true(strlen(radiance_notes) + strlen(line) + 2 < sizeof radiance_notes);
    strcat(strcat(radiance_notes, line), "\n");
}

hnbrdf_result radiance_read(const void *data, size_t size, render_image *image, hnbrdf_error *error)
{
    const render_read_options options = {.notes = {keep_note, NULL}};
    unsigned char *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    memcpy(copy, data, size);
    radiance_notes[0] = 0;
    memset(image, 0, sizeof *image);
    const hnbrdf_result result =
        render_radiance_decode(copy, size, "x.hdr", &options, image, error);
    free(copy);
    assert_true((result == HNBRDF_OK) == (image->rgb != NULL));
    if (result != HNBRDF_OK) {
        assert_true(strlen(error->text) > 10);
        for (const char *c = error->text; *c; c++)
            assert_true((unsigned char)*c >= ' ');
    }
    return result;
}

render_image radiance_expect(const void *data, size_t size)
{
    render_image image;
    hnbrdf_error error = {""};
    if (radiance_read(data, size, &image, &error) != HNBRDF_OK)
        fail_msg("%s", error.text);
    return image;
}

void radiance_expect_refused(const void *data, size_t size, hnbrdf_result expected,
                             const char *text)
{
    render_image image;
    hnbrdf_error error = {""};
    assert_int_equal(radiance_read(data, size, &image, &error), expected);
    if (!strstr(error.text, text))
        fail_msg("'%s' does not say '%s'", error.text, text);
}
