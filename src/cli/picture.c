/* picture.c: light, exposure and files of the commands that make pictures. */
#include "cli/picture.h"

#include "image/difference.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Before minutes of work rather than after them. */
static int folder_is_writable(const char *path)
{
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) + 1 : 0; /* with the slash: "/x" lies in "/" */
    char *folder = malloc(length + 2);
    if (!folder)
        return 0;
    memcpy(folder, length ? path : ".", length ? length : 1);
    folder[length ? length : 1] = 0;
    int writable = access(folder, W_OK) == 0;
    free(folder);
    return writable;
}

int picture_check_output(const cli_command *command, const char *path)
{
    if (!path)
        return cli_usage(command, "where to write: -o FILE.exr or -o FILE.png is missing");
    if (render_has_extension(path, ".exr") && !render_has_exr())
        return cli_usage(
            command, "%s: this program was built without OpenEXR: expected a name in .png", path);
    if (!render_has_extension(path, ".exr") && !render_has_extension(path, ".png"))
        return cli_usage(command, "%s: expected a name ending in .exr or .png", path);
    if (!folder_is_writable(path))
        return cli_fail("%s: cannot be written: its folder does not exist or is not writable",
                        path);
    return -1;
}

int picture_open_light(picture_options *options, render_environment *environment)
{
    static const double sky_level = 0.56; /* what render_environment_level() gives for the sky */
    hnbrdf_error error;
    double radians = options->rotate * 3.14159265358979323846 / 180.0;
    if (render_environment_open(options->env, radians, environment, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    if (isnan(options->exposure))
        options->exposure = log2(sky_level / render_environment_level(environment));
    return CLI_OK;
}

/* FILE.png for FILE.exr; malloc'ed, NULL when memory is short. */
static char *png_beside(const char *path)
{
    size_t length = strlen(path);
    char *beside = malloc(length + 1);
    if (beside) {
        memcpy(beside, path, length + 1);
        memcpy(beside + length - 4, ".png", 4);
    }
    return beside;
}

int picture_write_quietly(const render_image *image, const char *path,
                          const render_write_options *options)
{
    hnbrdf_error error;
    if (render_image_write(image, path, options, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    if (render_has_extension(path, ".png"))
        return CLI_OK;
    char *beside = png_beside(path);
    if (!beside)
        return cli_fail("out of memory");
    hnbrdf_result result = render_image_write(image, beside, options, &error);
    free(beside);
    return result == HNBRDF_OK ? CLI_OK : cli_fail("%s", error.text);
}

int picture_write(const render_image *image, const char *path, const render_write_options *options)
{
    char *beside = render_has_extension(path, ".png") ? NULL : png_beside(path);
    int code = picture_write_quietly(image, path, options);
    if (code == CLI_OK)
        printf("%s\n", path);
    if (code == CLI_OK && beside)
        printf("%s\n", beside);
    free(beside);
    return code;
}

/* The pixels of image that count, one after the other; returns how many. */
static size_t pack(const render_image *image, const render_image *a, const render_image *b,
                   float *out)
{
    size_t pixels = (size_t)image->width * (size_t)image->height, count = 0;
    for (size_t i = 0; i < pixels; i++)
        if (render_covered(a, b, i))
            memcpy(out + 3 * count++, image->rgb + 3 * i, 3 * sizeof(float));
    return count;
}

int picture_compare(const render_image *image, const render_image *reference,
                    hnbrdf_image_error *error)
{
    size_t values = 3 * (size_t)image->width * (size_t)image->height;
    float *packed = malloc(2 * values * sizeof *packed);
    if (!packed)
        return cli_fail("out of memory");
    pack(reference, image, reference, packed + values);
    hnbrdf_image_compare(packed, packed + values, 3 * pack(image, image, reference, packed), error);
    free(packed);
    return CLI_OK;
}

int picture_compare_twice(const render_image image[2], const render_image reference[2],
                          hnbrdf_image_error *error, hnbrdf_image_noise *noise)
{
    size_t values = 3 * (size_t)image->width * (size_t)image->height, count = 0;
    float *packed = malloc(4 * values * sizeof *packed);
    if (!packed)
        return cli_fail("out of memory");
    const float *images[2] = {packed, packed + values},
                *references[2] = {packed + 2 * values, packed + 3 * values};
    for (int k = 0; k < 2; k++) {
        count = pack(&image[k], &image[0], &image[1], packed + (size_t)k * values);
        pack(&reference[k], &image[0], &image[1], packed + (size_t)(2 + k) * values);
    }
    hnbrdf_image_compare_twice(images, references, count, error, noise);
    free(packed);
    return CLI_OK;
}

int picture_report(void *progress, double share)
{
    picture_progress *p = progress;
    cli_progress_update(&p->line, (p->first + share) / p->count, p->detail);
    return 0;
}
