/* cmd_render.c: `hnbrdf render`: a sphere or a mesh of one material, as OpenEXR with a PNG beside
 * it. */
#include "cli/render_gpu.h"
#include "cli/render_mesh.h"

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
    "The camera looks along -z, y is up; the middle column of a map lies straight ahead of it.",
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

typedef struct render_job {
    const char *path, *material, *background, *output;
    const char *device; /* of Vulkan; NULL: the CPU */
    int analytic, half, layers, check;
    long size;
    picture_options picture;
    mesh_view mesh;
    scene_job scene; /* of a mesh */
    cli_source source;
    int index;           /* of the material in the model */
    hnbrdf_model *guide; /* see render_guide_model() */
    render_environment environment;
    render_image image;
} render_job;

static int is_one_of(const char *text, const char *a, const char *b, const char *c)
{
    return strcmp(text, a) == 0 || strcmp(text, b) == 0 || strcmp(text, c) == 0;
}

static int open_source(render_job *job)
{
    if (cli_open_source(job->path, &job->source) != CLI_OK)
        return CLI_FAILURE;
    job->index = cli_choose_source_material(&job->source, job->material);
    if (job->index < 0)
        return CLI_FAILURE;
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_NEURAL};
    if (job->source.model)
        hnbrdf_model_describe(job->source.model, &desc);
    if ((job->analytic || job->layers) && desc.kind == HNBRDF_KIND_NEURAL)
        return cli_fail(
            "%s has no analytic part: --analytic and --layers are for hybrid and ggx models",
            job->path);
    return CLI_OK;
}

static render_surface make_surface(const render_job *job, int analytic)
{
    const hnbrdf_model *model = job->source.model;
    const hnbrdf_material *material = model ? hnbrdf_model_material(model, job->index) : NULL;
    render_surface surface = !model     ? render_surface_measured(job->source.measured)
                             : analytic ? render_surface_analytic(model, material)
                                        : render_surface_model(model, material);
    const render_surface *one = &surface;
    render_guide guide = render_guide_fit(&one, 1, job->guide);
    render_surface_guide(&surface, &guide);
    return surface;
}

static int render_one(const render_job *job, int analytic, picture_progress *progress,
                      render_image *image)
{
    hnbrdf_error error;
    render_surface surface = make_surface(job, analytic);
    render_options options = {.size = (int)job->size,
                              .spp = (int)job->picture.spp,
                              .seed = (uint64_t)job->picture.seed,
                              .threads = (int)job->picture.threads,
                              .progress = picture_report,
                              .progress_user = progress};
    if (render_sphere(&surface, &job->environment, &options, image, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    progress->first++;
    return CLI_OK;
}

static int add_analytic_layer(render_job *job, picture_progress *progress)
{
    hnbrdf_error error;
    render_image analytic = {0};
    int code = render_one(job, 1, progress, &analytic);
    if (code == CLI_OK &&
        render_image_add_layer(&job->image, "analytic", analytic.rgb, &error) == HNBRDF_OK)
        analytic.rgb = NULL;
    render_image_free(&analytic);
    return code;
}

static int render_on_device(render_job *job)
{
    const render_gpu gpu = {.device = job->device,
                            .check = job->check,
                            .model = job->source.model,
                            .material = job->index,
                            .environment = &job->environment,
                            .options = {.size = (int)job->size,
                                        .spp = (int)job->picture.spp,
                                        .seed = (uint64_t)job->picture.seed,
                                        .threads = (int)job->picture.threads}};
    if (!job->source.model)
        return cli_fail("%s is no model: --device renders what `hnbrdf export` can write",
                        job->path);
    return render_gpu_run(&gpu, &job->image);
}

/* A model draws its own directions; what else there is has a guide. */
static int render_mesh_view(render_job *job)
{
    const hnbrdf_model *model = job->source.model;
    render_surface surface =
        model && !job->analytic
            ? render_surface_model(model, hnbrdf_model_material(model, job->index))
            : make_surface(job, job->analytic);
    job->scene.output = job->output;
    job->scene.spp = job->picture.spp;
    job->scene.seed = job->picture.seed;
    job->scene.threads = job->picture.threads;
    job->scene.transparent = strcmp(job->background, "env") != 0;
    return mesh_view_render(&job->mesh, &surface, &job->environment, (int)job->size, &job->scene,
                            &job->image);
}

static int render_all(render_job *job)
{
    if (job->mesh.path)
        return render_mesh_view(job);
    if (job->device)
        return render_on_device(job);
    picture_progress progress = {.count = 1 + job->layers};
    cli_progress_begin(&progress.line, "rendering");
    int code = render_one(job, job->analytic, &progress, &job->image);
    if (code == CLI_OK && job->layers)
        code = add_analytic_layer(job, &progress);
    cli_progress_end(&progress.line);
    return code;
}

static int write_picture(render_job *job)
{
    char comments[512];
    const char *name = job->source.model ? hnbrdf_model_material_name(job->source.model, job->index)
                                         : hnbrdf_measured_name(job->source.measured);
    double gain = exp2(-job->picture.exposure);
    if (strcmp(job->background, "backdrop") == 0)
        render_over_backdrop(&job->image, 0.16 * gain);
    else if (strcmp(job->background, "env") == 0 && !job->mesh.path)
        render_over_environment(&job->image, &job->environment,
                                strcmp(job->picture.env, "furnace") == 0 ? 1.0 : 0.35);
    snprintf(comments, sizeof comments, "hnbrdf %s render: %s%s, %ld samples a pixel, seed %ld",
             hnbrdf_version(), name, job->analytic ? " (analytic part)" : "", job->picture.spp,
             job->picture.seed);
    render_write_options options = {
        .exposure = job->picture.exposure, .half = job->half, .comments = comments};
    return picture_write(&job->image, job->output, &options);
}

static int run(render_job *job)
{
    hnbrdf_error error;
    if (open_source(job) != CLI_OK ||
        picture_open_light(&job->picture, &job->environment) != CLI_OK)
        return CLI_FAILURE;
    if (render_guide_model(&job->guide, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    int code = render_all(job);
    return code == CLI_OK ? write_picture(job) : code;
}

int cmd_render(int argc, char **argv)
{
    render_job job = {.background = "backdrop",
                      .size = 512,
                      .picture = PICTURE_DEFAULTS(64),
                      .mesh = MESH_VIEW_DEFAULTS,
                      .scene = {.bounces = 1}};
    const cli_option options[] = {
        {"material", 0, CLI_TEXT, &job.material, 0, 0, "NAME", "of a model with several"},
        {"output", 'o', CLI_TEXT, &job.output, 0, 0, "FILE",
         "FILE.exr (and FILE.png beside it) or FILE.png"},
        {"size", 0, CLI_INT, &job.size, 1, 8192, "N", "pixels a side, default 512"},
        PICTURE_OPTIONS(job.picture, "64"),
        {"background", 0, CLI_TEXT, &job.background, 0, 0, "NAME",
         "backdrop (default), env, or none: transparent"},
        {"analytic", 0, CLI_FLAG, &job.analytic, 0, 0, NULL,
         "the analytic part (GGX) of the model alone"},
        {"layers", 0, CLI_FLAG, &job.layers, 0, 0, NULL,
         "EXR: also the analytic part, as analytic.R, .G, .B"},
        {"half", 0, CLI_FLAG, &job.half, 0, 0, NULL, "EXR: half instead of float"},
        {"device", 'd', CLI_TEXT, &job.device, 0, 0, "N",
         "on Vulkan device N (hnbrdf verify --list), by the exported shader and its sampling"},
        {"check", 0, CLI_FLAG, &job.check, 0, 0, NULL,
         "with --device: also on the CPU, with the same random numbers; fails if they differ"},
        MESH_OPTIONS(job.mesh),
        {"bounces", 0, CLI_INT, &job.scene.bounces, 1, RENDER_MAX_BOUNCES, "N",
         "of a mesh: most reflections of light, default 1"},
        SCENE_LENGTH_OPTIONS(job.scene),
        CLI_READING_OPTIONS,
        CLI_SIGNED_OPTION,
        {NULL, 0, CLI_FLAG, NULL, 0, 0, NULL, NULL},
    };
    int positionals, code = cli_parse(&command, options, argc, argv, &positionals);
    if (code >= 0)
        return code;
    if (positionals != 1)
        return cli_usage(&command, "expected one SOURCE, found %d", positionals);
    if (!is_one_of(job.background, "backdrop", "env", "none"))
        return cli_usage(&command, "--background %s: expected backdrop, env or none",
                         job.background);
    if (job.check && !job.device)
        return cli_usage(&command,
                         "--check compares a device with the CPU: expected --device N too");
    if (job.device && (job.analytic || job.layers))
        return cli_usage(&command, "--analytic and --layers are for the CPU, without --device");
    if (!job.mesh.path && (job.scene.bounces > 1 || job.scene.seconds > 0.0 || job.scene.resume ||
                           job.mesh.smooth || job.scene.clamp > 0.0))
        return cli_usage(&command,
                         "--bounces, --time, --resume, --clamp and --smooth are for --mesh");
    if (job.mesh.path && (job.layers || job.device))
        return cli_usage(&command, "--layers and --device are for the sphere, without --mesh");
    code = picture_check_output(&command, job.output);
    if (code >= 0)
        return code;
    job.path = argv[1];
    code = run(&job);
    render_image_free(&job.image);
    render_environment_free(&job.environment);
    hnbrdf_model_free(job.guide);
    cli_close_source(&job.source);
    return code;
}
