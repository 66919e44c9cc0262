/* condition.c: the condition of an #if: defined, numbers, || && == != < <= > >= + - !. */
#include "language/preprocess.h"

#include "base/memory.h"

#include <stdlib.h>

/* What is read of it. `skip`: beside a || or && that is decided, where names may be undefined. */
typedef struct condition {
    hnbrdf_preprocessor *p;
    hnbrdf_token *tokens;
    size_t count, at;
    hnbrdf_token end;
    int open;
} condition;

static long read_level(condition *c, int level, int skip);

static const hnbrdf_token *peek(const condition *c)
{
    return c->at < c->count ? &c->tokens[c->at] : &c->end;
}

static int take(condition *c, const char *sign)
{
    const int found = hnbrdf_span_is(peek(c)->text, sign);
    c->at += (size_t)found;
    return found;
}

static long read_value(condition *c, int skip)
{
    const hnbrdf_token *token = peek(c);
    if (take(c, "!"))
        return !read_value(c, skip);
    if (take(c, "-"))
        return -read_value(c, skip);
    if (take(c, "(")) {
        if (++c->open > HNBRDF_NESTED) {
            hnbrdf_refuse(c->p->t, token, "more than %d brackets within each other", HNBRDF_NESTED);
            return 0;
        }
        const long value = read_level(c, 0, skip);
        c->open--;
        if (!take(c, ")"))
            hnbrdf_refuse(c->p->t, peek(c), "a condition without its ')'");
        return value;
    }
    c->at++;
    if (token->kind == HNBRDF_TOKEN_NUMBER)
        return strtol(token->text.at, NULL, 0); /* ends at what is no digit */
    if (token->kind != HNBRDF_TOKEN_NAME || !skip)
        hnbrdf_refuse(c->p->t, token, "a condition with '%.*s', which is no number and not defined",
                      HNBRDF_SPAN(token->text));
    return 0;
}

/* Operators that bind equally, `level` loosest first. */
static const char *const operators[][5] = {
    {"||", NULL}, {"&&", NULL}, {"==", "!=", NULL}, {"<=", ">=", "<", ">", NULL}, {"+", "-", NULL}};
enum { LEVELS = sizeof operators / sizeof operators[0] };

static const char *take_operator(condition *c, int level)
{
    for (int k = 0; operators[level][k]; k++)
        if (take(c, operators[level][k]))
            return operators[level][k];
    return NULL;
}

static long apply(const char *sign, long a, long b)
{
    switch (sign[0]) {
    case '|':
        return a || b;
    case '&':
        return a && b;
    case '=':
        return a == b;
    case '!':
        return a != b;
    case '+':
        return a + b;
    case '-':
        return a - b;
    case '<':
        return sign[1] ? a <= b : a < b;
    default:
        return sign[1] ? a >= b : a > b;
    }
}

static long read_level(condition *c, int level, int skip)
{
    if (level == LEVELS)
        return read_value(c, skip);
    long value = read_level(c, level + 1, skip);
    const char *sign;
    while (!c->p->t->result && (sign = take_operator(c, level)) != NULL) {
        const int decided = level == 0 ? value != 0 : level == 1 && value == 0;
        value = apply(sign, value, read_level(c, level + 1, skip || decided));
    }
    return value;
}

/* defined(NAME) and defined NAME as 1 and 0. */
static void replace_defined(hnbrdf_preprocessor *p, hnbrdf_tokens *tokens)
{
    static const char *const digits[] = {"0", "1"};
    size_t to = 0;
    for (size_t k = 0; k < tokens->count; k++) {
        hnbrdf_token token = tokens->list[k];
        if (hnbrdf_span_is(token.text, "defined")) {
            const int bracket =
                k + 3 < tokens->count && hnbrdf_span_is(tokens->list[k + 1].text, "(");
            k += bracket ? 2 : 1;
            if (k >= tokens->count || tokens->list[k].kind != HNBRDF_TOKEN_NAME) {
                hnbrdf_refuse(p->t, &token, "defined without a name");
                return;
            }
            const int known = hnbrdf_find_macro(p, tokens->list[k].text) != NULL;
            token.text = (hnbrdf_span){digits[known], 1};
            token.kind = HNBRDF_TOKEN_NUMBER;
            k += (size_t)bracket;
        }
        tokens->list[to++] = token;
    }
    tokens->count = to;
}

long hnbrdf_condition(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *directive)
{
    hnbrdf_tokens raw = {0}, tokens = {0};
    for (hnbrdf_token token = hnbrdf_lex(line); token.kind != HNBRDF_TOKEN_END && !p->t->result;
         token = hnbrdf_lex(line))
        if (token.kind != HNBRDF_TOKEN_COMMENT)
            hnbrdf_add_token(p->t, &raw, &token);
    replace_defined(p, &raw);
    hnbrdf_expand(p, &tokens, raw.list, raw.count, 1);
    long value = 0;
    if (!p->t->result) {
        condition c = {.p = p, .tokens = tokens.list, .count = tokens.count, .end = *directive};
        c.end.kind = HNBRDF_TOKEN_END;
        value = read_level(&c, 0, 0);
        if (c.at < c.count)
            hnbrdf_refuse(p->t, peek(&c), "'%.*s' in a condition", HNBRDF_SPAN(peek(&c)->text));
    }
    hnbrdf_release(p->t->memory, raw.list);
    hnbrdf_release(p->t->memory, tokens.list);
    return value;
}
