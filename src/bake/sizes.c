/* sizes.c: which networks a bake may try, and what an evaluation with each of them costs here. */
#include "bake/task.h"
#include "base/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WORTH = 8 /* tenths of the teacher's multiplications */ };
enum { TIMED_PAIRS = 512, ROUNDS = 12, OUTPUTS = 6, INPUTS = 6 };

#define SAMPLE_NS 3e5

/* One hidden layer loses to two at equal cost from 6 units on. */
static const int nets[][2] = {{4, 1},  {4, 2},  {6, 2},  {8, 2},  {8, 3},  {10, 2}, {12, 2},
                              {12, 3}, {16, 2}, {16, 3}, {20, 2}, {24, 2}, {24, 3}, {32, 2},
                              {32, 3}, {48, 2}, {48, 3}, {64, 2}, {64, 3}};
enum { NETS = sizeof nets / sizeof nets[0] };

int hnbrdf_bake_same_size(const hnbrdf_bake_size *x, const hnbrdf_bake_size *y)
{
    return x->hidden == y->hidden && x->layers == y->layers && x->latent == y->latent &&
           x->encoding == y->encoding;
}

/* Whether turning a pair of directions about the normal may change what is learned from. */
static int is_isotropic(const bake_task *b)
{
    for (int m = 0; m < b->count; m++)
        if (!hnbrdf_measured_is_isotropic(b->reference[m]))
            return 0;
    return 1;
}

/* Those for anisotropic data have nothing over the others for isotropic ones, and those others see
 * no azimuth. */
static int suits(const bake_task *b, hnbrdf_encoding encoding)
{
    const int azimuth = hnbrdf_encoding_sees_azimuth(encoding);
    return is_isotropic(b) ? !azimuth || encoding == HNBRDF_ENCODING_DIRECTIONS : azimuth;
}

int hnbrdf_bake_encoding_count(const bake_task *b)
{
    int count = 0;
    for (int e = 0; b->options.all_encodings && hnbrdf_encoding_name((hnbrdf_encoding)e); e++)
        count += suits(b, (hnbrdf_encoding)e);
    return count ? count : 1;
}

static void add_one(bake_task *b, int hidden, int layers, int latent, int encoding)
{
    size_t h = (size_t)hidden, in = INPUTS + (size_t)latent, n = (size_t)layers;
    hnbrdf_bake_size *c = &b->candidates[b->candidate_count++];
    memset(c, 0, sizeof *c);
    c->half_ns = (double)NAN;
    c->encoding = encoding;
    if (!hidden)
        return;
    c->hidden = hidden;
    c->layers = layers;
    c->latent = latent;
    c->multiplications = h * in + h * h * (n - 1) + OUTPUTS * h;
    c->weights = c->multiplications + h * n + OUTPUTS;
}

static void add(bake_task *b, int hidden, int layers, int latent)
{
    if (!b->options.all_encodings || !hidden) {
        add_one(b, hidden, layers, latent, 0);
        return;
    }
    for (int e = 0; hnbrdf_encoding_name((hnbrdf_encoding)e); e++)
        if (suits(b, (hnbrdf_encoding)e))
            add_one(b, hidden, layers, latent, e + 1);
}

static int by_mults(const void *a, const void *b)
{
    const hnbrdf_bake_size *x = a, *y = b;
    return x->multiplications < y->multiplications   ? -1
           : x->multiplications > y->multiplications ? 1
           : x->latent != y->latent                  ? y->latent - x->latent
                                                     : x->encoding - y->encoding;
}

/* A latent code of one float less than there are materials lets the network treat each of them as
 * it likes; half of that, where they resemble each other, does too. */
static void add_latents(bake_task *b, int hidden, int layers)
{
    size_t h = (size_t)hidden, fixed = h * (INPUTS + OUTPUTS) + h * h * ((size_t)layers - 1);
    if (!b->from_data && b->options.wish != HNBRDF_BAKE_NET &&
        fixed * 10 > b->report.model.multiplications * WORTH)
        return; /* the model itself costs hardly more and has no error */
    int most = b->count - 1 < 8 ? b->count - 1 : 8;
    if (b->latent >= 0)
        most = b->latent;
    add(b, hidden, layers, most);
    if (b->latent < 0 && most / 2 > 0 && b->options.wish == HNBRDF_BAKE_ERROR)
        add(b, hidden, layers, most / 2);
}

/* ---- Time ------------------------------------------------------------------------------------ */

/* A network of this size with weights that mean nothing: time does not depend on them. */
static hnbrdf_model *make_dummy(const bake_task *b, const hnbrdf_bake_size *c)
{
    static const char *const names[] = {"timed"};
    enum { MOST = HNBRDF_MAX_HIDDEN * HNBRDF_MAX_HIDDEN }; /* of one matrix; all layers share it */
    float *weights = malloc(sizeof(float) * MOST);
    hnbrdf_model *model = NULL;
    hnbrdf_model_desc desc = {.kind = c->hidden ? HNBRDF_KIND_HYBRID : HNBRDF_KIND_GGX,
                              .encoding = c->encoding       ? (hnbrdf_encoding)(c->encoding - 1)
                                          : b->encoding < 0 ? HNBRDF_ENCODING_ANGLES
                                                            : (hnbrdf_encoding)b->encoding,
                              .hidden = c->hidden,
                              .layers = c->layers,
                              .latent = c->latent,
                              .material_count = 1,
                              .materials = hnbrdf_model_material(b->model, b->chosen[0]),
                              .names = names};
    if (!weights)
        return NULL;
    for (int i = 0; i < MOST; i++)
        weights[i] = (float)(i * 37 % 101 - 50) * 0.006f;
    for (int k = 0; k <= c->layers; k++)
        desc.weights[k] = desc.biases[k] = weights;
    if (hnbrdf_model_create(&desc, NULL, &model, NULL) != HNBRDF_OK)
        model = NULL;
    free(weights);
    return model;
}

/* Directions to evaluate, and where the values go; of all probes. */
typedef struct stage {
    float wi[TIMED_PAIRS][3], wo[TIMED_PAIRS][3], f[TIMED_PAIRS][3];
} stage;

typedef struct act {
    stage *on;
    const hnbrdf_model *model;
    const hnbrdf_material *material;
} act;

static void run(void *context)
{
    act *a = context;
    hnbrdf_eval_batch(a->model, a->material, TIMED_PAIRS, a->on->wi[0], 0, a->on->wo[0], 0,
                      a->on->f[0], 0);
}

static int between(void *user, double share)
{
    const hnbrdf_bake_progress progress = {
        .stage = HNBRDF_BAKE_TIMING, .done = share, .loss = (double)NAN};
    return hnbrdf_bake_tell(user, &progress);
}

/* All sizes in turn, the model last: `models` and `acts` have a place for each. */
static void time_models(bake_task *b, stage *on, hnbrdf_model *const *models, act *acts,
                        hnbrdf_probe *probes, hnbrdf_probe **list)
{
    const hnbrdf_timing timing = {SAMPLE_NS, ROUNDS, between, b};
    int count = b->candidate_count;
    for (int k = 0; k <= count; k++) {
        acts[k] = (act){on, k < count ? models[k] : b->model,
                        hnbrdf_model_material(b->model, b->chosen[0])};
        probes[k] = hnbrdf_probe_of_thread(run, &acts[k], TIMED_PAIRS);
        list[k] = &probes[k];
    }
    hnbrdf_time_probes(&timing, list, count + 1);
    for (int k = 0; k < count; k++)
        b->candidates[k].ns = probes[k].ns;
    b->report.model.ns = probes[count].ns;
}

/* By whoever asked to do it. */
static void time_elsewhere(bake_task *b, hnbrdf_model *const *models)
{
    const hnbrdf_bake_options *o = &b->options;
    for (int k = 0; k < b->candidate_count; k++) {
        hnbrdf_bake_size *c = &b->candidates[k];
        if (between(b, (double)k / b->candidate_count))
            return;
        c->ns = o->time(o->time_user, models[k], 0);
        c->half_ns = c->hidden ? o->time(o->time_user, models[k], 1) : (double)NAN;
    }
    b->report.model.ns = o->time(o->time_user, b->model, 0);
}

static hnbrdf_result time_all(bake_task *b, hnbrdf_error *error)
{
    hnbrdf_rng rng;
    size_t count = (size_t)b->candidate_count;
    stage *on = malloc(sizeof *on);
    hnbrdf_model **models = calloc(count, sizeof *models);
    act *acts = calloc(count + 1, sizeof *acts);
    hnbrdf_probe *probes = calloc(count + 1, sizeof *probes),
                 **list = calloc(count + 1, sizeof *list);
    int ready = on && models && acts && probes && list;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; ready && k < TIMED_PAIRS; k++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, on->wi[k], on->wo[k]);
    for (size_t k = 0; ready && k < count; k++)
        ready = (models[k] = make_dummy(b, &b->candidates[k])) != NULL;
    if (ready && b->options.time)
        time_elsewhere(b, models);
    else if (ready)
        time_models(b, on, models, acts, probes, list);
    for (size_t k = 0; models && k < count; k++)
        hnbrdf_model_free(models[k]);
    free(models);
    free(acts);
    free(probes);
    free(list);
    free(on);
    return ready ? HNBRDF_OK : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
}

hnbrdf_result hnbrdf_bake_make_candidates(bake_task *b, hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(b->model, &desc);
    b->report.model.hidden = desc.hidden;
    b->report.model.layers = desc.layers;
    b->report.model.latent = desc.latent;
    b->report.model.multiplications = hnbrdf_model_multiplications(b->model);
    b->report.model.weights = hnbrdf_model_weight_count(b->model);
    b->candidates =
        calloc((2 * NETS + 3) * (size_t)hnbrdf_bake_encoding_count(b), sizeof *b->candidates);
    if (!b->candidates)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    add(b, 0, 0, 0);
    if (b->options.wish == HNBRDF_BAKE_NET)
        add_latents(b, b->options.hidden, b->options.layers);
    for (int k = 0; k < NETS && b->options.wish != HNBRDF_BAKE_NET; k++)
        add_latents(b, nets[k][0], nets[k][1]);
    qsort(b->candidates, (size_t)b->candidate_count, sizeof *b->candidates, by_mults);
    hnbrdf_result result = hnbrdf_ranks_agree(b->options.ranks, time_all(b, error), NULL, error);
    /* the times of one machine decide */
    if (!result)
        result = hnbrdf_bake_spread(b, 0, b->candidates,
                                    (size_t)b->candidate_count * sizeof *b->candidates, error);
    if (!result && b->options.max_ggx > 0.0)
        b->options.max_ns = b->report.max_ns = b->options.max_ggx * b->candidates[0].ns;
    return result ? result
                  : hnbrdf_bake_spread(b, 0, &b->report.model, sizeof b->report.model, error);
}
