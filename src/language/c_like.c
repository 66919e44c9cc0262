/* c_like.c: what HLSL, Slang and MSL have in common. */
#include "language/c_like.h"

#include "language/type.h"

/* ---- Constants ------------------------------------------------------------------------------- */

static void write_define(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_new_line(p, node->after_blank);
    hnbrdf_write(p, "#define ");
    hnbrdf_write_span(p, node->token.text);
    if (!node->first)
        return;
    hnbrdf_write(p, hnbrdf_is_single(node->first) ? " " : " (");
    hnbrdf_write_expression(p, node->first);
    hnbrdf_write(p, hnbrdf_is_single(node->first) ? "" : ")");
}

/* const float a[2] = float[](1.0, 2.0); */
static void write_global(hnbrdf_print *p, const hnbrdf_node *node, const char *constant)
{
    for (const hnbrdf_node *variable = node->first; variable; variable = variable->next) {
        const hnbrdf_node *value = variable->first;
        const int list = variable->type.length && value && value->kind == HNBRDF_NODE_CONSTRUCT;
        hnbrdf_new_line(p, variable == node->first && node->after_blank);
        hnbrdf_write(p, constant);
        hnbrdf_write_type(p, node->type);
        hnbrdf_write(p, " ");
        hnbrdf_write_name(p, variable->token.text);
        if (variable->type.length) {
            hnbrdf_write(p, "[");
            hnbrdf_write_expression(p, variable->type.length);
            hnbrdf_write(p, "]");
        }
        hnbrdf_write(p, list ? " = {" : " = ");
        if (list)
            hnbrdf_write_list(p, value->first);
        else if (value)
            hnbrdf_write_expression(p, value);
        else
            hnbrdf_refuse(p->t, &variable->token, "a constant without a value");
        hnbrdf_write(p, list ? "};" : ";");
    }
}

int hnbrdf_c_item(hnbrdf_print *p, const hnbrdf_node *node, const char *constant)
{
    if (node->kind == HNBRDF_NODE_CONSTANT)
        write_define(p, node);
    else if (node->kind == HNBRDF_NODE_DECLARATION)
        write_global(p, node, constant);
    else
        return 0;
    return 1;
}

/* ---- Structs and functions ------------------------------------------------------------------- */

void hnbrdf_c_member(hnbrdf_print *p, const hnbrdf_node *declaration)
{
    hnbrdf_write_statement(p, declaration);
}

void hnbrdf_c_struct(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_write(p, "struct ");
    hnbrdf_write_name(p, node->token.text);
    hnbrdf_write(p, " {");
    p->indent++;
    hnbrdf_write_members(p, node, hnbrdf_c_member);
    p->indent--;
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "};");
}

void hnbrdf_c_head(hnbrdf_print *p, const hnbrdf_node *function, const char *out, const char *inout,
                   const char *behind)
{
    const hnbrdf_node *parameter = function->first;
    hnbrdf_write_type(p, function->type);
    hnbrdf_write(p, " ");
    hnbrdf_write_name(p, function->token.text);
    hnbrdf_write(p, "(");
    for (; parameter->kind == HNBRDF_NODE_VARIABLE; parameter = parameter->next) {
        if (parameter != function->first)
            hnbrdf_write(p, parameter->own_line ? "," : ", ");
        hnbrdf_write_break(p, parameter->own_line, "");
        if (parameter->output)
            hnbrdf_write(p, parameter->input ? inout : out);
        hnbrdf_write_type(p, parameter->type);
        hnbrdf_write(p, parameter->output ? behind : " ");
        hnbrdf_write_name(p, parameter->token.text);
        if (parameter->type.length)
            hnbrdf_refuse(p->t, &parameter->token, "an array as a parameter");
    }
}

void hnbrdf_c_body(hnbrdf_print *p, const hnbrdf_node *function)
{
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "{");
    hnbrdf_write_body(p, function->last);
}
