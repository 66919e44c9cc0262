/* outline.c: how a polygon in the plane turns. */
#include "scene/outline.h"

#include "scene/turn.h"

int render_outline_turn(const render_outline *o, uint32_t a, uint32_t b, uint32_t c)
{
    const double pa[2] = {o->p[a][o->x], o->p[a][o->y]}, pb[2] = {o->p[b][o->x], o->p[b][o->y]},
                 pc[2] = {o->p[c][o->x], o->p[c][o->y]};
    return render_turn(pa, pb, pc);
}

int render_outline_returns(const render_outline *o, uint32_t a, uint32_t b, uint32_t c)
{
    if (render_outline_turn(o, a, b, c) != 0)
        return 0;
    /* On a line: b is strictly between the others where each coordinate says so. */
    int apart = 0;
    for (int k = 0; k < 2; k++) {
        const int axis = k ? o->y : o->x;
        const double from = o->p[a][axis], at = o->p[b][axis], to = o->p[c][axis];
        if ((at > from && at > to) || (at < from && at < to))
            return 1;
        apart += (from < at && at < to) || (from > at && at > to);
    }
    return apart == 0;
}
