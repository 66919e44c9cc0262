/* cmd_fit.c: hnbrdf fit: measured materials in, one model file out. */
#include "cli/cli.h"
#include "hnbrdf/fit.h"

#include <math.h>
#include <string.h>

static const cli_command command = {
    "fit", "DATA... [options] -o MODEL.safetensors",
    "Fit one model to measured materials: GGX for each of them, then a small network and latent codes\n"
    "that learn what GGX misses. DATA is `builtin`, builtin:NAME, files (.bsdf, .binary) or directories.\n"
    "The result depends on the data, the options and the seed, not on the number of threads; a fit\n"
    "limited by --seconds prints the steps it made, to be repeated with --steps.",
    "  hnbrdf fit builtin -o builtin.safetensors\n"
    "  hnbrdf fit rgl/ --net 32x2 --latent 4 --seconds 120 -o rgl.safetensors\n"
    "  hnbrdf fit rgl/ --kind ggx -o ggx.safetensors\n"
    "  hnbrdf fit merl/ --encoding directions --floor 0 -o paper.safetensors\n"};

typedef struct display {
    cli_progress line;
    const char *stage;
} display;

static int show(void *user, const hnbrdf_fit_progress *p)
{
    display *d = user;
    char detail[128];
    if (!d->stage || strcmp(d->stage, p->stage)) {
        if (d->stage)
            cli_progress_end(&d->line);
        d->stage = p->stage;
        cli_progress_begin(&d->line, strcmp(p->stage, "sampling") == 0 ? "drawing data"
                                     : strcmp(p->stage, "ggx") == 0    ? "fitting GGX"
                                                                       : "training the network");
    }
    if (isfinite(p->loss))
        snprintf(detail, sizeof detail, "step %ld  loss %.4f  %.2f M pairs/s", p->step, p->loss,
                 p->pairs_per_s * 1e-6);
    else
        detail[0] = '\0';
    cli_progress_update(&d->line, p->done, detail);
    return 0;
}

/* Index of text in names, or -1. */
static int choose(const char *text, const char *const *names)
{
    for (int i = 0; names[i]; i++)
        if (strcmp(text, names[i]) == 0)
            return i;
    return -1;
}

int cmd_fit(int argc, char **argv)
{
    static const char *const kinds[] = {"hybrid", "neural", "ggx", NULL};
    static const char *const encodings[] = {"directions", "half-difference", NULL};
    static const char *const analytics[] = {"faithful", "joint", NULL};
    const char *kind = "hybrid", *encoding = "half-difference", *analytic = "faithful", *output = NULL;
    int net[2] = {32, 2};
    long latent = 0, steps = 0, seed = 1, threads = 0, batch = 0, pool = 0;
    double seconds = 0.0, floor = 0.003, rate = 1e-2;
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &output, 0, 0, "FILE", "the model file to write (required)"},
        {"kind", 0, CLI_TEXT, &kind, 0, 0, "KIND", "hybrid, neural or ggx (default hybrid)"},
        {"net", 0, CLI_NET, net, 0, 0, "HxN", "N hidden layers of H units (default 32x2)"},
        {"latent", 0, CLI_INT, &latent, 1, HNBRDF_MAX_LATENT, "L",
         "floats of latent code a material (default 4; neural: 12)"},
        {"encoding", 0, CLI_TEXT, &encoding, 0, 0, "NAME", "half-difference or directions (default the first)"},
        {"analytic", 0, CLI_TEXT, &analytic, 0, 0, "HOW",
         "faithful: keep the GGX fit; joint: train it along (default faithful)"},
        {"floor", 0, CLI_REAL, &floor, 0, 0.999, "B", "the floor b, 1/sr; 0 for none (default 0.003)"},
        {"steps", 0, CLI_INT, &steps, 1, 1e9, "N", "training steps (default 32000)"},
        {"seconds", 0, CLI_REAL, &seconds, 0.1, 1e7, "S", "train the network for this long instead"},
        {"batch", 0, CLI_INT, &batch, 1, 1 << 24, "N", "direction pairs a step (default 2048)"},
        {"pool", 0, CLI_INT, &pool, 64, 1 << 26, "N", "direction pairs drawn a material (default 131072)"},
        {"rate", 0, CLI_REAL, &rate, 1e-7, 10, "R", "peak learning rate of Adam (default 0.01)"},
        {"seed", 0, CLI_INT, &seed, 0, 9e15, "N", "seed of everything random (default 1)"},
        {"threads", 0, CLI_INT, &threads, 1, 256, "N", "threads (default one a core)"},
        {NULL, 0, CLI_FLAG, NULL, 0, 0, NULL, NULL}};
    int given;
    int code = cli_parse(&command, options, argc, argv, &given);
    if (code >= 0)
        return code;
    if (given == 0)
        return cli_usage(&command, "no DATA given");
    if (!output)
        return cli_usage(&command, "no output file given, expected -o MODEL.safetensors");
    int kind_index = choose(kind, kinds), encoding_index = choose(encoding, encodings);
    int analytic_index = choose(analytic, analytics);
    if (kind_index < 0)
        return cli_usage(&command, "--kind %s, expected hybrid, neural or ggx", kind);
    if (encoding_index < 0)
        return cli_usage(&command, "--encoding %s, expected directions or half-difference", encoding);
    if (analytic_index < 0)
        return cli_usage(&command, "--analytic %s, expected faithful or joint", analytic);
    if (steps && seconds > 0.0)
        return cli_usage(&command, "--steps and --seconds exclude each other");

    cli_data data;
    if ((code = cli_open_data(argv + 1, given, &data)))
        return code;
    display d = {{0}, NULL};
    hnbrdf_fit_options fit = {0};
    fit.kind = (hnbrdf_kind)kind_index;
    fit.hidden = net[0];
    fit.layers = net[1];
    fit.latent = (int)latent;
    fit.encoding = (hnbrdf_encoding)encoding_index;
    fit.encoding_set = 1;
    fit.floor = floor > 0.0 ? (float)floor : -1.0f;
    fit.analytic = (hnbrdf_fit_analytic)analytic_index;
    fit.steps = steps;
    fit.seconds = seconds;
    fit.batch = (int)batch;
    fit.pool = (int)pool;
    fit.learning_rate = (float)rate;
    fit.seed = (uint64_t)seed;
    fit.threads = (int)threads;
    fit.progress = show;
    fit.progress_user = &d;
    hnbrdf_model *model = NULL;
    hnbrdf_fit_report report;
    hnbrdf_error error;
    hnbrdf_result result = hnbrdf_fit((const hnbrdf_measured *const *)data.items, data.count, &fit, &model,
                                      &report, &error);
    if (d.stage)
        cli_progress_end(&d.line);
    if (!result)
        result = hnbrdf_model_save(model, output, &error);
    if (result) {
        code = cli_fail("%s", error.text);
    } else {
        code = CLI_OK;
        printf("%s: %s", output, kind);
        if (fit.kind != HNBRDF_KIND_GGX)
            printf(" %dx%d, %s, %d materials, %ld steps, loss %.4f, %.2f M pairs/s", net[0], net[1], encoding,
                   data.count, report.steps, report.final_loss, report.pairs_per_s * 1e-6);
        else
            printf(", %d materials", data.count);
        printf(", %.1f s\n", report.seconds);
    }
    hnbrdf_model_free(model);
    cli_close_data(&data);
    return code;
}
