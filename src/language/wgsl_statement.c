/* wgsl_statement.c: statements of WGSL: let and var, braces everywhere, choices that are an if. */
#include "language/wgsl.h"

static int calls_function(const hnbrdf_node *node)
{
    if (node->kind == HNBRDF_NODE_CALL)
        return 1;
    for (const hnbrdf_node *child = node->first; child; child = child->next)
        if (calls_function(child))
            return 1;
    return 0;
}

/* A choice that is better made by an if: of structs, or where a function would be called for
 * nothing. NULL: none. */
static const hnbrdf_node *costly_choice(const hnbrdf_node *value)
{
    while (value && value->kind == HNBRDF_NODE_BRACKET)
        value = value->first;
    if (!value || value->kind != HNBRDF_NODE_CHOICE)
        return NULL;
    return value->type.structure || calls_function(value->first->next) ||
                   calls_function(value->last)
               ? value
               : NULL;
}

/* What stands on both branches: "x = ", "return ". */
typedef struct chosen {
    const hnbrdf_node *variable, *target; /* either, or none */
} chosen;

static void write_chosen(hnbrdf_print *p, const chosen *to, const hnbrdf_node *value)
{
    p->indent++;
    hnbrdf_new_line(p, 0);
    if (to->variable)
        hnbrdf_write_variable(p, to->variable);
    else if (to->target)
        hnbrdf_write_expression(p, to->target);
    hnbrdf_write(p, to->variable || to->target ? " = " : "return ");
    hnbrdf_write_expression(p, value);
    hnbrdf_write(p, ";");
    p->indent--;
    hnbrdf_new_line(p, 0);
}

static void write_if_choice(hnbrdf_print *p, const chosen *to, const hnbrdf_node *choice)
{
    hnbrdf_write(p, "if (");
    hnbrdf_write_expression(p, choice->first);
    hnbrdf_write(p, ") {");
    write_chosen(p, to, choice->first->next);
    hnbrdf_write(p, "} else {");
    write_chosen(p, to, choice->last);
    hnbrdf_write(p, "}");
}

static void write_variable_declaration(hnbrdf_print *p, const hnbrdf_node *variable)
{
    const hnbrdf_node *value = variable->first, *choice = costly_choice(value);
    const int typed = !value || choice;
    hnbrdf_write(p, variable->assigned || typed ? "var " : "let ");
    hnbrdf_write_variable(p, variable);
    if (typed) {
        hnbrdf_write(p, ": ");
        hnbrdf_wgsl_type(p, variable->type);
    } else {
        hnbrdf_write(p, " =");
        hnbrdf_write_break(p, value->own_line, " ");
        hnbrdf_write_expression(p, value);
    }
    hnbrdf_write(p, ";");
    if (choice) {
        hnbrdf_new_line(p, 0);
        const chosen to = {variable, NULL};
        write_if_choice(p, &to, choice);
    }
}

static void write_declaration(hnbrdf_print *p, const hnbrdf_node *node)
{
    for (const hnbrdf_node *variable = node->first; variable; variable = variable->next) {
        if (variable != node->first)
            hnbrdf_new_line(p, 0);
        write_variable_declaration(p, variable);
    }
}

static void write_inner(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_write(p, " {");
    if (node->kind == HNBRDF_NODE_COMPOUND) {
        hnbrdf_write_body(p, node);
        return;
    }
    p->indent++;
    hnbrdf_write_statement(p, node);
    p->indent--;
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "}");
}

static void write_if(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *yes = node->first->next, *no = yes->next;
    hnbrdf_write(p, "if (");
    hnbrdf_write_expression(p, node->first);
    hnbrdf_write(p, ")");
    write_inner(p, yes);
    if (!no)
        return;
    hnbrdf_write(p, " else");
    if (no->kind == HNBRDF_NODE_IF) {
        hnbrdf_write(p, " ");
        write_if(p, no);
    } else {
        write_inner(p, no);
    }
}

static void write_for(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *condition = node->first->next, *step = condition->next;
    const hnbrdf_node *variable = node->first->first;
    hnbrdf_write(p, "for (var ");
    hnbrdf_write_variable(p, variable);
    hnbrdf_write(p, ": ");
    hnbrdf_wgsl_type(p, variable->type);
    if (!variable->first || variable->next)
        hnbrdf_refuse(p->t, &node->token, "a loop over other than one variable");
    else {
        hnbrdf_write(p, " = ");
        hnbrdf_write_expression(p, variable->first);
    }
    hnbrdf_write(p, "; ");
    hnbrdf_write_expression(p, condition);
    hnbrdf_write(p, "; ");
    hnbrdf_write_expression(p, step);
    hnbrdf_write(p, ")");
    write_inner(p, step->next);
}

/* ---- Calls with out parameters --------------------------------------------------------------- */

/* The call in an expression some argument of which is an out parameter and no whole variable, to
 * which WGSL has no pointers. */
static const hnbrdf_node *split_call(const hnbrdf_node *node)
{
    if (node->kind == HNBRDF_NODE_CALL) {
        const hnbrdf_node *parameter = node->symbol->first;
        for (const hnbrdf_node *a = node->first; a; a = a->next, parameter = parameter->next)
            if (parameter->output && a->kind != HNBRDF_NODE_NAME)
                return node;
    }
    for (const hnbrdf_node *child = node->first; child; child = child->next) {
        const hnbrdf_node *found = split_call(child);
        if (found)
            return found;
    }
    return NULL;
}

/* Through variables of their own, in a block. */
static void write_split(hnbrdf_print *p, const hnbrdf_node *expression, const hnbrdf_node *call)
{
    hnbrdf_write(p, "{");
    p->indent++;
    for (int pass = 0; pass < 2; pass++) {
        const hnbrdf_node *parameter = call->symbol->first;
        for (const hnbrdf_node *a = call->first; a; a = a->next, parameter = parameter->next) {
            if (!parameter->output || a->kind == HNBRDF_NODE_NAME)
                continue;
            hnbrdf_new_line(p, 0);
            hnbrdf_write(p, pass == 0 ? "var " : "");
            if (pass == 0)
                hnbrdf_wgsl_temporary(p, a);
            else
                hnbrdf_write_expression(p, a);
            hnbrdf_write(p, pass == 0 && !parameter->input ? ": " : " = ");
            if (pass == 1)
                hnbrdf_wgsl_temporary(p, a);
            else if (parameter->input)
                hnbrdf_write_expression(p, a);
            else
                hnbrdf_write_type(p, a->type);
            hnbrdf_write(p, ";");
        }
        if (pass == 0) {
            hnbrdf_new_line(p, 0);
            hnbrdf_write_expression(p, expression);
            hnbrdf_write(p, ";");
        }
    }
    p->indent--;
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "}");
}

static int write_expression_statement(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *expression = node->first, *call = split_call(expression);
    if (call) {
        write_split(p, expression, call);
        return 1;
    }
    const hnbrdf_node *choice =
        expression->kind == HNBRDF_NODE_ASSIGN && expression->token.text.size == 1
            ? costly_choice(expression->last)
            : NULL;
    const chosen to = {NULL, expression->first};
    if (choice)
        write_if_choice(p, &to, choice);
    else if (expression->kind == HNBRDF_NODE_CALL && expression->type.scalar != HNBRDF_VOID)
        hnbrdf_refuse(p->t, &expression->token, "a value that is not used");
    return choice != NULL;
}

int hnbrdf_wgsl_statement(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *choice;
    const chosen result = {NULL, NULL};
    switch (node->kind) {
    case HNBRDF_NODE_DECLARATION:
    case HNBRDF_NODE_RETURN:
        if (split_call(node)) {
            hnbrdf_refuse(p->t, &node->token, "a part of a variable for an out parameter here");
            return 1;
        }
        choice = node->kind == HNBRDF_NODE_RETURN ? costly_choice(node->first) : NULL;
        if (node->kind == HNBRDF_NODE_DECLARATION)
            write_declaration(p, node);
        else if (choice)
            write_if_choice(p, &result, choice);
        return node->kind == HNBRDF_NODE_DECLARATION || choice;
    case HNBRDF_NODE_IF:
        write_if(p, node);
        return 1;
    case HNBRDF_NODE_FOR:
        write_for(p, node);
        return 1;
    case HNBRDF_NODE_EXPRESSION:
        return write_expression_statement(p, node);
    default:
        return 0;
    }
}
