/* cmd_eval.c: `hnbrdf eval`: pairs of directions in, BRDF values out, one CSV line for each. */
#include "cli/cli.h"
#include "base/csv.h"
#include "base/text.h"

#include <errno.h>
#include <math.h>
#include <string.h>

static const cli_command command = {
    "eval",
    "SOURCE [--material NAME] [-i FILE] [-o FILE]",
    "Evaluates a BRDF for pairs of directions. SOURCE is a model file, a measured file or\n"
    "builtin:NAME.\n"
    "\n"
    "In:  CSV with the columns wi_x,wi_y,wi_z,wo_x,wo_y,wo_z: unit vectors in the shading frame "
    "(normal\n"
    "     +z), wi towards the light, wo towards the viewer. A header may name them in any order "
    "among\n"
    "     other columns; without one there are these six. With a model and a column `material`, "
    "each\n"
    "     line is evaluated for the material it names, unless --material is given. Fields are "
    "separated by\n"
    "     commas and may be in quotes, numbers have decimal points.\n"
    "Out: CSV with the header f_r,f_g,f_b: the BRDF in 1/sr, linear RGB, without the cosine; one "
    "line "
    "for\n"
    "     each line of input, a blank one for a blank one, 0 where wi or wo is below the horizon "
    "or there\n"
    "     is no valid measurement.",
    "echo 0,0,1,0.6,0,0.8 | hnbrdf eval builtin:velvet-crimson\n"
    "hnbrdf eval model.safetensors --material velvet-crimson -i pairs.csv -o values.csv\n"
    "hnbrdf eval gold.binary < pairs.csv > values.csv",
};

enum { MATERIAL = 6, COLUMNS = 7 };
static const char *const column_names[COLUMNS] = {"wi_x", "wi_y", "wi_z",    "wo_x",
                                                  "wo_y", "wo_z", "material"};

/* Squared lengths further from 1 than this are no rounding of a unit vector. */
static const float unit_tolerance = 1e-3f;

typedef struct eval_job {
    cli_source source;
    int material; /* of a model, when no column names it */
    hnbrdf_csv_reader in;
    FILE *out;
    const char *out_name;
    int fields;                    /* expected in every line */
    int columns[COLUMNS];          /* where each is among the fields, -1: nowhere */
    long not_unit, first_not_unit; /* lines with directions that are no unit vectors */
} eval_job;

/* ---- Columns --------------------------------------------------------------------------------- */

/* For the end of a message about a line whose fields are not those expected. */
static const char *separator_hint(const eval_job *job)
{
    return hnbrdf_csv_has(&job->in, ';')    ? "; commas separate fields here, not ';'"
           : hnbrdf_csv_has(&job->in, '\t') ? "; commas separate fields here, not tabs"
                                            : "";
}

/* Where the column stands among the fields, -1: nowhere, -2 after a message: twice. */
static int find_column(const eval_job *job, const char *name)
{
    int found = -1;
    for (int k = 0; k < job->in.count; k++) {
        if (strcmp(job->in.fields[k], name) != 0)
            continue;
        if (found >= 0) {
            cli_fail("%s:%ld: fields %d and %d are both named %s, expected one", job->in.name,
                     job->in.line, found + 1, k + 1, name);
            return -2;
        }
        found = k;
    }
    return found;
}

static int read_header(eval_job *job)
{
    job->fields = job->in.count;
    for (int column = 0; column < COLUMNS; column++) {
        job->columns[column] = find_column(job, column_names[column]);
        if (job->columns[column] < -1)
            return CLI_FAILURE;
        if (job->columns[column] < 0 && column != MATERIAL)
            return cli_fail("%s:%ld: found '%.40s' first, expected numbers or a header with "
                            "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z (%s is missing)%s",
                            job->in.name, job->in.line, job->in.fields[0], column_names[column],
                            separator_hint(job));
    }
    return CLI_OK;
}

static void assume_columns(eval_job *job)
{
    job->fields = MATERIAL;
    for (int column = 0; column < COLUMNS; column++)
        job->columns[column] = column < MATERIAL ? column : -1;
}

static int is_number(const char *text)
{
    double value;
    return cli_parse_real(text, &value);
}

/* ---- Lines ----------------------------------------------------------------------------------- */

static int read_pair(const eval_job *job, float pair[6])
{
    hnbrdf_error error;
    if (job->in.count != job->fields)
        return cli_fail("%s:%ld: found %d fields, expected %d%s", job->in.name, job->in.line,
                        job->in.count, job->fields, separator_hint(job));
    for (int k = 0; k < 6; k++)
        if (hnbrdf_csv_number(&job->in, job->columns[k], column_names[k], &pair[k], &error) != 0)
            return cli_fail("%s%s", error.text, separator_hint(job));
    return CLI_OK;
}

static void note_length(eval_job *job, const float w[3])
{
    float squared = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    if (fabsf(squared - 1.0f) <= unit_tolerance || job->first_not_unit == job->in.line)
        return;
    job->first_not_unit = job->not_unit++ == 0 ? job->in.line : job->first_not_unit;
}

/* The material of this line, or NULL after a message. */
static const hnbrdf_material *line_material(eval_job *job)
{
    int column = job->columns[MATERIAL];
    if (column >= 0 && job->material < 0) {
        int index = hnbrdf_model_find(job->source.model, job->in.fields[column]);
        if (index < 0)
            cli_fail("%s:%ld: the model has no material '%.127s'", job->in.name, job->in.line,
                     job->in.fields[column]);
        return hnbrdf_model_material(job->source.model, index);
    }
    return hnbrdf_model_material(job->source.model, job->material);
}

static int evaluate(eval_job *job, const float pair[6], float f[3])
{
    if (job->source.measured) {
        hnbrdf_measured_eval(job->source.measured, pair, pair + 3, f);
        return CLI_OK;
    }
    const hnbrdf_material *material = line_material(job);
    if (!material)
        return CLI_FAILURE;
    hnbrdf_eval(job->source.model, material, pair, pair + 3, f);
    return CLI_OK;
}

static int write_value(const eval_job *job, const float f[3])
{
    FILE *file = job->out;
    for (int channel = 0; channel < 3; channel++) {
        char text[HNBRDF_NUMBER_TEXT];
        hnbrdf_format_float(text, sizeof text, f[channel]);
        fputs(text, file);
        putc(channel < 2 ? ',' : '\n', file);
    }
    if (ferror(file) && file == stdout && cli_standard_gone())
        return CLI_FAILURE; /* without a word, see cli_standard_end() */
    return ferror(file) ? cli_fail("%s: cannot write: %s", job->out_name, strerror(errno)) : CLI_OK;
}

static int evaluate_line(eval_job *job)
{
    float pair[6], f[3];
    if (read_pair(job, pair) != CLI_OK || evaluate(job, pair, f) != CLI_OK)
        return CLI_FAILURE;
    note_length(job, pair);
    note_length(job, pair + 3);
    return write_value(job, f);
}

static void write_blank(const eval_job *job, long lines)
{
    while (lines-- > 0)
        putc('\n', job->out);
}

/* As many lines as there were in, so that the two can stand side by side. */
static int evaluate_lines(eval_job *job)
{
    hnbrdf_error error;
    int headed = 0;
    int more = hnbrdf_csv_next(&job->in, &error);
    if (more == 0)
        return cli_fail("%s: empty, expected lines with wi_x,wi_y,wi_z,wo_x,wo_y,wo_z",
                        job->in.name);
    if (more < 0)
        return cli_fail("%s", error.text);
    if (is_number(job->in.fields[0]))
        assume_columns(job);
    else if (read_header(job) != CLI_OK)
        return CLI_FAILURE;
    else
        headed = 1;
    if (job->source.model && job->material < 0 && job->columns[MATERIAL] < 0 &&
        (job->material = cli_choose_material(job->source.model, NULL)) < 0)
        return CLI_FAILURE;
    write_blank(job, headed ? job->in.blank : 0);
    fputs("f_r,f_g,f_b\n", job->out);
    if (headed)
        more = hnbrdf_csv_next(&job->in, &error);
    for (; more > 0; more = hnbrdf_csv_next(&job->in, &error)) {
        write_blank(job, job->in.blank);
        if (evaluate_line(job) != CLI_OK)
            return CLI_FAILURE;
    }
    write_blank(job, more == 0 ? job->in.blank : 0);
    return more == 0 ? CLI_OK : cli_fail("%s", error.text);
}

/* ---- Command --------------------------------------------------------------------------------- */

static int run(eval_job *job, const char *in, const char *out)
{
    cli_output output;
    FILE *file = in ? hnbrdf_open_to_read(in) : stdin;
    if (!file)
        return cli_fail("%s: cannot open: %s", in, strerror(errno));
    hnbrdf_csv_begin(&job->in, file, in ? in : "stdin");
    int result = cli_output_open(out, &output);
    if (result == CLI_OK) {
        job->out = output.file;
        job->out_name = out;
        result = evaluate_lines(job);
        if (result == CLI_OK)
            result = cli_output_close(&output);
        else
            cli_output_discard(&output);
    }
    if (in)
        fclose(file);
    if (result == CLI_OK && job->not_unit > 0)
        cli_warn("%s: %ld lines, line %ld first, have directions that are not unit vectors; "
                 "the formulas were evaluated as they stand",
                 job->in.name, job->not_unit, job->first_not_unit);
    return result;
}

int cmd_eval(int argc, char **argv)
{
    static eval_job job;
    const char *material = NULL, *in = NULL, *out = "-";
    const cli_option options[] = {
        {"material", 'm', CLI_TEXT, &material, 0, 0, "NAME",
         "material of the model (default: the only one, or the column `material`)"},
        {"input", 'i', CLI_READ, &in, 0, 0, "FILE",
         "read the pairs from FILE (default: standard input)"},
        {"output", 'o', CLI_WRITE_TEXT, &out, 0, 0, "FILE",
         "write the values to FILE (default: standard output)"},
        {"variant", 0, CLI_WORD, &cli_variant, 0, 0, "NAME",
         "auto, plain, sse2, avx2, avx512 or neon: instructions to use, the same values "
         "(default auto)"},
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {0},
    };
    int count;
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != 1)
        return cli_usage(&command, "%s", count ? "more than one SOURCE" : "no SOURCE to evaluate");
    if (in && strcmp(in, "-") == 0)
        in = NULL;

    result = cli_open_source(argv[1], &job.source);
    if (result != CLI_OK)
        return result;
    job.material =
        material || !job.source.model ? cli_choose_source_material(&job.source, material) : -1;
    if (material && job.material < 0)
        result = CLI_FAILURE;
    else
        result = run(&job, in, out);
    cli_close_source(&job.source);
    return result;
}
