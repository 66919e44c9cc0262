/* ranks.c: what the ranks of a fit tell each other, on top of the caller's three callbacks. */
#include "fit/trainer.h"

#include "base/clock.h"
#include "base/error.h"

#include <stdlib.h>
#include <string.h>

int hnbrdf_fit_is_alone(const trainer *t)
{
    return t->ranks.size == 1;
}

/* One call of a callback came back. */
static int done(trainer *t, double started, int failed)
{
    t->exchange += hnbrdf_seconds() - started;
    t->lost |= failed != 0;
    return !t->lost;
}

int hnbrdf_fit_gather(trainer *t, const void *mine, void *all, const size_t *bytes)
{
    if (hnbrdf_fit_is_alone(t)) {
        memcpy(all, mine, bytes[0]);
        return 1;
    }
    const double started = hnbrdf_seconds();
    return !t->lost && done(t, started, t->ranks.gather(t->ranks.user, mine, all, bytes));
}

int hnbrdf_fit_exchange(trainer *t, const void *send, const size_t *send_bytes, void *received,
                        const size_t *received_bytes)
{
    const double started = hnbrdf_seconds();
    return !t->lost &&
           done(t, started,
                t->ranks.exchange(t->ranks.user, send, send_bytes, received, received_bytes));
}

int hnbrdf_fit_broadcast(trainer *t, void *data, size_t bytes)
{
    const double started = hnbrdf_seconds();
    return hnbrdf_fit_is_alone(t) ||
           (!t->lost && done(t, started, t->ranks.broadcast(t->ranks.user, data, bytes, 0)));
}

hnbrdf_result hnbrdf_fit_fail_lost(const trainer *t, hnbrdf_error *error)
{
    return hnbrdf_fail(error, HNBRDF_ERROR_IO,
                       "rank %d of %d: another rank has ended or cannot be reached, after %ld "
                       "steps of training",
                       t->ranks.rank, t->ranks.size, t->step);
}

hnbrdf_result hnbrdf_fit_agree(trainer *t, hnbrdf_result mine, hnbrdf_error *error)
{
    const double started = hnbrdf_seconds();
    int asked = t->asked;
    hnbrdf_result result = hnbrdf_ranks_agree(&t->ranks, mine, &asked, error);
    if (!hnbrdf_fit_is_alone(t))
        t->exchange += hnbrdf_seconds() - started;
    t->stopped |= asked;
    return result;
}

/* ---- Records --------------------------------------------------------------------------------- */

/* mine and all: room for the records of this rank and of all ranks. */
static int share_packed(trainer *t, char *records, size_t size, char *mine, char *all,
                        size_t *bytes, char **place)
{
    memset(bytes, 0, (size_t)t->ranks.size * sizeof *bytes);
    for (int k = 0; k < t->held_count; k++)
        memcpy(mine + (size_t)k * size, records + (size_t)t->held[k] * size, size);
    for (int m = 0; m < t->count; m++)
        bytes[t->owner[m]] += size;
    if (!hnbrdf_fit_gather(t, mine, all, bytes))
        return 0;
    for (int r = 0; r < t->ranks.size; r++) {
        place[r] = all;
        all += bytes[r];
    }
    for (int m = 0; m < t->count; m++) {
        memcpy(records + (size_t)m * size, place[t->owner[m]], size);
        place[t->owner[m]] += size;
    }
    return 1;
}

hnbrdf_result hnbrdf_fit_share_records(trainer *t, void *records, size_t size, hnbrdf_error *error)
{
    if (hnbrdf_fit_is_alone(t))
        return HNBRDF_OK;
    const size_t ranks = (size_t)t->ranks.size;
    char *mine = malloc((size_t)t->held_count * size + 1), *all = malloc((size_t)t->count * size);
    size_t *bytes = calloc(ranks, sizeof *bytes);
    char **place = calloc(ranks, sizeof *place);
    hnbrdf_result result = HNBRDF_OK;
    if (!mine || !all || !bytes || !place)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY,
                             "out of memory for what %d ranks know of %d materials", t->ranks.size,
                             t->count);
    else if (!share_packed(t, records, size, mine, all, bytes, place))
        result = hnbrdf_fit_fail_lost(t, error);
    free(mine);
    free(all);
    free(bytes);
    free(place);
    return result;
}
