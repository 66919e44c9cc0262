/* grid_paper.c: our figures beside those that the paper prints of the same database. */
#include "report/grid.h"

#include "report/paper.h"

#include <stdlib.h>
#include <string.h>

static const int ORDER[REPORT_SAMPLERS] = {HNBRDF_SAMPLER_GRID, HNBRDF_SAMPLER_UNIFORM,
                                           HNBRDF_SAMPLER_COSINE};

/* ---- Which data ------------------------------------------------------------------------------ */

/* How many materials are of each database, and of none. */
static void count_known(const report *r, int known[PAPER_DATABASES + 1])
{
    memset(known, 0, (PAPER_DATABASES + 1) * sizeof *known);
    for (int m = 0; m < r->data.count; m++) {
        const int database = paper_database_of(r->data.items[m]);
        known[database < 0 ? PAPER_DATABASES : database]++;
    }
}

/* The database that all data are of, or -1. */
static int database_of(const report *r)
{
    int known[PAPER_DATABASES + 1];
    count_known(r, known);
    for (int d = 0; d < PAPER_DATABASES; d++)
        if (known[d] == r->data.count)
            return d;
    return -1;
}

void report_write_recognised(const report *r, FILE *file)
{
    static const char *const how[PAPER_DATABASES] = {
        ", by the checksums of their files", ", by their names; what the files hold is not checked",
        ", by their names; what the files hold is not checked"};
    int known[PAPER_DATABASES + 1], written = 0;
    count_known(r, known);
    fputs("Data: ", file);
    for (int d = 0; d < PAPER_DATABASES; d++)
        if (known[d] > 0)
            fprintf(file, "%s%d of the %d materials of %s%s", written++ ? "; " : "", known[d],
                    hnbrdf_paper_materials[d], hnbrdf_paper_names[d], how[d]);
    if (known[PAPER_DATABASES] > 0)
        fprintf(file, "%s%d material%s of no database of the paper", written ? "; " : "",
                known[PAPER_DATABASES], known[PAPER_DATABASES] == 1 ? "" : "s");
    fputs(".\n", file);
}

/* ---- What differs ---------------------------------------------------------------------------- */

static void write_differences(const report *r, int database, FILE *file)
{
    fputs("\nWhat differs from the paper:\n\n"
          "- The sampler: the paper does not say how it draws directions. The columns are the "
          "three of\n"
          "  ours, the printed figure belongs to none of them for certain.\n",
          file);
    if (database < 0)
        fputs("- The data: these are not one database of the paper, so that nothing printed stands "
              "beside ours.\n",
              file);
    else if (r->data.count != hnbrdf_paper_materials[database])
        fprintf(file,
                "- The data: a network has %d materials here and %d there; fewer are easier.\n",
                r->data.count, hnbrdf_paper_materials[database]);
    fprintf(file,
            "- The training: ours, %s, the same for all rows; the paper's models have their own.\n"
            "- Paper's form is what the paper describes, trained by us: directions as inputs, no "
            "floor, GGX trained\n  jointly. Hybrid and neural have our encoding and floor, hybrid "
            "keeps the fit of GGX%s.\n",
            r->budget > 0.0 ? "for equal seconds" : "for equal steps (see Cost)",
            r->analytic == HNBRDF_FIT_JOINT ? " only as a start" : "");
}

/* ---- Tables ---------------------------------------------------------------------------------- */

/* The printed figure of one of our rows, 0 where there is none. */
static double printed(const report_entry *e, int database, int psnr)
{
    const paper_row *row = e->form == REPORT_GGX ? NULL : paper_find(e->net);
    if (database < 0 || e->form == REPORT_HYBRID)
        return 0.0;
    if (e->form == REPORT_GGX)
        return psnr ? hnbrdf_paper_ggx_psnr[database] : hnbrdf_paper_ggx_smape[database];
    const int model = e->form == REPORT_NEURAL ? PAPER_NEURAL : PAPER_HYBRID;
    if (!row || e->latent != (model == PAPER_NEURAL ? PAPER_NEURAL_LATENT : PAPER_HYBRID_LATENT))
        return 0.0;
    return psnr ? row->psnr[database][model] : row->smape[database][model];
}

static void write_title(const report_entry *e, FILE *file)
{
    if (e->form == REPORT_GGX)
        fprintf(file, "| GGX alone | %d |", (int)REPORT_ANALYTIC_NUMBERS);
    else
        fprintf(file, "| %dx%d %s, l = %d | %d |", e->net[0], e->net[1], report_form_title(e->form),
                e->latent, e->latent + (e->form == REPORT_NEURAL ? 0 : REPORT_ANALYTIC_NUMBERS));
}

static void write_printed(double value, const char *format, FILE *file)
{
    if (value > 0.0)
        fprintf(file, format, value);
    else
        fputs(" |", file);
}

/* A network that was not fitted here, and GGX alone over the materials that it has. */
static void write_outside(const report *r, int which, int database, FILE *file)
{
    const report_outside *o = &r->outside[which];
    if (o->has == 0)
        return;
    if (which == REPORT_NBRDF) {
        fprintf(file, "| NBRDF, a network a material, %d of %d | %d | |", o->has, r->data.count,
                (int)REPORT_NBRDF_NUMBERS);
    } else {
        hnbrdf_model_desc desc;
        hnbrdf_model_describe(r->published, &desc);
        const int net[2] = {desc.hidden, desc.layers};
        const paper_row *row = paper_find(net);
        const int whole = row && database >= 0 && desc.latent == PAPER_HYBRID_LATENT;
        fprintf(file, "| the published networks, %dx%d, l = %d, %d of %d | %d |", net[0], net[1],
                desc.latent, o->has, r->data.count, desc.latent + (int)REPORT_ANALYTIC_NUMBERS);
        write_printed(whole ? row->smape[database][PAPER_HYBRID] : 0.0, " %.4f |", file);
    }
    for (int k = 0; k < REPORT_SAMPLERS; k++)
        fprintf(file, " %.4f |", o->smape[ORDER[k]]);
    putc('\n', file);
    if (o->has == r->data.count || !r->entries[0].done)
        return;
    fprintf(file, "| GGX alone, of those %d | %d | |", o->has, (int)REPORT_ANALYTIC_NUMBERS);
    for (int k = 0; k < REPORT_SAMPLERS; k++)
        fprintf(file, " %.4f |", report_ggx_beside(r, o, ORDER[k]));
    putc('\n', file);
}

static void write_smape(const report *r, int database, FILE *file)
{
    fputs("\n| model | numbers a material | printed | grid | uniform | cosine |\n"
          "|---|---|---|---|---|---|\n",
          file);
    for (int k = 0; k < r->count; k++) {
        const report_entry *e = &r->entries[k];
        if (!e->done)
            continue;
        write_title(e, file);
        write_printed(printed(e, database, 0), e->form == REPORT_GGX ? " %.2f |" : " %.4f |", file);
        for (int s = 0; s < REPORT_SAMPLERS; s++)
            fprintf(file, " %.4f |", e->mean[ORDER[s]].smape);
        putc('\n', file);
    }
    for (int which = 0; which < REPORT_OUTSIDES; which++)
        write_outside(r, which, database, file);
}

static void write_psnr(const report *r, int database, FILE *file)
{
    if (!r->image_size || database < 0)
        return;
    fprintf(
        file,
        "\nPSNR of pictures. Printed: 512 x 512 pixels, 1024 samples, the Uffizi probe. Ours: %ld "
        "x %ld, %ld samples,\nthe built-in sky; `hnbrdf report images DATA --from %s --latents 4 "
        "--env uffizi.hdr -o DIR`\nmakes the pictures of the paper.\n\n"
        "| model | numbers a material | printed | ours |\n|---|---|---|---|\n",
        r->image_size, r->image_size, r->light.spp, r->directory);
    for (int k = 0; k < r->count; k++) {
        const report_entry *e = &r->entries[k];
        if (!e->done)
            continue;
        write_title(e, file);
        write_printed(printed(e, database, 1), " %.2f |", file);
        fprintf(file, " %.2f |\n", e->mean_psnr);
    }
}

void report_write_paper(const report *r, FILE *file)
{
    const int database = database_of(r);
    fputs("\n## Beside the paper\n\n", file);
    report_write_recognised(r, file);
    write_differences(r, database, file);
    write_smape(r, database, file);
    write_psnr(r, database, file);
}
