/* test_polygon.c: polygons of every form are split into triangles that cover them once; the sign
 * of a turn is exact. */
#include "scene/polygon.h"
#include "scene/turn.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;
enum { MOST = 4096 };
static double p[MOST][3];
static uint32_t t[MOST][3];

/* ---- Turns ----------------------------------------------------------------------------------- */

/* Points a few 2^-53 beside the line x = y turn as their coordinates say; rounded arithmetic gets
 * half of them wrong (Kettner et al. 2008). */
static void turns_are_exact(void **state)
{
    (void)state;
    const double b[2] = {12.0, 12.0}, c[2] = {24.0, 24.0};
    for (int i = 0; i < 64; i++)
        for (int j = 0; j < 64; j++) {
            const double a[2] = {0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53};
            const int expected = (a[1] > a[0]) - (a[1] < a[0]);
            assert_int_equal(render_turn(a, b, c), expected);
            assert_int_equal(render_turn(b, c, a), expected);
            assert_int_equal(render_turn(c, b, a), -expected);
        }
}

/* The differences round here: 1e16 + 1 is no double. */
static void turns_do_not_overflow_their_terms(void **state)
{
    (void)state;
    const double a[2] = {1e16, 1e16}, b[2] = {-1.0, -1.0}, c[2] = {1.0, nextafter(1.0, 2.0)};
    assert_int_equal(render_turn(a, b, c), -1);
    assert_int_equal(render_turn(b, a, c), 1);
    const double far[2] = {1e120, 1e120}, near[2] = {1e-60, 1e-60}, beside[2] = {1e-60, 2e-60};
    assert_int_equal(render_turn(near, far, beside), 1);
    assert_int_equal(render_turn(near, far, near), 0);
}

/* ---- Polygons -------------------------------------------------------------------------------- */

/* Of a triangle in the plane x, y; exact where coordinates are small whole numbers. */
static double area_of(const uint32_t c[3])
{
    return 0.5 * ((p[c[1]][0] - p[c[0]][0]) * (p[c[2]][1] - p[c[0]][1]) -
                  (p[c[1]][1] - p[c[0]][1]) * (p[c[2]][0] - p[c[0]][0]));
}

/* Splits p[0..count), which runs counter-clockwise if way is 1 and clockwise if it is -1: no
 * triangle may be turned over, and together they have the area. Returns how much they are off. */
static double split(uint32_t count, double area, int way)
{
    double sum = 0.0;
    assert_int_equal(render_polygon_split((const double(*)[3])p, count, t), 0);
    for (uint32_t i = 0; i + 2 < count; i++) {
        assert_true(t[i][0] < count && t[i][1] < count && t[i][2] < count);
        const double one = way * area_of(t[i]);
        if (one < 0.0)
            fail_msg("%u corners: triangle %u %u %u is turned over", count, t[i][0], t[i][1],
                     t[i][2]);
        sum += one;
    }
    return sum - area;
}

static void set(const double (*xy)[2], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        p[i][0] = xy[i][0];
        p[i][1] = xy[i][1];
        p[i][2] = 7.0;
    }
}

static void stars_are_covered_once(void **state)
{
    (void)state;
    for (int way = -1; way <= 1; way += 2)
        for (uint32_t count = 6; count <= 2000; count += count < 260 ? 10 : 580) {
            for (uint32_t i = 0; i < count; i++) {
                double angle = way * 2.0 * pi * i / count, radius = i % 2 ? 0.4 : 1.0;
                p[i][0] = radius * cos(angle);
                p[i][1] = radius * sin(angle);
                p[i][2] = 2.0;
            }
            double area = 0.5 * 0.4 * sin(2.0 * pi / count) * count;
            assert_true(fabs(split(count, area, way)) < 1e-12 * count);
        }
}

typedef struct figure {
    const char *name;
    uint32_t count;
    double area;
    double xy[12][2];
} figure;

static const figure figures[] = {
    {"a hole behind a bridge",
     8,
     13.0,
     {{-3, -2}, {3, -2}, {0, 3}, {-3, -2}, {-1, -1}, {0, 1}, {1, -1}, {-1, -1}}},
    {"a hole behind a bridge from its corner",
     8,
     15.0,
     {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 2}, {2, 1}, {1, 1}}},
    {"a hole and a slit",
     12,
     98.0,
     {{0, 0},
      {10, 0},
      {10, 10},
      {8, 8},
      {8, 6},
      {6, 8},
      {8, 8},
      {10, 10},
      {5, 10},
      {5, 9},
      {5, 10},
      {0, 10}}},
    {"a spike outwards", 7, 16.0, {{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 6}, {2, 4}, {0, 4}}},
    {"a spike inwards", 7, 16.0, {{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 1}, {2, 4}, {0, 4}}},
    {"a spike along an edge", 5, 1.0, {{0, 0}, {2, 0}, {1, 0}, {1, 1}, {0, 1}}},
    {"a spike from a corner", 6, 1.0, {{0, 0}, {1, 0}, {2, -1}, {1, 0}, {1, 1}, {0, 1}}},
    {"a slit from a corner", 6, 1.0, {{0, 0}, {1, 0}, {0.5, 0.5}, {1, 0}, {1, 1}, {0, 1}}},
    {"there and back", 6, 0.0, {{0, 0}, {4, 1}, {6, 5}, {4, 1}, {5, 0}, {4, 1}}},
    {"a corner on an edge", 5, 8.0, {{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}},
    {"two corners that touch", 6, 8.0, {{0, 0}, {2, 1}, {4, 0}, {4, 4}, {2, 1}, {0, 4}}},
    {"a corner given twice", 5, 16.0, {{0, 0}, {4, 0}, {4, 0}, {4, 4}, {0, 4}}},
    {"a corner given three times",
     7,
     12.0,
     {{0, 0}, {4, 0}, {4, 4}, {2, 2}, {2, 2}, {2, 2}, {0, 4}}},
    {"corners on its edges", 7, 8.0, {{0, 0}, {1, 0}, {2, 0}, {4, 0}, {2, 2}, {0, 4}, {0, 1}}},
};

/* From every first corner, in both ways, and far away. */
static void edges_may_touch(void **state)
{
    (void)state;
    for (size_t f = 0; f < sizeof figures / sizeof *figures; f++)
        for (uint32_t first = 0; first < figures[f].count; first++)
            for (int way = -1; way <= 1; way += 2) {
                const uint32_t count = figures[f].count;
                double xy[12][2];
                for (uint32_t i = 0; i < count; i++)
                    memcpy(xy[i], figures[f].xy[(way > 0 ? first + i : first + count - i) % count],
                           sizeof *xy);
                set((const double(*)[2])xy, count);
                if (split(count, figures[f].area, way) != 0.0)
                    fail_msg("%s, from corner %u", figures[f].name, first);
                for (uint32_t i = 0; i < count; i++) {
                    p[i][0] += 4194304.0;
                    p[i][1] -= 4194304.0;
                }
                if (split(count, figures[f].area, way) != 0.0)
                    fail_msg("%s, from corner %u, far away", figures[f].name, first);
            }
}

/* A corner at which an edge goes straight on is a corner of triangles on both sides of it, so that
 * no rounding opens a gap there: every triangle has an area. */
static void straight_corners_are_kept(void **state)
{
    (void)state;
    static const double xy[][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2},
                                   {2, 1}, {1, 1}, {1, 2}, {1, 3}, {0, 3}, {0, 2}, {0, 1}};
    enum { COUNT = sizeof xy / sizeof *xy };
    for (uint32_t first = 0; first < COUNT; first++) {
        for (uint32_t i = 0; i < COUNT; i++)
            for (int k = 0; k < 3; k++)
                p[i][k] = k < 2 ? xy[(first + i) % COUNT][k] : 0.0;
        assert_true(split(COUNT, 6.0, 1) == 0.0);
        for (uint32_t i = 0; i + 2 < COUNT; i++)
            assert_true(area_of(t[i]) > 0.0);
    }
}

static uint32_t draw(uint32_t count)
{
    static uint32_t seed = 1;
    seed = seed * 1664525u + 1013904223u;
    return (uint32_t)(((uint64_t)seed * count) >> 32);
}

enum { SIDE = 8, CELLS = SIDE * SIDE };

/* Across side 0 to 3 of a cell: below, right, above, left; -1 beyond the field. */
static int neighbour(int cell, int side)
{
    const int x = cell % SIDE + (side == 1) - (side == 3),
              y = cell / SIDE + (side == 2) - (side == 0);
    return x < 0 || y < 0 || x >= SIDE || y >= SIDE ? -1 : y * SIDE + x;
}

/* Joins `count` cells to a tree; doors[c] has bit s where c is open across its side s. */
static void grow_tree(int count, int doors[CELLS])
{
    int in[CELLS] = {0}, cells[CELLS] = {CELLS / 2 + SIDE / 2}, have = 1;
    memset(doors, 0, CELLS * sizeof *doors);
    in[cells[0]] = 1;
    while (have < count) {
        const int from = cells[draw((uint32_t)have)], side = (int)draw(4),
                  to = neighbour(from, side);
        if (to < 0 || in[to])
            continue;
        doors[from] |= 1 << side;
        doors[to] |= 1 << (side + 2) % 4;
        in[to] = 1;
        cells[have++] = to;
    }
}

/* The walls of a tree of cells, walked around inside: one outline that touches itself along walls
 * that lie between two cells, at corners, around holes. Returns how many corners it has. */
static uint32_t walk_walls(const int doors[CELLS], uint32_t walls)
{
    static const int corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    int cell = CELLS / 2 + SIDE / 2, side = 0;
    for (uint32_t i = 0; i < walls; i++) {
        for (side = (side + 1) % 4; doors[cell] >> side & 1; side = (side + 3) % 4)
            cell = neighbour(cell, side);
        p[i][0] = cell % SIDE + corners[side][0];
        p[i][1] = cell / SIDE + corners[side][1];
        p[i][2] = 0.0;
    }
    return walls;
}

/* A tree of n cells has n - 1 doors, so 2 n + 2 walls, and the area n. */
static void mazes_are_covered_once(void **state)
{
    (void)state;
    for (int round = 0; round < 400; round++) {
        int doors[CELLS];
        const int count = 1 + (int)draw(CELLS);
        grow_tree(count, doors);
        if (split(walk_walls(doors, 2 * (uint32_t)count + 2), count, 1) != 0.0)
            fail_msg("maze %d of %d cells", round, count);
    }
}

/* Without the corners at which the outline goes straight on, others touch the middle of edges. */
static uint32_t drop_straight(uint32_t count)
{
    static double all[MOST][3];
    uint32_t kept = 0;
    memcpy(all, p, count * sizeof *all);
    for (uint32_t i = 0; i < count; i++) {
        const double *a = all[(i + count - 1) % count], *b = all[i], *c = all[(i + 1) % count];
        if (a[0] + c[0] != 2.0 * b[0] || a[1] + c[1] != 2.0 * b[1])
            memcpy(p[kept++], b, sizeof *p);
    }
    return kept;
}

static void corners_may_touch_the_middle_of_edges(void **state)
{
    (void)state;
    for (int round = 0; round < 400; round++) {
        int doors[CELLS];
        const int count = 1 + (int)draw(CELLS);
        grow_tree(count, doors);
        const uint32_t corners = drop_straight(walk_walls(doors, 2 * (uint32_t)count + 2));
        if (split(corners, count, 1) != 0.0)
            fail_msg("maze %d of %d cells, %u corners", round, count, corners);
    }
}

/* In a plane that no axis is perpendicular to, corners that coincide still do. The two vectors in
 * it are perpendicular and of length 1. */
static void planes_may_be_tilted(void **state)
{
    (void)state;
    for (int round = 0; round < 50; round++) {
        int doors[CELLS];
        grow_tree(CELLS / 2, doors);
        const uint32_t count = walk_walls(doors, CELLS + 2);
        double sum = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            const double x = p[i][0], y = p[i][1];
            p[i][0] = 1e5 + 0.36 * x + 0.48 * y;
            p[i][1] = 0.8 * x - 0.6 * y;
            p[i][2] = -0.48 * x - 0.64 * y;
        }
        assert_int_equal(render_polygon_split((const double(*)[3])p, count, t), 0);
        for (uint32_t i = 0; i + 2 < count; i++) {
            double a[3], b[3];
            for (int k = 0; k < 3; k++) {
                a[k] = p[t[i][1]][k] - p[t[i][0]][k];
                b[k] = p[t[i][2]][k] - p[t[i][0]][k];
            }
            const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2],
                         z = a[0] * b[1] - a[1] * b[0];
            sum += 0.5 * sqrt(x * x + y * y + z * z);
        }
        /* unsigned areas: any triangle that is turned over would make them more; coordinates near
         * 1e5 are off by 2^-37, lengths are below 8 */
        assert_true(fabs(sum - CELLS / 2) < count * 8.0 * 0x1p-35);
    }
}

/* A convex one is a fan from its first corner. */
static void convex_polygons_are_fans(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    for (int i = 0; i < COUNT; i++) {
        p[i][0] = cos(2.0 * pi * i / COUNT);
        p[i][1] = 0.0;
        p[i][2] = sin(2.0 * pi * i / COUNT);
    }
    assert_int_equal(render_polygon_split((const double(*)[3])p, COUNT, t), 0);
    for (uint32_t i = 0; i + 2 < COUNT; i++)
        assert_true(t[i][0] == 0 && t[i][1] == i + 1 && t[i][2] == i + 2);
}

/* Points in one place, on a line, and edges that cross wildly. */
static void any_polygon_ends(void **state)
{
    (void)state;
    memset(p, 0, sizeof p);
    assert_int_equal(render_polygon_split((const double(*)[3])p, 100, t), 0);
    for (int i = 0; i < 100; i++)
        p[i][0] = (i * 37) % 11;
    assert_int_equal(render_polygon_split((const double(*)[3])p, 100, t), 0);
    for (int i = 0; i < 500; i++)
        for (int k = 0; k < 3; k++)
            p[i][k] = (i * 7919 + k * 104729) % 101;
    assert_int_equal(render_polygon_split((const double(*)[3])p, 500, t), 0);
    for (int i = 0; i < 498; i++)
        for (int k = 0; k < 3; k++)
            assert_true(t[i][k] < 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turns_are_exact),
        cmocka_unit_test(turns_do_not_overflow_their_terms),
        cmocka_unit_test(stars_are_covered_once),
        cmocka_unit_test(edges_may_touch),
        cmocka_unit_test(straight_corners_are_kept),
        cmocka_unit_test(mazes_are_covered_once),
        cmocka_unit_test(corners_may_touch_the_middle_of_edges),
        cmocka_unit_test(planes_may_be_tilted),
        cmocka_unit_test(convex_polygons_are_fans),
        cmocka_unit_test(any_polygon_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
