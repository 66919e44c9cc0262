/* cmd_bench.c: `hnbrdf bench`: run time beside error, for models, backends and styles of one
 * run. */
#include "bench/bench.h"
#include "bench/growth.h"
#include "bench/scaling.h"
#include "cli/cli.h"
#include "cli/report.h"
#include "cli/words.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "bench",
    "[MODEL...] [--data DATA] [--csv FILE] [--json FILE] [--plot FILE]",
    "Measures what one evaluation takes, for each model on each backend, and sets it beside\n"
    "the error. Without MODEL, networks of several sizes (--nets) are fitted to DATA (default\n"
    "builtin) first. GGX alone is always there to compare with. All rows are sampled in turn,\n"
    "many times; the least counts.\n\n"
    "Backends: c-single (hnbrdf_eval), c-single-prepared (hnbrdf_prepared_eval), c-batch\n"
    "(hnbrdf_eval_batch; a row a variant), c-many (hnbrdf_eval_many, a material drawn for\n"
    "every pair), vulkan:DEVICE (the exported shader, fast build, two materials). CPU rows\n"
    "are of one thread, in its CPU time. Vulkan rows are by the device's timestamps, those of\n"
    "a software device by the process's CPU time over the number of processors, less the time\n"
    "of an empty kernel on the same buffers (io).\n\n"
    "Weights: model (as loaded); constants, columns, uniform: of `hnbrdf export --weights`,\n"
    "constants in half precision too where the device has it; columns-fixed (with --fixed: the\n"
    "latent code in the first bias, no material can be edited); published-style (a peer: the\n"
    "same network with the directions as inputs, mat4 chains with literals of three decimals,\n"
    "microfacet formulas with full fractions and pow, as published viewer shaders have them;\n"
    "made by this command).\n\n"
    "Baselines (--baselines): measurement (by its reader), table-90x90x180 (of MERL's shape,\n"
    "trilinear, made of the measurement with the mean of both orders of the directions),\n"
    "ggx-two-lobes (Lambert and two GGX lobes, fitted to the measurement), nbrdf (--nbrdf, a\n"
    "network a material). Directions are drawn, and densities taken, by a table of 5.6 MB a\n"
    "material for the first two (Lawrence et al. 2004), by both lobes, and by GGX alone.\n\n"
    "CSV: ns_per_eval is without buffers; peak_fraction: multiplications and additions of the\n"
    "network in that time (on the CPU without the latent code's, which is folded into the\n"
    "first bias), of the FMA peak measured in the same run with the row's instructions and\n"
    "threads; ratio_to_ggx: to ns_per_eval of GGX alone on the same backend; compile_ms: GLSL\n"
    "to SPIR-V; bytes: of the weights; of a shader: of the SPIR-V with evaluation alone in\n"
    "it, and of the uniform block; mults: of the network, an evaluation; smape, psnr: means\n"
    "over the materials that DATA has, blank without; io_ns: of the buffers; net_ns and\n"
    "net_peak_fraction: of the network alone, in batches, of c-single-prepared one pair at a\n"
    "time; first_dispatch_ms: pipeline and first run; threads; net_muladd_fraction: of the\n"
    "peak without fusing; sample_ns, density_ns: one direction with its density, one density;\n"
    "scene_bytes: of all materials of DATA, the network, kd, eta, alpha, rotation and latent\n"
    "codes in single precision.",
    "hnbrdf bench --quick\n"
    "hnbrdf bench model.safetensors\n"
    "hnbrdf bench a.safetensors b.safetensors --data rgl/ --csv b.csv --plot b.svg\n"
    "hnbrdf bench --nets 8x2,16x2,32x2,64x3 --data rgl/ --seconds 60 --plot bench.svg\n"
    "hnbrdf bench a.safetensors --data rgl/ --baselines --csv b.csv\n"
    "hnbrdf bench --growth --csv growth.csv",
};

typedef struct settings {
    const char *data, *nets, *device, *csv, *json, *plot, *nbrdf;
    double seconds;
    long steps, pool;
    int quick, without_peer, scaling, growth, baselines;
    double sample_ms;
    bench_gpu_options gpu;
} settings;

/* ---- Progress -------------------------------------------------------------------------------- */

static int show(void *user, const char *what, double share, const char *detail)
{
    cli_stages_show(user, what, share, detail);
    return 0;
}

static void tell(void *user, const char *line)
{
    cli_stages_end(user);
    fprintf(cli_words(), "%s\n", line);
}

static void warn(void *user, const char *line)
{
    cli_stages_end(user);
    cli_warn("%s", line);
}

static int ended(bench *b, hnbrdf_result result, const hnbrdf_error *error)
{
    cli_stages_end(b->watch.user);
    return cli_code(result, error);
}

/* ---- Models ---------------------------------------------------------------------------------- */

static int load_model(bench *b, const char *path)
{
    cli_source source;
    hnbrdf_error error;
    if (cli_open_source(path, &source) != CLI_OK)
        return CLI_FAILURE;
    if (source.model)
        return ended(b, bench_add_model(b, source.model, path, &error), &error);
    cli_close_source(&source);
    return cli_fail("%s: a measurement, expected a model; data to compare with go behind --data",
                    path);
}

static int fit_models(bench *b, const cli_data *data, const settings *set)
{
    bench_fit fit = {.steps = set->steps, .seconds = set->seconds, .pool = (int)set->pool};
    for (const char *at = set->nets; *at; at += *at == ',') {
        hnbrdf_error error;
        at = cli_parse_net(at, fit.net);
        if (!at || (*at != ',' && *at != '\0'))
            return cli_usage(&command, "--nets: '%s' is not HxN,HxN,... with H to %d and N to %d",
                             set->nets, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
        int code = ended(b, bench_fit_model(b, data->items, data->count, &fit, &error), &error);
        if (code != CLI_OK)
            return code;
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

/* What many processes would exchange, as CSV. */
static int print_scaling(const settings *set)
{
    int nets[16][2], count = 0;
    hnbrdf_error error;
    cli_output output;
    for (const char *at = set->nets; *at; at += *at == ',') {
        at = count < 16 ? cli_parse_net(at, nets[count++]) : NULL;
        if (!at || (*at != ',' && *at != '\0'))
            return cli_usage(&command, "--nets: '%s' is not up to 16 of HxN,HxN,...", set->nets);
    }
    int code = cli_output_open(set->csv ? set->csv : "-", &output);
    if (code != CLI_OK)
        return code;
    code = cli_code(bench_scaling_print((const int(*)[2])nets, count, output.file, &error), &error);
    return cli_output_close(&output) || code ? CLI_FAILURE : CLI_OK;
}

/* How costs grow. */
static int print_growth(const bench *b, const settings *set)
{
    growth g = {.cpu = b->cpu};
    hnbrdf_error error;
    const bench_growth_options options = {
        .quick = set->quick, .device = set->device, .watch = b->watch};
    hnbrdf_result result = bench_growth(&options, &g, &error);
    cli_stages_end(b->watch.user);
    if (result)
        return cli_code(result, &error);
    if (!cli_is_stdout(set->csv))
        bench_growth_print(&g, stdout);
    return cli_write_file(set->csv, bench_growth_write_csv, &g);
}

/* ---- Output ---------------------------------------------------------------------------------- */

static int write_results(const bench *b, const settings *set)
{
    if (!cli_is_stdout(set->csv) && !cli_is_stdout(set->json) && !cli_is_stdout(set->plot))
        bench_print(b, stdout);
    int code = cli_write_file(set->csv, bench_write_csv, b);
    if (code == CLI_OK)
        code = cli_write_file(set->json, bench_write_json, b);
    return code == CLI_OK ? cli_write_file(set->plot, bench_write_plot, b) : code;
}

/* ---- Command --------------------------------------------------------------------------------- */

static int run(bench *b, const settings *set, char **paths, int count)
{
    cli_data data = {NULL, 0}, nbrdf = {NULL, 0};
    hnbrdf_error error;
    int code =
        set->data || count == 0 ? open_data(set->data ? set->data : "builtin", &data) : CLI_OK;
    for (int k = 0; k < count && code == CLI_OK; k++)
        code = load_model(b, paths[k]);
    if (code == CLI_OK && count == 0)
        code = fit_models(b, &data, set);
    if (code == CLI_OK && set->nbrdf)
        code = open_data(set->nbrdf, &nbrdf);
    if (code == CLI_OK && set->baselines)
        bench_add_baselines(b, data.items, data.count, nbrdf.items, nbrdf.count);
    if (code == CLI_OK)
        code = ended(b, bench_add_ggx(b, &error), &error);
    if (code == CLI_OK && data.count > 0)
        code =
            ended(b, bench_measure_quality(b, data.items, data.count, !set->without_peer, &error),
                  &error);
    if (code == CLI_OK)
        code = ended(b, bench_measure(b, &set->gpu, 1e6 * set->sample_ms, &error), &error);
    if (code == CLI_OK)
        code = write_results(b, set);
    bench_free(b);
    cli_close_data(&data);
    cli_close_data(&nbrdf);
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

int cmd_bench(int argc, char **argv)
{
    bench *b = calloc(1, sizeof *b);
    char *line = report_join(argc, argv);
    if (!b || !line) {
        free(b);
        free(line);
        return cli_fail("out of memory");
    }
    settings set = {.device = "all"};
    b->command_line = line;
    cli_stages stages = {.what = ""};
    char cpu[BENCH_NAME];
    cli_word sampler = {HNBRDF_SAMPLER_GRID, cli_sampler_word};
    b->cpu = bench_cpu_name(cpu);
    b->watch = (bench_watch){show, tell, warn, &stages};
    const cli_option options[] = {
        {"data", 0, CLI_TEXT, &set.data, 0, 0, "DATA",
         "measurements to compare with, by name; several with commas between"},
        {"csv", 0, CLI_WRITE_TEXT, &set.csv, 0, 0, "FILE",
         "the table as CSV; - is standard output"},
        {"json", 0, CLI_WRITE_TEXT, &set.json, 0, 0, "FILE",
         "the table and the machine as JSON; - likewise"},
        {"plot", 0, CLI_WRITE_TEXT, &set.plot, 0, 0, "FILE",
         "SVG: error against run time; c-batch, c-single-prepared and Vulkan (with MODEL needs "
         "--data)"},
        {"nets", 0, CLI_TEXT, &set.nets, 0, 0, "LIST",
         "without MODEL: what to fit (default 16x2,32x2,64x3)"},
        {"seconds", 0, CLI_REAL, &set.seconds, 0.1, 1e6, "S",
         "without MODEL: train each network this long (default 20)"},
        {"sampler", 0, CLI_WORD, &sampler, 0, 0, "uniform|cosine|grid",
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
        {"baselines", 0, CLI_FLAG, &set.baselines, 0, 0, NULL,
         "rows of what one would pick instead too; needs --data"},
        {"nbrdf", 0, CLI_TEXT, &set.nbrdf, 0, 0, "DATA",
         "with --baselines: NBRDF networks (.h5, .npy), by the names of the measurements"},
        {"growth", 0, CLI_FLAG, &set.growth, 0, 0, NULL,
         "instead: how costs grow with H, N, l, materials and pairs; a minute or two"},
        {"scaling", 0, CLI_FLAG, &set.scaling, 0, 0, NULL,
         "instead: what a fit by 10, 100 and 1000 processes would exchange, on paper, as CSV"},
        {"quick", 0, CLI_FLAG, &set.quick, 0, 0, NULL,
         "a try: one small network, two rounds of 1 ms; times mean little"},
        CLI_READING_OPTIONS,
        {0},
    };
    int count, code = cli_parse(&command, options, argc, argv, &count);
    fill_defaults(b, &set);
    b->sampler = (hnbrdf_sampler)sampler.value;
    if (code < 0) {
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 0); /* the first dispatch is timed */
        if ((set.nbrdf && !set.baselines) || (set.baselines && count > 0 && !set.data))
            code = cli_usage(&command,
                             set.nbrdf ? "--nbrdf needs --baselines" : "--baselines needs --data");
        else
            code = set.growth    ? print_growth(b, &set)
                   : set.scaling ? print_scaling(&set)
                                 : run(b, &set, argv + 1, count);
    }
    free(line);
    free(b);
    return code;
}
