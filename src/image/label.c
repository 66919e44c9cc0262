/* label.c: draw text as strokes of even weight with round ends, anti-aliased by distance. */
#include "image/label.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_SEGMENTS = 128, CURVE_STEPS = 6 };
static const double letter_space = 3.2, stroke = 1.55, x_units = 10.0; /* on the glyphs' grid */

typedef struct segment {
    double x0, y0, x1, y1;
} segment;

/* ---- Text ------------------------------------------------------------------------------------ */

/* Next code point of UTF-8; bytes that are none count as U+FFFD one by one. */
static unsigned next_code(const char **text)
{
    const unsigned char *t = (const unsigned char *)*text;
    int more = t[0] >= 0xf0 ? 3 : t[0] >= 0xe0 ? 2 : t[0] >= 0xc0 ? 1 : 0;
    unsigned code = more == 3 ? t[0] & 7u : more == 2 ? t[0] & 15u : more == 1 ? t[0] & 31u : t[0];
    int length = 1;
    for (; length <= more && (t[length] & 0xc0) == 0x80; length++)
        code = code << 6 | (t[length] & 63u);
    int valid = length == more + 1 && (t[0] < 0x80 || more > 0);
    *text += valid ? length : 1;
    return valid ? code : 0xfffd;
}

double render_text_width(const char *text, double x_height)
{
    double width = 0.0;
    while (*text)
        width += render_glyph_find(next_code(&text))->width + letter_space;
    return width > 0.0 ? (width - letter_space + stroke) * x_height / x_units : 0.0;
}

void render_text_shorten(const char *text, double x_height, double width, char *out, size_t size)
{
    static const char ellipsis[] = "\xe2\x80\xa6";
    if (strlen(text) < size && render_text_width(text, x_height) <= width) {
        strcpy(out, text);
        return;
    }
    size_t kept = 0;
    for (const char *at = text; *at;) {
        const char *after = at;
        next_code(&after);
        size_t length = (size_t)(after - text);
        if (length + sizeof ellipsis > size)
            break;
        memcpy(out, text, length);
        memcpy(out + length, ellipsis, sizeof ellipsis);
        if (render_text_width(out, x_height) > width)
            break;
        kept = length;
        at = after;
    }
    memcpy(out, text, kept);
    memcpy(out + kept, ellipsis, sizeof ellipsis);
}

/* ---- Paths ----------------------------------------------------------------------------------- */

static double number(const char **path)
{
    int value = 0;
    while (**path == ' ')
        ++*path;
    int negative = **path == '-';
    *path += negative;
    while (**path >= '0' && **path <= '9')
        value = 10 * value + (*(*path)++ - '0');
    return negative ? -value : value;
}

static int flatten(const char *path, segment *segments)
{
    int count = 0;
    double x = 0.0, y = 0.0;
    while (*path && count + CURVE_STEPS <= MAX_SEGMENTS) {
        char command = *path++;
        double cx = x, cy = y;
        if (command == 'Q') {
            cx = number(&path);
            cy = number(&path);
        }
        double ex = number(&path), ey = number(&path), fromx = x, fromy = y;
        int steps = command == 'Q' ? CURVE_STEPS : command == 'L' ? 1 : 0;
        for (int i = 1; i <= steps; i++) {
            double t = (double)i / steps, a = (1.0 - t) * (1.0 - t), b = 2.0 * t * (1.0 - t),
                   c = t * t;
            double nx = steps == 1 ? ex : a * fromx + b * cx + c * ex;
            double ny = steps == 1 ? ey : a * fromy + b * cy + c * ey;
            segments[count++] = (segment){x, y, nx, ny};
            x = nx;
            y = ny;
        }
        x = ex;
        y = ey;
    }
    return count;
}

static double distance(const segment *s, double x, double y)
{
    double dx = s->x1 - s->x0, dy = s->y1 - s->y0, px = x - s->x0, py = y - s->y0;
    double length2 = dx * dx + dy * dy, t = length2 > 0.0 ? (px * dx + py * dy) / length2 : 0.0;
    t = fmin(1.0, fmax(0.0, t));
    return hypot(px - t * dx, py - t * dy);
}

/* ---- Pixels ---------------------------------------------------------------------------------- */

static void blend(render_image *image, int x, int y, double coverage, const float colour[3])
{
    if (coverage <= 0.0 || x < 0 || y < 0 || x >= image->width || y >= image->height)
        return;
    size_t pixel = (size_t)y * (size_t)image->width + (size_t)x;
    float c = (float)fmin(1.0, coverage);
    for (size_t k = 0; k < 3; k++)
        image->rgb[3 * pixel + k] += c * (colour[k] - image->rgb[3 * pixel + k]);
    if (image->alpha)
        image->alpha[pixel] += c * (1.0f - image->alpha[pixel]);
}

static void draw_glyph(render_image *image, const render_glyph *glyph, double x, int y,
                       double scale, const float colour[3])
{
    segment segments[MAX_SEGMENTS];
    int count = flatten(glyph->path, segments);
    double radius = fmax(0.5, 0.5 * stroke * scale);
    int left = (int)floor(x - 2.0), right = (int)ceil(x + glyph->width * scale + 2.0);
    int up = (int)ceil(16.0 * scale) + 2, down = (int)ceil(4.0 * scale) + 2;
    for (int row = y - up; count > 0 && row <= y + down; row++)
        for (int column = left; column <= right; column++) {
            double px = (column + 0.5 - x) / scale, py = (y - row) / scale, nearest = 1e9;
            for (int i = 0; i < count; i++)
                nearest = fmin(nearest, distance(&segments[i], px, py));
            blend(image, column, row, 0.5 + radius - nearest * scale, colour);
        }
}

void render_text(render_image *image, int x, int y, const char *text, double x_height,
                 const float colour[3])
{
    double scale = x_height / x_units, pen = x + 0.5 * stroke * scale;
    while (*text) {
        const render_glyph *glyph = render_glyph_find(next_code(&text));
        draw_glyph(image, glyph, pen, y, scale, colour);
        pen += (glyph->width + letter_space) * scale;
    }
}
