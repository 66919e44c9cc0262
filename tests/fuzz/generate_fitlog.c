/* generate_fitlog.c: the log of a fit: a row every 100 steps. */
#include "generate.h"

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    const int rows = fuzz_between(c, 0, 8);
    fuzz_put_text(out, fuzz_word(c, "step,share,loss,pairs_per_s"));
    fuzz_put_text(out, "\n");
    for (int k = 1; k <= rows; k++) {
        fuzz_put_number(out, c, fuzz_odd(c) ? 100 : 100 * k);
        fuzz_put_text(out, fuzz_word(c, ","));
        fuzz_put_number(out, c, 0.1 * k);
        fuzz_put_text(out, ",");
        fuzz_put_number(out, c, fuzz_real_between(c, 0.01, 1.0));
        fuzz_put_text(out, ",");
        fuzz_put_number(out, c, 1e6);
        fuzz_put_text(out, k < rows || fuzz_below(c, 4) ? "\n" : "");
    }
    if (fuzz_odd(c))
        out->size = fuzz_below(c, (unsigned)out->size + 1);
    if (fuzz_odd(c))
        fuzz_put(out, "\0more", 5);
}

FUZZ_GENERATOR(generate)
