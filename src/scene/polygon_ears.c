/* polygon_ears.c: triangles from an outline of any form, cut off one after the other. */
#include "scene/outline.h"

#include <stdlib.h>

#define NOBODY UINT32_MAX

/* A corner that is left. What was found of it holds as long as its neighbours and its blocker,
 * with the blocker's neighbours, are the same: `changes` counts those of its own neighbours. */
typedef struct corner {
    uint32_t before, next;
    uint32_t blocker; /* why it is no ear: another corner, or itself where it does not turn left */
    uint32_t blocker_changes, changes;
    int known, gone; /* known: blocker says what was found */
} corner;

/* What may be spent on an outline whose edges cross, so that it ends: how often no corner can be
 * cut off rightly and any is, and how many edges is_free() looks at for each corner. Outlines that
 * only touch themselves need none of the first, and mazes of the tests less than 2 of the second.
 */
enum { MOST_CROSSINGS = 64, PATIENCE = 4096 };

typedef struct ring {
    const render_outline *o;
    corner *corners;
    uint32_t first, count;
    uint64_t patience; /* edges that is_free() may still look at */
    int crossings;     /* how often any corner was cut off */
} ring;

static int turn(const ring *r, uint32_t a, uint32_t b, uint32_t c)
{
    return render_outline_turn(r->o, a, b, c);
}

static int coincide(const ring *r, uint32_t a, uint32_t b)
{
    const double(*p)[3] = r->o->p;
    return p[a][r->o->x] == p[b][r->o->x] && p[a][r->o->y] == p[b][r->o->y];
}

/* ---- Triangles and what lies in them --------------------------------------------------------- */

/* A corner with its neighbours, and their bounding box. */
typedef struct triangle {
    uint32_t t[3];
    double low[2], high[2];
} triangle;

static triangle triangle_at(const ring *r, uint32_t i)
{
    const render_outline *o = r->o;
    triangle t = {.t = {r->corners[i].before, i, r->corners[i].next}};
    for (int k = 0; k < 2; k++) {
        const int axis = k ? o->y : o->x;
        t.low[k] = t.high[k] = o->p[i][axis];
        for (int c = 0; c < 3; c += 2) {
            const double x = o->p[t.t[c]][axis];
            t.low[k] = x < t.low[k] ? x : t.low[k];
            t.high[k] = x > t.high[k] ? x : t.high[k];
        }
    }
    return t;
}

static int turn_of(const ring *r, const triangle *t)
{
    return turn(r, t->t[0], t->t[1], t->t[2]);
}

/* In a triangle that turns left, or on its edges. */
static int is_inside(const ring *r, const triangle *t, uint32_t p)
{
    const double x = r->o->p[p][r->o->x], y = r->o->p[p][r->o->y];
    if (x < t->low[0] || x > t->high[0] || y < t->low[1] || y > t->high[1])
        return 0; /* the quick answer for most */
    return turn(r, t->t[0], t->t[1], p) >= 0 && turn(r, t->t[1], t->t[2], p) >= 0 &&
           turn(r, t->t[2], t->t[0], p) >= 0;
}

/* Whether the edge from p to q passes through the inside of a triangle that turns left. Two convex
 * sets are apart if the line through an edge of one of them parts them. */
static int crosses(const ring *r, const triangle *t, uint32_t p, uint32_t q)
{
    int sides[3];
    for (int k = 0; k < 3; k++) {
        const uint32_t a = t->t[k], b = t->t[(k + 1) % 3];
        if (turn(r, a, b, p) <= 0 && turn(r, a, b, q) <= 0)
            return 0;
        sides[k] = turn(r, p, q, a);
    }
    return !(sides[0] >= 0 && sides[1] >= 0 && sides[2] >= 0) &&
           !(sides[0] <= 0 && sides[1] <= 0 && sides[2] <= 0);
}

/* Whether the outside of the outline at p, where it turns right, holds all of a triangle. p
 * coincides with a corner of it. */
static int shuts_out(const ring *r, const triangle *t, uint32_t p)
{
    const uint32_t before = r->corners[p].before, next = r->corners[p].next;
    if (turn(r, before, p, next) >= 0)
        return 0;
    for (int k = 0; k < 3; k++)
        if (turn(r, p, before, t->t[k]) < 0 || turn(r, p, next, t->t[k]) > 0)
            return 0;
    return 1;
}

/* ---- Ears ------------------------------------------------------------------------------------ */

/* Whether corner p keeps a triangle from being cut off: it lies in it or on its edges; or, where it
 * coincides with a corner of it, an edge of p leads through it or p has it outside. */
static int blocks(const ring *r, const triangle *t, uint32_t p)
{
    if (p == t->t[0] || p == t->t[1] || p == t->t[2] || !is_inside(r, t, p))
        return 0;
    if (!coincide(r, p, t->t[0]) && !coincide(r, p, t->t[1]) && !coincide(r, p, t->t[2]))
        return 1;
    return crosses(r, t, p, r->corners[p].next) || crosses(r, t, r->corners[p].before, p) ||
           shuts_out(r, t, p);
}

/* Whether what was found of corner i still holds. */
static int is_up_to_date(const ring *r, uint32_t i)
{
    const corner *c = &r->corners[i], *b = c->known ? &r->corners[c->blocker] : NULL;
    return b && !b->gone && b->changes == c->blocker_changes;
}

static void remember(const ring *r, uint32_t i, uint32_t blocker)
{
    corner *c = &r->corners[i];
    c->known = 1;
    c->blocker = blocker;
    c->blocker_changes = r->corners[blocker].changes;
}

/* Whether the way from a to c by b, all on one line, goes back over itself: b is not between them,
 * or two of them are one point. */
static int goes_back(const ring *r, uint32_t a, uint32_t b, uint32_t c)
{
    for (int k = 0; k < 2; k++) {
        const int axis = k ? r->o->y : r->o->x;
        const double from = r->o->p[a][axis], at = r->o->p[b][axis], to = r->o->p[c][axis];
        if ((from < at && at < to) || (from > at && at > to))
            return 0;
    }
    return 1;
}

/* Whether corner i can be cut off: it turns left, and no other corner blocks it; or the outline
 * goes back over itself there. */
static int is_ear(ring *r, uint32_t i)
{
    if (is_up_to_date(r, i))
        return 0;
    const triangle t = triangle_at(r, i);
    const int way = turn_of(r, &t);
    if (way == 0 && goes_back(r, t.t[0], i, t.t[2]))
        return 1;
    if (way <= 0) {
        remember(r, i, i);
        return 0;
    }
    uint32_t p = r->corners[i].blocker; /* as it did before, perhaps */
    if (p == NOBODY || r->corners[p].gone || !blocks(r, &t, p))
        for (p = r->corners[t.t[2]].next; p != t.t[0] && !blocks(r, &t, p);)
            p = r->corners[p].next;
    if (p == t.t[0])
        return 1;
    remember(r, i, p);
    return 0;
}

/* Whether corner i turns left and no edge passes through its triangle; other corners may lie on
 * its edges. */
static int is_free(ring *r, uint32_t i)
{
    const triangle t = triangle_at(r, i);
    if (turn_of(r, &t) <= 0)
        return 0;
    for (uint32_t p = t.t[2]; p != t.t[0]; p = r->corners[p].next) {
        if (r->patience == 0 || crosses(r, &t, p, r->corners[p].next))
            return 0;
        r->patience--;
    }
    return 1;
}

static uint32_t find(ring *r, int (*is_such)(ring *, uint32_t))
{
    uint32_t i = r->first;
    for (uint32_t k = 0; k < r->count; k++, i = r->corners[i].next)
        if (is_such(r, i))
            return i;
    return NOBODY;
}

/* The next corner to cut off. An outline whose edges do not cross has an ear, or one that is free
 * where corners touch the middle of edges; otherwise any will do. */
static uint32_t choose(ring *r)
{
    uint32_t found = NOBODY;
    if (r->crossings < MOST_CROSSINGS)
        found = find(r, is_ear);
    if (r->crossings < MOST_CROSSINGS && found == NOBODY)
        found = find(r, is_free);
    r->crossings += found == NOBODY;
    return found == NOBODY ? r->first : found;
}

static void cut(ring *r, uint32_t i)
{
    corner *c = &r->corners[i], *before = &r->corners[c->before], *next = &r->corners[c->next];
    before->next = c->next;
    next->before = c->before;
    before->known = next->known = 0;
    before->changes++;
    next->changes++;
    c->gone = 1;
    r->first = r->first == i ? c->next : r->first;
    r->count--;
}

int render_outline_cut_ears(const render_outline *o, uint32_t (*triangles)[3])
{
    ring r = {.o = o,
              .corners = malloc(o->count * sizeof *r.corners),
              .count = o->count,
              .patience = (uint64_t)PATIENCE * o->count};
    if (!r.corners)
        return -1;
    for (uint32_t i = 0; i < o->count; i++)
        r.corners[i] = (corner){.before = (i ? i : o->count) - 1,
                                .next = i + 1 < o->count ? i + 1 : 0,
                                .blocker = NOBODY};
    for (; r.count >= 3; triangles++) {
        const uint32_t i = choose(&r);
        (*triangles)[0] = r.corners[i].before;
        (*triangles)[1] = i;
        (*triangles)[2] = r.corners[i].next;
        cut(&r, i);
    }
    free(r.corners);
    return 0;
}
