/* fuzz_exr.c: the bytes are an OpenEXR picture. */
#include "fuzz_picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    render_image image = {0};
    hnbrdf_error error = {""};
    const hnbrdf_result result =
        render_exr_decode(data, size, "picture.exr", &fuzz_limits, &image, &error);
    fuzz_environment(result, &image, &error);
    return 0;
}
