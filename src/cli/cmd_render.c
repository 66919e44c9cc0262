/* cmd_render.c: `hnbrdf render`: a sphere or a mesh of one material, as OpenEXR with a PNG beside
 * it. */
#include "cli/picture.h"
#include "report/still.h"
#ifdef HNBRDF_WITH_VULKAN
#include "gpu/picture.h"
#endif

#include <stdlib.h>
#include <string.h>

static const cli_command command = {
    "render",
    "SOURCE [--material NAME] [--mesh FILE.obj] [options] -o FILE.exr",
    "Renders a sphere, or a mesh, under an environment, one bounce of light. SOURCE is a model "
    "file, a\n"
    "measured file or builtin:NAME. FILE.exr gets linear radiance (float, ZIP), FILE.png beside it "
    "the\n"
    "same times 2^exposure, clamped to [0, 1] and through the sRGB curve. With -o FILE.png there "
    "is no EXR.\n"
    "The camera looks along -z, y is up; the middle column of a map lies straight ahead of it.\n"
    "A mesh may have any size and place: the camera sees all of its faces. Lines, points and "
    "curves are\n"
    "not drawn, and what a file lacks is computed; a warning says so.",
    "hnbrdf render builtin:clear-coat-red -o red.exr\n"
    "hnbrdf render model.safetensors --material gold-two-lobe --spp 256 -o gold.exr\n"
    "hnbrdf render model.safetensors --material gold-two-lobe --analytic -o gold_ggx.png\n"
    "hnbrdf render model.safetensors --material gold-two-lobe --env furnace --exposure -1 \\\n"
    "    --background env -o furnace.exr    # brighter than the ground: gives off more than it "
    "gets\n"
    "hnbrdf render chrome.binary --env studio.hdr --rotate 90 --background env -o chrome.exr\n"
    "hnbrdf render model.safetensors --material gold-two-lobe --device 0 --check -o gold.exr\n"
    "hnbrdf render --mesh bunny.obj model.safetensors --material gold-two-lobe --turn 30 -o "
    "bunny.exr\n"
    "hnbrdf render --mesh bunny.obj model.safetensors --material gold-two-lobe --bounces 8 --time "
    "60 \\\n"
    "    --spp 65536 -o bunny.exr           # light between its parts too; a minute's worth of it",
};

typedef struct render_command {
    const char *path, *material, *output;
    const char *device; /* of Vulkan; NULL: the CPU */
    int check;
    cli_source source;
    report_still still;
} render_command;

static int open_source(render_command *c)
{
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_NEURAL};
    hnbrdf_error error;
    if (cli_open_source(c->path, &c->source) != CLI_OK)
        return CLI_FAILURE;
    c->still.model = c->source.model;
    c->still.measured = c->source.measured;
    c->still.material = cli_choose_source_material(&c->source, c->material);
    if (c->still.material < 0)
        return CLI_FAILURE;
    if (c->still.model)
        hnbrdf_model_describe(c->still.model, &desc);
    if ((c->still.analytic || c->still.layers) && desc.kind == HNBRDF_KIND_NEURAL)
        return cli_fail(
            "%s has no analytic part: --analytic and --layers are for hybrid and ggx models",
            c->path);
    if (c->device && !c->still.model)
        return cli_fail("%s is no model: --device renders what `hnbrdf export` can write", c->path);
    return cli_code(report_spheres_open(&c->still.spheres, &error), &error);
}

/* ---- On a device ----------------------------------------------------------------------------- */

#ifdef HNBRDF_WITH_VULKAN
static int check(render_command *c, cli_progress *line, int exact)
{
    const render_options options = report_still_options(&c->still);
    report_same_picture same;
    hnbrdf_error error;
    double seconds;
    cli_progress_begin(line, "rendering on the CPU");
    hnbrdf_result result = report_still_check(&c->still, &same, &seconds, &error);
    cli_progress_end(line);
    if (result != HNBRDF_OK)
        return cli_fail("%s", error.text);
    int threads = options.threads > 0 ? options.threads : cli_processors();
    printf("CPU, %d thread%s: %.0f ns a sample\n", threads, threads == 1 ? "" : "s",
           seconds * 1e9 / ((double)options.size * options.size * options.spp));
    report_same_picture_print(&same, exact, stdout);
    return exact && same.apart > 0 ? cli_fail("the device computes + - * / sqrt exactly, and its "
                                              "picture is not the CPU's")
                                   : CLI_OK;
}

static void begin_on_device(void *progress, const char *device)
{
    cli_progress_begin(&((picture_progress *)progress)->line, device);
}

static int render_on_device(render_command *c, picture_progress *progress)
{
    report_still *still = &c->still;
    gpu_picture_report made;
    hnbrdf_error error;
    char *end;
    gpu_picture job = {.device = strtol(c->device, &end, 10),
                       .model = still->model,
                       .material = still->material,
                       .environment = &still->spheres.environment,
                       .options = report_still_options(still),
                       .begin = begin_on_device,
                       .begin_user = progress};
    if (end == c->device || *end)
        return cli_fail("--device: found '%s', expected a number (hnbrdf verify --list)",
                        c->device),
               CLI_USAGE;
    job.options.progress = picture_report;
    job.options.progress_user = progress;
    hnbrdf_result result = gpu_picture_render(&job, &still->image, &made, &error);
    cli_progress_end(&progress->line);
    if (result != HNBRDF_OK)
        return cli_fail("%s", error.text);
    printf("%s: %.0f ns a sample\n", made.device, made.sample_ns);
    return c->check ? check(c, &progress->line, made.exact) : CLI_OK;
}
#else
static int render_on_device(render_command *c, picture_progress *progress)
{
    (void)c, (void)progress;
    return cli_fail("--device: this hnbrdf was built without Vulkan (HNBRDF_WITH_VULKAN)");
}
#endif

/* ---- On the CPU ------------------------------------------------------------------------------ */

static int render_on_cpu(report_still *still, cli_progress *line)
{
    render_outcome outcome;
    hnbrdf_error error;
    picture_begin(line, "rendering", still->mesh.path != NULL);
    hnbrdf_result result = report_still_render(still, &outcome, &error);
    picture_end(line, result == HNBRDF_OK ? &outcome : NULL, still->spheres.light.spp);
    return cli_code(result, &error);
}

static int run(render_command *c)
{
    report_still *still = &c->still;
    hnbrdf_error error;
    picture_progress progress = {.count = 1};
    still->spheres.watch = cli_watch(&progress.line);
    int code = open_source(c);
    if (code == CLI_OK)
        code = c->device ? render_on_device(c, &progress) : render_on_cpu(still, &progress.line);
    return code == CLI_OK ? cli_code(report_still_write(still, c->output, &error), &error) : code;
}

/* -1 to go on, as cli_parse() does. */
static int check_options(render_command *c)
{
    const report_still *still = &c->still;
    if (c->check && !c->device)
        return cli_usage(&command,
                         "--check compares a device with the CPU: expected --device N too");
    if (c->device && (still->analytic || still->layers))
        return cli_usage(&command, "--analytic and --layers are for the CPU, without --device");
    if (!still->mesh.path && (still->job.bounces > 1 || still->job.seconds > 0.0 ||
                              still->job.resume || still->mesh.smooth || still->job.clamp > 0.0))
        return cli_usage(&command,
                         "--bounces, --time, --resume, --clamp and --smooth are for --mesh");
    if (still->mesh.path && (still->layers || c->device))
        return cli_usage(&command, "--layers and --device are for the sphere, without --mesh");
    return picture_check_output(&command, c->output);
}

int cmd_render(int argc, char **argv)
{
    render_command c = {.still = {.spheres = {.size = 512, .light = PICTURE_DEFAULTS(64)},
                                  .mesh = {.tilt = 15.0, .notes = CLI_NOTES},
                                  .job = {.bounces = 1}}};
    report_still *still = &c.still;
    const cli_option options[] = {
        {"material", 0, CLI_TEXT, &c.material, 0, 0, "NAME", "of a model with several"},
        {"output", 'o', CLI_WRITE_PICTURE, &c.output, 0, 0, "FILE",
         "FILE.exr (and FILE.png beside it) or FILE.png"},
        {"size", 0, CLI_INT, &still->spheres.size, 1, 8192, "N", "pixels a side, default 512"},
        PICTURE_OPTIONS(still->spheres.light, "64"),
        {"background", 0, CLI_CHOICE, &still->background, 0, 0, "backdrop|env|none",
         "backdrop (default), env, or none: transparent"},
        {"analytic", 0, CLI_FLAG, &still->analytic, 0, 0, NULL,
         "the analytic part (GGX) of the model alone"},
        {"layers", 0, CLI_FLAG, &still->layers, 0, 0, NULL,
         "EXR: also the analytic part, as analytic.R, .G, .B"},
        {"half", 0, CLI_FLAG, &still->half, 0, 0, NULL, "EXR: half instead of float"},
        {"device", 'd', CLI_TEXT, &c.device, 0, 0, "N",
         "on Vulkan device N (hnbrdf verify --list), by the exported shader and its sampling"},
        {"check", 0, CLI_FLAG, &c.check, 0, 0, NULL,
         "with --device: also on the CPU, with the same random numbers; fails if they differ"},
        {"mesh", 0, CLI_READ, &still->mesh.path, 0, 0, "FILE.obj",
         "a mesh instead of the sphere (y is up)"},
        {"smooth", 0, CLI_FLAG, &still->mesh.smooth, 0, 0, NULL,
         "of a mesh: normals averaged at its vertices"},
        {"turn", 0, CLI_REAL, &still->mesh.turn, -360, 360, "DEG",
         "of a mesh: walk around it, counter-clockwise"},
        {"tilt", 0, CLI_REAL, &still->mesh.tilt, -89, 89, "DEG",
         "of a mesh: camera above the horizon, default 15"},
        {"bounces", 0, CLI_INT, &still->job.bounces, 1, RENDER_MAX_BOUNCES, "N",
         "of a mesh: most reflections of light, default 1"},
        SCENE_LENGTH_OPTIONS(still->job),
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {NULL, 0, CLI_FLAG, NULL, 0, 0, NULL, NULL},
    };
    int positionals, code = cli_parse(&command, options, argc, argv, &positionals);
    if (code >= 0)
        return code;
    if (positionals != 1)
        return cli_usage(&command, "expected one SOURCE, found %d", positionals);
    code = check_options(&c);
    if (code >= 0)
        return code;
    c.path = argv[1];
    still->job.output = c.output;
    code = run(&c);
    render_image_free(&still->image);
    report_spheres_close(&still->spheres);
    cli_close_source(&c.source);
    return code;
}
