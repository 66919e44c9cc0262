/* bake_plot.c: error against run time of everything `bake` tried, both axes logarithmic. */
#include "plot/svg.h"
#include "report/bake.h"

#include <math.h>
#include <string.h>

enum { LEFT = 72, TOP = 56, WIDTH = 640, HEIGHT = 360, BELOW = 64, NAMES = 64 };

#define LETTER 6.7 /* pixels */
#define ROOM 1.3   /* for names right of the slowest */

static double error_of(const hnbrdf_bake_report *b, const hnbrdf_bake_row *row)
{
    return fmax(hnbrdf_bake_judged(b, row),
                1e-4); /* a teacher's own GGX part may have none at all */
}

static void draw_limit(const hnbrdf_bake_report *b, const svg_panel *p, FILE *file)
{
    char text[64];
    if (b->wish == HNBRDF_BAKE_ERROR) {
        double y = svg_y(p, b->max_error);
        svg_line(file, p->left, y, p->left + p->width, y, svg_colors[2], 1.0, 1);
        snprintf(text, sizeof text, "accepted: %g", b->max_error);
        svg_text(file, p->left + p->width - 6.0, y - 6.0, "end", svg_colors[2], text);
    } else if (b->wish == HNBRDF_BAKE_TIME) {
        double x = svg_x(p, b->max_ns);
        svg_line(file, x, p->top, x, p->top + p->height, svg_colors[2], 1.0, 1);
        snprintf(text, sizeof text, "accepted: %g ns", b->max_ns);
        svg_text(file, x - 6.0, p->top + 16.0, "end", svg_colors[2], text);
    }
}

/* Names already written; one that would cover another is left out. */
typedef struct names {
    double x[NAMES], y[NAMES], width[NAMES];
    int count;
} names;

static int take_place(names *n, double x, double y, double width)
{
    if (n->count == NAMES)
        return 0;
    for (int k = 0; k < n->count; k++)
        if (fabs(y - n->y[k]) < 12.0 && x < n->x[k] + n->width[k] && n->x[k] < x + width)
            return 0;
    n->x[n->count] = x;
    n->y[n->count] = y;
    n->width[n->count++] = width;
    return 1;
}

static void draw_name(const hnbrdf_bake_report *b, const hnbrdf_bake_row *row, const svg_panel *p,
                      names *n, FILE *file)
{
    char text[32];
    const hnbrdf_bake_size *c = &row->size;
    int picked = row == &b->rows[b->picked];
    double x = svg_x(p, c->ns) + 9.0, y = svg_y(p, error_of(b, row));
    y += picked ? 17.0 : 4.0; /* below the line of a limit */
    if (!c->hidden)
        snprintf(text, sizeof text, "GGX alone%s", picked ? ", picked" : "");
    else if (row->full)
        snprintf(text, sizeof text, "%dx%d l=%d%s", c->hidden, c->layers, c->latent,
                 picked ? ", picked" : "");
    else
        snprintf(text, sizeof text, "%dx%d", c->hidden, c->layers);
    if (take_place(n, x, y, LETTER * (double)strlen(text)))
        svg_text(file, x, y, "start",
                 picked      ? svg_colors[2]
                 : c->hidden ? svg_colors[1]
                             : svg_colors[0],
                 text);
}

/* Marks of all rows, short fits hollow, full ones filled; then names, the most important first. */
static void draw_rows(const hnbrdf_bake_report *b, const svg_panel *p, names *n, FILE *file)
{
    for (int k = 0; k < b->row_count; k++) {
        const hnbrdf_bake_row *row = &b->rows[k];
        int picked = k == b->picked;
        svg_mark(file, row->size.hidden ? SVG_CIRCLE : SVG_SQUARE, svg_x(p, row->size.ns),
                 svg_y(p, error_of(b, row)), picked ? 6.0 : 4.0,
                 picked             ? svg_colors[2]
                 : row->size.hidden ? svg_colors[1]
                                    : svg_colors[0],
                 !row->full);
    }
    draw_name(b, &b->rows[b->picked], p, n, file);
    for (int full = 1; full >= 0; full--)
        for (int k = 0; k < b->row_count; k++)
            if (b->rows[k].full == full && k != b->picked)
                draw_name(b, &b->rows[k], p, n, file);
}

static void draw_legend(const hnbrdf_bake_report *b, FILE *file)
{
    double y = TOP - 14.0, x = LEFT + 2.0;
    svg_mark(file, SVG_CIRCLE, x + 4.0, y - 4.0, 4.0, svg_colors[1], 1);
    svg_text(file, x + 14.0, y, "start", NULL, "short fit");
    svg_mark(file, SVG_CIRCLE, x + 84.0, y - 4.0, 4.0, svg_colors[1], 0);
    svg_text(file, x + 94.0, y, "start", NULL, "full fit");
    if (!b->from_data)
        return;
    svg_mark(file, SVG_DIAMOND, x + 158.0, y - 4.0, 5.0, svg_colors[3], 0);
    svg_text(file, x + 170.0, y, "start", NULL, "the model baked from");
}

static const char *x_title(const hnbrdf_bake_report *b)
{
    return b->timed_on ? "ns an evaluation of the exported shader"
                       : "ns an evaluation (hnbrdf_eval_batch, one thread of this machine)";
}

void report_bake_plot(const void *report, FILE *file)
{
    const hnbrdf_bake_report *b = report;
    char title[160], below[160];
    names placed = {.count = 0};
    svg_panel p = {.left = LEFT,
                   .top = TOP,
                   .width = WIDTH,
                   .height = HEIGHT,
                   .x = {1.0, 0.0, 1, x_title(b)},
                   .y = {1.0, 0.0, 1, NULL}};
    for (int k = 0; k < b->row_count; k++) {
        svg_axis_include(&p.x, ROOM * b->rows[k].size.ns);
        svg_axis_include(&p.x, b->rows[k].size.ns);
        svg_axis_include(&p.y, error_of(b, &b->rows[k]));
    }
    double own = b->judge == HNBRDF_BAKE_WORST ? b->model_worst : b->model_smape;
    if (b->from_data) {
        svg_axis_include(&p.x, ROOM * b->model.ns);
        svg_axis_include(&p.y, own);
    }
    if (b->wish == HNBRDF_BAKE_ERROR)
        svg_axis_include(&p.y, b->max_error);
    if (b->wish == HNBRDF_BAKE_TIME)
        svg_axis_include(&p.x, b->max_ns);
    svg_axis_pad(&p.x, 0.06);
    svg_axis_pad(&p.y, 0.06);
    snprintf(title, sizeof title, "%d material%s: error against run time", b->material_count,
             b->material_count == 1 ? "" : "s");
    snprintf(below, sizeof below, "%s SMAPE against the %s, %s sampler",
             b->judge == HNBRDF_BAKE_WORST ? "highest" : "mean",
             b->from_data ? "measurements" : "model", hnbrdf_sampler_name(b->sampler));
    svg_begin(file, LEFT + WIDTH + 24, TOP + HEIGHT + BELOW);
    svg_heading(file, LEFT, 22, title);
    draw_legend(b, file);
    svg_panel_draw(file, &p);
    svg_text_upwards(file, 18, TOP + HEIGHT / 2.0, below);
    draw_limit(b, &p, file);
    if (b->from_data) {
        double x = svg_x(&p, b->model.ns), y = svg_y(&p, own);
        char name[16];
        hnbrdf_bake_size_name(&b->model, name);
        svg_mark(file, SVG_DIAMOND, x, y, 5.0, svg_colors[3], 0);
        take_place(&placed, x + 9.0, y + 4.0, LETTER * (double)strlen(name));
        svg_text(file, x + 9.0, y + 4.0, "start", svg_colors[3], name);
    }
    draw_rows(b, &p, &placed, file);
    svg_end(file);
}
