/* growth.c: all series of costs, and tables of them. */
#include "bench/growth.h"
#include "base/write.h"

/* ---- All of them ----------------------------------------------------------------------------- */

hnbrdf_result bench_growth(const bench_growth_options *options, growth *g, hnbrdf_error *error)
{
    g->quick = options->quick;
    hnbrdf_result result = bench_growth_cpu(g, &options->watch, error);
    if (!result)
        result = bench_growth_files(g, &options->watch, error);
    if (!result)
        result = bench_growth_fit(g, &options->watch, error);
    return result ? result : bench_growth_gpu(g, options, error);
}

/* ---- Tables ---------------------------------------------------------------------------------- */

static void print_exponent(double value, FILE *file)
{
    if (isfinite(value))
        fprintf(file, "  %9.2f", value);
    else
        fprintf(file, "  %9s", "-");
}

void bench_growth_print(const void *of, FILE *file)
{
    const growth *g = of;
    fprintf(file,
            "%s%s%s\ncost ~ size^e; arithmetic: e of the multiplications, numbers or materials\n",
            g->cpu ? g->cpu : "", g->device[0] ? "; " : "", g->device);
    fprintf(file, "last: by the two largest sizes alone\n\n%-30s  %-9s  %9s  %9s  %9s  %9s  %s\n",
            "cost", "size", "e", "arithmetic", "last", "arithmetic", "size: cost");
    for (int k = 0; k < g->count; k++) {
        const growth_series *s = &g->series[k];
        const growth_exponents e = bench_growth_exponents(s);
        char what[64];
        snprintf(what, sizeof what, "%s, %s", s->what, s->unit);
        fprintf(file, "%-30s  %-9s", what, s->against);
        print_exponent(e.cost, file);
        print_exponent(e.work, file);
        print_exponent(e.last_cost, file);
        print_exponent(e.last_work, file);
        fputs(" ", file);
        for (int i = 0; i < s->count; i++)
            fprintf(file, " %.6g: %.3g%s", s->points[i].size, s->points[i].cost,
                    i + 1 < s->count ? "," : "");
        fputc('\n', file);
    }
}

void bench_growth_write_csv(const void *of, FILE *file)
{
    const growth *g = of;
    fputs("cost,unit,against,size,value,arithmetic,exponent,arithmetic_exponent,last_exponent,"
          "last_arithmetic_exponent\n",
          file);
    for (int k = 0; k < g->count; k++) {
        const growth_series *s = &g->series[k];
        const growth_exponents e = bench_growth_exponents(s);
        const double last[] = {e.cost, e.work, e.last_cost, e.last_work};
        for (int i = 0; i < s->count; i++) {
            hnbrdf_write_csv_text(file, s->what);
            fprintf(file, ",%s,%s,%.9g", s->unit, s->against, s->points[i].size);
            const double values[] = {s->points[i].cost, s->points[i].work};
            for (int n = 0; n < 6; n++) {
                const double value = n < 2 ? values[n] : last[n - 2];
                if (isfinite(value))
                    fprintf(file, ",%.6g", value);
                else
                    putc(',', file);
            }
            putc('\n', file);
        }
    }
}
