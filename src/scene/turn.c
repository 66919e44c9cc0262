/* turn.c: the sign of a determinant of three points: in double precision where that is sure, else
 * in an expansion, a sum of doubles that do not overlap (Shewchuk 1997). */
#include "scene/turn.h"

#include <math.h>

enum { TERMS = 12 };

/* a + b = *sum + *rest, exactly (Knuth). */
static void two_sum(double a, double b, double *sum, double *rest)
{
    const double s = a + b, bb = s - a, aa = s - bb;
    *rest = (a - aa) + (b - bb);
    *sum = s;
}

/* a = *high + *low, 26 bits each at most (Dekker). */
static void split(double a, double *high, double *low)
{
    const double c = 134217729.0 * a; /* 2^27 + 1 */
    *high = c - (c - a);
    *low = a - *high;
}

/* a * b = *product + *rest, exactly unless it underflows. */
static void two_product(double a, double b, double *product, double *rest)
{
    double ah, al, bh, bl;
    const double p = a * b;
    split(a, &ah, &al);
    split(b, &bh, &bl);
    *rest = al * bl - (((p - ah * bh) - al * bh) - ah * bl);
    *product = p;
}

/* Adds x to an expansion of *count numbers, the smallest first; makes one more. */
static void grow(double *e, int *count, double x)
{
    for (int i = 0; i < *count; i++)
        two_sum(x, e[i], &x, &e[i]);
    e[(*count)++] = x;
}

static void grow_product(double *e, int *count, double a, double b)
{
    double product, rest;
    two_product(a, b, &product, &rest);
    grow(e, count, rest);
    grow(e, count, product);
}

/* The largest number of an expansion that is not 0 has its sign. */
static int exact_turn(const double a[2], const double b[2], const double c[2])
{
    double e[TERMS];
    int count = 0;
    grow_product(e, &count, a[0], b[1]);
    grow_product(e, &count, -a[1], b[0]);
    grow_product(e, &count, b[0], c[1]);
    grow_product(e, &count, -b[1], c[0]);
    grow_product(e, &count, c[0], a[1]);
    grow_product(e, &count, -c[1], a[0]);
    while (count > 0 && e[count - 1] == 0.0)
        count--;
    return count == 0 ? 0 : e[count - 1] > 0.0 ? 1 : -1;
}

int render_turn(const double a[2], const double b[2], const double c[2])
{
    /* Shewchuk's bound A, (3 + 16 u) u with u = 2^-53, on the rounding of `area`; the two products
     * are far from underflow where it decides. */
    static const double bound = (3.0 + 16.0 * 0x1p-53) * 0x1p-53;
    const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
    const double area = left - right, most = fabs(left) + fabs(right);
    if (fabs(area) > bound * most && most > 0x1p-900)
        return area > 0.0 ? 1 : -1;
    return exact_turn(a, b, c);
}
