/* stability_report.c: what `hnbrdf stability` found, as a table, CSV and JSON. */
#include "report/stability_report.h"

#include "check/oracle.h"
#include "base/write.h"
#include "report/output.h"

#include <math.h>

static const stability_row *row_at(const stability_result *result, int what, int backend, int stage)
{
    return &result->rows[(what * result->backend_count + backend) * STABILITY_STAGES + stage];
}

int stability_passed(const stability_result *results, int count)
{
    for (int m = 0; m < count; m++)
        for (int k = 0; k < stability_case_count * results[m].backend_count * STABILITY_STAGES; k++)
            if (results[m].rows[k].applies && !results[m].rows[k].within)
                return 0;
    return 1;
}

static size_t wrong(const stability_row *row)
{
    return row->not_finite + row->negative + row->inconsistent;
}

static const char *verdict(const stability_row *row)
{
    return !row->within         ? wrong(row)                       ? "INVALID"
                                  : row->exact && row->differs > 0 ? "OTHER BITS"
                                                                   : "OUTSIDE"
           : isfinite(row->bar) ? "ok"
                                : "finite";
}

/* ---- For people ------------------------------------------------------------------------------ */

static void print_place(const stability_row *row, FILE *file)
{
    const stability_place *p = &row->place;
    fprintf(file,
            "      channel %d: %.9g, true %.9g; wi (%.9g %.9g %.9g) wo (%.9g %.9g %.9g) alpha %.6g "
            "%.6g eta %.9g "
            "kd %.4g; inputs an ulp off: %.2g\n",
            p->channel, p->got, p->expected, (double)p->pair[0], (double)p->pair[1],
            (double)p->pair[2], (double)p->pair[3], (double)p->pair[4], (double)p->pair[5],
            (double)p->material.alpha[0], (double)p->material.alpha[1],
            (double)p->material.eta[p->channel % 3], (double)p->material.kd[p->channel % 3],
            p->sensitivity);
}

static void print_row(const stability_row *row, int brief, FILE *file)
{
    fprintf(file, "  %-16s %-9s %-36.36s %8zu %6zu ", row->what->name,
            stability_stage_name(row->stage), row->backend, row->values, wrong(row));
    if (row->what->not_a_number)
        fprintf(file, "%9s %9s %9s  %s\n", "", "", "", verdict(row));
    else
        fprintf(file, "%9.2g %9.2g %9.3g  %s", row->worst_scale, row->worst_own, row->worst_ulp,
                verdict(row));
    if (row->ill_conditioned > 0)
        fprintf(file, ", %zu of them ill-conditioned", row->ill_conditioned);
    if (!row->what->not_a_number)
        putc('\n', file);
    if (!row->within || row->ill_conditioned > 0 || (!brief && row->worst_scale > 0.0))
        print_place(row, file);
}

/* Of a stage of a case, the backend that is furthest from its bar. */
static const stability_row *worst_backend(const stability_result *result, int what, int stage)
{
    const stability_row *worst = NULL;
    for (int b = 0; b < result->backend_count; b++) {
        const stability_row *row = row_at(result, what, b, stage);
        if (!row->applies)
            continue;
        if (!worst || wrong(row) > wrong(worst) ||
            (wrong(row) == wrong(worst) &&
             (row->worst_share > worst->worst_share ||
              (!isfinite(row->bar) && row->worst_scale > worst->worst_scale))))
            worst = row;
    }
    return worst;
}

static void print_case(const stability_result *result, int what, int brief, FILE *file)
{
    const stability_case *c = &stability_cases[what];
    fprintf(file, "%s: %s%s%s\n", c->name, c->about, c->why ? "; " : "", c->why ? c->why : "");
    for (int stage = 0; stage < STABILITY_STAGES; stage++) {
        const stability_row *worst = worst_backend(result, what, stage);
        for (int b = 0; b < result->backend_count; b++) {
            const stability_row *row = row_at(result, what, b, stage);
            if (row->applies && (!brief || row == worst || !row->within))
                print_row(row, brief, file);
        }
    }
}

/* Over all cases of one backend and stage. */
typedef struct stage_sum {
    double worst; /* of the cases that have the plain bars */
    size_t values, invalid, differs;
} stage_sum;

static stage_sum sum_stage(const stability_result *result, int backend, int stage)
{
    stage_sum sum = {0};
    for (int k = 0; k < stability_case_count; k++) {
        const stability_row *row = row_at(result, k, backend, stage);
        sum.values += row->values;
        sum.invalid += wrong(row);
        sum.differs += row->differs;
        stability_demand demand =
            stage == STABILITY_VALUE ? row->what->value_demand : row->what->demand;
        if (row->applies && demand == STABILITY_ACCURATE)
            sum.worst = fmax(sum.worst, row->worst_scale);
    }
    return sum;
}

/* Those that must have another's bits and do get one line together. */
static void print_summary(const stability_result *result, FILE *file)
{
    fputs("the worst of all cases that have a bar\n", file);
    for (int stage = 0; stage < STABILITY_STAGES; stage++) {
        int same = 0, same_in_state = 0;
        for (int b = 0; b < result->backend_count; b++) {
            const stability_row *row = row_at(result, 0, b, stage);
            stage_sum sum = sum_stage(result, b, stage);
            int as_promised = row->applies && row->exact && sum.differs == 0;
            same += as_promised && row->state == STABILITY_NEAREST;
            same_in_state += as_promised && row->state != STABILITY_NEAREST;
            if (!row->applies || as_promised)
                continue;
            fprintf(file, "  %-9s %-36.36s %9zu numbers %6zu wrong  worst %-9.2g",
                    stability_stage_name(row->stage), row->backend, sum.values, sum.invalid,
                    sum.worst);
            fprintf(file, b > 0 ? " %zu not C's bits\n" : "\n", sum.differs);
        }
        if (same > 0)
            fprintf(file, "  %-9s %d other ways of computing it: C's bits in every case\n",
                    stability_stage_name((stability_stage)stage), same);
        if (same_in_state > 0)
            fprintf(
                file,
                "  %-9s %d that round otherwise or flush subnormals: the bits of C plain that does "
                "so too\n",
                stability_stage_name((stability_stage)stage), same_in_state);
    }
}

void stability_print(const stability_result *results, int count, int brief, FILE *file)
{
    fprintf(file,
            "Errors against the formulas in %s: relative to f before the floor is subtracted "
            "(judged), to "
            "f, in "
            "ulp of f.\nBars: analytic and pdf %.2g, value %.2g; four times that in directed "
            "rounding. A "
            "value beyond its bar is ill-conditioned, not\nwrong, within six standard deviations "
            "of what "
            "rounding in the network's sums costs there.\n\n",
            oracle_arithmetic(), STABILITY_ANALYTIC_BAR, STABILITY_VALUE_BAR);
    for (int m = 0; m < count; m++) {
        fprintf(file, "%s\n  %-16s %-9s %-36s %8s %6s %9s %9s %9s\n", results[m].path, "case",
                "stage", "backend", "numbers", "wrong", "worst", "of f", "ulp");
        for (int k = 0; k < stability_case_count; k++)
            print_case(&results[m], k, brief, file);
        print_summary(&results[m], file);
        fputc('\n', file);
    }
    fputs(stability_passed(results, count) ? "all finite, none negative, every bar kept\n"
                                           : "NOT PASSED\n",
          file);
}

/* ---- For programs ---------------------------------------------------------------------------- */

void stability_write_csv(const void *all, FILE *file)
{
    const stability_result *results = ((const stability_results *)all)->items;
    int count = ((const stability_results *)all)->count;
    fputs(
        "model,case,stage,backend,values,not_finite,negative,inconsistent,differs,ill_conditioned,"
        "worst,worst_of_f,"
        "worst_ulp,"
        "bar,within,channel,got,expected,ulp_sensitivity,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,alpha_x,"
        "alpha_"
        "y,eta,kd,"
        "rotation,why\n",
        file);
    for (int m = 0; m < count; m++)
        for (int k = 0; k < stability_case_count * results[m].backend_count * STABILITY_STAGES;
             k++) {
            const stability_row *row = &results[m].rows[k];
            const stability_place *p = &row->place;
            if (!row->applies)
                continue;
            hnbrdf_write_csv_text(file, results[m].path);
            fprintf(file, ",%s,%s,", row->what->name, stability_stage_name(row->stage));
            hnbrdf_write_csv_text(file, row->backend);
            fprintf(file, ",%zu,%zu,%zu,%zu,%zu,%zu,%.4g,%.4g,%.4g,%.4g,%d,%d,%.9g,%.9g,%.4g",
                    row->values, row->not_finite, row->negative, row->inconsistent, row->differs,
                    row->ill_conditioned, row->worst_scale, row->worst_own, row->worst_ulp,
                    row->bar, row->within, p->channel, p->got, p->expected, p->sensitivity);
            for (int i = 0; i < 6; i++)
                fprintf(file, ",%.9g", (double)p->pair[i]);
            fprintf(file, ",%.9g,%.9g,%.9g,%.9g,%.9g,", (double)p->material.alpha[0],
                    (double)p->material.alpha[1], (double)p->material.eta[p->channel % 3],
                    (double)p->material.kd[p->channel % 3], (double)p->material.rotation);
            hnbrdf_write_csv_text(file, row->what->why ? row->what->why : "");
            fputc('\n', file);
        }
}

/* JSON has no infinity and no NaN: null. */
static void put(FILE *file, const char *key, double value)
{
    if (isfinite(value))
        fprintf(file, ", \"%s\": %.9g", key, value);
    else
        fprintf(file, ", \"%s\": null", key);
}

static void put_floats(FILE *file, const char *key, const float *values, int count)
{
    fprintf(file, ", \"%s\": [", key);
    for (int i = 0; i < count; i++)
        if (isfinite(values[i]))
            fprintf(file, "%s%.9g", i ? ", " : "", (double)values[i]);
        else
            fprintf(file, "%snull", i ? ", " : "");
    fputc(']', file);
}

static void json_row(const char *path, const stability_row *row, FILE *file)
{
    const stability_place *p = &row->place;
    fputs("    {\"model\": ", file);
    hnbrdf_write_json_text(file, path);
    fprintf(file, ", \"case\": \"%s\", \"stage\": \"%s\", \"backend\": ", row->what->name,
            stability_stage_name(row->stage));
    hnbrdf_write_json_text(file, row->backend);
    fprintf(file,
            ", \"values\": %zu, \"not_finite\": %zu, \"negative\": %zu, \"inconsistent\": %zu, "
            "\"differs\": %zu, \"ill_conditioned\": %zu",
            row->values, row->not_finite, row->negative, row->inconsistent, row->differs,
            row->ill_conditioned);
    put(file, "worst", row->worst_scale);
    put(file, "worst_of_f", row->worst_own);
    put(file, "worst_ulp", row->worst_ulp);
    put(file, "bar", row->bar);
    fprintf(file, ", \"within\": %s, \"channel\": %d", row->within ? "true" : "false", p->channel);
    put(file, "got", p->got);
    put(file, "expected", p->expected);
    put(file, "ulp_sensitivity", p->sensitivity);
    put_floats(file, "wi", p->pair, 3);
    put_floats(file, "wo", p->pair + 3, 3);
    put_floats(file, "alpha", p->material.alpha, 2);
    put_floats(file, "eta", p->material.eta, 3);
    put_floats(file, "kd", p->material.kd, 3);
    fputc('}', file);
}

void stability_write_json(const void *all, FILE *file)
{
    const stability_result *results = ((const stability_results *)all)->items;
    int count = ((const stability_results *)all)->count;
    const char *comma = "";
    fprintf(file, "{\n  \"oracle\": \"%s\",\n  \"passed\": %s,\n  \"cases\": [\n",
            oracle_arithmetic(), stability_passed(results, count) ? "true" : "false");
    for (int k = 0; k < stability_case_count; k++) {
        fprintf(file, "%s    {\"name\": \"%s\", \"about\": ", k ? ",\n" : "",
                stability_cases[k].name);
        hnbrdf_write_json_text(file, stability_cases[k].about);
        fputs(", \"why\": ", file);
        if (stability_cases[k].why)
            hnbrdf_write_json_text(file, stability_cases[k].why);
        else
            fputs("null", file);
        fputc('}', file);
    }
    fputs("\n  ],\n  \"rows\": [\n", file);
    for (int m = 0; m < count; m++)
        for (int k = 0; k < stability_case_count * results[m].backend_count * STABILITY_STAGES; k++)
            if (results[m].rows[k].applies) {
                fputs(comma, file);
                json_row(results[m].path, &results[m].rows[k], file);
                comma = ",\n";
            }
    fputs("\n  ]\n}\n", file);
}
