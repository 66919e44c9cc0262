/* loss_plot.c: the course of a training as an SVG without dependencies, loss on a logarithmic axis. */
#include "cli/loss_plot.h"

#include "cli/cli.h"

#include <math.h>
#include <stdlib.h>

enum { LEFT = 64, TOP = 44, WIDTH = 640, HEIGHT = 320, BELOW = 48 };

void loss_curve_add(loss_curve *curve, long step, double loss)
{
    if (!(loss > 0.0) || !isfinite(loss))
        return;
    if (curve->count == curve->room) {
        int room = curve->room ? 2 * curve->room : 256;
        loss_point *points = realloc(curve->points, sizeof *points * (size_t)room);
        if (!points)
            return;
        curve->points = points;
        curve->room = room;
    }
    curve->points[curve->count].step = step;
    curve->points[curve->count++].loss = loss;
}

void loss_curve_free(loss_curve *curve)
{
    free(curve->points);
    curve->points = NULL;
    curve->count = curve->room = 0;
}

typedef struct axes {
    FILE *file;
    double low, high; /* of the loss */
    double last;      /* step */
} axes;

/* Numbers in an SVG in tenths of a pixel, by integers: no locale has a say. */
static void put_tenths(FILE *file, double value)
{
    long tenths = lround(10.0 * value);
    fprintf(file, "%ld.%ld", tenths / 10, labs(tenths % 10));
}

static double x_of(const axes *a, double step)
{
    return LEFT + WIDTH * step / a->last;
}

static double y_of(const axes *a, double loss)
{
    return TOP + HEIGHT * (log(a->high) - log(loss)) / (log(a->high) - log(a->low));
}

static void put_line(const axes *a, double x0, double y0, double x1, double y1)
{
    const double at[4] = {x0, y0, x1, y1};
    static const char *const names[4] = {"x1", "y1", "x2", "y2"};
    fputs("<line stroke='#ccc'", a->file);
    for (int i = 0; i < 4; i++) {
        fprintf(a->file, " %s='", names[i]);
        put_tenths(a->file, at[i]);
        fputs("'", a->file);
    }
    fputs("/>\n", a->file);
}

static void put_text(const axes *a, double x, double y, const char *anchor, const char *text)
{
    fputs("<text x='", a->file);
    put_tenths(a->file, x);
    fputs("' y='", a->file);
    put_tenths(a->file, y);
    fprintf(a->file, "' text-anchor='%s'>%s</text>\n", anchor, text);
}

/* Grid and labels: the loss at 1, 1.5, 2, 3, 5 and 7 of every decade, five steps. */
static void put_axes(const axes *a)
{
    static const int tenths[] = {10, 15, 20, 30, 50, 70};
    char text[48];
    for (int decade = -6; decade < 3; decade++)
        for (int i = 0; i < 6; i++) {
            double loss = tenths[i] * pow(10.0, decade - 1);
            if (loss < a->low * 0.999 || loss > a->high * 1.001)
                continue;
            double y = y_of(a, loss);
            int digits = decade < 0 ? 1 - decade : 1;
            long units = lround(loss * pow(10.0, digits));
            long scale = lround(pow(10.0, digits));
            put_line(a, LEFT, y, LEFT + WIDTH, y);
            snprintf(text, sizeof text, "%ld.%0*ld", units / scale, digits, units % scale);
            put_text(a, LEFT - 8, y + 4, "end", text);
        }
    for (int i = 0; i <= 4; i++) {
        double step = a->last * i / 4;
        put_line(a, x_of(a, step), TOP, x_of(a, step), TOP + HEIGHT);
        snprintf(text, sizeof text, "%.0f", step);
        put_text(a, x_of(a, step), TOP + HEIGHT + 18, "middle", text);
    }
    put_text(a, LEFT + WIDTH / 2.0, TOP + HEIGHT + 38, "middle", "step");
}

int loss_curve_plot(const loss_curve *curve, const char *title, const char *path)
{
    if (curve->count < 2)
        return cli_fail("%s: nothing to plot, the loss was known for %d steps", path, curve->count);
    cli_output output;
    int code = cli_output_open(path, &output);
    if (code)
        return code;
    axes a = {output.file, INFINITY, 0.0, (double)curve->points[curve->count - 1].step};
    for (int i = 0; i < curve->count; i++) {
        a.low = fmin(a.low, curve->points[i].loss);
        a.high = fmax(a.high, curve->points[i].loss);
    }
    a.low /= 1.05;
    a.high *= 1.05;
    fprintf(a.file,
            "<svg xmlns='http://www.w3.org/2000/svg' width='%d' height='%d' font-family='sans-serif' "
            "font-size='12'>\n<rect width='100%%' height='100%%' fill='#fff'/>\n",
            LEFT + WIDTH + 32, TOP + HEIGHT + BELOW);
    put_text(&a, LEFT, 26, "start", title);
    put_axes(&a);
    fputs("<polyline fill='none' stroke='#0072b2' stroke-width='1.5' points='", a.file);
    for (int i = 0; i < curve->count; i++) {
        put_tenths(a.file, x_of(&a, (double)curve->points[i].step));
        fputc(',', a.file);
        put_tenths(a.file, y_of(&a, curve->points[i].loss));
        fputc(' ', a.file);
    }
    fputs("'/>\n</svg>\n", a.file);
    return cli_output_close(&output);
}
