/* generate_obj.c: Wavefront OBJ files: vertices of a grid or of any place and size, faces of every
 * form, groups, and the statements that are passed over. */
#include "generate.h"

enum { SIDE = 4, MOST_LINES = 24 };

typedef struct counts {
    int positions, normals, uvs; /* in the file, and above */
} counts;

static void end_line(fuzz_choices *c, fuzz_bytes *out)
{
    if (fuzz_below(c, 16) == 0)
        fuzz_put_text(out, FUZZ_PICK(c, char *, " ", "\t", " # a comment", " \\\n", "#1"));
    fuzz_put_text(out, fuzz_below(c, 8) ? "\n" : FUZZ_PICK(c, char *, "\r\n", "\r", "\n\n"));
}

/* A number that faces may lack the use of. */
static void put_soft(fuzz_choices *c, fuzz_bytes *out, double value)
{
    if (fuzz_below(c, 40) == 0)
        fuzz_put_text(out, FUZZ_PICK(c, char *, "nan", "-nan(ind)", "inf", "1.#QNAN", "-1.#IND",
                                     "1e31", "NaN"));
    else
        fuzz_put_number(out, c, value);
}

/* Corners of a grid of whole numbers: edges touch, points coincide and lie on lines. */
static void put_positions(fuzz_choices *c, fuzz_bytes *out, counts *have)
{
    const int count = fuzz_between(c, 3, 20), plane = (int)fuzz_below(c, 4);
    double size = 1.0, at[3] = {0.0, 0.0, 0.0};
    if (fuzz_below(c, 4) == 0)
        size = FUZZ_PICK(c, double, 1e-12, 1e-40, 1e10, 1e29, 0.1);
    if (fuzz_below(c, 4) == 0)
        for (int k = 0; k < 3; k++)
            at[k] = FUZZ_PICK(c, double, 4e6, -1e18, 1e29, 0.5, 1e-9);
    for (int i = 0; i < count; i++) {
        fuzz_put_text(out, "v");
        for (int k = 0; k < 3; k++) {
            double x = (double)fuzz_below(c, SIDE);
            if (k == plane)
                x = fuzz_below(c, 8) ? 0.0 : fuzz_real_between(c, -1.0, 1.0);
            fuzz_put_text(out, " ");
            fuzz_put_number(out, c, at[k] + size * x);
        }
        if (fuzz_below(c, 16) == 0)
            fuzz_put_text(out, FUZZ_PICK(c, char *, " 1.0", " 0.5 0.5 0.5", " x"));
        end_line(c, out);
        have->positions++;
    }
}

static void put_others(fuzz_choices *c, fuzz_bytes *out, counts *have)
{
    for (int i = fuzz_between(c, 0, 6); i > 0; i--) {
        fuzz_put_text(out, "vn");
        for (int k = 0; k < 3; k++) {
            fuzz_put_text(out, " ");
            put_soft(c, out, fuzz_below(c, 3) ? 0.0 : fuzz_real_between(c, -1.0, 1.0));
        }
        end_line(c, out);
        have->normals++;
    }
    for (int i = fuzz_between(c, 0, 6); i > 0; i--) {
        const int numbers = fuzz_between(c, 1, 3);
        fuzz_put_text(out, "vt");
        for (int k = 0; k < numbers; k++) {
            fuzz_put_text(out, " ");
            put_soft(c, out, fuzz_real_between(c, -1.0, 2.0));
        }
        end_line(c, out);
        have->uvs++;
    }
}

/* From the front, or from the back; in the odd place any number. */
static void put_index(fuzz_choices *c, fuzz_bytes *out, int index, int count)
{
    if (fuzz_odd(c)) {
        fuzz_put_text(out, FUZZ_PICK(c, char *, "0", "-0", "-", "+1", "x", "4294967296", "-99",
                                     "99999999999999999999", "1.5", "-1-1", ""));
        return;
    }
    fuzz_printf(out, "%d", fuzz_below(c, 4) ? index + 1 : index - count);
}

/* One in 16 of what the file lacks. */
static int any_index(fuzz_choices *c, int count)
{
    return fuzz_below(c, 16) ? (int)fuzz_below(c, count > 0 ? (unsigned)count : 1) : count;
}

static void put_corner(fuzz_choices *c, fuzz_bytes *out, int position, const counts *have, int form)
{
    fuzz_put_text(out, " ");
    put_index(c, out, position, have->positions);
    if (form == 0)
        return;
    fuzz_put_text(out, fuzz_odd(c) ? "," : "/");
    if (form != 2)
        put_index(c, out, any_index(c, have->uvs), have->uvs);
    if (form > 1) {
        fuzz_put_text(out, "/");
        if (fuzz_below(c, 32))
            put_index(c, out, any_index(c, have->normals), have->normals);
    }
    if (fuzz_odd(c))
        fuzz_put_text(out, FUZZ_PICK(c, char *, "/", "/1", "x", "//"));
}

/* Any corners in any order, so that most outlines touch or cross themselves. */
static void put_face(fuzz_choices *c, fuzz_bytes *out, const counts *have)
{
    const int form = (int)fuzz_below(c, 4), most = fuzz_below(c, 4) ? 5 : 30;
    int count = fuzz_between(c, 3, most), at = (int)fuzz_below(c, (unsigned)have->positions);
    if (fuzz_below(c, 32) == 0)
        count = fuzz_between(c, 0, 2);
    const int walk = fuzz_below(c, 2) ? 1 : 0;
    fuzz_put_text(out, fuzz_below(c, 16) ? "f" : "fo");
    for (int i = 0; i < count; i++) {
        at = walk ? (at + 1) % have->positions : (int)fuzz_below(c, (unsigned)have->positions);
        put_corner(c, out, at, have, fuzz_below(c, 32) ? form : (int)fuzz_below(c, 4));
    }
    end_line(c, out);
}

static void put_other(fuzz_choices *c, fuzz_bytes *out)
{
    const char *word = FUZZ_PICK(c, char *, "g", "o", "usemtl", "s", "mtllib", "l", "p", "curv",
                                 "surf", "cstype", "call", "vp", "F", "# a comment", "", "\\");
    fuzz_put_text(out, fuzz_word(c, word));
    fuzz_put_text(out, fuzz_below(c, 4) ? " " : "");
    fuzz_put_text(out, fuzz_word(c, FUZZ_PICK(c, char *, "a", "b", "a b", "1", "1 2", "off", "")));
    if (fuzz_below(c, 8) == 0)
        fuzz_printf(out, "%d", fuzz_between(c, 0, 40));
    end_line(c, out);
}

/* The outline of a square with a hole behind a bridge, a slit, or a corner that touches an edge:
 * what any corners rarely make. */
static void put_known_face(fuzz_choices *c, fuzz_bytes *out, counts *have)
{
    static const double squares[10][2] = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {2, 2},
                                          {2, 4}, {4, 4}, {4, 2}, {3, 0}, {6, 3}};
    static const int faces[][12] = {
        {10, 1, 2, 3, 4, 1, 5, 6, 7, 8, 5}, {6, 1, 2, 3, 7, 3, 4},
        {7, 1, 2, 3, 9, 4, 4, 4},           {8, 1, 9, 2, 10, 3, 7, 10, 4},
        {9, 1, 2, 5, 2, 3, 4, 6, 4, 8},     {8, 1, 2, 3, 5, 7, 5, 6, 4}};
    const int *face = faces[fuzz_below(c, sizeof faces / sizeof *faces)];
    const int axis = (int)fuzz_below(c, 3);
    for (int i = 0; i < 10; i++) {
        double p[3] = {0.0, 0.0, 0.0};
        p[(axis + 1) % 3] = squares[i][0];
        p[(axis + 2) % 3] = squares[i][1];
        fuzz_printf(out, "v %g %g %g\n", p[0], p[1], p[2]);
    }
    have->positions += 10;
    fuzz_put_text(out, "f");
    const int first = (int)fuzz_below(c, (unsigned)face[0]), back = (int)fuzz_below(c, 2);
    for (int i = 0; i < face[0]; i++) {
        const int at = (first + (back ? face[0] - i : i)) % face[0];
        fuzz_printf(out, " %d", face[1 + at] - 11);
    }
    end_line(c, out);
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    counts have = {0, 0, 0};
    if (fuzz_below(c, 8) == 0)
        fuzz_put_text(out, FUZZ_PICK(c, char *, "\xef\xbb\xbf", "# by a program\n", "\xff\xfe"));
    if (fuzz_odd(c)) /* before the vertices, counted from the back */
        fuzz_put_text(out, "f -1 -2 -3\n");
    for (int block = fuzz_between(c, 1, 3); block > 0; block--) {
        put_positions(c, out, &have);
        put_others(c, out, &have);
        for (int i = fuzz_between(c, 1, MOST_LINES); i > 0; i--) {
            const unsigned kind = fuzz_below(c, 8);
            if (kind == 0)
                put_other(c, out);
            else if (kind == 1)
                put_known_face(c, out, &have);
            else
                put_face(c, out, &have);
        }
    }
    if (fuzz_odd(c))
        fuzz_put_text(out, FUZZ_PICK(c, char *, "f 1 2", "f 1 2 \\", "v 1 2", "vt", "vn 0 0", "v"));
}

FUZZ_GENERATOR(generate)
