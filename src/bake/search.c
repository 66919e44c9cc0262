/* search.c: in which order candidates are tried, when to stop, and which one is picked.
 *
 * GGX first, then networks by their multiplications: a short fit of a few seeds tells which are
 * worth a full one. */
#include "bake/task.h"
#include "base/clock.h"

#include <math.h>

enum {
    SHORT_SEEDS = 2, /* fits of a candidate in the first look */
    /* candidates in it; a number of its own, so that the result does not depend on threads */
    AT_ONCE = 2,
    MOST_JOBS = 32,
    /* candidates that a limit of time or size allows, from the largest down, that get a look */
    LIMIT_LOOKS = 6,
    MOST_ENCODINGS = 8,
    FINALISTS = 2, /* of them, and of `auto`, that get a full fit */
    PATIENCE = 4   /* candidates without a better product after which `auto` stops looking */
};
/* A full fit takes up to a fifth off the error of the better of two short ones (0.159 to 0.140,
 * 0.137 to 0.117, 0.123 to 0.109 on six MERL stand-ins). */
#define PROMISING 1.25
#define LOOK_SHARE 0.3 /* of `seconds` for short fits */
#define FULL_SHARE 0.5 /* of the time that is left for one full fit */
#define LEAST_SECONDS 0.5

/* ---- Picking --------------------------------------------------------------------------------- */

static double product(const bake_task *b, const hnbrdf_bake_row *row)
{
    return hnbrdf_bake_judged(&b->report, row) * row->size.ns;
}

static int is_met(const bake_task *b, const hnbrdf_bake_row *row)
{
    switch (b->options.wish) {
    case HNBRDF_BAKE_ERROR:
        return hnbrdf_bake_judged(&b->report, row) <= b->options.max_error;
    case HNBRDF_BAKE_TIME:
        return row->half || row->size.ns <= b->options.max_ns;
    case HNBRDF_BAKE_SIZE:
        return row->size.multiplications <= b->options.max_multiplications;
    case HNBRDF_BAKE_AUTO:
    case HNBRDF_BAKE_FRONT:
        return row->full && row->size.hidden > 0;
    case HNBRDF_BAKE_NET:
        return row->size.hidden > 0;
    }
    return 0;
}

/* 1 if a is the better answer; both meet the wish, or neither does. */
static int is_better(const bake_task *b, const hnbrdf_bake_row *x, const hnbrdf_bake_row *y,
                     int met)
{
    if (b->options.wish == HNBRDF_BAKE_ERROR && met && !hnbrdf_bake_same_size(&x->size, &y->size))
        return x->size.multiplications < y->size.multiplications;
    if (b->options.wish == HNBRDF_BAKE_TIME && !met)
        return x->size.ns < y->size.ns;
    if (b->options.wish == HNBRDF_BAKE_AUTO || b->options.wish == HNBRDF_BAKE_FRONT)
        return product(b, x) < product(b, y);
    return hnbrdf_bake_judged(&b->report, x) < hnbrdf_bake_judged(&b->report, y);
}

static void pick(bake_task *b)
{
    b->report.picked = -1;
    b->report.met = 0;
    for (int k = 0; k < b->report.row_count; k++) {
        int met = is_met(b, &b->report.rows[k]);
        if (b->report.picked < 0 || met > b->report.met ||
            (met == b->report.met &&
             is_better(b, &b->report.rows[k], &b->report.rows[b->report.picked], met)))
            b->report.picked = k;
        b->report.met = is_met(b, &b->report.rows[b->report.picked]);
    }
}

/* ---- Trying ---------------------------------------------------------------------------------- */

static double left(const bake_task *b)
{
    return b->options.seconds > 0.0 ? b->started + b->options.seconds - hnbrdf_seconds() : INFINITY;
}

static int is_over(bake_task *b)
{
    hnbrdf_bake_end *end = &b->report.end;
    int stopped = hnbrdf_bake_is_stopped(b);
    if (!b->lost) /* one that is stopped stops all */
        b->lost = hnbrdf_ranks_agree(b->options.ranks, HNBRDF_OK, &stopped, &b->lost_error);
    if (stopped || b->lost) {
        atomic_store(&b->stopped, 1);
        *end = HNBRDF_BAKE_STOPPED;
    } else if (*end == HNBRDF_BAKE_COMPLETE && left(b) < LEAST_SECONDS)
        *end = HNBRDF_BAKE_OUT_OF_TIME;
    if (!b->lost) /* and one clock decides */
        b->lost = hnbrdf_bake_spread(b, 0, end, sizeof *end, &b->lost_error);
    return *end != HNBRDF_BAKE_COMPLETE;
}

/* The row of this candidate with the lowest error, or NULL. */
static const hnbrdf_bake_row *best_row(const bake_task *b, const hnbrdf_bake_size *candidate)
{
    const hnbrdf_bake_row *best = NULL;
    for (int k = 0; k < b->report.row_count; k++)
        if (hnbrdf_bake_same_size(&b->report.rows[k].size, candidate) &&
            (!best || hnbrdf_bake_judged(&b->report, &b->report.rows[k]) <
                          hnbrdf_bake_judged(&b->report, best)))
            best = &b->report.rows[k];
    return best;
}

/* Short fits of candidates; `looks` is how many candidates will get one in all, at most. */
static hnbrdf_result look(bake_task *b, hnbrdf_bake_size *const *candidates, int count, int looks,
                          hnbrdf_error *error)
{
    bake_job jobs[MOST_JOBS];
    int n = 0, width = hnbrdf_bake_width(b, 0);
    for (int k = 0; k < count; k++)
        for (int s = 0; s < SHORT_SEEDS && n < MOST_JOBS; s++)
            jobs[n++] = (bake_job){candidates[k], b->options.seed + (uint64_t)s, 0};
    double seconds = 0.0;
    if (b->options.seconds > 0.0) {
        int rounds = (looks * SHORT_SEEDS + width - 1) / width;
        seconds = fmax(LOOK_SHARE * b->options.seconds / rounds, 0.1);
    }
    return hnbrdf_bake_wave(b, jobs, n, seconds, error);
}

/* One full fit of a candidate from several seeds. */
static hnbrdf_result fit_fully(bake_task *b, const hnbrdf_bake_size *candidate, hnbrdf_error *error)
{
    bake_job jobs[MOST_JOBS];
    int n = b->options.restarts < MOST_JOBS ? b->options.restarts : MOST_JOBS,
        width = hnbrdf_bake_width(b, 1);
    for (int s = 0; s < n; s++)
        jobs[s] = (bake_job){candidate, b->options.seed + (uint64_t)s, 1};
    int rounds = (n + width - 1) / width;
    return hnbrdf_bake_wave(
        b, jobs, n, b->options.seconds > 0.0 ? fmax(FULL_SHARE * left(b) / rounds, 0.1) : 0.0,
        error);
}

/* The smallest within the error. */
static hnbrdf_result search_error(bake_task *b, hnbrdf_error *error)
{
    if (hnbrdf_bake_judged(&b->report, &b->report.rows[0]) <= b->options.max_error)
        return HNBRDF_OK;
    int networks = b->candidate_count - 1;
    for (int k = 1; k < b->candidate_count; k += AT_ONCE) {
        hnbrdf_bake_size *some[AT_ONCE];
        int n = 0;
        for (; n < AT_ONCE && k + n < b->candidate_count; n++)
            some[n] = &b->candidates[k + n];
        if (is_over(b))
            return HNBRDF_OK;
        hnbrdf_result result = look(b, some, n, networks / 2, error);
        for (int i = 0; i < n && !result && !is_over(b); i++) {
            const hnbrdf_bake_row *seen = best_row(b, some[i]);
            if (!seen || hnbrdf_bake_judged(&b->report, seen) > PROMISING * b->options.max_error)
                continue;
            result = fit_fully(b, some[i], error);
            seen = best_row(b, some[i]);
            if (!result && seen && hnbrdf_bake_judged(&b->report, seen) <= b->options.max_error)
                return HNBRDF_OK;
        }
        if (result)
            return result;
    }
    return HNBRDF_OK;
}

/* Full fits of the candidates that looked best, by error or by product. */
static hnbrdf_result finish(bake_task *b, hnbrdf_error *error)
{
    for (int f = 0; f < FINALISTS && !is_over(b); f++) {
        const hnbrdf_bake_row *best = NULL;
        for (int k = 0; k < b->report.row_count; k++) {
            const hnbrdf_bake_row *row = &b->report.rows[k];
            int done = 0;
            for (int i = 0; i < b->report.row_count; i++)
                done |= b->report.rows[i].full &&
                        hnbrdf_bake_same_size(&b->report.rows[i].size, &row->size);
            if (!done && (!best || is_better(b, row, best, 1)))
                best = row;
        }
        if (!best)
            return HNBRDF_OK;
        const hnbrdf_bake_size size = best->size; /* rows move when one is added */
        hnbrdf_result result = fit_fully(b, &size, error);
        if (result)
            return result;
    }
    return HNBRDF_OK;
}

/* Whether the limit on time or size allows the candidate. */
static int is_allowed(const bake_task *b, const hnbrdf_bake_size *size)
{
    if (b->options.wish == HNBRDF_BAKE_SIZE)
        return size->multiplications <= b->options.max_multiplications;
    return size->ns <= b->options.max_ns || hnbrdf_bake_needs_half(b, size);
}

/* The lowest error within a limit of time or size: of those that it allows, the largest. */
static hnbrdf_result search_limit(bake_task *b, hnbrdf_error *error)
{
    hnbrdf_bake_size *fit[LIMIT_LOOKS * MOST_ENCODINGS];
    int n = 0;
    const int looks = LIMIT_LOOKS * hnbrdf_bake_encoding_count(b);
    for (int k = b->candidate_count - 1; k > 0 && n < looks; k--)
        if (is_allowed(b, &b->candidates[k]))
            fit[n++] = &b->candidates[k];
    for (int k = 0; k < n && !is_over(b); k += AT_ONCE) {
        hnbrdf_result result = look(b, fit + k, n - k < AT_ONCE ? n - k : AT_ONCE, n, error);
        if (result)
            return result;
    }
    return finish(b, error);
}

/* Where error times time is lowest: beyond, an evaluation gets slower by more than it gets
 * better. */
static hnbrdf_result search_auto(bake_task *b, hnbrdf_error *error)
{
    double least = INFINITY; /* of networks: a step up from GGX costs more than its size tells */
    int without = 0;
    for (int k = 1; k < b->candidate_count && without < PATIENCE && !is_over(b); k += AT_ONCE) {
        hnbrdf_bake_size *some[AT_ONCE];
        int n = 0;
        for (; n < AT_ONCE && k + n < b->candidate_count; n++)
            some[n] = &b->candidates[k + n];
        hnbrdf_result result = look(b, some, n, b->candidate_count - 1, error);
        if (result)
            return result;
        for (int i = 0; i < n; i++) {
            const hnbrdf_bake_row *seen = best_row(b, some[i]);
            without = seen && product(b, seen) < least ? 0 : without + 1;
            least = seen ? fmin(least, product(b, seen)) : least;
        }
    }
    return finish(b, error);
}

/* Whether no faster row has as low an error. */
static int is_on_front(const bake_task *b, const hnbrdf_bake_row *row)
{
    for (int k = 0; k < b->report.row_count; k++) {
        const hnbrdf_bake_row *other = &b->report.rows[k];
        if (hnbrdf_bake_judged(&b->report, other) <= hnbrdf_bake_judged(&b->report, row) &&
            other->size.ns < row->size.ns)
            return 0;
    }
    return 1;
}

/* Short fits of all, full ones of those on the front, the fastest first. */
static hnbrdf_result search_front(bake_task *b, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 1; k < b->candidate_count && !result && !is_over(b); k += AT_ONCE) {
        hnbrdf_bake_size *some[AT_ONCE];
        int n = 0;
        for (; n < AT_ONCE && k + n < b->candidate_count; n++)
            some[n] = &b->candidates[k + n];
        result = look(b, some, n, b->candidate_count - 1, error);
    }
    for (int k = 1; k < b->candidate_count && !result && !is_over(b); k++) {
        const hnbrdf_bake_row *seen = best_row(b, &b->candidates[k]);
        if (seen && is_on_front(b, seen))
            result = fit_fully(b, &b->candidates[k], error);
    }
    return result;
}

/* Why the picked row is the picked one. */
static hnbrdf_bake_reason reason(const bake_task *b)
{
    const hnbrdf_bake_report *r = &b->report;
    const int ggx = r->rows[r->picked].size.hidden == 0;
    switch (b->options.wish) {
    case HNBRDF_BAKE_ERROR:
        return !r->met ? HNBRDF_BAKE_MOST_ACCURATE
               : ggx   ? HNBRDF_BAKE_GGX_IS_ENOUGH
                       : HNBRDF_BAKE_SMALLEST;
    case HNBRDF_BAKE_TIME:
        return r->met ? HNBRDF_BAKE_MOST_ACCURATE : HNBRDF_BAKE_FASTEST;
    case HNBRDF_BAKE_SIZE:
        return HNBRDF_BAKE_MOST_ACCURATE;
    case HNBRDF_BAKE_AUTO:
    case HNBRDF_BAKE_FRONT:
        return HNBRDF_BAKE_BALANCED;
    case HNBRDF_BAKE_NET:
        break;
    }
    return HNBRDF_BAKE_GIVEN;
}

static hnbrdf_result search(bake_task *b, hnbrdf_error *error)
{
    switch (b->options.wish) {
    case HNBRDF_BAKE_ERROR:
        return search_error(b, error);
    case HNBRDF_BAKE_TIME:
    case HNBRDF_BAKE_SIZE:
        return search_limit(b, error);
    case HNBRDF_BAKE_AUTO:
        return search_auto(b, error);
    case HNBRDF_BAKE_FRONT:
        return search_front(b, error);
    case HNBRDF_BAKE_NET:
        break;
    }
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 1; k < b->candidate_count && !result && (k == 1 || !is_over(b)); k++)
        result = fit_fully(b, &b->candidates[k], error);
    return result;
}

hnbrdf_result hnbrdf_bake_search(bake_task *b, hnbrdf_error *error)
{
    hnbrdf_result result = hnbrdf_bake_ggx(b, error);
    if (!result && !is_over(b))
        result = search(b, error);
    if (result)
        return result;
    is_over(b);
    if (b->lost)
        return hnbrdf_fail(error, b->lost, "%s", b->lost_error.text);
    pick(b);
    b->report.reason = reason(b);
    return HNBRDF_OK;
}
