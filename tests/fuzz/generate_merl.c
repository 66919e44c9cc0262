/* generate_merl.c: as fuzz_merl.c has it: a MERL header, options, and samples of a full table. */
#include "generate.h"

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    static const uint64_t axes[3] = {90, 90, 180};
    const int full_circle = fuzz_odd(c), records = fuzz_between(c, 1, 6);
    for (int k = 0; k < 3; k++)
        fuzz_put_le(out, k == 2 && full_circle ? 360 : fuzz_whole(c, axes[k]), 4);
    fuzz_put_le(out, fuzz_odd(c) ? FUZZ_PICK(c, uint64_t, 4, 8, 16, 32) : fuzz_below(c, 4), 1);
    for (int r = 0; r < records; r++) {
        fuzz_put_le(out, fuzz_below(c, 90 * 90 * 180 * 3), 4);
        fuzz_put_double(out, fuzz_real(c, fuzz_real_between(c, 0.0, 1500.0)));
    }
    if (fuzz_odd(c))
        out->size = fuzz_below(c, 14);
}

FUZZ_GENERATOR(generate)
