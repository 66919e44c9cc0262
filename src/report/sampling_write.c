/* sampling_write.c: what `hnbrdf report sampling` writes: a table for programs, a page for
 * people, a plot. */
#include "report/sampling.h"

#include "base/error.h"
#include "plot/svg.h"
#include "base/write.h"
#include "report/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static hnbrdf_result write_file(const sampling_report *r, const char *name,
                                void (*write)(const sampling_report *r, FILE *file))
{
    report_output output;
    char *path = report_path_join(r->directory, name, r->error);
    hnbrdf_result code = path ? report_output_open(path, &output, r->error) : HNBRDF_ERROR_MEMORY;
    free(path);
    if (code != HNBRDF_OK)
        return code;
    write(r, output.file);
    return report_output_close(&output, r->error);
}

/* ---- CSV ------------------------------------------------------------------------------------- */

static void write_csv(const sampling_report *r, FILE *file)
{
    fputs("material,model,alpha,sampler,spp,mse,mean,ns_per_sample,reference_spp,size\n", file);
    for (int m = 0; m < r->count; m++) {
        const sampling_subject *s = &r->subjects[m];
        for (int way = 0; way < SAMPLING_WAYS && s->done; way++)
            for (int k = 0; k < r->count_count && s->runs[way].ns > 0.0; k++) {
                hnbrdf_write_csv_text(file, s->name);
                putc(',', file);
                hnbrdf_write_csv_text(file, s->file);
                fprintf(file, ",%.9g,%s,%d,%.9g,%.9g,%.1f,%ld,%ld\n", (double)s->material->alpha[0],
                        sampling_name((sampling_way)way), r->counts[k], s->runs[way].mse[k],
                        s->level, s->runs[way].ns, r->light.spp, r->size);
            }
    }
}

/* ---- Page ------------------------------------------------------------------------------------ */

static void write_number(FILE *file, double value)
{
    if (value > 0.0)
        fprintf(file, value < 10.0 ? " %.2f |" : " %.0f |", value);
    else
        fputs(" - |", file);
}

static void write_means(const sampling_report *r, FILE *file)
{
    fputs("| mean |  |", file);
    for (int way = 0; way < SAMPLING_WAYS; way++)
        write_number(file, sampling_mean_ratio(r, 0, (sampling_way)way, SAMPLING_TABULATED, 2.0));
    fprintf(file, "\n| mean, %d stratified samples |  |", r->counts[r->at]);
    for (int way = 0; way < SAMPLING_WAYS; way++)
        write_number(file,
                     sampling_mean_ratio(r, r->at, (sampling_way)way, SAMPLING_TABULATED, 2.0));
    fputs("\n| efficiency |  |", file);
    for (int way = 0; way < SAMPLING_WAYS; way++)
        write_number(file, sampling_mean_efficiency(r, (sampling_way)way));
    fputs("\n", file);
}

static void write_page(const sampling_report *r, FILE *file)
{
    fprintf(file, "# Sampling\n\nMade by `%s`.\n\n", r->command_line);
    fprintf(file,
            "A sphere of each material under `%s`, %ld pixels wide, directions drawn from the BRDF "
            "alone. Variance of one\n"
            "sample a pixel: the mean squared error of %d renderings against a reference (%ld "
            "samples, light and BRDF\n"
            "joined), over that of a sampler which has the whole BRDF in a table (90 x 90 x 180 "
            "numbers, after Lawrence et\n"
            "al. 2004). Efficiency is 1/(variance x processor time), over that of the table; time "
            "is of the whole estimator,\n"
            "with evaluation.\n\n",
            r->light.env, r->size, r->counts[r->at], r->light.spp);
    fputs("| material | alpha |", file);
    for (int way = 0; way < SAMPLING_WAYS; way++)
        fprintf(file, " %s |", sampling_title((sampling_way)way));
    fputs("\n|---|---|---|---|---|---|---|\n", file);
    for (int m = 0; m < r->count; m++) {
        const sampling_subject *s = &r->subjects[m];
        if (!s->done)
            continue;
        fprintf(file, "| %s | %.3f |", s->name, (double)s->material->alpha[0]);
        for (int way = 0; way < SAMPLING_WAYS; way++)
            write_number(file, sampling_ratio(s, 0, (sampling_way)way, SAMPLING_TABULATED));
        fputs("\n", file);
    }
    write_means(r, file);
    fprintf(file,
            "\nGlossy materials (alpha < 0.1): cosine alone has %.0f times the variance of the "
            "fitted lobes.\n\n",
            sampling_mean_ratio(r, 0, SAMPLING_COSINE, SAMPLING_FITTED, 0.1));
    fputs("![Error over samples a pixel](sampling.svg)\n\n![Strips](sampling-strips.png)\n", file);
}

/* ---- Plot ------------------------------------------------------------------------------------ */

/* Mean over the materials of the error over the material's own brightness squared; 0 if none has
 * this way. */
static double relative_error(const sampling_report *r, int way, int k)
{
    double sum = 0.0;
    int count = 0;
    for (int m = 0; m < r->count; m++) {
        const sampling_subject *s = &r->subjects[m];
        if (s->done && s->runs[way].mse[k] > 0.0 && s->level > 0.0) {
            sum += s->runs[way].mse[k] / (s->level * s->level);
            count++;
        }
    }
    return count ? sum / count : 0.0;
}

static void write_plot(const sampling_report *r, FILE *file)
{
    enum { LEFT = 76, TOP = 56, WIDTH = 520, HEIGHT = 360 };
    svg_panel panel = {.left = LEFT,
                       .top = TOP,
                       .width = WIDTH,
                       .height = HEIGHT,
                       .x = {r->counts[0], r->counts[r->count_count - 1], 1, "samples a pixel"},
                       .y = {1.0, 0.0, 1, "mean squared error over brightness squared"}};
    for (int way = 0; way < SAMPLING_WAYS; way++)
        for (int k = 0; k < r->count_count; k++)
            if (relative_error(r, way, k) > 0.0)
                svg_axis_include(&panel.y, relative_error(r, way, k));
    svg_axis_pad(&panel.x, 0.02);
    svg_axis_pad(&panel.y, 0.04);
    svg_begin(file, LEFT + WIDTH + 190, TOP + HEIGHT + 60);
    svg_heading(file, LEFT, 24, "Noise of sampling");
    char text[160];
    snprintf(text, sizeof text, "mean over %d materials; %s; directions from the BRDF alone",
             r->count, r->light.env);
    svg_text(file, LEFT, 44, "start", NULL, text);
    svg_panel_draw(file, &panel);
    for (int way = 0; way < SAMPLING_WAYS; way++) {
        const char *color = svg_colors[(way + 1) % SVG_COLORS];
        double last = 0.0;
        svg_path_begin(file, color, 2.0, way == SAMPLING_TABULATED);
        for (int k = 0; k < r->count_count; k++)
            if ((last = relative_error(r, way, k)) > 0.0)
                svg_path_point(file, svg_x(&panel, r->counts[k]), svg_y(&panel, last));
        svg_path_end(file);
        for (int k = 0; k < r->count_count; k++)
            if (relative_error(r, way, k) > 0.0)
                svg_mark(file, (svg_shape)(way % SVG_SHAPES), svg_x(&panel, r->counts[k]),
                         svg_y(&panel, relative_error(r, way, k)), 3.5, color,
                         way == SAMPLING_TABULATED);
        double y = TOP + 14.0 + 20.0 * way;
        svg_line(file, LEFT + WIDTH + 16, y - 4, LEFT + WIDTH + 44, y - 4, color, 2.0,
                 way == SAMPLING_TABULATED);
        svg_text(file, LEFT + WIDTH + 52, y, "start", NULL, sampling_title((sampling_way)way));
    }
    svg_end(file);
}

hnbrdf_result sampling_write(const sampling_report *r)
{
    hnbrdf_result code = write_file(r, "sampling.csv", write_csv);
    if (code == HNBRDF_OK)
        code = write_file(r, "sampling.md", write_page);
    return code == HNBRDF_OK ? write_file(r, "sampling.svg", write_plot) : code;
}
