/* cmd_sheet.c: `hnbrdf sheet`: spheres of measured materials beside their models, on one page. */
#include "cli/picture.h"
#include "hnbrdf/metrics.h"
#include "image/sheet.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "sheet",
    "MODEL DATA... [--materials A,B] [options] -o FILE.png",
    "Renders a contact sheet: for each material the measurement, GGX alone and the model, under "
    "the "
    "same\n"
    "light, with the same exposure and the same random numbers. Under each fitted sphere stand its "
    "mean\n"
    "absolute error in radiance and its PSNR (peak: the reference's largest value) over the "
    "sphere's\n"
    "pixels; they are also printed. GGX alone is the analytic part of MODEL, or of --ggx MODEL2.\n"
    "DATA is builtin, builtin:NAME, measured files or directories.",
    "hnbrdf sheet model.safetensors builtin -o sheet.png\n"
    "hnbrdf sheet rgl.safetensors measured/rgl --ggx rgl_ggx.safetensors --difference -o rgl.png\n"
    "hnbrdf sheet model.safetensors builtin --materials gold-two-lobe,retro-tape --size 256 -o "
    "two.exr",
};

enum { REFERENCE, GGX, MODEL, GGX_ERROR, MODEL_ERROR, KINDS };
static const float difference_gain = 4.0f;

typedef struct sheet_material {
    const hnbrdf_measured *measured;
    int index, ggx_index; /* of the material in the models */
    hnbrdf_image_error errors[KINDS];
} sheet_material;

typedef struct sheet_job {
    const char *path, *ggx_path, *list, *output;
    int difference;
    long size, columns;
    picture_options picture;
    cli_data data;
    cli_source source, ggx; /* the model; MODEL2 or nothing */
    hnbrdf_model_desc desc;
    const hnbrdf_model *ggx_model; /* whose analytic part is shown as GGX; NULL: none */
    hnbrdf_model *guide;           /* see render_guide_model() */
    render_environment environment;
    int kinds[RENDER_SHEET_COLUMNS], kind_count; /* what the columns show */
    sheet_material *materials;
    render_sheet_row *rows;
    int count;
    picture_progress progress;
} sheet_job;

/* ---- What is shown --------------------------------------------------------------------------- */

static int open_model(const char *path, cli_source *source)
{
    if (cli_open_source(path, source) != CLI_OK)
        return CLI_FAILURE;
    return source->model ? CLI_OK
                         : cli_fail("%s: expected a model file, found a measurement", path);
}

static void choose_columns(sheet_job *job)
{
    int has_model = job->desc.kind != HNBRDF_KIND_GGX || job->ggx.model;
    job->ggx_model = job->ggx.model                         ? job->ggx.model
                     : job->desc.kind != HNBRDF_KIND_NEURAL ? job->source.model
                                                            : NULL;
    job->kinds[job->kind_count++] = REFERENCE;
    if (job->ggx_model)
        job->kinds[job->kind_count++] = GGX;
    if (has_model)
        job->kinds[job->kind_count++] = MODEL;
    if (job->difference && job->ggx_model)
        job->kinds[job->kind_count++] = GGX_ERROR;
    if (job->difference && has_model)
        job->kinds[job->kind_count++] = MODEL_ERROR;
}

/* 1 if the material can be shown, 0 if it has no data and was not asked for by name, -1 after a
 * message. */
static int find_material(const sheet_job *job, int index, sheet_material *material)
{
    const char *name = hnbrdf_model_material_name(job->source.model, index);
    material->measured = cli_find_data(&job->data, name);
    material->index = material->ggx_index = index;
    if (!material->measured && job->list)
        return cli_fail("%s: none of the data has this name", name), -1;
    if (material->measured && job->ggx.model) {
        material->ggx_index = hnbrdf_model_find(job->ggx.model, name);
        if (material->ggx_index < 0)
            return cli_fail("%s: has no material %s", job->ggx_path, name), -1;
    }
    return material->measured != NULL;
}

static int choose_materials(sheet_job *job)
{
    int *indices, count, code = CLI_OK;
    if (cli_choose_materials(job->source.model, job->list, &indices, &count) != CLI_OK)
        return CLI_FAILURE;
    job->materials = calloc((size_t)count, sizeof *job->materials);
    job->rows = calloc((size_t)count, sizeof *job->rows);
    if (!job->materials || !job->rows)
        code = cli_fail("out of memory");
    for (int i = 0; i < count && code == CLI_OK; i++) {
        int found = find_material(job, indices[i], &job->materials[job->count]);
        if (found < 0)
            code = CLI_FAILURE;
        else
            job->count += found;
    }
    free(indices);
    if (code == CLI_OK && job->count == 0)
        code = cli_fail("%s: none of its materials is among the data", job->path);
    return code;
}

static int open_all(sheet_job *job, char **data, int count)
{
    hnbrdf_error error;
    if (open_model(job->path, &job->source) != CLI_OK ||
        (job->ggx_path && open_model(job->ggx_path, &job->ggx) != CLI_OK) ||
        cli_open_data(data, count, &job->data) != CLI_OK)
        return CLI_FAILURE;
    hnbrdf_model_describe(job->source.model, &job->desc);
    choose_columns(job);
    if (choose_materials(job) != CLI_OK ||
        picture_open_light(&job->picture, &job->environment) != CLI_OK)
        return CLI_FAILURE;
    return render_guide_model(&job->guide, &error) == HNBRDF_OK ? CLI_OK
                                                                : cli_fail("%s", error.text);
}

/* ---- One material ---------------------------------------------------------------------------- */

/* All surfaces of a row draw the same directions, which suit all of them. */
static void make_surfaces(const sheet_job *job, const sheet_material *m,
                          render_surface surfaces[KINDS])
{
    surfaces[REFERENCE] = render_surface_measured(m->measured);
    surfaces[MODEL] =
        render_surface_model(job->source.model, hnbrdf_model_material(job->source.model, m->index));
    surfaces[GGX] = surfaces[MODEL]; /* unless there is something to show */
    if (job->ggx_model)
        surfaces[GGX] = render_surface_analytic(
            job->ggx_model, hnbrdf_model_material(job->ggx_model, m->ggx_index));
    const render_surface *all[] = {&surfaces[REFERENCE], &surfaces[GGX], &surfaces[MODEL]};
    render_guide guide = render_guide_fit(all, 3, job->guide);
    for (int kind = REFERENCE; kind <= MODEL; kind++)
        render_surface_guide(&surfaces[kind], &guide);
}

static void write_captions(const hnbrdf_image_error *error, render_sheet_cell *cell)
{
    if (isinf(error->psnr))
        snprintf(cell->short_caption, sizeof cell->short_caption, "equal");
    else
        snprintf(cell->short_caption, sizeof cell->short_caption, "%.1f dB", error->psnr);
    snprintf(cell->caption, sizeof cell->caption, "MAE %.4f  %s", error->mae, cell->short_caption);
}

static int make_difference(const render_image *a, const render_image *reference, render_image *out)
{
    hnbrdf_error error;
    if (render_image_create(a->width, a->height, 1, out, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    size_t pixels = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < 3 * pixels; i++)
        out->rgb[i] = difference_gain * fabsf(a->rgb[i] - reference->rgb[i]);
    memcpy(out->alpha, a->alpha, pixels * sizeof(float));
    return CLI_OK;
}

static int render_cell(sheet_job *job, const render_surface *surface, render_image *image)
{
    hnbrdf_error error;
    render_options options = {.size = (int)job->size,
                              .spp = (int)job->picture.spp,
                              .seed = (uint64_t)job->picture.seed,
                              .threads = (int)job->picture.threads,
                              .progress = picture_report,
                              .progress_user = &job->progress};
    if (render_sphere(surface, &job->environment, &options, image, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    job->progress.first++;
    return CLI_OK;
}

/* Fills one cell; the columns to its left, of which it may need the pictures, are done. */
static int fill_cell(sheet_job *job, sheet_material *m, const render_surface *surfaces,
                     render_sheet_cell *const cells[KINDS], int kind)
{
    render_sheet_cell *cell = cells[kind];
    if (kind == GGX_ERROR || kind == MODEL_ERROR)
        return make_difference(&cells[kind == GGX_ERROR ? GGX : MODEL]->image,
                               &cells[REFERENCE]->image, &cell->image);
    int code = render_cell(job, &surfaces[kind], &cell->image);
    if (code == CLI_OK && kind != REFERENCE) {
        code = picture_compare(&cell->image, &cells[REFERENCE]->image, &m->errors[kind]);
        write_captions(&m->errors[kind], cell);
    }
    return code;
}

static int fill_row(sheet_job *job, sheet_material *m, render_sheet_row *row)
{
    render_surface surfaces[KINDS];
    render_sheet_cell *cells[KINDS] = {NULL};
    row->name = job->progress.detail = hnbrdf_measured_name(m->measured);
    make_surfaces(job, m, surfaces);
    for (int c = 0; c < job->kind_count; c++) {
        cells[job->kinds[c]] = &row->cells[c];
        int code = fill_cell(job, m, surfaces, cells, job->kinds[c]);
        if (code != CLI_OK)
            return code;
    }
    return CLI_OK;
}

/* ---- The page -------------------------------------------------------------------------------- */

static void expose(sheet_job *job)
{
    float gain = (float)exp2(job->picture.exposure);
    for (int i = 0; i < job->count; i++)
        for (int c = 0; c < job->kind_count; c++) {
            render_image *image = &job->rows[i].cells[c].image;
            size_t values = 3 * (size_t)image->width * (size_t)image->height;
            for (size_t k = 0; k < values; k++)
                image->rgb[k] *= gain;
        }
}

static void print_errors(const sheet_job *job, hnbrdf_image_error means[KINDS])
{
    printf("%-32s", "material");
    for (int kind = GGX; kind <= MODEL; kind++)
        if ((kind == GGX && job->ggx_model) ||
            (kind == MODEL && job->kinds[job->kind_count - 1] >= MODEL))
            printf("  %s", kind == GGX ? "  MAE GGX     PSNR" : "MAE model     PSNR");
    printf("\n");
    for (int i = 0; i < job->count; i++) {
        printf("%-32s", job->rows[i].name);
        for (int c = 0; c < job->kind_count; c++) {
            int kind = job->kinds[c];
            if (kind != GGX && kind != MODEL)
                continue;
            const hnbrdf_image_error *error = &job->materials[i].errors[kind];
            printf("  %9.5f  %7.2f", error->mae, error->psnr);
            means[kind].mae += error->mae / job->count;
            means[kind].psnr += error->psnr / job->count;
        }
        printf("\n");
    }
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static int write_sheet(sheet_job *job)
{
    hnbrdf_error error;
    hnbrdf_image_error means[KINDS] = {{0}};
    char kind[96], what[192], light[192], ggx_error[32], model_error[32];
    const char *titles[KINDS] = {"reference", "GGX alone", kind, ggx_error, model_error};
    render_sheet sheet = {.lines = {base_name(job->path), what, light},
                          .columns = job->kind_count,
                          .cell = (int)job->size,
                          .blocks = (int)job->columns,
                          .rows = job->rows,
                          .count = job->count};
    print_errors(job, means);
    expose(job);
    snprintf(kind, sizeof kind, "%s", hnbrdf_kind_name(job->desc.kind));
    snprintf(what, sizeof what, "%s", kind);
    if (job->desc.kind != HNBRDF_KIND_GGX) {
        snprintf(kind, sizeof kind, "%s %dx%d", hnbrdf_kind_name(job->desc.kind), job->desc.hidden,
                 job->desc.layers);
        snprintf(what, sizeof what, "%s, %s encoding, %zu weights for %d materials", kind,
                 hnbrdf_encoding_name(job->desc.encoding),
                 hnbrdf_model_weight_count(job->source.model),
                 hnbrdf_model_material_count(job->source.model));
    }
    int length = snprintf(light, sizeof light, "mean PSNR of");
    for (int c = 1; c < job->kind_count && job->kinds[c] <= MODEL; c++)
        length += snprintf(light + length, sizeof light - (size_t)length, "%s %s %.1f dB",
                           c > 1 ? "," : "", job->kinds[c] == GGX ? "GGX" : "model",
                           means[job->kinds[c]].psnr);
    snprintf(light + length, sizeof light - (size_t)length, "; light %.60s, %ld samples a pixel",
             base_name(job->picture.env), job->picture.spp);
    snprintf(ggx_error, sizeof ggx_error, "GGX error \xc3\x97 %g", (double)difference_gain);
    snprintf(model_error, sizeof model_error, "%s error \xc3\x97 %g",
             hnbrdf_kind_name(job->desc.kind), (double)difference_gain);
    for (int c = 0; c < job->kind_count; c++)
        sheet.titles[c] = titles[job->kinds[c]];

    render_image image;
    if (render_sheet_compose(&sheet, &image, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    render_write_options options = {.half = 1, .comments = what};
    int code = picture_write(&image, job->output, &options);
    render_image_free(&image);
    return code;
}

static int run(sheet_job *job, char **data, int count)
{
    int code = open_all(job, data, count);
    if (code != CLI_OK)
        return code;
    int rendered =
        job->kinds[job->kind_count - 1] > MODEL ? (job->kind_count + 1) / 2 : job->kind_count;
    job->progress.count = rendered * job->count;
    cli_progress_begin(&job->progress.line, "rendering");
    for (int i = 0; i < job->count && code == CLI_OK; i++)
        code = fill_row(job, &job->materials[i], &job->rows[i]);
    cli_progress_end(&job->progress.line);
    return code == CLI_OK ? write_sheet(job) : code;
}

static void clean_up(sheet_job *job)
{
    for (int i = 0; i < job->count; i++)
        for (int c = 0; c < RENDER_SHEET_COLUMNS; c++)
            render_image_free(&job->rows[i].cells[c].image);
    free(job->rows);
    free(job->materials);
    render_environment_free(&job->environment);
    hnbrdf_model_free(job->guide);
    cli_close_data(&job->data);
    cli_close_source(&job->source);
    cli_close_source(&job->ggx);
}

int cmd_sheet(int argc, char **argv)
{
    sheet_job job = {.size = 160, .picture = PICTURE_DEFAULTS(32)};
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &job.output, 0, 0, "FILE",
         "FILE.png, or FILE.exr with a PNG beside it"},
        {"materials", 0, CLI_TEXT, &job.list, 0, 0, "A,B",
         "default: all of the model's that are in DATA"},
        {"ggx", 0, CLI_TEXT, &job.ggx_path, 0, 0, "MODEL2", "show its analytic parts as GGX alone"},
        {"difference", 0, CLI_FLAG, &job.difference, 0, 0, NULL,
         "also 4 times the absolute errors"},
        {"columns", 0, CLI_INT, &job.columns, 0, 64, "N",
         "materials beside each other; default: about 3:2"},
        {"size", 0, CLI_INT, &job.size, 32, 2048, "N", "pixels of a sphere's side, default 160"},
        PICTURE_OPTIONS(job.picture, "32"),
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {NULL, 0, CLI_FLAG, NULL, 0, 0, NULL, NULL},
    };
    int positionals, code = cli_parse(&command, options, argc, argv, &positionals);
    if (code >= 0)
        return code;
    if (positionals < 2)
        return cli_usage(&command, "expected MODEL and DATA, found %d arguments", positionals);
    code = picture_check_output(&command, job.output);
    if (code >= 0)
        return code;
    job.path = argv[1];
    code = run(&job, argv + 2, positionals - 1);
    clean_up(&job);
    return code;
}
