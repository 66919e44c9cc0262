/* tiles.h: the parts of a picture, handed out to threads. */
#ifndef HNBRDF_RENDER_TILES_H
#define HNBRDF_RENDER_TILES_H

typedef struct render_tiles {
    int count;
    int threads; /* 0: all cores */
    void (*work)(void *user, int tile);
    void *user;
    /* Called from the caller's thread with the share done, 0 to 1, after each of its tiles;
     * non-zero stops: no further tile is begun. May be NULL. */
    int (*progress)(void *user, double share);
    void *progress_user;
} render_tiles;

/* Calls work once for each tile, in any order. Returns 0, or 1 if it was stopped. */
int render_tiles_run(const render_tiles *tiles);

#endif
