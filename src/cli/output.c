/* output.c: files that appear only when they are complete, and text as JSON wants it. */
#include "cli/cli.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int fail_output(cli_output *output, const char *what)
{
    cli_fail("%s: %s: %s", output->path, what, strerror(errno));
    cli_output_discard(output);
    return CLI_FAILURE;
}

/* Existing pipes and devices, /dev/null for one, must not be replaced by a file. */
static int is_written_directly(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode);
}

static FILE *open_aside(cli_output *output)
{
    size_t size = strlen(output->path) + 32;
    output->aside = malloc(size);
    if (!output->aside)
        return NULL;
    snprintf(output->aside, size, "%s.%ld.part", output->path, (long)getpid());
    int descriptor = open(output->aside, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    return descriptor < 0 ? NULL : fdopen(descriptor, "wb");
}

int cli_output_open(const char *path, cli_output *output)
{
    memset(output, 0, sizeof *output);
    output->path = strdup(path);
    if (!output->path)
        return cli_fail("out of memory");
    if (strcmp(path, "-") == 0)
        output->file = stdout;
    else
        output->file = is_written_directly(path) ? fopen(path, "wb") : open_aside(output);
    return output->file ? CLI_OK : fail_output(output, "cannot write");
}

int cli_output_check(const char *path)
{
    cli_output output;
    int code = cli_output_open(path, &output);
    if (!code)
        cli_output_discard(&output);
    return code;
}

int cli_output_close(cli_output *output)
{
    int written = fflush(output->file) == 0 && !ferror(output->file);
    if (written && output->file != stdout) {
        written = fclose(output->file) == 0;
        output->file = NULL;
    }
    if (!written)
        return fail_output(output, "cannot write");
    if (output->aside && rename(output->aside, output->path) != 0)
        return fail_output(output, "cannot rename the finished file to this name");
    free(output->aside);
    output->aside = NULL;
    cli_output_discard(output);
    return CLI_OK;
}

void cli_output_discard(cli_output *output)
{
    if (output->file && output->file != stdout)
        fclose(output->file);
    if (output->aside)
        remove(output->aside);
    free(output->aside);
    free(output->path);
    memset(output, 0, sizeof *output);
}

void cli_write_json_text(FILE *file, const char *text)
{
    putc('"', file);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            putc('\\', file);
        if ((unsigned char)*text < 0x20)
            fprintf(file, "\\u%04x", (unsigned)(unsigned char)*text);
        else
            putc(*text, file);
    }
    putc('"', file);
}

int cli_make_folder(const char *path)
{
    struct stat status;
    if (mkdir(path, 0777) == 0 ||
        (errno == EEXIST && stat(path, &status) == 0 && S_ISDIR(status.st_mode)))
        return CLI_OK;
    return cli_fail("%s: cannot make this folder: %s", path, strerror(errno));
}
