/* print.c: lines, comments, names and items, as all languages have them. */
#include "language/print.h"

#include "language/type.h"

#include <stdio.h>
#include <string.h>

/* ---- Lines ----------------------------------------------------------------------------------- */

static void put(hnbrdf_print *p, const char *text, size_t size)
{
    p->column += (int)size;
    p->started |= size > 0;
    if (!p->measured)
        hnbrdf_put_bytes(p->out, text, size);
}

void hnbrdf_write(hnbrdf_print *p, const char *text)
{
    put(p, text, strlen(text));
}

void hnbrdf_write_span(hnbrdf_print *p, hnbrdf_span span)
{
    put(p, span.at, span.size);
}

static void end_line(hnbrdf_print *p)
{
    if (p->started)
        put(p, "\n", 1);
    p->column = p->started = 0;
}

void hnbrdf_new_line(hnbrdf_print *p, int after_blank)
{
    end_line(p);
    if (after_blank)
        put(p, "\n", 1);
    for (int k = 0; k < p->indent; k++)
        put(p, "    ", 4);
    p->started = 0;
    p->column = 4 * p->indent;
}

void hnbrdf_write_lines(hnbrdf_print *p, const char *text)
{
    end_line(p);
    put(p, text, strlen(text));
    p->column = p->started = 0;
}

void hnbrdf_write_break(hnbrdf_print *p, int breaks, const char *otherwise)
{
    if (!breaks) {
        hnbrdf_write(p, otherwise);
        return;
    }
    p->indent++;
    hnbrdf_new_line(p, 0);
    p->indent--;
}

/* ---- Names ----------------------------------------------------------------------------------- */

void hnbrdf_write_name(hnbrdf_print *p, hnbrdf_span name)
{
    hnbrdf_write_span(p, name);
    for (const char *const *word = p->dialect->reserved; *word; word++)
        if (hnbrdf_span_is(name, *word))
            hnbrdf_write(p, "_");
}

/* r, r2, r3 of several loops over r, where a language would take them for one. */
void hnbrdf_write_variable(hnbrdf_print *p, const hnbrdf_node *variable)
{
    hnbrdf_write_name(p, variable->token.text);
    if (p->dialect->loops_leak && variable->loop && variable->form > 0) {
        char number[16];
        snprintf(number, sizeof number, "%d", variable->form + 1);
        hnbrdf_write(p, number);
    }
}

void hnbrdf_write_type(hnbrdf_print *p, hnbrdf_type type)
{
    if (type.structure)
        hnbrdf_write_name(p, type.structure->token.text);
    else
        hnbrdf_write(p, p->dialect->types[type.scalar][type.width]);
}

/* X_GLSL as X_HLSL. */
void hnbrdf_write_guard(hnbrdf_print *p, hnbrdf_span name)
{
    hnbrdf_write_span(p, (hnbrdf_span){name.at, name.size - strlen("GLSL")});
    hnbrdf_write(p, p->dialect->capital);
}

void hnbrdf_write_setting(hnbrdf_print *p, hnbrdf_span block, const char *ending)
{
    static const char last[] = "_block";
    const size_t size = block.size - (hnbrdf_span_ends(block, last) ? sizeof last - 1 : 0);
    for (size_t k = 0; k < size; k++) {
        char c = block.at[k];
        c = c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
        hnbrdf_write_span(p, (hnbrdf_span){&c, 1});
    }
    hnbrdf_write(p, ending);
}

void hnbrdf_write_comment(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->own_line) {
        hnbrdf_new_line(p, node->after_blank);
    } else {
        if (p->widest < p->column)
            p->widest = p->column;
        hnbrdf_write(p, " ");
        while (!p->measured && p->column < p->comment_column)
            hnbrdf_write(p, " ");
    }
    hnbrdf_write_span(p, node->token.text);
}

/* ---- Items ----------------------------------------------------------------------------------- */

void hnbrdf_write_members(hnbrdf_print *p, const hnbrdf_node *structure,
                          void (*member)(hnbrdf_print *p, const hnbrdf_node *declaration))
{
    hnbrdf_print around = *p;
    p->widest = 0;
    for (int pass = 0; pass < 2; pass++) {
        p->measured = pass == 0 || around.measured;
        for (const hnbrdf_node *node = structure->first; node; node = node->next)
            if (node->kind == HNBRDF_NODE_COMMENT)
                hnbrdf_write_comment(p, node);
            else
                member(p, node);
        p->comment_column = p->widest + 1;
        if (pass == 0) {
            p->column = around.column;
            p->started = around.started;
        }
    }
    p->widest = around.widest;
    p->comment_column = around.comment_column;
    p->measured = around.measured;
}

static void print_item(hnbrdf_print *p, const hnbrdf_node *node);

/* The guard behind the comments that begin here, without an empty line; NULL: there is none. */
static const hnbrdf_node *guard_behind(const hnbrdf_node *node)
{
    do
        node = node->next;
    while (node && node->kind == HNBRDF_NODE_COMMENT && !node->after_blank);
    return node && node->kind == HNBRDF_NODE_GUARD && !node->after_blank ? node : NULL;
}

/* The comment on top of the guard of a text is replaced by its heading. */
static void print_items(hnbrdf_print *p, const hnbrdf_node *first)
{
    for (const hnbrdf_node *node = first; node; node = node->next) {
        const hnbrdf_node *guard =
            p->source->heading && node->kind == HNBRDF_NODE_COMMENT ? guard_behind(node) : NULL;
        if (guard) {
            if (node->after_blank)
                hnbrdf_new_line(p, 1);
            hnbrdf_write_lines(p, p->source->heading);
            node = guard;
        }
        print_item(p, node);
    }
}

static void print_guarded(hnbrdf_print *p, const hnbrdf_node *node)
{
    const int define = p->dialect->preprocessor;
    if (define) {
        hnbrdf_new_line(p, node->after_blank);
        hnbrdf_write(p, "#ifndef ");
        hnbrdf_write_guard(p, node->token.text);
        hnbrdf_new_line(p, 0);
        hnbrdf_write(p, "#define ");
        hnbrdf_write_guard(p, node->token.text);
    }
    const int library = hnbrdf_span_is(node->token.text, "HNBRDF_HYBRID_BRDF_GLSL");
    if (library && p->dialect->prelude)
        hnbrdf_write_lines(p, p->dialect->prelude);
    if (library && p->dialect->exact && p->t->exact)
        hnbrdf_write_lines(p, p->dialect->exact);
    print_items(p, node->first);
    if (define) {
        hnbrdf_new_line(p, 1);
        hnbrdf_write(p, "#endif");
    }
}

/* The message says hybrid_brdf.glsl. */
static void write_message(hnbrdf_print *p, hnbrdf_span message)
{
    static const char ending[] = ".glsl";
    const size_t size = sizeof ending - 1;
    for (size_t k = 0; k < message.size; k++) {
        if (message.size - k >= size && memcmp(message.at + k, ending, size) == 0) {
            hnbrdf_write(p, ".");
            hnbrdf_write(p, p->dialect->name);
            k += size - 1;
        } else {
            hnbrdf_write_span(p, (hnbrdf_span){message.at + k, 1});
        }
    }
}

static void print_check(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (p->dialect->preprocessor) {
        hnbrdf_new_line(p, node->after_blank);
        hnbrdf_write(p, "#ifndef ");
        hnbrdf_write_guard(p, node->token.text);
        hnbrdf_new_line(p, 0);
        hnbrdf_write(p, "#error ");
        write_message(p, node->first->token.text);
        hnbrdf_new_line(p, 0);
        hnbrdf_write(p, "#endif");
    }
    if (p->text->half && p->dialect->half) {
        hnbrdf_new_line(p, 1);
        hnbrdf_write_lines(p, p->dialect->half);
    }
}

static void print_item(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (p->dialect->item(p, node))
        return;
    switch (node->kind) {
    case HNBRDF_NODE_COMMENT:
        hnbrdf_write_comment(p, node);
        return;
    case HNBRDF_NODE_GUARD:
        print_guarded(p, node);
        return;
    case HNBRDF_NODE_CHECK:
        print_check(p, node);
        return;
    case HNBRDF_NODE_STRUCT:
        hnbrdf_new_line(p, node->after_blank);
        p->dialect->structure(p, node);
        return;
    case HNBRDF_NODE_BLOCK:
        hnbrdf_new_line(p, node->after_blank);
        p->dialect->block(p, node);
        return;
    case HNBRDF_NODE_FUNCTION:
        hnbrdf_new_line(p, node->after_blank);
        p->dialect->function(p, node);
        return;
    default:
        hnbrdf_refuse(p->t, &node->token, "'%.*s' is not translated",
                      HNBRDF_SPAN(node->token.text));
    }
}

void hnbrdf_print_text(hnbrdf_print *p, const hnbrdf_node *text)
{
    p->text = text;
    if (text->half && p->source->heading && p->dialect->half_begin)
        hnbrdf_write_lines(p, p->dialect->half_begin);
    print_items(p, text->first);
    end_line(p);
}
