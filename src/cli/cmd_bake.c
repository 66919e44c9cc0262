/* cmd_bake.c: `hnbrdf bake`: the smallest network that is good enough for the materials of one
 * scene. */
#include "cli/bake.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "bake",
    "MODEL (--max-error E | --max-ns T | --net auto|HxN) [-m A,B] [--data DATA...] -o OUT",
    "Refits a small network to only the materials that a scene uses. A network shared by a whole "
    "database\n"
    "is larger than a few of its materials need. They are learned from the measurements (--data), "
    "else "
    "from\n"
    "MODEL itself. Prints what was tried: SMAPE of the whole and of the analytic part alone "
    "against "
    "what was\n"
    "learned from, multiplications, and the time of an evaluation by the batch call on this "
    "machine.\n"
    "  --max-error E  the fewest multiplications whose SMAPE is at most E, on average over the "
    "materials\n"
    "                 (--worst: for each of them). Where GGX alone is within E the network is "
    "dropped.\n"
    "  --max-ns T     the lowest error with at most T ns an evaluation, batch call, one thread\n"
    "  --net auto     the network with the lowest product of error and time\n"
    "  --net HxN      this network\n"
    "Candidates get a short fit first, in order of their size; those that come near get a full one "
    "from\n"
    "several seeds. kd, eta and alpha stay MODEL's when it is the teacher, edits included, and are "
    "fitted\n"
    "anew to measurements; --analytic decides otherwise. The network never takes them over.\n"
    "The exit code is 0 only if what is saved is what was asked for. Otherwise, after Ctrl-C too, "
    "the "
    "best of\n"
    "what was tried is saved, if a network was.",
    "hnbrdf bake rgl.safetensors -m vch_silk_blue,cc_nothern_aurora --max-error 0.15 -o "
    "scene.safetensors\n"
    "hnbrdf bake rgl.safetensors -m vch_silk_blue --max-ns 60 --data rgl/ -o scene.safetensors\n"
    "hnbrdf bake merl.safetensors --net auto --seconds 120 --csv b.csv --plot b.svg -o "
    "scene.safetensors\n"
    "hnbrdf bake rgl.safetensors --net 8x2 --latent 4 -o scene.safetensors",
};

typedef struct outputs {
    const char *model, *csv, *json, *plot;
} outputs;

static int told(const bake *b, const bake_row *row)
{
    if (b->row_count == 1)
        bake_print_heading(b);
    bake_print_row(b, row);
    return CLI_OK;
}

/* ---- What is learned from -------------------------------------------------------------------- */

/* The measurements of the chosen materials, by name; they stay data's. */
static int take_measurements(bake *b, const cli_data *data)
{
    for (int m = 0; m < b->count; m++) {
        const char *name = hnbrdf_model_material_name(b->model, b->chosen[m]);
        const hnbrdf_measured *found = cli_find_data(data, name);
        if (!found)
            return cli_fail("no measurement of %s among the %d of --data: materials go by the "
                            "names of their files",
                            name, data->count);
        for (int k = 0; k < data->count; k++)
            if (data->items[k] == found)
                b->reference[m] = data->items[k];
    }
    return CLI_OK;
}

static int make_teachers(bake *b)
{
    for (int m = 0; m < b->count; m++)
        if (bake_teacher(b->model, b->chosen[m], &b->reference[m]) != CLI_OK)
            return CLI_FAILURE;
    return CLI_OK;
}

/* ---- Results --------------------------------------------------------------------------------- */

static int write_file(const bake *b, const char *path, void (*write)(const bake *b, FILE *file))
{
    cli_output output;
    if (!path)
        return CLI_OK;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    write(b, output.file);
    return cli_output_close(&output);
}

/* Why the result is not what was asked for: CLI_FAILURE after a message; CLI_OK if it is. */
static int answer(const bake *b, const char *output)
{
    if (b->stopped && bake_interrupted())
        return cli_fail("interrupted; %s has the best of what was tried", output);
    if (b->met)
        return CLI_OK;
    if (b->stopped)
        return cli_fail("the %g s are over; %s has the best of what was tried", b->seconds, output);
    if (b->wish == BAKE_ERROR && !b->from_data)
        return cli_fail(
            "no network that is clearly smaller than the model's comes within %g of it; %s "
            "has the most "
            "accurate one",
            b->max_error, output);
    if (b->wish == BAKE_ERROR)
        return cli_fail("no network tried is within %g; %s has the most accurate one", b->max_error,
                        output);
    return cli_fail("nothing takes at most %g ns here; %s has GGX alone", b->max_ns, output);
}

/* An old output is not replaced by GGX alone only because Ctrl-C came early. */
static int save(bake *b, const outputs *o)
{
    hnbrdf_error error;
    const bake_row *row = &b->rows[b->picked];
    if (b->stopped && !b->met && row->candidate->hidden == 0)
        return cli_fail("%s before a network was fitted; %s is as it was",
                        bake_interrupted() ? "interrupted" : "the time was over", o->model);
    if (hnbrdf_model_save(row->model, o->model, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    b->half = bake_half_error(b);
    bake_print_result(b, o->model);
    int code = write_file(b, o->csv, bake_write_csv);
    if (code == CLI_OK)
        code = write_file(b, o->json, bake_write_json);
    if (code == CLI_OK)
        code = write_file(b, o->plot, bake_write_plot);
    fflush(stdout);
    return code == CLI_OK ? answer(b, o->model) : code;
}

static void release(bake *b)
{
    for (int k = 0; k < b->row_count; k++) {
        free(b->rows[k].errors);
        hnbrdf_model_free(b->rows[k].model);
    }
    free(b->rows);
    free(b->candidates);
    free(b->analytic);
    for (int m = 0; b->reference && !b->from_data && m < b->count; m++)
        hnbrdf_measured_close(b->reference[m]);
    free(b->reference);
}

/* ---- Command --------------------------------------------------------------------------------- */

static int search(bake *b, const cli_data *data, const outputs *o)
{
    b->reference = calloc((size_t)b->count, sizeof *b->reference);
    int code = b->reference ? CLI_OK : cli_fail("out of memory");
    if (code == CLI_OK)
        code = b->from_data ? take_measurements(b, data) : make_teachers(b);
    bake_catch_interrupts(1);
    if (code == CLI_OK)
        code = bake_make_candidates(b);
    if (code == CLI_OK)
        code = bake_search(b);
    bake_catch_interrupts(0);
    if (code == CLI_OK)
        code = save(b, o);
    release(b);
    return code;
}

static int check_outputs(const outputs *o)
{
    const char *const all[] = {o->model, o->csv, o->json, o->plot};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        if (all[k] && cli_output_check(all[k]) != CLI_OK)
            return CLI_FAILURE;
    return CLI_OK;
}

static int run(bake *b, const char *list, int analytic, char *const *data_arguments, int data_count,
               const outputs *o)
{
    cli_source source = {NULL, NULL};
    cli_data data = {NULL, 0};
    int *chosen = NULL, code = check_outputs(o);
    if (code == CLI_OK)
        code = cli_open_source(b->path, &source);
    if (code == CLI_OK && !source.model)
        code = cli_fail("%s: measured data, expected a model file", b->path);
    if (code == CLI_OK)
        code = cli_choose_materials(source.model, list, &chosen, &b->count);
    if (code == CLI_OK && data_count > 0)
        code = cli_open_data(data_arguments, data_count, &data);
    if (code == CLI_OK) {
        hnbrdf_model_desc desc;
        hnbrdf_model_describe(source.model, &desc);
        b->model = source.model;
        b->chosen = chosen;
        b->from_data = data_count > 0;
        b->keep = analytic < 0 ? !b->from_data && desc.kind != HNBRDF_KIND_NEURAL : analytic == 0;
        code = b->keep && desc.kind == HNBRDF_KIND_NEURAL
                   ? cli_fail("%s: a neural model has no analytic part to keep", b->path)
                   : search(b, &data, o);
    }
    free(chosen);
    cli_close_data(&data);
    cli_close_source(&source);
    return code;
}

/* "auto" or "HxN" with --net, and that exactly one wish is there: -1 to go on, or the exit code. */
static int read_wish(bake *b, const char *net)
{
    int length = 0;
    if ((b->max_error > 0.0) + (b->max_ns > 0.0) + (net != NULL) != 1)
        return cli_usage(&command,
                         "expected exactly one of --max-error E, --max-ns T and --net auto|HxN");
    b->wish = b->max_error > 0.0 ? BAKE_ERROR : b->max_ns > 0.0 ? BAKE_TIME : BAKE_AUTO;
    if (!net || strcmp(net, "auto") == 0)
        return -1;
    if (sscanf(net, "%2dx%1d%n", &b->net[0], &b->net[1], &length) != 2 || net[length] ||
        b->net[0] < 1 || b->net[0] > HNBRDF_MAX_HIDDEN || b->net[1] < 1 ||
        b->net[1] > HNBRDF_MAX_LAYERS)
        return cli_usage(&command,
                         "--net %s, expected auto or HxN with H from 1 to %d and N from 1 to %d",
                         net, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
    b->wish = BAKE_NET;
    return -1;
}

/* The index of an encoding's name or -1. */
static int find_encoding(const char *text)
{
    const char *name;
    for (int i = 0; (name = hnbrdf_encoding_name((hnbrdf_encoding)i)); i++)
        if (strcmp(text, name) == 0)
            return i;
    return -1;
}

int cmd_bake(int argc, char **argv)
{
    bake b = {.sampler = HNBRDF_SAMPLER_GRID,
              .encoding = -1,
              .latent = -1,
              .pairs = 200000,
              .steps = 32000,
              .restarts = 4,
              .seed = 1,
              .picked = -1,
              .told = told};
    outputs o = {NULL, NULL, NULL, NULL};
    const char *materials = NULL, *net = NULL, *data = NULL, *encoding = NULL;
    int analytic = -1, given;
    long latent = -1;
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &o.model, 0, 0, "FILE", "the model file to write (required)"},
        {"materials", 'm', CLI_TEXT, &materials, 0, 0, "LIST",
         "materials of MODEL to keep (default all)"},
        {"max-error", 0, CLI_REAL, &b.max_error, 1e-6, 2, "E", "the SMAPE that is accepted"},
        {"worst", 0, CLI_FLAG, &b.worst, 0, 0, NULL,
         "errors are judged by the worst material (default: by the mean)"},
        {"max-ns", 0, CLI_REAL, &b.max_ns, 1e-3, 1e9, "T",
         "the ns an evaluation may take, batch call, one thread of this machine"},
        {"net", 0, CLI_TEXT, &net, 0, 0, "HxN", "N hidden layers of H units, or auto"},
        {"latent", 0, CLI_INT, &latent, 0, HNBRDF_MAX_LATENT, "L",
         "floats of latent code (default: by the number of materials, at most 8)"},
        {"data", 0, CLI_TEXT, &data, 0, 0, "DATA...",
         "measurements to learn from and be judged by; further ones behind it, MODEL before"},
        {"analytic", 0, CLI_CHOICE, &analytic, 0, 0, "keep|fit",
         "kd, eta, alpha: MODEL's, or fitted to what is learned from (default keep, with --data "
         "fit)"},
        {"encoding", 0, CLI_TEXT, &encoding, 0, 0, "NAME",
         "as of `fit` (default: by what is learned from)"},
        {"seconds", 0, CLI_REAL, &b.seconds, 1, 1e7, "S",
         "about the time for all fits (default: by steps)"},
        {"steps", 0, CLI_INT, &b.steps, 1, 1e9, "N",
         "training steps of a full fit; of a short one an eighth (default 32000)"},
        {"restarts", 0, CLI_INT, &b.restarts, 1, 32, "N",
         "seeds of a full fit, the best counts (default 4)"},
        {"sampler", 0, CLI_CHOICE, &b.sampler, 0, 0, "uniform|cosine|grid",
         "of the pairs that errors are measured on (default grid)"},
        {"pairs", 'n', CLI_INT, &b.pairs, 1, 1e9, "N",
         "pairs a material that errors are measured on (default 200000; short fits 20000)"},
        {"pool", 0, CLI_INT, &b.pool, 64, 1 << 26, "N",
         "pairs drawn a material for training (default 131072, short fits 32768)"},
        {"seed", 0, CLI_INT, &b.seed, 0, 9e15, "N",
         "the first seed of everything random (default 1)"},
        {"csv", 0, CLI_TEXT, &o.csv, 0, 0, "FILE", "write what was tried, a row a model"},
        {"json", 0, CLI_TEXT, &o.json, 0, 0, "FILE", "the same with the errors of each material"},
        {"plot", 0, CLI_TEXT, &o.plot, 0, 0, "FILE", "write error against time as an SVG"},
        {"threads", 't', CLI_INT, &b.threads, 1, 256, "N", "threads (default one a core)"},
        CLI_READING_OPTIONS,
        {0},
    };
    int code = cli_parse(&command, options, argc, argv, &given);
    if (code >= 0)
        return code;
    if (given < 1)
        return cli_usage(&command, "no MODEL given");
    if (given > 1 && !data)
        return cli_usage(&command,
                         "found %d arguments, expected one MODEL; measurements go after --data",
                         given);
    if (!o.model)
        return cli_usage(&command, "no output file given, expected -o SCENE.safetensors");
    if ((code = read_wish(&b, net)) >= 0)
        return code;
    if (encoding && (b.encoding = find_encoding(encoding)) < 0)
        return cli_usage(&command,
                         "--encoding %s, expected angles, angles-anisotropic, angles-directed, "
                         "half-difference or directions",
                         encoding);
    b.path = argv[1];
    b.latent = (int)latent;
    b.short_steps = b.steps / 8 > 0 ? b.steps / 8 : 1;
    b.started = cli_seconds();
    if (data)
        argv[1] = (char *)data; /* points into argv, as the others do */
    return run(&b, materials, analytic, argv + 1, data ? given : 0, &o);
}
