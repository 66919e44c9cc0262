/* cmd_compare.c: `hnbrdf compare`: how far a model is from measured materials, one row for each. */
#include "cli/compare_images.h"
#include "cli/csv.h"
#include "cli/picture.h"
#include "hnbrdf/metrics.h"
#include "base/text.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "compare",
    "MODEL DATA... [--sampler grid] [--pairs N] [--csv FILE]",
    "Prints the error of a model, and of its analytic part (GGX) alone, against measured materials "
    "of\n"
    "the same names: SMAPE, 0 is perfect and 2 the worst, mean over N pairs of directions and "
    "RGB.\n"
    "DATA is builtin, builtin:NAME, measured files or directories.\n"
    "\n"
    "Samplers: uniform (wi and wo uniform in solid angle), cosine, grid (theta_h = u^2 pi/2, "
    "theta_d "
    "and\n"
    "phi_d uniform, as MERL's own grid). The same seed gives the same pairs, whatever the "
    "threads.\n"
    "CSV columns: material,smape,smape_analytic,pairs; the last row is named mean.\n"
    "\n"
    "With --images, pictures instead: IMAGE... REFERENCE, OpenEXR or Radiance files of one size. "
    "MAE "
    "and "
    "MSE\n"
    "are means over R, G and B of the linear values as they are, without exposure; PSNR takes the "
    "reference's\n"
    "largest value as its peak, as a rendering has no white. Pixels with alpha 0 in both are left "
    "out; "
    "values\n"
    "with alpha are premultiplied and compared so. --difference draws where they differ. There is "
    "no "
    "FLIP: "
    "no\n"
    "library of it is packaged; NVIDIA's own `flip` reads the same files.\n"
    "CSV columns: image,reference,mae,mse,psnr,pixels.",
    "hnbrdf compare model.safetensors builtin\n"
    "hnbrdf compare rgl.safetensors measured/rgl --sampler uniform --pairs 1e6 --csv rgl.csv\n"
    "hnbrdf compare hybrid.safetensors builtin --against ggx.safetensors\n"
    "hnbrdf compare --images hybrid.exr ggx.exr reference.exr --csv -\n"
    "hnbrdf compare --images hybrid.exr reference.exr --difference where.png",
};

typedef struct row {
    const hnbrdf_measured *measured;
    int material, material_against; /* numbers in the models */
    hnbrdf_comparison error, error_against;
} row;

typedef struct job {
    const char *path, *path_against; /* the second one NULL when there is only one model */
    hnbrdf_model *model, *against;
    hnbrdf_sampler sampler;
    long pairs, seed;
    row *rows;
    int count;
    hnbrdf_comparison mean, mean_against;

    pthread_mutex_t mutex; /* over what follows */
    int next, done;
    hnbrdf_result result;
    hnbrdf_error message;
    cli_progress progress;
} job;

/* ---- Measuring ------------------------------------------------------------------------------- */

static hnbrdf_result measure(const job *j, row *r, hnbrdf_error *message)
{
    hnbrdf_result result =
        hnbrdf_compare(j->model, hnbrdf_model_material(j->model, r->material), r->measured,
                       j->sampler, (size_t)j->pairs, (uint64_t)j->seed, &r->error, message);
    if (result == HNBRDF_OK && j->against)
        result = hnbrdf_compare(j->against, hnbrdf_model_material(j->against, r->material_against),
                                r->measured, j->sampler, (size_t)j->pairs, (uint64_t)j->seed,
                                &r->error_against, message);
    return result;
}

static void *work(void *argument)
{
    job *j = argument;
    pthread_mutex_lock(&j->mutex);
    while (j->next < j->count && j->result == HNBRDF_OK) {
        hnbrdf_error message;
        row *r = &j->rows[j->next++];
        pthread_mutex_unlock(&j->mutex);
        hnbrdf_result result = measure(j, r, &message);
        pthread_mutex_lock(&j->mutex);
        if (result != HNBRDF_OK && j->result == HNBRDF_OK) {
            j->result = result;
            j->message = message;
        }
        j->done++;
        cli_progress_update(&j->progress, (double)j->done / j->count,
                            hnbrdf_measured_name(r->measured));
    }
    pthread_mutex_unlock(&j->mutex);
    return NULL;
}

static void add_to_mean(hnbrdf_comparison *mean, const hnbrdf_comparison *error, int count)
{
    mean->smape += error->smape / count;
    mean->smape_analytic += error->smape_analytic / count;
    mean->mae += error->mae / count;
    mean->mse += error->mse / count;
    mean->pairs += error->pairs;
}

/* Materials are shared out to threads; each has its own sequence of pairs, so the threads do not
 * change a digit. */
static int measure_all(job *j, int threads)
{
    pthread_t *helpers = calloc((size_t)threads, sizeof *helpers);
    int started = 0;
    pthread_mutex_init(&j->mutex, NULL);
    cli_progress_begin(&j->progress, "comparing");
    while (helpers && started < threads - 1 && started < j->count - 1 &&
           pthread_create(&helpers[started], NULL, work, j) == 0)
        started++;
    work(j);
    for (int k = 0; k < started; k++)
        pthread_join(helpers[k], NULL);
    cli_progress_end(&j->progress);
    pthread_mutex_destroy(&j->mutex);
    free(helpers);
    if (j->result != HNBRDF_OK)
        return cli_fail("%s", j->message.text);
    for (int k = 0; k < j->count; k++) {
        add_to_mean(&j->mean, &j->rows[k].error, j->count);
        add_to_mean(&j->mean_against, &j->rows[k].error_against, j->count);
    }
    return CLI_OK;
}

/* ---- Which materials ------------------------------------------------------------------------- */

/* 1 if both models have the material; else 0, or -1 after a message if that is an error. */
static int find_material(const job *j, row *r, int skip_missing)
{
    const char *name = hnbrdf_measured_name(r->measured);
    r->material = hnbrdf_model_find(j->model, name);
    r->material_against = j->against ? hnbrdf_model_find(j->against, name) : 0;
    if (r->material >= 0 && r->material_against >= 0)
        return 1;
    if (skip_missing)
        return 0;
    cli_fail("%s: the model has no material %s (--skip-missing leaves such data out)",
             r->material < 0 ? j->path : j->path_against, name);
    return -1;
}

static int choose_rows(job *j, const cli_data *data, int skip_missing)
{
    j->rows = calloc((size_t)data->count, sizeof *j->rows);
    if (!j->rows)
        return cli_fail("out of memory");
    for (int k = 0; k < data->count; k++) {
        row *r = &j->rows[j->count];
        r->measured = data->items[k];
        int found = find_material(j, r, skip_missing);
        if (found < 0)
            return CLI_FAILURE;
        j->count += found;
    }
    return j->count ? CLI_OK
                    : cli_fail("%s: the model has none of the materials of the data", j->path);
}

/* ---- Output ---------------------------------------------------------------------------------- */

static void write_number(FILE *file, const char *before, double value)
{
    char text[HNBRDF_NUMBER_TEXT];
    hnbrdf_format_float(text, sizeof text, (float)value);
    fprintf(file, "%s%s", before, text);
}

static void print_row(const job *j, int width, const char *name, const hnbrdf_comparison *error,
                      const hnbrdf_comparison *against)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(j->model, &desc);
    printf("%-*s  %8.4f", width, name, error->smape);
    if (desc.kind == HNBRDF_KIND_NEURAL)
        printf("  %8s", "-");
    else
        printf("  %8.4f", error->smape_analytic);
    if (j->against)
        printf("  %8.4f", against->smape);
    printf("  %10zu\n", error->pairs);
}

static void print_wins(const job *j)
{
    int wins = 0, losses = 0;
    for (int k = 0; k < j->count; k++) {
        double gain = j->rows[k].error_against.smape - j->rows[k].error.smape;
        wins += gain > 0.0;
        losses += gain < 0.0;
    }
    printf("lower SMAPE: %s for %d of %d materials, %s (against) for %d\n", j->path, wins, j->count,
           j->path_against, losses);
}

static void print_table(const job *j)
{
    int width = (int)strlen("material");
    for (int k = 0; k < j->count; k++) {
        int length = (int)strlen(hnbrdf_measured_name(j->rows[k].measured));
        width = length > width ? length : width;
    }
    printf("%-*s  %8s  %8s%s  %10s\n", width, "material", "SMAPE", "analytic",
           j->against ? "   against" : "", "pairs");
    for (int k = 0; k < j->count; k++)
        print_row(j, width, hnbrdf_measured_name(j->rows[k].measured), &j->rows[k].error,
                  &j->rows[k].error_against);
    print_row(j, width, "mean", &j->mean, &j->mean_against);
    printf("\n%s sampler, %ld pairs a material, seed %ld; SMAPE: 0 is perfect, 2 the worst\n",
           hnbrdf_sampler_name(j->sampler), j->pairs, j->seed);
    cli_print_reading();
    if (j->against)
        print_wins(j);
}

static void write_csv_row(FILE *file, const char *name, const hnbrdf_comparison *error)
{
    csv_write_text(file, name);
    write_number(file, ",", error->smape);
    write_number(file, ",", error->smape_analytic);
    fprintf(file, ",%zu\n", error->pairs);
}

static void write_csv(const job *j, FILE *file)
{
    fputs("material,smape,smape_analytic,pairs\n", file);
    for (int k = 0; k < j->count; k++)
        write_csv_row(file, hnbrdf_measured_name(j->rows[k].measured), &j->rows[k].error);
    write_csv_row(file, "mean", &j->mean);
}

static void write_json_errors(const job *j, FILE *file, const hnbrdf_comparison *error,
                              const hnbrdf_comparison *against)
{
    write_number(file, "\"smape\": ", error->smape);
    write_number(file, ", \"smape_analytic\": ", error->smape_analytic);
    write_number(file, ", \"mae\": ", error->mae);
    write_number(file, ", \"mse\": ", error->mse);
    if (j->against)
        write_number(file, ", \"smape_against\": ", against->smape);
    fprintf(file, ", \"pairs\": %zu}", error->pairs);
}

static void write_json(const job *j, FILE *file)
{
    fputs("{\n  \"model\": ", file);
    cli_write_json_text(file, j->path);
    if (j->against) {
        fputs(",\n  \"against\": ", file);
        cli_write_json_text(file, j->path_against);
    }
    fprintf(file,
            ",\n  \"sampler\": \"%s\",\n  \"pairs\": %ld,\n  \"seed\": %ld,\n  \"materials\": [",
            hnbrdf_sampler_name(j->sampler), j->pairs, j->seed);
    for (int k = 0; k < j->count; k++) {
        fprintf(file, "%s\n    {\"name\": ", k ? "," : "");
        cli_write_json_text(file, hnbrdf_measured_name(j->rows[k].measured));
        fputs(", ", file);
        write_json_errors(j, file, &j->rows[k].error, &j->rows[k].error_against);
    }
    fputs("\n  ],\n  \"mean\": {", file);
    write_json_errors(j, file, &j->mean, &j->mean_against);
    fputs("\n}\n", file);
}

/* path may be NULL: nothing to write. */
static int write_file(const job *j, const char *path, void (*write)(const job *j, FILE *file))
{
    cli_output output;
    if (!path)
        return CLI_OK;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    write(j, output.file);
    return cli_output_close(&output);
}

/* ---- Command --------------------------------------------------------------------------------- */

static int parse_sampler(const char *name, hnbrdf_sampler *sampler)
{
    cli_guess guess;
    cli_guess_begin(&guess, name);
    for (hnbrdf_sampler s = HNBRDF_SAMPLER_UNIFORM; hnbrdf_sampler_name(s); s++) {
        if (strcmp(name, hnbrdf_sampler_name(s)) == 0) {
            *sampler = s;
            return -1;
        }
        cli_guess_offer(&guess, hnbrdf_sampler_name(s));
    }
    const char *nearest = cli_guess_nearest(&guess);
    return cli_usage(&command, "--sampler: found '%s', expected uniform, cosine or grid%s%s%s",
                     name, nearest ? " (did you mean " : "", nearest ? nearest : "",
                     nearest ? "?)" : "");
}

static int open_model(const char *path, hnbrdf_model **model)
{
    cli_source source;
    if (cli_open_source(path, &source) != CLI_OK)
        return CLI_FAILURE;
    *model = source.model;
    if (source.model)
        return CLI_OK;
    cli_close_source(&source);
    return cli_fail("%s: measured data, expected a model file", path);
}

static int is_stdout(const char *path)
{
    return path && strcmp(path, "-") == 0;
}

static int run(job *j, char **data_arguments, int data_count, int skip_missing, int threads,
               const char *csv, const char *json)
{
    cli_data data = {0};
    int result = open_model(j->path, &j->model);
    if (result == CLI_OK && j->path_against)
        result = open_model(j->path_against, &j->against);
    if (result == CLI_OK)
        result = cli_open_data(data_arguments, data_count, &data);
    if (result == CLI_OK)
        result = choose_rows(j, &data, skip_missing);
    if (result == CLI_OK)
        result = measure_all(j, threads);
    if (result == CLI_OK && !is_stdout(csv) && !is_stdout(json))
        print_table(j);
    if (result == CLI_OK)
        result = write_file(j, csv, write_csv);
    if (result == CLI_OK)
        result = write_file(j, json, write_json);
    cli_close_data(&data);
    free(j->rows);
    hnbrdf_model_free(j->model);
    hnbrdf_model_free(j->against);
    return result;
}

/* Returns -1 to go on, as cli_parse() does. */
static int check_images(int images, const compare_images_options *pictures, int count,
                        int of_models)
{
    if (!images && (pictures->difference || pictures->top > 0.0))
        return cli_usage(&command, "--difference and --scale belong to --images");
    if (images && of_models)
        return cli_usage(&command, "--against and --skip-missing are for models, not for --images");
    if (images && count < 2)
        return cli_usage(&command, "--images: found %d picture%s, expected IMAGE... REFERENCE",
                         count, count == 1 ? "" : "s");
    if (images && pictures->difference && count != 2)
        return cli_usage(&command, "--difference: found %d pictures, expected IMAGE REFERENCE",
                         count);
    return pictures->difference ? picture_check_output(&command, pictures->difference) : -1;
}

int cmd_compare(int argc, char **argv)
{
    job j = {.pairs = 200000, .seed = 1};
    const char *sampler = "grid", *csv = NULL, *json = NULL;
    int skip_missing = 0, images = 0, count;
    long threads = 0;
    compare_images_options pictures = {0};
    const cli_option options[] = {
        {"sampler", 0, CLI_TEXT, &sampler, 0, 0, "NAME", "uniform, cosine or grid (default grid)"},
        {"pairs", 'n', CLI_INT, &j.pairs, 1, 1e10, "N",
         "valid pairs of directions a material (default 200000; 1e6 may be written)"},
        {"seed", 0, CLI_INT, &j.seed, 0, 9007199254740992.0, "N",
         "of the random pairs (default 1)"},
        {"threads", 't', CLI_INT, &threads, 0, 1024, "N", "default 0: all processors"},
        {"against", 0, CLI_TEXT, &j.path_against, 0, 0, "MODEL",
         "a second model: its SMAPE beside, and which of the two is better for how many materials"},
        {"skip-missing", 0, CLI_FLAG, &skip_missing, 0, 0, NULL,
         "leave out data that the model has no material for (default: an error)"},
        {"images", 0, CLI_FLAG, &images, 0, 0, NULL, "compare pictures, the reference last"},
        {"difference", 0, CLI_TEXT, &pictures.difference, 0, 0, "FILE",
         "with --images: false colours and their scale as FILE.png, or FILE.exr and a PNG beside "
         "it"},
        {"scale", 0, CLI_REAL, &pictures.top, 1e-30, 1e30, "X",
         "where its colours end (default: at most one pixel in a hundred is beyond)"},
        {"csv", 0, CLI_TEXT, &csv, 0, 0, "FILE", "write the table as CSV; - is standard output"},
        {"json", 0, CLI_TEXT, &json, 0, 0, "FILE",
         "write it as JSON, with MAE and MSE; - likewise"},
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result < 0)
        result = parse_sampler(sampler, &j.sampler);
    if (result < 0)
        result = check_images(images, &pictures, count, j.path_against || skip_missing);
    if (result >= 0)
        return result;
    if (count < 2)
        return cli_usage(&command, "%s",
                         count ? "no DATA to compare with" : "no MODEL and no DATA");
    if (csv && json && is_stdout(csv) && is_stdout(json))
        return cli_usage(&command, "--csv and --json both to standard output");
    if ((csv && (result = cli_output_check(csv))) || (json && (result = cli_output_check(json))))
        return result;
    if (images) {
        pictures.paths = argv + 1;
        pictures.count = count;
        pictures.csv = csv;
        pictures.json = json;
        return compare_images(&pictures);
    }
    j.path = argv[1];
    return run(&j, argv + 2, count - 1, skip_missing, threads ? (int)threads : cli_processors(),
               csv, json);
}
