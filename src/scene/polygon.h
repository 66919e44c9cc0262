/* polygon.h: split polygons into triangles. */
#ifndef HNBRDF_SCENE_POLYGON_H
#define HNBRDF_SCENE_POLYGON_H

#include <stdint.h>

/* Splits the polygon with corners p[0..count), 3 or more, into count - 2 triangles of corner
 * numbers, all turning as it does: a fan from corner 0 where it is convex, ears where it is not.
 * Its edges may touch: a hole may be cut out by a bridge that runs there and back, corners may
 * coincide, an edge may go back over the one before. Some triangles then have no area. One whose
 * edges cross is split somehow. Coordinates as for render_turn(). 0, or -1 when memory is out. */
int render_polygon_split(const double (*p)[3], uint32_t count, uint32_t (*triangles)[3]);

#endif
