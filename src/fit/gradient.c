/* gradient.c: loss and gradient of one step, summed in fixed chunks, so that neither the number of
 * threads nor that of ranks changes a bit.
 *
 * In one order: the tiles of a chunk one after the other, then the chunks. Pieces of that are made
 * by threads and ranks; where tiles of a chunk are apart, their gradients are still added one by
 * one. Each rank adds up one segment of the network's gradient for all; what the materials have of
 * their own is a few numbers a tile, which all ranks add up. */
#include "fit/trainer.h"

#include <stdlib.h>
#include <string.h>

/* What every rank says beside its sums. */
typedef struct word {
    double asked, trouble, elapsed;
} word;

struct fit_sums {
    size_t own_size;        /* numbers that a tile adds for its material */
    float *pieces;          /* [pieces of this rank][network] */
    float *own;             /* [tiles][own_size] */
    float *chunk;           /* [layout.count] the sum of one chunk */
    size_t *segment;        /* [ranks + 1] where the segments of the network start */
    float *send, *received; /* by rank, by unit: a segment */
    size_t *send_bytes, *received_bytes;
    char *mine, *all; /* by rank: word, losses, segment, own */
    size_t *mine_bytes;
};

static int tiles_of(const trainer *t, int rank)
{
    return hnbrdf_fit_share_tiles(&t->shares, rank);
}

/* ---- Memory ---------------------------------------------------------------------------------- */

static size_t segment_size(const struct fit_sums *s, int rank)
{
    return s->segment[rank + 1] - s->segment[rank];
}

/* Where the segment of a rank starts; one past all ranks: where the last one ends. */
static size_t segment_start(const fit_layout *l, int ranks, int rank)
{
    const size_t rows = l->network_count / FIT_LANES;
    return rows * (size_t)rank / (size_t)ranks * FIT_LANES;
}

static size_t own_size(const fit_layout *l)
{
    return (size_t)l->latent_size + (l->train_analytic ? FIT_ANALYTIC : 0);
}

size_t hnbrdf_fit_sums_sent(const fit_share *s, const fit_layout *l, int from, int to)
{
    const size_t units = (size_t)(hnbrdf_fit_share_tiles(s, from) / s->unit_tiles);
    return units * sizeof(float) *
           (segment_start(l, s->ranks, to + 1) - segment_start(l, s->ranks, to));
}

size_t hnbrdf_fit_sums_gathered(const fit_share *s, const fit_layout *l, int from)
{
    const size_t tiles = (size_t)hnbrdf_fit_share_tiles(s, from);
    const size_t segment = segment_start(l, s->ranks, from + 1) - segment_start(l, s->ranks, from);
    return sizeof(word) + tiles * sizeof(double) + (segment + tiles * own_size(l)) * sizeof(float);
}

/* Sizes of all messages: they are the same in every step. */
static void measure(const trainer *t, struct fit_sums *s)
{
    const fit_share *shares = &t->shares;
    const int ranks = shares->ranks, me = shares->rank;
    for (int r = 0; r <= ranks; r++)
        s->segment[r] = segment_start(&t->layout, ranks, r);
    for (int r = 0; r < ranks; r++) {
        s->send_bytes[r] = hnbrdf_fit_sums_sent(shares, &t->layout, me, r);
        s->received_bytes[r] = hnbrdf_fit_sums_sent(shares, &t->layout, r, me);
        s->mine_bytes[r] = hnbrdf_fit_sums_gathered(shares, &t->layout, r);
    }
}

static size_t sum(const size_t *bytes, int count)
{
    size_t all = 0;
    for (int r = 0; r < count; r++)
        all += bytes[r];
    return all;
}

int hnbrdf_fit_sums_make(trainer *t)
{
    struct fit_sums *s = t->sums = calloc(1, sizeof *t->sums);
    const fit_share *shares = &t->shares;
    const size_t ranks = (size_t)t->ranks.size, tiles = (size_t)shares->tiles;
    if (!s)
        return 0;
    s->own_size = own_size(&t->layout);
    const size_t pieces = (size_t)((shares->end - shares->first) / shares->piece_tiles);
    s->pieces = calloc(pieces * t->layout.network_count + 1, sizeof(float));
    s->own = calloc(tiles * s->own_size + 1, sizeof(float));
    s->chunk = calloc(t->layout.count + 1, sizeof(float));
    s->segment = calloc(ranks + 1, sizeof *s->segment);
    s->send_bytes = calloc(ranks, sizeof *s->send_bytes);
    s->received_bytes = calloc(ranks, sizeof *s->received_bytes);
    s->mine_bytes = calloc(ranks, sizeof *s->mine_bytes);
    t->losses = calloc(tiles, sizeof(double));
    if (!s->pieces || !s->own || !s->chunk || !s->segment || !s->send_bytes || !s->received_bytes ||
        !s->mine_bytes || !t->losses)
        return 0;
    if (hnbrdf_fit_is_alone(t))
        return 1;
    measure(t, s);
    s->send = malloc(sum(s->send_bytes, t->ranks.size) + 1);
    s->received = malloc(sum(s->received_bytes, t->ranks.size) + 1);
    s->mine = malloc(s->mine_bytes[t->ranks.rank]);
    s->all = malloc(sum(s->mine_bytes, t->ranks.size));
    return s->send && s->received && s->mine && s->all;
}

void hnbrdf_fit_sums_free(trainer *t)
{
    struct fit_sums *s = t->sums;
    free(t->losses);
    if (!s)
        return;
    void *all[] = {s->pieces, s->own,      s->chunk,      s->segment,
                   s->send,   s->received, s->send_bytes, s->received_bytes,
                   s->mine,   s->all,      s->mine_bytes};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        free(all[i]);
    free(s);
}

/* ---- Pieces ---------------------------------------------------------------------------------- */

/* Tiles lie anywhere in the pool: the memory fetches the next one while this one is used. */
static void ask_for(const float *tile)
{
#if defined(__GNUC__)
    enum { LINE = 64 / sizeof(float) };
    for (int i = 0; i < FIT_POOL_WI; i += LINE)
        __builtin_prefetch(tile + i);
#else
    (void)tile;
#endif
}

static void piece(void *context, int index, int worker)
{
    trainer *t = context;
    const struct fit_sums *s = t->sums;
    float *gradient = s->pieces + (size_t)index * t->layout.network_count;
    const int first = t->shares.first + index * t->shares.piece_tiles;
    memset(gradient, 0, sizeof(float) * t->layout.network_count);
    const int end = first + t->shares.piece_tiles;
    for (int k = first; k < end; k++) {
        if (k + 1 < end)
            ask_for(t->tile_data[k + 1]);
        const fit_tile tile = hnbrdf_fit_tile_view(t->tile_data[k]);
        float *own = s->own + (size_t)k * s->own_size;
        memset(own, 0, sizeof(float) * s->own_size);
        t->losses[k] = t->kernel->network(
            &t->layout, t->parameters, t->derived, &tile, t->tile_material[k], t->mix,
            t->scratch + (size_t)worker * t->layout.scratch_count, gradient, own);
    }
}

static void add(float *restrict to, const float *restrict from, size_t count)
{
    for (size_t i = 0; i < count; i++)
        to[i] += from[i];
}

/* ---- The network ----------------------------------------------------------------------------- */

/* to [size]: the sum of parts, `stride` numbers from one to the next, each of so many tiles; a
 * chunk's are added up before the chunks are. */
static void add_up(const trainer *t, const float *parts, size_t stride, int part_tiles, float *to,
                   size_t size)
{
    const int parts_a_chunk = t->shares.chunk_tiles / part_tiles;
    float *chunk = t->sums->chunk;
    for (int c = 0; c < FIT_CHUNKS; c++) {
        const float *first = parts + (size_t)(c * parts_a_chunk) * stride, *whole = first;
        if (parts_a_chunk > 1) {
            memcpy(chunk, first, size * sizeof(float));
            for (int p = 1; p < parts_a_chunk; p++)
                add(chunk, first + (size_t)p * stride, size);
            whole = chunk;
        }
        if (c == 0)
            memcpy(to, whole, size * sizeof(float));
        else
            add(to, whole, size);
    }
}

/* Sums of whole units in their first pieces, to be sent. */
static void close_units(trainer *t)
{
    const fit_share *shares = &t->shares;
    const size_t size = t->layout.network_count;
    const int pieces = shares->unit_tiles / shares->piece_tiles;
    for (int u = 0; pieces > 1 && u < (shares->end - shares->first) / shares->unit_tiles; u++)
        for (int p = 1; p < pieces; p++)
            add(t->sums->pieces + (size_t)(u * pieces) * size,
                t->sums->pieces + (size_t)(u * pieces + p) * size, size);
}

/* This rank's segment of the network's gradient, of all ranks' units. */
static int add_up_segment(trainer *t, float *segment)
{
    struct fit_sums *s = t->sums;
    const fit_share *shares = &t->shares;
    const size_t stride =
        (size_t)(shares->unit_tiles / shares->piece_tiles) * t->layout.network_count;
    const size_t size = segment_size(s, t->ranks.rank);
    const int units = (shares->end - shares->first) / shares->unit_tiles;
    float *send = s->send;
    close_units(t);
    for (int r = 0; r < t->ranks.size; r++)
        for (int u = 0; u < units; u++) {
            memcpy(send, s->pieces + (size_t)u * stride + s->segment[r],
                   segment_size(s, r) * sizeof(float));
            send += segment_size(s, r);
        }
    if (!hnbrdf_fit_exchange(t, s->send, s->send_bytes, s->received, s->received_bytes))
        return 0;
    add_up(t, s->received, size, shares->unit_tiles, segment, size);
    return 1;
}

/* ---- Among ranks ----------------------------------------------------------------------------- */

static char *put(char *to, const void *from, size_t bytes)
{
    memcpy(to, from, bytes);
    return to + bytes;
}

static const char *get(const char *from, void *to, size_t bytes)
{
    memcpy(to, from, bytes);
    return from + bytes;
}

static void hear(trainer *t)
{
    const struct fit_sums *s = t->sums;
    const char *from = s->all;
    t->troubled = 0;
    for (int r = 0; r < t->ranks.size; r++) {
        const size_t first = (size_t)hnbrdf_fit_share_first(&t->shares, r);
        const size_t tiles = (size_t)tiles_of(t, r);
        word said;
        from = get(from, &said, sizeof said);
        from = get(from, t->losses + first, tiles * sizeof(double));
        from = get(from, t->gradient + s->segment[r], segment_size(s, r) * sizeof(float));
        from = get(from, s->own + first * s->own_size, tiles * s->own_size * sizeof(float));
        t->stopped |= said.asked != 0.0;
        t->troubled |= said.trouble != 0.0;
        if (r == 0)
            t->elapsed = said.elapsed;
    }
}

/* The network's gradient, and what all ranks have of tiles. 0 where a rank is lost. */
static int tell_all(trainer *t)
{
    struct fit_sums *s = t->sums;
    const int rank = t->ranks.rank;
    const size_t first = (size_t)t->shares.first, tiles = (size_t)(t->shares.end - t->shares.first);
    const word said = {t->asked, t->trouble != HNBRDF_OK, hnbrdf_fit_stage_seconds(t)};
    char *to = put(s->mine, &said, sizeof said);
    to = put(to, t->losses + first, tiles * sizeof(double));
    float *segment = t->gradient + s->segment[rank];
    if (segment_size(s, rank) > 0 && !add_up_segment(t, segment))
        return 0;
    to = put(to, segment, segment_size(s, rank) * sizeof(float));
    put(to, s->own + first * s->own_size, tiles * s->own_size * sizeof(float));
    if (!hnbrdf_fit_gather(t, s->mine, s->all, s->mine_bytes))
        return 0;
    hear(t);
    return 1;
}

/* ---- The whole ------------------------------------------------------------------------------- */

/* Of a tile's own numbers, where those of its material lie in the layout. */
static void add_own(const trainer *t, float *to, int material, const float *own)
{
    const fit_layout *l = &t->layout;
    const size_t latent = (size_t)l->latent_size;
    add(to + l->codes + (size_t)material * latent, own, latent);
    if (l->train_analytic)
        add(to + l->analytic + (size_t)material * FIT_ANALYTIC, own + latent, FIT_ANALYTIC);
}

/* The sum of a chunk, of one of its materials, goes to the gradient; again, it is 0. */
static void settle_own(trainer *t, int material)
{
    const fit_layout *l = &t->layout;
    const size_t latent = (size_t)l->latent_size;
    float *code = t->sums->chunk + l->codes + (size_t)material * latent;
    float *analytic = t->sums->chunk + l->analytic + (size_t)material * FIT_ANALYTIC;
    add(t->gradient + l->codes + (size_t)material * latent, code, latent);
    memset(code, 0, latent * sizeof(float));
    if (!l->train_analytic)
        return;
    add(t->gradient + l->analytic + (size_t)material * FIT_ANALYTIC, analytic, FIT_ANALYTIC);
    memset(analytic, 0, FIT_ANALYTIC * sizeof(float));
}

static double add_up_tiles(trainer *t)
{
    const fit_layout *l = &t->layout;
    const int each = t->shares.chunk_tiles;
    double loss = 0.0;
    memset(t->gradient + l->network_count, 0,
           (hnbrdf_fit_trained(l) - l->network_count) * sizeof(float));
    for (int first = 0; first < t->shares.tiles; first += each) {
        double chunk = 0.0;
        for (int k = first; k < first + each; k++) {
            chunk += t->losses[k];
            add_own(t, t->sums->chunk, t->tile_material[k],
                    t->sums->own + (size_t)k * t->sums->own_size);
        }
        for (int k = first; k < first + each; k++)
            settle_own(t, t->tile_material[k]);
        loss += chunk;
    }
    return loss;
}

double hnbrdf_fit_step_gradient(trainer *t)
{
    const fit_layout *l = &t->layout;
    const fit_share *shares = &t->shares;
    const double scale = 1.0 / (3.0 * FIT_TILE * shares->tiles);
    t->kernel->derive(l, t->parameters, t->derived);
    hnbrdf_threads_run(t->workers, (shares->end - shares->first) / shares->piece_tiles, piece, t);
    if (hnbrdf_fit_is_alone(t))
        add_up(t, t->sums->pieces, l->network_count, shares->piece_tiles, t->gradient,
               l->network_count);
    else if (!tell_all(t))
        return 0.0;
    const double loss = add_up_tiles(t);
    for (size_t i = 0; i < hnbrdf_fit_trained(l); i++)
        t->gradient[i] *= (float)scale;
    return loss * scale;
}
