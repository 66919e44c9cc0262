/* loss_plot.c: the course of a training as an SVG, loss on a logarithmic axis. */
#include "report/loss_plot.h"

#include "base/error.h"
#include "plot/svg.h"
#include "report/output.h"

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

hnbrdf_result loss_curve_plot(const loss_curve *curve, const char *title, const char *path,
                              hnbrdf_error *error)
{
    if (curve->count < 2)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "%s: nothing to plot, the loss was known for %d steps", path,
                           curve->count);
    report_output output;
    hnbrdf_result code = report_output_open(path, &output, error);
    if (code)
        return code;
    svg_panel panel = {.left = LEFT,
                       .top = TOP,
                       .width = WIDTH,
                       .height = HEIGHT,
                       .x = {0.0, (double)curve->points[curve->count - 1].step, 0, "step"},
                       .y = {1.0, 0.0, 1, NULL}};
    for (int i = 0; i < curve->count; i++)
        svg_axis_include(&panel.y, curve->points[i].loss);
    svg_axis_pad(&panel.y, 0.02);
    svg_begin(output.file, LEFT + WIDTH + 32, TOP + HEIGHT + BELOW);
    svg_text(output.file, LEFT, 26, "start", NULL, title);
    svg_panel_draw(output.file, &panel);
    svg_path_begin(output.file, svg_colors[1], 1.5, 0);
    for (int i = 0; i < curve->count; i++)
        svg_path_point(output.file, svg_x(&panel, (double)curve->points[i].step),
                       svg_y(&panel, curve->points[i].loss));
    svg_path_end(output.file);
    svg_end(output.file);
    return report_output_close(&output, error);
}
