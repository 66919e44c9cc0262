/* cmd_report.c: `hnbrdf report accuracy`: the error of a grid of networks and baselines, as
 * tables and plots. */
#include "cli/ranks.h"
#include "cli/report.h"
#include "cli/words.h"

#include "base/interrupt.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "report",
    "accuracy DATA... -o DIR [options]",
    "Trains a grid of networks on the same data with the same trainer, and measures them: the "
    "hybrid; "
    "the\n"
    "paper's form of it (encoding directions, no floor); neural models that store as many numbers "
    "a\n"
    "material (l = 4 against 12, 8 against 16); GGX alone. DIR gets report.md, accuracy.csv (a row "
    "a "
    "model),\n"
    "materials.csv (a row a material and model), ggx.csv and ggx.svg (how the fits of GGX went),\n"
    "errors-NET.svg, and the models in models/. Beside SMAPE stand PSNR and FLIP of spheres\n"
    "under the built-in sky.\n"
    "`hnbrdf report images --help`, `report sampling --help` and `report editing --help` tell "
    "about\n"
    "the other reports.\n"
    "Everything is written anew after each model: what an interrupted run has done stays, and "
    "--resume\n"
    "goes on with it. A model made with other settings is not reused.\n"
    "With --paper it looks which of the paper's databases the data are: MERL by the checksums of "
    "the\n"
    "files, RGL and UTIA by their names. What the paper prints then stands beside ours, with what\n"
    "differs; --published and --nbrdf add rows for networks that others have published.\n"
    "`mpirun -n N hnbrdf report accuracy ...` shares the models among N processes that see the "
    "same\n"
    "DIR; each reads all data.",
    "hnbrdf report accuracy builtin --quick -o quick\n"
    "hnbrdf report accuracy rgl/ --seconds 300 --sampler uniform -o rgl-report\n"
    "hnbrdf report accuracy merl/ --paper --published brdf/ --steps 40000 -o paper\n"
    "hnbrdf report accuracy merl/ --seconds 600 --latents 4 --nets 16x2,32x2 --resume -o "
    "merl-report",
};

/* ---- Output ---------------------------------------------------------------------------------- */

static void print_entry(const report *r, const report_entry *e)
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
}

static hnbrdf_result finished(const report *r, const report_entry *e)
{
    cli_progress_end(r->watch.user);
    print_entry(r, e);
    return report_write_accuracy_files(r);
}

/* ---- Command --------------------------------------------------------------------------------- */

/* What --published and --nbrdf name. */
typedef struct outside_paths {
    const char *published, *nbrdf;
} outside_paths;

static int open_outside(report *r, const outside_paths *paths, cli_data *nbrdf)
{
    char *folder = (char *)paths->nbrdf;
    int code = paths->published ? cli_open_published(paths->published, &r->published) : CLI_OK;
    if (code == CLI_OK && folder)
        code = cli_open_data(&folder, 1, nbrdf);
    for (int k = 0; k < nbrdf->count && code == CLI_OK; k++)
        if (hnbrdf_measured_format_of(nbrdf->items[k]) != HNBRDF_MEASURED_NBRDF)
            code =
                cli_fail("%s: %s is %s, expected networks of Neural-BRDF", folder,
                         hnbrdf_measured_name(nbrdf->items[k]),
                         hnbrdf_measured_format_name(hnbrdf_measured_format_of(nbrdf->items[k])));
    r->nbrdf = (report_data){nbrdf->items, nbrdf->count};
    return code;
}

static int run(report *r, char **arguments, int count, const outside_paths *paths)
{
    cli_data data = {0}, nbrdf = {0};
    cli_progress progress;
    hnbrdf_error error;
    int own = cli_open_data(arguments, count, &data);
    if (own == CLI_OK)
        own = open_outside(r, paths, &nbrdf);
    int code = cli_ranks_agree(own);
    if (code != CLI_OK) {
        cli_close_data(&data);
        cli_close_data(&nbrdf);
        hnbrdf_model_free(r->published);
        return code;
    }
    r->ranks = cli_ranks();
    r->data = (report_data){data.items, data.count};
    r->watch = cli_watch(&progress);
    r->error = &error;
    cli_progress_begin(&progress, "report");
    hnbrdf_catch_interrupts(1);
    hnbrdf_result result = report_make_folders(r, "models");
    if (result == HNBRDF_OK)
        result = report_make_entries(r);
    if (result == HNBRDF_OK)
        result = report_measure_outside(r);
    if (result == HNBRDF_OK)
        result = report_run(r, finished);
    hnbrdf_catch_interrupts(0);
    cli_progress_end(&progress);
    code = cli_code(result, &error);
    if (code == CLI_OK && r->paper)
        report_write_paper(r, stdout);
    if (code == CLI_OK)
        printf("\n%s/report.md: tables and plots; SMAPE, 0 is perfect, 2 the worst\n",
               r->directory);
    report_free_entries(r);
    cli_close_data(&data);
    cli_close_data(&nbrdf);
    hnbrdf_model_free(r->published);
    return code;
}

/* What --quick stands for, where nothing else is asked for. */
static void fill_defaults(report *r, int quick, const char **nets, const char **latents)
{
    if (!*nets)
        *nets = quick ? "16x2" : "16x2,16x3,32x2,32x3,64x2,64x3";
    if (!*latents)
        *latents = quick || r->paper ? "4" : "4,8";
    if (!r->pairs)
        r->pairs = quick ? 5000 : 200000;
    if (!r->steps && r->budget == 0.0 && quick)
        r->steps = 300;
    if (!r->pool && quick)
        r->pool = 8192;
}

int cmd_report(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "accuracy") != 0 && cli_ranks())
        return cli_fail("report %s is done by one process, but was started in %d", argv[1],
                        cli_rank_count());
    if (argc > 1 && strcmp(argv[1], "images") == 0)
        return cmd_report_images(argc, argv);
    if (argc > 1 && strcmp(argv[1], "sampling") == 0)
        return cmd_report_sampling(argc, argv);
    if (argc > 1 && strcmp(argv[1], "editing") == 0)
        return cmd_report_editing(argc, argv);
    report r = {.seed = 1,
                .image_size = 64,
                .light = PICTURE_DEFAULTS(REPORT_IMAGE_SAMPLES),
                .flip = {.exposure = NAN}};
    const char *nets = NULL, *latents = NULL, *models = "hybrid,paper,neural";
    cli_word sampler = {HNBRDF_SAMPLER_GRID, cli_sampler_word};
    cli_word analytic = {HNBRDF_FIT_FAITHFUL, cli_analytic_word};
    outside_paths outside = {0};
    int quick = 0, count;
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_FOLDER, &r.directory, 0, 0, "DIR",
         "the folder to write (required); made if missing"},
        {"nets", 0, CLI_TEXT, &nets, 0, 0, "LIST", "default 16x2,16x3,32x2,32x3,64x2,64x3"},
        {"latents", 0, CLI_TEXT, &latents, 0, 0, "LIST",
         "latent sizes of the hybrids (default 4,8)"},
        {"models", 0, CLI_TEXT, &models, 0, 0, "LIST",
         "of hybrid, paper and neural (default all); GGX always"},
        {"paper", 0, CLI_FLAG, &r.paper, 0, 0, NULL,
         "our figures beside those that the paper prints of these data; latents 4"},
        {"published", 0, CLI_TEXT, &outside.published, 0, 0, "DIR|MODEL",
         "with --paper: the paper's own networks, a folder of .brdf or what `import` made of them"},
        {"nbrdf", 0, CLI_TEXT, &outside.nbrdf, 0, 0, "DIR",
         "with --paper: networks of Neural-BRDF for the same materials, by their names"},
        {"seconds", 0, CLI_REAL, &r.budget, 0.1, 1e6, "S",
         "train each network this long (default: by steps)"},
        {"steps", 0, CLI_INT, &r.steps, 1, 1e9, "N",
         "train each network so many steps (default: as `fit`)"},
        {"analytic", 0, CLI_WORD, &analytic, 0, 0, "faithful|joint",
         "analytic part of the hybrids: keep the GGX fit, or train it along (default faithful)"},
        {"sampler", 0, CLI_WORD, &sampler, 0, 0, "uniform|cosine|grid",
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
    char *line = report_join(argc, argv);
    int result =
        line ? cli_parse(&command, options, argc, argv, &count) : cli_fail("out of memory");
    r.command_line = line;
    r.sampler = sampler.value;
    r.analytic = analytic.value;
    if (result < 0 && count < 1)
        result =
            cli_usage(&command, "no report named, expected accuracy, images, sampling or editing");
    if (result < 0 && strcmp(argv[1], "accuracy") != 0)
        result = cli_usage(
            &command, "no report is called '%s', expected accuracy, images, sampling or editing",
            argv[1]);
    if (result < 0 && count < 2)
        result = cli_usage(&command, "no DATA given");
    if (result < 0 && !r.directory)
        result = cli_usage(&command, "no folder given, expected -o DIR");
    if (result < 0 && r.steps && r.budget > 0.0)
        result = cli_usage(&command, "--steps and --seconds exclude each other");
    if (result < 0 && !r.paper && (outside.published || outside.nbrdf))
        result = cli_usage(&command, "--published and --nbrdf belong to --paper");
    cli_read.merl_identify |= r.paper;
    fill_defaults(&r, quick, &nets, &latents);
    if (result < 0)
        result = report_read_nets(&command, nets, &r);
    if (result < 0)
        result = report_read_latents(&command, latents, &r);
    if (result < 0)
        result = report_read_models(&command, models, &r);
    if (result < 0)
        result = run(&r, argv + 2, count - 1, &outside);
    free(line);
    return result;
}
