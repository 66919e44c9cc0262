/* cmd_report_sampling.c: `hnbrdf report sampling`: noise of drawing directions in several ways. */
#include "cli/report.h"

#include "base/interrupt.h"
#include "report/sampling.h"

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "report",
    "sampling MODEL... -o DIR [options]",
    "Renders spheres of the models' materials with directions drawn from the BRDF alone, in five "
    "ways:\n"
    "cosine alone; the paper's scheme (half cosine, half GGX normals); one GGX lobe with a share "
    "guessed\n"
    "from kd and eta; the fitted lobes; a table of the whole BRDF (Lawrence et al. 2004, 5.6 MB a\n"
    "material; isotropic ones). DIR gets sampling.md (variance over that of the table, and "
    "efficiency,\n"
    "1/(variance x time)), sampling.csv (a row a material, sampler and number of samples), "
    "sampling.svg\n"
    "and strips of pictures. Written anew after each material; Ctrl-C keeps what is done.",
    "hnbrdf report sampling model.safetensors --quick -o sampling\n"
    "hnbrdf report sampling rgl.safetensors merl.safetensors --most 20 --env uffizi.hdr -o "
    "sampling",
};

/* Of each model at most `most` materials, spread evenly. 0, or CLI_FAILURE after a message. */
static int choose_subjects(sampling_report *r, hnbrdf_model **models, char *const *paths, int count,
                           long most, long strips)
{
    int total = 0;
    for (int k = 0; k < count; k++)
        total += hnbrdf_model_material_count(models[k]);
    r->subjects = calloc((size_t)total, sizeof *r->subjects);
    if (!r->subjects)
        return cli_fail("out of memory");
    for (int k = 0; k < count; k++) {
        long have = hnbrdf_model_material_count(models[k]), want = have < most ? have : most;
        for (long i = 0; i < want; i++) {
            sampling_subject *s = &r->subjects[r->count++];
            int m = (int)(i * have / want);
            s->model = models[k];
            s->file = paths[k];
            s->name = hnbrdf_model_material_name(models[k], m);
            s->material = hnbrdf_model_material(models[k], m);
        }
    }
    for (int m = 0; m < r->count; m++)
        r->subjects[m].has_strip = (long)(m + 1) * strips / r->count > (long)m * strips / r->count;
    return CLI_OK;
}

static void print_subject(const sampling_subject *s)
{
    printf("%-28s %7.4f", s->name, (double)s->material->alpha[0]);
    for (int way = 0; way < SAMPLING_WAYS; way++)
        printf("  %9.3g", sampling_ratio(s, 0, (sampling_way)way, SAMPLING_TABULATED));
    putchar('\n');
    fflush(stdout);
}

static void print_means(const sampling_report *r)
{
    char stratified[40];
    snprintf(stratified, sizeof stratified, "%d stratified samples", r->counts[r->at]);
    for (int row = 0; row < 2; row++) {
        printf("%-28s %7s", row ? stratified : "mean", "");
        for (int way = 0; way < SAMPLING_WAYS; way++)
            printf("  %9.3g", sampling_mean_ratio(r, row ? r->at : 0, (sampling_way)way,
                                                  SAMPLING_TABULATED, 2.0));
        putchar('\n');
    }
    printf("%-28s %7s", "efficiency over the table's", "");
    for (int way = 0; way < SAMPLING_WAYS; way++)
        printf("  %9.3g", sampling_mean_efficiency(r, (sampling_way)way));
}

static void print_heading(const sampling_report *r)
{
    printf("variance of one sample over that of the table, %s\n%-28s %7s", r->light.env, "material",
           "alpha");
    for (int way = 0; way < SAMPLING_WAYS; way++)
        printf("  %9s", sampling_name((sampling_way)way));
    putchar('\n');
}

static int run(sampling_report *r)
{
    cli_progress progress;
    hnbrdf_error error;
    hnbrdf_result result = HNBRDF_OK;
    int stopped = 0;
    r->watch = cli_watch(&progress);
    r->error = &error;
    print_heading(r);
    cli_progress_begin(&progress, "sampling");
    hnbrdf_catch_interrupts(1);
    for (int m = 0; m < r->count && result == HNBRDF_OK && !stopped; m++) {
        result = sampling_measure(r, m);
        if (result == HNBRDF_OK) {
            print_subject(&r->subjects[m]);
            result = sampling_write(r);
        }
        stopped = hnbrdf_interrupted() ? m + 1 : 0;
    }
    hnbrdf_catch_interrupts(0);
    cli_progress_end(&progress);
    if (result != HNBRDF_OK)
        return cli_code(result, &error);
    if (stopped)
        return cli_fail("interrupted after %d of %d materials; what is done is in %s", stopped,
                        r->count, r->directory);
    print_means(r);
    printf("\n\n%s/sampling.md: tables, plot and pictures\n", r->directory);
    return cli_code(sampling_write_strips(r), &error);
}

static int open_models(sampling_report *r, char *const *paths, int count, long most, long strips)
{
    hnbrdf_model **models = calloc((size_t)count, sizeof *models);
    int code = models ? CLI_OK : cli_fail("out of memory");
    for (int k = 0; k < count && code == CLI_OK; k++)
        code = cli_open_model(paths[k], &models[k]);
    if (code == CLI_OK)
        code = choose_subjects(r, models, paths, count, most, strips);
    if (code == CLI_OK)
        code = picture_open_light(&r->light, &r->environment);
    if (code == CLI_OK) {
        code = cli_make_folder(r->directory);
        if (code == CLI_OK)
            code = run(r);
        render_environment_free(&r->environment);
    }
    for (int m = 0; m < r->count; m++) {
        render_image_free(&r->subjects[m].reference);
        for (int n = 0; n < SAMPLING_STRIP_COUNTS; n++)
            for (int way = 0; way < SAMPLING_WAYS; way++)
                render_image_free(&r->subjects[m].strips[n][way]);
    }
    free(r->subjects);
    for (int k = 0; k < count && models; k++)
        hnbrdf_model_free(models[k]);
    free(models);
    return code;
}

/* Powers of 4 up to `most` and that itself; the table's are the one nearest to `at`. */
static void choose_counts(sampling_report *r, long most, long at)
{
    for (long n = 1; n < most && r->count_count < SAMPLING_COUNTS - 1; n *= 4)
        r->counts[r->count_count++] = (int)n;
    r->counts[r->count_count++] = (int)most;
    while (r->at + 1 < r->count_count && r->counts[r->at + 1] <= at)
        r->at++;
    r->strips[0] = r->count_count > 1 ? 1 : 0;
    r->strips[1] = r->at;
}

int cmd_report_sampling(int argc, char **argv)
{
    sampling_report r = {.light = PICTURE_DEFAULTS(8192)};
    int quick = 0, count;
    long most = 1 << 20, spp = 1024, strips = 3;
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_FOLDER, &r.directory, 0, 0, "DIR",
         "the folder to write (required); made if missing"},
        {"most", 0, CLI_INT, &most, 1, 1 << 20, "N",
         "at most so many materials of each model (default all)"},
        {"size", 0, CLI_INT, &r.size, 4, 2048, "N", "pixels a side of the spheres (default 48)"},
        {"samples", 0, CLI_INT, &spp, 1, 65536, "N",
         "most samples a pixel (default 1024); fewer by powers of 4"},
        {"strips", 0, CLI_INT, &strips, 0, 64, "N",
         "materials in the strips of pictures (default 3)"},
        {"quick", 0, CLI_FLAG, &quick, 0, 0, NULL,
         "a try: 24 pixels, 64 samples, reference of 1024"},
        PICTURE_OPTIONS(r.light, "8192, of the reference"),
        {0},
    };
    char *line = report_join(argc, argv);
    int result =
        line ? cli_parse(&command, options, argc, argv, &count) : cli_fail("out of memory");
    r.command_line = line;
    if (result < 0 && count < 2)
        result = cli_usage(&command, "no MODEL given");
    if (result < 0 && !r.directory)
        result = cli_usage(&command, "no folder given, expected -o DIR");
    if (result < 0) {
        if (quick) {
            r.light.spp = r.light.spp == 8192 ? 1024 : r.light.spp;
            spp = spp == 1024 ? 64 : spp;
        }
        if (r.size == 0)
            r.size = quick ? 24 : 48;
        choose_counts(&r, spp, 64);
        result = open_models(&r, argv + 2, count - 1, most, strips);
    }
    free(line);
    return result;
}
