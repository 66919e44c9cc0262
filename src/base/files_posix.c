/* files_posix.c: what files.c asks of a POSIX system.
 *
 * A file aside is locked (flock) as long as its writer lives. One that is there and not locked was
 * left by a process that was killed. The lock is held beyond the renaming, so that nobody takes a
 * finished file that still has the name aside for such a leftover. */
#ifndef _WIN32
#define _POSIX_C_SOURCE 200809L
#define _DEFAULT_SOURCE /* flock */
#define _DARWIN_C_SOURCE
#include "base/files_system.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_LINKS = 40 };

size_t hnbrdf_system_folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return !slash ? 0 : slash == path ? 1 : (size_t)(slash - path);
}

FILE *hnbrdf_system_open(const char *path, int writing)
{
    return fopen(path, writing ? "wb" : "rb");
}

int hnbrdf_system_is_written_directly(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

int hnbrdf_system_is_device(FILE *file)
{
    struct stat status;
    return fstat(fileno(file), &status) == 0 &&
           (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode));
}

int hnbrdf_system_may_write(const char *path)
{
    return access(path, W_OK) == 0;
}

/* Puts what the link at target names into target: 1, 0 if it is no link, -1 for failure. */
static int follow(char target[HNBRDF_PATH_SIZE])
{
    struct stat status;
    char named[HNBRDF_PATH_SIZE];
    if (lstat(target, &status) != 0 || !S_ISLNK(status.st_mode))
        return 0;
    const ssize_t length = readlink(target, named, sizeof named);
    if (length < 0)
        return -1;
    const char *slash = strrchr(target, '/');
    const size_t kept = length > 0 && named[0] == '/' ? 0
                        : slash                       ? (size_t)(slash + 1 - target)
                                                      : 0;
    if (kept + (size_t)length >= HNBRDF_PATH_SIZE) {
        errno = ENAMETOOLONG;
        return -1;
    }
    memcpy(target + kept, named, (size_t)length);
    target[kept + (size_t)length] = '\0';
    return 1;
}

int hnbrdf_system_find_target(hnbrdf_output *output)
{
    struct stat status;
    int followed = 1;
    strcpy(output->target, output->path);
    for (int k = 0; k < MAX_LINKS && followed == 1; ++k)
        followed = follow(output->target);
    if (followed == 1)
        errno = ELOOP;
    if (followed)
        return 0;
    if (stat(output->target, &status) != 0)
        return 1; /* a new file */
    if (S_ISDIR(status.st_mode)) {
        errno = EISDIR;
        return 0;
    }
    /* Renaming asks the folder alone, but whoever made a file read-only wants to keep it. */
    if (access(output->target, W_OK) != 0)
        return 0;
    output->replaces = 1;
    output->mode = status.st_mode & 07777;
    output->user = status.st_uid;
    output->group = status.st_gid;
    return 1;
}

/* 1 if the descriptor is the regular file of this name, and ours. */
static int is_here(int descriptor, const char *path)
{
    struct stat open_one, named;
    return fstat(descriptor, &open_one) == 0 && lstat(path, &named) == 0 &&
           S_ISREG(named.st_mode) && open_one.st_dev == named.st_dev &&
           open_one.st_ino == named.st_ino && open_one.st_uid == geteuid();
}

/* Removes the file aside if its writer is gone. */
static int remove_leftover(const char *aside)
{
    const int descriptor = open(aside, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        return 0;
    const int gone = flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_here(descriptor, aside) &&
                     unlink(aside) == 0;
    close(descriptor);
    return gone;
}

/* A file system without locks: the name alone has to do. */
static int lock(int descriptor)
{
    return flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

hnbrdf_system_answer hnbrdf_system_open_aside(hnbrdf_output *output)
{
    const int flags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
    const mode_t mode = output->replaces ? 0600 : 0666;
    int descriptor = open(output->aside, flags, mode);
    if (descriptor < 0 && errno == EEXIST) {
        const int removed = remove_leftover(output->aside);
        errno = EEXIST;
        descriptor = removed ? open(output->aside, flags, mode) : -1;
    }
    if (descriptor < 0) {
        const hnbrdf_system_answer answer =
            errno == EEXIST ? HNBRDF_SYSTEM_TAKEN : HNBRDF_SYSTEM_FAILED;
        output->aside[0] = '\0'; /* not ours to remove */
        return answer;
    }
    if (!lock(descriptor) || !is_here(descriptor, output->aside)) {
        close(descriptor); /* who took it for a leftover removes it */
        output->aside[0] = '\0';
        return HNBRDF_SYSTEM_TAKEN;
    }
    output->lock = fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
    output->stream = output->lock < 3 ? NULL : fdopen(descriptor, "wb");
    if (output->stream)
        return HNBRDF_SYSTEM_DONE;
    const int number = errno;
    close(descriptor);
    hnbrdf_system_unlock(output);
    unlink(output->aside);
    output->aside[0] = '\0';
    errno = number;
    return HNBRDF_SYSTEM_FAILED;
}

/* Where the group cannot stay, it gets no more than everybody. */
int hnbrdf_system_settle(hnbrdf_output *output)
{
    if (!output->replaces)
        return 1;
    struct stat status;
    unsigned mode = output->mode;
    if (fstat(output->lock, &status) != 0)
        return 0;
    if (status.st_uid != output->user && fchown(output->lock, (uid_t)output->user, (gid_t)-1) != 0)
        mode &= ~(unsigned)S_ISUID;
    if (status.st_gid != output->group &&
        fchown(output->lock, (uid_t)-1, (gid_t)output->group) != 0)
        mode = (mode & ~(unsigned)(S_ISGID | 070)) | (mode & (mode << 3) & 070);
    return fchmod(output->lock, (mode_t)mode) == 0;
}

int hnbrdf_system_replace(hnbrdf_output *output)
{
    return rename(output->aside, output->target) == 0;
}

void hnbrdf_system_unlock(hnbrdf_output *output)
{
    if (output->lock > 0)
        close(output->lock);
    output->lock = 0;
}

void hnbrdf_system_remove(const char *path)
{
    unlink(path);
}
#else
typedef int hnbrdf_files_posix_unused; /* C has no empty files */
#endif
