/* translation.h: what all steps of a translation share: texts, tokens, nodes, the first error. */
#ifndef HNBRDF_LANGUAGE_TRANSLATION_H
#define HNBRDF_LANGUAGE_TRANSLATION_H

#include "language/language.h"
#include "language/token.h"

typedef struct hnbrdf_tokens {
    hnbrdf_token *list;
    size_t count, room;
} hnbrdf_tokens;

typedef struct hnbrdf_translation {
    const hnbrdf_source *sources;
    int count;
    const hnbrdf_dialect *dialect;
    int exact;
    const hnbrdf_allocator *memory;
    hnbrdf_error *error;
    hnbrdf_result result; /* the first failure; nothing that is done after it counts */
    hnbrdf_tokens tokens; /* of all texts, without directives, macros replaced */
    struct hnbrdf_node *nodes;
    size_t node_count, node_room;
} hnbrdf_translation;

/* Notes the first failure, with the text and the line of this token. */
#if defined(__GNUC__) && !defined(__MINGW32__)
__attribute__((format(printf, 3, 4)))
#endif
void hnbrdf_refuse(hnbrdf_translation *t, const hnbrdf_token *at, const char *format, ...);
void hnbrdf_refuse_memory(hnbrdf_translation *t, size_t size);

/* Adds one at the end, but for lack of memory. */
void hnbrdf_add_token(hnbrdf_translation *t, hnbrdf_tokens *tokens, const hnbrdf_token *token);

#endif
