/* generate_utia.c: as fuzz_utia.c has it: options, a scale and samples of a table. */
#include "generate.h"

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    const int records = fuzz_between(c, 1, 6);
    unsigned options = 4 * fuzz_below(c, 2);
    options |= fuzz_odd(c) ? 3 : fuzz_below(c, 3);
    if (fuzz_odd(c))
        options |= FUZZ_PICK(c, unsigned, 8, 16);
    fuzz_put_le(out, options, 1);
    fuzz_put_float(out, fuzz_real(c, fuzz_below(c, 2) ? 1.0 : fuzz_real_between(c, 0.1, 10.0)));
    for (int r = 0; r < records; r++) {
        fuzz_put_le(out, fuzz_below(c, 3 * 288 * 288), 4);
        fuzz_put_double(out, fuzz_real(c, fuzz_real_between(c, -0.01, 1e4)));
    }
}

FUZZ_GENERATOR(generate)
