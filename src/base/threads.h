/* threads.h: run the same function for pieces of work 0 .. count-1 on a few threads. */
#ifndef HNBRDF_BASE_THREADS_H
#define HNBRDF_BASE_THREADS_H

/* Processors that are online, at least 1. */
int hnbrdf_processors(void);

typedef struct hnbrdf_threads hnbrdf_threads;

/* index is the piece of work, worker (0 .. threads-1) whose scratch to use; worker 0 is the thread
 * that called hnbrdf_threads_run(). Which worker gets which index is left to chance: results must
 * not depend on it. */
typedef void (*hnbrdf_work_fn)(void *context, int index, int worker);

/* count 0 stands for one a processor; at most 256. NULL when memory cannot be had; where threads
 * cannot be had there are fewer of them: the same result, later. */
hnbrdf_threads *hnbrdf_threads_start(int count);
int hnbrdf_threads_count(const hnbrdf_threads *threads);
/* Returns when every index is done. The calling thread works too. */
void hnbrdf_threads_run(hnbrdf_threads *threads, int count, hnbrdf_work_fn work, void *context);
/* NULL is allowed. */
void hnbrdf_threads_stop(hnbrdf_threads *threads);

/* Processor seconds spent in work so far, of all threads together and of the calling thread
 * alone; not while they run. */
double hnbrdf_threads_busy(const hnbrdf_threads *threads);
double hnbrdf_threads_busy_here(const hnbrdf_threads *threads);

#endif
