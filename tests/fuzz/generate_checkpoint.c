/* generate_checkpoint.c: as fuzz_checkpoint.c has it: the state of a fit of 5 numbers and 2
 * materials of 4 tiles each, behind magic and fingerprint. */
#include "generate.h"

static void put_floats(fuzz_choices *c, fuzz_bytes *out, int count, double low)
{
    const int odd = fuzz_odd(c) ? (int)fuzz_below(c, (unsigned)count) : -1;
    for (int i = 0; i < count; i++) {
        const double value = fuzz_real_between(c, low, 1.0);
        fuzz_put_float(out, i == odd ? fuzz_hostile(c, value) : value);
    }
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    const int step = fuzz_between(c, 0, 1000), best = fuzz_between(c, 0, step);
    fuzz_put_le(out, fuzz_whole(c, fuzz_below(c, 1000)), 8); /* random numbers */
    fuzz_put_le(out, fuzz_whole(c, 1 + 2 * fuzz_below(c, 1000)), 8);
    fuzz_put_double(out, fuzz_real(c, fuzz_real_between(c, 0.0, 1.0)));  /* share */
    fuzz_put_double(out, fuzz_real(c, fuzz_real_between(c, 0.01, 1.0))); /* peak */
    fuzz_put_double(out, fuzz_real(c, fuzz_real_between(c, 0.0, 1.0)));  /* running */
    fuzz_put_le(out, fuzz_whole(c, (uint64_t)step), 8);
    fuzz_put_le(out, fuzz_whole(c, fuzz_below(c, 2)), 8);
    fuzz_put_le(out, fuzz_whole(c, (uint64_t)(step - best)), 8);
    fuzz_put_le(out, fuzz_whole(c, (uint64_t)best), 8);
    fuzz_put_le(out, fuzz_whole(c, fuzz_below(c, 3)), 8);
    fuzz_put_le(out, fuzz_whole(c, 0), 8);
    fuzz_put_double(out, fuzz_real(c, fuzz_real_between(c, 0.0, 1.0)));
    put_floats(c, out, 10, -1.0); /* parameters and moments */
    put_floats(c, out, 5, 0.0);   /* squares */
    put_floats(c, out, 5, -1.0);  /* the best */
    const unsigned first = fuzz_below(c, 2);
    fuzz_put_le(out, fuzz_whole(c, first), 4);
    fuzz_put_le(out, fuzz_whole(c, 1 - first), 4);
    for (int m = 0; m < 2; m++)
        fuzz_put_le(out, fuzz_whole(c, fuzz_below(c, 4)), 4);
    if (fuzz_odd(c))
        fuzz_put(out, "more", 1 + fuzz_below(c, 4));
    if (fuzz_odd(c))
        out->size = fuzz_below(c, (unsigned)out->size);
}

FUZZ_GENERATOR(generate)
