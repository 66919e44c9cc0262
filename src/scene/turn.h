/* turn.h: which way three points turn, without rounding. */
#ifndef HNBRDF_SCENE_TURN_H
#define HNBRDF_SCENE_TURN_H

/* 1 where a, b, c turn left, -1 where they turn right, 0 where they lie on one line: the exact
 * sign for coordinates that are 0 or between 1e-70 and 1e150 in size. */
int render_turn(const double a[2], const double b[2], const double c[2]);

#endif
