/* macro.c: macros of a shader text, and what they stand for. */
#include "language/preprocess.h"

#include "base/hash.h"
#include "base/memory.h"

#include <string.h>

/* ---- Finding and adding ---------------------------------------------------------------------- */

static size_t *bucket_of(hnbrdf_preprocessor *p, hnbrdf_span name)
{
    return &p->buckets[hnbrdf_hash32(HNBRDF_HASH32_START, name.at, name.size) %
                       HNBRDF_MACRO_BUCKETS];
}

hnbrdf_macro *hnbrdf_find_macro(hnbrdf_preprocessor *p, hnbrdf_span name)
{
    for (size_t k = *bucket_of(p, name); k > 0; k = p->macros[k - 1].next)
        if (!p->macros[k - 1].removed && hnbrdf_span_same(p->macros[k - 1].name, name))
            return &p->macros[k - 1];
    return NULL;
}

/* A new one, or NULL for lack of memory. */
static hnbrdf_macro *add_macro(hnbrdf_preprocessor *p, hnbrdf_span name)
{
    if (p->macro_count == p->macro_room) {
        const size_t room = p->macro_room ? 2 * p->macro_room : 64;
        hnbrdf_macro *macros = (hnbrdf_macro *)hnbrdf_allocate(p->t->memory, room * sizeof *macros);
        if (!macros) {
            hnbrdf_refuse_memory(p->t, room * sizeof *macros);
            return NULL;
        }
        if (p->macro_count > 0)
            memcpy(macros, p->macros, p->macro_count * sizeof *macros);
        hnbrdf_release(p->t->memory, p->macros);
        p->macros = macros;
        p->macro_room = room;
    }
    size_t *bucket = bucket_of(p, name);
    hnbrdf_macro *macro = &p->macros[p->macro_count++];
    *macro = (hnbrdf_macro){.name = name, .parameter_count = -1, .next = *bucket};
    *bucket = p->macro_count;
    return macro;
}

/* Only numbers, signs of arithmetic and names of other constants: stays in the code by its name. */
static int is_constant(hnbrdf_preprocessor *p, const hnbrdf_macro *macro)
{
    if (macro->parameter_count >= 0)
        return 0;
    for (size_t k = 0; k < macro->body_count; k++) {
        const hnbrdf_token *token = &p->bodies.list[macro->body + k];
        const hnbrdf_macro *other =
            token->kind == HNBRDF_TOKEN_NAME ? hnbrdf_find_macro(p, token->text) : NULL;
        if (token->kind != HNBRDF_TOKEN_NUMBER && !(other && other->constant) &&
            !(token->kind == HNBRDF_TOKEN_SIGN && strchr("+-*/()", token->text.at[0])))
            return 0;
    }
    return macro->body_count > 0;
}

/* "(a, b)" directly behind the name. */
static void read_parameters(hnbrdf_preprocessor *p, hnbrdf_lexer *line, hnbrdf_macro *macro)
{
    macro->parameter_count = 0;
    hnbrdf_lex(line); /* the bracket */
    for (;;) {
        const hnbrdf_token name = hnbrdf_lex(line), after = hnbrdf_lex(line);
        if (name.kind != HNBRDF_TOKEN_NAME || macro->parameter_count == HNBRDF_MACRO_PARAMETERS) {
            hnbrdf_refuse(p->t, &name, "a macro with %s, expected 1 to %d parameters",
                          name.kind == HNBRDF_TOKEN_NAME ? "more" : "none",
                          HNBRDF_MACRO_PARAMETERS);
            return;
        }
        macro->parameters[macro->parameter_count++] = name.text;
        if (hnbrdf_span_is(after.text, ")"))
            return;
        if (!hnbrdf_span_is(after.text, ",")) {
            hnbrdf_refuse(p->t, &after, "found '%.*s', expected ',' or ')'",
                          HNBRDF_SPAN(after.text));
            return;
        }
    }
}

void hnbrdf_define(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *name)
{
    if (hnbrdf_find_macro(p, name->text)) {
        hnbrdf_refuse(p->t, name, "%.*s is defined already", HNBRDF_SPAN(name->text));
        return;
    }
    hnbrdf_macro *macro = add_macro(p, name->text);
    if (!macro)
        return;
    if (line->at < line->end && *line->at == '(')
        read_parameters(p, line, macro);
    macro->body = p->bodies.count;
    for (hnbrdf_token token = hnbrdf_lex(line); token.kind != HNBRDF_TOKEN_END && !p->t->result;
         token = hnbrdf_lex(line))
        if (token.kind != HNBRDF_TOKEN_COMMENT) {
            hnbrdf_add_token(p->t, &p->bodies, &token);
            macro->body_count++;
        }
    if (!p->t->result)
        macro->constant = is_constant(p, macro);
}

/* ---- Replacing ------------------------------------------------------------------------------- */

/* Tokens of one argument, `from` and the others being a list. */
typedef struct argument {
    const hnbrdf_token *from;
    size_t count;
} argument;

/* Reads "(a, b)" at `from`; returns how many tokens that was, 0 after a refusal. */
static size_t read_arguments(hnbrdf_preprocessor *p, const hnbrdf_macro *macro,
                             const hnbrdf_token *from, size_t count, argument *arguments)
{
    int open = 0, found = 0;
    size_t begin = 1;
    for (size_t k = 0; k < count; k++) {
        const hnbrdf_span sign = from[k].text;
        const int closes = hnbrdf_span_is(sign, ")");
        open += hnbrdf_span_is(sign, "(") - closes;
        if (from[k].kind != HNBRDF_TOKEN_SIGN ||
            !((open == 0 && closes) || (open == 1 && hnbrdf_span_is(sign, ","))))
            continue;
        if (found < HNBRDF_MACRO_PARAMETERS)
            arguments[found] = (argument){from + begin, k - begin};
        found++;
        begin = k + 1;
        if (open == 0) {
            if (found == macro->parameter_count)
                return k + 1;
            break;
        }
    }
    hnbrdf_refuse(p->t, from, "%.*s takes %d arguments, found %s", HNBRDF_SPAN(macro->name),
                  macro->parameter_count, open > 0 ? "no end of them" : "another number");
    return 0;
}

/* Its body with arguments in the place of parameters. */
static void substitute(hnbrdf_preprocessor *p, hnbrdf_tokens *to, const hnbrdf_macro *macro,
                       const argument *arguments, int constants)
{
    for (size_t k = 0; k < macro->body_count && !p->t->result; k++) {
        const hnbrdf_token token = p->bodies.list[macro->body + k];
        int parameter = 0;
        while (parameter < macro->parameter_count &&
               !hnbrdf_span_same(macro->parameters[parameter], token.text))
            parameter++;
        if (parameter < macro->parameter_count)
            hnbrdf_expand(p, to, arguments[parameter].from, arguments[parameter].count, constants);
        else
            hnbrdf_add_token(p->t, to, &token);
    }
}

/* What the macro at *from stands for; returns how many tokens that used. */
static size_t replace(hnbrdf_preprocessor *p, hnbrdf_tokens *to, hnbrdf_macro *macro,
                      const hnbrdf_token *from, size_t count, int constants)
{
    const size_t index = (size_t)(macro - p->macros);
    argument arguments[HNBRDF_MACRO_PARAMETERS];
    hnbrdf_tokens body = {0};
    size_t used = 1;
    if (macro->parameter_count >= 0) {
        const size_t read = read_arguments(p, macro, from + 1, count - 1, arguments);
        if (read == 0)
            return count;
        used += read;
    }
    substitute(p, &body, macro, arguments, constants);
    for (size_t k = 0; k < body.count; k++) { /* lines as if it stood there */
        body.list[k].line = from->line;
        body.list[k].source = from->source;
        body.list[k].own_line = k == 0 ? from->own_line : 0;
        body.list[k].after_blank = k == 0 ? from->after_blank : 0;
    }
    p->macros[index].busy = 1;
    hnbrdf_expand(p, to, body.list, body.count, constants);
    p->macros[index].busy = 0;
    hnbrdf_release(p->t->memory, body.list);
    return used;
}

void hnbrdf_expand(hnbrdf_preprocessor *p, hnbrdf_tokens *to, const hnbrdf_token *from,
                   size_t count, int constants)
{
    unsigned char own_line = 0, after_blank = 0; /* of macros that stand for nothing */
    for (size_t k = 0; k < count && !p->t->result;) {
        const size_t before = to->count;
        hnbrdf_macro *macro =
            from[k].kind == HNBRDF_TOKEN_NAME ? hnbrdf_find_macro(p, from[k].text) : NULL;
        const int called = k + 1 < count && hnbrdf_span_is(from[k + 1].text, "(");
        own_line |= from[k].own_line;
        after_blank |= from[k].after_blank;
        if (macro && !macro->busy && (constants || !macro->constant) &&
            (macro->parameter_count < 0 || called))
            k += replace(p, to, macro, from + k, count - k, constants);
        else
            hnbrdf_add_token(p->t, to, &from[k++]);
        if (to->count > before) {
            to->list[before].own_line = own_line;
            to->list[before].after_blank = after_blank;
            own_line = after_blank = 0;
        }
    }
}
