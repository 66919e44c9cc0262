/* share.c: how the tiles of a step are shared out. */
#include "fit/share.h"

int hnbrdf_fit_share_first(const fit_share *s, int rank)
{
    const long long units = s->tiles / s->unit_tiles;
    return (int)(units * rank / s->ranks) * s->unit_tiles;
}

int hnbrdf_fit_share_tiles(const fit_share *s, int rank)
{
    return hnbrdf_fit_share_first(s, rank + 1) - hnbrdf_fit_share_first(s, rank);
}

int hnbrdf_fit_share_rank(const fit_share *s, int tile)
{
    const long long units = s->tiles / s->unit_tiles, unit = tile / s->unit_tiles;
    return (int)(((unit + 1) * s->ranks - 1) / units); /* the last that starts at it or before */
}

/* Gradients of single tiles cost memory, and time to send: only so many for each rank or thread. */
enum { SINGLE_TILES = 16 };

fit_share hnbrdf_fit_share_make(int tiles, int rank, int ranks, int threads)
{
    fit_share s = {.tiles = tiles, .chunk_tiles = tiles / FIT_CHUNKS, .rank = rank, .ranks = ranks};
    s.unit_tiles = ranks > FIT_CHUNKS && tiles <= SINGLE_TILES * ranks ? 1 : s.chunk_tiles;
    s.first = hnbrdf_fit_share_first(&s, rank);
    s.end = hnbrdf_fit_share_first(&s, rank + 1);
    const int mine = s.end - s.first;
    const int too_few = mine / s.unit_tiles < threads && mine <= SINGLE_TILES * threads;
    s.piece_tiles = too_few ? 1 : s.unit_tiles;
    return s;
}
