/* exr_none.c: in the place of the OpenEXR reader and writer where the program is built without
 * OpenEXR. */
#include "image/image.h"

#include "base/error.h"

int render_has_exr(void)
{
    return 0;
}

hnbrdf_result render_exr_encode(const render_image *image, const render_write_options *options,
                                render_bytes *bytes, hnbrdf_error *error)
{
    (void)image, (void)options, (void)bytes;
    return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                       "this program was built without OpenEXR: write a .png instead");
}

hnbrdf_result render_exr_decode(const void *data, size_t size, const char *name,
                                const render_read_options *options, render_image *image,
                                hnbrdf_error *error)
{
    (void)data, (void)size, (void)options, (void)image;
    return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                       "%s: this program was built without OpenEXR: use a Radiance .hdr file",
                       name);
}
