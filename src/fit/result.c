/* result.c: the model of what was found and trained. */
#include "fit/trainer.h"

#include "base/clock.h"
#include "base/error.h"
#include "fit/ggx.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The trained weights as desc wants them, row-major without padding, in `weights`. */
static void describe_network(const trainer *t, float *weights, hnbrdf_model_desc *desc)
{
    const fit_layout *l = &t->layout;
    const float *p = t->parameters;
    desc->encoding = t->encoding;
    desc->hidden = l->hidden_size;
    desc->layers = l->layers;
    desc->latent = l->latent_size;
    desc->floor = l->floor;
    for (int k = 0; k <= l->layers; k++) {
        int rows, columns;
        hnbrdf_fit_layer_size(l, k, &rows, &columns);
        desc->weights[k] = weights;
        desc->biases[k] = p + l->bias[k];
        for (int o = 0; o < rows; o++)
            for (int i = 0; i < columns; i++)
                *weights++ = p[hnbrdf_fit_weight_at(l, k, o, i)];
    }
}

/* Latent codes, and the analytic part where it was trained along. */
static void settle_materials(trainer *t)
{
    const fit_layout *l = &t->layout;
    for (int m = 0; m < t->count; m++) {
        hnbrdf_material *material = &t->found[m].material;
        memcpy(material->latent, t->parameters + l->codes + (size_t)(m * l->latent_size),
               sizeof(float) * (size_t)l->latent_size);
        if (l->train_analytic)
            hnbrdf_fit_ggx_material(t->parameters + l->analytic + (size_t)m * FIT_ANALYTIC,
                                    material);
    }
}

/* ---- Lobes ----------------------------------------------------------------------------------- */

/* Of the materials of this rank, by its threads. */
typedef struct lobe_job {
    trainer *t;
    const hnbrdf_model *bare;
    const hnbrdf_material *materials;
    hnbrdf_lobes *lobes; /* [count] */
    atomic_int failed;   /* an hnbrdf_result */
} lobe_job;

static void fit_one(void *context, int index, int worker)
{
    lobe_job *job = context;
    trainer *t = job->t;
    const int m = t->held[index];
    hnbrdf_result result = hnbrdf_lobes_fit(job->bare, &job->materials[m], &job->lobes[m], NULL);
    if (result)
        atomic_store(&job->failed, (int)result);
    int done = atomic_fetch_add(&t->finished, 1) + 1;
    if (worker == 0)
        hnbrdf_fit_tell(t, "lobes", (double)done / t->held_count, NAN, 0.0, 0);
}

static hnbrdf_result without_lobes(const trainer *t, const hnbrdf_model_desc *desc,
                                   hnbrdf_material *materials, hnbrdf_model **model,
                                   hnbrdf_error *error)
{
    for (int m = 0; m < t->count; m++) /* those that were given may have some */
        memset(&materials[m].lobes, 0, sizeof materials[m].lobes);
    return hnbrdf_model_create(desc, NULL, model, error);
}

/* The same model with lobes for its first t->count materials, which stand in desc. */
static hnbrdf_result fit_lobes(trainer *t, hnbrdf_model_desc *desc, hnbrdf_material *materials,
                               hnbrdf_model **model, hnbrdf_error *error)
{
    hnbrdf_model *bare = NULL;
    hnbrdf_lobes *lobes = calloc((size_t)t->count, sizeof *lobes);
    hnbrdf_result result =
        lobes ? hnbrdf_model_create(desc, NULL, &bare, error)
              : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for the lobes");
    lobe_job job = {.t = t, .bare = bare, .materials = materials, .lobes = lobes};
    if (!result) {
        hnbrdf_fit_stage_begin(t);
        hnbrdf_threads_run(t->workers, t->held_count, fit_one, &job);
        result = (hnbrdf_result)atomic_load(&job.failed);
        if (result)
            hnbrdf_fail(error, result, "fitting lobes: %s", hnbrdf_strerror(result));
    }
    result = hnbrdf_fit_agree(t, result, error);
    if (!result)
        result = hnbrdf_fit_share_records(t, lobes, sizeof *lobes, error);
    for (int m = 0; m < t->count && !result; m++)
        materials[m].lobes = lobes[m];
    hnbrdf_model_free(bare);
    free(lobes);
    return result ? result : hnbrdf_model_create(desc, NULL, model, error);
}

/* ---- The model ------------------------------------------------------------------------------- */

hnbrdf_result hnbrdf_fit_result(trainer *t, hnbrdf_model **model, hnbrdf_fit_report *report,
                                hnbrdf_error *error)
{
    const fit_layout *l = &t->layout;
    size_t h = (size_t)l->hidden_size, in = FIT_INPUTS + (size_t)l->latent_size;
    size_t numbers = h * in + (size_t)l->layers * h * h + 6 * h;
    int before = t->options.freeze ? hnbrdf_model_material_count(t->options.freeze) : 0;
    size_t count = (size_t)before + (size_t)t->count;
    hnbrdf_model_desc desc = {0};
    float *weights = malloc(sizeof(float) * (numbers + 1));
    hnbrdf_material *materials = calloc(count + (size_t)t->count, sizeof *materials);
    const char **names = calloc(count, sizeof *names);
    hnbrdf_result result = HNBRDF_ERROR_MEMORY;
    if (!weights || !materials || !names) {
        hnbrdf_fail(error, result, "out of memory for the fitted model");
    } else {
        if (t->options.freeze)
            hnbrdf_model_describe(t->options.freeze, &desc);
        else if (l->kind != HNBRDF_KIND_GGX)
            describe_network(t, weights, &desc);
        hnbrdf_material *ggx = materials + count;
        for (int m = 0; m < t->count; m++)
            ggx[m] = t->found[m].material;
        settle_materials(t);
        int kept = 0; /* a new material takes the place of a known one of its name */
        for (int m = 0; m < t->count; m++) {
            names[m] = t->known[m].name;
            materials[m] = t->found[m].material;
        }
        for (int m = 0; m < before; m++) {
            int replaced = 0;
            for (int k = 0; k < t->count && !replaced; k++)
                replaced = strcmp(names[k], desc.names[m]) == 0;
            if (replaced)
                continue;
            names[t->count + kept] = desc.names[m];
            materials[t->count + kept++] = desc.materials[m];
        }
        desc.kind = l->kind;
        desc.material_count = t->count + kept;
        desc.materials = materials;
        desc.names = names;
        result = hnbrdf_fit_leave_alone(t, &desc, ggx, materials, report, error);
        if (!result)
            result = t->options.lobes_none ? without_lobes(t, &desc, materials, model, error)
                                           : fit_lobes(t, &desc, materials, model, error);
    }
    free(weights);
    free(materials);
    free(names);
    return result;
}
