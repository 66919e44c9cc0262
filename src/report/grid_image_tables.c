/* grid_image_tables.c: the errors of spheres as CSV and as Markdown, the paper's second table
 * among them. */
#include "base/number.h"
#include "base/write.h"
#include "report/grid.h"
#include "report/paper.h"

#include <math.h>
#include <string.h>

/* ---- CSV ------------------------------------------------------------------------------------- */

void report_write_images_csv(const report *r, FILE *file)
{
    fputs("material,kind,net,encoding,latent,mae,mse,psnr,psnr_error,psnr_bias,peak_error,flip,"
          "name\n",
          file);
    for (int m = 0; m < r->data.count; m++)
        for (int k = 0; k < r->count; k++) {
            const report_entry *e = &r->entries[k];
            const report_picture *p = &e->pictures[m];
            if (!p->done)
                continue;
            hnbrdf_write_csv_text(file, hnbrdf_measured_name(r->data.items[m]));
            putc(',', file);
            report_write_model_columns(e, file);
            fprintf(file, ",%.9g,%.9g,%.9g,%.4g,%.4g,%.4g,%.9g,%s\n", p->mae, p->mse, p->psnr,
                    p->psnr_error, p->psnr_bias, p->peak_error, p->flip, e->name);
        }
}

/* ---- The paper's second table ---------------------------------------------------------------- */

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

void report_write_psnr_method(const report *r, FILE *file)
{
    fprintf(
        file,
        "Spheres of each material, one bounce of light from %s%s, %ld x %ld pixels, %ld samples a "
        "pixel, seed %ld,\nthe same random directions for the measurement and all models. Mean "
        "over the pixels that the sphere covers;\npeak: the reference's largest value. Every "
        "sphere "
        "is rendered twice with half of the samples, and what\ndiffers between both is noise: +- "
        "is "
        "the standard error that it leaves.\n",
        strcmp(r->light.env, "sky") == 0 ? "the built-in " : "", base_name(r->light.env),
        r->image_size, r->image_size, 2 * ((r->light.spp + 1) / 2), r->light.seed);
}

/* A row a net, of what `put` writes for a model of which some material is done. */
static void write_nets(const report *r, void (*put)(const report_entry *e, FILE *file), FILE *file)
{
    report_write_form_header(r, file);
    for (int n = 0; n < r->net_count; n++) {
        fprintf(file, "| %dx%d |", r->nets[n][0], r->nets[n][1]);
        for (int l = 0; l < r->latent_count; l++)
            for (report_form form = REPORT_HYBRID; form < REPORT_FORMS; form++) {
                const report_entry *e = report_find(r, form, r->nets[n], r->latents[l]);
                if (r->forms[form] && e && e->mean_psnr > 0.0)
                    put(e, file);
                else if (r->forms[form])
                    fputs(" |", file);
            }
        putc('\n', file);
    }
}

static void put_psnr(const report_entry *e, FILE *file)
{
    fprintf(file, " %.2f +- %.2f |", e->mean_psnr, e->mean_psnr_error);
}

static void put_flip(const report_entry *e, FILE *file)
{
    fprintf(file, " %.4f |", e->mean_flip);
}

void report_write_psnr_table(const report *r, FILE *file)
{
    const report_entry *ggx = &r->entries[0];
    fprintf(file, "\nGGX alone: %.2f +- %.2f.\n\n", ggx->mean_psnr, ggx->mean_psnr_error);
    write_nets(r, put_psnr, file);
}

void report_write_flip_table(const report *r, FILE *file)
{
    fprintf(
        file,
        "FLIP of the same spheres, mean over the pixels that they cover: what a person sees of "
        "the difference\nat %s pixels a degree, 0 for nothing; the largest over the exposures of "
        "HDR-FLIP (%s). It\nis our implementation of Andersson et al. (2020, 2021), not NVIDIA's. "
        "The noise of both renderings counts.\n\nGGX alone: %.4f.\n\n",
        HNBRDF_NUMBER(r->flip.pixels_per_degree > 0.0 ? r->flip.pixels_per_degree : 67.02),
        "include/hnbrdf/metrics.h", r->entries[0].mean_flip);
    write_nets(r, put_flip, file);
}

/* ---- Model against model --------------------------------------------------------------------- */

/* Mean of a's PSNR less b's with its standard error, over the materials that are done; the peaks
 * are the same in both and cancel. */
static void write_gain(const report *r, const report_entry *a, const report_entry *b, FILE *file)
{
    double gain = 0.0, variance = 0.0;
    int done = 0, wins = 0;
    for (int m = 0; b && m < r->data.count; m++) {
        const report_picture *p = &a->pictures[m], *q = &b->pictures[m];
        if (!p->done || !q->done)
            continue;
        done++;
        wins += p->psnr > q->psnr;
        gain += p->psnr - q->psnr;
        variance += p->psnr_error * p->psnr_error + q->psnr_error * q->psnr_error;
    }
    if (done)
        fprintf(file, " %+.2f +- %.2f, %d of %d |", gain / done, sqrt(variance) / done, wins, done);
    else
        fputs(" |", file);
}

/* Over the materials where there is more than noise. */
static void write_bias(const report *r, const report_entry *e, FILE *file)
{
    double bias = 0.0;
    int known = 0, drowned = 0;
    for (int m = 0; m < r->data.count; m++) {
        const report_picture *p = &e->pictures[m];
        if (p->done && isfinite(p->psnr_bias)) {
            bias += p->psnr_bias;
            known++;
        } else if (p->done) {
            drowned++;
        }
    }
    fprintf(file, " %.3f", known ? bias / known : 0.0);
    if (drowned)
        fprintf(file, "; %d drowned", drowned);
    fputs(" |", file);
}

/* The neural model of the same net whose materials store as many numbers. */
static const report_entry *neural_beside(const report *r, const report_entry *e)
{
    return e->form == REPORT_GGX || e->form == REPORT_NEURAL
               ? NULL
               : report_find(r, REPORT_NEURAL, e->net, e->latent);
}

static void write_models(const report *r, FILE *file)
{
    const int complete = report_is_complete(r);
    fputs(
        "\n## Model by model\n\nMean MAE in radiance, FLIP and PSNR in dB; noise: by how much "
        "PSNR is too low because noise counts as error (drowned: materials whose error is less "
        "than the noise). The last\ncolumns: dB more than GGX alone, and than the neural model "
        "that stores as many numbers a material, and for how many\nmaterials PSNR is higher, once "
        "all are done.\n\n"
        "| model | MAE | FLIP | PSNR | noise | against GGX alone | against neural "
        "|\n|---|---|---|---|---|---|---|\n",
        file);
    for (int k = 0; k < r->count; k++) {
        const report_entry *e = &r->entries[k];
        fprintf(file, "| %s | %.5f | %.4f | %.2f +- %.2f |", e->name, e->mean_mae, e->mean_flip,
                e->mean_psnr, e->mean_psnr_error);
        write_bias(r, e, file);
        write_gain(r, e, complete && e->form != REPORT_GGX ? &r->entries[0] : NULL, file);
        write_gain(r, e, complete ? neural_beside(r, e) : NULL, file);
        putc('\n', file);
    }
}

/* ---- The whole ------------------------------------------------------------------------------- */

void report_write_images_markdown(const report *r, FILE *file)
{
    int done = 0, pages = 0;
    for (int m = 0; m < r->data.count; m++) {
        done += r->entries[0].pictures[m].done;
        pages += report_rows_has(r, m);
    }
    pages = (pages + REPORT_ROWS_A_PAGE - 1) / REPORT_ROWS_A_PAGE;
    fprintf(file, "# Image error\n\nMade by `%s`, hnbrdf %s; %d of %d materials done.\n\n",
            r->command_line, hnbrdf_version(), done, r->data.count);
    report_write_data(r, file);
    report_write_psnr_method(r, file);
    fputs("\n## Mean PSNR, dB\n", file);
    report_write_psnr_table(r, file);
    fputs("\n## Mean FLIP\n\n", file);
    report_write_flip_table(r, file);
    write_models(r, file);
    if (done == r->data.count && render_has_exr()) {
        fputs("\n## Picture rows\n\nReference, models and where they differ. pictures/ has the "
              "radiance as "
              "EXR.\n\n",
              file);
        for (int page = 1; page <= pages; page++)
            fprintf(file, "![images-%d](images-%d.png)\n", page, page);
    }
    fputs("\n## PSNR of every material\n", file);
    for (int n = 0; n < r->net_count; n++)
        fprintf(file, "\n![%dx%d](psnr-%dx%d.svg)\n", r->nets[n][0], r->nets[n][1], r->nets[n][0],
                r->nets[n][1]);
    fputs(
        "\n## The paper's own figures\n\nDe Oliveira et al., EGSR 2026: other data (the MERL, RGL "
        "and UTIA "
        "databases). For orientation only.\n",
        file);
    paper_write_psnr(file);
}

hnbrdf_result report_write_image_files(report *r)
{
    for (int k = 0; k < r->count; k++) {
        report_images_average(r, &r->entries[k]);
        r->entries[k].done = 1;
        for (int m = 0; m < r->data.count; m++)
            r->entries[k].done &= r->entries[k].pictures[m].done;
    }
    hnbrdf_result code = report_write(r, "images.csv", report_write_images_csv);
    for (int n = 0; n < r->net_count && code == HNBRDF_OK && r->entries[0].done; n++)
        code = report_write_net(r, "psnr", r->nets[n], report_write_psnr_plot);
    return code == HNBRDF_OK ? report_write(r, "images.md", report_write_images_markdown) : code;
}
