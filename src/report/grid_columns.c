/* grid_columns.c: the columns, headers and lines that several tables of a grid share. */
#include "report/grid.h"

void report_write_model_columns(const report_entry *e, FILE *file)
{
    if (e->form == REPORT_GGX)
        fputs("ggx,none,none,0", file);
    else
        fprintf(file, "%s,%dx%d,%s,%d", hnbrdf_kind_name(e->kind), e->net[0], e->net[1],
                hnbrdf_encoding_name(e->encoding), e->latent);
}

const char *report_form_title(report_form form)
{
    static const char *const titles[REPORT_FORMS] = {"GGX alone", "hybrid", "paper's form",
                                                     "neural"};
    return titles[form];
}

/* The latent size first. */
void report_write_form_header(const report *r, FILE *file)
{
    int columns = 1;
    fputs("| net |", file);
    for (int l = 0; l < r->latent_count; l++)
        for (report_form form = REPORT_HYBRID; form < REPORT_FORMS; form++)
            if (r->forms[form]) {
                int more = form == REPORT_NEURAL ? REPORT_ANALYTIC_NUMBERS : 0;
                fprintf(file, " %s l=%d |", report_form_title(form), r->latents[l] + more);
                columns++;
            }
    fputs("\n|---|", file);
    while (--columns)
        fputs("---|", file);
    putc('\n', file);
}

void report_write_data(const report *r, FILE *file)
{
    fprintf(file, "Data: %d material%s (", r->data.count, r->data.count == 1 ? "" : "s");
    for (int m = 0; m < r->data.count; m++)
        fprintf(file, "%s%s", m ? ", " : "", hnbrdf_measured_name(r->data.items[m]));
    fputs("); formats:", file);
    for (int k = 0; hnbrdf_measured_format_name((hnbrdf_measured_format)k); k++) {
        int count = 0;
        for (int m = 0; m < r->data.count; m++)
            count += hnbrdf_measured_format_of(r->data.items[m]) == (hnbrdf_measured_format)k;
        if (count)
            fprintf(file, " %d %s", count, hnbrdf_measured_format_name((hnbrdf_measured_format)k));
    }
    fputs(".\n", file);
}
