/* workers.h: run the same function for indices 0 .. count-1 on a few threads that live as long as a
 * fit. */
#ifndef HNBRDF_FIT_WORKERS_H
#define HNBRDF_FIT_WORKERS_H

typedef struct fit_workers fit_workers;

/* index is the piece of work, worker (0 .. threads-1) whose scratch to use. Which worker gets which
 * index is left to chance: results must not depend on it. */
typedef void (*fit_work_fn)(void *context, int index, int worker);

/* threads 0 stands for one a core. NULL when memory or threads cannot be had. */
fit_workers *hnbrdf_fit_workers_start(int threads);
int hnbrdf_fit_workers_count(const fit_workers *workers);
/* Processor seconds spent in work so far, of all threads together and of the calling thread
 * alone; not while they run. */
double hnbrdf_fit_workers_busy(const fit_workers *workers);
double hnbrdf_fit_workers_busy_here(const fit_workers *workers);
/* Processor seconds of the calling thread: what it worked, whatever else the machine did. */
double hnbrdf_fit_thread_seconds(void);
/* Returns when every index is done. The calling thread works too. */
void hnbrdf_fit_workers_run(fit_workers *workers, int count, fit_work_fn work, void *context);
void hnbrdf_fit_workers_stop(fit_workers *workers);

#endif
