/* bake_sizes.c: which networks `bake` may try, and what an evaluation with each of them costs here. */
#include "cli/bake.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WORTH = 8 /* tenths of the teacher's multiplications */ };
enum { TIMED_PAIRS = 2048, TIMED_ROUNDS = 25, OUTPUTS = 6, INPUTS = 6 };

/* One hidden layer loses to two at equal cost from 6 units on. */
static const int nets[][2] = {{4, 1},  {4, 2},  {6, 2},  {8, 2},  {8, 3},  {10, 2}, {12, 2},
                              {12, 3}, {16, 2}, {16, 3}, {20, 2}, {24, 2}, {24, 3}, {32, 2},
                              {32, 3}, {48, 2}, {48, 3}, {64, 2}, {64, 3}};
enum { NETS = sizeof nets / sizeof nets[0] };

void bake_size_name(const bake_candidate *candidate, char text[16])
{
    if (candidate->hidden)
        snprintf(text, 16, "%dx%d", candidate->hidden, candidate->layers);
    else
        snprintf(text, 16, "ggx");
}

static void add(bake *b, int hidden, int layers, int latent)
{
    size_t h = (size_t)hidden, in = INPUTS + (size_t)latent, n = (size_t)layers;
    bake_candidate *c = &b->candidates[b->candidate_count++];
    memset(c, 0, sizeof *c);
    if (!hidden)
        return;
    c->hidden = hidden;
    c->layers = layers;
    c->latent = latent;
    c->mults = h * in + h * h * (n - 1) + OUTPUTS * h;
    c->weights = c->mults + h * n + OUTPUTS;
}

static int by_mults(const void *a, const void *b)
{
    const bake_candidate *x = a, *y = b;
    return x->mults < y->mults ? -1 : x->mults > y->mults ? 1 : y->latent - x->latent;
}

/* A latent code of one float less than there are materials lets the network treat each of them as it
 * likes; half of that, where they resemble each other, does too. */
static void add_latents(bake *b, int hidden, int layers)
{
    size_t h = (size_t)hidden, fixed = h * (INPUTS + OUTPUTS) + h * h * ((size_t)layers - 1);
    if (!b->from_data && b->wish != BAKE_NET && fixed * 10 > b->reference_size.mults * WORTH)
        return; /* the model itself costs hardly more and has no error */
    int most = b->count - 1 < 8 ? b->count - 1 : 8;
    if (b->latent >= 0)
        most = b->latent;
    add(b, hidden, layers, most);
    if (b->latent < 0 && most / 2 > 0 && b->wish == BAKE_ERROR)
        add(b, hidden, layers, most / 2);
}

/* ---- Time ---------------------------------------------------------------------------------------- */

/* A network of this size with weights that mean nothing: time does not depend on them. */
static hnbrdf_model *make_dummy(const bake *b, const bake_candidate *c)
{
    static const char *const names[] = {"timed"};
    enum { MOST = HNBRDF_MAX_HIDDEN * HNBRDF_MAX_HIDDEN }; /* of one matrix; all layers share it */
    float *weights = malloc(sizeof(float) * MOST);
    hnbrdf_model *model = NULL;
    hnbrdf_model_desc desc = {.kind = c->hidden ? HNBRDF_KIND_HYBRID : HNBRDF_KIND_GGX,
                              .encoding = b->encoding < 0 ? HNBRDF_ENCODING_ANGLES
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

typedef struct stopwatch {
    float wi[TIMED_PAIRS][3], wo[TIMED_PAIRS][3], f[TIMED_PAIRS][3];
} stopwatch;

/* The least time an evaluation of `material` took so far. */
static void time_once(stopwatch *w, const hnbrdf_model *model, const hnbrdf_material *material,
                      double *ns)
{
    double started = cli_seconds();
    hnbrdf_eval_batch(model, material, TIMED_PAIRS, w->wi[0], 0, w->wo[0], 0, w->f[0], 0);
    *ns = fmin(*ns, (cli_seconds() - started) * 1e9 / TIMED_PAIRS);
}

/* Rounds over all sizes, so that a busy moment of the machine hits all alike; the least of each counts.
 */
static int time_all(bake *b)
{
    hnbrdf_rng rng;
    stopwatch *w = malloc(sizeof *w);
    hnbrdf_model **models = calloc((size_t)b->candidate_count, sizeof *models);
    int code = w && models ? CLI_OK : cli_fail("out of memory");
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; w && k < TIMED_PAIRS; k++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, w->wi[k], w->wo[k]);
    for (int k = 0; k < b->candidate_count && code == CLI_OK; k++) {
        b->candidates[k].ns = INFINITY;
        if (!(models[k] = make_dummy(b, &b->candidates[k])))
            code = cli_fail("out of memory");
    }
    const hnbrdf_material *first = hnbrdf_model_material(b->model, b->chosen[0]);
    b->reference_size.ns = INFINITY;
    for (int round = 0; round < TIMED_ROUNDS && code == CLI_OK; round++) {
        time_once(w, b->model, first, &b->reference_size.ns);
        for (int k = 0; k < b->candidate_count; k++)
            time_once(w, models[k], first, &b->candidates[k].ns);
    }
    for (int k = 0; models && k < b->candidate_count; k++)
        hnbrdf_model_free(models[k]);
    free(models);
    free(w);
    return code;
}

int bake_make_candidates(bake *b)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(b->model, &desc);
    b->reference_size.hidden = desc.hidden;
    b->reference_size.layers = desc.layers;
    b->reference_size.latent = desc.latent;
    b->reference_size.mults = hnbrdf_model_multiplications(b->model);
    b->reference_size.weights = hnbrdf_model_weight_count(b->model);
    b->candidates = calloc(2 * NETS + 3, sizeof *b->candidates);
    if (!b->candidates)
        return cli_fail("out of memory");
    add(b, 0, 0, 0);
    if (b->wish == BAKE_NET)
        add_latents(b, b->net[0], b->net[1]);
    for (int k = 0; k < NETS && b->wish != BAKE_NET; k++)
        add_latents(b, nets[k][0], nets[k][1]);
    qsort(b->candidates, (size_t)b->candidate_count, sizeof *b->candidates, by_mults);
    return time_all(b);
}
