/* token.c: a shader text as words, numbers, signs and comments. */
#include "language/token.h"

#include <string.h>

int hnbrdf_span_is(hnbrdf_span span, const char *text)
{
    return strlen(text) == span.size && memcmp(text, span.at, span.size) == 0;
}

int hnbrdf_span_same(hnbrdf_span a, hnbrdf_span b)
{
    return a.size == b.size && memcmp(a.at, b.at, a.size) == 0;
}

int hnbrdf_span_ends(hnbrdf_span span, const char *ending)
{
    const size_t size = strlen(ending);
    return span.size >= size && memcmp(span.at + span.size - size, ending, size) == 0;
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static int in_name(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_';
}

/* Digits, points, letters of hexadecimal numbers and suffixes, signs of exponents. */
static const char *number_end(const char *at, const char *end)
{
    const int hexadecimal = end - at > 1 && at[0] == '0' && (at[1] == 'x' || at[1] == 'X');
    for (; at < end; at++) {
        const int exponent = !hexadecimal && (*at == 'e' || *at == 'E');
        if (exponent && end - at > 1 && (at[1] == '+' || at[1] == '-'))
            at++;
        else if (!in_name(*at) && *at != '.')
            break;
    }
    return at;
}

static const char *comment_end(const char *at, const char *end)
{
    if (at[1] == '/') {
        while (at < end && *at != '\n')
            at++;
        return at;
    }
    for (at += 2; end - at > 1; at++)
        if (at[0] == '*' && at[1] == '/')
            return at + 2;
    return end;
}

static size_t sign_size(const char *at, const char *end)
{
    static const char *const signs[] = {
        "<<=", ">>=", "==", "!=", "<=", ">=", "&&", "||", "^^", "++", "--",
        "+=",  "-=",  "*=", "/=", "%=", "&=", "|=", "^=", "<<", ">>"};
    for (size_t k = 0; k < sizeof signs / sizeof signs[0]; k++) {
        const size_t size = strlen(signs[k]);
        if ((size_t)(end - at) >= size && memcmp(at, signs[k], size) == 0)
            return size;
    }
    return 1;
}

static void skip_blanks(hnbrdf_lexer *lexer)
{
    for (; lexer->at < lexer->end; lexer->at++) {
        if (*lexer->at == '\n') {
            if (lexer->own_line)
                lexer->after_blank = 1;
            lexer->own_line = 1;
            lexer->line++;
        } else if (*lexer->at != ' ' && *lexer->at != '\t' && *lexer->at != '\r') {
            return;
        }
    }
}

static hnbrdf_token_kind kind_at(const char *at, const char *end)
{
    if (is_digit(*at) || (*at == '.' && end - at > 1 && is_digit(at[1])))
        return HNBRDF_TOKEN_NUMBER;
    if (in_name(*at))
        return HNBRDF_TOKEN_NAME;
    if (*at == '/' && end - at > 1 && (at[1] == '/' || at[1] == '*'))
        return HNBRDF_TOKEN_COMMENT;
    return strchr("+-*/%<>=!&|^~?:;,.()[]{}#", *at) && *at ? HNBRDF_TOKEN_SIGN : HNBRDF_TOKEN_ODD;
}

hnbrdf_token hnbrdf_lex(hnbrdf_lexer *lexer)
{
    skip_blanks(lexer);
    hnbrdf_token token = {.text = {lexer->at, 0},
                          .line = lexer->line,
                          .source = lexer->source,
                          .own_line = lexer->own_line,
                          .after_blank = lexer->after_blank};
    if (lexer->at == lexer->end)
        return token;
    const char *after = lexer->at;
    token.kind = (unsigned char)kind_at(lexer->at, lexer->end);
    if (token.kind == HNBRDF_TOKEN_NUMBER)
        after = number_end(after, lexer->end);
    else if (token.kind == HNBRDF_TOKEN_NAME)
        while (after < lexer->end && in_name(*after))
            after++;
    else if (token.kind == HNBRDF_TOKEN_COMMENT)
        after = comment_end(after, lexer->end);
    else
        after += token.kind == HNBRDF_TOKEN_SIGN ? sign_size(after, lexer->end) : 1;
    token.text.size = (size_t)(after - lexer->at);
    for (const char *c = lexer->at; c < after; c++)
        lexer->line += *c == '\n';
    lexer->at = after;
    lexer->own_line = lexer->after_blank = 0;
    return token;
}

hnbrdf_span hnbrdf_lex_line(hnbrdf_lexer *lexer)
{
    const char *end = (const char *)memchr(lexer->at, '\n', (size_t)(lexer->end - lexer->at));
    hnbrdf_span line = {lexer->at, 0};
    end = end ? end : lexer->end;
    lexer->at = end;
    while (line.at < end && (*line.at == ' ' || *line.at == '\t'))
        line.at++;
    while (end > line.at && (end[-1] == ' ' || end[-1] == '\t' || end[-1] == '\r'))
        end--;
    line.size = (size_t)(end - line.at);
    return line;
}
