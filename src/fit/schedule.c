/* schedule.c: which tiles a step trains on. */
#include "fit/schedule.h"

#include <stdlib.h>
#include <string.h>

int hnbrdf_fit_schedule_start(fit_schedule *s, int count, int tiles, uint64_t seed)
{
    s->count = count;
    s->tiles = tiles;
    s->at = 0;
    hnbrdf_rng_seed(&s->rng, seed, UINT64_C(2) << 40);
    s->order = calloc((size_t)count, sizeof(int));
    s->cursor = calloc((size_t)count, sizeof(int));
    for (int m = 0; s->order && m < count; m++)
        s->order[m] = m;
    return s->order && s->cursor;
}

static void shuffle(fit_schedule *s)
{
    for (int i = s->count - 1; i > 0; i--) {
        int j = (int)(((uint64_t)hnbrdf_rng_u32(&s->rng) * (uint64_t)(i + 1)) >> 32);
        int swap = s->order[i];
        s->order[i] = s->order[j];
        s->order[j] = swap;
    }
}

void hnbrdf_fit_schedule_step(fit_schedule *s, int tiles, int *material, int *tile)
{
    for (int k = 0; k < tiles; k++) {
        if (s->at == 0)
            shuffle(s);
        const int m = s->order[s->at];
        s->at = (s->at + 1) % s->count;
        if (material)
            material[k] = m;
        if (tile)
            tile[k] = s->cursor[m];
        s->cursor[m] = (s->cursor[m] + 1) % s->tiles;
    }
}

void hnbrdf_fit_schedule_copy(fit_schedule *to, const fit_schedule *from)
{
    to->rng = from->rng;
    to->at = from->at;
    memcpy(to->order, from->order, (size_t)from->count * sizeof(int));
    memcpy(to->cursor, from->cursor, (size_t)from->count * sizeof(int));
}

void hnbrdf_fit_schedule_free(fit_schedule *s)
{
    free(s->order);
    free(s->cursor);
}
