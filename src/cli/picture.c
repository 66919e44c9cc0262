/* picture.c: light, exposure and files of the commands that make pictures. */
#include "cli/picture.h"

#include "base/interrupt.h"
#include "base/text.h"

#include <stdlib.h>
#include <string.h>

int picture_check_output(const cli_command *command, const char *path)
{
    if (!path)
        return cli_usage(command, "where to write: -o FILE.exr or -o FILE.png is missing");
    if (hnbrdf_ends_with(path, ".exr") && !render_has_exr())
        return cli_usage(
            command, "%s: this program was built without OpenEXR: expected a name in .png", path);
    if (!hnbrdf_ends_with(path, ".exr") && !hnbrdf_ends_with(path, ".png"))
        return cli_usage(command, "%s: expected a name ending in .exr or .png", path);
    return -1;
}

int picture_open_light(picture_options *options, render_environment *environment)
{
    hnbrdf_error error;
    return cli_code(report_open_light(options, environment, &error), &error);
}

int picture_write(const render_image *image, const char *path, const render_write_options *options)
{
    hnbrdf_error error;
    if (report_picture_write(image, path, options, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    report_print_pictures(path, cli_words());
    return CLI_OK;
}

int picture_report(void *progress, double share)
{
    picture_progress *p = progress;
    cli_progress_update(&p->line, (p->first + share) / p->count, p->detail);
    return hnbrdf_interrupted();
}

void picture_begin(cli_progress *line, const char *what, int stoppable)
{
    cli_progress_begin(line, what);
    hnbrdf_catch_interrupts(stoppable);
}

void picture_end(cli_progress *line, const render_outcome *outcome, long spp)
{
    hnbrdf_catch_interrupts(0);
    cli_progress_end(line);
    if (outcome && !outcome->complete)
        fprintf(
            cli_words(),
            "stopped at %d to %d of %ld samples a pixel. Repeat the command with --resume to go "
            "on.\n",
            outcome->least, outcome->most, spp);
}
