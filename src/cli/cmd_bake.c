/* cmd_bake.c: `hnbrdf bake`: the smallest network that is good enough for the materials of one
 * scene. */
#include "base/interrupt.h"
#include "cli/bake_device.h"
#include "cli/cli.h"
#include "cli/ranks.h"
#include "cli/words.h"
#include "report/bake.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "bake",
    "MODEL (--max-error E | --max-ns T | --max-ggx X | --max-mults N | --net auto|HxN | "
    "--front LIST) [-m A,B] [--data DATA...] [-o OUT]",
    "Refits a small network to only the materials that a scene uses. A network shared by a\n"
    "whole database is larger than a few of its materials need. They are learned from the\n"
    "measurements (--data), else from MODEL itself. Prints what was tried: SMAPE of the whole\n"
    "and of the analytic part alone against what was learned from, multiplications, and the\n"
    "time of an evaluation by the batch call on this machine.\n"
    "  --max-error E  the fewest multiplications whose SMAPE is at most E, on average over\n"
    "                 the materials (--worst: for each of them). Where GGX alone is within E\n"
    "                 the network is dropped.\n"
    "  --max-ns T     the lowest error with at most T ns an evaluation, batch, one thread\n"
    "                 (--device: on that Vulkan device, in half precision too where only that\n"
    "                 is fast enough)\n"
    "  --max-ggx X    likewise with at most X times the time of GGX alone\n"
    "  --max-mults N  the lowest error with at most N multiplications an evaluation\n"
    "  --net auto     the network with the lowest product of error and time\n"
    "  --net HxN      this network\n"
    "--front 1,6,12 saves no model: for the first, six and twelve of the materials it fits all\n"
    "sizes, and those that none beats in both error and time to the full length. --plot is one\n"
    "picture of them: what a scene needs against what a database needs.\n"
    "Candidates get a short fit first, in order of their size; those that come near get a\n"
    "full one from several seeds. kd, eta and alpha stay MODEL's when it is the teacher, edits\n"
    "included, and are fitted anew to measurements; --analytic decides otherwise. The network\n"
    "never takes them over.\n"
    "The exit code is 0 only if what is saved is what was asked for. Otherwise, after Ctrl-C\n"
    "too, the best of what was tried is saved, if a network was. `mpirun -n N hnbrdf bake ...`\n"
    "shares the fits among N processes; each reads MODEL and all data.",
    "hnbrdf bake rgl.safetensors -m vch_silk_blue --max-error 0.15 -o scene.safetensors\n"
    "hnbrdf bake rgl.safetensors -m vch_silk_blue --max-ns 60 --data rgl/ -o s.safetensors\n"
    "hnbrdf bake merl.safetensors --net auto --seconds 120 --plot b.svg -o s.safetensors\n"
    "hnbrdf bake rgl.safetensors --net 8x2 --latent 4 -o scene.safetensors\n"
    "hnbrdf bake rgl.safetensors -m vch_silk_blue --max-ggx 2 --encoding all -o s.safetensors\n"
    "hnbrdf bake rgl.safetensors --front 1,2 --csv front.csv --plot front.svg",
};

typedef struct outputs {
    const char *model, *csv, *json, *plot, *front; /* front: the list, or NULL */
    long device;                                   /* -1: none */
} outputs;

typedef struct watch {
    const char *path; /* of the model */
    cli_stages stages;
} watch;

static int show(void *user, const hnbrdf_bake_progress *p)
{
    watch *w = user;
    char what[64], detail[64];
    if (!p->new_row) {
        report_bake_stage(p, what, detail);
        cli_stages_show(&w->stages, what, p->done, detail);
        return hnbrdf_interrupted();
    }
    cli_stages_end(&w->stages);
    if (p->report->row_count == 1) {
        report_bake_heading(p->report, w->path, cli_words());
        cli_print_reading();
        report_bake_columns(p->report, cli_words());
    }
    report_bake_row(p->report, &p->report->rows[p->report->row_count - 1], cli_words());
    fflush(cli_words());
    return hnbrdf_interrupted();
}

static int save(const hnbrdf_model *baked, const hnbrdf_bake_report *r, double seconds,
                const outputs *o)
{
    hnbrdf_error error;
    if (hnbrdf_model_save(baked, o->model, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    report_bake_result(r, o->model, cli_words());
    int code = cli_write_file(o->csv, report_bake_csv, r);
    if (code == CLI_OK)
        code = cli_write_file(o->json, report_bake_json, r);
    if (code == CLI_OK)
        code = cli_write_file(o->plot, report_bake_plot, r);
    fflush(cli_words());
    if (code == CLI_OK)
        code = cli_code(report_bake_verdict(r, seconds, o->model, &error), &error);
    return code;
}

static int bake(const hnbrdf_model *model, hnbrdf_bake_options *options, const char *path,
                const outputs *o)
{
    watch w = {.path = path};
    hnbrdf_model *baked;
    hnbrdf_bake_report report;
    hnbrdf_error error;
    options->progress = show;
    options->progress_user = &w;
    hnbrdf_catch_interrupts(1);
    hnbrdf_result result = hnbrdf_bake(model, options, &baked, &report, &error);
    hnbrdf_catch_interrupts(0);
    cli_stages_end(&w.stages);
    if (result == HNBRDF_ERROR_CANCELLED)
        return cli_fail("%s; %s is as it was", error.text, o->model);
    if (result)
        return cli_fail("%s", error.text);
    int code = cli_rank() == 0 ? save(baked, &report, options->seconds, o) : CLI_OK;
    hnbrdf_bake_report_free(&report);
    hnbrdf_model_free(baked);
    return code;
}

/* "1,6,12" */
static int read_front(const char *list, int most, int counts[REPORT_BAKE_FRONTS], int *count)
{
    *count = 0;
    for (const char *at = list;; at++) {
        char *end;
        const long n = strtol(at, &end, 10);
        if (end == at || n < 1 || n > most || *count == REPORT_BAKE_FRONTS ||
            (*end != ',' && *end != '\0'))
            return cli_usage(&command, "--front '%s' is not up to %d numbers from 1 to %d", list,
                             (int)REPORT_BAKE_FRONTS, most);
        counts[(*count)++] = (int)n;
        if (!*end)
            return CLI_OK;
        at = end;
    }
}

/* One bake for each number of materials; no model is kept. */
static int bake_front(const hnbrdf_model *model, hnbrdf_bake_options *options, const char *path,
                      const char *list, const outputs *o)
{
    report_bake_front front = {.count = 0};
    watch w = {.path = path};
    int counts[REPORT_BAKE_FRONTS], count;
    hnbrdf_error error;
    int code = read_front(list, options->material_count, counts, &count);
    options->wish = HNBRDF_BAKE_FRONT;
    options->progress = show;
    options->progress_user = &w;
    hnbrdf_catch_interrupts(1);
    for (int n = 0; n < count && code == CLI_OK; n++) {
        hnbrdf_model *baked;
        options->material_count = counts[n];
        hnbrdf_result result = hnbrdf_bake(model, options, &baked, &front.reports[n], &error);
        cli_stages_end(&w.stages);
        if (result) {
            code = cli_fail("%s", error.text);
            break;
        }
        front.count++;
        hnbrdf_model_free(baked);
        fputs("\n", cli_words());
        if (front.reports[n].end == HNBRDF_BAKE_STOPPED)
            code = cli_fail("interrupted; nothing is written");
    }
    hnbrdf_catch_interrupts(0);
    if (code == CLI_OK && cli_rank() == 0) {
        code = cli_write_file(o->csv, report_bake_front_csv, &front);
        if (code == CLI_OK)
            code = cli_write_file(o->plot, report_bake_front_plot, &front);
    }
    for (int n = 0; n < front.count; n++)
        hnbrdf_bake_report_free(&front.reports[n]);
    return code;
}

static int run(const char *path, const char *list, char *const *data_arguments, int data_count,
               hnbrdf_bake_options *options, const outputs *o)
{
    hnbrdf_model *model = NULL;
    cli_data data = {NULL, 0};
    bake_device *device = NULL;
    int *chosen = NULL, code = cli_open_model(path, &model);
    if (code == CLI_OK)
        code = cli_choose_materials(model, list, &chosen, &options->material_count);
    if (code == CLI_OK && data_count > 0)
        code = cli_open_data(data_arguments, data_count, &data);
    code = cli_ranks_agree(code);
    if (code == CLI_OK) {
        options->ranks = cli_ranks();
        options->materials = chosen;
        options->data = (const hnbrdf_measured *const *)data.items;
        options->data_count = data.count;
        if (o->device >= 0)
            code = bake_device_open(o->device, options, &device);
        if (code == CLI_OK)
            code = o->front ? bake_front(model, options, path, o->front, o)
                            : bake(model, options, path, o);
    }
    bake_device_close(device);
    free(chosen);
    cli_close_data(&data);
    hnbrdf_model_free(model);
    return code;
}

/* Exactly one wish, --net "auto" or "HxN" among them: -1 to go on, or the exit code. */
static int read_wish(hnbrdf_bake_options *o, const char *text)
{
    int net[2];
    int limits = (o->max_error > 0.0) + (o->max_ns > 0.0) + (o->max_ggx > 0.0) +
                 (o->max_multiplications > 0);
    if (limits + (text != NULL) != 1)
        return cli_usage(&command, "expected exactly one of --max-error E, --max-ns T, "
                                   "--max-ggx X, --max-mults N and --net auto|HxN");
    o->wish = o->max_error > 0.0                    ? HNBRDF_BAKE_ERROR
              : o->max_ns > 0.0 || o->max_ggx > 0.0 ? HNBRDF_BAKE_TIME
              : !text                               ? HNBRDF_BAKE_SIZE
                                                    : HNBRDF_BAKE_AUTO;
    if (!text || strcmp(text, "auto") == 0)
        return -1;
    const char *after = cli_parse_net(text, net);
    if (!after || *after)
        return cli_usage(&command,
                         "--net %s, expected auto or HxN with H from 1 to %d and N from 1 to %d",
                         text, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
    o->wish = HNBRDF_BAKE_NET;
    o->hidden = net[0];
    o->layers = net[1];
    return -1;
}

/* Those of encodings, and "all" behind them. */
static const char *encoding_word(int value)
{
    const char *word = cli_encoding_word(value);
    return word ? word : value > 0 && cli_encoding_word(value - 1) ? "all" : NULL;
}

int cmd_bake(int argc, char **argv)
{
    hnbrdf_bake_options b = {.steps = 0};
    outputs o = {.device = -1};
    const char *materials = NULL, *net = NULL, *data = NULL;
    cli_word encoding = {-1, encoding_word}, sampler = {HNBRDF_SAMPLER_GRID, cli_sampler_word};
    int analytic = -1, worst = 0, given;
    long latent = -1, mults = 0, restarts = 0, pairs = 0, pool = 0, seed = 1, threads = 0;
    /* clang-format off */
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_MODEL, &o.model, 0, 0, "FILE",
         "the model file to write (required)"},
        {"materials", 'm', CLI_TEXT, &materials, 0, 0, "LIST",
         "materials of MODEL to keep (default all)"},
        {"max-error", 0, CLI_REAL, &b.max_error, 1e-6, 2, "E", "the SMAPE that is accepted"},
        {"worst", 0, CLI_FLAG, &worst, 0, 0, NULL,
         "errors are judged by the worst material (default: by the mean)"},
        {"max-ns", 0, CLI_REAL, &b.max_ns, 1e-3, 1e9, "T",
         "the ns an evaluation may take, batch call, one thread of this machine"},
        {"max-ggx", 0, CLI_REAL, &b.max_ggx, 1e-3, 1e6, "X",
         "the same, in times of GGX alone"},
        {"device", 'd', CLI_INT, &o.device, 0, 63, "N",
         "times are of the exported shader on this Vulkan device (hnbrdf verify --list)"},
        {"front", 0, CLI_TEXT, &o.front, 0, 0, "LIST",
         "instead: the error against time for these numbers of materials"},
        {"max-mults", 0, CLI_INT, &mults, 1, 1e9, "N",
         "the multiplications of the network that are accepted"},
        {"net", 0, CLI_TEXT, &net, 0, 0, "HxN", "N hidden layers of H units, or auto"},
        {"latent", 0, CLI_INT, &latent, 0, HNBRDF_MAX_LATENT, "L",
         "floats of latent code (default: by the number of materials, at most 8)"},
        {"data", 0, CLI_READ, &data, 0, 0, "DATA...",
         "measurements to learn from and be judged by; further ones behind it, MODEL before"},
        {"analytic", 0, CLI_CHOICE, &analytic, 0, 0, "keep|fit",
         "kd, eta, alpha: MODEL's, or fitted to what is learned from (default keep, with "
         "--data fit)"},
        {"encoding", 0, CLI_WORD, &encoding, 0, 0, "NAME|all",
         "as of `fit`, or each of them in turn (default: by what is learned from)"},
        {"seconds", 0, CLI_REAL, &b.seconds, 1, 1e7, "S",
         "about the time for all fits (default: by steps)"},
        {"steps", 0, CLI_INT, &b.steps, 1, 1e9, "N",
         "training steps of a full fit; of a short one an eighth (default 32000)"},
        {"restarts", 0, CLI_INT, &restarts, 1, 32, "N",
         "seeds of a full fit, the best counts (default 4)"},
        {"sampler", 0, CLI_WORD, &sampler, 0, 0, "uniform|cosine|grid",
         "of the pairs that errors are measured on (default grid)"},
        {"pairs", 'n', CLI_INT, &pairs, 1, 1e9, "N",
         "pairs a material that errors are measured on (default 200000; short fits 20000)"},
        {"pool", 0, CLI_INT, &pool, 64, 1 << 26, "N",
         "pairs drawn a material for training (default 131072, short fits 32768)"},
        {"seed", 0, CLI_INT, &seed, 0, 9e15, "N",
         "the first seed of everything random (default 1)"},
        {"csv", 0, CLI_WRITE_TEXT, &o.csv, 0, 0, "FILE", "write what was tried, a row a model"},
        {"json", 0, CLI_WRITE_TEXT, &o.json, 0, 0, "FILE",
         "the same with the errors of each material"},
        {"plot", 0, CLI_WRITE_TEXT, &o.plot, 0, 0, "FILE", "write error against time as an SVG"},
        {"threads", 't', CLI_INT, &threads, 1, 256, "N", "threads (default one a core)"},
        CLI_READING_OPTIONS,
        {0},
    };
    /* clang-format on */
    int code = cli_parse(&command, options, argc, argv, &given);
    if (code >= 0)
        return code;
    if (given < 1)
        return cli_usage(&command, "no MODEL given");
    if (given > 1 && !data)
        return cli_usage(&command,
                         "found %d arguments, expected one MODEL; measurements go after --data",
                         given);
    if (o.front && (o.model || o.json || net || b.max_error > 0.0 || b.max_ns > 0.0 ||
                    b.max_ggx > 0.0 || mults))
        return cli_usage(&command, "--front makes no model: neither a limit, --net, --json nor -o");
    if (!o.model && !o.front)
        return cli_usage(&command, "no output file given, expected -o SCENE.safetensors");
    b.max_multiplications = (size_t)mults;
    if (!o.front && (code = read_wish(&b, net)) >= 0)
        return code;
    b.encoding = hnbrdf_encoding_name((hnbrdf_encoding)encoding.value);
    b.all_encodings = encoding.value >= 0 && !b.encoding;
    b.judge = worst ? HNBRDF_BAKE_WORST : HNBRDF_BAKE_MEAN;
    b.analytic = (hnbrdf_bake_analytic)(analytic + 1);
    b.sampler = (hnbrdf_sampler)sampler.value;
    b.latent = latent > 0 ? (int)latent : 0;
    b.latent_none = latent == 0;
    b.restarts = (int)restarts;
    b.pairs = (size_t)pairs;
    b.pool = (int)pool;
    b.seed = (uint64_t)seed;
    b.threads = (int)threads;
    const char *path = argv[1];
    if (data)
        argv[1] = (char *)data; /* points into argv, as the others do */
    return run(path, materials, argv + 1, data ? given : 0, &b, &o);
}
