/* parse.c: what a text consists of: comments, constants, structs, a uniform block, functions. */
#include "language/parse.h"

#include "language/type.h"

/* #define NAME 3.0 */
static hnbrdf_node *parse_constant(hnbrdf_parser *p)
{
    const hnbrdf_token token = hnbrdf_take(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_CONSTANT, &token);
    if (hnbrdf_peek(p)->kind != HNBRDF_TOKEN_CONSTANT_END) {
        hnbrdf_add_child(node, hnbrdf_parse_expression(p));
        node->type = node->first->type;
    }
    const hnbrdf_token end = hnbrdf_take(p);
    if (end.kind != HNBRDF_TOKEN_CONSTANT_END)
        hnbrdf_refuse(p->t, &end, "'%.*s' in a constant", HNBRDF_SPAN(end.text));
    hnbrdf_add_name(p, node);
    return node;
}

static hnbrdf_node *parse_check(hnbrdf_parser *p)
{
    const hnbrdf_token token = hnbrdf_take(p), message = hnbrdf_take(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_CHECK, &token);
    hnbrdf_add_child(node, hnbrdf_make_node(p, HNBRDF_NODE_NAME, &message));
    return node;
}

static void parse_members(hnbrdf_parser *p, hnbrdf_node *node)
{
    const size_t names = p->name_count;
    hnbrdf_expect(p, "{");
    while (!p->t->result) {
        hnbrdf_node *comment = hnbrdf_parse_comment(p);
        if (!comment && hnbrdf_next_is(p, "}"))
            break;
        hnbrdf_add_child(node, comment ? comment : hnbrdf_parse_declaration(p));
    }
    hnbrdf_expect(p, "}");
    p->name_count = names;
}

static hnbrdf_node *parse_struct(hnbrdf_parser *p)
{
    hnbrdf_take(p);
    const hnbrdf_token name = hnbrdf_take(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_STRUCT, &name);
    parse_members(p, node);
    hnbrdf_expect(p, ";");
    hnbrdf_add_name(p, node);
    return node;
}

/* set and binding of "layout(std140, set = 0, binding = 0)", each an INDEX with its number. */
static void parse_layout(hnbrdf_parser *p, hnbrdf_node *block)
{
    if (!hnbrdf_take_if(p, "layout"))
        return;
    hnbrdf_expect(p, "(");
    do {
        const hnbrdf_token word = hnbrdf_take(p);
        if (hnbrdf_take_if(p, "=")) {
            hnbrdf_node *place = hnbrdf_make_node(p, HNBRDF_NODE_INDEX, &word);
            hnbrdf_add_child(place, hnbrdf_parse_expression(p));
            hnbrdf_add_child(block, place);
        }
    } while (hnbrdf_take_if(p, ","));
    hnbrdf_expect(p, ")");
}

/* "layout(...) uniform NAME { vec4 weights[30]; };" */
static hnbrdf_node *parse_block(hnbrdf_parser *p)
{
    const hnbrdf_token begin = *hnbrdf_peek(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_BLOCK, &begin);
    parse_layout(p, node);
    hnbrdf_expect(p, "uniform");
    node->token = hnbrdf_take(p);
    hnbrdf_expect(p, "{");
    hnbrdf_node *declaration = hnbrdf_parse_declaration(p);
    hnbrdf_node *variable = declaration->first;
    hnbrdf_expect(p, "}");
    hnbrdf_expect(p, ";");
    if (p->t->result)
        return node;
    if (variable != declaration->last || !variable->type.length || variable->type.width != 4 ||
        variable->type.scalar != HNBRDF_FLOAT)
        hnbrdf_refuse(p->t, &node->token, "a uniform block that is not one array of vec4");
    variable->global = 1;
    variable->block = node;
    hnbrdf_add_child(node, variable);
    return node;
}

static hnbrdf_node *parse_parameter(hnbrdf_parser *p)
{
    const hnbrdf_token begin = *hnbrdf_peek(p);
    const int inout = hnbrdf_take_if(p, "inout"), out = hnbrdf_take_if(p, "out");
    while (hnbrdf_take_if(p, "const") || hnbrdf_take_if(p, "in")) {
    }
    hnbrdf_type type = hnbrdf_parse_type(p);
    const hnbrdf_token name = hnbrdf_take(p);
    hnbrdf_node *parameter = hnbrdf_make_node(p, HNBRDF_NODE_VARIABLE, &name);
    hnbrdf_parse_length(p, &type);
    parameter->type = type;
    parameter->parameter = 1;
    parameter->output = inout || out;
    parameter->input = inout != 0;
    parameter->own_line = begin.own_line != 0;
    hnbrdf_add_name(p, parameter);
    return parameter;
}

/* Which of the functions of its name it is; its symbol is the first of them. */
static void count_form(const hnbrdf_parser *p, hnbrdf_node *function)
{
    function->symbol = function;
    for (size_t k = p->name_count; k-- > 0;)
        if (p->names[k]->kind == HNBRDF_NODE_FUNCTION &&
            hnbrdf_span_same(p->names[k]->token.text, function->token.text)) {
            function->form++;
            function->symbol = p->names[k];
        }
}

static hnbrdf_node *parse_function(hnbrdf_parser *p)
{
    hnbrdf_take_if(p, "precise"); /* of what is returned: its variables say it too */
    const hnbrdf_type type = hnbrdf_parse_type(p);
    const hnbrdf_token name = hnbrdf_take(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_FUNCTION, &name);
    const size_t names = p->name_count;
    node->type = type;
    count_form(p, node);
    hnbrdf_expect(p, "(");
    if (!hnbrdf_take_if(p, ")")) {
        do
            hnbrdf_add_child(node, parse_parameter(p));
        while (hnbrdf_take_if(p, ","));
        hnbrdf_expect(p, ")");
    }
    p->function = node;
    hnbrdf_add_child(node, hnbrdf_parse_compound(p));
    p->function = NULL;
    p->name_count = names;
    hnbrdf_add_name(p, node);
    return node;
}

/* "precision highp float;": the others have no such thing. */
static int skip_precision(hnbrdf_parser *p)
{
    if (!hnbrdf_take_if(p, "precision"))
        return 0;
    hnbrdf_take(p);
    hnbrdf_take(p);
    hnbrdf_expect(p, ";");
    return 1;
}

static hnbrdf_node *parse_global(hnbrdf_parser *p)
{
    hnbrdf_node *node = hnbrdf_parse_declaration(p);
    for (hnbrdf_node *variable = node->first; variable; variable = variable->next) {
        variable->global = 1;
        if (!variable->constant)
            hnbrdf_refuse(p->t, &variable->token, "a global variable that is not const");
    }
    return node;
}

static hnbrdf_node *parse_items(hnbrdf_parser *p, hnbrdf_node *into);

static hnbrdf_node *parse_item(hnbrdf_parser *p)
{
    const hnbrdf_token token = *hnbrdf_peek(p);
    switch (token.kind) {
    case HNBRDF_TOKEN_CONSTANT:
        return parse_constant(p);
    case HNBRDF_TOKEN_CHECK:
        return parse_check(p);
    case HNBRDF_TOKEN_GUARD:
        hnbrdf_take(p);
        return parse_items(p, hnbrdf_make_node(p, HNBRDF_NODE_GUARD, &token));
    default:
        break;
    }
    if (hnbrdf_next_is(p, "struct"))
        return parse_struct(p);
    if (hnbrdf_next_is(p, "layout") || hnbrdf_next_is(p, "uniform"))
        return parse_block(p);
    return hnbrdf_next_is(p, "const") ? parse_global(p) : parse_function(p);
}

/* Up to the end of what is guarded, or of the text. */
static hnbrdf_node *parse_items(hnbrdf_parser *p, hnbrdf_node *into)
{
    while (!p->t->result) {
        const hnbrdf_token token = p->t->tokens.list[p->at];
        hnbrdf_node *item = hnbrdf_parse_comment(p);
        if (token.kind == HNBRDF_TOKEN_END)
            break;
        if (token.kind == HNBRDF_TOKEN_GUARD_END) {
            p->at++;
            break;
        }
        if (!item && skip_precision(p))
            continue;
        if (!item) {
            item = parse_item(p);
            item->after_blank = token.after_blank != 0;
        }
        hnbrdf_add_comments(p, into);
        hnbrdf_add_child(into, item);
    }
    return into;
}

hnbrdf_node *hnbrdf_parse_text(hnbrdf_parser *p)
{
    hnbrdf_node *text = hnbrdf_make_node(p, HNBRDF_NODE_TEXT, &p->t->tokens.list[p->at]);
    p->text = text;
    parse_items(p, text);
    if (!p->t->result && p->t->tokens.list[p->at].kind != HNBRDF_TOKEN_END)
        hnbrdf_refuse(p->t, &p->t->tokens.list[p->at], "what is behind the guard of the text");
    p->at++;
    return text;
}
