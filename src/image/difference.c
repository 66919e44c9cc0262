/* difference.c: where two pictures differ, in false colours with a scale. */
#include "image/difference.h"

#include "base/error.h"
#include "image/draw.h"
#include "image/label.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int render_covered(const render_image *a, const render_image *b, size_t pixel)
{
    return !a->alpha || !b->alpha || a->alpha[pixel] > 0.0f || b->alpha[pixel] > 0.0f;
}

static double difference_at(const render_image *a, const render_image *b, size_t pixel)
{
    double sum = 0.0;
    for (size_t k = 3 * pixel; k < 3 * pixel + 3; k++)
        sum += fabs((double)a->rgb[k] - (double)b->rgb[k]);
    return sum / 3.0;
}

/* ---- The scale ------------------------------------------------------------------------------- */

static int compare_values(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* 1, 2 or 5 times a power of ten, >= value > 0. */
static double round_up(double value)
{
    double power = pow(10.0, floor(log10(value)));
    for (int k = 0; k < 2; k++, power *= 10.0)
        for (int m = 1; m <= 5; m += m == 1 ? 1 : 3)
            if (value <= m * power * (1.0 + 1e-9))
                return m * power;
    return power;
}

double render_difference_top(const render_image *a, const render_image *b)
{
    size_t pixels = (size_t)a->width * (size_t)a->height, count = 0;
    double *values = malloc(pixels * sizeof *values);
    if (!values)
        return 0.0;
    for (size_t i = 0; i < pixels; i++)
        if (render_covered(a, b, i))
            values[count++] = difference_at(a, b, i);
    qsort(values, count, sizeof *values, compare_values);
    double most = count ? values[count - 1 - count / 100] : 0.0;
    if (count && !(most > 0.0)) /* fewer than one in a hundred differ */
        most = values[count - 1];
    free(values);
    return most > 0.0 ? round_up(most) : 1.0;
}

hnbrdf_result render_difference_map(const render_image *a, const render_image *b, double top,
                                    render_image *map, hnbrdf_error *error)
{
    hnbrdf_result result = render_image_create(a->width, a->height, 1, map, error);
    for (size_t i = 0; result == HNBRDF_OK && i < (size_t)a->width * (size_t)a->height; i++)
        if (render_covered(a, b, i)) {
            render_colour_map(difference_at(a, b, i) / top, map->rgb + 3 * i);
            map->alpha[i] = 1.0f;
        }
    return result;
}

/* ---- The page -------------------------------------------------------------------------------- */

static const float page_colour[3] = {0.016f, 0.017f, 0.019f}, plain[3] = {0.50f, 0.50f, 0.52f},
                   bright[3] = {0.80f, 0.80f, 0.80f};
enum {
    MARGIN = 16,
    BAR = 18,
    TICKS = 5,
    TICK = 5,
    TEXT = 7,
    LINE = 18,
    LABELS = 90,
    LEAST_WIDTH = 420
};

static void draw_scale(render_image *page, int x, int y, int height, double top)
{
    render_colour_bar(page, x, y, BAR, height);
    for (int k = 0; k <= TICKS; k++) {
        char label[32];
        int at = y + height - (int)lround((double)height * k / TICKS);
        snprintf(label, sizeof label, "%.4g%s", top * k / TICKS, k == TICKS ? " or more" : "");
        render_fill(page, x + BAR, at - (k == TICKS ? 0 : 1), TICK, 1, plain);
        render_text_at(page, x + BAR + 2 * TICK, at + TEXT / 2, 0.0, label, TEXT, plain);
    }
}

hnbrdf_result render_difference_page(const render_image *a, const render_image *b, double top,
                                     const char *const lines[RENDER_DIFFERENCE_LINES],
                                     render_image *page, hnbrdf_error *error)
{
    render_image map = {0};
    int header = MARGIN, scale = a->height > 120 ? a->height : 120;
    for (int i = 0; i < RENDER_DIFFERENCE_LINES; i++)
        header += lines[i] ? LINE : 0;
    if (top == 0.0)
        top = render_difference_top(a, b);
    if (top == 0.0)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory to sort the differences");
    int width = a->width + 3 * MARGIN + BAR + LABELS;
    width = width > LEAST_WIDTH ? width : LEAST_WIDTH;
    hnbrdf_result result = render_difference_map(a, b, top, &map, error);
    if (result == HNBRDF_OK)
        result = render_image_create(width, header + scale + 2 * MARGIN, 0, page, error);
    if (result == HNBRDF_OK) {
        render_fill(page, 0, 0, page->width, page->height, page_colour);
        for (int i = 0, y = MARGIN; i < RENDER_DIFFERENCE_LINES; i++) {
            char text[256];
            if (!lines[i])
                continue;
            render_text_shorten(lines[i], TEXT, page->width - 2 * MARGIN, text, sizeof text);
            render_text_at(page, MARGIN, y + TEXT + 3, 0.0, text, TEXT, i ? plain : bright);
            y += LINE;
        }
        render_paste(page, MARGIN, header + MARGIN / 2, &map);
        draw_scale(page, a->width + 2 * MARGIN, header + MARGIN / 2, scale, top);
    }
    render_image_free(&map);
    return result;
}
