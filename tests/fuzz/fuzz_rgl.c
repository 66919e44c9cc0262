/* fuzz_rgl.c: the bytes are an RGL .bsdf file, read with each set of options. */
#include "fuzz_measured.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    for (int bits = 0; bits < 4; bits++) {
        const hnbrdf_measured_options options = {.rgl_signed = bits & 1, .rgl_spectra = bits >> 1};
        fuzz_measured(data, size, "material.bsdf", &options);
    }
    return 0;
}
