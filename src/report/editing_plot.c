/* editing_plot.c: the error over the factor of alpha: the mean, then each family. */
#include "plot/svg.h"
#include "report/editing.h"

#include <math.h>

enum { LEFT = 76, TOP = 76, WIDTH = 200, HEIGHT = 150, STEP_X = 268, STEP_Y = 226, COLUMNS = 4 };

static void include_all(const editing_report *r, int family, svg_axis *y)
{
    for (int e = 0; e < editing_edit_count; e++)
        for (int way = 0; way < EDITING_WAYS; way++) {
            double value = editing_mean(r, family, e, (editing_way)way, 0, NULL);
            if (editing_edits[e].kind == EDITING_ALPHA && !isnan(value))
                svg_axis_include(y, value);
        }
}

static void draw_curve(const editing_report *r, int family, editing_way way, const svg_panel *panel,
                       FILE *file)
{
    const char *color = svg_colors[(way + 1) % SVG_COLORS];
    svg_path_begin(file, color, 2.0, way == EDITING_FROZEN);
    for (int pass = 0; pass < 2; pass++) {
        for (int e = 0; e < editing_edit_count; e++) {
            double value = editing_mean(r, family, e, way, 0, NULL);
            if (editing_edits[e].kind != EDITING_ALPHA || isnan(value))
                continue;
            double x = svg_x(panel, editing_edits[e].factor), y = svg_y(panel, value);
            if (pass)
                svg_mark(file, (svg_shape)(way % SVG_SHAPES), x, y, 3.0, color, 0);
            else
                svg_path_point(file, x, y);
        }
        if (pass == 0)
            svg_path_end(file);
    }
}

static void draw_panel(const editing_report *r, int family, int place, FILE *file)
{
    svg_panel panel = {.left = LEFT + (place % COLUMNS) * STEP_X,
                       .top = TOP + (place / COLUMNS) * STEP_Y, /* whole rows */
                       .width = WIDTH,
                       .height = HEIGHT,
                       .x = {0.22, 4.5, 1, "factor of alpha"},
                       .y = {0.0, 0.2, 0, place % COLUMNS ? NULL : "SMAPE"}};
    include_all(r, family, &panel.y);
    panel.y.high *= 1.05;
    svg_text(file, panel.left + WIDTH / 2.0, panel.top - 8.0, "middle", NULL,
             family < 0 ? "mean" : hnbrdf_family_name(family));
    svg_panel_draw(file, &panel);
    for (int way = 0; way < EDITING_WAYS; way++)
        draw_curve(r, family, (editing_way)way, &panel, file);
}

static void draw_legend(FILE *file)
{
    for (int way = 0; way < EDITING_WAYS; way++) {
        double x = LEFT + 160.0 * way;
        const char *color = svg_colors[(way + 1) % SVG_COLORS];
        svg_line(file, x, 44.0, x + 24.0, 44.0, color, 2.0, way == EDITING_FROZEN);
        svg_mark(file, (svg_shape)(way % SVG_SHAPES), x + 12.0, 44.0, 3.0, color, 0);
        svg_text(file, x + 30.0, 48.0, "start", NULL, editing_way_title((editing_way)way));
    }
}

void editing_write_plot(const void *report, FILE *file)
{
    const editing_report *r = report;
    int panels = 1, place = 0;
    for (int f = 0; hnbrdf_family_name(f); f++)
        panels += !isnan(editing_mean(r, f, 0, EDITING_EDITED, 0, NULL));
    int rows = (panels + COLUMNS - 1) / COLUMNS, columns = panels < COLUMNS ? panels : COLUMNS;
    svg_begin(file, fmax(LEFT + columns * STEP_X, LEFT + 650.0), TOP + rows * STEP_Y);
    svg_heading(file, LEFT, 24, "Error after an edit of alpha");
    draw_legend(file);
    for (int f = -1; f < 0 || hnbrdf_family_name(f); f++)
        if (f < 0 || !isnan(editing_mean(r, f, 0, EDITING_EDITED, 0, NULL)))
            draw_panel(r, f, place++, file);
    svg_end(file);
}
