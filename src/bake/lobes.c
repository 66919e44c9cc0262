/* lobes.c: the lobes of the model that was picked; candidates have none. */
#include "bake/task.h"
#include "base/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct lobe_job {
    bake_task *b;
    const hnbrdf_model *model;
    hnbrdf_material *materials;
    atomic_int done, failed; /* materials; an hnbrdf_result */
} lobe_job;

static void fit_one(void *context, int index, int worker)
{
    lobe_job *job = context;
    hnbrdf_result result =
        hnbrdf_lobes_fit(job->model, &job->materials[index], &job->materials[index].lobes, NULL);
    if (result)
        atomic_store(&job->failed, (int)result);
    const int done = atomic_fetch_add(&job->done, 1) + 1;
    const hnbrdf_bake_progress progress = {
        .stage = HNBRDF_BAKE_LOBES, .done = (double)done / job->b->count, .loss = (double)NAN};
    (void)worker;
    hnbrdf_bake_tell(job->b, &progress); /* too late to be stopped: little is left */
}

hnbrdf_result hnbrdf_bake_lobes(bake_task *b, hnbrdf_model **model, hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model *made = NULL;
    hnbrdf_model_describe(*model, &desc);
    const size_t size = sizeof(hnbrdf_material) * (size_t)desc.material_count;
    lobe_job job = {.b = b, .model = *model, .materials = malloc(size)};
    hnbrdf_threads *threads =
        hnbrdf_threads_start(b->options.threads ? b->options.threads : hnbrdf_processors());
    hnbrdf_result result = HNBRDF_OK;
    if (!job.materials || !threads) {
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for the lobes");
    } else {
        memcpy(job.materials, desc.materials, size);
        desc.materials = job.materials;
        hnbrdf_threads_run(threads, desc.material_count, fit_one, &job);
        result = (hnbrdf_result)atomic_load(&job.failed);
        if (result)
            hnbrdf_fail(error, result, "fitting lobes: %s", hnbrdf_strerror(result));
    }
    if (!result)
        result = hnbrdf_model_create(&desc, NULL, &made, error);
    hnbrdf_threads_stop(threads);
    free(job.materials);
    if (!result) {
        hnbrdf_model_free(*model);
        *model = made;
    }
    return result;
}
