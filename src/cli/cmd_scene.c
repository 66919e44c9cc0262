/* cmd_scene.c: `hnbrdf scene`: path tracing of a scene told in a text file. */
#include "cli/scene_compare.h"

#include "scene/describe.h"

#include <string.h>

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
    "  environment sky|furnace|FILE [rotate DEG] [gain G] [hidden]\n"
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
    "turn DEG (about y, which is up), rotate X Y Z DEG (about that axis), move X Y Z.",
    "hnbrdf scene examples/room.scene -o room.exr\n"
    "hnbrdf scene room.scene --spp 4096 --time 600 -o room.exr     # ten minutes now,\n"
    "hnbrdf scene room.scene --spp 4096 --resume -o room.exr       # the rest later\n"
    "hnbrdf scene room.scene --analytic -o room_ggx.exr\n"
    "hnbrdf scene room.scene --measured rgl/ -o room_measured.exr\n"
    "hnbrdf scene room.scene --compare rgl/ --csv room.csv -o room.exr",
};

static int open_scene(scene_files *files, const scene_sizes *sizes)
{
    hnbrdf_error error;
    render_camera *camera = &files->description.camera;
    if (render_description_read(files->path, &files->description, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    camera->width = camera->width ? camera->width : 640;
    camera->height = camera->height ? camera->height : 480;
    if (sizes->width) { /* the picture keeps its shape */
        long height = (camera->height * sizes->width + camera->width / 2) / camera->width;
        camera->height = height > 0 ? (int)height : 1;
        camera->width = (int)sizes->width;
    }
    return CLI_OK;
}

static int render_one(const scene_files *files, const scene_job *job, render_show show,
                      const char *folder, double exposure)
{
    char comments[512];
    render_image image = {0};
    scene_time time;
    int code = scene_files_render(files, job, show, folder, "rendering", &image, &time);
    if (code == CLI_OK) {
        snprintf(comments, sizeof comments,
                 "hnbrdf %s scene: %.300s, %ld samples a pixel, seed %ld", hnbrdf_version(),
                 files->path, job->spp, job->seed);
        const render_write_options options = {
            .exposure = exposure, .half = job->half, .comments = comments};
        code = picture_write(&image, job->output, &options);
    }
    render_image_free(&image);
    return code;
}

int cmd_scene(int argc, char **argv)
{
    scene_job job = {.spp = 64, .seed = 1};
    scene_files files = {.csv = NULL};
    scene_sizes sizes = {0};
    const char *measured = NULL, *compare = NULL;
    int analytic = 0;
    double exposure = NAN;
    const cli_option options[] = {
        {"output", 'o', CLI_TEXT, &job.output, 0, 0, "FILE",
         "FILE.exr (and FILE.png beside it) or FILE.png"},
        SCENE_OPTIONS(job),
        {"width", 0, CLI_INT, &sizes.width, 1, 16384, "N", "of the picture, whose shape is kept"},
        {"exposure", 0, CLI_REAL, &exposure, -64, 64, "EV",
         "stops, default 0 or what the scene says"},
        {"analytic", 0, CLI_FLAG, &analytic, 0, 0, NULL, "models: their GGX part alone"},
        {"measured", 0, CLI_TEXT, &measured, 0, 0, "DIR",
         "models: the measurements of the same names in DIR instead"},
        {"compare", 0, CLI_TEXT, &compare, 0, 0, "DIR",
         "model, GGX and measurements in DIR: three pictures, errors and times"},
        {"csv", 0, CLI_TEXT, &files.csv, 0, 0, "FILE", "of --compare, the table"},
        {"json", 0, CLI_TEXT, &files.json, 0, 0, "FILE", "likewise"},
        CLI_READING_OPTIONS,
        {NULL, 0, CLI_FLAG, NULL, 0, 0, NULL, NULL},
    };
    int positionals, code = cli_parse(&command, options, argc, argv, &positionals);
    if (code >= 0)
        return code;
    if (positionals != 1)
        return cli_usage(&command, "expected one FILE.scene, found %d", positionals);
    if ((analytic != 0) + (measured != NULL) + (compare != NULL) > 1)
        return cli_usage(&command, "--analytic, --measured and --compare: expected one of them");
    if (!compare && (files.csv || files.json))
        return cli_usage(&command, "--csv and --json are for --compare");
    if (compare && (job.resume || job.seconds > 0.0))
        return cli_usage(&command,
                         "--compare takes the same samples for each: no --time and no --resume");
    code = picture_check_output(&command, job.output);
    if (code >= 0)
        return code;
    files.path = argv[1];
    code = open_scene(&files, &sizes);
    if (code == CLI_OK) {
        render_show show = analytic   ? RENDER_SHOW_ANALYTIC
                           : measured ? RENDER_SHOW_MEASURED
                                      : RENDER_SHOW_MODEL;
        if (isnan(exposure))
            exposure = isnan(files.description.exposure) ? 0.0 : files.description.exposure;
        code = compare ? scene_compare(&files, &job, compare, exposure)
                       : render_one(&files, &job, show, measured, exposure);
    }
    render_description_free(&files.description);
    return code;
}
