/* report.c: what a user asks of a report. */
#include "hnbrdf/bake.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *hnbrdf_bake_size_name(const hnbrdf_bake_size *size, char text[16])
{
    if (size->hidden)
        snprintf(text, 16, "%dx%d", size->hidden, size->layers);
    else
        snprintf(text, 16, "ggx");
    return text;
}

double hnbrdf_bake_judged(const hnbrdf_bake_report *report, const hnbrdf_bake_row *row)
{
    return report->judge == HNBRDF_BAKE_WORST ? row->worst : row->smape;
}

void hnbrdf_bake_report_free(hnbrdf_bake_report *report)
{
    if (!report)
        return;
    for (int k = 0; k < report->row_count; k++)
        free(report->rows[k].errors);
    free(report->rows);
    free((void *)report->names);
    memset(report, 0, sizeof *report);
}
