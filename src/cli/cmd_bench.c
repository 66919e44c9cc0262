/* cmd_bench.c: `hnbrdf bench`: run time beside error, for models, backends and styles of one run.
 * */
#include "cli/bench.h"
#include "cli/peak.h"
#include "hnbrdf/fit.h"

#include <math.h>
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

/* ---- Rows ------------------------------------------------------------------------------------ */

bench_row *bench_add_row(bench *b, const bench_model *model, const char *backend,
                         const char *variant, const char *weights, const char *precision)
{
    if (b->row_count == BENCH_ROWS) {
        cli_fail("more than %d rows: fewer models, please", BENCH_ROWS);
        return NULL;
    }
    bench_row *row = &b->rows[b->row_count++];
    *row = (bench_row){.model = model,
                       .variant = variant,
                       .weights = weights,
                       .precision = precision,
                       .encoding = model->desc.encoding,
                       .whole = {.ns = (double)NAN},
                       .network = {.ns = (double)NAN},
                       .compile_ms = (double)NAN,
                       .first_ms = (double)NAN,
                       .smape = model->smape,
                       .psnr = model->psnr};
    snprintf(row->backend, sizeof row->backend, "%s", backend);
    return row;
}

const char *bench_net(const bench_model *model, char text[16])
{
    if (model->desc.kind == HNBRDF_KIND_GGX)
        snprintf(text, 16, "none");
    else
        snprintf(text, 16, "%dx%d", model->desc.hidden, model->desc.layers);
    return text;
}

double bench_ns(const bench_row *row)
{
    return row->whole.ns - (row->io ? row->io->ns : 0.0);
}

double bench_network_ns(const bench_row *row)
{
    return row->network.ns - (row->io ? row->io->ns : 0.0);
}

const bench_row *bench_ggx(const bench *b, const bench_row *row)
{
    for (int k = 0; k < b->row_count; k++)
        if (b->rows[k].model == &b->models[0] && strcmp(b->rows[k].backend, row->backend) == 0 &&
            strcmp(b->rows[k].variant, row->variant) == 0)
            return &b->rows[k];
    return NULL;
}

double bench_peak_fraction(const bench *b, const bench_row *row, double ns, int fused)
{
    const hnbrdf_model_desc *desc = &row->model->desc;
    double operations = 2.0 * (double)hnbrdf_model_multiplications(row->model->model);
    if (!row->io) /* on the CPU the latent code is folded into the first bias */
        operations -= 2.0 * desc->hidden * desc->latent;
    const char *variant = row->io ? cli_peak_name() : row->variant;
    for (int k = 0; k < b->peak_count; k++)
        if (strcmp(b->peaks[k].variant, variant) == 0 && row->threads > 0 && operations > 0.0) {
            double peak = row->threads * (fused ? b->peaks[k].fma : b->peaks[k].muladd);
            return operations / ns * 1e9 / peak;
        }
    return (double)NAN;
}

/* ---- Models ---------------------------------------------------------------------------------- */

static int has_name(const bench *b, const char *name)
{
    for (int k = 0; k < b->model_count; k++)
        if (strcmp(b->models[k].name, name) == 0)
            return 1;
    return 0;
}

/* Takes the model over, also on failure. */
static int add_model(bench *b, hnbrdf_model *model, const char *name)
{
    if (b->model_count == BENCH_MODELS || has_name(b, name)) {
        hnbrdf_model_free(model);
        return b->model_count == BENCH_MODELS ? cli_fail("more than %d models", BENCH_MODELS - 1)
                                              : cli_fail("two models are called %s", name);
    }
    bench_model *m = &b->models[b->model_count++];
    m->model = model;
    m->material = hnbrdf_model_material(model, 0);
    m->smape = m->psnr = m->half_smape = m->peer_smape = m->peer_psnr = (double)NAN;
    hnbrdf_model_describe(model, &m->desc);
    snprintf(m->name, sizeof m->name, "%s", name);
    return CLI_OK;
}

static int load_model(bench *b, const char *path)
{
    char name[BENCH_NAME];
    cli_source source;
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
    return add_model(b, source.model, name);
}

static int show_fit(void *user, const hnbrdf_fit_progress *p)
{
    cli_progress_update(user, strcmp(p->stage, "network") == 0 ? p->done : 0.0, p->stage);
    return 0;
}

static int fit_model(bench *b, const cli_data *data, const settings *set, const int net[2])
{
    char name[BENCH_NAME], what[BENCH_NAME + 16];
    cli_progress line;
    hnbrdf_error error;
    hnbrdf_model *model;
    snprintf(name, sizeof name, "hybrid-%dx%d", net[0], net[1]);
    snprintf(what, sizeof what, "fitting %s", name);
    const hnbrdf_fit_options options = {.hidden = net[0],
                                        .layers = net[1],
                                        .steps = set->steps,
                                        .seconds = set->steps ? 0.0 : set->seconds,
                                        .pool = (int)set->pool,
                                        .seed = 1,
                                        .progress = show_fit,
                                        .progress_user = &line};
    cli_progress_begin(&line, what);
    hnbrdf_result result = hnbrdf_fit((const hnbrdf_measured *const *)data->items, data->count,
                                      &options, &model, NULL, &error);
    cli_progress_end(&line);
    return result ? cli_fail("%s", error.text) : add_model(b, model, name);
}

static int fit_models(bench *b, const cli_data *data, const settings *set)
{
    for (const char *at = set->nets; *at;) {
        int net[2], length = 0;
        if (sscanf(at, "%2dx%1d%n", &net[0], &net[1], &length) != 2 || net[0] < 1 ||
            net[0] > HNBRDF_MAX_HIDDEN || net[1] < 1 || net[1] > HNBRDF_MAX_LAYERS ||
            (at[length] != ',' && at[length] != '\0'))
            return cli_usage(&command, "--nets: '%s' is not HxN,HxN,... with H to %d and N to %d",
                             set->nets, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
        int code = fit_model(b, data, set, net);
        if (code != CLI_OK)
            return code;
        at += length + (at[length] == ',');
    }
    return CLI_OK;
}

/* GGX alone goes first: the analytic part of the first model that has one, else of default
 * materials. */
static int add_ggx(bench *b)
{
    hnbrdf_model_desc ggx = {.kind = HNBRDF_KIND_GGX};
    hnbrdf_model *model;
    hnbrdf_error error;
    const bench_model *from = &b->models[1];
    for (int k = b->model_count - 1; k > 0; k--)
        if (b->models[k].desc.kind != HNBRDF_KIND_NEURAL)
            from = &b->models[k];
    ggx.material_count = from->desc.material_count;
    ggx.materials = from->desc.materials;
    ggx.names = from->desc.names;
    if (hnbrdf_model_create(&ggx, NULL, &model, &error))
        return cli_fail("%s", error.text);
    int count = b->model_count;
    b->model_count = 0;
    int code = add_model(b, model, "ggx");
    b->model_count = count;
    return code;
}

/* ---- Data ------------------------------------------------------------------------------------ */

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

/* ---- Timing ---------------------------------------------------------------------------------- */

typedef struct watch {
    bench *b;
    cli_progress line;
    double peak_seconds; /* when the peak was measured last */
} watch;

/* Peaks are measured again and again along the way: the clock rate changes within a run. */
static void between(void *user, double share)
{
    watch *w = user;
    cli_progress_update(&w->line, share, "");
    if (cli_seconds() - w->peak_seconds < 1.0)
        return;
    for (int k = 0; k < w->b->peak_count; k++) {
        double fma, muladd;
        bench_peak *peak = &w->b->peaks[k];
        cli_peaks_of(peak->variant, &fma, &muladd);
        peak->fma = fmax(peak->fma, fma);
        peak->muladd = fmax(peak->muladd, muladd);
    }
    w->peak_seconds = cli_seconds();
}

static void choose_peaks(bench *b)
{
    for (int v = HNBRDF_VARIANT_PLAIN; hnbrdf_variant_name((hnbrdf_variant)v); v++)
        if (hnbrdf_variant_available((hnbrdf_variant)v) && b->peak_count < BENCH_PEAKS)
            b->peaks[b->peak_count++].variant = hnbrdf_variant_name((hnbrdf_variant)v);
}

static int time_rows(bench *b, const settings *set)
{
    choose_peaks(b);
    bench_probe **probes = calloc(2 * BENCH_ROWS + BENCH_DEVICES, sizeof(bench_probe *));
    int count = 0;
    if (!probes)
        return cli_fail("out of memory");
    for (int k = 0; k < b->io_count; k++)
        probes[count++] = &b->io[k];
    for (int k = 0; k < b->row_count; k++) {
        probes[count++] = &b->rows[k].whole;
        if (b->rows[k].network.run)
            probes[count++] = &b->rows[k].network;
    }
    watch w = {.b = b, .peak_seconds = -2.0};
    const bench_timing timing = {
        .sample_ns = 1e6 * set->sample_ms, .rounds = b->rounds, .between = between, .user = &w};
    cli_progress_begin(&w.line, "timing");
    bench_time(&timing, probes, count);
    cli_progress_end(&w.line);
    free(probes);
    return CLI_OK;
}

/* ---- Output ---------------------------------------------------------------------------------- */

static int write_file(const bench *b, const char *path, void (*write)(const bench *b, FILE *file))
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
        bench_print(b);
    int code = write_file(b, set->csv, bench_write_csv);
    if (code == CLI_OK)
        code = write_file(b, set->json, bench_write_json);
    return code == CLI_OK ? write_file(b, set->plot, bench_write_plot) : code;
}

/* ---- Command --------------------------------------------------------------------------------- */

static int measure(bench *b, const settings *set)
{
    bench_cpu *cpu = bench_cpu_open(b);
    bench_gpu *gpu = cpu ? bench_gpu_open(b, &set->gpu) : NULL;
    int code = cpu && gpu ? time_rows(b, set) : CLI_FAILURE;
    if (code == CLI_OK)
        code = write_results(b, set);
    bench_gpu_close(gpu);
    bench_cpu_close(cpu);
    return code;
}

static int run(bench *b, const settings *set, char **paths, int count)
{
    cli_data data = {NULL, 0};
    int code =
        set->data || count == 0 ? open_data(set->data ? set->data : "builtin", &data) : CLI_OK;
    b->model_count = 1; /* room for GGX */
    for (int k = 0; k < count && code == CLI_OK; k++)
        code = load_model(b, paths[k]);
    if (code == CLI_OK && count == 0)
        code = fit_models(b, &data, set);
    if (code == CLI_OK)
        code = add_ggx(b);
    if (code == CLI_OK && data.count > 0)
        code = bench_measure_quality(b, &data, !set->without_peer);
    b->rows = code == CLI_OK ? calloc(BENCH_ROWS, sizeof *b->rows) : NULL;
    if (code == CLI_OK)
        code = b->rows ? measure(b, set) : cli_fail("out of memory");
    for (int k = 0; k < b->model_count; k++)
        hnbrdf_model_free(b->models[k].model);
    free(b->rows);
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
    b->cpu = bench_cpu_name();
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
    b->sampler = HNBRDF_SAMPLER_GRID;
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
        {"sampler", 0, CLI_CHOICE, &b->sampler, 0, 0, "uniform|cosine|grid",
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
    if (code < 0) {
        code = check_outputs(&set);
        if (code == CLI_OK)
            code = run(b, &set, argv + 1, count);
    }
    free(line);
    free(b);
    return code;
}
