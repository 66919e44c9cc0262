/* checkpoint.c: the state of a training under way, to go on later with the very same result.
 *
 * A checkpoint is for the machine that wrote it: numbers in its own byte order, and a fingerprint
 * of data names, options and layout that must match. */
#include "fit/frozen.h"

#include "base/error.h"
#include "base/files.h"
#include "base/hash.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct header {
    char magic[16];
    uint64_t fingerprint;
    hnbrdf_rng rng;
    double share, peak, running;
    int64_t step, order_at;
    int64_t since, best_step, best_dead, set_backs;
    double best_loss;
} header;

static const char magic[16] = "hnbrdf-fit/3";

static uint64_t hash_number(uint64_t h, double value)
{
    return hnbrdf_hash(h, &value, sizeof value);
}

/* Everything that the result depends on, but for the values of the measurements. */
static uint64_t fingerprint(const trainer *t)
{
    const hnbrdf_fit_options *o = &t->options;
    const double numbers[] = {o->kind,
                              o->hidden,
                              o->layers,
                              o->latent,
                              t->encoding,
                              (double)o->floor,
                              o->analytic,
                              (double)o->steps,
                              o->seconds,
                              t->shares.tiles,
                              t->pool.tiles,
                              (double)o->learning_rate,
                              (double)o->seed,
                              t->count,
                              o->freeze ? 2 : 0, /* 1 once: by Adam */
                              o->loss,
                              o->schedule,
                              (double)o->uniform_share,
                              (double)o->horizon_share,
                              (double)o->bright_share,
                              (double)o->lift,
                              o->materials != NULL};
    uint64_t h = HNBRDF_HASH_START;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        h = hash_number(h, numbers[i]);
    for (int m = 0; m < t->count; m++)
        h = hnbrdf_hash(h, t->known[m].name, strlen(t->known[m].name) + 1);
    return h;
}

/* The arrays that follow the header. */
typedef struct block {
    void *data;
    size_t size;
} block;

enum { BLOCKS = 6 };
#define BLOCKS_OF(t)                                                        \
    {                                                                       \
        {(t)->parameters, 3 * (t)->layout.count * sizeof(float)},           \
            {(t)->best, (t)->layout.count * sizeof(float)},                 \
            {(t)->schedule.order, (size_t)(t)->count * sizeof(int)},        \
            {(t)->schedule.cursor, (size_t)(t)->count * sizeof(int)},       \
            {(t)->soap.state, (t)->soap.state_count * sizeof(float)},       \
        {                                                                   \
            (t)->frozen ? (void *)(t)->frozen->of : NULL,                   \
                (t)->frozen ? (size_t)(t)->count * sizeof(fit_searches) : 0 \
        }                                                                   \
    }

/* One pass over all blocks of the file, reading or writing. An absent block has no bytes. */
static int transfer(const trainer *t, FILE *file, int writing)
{
    const block blocks[BLOCKS] = BLOCKS_OF(t);
    for (size_t i = 0; i < BLOCKS; i++) {
        if (blocks[i].size == 0)
            continue;
        size_t done = writing ? fwrite(blocks[i].data, 1, blocks[i].size, file)
                              : fread(blocks[i].data, 1, blocks[i].size, file);
        if (done != blocks[i].size)
            return 0;
    }
    return 1;
}

/* 1 if parameters, moments and squares, count of each, are finite, and squares not negative. */
static int numbers_are_sound(const float *numbers, size_t count)
{
    for (size_t i = 0; i < 3 * count; i++)
        if (!isfinite(numbers[i]) || (i >= 2 * count && numbers[i] < 0.0f))
            return 0;
    return 1;
}

hnbrdf_result hnbrdf_fit_checkpoint_save(const trainer *t, hnbrdf_error *error)
{
    const char *path = t->options.checkpoint;
    header h;
    memset(&h, 0, sizeof h);
    memcpy(h.magic, magic, sizeof magic);
    h.fingerprint = fingerprint(t);
    h.rng = t->schedule.rng;
    h.share = t->share;
    h.peak = t->peak;
    h.running = t->running;
    h.step = t->step;
    h.order_at = t->schedule.at;
    h.since = t->since;
    h.best_step = t->best_step;
    h.best_dead = t->best_dead;
    h.set_backs = t->set_backs;
    h.best_loss = t->best_loss;
    hnbrdf_output output;
    const hnbrdf_result result = hnbrdf_output_open(path, &output, error);
    if (result)
        return result;
    if (fwrite(&h, sizeof h, 1, output.stream) == 1)
        transfer(t, output.stream, 1); /* closing tells whether it failed */
    return hnbrdf_output_close(&output, error);
}

/* 1 if these can be the searches of a material: as many as there is room for, in range. */
static int searches_are_sound(const fit_searches *s)
{
    const int most = s->phase == 0 ? FIT_STARTS : FIT_PULLS;
    int good = s->phase >= 0 && s->phase < FIT_PHASES && s->count > 0 && s->count <= most;
    for (int i = 0; i < s->count && good; i++) {
        const fit_point *p = &s->point[i];
        good = p->damping > 0.0 && p->damping <= 1e9 && p->pull >= 0.0 && p->pull <= 1e9;
        for (int k = 0; k < FIT_OWN; k++)
            good &= fabsf(p->at[k]) <= 1e6f && fabsf(p->trial[k]) <= 1e6f;
    }
    return good;
}

/* 1 if training could have stood like this: indices that exist, and numbers in range. */
static int is_sound(const trainer *t, const header *h)
{
    int good = h->step >= 0 && h->step < LONG_MAX && h->share >= 0.0 && h->share < 1.0 &&
               h->peak > 0.0 && h->peak <= DBL_MAX && !isinf(h->running) && h->order_at >= 0 &&
               h->order_at < t->count && h->since >= 0 && h->since <= h->step &&
               h->best_step >= 0 && h->best_step <= h->step && h->best_dead >= 0 &&
               h->best_dead <= HNBRDF_MAX_HIDDEN && h->set_backs >= 0 && h->set_backs <= h->step &&
               h->set_backs <= INT_MAX && h->best_loss >= 0.0 && h->best_loss <= DBL_MAX;
    for (int m = 0; m < t->count; m++)
        good &= t->schedule.order[m] >= 0 && t->schedule.order[m] < t->count &&
                t->schedule.cursor[m] >= 0 && t->schedule.cursor[m] < t->pool.tiles;
    for (int m = 0; m < t->count && t->frozen; m++)
        good &= searches_are_sound(&t->frozen->of[m]) &&
                t->frozen->of[m].phase == t->frozen->of[0].phase;
    for (size_t i = 0; i < t->layout.count; i++)
        good &= isfinite(t->best[i]) != 0;
    for (size_t i = 0; i < t->soap.state_count; i++)
        good &= isfinite(t->soap.state[i]) != 0;
    return good && numbers_are_sound(t->parameters, t->layout.count);
}

/* The file as it is, into t and *h. */
static hnbrdf_result read_file(trainer *t, header *h, hnbrdf_error *error)
{
    const char *path = t->options.checkpoint;
    FILE *file = hnbrdf_open_to_read(path);
    if (!file)
        return hnbrdf_fail(error, HNBRDF_ERROR_IO,
                           "%s: no checkpoint to resume from can be read there", path);
    hnbrdf_result result = HNBRDF_OK;
    if (fread(h, sizeof *h, 1, file) != 1 || memcmp(h->magic, magic, sizeof magic) != 0)
        result = hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                             "%s: not a checkpoint of this version of hnbrdf", path);
    else if (h->fingerprint != fingerprint(t))
        result = hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "%s: the checkpoint is of a fit with other data, options or seed; repeat that "
            "command with --resume, or start anew without it",
            path);
    else if (!transfer(t, file, 0) || fgetc(file) != EOF)
        result = hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                             "%s: the checkpoint is damaged: its size is wrong", path);
    else if (!is_sound(t, h))
        result = hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                             "%s: the checkpoint is damaged: it holds numbers that no training has",
                             path);
    fclose(file);
    return result;
}

/* What rank 0 has read, to all. */
static int spread(trainer *t, header *h)
{
    const block blocks[BLOCKS] = BLOCKS_OF(t);
    int good = hnbrdf_fit_broadcast(t, h, sizeof *h);
    for (int i = 0; i < BLOCKS && good; i++)
        good = blocks[i].size == 0 || hnbrdf_fit_broadcast(t, blocks[i].data, blocks[i].size);
    return good;
}

hnbrdf_result hnbrdf_fit_checkpoint_load(trainer *t, hnbrdf_error *error)
{
    header h;
    hnbrdf_result result = t->ranks.rank == 0 ? read_file(t, &h, error) : HNBRDF_OK;
    result = hnbrdf_fit_agree(t, result, error);
    if (!result && !spread(t, &h))
        result = hnbrdf_fit_fail_lost(t, error);
    if (result)
        return result;
    t->schedule.rng = h.rng;
    t->share = h.share;
    t->peak = h.peak;
    t->running = h.running;
    t->step = (long)h.step;
    t->schedule.at = (int)h.order_at;
    t->since = (long)h.since;
    t->best_step = (long)h.best_step;
    t->best_dead = (int)h.best_dead;
    t->set_backs = (int)h.set_backs;
    t->best_loss = h.best_loss;
    return HNBRDF_OK;
}
