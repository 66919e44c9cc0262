/* generate_nbrdf.c: as fuzz_nbrdf.c has it: six NumPy files of one network, in the dialects that
 * NumPy writes. */
#include "generate.h"

#include <string.h>

enum { PARTS = 6 };

typedef struct dialect {
    int version, big_endian, bytes, columns_first;
} dialect;

/* The header's dictionary, its keys in any order. */
static void put_dictionary(fuzz_choices *c, fuzz_bytes *out, const dialect *d, const char *shape)
{
    const unsigned first = fuzz_below(c, 3);
    fuzz_put_text(out, fuzz_odd(c) ? FUZZ_PICK(c, char *, "", "[", "{{", "(") : "{");
    for (unsigned k = 0; k < 3; k++) {
        const unsigned key = fuzz_odd(c) ? fuzz_below(c, 4) : (first + k) % 3;
        if (k > 0)
            fuzz_put_text(out, fuzz_word(c, ", "));
        if (key == 0 && fuzz_odd(c))
            fuzz_printf(
                out, "'descr': %s",
                FUZZ_PICK(c, char *, "'<f2'", "'|u1'", "'<i4'", "[('a', '<f4')]", "<f4", "'"));
        else if (key == 0)
            fuzz_printf(out, "'descr': '%cf%d'", d->big_endian ? '>' : '<', d->bytes);
        else if (key == 1)
            fuzz_printf(out, "'fortran_order': %s",
                        fuzz_odd(c)        ? FUZZ_PICK(c, char *, "1", "false", "None", "Tru")
                        : d->columns_first ? "True"
                                           : "False");
        else if (key == 2)
            fuzz_printf(out, "'shape': %s", shape);
        else
            fuzz_put_text(out, "'other': 1");
    }
    fuzz_put_text(out, fuzz_below(c, 2) ? ", }" : "}");
    if (fuzz_odd(c))
        fuzz_put_text(out, FUZZ_PICK(c, char *, "}", " x", ",", "\t"));
}

static void print_shape(fuzz_choices *c, fuzz_bytes *shape, int axes, const size_t size[2])
{
    if (fuzz_odd(c))
        fuzz_put_text(shape,
                      FUZZ_PICK(c, char *, "()", "(0,)", "(1025,)", "(2,3,4)", "(-1,)", "(a,)",
                                "(6, ", "6", "(99999999999999999999999,)", "(6 21)", "(,)"));
    else if (axes == 1)
        fuzz_printf(shape, "(%llu,)", (unsigned long long)fuzz_whole(c, size[0]));
    else
        fuzz_printf(shape, "(%llu, %llu)", (unsigned long long)fuzz_whole(c, size[0]),
                    (unsigned long long)fuzz_whole(c, size[1]));
    fuzz_put(shape, "", 1);
}

static void put_header(fuzz_choices *c, fuzz_bytes *out, const dialect *d, int axes,
                       const size_t size[2])
{
    fuzz_bytes text = {0}, shape = {0};
    print_shape(c, &shape, axes, size);
    put_dictionary(c, &text, d, (const char *)shape.data);
    while ((text.size + (d->version == 1 ? 11 : 13)) % 16)
        fuzz_put_text(&text, " ");
    fuzz_put_text(&text, "\n");
    fuzz_put(out, fuzz_odd(c) ? "\223NumPY" : "\223NUMPY", 6);
    fuzz_put_le(out, fuzz_whole(c, (uint64_t)d->version), 1);
    fuzz_put_le(out, 0, 1);
    fuzz_put_le(out, fuzz_whole(c, text.size), d->version == 1 ? 2 : 4);
    fuzz_put(out, text.data, text.size);
    fuzz_free(&text);
    fuzz_free(&shape);
}

static void put_numbers(fuzz_choices *c, fuzz_bytes *out, const dialect *d, size_t count)
{
    const size_t odd = fuzz_odd(c) ? fuzz_below(c, (unsigned)count) : count;
    for (size_t i = 0; i < count; i++) {
        fuzz_bytes number = {0};
        double value = fuzz_real_between(c, -1.0, 1.0);
        if (i == odd)
            value = fuzz_hostile(c, value);
        (d->bytes == 4 ? fuzz_put_float : fuzz_put_double)(&number, value);
        for (int k = 0; k < d->bytes; k++)
            fuzz_put(out, number.data + (d->big_endian ? d->bytes - 1 - k : k), 1);
        fuzz_free(&number);
    }
}

static void put_part(fuzz_choices *c, fuzz_bytes *out, int axes, const size_t size[2])
{
    const dialect d = {fuzz_between(c, 1, 3), (int)fuzz_below(c, 2), fuzz_below(c, 2) ? 4 : 8,
                       (int)fuzz_below(c, 2)};
    fuzz_bytes part = {0};
    put_header(c, &part, &d, axes, size);
    put_numbers(c, &part, &d, size[0] * (axes == 2 ? size[1] : 1));
    if (fuzz_odd(c))
        part.size = fuzz_below(c, (unsigned)part.size);
    if (fuzz_odd(c))
        part.size = FUZZ_PICK(c, size_t, 9, 10, 11, 12, part.size - 1);
    fuzz_put_le(out, part.size, 2);
    fuzz_put(out, part.data, part.size);
    fuzz_free(&part);
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    size_t inputs = 6;
    for (int k = 0; k < PARTS; k += 2) {
        const size_t units = k == PARTS - 2 ? 3 : 1 + fuzz_below(c, 10);
        const size_t size[2] = {fuzz_odd(c) ? inputs + 1 : inputs, fuzz_odd(c) ? units + 1 : units};
        put_part(c, out, fuzz_odd(c) ? 1 : 2, size);
        put_part(c, out, fuzz_odd(c) ? 2 : 1, (size_t[]){fuzz_odd(c) ? units + 1 : units, 1});
        inputs = units;
    }
}

FUZZ_GENERATOR(generate)
