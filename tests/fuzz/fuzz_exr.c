/* fuzz_exr.c: the bytes are an OpenEXR picture. It is read as it is, and once more as the layer
 * called a. */
#include "fuzz_picture.h"

static void nobody(void *user, const char *line)
{
    (void)user;
    FUZZ_CHECK(strlen(line) > 10 && !strchr(line, '\n'));
}

static void read_layer(const uint8_t *data, size_t size, const char *layer)
{
    render_image image = {0};
    hnbrdf_error error = {""};
    render_read_options limits = fuzz_limits;
    limits.layer = layer;
    limits.notes.note = nobody;
    hnbrdf_result result = render_exr_decode(data, size, "picture.exr", &limits, &image, &error);
    if (result == HNBRDF_OK && layer)
        (void)render_image_check(&image, "picture.exr", &error);
    if (result == HNBRDF_OK && layer)
        result = render_image_repair(&image, "picture.exr", &limits.notes, &error);
    if (result == HNBRDF_OK && image.width <= 8) /* more takes long */
        result = render_image_unfold(&image, "picture.exr", &error);
    if (result != HNBRDF_OK)
        render_image_free(&image);
    fuzz_environment(result, &image, &error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    read_layer(data, size, NULL);
    read_layer(data, size, "a");
    return 0;
}
