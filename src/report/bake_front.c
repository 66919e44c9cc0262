/* bake_front.c: what 1, 6, ... materials need: the errors against time that networks reach. */
#include "plot/svg.h"
#include "report/bake.h"

#include <math.h>
#include <stdlib.h>

enum { LEFT = 72, TOP = 64, WIDTH = 640, HEIGHT = 400, BELOW = 64, POINTS = 256 };

typedef struct point {
    double ns, error;
    const hnbrdf_bake_row *row;
} point;

static int compare_points(const void *a, const void *b)
{
    const point *x = a, *y = b;
    return x->ns < y->ns ? -1 : x->ns > y->ns;
}

/* GGX alone and full fits that no faster one beats, by time. */
static int choose(const hnbrdf_bake_report *r, point points[POINTS])
{
    int all = 0, count = 0;
    for (int k = 0; k < r->row_count && all < POINTS; k++)
        if (r->rows[k].full)
            points[all++] =
                (point){r->rows[k].size.ns, hnbrdf_bake_judged(r, &r->rows[k]), &r->rows[k]};
    qsort(points, (size_t)all, sizeof *points, compare_points);
    for (int k = 0; k < all; k++)
        if (count == 0 || points[k].error < points[count - 1].error)
            points[count++] = points[k];
    return count;
}

static void draw_one(const hnbrdf_bake_report *r, const svg_panel *p, const char *color, int last,
                     FILE *file)
{
    point points[POINTS];
    const int count = choose(r, points);
    svg_path_begin(file, color, 1.4, 0);
    for (int k = 0; k < count; k++)
        svg_path_point(file, svg_x(p, points[k].ns), svg_y(p, points[k].error));
    svg_path_end(file);
    for (int k = 0; k < count; k++) {
        const hnbrdf_bake_size *s = &points[k].row->size;
        char name[16];
        svg_mark(file, s->hidden ? SVG_CIRCLE : SVG_SQUARE, svg_x(p, points[k].ns),
                 svg_y(p, points[k].error), 4.0, color, 0);
        if (last && (k % 2 == 0 || k == count - 1))
            svg_text(file, svg_x(p, points[k].ns) + 4.0, svg_y(p, points[k].error) - 9.0, "start",
                     color, s->hidden ? hnbrdf_bake_size_name(s, name) : "GGX");
    }
}

void report_bake_front_plot(const void *of, FILE *file)
{
    const report_bake_front *front = of;
    const hnbrdf_bake_report *first = &front->reports[0];
    svg_panel p = {.left = LEFT,
                   .top = TOP,
                   .width = WIDTH,
                   .height = HEIGHT,
                   .x = {1.0, 0.0, 1,
                         first->timed_on
                             ? "ns an evaluation of the exported shader"
                             : "ns an evaluation (hnbrdf_eval_batch, one thread of this machine)"},
                   .y = {1.0, 0.0, 1, NULL}};
    char text[96];
    double x = LEFT + 2.0;
    for (int n = 0; n < front->count; n++) {
        point points[POINTS];
        const int count = choose(&front->reports[n], points);
        for (int k = 0; k < count; k++) {
            svg_axis_include(&p.x, points[k].ns);
            svg_axis_include(&p.y, points[k].error);
        }
    }
    svg_axis_pad(&p.x, 0.08);
    svg_axis_pad(&p.y, 0.08);
    svg_begin(file, LEFT + WIDTH + 24, TOP + HEIGHT + BELOW);
    svg_heading(file, LEFT, 22, "What a scene needs against what a database needs");
    svg_panel_draw(file, &p);
    snprintf(text, sizeof text, "%s SMAPE against the %s, %s sampler",
             first->judge == HNBRDF_BAKE_WORST ? "highest" : "mean",
             first->from_data ? "measurements" : "model", hnbrdf_sampler_name(first->sampler));
    svg_text_upwards(file, 18, TOP + HEIGHT / 2.0, text);
    for (int n = 0; n < front->count; n++) {
        const char *color = svg_colors[(n + 1) % SVG_COLORS];
        draw_one(&front->reports[n], &p, color, n == front->count - 1 || n == 0, file);
        snprintf(text, sizeof text, "%d material%s", front->reports[n].material_count,
                 front->reports[n].material_count == 1 ? "" : "s");
        svg_mark(file, SVG_CIRCLE, x + 4.0, TOP - 18.0, 4.0, color, 0);
        svg_text(file, x + 14.0, TOP - 14.0, "start", NULL, text);
        x += 120.0;
    }
    svg_end(file);
}
