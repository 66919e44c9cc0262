/* translation.c: what all steps of a translation share: the first failure, lists of tokens. */
#include "language/translation.h"

#include "base/error.h"
#include "base/memory.h"
#include "language/print.h"

#include <string.h>

const char *hnbrdf_dialect_name(const hnbrdf_dialect *dialect)
{
    return dialect->name;
}

void hnbrdf_refuse(hnbrdf_translation *t, const hnbrdf_token *at, const char *format, ...)
{
    hnbrdf_error found;
    if (t->result)
        return;
    va_list arguments;
    va_start(arguments, format);
    hnbrdf_error_print(&found, format, arguments);
    va_end(arguments);
    t->result = hnbrdf_fail(t->error, HNBRDF_ERROR_FORMAT, "%s, line %d, as %s: %.180s",
                            t->sources[at->source].name, at->line, t->dialect->name, found.text);
}

void hnbrdf_refuse_memory(hnbrdf_translation *t, size_t size)
{
    if (!t->result)
        t->result = hnbrdf_fail_memory(t->error, size, "a translation");
}

void hnbrdf_add_token(hnbrdf_translation *t, hnbrdf_tokens *tokens, const hnbrdf_token *token)
{
    if (tokens->count == tokens->room) {
        const size_t room = tokens->room ? 2 * tokens->room : 64;
        hnbrdf_token *list = (hnbrdf_token *)hnbrdf_allocate(t->memory, room * sizeof *list);
        if (!list) {
            hnbrdf_refuse_memory(t, room * sizeof *list);
            return;
        }
        if (tokens->count > 0)
            memcpy(list, tokens->list, tokens->count * sizeof *list);
        hnbrdf_release(t->memory, tokens->list);
        tokens->list = list;
        tokens->room = room;
    }
    tokens->list[tokens->count++] = *token;
}
