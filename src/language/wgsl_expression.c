/* wgsl_expression.c: names and expressions of WGSL: no overloads, no ?:, pointers for out. */
#include "language/wgsl.h"

#include "base/text.h"
#include "language/type.h"

#include <float.h>
#include <string.h>

/* ---- Names ----------------------------------------------------------------------------------- */

void hnbrdf_wgsl_function_name(hnbrdf_print *p, const hnbrdf_node *function)
{
    const hnbrdf_node *first = function->symbol->first, *parameter = function->first;
    hnbrdf_write_span(p, function->token.text);
    for (; function->form > 0 && parameter->kind == HNBRDF_NODE_VARIABLE;
         parameter = parameter->next) {
        const int there = first && first->kind == HNBRDF_NODE_VARIABLE;
        if (!there || !hnbrdf_same_type(first->type, parameter->type)) {
            hnbrdf_write(p, "_");
            hnbrdf_write_span(p, hnbrdf_type_name(parameter->type));
        }
        first = there ? first->next : first;
    }
}

void hnbrdf_wgsl_type(hnbrdf_print *p, hnbrdf_type type)
{
    if (!type.length) {
        hnbrdf_write_type(p, type);
        return;
    }
    hnbrdf_write(p, "array<");
    hnbrdf_write_type(p, type);
    hnbrdf_write(p, ", ");
    hnbrdf_write_expression(p, type.length);
    hnbrdf_write(p, ">");
}

/* ---- Expressions ----------------------------------------------------------------------------- */

/* A number that rounds down to the largest float is above it, which WGSL refuses. */
static int write_number(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_span text = node->token.text;
    char largest[HNBRDF_NUMBER_TEXT];
    double value = 0.0;
    if (node->type.scalar != HNBRDF_FLOAT ||
        !hnbrdf_parse_double(text.at, text.at + text.size, &value) || value <= (double)FLT_MAX)
        return 0;
    hnbrdf_format_double(largest, sizeof largest, (double)FLT_MAX);
    hnbrdf_write(p, largest);
    return 1;
}

/* Out parameters are pointers. */
static int write_name(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (!node->symbol->output)
        return 0;
    hnbrdf_write(p, "(*");
    hnbrdf_write_variable(p, node->symbol);
    hnbrdf_write(p, ")");
    return 1;
}

enum { LOGICAL = 1, BITS, COMPARISON, ARITHMETIC };

static int group_of(hnbrdf_span sign)
{
    if (sign.size == 2 && (sign.at[0] == '&' || sign.at[0] == '|'))
        return LOGICAL;
    if (sign.size == 1 && strchr("&|^", sign.at[0]))
        return BITS;
    if (hnbrdf_span_is(sign, "<<") || hnbrdf_span_is(sign, ">>"))
        return BITS;
    return strchr("<>=!", sign.at[0]) ? COMPARISON : ARITHMETIC;
}

/* Operators that WGSL does not mix without brackets. */
static int needs_brackets(const hnbrdf_node *node, const hnbrdf_node *operand)
{
    if (operand->kind != HNBRDF_NODE_BINARY)
        return 0;
    const int outer = group_of(node->token.text), inner = group_of(operand->token.text);
    if (outer == LOGICAL)
        return inner == LOGICAL && !hnbrdf_span_same(node->token.text, operand->token.text);
    return outer == BITS || inner == BITS || (outer == COMPARISON && inner == COMPARISON);
}

static void write_operand(hnbrdf_print *p, const hnbrdf_node *node, const hnbrdf_node *operand)
{
    const int brackets = needs_brackets(node, operand);
    hnbrdf_write(p, brackets ? "(" : "");
    hnbrdf_write_expression(p, operand);
    hnbrdf_write(p, brackets ? ")" : "");
}

/* *x = 1.0, not (*x) = 1.0 */
static int write_assign(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *target = node->first;
    if (target->kind != HNBRDF_NODE_NAME || !target->symbol->output)
        return 0;
    hnbrdf_write(p, "*");
    hnbrdf_write_variable(p, target->symbol);
    hnbrdf_write(p, " ");
    hnbrdf_write_span(p, node->token.text);
    hnbrdf_write_break(p, node->last->own_line, " ");
    hnbrdf_write_expression(p, node->last);
    return 1;
}

static int write_binary(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_span sign = node->token.text;
    const int shift = hnbrdf_span_is(sign, "<<") || hnbrdf_span_is(sign, ">>");
    if (group_of(sign) == COMPARISON && node->first->type.width > 1)
        return 0; /* all(a == b) */
    write_operand(p, node, node->first);
    hnbrdf_write_break(p, node->breaks, " ");
    hnbrdf_write_span(p, sign);
    hnbrdf_write_break(p, node->last->own_line, " ");
    if (shift && node->last->kind != HNBRDF_NODE_NUMBER) {
        hnbrdf_write(p, "u32(");
        hnbrdf_write_expression(p, node->last);
        hnbrdf_write(p, ")");
    } else {
        write_operand(p, node, node->last);
    }
    return 1;
}

/* Both values are worked out: none of our functions does anything else than return one. */
static int write_choice(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->type.structure || node->type.length)
        hnbrdf_refuse(p->t, &node->token, "a choice of structs within an expression");
    hnbrdf_write(p, "select(");
    hnbrdf_write_expression(p, node->last);
    hnbrdf_write(p, ", ");
    hnbrdf_write_expression(p, node->first->next);
    hnbrdf_write(p, ", ");
    hnbrdf_write_expression(p, node->first);
    hnbrdf_write(p, ")");
    return 1;
}

void hnbrdf_wgsl_temporary(hnbrdf_print *p, const hnbrdf_node *argument)
{
    hnbrdf_write_span(p, argument->token.text);
    hnbrdf_write(p, "_out");
}

static int write_call(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *parameter = node->symbol->first;
    hnbrdf_wgsl_function_name(p, node->symbol);
    hnbrdf_write(p, "(");
    for (const hnbrdf_node *a = node->first; a; a = a->next, parameter = parameter->next) {
        if (a != node->first)
            hnbrdf_write(p, a->own_line ? "," : ", ");
        hnbrdf_write_break(p, a->own_line, "");
        if (!parameter->output) {
            hnbrdf_write_expression(p, a);
        } else if (a->kind != HNBRDF_NODE_NAME) {
            hnbrdf_write(p, "&");
            hnbrdf_wgsl_temporary(p, a);
        } else { /* a pointer that came in goes on */
            hnbrdf_write(p, a->symbol->output ? "" : "&");
            hnbrdf_write_variable(p, a->symbol);
        }
    }
    hnbrdf_write(p, ")");
    return 1;
}

static int write_construct(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (!node->type.length)
        return 0;
    hnbrdf_write(p, "array(");
    hnbrdf_write_list(p, node->first);
    hnbrdf_write(p, ")");
    return 1;
}

/* bitcast<f32>(x) */
static int write_bits(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->builtin->shape != HNBRDF_SHAPE_BITS)
        return 0;
    hnbrdf_write(p, "bitcast<");
    hnbrdf_write_type(p, node->type);
    hnbrdf_write(p, ">(");
    hnbrdf_write_list(p, node->first);
    hnbrdf_write(p, ")");
    return 1;
}

int hnbrdf_wgsl_expression(hnbrdf_print *p, const hnbrdf_node *node)
{
    switch (node->kind) {
    case HNBRDF_NODE_NUMBER:
        return write_number(p, node);
    case HNBRDF_NODE_NAME:
        return write_name(p, node);
    case HNBRDF_NODE_ASSIGN:
        return write_assign(p, node);
    case HNBRDF_NODE_BINARY:
        return write_binary(p, node);
    case HNBRDF_NODE_BRACKET: /* select(...) needs none */
        return node->first->kind == HNBRDF_NODE_CHOICE && write_choice(p, node->first);
    case HNBRDF_NODE_CHOICE:
        return write_choice(p, node);
    case HNBRDF_NODE_CALL:
        return write_call(p, node);
    case HNBRDF_NODE_CONSTRUCT:
        return write_construct(p, node);
    case HNBRDF_NODE_BUILTIN:
        return write_bits(p, node);
    default:
        return 0;
    }
}
