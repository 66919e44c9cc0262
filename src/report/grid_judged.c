/* grid_judged.c: which materials a fit left to GGX alone. */
#include "report/grid.h"

static int count_judged(const report *r, const report_entry *e, report_judged as)
{
    int count = 0;
    for (int m = 0; m < r->data.count; m++)
        count += e->judged[m] == (unsigned char)as;
    return count;
}

/* "3: a, b, c" */
static void write_names(const report *r, const report_entry *e, report_judged as, FILE *file)
{
    int listed = 0;
    fprintf(file, " %d", count_judged(r, e, as));
    for (int m = 0; m < r->data.count; m++)
        if (e->judged[m] == (unsigned char)as)
            fprintf(file, "%s%s", listed++ ? ", " : ": ", hnbrdf_measured_name(r->data.items[m]));
    fputs(" |", file);
}

void report_write_judged(const report *r, FILE *file)
{
    int worse = 0, written = 0;
    for (int k = 0; k < r->count; k++)
        worse += r->entries[k].done && count_judged(r, &r->entries[k], REPORT_WORSE) > 0;
    for (int k = 0; k < r->count; k++) {
        const report_entry *e = &r->entries[k];
        if (!e->done || !report_is_judged(e->form))
            continue;
        if (!written++)
            fprintf(file,
                    "\n## Left to GGX alone\n\nA material that the network makes worse than GGX "
                    "alone, in SMAPE over training pairs or in a small\npicture "
                    "(hnbrdf_fit_worth in fit.h), has a latent code that turns the network off%s. "
                    "materials.csv\nhas them in its column `alone`.\n\n| model | left to GGX alone "
                    "|%s\n|---|---|%s\n",
                    worse ? "; worse ones\nremain where there is no such code" : "",
                    worse ? " worse than it |" : "", worse ? "---|" : "");
        fprintf(file, "| %s |", e->name);
        write_names(r, e, REPORT_ALONE, file);
        if (worse)
            write_names(r, e, REPORT_WORSE, file);
        putc('\n', file);
    }
}
