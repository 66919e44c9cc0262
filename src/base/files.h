/* files.h: files by UTF-8 paths. Every file is written aside and renamed when it is complete, so
 * that its name never stands for a part of it. Nothing here allocates memory. */
#ifndef HNBRDF_BASE_FILES_H
#define HNBRDF_BASE_FILES_H

#include "hnbrdf/hnbrdf.h"

#include <stdio.h>

enum { HNBRDF_PATH_SIZE = 4096 }; /* bytes of the longest path that can be written, with its NUL */

/* What the file is called while it is written: PATH and this, then a number if that is taken. */
#define HNBRDF_ASIDE ".hnbrdf-part"

/* A file on its way. The caller writes to `stream`; the rest belongs to the functions below. */
typedef struct hnbrdf_output {
    FILE *stream; /* NULL: not open */
    int lock;     /* a descriptor that holds the lock of the file aside; 0 without one */
    int replaces; /* 1: mode and owner of the file there before are kept */
    unsigned mode, user, group;
    char path[HNBRDF_PATH_SIZE];   /* as given, for messages */
    char target[HNBRDF_PATH_SIZE]; /* what is replaced: the path, or what the symbolic link names */
    char aside[HNBRDF_PATH_SIZE];  /* "": a pipe or a device, which is written as it is */
} hnbrdf_output;

/* Opens the file aside, in the folder of the file it will replace. Until hnbrdf_output_close() has
 * succeeded the old file stays as it is.
 * A file that may not be written is refused, though its folder would allow to replace it.
 * A symbolic link stays, the file it names is replaced; of a file with several names (hard links)
 * the others keep what was there. A replaced file keeps its mode and, as far
 * as the process may, its owner; a new one gets 0666 without the process's umask. Processes or
 * threads that write one file at the same time write different files aside; the last to close
 * wins. What a killed process left aside is removed. A pipe or device is opened and written
 * directly. */
hnbrdf_result hnbrdf_output_open(const char *path, hnbrdf_output *output, hnbrdf_error *error);
/* Flushes, checks and renames. On failure the old file is as it was and nothing is left aside.
 * Closed in either case. */
hnbrdf_result hnbrdf_output_close(hnbrdf_output *output, hnbrdf_error *error);
/* Drops what was written. An output that is not open is allowed. */
void hnbrdf_output_discard(hnbrdf_output *output);

/* Whether the path could be written to now, for commands to ask before hours of work. Leaves
 * nothing behind. */
hnbrdf_result hnbrdf_output_check(const char *path, hnbrdf_error *error);

/* All of the above for bytes in memory. */
hnbrdf_result hnbrdf_write_file(const char *path, const void *data, size_t size,
                                hnbrdf_error *error);
/* An hnbrdf_write_fn whose `user` is a FILE. */
int hnbrdf_write_stream(void *file, const void *data, size_t size);

/* Opens a file to read its bytes; NULL if that fails, errno says why. */
FILE *hnbrdf_open_to_read(const char *path);
/* The same for a file that is read whole, with a message that begins with LABEL and holds what
 * errno says, in no locale's words. Devices are refused: a terminal or /dev/zero has no end. */
FILE *hnbrdf_open_whole(const char *path, const char *label, hnbrdf_error *error);

#endif
