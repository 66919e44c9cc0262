/* glsl_plain.c: GLSL as it is, but for its directives: what is left when they are resolved, with
 * constants in place of macros. */
#include "language/c_like.h"

#include "language/type.h"

static const char *const types[][5] = {
    [HNBRDF_VOID] = {NULL, "void"},
    [HNBRDF_BOOL] = {NULL, "bool", "bvec2", "bvec3", "bvec4"},
    [HNBRDF_INT] = {NULL, "int", "ivec2", "ivec3", "ivec4"},
    [HNBRDF_UINT] = {NULL, "uint", "uvec2", "uvec3", "uvec4"},
    [HNBRDF_FLOAT] = {NULL, "float", "vec2", "vec3", "vec4"},
    [HNBRDF_FLOAT16] = {NULL, "float", "vec2", "vec3", "vec4"},
};

static const char *const reserved[] = {NULL};

static const char *builtin(const hnbrdf_builtin *function)
{
    return function->name;
}

/* Whole vectors, which other languages compare number by number. */
static int write_equality(hnbrdf_print *p, const hnbrdf_node *node)
{
    const char sign = node->token.text.at[0];
    if (sign != '=' && sign != '!')
        return 0;
    hnbrdf_write_expression(p, node->first);
    hnbrdf_write(p, sign == '=' ? " == " : " != ");
    hnbrdf_write_expression(p, node->last);
    return 1;
}

/* And functions that they have operators for. */
static int expression(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->kind == HNBRDF_NODE_BINARY)
        return write_equality(p, node);
    if (node->kind != HNBRDF_NODE_BUILTIN || node->builtin->shape != HNBRDF_SHAPE_RELATION)
        return 0;
    hnbrdf_write(p, node->builtin->name);
    hnbrdf_write(p, "(");
    hnbrdf_write_list(p, node->first);
    hnbrdf_write(p, ")");
    return 1;
}

static int statement(hnbrdf_print *p, const hnbrdf_node *node)
{
    (void)p;
    (void)node;
    return 0;
}

static int item(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->kind != HNBRDF_NODE_CONSTANT)
        return hnbrdf_c_item(p, node, "const ");
    if (!node->first)
        return 1;
    hnbrdf_new_line(p, node->after_blank);
    hnbrdf_write(p, "const ");
    hnbrdf_write_type(p, node->first->type);
    hnbrdf_write(p, " ");
    hnbrdf_write_span(p, node->token.text);
    hnbrdf_write(p, " = ");
    hnbrdf_write_expression(p, node->first);
    hnbrdf_write(p, ";");
    return 1;
}

static void function(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_c_head(p, node, "out ", "inout ", " ");
    hnbrdf_write(p, ")");
    hnbrdf_c_body(p, node);
}

static void block(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_refuse(p->t, &node->token, "a uniform block");
}

const hnbrdf_dialect hnbrdf_glsl_plain = {.name = "glsl",
                                          .capital = "GLSL",
                                          .types = types,
                                          .suffix = "",
                                          .reserved = reserved,
                                          .item = item,
                                          .statement = statement,
                                          .expression = expression,
                                          .function = function,
                                          .structure = hnbrdf_c_struct,
                                          .block = block,
                                          .builtin = builtin};
