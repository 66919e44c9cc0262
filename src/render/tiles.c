/* tiles.c: the parts of a picture, handed out to threads. */
#include "render/tiles.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <unistd.h>

enum { MAX_THREADS = 256 };

typedef struct queue {
    const render_tiles *tiles;
    atomic_int next, done, stop;
} queue;

static void work(queue *q, int is_caller)
{
    const render_tiles *tiles = q->tiles;
    for (;;) {
        int tile = atomic_fetch_add(&q->next, 1);
        if (tile >= tiles->count || atomic_load(&q->stop))
            return;
        tiles->work(tiles->user, tile);
        double share = (double)(atomic_fetch_add(&q->done, 1) + 1) / tiles->count;
        if (is_caller && tiles->progress && tiles->progress(tiles->progress_user, share))
            atomic_store(&q->stop, 1);
    }
}

static void *worker(void *argument)
{
    work(argument, 0);
    return NULL;
}

static int thread_count(int wanted)
{
    long count = wanted > 0 ? wanted : sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > MAX_THREADS ? MAX_THREADS : (int)count;
}

int render_tiles_run(const render_tiles *tiles)
{
    queue q = {.tiles = tiles};
    pthread_t handles[MAX_THREADS];
    int threads = thread_count(tiles->threads), started = 0;
    atomic_init(&q.next, 0);
    atomic_init(&q.done, 0);
    atomic_init(&q.stop, 0);
    while (started < threads - 1 && pthread_create(&handles[started], NULL, worker, &q) == 0)
        started++;
    work(&q, 1);
    for (int i = 0; i < started; i++)
        pthread_join(handles[i], NULL);
    return atomic_load(&q.stop);
}
