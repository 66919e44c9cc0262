/* output.c: the files that commands write, and stdout in the place of one. */
#include "cli/cli.h"

#include "base/write.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

int cli_output_open(const char *path, cli_output *output)
{
    hnbrdf_error error;
    memset(output, 0, sizeof *output);
    if (strcmp(path, "-") == 0) {
        output->file = stdout;
        return CLI_OK;
    }
    if (hnbrdf_output_open(path, &output->output, &error))
        return cli_fail("%s", error.text);
    output->file = output->output.stream;
    return CLI_OK;
}

int cli_output_check(const char *path)
{
    hnbrdf_error error;
    if (strcmp(path, "-") == 0 || hnbrdf_output_check(path, &error) == HNBRDF_OK)
        return CLI_OK;
    return cli_fail("%s", error.text);
}

int cli_output_close(cli_output *output)
{
    hnbrdf_error error;
    FILE *file = output->file;
    output->file = NULL;
    if (file == stdout && (fflush(file) != 0 || ferror(file)))
        return cli_fail("-: cannot write: %s", strerror(errno));
    if (file != stdout && hnbrdf_output_close(&output->output, &error))
        return cli_fail("%s", error.text);
    return CLI_OK;
}

void cli_output_discard(cli_output *output)
{
    if (output->file && output->file != stdout)
        hnbrdf_output_discard(&output->output);
    output->file = NULL;
}

void cli_write_json_text(FILE *file, const char *text)
{
    hnbrdf_write_json_text(file, text);
}

int cli_make_folder(const char *path)
{
    struct stat status;
    if (mkdir(path, 0777) == 0 ||
        (errno == EEXIST && stat(path, &status) == 0 && S_ISDIR(status.st_mode)))
        return CLI_OK;
    return cli_fail("%s: cannot make this folder: %s", path, strerror(errno));
}
