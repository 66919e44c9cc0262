/* export_filter.h: what an exported text goes through on its way to the caller: names with another
 * prefix, and no comments. Each is an hnbrdf_write_fn that writes to the next one. */
#ifndef HNBRDF_GLSL_EXPORT_FILTER_H
#define HNBRDF_GLSL_EXPORT_FILTER_H

#include "hnbrdf/hnbrdf.h"

enum { HNBRDF_MAX_PREFIX = 40, HNBRDF_FILTER_WORD = 64 };

/* 1 for a letter, then letters, digits and single underscores, not at the end, at most
 * HNBRDF_MAX_PREFIX; what begins with gl or hnbrdf_ belongs to others. */
int hnbrdf_prefix_is_valid(const char *prefix);

/* Set write, user and prefix, all else zero. */
typedef struct hnbrdf_renamer {
    hnbrdf_write_fn write;
    void *user;
    const char *prefix;
    char word[HNBRDF_FILTER_WORD]; /* begun at the end of what was read last */
    size_t size;
    int passing; /* 1 in a word whose beginning was written */
} hnbrdf_renamer;

/* Words that begin with hnbrdf_ or HNBRDF_ get the prefix instead, in capitals for HNBRDF_, but for
 * those that hybrid_brdf.glsl has too and the switches that all scenes of a shader share. */
int hnbrdf_rename(void *renamer, const void *data, size_t size);
int hnbrdf_rename_end(hnbrdf_renamer *renamer);

/* Set write and user, all else zero. */
typedef struct hnbrdf_stripper {
    hnbrdf_write_fn write;
    void *user;
    size_t blanks;  /* held back: they may be the end of a line */
    int slash;      /* 1: one is held back, it may begin a comment */
    int in_comment; /* to the end of the line */
    int written;    /* 1: something of this line was */
} hnbrdf_stripper;

/* Leaves out comments, blanks at ends of lines and empty lines. */
int hnbrdf_strip(void *stripper, const void *data, size_t size);

#endif
