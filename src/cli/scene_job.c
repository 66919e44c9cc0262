/* scene_job.c: render a scene for a command: progress, Ctrl-C, checkpoint. */
#include "cli/scene_job.h"

#include "base/interrupt.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

int scene_job_interrupted(void)
{
    return hnbrdf_interrupted();
}

static int show(void *line, double share)
{
    cli_progress_update(line, share, NULL);
    return hnbrdf_interrupted();
}

static char *checkpoint_path(const char *output)
{
    size_t length = strlen(output);
    char *path = malloc(length + sizeof ".checkpoint");
    if (path)
        snprintf(path, length + sizeof ".checkpoint", "%s.checkpoint", output);
    return path;
}

/* Renders into the film; *complete as render_scene_run() has it. */
static int fill(const scene_job *job, const render_scene *scene, const char *what,
                const char *state, render_film *film, int *complete)
{
    hnbrdf_error error;
    cli_progress line;
    const render_scene_options options = {.path = {.seed = (uint64_t)job->seed,
                                                   .bounces = (int)job->bounces,
                                                   .transparent = job->transparent,
                                                   .clamp = job->clamp},
                                          .spp = (int)job->spp,
                                          .threads = (int)job->threads,
                                          .seconds = job->seconds,
                                          .state = state,
                                          .resume = job->resume,
                                          .progress = show,
                                          .progress_user = &line};
    cli_progress_begin(&line, what);
    hnbrdf_catch_interrupts(1);
    hnbrdf_result result = render_scene_run(scene, &options, film, complete, &error);
    hnbrdf_catch_interrupts(0);
    cli_progress_end(&line);
    return result == HNBRDF_OK ? CLI_OK : cli_fail("%s", error.text);
}

/* Samples of the tiles: fewest and most. */
static void count_samples(const render_film *film, int *least, int *most)
{
    *least = *most = film->samples[0];
    for (int i = 1; i < film->tiles; i++) {
        *least = film->samples[i] < *least ? film->samples[i] : *least;
        *most = film->samples[i] > *most ? film->samples[i] : *most;
    }
}

int scene_job_render(const scene_job *job, const render_scene *scene, const char *what,
                     render_image *image, scene_time *time)
{
    hnbrdf_error error;
    render_film film;
    if (render_film_create(scene->camera.width, scene->camera.height, &film, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    char *state = job->output ? checkpoint_path(job->output) : NULL;
    int complete = 0;
    clock_t cpu = clock();
    double wall = cli_seconds();
    int code = job->output && !state ? cli_fail("out of memory")
                                     : fill(job, scene, what, state, &film, &complete);
    time->wall = cli_seconds() - wall;
    time->cpu = (double)(clock() - cpu) / CLOCKS_PER_SEC;
    if (code == CLI_OK && render_film_develop(&film, 1, image, &error) != HNBRDF_OK)
        code = cli_fail("%s", error.text);
    if (code == CLI_OK && !job->transparent) {
        free(image->alpha);
        image->alpha = NULL;
    }
    if (code == CLI_OK && complete && state)
        remove(state);
    if (code == CLI_OK && !complete) {
        int least, most;
        count_samples(&film, &least, &most);
        printf("stopped at %d to %d of %ld samples a pixel. Repeat the command with --resume to go "
               "on.\n",
               least, most, job->spp);
    }
    free(state);
    render_film_free(&film);
    return code;
}
