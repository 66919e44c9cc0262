/* cmd_edit.c: `hnbrdf edit`: change a material of a model by hand: colour, refraction, roughness,
 * angle. */
#include "cli/cli.h"
#include "hnbrdf/edit.h"
#include "base/text.h"

#include <stddef.h>
#include <string.h>

static const cli_command command = {
    "edit",
    "MODEL --set FIELD=VALUE[,...] [--material A] [--as B] [-o OUT]",
    "Changes fields of a material's analytic part; the network and the latent code stay as they "
    "are.\n"
    "Without --as the material itself changes, with it a copy is added under that name.\n"
    "\n"
    "Fields: kd (diffuse albedo, 0 to 1) and eta (index of refraction, above 1), one value or "
    "three "
    "for\n"
    "R:G:B; alpha (roughness, 0.0001 to 1), one value or two for x:y; alpha_x; alpha_y; rotation "
    "of x "
    "and\n"
    "y about the normal, counter-clockwise, in radians or as in 30deg. FIELD*=VALUE multiplies,\n"
    "FIELD+=VALUE adds. Two different alphas make an isotropic material anisotropic.",
    "hnbrdf edit model.safetensors --material gold --set alpha=0.2,kd=0.1:0.2:0.3 --as dull-gold\n"
    "hnbrdf edit model.safetensors --material gold --set alpha=0.1:0.4,rotation=30deg --as "
    "brushed-gold\n"
    "hnbrdf edit model.safetensors --material gold --set alpha*=2,eta+=0.1 -o edited.safetensors",
};

typedef struct field {
    const char *name;
    size_t offset; /* in hnbrdf_material */
    int count;     /* floats there */
} field;

static const field fields[] = {
    {"kd", offsetof(hnbrdf_material, kd), 3},
    {"eta", offsetof(hnbrdf_material, eta), 3},
    {"alpha", offsetof(hnbrdf_material, alpha), 2},
    {"alpha_x", offsetof(hnbrdf_material, alpha), 1},
    {"alpha_y", offsetof(hnbrdf_material, alpha) + sizeof(float), 1},
    {"rotation", offsetof(hnbrdf_material, rotation), 1},
};
enum { FIELDS = sizeof fields / sizeof fields[0], MAX_EDITS = 32, MAX_VALUES = 3 };

/* FIELD=VALUE[:VALUE...], or with *= or +=. */
typedef struct edit {
    const field *field;
    char operation; /* '=', '*' or '+' */
    float values[MAX_VALUES];
    int count; /* 1: the same for every float of the field */
} edit;

/* ---- Reading --set --------------------------------------------------------------------------- */

static const field *find_field(const char *name, size_t length)
{
    char word[HNBRDF_MAX_NAME + 1];
    cli_guess guess;
    snprintf(word, sizeof word, "%.*s", (int)length, name);
    cli_guess_begin(&guess, word);
    for (int k = 0; k < FIELDS; k++) {
        if (strcmp(word, fields[k].name) == 0)
            return &fields[k];
        cli_guess_offer(&guess, fields[k].name);
    }
    const char *nearest = cli_guess_nearest(&guess);
    cli_usage(&command,
              "--set: no field '%s', expected kd, eta, alpha, alpha_x, alpha_y or rotation%s%s%s",
              word, nearest ? " (did you mean " : "", nearest ? nearest : "", nearest ? "?)" : "");
    return NULL;
}

/* One number, of an angle also with a unit. NULL if there is none that goes up to ':' or the end.
 * */
static const char *read_value(const edit *e, const char *from, const char *end, float *value)
{
    int is_angle = e->field->offset == offsetof(hnbrdf_material, rotation) && e->operation != '*';
    const char *to = hnbrdf_parse_float(from, end, value);
    if (to && is_angle && end - to >= 3 && strncmp(to, "deg", 3) == 0) {
        *value = (float)((double)*value * (3.14159265358979324 / 180.0));
        to += 3;
    } else if (to && is_angle && end - to >= 3 && strncmp(to, "rad", 3) == 0) {
        to += 3;
    }
    return to && (to == end || *to == ':') ? to : NULL;
}

static int read_values(edit *e, const char *from, const char *end)
{
    for (;;) {
        float value;
        const char *to = read_value(e, from, end, &value);
        if (!to)
            return cli_usage(
                &command, "--set %s: '%.*s' is not %s", e->field->name, (int)(end - from), from,
                e->field->count > 1 ? "a number, or numbers with ':' between" : "a number");
        if (e->count < MAX_VALUES)
            e->values[e->count] = value;
        e->count++;
        if (to == end)
            break;
        from = to + 1;
    }
    if (e->count == 1 || e->count == e->field->count)
        return -1;
    return cli_usage(&command, "--set %s: found %d values, expected %s%s", e->field->name, e->count,
                     e->field->count == 1   ? "1"
                     : e->field->count == 2 ? "1 or 2"
                                            : "1 or 3",
                     e->field->count == 3   ? ", R:G:B"
                     : e->field->count == 2 ? ", x:y"
                                            : "");
}

/* The assignment in [from, end). Returns -1 to go on, as cli_parse() does. */
static int read_edit(edit *e, const char *from, const char *end)
{
    const char *equals = memchr(from, '=', (size_t)(end - from));
    if (!equals)
        return cli_usage(&command, "--set: '%.*s' is not FIELD=VALUE", (int)(end - from), from);
    const char *name_end = equals;
    e->operation = '=';
    if (equals > from && (equals[-1] == '*' || equals[-1] == '+'))
        e->operation = *--name_end;
    e->count = 0;
    e->field = find_field(from, (size_t)(name_end - from));
    return e->field ? read_values(e, equals + 1, end) : CLI_USAGE;
}

static int read_edits(const char *list, edit *edits, int *count)
{
    for (*count = 0;; list++) {
        const char *end = list + strcspn(list, ",");
        if (*count == MAX_EDITS)
            return cli_usage(&command, "--set: more than %d fields", (int)MAX_EDITS);
        int result = read_edit(&edits[(*count)++], list, end);
        if (result >= 0)
            return result;
        if (*end == '\0')
            return -1;
        list = end;
    }
}

/* ---- Applying -------------------------------------------------------------------------------- */

static void apply(const edit *e, hnbrdf_material *material)
{
    float *at = (float *)(void *)((char *)material + e->field->offset);
    for (int k = 0; k < e->field->count; k++) {
        float value = e->values[e->count > 1 ? k : 0];
        at[k] = e->operation == '=' ? value : e->operation == '*' ? at[k] * value : at[k] + value;
    }
}

static void print_values(const float *values, int count)
{
    int equal = 1;
    for (int k = 1; k < count; k++)
        equal = equal && values[k] == values[0];
    for (int k = 0; k < (equal ? 1 : count); k++)
        printf("%s%.6g", k ? ":" : "", (double)values[k]);
}

static void print_changes(const hnbrdf_material *before, const hnbrdf_material *after)
{
    for (int k = 0; k < FIELDS; k++) {
        const float *from = (const float *)(const void *)((const char *)before + fields[k].offset);
        const float *to = (const float *)(const void *)((const char *)after + fields[k].offset);
        int is_part = strncmp(fields[k].name, "alpha_", 6) == 0; /* shown as alpha x:y */
        if (is_part || memcmp(from, to, (size_t)fields[k].count * sizeof *from) == 0)
            continue;
        printf("  %-8s  ", fields[k].name);
        print_values(from, fields[k].count);
        printf(" -> ");
        print_values(to, fields[k].count);
        printf("\n");
    }
}

/* What --as asks for: the material itself, or one under another name. */
typedef struct edit_job {
    const char *path, *output, *material, *as;
    int replace; /* a material of the name `as` may be overwritten */
    edit edits[MAX_EDITS];
    int edit_count;
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
    for (int k = 0; k < job->edit_count; k++)
        apply(&job->edits[k], &after);
    const hnbrdf_material_change change = {
        .name = to, .material = &after, .lobes = HNBRDF_LOBES_FIT};
    if (!job->replace && strcmp(to, from) != 0 && hnbrdf_model_find(model, to) >= 0)
        return cli_fail_name_taken(job->path, to);
    if (hnbrdf_model_with_materials(model, &change, 1, NULL, &made, &error) != HNBRDF_OK ||
        hnbrdf_model_save(made, job->output, &error) != HNBRDF_OK) {
        hnbrdf_model_free(made);
        return cli_fail("%s", error.text);
    }
    hnbrdf_model_free(made);
    printf("%s: %s%s%s\n", job->output, to, job->as ? " from " : " changed", job->as ? from : "");
    print_changes(before, &after);
    return CLI_OK;
}

static int run(const edit_job *job)
{
    hnbrdf_model *model;
    if (cli_open_model(job->path, &model) != CLI_OK)
        return CLI_FAILURE;
    int index = cli_choose_material(model, job->material);
    int result = index < 0 ? CLI_FAILURE : edit_material(job, model, index);
    hnbrdf_model_free(model);
    return result;
}

int cmd_edit(int argc, char **argv)
{
    edit_job job = {.path = NULL};
    const char *set = NULL;
    int count;
    const cli_option options[] = {
        {"material", 'm', CLI_TEXT, &job.material, 0, 0, "NAME",
         "the material to start from; needed when the model has several"},
        {"set", 's', CLI_TEXT, &set, 0, 0, "LIST", "what to change (required)"},
        {"as", 0, CLI_TEXT, &job.as, 0, 0, "NAME",
         "keep the material, add the edited one under this name"},
        {"replace", 0, CLI_FLAG, &job.replace, 0, 0, NULL,
         "--as may overwrite a material of that name"},
        {"output", 'o', CLI_TEXT, &job.output, 0, 0, "OUT",
         "the model file to write (default: MODEL, rewritten)"},
        {0},
    };
    int result = cli_parse(&command, options, argc, argv, &count);
    if (result >= 0)
        return result;
    if (count != 1)
        return cli_usage(&command, count ? "more than one MODEL" : "no MODEL");
    if (!set)
        return cli_usage(&command, "nothing to change, expected --set FIELD=VALUE");
    result = read_edits(set, job.edits, &job.edit_count);
    job.path = argv[1];
    job.output = job.output ? job.output : job.path;
    return result >= 0 ? result : run(&job);
}
