/* files_windows.c: what files.c asks of Windows: UTF-8 paths through the wide functions. A file
 * aside that its writer has open can be neither opened nor removed by others. */
#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include "base/files_system.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <string.h>
#include <sys/stat.h>
#include <windows.h>

/* 0 with errno set if the path is not UTF-8 or too long. */
static int widen(const char *path, wchar_t wide[HNBRDF_PATH_SIZE])
{
    const int length =
        MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, HNBRDF_PATH_SIZE);
    if (length == 0)
        errno = GetLastError() == ERROR_INSUFFICIENT_BUFFER ? ENAMETOOLONG : ENOENT;
    return length > 0;
}

size_t hnbrdf_system_folder_length(const char *path)
{
    size_t length = strlen(path);
    while (length > 0 && !strchr("/\\:", path[length - 1]))
        --length;
    if (length > 1 && path[length - 1] != ':' && path[length - 2] != ':')
        --length; /* but the separator of a root stays */
    return length;
}

FILE *hnbrdf_system_open(const char *path, int writing)
{
    wchar_t wide[HNBRDF_PATH_SIZE];
    return widen(path, wide) ? _wfopen(wide, writing ? L"wb" : L"rb") : NULL;
}

/* NUL, CON, COM1 and so on, and named pipes. */
int hnbrdf_system_is_written_directly(const char *path)
{
    wchar_t wide[HNBRDF_PATH_SIZE];
    if (strncmp(path, "\\\\.\\", 4) == 0)
        return 1;
    if (!widen(path, wide) || GetFileAttributesW(wide) != INVALID_FILE_ATTRIBUTES)
        return 0;
    const HANDLE handle = CreateFileW(wide, GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, NULL,
                                      OPEN_EXISTING, 0, NULL);
    if (handle == INVALID_HANDLE_VALUE)
        return 0;
    const DWORD type = GetFileType(handle);
    CloseHandle(handle);
    return type != FILE_TYPE_DISK;
}

int hnbrdf_system_is_device(FILE *file)
{
    return GetFileType((HANDLE)_get_osfhandle(_fileno(file))) == FILE_TYPE_CHAR;
}

int hnbrdf_system_may_write(const char *path)
{
    (void)path; /* opening tells */
    return 1;
}

int hnbrdf_system_find_target(hnbrdf_output *output)
{
    wchar_t wide[HNBRDF_PATH_SIZE];
    strcpy(output->target, output->path);
    if (!widen(output->target, wide))
        return 0;
    const DWORD attributes = GetFileAttributesW(wide);
    if (attributes != INVALID_FILE_ATTRIBUTES && attributes & FILE_ATTRIBUTE_DIRECTORY) {
        errno = EISDIR;
        return 0;
    }
    return 1;
}

hnbrdf_system_answer hnbrdf_system_open_aside(hnbrdf_output *output)
{
    const int flags = _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT;
    wchar_t wide[HNBRDF_PATH_SIZE];
    int descriptor = -1;
    if (widen(output->aside, wide)) {
        DeleteFileW(wide); /* a leftover; fails while its writer has it open */
        descriptor = _wsopen(wide, flags, _SH_DENYRW, _S_IREAD | _S_IWRITE);
    }
    if (descriptor < 0) {
        output->aside[0] = '\0'; /* not ours to remove */
        return errno == EEXIST ? HNBRDF_SYSTEM_TAKEN : HNBRDF_SYSTEM_FAILED;
    }
    output->stream = _fdopen(descriptor, "wb");
    if (output->stream)
        return HNBRDF_SYSTEM_DONE;
    const int number = errno;
    _close(descriptor);
    DeleteFileW(wide);
    output->aside[0] = '\0';
    errno = number;
    return HNBRDF_SYSTEM_FAILED;
}

int hnbrdf_system_settle(hnbrdf_output *output)
{
    (void)output; /* the folder's rules hold */
    return 1;
}

int hnbrdf_system_replace(hnbrdf_output *output)
{
    wchar_t from[HNBRDF_PATH_SIZE], to[HNBRDF_PATH_SIZE];
    if (!widen(output->aside, from) || !widen(output->target, to))
        return 0;
    if (MoveFileExW(from, to, MOVEFILE_REPLACE_EXISTING))
        return 1;
    errno = GetLastError() == ERROR_ACCESS_DENIED ? EACCES : EIO;
    return 0;
}

void hnbrdf_system_unlock(hnbrdf_output *output)
{
    output->lock = 0;
}

void hnbrdf_system_remove(const char *path)
{
    wchar_t wide[HNBRDF_PATH_SIZE];
    if (widen(path, wide))
        DeleteFileW(wide);
}
#else
typedef int hnbrdf_files_windows_unused; /* C has no empty files */
#endif
