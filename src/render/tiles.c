/* tiles.c: the parts of a picture, handed out to threads. */
#include "render/tiles.h"

#include "base/threads.h"

#include <stdatomic.h>

typedef struct queue {
    const render_tiles *tiles;
    atomic_int done, stop;
} queue;

static void work(void *context, int tile, int worker)
{
    queue *q = context;
    const render_tiles *tiles = q->tiles;
    if (atomic_load(&q->stop))
        return;
    tiles->work(tiles->user, tile);
    double share = (double)(atomic_fetch_add(&q->done, 1) + 1) / tiles->count;
    if (worker == 0 && tiles->progress && tiles->progress(tiles->progress_user, share))
        atomic_store(&q->stop, 1);
}

int render_tiles_run(const render_tiles *tiles)
{
    queue q = {.tiles = tiles};
    hnbrdf_threads *threads = hnbrdf_threads_start(tiles->threads);
    atomic_init(&q.done, 0);
    atomic_init(&q.stop, 0);
    if (threads)
        hnbrdf_threads_run(threads, tiles->count, work, &q);
    for (int tile = 0; !threads && tile < tiles->count; tile++)
        work(&q, tile, 0); /* no memory for threads */
    hnbrdf_threads_stop(threads);
    return atomic_load(&q.stop);
}
