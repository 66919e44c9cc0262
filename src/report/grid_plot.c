/* grid_plot.c: the error of every material as a curve for each model, an SVG without
 * dependencies. */
#include "report/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    PLOT_TOP = 24,
    PLOT_HEIGHT = 360,
    LEGEND_LINE = 20,
    LEGEND_WIDTH = 300,
    NAMED_MATERIALS = 40, /* of more than these each curve is sorted by itself */
    MAX_CURVES = 1 + REPORT_LATENTS * (REPORT_FORMS - 1)
};

typedef struct ranked {
    double error;
    int material;
} ranked;

typedef struct plot {
    const report *r;
    const report_entry *curves[MAX_CURVES];
    int curve_count;
    /* 1: one order for all curves, by GGX's error, with the names below */
    int named;
    ranked *order;            /* [materials], the order of the curve that is being drawn */
    double left;              /* pixels */
    double below;             /* pixels under the axis */
    double tick, bottom, top; /* of the error axis */
    int psnr;                 /* 1: what is drawn is PSNR, 0: SMAPE */
    double step;              /* pixels from one material to the next */
    FILE *file;
} plot;

/* Told apart by most colour-blind people (Okabe and Ito 2008). */
static const char *const form_colors[REPORT_FORMS] = {"#000000", "#0072b2", "#d55e00", "#009e73"};

static int compare_ranked(const void *a, const void *b)
{
    const ranked *x = a, *y = b;
    return x->error < y->error ? -1 : x->error > y->error ? 1 : x->material - y->material;
}

static double value_of(const plot *p, const report_entry *e, int m)
{
    return p->psnr ? e->pictures[m].psnr : report_error(p->r, e, m);
}

static void sort_materials(plot *p, const report_entry *by)
{
    size_t count = (size_t)p->r->data.count;
    for (int m = 0; m < p->r->data.count; m++) {
        p->order[m].error = value_of(p, by, m);
        p->order[m].material = m;
    }
    qsort(p->order, count, sizeof *p->order, compare_ranked);
}

static void choose_curves(plot *p, const int net[2])
{
    p->curves[p->curve_count++] = &p->r->entries[0];
    for (report_form form = REPORT_NEURAL; form >= REPORT_HYBRID; form--)
        for (int l = 0; l < p->r->latent_count; l++) {
            const report_entry *e = report_find(p->r, form, net, p->r->latents[l]);
            if (e && e->done)
                p->curves[p->curve_count++] = e;
        }
}

static double x_of(const plot *p, int rank)
{
    return p->left + p->step * (rank + 0.5);
}

static double y_of(const plot *p, double error)
{
    return PLOT_TOP + PLOT_HEIGHT * (p->top - error) / (p->top - p->bottom);
}

static void write_escaped(FILE *file, const char *text)
{
    for (; *text; text++) {
        const char *entity = *text == '&'   ? "&amp;"
                             : *text == '<' ? "&lt;"
                             : *text == '>' ? "&gt;"
                                            : NULL;
        if (entity)
            fputs(entity, file);
        else
            putc(*text, file);
    }
}

static void write_error_axis(const plot *p)
{
    for (double error = p->bottom; error < p->top + 1e-9; error += p->tick) {
        double y = y_of(p, error);
        fprintf(p->file, "<path d=\"M%.1f %.1fh%.1f\" stroke=\"#ddd\"/>\n", p->left, y,
                p->step * p->r->data.count);
        fprintf(p->file, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.*f</text>\n",
                p->left - 8.0, y + 4.0, p->psnr ? 0 : 2, error);
    }
    fprintf(
        p->file,
        "<text transform=\"translate(%.1f %d) rotate(-90)\" text-anchor=\"middle\">%s%s%s</text>\n",
        p->left - 48.0, PLOT_TOP + PLOT_HEIGHT / 2, p->psnr ? "PSNR, dB" : "SMAPE, ",
        p->psnr ? "" : hnbrdf_sampler_name((hnbrdf_sampler)p->r->sampler),
        p->psnr ? "" : " sampler");
}

static void write_name(const plot *p, int rank)
{
    fprintf(p->file, "<text transform=\"translate(%.1f %d) rotate(-50)\" text-anchor=\"end\">",
            x_of(p, rank) + 4.0, PLOT_TOP + PLOT_HEIGHT + 16);
    write_escaped(p->file, hnbrdf_measured_name(p->r->data.items[p->order[rank].material]));
    fputs("</text>\n", p->file);
}

static void write_material_axis(const plot *p)
{
    int count = p->r->data.count, bottom = PLOT_TOP + PLOT_HEIGHT;
    for (int k = 0; k < count; k++)
        if (p->named)
            write_name(p, k);
        else if (k == 0 || (k + 1) % 10 == 0)
            fprintf(p->file, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%d</text>\n",
                    x_of(p, k), bottom + 18, k + 1);
    if (!p->named)
        fprintf(
            p->file,
            "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">materials, each curve in the order "
            "of its "
            "errors</text>\n",
            p->left + 0.5 * p->step * count, bottom + 42);
}

/* Solid for the first latent size, dashed for the others. */
static const char *dashes(const plot *p, const report_entry *e)
{
    int first = p->r->latents[0] + (e->form == REPORT_NEURAL ? REPORT_ANALYTIC_NUMBERS : 0);
    return e->form == REPORT_GGX || e->latent == first ? "" : " stroke-dasharray=\"5 3\"";
}

static void write_curve(plot *p, const report_entry *e)
{
    const char *color = form_colors[e->form];
    if (!p->named)
        sort_materials(p, e);
    fprintf(p->file, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\"%s d=\"", color,
            dashes(p, e));
    for (int k = 0; k < p->r->data.count; k++)
        fprintf(p->file, "%c%.1f %.1f", k ? 'L' : 'M', x_of(p, k),
                y_of(p, value_of(p, e, p->order[k].material)));
    fputs("\"/>\n", p->file);
    for (int k = 0; p->named && k < p->r->data.count; k++)
        fprintf(p->file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.5\" fill=\"%s\"/>\n", x_of(p, k),
                y_of(p, value_of(p, e, p->order[k].material)), color);
}

static void write_legend(const plot *p, double x)
{
    static const char *const titles[REPORT_FORMS] = {"GGX alone", "hybrid", "paper's form",
                                                     "neural"};
    for (int k = 0; k < p->curve_count; k++) {
        const report_entry *e = p->curves[k];
        int y = PLOT_TOP + 16 + k * LEGEND_LINE;
        fprintf(p->file, "<path d=\"M%.1f %dh28\" stroke=\"%s\" stroke-width=\"2\"%s/>\n", x, y - 4,
                form_colors[e->form], dashes(p, e));
        fprintf(p->file, "<text x=\"%.1f\" y=\"%d\">%s", x + 36.0, y, titles[e->form]);
        if (e->form != REPORT_GGX)
            fprintf(p->file, " %dx%d l=%d", e->net[0], e->net[1], e->latent);
        if (p->psnr)
            fprintf(p->file, ", mean %.1f dB</text>\n", e->mean_psnr);
        else
            fprintf(p->file, ", mean %.3f</text>\n", e->mean[p->r->sampler].smape);
    }
}

/* The longest name and the largest error decide about margins and axis. */
static void lay_out(plot *p)
{
    size_t longest = 0;
    double least = 1e9, most = p->psnr ? 1.0 : 0.05;
    int count = p->r->data.count;
    for (int m = 0; m < count; m++) {
        size_t length = strlen(hnbrdf_measured_name(p->r->data.items[m]));
        longest = length > longest ? length : longest;
        for (int k = 0; k < p->curve_count; k++) {
            most = fmax(most, value_of(p, p->curves[k], m));
            least = fmin(least, value_of(p, p->curves[k], m));
        }
    }
    p->named = count <= NAMED_MATERIALS;
    p->left = p->named ? fmax(64.0, 4.6 * (double)longest - 10.0) : 64.0;
    p->below = p->named ? 28.0 + 5.4 * (double)longest : 60.0;
    p->tick = most > 1.0 ? 0.25 : most > 0.5 ? 0.1 : 0.05;
    if (p->psnr)
        p->tick = most - least > 40.0 ? 10.0 : 5.0;
    p->bottom = p->psnr ? p->tick * floor(least / p->tick) : 0.0;
    p->top = p->tick * ceil(most / p->tick + 1e-9);
    p->step =
        count > NAMED_MATERIALS ? fmax(2.0, 720.0 / count) : fmax(18.0, fmin(40.0, 720.0 / count));
}

static void write_whole(const report *r, const int net[2], int psnr, FILE *file)
{
    plot p = {.r = r, .file = file, .psnr = psnr};
    p.order = malloc((size_t)r->data.count * sizeof *p.order);
    if (p.order && r->entries[0].done) {
        choose_curves(&p, net);
        lay_out(&p);
        sort_materials(&p, &r->entries[0]);
        double legend = p.left + p.step * r->data.count + 16.0;
        fprintf(file,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
                "font-family=\"sans-serif\" font-size=\"12\">\n"
                "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
                legend + LEGEND_WIDTH, PLOT_TOP + PLOT_HEIGHT + p.below);
        write_error_axis(&p);
        write_material_axis(&p);
        for (int k = 0; k < p.curve_count; k++)
            write_curve(&p, p.curves[k]);
        write_legend(&p, legend);
        fputs("</svg>\n", file);
    }
    free(p.order);
}

void report_write_plot(const report *r, const int net[2], FILE *file)
{
    write_whole(r, net, 0, file);
}

void report_write_psnr_plot(const report *r, const int net[2], FILE *file)
{
    write_whole(r, net, 1, file);
}
