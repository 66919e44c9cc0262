/* cmd_mix.c: `hnbrdf mix`: materials between two of a model. */
#include "cli/cli.h"
#include "base/text.h"
#include "core/compose.h"
#include "hnbrdf/edit.h"
#include "hnbrdf/metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "mix",
    "MODEL A B --t 0:1:0.25 [--as PREFIX] [-o OUT]",
    "Adds materials on the way from A (t = 0) to B (t = 1) to a model. Albedo, reflectance and "
    "the\n"
    "logarithm of the roughness go linearly, the tangent frame turns the short way; the latent "
    "code\n"
    "goes around what looks like neither: each step is as near as the network comes to a blend of\n"
    "both ends edited to the same roughness and colour, and no brighter or darker than both, seen\n"
    "from 0, 30 and 60 degrees. --straight: the latent code goes linearly too. Where an end\n"
    "conserves energy (hnbrdf edit --conserve), so do the mixtures, each with a factor of its "
    "own.\n"
    "They are named PREFIX-T, as in gold-chrome-0.25. FIRST:LAST:STEP is a sweep, ends included.",
    "hnbrdf mix model.safetensors gold-two-lobe rough-clay --t 0.5\n"
    "hnbrdf mix model.safetensors gold-two-lobe rough-clay --t 0:1:0.25 --as polish -o "
    "polish.safetensors",
};

enum { MAX_STEPS = 1000 };

typedef struct sweep {
    double first, step;
    int count;
} sweep;

/* "0.5" or "0:1:0.25". Returns -1 to go on, as cli_parse() does. */
static int read_sweep(const char *text, sweep *s)
{
    double values[3] = {0, 0, 0};
    const char *at = text, *end = text + strlen(text);
    int n = 0;
    while (n < 3 && (at = hnbrdf_parse_double(at, end, &values[n])) != NULL) {
        n++;
        if (at == end || *at != ':')
            break;
        at++;
    }
    if (!at || at != end || (n != 1 && n != 3))
        return cli_usage(&command,
                         "--t: '%s' is neither T, as in 0.5, nor FIRST:LAST:STEP, as in 0:1:0.25",
                         text);
    double last = n == 3 ? values[1] : values[0];
    if (values[0] < 0.0 || values[0] > 1.0 || last < 0.0 || last > 1.0)
        return cli_usage(&command, "--t: %s leaves the range from 0 (A) to 1 (B)", text);
    s->first = values[0];
    s->step = values[2];
    s->count = 1;
    if (n == 1)
        return -1;
    double steps = values[2] > 0.0 ? (last - values[0]) / values[2] : -1.0;
    if (!(steps >= 0.0) || steps >= MAX_STEPS)
        return cli_usage(&command,
                         "--t: %s: expected LAST not below FIRST, STEP above 0, at most %d values",
                         text, (int)MAX_STEPS);
    s->count = (int)floor(steps + 1e-9) + 1; /* 0.7/0.1 is a little below 7 */
    return -1;
}

/* The name of the material at t, "A-B-0.25" unless there is a prefix; 0 after a message if too
 * long. */
static int make_name(char *name, size_t size, const char *const ends[2], const char *prefix,
                     double t)
{
    int length = prefix ? snprintf(name, size, "%s-%.6g", prefix, t)
                        : snprintf(name, size, "%s-%s-%.6g", ends[0], ends[1], t);
    if (length > 0 && (size_t)length < size)
        return 1;
    cli_fail("the name of a mixed material is longer than %d bytes, choose a short one with --as",
             HNBRDF_MAX_NAME);
    return 0;
}

/* What the command is asked for. */
typedef struct mix_job {
    const char *path, *output, *prefix, *ends[2];
    int replace;  /* materials of the new names may be overwritten */
    int straight; /* the latent code goes linearly */
    sweep sweep;
} mix_job;

/* The steps of the sweep, each a change that puts it into the model. */
typedef struct mixtures {
    char names[MAX_STEPS][HNBRDF_MAX_NAME + 1];
    hnbrdf_material materials[MAX_STEPS];
    hnbrdf_material_change changes[MAX_STEPS];
} mixtures;

static int mix_all(const mix_job *job, const hnbrdf_model *model, mixtures *m)
{
    int a = cli_choose_material(model, job->ends[0]),
        b = a < 0 ? -1 : cli_choose_material(model, job->ends[1]);
    if (a < 0 || b < 0)
        return CLI_FAILURE;
    const hnbrdf_material *from = hnbrdf_model_material(model, a),
                          *to = hnbrdf_model_material(model, b);
    hnbrdf_material path[HNBRDF_MIX_KNOTS];
    hnbrdf_error error;
    if (!job->straight && hnbrdf_mix_path_fit(model, from, to, path, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    for (int k = 0; k < job->sweep.count; k++) {
        double t = fmin(job->sweep.first + k * job->sweep.step, 1.0);
        if (job->straight)
            hnbrdf_material_mix(from, to, (float)t, &m->materials[k]);
        else
            hnbrdf_mix_path_at(path, (float)t, &m->materials[k]);
        if (hnbrdf_has_energy(&m->materials[k].energy) &&
            hnbrdf_energy_fit(model, &m->materials[k], &m->materials[k].energy, &error))
            return cli_fail("%s", error.text);
        if (!make_name(m->names[k], sizeof m->names[k], job->ends, job->prefix, t))
            return CLI_FAILURE;
        if (!job->replace && hnbrdf_model_find(model, m->names[k]) >= 0)
            return cli_fail_name_taken(job->path, m->names[k]);
        m->changes[k].kind = job->replace ? HNBRDF_CHANGE_PUT : HNBRDF_CHANGE_ADD;
        m->changes[k].name = m->names[k];
        m->changes[k].material = &m->materials[k];
        m->changes[k].lobes = HNBRDF_LOBES_FIT;
    }
    return CLI_OK;
}

static int write_mixed(const mix_job *job, const hnbrdf_model *model,
                       const hnbrdf_material_change *changes)
{
    hnbrdf_model *made = NULL;
    hnbrdf_error error;
    int count = job->sweep.count, before = hnbrdf_model_material_count(model);
    if (hnbrdf_model_with_materials(model, changes, count, NULL, &made, &error) != HNBRDF_OK ||
        hnbrdf_model_save(made, job->output, &error) != HNBRDF_OK) {
        hnbrdf_model_free(made);
        return cli_fail("%s", error.text);
    }
    int after = hnbrdf_model_material_count(made);
    printf("%s: %d material%s from %s to %s, %d new\n", job->output, count, count == 1 ? "" : "s",
           job->ends[0], job->ends[1], after - before);
    for (int k = before; k < after; k++)
        printf("  %s\n", hnbrdf_model_material_name(made, k));
    hnbrdf_model_free(made);
    return CLI_OK;
}

static int run(const mix_job *job)
{
    hnbrdf_model *model;
    if (cli_open_model_to_change(job->path, job->output, &model) != CLI_OK)
        return CLI_FAILURE;
    mixtures *m = calloc(1, sizeof *m);
    int result = m ? mix_all(job, model, m) : cli_fail("out of memory");
    if (result == CLI_OK)
        result = write_mixed(job, model, m->changes);
    free(m);
    hnbrdf_model_free(model);
    return result;
}

int cmd_mix(int argc, char **argv)
{
    mix_job job = {.path = NULL};
    const char *t = NULL;
    int count;
    const cli_option options[] = {
        {"t", 't', CLI_TEXT, &t, 0, 0, "T",
         "0 is A, 1 is B; FIRST:LAST:STEP for several (required)"},
        {"as", 0, CLI_TEXT, &job.prefix, 0, 0, "PREFIX", "what the names begin with (default A-B)"},
        {"straight", 0, CLI_FLAG, &job.straight, 0, 0, NULL,
         "straight through the latent space, as texture filtering goes"},
        {"replace", 0, CLI_FLAG, &job.replace, 0, 0, NULL, "overwrite materials of these names"},
        {"output", 'o', CLI_WRITE_MODEL, &job.output, 0, 0, "OUT",
         "the model file to write (default: MODEL, rewritten)"},
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != 3)
        return cli_usage(
            &command, "found %d arguments, expected MODEL and the names of two materials", count);
    if (!t)
        return cli_usage(&command, "no --t T");
    result = read_sweep(t, &job.sweep);
    if (result >= 0)
        return result;
    job.path = argv[1];
    job.ends[0] = argv[2];
    job.ends[1] = argv[3];
    job.output = job.output ? job.output : job.path;
    return run(&job);
}
