/* threads.c: a small pool of POSIX threads that take pieces of work from one atomic counter. */
#define _POSIX_C_SOURCE 200809L
#include "base/threads.h"

#include "base/clock.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <unistd.h>
#endif

enum { MAX_THREADS = 256, MAX_PROCESSORS = 1024 };
/* Steps of a fit follow each other within 50 microseconds, and to wake a thread takes as long: who
 * waits stays awake for so many turns, in which other programs may run, and sleeps then. */
enum { TURNS = 200 };

struct hnbrdf_threads {
    pthread_mutex_t mutex;
    pthread_cond_t wake, done;
    atomic_uint round; /* a new number wakes the threads; changes with the mutex held */
    atomic_int busy;
    int quit, threads; /* how many there are, with the caller */
    int count;
    hnbrdf_work_fn work;
    void *context;
    atomic_int next;
    double worked[MAX_THREADS]; /* processor seconds, each written by its thread alone */
    pthread_t thread[MAX_THREADS];
    struct start {
        hnbrdf_threads *threads;
        int worker;
    } start[MAX_THREADS];
};

int hnbrdf_processors(void)
{
#ifdef _WIN32
    SYSTEM_INFO about;
    GetSystemInfo(&about);
    const long count = (long)about.dwNumberOfProcessors;
#else
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
#endif
    return count < 1 ? 1 : count > MAX_PROCESSORS ? MAX_PROCESSORS : (int)count;
}

double hnbrdf_threads_busy(const hnbrdf_threads *threads)
{
    double sum = 0.0;
    for (int i = 0; i < threads->threads; i++)
        sum += threads->worked[i];
    return sum;
}

double hnbrdf_threads_busy_here(const hnbrdf_threads *threads)
{
    return threads->worked[0];
}

static void take(hnbrdf_threads *w, int worker)
{
    double started = hnbrdf_thread_seconds();
    for (int index; (index = atomic_fetch_add(&w->next, 1)) < w->count;)
        w->work(w->context, index, worker);
    w->worked[worker] += hnbrdf_thread_seconds() - started;
}

/* Waits for another round than the one seen; 0 where there is none any more. */
static int wait_for_round(hnbrdf_threads *w, unsigned seen)
{
    for (int turn = 0; turn < TURNS; turn++) {
        if (atomic_load(&w->round) != seen)
            return 1;
        sched_yield();
    }
    pthread_mutex_lock(&w->mutex);
    while (atomic_load(&w->round) == seen && !w->quit)
        pthread_cond_wait(&w->wake, &w->mutex);
    const int more = atomic_load(&w->round) != seen;
    pthread_mutex_unlock(&w->mutex);
    return more;
}

static void wait_for_threads(hnbrdf_threads *w)
{
    for (int turn = 0; turn < TURNS; turn++) {
        if (atomic_load(&w->busy) == 0)
            return;
        sched_yield();
    }
    pthread_mutex_lock(&w->mutex);
    while (atomic_load(&w->busy) > 0)
        pthread_cond_wait(&w->done, &w->mutex);
    pthread_mutex_unlock(&w->mutex);
}

static void *loop(void *argument)
{
    struct start *start = argument;
    hnbrdf_threads *w = start->threads;
    for (unsigned seen = 0; wait_for_round(w, seen);) {
        seen = atomic_load(&w->round);
        take(w, start->worker);
        if (atomic_fetch_sub(&w->busy, 1) == 1) {
            pthread_mutex_lock(&w->mutex);
            pthread_cond_signal(&w->done);
            pthread_mutex_unlock(&w->mutex);
        }
    }
    return NULL;
}

hnbrdf_threads *hnbrdf_threads_start(int count)
{
    if (count <= 0)
        count = hnbrdf_processors();
    if (count > MAX_THREADS)
        count = MAX_THREADS;
    hnbrdf_threads *w = calloc(1, sizeof *w);
    if (!w)
        return NULL;
    pthread_mutex_init(&w->mutex, NULL);
    pthread_cond_init(&w->wake, NULL);
    pthread_cond_init(&w->done, NULL);
    w->threads = 1;
    for (int i = 1; i < count; i++) {
        w->start[i].threads = w;
        w->start[i].worker = i;
        if (pthread_create(&w->thread[i], NULL, loop, &w->start[i]))
            break; /* fewer threads: the same result, later */
        w->threads++;
    }
    return w;
}

int hnbrdf_threads_count(const hnbrdf_threads *threads)
{
    return threads->threads;
}

void hnbrdf_threads_run(hnbrdf_threads *w, int count, hnbrdf_work_fn work, void *context)
{
    w->work = work;
    w->context = context;
    w->count = count;
    atomic_store(&w->next, 0);
    atomic_store(&w->busy, w->threads - 1);
    pthread_mutex_lock(&w->mutex);
    atomic_fetch_add(&w->round, 1);
    pthread_cond_broadcast(&w->wake);
    pthread_mutex_unlock(&w->mutex);
    take(w, 0);
    wait_for_threads(w);
}

void hnbrdf_threads_stop(hnbrdf_threads *w)
{
    if (!w)
        return;
    pthread_mutex_lock(&w->mutex);
    w->quit = 1;
    pthread_cond_broadcast(&w->wake);
    pthread_mutex_unlock(&w->mutex);
    for (int i = 1; i < w->threads; i++)
        pthread_join(w->thread[i], NULL);
    pthread_cond_destroy(&w->done);
    pthread_cond_destroy(&w->wake);
    pthread_mutex_destroy(&w->mutex);
    free(w);
}
