/* scene_job.h: what the commands that render scenes share: options, progress, interruption,
 * files. */
#ifndef HNBRDF_CLI_SCENE_JOB_H
#define HNBRDF_CLI_SCENE_JOB_H

#include "cli/picture.h"
#include "scene/film.h"

typedef struct scene_job {
    const char *output;
    long spp, bounces, seed, threads; /* bounces 0: what the scene says */
    double seconds, clamp;
    int half, resume, transparent;
} scene_job;

/* clang-format off */
/* Rows of a cli_option table for a scene_job named j. */
#define SCENE_LENGTH_OPTIONS(j) \
    {"time", 0, CLI_REAL, &(j).seconds, 0.1, 1e7, "S", \
     "stop after S seconds; --resume goes on later, up to --spp"}, \
    {"resume", 0, CLI_FLAG, &(j).resume, 0, 0, NULL, \
     "go on from FILE.checkpoint of a rendering that was stopped"}, \
    {"clamp", 0, CLI_REAL, &(j).clamp, 1e-3, 1e9, "X", \
     "limit on what a path brings after its first reflection: no speckles, a little less light"}
#define SCENE_OPTIONS(j) \
    {"spp", 0, CLI_INT, &(j).spp, 1, 1 << 20, "N", "samples a pixel, default 64"}, \
    {"bounces", 0, CLI_INT, &(j).bounces, 1, RENDER_MAX_BOUNCES, "N", \
     "most reflections of light, default 16 or what the scene says"}, \
    SCENE_LENGTH_OPTIONS(j), \
    {"seed", 0, CLI_INT, &(j).seed, 0, 2147483647, "N", "of the random numbers, default 1"}, \
    {"threads", 0, CLI_INT, &(j).threads, 0, 1024, "N", "default: all cores; changes no pixel"}, \
    {"half", 0, CLI_FLAG, &(j).half, 0, 0, NULL, "EXR: half instead of float"}
/* clang-format on */

/* Seconds that a rendering took: by the clock, and of all processors together. */
typedef struct scene_time {
    double wall, cpu;
} scene_time;

/* Renders what the job asks for, with progress; develops the film, with its layers, and where the
 * environment is seen behind the shapes without alpha. A rendering that was
 * stopped leaves OUTPUT.checkpoint and says so; one that is complete removes it. NULL output: no
 * checkpoint. 0, or CLI_FAILURE after a message. */
int scene_job_render(const scene_job *job, const render_scene *scene, const char *what,
                     render_image *image, scene_time *time);
/* 1 after Ctrl-C. */
int scene_job_interrupted(void);

#endif
