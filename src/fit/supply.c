/* supply.c: brings the tiles of coming steps to the ranks that work on them, a few steps at a time.
 *
 * A tile stays with the rank that holds its material; whoever works on it in a step gets a copy,
 * which is smaller than the gradient that would travel otherwise. All ranks know the schedule, so
 * that nobody has to ask. */
#include "fit/trainer.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

enum { WINDOW_TILES = 512 }; /* of a window, unless a step has more */

size_t hnbrdf_fit_supply_tile_bytes(const fit_layout *layout)
{
    return sizeof(float) * (size_t)(layout->train_analytic ? FIT_POOL_TILE : FIT_POOL_WI);
}

/* Floats of a tile that training sees, and that are sent: the directions only where they matter. */
static size_t tile_floats(const trainer *t)
{
    return hnbrdf_fit_supply_tile_bytes(&t->layout) / sizeof(float);
}

static int is_mine(const trainer *t, int material)
{
    return t->owner[material] == t->ranks.rank;
}

/* Tiles of several steps, in the places where they are worked on. */
typedef struct batch {
    int *material, *tile; /* [steps][tiles a step] the same on all ranks */
    const float **data;   /* [steps][tiles a step] NULL where another rank works on the tile */
    float *room;          /* of tiles that were sent here or drawn again */
} batch;

/* A batch on its way. */
typedef struct delivery {
    trainer *t;
    const batch *batch;
    int slots;         /* tiles of all steps */
    float **to;        /* [slots] where a tile of this rank goes; NULL: it stays or is not ours */
    int *first, *last; /* [held] the slots of a material, in turn */
    int *following;    /* [slots] */
    int *wanted, materials; /* [held] the materials with slots */
    size_t *send, *receive; /* [ranks] bytes, 0 for this rank */
    size_t redrawn;         /* bytes of the tiles that are drawn again for this rank */
    float **from, **into;   /* [ranks] where the next tile from a rank, or to it, lies */
} delivery;

static int worker_of(const delivery *d, int slot)
{
    return hnbrdf_fit_share_rank(&d->t->shares, slot % d->t->shares.tiles);
}

/* ---- What goes where ------------------------------------------------------------------------- */

static void count_bytes(delivery *d)
{
    const trainer *t = d->t;
    const size_t ranks = (size_t)t->ranks.size, bytes = tile_floats(t) * sizeof(float);
    memset(d->send, 0, ranks * sizeof *d->send);
    memset(d->receive, 0, ranks * sizeof *d->receive);
    d->redrawn = 0;
    for (int s = 0; s < d->slots; s++) {
        const int m = d->batch->material[s], owner = t->owner[m], worker = worker_of(d, s);
        const int kept = is_mine(t, m) && t->at[m] < t->pool.kept;
        if (owner != worker && is_mine(t, m))
            d->send[worker] += bytes;
        if (worker == t->ranks.rank && !is_mine(t, m))
            d->receive[owner] += bytes;
        else if (worker == t->ranks.rank && !kept)
            d->redrawn += bytes;
    }
}

/* Slot s is one of material k of those held. */
static void line_up(delivery *d, int s, int k)
{
    d->following[s] = -1;
    if (d->first[k] < 0) {
        d->first[k] = s;
        d->wanted[d->materials++] = k;
    } else {
        d->following[d->last[k]] = s;
    }
    d->last[k] = s;
}

/* Each rank's part of a row of parts; this rank's own comes last. */
static void divide(const trainer *t, float *row, const size_t *bytes, float **parts)
{
    for (int r = 0; r < t->ranks.size; r++) {
        parts[r] = row;
        row += bytes[r] / sizeof(float);
    }
    parts[t->ranks.rank] = row;
}

static float *take(float **place, size_t size)
{
    float *taken = *place;
    *place += size;
    return taken;
}

/* Places of the tiles that this rank works on, and of those that it has: here or in a parcel. */
static void address(delivery *d)
{
    trainer *t = d->t;
    const size_t size = tile_floats(t);
    const int me = t->ranks.rank;
    d->materials = 0;
    memset(d->first, -1, (size_t)t->held_count * sizeof(int));
    for (int s = 0; s < d->slots; s++) {
        const int m = d->batch->material[s], owner = t->owner[m], worker = worker_of(d, s);
        const int kept = owner == me && t->at[m] < t->pool.kept;
        d->batch->data[s] = NULL;
        d->to[s] = NULL;
        if (worker == me && kept)
            d->batch->data[s] = hnbrdf_fit_pool_fetch(&t->pool, t->at[m], d->batch->tile[s], NULL);
        else if (worker == me) /* its own ones are drawn again */
            d->batch->data[s] = d->to[s] = take(&d->from[owner], size);
        else if (owner == me)
            d->to[s] = take(&d->into[worker], size);
        if (owner != me)
            d->to[s] = NULL;
        else if (d->to[s])
            line_up(d, s, t->at[m]);
    }
}

/* ---- Bringing it there ----------------------------------------------------------------------- */

static void fetch_material(void *context, int index, int worker)
{
    delivery *d = context;
    trainer *t = d->t;
    const int k = d->wanted[index];
    float room[FIT_POOL_TILE];
    (void)worker;
    for (int s = d->first[k]; s >= 0; s = d->following[s]) {
        const float *tile = hnbrdf_fit_pool_fetch(&t->pool, k, d->batch->tile[s], room);
        memcpy(d->to[s], tile, tile_floats(t) * sizeof(float));
    }
}

static size_t sum(const size_t *bytes, int count)
{
    size_t all = 0;
    for (int r = 0; r < count; r++)
        all += bytes[r];
    return all;
}

static int begin(delivery *d, trainer *t, const batch *of, int steps)
{
    const size_t ranks = (size_t)t->ranks.size, held = (size_t)t->held_count + 1;
    *d = (delivery){.t = t, .batch = of, .slots = steps * t->shares.tiles};
    d->to = calloc((size_t)d->slots, sizeof *d->to);
    d->following = calloc((size_t)d->slots, sizeof(int));
    d->first = calloc(held, sizeof(int));
    d->last = calloc(held, sizeof(int));
    d->wanted = calloc(held, sizeof(int));
    d->send = calloc(ranks, sizeof *d->send);
    d->receive = calloc(ranks, sizeof *d->receive);
    d->from = calloc(ranks, sizeof *d->from);
    d->into = calloc(ranks, sizeof *d->into);
    return d->to && d->following && d->first && d->last && d->wanted && d->send && d->receive &&
           d->from && d->into;
}

static void end(delivery *d)
{
    void *all[] = {d->to,   d->following, d->first, d->last, d->wanted,
                   d->send, d->receive,   d->from,  d->into};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        free(all[i]);
}

/* 0 where a rank is lost. */
static int deliver(delivery *d, float *parcel)
{
    trainer *t = d->t;
    const double before = hnbrdf_threads_busy(t->workers);
    divide(t, d->batch->room, d->receive, d->from);
    divide(t, parcel, d->send, d->into);
    address(d);
    if (d->materials > 0)
        hnbrdf_threads_run(t->workers, d->materials, fetch_material, d);
    t->redrawing += hnbrdf_threads_busy(t->workers) - before;
    return hnbrdf_fit_is_alone(t) ||
           hnbrdf_fit_exchange(t, parcel, d->send, d->batch->room, d->receive);
}

/* ---- Batches --------------------------------------------------------------------------------- */

struct fit_supply {
    batch window, sample; /* the coming steps; what judge.c sees */
    delivery on_its_way;  /* the window */
    fit_schedule ahead;   /* of the step after the window */
    int steps, at;        /* of the window; of them, done */
    float *parcel;        /* of the window */
};

static int make_batch(const trainer *t, batch *b, int steps)
{
    const size_t slots = (size_t)steps * (size_t)t->shares.tiles;
    b->material = calloc(slots, sizeof(int));
    b->tile = calloc(slots, sizeof(int));
    b->data = calloc(slots, sizeof *b->data);
    return b->material && b->tile && b->data;
}

static void free_batch(batch *b)
{
    free(b->material);
    free(b->tile);
    free((void *)b->data);
    free(b->room);
}

static float *room_of(size_t bytes)
{
    return malloc(bytes + sizeof(float));
}

int hnbrdf_fit_supply_rounds(const trainer *t)
{
    return (t->count + t->shares.tiles - 1) / t->shares.tiles;
}

static hnbrdf_result out_of_memory(const trainer *t, hnbrdf_error *error)
{
    return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY,
                       "rank %d of %d: out of memory for the tiles of %d materials", t->ranks.rank,
                       t->ranks.size, t->count);
}

/* The first tiles of all materials, which stay where they are judged. */
static hnbrdf_result make_sample(trainer *t, hnbrdf_error *error)
{
    batch *sample = &t->supply->sample;
    const int rounds = hnbrdf_fit_supply_rounds(t);
    float *parcel = NULL;
    delivery d = {0};
    hnbrdf_result result = HNBRDF_OK;
    if (make_batch(t, sample, rounds) && begin(&d, t, sample, rounds)) {
        for (int s = 0; s < d.slots; s++) {
            sample->material[s] = s % t->count;
            sample->tile[s] = s / t->count % t->pool.tiles;
        }
        count_bytes(&d);
        sample->room = room_of(d.redrawn + sum(d.receive, t->ranks.size));
        parcel = room_of(sum(d.send, t->ranks.size));
    }
    if (!sample->room || !parcel)
        result = out_of_memory(t, error);
    result = hnbrdf_fit_agree(t, result, error);
    if (!result && !deliver(&d, parcel))
        result = hnbrdf_fit_fail_lost(t, error);
    free(parcel);
    end(&d);
    return result;
}

hnbrdf_result hnbrdf_fit_supply_make(trainer *t, hnbrdf_error *error)
{
    struct fit_supply *supply = t->supply = calloc(1, sizeof *t->supply);
    int good = 0;
    if (supply) {
        const int tiles = t->shares.tiles;
        const size_t bytes = tile_floats(t) * sizeof(float);
        supply->steps = tiles < WINDOW_TILES ? WINDOW_TILES / tiles : 1;
        const size_t slots = (size_t)supply->steps * (size_t)tiles;
        const size_t mine = (size_t)supply->steps * (size_t)(t->shares.end - t->shares.first);
        const int stays = hnbrdf_fit_is_alone(t) && t->pool.kept == t->held_count;
        good = hnbrdf_fit_schedule_start(&supply->ahead, t->count, t->pool.tiles, 0) &&
               make_batch(t, &supply->window, supply->steps) &&
               begin(&supply->on_its_way, t, &supply->window, supply->steps);
        supply->window.room = room_of(stays ? 0 : mine * bytes);
        supply->parcel = room_of(hnbrdf_fit_is_alone(t) ? 0 : (slots - mine) * bytes);
        good = good && supply->window.room && supply->parcel;
    }
    hnbrdf_result result = hnbrdf_fit_agree(t, good ? HNBRDF_OK : out_of_memory(t, error), error);
    return result ? result : make_sample(t, error);
}

void hnbrdf_fit_supply_free(trainer *t)
{
    if (!t->supply)
        return;
    end(&t->supply->on_its_way);
    free_batch(&t->supply->window);
    free_batch(&t->supply->sample);
    hnbrdf_fit_schedule_free(&t->supply->ahead);
    free(t->supply->parcel);
    free(t->supply);
}

/* ---- Steps ----------------------------------------------------------------------------------- */

static void show_step(trainer *t, const batch *b, int step)
{
    const size_t first = (size_t)step * (size_t)t->shares.tiles;
    t->tile_material = b->material + first;
    t->tile_data = b->data + first;
}

void hnbrdf_fit_supply_round(trainer *t, int r)
{
    show_step(t, &t->supply->sample, r);
}

void hnbrdf_fit_supply_restart(trainer *t)
{
    hnbrdf_fit_schedule_copy(&t->supply->ahead, &t->schedule);
    t->supply->at = t->supply->steps;
}

int hnbrdf_fit_supply_step(trainer *t)
{
    struct fit_supply *supply = t->supply;
    if (supply->at == supply->steps) {
        for (int s = 0; s < supply->steps; s++)
            hnbrdf_fit_schedule_step(&supply->ahead, t->shares.tiles,
                                     supply->window.material + s * t->shares.tiles,
                                     supply->window.tile + s * t->shares.tiles);
        count_bytes(&supply->on_its_way);
        supply->at = 0;
        if (!deliver(&supply->on_its_way, supply->parcel))
            return 0;
    }
    show_step(t, &supply->window, supply->at++);
    return 1;
}
