/* workers.c: a small pool of POSIX threads handing out indices through one atomic counter. */
#define _POSIX_C_SOURCE 200809L
#include "fit/workers.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { MAX_THREADS = 256 };

struct fit_workers {
    pthread_mutex_t mutex;
    pthread_cond_t wake, done;
    unsigned round; /* a new number wakes the threads */
    int busy, quit, threads;
    int count;
    fit_work_fn work;
    void *context;
    atomic_int next;
    double worked[MAX_THREADS]; /* processor seconds, each written by its thread alone */
    pthread_t thread[MAX_THREADS];
    struct start {
        fit_workers *workers;
        int worker;
    } start[MAX_THREADS];
};

double hnbrdf_fit_thread_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double hnbrdf_fit_workers_busy(const fit_workers *workers)
{
    double sum = 0.0;
    for (int i = 0; i < workers->threads; i++)
        sum += workers->worked[i];
    return sum;
}

double hnbrdf_fit_workers_busy_here(const fit_workers *workers)
{
    return workers->worked[0];
}

static void take(fit_workers *w, int worker)
{
    double started = hnbrdf_fit_thread_seconds();
    for (int index; (index = atomic_fetch_add(&w->next, 1)) < w->count;)
        w->work(w->context, index, worker);
    w->worked[worker] += hnbrdf_fit_thread_seconds() - started;
}

static void *loop(void *argument)
{
    struct start *start = argument;
    fit_workers *w = start->workers;
    unsigned seen = 0;
    pthread_mutex_lock(&w->mutex);
    for (;;) {
        while (w->round == seen && !w->quit)
            pthread_cond_wait(&w->wake, &w->mutex);
        if (w->quit)
            break;
        seen = w->round;
        pthread_mutex_unlock(&w->mutex);
        take(w, start->worker);
        pthread_mutex_lock(&w->mutex);
        if (--w->busy == 0)
            pthread_cond_signal(&w->done);
    }
    pthread_mutex_unlock(&w->mutex);
    return NULL;
}

fit_workers *hnbrdf_fit_workers_start(int threads)
{
    if (threads <= 0) {
        long cores = sysconf(_SC_NPROCESSORS_ONLN);
        threads = cores > 0 ? (int)(cores < MAX_THREADS ? cores : MAX_THREADS) : 1;
    }
    if (threads > MAX_THREADS)
        threads = MAX_THREADS;
    fit_workers *w = calloc(1, sizeof *w);
    if (!w)
        return NULL;
    pthread_mutex_init(&w->mutex, NULL);
    pthread_cond_init(&w->wake, NULL);
    pthread_cond_init(&w->done, NULL);
    w->threads = 1;
    for (int i = 1; i < threads; i++) {
        w->start[i].workers = w;
        w->start[i].worker = i;
        if (pthread_create(&w->thread[i], NULL, loop, &w->start[i]))
            break; /* fewer threads: the same result, later */
        w->threads++;
    }
    return w;
}

int hnbrdf_fit_workers_count(const fit_workers *workers)
{
    return workers->threads;
}

void hnbrdf_fit_workers_run(fit_workers *w, int count, fit_work_fn work, void *context)
{
    pthread_mutex_lock(&w->mutex);
    w->work = work;
    w->context = context;
    w->count = count;
    atomic_store(&w->next, 0);
    w->busy = w->threads - 1;
    w->round++;
    pthread_cond_broadcast(&w->wake);
    pthread_mutex_unlock(&w->mutex);
    take(w, 0);
    pthread_mutex_lock(&w->mutex);
    while (w->busy > 0)
        pthread_cond_wait(&w->done, &w->mutex);
    pthread_mutex_unlock(&w->mutex);
}

void hnbrdf_fit_workers_stop(fit_workers *w)
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
