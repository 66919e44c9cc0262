/* bake_search.c: in which order candidates are tried, when to stop, and which one is picked.
 *
 * GGX first, then networks by their multiplications: a short fit of a few seeds tells which are
 * worth a full one. */
#include "cli/bake.h"

#include <math.h>

enum {
    SHORT_SEEDS = 2, /* fits of a candidate in the first look */
    AT_ONCE =
        /* candidates in it; a number of its own, so that the result does not depend on threads */
    2,
    MOST_JOBS = 32,
    /* candidates that a limit of time allows, from the largest down, that get a look */
    TIME_LOOKS = 6,
    FINALISTS = 2, /* of them, and of `auto`, that get a full fit */
    PATIENCE = 4   /* candidates without a better product after which `auto` stops looking */
};
/* A full fit takes up to a fifth off the error of the better of two short ones (0.159 to 0.140,
 * 0.137 to 0.117, 0.123 to 0.109 on six MERL stand-ins). */
#define PROMISING 1.25
#define LOOK_SHARE 0.3 /* of --seconds for short fits */
#define FULL_SHARE 0.5 /* of the time that is left for one full fit */
#define LEAST_SECONDS 0.5

/* ---- Picking --------------------------------------------------------------------------------- */

static double product(const bake *b, const bake_row *row)
{
    return bake_judged(b, row) * row->candidate->ns;
}

static int is_met(const bake *b, const bake_row *row)
{
    switch (b->wish) {
    case BAKE_ERROR:
        return bake_judged(b, row) <= b->max_error;
    case BAKE_TIME:
        return row->candidate->ns <= b->max_ns;
    case BAKE_AUTO:
        return row->full && row->candidate->hidden > 0;
    case BAKE_NET:
        return row->candidate->hidden > 0;
    }
    return 0;
}

/* 1 if a is the better answer; both meet the wish, or neither does. */
static int is_better(const bake *b, const bake_row *x, const bake_row *y, int met)
{
    if (b->wish == BAKE_ERROR && met && x->candidate != y->candidate)
        return x->candidate->mults < y->candidate->mults;
    if (b->wish == BAKE_TIME && !met)
        return x->candidate->ns < y->candidate->ns;
    if (b->wish == BAKE_AUTO)
        return product(b, x) < product(b, y);
    return bake_judged(b, x) < bake_judged(b, y);
}

static void pick(bake *b)
{
    b->picked = -1;
    b->met = 0;
    for (int k = 0; k < b->row_count; k++) {
        int met = is_met(b, &b->rows[k]);
        if (b->picked < 0 || met > b->met ||
            (met == b->met && is_better(b, &b->rows[k], &b->rows[b->picked], met)))
            b->picked = k;
        b->met = is_met(b, &b->rows[b->picked]);
    }
}

/* ---- Trying ---------------------------------------------------------------------------------- */

static double left(const bake *b)
{
    return b->seconds > 0.0 ? b->started + b->seconds - cli_seconds() : INFINITY;
}

static int is_over(bake *b)
{
    if (bake_interrupted() || left(b) < LEAST_SECONDS)
        b->stopped = 1;
    return b->stopped;
}

/* The row of this candidate with the lowest error, or NULL. */
static const bake_row *best_row(const bake *b, const bake_candidate *candidate)
{
    const bake_row *best = NULL;
    for (int k = 0; k < b->row_count; k++)
        if (b->rows[k].candidate == candidate &&
            (!best || bake_judged(b, &b->rows[k]) < bake_judged(b, best)))
            best = &b->rows[k];
    return best;
}

/* Short fits of candidates; `looks` is how many candidates will get one in all, at most. */
static int look(bake *b, bake_candidate *const *candidates, int count, int looks)
{
    bake_job jobs[MOST_JOBS];
    int n = 0, width = bake_width(b, 0);
    for (int k = 0; k < count; k++)
        for (int s = 0; s < SHORT_SEEDS && n < MOST_JOBS; s++)
            jobs[n++] = (bake_job){candidates[k], b->seed + s, 0};
    double seconds = 0.0;
    if (b->seconds > 0.0) {
        int rounds = (looks * SHORT_SEEDS + width - 1) / width;
        seconds = fmax(LOOK_SHARE * b->seconds / rounds, 0.1);
    }
    return bake_wave(b, jobs, n, seconds);
}

/* One full fit of a candidate from several seeds. */
static int fit_fully(bake *b, const bake_candidate *candidate)
{
    bake_job jobs[MOST_JOBS];
    int n = b->restarts < MOST_JOBS ? (int)b->restarts : MOST_JOBS, width = bake_width(b, 1);
    for (int s = 0; s < n; s++)
        jobs[s] = (bake_job){candidate, b->seed + s, 1};
    int rounds = (n + width - 1) / width;
    return bake_wave(b, jobs, n, b->seconds > 0.0 ? fmax(FULL_SHARE * left(b) / rounds, 0.1) : 0.0);
}

/* The smallest within the error. */
static int search_error(bake *b)
{
    if (bake_judged(b, &b->rows[0]) <= b->max_error)
        return CLI_OK;
    int networks = b->candidate_count - 1;
    for (int k = 1; k < b->candidate_count; k += AT_ONCE) {
        bake_candidate *some[AT_ONCE];
        int n = 0;
        for (; n < AT_ONCE && k + n < b->candidate_count; n++)
            some[n] = &b->candidates[k + n];
        if (is_over(b))
            return CLI_OK;
        int code = look(b, some, n, networks / 2);
        for (int i = 0; i < n && code == CLI_OK && !is_over(b); i++) {
            const bake_row *seen = best_row(b, some[i]);
            if (!seen || bake_judged(b, seen) > PROMISING * b->max_error)
                continue;
            code = fit_fully(b, some[i]);
            seen = best_row(b, some[i]);
            if (code == CLI_OK && seen && bake_judged(b, seen) <= b->max_error)
                return CLI_OK;
        }
        if (code != CLI_OK)
            return code;
    }
    return CLI_OK;
}

/* Full fits of the candidates that looked best, by error or by product. */
static int finish(bake *b)
{
    for (int f = 0; f < FINALISTS && !is_over(b); f++) {
        const bake_row *best = NULL;
        for (int k = 0; k < b->row_count; k++) {
            const bake_row *row = &b->rows[k];
            int done = 0;
            for (int i = 0; i < b->row_count; i++)
                done |= b->rows[i].full && b->rows[i].candidate == row->candidate;
            if (!done && (!best || is_better(b, row, best, 1)))
                best = row;
        }
        if (!best)
            return CLI_OK;
        int code = fit_fully(b, best->candidate);
        if (code != CLI_OK)
            return code;
    }
    return CLI_OK;
}

/* The lowest error within the time: of those that are fast enough, the largest. */
static int search_time(bake *b)
{
    bake_candidate *fit[TIME_LOOKS];
    int n = 0;
    for (int k = b->candidate_count - 1; k > 0 && n < TIME_LOOKS; k--)
        if (b->candidates[k].ns <= b->max_ns)
            fit[n++] = &b->candidates[k];
    for (int k = 0; k < n && !is_over(b); k += AT_ONCE) {
        int code = look(b, fit + k, n - k < AT_ONCE ? n - k : AT_ONCE, n);
        if (code != CLI_OK)
            return code;
    }
    return finish(b);
}

/* Where error times time is lowest: beyond, an evaluation gets slower by more than it gets
 * better. */
static int search_auto(bake *b)
{
    double least = INFINITY; /* of networks: a step up from GGX costs more than its size tells */
    int without = 0;
    for (int k = 1; k < b->candidate_count && without < PATIENCE && !is_over(b); k += AT_ONCE) {
        bake_candidate *some[AT_ONCE];
        int n = 0;
        for (; n < AT_ONCE && k + n < b->candidate_count; n++)
            some[n] = &b->candidates[k + n];
        int code = look(b, some, n, b->candidate_count - 1);
        if (code != CLI_OK)
            return code;
        for (int i = 0; i < n; i++) {
            const bake_row *seen = best_row(b, some[i]);
            without = seen && product(b, seen) < least ? 0 : without + 1;
            least = seen ? fmin(least, product(b, seen)) : least;
        }
    }
    return finish(b);
}

int bake_search(bake *b)
{
    int code = bake_ggx(b);
    if (code == CLI_OK && !is_over(b))
        switch (b->wish) {
        case BAKE_ERROR:
            code = search_error(b);
            break;
        case BAKE_TIME:
            code = search_time(b);
            break;
        case BAKE_AUTO:
            code = search_auto(b);
            break;
        case BAKE_NET:
            code = fit_fully(b, &b->candidates[b->candidate_count - 1]);
            break;
        }
    is_over(b);
    pick(b);
    return code;
}
