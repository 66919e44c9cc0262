/* cmd_report_editing.c: `hnbrdf report editing`: how far edited and mixed materials are from what
 * the edit means. */
#include "cli/report.h"
#include "cli/words.h"

#include "base/interrupt.h"
#include "report/editing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "report",
    "editing -o DIR [options]",
    "Procedural families of materials, whose truth after an edit is known, are fitted together\n"
    "with the built-in materials. Their members, alpha 0.08, 0.16 and 0.3, are then edited in\n"
    "alpha, eta, kd, colour, anisotropy and rotation, and compared with the truth: as they were,\n"
    "edited, the GGX part alone edited, and the network, frozen, fitted to the truth. Then\n"
    "mixtures, as `mix` makes them: half way between two members of a family against the member\n"
    "there; and for all pairs of materials, whether the albedo stays between those of the ends.\n"
    "DIR gets report.md, editing.csv (a row a member, edit and model), mixtures.csv, editing.svg,\n"
    "contact sheets editing-alpha.png and editing-others.png (EXR beside), and the models.\n"
    "--model measures a model that is there: of its materials those named as members are, FAMILY\n"
    "and alpha as in plastic-0.16; mixtures are measured of all.\n"
    "Written anew after each member; Ctrl-C keeps what is done.",
    "hnbrdf report editing -o editing\n"
    "hnbrdf report editing --families two-lobe,plastic,film -o three\n"
    "hnbrdf report editing --model editing/isotropic.safetensors --images 0 -o again\n"
    "hnbrdf report editing --model examples/models/rgl_32x2.safetensors -o mixtures",
};

/* ---- Options --------------------------------------------------------------------------------- */

static void list_families(char *text, size_t size)
{
    size_t at = 0;
    for (int f = 0; hnbrdf_family_name(f); f++)
        at += (size_t)snprintf(text + at, size - at, "%s%s", f ? ", " : "", hnbrdf_family_name(f));
}

/* -1 to go on; chosen[family] is then 1 for those in the list. */
static int read_families(const char *list, int *chosen)
{
    while (*list) {
        size_t length = strcspn(list, ",");
        int f = 0;
        while (hnbrdf_family_name(f) && (strlen(hnbrdf_family_name(f)) != length ||
                                         strncmp(list, hnbrdf_family_name(f), length) != 0))
            f++;
        if (!hnbrdf_family_name(f)) {
            char names[256];
            list_families(names, sizeof names);
            return cli_usage(&command, "--families: '%.*s' is none of %s", (int)length, list,
                             names);
        }
        chosen[f] = 1;
        list += length + (list[length] == ',');
    }
    return -1;
}

/* Returns 0, or CLI_FAILURE after a message. */
static int check_model(const char *path, const hnbrdf_model *model)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    return desc.kind == HNBRDF_KIND_HYBRID
               ? CLI_OK
               : cli_fail("%s: a %s model, expected a hybrid, whose analytic part can be edited",
                          path, hnbrdf_kind_name(desc.kind));
}

/* ---- Output ---------------------------------------------------------------------------------- */

static void print_number(double value, int digits)
{
    if (isnan(value))
        printf("  %9s", "");
    else
        printf("  %9.*f", digits, value);
}

static void print_edits(const editing_report *r)
{
    printf("%-16s  %9s  %9s  %9s  %9s%s\n", "SMAPE of the edit", "unedited", "edited", "GGX",
           "frozen", r->image_size ? "    PSNR, dB: the same" : "");
    for (int e = 0; e < editing_edit_count; e++) {
        char name[48];
        editing_edit_name(&editing_edits[e], name, sizeof name);
        if (isnan(editing_mean(r, -1, e, EDITING_EDITED, 0, NULL)))
            continue;
        printf("%-16s ", name);
        for (int psnr = 0; psnr <= (r->image_size > 0); psnr++)
            for (int way = 0; way < EDITING_WAYS; way++)
                print_number(editing_mean(r, -1, e, (editing_way)way, psnr, NULL), psnr ? 2 : 4);
        putchar('\n');
    }
}

static void print_mixtures(const editing_report *r)
{
    for (int k = 0; k < r->model_count; k++)
        if (!isnan(editing_mean_half(r, k)))
            printf("%s: half way between two members, mean SMAPE %.4f\n", r->models[k].name,
                   editing_mean_half(r, k));
    for (int s = 0; s < r->pair_set_count; s++) {
        const editing_pairs *set = &r->pair_sets[s];
        printf("%s: albedo between the ends' in %d of %d mixtures, throughout for %d of %d pairs\n",
               r->models[set->model].name, set->within, set->mixtures, set->all, set->pairs);
    }
}

/* ---- Command --------------------------------------------------------------------------------- */

static hnbrdf_result measure(editing_report *r)
{
    hnbrdf_result result = editing_begin(r);
    for (int m = 0; m < r->count && !result; m++) {
        result = report_stop(&r->watch) ? editing_interrupted(r) : editing_measure(r, m);
        if (!result)
            result = editing_write(r);
    }
    if (!result)
        result = editing_measure_mixtures(r);
    if (!result)
        result = editing_write(r);
    if (!result && r->count && r->sheet_size)
        result = editing_write_sheets(r);
    return result;
}

static int run(editing_report *r)
{
    cli_progress progress;
    hnbrdf_error error;
    r->error = &error;
    r->watch = cli_watch(&progress);
    r->spheres.light = r->light;
    r->spheres.light.threads = r->threads;
    r->spheres.size = r->image_size;
    r->spheres.watch.stop = r->watch.stop;
    r->spheres.count = 1;
    cli_progress_begin(&progress, "report");
    hnbrdf_catch_interrupts(1);
    hnbrdf_result result = report_make_folder(r->directory, &error);
    if (!result)
        result = report_spheres_open(&r->spheres, &error);
    if (!result)
        result = measure(r);
    hnbrdf_catch_interrupts(0);
    cli_progress_end(&progress);
    if (!result && r->count)
        print_edits(r);
    if (!result && !r->count)
        cli_warn("%s: has no member of the families, such as plastic-0.16: its mixtures alone",
                 r->given_name);
    if (!result) {
        print_mixtures(r);
        printf("%s/report.md: tables, plot and pictures; SMAPE, 0 is perfect, 2 the worst\n",
               r->directory);
    }
    editing_free(r);
    return cli_code(result, &error);
}

/* What --quick stands for, where nothing else is asked for. */
static void fill_defaults(editing_report *r, int quick)
{
    if (!r->net[0])
        memcpy(r->net, quick ? (int[2]){16, 2} : (int[2]){32, 2}, sizeof r->net);
    r->alone = quick;
    r->steps = r->steps ? r->steps : quick ? 300 : 30000;
    r->frozen_steps = quick ? 4 : 0; /* 0: as `fit` does */
    r->pool = r->pool ? r->pool : quick ? 512 : 0;
    r->pairs = r->pairs ? r->pairs : quick ? 1000 : 50000;
    r->image_size = r->image_size >= 0 ? r->image_size : quick ? 16 : 64;
    r->sheet_size = r->image_size ? quick ? 48 : 136 : 0;
    r->light.spp = quick ? 4 : REPORT_IMAGE_SAMPLES;
}

int cmd_report_editing(int argc, char **argv)
{
    editing_report r = {.seed = 1, .image_size = -1, .light = PICTURE_DEFAULTS(0)};
    char names[256], families_help[320];
    int chosen[32] = {0}, quick = 0, count;
    const char *families = NULL;
    cli_word sampler = {HNBRDF_SAMPLER_GRID, cli_sampler_word};
    list_families(names, sizeof names);
    snprintf(families_help, sizeof families_help, "default all: %s", names);
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_FOLDER, &r.directory, 0, 0, "DIR",
         "the folder to write (required); made if missing"},
        {"model", 0, CLI_READ, &r.given_name, 0, 0, "FILE",
         "measure this model; nothing is fitted but what is compared"},
        {"families", 0, CLI_TEXT, &families, 0, 0, "LIST", families_help},
        {"net", 0, CLI_NET, r.net, 0, 0, "HxN", "of the fit (default 32x2)"},
        {"steps", 0, CLI_INT, &r.steps, 1, 1e9, "N", "of the fit (default 30000)"},
        {"pool", 0, CLI_INT, &r.pool, 64, 1 << 26, "N",
         "direction pairs drawn a material for training"},
        {"sampler", 0, CLI_WORD, &sampler, 0, 0, "uniform|cosine|grid",
         "of the errors (default grid)"},
        {"pairs", 'n', CLI_INT, &r.pairs, 1, 1e9, "N", "pairs of directions (default 50000)"},
        {"images", 0, CLI_INT, &r.image_size, 0, 2048, "N",
         "pixels a side of the spheres; 0: none, no sheets either (default 64)"},
        {"seed", 0, CLI_INT, &r.seed, 0, 9e15, "N", "seed of everything random (default 1)"},
        {"quick", 0, CLI_FLAG, &quick, 0, 0, NULL,
         "a try: members alone, 16x2, 300 steps, 1000 pairs, unless asked for otherwise"},
        {"threads", 't', CLI_INT, &r.threads, 1, 256, "N",
         "threads (default one a core); change no figure"},
        {0},
    };
    char *line = report_join(argc, argv);
    hnbrdf_model *given = NULL;
    int code = line ? cli_parse(&command, options, argc, argv, &count) : cli_fail("out of memory");
    r.command_line = line;
    r.sampler = sampler.value;
    if (code < 0 && count > 1)
        code = cli_usage(&command, "'%s': takes no DATA, see --families", argv[2]);
    if (code < 0 && !r.directory)
        code = cli_usage(&command, "no folder given, expected -o DIR");
    if (code < 0 && r.given_name && r.steps)
        code = cli_usage(&command, "--steps and --model exclude each other");
    if (code < 0 && families) {
        code = read_families(families, chosen);
        r.families = chosen;
    }
    if (code < 0 && r.given_name && cli_open_model(r.given_name, &given) != CLI_OK)
        code = CLI_FAILURE;
    if (code < 0 && given && check_model(r.given_name, given) != CLI_OK)
        code = CLI_FAILURE;
    if (code < 0) {
        r.given = given;
        fill_defaults(&r, quick);
        code = run(&r);
    }
    hnbrdf_model_free(given);
    free(line);
    return code;
}
