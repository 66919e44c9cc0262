/* schedule.h: which tiles a step trains on: materials in shuffled rounds, each material's tiles in
 * turn. Every rank can tell what any of them trains on. */
#ifndef HNBRDF_FIT_SCHEDULE_H
#define HNBRDF_FIT_SCHEDULE_H

#include "hnbrdf/measured.h"

typedef struct fit_schedule {
    hnbrdf_rng rng;
    int *order, *cursor; /* [count] shuffled materials; the next tile of each */
    int count, tiles;    /* materials; tiles of each */
    int at;              /* of order */
} fit_schedule;

/* The schedule of a training's first step. Returns 0 when memory is short; free it all the same. */
int hnbrdf_fit_schedule_start(fit_schedule *schedule, int count, int tiles, uint64_t seed);
/* The next step, of so many tiles; both lists may be NULL. */
void hnbrdf_fit_schedule_step(fit_schedule *schedule, int tiles, int *material, int *tile);
/* Both of the same materials. */
void hnbrdf_fit_schedule_copy(fit_schedule *to, const fit_schedule *from);
void hnbrdf_fit_schedule_free(fit_schedule *schedule);

#endif
