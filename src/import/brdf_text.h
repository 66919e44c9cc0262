/* brdf_text.h: the words of a BRDF-Explorer .brdf file: parameter lines and GLSL. Comments, from
 * # or // to the end of the line and between slash-star and star-slash, are skipped like white
 * space. */
#ifndef HNBRDF_IMPORT_BRDF_TEXT_H
#define HNBRDF_IMPORT_BRDF_TEXT_H

#include "hnbrdf/hnbrdf.h"

typedef enum hnbrdf_word_kind {
    HNBRDF_WORD_END = 0,
    HNBRDF_WORD_NAME,
    HNBRDF_WORD_NUMBER, /* without sign */
    HNBRDF_WORD_MARK    /* any other single character */
} hnbrdf_word_kind;

/* Reads ahead by one word. A copy remembers a place to return to. */
typedef struct hnbrdf_words {
    const char *file; /* for messages */
    const char *at, *end;
    int line; /* of the word, from 1 */
    hnbrdf_word_kind kind;
    const char *begin, *stop; /* the word's characters */
    float number;
} hnbrdf_words;

/* Places itself at the first word. */
void hnbrdf_words_begin(hnbrdf_words *words, const char *file, const char *text, size_t size);
/* To the next word. */
void hnbrdf_words_next(hnbrdf_words *words);
/* 1 if this word is `text`. */
int hnbrdf_words_at(const hnbrdf_words *words, const char *text);
/* Moves on and returns 1 if this word is `text`. */
int hnbrdf_words_take(hnbrdf_words *words, const char *text);
/* A number with any signs before it. Returns 0 if there is none. */
int hnbrdf_words_take_number(hnbrdf_words *words, float *number);

/* "FILE: line N: found WORD, expected ..."; returns HNBRDF_ERROR_FORMAT. */
hnbrdf_result hnbrdf_words_fail(const hnbrdf_words *words, const char *expected,
                                hnbrdf_error *error);

#endif
