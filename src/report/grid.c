/* grid.c: which models a report trains, and how to find them. */
#include "report/grid.h"

#include "base/error.h"
#include "report/output.h"

#include <stdlib.h>
#include <string.h>

const char *report_form_name(report_form form)
{
    static const char *const names[REPORT_FORMS] = {"ggx", "hybrid", "paper", "neural"};
    return (unsigned)form < REPORT_FORMS ? names[form] : NULL;
}

static int entry_latent(report_form form, int latent)
{
    return form == REPORT_NEURAL ? latent + REPORT_ANALYTIC_NUMBERS : latent;
}

static void add_entry(report *r, report_form form, const int net[2], int latent)
{
    report_entry *e = &r->entries[r->count++];
    e->form = form;
    if (form == REPORT_GGX) {
        snprintf(e->name, sizeof e->name, "ggx");
        return;
    }
    memcpy(e->net, net, sizeof e->net);
    e->latent = entry_latent(form, latent);
    snprintf(e->name, sizeof e->name, "%s-%dx%d-l%d", report_form_name(form), net[0], net[1],
             e->latent);
}

hnbrdf_result report_make_entries(report *r)
{
    size_t most = 1 + (size_t)r->net_count * (size_t)r->latent_count * REPORT_FORMS;
    r->entries = calloc(most, sizeof *r->entries);
    if (!r->entries)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    add_entry(r, REPORT_GGX, NULL, 0);
    for (int n = 0; n < r->net_count; n++)
        for (int l = 0; l < r->latent_count; l++)
            for (report_form form = REPORT_HYBRID; form < REPORT_FORMS; form++)
                if (r->forms[form])
                    add_entry(r, form, r->nets[n], r->latents[l]);
    for (int k = 0; k < r->count; k++) {
        report_entry *e = &r->entries[k];
        e->errors = calloc((size_t)r->data.count * REPORT_SAMPLERS, sizeof *e->errors);
        e->pictures = calloc((size_t)r->data.count, sizeof *e->pictures);
        e->judged = calloc((size_t)r->data.count, sizeof *e->judged);
        if (!e->errors || !e->pictures || !e->judged)
            return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    }
    r->ggx = calloc((size_t)r->data.count, sizeof *r->ggx);
    r->search = calloc((size_t)r->data.count, sizeof *r->search);
    return r->ggx && r->search ? HNBRDF_OK
                               : hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
}

void report_free_entries(report *r)
{
    for (int k = 0; k < r->count; k++) {
        free(r->entries[k].errors);
        free(r->entries[k].pictures);
        free(r->entries[k].judged);
    }
    free(r->entries);
    free(r->ggx);
    free(r->search);
    for (int k = 0; k < REPORT_OUTSIDES; k++)
        free(r->outside[k].errors);
    hnbrdf_model_free(r->ggx_model);
    r->ggx_model = NULL;
}

const report_entry *report_find(const report *r, report_form form, const int net[2], int latent)
{
    for (int k = 0; k < r->count; k++) {
        const report_entry *e = &r->entries[k];
        if (e->form != form)
            continue;
        if (form == REPORT_GGX ||
            (e->net[0] == net[0] && e->net[1] == net[1] && e->latent == entry_latent(form, latent)))
            return e;
    }
    return NULL;
}

double report_error(const report *r, const report_entry *e, int m)
{
    return e->errors[r->sampler * r->data.count + m].smape;
}

int report_is_complete(const report *r)
{
    int complete = 1;
    for (int k = 0; k < r->count; k++)
        complete &= r->entries[k].done;
    return complete;
}

int report_is_judged(report_form form)
{
    return form == REPORT_HYBRID || form == REPORT_PAPER;
}

int report_wins(const report *r, const report_entry *a, const report_entry *b)
{
    int wins = 0;
    for (int m = 0; m < r->data.count; m++)
        wins += report_error(r, a, m) < report_error(r, b, m);
    return wins;
}

int report_image_wins(const report *r, const report_entry *a, const report_entry *b)
{
    int wins = 0;
    for (int m = 0; m < r->data.count; m++)
        wins += a->pictures[m].psnr > b->pictures[m].psnr;
    return wins;
}

char *report_path(const report *r, const char *name, const char *suffix)
{
    size_t size = strlen(r->directory) + strlen(name) + strlen(suffix) + sizeof "/models/.";
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s/models/%s.%s", r->directory, name, suffix);
    else
        hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    return path;
}

const hnbrdf_material *report_material(const report *r, const hnbrdf_model *model, int m)
{
    return hnbrdf_model_material(model,
                                 hnbrdf_model_find(model, hnbrdf_measured_name(r->data.items[m])));
}

/* ---- Files of the report's folder ------------------------------------------------------------ */

char *report_path_in(const report *r, const char *name)
{
    return report_path_join(r->directory, name, r->error);
}

hnbrdf_result report_make_folders(const report *r, const char *name)
{
    char *path = report_path_in(r, name);
    hnbrdf_result result = path ? report_make_folder(r->directory, r->error) : HNBRDF_ERROR_MEMORY;
    if (result == HNBRDF_OK)
        result = report_make_folder(path, r->error);
    free(path);
    return result;
}

static hnbrdf_result open_result(const report *r, const char *name, report_output *output)
{
    char *path = report_path_in(r, name);
    hnbrdf_result result = path ? report_output_open(path, output, r->error) : HNBRDF_ERROR_MEMORY;
    free(path);
    return result;
}

hnbrdf_result report_write(const report *r, const char *name,
                           void (*write)(const report *r, FILE *file))
{
    report_output output;
    hnbrdf_result result = open_result(r, name, &output);
    if (result != HNBRDF_OK)
        return result;
    write(r, output.file);
    return report_output_close(&output, r->error);
}

hnbrdf_result report_write_net(const report *r, const char *name, const int net[2],
                               void (*write)(const report *r, const int net[2], FILE *file))
{
    char full[64];
    report_output output;
    snprintf(full, sizeof full, "%s-%dx%d.svg", name, net[0], net[1]);
    hnbrdf_result result = open_result(r, full, &output);
    if (result != HNBRDF_OK)
        return result;
    write(r, net, output.file);
    return report_output_close(&output, r->error);
}
