/* cmd_edit.c: `hnbrdf edit`: change a material of a model by hand: colour, refraction, roughness,
 * angle. */
#include "cli/cli.h"
#include "core/compose.h"
#include "hnbrdf/edit.h"
#include "hnbrdf/metrics.h"
#include "report/conserve.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "edit",
    "MODEL --set FIELD=VALUE[,...] [--material A] [--as B] [--conserve] [-o OUT]\n"
    "       hnbrdf edit MODEL --conserve [-o OUT]",
    "Changes fields of a material. The model's network and the latent code stay as they are; what "
    "the\n"
    "network adds to the material is carried along: of a rougher material all of the highlight is "
    "wider.\n"
    "Without --as the material itself changes, with it a copy is added under that name.\n"
    "\n"
    "Fields: kd (diffuse albedo, 0 to 1) and eta (index of refraction, above 1), one value or "
    "three "
    "for\n"
    "R:G:B; alpha (roughness, 0.0001 to 1), one value or two for x:y; alpha_x; alpha_y; rotation "
    "of x "
    "and\n"
    "y about the normal, counter-clockwise, in radians or as in 30deg. FIELD*=VALUE multiplies,\n"
    "FIELD+=VALUE adds. Two different alphas make an isotropic material anisotropic. FIELD=fitted "
    "takes\n"
    "an edit back: the file keeps what a material was fitted with (hnbrdf info shows it). Good up "
    "to\n"
    "3 times or a third of the fitted alpha or so; examples/editing.md has the errors.\n"
    "\n"
    "--conserve: a material whose albedo (hnbrdf info) is above 1 gets a factor on its values, of\n"
    "both cosines: reciprocal, at most 1, and 1 but near the horizon; one that does not need it\n"
    "has none. Without --set that is done to all materials, or to --material. The factor of an\n"
    "edited material that had one is found again.",
    "hnbrdf edit model.safetensors --material gold-two-lobe --set alpha=0.2,kd=0.1:0.2:0.3 --as "
    "dull\n"
    "hnbrdf edit model.safetensors --material gold-two-lobe --set alpha=0.1:0.4,rotation=30deg "
    "--as "
    "brushed\n"
    "hnbrdf edit model.safetensors --material gold-two-lobe --set alpha*=2,eta+=0.1 -o "
    "edited.safetensors\n"
    "hnbrdf edit model.safetensors --conserve -o conserving.safetensors",
};

static void print_values(const float *values, int count)
{
    int equal = 1;
    for (int k = 1; k < count; k++)
        equal = equal && values[k] == values[0];
    for (int k = 0; k < (equal ? 1 : count); k++)
        printf("%s%.6g", k ? ":" : "", (double)values[k]);
}

static void print_change(const char *name, const float *before, const float *after, int count)
{
    if (memcmp(before, after, (size_t)count * sizeof *before) == 0)
        return;
    printf("  %-8s  ", name);
    print_values(before, count);
    printf(" -> ");
    print_values(after, count);
    printf("\n");
}

/* What --as asks for: the material itself, or one under another name. */
typedef struct edit_job {
    const char *path, *output, *material, *as;
    int replace; /* a material of the name `as` may be overwritten */
    int conserve;
    const char *set;
} edit_job;

static int edit_material(const edit_job *job, const hnbrdf_model *model, int index)
{
    const char *from = hnbrdf_model_material_name(model, index), *to = job->as ? job->as : from;
    const hnbrdf_material *before = hnbrdf_model_material(model, index);
    hnbrdf_material after = *before;
    hnbrdf_model_desc desc;
    hnbrdf_model *made = NULL;
    hnbrdf_error error;
    hnbrdf_model_describe(model, &desc);
    if (desc.kind == HNBRDF_KIND_NEURAL)
        cli_warn("%s: a neural model has no analytic part; kd, eta and alpha do not show",
                 job->path);
    if (hnbrdf_material_set(&after, job->set, &error) != HNBRDF_OK)
        return cli_fail("%s: %s", from, error.text);
    if ((job->conserve || hnbrdf_has_energy(&before->energy)) &&
        hnbrdf_material_check(&after, NULL) == HNBRDF_OK &&
        hnbrdf_energy_fit(model, &after, &after.energy, &error) != HNBRDF_OK)
        return cli_fail("%s: %s", from, error.text);
    const hnbrdf_material_change change = {
        .name = to, .material = &after, .lobes = HNBRDF_LOBES_FIT};
    if (!job->replace && strcmp(to, from) != 0 && hnbrdf_model_find(model, to) >= 0)
        return cli_fail_name_taken(job->path, to);
    hnbrdf_result result = hnbrdf_model_with_materials(model, &change, 1, NULL, &made, &error);
    if (result == HNBRDF_OK)
        result = hnbrdf_model_save(made, job->output, &error);
    hnbrdf_model_free(made);
    if (result != HNBRDF_OK)
        return cli_fail("%s", error.text);
    printf("%s: %s%s%s\n", job->output, to, job->as ? " from " : " changed", job->as ? from : "");
    print_change("kd", before->kd, after.kd, 3);
    print_change("eta", before->eta, after.eta, 3);
    print_change("alpha", before->alpha, after.alpha, 2);
    print_change("rotation", &before->rotation, &after.rotation, 1);
    print_change("energy", &before->energy.horizon, &after.energy.horizon, 2);
    return CLI_OK;
}

/* --conserve alone: all materials, or one. */
static int conserve(const edit_job *job, const hnbrdf_model *model)
{
    cli_progress progress;
    const report_watch watch = cli_watch(&progress);
    hnbrdf_model *made = NULL;
    hnbrdf_error error;
    int *materials = NULL, count = 0;
    if (cli_choose_materials(model, job->material, &materials, &count) != CLI_OK)
        return CLI_FAILURE;
    cli_progress_begin(&progress, "albedo");
    hnbrdf_result result =
        report_conserve(model, materials, count, &watch, cli_words(), &made, &error);
    cli_progress_end(&progress);
    free(materials);
    if (!result)
        result = hnbrdf_model_save(made, job->output, &error);
    hnbrdf_model_free(made);
    return cli_code(result, &error);
}

static int run(const edit_job *job)
{
    hnbrdf_model *model;
    if (cli_open_model_to_change(job->path, job->output, &model) != CLI_OK)
        return CLI_FAILURE;
    if (!job->set) {
        const int code = conserve(job, model);
        hnbrdf_model_free(model);
        return code;
    }
    int index = cli_choose_material(model, job->material);
    int result = index < 0 ? CLI_FAILURE : edit_material(job, model, index);
    hnbrdf_model_free(model);
    return result;
}

int cmd_edit(int argc, char **argv)
{
    edit_job job = {.path = NULL};
    hnbrdf_material any;
    hnbrdf_error error;
    int count;
    const cli_option options[] = {
        {"material", 'm', CLI_TEXT, &job.material, 0, 0, "NAME",
         "the material to start from; needed when the model has several"},
        {"set", 's', CLI_TEXT, &job.set, 0, 0, "LIST", "what to change"},
        {"as", 0, CLI_TEXT, &job.as, 0, 0, "NAME",
         "keep the material, add the edited one under this name"},
        {"conserve", 0, CLI_FLAG, &job.conserve, 0, 0, NULL,
         "give off no more light than comes, by a factor near the horizon where one is needed"},
        {"replace", 0, CLI_FLAG, &job.replace, 0, 0, NULL,
         "--as may overwrite a material of that name"},
        {"output", 'o', CLI_WRITE_MODEL, &job.output, 0, 0, "OUT",
         "the model file to write (default: MODEL, rewritten)"},
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != 1)
        return cli_usage(&command, count ? "more than one MODEL" : "no MODEL");
    if (!job.set && (job.as || !job.conserve))
        return cli_usage(&command, "nothing to change, expected --set FIELD=VALUE%s",
                         job.as ? " beside --as" : " or --conserve");
    hnbrdf_material_init(&any);         /* is it an edit at all? before files are opened */
    any.fitted.alpha[0] = any.alpha[0]; /* as every material of a hybrid has it */
    if (job.set && hnbrdf_material_set(&any, job.set, &error) != HNBRDF_OK)
        return cli_usage(&command, "--set: %s", error.text);
    job.path = argv[1];
    job.output = job.output ? job.output : job.path;
    return run(&job);
}
