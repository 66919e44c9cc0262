/* token.h: a shader text as words, numbers, signs and comments. */
#ifndef HNBRDF_LANGUAGE_TOKEN_H
#define HNBRDF_LANGUAGE_TOKEN_H

#include <stddef.h>

/* Characters of a text that somebody else keeps. */
typedef struct hnbrdf_span {
    const char *at;
    size_t size;
} hnbrdf_span;

typedef enum hnbrdf_token_kind {
    HNBRDF_TOKEN_END = 0,
    HNBRDF_TOKEN_NAME,
    HNBRDF_TOKEN_NUMBER,
    HNBRDF_TOKEN_SIGN,    /* an operator or a bracket, the longest there is */
    HNBRDF_TOKEN_COMMENT, /* whole, without the end of its line */
    HNBRDF_TOKEN_ODD,     /* what is none of these, one character */
    /* What the preprocessor leaves of directives: */
    HNBRDF_TOKEN_CONSTANT,     /* "#define NAME": then its numbers and signs ... */
    HNBRDF_TOKEN_CONSTANT_END, /* ... up to here; none: it is only defined */
    HNBRDF_TOKEN_GUARD,        /* "#ifndef NAME" and "#define NAME" around the whole text ... */
    HNBRDF_TOKEN_GUARD_END,    /* ... and its "#endif" */
    HNBRDF_TOKEN_CHECK         /* "#ifndef NAME", "#error ...": a NAME token with the message */
} hnbrdf_token_kind;

typedef struct hnbrdf_token {
    hnbrdf_span text;
    int line;
    unsigned char kind;
    unsigned char source;      /* number of the text it is from */
    unsigned char own_line;    /* 1: the first of its line */
    unsigned char after_blank; /* 1: empty lines stand before it */
} hnbrdf_token;

/* Reads a text token by token; start with everything from `line` on zero but line 1, own_line 1. */
typedef struct hnbrdf_lexer {
    const char *at, *end;
    int line;
    unsigned char source, own_line, after_blank;
} hnbrdf_lexer;

/* The next token; HNBRDF_TOKEN_END at the end, again and again. */
hnbrdf_token hnbrdf_lex(hnbrdf_lexer *lexer);

/* The rest of the line as it is, without what surrounds it; for what directives say. */
hnbrdf_span hnbrdf_lex_line(hnbrdf_lexer *lexer);

int hnbrdf_span_is(hnbrdf_span span, const char *text);
int hnbrdf_span_same(hnbrdf_span a, hnbrdf_span b);
int hnbrdf_span_ends(hnbrdf_span span, const char *ending);

/* For "%.*s". */
#define HNBRDF_SPAN(span) (int)(span).size, (span).at

#endif
