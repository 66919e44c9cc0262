/* cmd_bench.c: `hnbrdf bench`: run time beside error, for models, backends and styles of one
 * run. */
#include "bench/bench.h"
#include "cli/cli.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "bench",
    "[MODEL...] [--data DATA] [--csv FILE] [--json FILE] [--plot FILE]",
    "Measures what one evaluation takes, for each model on each backend, and sets it beside the "
    "error.\n"
    "Without MODEL, networks of several sizes (--nets) are fitted to DATA (default builtin) first. "
    "GGX\n"
    "alone is always there to compare with. All rows are sampled in turn, many times; the least "
    "counts.\n"
    "\n"
    "Backends: c-single (hnbrdf_eval), c-single-prepared (hnbrdf_prepared_eval), c-batch\n"
    "(hnbrdf_eval_batch; a row a variant), c-many (hnbrdf_eval_many, a material drawn for every "
    "pair),\n"
    "vulkan:DEVICE (the exported shader, fast build, two materials). CPU rows are of one thread, "
    "in "
    "its\n"
    "CPU time. Vulkan rows are by the device's timestamps, those of a software device by the "
    "process's\n"
    "CPU time over the number of processors, less the time of an empty kernel on the same buffers "
    "(io).\n"
    "\n"
    "Weights: model (as loaded); constants, columns, uniform: of `hnbrdf export --weights`, "
    "constants "
    "in\n"
    "half precision too where the device has it; published-style (a peer: the same\n"
    "network with the directions as inputs, mat4 chains with literals of three decimals, "
    "microfacet\n"
    "formulas with full fractions and pow, as published viewer shaders have them; made by this "
    "command).\n"
    "\n"
    "CSV: ns_per_eval is without buffers; peak_fraction: multiplications and additions of the "
    "network "
    "in\n"
    "that time (on the CPU without the latent code's, which is folded into the first bias), of the "
    "FMA\n"
    "peak measured in the same run with the row's instructions and threads;\n"
    "ratio_to_ggx: to ns_per_eval of GGX alone on the same backend; compile_ms: GLSL to SPIR-V; "
    "bytes: "
    "of\n"
    "the weights; of a shader: of the SPIR-V with evaluation alone in it, and of the uniform "
    "block; "
    "mults:\n"
    "of the network, an evaluation; smape, psnr: means over the materials that DATA has, blank "
    "without;\n"
    "io_ns: of the buffers; net_ns and net_peak_fraction: of the network alone; "
    "first_dispatch_ms:\n"
    "pipeline and first run; threads; net_muladd_fraction: of the peak without fusing.",
    "hnbrdf bench --quick\n"
    "hnbrdf bench model.safetensors\n"
    "hnbrdf bench rgl_32x2.safetensors rgl_16x2.safetensors --data rgl/ --csv bench.csv --plot "
    "bench.svg\n"
    "hnbrdf bench --nets 8x2,16x2,32x2,64x3 --data rgl/ --seconds 60 --plot bench.svg",
};

typedef struct settings {
    const char *data, *nets, *device, *csv, *json, *plot;
    double seconds;
    long steps, pool;
    int quick, without_peer;
    double sample_ms;
    bench_gpu_options gpu;
} settings;

/* ---- Progress -------------------------------------------------------------------------------- */

typedef struct watch {
    cli_progress line;
    char what[BENCH_NAME + 16]; /* shown on it; "": no line */
} watch;

static void end_line(watch *w)
{
    if (w->what[0])
        cli_progress_end(&w->line);
    w->what[0] = '\0';
}

static int show(void *user, const char *what, double share, const char *detail)
{
    watch *w = user;
    if (strcmp(w->what, what) != 0) {
        end_line(w);
        snprintf(w->what, sizeof w->what, "%s", what);
        cli_progress_begin(&w->line, w->what);
    }
    cli_progress_update(&w->line, share, detail);
    return 0;
}

static void tell(void *user, const char *line)
{
    end_line(user);
    puts(line);
}

static void warn(void *user, const char *line)
{
    end_line(user);
    cli_warn("%s", line);
}

static int fail(bench *b, hnbrdf_result result, const hnbrdf_error *error)
{
    end_line(b->watch.user);
    return result ? cli_fail("%s", error->text) : CLI_OK;
}

/* ---- Models ---------------------------------------------------------------------------------- */

static int load_model(bench *b, const char *path)
{
    char name[BENCH_NAME];
    cli_source source;
    hnbrdf_error error;
    if (cli_open_source(path, &source) != CLI_OK)
        return CLI_FAILURE;
    if (!source.model) {
        cli_close_source(&source);
        return cli_fail(
            "%s: a measurement, expected a model; data to compare with go behind --data", path);
    }
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    snprintf(name, sizeof name, "%.*s", dot && dot > base ? (int)(dot - base) : BENCH_NAME - 1,
             base);
    return fail(b, bench_add_model(b, source.model, name, &error), &error);
}

static int fit_models(bench *b, const cli_data *data, const settings *set)
{
    bench_fit fit = {.steps = set->steps, .seconds = set->seconds, .pool = (int)set->pool};
    for (const char *at = set->nets; *at;) {
        int length = 0;
        hnbrdf_error error;
        if (sscanf(at, "%2dx%1d%n", &fit.hidden, &fit.layers, &length) != 2 || fit.hidden < 1 ||
            fit.hidden > HNBRDF_MAX_HIDDEN || fit.layers < 1 || fit.layers > HNBRDF_MAX_LAYERS ||
            (at[length] != ',' && at[length] != '\0'))
            return cli_usage(&command, "--nets: '%s' is not HxN,HxN,... with H to %d and N to %d",
                             set->nets, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
        int code = fail(b, bench_fit_model(b, data->items, data->count, &fit, &error), &error);
        if (code != CLI_OK)
            return code;
        at += length + (at[length] == ',');
    }
    return CLI_OK;
}

/* "A,B" as DATA arguments. */
static int open_data(const char *list, cli_data *data)
{
    char *copy = strdup(list), *arguments[64];
    int count = 0;
    for (char *part = copy ? strtok(copy, ",") : NULL; part && count < 64; part = strtok(NULL, ","))
        arguments[count++] = part;
    int code = copy ? cli_open_data(arguments, count, data) : cli_fail("out of memory");
    free(copy);
    return code;
}

/* ---- Output ---------------------------------------------------------------------------------- */

static int write_file(const bench *b, const char *path, void (*write)(const void *b, FILE *file))
{
    cli_output output;
    if (!path)
        return CLI_OK;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    write(b, output.file);
    return cli_output_close(&output);
}

static int is_stdout(const char *path)
{
    return path && strcmp(path, "-") == 0;
}

static int write_results(const bench *b, const settings *set)
{
    if (!is_stdout(set->csv) && !is_stdout(set->json) && !is_stdout(set->plot))
        bench_print(b, stdout);
    int code = write_file(b, set->csv, bench_write_csv);
    if (code == CLI_OK)
        code = write_file(b, set->json, bench_write_json);
    return code == CLI_OK ? write_file(b, set->plot, bench_write_plot) : code;
}

/* ---- Command --------------------------------------------------------------------------------- */

static int run(bench *b, const settings *set, char **paths, int count)
{
    cli_data data = {NULL, 0};
    hnbrdf_error error;
    int code =
        set->data || count == 0 ? open_data(set->data ? set->data : "builtin", &data) : CLI_OK;
    for (int k = 0; k < count && code == CLI_OK; k++)
        code = load_model(b, paths[k]);
    if (code == CLI_OK && count == 0)
        code = fit_models(b, &data, set);
    if (code == CLI_OK)
        code = fail(b, bench_add_ggx(b, &error), &error);
    if (code == CLI_OK && data.count > 0)
        code = fail(b, bench_measure_quality(b, data.items, data.count, !set->without_peer, &error),
                    &error);
    if (code == CLI_OK)
        code = fail(b, bench_measure(b, &set->gpu, 1e6 * set->sample_ms, &error), &error);
    if (code == CLI_OK)
        code = write_results(b, set);
    bench_free(b);
    cli_close_data(&data);
    return code;
}

/* What --quick stands for, where nothing else is asked for. */
static void fill_defaults(bench *b, settings *set)
{
    int quick = set->quick;
    set->nets = set->nets ? set->nets : quick ? "8x2" : "16x2,32x2,64x3";
    set->steps = quick && set->seconds == 0.0 ? 200 : 0;
    set->pool = quick ? 2048 : 0;
    set->seconds = set->seconds > 0.0 ? set->seconds : 20.0;
    set->sample_ms = quick ? 1.0 : 20.0;
    set->gpu.evaluations = quick ? 1 << 12 : 1 << 16;
    set->gpu.device = set->device;
    set->gpu.peer = !set->without_peer;
    b->rounds = b->rounds ? b->rounds : quick ? 2 : 12;
    b->pairs = b->pairs ? b->pairs : quick ? 2000 : 50000;
    b->size = b->size ? b->size : quick ? 32 : 64;
    b->spp = b->spp ? b->spp : quick ? 4 : 32;
}

static int check_outputs(const settings *set)
{
    const char *const paths[] = {set->csv, set->json, set->plot};
    int on_stdout = 0;
    for (int k = 0; k < 3; k++) {
        on_stdout += is_stdout(paths[k]);
        if (paths[k] && cli_output_check(paths[k]) != CLI_OK)
            return CLI_FAILURE;
    }
    return on_stdout > 1 ? cli_usage(&command, "only one of --csv, --json and --plot can be -")
                         : CLI_OK;
}

/* The command as it was typed; cli_parse() moves its arguments about. NULL when memory is short. */
static char *join(int argc, char **argv)
{
    size_t size = sizeof "hnbrdf";
    for (int k = 0; k < argc; k++)
        size += strlen(argv[k]) + 1;
    char *text = malloc(size);
    size_t at = text ? (size_t)snprintf(text, size, "hnbrdf") : 0;
    for (int k = 0; k < argc && text; k++)
        at += (size_t)snprintf(text + at, size - at, " %s", argv[k]);
    return text;
}

int cmd_bench(int argc, char **argv)
{
    bench *b = calloc(1, sizeof *b);
    char *line = join(argc, argv);
    if (!b || !line) {
        free(b);
        free(line);
        return cli_fail("out of memory");
    }
    settings set = {.device = "all"};
    b->command_line = line;
    watch w = {.what = ""};
    char cpu[BENCH_NAME];
    int sampler = HNBRDF_SAMPLER_GRID;
    b->cpu = bench_cpu_name(cpu);
    b->watch = (bench_watch){show, tell, warn, &w};
    const cli_option options[] = {
        {"data", 0, CLI_TEXT, &set.data, 0, 0, "DATA",
         "measurements to compare with, by name; several with commas between"},
        {"csv", 0, CLI_TEXT, &set.csv, 0, 0, "FILE", "the table as CSV; - is standard output"},
        {"json", 0, CLI_TEXT, &set.json, 0, 0, "FILE",
         "the table and the machine as JSON; - likewise"},
        {"plot", 0, CLI_TEXT, &set.plot, 0, 0, "FILE",
         "SVG: error against run time; c-batch, c-single-prepared and Vulkan (with MODEL needs "
         "--data)"},
        {"nets", 0, CLI_TEXT, &set.nets, 0, 0, "LIST",
         "without MODEL: what to fit (default 16x2,32x2,64x3)"},
        {"seconds", 0, CLI_REAL, &set.seconds, 0.1, 1e6, "S",
         "without MODEL: train each network this long (default 20)"},
        {"sampler", 0, CLI_CHOICE, &sampler, 0, 0, "uniform|cosine|grid",
         "of the SMAPE (default grid)"},
        {"pairs", 'n', CLI_INT, &b->pairs, 1, 1e9, "N",
         "pairs of directions a material for the SMAPE (default 50000)"},
        {"size", 0, CLI_INT, &b->size, 16, 2048, "N",
         "pixels of a sphere's side for the PSNR, under the built-in sky (default 64)"},
        {"spp", 0, CLI_INT, &b->spp, 1, 1 << 20, "N", "samples a pixel for the PSNR (default 32)"},
        {"device", 'd', CLI_TEXT, &set.device, 0, 0, "N|all|none",
         "Vulkan device, see `hnbrdf verify --list` (default all)"},
        {"rounds", 0, CLI_INT, &b->rounds, 1, 100000, "N",
         "how often every row is sampled, 20 ms each (default 12)"},
        {"without-peer", 0, CLI_FLAG, &set.without_peer, 0, 0, NULL,
         "leave out the rows in the published style"},
        {"quick", 0, CLI_FLAG, &set.quick, 0, 0, NULL,
         "a try: one small network, two rounds of 1 ms; times mean little"},
        CLI_READING_OPTIONS,
        {0},
    };
    int count, code = cli_parse(&command, options, argc, argv, &count);
    fill_defaults(b, &set);
    b->sampler = (hnbrdf_sampler)sampler;
    if (code < 0) {
        code = check_outputs(&set);
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 0); /* the first dispatch is timed */
        if (code == CLI_OK)
            code = run(b, &set, argv + 1, count);
    }
    free(line);
    free(b);
    return code;
}
