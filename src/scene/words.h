/* words.h: lines of a scene as text, cut into words, and what the words mean. Inside describe
 * only. */
#ifndef HNBRDF_SCENE_WORDS_H
#define HNBRDF_SCENE_WORDS_H

#include "scene/describe.h"

#include "base/error.h"

enum { WORDS_MAX = 256, WORDS_LINE = 8192 };
#define WORDS_FAR 1e6 /* largest coordinate */

typedef struct words {
    const char *name;
    long line;
    char text[WORDS_LINE];
    char *words[WORDS_MAX];
    int count, at; /* at: the next one to be taken */
    int has_camera;
    render_description *out;
    hnbrdf_error *error;
} words;

#define BAD(in, ...) hnbrdf_fail((in)->error, HNBRDF_ERROR_FORMAT, __VA_ARGS__)

/* Cuts in->text into words, in place. */
hnbrdf_result words_split(words *in);
/* 1, and steps over it, if the next word is this one. */
int words_take(words *in, const char *word);
/* Each takes what it is named after or refuses the line; `what` is used in messages. */
hnbrdf_result words_number(words *in, const char *what, double low, double high, double *value);
hnbrdf_result words_numbers(words *in, const char *what, double low, double high, int count,
                            double *values);
hnbrdf_result words_vector(words *in, const char *what, double low, double high, float v[3]);
hnbrdf_result words_whole(words *in, const char *what, int low, int high, int *value);
hnbrdf_result words_text(words *in, const char *what, size_t room, char *to);
/* Refuses the next word. */
hnbrdf_result words_unknown(const words *in, const char *expected);
static inline hnbrdf_result words_no_memory(const words *in)
{
    return hnbrdf_fail(in->error, HNBRDF_ERROR_MEMORY, "%s:%ld: no memory for what was read so far",
                       in->name, in->line);
}

/* Number of the material of that name so far, or -1. */
int describe_find_material(const render_description *out, const char *name);
/* Room for one more element of an array that doubles at powers of two; NULL when memory is out. */
void *describe_grown(void *array, int count, size_t element);
/* The rest of a line that begins with "shape". */
hnbrdf_result describe_shape(words *in);

#endif
