/* plot.c: error against run time: a pair of panels (SMAPE, PSNR) for each backend, with
 * Pareto fronts; a last pair against bytes. */
#include "bench/bench.h"
#include "plot/svg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 400,
    HEIGHT = 260,
    LEFT = 74,
    BETWEEN = 88,
    TOP = 92,
    BELOW = 84,
    RIGHT = 40,
    PLOT_BACKENDS = 6,
    PLOT_POINTS = 128
};

typedef enum plot_kind {
    PLOT_GGX,
    PLOT_HYBRID,
    PLOT_NEURAL,
    PLOT_PEER,
    PLOT_BASELINE,
    PLOT_KINDS
} plot_kind;

static const char *const kind_titles[PLOT_KINDS] = {"GGX alone", "hybrid", "neural",
                                                    "published-style shader", "other"};
static const svg_shape kind_shapes[PLOT_KINDS] = {SVG_DIAMOND, SVG_CIRCLE, SVG_TRIANGLE, SVG_SQUARE,
                                                  SVG_SQUARE};

typedef struct plot_point {
    const bench_row *row;
    double x, error; /* x: ns or bytes; error NaN: exact, at the better edge */
} plot_point;

typedef struct plot_panel {
    plot_point points[PLOT_POINTS];
    int count;
    int larger_is_better;
} plot_panel;

static const char *kind_color(plot_kind kind)
{
    static const int colors[PLOT_KINDS] = {0, 1, 3, 2, 4};
    return svg_colors[colors[kind]];
}

static plot_kind kind_of(const bench_row *row)
{
    if (row->model->is_baseline)
        return PLOT_BASELINE;
    if (strcmp(row->weights, "published-style") == 0)
        return PLOT_PEER;
    return row->model->desc.kind == HNBRDF_KIND_GGX      ? PLOT_GGX
           : row->model->desc.kind == HNBRDF_KIND_NEURAL ? PLOT_NEURAL
                                                         : PLOT_HYBRID;
}

/* ---- Choosing -------------------------------------------------------------------------------- */

static int same_point(const bench_row *a, const bench_row *b)
{
    return a->model == b->model && kind_of(a) == kind_of(b);
}

/* Of the rows of one model on a backend, which differ in variant, storage and precision, the
 * fastest. */
static void add_point(plot_panel *panel, const bench_row *row, double x)
{
    double error = panel->larger_is_better ? row->psnr : row->smape;
    const int exact = row->model->is_baseline && row->smape == 0.0;
    if (!isfinite(x) || x <= 0.0 || !(exact || isfinite(error)))
        return;
    const plot_point point = {row, x, exact ? (double)NAN : error};
    for (int k = 0; k < panel->count; k++)
        if (same_point(panel->points[k].row, row)) {
            if (x < panel->points[k].x)
                panel->points[k] = point;
            return;
        }
    if (panel->count < PLOT_POINTS)
        panel->points[panel->count++] = point;
}

static int compare_points(const void *a, const void *b)
{
    const plot_point *x = a, *y = b;
    return x->x < y->x ? -1 : x->x > y->x;
}

/* backend NULL: bytes of all models, once each. */
static void choose_points(const bench *b, const char *backend, int psnr, plot_panel *panel)
{
    panel->count = 0;
    panel->larger_is_better = psnr;
    for (int k = 0; k < b->row_count; k++) {
        const bench_row *row = &b->rows[k];
        if (!backend && kind_of(row) != PLOT_PEER && strcmp(row->precision, "float") == 0)
            add_point(panel, row, bench_scene_bytes(b, row->model));
        else if (backend && strcmp(row->backend, backend) == 0)
            add_point(panel, row, bench_ns(row));
    }
    qsort(panel->points, (size_t)panel->count, sizeof *panel->points, compare_points);
}

/* Batches, single evaluations as renderers should make them, and every device, once each. */
static int choose_backends(const bench *b, const char *backends[PLOT_BACKENDS])
{
    int count = 0;
    for (int k = 0; k < b->row_count; k++) {
        int known = strcmp(b->rows[k].backend, "c-single") == 0 ||
                    strcmp(b->rows[k].backend, "c-many") == 0;
        for (int i = 0; i < count; i++)
            known = known || strcmp(backends[i], b->rows[k].backend) == 0;
        if (!known && count < PLOT_BACKENDS)
            backends[count++] = b->rows[k].backend;
    }
    return count;
}

/* ---- Drawing --------------------------------------------------------------------------------- */

static double point_y(const plot_panel *panel, const svg_panel *axes, const plot_point *p)
{
    if (isnan(p->error))
        return axes->top + (panel->larger_is_better ? 0.0 : axes->height);
    return svg_y(axes, p->error);
}

/* The points, in order of x, that none before beats. What is exact is beside the question. */
static void draw_front(const plot_panel *panel, const svg_panel *axes, FILE *file)
{
    double best = (double)NAN, sign = panel->larger_is_better ? -1.0 : 1.0;
    svg_path_begin(file, "#888", 1.2, 1);
    for (int k = 0; k < panel->count; k++) {
        const plot_point *p = &panel->points[k];
        if (isnan(p->error) || sign * p->error >= sign * best)
            continue;
        if (!isnan(best))
            svg_path_point(file, svg_x(axes, p->x), svg_y(axes, best));
        svg_path_point(file, svg_x(axes, p->x), svg_y(axes, p->error));
        best = p->error;
    }
    if (!isnan(best))
        svg_path_point(file, axes->left + axes->width, svg_y(axes, best));
    svg_path_end(file);
}

static void label_of(const bench_row *row, char *text, size_t size)
{
    char net[16];
    if (row->model->is_baseline)
        snprintf(text, size, "%s%s", row->model->name, row->smape == 0.0 ? " (exact)" : "");
    else if (row->model->desc.kind == HNBRDF_KIND_GGX)
        snprintf(text, size, "GGX");
    else
        snprintf(text, size, "%s%s%s", bench_net(row->model, net),
                 row->encoding == HNBRDF_ENCODING_DIRECTIONS ? " directions" : "",
                 strcmp(row->precision, "half") == 0 ? " half" : "");
}

/* Labels beside their points, each lifted until it is clear of those already there. */
static void draw_labels(const plot_panel *panel, const svg_panel *axes, FILE *file)
{
    double taken[PLOT_POINTS][3]; /* from, to, baseline */
    for (int k = 0; k < panel->count; k++) {
        char text[BENCH_NAME + 16];
        const plot_point *p = &panel->points[k];
        label_of(p->row, text, sizeof text);
        double length = 6.4 * (double)strlen(text), x = svg_x(axes, p->x),
               y = point_y(panel, axes, p);
        int left = x + length + 14.0 > axes->left + axes->width;
        double from = left ? x - 8.0 - length : x + 8.0, at = y - 7.0;
        for (int i = 0; i < k; i++)
            if (from < taken[i][1] && from + length > taken[i][0] &&
                fabs(at - taken[i][2]) < 12.0) {
                at = taken[i][2] - 12.0;
                i = -1;
            }
        taken[k][0] = from;
        taken[k][1] = from + length;
        taken[k][2] = at;
        svg_text(file, left ? x - 8.0 : x + 8.0, at, left ? "end" : "start",
                 kind_color(kind_of(p->row)), text);
    }
}

static void draw_panel(const bench *b, const char *backend, int psnr, double left, double top,
                       FILE *file)
{
    char title[64];
    plot_panel panel;
    choose_points(b, backend, psnr, &panel);
    snprintf(title, sizeof title, "SMAPE, %s sampler", hnbrdf_sampler_name(b->sampler));
    svg_panel axes = {.left = left,
                      .top = top,
                      .width = WIDTH,
                      .height = HEIGHT,
                      .x = {1.0, 0.0, 1, backend ? "ns per evaluation" : "bytes"},
                      .y = {1.0, 0.0, !psnr, psnr ? "PSNR of a sphere, dB" : title}};
    for (int k = 0; k < panel.count; k++) {
        svg_axis_include(&axes.x, panel.points[k].x);
        if (!isnan(panel.points[k].error))
            svg_axis_include(&axes.y, panel.points[k].error);
    }
    svg_axis_pad(&axes.x, 0.12);
    svg_axis_pad(&axes.y, 0.12);
    svg_panel_draw(file, &axes);
    draw_front(&panel, &axes, file);
    draw_labels(&panel, &axes, file); /* under the marks, which their rims would hide */
    for (int k = 0; k < panel.count; k++) {
        const plot_point *p = &panel.points[k];
        plot_kind kind = kind_of(p->row);
        svg_mark(file, kind_shapes[kind], svg_x(&axes, p->x), point_y(&panel, &axes, p), 5.0,
                 kind_color(kind), kind == PLOT_BASELINE);
    }
}

static int has_kind(const bench *b, plot_kind kind)
{
    for (int k = 0; k < b->row_count; k++)
        if (kind_of(&b->rows[k]) == kind && isfinite(b->rows[k].smape))
            return 1;
    return 0;
}

static void draw_legend(const bench *b, double y, FILE *file)
{
    double x = LEFT;
    for (plot_kind kind = 0; kind < PLOT_KINDS; kind++)
        if (has_kind(b, kind)) {
            svg_mark(file, kind_shapes[kind], x + 6.0, y - 4.0, 5.0, kind_color(kind),
                     kind == PLOT_BASELINE);
            svg_text(file, x + 17.0, y, "start", NULL, kind_titles[kind]);
            x += 44.0 + 6.6 * (double)strlen(kind_titles[kind]);
        }
    svg_line(file, x, y - 4.0, x + 26.0, y - 4.0, "#888", 1.2, 1);
    svg_text(file, x + 32.0, y, "start", NULL, "nothing faster is better (Pareto front)");
}

/* What the panels under it were measured on. */
static void title_of(const bench *b, const char *backend, char *text, size_t size)
{
    const bench_row *row = b->rows;
    if (!backend) {
        snprintf(text, size, "%d material%s: network and what each has, in single precision",
                 b->data_count, b->data_count == 1 ? "" : "s");
        return;
    }
    while (strcmp(row->backend, backend) != 0)
        row++;
    if (row->io)
        snprintf(text, size, "%s, buffers subtracted%s", backend,
                 row->threads ? ", all threads" : "");
    else
        snprintf(text, size, "%s, one thread, %s", backend, b->cpu);
}

void bench_write_plot(const void *of, FILE *file)
{
    const bench *b = of;
    const char *backends[PLOT_BACKENDS + 1];
    char text[160];
    int count = choose_backends(b, backends);
    if (b->data_count)
        backends[count++] = NULL;
    double row_height = HEIGHT + BELOW;
    svg_begin(file, LEFT + 2 * WIDTH + BETWEEN + RIGHT, TOP + count * row_height - 24.0);
    svg_heading(file, LEFT, 28.0,
                b->data_count ? "Error against run time, and against bytes"
                              : "Error against run time");
    draw_legend(b, 52.0, file);
    for (int k = 0; k < count; k++) {
        double top = TOP + k * row_height;
        title_of(b, backends[k], text, sizeof text);
        svg_text(file, LEFT, top - 10.0, "start", NULL, text);
        draw_panel(b, backends[k], 0, LEFT, top, file);
        draw_panel(b, backends[k], 1, LEFT + WIDTH + BETWEEN, top, file);
    }
    svg_end(file);
}
