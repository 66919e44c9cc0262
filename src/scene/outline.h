/* outline.h: a polygon in the plane, as it is split into triangles. Inside polygon*.c only. */
#ifndef HNBRDF_SCENE_OUTLINE_H
#define HNBRDF_SCENE_OUTLINE_H

#include "scene/turn.h"

#include <stdint.h>

/* A polygon seen along the axis to which its plane is nearest to perpendicular, from the side from
 * which it runs counter-clockwise. */
typedef struct render_outline {
    const double (*p)[3];
    int x, y; /* which coordinates */
    uint32_t count;
} render_outline;

/* The sign of the turn at b from a to c, exact. */
static inline int render_outline_turn(const render_outline *o, uint32_t a, uint32_t b, uint32_t c)
{
    const double pa[2] = {o->p[a][o->x], o->p[a][o->y]}, pb[2] = {o->p[b][o->x], o->p[b][o->y]},
                 pc[2] = {o->p[c][o->x], o->p[c][o->y]};
    return render_turn(pa, pb, pc);
}

/* Of any outline, ears one after the other (Meisters 1975). 0, or -1 when memory is out. */
int render_outline_cut_ears(const render_outline *o, uint32_t (*triangles)[3]);

#endif
