/* preprocess.c: directives of a shader text: #if, #define and the like are followed, #extension and
 * #version dropped. What of them another language needs too stays as a token: constants, the guard
 * of a text, the check that another text came before. */
#include "language/preprocess.h"

#include "base/memory.h"
#include "language/print.h"

#include <string.h>

/* ---- What leaves this step ------------------------------------------------------------------- */

/* Adds tokens in which macros are replaced. An empty line after a directive that went takes the
 * comment with it that stood on the directive. */
static void emit(hnbrdf_preprocessor *p, const hnbrdf_token *tokens, size_t count)
{
    if (count == 0)
        return;
    hnbrdf_tokens *out = &p->t->tokens;
    const int after_blank = p->after_blank || tokens[0].after_blank;
    if (p->tentative > 0 && after_blank)
        out->count = p->tentative - 1;
    p->tentative = 0;
    p->after_blank = 0;
    const size_t first = out->count;
    hnbrdf_expand(p, out, tokens, count, 0);
    if (out->count > first)
        out->list[first].after_blank = (unsigned char)after_blank;
}

/* A directive goes: whether its comment stays depends on what follows. */
static void let_go(hnbrdf_preprocessor *p, const hnbrdf_token *directive)
{
    const hnbrdf_tokens *out = &p->t->tokens;
    p->after_blank |= directive->after_blank;
    if (p->tentative > 0) {
        if (directive->after_blank) {
            p->t->tokens.count = p->tentative - 1;
            p->tentative = 0;
        }
        return;
    }
    size_t first = out->count;
    while (!directive->after_blank && first > 0 &&
           out->list[first - 1].kind == HNBRDF_TOKEN_COMMENT && out->list[first - 1].own_line &&
           out->list[first - 1].source == directive->source) {
        first--;
        if (out->list[first].after_blank)
            break;
    }
    if (first < out->count)
        p->tentative = first + 1;
}

static hnbrdf_token made(const hnbrdf_token *like, hnbrdf_token_kind kind, hnbrdf_span text)
{
    hnbrdf_token token = *like;
    token.kind = (unsigned char)kind;
    token.text = text;
    return token;
}

/* ---- Directives ------------------------------------------------------------------------------ */

static int is_active(const hnbrdf_preprocessor *p)
{
    return p->depth == 0 || p->branches[p->depth - 1].active;
}

/* 1: a #ifndef of this name is around us: what is defined may be set by who includes the text. */
static int is_asked(const hnbrdf_preprocessor *p, hnbrdf_span name)
{
    for (int k = 0; k < p->depth; k++)
        if (hnbrdf_span_same(p->branches[k].asked, name))
            return 1;
    return 0;
}

static void define(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *directive,
                   const hnbrdf_token *name)
{
    const hnbrdf_token comment_at = *name;
    hnbrdf_lexer again = *line;
    hnbrdf_define(p, line, name);
    hnbrdf_macro *macro = hnbrdf_find_macro(p, name->text);
    if (p->t->result || !macro)
        return;
    const int flag = macro->parameter_count < 0 && macro->body_count == 0;
    if (is_asked(p, name->text)) {
        macro->constant = 0;
        if (flag && p->depth == 1 && hnbrdf_span_ends(name->text, "_GLSL")) {
            const hnbrdf_token guard = made(directive, HNBRDF_TOKEN_GUARD, name->text);
            p->branches[0].guard = 1;
            p->tentative = 0; /* the heading of the text, which it guards */
            emit(p, &guard, 1);
        } else {
            let_go(p, directive);
        }
        return;
    }
    if (!macro->constant && !flag) {
        let_go(p, directive);
        return;
    }
    const hnbrdf_token begin = made(directive, HNBRDF_TOKEN_CONSTANT, name->text);
    const hnbrdf_token end = made(&comment_at, HNBRDF_TOKEN_CONSTANT_END, name->text);
    emit(p, &begin, 1);
    for (hnbrdf_token token = hnbrdf_lex(&again); token.kind != HNBRDF_TOKEN_END;
         token = hnbrdf_lex(&again)) {
        if (token.kind == HNBRDF_TOKEN_COMMENT)
            emit(p, &end, 1);
        emit(p, &token, 1);
        if (token.kind == HNBRDF_TOKEN_COMMENT)
            return;
    }
    emit(p, &end, 1);
}

static void begin_branch(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *word)
{
    if (p->depth == HNBRDF_NESTED) {
        hnbrdf_refuse(p->t, word, "more than %d #if within each other", HNBRDF_NESTED);
        return;
    }
    hnbrdf_branch branch = {0};
    const int around = is_active(p);
    if (hnbrdf_span_is(word->text, "if")) {
        branch.active = around && hnbrdf_condition(p, line, word) != 0;
    } else {
        const int negated = hnbrdf_span_is(word->text, "ifndef");
        const hnbrdf_token name = hnbrdf_lex(line);
        branch.active = around && (hnbrdf_find_macro(p, name.text) != NULL) != negated;
        if (negated && around)
            branch.asked = name.text;
    }
    branch.taken = branch.active || !around;
    p->branches[p->depth++] = branch;
}

static void next_branch(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *word)
{
    hnbrdf_branch *branch = &p->branches[p->depth - 1];
    const int last = hnbrdf_span_is(word->text, "else");
    branch->active = !branch->taken && (last || hnbrdf_condition(p, line, word) != 0);
    branch->taken |= branch->active;
    branch->asked.size = 0;
}

/* "#ifndef X_GLSL", "#error ...": another text must come before; other languages ask so too. */
static void check(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *directive)
{
    const hnbrdf_span message = hnbrdf_lex_line(line);
    if (is_active(p)) {
        hnbrdf_refuse(p->t, directive, "#error %.*s", HNBRDF_SPAN(message));
        return;
    }
    const hnbrdf_span asked = p->branches[p->depth - 1].asked;
    if (!hnbrdf_span_ends(asked, "_GLSL"))
        return;
    const hnbrdf_token tokens[2] = {made(directive, HNBRDF_TOKEN_CHECK, asked),
                                    made(directive, HNBRDF_TOKEN_NAME, message)};
    p->tentative = 0;
    emit(p, tokens, 2);
}

static void end_branch(hnbrdf_preprocessor *p, const hnbrdf_token *directive)
{
    if (p->branches[--p->depth].guard) {
        const hnbrdf_token end = made(directive, HNBRDF_TOKEN_GUARD_END, directive->text);
        emit(p, &end, 1);
    }
}

static void follow_active(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *directive,
                          const hnbrdf_token *word)
{
    const hnbrdf_token name = hnbrdf_lex(line);
    if (hnbrdf_span_is(word->text, "define")) {
        define(p, line, directive, &name);
        return;
    }
    if (hnbrdf_span_is(word->text, "undef")) {
        hnbrdf_macro *macro = hnbrdf_find_macro(p, name.text);
        if (macro)
            macro->removed = 1;
    } else if (!hnbrdf_span_is(word->text, "extension") && !hnbrdf_span_is(word->text, "version")) {
        hnbrdf_refuse(p->t, word, "#%.*s", HNBRDF_SPAN(word->text));
    }
    let_go(p, directive);
}

static void follow(hnbrdf_preprocessor *p, hnbrdf_lexer *line, const hnbrdf_token *directive)
{
    const hnbrdf_token word = hnbrdf_lex(line);
    const int ends = hnbrdf_span_is(word.text, "endif");
    const int turns = hnbrdf_span_is(word.text, "else") || hnbrdf_span_is(word.text, "elif");
    if ((ends || turns) && p->depth == 0) {
        hnbrdf_refuse(p->t, &word, "#%.*s without #if", HNBRDF_SPAN(word.text));
    } else if (ends) {
        let_go(p, directive);
        end_branch(p, directive);
    } else if (turns) {
        let_go(p, directive);
        next_branch(p, line, &word);
    } else if (hnbrdf_span_is(word.text, "if") || hnbrdf_span_is(word.text, "ifdef") ||
               hnbrdf_span_is(word.text, "ifndef")) {
        let_go(p, directive);
        begin_branch(p, line, &word);
    } else if (hnbrdf_span_is(word.text, "error")) {
        check(p, line, directive);
    } else if (is_active(p) && word.kind != HNBRDF_TOKEN_END) {
        follow_active(p, line, directive, &word);
    }
}

/* ---- Texts ----------------------------------------------------------------------------------- */

/* The tokens of a text up to the next directive, and that. */
static void read_text(hnbrdf_preprocessor *p, const hnbrdf_source *source, int number)
{
    hnbrdf_lexer lexer = {.at = source->text,
                          .end = source->text + source->size,
                          .line = 1,
                          .source = (unsigned char)number,
                          .own_line = 1};
    hnbrdf_tokens part = {0};
    while (!p->t->result) {
        const hnbrdf_token token = hnbrdf_lex(&lexer);
        const int directive = token.own_line && hnbrdf_span_is(token.text, "#");
        if (directive || token.kind == HNBRDF_TOKEN_END) {
            emit(p, part.list, part.count);
            part.count = 0;
        }
        if (token.kind == HNBRDF_TOKEN_END)
            break;
        if (directive) {
            const hnbrdf_span rest = hnbrdf_lex_line(&lexer);
            hnbrdf_lexer line = {.at = rest.at,
                                 .end = rest.at + rest.size,
                                 .line = token.line,
                                 .source = (unsigned char)number};
            follow(p, &line, &token);
        } else if (is_active(p)) {
            hnbrdf_add_token(p->t, &part, &token);
        }
    }
    hnbrdf_release(p->t->memory, part.list);
    const hnbrdf_token end = {.line = lexer.line, .source = (unsigned char)number};
    if (p->depth > 0)
        hnbrdf_refuse(p->t, &end, "an #if without #endif");
    hnbrdf_add_token(p->t, &p->t->tokens, &end);
}

/* What a Vulkan compiler of GLSL defines. */
static void define_language(hnbrdf_preprocessor *p)
{
    const char *const defined[] = {p->t->exact ? "HNBRDF_EXACT 1" : "HNBRDF_EXACT 0",
                                   p->t->dialect->precise ? "__VERSION__ 450" : "__VERSION__ 330",
                                   "VULKAN 100", "GL_EXT_control_flow_attributes 1",
                                   "GL_EXT_shader_explicit_arithmetic_types_float16 1"};
    for (size_t k = 0; k < sizeof defined / sizeof defined[0]; k++) {
        hnbrdf_lexer line = {.at = defined[k], .end = defined[k] + strlen(defined[k])};
        const hnbrdf_token name = hnbrdf_lex(&line);
        hnbrdf_define(p, &line, &name);
        hnbrdf_macro *macro = hnbrdf_find_macro(p, name.text);
        if (macro)
            macro->constant = 0;
    }
}

void hnbrdf_preprocess(hnbrdf_translation *t)
{
    hnbrdf_preprocessor p = {.t = t};
    define_language(&p);
    for (int k = 0; k < t->count && !t->result; k++)
        read_text(&p, &t->sources[k], k);
    hnbrdf_release(t->memory, p.macros);
    hnbrdf_release(t->memory, p.bodies.list);
}
