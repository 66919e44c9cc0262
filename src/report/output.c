/* output.c: files that a person names, and stdout in the place of one. */
#include "report/output.h"

#include "base/error.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

hnbrdf_result report_output_open(const char *path, report_output *output, hnbrdf_error *error)
{
    memset(output, 0, sizeof *output);
    hnbrdf_result result = HNBRDF_OK;
    if (strcmp(path, "-") != 0)
        result = hnbrdf_output_open(path, &output->output, error);
    if (result == HNBRDF_OK)
        output->file = output->output.stream ? output->output.stream : stdout;
    return result;
}

hnbrdf_result report_output_check(const char *path, hnbrdf_error *error)
{
    return strcmp(path, "-") == 0 ? HNBRDF_OK : hnbrdf_output_check(path, error);
}

hnbrdf_result report_output_close(report_output *output, hnbrdf_error *error)
{
    FILE *file = output->file;
    output->file = NULL;
    if (file != stdout)
        return hnbrdf_output_close(&output->output, error);
    if (fflush(file) != 0 || ferror(file))
        return hnbrdf_fail(error, HNBRDF_ERROR_IO, "-: cannot write: %s", strerror(errno));
    return HNBRDF_OK;
}

void report_output_discard(report_output *output)
{
    if (output->file && output->file != stdout)
        hnbrdf_output_discard(&output->output);
    output->file = NULL;
}

hnbrdf_result report_write_file(const char *path, void (*write)(const void *what, FILE *file),
                                const void *what, hnbrdf_error *error)
{
    report_output output;
    hnbrdf_result result = report_output_open(path, &output, error);
    if (result)
        return result;
    write(what, output.file);
    return report_output_close(&output, error);
}

char *report_path_join(const char *directory, const char *name, hnbrdf_error *error)
{
    size_t size = strlen(directory) + strlen(name) + 2;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s/%s", directory, name);
    else
        hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    return path;
}

hnbrdf_result report_make_folder(const char *path, hnbrdf_error *error)
{
    struct stat status;
    if (mkdir(path, 0777) == 0 ||
        (errno == EEXIST && stat(path, &status) == 0 && S_ISDIR(status.st_mode)))
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: cannot make this folder: %s", path,
                       strerror(errno));
}

char *report_png_beside(const char *path)
{
    size_t length = strlen(path);
    char *beside = malloc(length + 1);
    if (beside) {
        memcpy(beside, path, length + 1);
        memcpy(beside + length - 4, ".png", 4);
    }
    return beside;
}
