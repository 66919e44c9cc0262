/* generate_texels.c: as fuzz_texels.c has it: a packing, then texels of any bits. */
#include "generate.h"

static void put_range(fuzz_choices *c, fuzz_bytes *out, double low, double high)
{
    const double first = fuzz_real_between(c, low, high);
    fuzz_put_float(out, fuzz_real(c, first));
    fuzz_put_float(out, fuzz_real(c, fuzz_real_between(c, first, high)));
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    const unsigned latent = fuzz_odd(c) ? FUZZ_PICK(c, unsigned, 0, 17) : 1 + fuzz_below(c, 16);
    const unsigned usual = fuzz_below(c, 2);
    fuzz_put_le(out, fuzz_below(c, 16) | usual << 4 | fuzz_below(c, 2) << 5, 1);
    fuzz_put_le(out, latent, 1);
    if (!usual) {
        put_range(c, out, 0.0, 1.0);
        put_range(c, out, 1.01, 4.0);
        put_range(c, out, 0.001, 1.0);
    }
    for (unsigned i = 1; i < latent; i++)
        put_range(c, out, -3.0, 3.0);
    for (int i = fuzz_between(c, 1, 30); i > 0; i--)
        fuzz_put_le(out, fuzz_whole(c, fuzz_below(c, 0xffffffff)), 4);
}

FUZZ_GENERATOR(generate)
