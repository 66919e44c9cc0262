/* ranks_support.c: a communicator among threads. */
#include "ranks_support.h"

#include <pthread.h>
#include <string.h>

struct test_ranks {
    int count, waiting, round, broken;
    pthread_mutex_t mutex;
    pthread_cond_t moved;
    const void *data[TEST_RANKS_MOST];
    const size_t *bytes[TEST_RANKS_MOST];
};

typedef struct rank {
    test_ranks *of;
    int number;
    test_rank_fn work;
    void *context;
} rank;

/* All ranks meet here; non-zero where one has gone. */
static int meet(test_ranks *t)
{
    pthread_mutex_lock(&t->mutex);
    const int round = t->round;
    if (++t->waiting == t->count) {
        t->waiting = 0;
        t->round++;
        pthread_cond_broadcast(&t->moved);
    }
    while (round == t->round && !t->broken)
        pthread_cond_wait(&t->moved, &t->mutex);
    const int failed = round == t->round;
    pthread_mutex_unlock(&t->mutex);
    return failed;
}

static int show(rank *r, const void *data, const size_t *bytes)
{
    r->of->data[r->number] = data;
    r->of->bytes[r->number] = bytes;
    return meet(r->of);
}

static int gather(void *user, const void *mine, void *all, const size_t *bytes)
{
    rank *r = user;
    char *to = all;
    if (show(r, mine, bytes))
        return 1;
    for (int k = 0; k < r->of->count; k++) {
        memcpy(to, r->of->data[k], bytes[k]);
        to += bytes[k];
    }
    return meet(r->of);
}

static int exchange(void *user, const void *send, const size_t *send_bytes, void *received,
                    const size_t *received_bytes)
{
    rank *r = user;
    char *to = received;
    int wrong = 0;
    if (show(r, send, send_bytes))
        return 1;
    for (int k = 0; k < r->of->count; k++) {
        const char *from = r->of->data[k];
        for (int before = 0; before < r->number; before++)
            from += r->of->bytes[k][before];
        wrong |= r->of->bytes[k][r->number] != received_bytes[k];
        if (!wrong)
            memcpy(to, from, received_bytes[k]);
        to += received_bytes[k];
    }
    return meet(r->of) || wrong;
}

static int broadcast(void *user, void *data, size_t bytes, int root)
{
    rank *r = user;
    if (show(r, data, NULL))
        return 1;
    if (r->number != root)
        memcpy(data, r->of->data[root], bytes);
    return meet(r->of);
}

static void *run(void *context)
{
    rank *r = context;
    const hnbrdf_communicator ranks = {r->number, r->of->count, gather, exchange, broadcast, r};
    r->work(r->context, &ranks);
    pthread_mutex_lock(&r->of->mutex);
    r->of->broken = 1;
    pthread_cond_broadcast(&r->of->moved);
    pthread_mutex_unlock(&r->of->mutex);
    return NULL;
}

int test_ranks_run(int count, test_rank_fn work, void *context)
{
    test_ranks t = {.count = count};
    rank ranks[TEST_RANKS_MOST];
    pthread_t threads[TEST_RANKS_MOST];
    int started = 0;
    pthread_mutex_init(&t.mutex, NULL);
    pthread_cond_init(&t.moved, NULL);
    for (; started < count; started++) {
        ranks[started] = (rank){&t, started, work, context};
        if (pthread_create(&threads[started], NULL, run, &ranks[started]))
            break;
    }
    for (int k = 0; k < started; k++)
        pthread_join(threads[k], NULL);
    pthread_cond_destroy(&t.moved);
    pthread_mutex_destroy(&t.mutex);
    return started == count;
}
