/* cmd_compare.c: `hnbrdf compare`: how far a model is from measured materials, one row for each. */
#include "cli/picture.h"
#include "cli/words.h"
#include "report/compare.h"
#include "report/compare_images.h"

#include "base/interrupt.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "compare",
    "MODEL DATA... [--sampler grid] [--pairs N] [--csv FILE]",
    "Prints the error of a model, and of its analytic part (GGX) alone, against measured materials "
    "of\n"
    "the same names: SMAPE, 0 is perfect and 2 the worst, mean over N pairs of directions and "
    "RGB.\n"
    "DATA is builtin, builtin:anisotropic, builtin:NAME, procedural:N, measured files or\n"
    "directories.\n"
    "\n"
    "Samplers: uniform (wi and wo uniform in solid angle), cosine, grid (theta_h = u^2 pi/2, "
    "theta_d "
    "and\n"
    "phi_d uniform, as MERL's own grid). The same seed gives the same pairs, whatever the "
    "threads.\n"
    "CSV columns: material,smape,smape_analytic,pairs; the last row is named mean.\n"
    "\n"
    "With --images, pictures instead: IMAGE... REFERENCE, OpenEXR or Radiance files of one size. "
    "MAE "
    "and "
    "MSE\n"
    "are means over R, G and B of the linear values as they are, without exposure; PSNR takes the "
    "reference's\n"
    "largest value as its peak, as a rendering has no white. Pixels with alpha 0 in both are left "
    "out; "
    "values\n"
    "with alpha are premultiplied and compared so. --difference draws where they differ. FLIP is "
    "what "
    "a\n"
    "person sees of the difference, 0 nothing and 1 the most: our implementation of Andersson et "
    "al. "
    "(2020),\n"
    "not NVIDIA's. As linear pictures have no white, it is the largest over exposures, displayed "
    "through\n"
    "the curve of ACES, as in HDR-FLIP (2021); with --exposure the pictures are displayed as PNG "
    "writes\n"
    "them. Of an OpenEXR file the plain channels are read, or its only layer, converted to linear\n"
    "Rec. 709 and placed in the display window.\n"
    "CSV columns: image,reference,mae,mse,psnr,pixels,flip.",
    "hnbrdf compare model.safetensors builtin\n"
    "hnbrdf compare rgl.safetensors measured/rgl --sampler uniform --pairs 1e6 --csv rgl.csv\n"
    "hnbrdf compare hybrid.safetensors builtin --against ggx.safetensors\n"
    "hnbrdf compare --images hybrid.exr ggx.exr reference.exr --csv -\n"
    "hnbrdf compare --images hybrid.exr reference.exr --difference where.png",
};

/* ---- Command --------------------------------------------------------------------------------- */

static int measure(model_comparison *j, const cli_data *data, int skip_missing, int threads)
{
    cli_progress progress;
    hnbrdf_error error;
    const report_watch watch = cli_watch(&progress);
    hnbrdf_result result = compare_choose(j, data->items, data->count, skip_missing, &error);
    cli_progress_begin(&progress, "comparing");
    if (result == HNBRDF_OK)
        result = compare_measure(j, threads, &watch, &error);
    cli_progress_end(&progress);
    return cli_code(result, &error);
}

static int run(model_comparison *j, char **arguments, int count, int skip_missing, int threads,
               const char *csv, const char *json)
{
    cli_data data = {0};
    hnbrdf_model *model = NULL, *against = NULL;
    int result = cli_open_model(j->path, &model);
    if (result == CLI_OK && j->path_against)
        result = cli_open_model(j->path_against, &against);
    j->model = model;
    j->against = against;
    if (result == CLI_OK)
        result = cli_open_data(arguments, count, &data);
    if (result == CLI_OK)
        result = measure(j, &data, skip_missing, threads);
    if (result == CLI_OK && !cli_is_stdout(csv) && !cli_is_stdout(json)) {
        compare_print(j, stdout);
        cli_print_reading();
        if (against)
            compare_print_wins(j, stdout);
    }
    if (result == CLI_OK)
        result = cli_write_file(csv, compare_write_csv, j);
    if (result == CLI_OK)
        result = cli_write_file(json, compare_write_json, j);
    cli_close_data(&data);
    free(j->rows);
    hnbrdf_model_free(model);
    hnbrdf_model_free(against);
    return result;
}

static int run_images(compare_images_options *pictures)
{
    cli_progress progress;
    hnbrdf_error error;
    pictures->watch = cli_watch(&progress);
    cli_progress_begin(&progress, "comparing");
    hnbrdf_catch_interrupts(1);
    const hnbrdf_result result = compare_images(pictures, &error);
    hnbrdf_catch_interrupts(0);
    cli_progress_end(&progress);
    return cli_code(result, &error);
}

/* Returns -1 to go on, as cli_parse() does. */
static int check_images(int images, const compare_images_options *pictures, int count,
                        int of_models)
{
    if (!images && (pictures->difference || pictures->top > 0.0))
        return cli_usage(&command, "--difference and --scale belong to --images");
    if (!images && (pictures->layer || pictures->repair))
        return cli_usage(&command, "--layer and --repair belong to --images");
    if (!images && (!isnan(pictures->flip.exposure) || pictures->flip.pixels_per_degree > 0.0))
        return cli_usage(&command, "--exposure and --ppd belong to --images");
    if (images && of_models)
        return cli_usage(&command, "--against and --skip-missing are for models, not for --images");
    if (images && count < 2)
        return cli_usage(&command, "--images: found %d picture%s, expected IMAGE... REFERENCE",
                         count, count == 1 ? "" : "s");
    if (images && pictures->difference && count != 2)
        return cli_usage(&command, "--difference: found %d pictures, expected IMAGE REFERENCE",
                         count);
    return pictures->difference ? picture_check_output(&command, pictures->difference) : -1;
}

int cmd_compare(int argc, char **argv)
{
    model_comparison j = {.pairs = 200000, .seed = 1};
    const char *csv = NULL, *json = NULL;
    cli_word sampler = {HNBRDF_SAMPLER_GRID, cli_sampler_word};
    int skip_missing = 0, images = 0, count;
    long threads = 0;
    compare_images_options pictures = {.notes = CLI_NOTES, .flip = {.exposure = NAN}};
    const cli_option options[] = {
        {"sampler", 0, CLI_WORD, &sampler, 0, 0, "NAME", "uniform, cosine or grid (default grid)"},
        {"pairs", 'n', CLI_INT, &j.pairs, 1, 1e10, "N",
         "valid pairs of directions a material (default 200000; 1e6 may be written)"},
        {"seed", 0, CLI_INT, &j.seed, 0, 9007199254740992.0, "N",
         "of the random pairs (default 1)"},
        {"threads", 't', CLI_INT, &threads, 0, 1024, "N", "default 0: all processors"},
        {"against", 0, CLI_READ, &j.path_against, 0, 0, "MODEL",
         "a second model: its SMAPE beside, and which of the two is better for how many materials"},
        {"skip-missing", 0, CLI_FLAG, &skip_missing, 0, 0, NULL,
         "leave out data that the model has no material for (default: an error)"},
        {"images", 0, CLI_FLAG, &images, 0, 0, NULL, "compare pictures, the reference last"},
        {"difference", 0, CLI_WRITE_PICTURE, &pictures.difference, 0, 0, "FILE",
         "with --images: false colours and their scale as FILE.png, or FILE.exr and a PNG beside "
         "it"},
        {"layer", 0, CLI_TEXT, &pictures.layer, 0, 0, "NAME",
         "with --images: of EXR files with several layers, the same of all"},
        {"repair", 0, CLI_FLAG, &pictures.repair, 0, 0, NULL,
         "with --images: pixels that are not finite become the mean of those around them"},
        {"scale", 0, CLI_REAL, &pictures.top, 1e-30, 1e30, "X",
         "where its colours end (default: at most one pixel in a hundred is beyond)"},
        {"exposure", 0, CLI_REAL, &pictures.flip.exposure, -64, 64, "EV",
         "with --images: FLIP at this exposure, in stops (default: the largest over exposures)"},
        CLI_PPD_OPTION(pictures.flip),
        {"csv", 0, CLI_WRITE_TEXT, &csv, 0, 0, "FILE",
         "write the table as CSV; - is standard output"},
        {"json", 0, CLI_WRITE_TEXT, &json, 0, 0, "FILE",
         "write it as JSON, with MAE and MSE; - likewise"},
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    j.sampler = (hnbrdf_sampler)sampler.value;
    if (result < 0)
        result = check_images(images, &pictures, count, j.path_against || skip_missing);
    if (result >= 0)
        return result;
    if (count < 2)
        return cli_usage(&command, "%s",
                         count ? "no DATA to compare with" : "no MODEL and no DATA");
    if (images) {
        pictures.paths = argv + 1;
        pictures.count = count;
        pictures.csv = csv;
        pictures.json = json;
        pictures.table = cli_is_stdout(csv) || cli_is_stdout(json) ? NULL : stdout;
        return run_images(&pictures);
    }
    j.path = argv[1];
    return run(&j, argv + 2, count - 1, skip_missing, (int)threads, csv, json);
}
