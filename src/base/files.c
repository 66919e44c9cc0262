/* files.c: files by UTF-8 paths, written aside and renamed when complete. The system's part is in
 * files_posix.c and files_windows.c. */
#include "base/files.h"

#include "base/error.h"
#include "base/files_system.h"

#include <errno.h>
#include <string.h>

enum { MAX_ASIDE = 64 }; /* writers of one file at the same time */

/* The words of the C library's strerror() in the C locale: that function follows the locale. */
static const char *reason(int number)
{
    static const struct {
        int number;
        const char *words;
    } known[] = {
        {EACCES, "Permission denied"},
        {EEXIST, "File exists"},
        {EFBIG, "File too large"},
        {EIO, "Input/output error"},
        {EISDIR, "Is a directory"},
        {EMFILE, "Too many open files"},
        {ENAMETOOLONG, "File name too long"},
        {ENOENT, "No such file or directory"},
        {ENOSPC, "No space left on device"},
        {ENOTDIR, "Not a directory"},
        {EPERM, "Operation not permitted"},
        {EROFS, "Read-only file system"},
#ifdef ELOOP
        {ELOOP, "Too many levels of symbolic links"},
#endif
#ifdef EDQUOT
        {EDQUOT, "Disk quota exceeded"},
#endif
#ifdef EBUSY
        {EBUSY, "Device or resource busy"},
#endif
    };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i)
        if (known[i].number == number)
            return known[i].words;
    return "the system does not say why";
}

static hnbrdf_result fail(const char *path, int number, hnbrdf_error *error)
{
    return hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: cannot write: %s", path, reason(number));
}

/* ---- Opening --------------------------------------------------------------------------------- */

/* The folder of the path, "." if it names none. */
static void folder_of(const char *path, char folder[HNBRDF_PATH_SIZE])
{
    const size_t length = hnbrdf_system_folder_length(path);
    memcpy(folder, path, length);
    folder[length] = '\0';
    if (length == 0)
        strcpy(folder, ".");
}

static hnbrdf_result fail_aside(const hnbrdf_output *output, int number, hnbrdf_error *error)
{
    char folder[HNBRDF_PATH_SIZE];
    folder_of(output->target, folder);
    if (number != EACCES && number != EROFS && number != EPERM)
        return fail(output->path, number, error);
    return hnbrdf_fail(error, HNBRDF_ERROR_IO,
                       "%s: cannot write: %s: the folder '%s' lets no file be made in it",
                       output->path, reason(number), folder);
}

static hnbrdf_result open_aside(hnbrdf_output *output, hnbrdf_error *error)
{
    const size_t length = strlen(output->target);
    if (length + sizeof HNBRDF_ASIDE + 8 > HNBRDF_PATH_SIZE)
        return fail(output->path, ENAMETOOLONG, error);
    for (int k = 0; k < MAX_ASIDE; ++k) {
        memcpy(output->aside, output->target, length);
        snprintf(output->aside + length, HNBRDF_PATH_SIZE - length,
                 k ? HNBRDF_ASIDE "%d" : HNBRDF_ASIDE, k);
        const hnbrdf_system_answer answer = hnbrdf_system_open_aside(output);
        if (answer == HNBRDF_SYSTEM_DONE)
            return HNBRDF_OK;
        if (answer == HNBRDF_SYSTEM_FAILED)
            return fail_aside(output, errno, error);
    }
    return hnbrdf_fail(
        error, HNBRDF_ERROR_IO,
        "%s: cannot write: %d files named '%s%s...' are in the way, expected none or "
        "those of processes that write this file now",
        output->path, MAX_ASIDE, output->target, HNBRDF_ASIDE);
}

static hnbrdf_result begin(const char *path, hnbrdf_output *output, hnbrdf_error *error)
{
    memset(output, 0, sizeof *output);
    if (strlen(path) >= HNBRDF_PATH_SIZE)
        return fail(path, ENAMETOOLONG, error);
    strcpy(output->path, path);
    return hnbrdf_system_find_target(output) ? HNBRDF_OK : fail(path, errno, error);
}

hnbrdf_result hnbrdf_output_open(const char *path, hnbrdf_output *output, hnbrdf_error *error)
{
    hnbrdf_result result = begin(path, output, error);
    if (result)
        return result;
    if (!hnbrdf_system_is_written_directly(path))
        return open_aside(output, error);
    output->stream = hnbrdf_system_open(path, 1);
    return output->stream ? HNBRDF_OK : fail(path, errno, error);
}

hnbrdf_result hnbrdf_output_check(const char *path, hnbrdf_error *error)
{
    hnbrdf_output output;
    hnbrdf_result result = begin(path, &output, error);
    if (result)
        return result;
    if (hnbrdf_system_is_written_directly(path)) /* to open a pipe would show its reader an end */
        return hnbrdf_system_may_write(path) ? HNBRDF_OK : fail(path, errno, error);
    result = open_aside(&output, error);
    hnbrdf_output_discard(&output);
    return result;
}

/* ---- Closing --------------------------------------------------------------------------------- */

hnbrdf_result hnbrdf_output_close(hnbrdf_output *output, hnbrdf_error *error)
{
    int number = errno, done = !ferror(output->stream); /* of the write that failed */
    if (done && fflush(output->stream) != 0) {
        done = 0;
        number = errno;
    }
    if (done && output->aside[0] && !hnbrdf_system_settle(output)) {
        done = 0;
        number = errno;
    }
    if (fclose(output->stream) != 0 && done) {
        done = 0;
        number = errno;
    }
    output->stream = NULL;
    if (done && output->aside[0]) {
        done = hnbrdf_system_replace(output);
        number = errno;
    }
    if (done)
        output->aside[0] = '\0'; /* there is nothing left to remove */
    hnbrdf_output_discard(output);
    return done ? HNBRDF_OK : fail(output->path, number, error);
}

void hnbrdf_output_discard(hnbrdf_output *output)
{
    if (output->stream)
        fclose(output->stream);
    output->stream = NULL;
    if (output->aside[0])
        hnbrdf_system_remove(output->aside);
    output->aside[0] = '\0';
    hnbrdf_system_unlock(output);
}

/* ---- Whole files ----------------------------------------------------------------------------- */

int hnbrdf_write_stream(void *file, const void *data, size_t size)
{
    return fwrite(data, 1, size, (FILE *)file) != size;
}

hnbrdf_result hnbrdf_write_file(const char *path, const void *data, size_t size,
                                hnbrdf_error *error)
{
    hnbrdf_output output;
    const hnbrdf_result result = hnbrdf_output_open(path, &output, error);
    if (result)
        return result;
    fwrite(data, 1, size, output.stream); /* closing tells whether it failed */
    return hnbrdf_output_close(&output, error);
}

FILE *hnbrdf_open_to_read(const char *path)
{
    return hnbrdf_system_open(path, 0);
}

FILE *hnbrdf_open_whole(const char *path, const char *label, hnbrdf_error *error)
{
    FILE *file = hnbrdf_open_to_read(path);
    if (!file) {
        hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: cannot be opened for reading: %s", label,
                    reason(errno));
    } else if (hnbrdf_system_is_device(file)) {
        hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: a device, expected a file", label);
        fclose(file);
        file = NULL;
    }
    return file;
}
