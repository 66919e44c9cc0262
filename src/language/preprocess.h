/* preprocess.h: directives and macros of a shader text, resolved. */
#ifndef HNBRDF_LANGUAGE_PREPROCESS_H
#define HNBRDF_LANGUAGE_PREPROCESS_H

#include "language/translation.h"

enum { HNBRDF_MACRO_BUCKETS = 256, HNBRDF_MACRO_PARAMETERS = 4, HNBRDF_NESTED = 16 };

/* A macro; its body is body_count tokens of the macros' own list, from `body` on. */
typedef struct hnbrdf_macro {
    hnbrdf_span name;
    size_t body, body_count;
    hnbrdf_span parameters[HNBRDF_MACRO_PARAMETERS];
    int parameter_count; /* -1: not like a function */
    int constant;        /* 1: stands for a number and stays in the code by its name */
    int busy;            /* 1: being replaced, which its own name inside of it is not */
    int removed;
    size_t next; /* in its bucket, plus one */
} hnbrdf_macro;

/* One #if: whether its lines count, and whether any branch has counted. */
typedef struct hnbrdf_branch {
    int active, taken, guard;
    hnbrdf_span asked; /* NAME of #ifndef NAME */
} hnbrdf_branch;

typedef struct hnbrdf_preprocessor {
    hnbrdf_translation *t;
    hnbrdf_macro *macros;
    size_t macro_count, macro_room;
    size_t buckets[HNBRDF_MACRO_BUCKETS]; /* plus one; 0: none */
    hnbrdf_tokens bodies;
    hnbrdf_branch branches[HNBRDF_NESTED];
    int depth;
    int after_blank;  /* empty lines beside directives that went */
    size_t tentative; /* comments from here on go if an empty line follows, plus one; 0: none */
} hnbrdf_preprocessor;

/* All texts into t->tokens. */
void hnbrdf_preprocess(hnbrdf_translation *t);

/* ---- Between the files of this step ---------------------------------------------------------- */

hnbrdf_macro *hnbrdf_find_macro(hnbrdf_preprocessor *p, hnbrdf_span name);
/* "NAME 3" or "NAME(x) f(x)" of a #define; its name is `name`. */
void hnbrdf_define(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *name);
/* Adds these tokens with macros replaced; in conditions those of constants too. */
void hnbrdf_expand(hnbrdf_preprocessor *p, hnbrdf_tokens *to, const hnbrdf_token *from,
                   size_t count, int constants);
/* The value of a condition; refuses what it does not know. */
long hnbrdf_condition(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *directive);

#endif
