/* job.c: a picture of a scene within a time, with a checkpoint to go on from later. */
#include "scene/job.h"

#include "base/clock.h"
#include "base/error.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *checkpoint_path(const char *output)
{
    size_t length = strlen(output);
    char *path = malloc(length + sizeof ".checkpoint");
    if (path)
        snprintf(path, length + sizeof ".checkpoint", "%s.checkpoint", output);
    return path;
}

static void count_samples(const render_film *film, render_outcome *outcome)
{
    outcome->least = outcome->most = film->samples[0];
    for (int i = 1; i < film->tiles; i++) {
        outcome->least = film->samples[i] < outcome->least ? film->samples[i] : outcome->least;
        outcome->most = film->samples[i] > outcome->most ? film->samples[i] : outcome->most;
    }
}

/* Renders into the film and develops it. */
static hnbrdf_result fill(const render_job *job, const render_scene *scene, const char *state,
                          render_film *film, render_image *image, render_outcome *outcome,
                          hnbrdf_error *error)
{
    const render_scene_options options = {.path = {.seed = (uint64_t)job->seed,
                                                   .bounces = (int)job->bounces,
                                                   .transparent = job->transparent,
                                                   .clamp = job->clamp},
                                          .spp = (int)job->spp,
                                          .threads = (int)job->threads,
                                          .seconds = job->seconds,
                                          .state = state,
                                          .resume = job->resume,
                                          .progress = job->progress,
                                          .progress_user = job->progress_user};
    double cpu = hnbrdf_process_seconds(), wall = hnbrdf_seconds();
    hnbrdf_result result = render_scene_run(scene, &options, film, &outcome->complete, error);
    outcome->wall = hnbrdf_seconds() - wall;
    outcome->cpu = hnbrdf_process_seconds() - cpu;
    if (result == HNBRDF_OK)
        result = render_film_develop(film, 1, image, error);
    if (result != HNBRDF_OK)
        return result;
    count_samples(film, outcome);
    if (!job->transparent) {
        free(image->alpha);
        image->alpha = NULL;
    }
    if (outcome->complete && state)
        remove(state);
    return HNBRDF_OK;
}

hnbrdf_result render_job_run(const render_job *job, const render_scene *scene, render_image *image,
                             render_outcome *outcome, hnbrdf_error *error)
{
    render_film film;
    render_outcome made = {0};
    hnbrdf_result result =
        render_film_create(scene->camera.width, scene->camera.height, &film, error);
    if (result != HNBRDF_OK)
        return result;
    char *state = job->output ? checkpoint_path(job->output) : NULL;
    result = job->output && !state ? hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory")
                                   : fill(job, scene, state, &film, image, &made, error);
    free(state);
    render_film_free(&film);
    if (result == HNBRDF_OK)
        *outcome = made;
    return result;
}

hnbrdf_result render_job_run_description(const render_job *job,
                                         const render_description *description, render_show show,
                                         const char *folder, const render_reading *reading,
                                         render_image *image, render_outcome *outcome,
                                         hnbrdf_error *error)
{
    render_loaded loaded;
    render_job whole = *job;
    hnbrdf_result result =
        render_description_load(description, show, folder, reading, &loaded, error);
    if (result != HNBRDF_OK)
        return result;
    whole.transparent = description->hidden;
    if (!whole.bounces)
        whole.bounces = description->bounces;
    result = render_job_run(&whole, &loaded.scene, image, outcome, error);
    render_loaded_free(&loaded);
    return result;
}
