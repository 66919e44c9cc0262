/* alone.c: materials that the network makes no better are left to GGX alone. */
#include "fit/ggx.h"
#include "fit/switch.h"
#include "fit/trainer.h"
#include "fit/worth.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS_TILES = 256 }; /* 16384 pairs know a SMAPE to half a per cent */

/* Of the materials of this rank, by its threads. */
typedef struct job {
    trainer *t;
    const hnbrdf_model *hybrid, *ggx;
    hnbrdf_fit_worth *worth; /* [count] */
} job;

static void look_at(void *context, int index, int worker)
{
    const job *j = context;
    trainer *t = j->t;
    const int m = t->held[index];
    float room[FIT_POOL_TILE];
    hnbrdf_prepared hybrid, ggx;
    (void)worker;
    hnbrdf_prepare(j->hybrid, hnbrdf_model_material(j->hybrid, m), &hybrid);
    hnbrdf_prepare(j->ggx, hnbrdf_model_material(j->ggx, m), &ggx);
    const fit_sides sides = {&hybrid, &ggx};
    hnbrdf_fit_worth_smape(&sides, &t->pool, index, PAIRS_TILES, room, &j->worth[m]);
    hnbrdf_fit_worth_picture(&sides, t->data[m], &j->worth[m]);
}

/* A model of the first t->count materials of `of`, as their GGX. */
static hnbrdf_result make_ggx(const trainer *t, const hnbrdf_model_desc *of,
                              const hnbrdf_material *ggx, hnbrdf_model **model, hnbrdf_error *error)
{
    const hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = t->count, .materials = ggx, .names = of->names};
    return hnbrdf_model_create(&desc, NULL, model, error);
}

/* Fills worth of all materials, the same on every rank. */
static hnbrdf_result look(trainer *t, const hnbrdf_model_desc *desc, const hnbrdf_material *ggx,
                          hnbrdf_fit_worth *worth, hnbrdf_error *error)
{
    hnbrdf_model *models[2] = {NULL, NULL};
    hnbrdf_result result = hnbrdf_model_create(desc, NULL, &models[0], error);
    if (!result)
        result = make_ggx(t, desc, ggx, &models[1], error);
    if (!result)
        hnbrdf_threads_run(t->workers, t->held_count, look_at,
                           &(job){t, models[0], models[1], worth});
    result = hnbrdf_fit_agree(t, result, error);
    if (!result)
        result = hnbrdf_fit_share_records(t, worth, sizeof *worth, error);
    hnbrdf_model_free(models[0]);
    hnbrdf_model_free(models[1]);
    return result;
}

/* Where GGX is nearly exact in pictures but not in SMAPE (a channel that is 0, say), a network that
 * halves SMAPE is no loss as long as nobody sees what it costs. */
static int is_worse(const hnbrdf_fit_worth *w)
{
    const int unseen = w->picture <= w->unseen && 2.0 * w->smape <= w->ggx_smape;
    return w->smape > w->ggx_smape || (w->picture > w->ggx_picture && !unseen);
}

/* kd, eta and alpha of GGX, and the code that turns the network off. */
static void leave(const hnbrdf_material *ggx, const float *code, hnbrdf_material *material)
{
    memcpy(material->latent, code, sizeof material->latent);
    memcpy(material->kd, ggx->kd, sizeof material->kd);
    memcpy(material->eta, ggx->eta, sizeof material->eta);
    memcpy(material->alpha, ggx->alpha, sizeof material->alpha);
}

hnbrdf_result hnbrdf_fit_leave_alone(trainer *t, const hnbrdf_model_desc *desc,
                                     const hnbrdf_material *ggx, hnbrdf_material *materials,
                                     hnbrdf_fit_report *report, hnbrdf_error *error)
{
    if (t->layout.kind != HNBRDF_KIND_HYBRID)
        return HNBRDF_OK;
    hnbrdf_fit_worth *worth = calloc((size_t)t->count, sizeof *worth);
    if (!worth)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for %d materials", t->count);
    hnbrdf_result result = look(t, desc, ggx, worth, error);
    float code[HNBRDF_MAX_LATENT] = {0};
    const int can = hnbrdf_fit_switch_code(desc, code);
    for (int m = 0; m < t->count && !result && !report->ggx_alone; m++)
        if (is_worse(&worth[m])) {
            worth[m].worse = 1;
            worth[m].alone = can;
            report->left_alone += can;
            report->worse += !can;
            if (can)
                leave(&ggx[m], code, &materials[m]);
        }
    if (!result && t->options.worth)
        memcpy(t->options.worth, worth, (size_t)t->count * sizeof *worth);
    free(worth);
    return result;
}
