/* fuzz_radiance.c: the bytes are a Radiance .hdr picture. */
#include "fuzz_picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    render_image image = {0};
    hnbrdf_error error = {""};
    const hnbrdf_result result =
        render_radiance_decode(data, size, "picture.hdr", &fuzz_limits, &image, &error);
    fuzz_environment(result, &image, &error);
    return 0;
}
