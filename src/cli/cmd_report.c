/* cmd_report.c: `hnbrdf report accuracy`: the error of a grid of networks and baselines, as tables and
 * plots. */
#include "cli/report.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const cli_command command = {
    "report",
    "accuracy DATA... -o DIR [options]",
    "Trains a grid of networks on the same data with the same trainer, and measures them: the hybrid; "
    "the\n"
    "paper's form of it (encoding directions, no floor); neural models that store as many numbers a\n"
    "material (l = 4 against 12, 8 against 16); GGX alone. DIR gets report.md, accuracy.csv (a row a "
    "model),\n"
    "materials.csv (a row a material and model), ggx.csv and ggx.svg (how the fits of GGX went),\n"
    "errors-NET.svg, and the models in models/. Beside SMAPE stands the PSNR of spheres under the\n"
    "built-in sky.\n"
    "Everything is written anew after each model: what an interrupted run has done stays, and "
    "--resume\n"
    "goes on with it. A model made with other settings is not reused.",
    "hnbrdf report accuracy builtin --quick -o quick\n"
    "hnbrdf report accuracy rgl/ --seconds 300 --sampler uniform -o rgl-report\n"
    "hnbrdf report accuracy merl/ --seconds 600 --latents 4 --nets 16x2,32x2 --resume -o merl-report",
};

/* ---- Lists --------------------------------------------------------------------------------------- */

static int read_nets(const char *list, report *r)
{
    for (const char *at = list;; at++) {
        int *net = r->nets[r->net_count], length = 0;
        if (r->net_count == REPORT_NETS)
            return cli_usage(&command, "--nets: more than %d", (int)REPORT_NETS);
        if (sscanf(at, "%2dx%1d%n", &net[0], &net[1], &length) != 2 || net[0] < 1 ||
            net[0] > HNBRDF_MAX_HIDDEN || net[1] < 1 || net[1] > HNBRDF_MAX_LAYERS ||
            (at[length] != ',' && at[length] != '\0'))
            return cli_usage(&command,
                             "--nets: '%s' is not HxN,HxN,... with H from 1 to %d and N from 1 to %d",
                             list, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
        for (int k = 0; k < r->net_count; k++)
            if (r->nets[k][0] == net[0] && r->nets[k][1] == net[1])
                return cli_usage(&command, "--nets: %dx%d is there twice", net[0], net[1]);
        r->net_count++;
        at += length;
        if (*at == '\0')
            return -1;
    }
}

static int read_latents(const char *list, report *r)
{
    int most = HNBRDF_MAX_LATENT - REPORT_ANALYTIC_NUMBERS;
    for (const char *at = list;; at++) {
        int value = 0, length = 0;
        if (r->latent_count == REPORT_LATENTS)
            return cli_usage(&command, "--latents: more than %d", (int)REPORT_LATENTS);
        if (sscanf(at, "%2d%n", &value, &length) != 1 || value < 1 || value > most ||
            (at[length] != ',' && at[length] != '\0'))
            return cli_usage(&command, "--latents: '%s' is not a list of whole numbers from 1 to %d",
                             list, most);
        for (int k = 0; k < r->latent_count; k++)
            if (r->latents[k] == value)
                return cli_usage(&command, "--latents: %d is there twice", value);
        r->latents[r->latent_count++] = value;
        at += length;
        if (*at == '\0')
            return -1;
    }
}

static int read_models(const char *list, report *r)
{
    r->forms[REPORT_GGX] = 1;
    while (*list) {
        size_t length = strcspn(list, ",");
        report_form form = REPORT_GGX;
        while (report_form_name(form) && (strlen(report_form_name(form)) != length ||
                                          strncmp(list, report_form_name(form), length) != 0))
            form++;
        if (!report_form_name(form))
            return cli_usage(&command, "--models: '%.*s', expected hybrid, paper or neural",
                             (int)length, list);
        r->forms[form] = 1;
        list += length + (list[length] == ',');
    }
    return -1;
}

/* The command as it was typed; cli_parse() moves its arguments about. NULL when memory is short. */
static char *join(int argc, char **argv)
{
    size_t size = sizeof "hnbrdf";
    for (int k = 0; k < argc; k++)
        size += strlen(argv[k]) + 1;
    char *text = malloc(size);
    if (!text)
        return NULL;
    size_t at = (size_t)snprintf(text, size, "hnbrdf");
    for (int k = 0; k < argc; k++)
        at += (size_t)snprintf(text + at, size - at, " %s", argv[k]);
    return text;
}

/* ---- Output -------------------------------------------------------------------------------------- */

static int make_directory(const char *path)
{
    struct stat status;
    if (mkdir(path, 0777) == 0 ||
        (errno == EEXIST && stat(path, &status) == 0 && S_ISDIR(status.st_mode)))
        return CLI_OK;
    return cli_fail("%s: cannot make this folder: %s", path, strerror(errno));
}

static int make_directories(const report *r)
{
    char *path = report_path(r, "", "");
    int result = path ? make_directory(r->directory) : CLI_FAILURE;
    if (result == CLI_OK) {
        path[strlen(path) - 2] = '\0'; /* the "/." behind models */
        result = make_directory(path);
    }
    free(path);
    return result;
}

/* Opens NAME in the report's folder. */
static int open_result(const report *r, const char *name, cli_output *output)
{
    size_t size = strlen(r->directory) + strlen(name) + 2;
    char *path = malloc(size);
    if (!path)
        return cli_fail("out of memory");
    snprintf(path, size, "%s/%s", r->directory, name);
    int result = cli_output_open(path, output);
    free(path);
    return result;
}

static int write_result(const report *r, const char *name, void (*write)(const report *r, FILE *file))
{
    cli_output output;
    if (open_result(r, name, &output) != CLI_OK)
        return CLI_FAILURE;
    write(r, output.file);
    return cli_output_close(&output);
}

static int write_plot(const report *r, const int net[2])
{
    char name[32];
    cli_output output;
    snprintf(name, sizeof name, "errors-%dx%d.svg", net[0], net[1]);
    if (open_result(r, name, &output) != CLI_OK)
        return CLI_FAILURE;
    report_write_plot(r, net, output.file);
    return cli_output_close(&output);
}

static int write_results(const report *r)
{
    int result = write_result(r, "accuracy.csv", report_write_accuracy);
    if (result == CLI_OK)
        result = write_result(r, "materials.csv", report_write_materials);
    if (result == CLI_OK)
        result = write_result(r, "ggx.csv", report_write_ggx);
    if (result == CLI_OK)
        result = write_result(r, "ggx.svg", report_write_ggx_plot);
    if (result == CLI_OK)
        result = write_result(r, "report.md", report_write_markdown);
    for (int n = 0; n < r->net_count && result == CLI_OK; n++)
        result = write_plot(r, r->nets[n]);
    return result;
}

static int finished(const report *r, const report_entry *e)
{
    if (e == r->entries)
        printf("%-20s  %8s  %8s  %8s  %8s  %8s\n", "model", "grid", "uniform", "cosine",
               r->image_size ? "PSNR" : "", "seconds");
    printf("%-20s  %8.4f  %8.4f  %8.4f  ", e->name, e->mean[HNBRDF_SAMPLER_GRID].smape,
           e->mean[HNBRDF_SAMPLER_UNIFORM].smape, e->mean[HNBRDF_SAMPLER_COSINE].smape);
    if (r->image_size)
        printf("%8.2f  %8.1f\n", e->mean_psnr, e->seconds);
    else
        printf("%8s  %8.1f\n", "", e->seconds);
    fflush(stdout);
    return write_results(r);
}

/* ---- Command ------------------------------------------------------------------------------------- */

static int run(report *r, char **data, int count)
{
    int result = cli_open_data(data, count, &r->data);
    if (result != CLI_OK)
        return result;
    result = make_directories(r);
    if (result == CLI_OK)
        result = report_make_entries(r);
    if (result == CLI_OK)
        result = report_run(r, finished);
    if (result == CLI_OK)
        printf("\n%s/report.md: tables and plots; SMAPE, 0 is perfect, 2 the worst\n", r->directory);
    report_free_entries(r);
    cli_close_data(&r->data);
    return result;
}

/* What --quick stands for, where nothing else is asked for. */
static void fill_defaults(report *r, int quick, const char **nets, const char **latents)
{
    if (!*nets)
        *nets = quick ? "16x2" : "16x2,16x3,32x2,32x3,64x2,64x3";
    if (!*latents)
        *latents = quick ? "4" : "4,8";
    if (!r->pairs)
        r->pairs = quick ? 5000 : 200000;
    if (!r->steps && r->budget == 0.0 && quick)
        r->steps = 300;
    if (!r->pool && quick)
        r->pool = 8192;
}

int cmd_report(int argc, char **argv)
{
    report r = {.sampler = HNBRDF_SAMPLER_GRID, .seed = 1, .image_size = 64};
    const char *nets = NULL, *latents = NULL, *models = "hybrid,paper,neural";
    int quick = 0, count;
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &r.directory, 0, 0, "DIR",
         "the folder to write (required); made if missing"},
        {"nets", 0, CLI_TEXT, &nets, 0, 0, "LIST", "default 16x2,16x3,32x2,32x3,64x2,64x3"},
        {"latents", 0, CLI_TEXT, &latents, 0, 0, "LIST", "latent sizes of the hybrids (default 4,8)"},
        {"models", 0, CLI_TEXT, &models, 0, 0, "LIST",
         "of hybrid, paper and neural (default all); GGX always"},
        {"seconds", 0, CLI_REAL, &r.budget, 0.1, 1e6, "S",
         "train each network this long (default: by steps)"},
        {"steps", 0, CLI_INT, &r.steps, 1, 1e9, "N",
         "train each network so many steps (default: as `fit`)"},
        {"analytic", 0, CLI_CHOICE, &r.analytic, 0, 0, "faithful|joint",
         "analytic part of the hybrids: keep the GGX fit, or train it along (default faithful)"},
        {"sampler", 0, CLI_CHOICE, &r.sampler, 0, 0, "uniform|cosine|grid",
         "of plots, wins and analytic part (default grid); the tables have all three"},
        {"pairs", 'n', CLI_INT, &r.pairs, 1, 1e9, "N",
         "pairs of directions a material (default 200000)"},
        {"images", 0, CLI_INT, &r.image_size, 0, 2048, "N",
         "pixels a side of the spheres whose PSNR is measured; 0: none (default 64)"},
        {"pool", 0, CLI_INT, &r.pool, 64, 1 << 26, "N",
         "direction pairs drawn a material for training"},
        {"seed", 0, CLI_INT, &r.seed, 0, 9e15, "N", "seed of everything random (default 1)"},
        {"resume", 0, CLI_FLAG, &r.resume, 0, 0, NULL,
         "reuse the models in DIR made with the same settings"},
        {"quick", 0, CLI_FLAG, &quick, 0, 0, NULL,
         "a try: 16x2, l = 4, 300 steps, 5000 pairs, unless asked for otherwise"},
        {"threads", 't', CLI_INT, &r.threads, 1, 256, "N", "threads (default one a core)"},
        CLI_READING_OPTIONS,
        {0},
    };
    char *line = join(argc, argv);
    int result = line ? cli_parse(&command, options, argc, argv, &count) : cli_fail("out of memory");
    r.command_line = line;
    if (result < 0 && count < 1)
        result = cli_usage(&command, "no report named, expected accuracy");
    if (result < 0 && strcmp(argv[1], "accuracy") != 0)
        result = cli_usage(&command, "no report is called '%s', expected accuracy", argv[1]);
    if (result < 0 && count < 2)
        result = cli_usage(&command, "no DATA given");
    if (result < 0 && !r.directory)
        result = cli_usage(&command, "no folder given, expected -o DIR");
    if (result < 0 && r.steps && r.budget > 0.0)
        result = cli_usage(&command, "--steps and --seconds exclude each other");
    fill_defaults(&r, quick, &nets, &latents);
    if (result < 0)
        result = read_nets(nets, &r);
    if (result < 0)
        result = read_latents(latents, &r);
    if (result < 0)
        result = read_models(models, &r);
    if (result < 0)
        result = run(&r, argv + 2, count - 1);
    free(line);
    return result;
}
