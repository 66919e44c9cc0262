/* svg.c: plots as SVG: axes with round numbers, lines, marks, text. Coordinates are written in
 * tenths of a pixel, by integers. */
#include "plot/svg.h"

#include <math.h>
#include <stdlib.h>

const char *const svg_colors[SVG_COLORS] = {"#000000", "#0072b2", "#d55e00", "#009e73",
                                            "#cc79a7", "#e69f00", "#56b4e9"};
static const char grid_color[] = "#d8d8d8";

static void put_tenths(FILE *file, double value)
{
    long tenths = lround(10.0 * value);
    fprintf(file, "%s%ld.%ld", tenths < 0 ? "-" : "", labs(tenths) / 10, labs(tenths) % 10);
}

static void put_attribute(FILE *file, const char *name, double value)
{
    fprintf(file, " %s='", name);
    put_tenths(file, value);
    fputs("'", file);
}

static void put_escaped(FILE *file, const char *text)
{
    for (; *text; text++)
        if (*text == '&' || *text == '<' || *text == '>')
            fputs(*text == '&' ? "&amp;" : *text == '<' ? "&lt;" : "&gt;", file);
        else if ((unsigned char)*text >= 0x20)
            putc(*text, file);
}

void svg_begin(FILE *file, double width, double height)
{
    fprintf(file,
            "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' "
            "font-family='sans-serif' "
            "font-size='12'>\n<rect width='100%%' height='100%%' fill='#fff'/>\n",
            width, height);
}

void svg_end(FILE *file)
{
    fputs("</svg>\n", file);
}

void svg_text(FILE *file, double x, double y, const char *anchor, const char *color,
              const char *text)
{
    fputs("<text", file);
    put_attribute(file, "x", x);
    put_attribute(file, "y", y);
    fprintf(file, " text-anchor='%s'", anchor);
    if (color) /* such a text may lie on lines */
        fprintf(file, " fill='%s' stroke='#fff' stroke-width='3' paint-order='stroke'", color);
    putc('>', file);
    put_escaped(file, text);
    fputs("</text>\n", file);
}

void svg_heading(FILE *file, double x, double y, const char *text)
{
    fputs("<text font-size='14' font-weight='bold'", file);
    put_attribute(file, "x", x);
    put_attribute(file, "y", y);
    putc('>', file);
    put_escaped(file, text);
    fputs("</text>\n", file);
}

void svg_text_upwards(FILE *file, double x, double y, const char *text)
{
    fputs("<text text-anchor='middle' transform='translate(", file);
    put_tenths(file, x);
    putc(' ', file);
    put_tenths(file, y);
    fputs(") rotate(-90)'>", file);
    put_escaped(file, text);
    fputs("</text>\n", file);
}

/* " stroke='...'" and what belongs to it. */
static void put_stroke(FILE *file, const char *color, double width, int dashed)
{
    fprintf(file, " stroke='%s'", color);
    put_attribute(file, "stroke-width", width);
    if (dashed)
        fputs(" stroke-dasharray='5 3'", file);
}

void svg_line(FILE *file, double x0, double y0, double x1, double y1, const char *color,
              double width, int dashed)
{
    fputs("<line", file);
    put_attribute(file, "x1", x0);
    put_attribute(file, "y1", y0);
    put_attribute(file, "x2", x1);
    put_attribute(file, "y2", y1);
    put_stroke(file, color, width, dashed);
    fputs("/>\n", file);
}

void svg_path_begin(FILE *file, const char *color, double width, int dashed)
{
    fputs("<polyline fill='none'", file);
    put_stroke(file, color, width, dashed);
    fputs(" points='", file);
}

void svg_path_point(FILE *file, double x, double y)
{
    put_tenths(file, x);
    putc(',', file);
    put_tenths(file, y);
    putc(' ', file);
}

void svg_path_end(FILE *file)
{
    fputs("'/>\n", file);
}

void svg_mark(FILE *file, svg_shape shape, double x, double y, double radius, const char *color,
              int hollow)
{
    /* Corners, in radii; as large in area as the circle. */
    static const double corners[SVG_SHAPES][4][2] = {
        [SVG_SQUARE] = {{-0.89, -0.89}, {0.89, -0.89}, {0.89, 0.89}, {-0.89, 0.89}},
        [SVG_DIAMOND] = {{0.0, -1.25}, {1.25, 0.0}, {0.0, 1.25}, {-1.25, 0.0}},
        [SVG_TRIANGLE] = {{0.0, -1.45}, {1.35, 0.9}, {-1.35, 0.9}, {0.0, -1.45}},
    };
    fputs(shape == SVG_CIRCLE ? "<circle" : "<polygon", file);
    fprintf(file, " class='mark' fill='%s'", hollow ? "#fff" : color);
    put_stroke(file, color, 1.5, 0);
    if (shape == SVG_CIRCLE) {
        put_attribute(file, "cx", x);
        put_attribute(file, "cy", y);
        put_attribute(file, "r", radius);
    } else {
        fputs(" points='", file);
        for (int k = 0; k < 4; k++)
            svg_path_point(file, x + radius * corners[shape][k][0],
                           y + radius * corners[shape][k][1]);
        putc('\'', file);
    }
    fputs("/>\n", file);
}

/* ---- Axes ------------------------------------------------------------------------------------ */

/* 0 at the low end, 1 at the high one. */
static double share_of(const svg_axis *axis, double value)
{
    return axis->logarithmic ? log(value / axis->low) / log(axis->high / axis->low)
                             : (value - axis->low) / (axis->high - axis->low);
}

double svg_x(const svg_panel *panel, double value)
{
    return panel->left + panel->width * share_of(&panel->x, value);
}

double svg_y(const svg_panel *panel, double value)
{
    return panel->top + panel->height * (1.0 - share_of(&panel->y, value));
}

void svg_axis_include(svg_axis *axis, double value)
{
    if (!isfinite(value) || (axis->logarithmic && value <= 0.0))
        return;
    int empty = axis->low > axis->high;
    axis->low = empty || value < axis->low ? value : axis->low;
    axis->high = empty || value > axis->high ? value : axis->high;
}

void svg_axis_pad(svg_axis *axis, double share)
{
    if (axis->low > axis->high) {
        axis->low = axis->logarithmic ? 1.0 : 0.0;
        axis->high = axis->logarithmic ? 10.0 : 1.0;
    }
    if (axis->logarithmic) {
        double factor = fmax(pow(axis->high / axis->low, share), 1.05);
        axis->low /= factor;
        axis->high *= factor;
    } else {
        double more = fmax(share * (axis->high - axis->low), 1e-3 * fmax(fabs(axis->high), 1.0));
        axis->low -= more;
        axis->high += more;
    }
}

enum { MOST_TICKS = 64 };

static int linear_ticks(const svg_axis *axis, double ticks[MOST_TICKS])
{
    double rough = (axis->high - axis->low) / 6.0, decade = pow(10.0, floor(log10(rough)));
    double step = rough <= 2.0 * decade   ? 2.0 * decade
                  : rough <= 5.0 * decade ? 5.0 * decade
                                          : 10.0 * decade;
    int count = 0;
    for (double k = ceil(axis->low / step - 1e-9); k * step <= axis->high + 1e-9 * step; k += 1.0)
        if (count < MOST_TICKS)
            ticks[count++] = k * step + 0.0; /* no -0 */
    return count;
}

/* Tenths of a decade at which numbers stand, from sparse to dense. */
static const struct {
    int count, tenths[6];
} spacings[] = {{1, {10}}, {3, {10, 20, 50}}, {6, {10, 15, 20, 30, 50, 70}}};

static int spaced_ticks(const svg_axis *axis, const int *tenths, int steps,
                        double ticks[MOST_TICKS])
{
    int count = 0;
    for (int decade = (int)floor(log10(axis->low)); decade <= (int)ceil(log10(axis->high));
         decade++)
        for (int i = 0; i < steps; i++) {
            double value = tenths[i] * pow(10.0, decade - 1);
            if (value >= axis->low * 0.9999 && value <= axis->high * 1.0001 && count < MOST_TICKS)
                ticks[count++] = value;
        }
    return count;
}

/* The sparsest spacing with enough numbers; an axis of a fraction of a decade gets even steps. */
static int logarithmic_ticks(const svg_axis *axis, double ticks[MOST_TICKS])
{
    for (int k = 0; k < 3; k++) {
        int count = spaced_ticks(axis, spacings[k].tenths, spacings[k].count, ticks);
        if (count >= 4)
            return count;
    }
    return linear_ticks(axis, ticks);
}

static int ticks_of(const svg_axis *axis, double ticks[MOST_TICKS])
{
    return axis->logarithmic ? logarithmic_ticks(axis, ticks) : linear_ticks(axis, ticks);
}

/* From 100,000 on with a prefix, as 100 k, 1 M and 10 G: decades stand side by side. */
static void write_tick(double value, char *text, size_t size)
{
    const int prefix = value < 1e5 ? 0 : value < 1e6 ? 1 : value < 1e9 ? 2 : 3;
    static const double units[] = {1.0, 1e3, 1e6, 1e9};
    static const char *const names[] = {"", " k", " M", " G"};
    snprintf(text, size, "%.12g%s", value / units[prefix], names[prefix]);
}

static void draw_x(FILE *file, const svg_panel *panel)
{
    double ticks[MOST_TICKS], bottom = panel->top + panel->height;
    char text[32];
    int count = ticks_of(&panel->x, ticks);
    for (int k = 0; k < count; k++) {
        double x = svg_x(panel, ticks[k]);
        svg_line(file, x, panel->top, x, bottom, grid_color, 1.0, 0);
        write_tick(ticks[k], text, sizeof text);
        svg_text(file, x, bottom + 18.0, "middle", NULL, text);
    }
    if (panel->x.title)
        svg_text(file, panel->left + 0.5 * panel->width, bottom + 38.0, "middle", NULL,
                 panel->x.title);
}

static void draw_y(FILE *file, const svg_panel *panel)
{
    double ticks[MOST_TICKS];
    char text[32];
    int count = ticks_of(&panel->y, ticks);
    for (int k = 0; k < count; k++) {
        double y = svg_y(panel, ticks[k]);
        svg_line(file, panel->left, y, panel->left + panel->width, y, grid_color, 1.0, 0);
        write_tick(ticks[k], text, sizeof text);
        svg_text(file, panel->left - 8.0, y + 4.0, "end", NULL, text);
    }
    if (panel->y.title)
        svg_text_upwards(file, panel->left - 52.0, panel->top + 0.5 * panel->height,
                         panel->y.title);
}

void svg_panel_draw(FILE *file, const svg_panel *panel)
{
    draw_x(file, panel);
    draw_y(file, panel);
}
