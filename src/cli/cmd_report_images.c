/* cmd_report_images.c: `hnbrdf report images`: PSNR of spheres for a grid of networks and
 * baselines, with picture rows, material by material, so that what an interrupted run has done
 * stays. */
#include "base/csv.h"
#include "base/hash.h"
#include "cli/report.h"
#include "base/text.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "report",
    "images DATA... -o DIR [options]",
    "Renders a sphere of every material, measured and of every model, under the same light with "
    "the\n"
    "same random directions, and measures MAE, MSE and PSNR: the paper's table of image errors "
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

/* ---- What figures were made with ------------------------------------------------------------- */

static int hash_bytes(void *user, const void *data, size_t size)
{
    uint64_t *hash = user;
    *hash = hnbrdf_hash(*hash, data, size);
    return 0;
}

/* images.txt: what has to be the same for figures to be reused. */
static void write_settings(const report *r, hnbrdf_model *const *models, FILE *file)
{
    fprintf(file, "hnbrdf %s\nenv %s\nrotate %.9g\nsize %ld\nspp %ld\nseed %ld\nrows %ld\n",
            hnbrdf_version(), r->light.env, r->light.rotate, r->image_size, r->light.spp,
            r->light.seed, r->rows);
    for (int m = 0; m < r->data.count; m++)
        fprintf(file, "material %s: %s\n", hnbrdf_measured_name(r->data.items[m]),
                hnbrdf_measured_summary(r->data.items[m]));
    for (int k = 0; k < r->count; k++) {
        uint64_t hash = HNBRDF_HASH_START;
        hnbrdf_model_write(models[k], hash_bytes, &hash, NULL);
        fprintf(file, "model %s %016llx\n", r->entries[k].name, (unsigned long long)hash);
    }
}

/* 1 if DIR/images.txt is what write_settings() would write, 0 if not, -1 after a message. */
static int same_settings(const report *r, hnbrdf_model *const *models)
{
    char *wanted = NULL, *path = report_path_in(r, "images.txt");
    size_t size = 0, count = 0;
    FILE *file = path ? fopen(path, "rb") : NULL, *memory = open_memstream(&wanted, &size);
    free(path);
    if (memory) {
        write_settings(r, models, memory);
        fclose(memory);
    }
    int same = file && wanted;
    for (int c; same && (c = getc(file)) != EOF; count++)
        same = count < size && (unsigned char)wanted[count] == c;
    if (file)
        fclose(file);
    free(wanted);
    return memory ? same && count == size : (cli_fail("out of memory"), -1);
}

static int keep_settings(const report *r, hnbrdf_model *const *models)
{
    cli_output output;
    char *path = report_path_in(r, "images.txt");
    int code = path ? cli_output_open(path, &output) : CLI_FAILURE;
    free(path);
    if (code != CLI_OK)
        return code;
    write_settings(r, models, output.file);
    return cli_output_close(&output);
}

/* ---- Figures of an earlier run --------------------------------------------------------------- */

static report_picture *find_picture(report *r, const char *material, const char *name)
{
    for (int m = 0; m < r->data.count; m++)
        for (int k = 0; k < r->count; k++)
            if (strcmp(material, hnbrdf_measured_name(r->data.items[m])) == 0 &&
                strcmp(name, r->entries[k].name) == 0)
                return &r->entries[k].pictures[m];
    return NULL;
}

/* A row of images.csv; what is not one is made again. */
static void read_row(report *r, const hnbrdf_csv_reader *reader)
{
    double values[6];
    report_picture *p =
        reader->count == 12 ? find_picture(r, reader->fields[0], reader->fields[11]) : NULL;
    for (int k = 0; k < 6 && p; k++)
        if (strcmp(reader->fields[5 + k], "inf") == 0)
            values[k] = (double)INFINITY;
        else if (!cli_parse_real(reader->fields[5 + k], &values[k]))
            p = NULL;
    if (p)
        *p = (report_picture){1, values[0], values[1], values[2], values[3], values[4], values[5]};
}

static int read_figures(report *r)
{
    hnbrdf_error error;
    hnbrdf_csv_reader *reader = malloc(sizeof *reader);
    char *path = report_path_in(r, "images.csv");
    FILE *file = path ? fopen(path, "r") : NULL;
    int found = 1;
    if (reader && file) {
        hnbrdf_csv_begin(reader, file, path);
        while ((found = hnbrdf_csv_next(reader, &error)) == 1)
            read_row(r, reader);
    }
    if (file)
        fclose(file);
    int code = !path       ? CLI_FAILURE
               : !reader   ? cli_fail("out of memory")
               : found < 0 ? cli_fail("%s", error.text)
                           : CLI_OK;
    free(reader);
    free(path);
    return code;
}

static int is_done(const report *r, int m)
{
    int done = 1;
    for (int k = 0; k < r->count; k++)
        done &= r->entries[k].pictures[m].done;
    return done;
}

/* ---- Measuring ------------------------------------------------------------------------------- */

/* 1 if the picture of this entry is in the picture rows. */
static int is_shown(const report *r, const report_entry *e)
{
    return e == report_find(r, e->form, r->nets[r->net_count - 1], r->latents[0]);
}

static int measure_entry(report *r, int m, report_entry *e, const hnbrdf_model *model)
{
    render_image picture = {0};
    int kept = render_has_exr() && report_rows_has(r, m) && is_shown(r, e);
    int code = report_images_measure(r, m, e, model, kept ? &picture : NULL);
    if (code == CLI_OK && kept)
        code = report_rows_keep(r, m, e->name, &picture);
    render_image_free(&picture);
    return code;
}

static int measure_material(report *r, int m, hnbrdf_model *const *models)
{
    int code = report_images_reference(r, m, models[0]);
    for (int k = 0; k < r->count && code == CLI_OK; k++)
        code = measure_entry(r, m, &r->entries[k], models[k]);
    if (code == CLI_OK && render_has_exr() && report_rows_has(r, m))
        code = report_rows_keep(r, m, "reference", report_images_mean_reference(r, m));
    report_images_drop_reference(r, m);
    if (code != CLI_OK)
        for (int k = 0; k < r->count; k++)
            r->entries[k].pictures[m].done = 0;
    return code;
}

static int write_results(report *r)
{
    for (int k = 0; k < r->count; k++) {
        report_images_average(r, &r->entries[k]);
        r->entries[k].done = is_done(r, r->data.count - 1);
    }
    int code = report_write(r, "images.csv", report_write_images_csv);
    for (int n = 0; n < r->net_count && code == CLI_OK && r->entries[0].done; n++)
        code = report_write_net(r, "psnr", r->nets[n], report_write_psnr_plot);
    return code == CLI_OK ? report_write(r, "images.md", report_write_images_markdown) : code;
}

static int measure_all(report *r, hnbrdf_model *const *models)
{
    int left = 0, code = CLI_OK;
    for (int m = 0; m < r->data.count; m++)
        left += !is_done(r, m) || !report_rows_is_kept(r, m);
    picture_progress progress = {.count = left * 2 * (r->count + 1)};
    report_images_watch(r, &progress);
    report_catch_interrupts(1);
    cli_progress_begin(&progress.line, "rendering");
    for (int m = 0; m < r->data.count && code == CLI_OK; m++) {
        progress.detail = hnbrdf_measured_name(r->data.items[m]);
        if (is_done(r, m) && report_rows_is_kept(r, m))
            continue;
        code = measure_material(r, m, models);
        if (code == CLI_OK)
            code = write_results(r);
    }
    cli_progress_end(&progress.line);
    report_catch_interrupts(0);
    return code;
}

static void print_models(const report *r)
{
    printf("%-20s  %9s  %16s\n", "model", "MAE", "PSNR, dB");
    for (int k = 0; k < r->count; k++)
        printf("%-20s  %9.5f  %7.2f +- %5.2f\n", r->entries[k].name, r->entries[k].mean_mae,
               r->entries[k].mean_psnr, r->entries[k].mean_psnr_error);
}

static int measure_and_write(report *r, hnbrdf_model *const *models)
{
    int same = r->resume ? same_settings(r, models) : 0;
    int code = same < 0 ? CLI_FAILURE : report_make_folders(r, "pictures");
    if (code == CLI_OK && same)
        code = read_figures(r);
    /* Figures made with other settings are forgotten before the new settings are kept. */
    if (code == CLI_OK && !same)
        code = report_write(r, "images.csv", report_write_images_csv);
    if (code == CLI_OK)
        code = keep_settings(r, models);
    if (code == CLI_OK)
        code = report_images_open(r);
    if (code == CLI_OK)
        code = measure_all(r, models);
    if (code == CLI_OK)
        code = write_results(r);
    if (code == CLI_OK)
        print_models(r);
    if (code == CLI_OK && r->rows > 0 && render_has_exr())
        code = report_rows_write(r);
    else if (code == CLI_OK && r->rows > 0)
        cli_warn("built without OpenEXR: no picture rows");
    report_images_end(r);
    return code;
}

/* ---- Command --------------------------------------------------------------------------------- */

static int run(report *r, char **data, int count)
{
    int code = cli_open_data(data, count, &r->data);
    if (code != CLI_OK)
        return code;
    hnbrdf_model **models = NULL, *given = NULL;
    if (r->given) /* before anything takes time */
        code = report_load_model(r, r->given, &given);
    hnbrdf_model_free(given);
    if (code == CLI_OK)
        code = report_make_folders(r, "models");
    if (code == CLI_OK)
        code = report_make_entries(r);
    if (code == CLI_OK && !(models = calloc((size_t)r->count, sizeof *models)))
        code = cli_fail("out of memory");
    if (code == CLI_OK)
        code = report_make_models(r, models);
    if (code == CLI_OK)
        code = measure_and_write(r, models);
    if (code == CLI_OK)
        printf("%s/images.md\n", r->directory);
    for (int k = 0; k < r->count && models; k++)
        hnbrdf_model_free(models[k]);
    free(models);
    report_free_entries(r);
    cli_close_data(&r->data);
    return code;
}

/* The grid is the one model in this file. Returns -1 to go on, as cli_parse() does. */
static int describe_given(report *r)
{
    hnbrdf_error error;
    hnbrdf_model *model;
    hnbrdf_model_desc desc;
    if (hnbrdf_model_load(r->given, NULL, &model, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
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
    report r = {.sampler = HNBRDF_SAMPLER_GRID, .rows = 24, .light = PICTURE_DEFAULTS(0)};
    const char *nets = NULL, *latents = NULL, *models = NULL;
    int quick = 0, count;
    long fit_seed = 1;
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &r.directory, 0, 0, "DIR",
         "the folder to write (required); made if missing"},
        {"nets", 0, CLI_TEXT, &nets, 0, 0, "LIST", "default 16x3,32x3,64x3"},
        {"latents", 0, CLI_TEXT, &latents, 0, 0, "LIST",
         "latent sizes of the hybrids (default 4,8)"},
        {"models", 0, CLI_TEXT, &models, 0, 0, "LIST",
         "of hybrid, paper and neural (default all); GGX always"},
        {"model", 0, CLI_TEXT, &r.given, 0, 0, "FILE",
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
        {"env", 0, CLI_TEXT, &r.light.env, 0, 0, "sky|furnace|FILE",
         "light: sky, furnace, or a lat-long map .exr or .hdr"},
        {"rotate", 0, CLI_REAL, &r.light.rotate, -360, 360, "DEG",
         "turn the light about the vertical, counter-clockwise from above"},
        {"exposure", 0, CLI_REAL, &r.light.exposure, -64, 64, "EV",
         "of the picture rows, stops; default: mean light as bright as that of the sky"},
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
