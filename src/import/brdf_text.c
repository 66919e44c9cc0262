/* brdf_text.c: cut a .brdf file into words. */
#include "import/brdf_text.h"

#include "base/error.h"
#include "base/text.h"

#include <string.h>

enum { MAX_SHOWN = 40 };

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static int is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static int is_space(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* The character `ahead` behind this place; 0 beyond the end. */
static char look(const hnbrdf_words *words, int ahead)
{
    return words->end - words->at > ahead ? words->at[ahead] : '\0';
}

static void skip_line(hnbrdf_words *words)
{
    while (words->at < words->end && *words->at != '\n')
        ++words->at;
}

static void skip_block(hnbrdf_words *words)
{
    words->at += 2;
    while (words->at < words->end && !(look(words, 0) == '*' && look(words, 1) == '/')) {
        words->line += *words->at == '\n';
        ++words->at;
    }
    words->at += words->at < words->end ? 2 : 0;
}

static void skip_space(hnbrdf_words *words)
{
    while (words->at < words->end) {
        const char c = *words->at;
        if (is_space(c)) {
            words->line += c == '\n';
            ++words->at;
        } else if (c == '#' || (c == '/' && look(words, 1) == '/')) {
            skip_line(words);
        } else if (c == '/' && look(words, 1) == '*') {
            skip_block(words);
        } else {
            return;
        }
    }
}

/* A number that float cannot hold stays a mark, which no grammar expects. */
static void scan_number(hnbrdf_words *words)
{
    const char *stop = hnbrdf_parse_float(words->at, words->end, &words->number);
    if (stop) {
        words->kind = HNBRDF_WORD_NUMBER;
        words->at = stop;
        words->at += look(words, 0) == 'f' || look(words, 0) == 'F';
    } else {
        ++words->at;
    }
}

void hnbrdf_words_next(hnbrdf_words *words)
{
    skip_space(words);
    words->begin = words->at;
    words->kind = HNBRDF_WORD_MARK;
    if (words->at == words->end) {
        words->kind = HNBRDF_WORD_END;
    } else if (is_letter(*words->at)) {
        words->kind = HNBRDF_WORD_NAME;
        while (is_letter(look(words, 0)) || is_digit(look(words, 0)))
            ++words->at;
    } else if (is_digit(*words->at) || (*words->at == '.' && is_digit(look(words, 1)))) {
        scan_number(words);
    } else {
        ++words->at;
    }
    words->stop = words->at;
}

void hnbrdf_words_begin(hnbrdf_words *words, const char *file, const char *text, size_t size)
{
    words->file = file;
    words->at = text;
    words->end = text + size;
    words->line = 1;
    words->number = 0;
    hnbrdf_words_next(words);
}

int hnbrdf_words_at(const hnbrdf_words *words, const char *text)
{
    const size_t length = strlen(text);
    return words->kind != HNBRDF_WORD_END && (size_t)(words->stop - words->begin) == length &&
           memcmp(words->begin, text, length) == 0;
}

int hnbrdf_words_take(hnbrdf_words *words, const char *text)
{
    if (!hnbrdf_words_at(words, text))
        return 0;
    hnbrdf_words_next(words);
    return 1;
}

int hnbrdf_words_take_number(hnbrdf_words *words, float *number)
{
    int negative = 0;
    while (hnbrdf_words_at(words, "-") || hnbrdf_words_at(words, "+")) {
        negative ^= hnbrdf_words_at(words, "-");
        hnbrdf_words_next(words);
    }
    if (words->kind != HNBRDF_WORD_NUMBER)
        return 0;
    *number = negative ? -words->number : words->number;
    hnbrdf_words_next(words);
    return 1;
}

hnbrdf_result hnbrdf_words_fail(const hnbrdf_words *words, const char *expected,
                                hnbrdf_error *error)
{
    const ptrdiff_t length = words->stop - words->begin;
    if (words->kind == HNBRDF_WORD_END) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: line %d: the text ends, expected %s",
                           words->file, words->line, expected);
    }
    if (words->kind == HNBRDF_WORD_MARK && (*words->begin <= 0x20 || *words->begin >= 0x7f)) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: line %d: found byte 0x%02x, expected %s", words->file, words->line,
                           (unsigned)(unsigned char)*words->begin, expected);
    }
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: line %d: found %.*s, expected %s",
                       words->file, words->line,
                       (int)(length < MAX_SHOWN ? length : (ptrdiff_t)MAX_SHOWN), words->begin,
                       expected);
}
