/* obj_reader.h: what the files of the OBJ reader share: lines and words, faces, notes. Inside the
 * reader only. */
#ifndef HNBRDF_SCENE_OBJ_READER_H
#define HNBRDF_SCENE_OBJ_READER_H

#include "scene/obj.h"

/* ---- Lines and words ------------------------------------------------------------------------- */

typedef struct obj_lines {
    const char *at, *end;    /* what is left of the statement, a comment gone */
    const char *next, *last; /* the lines after it, and their end */
    const char *name;        /* of the file */
    long line, next_line;
    hnbrdf_error *error;
} obj_lines;

/* Before the first line, behind a byte-order mark. */
void obj_lines_begin(obj_lines *in, const void *data, size_t size, const char *name,
                     hnbrdf_error *error);
/* Steps to the next line; a backslash before its end joins the one after it. 0 at the end. */
int obj_next_line(obj_lines *in);
int obj_is_blank(char c);
/* Steps over blanks; 0 at the end of the line. */
int obj_skip_blanks(obj_lines *in);
/* The next word: its start, *length bytes; NULL at the end of the line. */
const char *obj_word(obj_lines *in, size_t *length);
int obj_is_word(const char *start, size_t length, const char *expected);
/* Numbers up to 1e30 in size: at least `least`, at most `most` where there are as many; the others
 * become 0. NaN for nan and inf, however they are spelt, and what is larger. */
hnbrdf_result obj_numbers(obj_lines *in, const char *what, int least, int most, double *values);
/* Fails with file and line before the text. */
hnbrdf_result obj_bad(const obj_lines *in, hnbrdf_result result, const char *what);
hnbrdf_result obj_no_memory(const obj_lines *in);
/* At most 40 bytes of the rest of the line, for "%.*s". */
int obj_rest(const obj_lines *in);

/* ---- Notes ----------------------------------------------------------------------------------- */

typedef enum obj_note {
    OBJ_NORMAL_ABSENT,  /* named by a face, but not in the file */
    OBJ_NORMAL_WITHOUT, /* a face has none; told if others have */
    OBJ_NORMAL_UNUSABLE,
    OBJ_UV_ABSENT,
    OBJ_UV_WITHOUT,
    OBJ_UV_UNUSABLE,
    OBJ_FACE_SHORT,
    OBJ_LINES,
    OBJ_FREE_FORM,
    OBJ_UNKNOWN,
    OBJ_NOTES
} obj_note;

/* Zero-initialise. */
typedef struct obj_tally {
    size_t count;
    long line;      /* of the first */
    char found[41]; /* there; "" for what needs none */
} obj_tally;

/* Counts one more of that kind, at this line; found: of so many bytes. */
void obj_count(obj_tally *tally, const obj_lines *in, const char *found, int length);
/* Tells a line for each kind that was counted. */
void obj_tell(const obj_tally tallies[OBJ_NOTES], const char *name, const hnbrdf_notes *notes);

/* ---- The file -------------------------------------------------------------------------------- */

typedef struct obj_corner {
    uint32_t position, uv, normal;
} obj_corner;

/* Vertices, normals and texture coordinates are read first, then the faces. What is no number has
 * NaN for its first one. */
typedef struct obj_reader {
    obj_lines in;
    double (*positions)[3];
    size_t position_count, position_room;
    render_mesh *mesh; /* but for its positions */
    /* Those above the line that is read: what negative indices count back from. */
    size_t positions_above, normals_above, uvs_above;
    size_t max_triangles;
    uint32_t part;
    int has_usemtl, has_normals, has_uvs; /* a face with normals, texture coordinates was read */
    size_t faces;
    obj_corner *corners; /* of one face, with its positions and triangles: room for corner_room */
    double (*outline)[3];
    uint32_t (*triangles)[3];
    uint32_t corner_room;
    obj_tally tallies[OBJ_NOTES];
} obj_reader;

/* The rest of a line that begins with "f". */
hnbrdf_result obj_read_face(obj_reader *r);

#endif
