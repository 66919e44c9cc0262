/* print_statement.c: statements, as C has them. */
#include "language/print.h"

#include "language/type.h"

void hnbrdf_write_body(hnbrdf_print *p, const hnbrdf_node *compound)
{
    p->indent++;
    for (const hnbrdf_node *node = compound->first; node; node = node->next)
        hnbrdf_write_statement(p, node);
    p->indent--;
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "}");
}

/* What an if or a for does: in braces where it was. */
static void write_inner(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->kind == HNBRDF_NODE_COMPOUND) {
        hnbrdf_write(p, " {");
        hnbrdf_write_body(p, node);
        return;
    }
    p->indent++;
    hnbrdf_write_statement(p, node);
    p->indent--;
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
    if (yes->kind == HNBRDF_NODE_COMPOUND)
        hnbrdf_write(p, " ");
    else
        hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "else");
    if (no->kind == HNBRDF_NODE_IF) {
        hnbrdf_write(p, " ");
        write_if(p, no);
    } else {
        write_inner(p, no);
    }
}

/* "float a = 1.0, b[3]", without the end. */
static void write_declaration(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *first = node->first;
    if (first->constant)
        hnbrdf_write(p, "const ");
    if (first->precise && p->dialect->precise && node->type.scalar != HNBRDF_FLOAT16) /* FXC */
        hnbrdf_write(p, "precise ");
    hnbrdf_write_type(p, node->type);
    for (const hnbrdf_node *variable = first; variable; variable = variable->next) {
        hnbrdf_write(p, variable == first ? " " : ", ");
        hnbrdf_write_variable(p, variable);
        if (variable->type.length) {
            hnbrdf_write(p, "[");
            hnbrdf_write_expression(p, variable->type.length);
            hnbrdf_write(p, "]");
        }
        if (variable->first) {
            hnbrdf_write(p, " =");
            hnbrdf_write_break(p, variable->first->own_line, " ");
            hnbrdf_write_expression(p, variable->first);
        }
    }
}

static void write_for(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *condition = node->first->next, *step = condition->next;
    hnbrdf_write(p, "for (");
    write_declaration(p, node->first);
    hnbrdf_write(p, "; ");
    hnbrdf_write_expression(p, condition);
    hnbrdf_write(p, "; ");
    hnbrdf_write_expression(p, step);
    hnbrdf_write(p, ")");
    write_inner(p, step->next);
}

void hnbrdf_write_statement(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->kind == HNBRDF_NODE_COMMENT) {
        hnbrdf_write_comment(p, node);
        return;
    }
    hnbrdf_new_line(p, node->after_blank);
    if (p->dialect->statement(p, node))
        return;
    switch (node->kind) {
    case HNBRDF_NODE_IF:
        write_if(p, node);
        return;
    case HNBRDF_NODE_FOR:
        write_for(p, node);
        return;
    case HNBRDF_NODE_COMPOUND:
        hnbrdf_write(p, "{");
        hnbrdf_write_body(p, node);
        return;
    case HNBRDF_NODE_DECLARATION:
        write_declaration(p, node);
        break;
    case HNBRDF_NODE_EXPRESSION:
        hnbrdf_write_expression(p, node->first);
        break;
    case HNBRDF_NODE_RETURN:
        hnbrdf_write(p, "return");
        if (node->first) {
            hnbrdf_write_break(p, node->first->own_line, " ");
            hnbrdf_write_expression(p, node->first);
        }
        break;
    case HNBRDF_NODE_JUMP:
        hnbrdf_write_span(p, node->token.text);
        break;
    default:
        hnbrdf_refuse(p->t, &node->token, "'%.*s' is not translated",
                      HNBRDF_SPAN(node->token.text));
    }
    hnbrdf_write(p, ";");
}
