/* job.h: a picture of a scene within a time, with a checkpoint to go on from later. */
#ifndef HNBRDF_SCENE_JOB_H
#define HNBRDF_SCENE_JOB_H

#include "scene/describe.h"
#include "scene/film.h"

typedef struct render_job {
    /* the picture's file: OUTPUT.checkpoint keeps what there is; NULL: no checkpoint */
    const char *output;
    long spp, bounces, seed, threads; /* bounces 0: what the scene says */
    double seconds, clamp;
    int resume, transparent;
    int (*progress)(void *user, double share); /* as in render_scene_options */
    void *progress_user;
} render_job;

/* How it went. */
typedef struct render_outcome {
    double wall, cpu; /* seconds: by the clock, and of all processors together */
    int complete;     /* 0: stopped before every pixel had its samples */
    int least, most;  /* samples of a pixel */
} render_outcome;

/* Renders what the job asks for and develops the film, with its layers, and where the environment
 * is seen behind the shapes without alpha. A rendering that was stopped leaves its checkpoint;
 * one that is complete removes it. */
hnbrdf_result render_job_run(const render_job *job, const render_scene *scene, render_image *image,
                             render_outcome *outcome, hnbrdf_error *error);

/* Loads the scene of a description, as render_description_load() does, and renders it. What the
 * description says of bounces and of a hidden environment holds. */
hnbrdf_result render_job_run_description(const render_job *job,
                                         const render_description *description, render_show show,
                                         const char *folder, const render_reading *reading,
                                         render_image *image, render_outcome *outcome,
                                         hnbrdf_error *error);

#endif
