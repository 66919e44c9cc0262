/* passes.c: render a scene pass by pass, until it is done, its time is over or someone stops it. */
#include "scene/film.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/hash.h"
#include "render/tiles.h"

#include <stdlib.h>
#include <unistd.h>

static const double save_seconds = 60.0; /* between two savings of the state */

typedef struct job {
    const render_scene *scene;
    const render_scene_options *options;
    render_path_options path;
    render_film *film;
    int target; /* samples that each tile shall have after this pass */
    int spp;
    uint64_t fingerprint;         /* of scene and options, with a state */
    double started, saved, share; /* share: done before this pass */
    int stopped;
} job;

static void work(void *user, int tile)
{
    job *j = user;
    int done = j->film->samples[tile];
    if (done >= j->target)
        return;
    render_path_tile(j->scene, &j->path, j->film, tile, done, j->target - done);
    j->film->samples[tile] = j->target;
}

static double share_done(const job *j)
{
    double sum = 0.0;
    for (int i = 0; i < j->film->tiles; i++)
        sum += j->film->samples[i] < j->spp ? j->film->samples[i] : j->spp;
    return sum / ((double)j->film->tiles * j->spp);
}

/* Of the caller: by samples or, with a time budget, by time, whichever is further. */
static int watch(void *user, double share_of_pass)
{
    job *j = user;
    double elapsed = hnbrdf_seconds() - j->started, goal = (double)j->target / j->spp;
    double share = j->share + (goal - j->share) * share_of_pass, budget = j->options->seconds;
    if (budget > 0.0 && elapsed / budget > share)
        share = elapsed / budget < 1.0 ? elapsed / budget : 1.0;
    if (j->options->progress && j->options->progress(j->options->progress_user, share))
        j->stopped = 1;
    if (budget > 0.0 && elapsed >= budget)
        j->stopped = 1;
    return j->stopped;
}

static hnbrdf_result save(job *j, hnbrdf_error *error)
{
    j->saved = hnbrdf_seconds();
    return j->options->state ? render_film_save(j->film, j->fingerprint, j->options->state, error)
                             : HNBRDF_OK;
}

/* The first pass takes one sample; later ones about as many as there were, up to some seconds'
 * worth. */
static int next_target(const job *j, double seconds_a_sample)
{
    int least = j->spp;
    for (int i = 0; i < j->film->tiles; i++)
        least = j->film->samples[i] < least ? j->film->samples[i] : least;
    double more = seconds_a_sample > 0.0 ? 5.0 / seconds_a_sample : 1.0;
    more = more > least ? least : more;
    int target = least + (more > 1.0 ? (int)more : 1);
    return target < j->spp ? target : j->spp;
}

static hnbrdf_result run(job *j, hnbrdf_error *error)
{
    const render_tiles tiles = {.count = j->film->tiles,
                                .threads = j->options->threads,
                                .work = work,
                                .user = j,
                                .progress = watch,
                                .progress_user = j};
    hnbrdf_result result = HNBRDF_OK;
    double pace = 0.0;
    while (result == HNBRDF_OK && !j->stopped && (j->share = share_done(j)) < 1.0) {
        double before = hnbrdf_seconds(), share = j->share;
        j->target = next_target(j, pace);
        render_tiles_run(&tiles);
        double gained = (share_done(j) - share) * j->spp;
        pace = gained > 0.0 ? (hnbrdf_seconds() - before) / gained : pace;
        if (hnbrdf_seconds() - j->saved >= save_seconds)
            result = save(j, error);
    }
    return result == HNBRDF_OK ? save(j, error) : result;
}

static uint64_t fingerprint(const job *j)
{
    const double numbers[] = {j->path.bounces, j->path.transparent, j->path.clamp,
                              j->path.strategy};
    uint64_t hash = hnbrdf_hash(render_scene_fingerprint(j->scene), numbers, sizeof numbers);
    return hnbrdf_hash(hash, &j->path.seed, sizeof j->path.seed);
}

hnbrdf_result render_scene_run(const render_scene *scene, const render_scene_options *options,
                               render_film *film, int *complete, hnbrdf_error *error)
{
    job j = {.scene = scene, .options = options, .path = options->path, .film = film};
    j.spp = options->spp ? options->spp : 64;
    j.path.bounces = options->path.bounces ? options->path.bounces : 16;
    if (j.spp < 1 || j.spp > 1 << 24 || j.path.bounces < 1 || j.path.bounces > RENDER_MAX_BOUNCES)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "%d samples a pixel, %d bounces: expected 1 to %d and 1 to %d", j.spp,
                           j.path.bounces, 1 << 24, RENDER_MAX_BOUNCES);
    j.started = j.saved = hnbrdf_seconds();
    j.fingerprint = options->state ? fingerprint(&j) : 0;
    hnbrdf_result result = HNBRDF_OK;
    if (options->resume && options->state && access(options->state, F_OK) == 0)
        result = render_film_load(options->state, j.fingerprint, film, error);
    if (result == HNBRDF_OK)
        result = run(&j, error);
    *complete = result == HNBRDF_OK && share_done(&j) >= 1.0;
    return result;
}
