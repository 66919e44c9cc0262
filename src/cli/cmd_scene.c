/* cmd_scene.c: `hnbrdf scene`: path tracing of a scene described by a text file. */
#include "base/interrupt.h"
#include "cli/picture.h"
#include "report/scene_compare.h"

static const cli_command command = {
    "scene",
    "FILE.scene [options] -o FILE.exr",
    "Renders a scene with global illumination: spheres, formulas and OBJ files, each with a "
    "material "
    "of a\n"
    "model, a measurement, a built-in material or GGX, under an environment and area lights.\n"
    "FILE.exr gets linear radiance and the layers albedo (directional, of what is seen first), "
    "normal "
    "and\n"
    "samples; FILE.png beside it the same radiance times 2^exposure. Ctrl-C keeps what there is.\n"
    "\n"
    "A scene is lines of these statements; [] may be left out, # begins a comment:\n"
    "  camera from X Y Z to X Y Z fov DEG [up X Y Z] [lens RADIUS] [focus DISTANCE]\n"
    "  size WIDTH HEIGHT | exposure EV | bounces N\n"
    "  environment sky|furnace|FILE [rotate DEG] [gain G] [hidden] [layer NAME] [repair]\n"
    "  portal corner X Y Z edge X Y Z edge X Y Z       a window: light is looked for through it\n"
    "  material NAME model FILE [MATERIAL] | measured FILE | builtin NAME | diffuse R G B\n"
    "  material NAME ggx kd R G B eta R G B alpha A [ALPHA_Y]\n"
    "  shape KIND [parameters] [material NAME] [emit R G B] [placing]\n"
    "KIND is sphere, quad, box, torus [tube R], knot [turns P Q] [tube R], superellipsoid [powers "
    "E1 "
    "E2],\n"
    "teapot, lathe profile R Y R Y ... (a point given twice is a corner), obj FILE [use PART "
    "MATERIAL]\n"
    "[smooth]; detail N sets how finely they are cut. Placing, in the order given: scale S, "
    "stretch X "
    "Y Z,\n"
    "turn DEG (about y, which is up), rotate X Y Z DEG (about that axis), move X Y Z. Shapes end "
    "up within\n"
    "1e9 of the origin; one too small for single precision where it is, is warned of.",
    "hnbrdf scene examples/room.scene -o room.exr\n"
    "hnbrdf scene room.scene --spp 4096 --time 600 -o room.exr     # ten minutes now,\n"
    "hnbrdf scene room.scene --spp 4096 --resume -o room.exr       # the rest later\n"
    "hnbrdf scene room.scene --analytic -o room_ggx.exr\n"
    "hnbrdf scene room.scene --measured rgl/ -o room_measured.exr\n"
    "hnbrdf scene room.scene --compare rgl/ --csv room.csv -o room.exr",
};

typedef struct scene_command {
    const char *path, *measured, *compare, *csv, *json;
    long width; /* 0: what the scene says */
    int analytic, half;
    double exposure;
    render_job job;
    render_description description;
} scene_command;

static const render_reading reading = {.measured = &cli_read, .notes = CLI_NOTES};

/* A file that the scene names, "" for none: is it written too? */
static int check_named(const scene_command *c, const char *file)
{
    char path[2 * RENDER_MAX_PATH];
    if (!file[0])
        return CLI_OK;
    render_description_path(&c->description, file, path);
    return cli_check_read(path);
}

static int check_all_named(const scene_command *c)
{
    const render_description *d = &c->description;
    int code = check_named(c, d->environment); /* sky and furnace are no pictures to write */
    for (int k = 0; k < d->material_count && code == CLI_OK; k++)
        code = check_named(c, d->materials[k].file);
    for (int k = 0; k < d->shape_count && code == CLI_OK; k++)
        code = check_named(c, d->shapes[k].file);
    return code;
}

static int open_scene(scene_command *c)
{
    hnbrdf_error error;
    render_camera *camera = &c->description.camera;
    if (render_description_read(c->path, &c->description, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    if (check_all_named(c) != CLI_OK)
        return CLI_FAILURE;
    camera->width = camera->width ? camera->width : 640;
    camera->height = camera->height ? camera->height : 480;
    if (c->width) { /* the picture keeps its shape */
        long height = (camera->height * c->width + camera->width / 2) / camera->width;
        camera->height = height > 0 ? (int)height : 1;
        camera->width = (int)c->width;
    }
    if (isnan(c->exposure))
        c->exposure = isnan(c->description.exposure) ? 0.0 : c->description.exposure;
    return CLI_OK;
}

static int render_one(const scene_command *c)
{
    char comments[512];
    hnbrdf_error error;
    render_image image = {0};
    render_outcome outcome;
    picture_progress progress = {.count = 1};
    render_job job = c->job;
    render_show show = c->analytic   ? RENDER_SHOW_ANALYTIC
                       : c->measured ? RENDER_SHOW_MEASURED
                                     : RENDER_SHOW_MODEL;
    job.progress = picture_report;
    job.progress_user = &progress;
    picture_begin(&progress.line, "rendering", 1);
    hnbrdf_result result = render_job_run_description(&job, &c->description, show, c->measured,
                                                      &reading, &image, &outcome, &error);
    picture_end(&progress.line, result == HNBRDF_OK ? &outcome : NULL, job.spp);
    if (result != HNBRDF_OK)
        return cli_fail("%s", error.text);
    snprintf(comments, sizeof comments, "hnbrdf %s scene: %.300s, %ld samples a pixel, seed %ld",
             hnbrdf_version(), c->path, job.spp, job.seed);
    const render_write_options options = {
        .exposure = c->exposure, .half = c->half, .comments = comments};
    int code = picture_write(&image, job.output, &options);
    render_image_free(&image);
    return code;
}

static int compare(const scene_command *c)
{
    hnbrdf_error error;
    cli_progress line;
    report_scene_row rows[REPORT_SCENE_ROWS];
    const report_scene scene = {.description = &c->description,
                                .reading = &reading,
                                .folder = c->compare,
                                .job = c->job,
                                .exposure = c->exposure,
                                .half = c->half,
                                .watch = cli_watch(&line)};
    cli_progress_begin(&line, "rendering");
    hnbrdf_catch_interrupts(1);
    hnbrdf_result result = report_scene_compare(&scene, rows, &error);
    hnbrdf_catch_interrupts(0);
    cli_progress_end(&line);
    if (result != HNBRDF_OK)
        return cli_fail("%s", error.text);
    report_scene_print(rows, cli_words());
    int code = cli_write_file(c->csv, report_scene_write_csv, rows);
    return code == CLI_OK ? cli_write_file(c->json, report_scene_write_json, rows) : code;
}

int cmd_scene(int argc, char **argv)
{
    scene_command c = {.exposure = NAN, .job = {.spp = 64, .seed = 1}};
    const cli_option options[] = {
        {"output", 'o', CLI_WRITE_PICTURE, &c.job.output, 0, 0, "FILE",
         "FILE.exr (and FILE.png beside it) or FILE.png"},
        {"spp", 0, CLI_INT, &c.job.spp, 1, 1 << 20, "N", "samples a pixel, default 64"},
        {"bounces", 0, CLI_INT, &c.job.bounces, 1, RENDER_MAX_BOUNCES, "N",
         "most reflections of light, default 16 or what the scene says"},
        SCENE_LENGTH_OPTIONS(c.job),
        {"seed", 0, CLI_INT, &c.job.seed, 0, 2147483647, "N", "of the random numbers, default 1"},
        {"threads", 0, CLI_INT, &c.job.threads, 0, 1024, "N",
         "default: all cores; changes no pixel"},
        {"half", 0, CLI_FLAG, &c.half, 0, 0, NULL, "EXR: half instead of float"},
        {"width", 0, CLI_INT, &c.width, 1, 16384, "N", "of the picture, whose shape is kept"},
        {"exposure", 0, CLI_REAL, &c.exposure, -64, 64, "EV",
         "stops, default 0 or what the scene says"},
        {"analytic", 0, CLI_FLAG, &c.analytic, 0, 0, NULL, "models: their GGX part alone"},
        {"measured", 0, CLI_TEXT, &c.measured, 0, 0, "DIR",
         "models: the measurements of the same names in DIR instead"},
        {"compare", 0, CLI_TEXT, &c.compare, 0, 0, "DIR",
         "model, GGX and measurements in DIR: three pictures, errors and times"},
        {"csv", 0, CLI_WRITE_TEXT, &c.csv, 0, 0, "FILE", "of --compare, the table"},
        {"json", 0, CLI_WRITE_TEXT, &c.json, 0, 0, "FILE", "likewise"},
        CLI_READING_OPTIONS,
        {NULL, 0, CLI_FLAG, NULL, 0, 0, NULL, NULL},
    };
    int positionals, code = cli_parse(&command, options, argc, argv, &positionals);
    if (code >= 0)
        return code;
    if (positionals != 1)
        return cli_usage(&command, "expected one FILE.scene, found %d", positionals);
    if (c.analytic + (c.measured != NULL) + (c.compare != NULL) > 1)
        return cli_usage(&command, "--analytic, --measured and --compare: expected one of them");
    if (!c.compare && (c.csv || c.json))
        return cli_usage(&command, "--csv and --json are for --compare");
    if (c.compare && (c.job.resume || c.job.seconds > 0.0))
        return cli_usage(&command,
                         "--compare takes the same samples for each: no --time and no --resume");
    code = picture_check_output(&command, c.job.output);
    if (code >= 0)
        return code;
    c.path = argv[1];
    code = open_scene(&c);
    if (code == CLI_OK)
        code = c.compare ? compare(&c) : render_one(&c);
    render_description_free(&c.description);
    return code;
}
