/* print_expression.c: expressions, as C has them. */
#include "language/print.h"

#include "language/type.h"

#include <string.h>

int hnbrdf_is_single(const hnbrdf_node *node)
{
    return node->kind != HNBRDF_NODE_UNARY && node->kind != HNBRDF_NODE_BINARY &&
           node->kind != HNBRDF_NODE_CHOICE && node->kind != HNBRDF_NODE_ASSIGN;
}

static void write_number(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_write_span(p, node->token.text);
    if (node->type.scalar == HNBRDF_FLOAT)
        hnbrdf_write(p, p->dialect->suffix);
}

void hnbrdf_write_list(hnbrdf_print *p, const hnbrdf_node *first)
{
    for (const hnbrdf_node *node = first; node; node = node->next) {
        if (node != first)
            hnbrdf_write(p, node->own_line ? "," : ", ");
        hnbrdf_write_break(p, node->own_line, "");
        hnbrdf_write_expression(p, node);
    }
}

static void write_call(hnbrdf_print *p, const char *name, hnbrdf_span span, const hnbrdf_node *node)
{
    if (name)
        hnbrdf_write(p, name);
    else
        hnbrdf_write_span(p, span);
    hnbrdf_write(p, "(");
    hnbrdf_write_list(p, node->first);
    hnbrdf_write(p, ")");
}

void hnbrdf_write_widened(hnbrdf_print *p, const hnbrdf_node *node, hnbrdf_type type)
{
    if (node->type.width == type.width) {
        hnbrdf_write_expression(p, node);
        return;
    }
    hnbrdf_node copy = *node;
    hnbrdf_node construct = {.kind = HNBRDF_NODE_CONSTRUCT, .type = type, .first = &copy};
    copy.next = NULL;
    copy.own_line = 0;
    construct.last = &copy;
    construct.type.scalar = node->type.scalar;
    hnbrdf_write_expression(p, &construct);
}

/* The widest argument says what all of them are: not every language widens numbers. */
static void write_builtin(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_builtin *builtin = node->builtin;
    const char *name = p->dialect->builtin(builtin);
    hnbrdf_type widest = node->first->type;
    for (const hnbrdf_node *a = node->first; a; a = a->next)
        if (a->type.width > widest.width)
            widest = a->type;
    if (builtin->shape == HNBRDF_SHAPE_RELATION) {
        hnbrdf_write(p, "(");
        hnbrdf_write_expression(p, node->first);
        hnbrdf_write(p, " ");
        hnbrdf_write(p, name);
        hnbrdf_write(p, " ");
        hnbrdf_write_expression(p, node->last);
        hnbrdf_write(p, ")");
        return;
    }
    hnbrdf_write(p, name ? name : builtin->name);
    hnbrdf_write(p, "(");
    for (const hnbrdf_node *a = node->first; a; a = a->next) {
        if (a != node->first)
            hnbrdf_write(p, a->own_line ? "," : ", ");
        hnbrdf_write_break(p, a->own_line, "");
        hnbrdf_write_widened(p, a, widest);
    }
    hnbrdf_write(p, ")");
}

/* Vectors are equal where all of their components are. */
static int write_equality(hnbrdf_print *p, const hnbrdf_node *node)
{
    const char sign = node->token.text.at[0];
    if ((sign != '=' && sign != '!') || node->first->type.width == 1)
        return 0;
    hnbrdf_write(p, sign == '=' ? "all(" : "any(");
    hnbrdf_write_expression(p, node->first);
    hnbrdf_write(p, sign == '=' ? " == " : " != ");
    hnbrdf_write_expression(p, node->last);
    hnbrdf_write(p, ")");
    return 1;
}

static void write_binary(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->kind == HNBRDF_NODE_BINARY && write_equality(p, node))
        return;
    hnbrdf_write_expression(p, node->first);
    hnbrdf_write_break(p, node->breaks, " ");
    hnbrdf_write_span(p, node->token.text);
    hnbrdf_write_break(p, node->last->own_line, " ");
    hnbrdf_write_expression(p, node->last);
}

static void write_choice(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *yes = node->first->next;
    hnbrdf_write_expression(p, node->first);
    hnbrdf_write_break(p, yes->own_line, " ");
    hnbrdf_write(p, "? ");
    hnbrdf_write_expression(p, yes);
    hnbrdf_write_break(p, node->last->own_line, " ");
    hnbrdf_write(p, ": ");
    hnbrdf_write_expression(p, node->last);
}

/* Of several arguments each must have the type of the components in some languages. */
static void write_construct(hnbrdf_print *p, const hnbrdf_node *node)
{
    const int several = !node->type.structure && node->first && node->first->next;
    hnbrdf_write_type(p, node->type);
    hnbrdf_write(p, "(");
    for (const hnbrdf_node *a = node->first; a; a = a->next) {
        const hnbrdf_type type = {.scalar = node->type.scalar, .width = a->type.width};
        const int converted = several && a->type.scalar != type.scalar;
        if (a != node->first)
            hnbrdf_write(p, a->own_line ? "," : ", ");
        hnbrdf_write_break(p, a->own_line, "");
        if (converted)
            hnbrdf_write_type(p, type);
        hnbrdf_write(p, converted ? "(" : "");
        hnbrdf_write_expression(p, a);
        hnbrdf_write(p, converted ? ")" : "");
    }
    hnbrdf_write(p, ")");
}

static void write_part(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_write_expression(p, node->first);
    if (node->kind == HNBRDF_NODE_INDEX) {
        hnbrdf_write(p, "[");
        hnbrdf_write_expression(p, node->last);
        hnbrdf_write(p, "]");
        return;
    }
    hnbrdf_write(p, ".");
    if (node->kind == HNBRDF_NODE_MEMBER)
        hnbrdf_write_name(p, node->token.text);
    else
        hnbrdf_write_span(p, node->token.text);
}

void hnbrdf_write_expression(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (p->dialect->expression(p, node))
        return;
    switch (node->kind) {
    case HNBRDF_NODE_NUMBER:
        write_number(p, node);
        return;
    case HNBRDF_NODE_NAME:
        hnbrdf_write_variable(p, node->symbol);
        return;
    case HNBRDF_NODE_BRACKET:
        write_call(p, "", node->token.text, node);
        return;
    case HNBRDF_NODE_UNARY:
        hnbrdf_write_span(p, node->token.text);
        hnbrdf_write_expression(p, node->first);
        return;
    case HNBRDF_NODE_STEP:
        hnbrdf_write_expression(p, node->first);
        hnbrdf_write_span(p, node->token.text);
        return;
    case HNBRDF_NODE_BINARY:
    case HNBRDF_NODE_ASSIGN:
        write_binary(p, node);
        return;
    case HNBRDF_NODE_CHOICE:
        write_choice(p, node);
        return;
    case HNBRDF_NODE_MEMBER:
    case HNBRDF_NODE_SWIZZLE:
    case HNBRDF_NODE_INDEX:
        write_part(p, node);
        return;
    case HNBRDF_NODE_CALL:
        write_call(p, NULL, node->token.text, node);
        return;
    case HNBRDF_NODE_BUILTIN:
        write_builtin(p, node);
        return;
    case HNBRDF_NODE_CONSTRUCT:
        write_construct(p, node);
        return;
    default:
        hnbrdf_refuse(p->t, &node->token, "'%.*s' is not translated",
                      HNBRDF_SPAN(node->token.text));
    }
}
