/* grid_tables.c: the results of a report as CSV and as Markdown in the layout of the paper's
 * tables. */
#include "base/write.h"
#include "report/grid.h"
#include "report/paper.h"

#include <string.h>

/* ---- CSV ------------------------------------------------------------------------------------- */

/* Empty for a neural model, which has no analytic part. */
static void write_analytic_column(const report_entry *e, const hnbrdf_comparison *error, FILE *file)
{
    if (e->form == REPORT_NEURAL)
        putc(',', file);
    else
        fprintf(file, ",%.6g", error->smape_analytic);
}

/* Empty if no pictures are made. */
static void write_picture_columns(const report *r, double psnr, double flip, FILE *file)
{
    if (r->image_size)
        fprintf(file, ",%.6g,%.6g", psnr, flip);
    else
        fputs(",,", file);
}

void report_write_accuracy(const report *r, FILE *file)
{
    fputs(
        "kind,net,encoding,latent,steps,seconds,pairs_per_s,weights,mults,smape_grid,smape_uniform,"
        "smape_analytic,smape_cosine,floor,psnr,flip,name\n",
        file);
    for (int k = 0; k < r->count; k++) {
        const report_entry *e = &r->entries[k];
        if (!e->done)
            continue;
        report_write_model_columns(e, file);
        fprintf(file, ",%ld,%.3f,%.0f,%zu,%zu,%.6g,%.6g", e->steps, e->seconds, e->pairs_per_s,
                e->weights, e->mults, e->mean[HNBRDF_SAMPLER_GRID].smape,
                e->mean[HNBRDF_SAMPLER_UNIFORM].smape);
        write_analytic_column(e, &e->mean[r->sampler], file);
        fprintf(file, ",%.6g,%.6g", e->mean[HNBRDF_SAMPLER_COSINE].smape, (double)e->floor);
        write_picture_columns(r, e->mean_psnr, e->mean_flip, file);
        fprintf(file, ",%s\n", e->name);
    }
}

/* alone: 1 of a material that was left to GGX alone; empty where there is no network or no GGX. */
void report_write_materials(const report *r, FILE *file)
{
    int n = r->data.count;
    fputs("material,kind,net,encoding,latent,smape_grid,smape_uniform,smape_analytic,smape_cosine,"
          "psnr,flip,alone,name\n",
          file);
    for (int k = 0; k < r->count; k++)
        for (int m = 0; r->entries[k].done && m < n; m++) {
            const report_entry *e = &r->entries[k];
            hnbrdf_write_csv_text(file, hnbrdf_measured_name(r->data.items[m]));
            putc(',', file);
            report_write_model_columns(e, file);
            fprintf(file, ",%.6g,%.6g", e->errors[HNBRDF_SAMPLER_GRID * n + m].smape,
                    e->errors[HNBRDF_SAMPLER_UNIFORM * n + m].smape);
            write_analytic_column(e, &e->errors[r->sampler * n + m], file);
            fprintf(file, ",%.6g", e->errors[HNBRDF_SAMPLER_COSINE * n + m].smape);
            write_picture_columns(r, e->pictures[m].psnr, e->pictures[m].flip, file);
            if (report_is_judged(e->form))
                fprintf(file, ",%d,%s\n", e->judged[m] == REPORT_ALONE, e->name);
            else
                fprintf(file, ",,%s\n", e->name);
        }
}

/* ---- Markdown: the tables of errors ---------------------------------------------------------- */

static void write_error_cell(const report_entry *e, int sampler, FILE *file)
{
    if (e && e->done)
        fprintf(file, " %.4f |", e->mean[sampler].smape);
    else
        fputs(" |", file);
}

static void write_errors(const report *r, int sampler, FILE *file)
{
    fprintf(file, "\n## Mean SMAPE, %s sampler\n\nGGX alone: ",
            hnbrdf_sampler_name((hnbrdf_sampler)sampler));
    fprintf(file, "%.4f.\n\n", r->entries[0].mean[sampler].smape);
    report_write_form_header(r, file);
    for (int n = 0; n < r->net_count; n++) {
        fprintf(file, "| %dx%d |", r->nets[n][0], r->nets[n][1]);
        for (int l = 0; l < r->latent_count; l++)
            for (report_form form = REPORT_HYBRID; form < REPORT_FORMS; form++)
                if (r->forms[form])
                    write_error_cell(report_find(r, form, r->nets[n], r->latents[l]), sampler,
                                     file);
        putc('\n', file);
    }
}

static void write_images(const report *r, FILE *file)
{
    if (!r->image_size)
        return;
    fputs("\n## Mean PSNR, dB\n\n", file);
    report_write_psnr_method(r, file);
    report_write_psnr_table(r, file);
    fputs("\n## Mean FLIP\n\n", file);
    report_write_flip_table(r, file);
}

/* ---- Markdown: hybrids against the others ---------------------------------------------------- */

static void write_ratio_cell(const report *r, const report_entry *e, const report_entry *other,
                             FILE *file)
{
    double divisor = other && other->done ? other->mean[r->sampler].smape : 0.0;
    if (divisor > 0.0)
        fprintf(file, " %.3f, %d of %d |", e->mean[r->sampler].smape / divisor,
                report_wins(r, e, other), r->data.count);
    else
        fputs(" |", file);
}

static void write_wins(const report *r, FILE *file)
{
    const report_entry *ggx = &r->entries[0];
    fprintf(file,
            "\n## Against the baselines, %s sampler\n\n"
            "Ratio of the mean errors, below 1 where the hybrid is better, and for how many "
            "materials it "
            "is.\n"
            "The last column is the hybrid's analytic part alone over the fit of GGX alone.\n\n"
            "| model | against GGX alone | against the paper's form | against neural | analytic "
            "part |\n"
            "|---|---|---|---|---|\n",
            hnbrdf_sampler_name((hnbrdf_sampler)r->sampler));
    for (int n = 0; n < r->net_count; n++)
        for (int l = 0; l < r->latent_count; l++) {
            const report_entry *e = report_find(r, REPORT_HYBRID, r->nets[n], r->latents[l]);
            if (!e || !e->done)
                continue;
            fprintf(file, "| %dx%d l=%d |", e->net[0], e->net[1], e->latent);
            write_ratio_cell(r, e, ggx, file);
            write_ratio_cell(r, e, report_find(r, REPORT_PAPER, r->nets[n], r->latents[l]), file);
            write_ratio_cell(r, e, report_find(r, REPORT_NEURAL, r->nets[n], r->latents[l]), file);
            fprintf(file, " %.3f |\n",
                    e->mean[r->sampler].smape_analytic / ggx->mean[r->sampler].smape);
        }
}

/* Hybrid and neural where a material stores as many numbers. */
static void write_equal_numbers(const report *r, FILE *file)
{
    fprintf(
        file,
        "\n## Hybrid against neural at equal numbers a material, %s sampler\n\n"
        "Same encoding, floor, network size and training; wins: for how many materials the hybrid "
        "is "
        "better.\n\n| net | numbers | SMAPE hybrid | neural | wins |%s\n|---|---|---|---|---|%s\n",
        hnbrdf_sampler_name((hnbrdf_sampler)r->sampler),
        r->image_size ? " PSNR hybrid | neural | wins |" : "", r->image_size ? "---|---|---|" : "");
    for (int n = 0; n < r->net_count; n++)
        for (int l = 0; l < r->latent_count; l++) {
            const report_entry *a = report_find(r, REPORT_HYBRID, r->nets[n], r->latents[l]);
            const report_entry *b = report_find(r, REPORT_NEURAL, r->nets[n], r->latents[l]);
            if (!a || !b || !a->done || !b->done)
                continue;
            fprintf(file, "| %dx%d | %d | %.4f | %.4f | %d of %d |", a->net[0], a->net[1],
                    a->latent + REPORT_ANALYTIC_NUMBERS, a->mean[r->sampler].smape,
                    b->mean[r->sampler].smape, report_wins(r, a, b), r->data.count);
            if (r->image_size)
                fprintf(file, " %.2f | %.2f | %d of %d |", a->mean_psnr, b->mean_psnr,
                        report_image_wins(r, a, b), r->data.count);
            putc('\n', file);
        }
}

/* How many materials each model of a network's size is the best for. */
static void write_best(const report *r, FILE *file)
{
    fprintf(file, "\n## For how many materials a model is the best of its row, %s sampler\n\n",
            hnbrdf_sampler_name((hnbrdf_sampler)r->sampler));
    fputs("| net | GGX alone | hybrid | paper's form | neural |\n|---|---|---|---|---|\n", file);
    for (int n = 0; n < r->net_count; n++)
        for (int l = 0; l < r->latent_count; l++) {
            int wins[REPORT_FORMS] = {0};
            for (int m = 0; m < r->data.count; m++) {
                const report_entry *best = &r->entries[0];
                for (report_form form = REPORT_HYBRID; form < REPORT_FORMS; form++) {
                    const report_entry *e = report_find(r, form, r->nets[n], r->latents[l]);
                    if (e && e->done && report_error(r, e, m) < report_error(r, best, m))
                        best = e;
                }
                wins[best->form]++;
            }
            fprintf(file, "| %dx%d l=%d | %d | %d | %d | %d |\n", r->nets[n][0], r->nets[n][1],
                    r->latents[l], wins[REPORT_GGX], wins[REPORT_HYBRID], wins[REPORT_PAPER],
                    wins[REPORT_NEURAL]);
        }
}

/* The hybrid with the fewest multiplications against the paper's form with the most. */
static void write_smallest_against_largest(const report *r, FILE *file)
{
    const report_entry *small = NULL, *large = NULL;
    for (int k = 0; k < r->count; k++) {
        const report_entry *e = &r->entries[k];
        if (e->done && e->form == REPORT_HYBRID && (!small || e->mults < small->mults))
            small = e;
        if (e->done && e->form == REPORT_PAPER && (!large || e->mults > large->mults))
            large = e;
    }
    if (!small || !large || small->mults >= large->mults)
        return;
    fprintf(
        file,
        "\nThe smallest hybrid, %dx%d l=%d, %zu multiplications: %.4f. The largest of the paper's "
        "form, %dx%d "
        "l=%d, %zu multiplications: %.4f.\n",
        small->net[0], small->net[1], small->latent, small->mults, small->mean[r->sampler].smape,
        large->net[0], large->net[1], large->latent, large->mults, large->mean[r->sampler].smape);
}

static void write_costs(const report *r, FILE *file)
{
    fputs("\n## Cost\n\n"
          "| model | encoding | floor | weights | mults | steps | seconds | M pairs/s |\n"
          "|---|---|---|---|---|---|---|---|\n",
          file);
    for (int k = 0; k < r->count; k++) {
        const report_entry *e = &r->entries[k];
        if (!e->done)
            continue;
        fprintf(file, "| %s |", e->name);
        if (e->form == REPORT_GGX)
            fprintf(file, " | | 0 | 0 | | %.1f | |\n", e->seconds);
        else
            fprintf(file, " %s | %.4g | %zu | %zu | %ld | %.1f | %.2f |\n",
                    hnbrdf_encoding_name(e->encoding), (double)e->floor, e->weights, e->mults,
                    e->steps, e->seconds, e->pairs_per_s * 1e-6);
    }
}

/* ---- Markdown: the paper --------------------------------------------------------------------- */

static void write_papers_figures(FILE *file)
{
    fputs("\n## The paper's own figures\n\n", file);
    paper_write_smape(file);
    paper_write_psnr(file);
}

/* ---- Markdown: the whole --------------------------------------------------------------------- */

static void write_method(const report *r, FILE *file)
{
    const char *encoding = "default";
    int done = 0;
    for (int k = 0; k < r->count; k++) {
        done += r->entries[k].done;
        if (r->entries[k].done && r->entries[k].form == REPORT_HYBRID)
            encoding = hnbrdf_encoding_name(r->entries[k].encoding);
    }
    fprintf(file, "# Accuracy\n\nMade by `%s`, hnbrdf %s; %d of %d entries done.\n\n",
            r->command_line, hnbrdf_version(), done, r->count);
    report_write_data(r, file);
    if (r->budget > 0.0)
        fprintf(file, "Training: %g s of network training an entry", r->budget);
    else
        fprintf(file, "Training: %s steps an entry",
                r->steps ? "the same number of" : "the default number of");
    fprintf(file,
            " (see Cost), seed %ld, the same trainer for all. SMAPE: 0 is perfect, 2 the worst; "
            "mean over\n"
            "materials, RGB and %ld valid pairs of directions a material, drawn with seed %ld "
            "apart from "
            "the\n"
            "training's.\n\n"
            "hybrid: encoding %s, floor, analytic part %s. Paper's form: directions, no floor,\n"
            "analytic part trained jointly. neural: as hybrid without an analytic part and with %d "
            "more "
            "latent\n"
            "floats, so that a material stores as many numbers.\n",
            r->seed, r->pairs, r->seed, encoding,
            r->analytic == HNBRDF_FIT_JOINT ? "trained jointly"
                                            : "frozen at the fit of GGX alone (faithful)",
            (int)REPORT_ANALYTIC_NUMBERS);
}

static void write_plots(const report *r, FILE *file)
{
    fputs("\n## Error of every material\n", file);
    for (int n = 0; n < r->net_count; n++)
        fprintf(file, "\n![%dx%d](errors-%dx%d.svg)\n", r->nets[n][0], r->nets[n][1], r->nets[n][0],
                r->nets[n][1]);
}

void report_write_markdown(const report *r, FILE *file)
{
    static const int order[REPORT_SAMPLERS] = {HNBRDF_SAMPLER_GRID, HNBRDF_SAMPLER_UNIFORM,
                                               HNBRDF_SAMPLER_COSINE};
    write_method(r, file);
    if (r->paper)
        report_write_paper(r, file);
    for (int k = 0; k < REPORT_SAMPLERS; k++)
        write_errors(r, order[k], file);
    write_images(r, file);
    if (report_is_complete(r)) {
        write_wins(r, file);
        write_smallest_against_largest(r, file);
        write_equal_numbers(r, file);
        write_best(r, file);
    } else {
        fprintf(file, "\nWhich model is better than which is told when all %d are done.\n",
                r->count);
    }
    report_write_judged(r, file);
    report_write_ggx_section(r, file);
    write_costs(r, file);
    write_plots(r, file);
    write_papers_figures(file);
}

hnbrdf_result report_write_accuracy_files(const report *r)
{
    static const struct {
        const char *name;
        void (*write)(const report *r, FILE *file);
    } files[] = {{"accuracy.csv", report_write_accuracy},
                 {"materials.csv", report_write_materials},
                 {"ggx.csv", report_write_ggx},
                 {"ggx.svg", report_write_ggx_plot},
                 {"report.md", report_write_markdown}};
    hnbrdf_result result = HNBRDF_OK;
    for (size_t k = 0; k < sizeof files / sizeof files[0] && result == HNBRDF_OK; k++)
        result = report_write(r, files[k].name, files[k].write);
    for (int n = 0; n < r->net_count && result == HNBRDF_OK; n++)
        result = report_write_net(r, "errors", r->nets[n], report_write_plot);
    return result;
}
