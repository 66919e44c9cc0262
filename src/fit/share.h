/* share.h: how the tiles of a step are shared out among ranks and threads. */
#ifndef HNBRDF_FIT_SHARE_H
#define HNBRDF_FIT_SHARE_H

/* Gradients are summed in this many pieces, whatever the number of threads and ranks: the sums of
 * the chunks one after the other, in each chunk its tiles one after the other. */
enum { FIT_CHUNKS = 16 };

/* A unit is a run of tiles whose gradients are added up in one place: a chunk, or one tile where
 * there are more ranks than chunks. Each rank has units that follow each other. A piece is what one
 * thread works on: a unit, or one tile where a rank has more threads than units. */
typedef struct fit_share {
    int tiles;       /* of a step */
    int chunk_tiles; /* of a chunk */
    int unit_tiles;  /* of a unit */
    int piece_tiles; /* of a piece of this rank */
    int rank, ranks;
    int first, end; /* the tiles of this rank: first to end - 1 */
} fit_share;

/* tiles is a multiple of FIT_CHUNKS. */
fit_share hnbrdf_fit_share_make(int tiles, int rank, int ranks, int threads);
/* The first tile of a rank; the first one past all for rank == ranks. */
int hnbrdf_fit_share_first(const fit_share *share, int rank);
int hnbrdf_fit_share_tiles(const fit_share *share, int rank);
/* Which rank works on a tile. */
int hnbrdf_fit_share_rank(const fit_share *share, int tile);

#endif
