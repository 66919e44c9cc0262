/* generate_film.c: as fuzz_film.c has it: the state of a rendering of 17 x 2 pixels in two tiles,
 * all of it. Numbers are those of a machine that has the low byte first. */
#include "generate.h"

enum { PIXELS = 17 * 2, SUMS = 10, TILES = 2 };

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    int samples[TILES];
    fuzz_put(out, fuzz_odd(c) ? "hnbrdf-render/2" : "hnbrdf-render/1", 16);
    fuzz_put_le(out, fuzz_whole(c, 7), 8); /* fingerprint */
    fuzz_put_le(out, fuzz_whole(c, 17), 4);
    fuzz_put_le(out, fuzz_whole(c, 2), 4);
    for (int i = 0; i < TILES; i++) {
        samples[i] = fuzz_between(c, 0, 4) ? fuzz_between(c, 0, 1000) : 0;
        fuzz_put_le(out, fuzz_whole(c, (uint64_t)samples[i]), 4);
    }
    const int odd = fuzz_odd(c) ? (int)fuzz_below(c, PIXELS * SUMS) : -1;
    for (int i = 0; i < PIXELS * SUMS; i++) {
        const double sum = samples[i / SUMS % 17 / 16] * fuzz_real_between(c, -1.0, 10.0);
        fuzz_put_double(out, i == odd ? fuzz_hostile(c, sum) : sum);
    }
    if (fuzz_odd(c))
        fuzz_put(out, "more", 1 + fuzz_below(c, 4));
    if (fuzz_odd(c))
        out->size = fuzz_below(c, (unsigned)out->size);
}

FUZZ_GENERATOR(generate)
