/* type.c: types of expressions: GLSL's rules without implicit conversions. */
#include "language/type.h"

#include <string.h>

/* ---- Names ----------------------------------------------------------------------------------- */

static const char *const names[][5] = {
    [HNBRDF_VOID] = {NULL, "void"},
    [HNBRDF_BOOL] = {NULL, "bool", "bvec2", "bvec3", "bvec4"},
    [HNBRDF_INT] = {NULL, "int", "ivec2", "ivec3", "ivec4"},
    [HNBRDF_UINT] = {NULL, "uint", "uvec2", "uvec3", "uvec4"},
    [HNBRDF_FLOAT] = {NULL, "float", "vec2", "vec3", "vec4"},
    [HNBRDF_FLOAT16] = {NULL, "float16_t", "f16vec2", "f16vec3", "f16vec4"},
};

hnbrdf_type hnbrdf_type_of_name(hnbrdf_span name)
{
    for (int scalar = HNBRDF_VOID; scalar <= HNBRDF_FLOAT16; scalar++)
        for (int width = 1; width <= 4; width++)
            if (names[scalar][width] && hnbrdf_span_is(name, names[scalar][width]))
                return (hnbrdf_type){.scalar = (hnbrdf_scalar)scalar, .width = width};
    return (hnbrdf_type){.scalar = HNBRDF_VOID};
}

hnbrdf_span hnbrdf_type_name(hnbrdf_type type)
{
    if (type.structure)
        return type.structure->token.text;
    const char *name = names[type.scalar][type.width > 0 ? type.width : 1];
    return (hnbrdf_span){name, strlen(name)};
}

int hnbrdf_same_type(hnbrdf_type a, hnbrdf_type b)
{
    return a.scalar == b.scalar && a.width == b.width && a.structure == b.structure &&
           !a.length == !b.length;
}

int hnbrdf_is_number(hnbrdf_type type)
{
    return type.scalar >= HNBRDF_INT && type.scalar <= HNBRDF_FLOAT16 && !type.length;
}

static int is_real(hnbrdf_type type)
{
    return (type.scalar == HNBRDF_FLOAT || type.scalar == HNBRDF_FLOAT16) && !type.length;
}

static int is_whole(hnbrdf_type type)
{
    return (type.scalar == HNBRDF_INT || type.scalar == HNBRDF_UINT) && !type.length;
}

static hnbrdf_type with_width(hnbrdf_scalar scalar, int width)
{
    return (hnbrdf_type){.scalar = scalar, .width = width};
}

/* ---- Operators ------------------------------------------------------------------------------- */

/* Sets the type of + - * /: the same numbers, vectors of one width or with a single number. */
static int type_arithmetic(hnbrdf_node *node, hnbrdf_type a, hnbrdf_type b)
{
    if (!hnbrdf_is_number(a) || a.scalar != b.scalar || b.length ||
        (a.width != b.width && a.width != 1 && b.width != 1))
        return 0;
    node->type = with_width(a.scalar, a.width > b.width ? a.width : b.width);
    return 1;
}

static int type_operator(hnbrdf_node *node, hnbrdf_span sign, hnbrdf_type a, hnbrdf_type b)
{
    const int single = a.width == 1 && b.width == 1;
    switch (sign.at[0]) {
    case '+':
    case '-':
    case '*':
    case '/':
        return type_arithmetic(node, a, b);
    case '%':
        return is_whole(a) && type_arithmetic(node, a, b);
    case '=':
    case '!':
        node->type = with_width(HNBRDF_BOOL, 1);
        return hnbrdf_same_type(a, b) && !a.structure && !a.length;
    case '&':
    case '|':
    case '^':
        if (sign.size == 2) {
            node->type = with_width(HNBRDF_BOOL, 1);
            return single && a.scalar == HNBRDF_BOOL && b.scalar == HNBRDF_BOOL &&
                   sign.at[0] != '^';
        }
        return is_whole(a) && single && type_arithmetic(node, a, b);
    default:
        if (sign.size == 2 && sign.at[0] == sign.at[1]) { /* << >> */
            node->type = a;
            return single && is_whole(a) && is_whole(b);
        }
        node->type = with_width(HNBRDF_BOOL, 1);
        return single && hnbrdf_is_number(a) && hnbrdf_same_type(a, b);
    }
}

void hnbrdf_type_binary(hnbrdf_translation *t, hnbrdf_node *node)
{
    const hnbrdf_type a = node->first->type, b = node->last->type;
    if (!type_operator(node, node->token.text, a, b))
        hnbrdf_refuse(t, &node->token, "%.*s %.*s %.*s", HNBRDF_SPAN(hnbrdf_type_name(a)),
                      HNBRDF_SPAN(node->token.text), HNBRDF_SPAN(hnbrdf_type_name(b)));
}

void hnbrdf_type_unary(hnbrdf_translation *t, hnbrdf_node *node)
{
    const char sign = node->token.text.at[0];
    const hnbrdf_type type = node->type = node->first->type;
    if (sign == '!'   ? type.scalar != HNBRDF_BOOL || type.width != 1
        : sign == '~' ? !is_whole(type)
                      : !hnbrdf_is_number(type))
        hnbrdf_refuse(t, &node->token, "%c %.*s", sign, HNBRDF_SPAN(hnbrdf_type_name(type)));
}

/* ---- Calls ----------------------------------------------------------------------------------- */

/* Arguments after the first are of its type, or single numbers of its kind where that is allowed;
 * mix and clamp take them anywhere behind, step and smoothstep before. */
static int arguments_fit(const hnbrdf_node *node, hnbrdf_type *widest)
{
    *widest = node->first->type;
    for (const hnbrdf_node *a = node->first; a; a = a->next)
        if (a->type.width > widest->width)
            *widest = a->type;
    for (const hnbrdf_node *a = node->first; a; a = a->next)
        if (a->type.scalar != widest->scalar || a->type.length ||
            (a->type.width != widest->width && a->type.width != 1))
            return 0;
    return 1;
}

static int fits(const hnbrdf_node *node, hnbrdf_type *result)
{
    hnbrdf_type widest;
    if (!arguments_fit(node, &widest))
        return 0;
    *result = widest;
    switch (node->builtin->shape) {
    case HNBRDF_SHAPE_T:
        return is_real(widest);
    case HNBRDF_SHAPE_NUMBERS:
        return hnbrdf_is_number(widest);
    case HNBRDF_SHAPE_SCALAR:
        *result = with_width(widest.scalar, 1);
        return is_real(widest);
    case HNBRDF_SHAPE_BITS:
        *result = with_width(node->builtin->result, widest.width);
        return widest.scalar != HNBRDF_FLOAT16 && widest.scalar != node->builtin->result &&
               hnbrdf_is_number(widest);
    case HNBRDF_SHAPE_RELATION:
        *result = with_width(HNBRDF_BOOL, widest.width);
        return widest.width > 1 && node->first->type.width == node->last->type.width;
    default:
        *result = with_width(HNBRDF_BOOL, 1);
        return widest.scalar == HNBRDF_BOOL && widest.width > 1;
    }
}

void hnbrdf_type_builtin(hnbrdf_translation *t, hnbrdf_node *node)
{
    if (!fits(node, &node->type))
        hnbrdf_refuse(t, &node->token, "%.*s(%.*s, ...)", HNBRDF_SPAN(node->token.text),
                      HNBRDF_SPAN(hnbrdf_type_name(node->first->type)));
}

/* ---- Constructors ---------------------------------------------------------------------------- */

static int constructs_structure(const hnbrdf_node *node)
{
    const hnbrdf_node *argument = node->first;
    for (const hnbrdf_node *list = node->type.structure->first; list; list = list->next) {
        const hnbrdf_node *member = list->kind == HNBRDF_NODE_DECLARATION ? list->first : NULL;
        for (; member; member = member->next) {
            if (!argument || !hnbrdf_same_type(member->type, argument->type))
                return 0;
            argument = argument->next;
        }
    }
    return !argument;
}

static int constructs_vector(const hnbrdf_node *node)
{
    int width = 0;
    for (const hnbrdf_node *a = node->first; a; a = a->next) {
        const int number = hnbrdf_is_number(a->type) || a->type.scalar == HNBRDF_BOOL;
        if (!number || a->type.length)
            return 0;
        width += a->type.width;
    }
    const int one = node->first && !node->first->next;
    return width == node->type.width || (one && width == 1);
}

/* float[](1.0, 2.0) */
static int constructs_array(const hnbrdf_node *node)
{
    hnbrdf_type element = node->type;
    element.length = NULL;
    for (const hnbrdf_node *a = node->first; a; a = a->next)
        if (!hnbrdf_same_type(element, a->type))
            return 0;
    return node->first != NULL;
}

void hnbrdf_type_construct(hnbrdf_translation *t, hnbrdf_node *node)
{
    if (!(node->type.length      ? constructs_array(node)
          : node->type.structure ? constructs_structure(node)
                                 : constructs_vector(node)))
        hnbrdf_refuse(t, &node->token, "%.*s(...) with other arguments than its members",
                      HNBRDF_SPAN(hnbrdf_type_name(node->type)));
}

void hnbrdf_type_swizzle(hnbrdf_translation *t, hnbrdf_node *node)
{
    static const char *const sets[] = {"xyzw", "rgba"};
    const hnbrdf_type of = node->first->type;
    const hnbrdf_span name = node->token.text;
    const char *set = name.size > 0 && strchr(sets[1], name.at[0]) ? sets[1] : sets[0];
    int known = of.width > 1 && !of.length && name.size >= 1 && name.size <= 4;
    for (size_t k = 0; known && k < name.size; k++) {
        const char *at = (const char *)memchr(set, name.at[k], (size_t)of.width);
        known = at != NULL;
    }
    node->type = with_width(of.scalar, (int)name.size);
    if (!known)
        hnbrdf_refuse(t, &node->token, "%.*s has no .%.*s", HNBRDF_SPAN(hnbrdf_type_name(of)),
                      HNBRDF_SPAN(name));
}
