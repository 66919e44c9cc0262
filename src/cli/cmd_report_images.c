/* cmd_report_images.c: `hnbrdf report images`: PSNR of spheres for a grid of networks and
 * baselines, with picture rows, material by material, so that what an interrupted run has done
 * stays. */
#include "cli/report.h"

#include "base/interrupt.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "report",
    "images DATA... -o DIR [options]",
    "Renders a sphere of every material, measured and of every model, under the same light with "
    "the\n"
    "same random directions, and measures MAE, MSE, PSNR and FLIP: the paper's table of image "
    "errors "
    "for\n"
    "your data. DIR gets images.md, images.csv (a row a material and model), psnr-NET.svg, the\n"
    "models in models/, and picture rows: images-1.png and so on (EXR beside) with the spheres "
    "and\n"
    "their differences in false colours; their radiance lies in pictures/ as EXR. Every figure\n"
    "stands with the standard error that noise leaves, from two renderings of each sphere. The\n"
    "default is the paper's: 512 pixels, 1024 samples, about a minute a sphere on two cores; "
    "--quick\n"
    "is a try. Models come from DIR (--resume), from the folder of a `report accuracy` (--from),\n"
    "from a file (--model), or are fitted. Everything is written anew after each material: what "
    "an\n"
    "interrupted run has done stays, and --resume goes on with it.",
    "hnbrdf report images builtin --quick -o quick\n"
    "hnbrdf report images merl/ --from merl-report --env uffizi.hdr -o merl-images\n"
    "hnbrdf report images merl/ --from merl-report --nets 32x2 --size 128 --spp 64 -o merl-images\n"
    "hnbrdf report images rgl/ --model rgl.safetensors --size 256 --spp 256 -o rgl-images",
};

/* ---- Measuring ------------------------------------------------------------------------------- */

static void print_models(const report *r)
{
    printf("%-20s  %9s  %7s  %16s\n", "model", "MAE", "FLIP", "PSNR, dB");
    for (int k = 0; k < r->count; k++)
        printf("%-20s  %9.5f  %7.4f  %7.2f +- %5.2f\n", r->entries[k].name, r->entries[k].mean_mae,
               r->entries[k].mean_flip, r->entries[k].mean_psnr, r->entries[k].mean_psnr_error);
}

static hnbrdf_result measure_and_write(report *r, hnbrdf_model *const *models)
{
    int same = 0;
    hnbrdf_result result = HNBRDF_OK;
    if (r->resume)
        result = report_images_same_settings(r, models, &same);
    if (result == HNBRDF_OK)
        result = report_make_folders(r, "pictures");
    if (result == HNBRDF_OK && same)
        result = report_images_read_figures(r);
    /* Figures made with other settings are forgotten before the new settings are kept. */
    if (result == HNBRDF_OK && !same)
        result = report_write(r, "images.csv", report_write_images_csv);
    if (result == HNBRDF_OK)
        result = report_images_keep_settings(r, models);
    if (result == HNBRDF_OK)
        result = report_images_open(r);
    if (result == HNBRDF_OK) {
        cli_progress_begin(r->watch.user, "rendering");
        hnbrdf_catch_interrupts(1);
        result = report_images_run(r, models, report_write_image_files);
        cli_progress_end(r->watch.user);
        hnbrdf_catch_interrupts(0);
    }
    if (result == HNBRDF_OK)
        result = report_write_image_files(r);
    if (result == HNBRDF_OK)
        print_models(r);
    if (result == HNBRDF_OK && r->rows > 0 && render_has_exr())
        result = report_rows_write(r);
    else if (result == HNBRDF_OK && r->rows > 0)
        cli_warn("built without OpenEXR: no picture rows");
    report_images_end(r);
    return result;
}

/* ---- Command --------------------------------------------------------------------------------- */

static hnbrdf_result make_models(report *r, hnbrdf_model **models)
{
    cli_progress_begin(r->watch.user, "report");
    hnbrdf_catch_interrupts(1);
    hnbrdf_result result = report_make_models(r, models);
    cli_progress_end(r->watch.user);
    hnbrdf_catch_interrupts(0);
    return result;
}

static int run(report *r, char **arguments, int count)
{
    cli_data data = {0};
    cli_progress progress = {0};
    hnbrdf_error error;
    int code = cli_open_data(arguments, count, &data);
    if (code != CLI_OK)
        return code;
    r->data = (report_data){data.items, data.count};
    r->watch = cli_watch(&progress);
    r->error = &error;
    hnbrdf_model **models = NULL, *given = NULL;
    hnbrdf_result result = HNBRDF_OK;
    if (r->given) /* before anything takes time */
        result = report_load_model(r, r->given, &given);
    hnbrdf_model_free(given);
    if (result == HNBRDF_OK)
        result = report_make_folders(r, "models");
    if (result == HNBRDF_OK)
        result = report_make_entries(r);
    if (result == HNBRDF_OK)
        result = (models = calloc((size_t)r->count, sizeof *models))
                     ? make_models(r, models)
                     : hnbrdf_fail(&error, HNBRDF_ERROR_MEMORY, "out of memory");
    if (result == HNBRDF_OK)
        result = measure_and_write(r, models);
    code = cli_code(result, &error);
    if (code == CLI_OK)
        printf("%s/images.md\n", r->directory);
    for (int k = 0; k < r->count && models; k++)
        hnbrdf_model_free(models[k]);
    free(models);
    report_free_entries(r);
    cli_close_data(&data);
    return code;
}

/* The grid is the one model in this file. Returns -1 to go on, as cli_parse() does. */
static int describe_given(report *r)
{
    hnbrdf_model *model;
    hnbrdf_model_desc desc;
    if (cli_open_model(r->given, &model) != CLI_OK)
        return CLI_FAILURE;
    hnbrdf_model_describe(model, &desc);
    hnbrdf_model_free(model);
    if (desc.kind == HNBRDF_KIND_GGX)
        return cli_fail(
            "%s: GGX alone, which is measured anyway: expected a hybrid or a neural model",
            r->given);
    report_form form = desc.kind == HNBRDF_KIND_NEURAL               ? REPORT_NEURAL
                       : desc.encoding == HNBRDF_ENCODING_DIRECTIONS ? REPORT_PAPER
                                                                     : REPORT_HYBRID;
    r->forms[REPORT_GGX] = r->forms[form] = 1;
    r->nets[0][0] = desc.hidden;
    r->nets[0][1] = desc.layers;
    r->latents[0] = desc.latent - (form == REPORT_NEURAL ? REPORT_ANALYTIC_NUMBERS : 0);
    r->net_count = r->latent_count = 1;
    return -1;
}

static int read_grid(report *r, int quick, const char *nets, const char *latents,
                     const char *models)
{
    if (r->given && (nets || latents || models || r->from))
        return cli_usage(&command,
                         "--model stands for the whole grid: without --nets, --latents, --models, "
                         "--from");
    if (r->given)
        return describe_given(r);
    int code = report_read_nets(&command, nets ? nets : quick ? "16x2" : "16x3,32x3,64x3", r);
    if (code < 0)
        code = report_read_latents(&command, latents ? latents : quick ? "4" : "4,8", r);
    return code < 0 ? report_read_models(&command, models ? models : "hybrid,paper,neural", r)
                    : code;
}

int cmd_report_images(int argc, char **argv)
{
    report r = {.sampler = HNBRDF_SAMPLER_GRID,
                .rows = 24,
                .light = PICTURE_DEFAULTS(0),
                .flip = {.exposure = NAN}};
    const char *nets = NULL, *latents = NULL, *models = NULL;
    int quick = 0, count;
    long fit_seed = 1;
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_FOLDER, &r.directory, 0, 0, "DIR",
         "the folder to write (required); made if missing"},
        {"nets", 0, CLI_TEXT, &nets, 0, 0, "LIST", "default 16x3,32x3,64x3"},
        {"latents", 0, CLI_TEXT, &latents, 0, 0, "LIST",
         "latent sizes of the hybrids (default 4,8)"},
        {"models", 0, CLI_TEXT, &models, 0, 0, "LIST",
         "of hybrid, paper and neural (default all); GGX always"},
        {"model", 0, CLI_READ, &r.given, 0, 0, "FILE",
         "instead of a grid: this model and GGX alone"},
        {"from", 0, CLI_TEXT, &r.from, 0, 0, "DIR2", "take the models from this report's folder"},
        {"steps", 0, CLI_INT, &r.steps, 1, 1e9, "N",
         "train each network so many steps (default: as `fit`)"},
        {"pool", 0, CLI_INT, &r.pool, 64, 1 << 26, "N",
         "direction pairs drawn a material for training"},
        {"fit-seed", 0, CLI_INT, &fit_seed, 0, 9e15, "N", "of the training (default 1)"},
        {"size", 0, CLI_INT, &r.image_size, 8, 4096, "N",
         "pixels of a sphere's side (default 512)"},
        {"spp", 0, CLI_INT, &r.light.spp, 2, 1 << 20, "N",
         "samples a pixel (default 1024); twice a power of 2 is best"},
        {"env", 0, CLI_READ, &r.light.env, 0, 0, "sky|furnace|FILE",
         "light: sky, furnace, or a map .exr or .hdr: lat-long, or an EXR cube"},
        {"layer", 0, CLI_TEXT, &r.light.layer, 0, 0, "NAME", "of an EXR map with several layers"},
        {"repair", 0, CLI_FLAG, &r.light.repair, 0, 0, NULL,
         "pixels of the map that are not finite: mean of those around"},
        {"rotate", 0, CLI_REAL, &r.light.rotate, -360, 360, "DEG",
         "turn the light about the vertical, counter-clockwise from above"},
        {"exposure", 0, CLI_REAL, &r.light.exposure, -64, 64, "EV",
         "of the picture rows, stops; default: mean light as bright as that of the sky"},
        CLI_PPD_OPTION(r.flip),
        {"seed", 0, CLI_INT, &r.light.seed, 0, 1000000000, "N",
         "of the spheres' random numbers (default 1)"},
        {"rows", 0, CLI_INT, &r.rows, 0, 100000, "N",
         "materials in the picture rows, of the last net and first latent size (default 24)"},
        {"resume", 0, CLI_FLAG, &r.resume, 0, 0, NULL,
         "reuse models and figures in DIR made with the same settings"},
        {"quick", 0, CLI_FLAG, &quick, 0, 0, NULL,
         "a try: 16x2, l = 4, 300 steps, 64 pixels, 32 samples, unless asked for otherwise"},
        {"threads", 't', CLI_INT, &r.threads, 1, 256, "N", "threads (default one a core)"},
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {0},
    };
    char *line = report_join(argc, argv);
    int code = line ? cli_parse(&command, options, argc, argv, &count) : cli_fail("out of memory");
    r.command_line = line;
    r.seed = fit_seed;
    if (code < 0 && count < 2)
        code = cli_usage(&command, "no DATA given");
    if (code < 0 && !r.directory)
        code = cli_usage(&command, "no folder given, expected -o DIR");
    if (code < 0)
        code = read_grid(&r, quick, nets, latents, models);
    r.image_size = r.image_size ? r.image_size : quick ? 64 : 512;
    r.light.spp = r.light.spp ? r.light.spp : quick ? 32 : 1024;
    r.steps = r.steps ? r.steps : quick ? 300 : 0;
    r.pool = r.pool ? r.pool : quick ? 8192 : 0;
    if (code < 0)
        code = run(&r, argv + 2, count - 1);
    free(line);
    return code;
}
