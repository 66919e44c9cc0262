/* picture.c: light, exposure and files of the commands that make pictures. */
#include "cli/picture.h"

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
        return cli_usage(command, "%s: this program was built without OpenEXR: expected a name in .png",
                         path);
    if (!render_has_extension(path, ".exr") && !render_has_extension(path, ".png"))
        return cli_usage(command, "%s: expected a name ending in .exr or .png", path);
    if (!folder_is_writable(path))
        return cli_fail("%s: cannot be written: its folder does not exist or is not writable", path);
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

int picture_write(const render_image *image, const char *path, const render_write_options *options)
{
    hnbrdf_error error;
    if (render_image_write(image, path, options, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    if (render_has_extension(path, ".png")) {
        printf("%s\n", path);
        return CLI_OK;
    }
    size_t length = strlen(path);
    char *beside = malloc(length + 1);
    if (!beside)
        return cli_fail("out of memory");
    memcpy(beside, path, length + 1);
    memcpy(beside + length - 4, ".png", 4);
    hnbrdf_result result = render_image_write(image, beside, options, &error);
    if (result == HNBRDF_OK)
        printf("%s\n%s\n", path, beside);
    free(beside);
    return result == HNBRDF_OK ? CLI_OK : cli_fail("%s", error.text);
}

int picture_compare(const render_image *image, const render_image *reference, hnbrdf_image_error *error)
{
    size_t pixels = (size_t)image->width * (size_t)image->height, count = 0;
    float *values = malloc(6 * sizeof(float) * pixels),
          *references = values ? values + 3 * pixels : NULL;
    if (!values)
        return cli_fail("out of memory");
    for (size_t i = 0; i < pixels; i++)
        if (reference->alpha[i] > 0.0f) {
            memcpy(values + count, image->rgb + 3 * i, 3 * sizeof(float));
            memcpy(references + count, reference->rgb + 3 * i, 3 * sizeof(float));
            count += 3;
        }
    hnbrdf_image_compare(values, references, count, error);
    free(values);
    return CLI_OK;
}

int picture_report(void *progress, double share)
{
    picture_progress *p = progress;
    cli_progress_update(&p->line, (p->first + share) / p->count, p->detail);
    return 0;
}
