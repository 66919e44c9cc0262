/* editing_tables.c: what `hnbrdf report editing` writes: tables for programs, a page for people. */
#include "report/editing.h"

#include "base/error.h"
#include "base/write.h"
#include "report/output.h"

#include <math.h>
#include <stdlib.h>

/* ---- CSV ------------------------------------------------------------------------------------- */

static void write_row(const editing_report *r, const editing_member *m, const editing_case *c,
                      editing_way way, FILE *file)
{
    const editing_edit *edit = &editing_edits[c->edit];
    hnbrdf_write_csv_text(file, m->name);
    fprintf(file, ",%s,", hnbrdf_family_name(m->family));
    hnbrdf_write_csv_number(file, m->alpha, 6);
    fprintf(file, ",%s,", editing_kind_name(edit->kind));
    hnbrdf_write_csv_number(file, edit->factor, 6);
    fprintf(file, ",%s,", editing_way_name(way));
    hnbrdf_write_csv_number(file, c->smape[way], 6);
    putc(',', file);
    if (r->image_size)
        hnbrdf_write_csv_number(file, c->psnr[way], 6);
    fprintf(file, ",%d,", c->stopped);
    hnbrdf_write_csv_text(file, r->models[m->model].name);
    putc('\n', file);
}

static void write_csv(const void *report, FILE *file)
{
    const editing_report *r = report;
    fputs("member,family,alpha,edit,factor,model,smape,psnr,stopped,network\n", file);
    for (int m = 0; m < r->count; m++)
        for (int k = 0; r->members[m].done && k < r->members[m].count; k++)
            for (int way = 0; way < EDITING_WAYS; way++)
                write_row(r, &r->members[m], &r->members[m].cases[k], (editing_way)way, file);
}

static void write_mixtures_csv(const void *report, FILE *file)
{
    const editing_report *r = report;
    fputs("network,a,b,t,beyond,channel,within\n", file);
    for (int s = 0; s < r->pair_set_count; s++)
        for (int k = 0; k < r->pair_sets[s].mixtures; k++) {
            const editing_mixture *m = &r->pair_sets[s].list[k];
            const editing_model *model = &r->models[r->pair_sets[s].model];
            hnbrdf_write_csv_text(file, model->name);
            for (int e = 0; e < 2; e++) {
                putc(',', file);
                hnbrdf_write_csv_text(file, hnbrdf_model_material_name(model->model, m->ends[e]));
            }
            putc(',', file);
            hnbrdf_write_csv_number(file, m->t, 6);
            putc(',', file);
            hnbrdf_write_csv_number(file, m->beyond, 6);
            const int within = m->beyond <= EDITING_WIDENED;
            fprintf(file, ",%c,%d\n", "rgb"[m->channel], within);
        }
}

/* ---- Page: head ------------------------------------------------------------------------------ */

static void write_number(FILE *file, double value, int digits)
{
    if (isnan(value))
        fputs(" |", file);
    else
        fprintf(file, " %.*f |", digits, value);
}

static void write_head(const editing_report *r, FILE *file)
{
    fprintf(file, "# Editing\n\nMade by `%s`, hnbrdf %s.\n\n", r->command_line, hnbrdf_version());
    fprintf(
        file,
        "Members of procedural families (alpha 0.08, 0.16 and 0.3), whose truth after an edit "
        "is known, are edited and\ncompared with it: SMAPE, %s sampler, %ld pairs; PSNR in dB "
        "of spheres under `%s`, %ld pixels wide, %ld samples a\npixel. *Unedited*: the fitted "
        "material as it was. *GGX alone, edited*: the analytic part of the edited one.\n"
        "*Frozen fit*: kd, eta, alpha and latent code fitted to the truth, the network kept: "
        "the best it could do.\nMeans give each family the same weight. An edit that leaves a "
        "field's range stops at its end (`stopped` in\nediting.csv); where the truth leaves it, "
        "there is no row.\n\n",
        hnbrdf_sampler_name((hnbrdf_sampler)r->sampler), r->pairs, r->light.env, r->image_size,
        r->light.spp);
    fputs("| network | size | encoding | materials | steps | s |\n|---|---|---|---|---|---|\n",
          file);
    for (int k = 0; k < r->model_count; k++) {
        hnbrdf_model_desc desc;
        const editing_model *m = &r->models[k];
        hnbrdf_model_describe(m->model, &desc);
        fprintf(file, "| %s | %dx%d l=%d | %s | %d |", m->name, desc.hidden, desc.layers,
                desc.latent, hnbrdf_encoding_name(desc.encoding), desc.material_count);
        if (m->steps)
            fprintf(file, " %ld | %.1f |\n", m->steps, m->seconds);
        else
            fputs(" | |\n", file);
    }
}

/* ---- Page: edits ----------------------------------------------------------------------------- */

static void write_means(const editing_report *r, FILE *file)
{
    fputs("\n## Mean over the families\n\n| edit | members |", file);
    for (int psnr = 0; psnr <= (r->image_size > 0); psnr++)
        for (int way = 0; way < EDITING_WAYS; way++)
            fprintf(file, "%s %s |", psnr ? " dB," : "", editing_way_title((editing_way)way));
    fputs("\n|---|---|---|---|---|---|", file);
    fputs(r->image_size > 0 ? "---|---|---|---|\n" : "\n", file);
    for (int e = 0; e < editing_edit_count; e++) {
        char name[48];
        int members;
        if (isnan(editing_mean(r, -1, e, EDITING_EDITED, 0, &members)))
            continue;
        editing_edit_name(&editing_edits[e], name, sizeof name);
        fprintf(file, "| %s | %d |", name, members);
        for (int psnr = 0; psnr <= (r->image_size > 0); psnr++)
            for (int way = 0; way < EDITING_WAYS; way++)
                write_number(file, editing_mean(r, -1, e, (editing_way)way, psnr, NULL),
                             psnr ? 1 : 3);
        putc('\n', file);
    }
}

/* A row a family, a column an edit: the error of this way. */
static void write_families(const editing_report *r, editing_way way, FILE *file)
{
    fprintf(file, "\n%s:\n\n| family |", editing_way_title(way));
    for (int e = 0; e < editing_edit_count; e++) {
        char name[48];
        editing_edit_name(&editing_edits[e], name, sizeof name);
        fprintf(file, " %s |", name);
    }
    fputs("\n|---|", file);
    for (int e = 0; e < editing_edit_count; e++)
        fputs("---|", file);
    putc('\n', file);
    for (int f = 0; hnbrdf_family_name(f); f++) {
        if (isnan(editing_mean(r, f, 0, way, 0, NULL)))
            continue;
        fprintf(file, "| %s |", hnbrdf_family_name(f));
        for (int e = 0; e < editing_edit_count; e++)
            write_number(file, editing_mean(r, f, e, way, 0, NULL), 3);
        putc('\n', file);
    }
}

static int is_worse(const editing_report *r, int family, int edit)
{
    return editing_mean(r, family, edit, EDITING_EDITED, 0, NULL) >
           editing_mean(r, family, edit, EDITING_GGX, 0, NULL);
}

static void write_worse(const editing_report *r, FILE *file)
{
    int worse = 0, all = 0;
    for (int f = 0; hnbrdf_family_name(f); f++)
        for (int e = 0; e < editing_edit_count; e++) {
            worse += is_worse(r, f, e);
            all += !isnan(editing_mean(r, f, e, EDITING_EDITED, 0, NULL));
        }
    fprintf(file,
            "\nThe edited material has a larger error than GGX alone, edited, in %d of these %d "
            "places%s",
            worse, all, worse ? ":\n\n" : ".\n");
    for (int f = 0; hnbrdf_family_name(f); f++) {
        int named = 0;
        for (int e = 0; e < editing_edit_count; e++) {
            char name[48];
            if (!is_worse(r, f, e))
                continue;
            editing_edit_name(&editing_edits[e], name, sizeof name);
            if (named++)
                fprintf(file, ", %s", name);
            else
                fprintf(file, "- %s: %s", hnbrdf_family_name(f), name);
        }
        if (named)
            putc('\n', file);
    }
}

/* ---- Page: mixtures -------------------------------------------------------------------------- */

static void write_halves(const editing_report *r, FILE *file)
{
    if (r->half_count == 0)
        return;
    fputs("\nHalf way between the members of alpha 0.08 and 0.3 of a family, against the member of "
          "their geometric mean:\n\n| family | mixture | its GGX alone | frozen fit |\n"
          "|---|---|---|---|\n",
          file);
    for (int k = 0; k < r->half_count; k++) {
        const editing_half *h = &r->halves[k];
        fprintf(file, "| %s | %.3f | %.3f | %.3f |\n", hnbrdf_family_name(h->family), h->smape,
                h->ggx, h->frozen);
    }
    for (int k = 0; k < r->model_count; k++)
        if (!isnan(editing_mean_half(r, k)))
            fprintf(file, "| mean, %s | %.3f | | |\n", r->models[k].name, editing_mean_half(r, k));
}

enum { WORST = 5 };

/* The mixtures that are farthest beyond their ends, by falling distance; returns how many. */
static int find_worst(const editing_pairs *set, const editing_mixture *worst[WORST])
{
    int count = 0;
    for (int k = 0; k < set->mixtures; k++) {
        const editing_mixture *m = &set->list[k];
        int at = count;
        while (at > 0 && m->beyond > worst[at - 1]->beyond)
            at--;
        if (at == WORST || m->beyond <= EDITING_WIDENED)
            continue;
        count += count < WORST;
        for (int i = count - 1; i > at; i--)
            worst[i] = worst[i - 1];
        worst[at] = m;
    }
    return count;
}

static void write_worst(const editing_report *r, const editing_pairs *set, FILE *file)
{
    static const char *const channels[3] = {"red", "green", "blue"};
    const editing_mixture *worst[WORST];
    const editing_model *model = &r->models[set->model];
    int count = find_worst(set, worst);
    for (int k = 0; k < count; k++)
        fprintf(file, "%s%s to %s at %.2f (%.1f in %s)", k ? ", " : "\nFarthest beyond: ",
                hnbrdf_model_material_name(model->model, worst[k]->ends[0]),
                hnbrdf_model_material_name(model->model, worst[k]->ends[1]), worst[k]->t,
                worst[k]->beyond, channels[worst[k]->channel]);
    if (count)
        fputs(".\n", file);
}

static void write_mixtures(const editing_report *r, FILE *file)
{
    if (r->pair_set_count == 0)
        return;
    fputs("\n## Mixtures\n", file);
    write_halves(r, file);
    fputs("\nAll pairs of a model's materials at t = 1/4, 1/2 and 3/4: mixtures whose directional "
          "albedo, seen from 0, 30 and\n60 degrees, lies in every channel between those of the two "
          "ends, widened by a tenth; under 0.001 counts as that (mixtures.csv has each):\n\n| "
          "network | mixtures | within | "
          "pairs | within at all t |\n|---|---|---|---|---|\n",
          file);
    for (int s = 0; s < r->pair_set_count; s++) {
        const editing_pairs *set = &r->pair_sets[s];
        fprintf(file, "| %s | %d | %.1f %% | %d | %.1f %% |\n", r->models[set->model].name,
                set->mixtures, 100.0 * set->within / fmax(set->mixtures, 1), set->pairs,
                100.0 * set->all / fmax(set->pairs, 1));
    }
    for (int s = 0; s < r->pair_set_count; s++)
        write_worst(r, &r->pair_sets[s], file);
}

static void write_page(const void *report, FILE *file)
{
    const editing_report *r = report;
    write_head(r, file);
    if (r->count) {
        write_means(r, file);
        fputs("\n![Error over the factor of alpha](editing.svg)\n\n## SMAPE of each family\n",
              file);
        for (int way = EDITING_EDITED; way < EDITING_WAYS; way++)
            write_families(r, (editing_way)way, file);
        write_worse(r, file);
    }
    write_mixtures(r, file);
    if (r->count && r->sheet_size)
        fputs("\n## Spheres\n\n![Roughness](editing-alpha.png)\n\n![Other "
              "edits](editing-others.png)\n",
              file);
}

/* ---- All ------------------------------------------------------------------------------------- */

hnbrdf_result editing_write(const editing_report *r)
{
    static const struct {
        const char *name;
        void (*write)(const void *report, FILE *file);
    } files[] = {{"editing.csv", write_csv},
                 {"mixtures.csv", write_mixtures_csv},
                 {"editing.svg", editing_write_plot},
                 {"report.md", write_page}};
    hnbrdf_result result = HNBRDF_OK;
    for (size_t k = 0; k < sizeof files / sizeof files[0] && !result; k++) {
        char *path = report_path_join(r->directory, files[k].name, r->error);
        result = path ? report_write_file(path, files[k].write, r, r->error) : HNBRDF_ERROR_MEMORY;
        free(path);
    }
    return result;
}
