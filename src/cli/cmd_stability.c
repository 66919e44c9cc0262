/* cmd_stability.c: `hnbrdf stability`: every implementation against the oracle, where floats are
 * hard pressed. */
#include "cli/cli.h"
#include "base/text.h"
#include "image/image.h"
#include "report/stability_plot.h"
#include "report/stability_report.h"
#ifdef HNBRDF_WITH_VULKAN
#include "gpu/stability.h"
#else
enum { STABILITY_GPU_BACKENDS = 0 };
#endif

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "stability",
    "MODEL... [--blocks N] [--device N|all|none] [--all]\n"
    "              [--csv FILE] [--json FILE] [--plot FILE.png]",
    "How far from the true value is what the library computes? The formulas in 113 bits (where the "
    "compiler\n"
    "has them) against C, singly and in batches, in every rounding mode and with subnormals "
    "flushed, "
    "over\n"
    "roughness 1e-4 to 1, needles of 1e4:1, half vectors at the normal and the horizon, cosines to "
    "1e-38,\n"
    "eta to 1 + 2^-23, latent codes and weights until they overflow, directions that are not unit, "
    "NaN "
    "and\n"
    "infinity everywhere, and sampling at both ends of its random numbers.\n"
    "\n"
    "Exit status 0 only if no number is negative or not finite and every bar is kept.",
    "hnbrdf stability model.safetensors\n"
    "hnbrdf stability a.safetensors b.safetensors --all --csv stability.csv",
};

typedef struct settings {
    const char *csv, *json, *device, *plot;
    long blocks;
    int all, styles;
} settings;

static void on_progress(void *user, double share)
{
    cli_progress_update(user, share, "");
}

/* Everything that is compared. */
typedef struct contest {
    stability_backend backends[STABILITY_C_BACKENDS + STABILITY_GPU_BACKENDS];
    int count;
    struct stability_gpus *gpus;
} contest;

static int run_model(const char *path, const settings *set, contest *c, stability_result *result)
{
    hnbrdf_error error;
    hnbrdf_model *model;
    cli_progress progress;
    const stability_options options = {
        .blocks = (int)set->blocks, .progress = on_progress, .progress_user = &progress};
    if (cli_open_model(path, &model) != CLI_OK)
        return CLI_FAILURE;
    result->path = path;
    result->backend_count = c->count;
    result->rows =
        calloc((size_t)(stability_case_count * c->count * STABILITY_STAGES), sizeof *result->rows);
    cli_progress_begin(&progress, "stability");
    hnbrdf_result code = HNBRDF_ERROR_MEMORY;
    snprintf(error.text, sizeof error.text, "out of memory");
    if (result->rows)
        code = stability_run(model, &options, c->backends, c->count, result->rows, &error);
    cli_progress_end(&progress);
    int failed = code == HNBRDF_OK ? CLI_OK : cli_fail("%s: %s", path, error.text);
    if (!failed && set->plot)
        failed =
            cli_code(stability_plot(set->plot, model, path, c->backends, c->count, &error), &error);
    hnbrdf_model_free(model);
    return failed;
}

#ifdef HNBRDF_WITH_VULKAN
static int add_gpus(const settings *set, contest *c)
{
    hnbrdf_error error;
    char note[128] = "";
    int count = 0;
    hnbrdf_result result = stability_gpus_open(set->device, set->styles, &c->gpus,
                                               c->backends + c->count, &count, note, &error);
    c->count += count;
    if (result != HNBRDF_OK) {
        cli_fail("%s", error.text);
        return result == HNBRDF_ERROR_ARGUMENT ? CLI_USAGE : CLI_FAILURE;
    }
    if (note[0])
        fprintf(stderr, "%s\n", note);
    return CLI_OK;
}
#else
static int add_gpus(const settings *set, contest *c)
{
    (void)set;
    (void)c;
    fputs("no GPU: this program was built without Vulkan\n", stderr);
    return CLI_OK;
}

static void stability_gpus_close(struct stability_gpus *gpus)
{
    (void)gpus;
}
#endif

static int compare_all(char **paths, int count, const settings *set, stability_result *results)
{
    contest c = {.count = 0};
    c.count = stability_c_backends(c.backends);
    int code = add_gpus(set, &c);
    for (int m = 0; m < count && code == CLI_OK; m++)
        code = run_model(paths[m], set, &c, &results[m]);
    stability_gpus_close(c.gpus);
    return code;
}

static int run(char **paths, int count, const settings *set, stability_result *results)
{
    int code = compare_all(paths, count, set, results);
    if (code != CLI_OK)
        return code;
    const stability_results all = {results, count};
    if (!cli_is_stdout(set->csv) && !cli_is_stdout(set->json))
        stability_print(results, count, !set->all, stdout);
    if (cli_write_file(set->csv, stability_write_csv, &all) != CLI_OK ||
        cli_write_file(set->json, stability_write_json, &all) != CLI_OK)
        return CLI_FAILURE;
    return stability_passed(results, count) ? CLI_OK : CLI_FAILURE;
}

int cmd_stability(int argc, char **argv)
{
    settings set = {.blocks = 32, .device = "all"};
    const cli_option options[] = {
        {"blocks", 0, CLI_INT, &set.blocks, 1, 100000, "N",
         "64 evaluations each, per case; default 32"},
        {"device", 'd', CLI_TEXT, &set.device, 0, 0, "N|all|none",
         "Vulkan devices to include; default all"},
        {"styles", 0, CLI_FLAG, &set.styles, 0, 0, NULL,
         "every style of weights in shaders (default: constants alone)"},
        {"all", 0, CLI_FLAG, &set.all, 0, 0, NULL,
         "print every backend and the places (default: the worst backend)"},
        {"csv", 0, CLI_WRITE_TEXT, &set.csv, 0, 0, "FILE",
         "every row as CSV; - is stdout, then without the table"},
        {"json", 0, CLI_WRITE_TEXT, &set.json, 0, 0, "FILE", "the same as JSON"},
        {"plot", 0, CLI_WRITE_PICTURE, &set.plot, 0, 0, "FILE.png",
         "heat maps of the error over half vector and alpha, over both cosines"},
        {0},
    };
    int count, code = cli_parse(&command, options, argc, argv, &count);
    if (code >= 0)
        return code;
    if (count < 1)
        return cli_usage(&command, "no MODEL to examine");
    if (set.plot && (count > 1 || !hnbrdf_ends_with(set.plot, ".png")))
        return cli_usage(&command, "--plot: expected one MODEL and a name ending in .png");
    stability_result *results = calloc((size_t)count, sizeof *results);
    code = results ? run(argv + 1, count, &set, results) : cli_fail("out of memory");
    for (int m = 0; m < count && results; m++)
        free(results[m].rows);
    free(results);
    return code;
}
