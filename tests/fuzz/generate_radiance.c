/* generate_radiance.c: Radiance pictures of every orientation: any lines in the header, scanlines
 * flat, in planes or with old run lengths, RGB and XYZ. */
#include "generate.h"

#include <string.h>

typedef struct writer {
    fuzz_choices *c;
    fuzz_bytes *out;
    const char *end;   /* of lines */
    int length, lines; /* of the scanlines */
    int coding;        /* FLAT ... MIXED */
    unsigned char scanline[65536][4];
} writer;

enum { FLAT, OLD_RUNS, PLANES, MIXED };

/* ---- The header ------------------------------------------------------------------------------ */

static void put_line(writer *w, const char *text)
{
    fuzz_put_text(w->out, fuzz_word(w->c, text));
    fuzz_put_text(w->out, w->end);
}

/* KEY= and numbers. */
static void put_numbers(writer *w, const char *key, int count, const double *numbers)
{
    fuzz_put_text(w->out, key);
    for (int i = 0; i < count; i++) {
        fuzz_put_text(w->out, FUZZ_PICK(w->c, char *, " ", "  ", "\t"));
        fuzz_put_number(w->out, w->c, numbers[i]);
    }
    fuzz_put_text(w->out, w->end);
}

static void put_primaries(writer *w)
{
    static const double spaces[5][8] = {{.64, .33, .29, .6, .15, .06, .3333, .3333},
                                        {.64, .33, .3, .6, .15, .06, .3127, .329},
                                        {.708, .292, .17, .797, .131, .046, .3127, .329},
                                        {.7, .3, .2, .7, .15, .06, .3457, .3585},
                                        {.1, .2, .2, .3, .3, .4, .4, .5}}; /* on a line */
    put_numbers(w, "PRIMARIES=", fuzz_odd(w->c) ? fuzz_between(w->c, 0, 7) : 8,
                spaces[fuzz_below(w->c, 5)]);
}

static void put_format(writer *w)
{
    fuzz_put_text(w->out, fuzz_odd(w->c) ? "FORMAT" : "FORMAT=");
    put_line(w, fuzz_odd(w->c) ? "Radiance_rle_spectra"
                               : FUZZ_PICK(w->c, char *, "32-bit_rle_rgbe", "32-bit_rle_xyze",
                                           " 32-bit_rle_xyze  "));
}

static void put_any_line(writer *w)
{
    const double one[3] = {fuzz_real_between(w->c, 0.1, 8.0), fuzz_real_between(w->c, 0.5, 2.0),
                           fuzz_real_between(w->c, 0.5, 2.0)};
    switch (fuzz_below(w->c, 7)) {
    case 0:
        put_numbers(w, "EXPOSURE=", 1, one);
        break;
    case 1:
        put_numbers(w, "COLORCORR=", fuzz_odd(w->c) ? 2 : 3, one);
        break;
    case 2:
        put_primaries(w);
        break;
    case 3:
        put_numbers(w, "PIXASPECT=", 1, one);
        break;
    case 4:
        put_line(w, "\tEXPOSURE=3");
        break;
    case 5:
        put_line(w, "# a comment");
        break;
    default:
        put_line(w, "VIEW= -vta -vh 360 -vv 180");
    }
}

static void put_header(writer *w)
{
    w->end = fuzz_below(w->c, 4) ? "\n" : "\r\n";
    const int has_magic = fuzz_below(w->c, 8) != 0;
    if (has_magic)
        put_line(w, fuzz_below(w->c, 2) ? "#?RADIANCE" : "#?RGBE");
    for (int i = fuzz_between(w->c, 0, 4); i > 0; i--)
        put_any_line(w);
    if (!has_magic || fuzz_below(w->c, 8))
        put_format(w);
    for (int i = fuzz_between(w->c, 0, 2); i > 0; i--)
        put_any_line(w);
    put_line(w, "");
}

static void put_axis(writer *w, char letter, int side)
{
    if (fuzz_odd(w->c))
        letter = FUZZ_PICK(w->c, char, 'X', 'Y', 'Z', 'y', ' ');
    fuzz_printf(w->out, "%c%s%llu%s", letter, FUZZ_PICK(w->c, char *, "", " ", "       ", "\t"),
                (unsigned long long)fuzz_whole(w->c, (uint64_t)side), fuzz_word(w->c, ""));
}

/* Sides are of scanlines and of how many there are; which is X and which is Y does not matter. */
static void put_resolution(writer *w)
{
    const char first = FUZZ_PICK(w->c, char, 'X', 'Y');
    fuzz_put_text(w->out, fuzz_word(w->c, FUZZ_PICK(w->c, char *, "-", "+")));
    put_axis(w, first, w->lines);
    fuzz_put_text(w->out, fuzz_word(w->c, FUZZ_PICK(w->c, char *, " -", " +", "+")));
    put_axis(w, first == 'X' ? 'Y' : 'X', w->length);
    fuzz_put_text(w->out, w->end);
}

/* ---- Scanlines ------------------------------------------------------------------------------- */

/* Pixels of which some repeat, in all of their bytes or in some. */
static void choose_scanline(writer *w)
{
    const int wild = fuzz_odd(w->c) ? (int)fuzz_below(w->c, (unsigned)w->length) : -1;
    const int most = FUZZ_PICK(w->c, int, 1, 4, 300, 65536);
    for (int x = 0, run = 0; x < w->length; x++, run--) {
        unsigned char *pixel = w->scanline[x];
        if (run <= 0) {
            run = fuzz_between(w->c, 1, most);
            pixel[0] = (unsigned char)fuzz_between(w->c, 128, 255);
            pixel[1] = (unsigned char)(fuzz_below(w->c, 2) ? fuzz_below(w->c, 256) : 9);
            pixel[2] = (unsigned char)(fuzz_below(w->c, 2) ? fuzz_below(w->c, 256) : 9);
            pixel[3] = (unsigned char)(fuzz_below(w->c, 8) ? fuzz_between(w->c, 120, 136)
                                                           : FUZZ_PICK(w->c, int, 0, 1, 254, 255));
        } else {
            memcpy(pixel, w->scanline[x - 1], 4);
        }
        if (x == wild)
            memcpy(pixel, FUZZ_PICK(w->c, char *, "\1\1\1\7", "\2\2\0\10", "\1\1\1\377"), 4);
    }
}

static int repeats(const writer *w, int x, int plane, int most)
{
    int count = 1;
    while (x + count < w->length && count < most &&
           (plane < 0 ? memcmp(w->scanline[x + count], w->scanline[x], 4) == 0
                      : w->scanline[x + count][plane] == w->scanline[x][plane]))
        count++;
    return count;
}

static void put_old_runs(writer *w)
{
    const int odd = fuzz_odd(w->c);
    if (odd && fuzz_below(w->c, 2))
        fuzz_put(w->out, "\1\1\1\2", 4); /* of no pixel */
    for (int x = 0, count; x < w->length; x += count) {
        count = repeats(w, x, -1, 65536);
        fuzz_put(w->out, w->scanline[x], 4);
        for (int left = count - 1; left > 0; left >>= 8)
            fuzz_put(w->out, (const unsigned char[4]){1, 1, 1, (unsigned char)left}, 4);
    }
    if (odd) { /* a run at the end, of any count */
        w->out->size -= 4;
        for (int i = fuzz_between(w->c, 1, 5); i > 0; i--)
            fuzz_put(w->out,
                     (const unsigned char[4]){1, 1, 1, (unsigned char)(fuzz_below(w->c, 2) * 9)},
                     4);
    }
}

static void put_plane(writer *w, int plane)
{
    const int odd = fuzz_odd(w->c);
    for (int x = 0, count; x < w->length; x += count) {
        count = repeats(w, x, plane, 127);
        if (count < 3) { /* as they are, and those after them until some repeat */
            while (count < 128 && x + count < w->length && repeats(w, x + count, plane, 3) < 3)
                count++;
            fuzz_put_le(w->out, odd ? fuzz_below(w->c, 256) : (uint64_t)count, 1);
            for (int i = 0; i < count; i++)
                fuzz_put_le(w->out, w->scanline[x + i][plane], 1);
        } else {
            fuzz_put_le(w->out, odd ? fuzz_below(w->c, 256) : 128 + (uint64_t)count, 1);
            fuzz_put_le(w->out, w->scanline[x][plane], 1);
        }
    }
}

static void put_scanline(writer *w)
{
    const int coding = w->coding == MIXED ? fuzz_between(w->c, FLAT, PLANES) : w->coding;
    choose_scanline(w);
    if (coding == OLD_RUNS) {
        put_old_runs(w);
    } else if (coding == PLANES && w->length < 32768) {
        fuzz_put(w->out, "\2\2", 2);
        fuzz_put_be(w->out, fuzz_whole(w->c, (uint64_t)w->length), 2);
        for (int k = 0; k < 4; k++)
            put_plane(w, k);
    } else {
        fuzz_put(w->out, w->scanline, 4 * (size_t)w->length);
    }
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    static writer w; /* large */
    w.c = c;
    w.out = out;
    w.coding = fuzz_between(c, FLAT, MIXED);
    w.length = fuzz_between(c, 1, 24);
    w.lines = fuzz_between(c, 1, 12);
    if (fuzz_below(c, 16) == 0)
        w.length = fuzz_between(c, 200, 1200);
    if (fuzz_below(c, 64) == 0) {
        w.length = FUZZ_PICK(c, int, 32767, 32768, 40000, 65536);
        w.lines = 1;
    }
    put_header(&w);
    put_resolution(&w);
    for (int i = 0; i < w.lines; i++)
        put_scanline(&w);
    if (fuzz_odd(c))
        out->size -= fuzz_below(c, 8);
}

FUZZ_GENERATOR(generate)
