/* files_system.h: what files.c asks of the system. For files.c, files_posix.c and files_windows.c
 * alone. Functions that return 0 for failure set errno. */
#ifndef HNBRDF_BASE_FILES_SYSTEM_H
#define HNBRDF_BASE_FILES_SYSTEM_H

#include "base/files.h"

typedef enum hnbrdf_system_answer {
    HNBRDF_SYSTEM_DONE,
    HNBRDF_SYSTEM_TAKEN, /* another name is worth a try */
    HNBRDF_SYSTEM_FAILED
} hnbrdf_system_answer;

/* How much of the path is its folder: up to the last separator, which counts only at a root. */
size_t hnbrdf_system_folder_length(const char *path);
/* NULL for failure. */
FILE *hnbrdf_system_open(const char *path, int writing);

/* 1 for what exists and is neither a file nor a folder: /dev/null must not be replaced. */
int hnbrdf_system_is_written_directly(const char *path);
/* 1 for an open terminal, /dev/zero, a disk: what is neither a file nor a pipe. */
int hnbrdf_system_is_device(FILE *file);
int hnbrdf_system_may_write(const char *path);
/* Fills target, replaces, mode, user and group from path. */
int hnbrdf_system_find_target(hnbrdf_output *output);
/* Opens output->aside, which must be nobody's: stream and lock. */
hnbrdf_system_answer hnbrdf_system_open_aside(hnbrdf_output *output);
/* Before the stream is closed: mode and owner. */
int hnbrdf_system_settle(hnbrdf_output *output);
/* After it: aside becomes target. */
int hnbrdf_system_replace(hnbrdf_output *output);
void hnbrdf_system_unlock(hnbrdf_output *output);
void hnbrdf_system_remove(const char *path);

#endif
