/* cmd_lobes.c: `hnbrdf lobes`: fit the lobes with which the materials of a model are sampled, and
 * show them. */
#include "cli/cli.h"
#include "hnbrdf/edit.h"
#include "report/lobes_table.h"

static const cli_command command = {
    "lobes",
    "MODEL [--scheme fitted|paper|guess] [-o OUT] [--show] [--csv FILE]",
    "Makes the lobes with which hnbrdf_sample() draws the materials of a model, and writes them "
    "into it:\n"
    "two GGX lobes a material, of their own roughness, and the share of the samples that each gets "
    "at\n"
    "wo.z = 0, 1/9, 4/9 and 1; the rest is a cosine lobe. The values of the BRDF do not change. "
    "`fit`,\n"
    "`edit`, `mix`, `bake` and `import` make them by themselves: this is for older files and for\n"
    "comparisons. A roughness of 0 stands for no such lobe, one with a minus draws from all "
    "normals.",
    "hnbrdf lobes old.safetensors\n"
    "hnbrdf lobes model.safetensors --show --csv -\n"
    "hnbrdf lobes model.safetensors --scheme paper -o paper.safetensors",
};

int cli_set_lobes(hnbrdf_model **model, hnbrdf_lobes_scheme scheme)
{
    const hnbrdf_material_change change = {.kind = HNBRDF_CHANGE_LOBES, .lobes = scheme};
    cli_progress line;
    const hnbrdf_edit_options options = {.progress = cli_progress_show, .progress_user = &line};
    hnbrdf_model *made;
    hnbrdf_error error;
    cli_progress_begin(&line, "lobes");
    hnbrdf_result result = hnbrdf_model_with_materials(*model, &change, 1, &options, &made, &error);
    cli_progress_end(&line);
    if (result != HNBRDF_OK)
        return cli_fail("%s", error.text);
    hnbrdf_model_free(*model);
    *model = made;
    return CLI_OK;
}

static int run(hnbrdf_model **model, hnbrdf_lobes_scheme scheme, int show, const char *csv,
               const char *output)
{
    hnbrdf_model_desc desc;
    hnbrdf_error error;
    if (!show && cli_set_lobes(model, scheme) != CLI_OK)
        return CLI_FAILURE;
    hnbrdf_model_describe(*model, &desc);
    if (!show && hnbrdf_model_save(*model, output, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    if (!cli_is_stdout(csv))
        report_lobes_print(&desc, stdout);
    return cli_write_file(csv, report_lobes_write_csv, &desc);
}

int cmd_lobes(int argc, char **argv)
{
    const char *output = NULL, *csv = NULL;
    static const hnbrdf_lobes_scheme schemes[] = {HNBRDF_LOBES_FIT, HNBRDF_LOBES_PAPER,
                                                  HNBRDF_LOBES_GUESS};
    int scheme = 0, show = 0, count;
    const cli_option options[] = {
        {"scheme", 0, CLI_CHOICE, &scheme, 0, 0, "fitted|paper|guess",
         "least variance (default); half cosine, half all normals; none"},
        {"output", 'o', CLI_WRITE_MODEL, &output, 0, 0, "OUT",
         "the model file to write (default: MODEL, rewritten)"},
        {"show", 0, CLI_FLAG, &show, 0, 0, NULL, "show those it has, change nothing"},
        {"csv", 0, CLI_WRITE_TEXT, &csv, 0, 0, "FILE",
         "write the table as CSV; - is stdout, then without the table"},
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != 1)
        return cli_usage(&command, count ? "more than one MODEL" : "no MODEL");
    if (show && output)
        return cli_usage(&command, "--show writes no model: leave out -o");
    hnbrdf_model *model;
    output = output ? output : argv[1];
    result =
        show ? cli_open_model(argv[1], &model) : cli_open_model_to_change(argv[1], output, &model);
    if (result != CLI_OK)
        return result;
    result = run(&model, schemes[scheme], show, csv, output);
    hnbrdf_model_free(model);
    return result;
}
