/* grid_ggx.c: how good the fits of GGX alone are, material by material: whether any was left at
 * a bad local minimum, and where their parameters lie. */
#include "base/write.h"
#include "report/grid.h"
#include "plot/svg.h"

#include <math.h>
#include <stdlib.h>

/* Worse by less than this share, the second best start counts as the same minimum. */
#define SAME_MINIMUM 0.01

/* ---- Order ----------------------------------------------------------------------------------- */

typedef struct place {
    double error;
    int material;
} place;

static int compare_places(const void *a, const void *b)
{
    const place *x = a, *y = b;
    return x->error < y->error ? -1 : x->error > y->error ? 1 : x->material - y->material;
}

/* The materials by rising error of GGX; malloc'ed, NULL when memory is short. */
static place *sorted(const report *r)
{
    place *places = malloc((size_t)r->data.count * sizeof *places);
    for (int m = 0; places && m < r->data.count; m++)
        places[m] = (place){report_error(r, &r->entries[0], m), m};
    if (places)
        qsort(places, (size_t)r->data.count, sizeof *places, compare_places);
    return places;
}

/* How much worse the second best start ended, as a share; infinite without one, NaN if not known.
 * */
static double spread(const report *r, int m)
{
    const hnbrdf_fit_search *s = &r->search[m];
    if (s->starts == 0 || !(s->best > 0.0))
        return NAN;
    return s->second / s->best - 1.0;
}

/* ---- CSV ------------------------------------------------------------------------------------- */

void report_write_ggx(const report *r, FILE *file)
{
    place *places = sorted(r);
    fputs("material,smape,alpha_x,alpha_y,eta_r,eta_g,eta_b,kd_r,kd_g,kd_b,starts,loss,second_loss,"
          "second_alpha_x,second_alpha_y\n",
          file);
    for (int k = 0; places && r->entries[0].done && k < r->data.count; k++) {
        int m = places[k].material;
        const hnbrdf_material *g = &r->ggx[m];
        const hnbrdf_fit_search *s = &r->search[m];
        hnbrdf_write_csv_text(file, hnbrdf_measured_name(r->data.items[m]));
        fprintf(file, ",%.6g", places[k].error);
        for (int a = 0; a < 2; a++)
            fprintf(file, ",%.6g", (double)g->alpha[a]);
        for (int c = 0; c < 3; c++)
            fprintf(file, ",%.6g", (double)g->eta[c]);
        for (int c = 0; c < 3; c++)
            fprintf(file, ",%.6g", (double)g->kd[c]);
        fprintf(file, ",%d,%.6g", s->starts, s->best);
        if (isfinite(s->second))
            fprintf(file, ",%.6g,%.6g,%.6g\n", s->second, (double)s->second_alpha[0],
                    (double)s->second_alpha[1]);
        else
            fputs(",,,\n", file);
    }
    free(places);
}

/* ---- Markdown -------------------------------------------------------------------------------- */

/* Least, quartiles and most of what value() gives for all materials. */
static void write_quantiles(const report *r, const char *name,
                            double (*value)(const report *r, int m), FILE *file)
{
    int count = r->data.count;
    place *places = malloc((size_t)count * sizeof *places);
    if (!places)
        return;
    for (int m = 0; m < count; m++)
        places[m] = (place){value(r, m), m};
    qsort(places, (size_t)count, sizeof *places, compare_places);
    fprintf(file, "| %s |", name);
    for (int q = 0; q <= 4; q++)
        fprintf(file, " %.4g |", places[(count - 1) * q / 4].error);
    putc('\n', file);
    free(places);
}

static double error_of(const report *r, int m)
{
    return report_error(r, &r->entries[0], m);
}

static double alpha_of(const report *r, int m)
{
    return sqrt((double)r->ggx[m].alpha[0] * (double)r->ggx[m].alpha[1]);
}

static double eta_of(const report *r, int m)
{
    const float *eta = r->ggx[m].eta;
    return ((double)eta[0] + (double)eta[1] + (double)eta[2]) / 3.0;
}

static double kd_of(const report *r, int m)
{
    const float *kd = r->ggx[m].kd;
    return ((double)kd[0] + (double)kd[1] + (double)kd[2]) / 3.0;
}

static void write_lone_minima(const report *r, FILE *file)
{
    int known = 0, same = 0, listed = 0;
    for (int m = 0; m < r->data.count; m++) {
        double s = spread(r, m);
        known += !isnan(s);
        same += s <= SAME_MINIMUM;
    }
    fprintf(file,
            "\nEvery fit starts from 8 places (48 if anisotropic), and its three best are followed "
            "to the "
            "end. For %d of %d\nmaterials the second best ends within %.0f %% of the best's loss",
            same, known, 100.0 * SAME_MINIMUM);
    if (same == known) {
        fputs(".\n", file);
        return;
    }
    fputs("; the others, where one start alone found the best (by how much,\nalpha, alpha of the "
          "second): ",
          file);
    for (int m = 0; m < r->data.count; m++) {
        double s = spread(r, m);
        if (isnan(s) || s <= SAME_MINIMUM)
            continue;
        fprintf(file, "%s%s (%.0f %%, %.3f, %.3f)", listed++ ? ", " : "",
                hnbrdf_measured_name(r->data.items[m]), 100.0 * s, (double)r->ggx[m].alpha[0],
                (double)r->search[m].second_alpha[0]);
    }
    fputs(".\n", file);
}

static void write_analytic_parts(const report *r, FILE *file)
{
    fputs("\nThe analytic part of each hybrid by itself, over GGX alone (mean error, and the worst "
          "material); "
          "bar: 1.05.\n\n| model | mean | worst material | ratio there |\n|---|---|---|---|\n",
          file);
    for (int k = 0; k < r->count; k++) {
        const report_entry *e = &r->entries[k];
        if (!e->done || (e->form != REPORT_HYBRID && e->form != REPORT_PAPER))
            continue;
        double most = 0.0;
        int worst = 0;
        for (int m = 0; m < r->data.count; m++) {
            double ratio =
                e->errors[r->sampler * r->data.count + m].smape_analytic / error_of(r, m);
            if (ratio > most) {
                most = ratio;
                worst = m;
            }
        }
        fprintf(file, "| %s | %.3f | %s | %.3f |\n", e->name,
                e->mean[r->sampler].smape_analytic / r->entries[0].mean[r->sampler].smape,
                hnbrdf_measured_name(r->data.items[worst]), most);
    }
}

void report_write_ggx_section(const report *r, FILE *file)
{
    if (!r->entries[0].done)
        return;
    fprintf(
        file,
        "\n## The fits of GGX alone\n\nOver the materials (ggx.csv has each of them, ggx.svg shows "
        "them); "
        "SMAPE: %s sampler;\nalpha: geometric mean of both; eta, kd: mean of the channels.\n\n"
        "| | least | quarter | median | three quarters | most |\n|---|---|---|---|---|---|\n",
        hnbrdf_sampler_name((hnbrdf_sampler)r->sampler));
    write_quantiles(r, "SMAPE", error_of, file);
    write_quantiles(r, "alpha", alpha_of, file);
    write_quantiles(r, "eta", eta_of, file);
    write_quantiles(r, "kd", kd_of, file);
    write_lone_minima(r, file);
    write_analytic_parts(r, file);
    fputs("\n![GGX alone](ggx.svg)\n", file);
}

/* ---- Plot ------------------------------------------------------------------------------------ */

enum { PANELS = 4, PANEL_HEIGHT = 120, PANEL_STEP = 172, PANEL_WIDTH = 640 };

void report_write_ggx_plot(const report *r, FILE *file)
{
    static const char *const titles[PANELS] = {"SMAPE", "alpha", "eta - 1", "2nd start, % worse"};
    static const double lows[PANELS] = {0.0, 1e-3, 1e-2, 1e-3},
                        highs[PANELS] = {0.1, 1.0, 10.0, 100.0};
    place *places = sorted(r);
    svg_begin(file, 96 + PANEL_WIDTH, 40 + PANELS * PANEL_STEP + 20);
    char heading[64];
    snprintf(heading, sizeof heading, "GGX alone, materials by rising error (%s sampler)",
             hnbrdf_sampler_name((hnbrdf_sampler)r->sampler));
    svg_heading(file, 72, 24, heading);
    for (int p = 0; places && r->entries[0].done && p < PANELS; p++) {
        svg_panel panel = {72,
                           40.0 + p * PANEL_STEP,
                           PANEL_WIDTH,
                           PANEL_HEIGHT,
                           {0.0, r->data.count + 1.0, 0, p == PANELS - 1 ? "material" : NULL},
                           {lows[p], highs[p], p > 0, titles[p]}};
        for (int pass = 0; pass < 2; pass++) {
            if (pass)
                svg_panel_draw(file, &panel);
            for (int k = 0; k < r->data.count; k++) {
                int m = places[k].material;
                double value = p == 0   ? places[k].error
                               : p == 1 ? alpha_of(r, m)
                               : p == 2 ? eta_of(r, m) - 1.0
                                        : 100.0 * spread(r, m);
                if (p == 3 && isfinite(value)) /* equal ends are drawn on the axis */
                    value = fmin(fmax(value, lows[3]), 1e4);
                if (!isfinite(value))
                    continue;
                if (pass)
                    svg_mark(file, SVG_CIRCLE, svg_x(&panel, k + 1.0), svg_y(&panel, value), 2.5,
                             svg_colors[1], 0);
                else
                    svg_axis_include(&panel.y, value);
            }
        }
    }
    svg_end(file);
    free(places);
}
