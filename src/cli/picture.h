/* picture.h: what the commands that make pictures share: light, exposure, output names, progress.
 * */
#ifndef HNBRDF_CLI_PICTURE_H
#define HNBRDF_CLI_PICTURE_H

#include "cli/cli.h"
#include "report/picture.h"
#include "scene/job.h"

#include <math.h>

typedef report_light picture_options;

#define PICTURE_DEFAULTS(samples)                                                      \
    {                                                                                  \
        .env = "sky", .exposure = NAN, .spp = (samples), .seed = 1, .notes = CLI_NOTES \
    }

/* The row of a report_flip named f. */
#define CLI_PPD_OPTION(f)                                                        \
    {                                                                            \
        "ppd", 0, CLI_REAL, &(f).pixels_per_degree, 1, 2000, "N",                \
            "of FLIP: pixels that its observer sees in a degree (default 67.02)" \
    }

/* Rows of a cli_option table for a picture_options named p. */
#define PICTURE_OPTIONS(p, samples)                                                               \
    {"env",                                                                                       \
     0,                                                                                           \
     CLI_READ,                                                                                    \
     &(p).env,                                                                                    \
     0,                                                                                           \
     0,                                                                                           \
     "sky|furnace|FILE",                                                                          \
     "light: sky, furnace (1 from everywhere), or a map .exr or .hdr: lat-long, or an EXR cube"}, \
        {"layer", 0, CLI_TEXT, &(p).layer, 0, 0, "NAME", "of an EXR map with several layers"},    \
        {"repair", 0, CLI_FLAG, &(p).repair,                                                      \
         0,        0, NULL,     "pixels of the map that are not finite: mean of those around"},   \
        {"rotate", 0,                                                                             \
         CLI_REAL, &(p).rotate,                                                                   \
         -360,     360,                                                                           \
         "DEG",    "turn the light about the vertical, counter-clockwise from above"},            \
        {"exposure", 0,  CLI_REAL, &(p).exposure,                                                 \
         -64,        64, "EV",     "stops; default: mean light as bright as that of the sky"},    \
        {"spp",   0,                                                                              \
         CLI_INT, &(p).spp,                                                                       \
         1,       1 << 20,                                                                        \
         "N",     "samples a pixel, default " samples "; powers of 2 are stratified best"},       \
        {"seed", 0, CLI_INT, &(p).seed, 0, 2147483647, "N", "of the random numbers, default 1"},  \
    {                                                                                             \
        "threads", 0, CLI_INT, &(p).threads, 0, 1024, "N", "default: all cores; changes no pixel" \
    }

/* clang-format off */
/* Rows of a cli_option table for a render_job named j. */
#define SCENE_LENGTH_OPTIONS(j) \
    {"time", 0, CLI_REAL, &(j).seconds, 0.1, 1e7, "S", \
     "stop after S seconds; --resume goes on later, up to --spp"}, \
    {"resume", 0, CLI_FLAG, &(j).resume, 0, 0, NULL, \
     "go on from FILE.checkpoint of a rendering that was stopped"}, \
    {"clamp", 0, CLI_REAL, &(j).clamp, 1e-3, 1e9, "X", \
     "limit on what a path brings after its first reflection: no speckles, a little less light"}
/* clang-format on */

/* -1 to go on, or an exit code after a message: the name must end in .exr or .png, and .exr
 * must be possible. */
int picture_check_output(const cli_command *command, const char *path);

/* Opens the environment and, where none was given, sets the exposure. 0, or CLI_FAILURE. */
int picture_open_light(picture_options *options, render_environment *environment);

/* Writes path and, for an .exr, a .png beside it; says so on stdout. 0, or CLI_FAILURE. */
int picture_write(const render_image *image, const char *path, const render_write_options *options);

/* One picture of several: `first` of `count` is being rendered. For render_options.progress. */
typedef struct picture_progress {
    cli_progress line;
    int first, count;
    const char *detail;
} picture_progress;
int picture_report(void *progress, double share);

/* Around a rendering: its line, and with `stoppable` Ctrl-C that stops it. The end says how far one
 * that was stopped came; outcome NULL: it failed. */
void picture_begin(cli_progress *line, const char *what, int stoppable);
void picture_end(cli_progress *line, const render_outcome *outcome, long spp);

#endif
