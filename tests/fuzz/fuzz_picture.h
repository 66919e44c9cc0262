/* fuzz_picture.h: what the targets for pictures share: a picture that was read becomes an
 * environment, which is asked and sampled. */
#ifndef HNBRDF_TESTS_FUZZ_PICTURE_H
#define HNBRDF_TESTS_FUZZ_PICTURE_H

#include "fuzz.h"

#include "render/environment.h"

static inline void fuzz_picture_note(void *user, const char *line)
{
    (void)user;
    fuzz_check_line(line);
}

/* Small, so that a run is fast; the tests hold the defaults. */
static const render_read_options fuzz_limits = {
    .max_bytes = 1 << 20, .max_pixels = 1 << 16, .notes = {fuzz_picture_note, NULL}};

static inline void fuzz_environment(hnbrdf_result result, render_image *image, hnbrdf_error *error)
{
    render_environment environment;
    FUZZ_CHECK((result == HNBRDF_OK) == (image->rgb != NULL));
    if (result) {
        fuzz_check_refusal(result, error);
        return;
    }
    FUZZ_CHECK((size_t)image->width * (size_t)image->height <= fuzz_limits.max_pixels);
    result = render_environment_create(image, 0.5, "picture", &environment, error);
    if (result) {
        fuzz_check_refusal(result, error);
        render_image_free(image);
        return;
    }
    for (int k = 0; k < 5; k++) {
        const double u[2] = {0.25 * k < 1.0 ? 0.25 * k : 1.0 - 0x1p-53, 0.5};
        float direction[3], radiance[3];
        FUZZ_CHECK(render_environment_sample(&environment, u, direction, radiance) > 0.0);
        fuzz_check_value(radiance);
        FUZZ_CHECK(render_environment_lookup(&environment, direction, radiance) >= 0.0);
        fuzz_check_value(radiance);
    }
    render_environment_free(&environment);
}

#endif
