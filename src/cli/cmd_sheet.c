/* cmd_sheet.c: `hnbrdf sheet`: spheres of measured materials beside their models, on one page. */
#include "cli/picture.h"
#include "report/sheet.h"

#include <stdlib.h>

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
    "DATA is builtin, builtin:anisotropic, builtin:NAME, measured files or directories.",
    "hnbrdf sheet model.safetensors builtin -o sheet.png\n"
    "hnbrdf sheet rgl.safetensors measured/rgl --ggx rgl_ggx.safetensors --difference -o rgl.png\n"
    "hnbrdf sheet model.safetensors builtin --materials gold-two-lobe,retro-tape --size 256 -o "
    "two.exr",
};

typedef struct sheet_command {
    const char *list, *output;
    report_sheet sheet;
} sheet_command;

static int make_sheet(sheet_command *c)
{
    hnbrdf_error error;
    report_sheet *sheet = &c->sheet;
    cli_progress line;
    sheet->spheres.watch = cli_watch(&line);
    cli_progress_begin(&line, "rendering");
    hnbrdf_result result = report_sheet_render(sheet, &error);
    cli_progress_end(&line);
    if (result == HNBRDF_OK) {
        report_sheet_print(sheet, stdout);
        result = report_sheet_write(sheet, c->output, &error);
    }
    report_sheet_free(sheet);
    return cli_code(result, &error);
}

static int run(sheet_command *c, char **arguments, int count)
{
    report_sheet *sheet = &c->sheet;
    hnbrdf_model *model = NULL, *ggx = NULL;
    cli_data data = {NULL, 0};
    int *chosen = NULL;
    int code = cli_open_model(sheet->path, &model);
    if (code == CLI_OK && sheet->ggx_path)
        code = cli_open_model(sheet->ggx_path, &ggx);
    if (code == CLI_OK)
        code = cli_open_data(arguments, count, &data);
    if (code == CLI_OK)
        code = cli_choose_materials(model, c->list, &chosen, &sheet->chosen_count);
    if (code == CLI_OK) {
        sheet->model = model;
        sheet->ggx = ggx;
        sheet->chosen = chosen;
        sheet->named = c->list != NULL;
        sheet->spheres.data = data.items;
        sheet->spheres.data_count = data.count;
        code = make_sheet(c);
    }
    free(chosen);
    cli_close_data(&data);
    hnbrdf_model_free(model);
    hnbrdf_model_free(ggx);
    return code;
}

int cmd_sheet(int argc, char **argv)
{
    sheet_command c = {.sheet = {.spheres = {.size = 160, .light = PICTURE_DEFAULTS(32)}}};
    report_sheet *sheet = &c.sheet;
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_PICTURE, &c.output, 0, 0, "FILE",
         "FILE.png, or FILE.exr with a PNG beside it"},
        {"materials", 0, CLI_TEXT, &c.list, 0, 0, "A,B",
         "default: all of the model's that are in DATA"},
        {"ggx", 0, CLI_READ, &sheet->ggx_path, 0, 0, "MODEL2",
         "show its analytic parts as GGX alone"},
        {"difference", 0, CLI_FLAG, &sheet->difference, 0, 0, NULL,
         "also 4 times the absolute errors"},
        {"columns", 0, CLI_INT, &sheet->columns, 0, 64, "N",
         "materials beside each other; default: about 3:2"},
        {"size", 0, CLI_INT, &sheet->spheres.size, 32, 2048, "N",
         "pixels of a sphere's side, default 160"},
        PICTURE_OPTIONS(sheet->spheres.light, "32"),
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {NULL, 0, CLI_FLAG, NULL, 0, 0, NULL, NULL},
    };
    int positionals, code = cli_parse(&command, options, argc, argv, &positionals);
    if (code >= 0)
        return code;
    if (positionals < 2)
        return cli_usage(&command, "expected MODEL and DATA, found %d arguments", positionals);
    code = picture_check_output(&command, c.output);
    if (code >= 0)
        return code;
    sheet->path = argv[1];
    return run(&c, argv + 2, positionals - 1);
}
