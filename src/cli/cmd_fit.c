/* cmd_fit.c: hnbrdf fit: measured materials in, one model file out. */
#include "base/interrupt.h"
#include "bench/speed.h"
#include "cli/cli.h"
#include "cli/ranks.h"
#include "cli/words.h"
#include "hnbrdf/fit.h"
#include "report/fit_log.h"
#include "report/loss_plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "fit", "DATA... [options] -o MODEL.safetensors",
    "Fit one model to measured materials: GGX for each of them, then a small network and latent "
    "codes\n"
    "that learn what GGX misses. DATA is `builtin`, `builtin:anisotropic`, builtin:NAME,\n"
    "measured files or directories; procedural:N stands for N random materials from formulas, of\n"
    "which a network for materials that it has not seen learns what there may be.\n"
    "The result depends on the data, the options and the seed, not on the number of threads; a "
    "fit\n"
    "limited by --seconds prints the steps it made, to be repeated with --steps. Ctrl-C ends a "
    "fit\n"
    "after the step, saves the model so far, and leaves OUTPUT.checkpoint, from which --resume "
    "goes "
    "on.\n"
    "`mpirun -n N hnbrdf fit ...` shares the work among N processes, on as many machines: each "
    "reads "
    "and\n"
    "holds every Nth material, and the model has the bits that one process gives. The first "
    "process\n"
    "writes; a checkpoint is good for any number of them. Give --threads, or each takes all cores.",
    "  hnbrdf fit builtin -o builtin.safetensors\n"
    "  hnbrdf fit rgl/ --net 32x2 --latent 4 --seconds 120 -o rgl.safetensors\n"
    "  hnbrdf fit rgl/ --kind ggx -o ggx.safetensors\n"
    "  hnbrdf fit new.bsdf --freeze universal -o new.safetensors\n"
    "  hnbrdf fit new.bsdf --freeze rgl.safetensors -o more.safetensors\n"
    "  hnbrdf fit rgl/ procedural:200 --net 64x2 --latent 16 -o many.safetensors\n"
    "  hnbrdf fit merl/ --encoding directions --floor 0 -o paper.safetensors\n"};

#define FEW_VALID 0.1 /* share; measurements are above half */
#define POOR_LOSS 1.0

typedef struct display {
    cli_progress line;
    const char *stage;
    int log_every; /* steps between rows */
    fit_log log;
    loss_curve curve;
} display;

static int show(void *user, const hnbrdf_fit_progress *p)
{
    display *d = user;
    char detail[128];
    if (!d->stage || strcmp(d->stage, p->stage) != 0) {
        if (d->stage)
            cli_progress_end(&d->line);
        d->stage = p->stage;
        cli_progress_begin(&d->line, strcmp(p->stage, "sampling") == 0 ? "drawing data"
                                     : strcmp(p->stage, "ggx") == 0    ? "fitting GGX"
                                     : strcmp(p->stage, "lobes") == 0 ? "fitting lobes for sampling"
                                                                      : "training the network");
    }
    if (isfinite(p->loss))
        snprintf(detail, sizeof detail, "step %ld  loss %.4f  %.2f M pairs/s", p->step, p->loss,
                 p->pairs_per_s * 1e-6);
    else
        detail[0] = '\0';
    cli_progress_update(&d->line, p->done, detail);
    if (strcmp(p->stage, "network") == 0 && p->step > 0 && p->step % d->log_every == 0)
        fit_log_row(&d->log, p);
    return hnbrdf_interrupted();
}

typedef struct job {
    hnbrdf_fit_options fit;
    const char *output, *plot, *log, *json;
    cli_data data;
    int only_new; /* 1: the model written has the materials of data alone */
} job;

static void summarise(const job *j, const hnbrdf_model *model, const hnbrdf_fit_report *report)
{
    FILE *words = cli_words();
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    fprintf(words, "%s: %s", j->output, hnbrdf_kind_name(desc.kind));
    if (desc.kind != HNBRDF_KIND_GGX)
        fprintf(words, " %dx%d, %s, l = %d", desc.hidden, desc.layers,
                hnbrdf_encoding_name(desc.encoding), desc.latent);
    fprintf(words, ", %d material%s", desc.material_count, desc.material_count == 1 ? "" : "s");
    if (j->fit.freeze) {
        int replaced = j->only_new ? 0
                                   : hnbrdf_model_material_count(j->fit.freeze) + j->data.count -
                                         desc.material_count;
        fprintf(words, " (%d fitted on a frozen network, %.2f s each", j->data.count,
                report->seconds / j->data.count);
        if (replaced > 0)
            fprintf(words, ", %d of the same name replaced", replaced);
        fprintf(words, ")");
    }
    if (desc.kind != HNBRDF_KIND_GGX)
        fprintf(words, ", %ld steps, loss %.4f", report->steps, report->final_loss);
    fprintf(words, ", %.1f s\n", report->seconds);
    if (report->redrawn > 0)
        fprintf(words, "memory: %.3g GB of pairs were kept, those of %d material%s drawn again%s\n",
                1e-9 * report->kept, report->redrawn, report->redrawn == 1 ? "" : "s",
                report->ranks > 1 ? ", in the first process" : "");
    cli_print_reading();
    if (report->stopped)
        fprintf(
            words,
            "interrupted; the model so far is saved. Repeat the command with --resume to go on.\n");
}

/* What is odd about the data: a person should know before trusting the model. */
static void tell_about_data(const job *j, const hnbrdf_model *model)
{
    FILE *words = cli_words();
    for (int m = 0; m < j->data.count; m++) {
        const hnbrdf_fit_drawn *d = &j->fit.drawn[m];
        const char *name = hnbrdf_model_material_name(model, m); /* the data's come first */
        if (d->valid < FEW_VALID)
            fprintf(
                words,
                "note: %s: %.3g %% of the directions drawn are valid measurements; what the model "
                "says of the others is a guess\n",
                name, 100.0 * d->valid);
        if (d->cut > 0.0)
            fprintf(
                words,
                "note: %s: %.3g %% of its values are above 1e15 1/sr, the largest %.3g; no BRDF "
                "is, "
                "they were taken as 1e15\n",
                name, 100.0 * d->cut, d->largest);
        if (d->largest <= 0.0)
            fprintf(words, "note: %s: every value is 0, negative ones counted as 0\n", name);
        else if (d->dark >= 1.0)
            fprintf(
                words,
                "note: %s: no value above %.3g 1/sr, which the loss hardly tells from black; is "
                "the "
                "unit 1/sr?\n",
                name, d->largest);
    }
}

/* What the training could not do. */
static void tell_about_training(const hnbrdf_fit_report *r)
{
    FILE *words = cli_words();
    if (r->set_backs > 0)
        fprintf(
            words,
            "note: training diverged %d time%s and went on from its best state at 0.3 times the "
            "rate, in the end %.3g; give a lower --rate\n",
            r->set_backs, r->set_backs == 1 ? "" : "s", r->rate);
    if (r->ggx_alone)
        fprintf(words,
                "note: no state of the training was better than GGX alone, loss %.4f: the network "
                "saved "
                "leaves GGX as it is; give more --steps or a lower --rate\n",
                r->ggx_loss);
    else if (r->best_step < r->steps)
        fprintf(words,
                "note: the state of step %ld is saved, loss %.4f; what came later was worse\n",
                r->best_step, r->best_loss);
    if (r->best_loss > POOR_LOSS)
        fprintf(
            words,
            "note: the model does not follow these data: loss %.2f, where 0 is perfect and 2 the "
            "worst\n",
            r->best_loss);
}

/* Which materials the network makes worse, and what was done. */
static void tell_about_worth(const job *j, const hnbrdf_model *model, const hnbrdf_fit_report *r)
{
    for (int m = 0; m < j->data.count && r->left_alone + r->worse > 0; m++) {
        const hnbrdf_fit_worth *w = &j->fit.worth[m];
        if (w->worse)
            fprintf(cli_words(),
                    "note: %s: with the network it is worse than GGX alone: SMAPE %.4f (GGX "
                    "%.4f), pictures %+.1f dB; %s\n",
                    hnbrdf_model_material_name(model, m), w->smape, w->ggx_smape,
                    10.0 * log10(w->ggx_picture / w->picture),
                    w->alone ? "its latent code turns the network off"
                             : "this network cannot be turned off for one material");
    }
}

static int write_speed(const job *j, const hnbrdf_fit_report *report)
{
    bench_speed speed = bench_speed_of(report);
    bench_speed_print(&speed, cli_words());
    if (!j->json)
        return CLI_OK;
    cli_output output;
    if (cli_output_open(j->json, &output) != CLI_OK)
        return CLI_FAILURE;
    bench_speed_write_json(&speed, output.file);
    return cli_output_close(&output);
}

/* *model with its first materials, those of the data, alone. */
static hnbrdf_result keep_new(const job *j, hnbrdf_model **model, hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model *kept = NULL;
    hnbrdf_model_describe(*model, &desc);
    desc.material_count = j->data.count;
    hnbrdf_result result = hnbrdf_model_create(&desc, NULL, &kept, error);
    if (!result) {
        hnbrdf_model_free(*model);
        *model = kept;
    }
    return result;
}

/* Fit and save. The checkpoint stays only after an interruption. */
static int run(job *j)
{
    const int first = cli_rank() == 0;
    display d = {.stage = NULL, .log_every = j->fit.freeze ? 1 : 100};
    hnbrdf_model *model = NULL;
    hnbrdf_fit_report report;
    hnbrdf_error error;
    int code = cli_code(
        fit_log_open(first ? j->log : NULL, j->fit.resume, &d.curve, &d.log, &error), &error);
    if (code)
        return code;
    j->fit.progress = show;
    j->fit.progress_user = &d;
    hnbrdf_catch_interrupts(1);
    hnbrdf_result result = hnbrdf_fit((const hnbrdf_measured *const *)j->data.items, j->data.count,
                                      &j->fit, &model, &report, &error);
    hnbrdf_catch_interrupts(0);
    if (d.stage)
        cli_progress_end(&d.line);
    if (!result && j->only_new)
        result = keep_new(j, &model, &error);
    if (!result && first)
        result = hnbrdf_model_save(model, j->output, &error);
    if (result == HNBRDF_ERROR_CANCELLED) {
        code = cli_fail("interrupted before the network's first step; %s is as it was", j->output);
    } else if (result) {
        code = cli_fail("%s", error.text);
    } else {
        summarise(j, model, &report);
        tell_about_data(j, model);
        tell_about_training(&report);
        tell_about_worth(j, model, &report);
        if (!report.stopped && first)
            remove(j->fit.checkpoint);
        code = first ? write_speed(j, &report) : CLI_OK;
    }
    if (cli_code(fit_log_close(&d.log, !result, &error), &error))
        code = CLI_FAILURE;
    if (!code && j->plot && first)
        code = cli_code(loss_curve_plot(&d.curve, "training loss, running mean", j->plot, &error),
                        &error);
    loss_curve_free(&d.curve);
    hnbrdf_model_free(model);
    return code;
}

static int open_and_run(job *j, const char *freeze, char *const *data, int count)
{
    cli_source source = {NULL, NULL};
    int code = CLI_OK;
    size_t length = strlen(j->output);
    char *checkpoint = malloc(length + sizeof ".checkpoint");
    if (!checkpoint)
        return cli_fail("out of memory");
    memcpy(checkpoint, j->output, length);
    memcpy(checkpoint + length, ".checkpoint", sizeof ".checkpoint");
    j->fit.checkpoint = checkpoint;
    if (freeze && !(code = cli_open_source(freeze, &source)) && !source.model)
        code = cli_fail("%s: a measured file, expected a model to freeze", freeze);
    j->fit.freeze = source.model;
    j->only_new = freeze && cli_is_universal(freeze);
    j->fit.ranks = cli_ranks();
    code = cli_ranks_agree(code);
    if (!code && !(code = cli_open_data_of_ranks(data, count, &j->data))) {
        j->fit.drawn = calloc((size_t)j->data.count, sizeof *j->fit.drawn);
        j->fit.worth = calloc((size_t)j->data.count, sizeof *j->fit.worth);
        code = j->fit.drawn && j->fit.worth ? run(j) : cli_fail("out of memory");
        free(j->fit.drawn);
        free(j->fit.worth);
        cli_close_data(&j->data);
    }
    cli_close_source(&source);
    free(checkpoint);
    return code;
}

int cmd_fit(int argc, char **argv)
{
    const char *freeze = NULL, *log = NULL, *plot = NULL, *json = NULL;
    const char *output = NULL;
    int resume = 0;
    cli_word kind = {HNBRDF_KIND_HYBRID, cli_kind_word}, encoding = {-1, cli_encoding_word};
    cli_word analytic = {HNBRDF_FIT_FAITHFUL, cli_analytic_word};
    cli_word loss = {HNBRDF_FIT_LOG_TO_SMAPE, cli_loss_word};
    cli_word schedule = {HNBRDF_FIT_COSINE, cli_schedule_word};
    double uniform_share = 0.667, bright_share = 0.25, horizon_share = 0.03, lift = 1.0;
    int net[2] = {0, 0};
    long latent = 0, steps = 0, seed = 1, threads = 0, batch = 0, pool = 0;
    double seconds = 0.0, floor = 0.003, rate = 0.0, memory = 0.0;
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_MODEL, &output, 0, 0, "FILE",
         "the model file to write (required)"},
        {"kind", 0, CLI_WORD, &kind, 0, 0, "KIND", "hybrid, neural or ggx (default hybrid)"},
        {"net", 0, CLI_NET, net, 0, 0, "HxN", "N hidden layers of H units (default 32x2)"},
        {"latent", 0, CLI_INT, &latent, 1, HNBRDF_MAX_LATENT, "L",
         "floats of latent code a material (default 4; neural: 12)"},
        {"encoding", 0, CLI_WORD, &encoding, 0, 0, "NAME",
         "angles (reciprocal), angles-directed, angles-anisotropic, angles-azimuths, "
         "half-difference or directions (default: angles for reciprocal data, else "
         "angles-directed; angles-azimuths if a material is anisotropic)"},
        {"analytic", 0, CLI_WORD, &analytic, 0, 0, "HOW",
         "faithful: keep the GGX fit; joint: train it along (default faithful)"},
        {"floor", 0, CLI_REAL, &floor, 0, 0.999, "B",
         "the floor b, 1/sr; 0 for none (default 0.003)"},
        {"steps", 0, CLI_INT, &steps, 1, 1e9, "N", "training steps (default 32000)"},
        {"seconds", 0, CLI_REAL, &seconds, 0.1, 1e7, "S",
         "train the network for this long instead"},
        {"batch", 0, CLI_INT, &batch, 1, 1 << 24, "N", "direction pairs a step (default 2048)"},
        {"pool", 0, CLI_INT, &pool, 64, 1 << 26, "N",
         "direction pairs drawn a material (default 131072; with --freeze 16384)"},
        {"memory", 0, CLI_REAL, &memory, 1e-6, 1e9, "GB",
         "keep so much of pairs, 72 bytes each, in a process; the others are drawn again when they "
         "are wanted: the same model, later (default: keep all, 1.25 GB unless --pool is given)"},
        {"rate", 0, CLI_REAL, &rate, 1e-7, 10, "R",
         "peak learning rate, of the network's weights twice that (default 0.06; beyond 64 hidden "
         "units in all, in inverse "
         "proportion to them)"},
        {"loss", 0, CLI_WORD, &loss, 0, 0, "NAME",
         "log-to-smape: log-L1 that turns into SMAPE between 30 and 70 %; log; smape (default the "
         "first)"},
        {"schedule", 0, CLI_WORD, &schedule, 0, 0, "NAME",
         "of the rate: cosine or linear down to 0.01 %, or constant (default cosine)"},
        {"uniform-share", 0, CLI_REAL, &uniform_share, 0, 1, "S",
         "of the rest, drawn uniformly, the others on MERL's grid (default 0.667)"},
        {"horizon-share", 0, CLI_REAL, &horizon_share, 0, 1, "S",
         "of the pairs, drawn near the horizon, beyond what was measured, where all are held to an "
         "albedo below 1; 0: the data as they are read (default 0.03)"},
        {"bright-share", 0, CLI_REAL, &bright_share, 0, 1, "S",
         "of the other pairs, drawn where a picture of the material is bright (default 0.25)"},
        {"lift", 0, CLI_REAL, &lift, 0, 1, "L",
         "how strongly the correction is pulled up where GGX is too low: as if it were at least L "
         "of GGX; 0: the plain gradient (default 1)"},
        {"seed", 0, CLI_INT, &seed, 0, 9e15, "N", "seed of everything random (default 1)"},
        {"freeze", 0, CLI_READ, &freeze, 0, 0, "MODEL",
         "keep this model's network, fit only the new materials; `universal` is a network that "
         "the command has in itself: MODEL.safetensors then holds the new ones alone (default "
         "steps 48; --rate, --batch "
         "and --schedule "
         "have no say)"},
        {"resume", 0, CLI_FLAG, &resume, 0, 0, NULL,
         "go on from OUTPUT.checkpoint of an interrupted fit, and with its --log"},
        {"log", 0, CLI_WRITE_TEXT, &log, 0, 0, "FILE",
         "write step,share,loss,pairs_per_s as CSV, a row every 100 steps; with --freeze every "
         "step"},
        {"plot", 0, CLI_WRITE_TEXT, &plot, 0, 0, "FILE", "write the course of the loss as an SVG"},
        {"json", 0, CLI_WRITE_TEXT, &json, 0, 0, "FILE",
         "write speed, the machine's limit and where the time went as JSON; - is standard output"},
        {"threads", 0, CLI_INT, &threads, 1, 256, "N", "threads (default one a core)"},
        CLI_READING_OPTIONS,
        {0},
    };
    int given;
    int code = cli_parse(&command, options, argc, argv, &given);
    if (code >= 0)
        return code;
    if (given == 0)
        return cli_usage(&command, "no DATA given");
    if (!output)
        return cli_usage(&command, "no output file given, expected -o MODEL.safetensors");
    if (freeze && (net[0] || latent || encoding.value >= 0))
        return cli_usage(&command,
                         "--net, --latent and --encoding are those of the model to --freeze");
    if (steps && seconds > 0.0)
        return cli_usage(&command, "--steps and --seconds exclude each other");

    job j = {0};
    j.output = output;
    j.plot = plot;
    j.log = log;
    j.json = json;
    j.fit.kind = (hnbrdf_kind)kind.value;
    j.fit.hidden = net[0];
    j.fit.layers = net[1];
    j.fit.latent = (int)latent;
    j.fit.encoding = encoding.value < 0 ? NULL : cli_encoding_word(encoding.value);
    j.fit.floor = (float)floor;
    j.fit.floor_none = j.fit.floor == 0.0f;
    j.fit.analytic = (hnbrdf_fit_analytic)analytic.value;
    j.fit.steps = steps;
    j.fit.seconds = seconds;
    j.fit.batch = (int)batch;
    j.fit.pool = (int)pool;
    j.fit.memory = (size_t)(1e9 * memory);
    j.fit.learning_rate = (float)rate;
    j.fit.loss = (hnbrdf_fit_loss)loss.value;
    j.fit.schedule = (hnbrdf_fit_schedule)schedule.value;
    j.fit.uniform_share = (float)uniform_share;
    j.fit.uniform_none = j.fit.uniform_share == 0.0f;
    j.fit.horizon_share = (float)horizon_share;
    j.fit.horizon_none = j.fit.horizon_share == 0.0f;
    j.fit.bright_share = (float)bright_share;
    j.fit.bright_none = j.fit.bright_share == 0.0f;
    j.fit.lift = (float)lift;
    j.fit.lift_none = j.fit.lift == 0.0f;
    j.fit.seed = (uint64_t)seed;
    j.fit.threads = (int)threads;
    j.fit.resume = resume;
    return open_and_run(&j, freeze, argv + 1, given);
}
