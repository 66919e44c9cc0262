/* output.c: the files that commands write, with a message where that fails. */
#include "cli/ranks.h"
#include "cli/cli.h"

#include <string.h>

int cli_output_open(const char *path, cli_output *output)
{
    hnbrdf_error error;
    return cli_code(report_output_open(path, output, &error), &error);
}

int cli_output_check(const char *path)
{
    hnbrdf_error error;
    if (cli_rank() > 0) /* the first one writes */
        return CLI_OK;
    return path ? cli_code(report_output_check(path, &error), &error) : CLI_OK;
}

int cli_output_close(cli_output *output)
{
    hnbrdf_error error;
    if (output->file == stdout && (fflush(stdout) != 0 || ferror(stdout)) && cli_standard_gone())
        return CLI_FAILURE; /* without a word, see cli_standard_end() */
    return cli_code(report_output_close(output, &error), &error);
}

void cli_output_discard(cli_output *output)
{
    report_output_discard(output);
}

int cli_make_folder(const char *path)
{
    hnbrdf_error error;
    return cli_code(report_make_folder(path, &error), &error);
}

int cli_write_file(const char *path, void (*write)(const void *what, FILE *file), const void *what)
{
    cli_output output;
    if (!path)
        return CLI_OK;
    if (cli_output_open(path, &output) != CLI_OK)
        return CLI_FAILURE;
    write(what, output.file);
    return cli_output_close(&output);
}

int cli_is_stdout(const char *path)
{
    return path && strcmp(path, "-") == 0;
}
