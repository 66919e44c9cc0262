/* parse_expression.c: expressions, and the statements that are expressions. */
#include "language/parse.h"

#include "language/type.h"

#include <string.h>

static hnbrdf_type boolean(void)
{
    return (hnbrdf_type){.scalar = HNBRDF_BOOL, .width = 1};
}

static void must_be(hnbrdf_parser *p, const hnbrdf_node *node, hnbrdf_type type, const char *what)
{
    if (!hnbrdf_same_type(node->type, type))
        hnbrdf_refuse(p->t, &node->token, "%s is %.*s, expected %.*s", what,
                      HNBRDF_SPAN(hnbrdf_type_name(node->type)),
                      HNBRDF_SPAN(hnbrdf_type_name(type)));
}

/* ---- Calls ----------------------------------------------------------------------------------- */

static void parse_arguments(hnbrdf_parser *p, hnbrdf_node *call)
{
    hnbrdf_expect(p, "(");
    if (hnbrdf_take_if(p, ")"))
        return;
    do {
        const int own_line = hnbrdf_peek(p)->own_line;
        hnbrdf_node *argument = hnbrdf_parse_expression(p);
        argument->own_line = own_line != 0;
        hnbrdf_add_child(call, argument);
    } while (hnbrdf_take_if(p, ","));
    hnbrdf_expect(p, ")");
}

static int accepts(const hnbrdf_node *function, const hnbrdf_node *call)
{
    const hnbrdf_node *argument = call->first, *parameter = function->first;
    for (; parameter && parameter->kind == HNBRDF_NODE_VARIABLE; parameter = parameter->next) {
        if (!argument || !hnbrdf_same_type(argument->type, parameter->type))
            return 0;
        argument = argument->next;
    }
    return !argument;
}

/* The variable that an expression is part of, or NULL. */
static hnbrdf_node *root_of(hnbrdf_node *node)
{
    while (node->kind == HNBRDF_NODE_MEMBER || node->kind == HNBRDF_NODE_SWIZZLE ||
           node->kind == HNBRDF_NODE_INDEX || node->kind == HNBRDF_NODE_BRACKET)
        node = node->first;
    return node->kind == HNBRDF_NODE_NAME && node->symbol->kind == HNBRDF_NODE_VARIABLE
               ? node->symbol
               : NULL;
}

/* What is assigned to must be a variable; a single component at most of a vector. */
static void assign(hnbrdf_parser *p, hnbrdf_node *target)
{
    hnbrdf_node *variable = root_of(target);
    if (!variable || variable->constant || variable->global)
        hnbrdf_refuse(p->t, &target->token, "'%.*s' cannot be assigned to",
                      HNBRDF_SPAN(target->token.text));
    else if (target->kind == HNBRDF_NODE_SWIZZLE && target->type.width > 1)
        hnbrdf_refuse(p->t, &target->token, "several components '.%.*s' assigned to at once",
                      HNBRDF_SPAN(target->token.text));
    else
        variable->assigned = 1;
}

static void use_block(hnbrdf_parser *p, hnbrdf_node *block, const hnbrdf_token *at)
{
    if (!block || !p->function)
        return;
    if (p->function->block && p->function->block != block)
        hnbrdf_refuse(p->t, at, "a function that reads two uniform blocks");
    p->function->block = block;
}

static void resolve_call(hnbrdf_parser *p, hnbrdf_node *call)
{
    for (size_t k = p->name_count; k-- > 0;) {
        hnbrdf_node *function = p->names[k];
        if (function->kind != HNBRDF_NODE_FUNCTION ||
            !hnbrdf_span_same(function->token.text, call->token.text) || !accepts(function, call))
            continue;
        call->symbol = function;
        call->type = function->type;
        hnbrdf_node *argument = call->first;
        for (hnbrdf_node *q = function->first; argument; q = q->next, argument = argument->next)
            if (q->output)
                assign(p, argument);
        use_block(p, function->block, &call->token);
        return;
    }
    hnbrdf_refuse(p->t, &call->token, "no function %.*s for these arguments",
                  HNBRDF_SPAN(call->token.text));
}

static hnbrdf_node *parse_call(hnbrdf_parser *p)
{
    const hnbrdf_token name = hnbrdf_take(p);
    hnbrdf_node *call = hnbrdf_make_node(p, HNBRDF_NODE_CALL, &name);
    int count = 0;
    parse_arguments(p, call);
    if (p->t->result)
        return call;
    for (const hnbrdf_node *a = call->first; a; a = a->next)
        count++;
    call->builtin = hnbrdf_find_builtin(name.text, count);
    if (call->builtin) {
        call->kind = HNBRDF_NODE_BUILTIN;
        hnbrdf_type_builtin(p->t, call);
    } else {
        resolve_call(p, call);
    }
    return call;
}

/* vec3(...), hnbrdf_lobes(...), float[](...). */
static hnbrdf_node *parse_construct(hnbrdf_parser *p)
{
    const hnbrdf_token name = *hnbrdf_peek(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_CONSTRUCT, &name);
    node->type = hnbrdf_parse_type(p);
    parse_arguments(p, node);
    if (!p->t->result)
        hnbrdf_type_construct(p->t, node);
    return node;
}

/* ---- Primary expressions --------------------------------------------------------------------- */

static hnbrdf_node *parse_number(hnbrdf_parser *p)
{
    const hnbrdf_token token = hnbrdf_take(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_NUMBER, &token);
    const hnbrdf_span text = token.text;
    const int hexadecimal = text.size > 1 && (text.at[1] == 'x' || text.at[1] == 'X');
    const char last = text.at[text.size - 1];
    node->type.width = 1;
    node->type.scalar = HNBRDF_INT;
    if (last == 'u' || last == 'U')
        node->type.scalar = HNBRDF_UINT;
    else if (!hexadecimal && (memchr(text.at, '.', text.size) || memchr(text.at, 'e', text.size) ||
                              memchr(text.at, 'E', text.size)))
        node->type.scalar = HNBRDF_FLOAT;
    if (!hexadecimal && strchr("fFlLhH", last))
        hnbrdf_refuse(p->t, &token, "a number with a letter, %.*s", HNBRDF_SPAN(text));
    return node;
}

static hnbrdf_node *parse_name(hnbrdf_parser *p)
{
    const hnbrdf_token token = hnbrdf_take(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_NAME, &token);
    node->symbol = hnbrdf_find_name(p, token.text);
    if (hnbrdf_span_is(token.text, "true") || hnbrdf_span_is(token.text, "false")) {
        node->kind = HNBRDF_NODE_NUMBER;
        node->type = boolean();
    } else if (!node->symbol || (node->symbol->kind != HNBRDF_NODE_VARIABLE &&
                                 node->symbol->kind != HNBRDF_NODE_CONSTANT)) {
        hnbrdf_refuse(p->t, &token, "'%.*s' is not known", HNBRDF_SPAN(token.text));
    } else {
        node->type = node->symbol->type;
        use_block(p, node->symbol->block, &token);
    }
    return node;
}

static hnbrdf_node *parse_primary(hnbrdf_parser *p)
{
    const hnbrdf_token token = *hnbrdf_peek(p);
    if (token.kind == HNBRDF_TOKEN_NUMBER)
        return parse_number(p);
    if (hnbrdf_take_if(p, "(")) {
        hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_BRACKET, &token);
        hnbrdf_add_child(node, hnbrdf_parse_expression(p));
        node->type = node->first->type;
        hnbrdf_expect(p, ")");
        return node;
    }
    if (token.kind != HNBRDF_TOKEN_NAME) {
        if (token.kind == HNBRDF_TOKEN_END)
            hnbrdf_refuse(p->t, &token, "found the end, expected more");
        hnbrdf_refuse(p->t, &token, "found '%.*s', expected an expression",
                      HNBRDF_SPAN(token.text));
        return hnbrdf_make_node(p, HNBRDF_NODE_NUMBER, &token);
    }
    const hnbrdf_node *named = hnbrdf_find_name(p, token.text);
    if (hnbrdf_type_of_name(token.text).width > 0 || (named && named->kind == HNBRDF_NODE_STRUCT))
        return parse_construct(p);
    const hnbrdf_token *after = &p->t->tokens.list[p->at + 1];
    return after->kind == HNBRDF_TOKEN_SIGN && hnbrdf_span_is(after->text, "(") ? parse_call(p)
                                                                                : parse_name(p);
}

static hnbrdf_node *parse_member(hnbrdf_parser *p, hnbrdf_node *of)
{
    const hnbrdf_token name = hnbrdf_take(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_SWIZZLE, &name);
    hnbrdf_add_child(node, of);
    if (!of->type.structure) {
        hnbrdf_type_swizzle(p->t, node);
        return node;
    }
    node->kind = HNBRDF_NODE_MEMBER;
    for (const hnbrdf_node *list = of->type.structure->first; list; list = list->next)
        for (hnbrdf_node *member = list->first; member; member = member->next)
            if (hnbrdf_span_same(member->token.text, name.text)) {
                node->symbol = member;
                node->type = member->type;
                return node;
            }
    hnbrdf_refuse(p->t, &name, "%.*s has no member %.*s", HNBRDF_SPAN(hnbrdf_type_name(of->type)),
                  HNBRDF_SPAN(name.text));
    return node;
}

static hnbrdf_node *parse_index(hnbrdf_parser *p, hnbrdf_node *of, const hnbrdf_token *sign)
{
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_INDEX, sign);
    hnbrdf_add_child(node, of);
    hnbrdf_add_child(node, hnbrdf_parse_expression(p));
    hnbrdf_expect(p, "]");
    node->type = of->type;
    if (of->type.length)
        node->type.length = NULL;
    else if (of->type.width > 1)
        node->type.width = 1;
    else
        hnbrdf_refuse(p->t, sign, "an index of what is no array");
    return node;
}

static hnbrdf_node *parse_postfix(hnbrdf_parser *p)
{
    hnbrdf_node *node = parse_primary(p);
    while (!p->t->result) {
        const hnbrdf_token sign = *hnbrdf_peek(p);
        if (hnbrdf_take_if(p, "."))
            node = parse_member(p, node);
        else if (hnbrdf_take_if(p, "["))
            node = parse_index(p, node, &sign);
        else
            break;
    }
    return node;
}

/* ---- Operators ------------------------------------------------------------------------------- */

static int too_deep(hnbrdf_parser *p)
{
    if (p->depth >= HNBRDF_MAX_DEPTH)
        hnbrdf_refuse(p->t, hnbrdf_peek(p), "more than %d brackets within each other",
                      HNBRDF_MAX_DEPTH);
    return p->t->result != HNBRDF_OK;
}

static hnbrdf_node *parse_unary(hnbrdf_parser *p)
{
    const hnbrdf_token sign = *hnbrdf_peek(p);
    if (sign.kind != HNBRDF_TOKEN_SIGN || sign.text.size != 1 || !strchr("+-!~", sign.text.at[0]) ||
        too_deep(p))
        return parse_postfix(p);
    hnbrdf_take(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_UNARY, &sign);
    p->depth++;
    hnbrdf_add_child(node, parse_unary(p));
    p->depth--;
    if (!p->t->result)
        hnbrdf_type_unary(p->t, node);
    return node;
}

/* How tightly an operator binds, from 1 on; 0: no operator. */
static int binds(const hnbrdf_token *token)
{
    static const char *const levels[][5] = {{"||"},
                                            {"&&"},
                                            {"|"},
                                            {"^"},
                                            {"&"},
                                            {"==", "!="},
                                            {"<", ">", "<=", ">="},
                                            {"<<", ">>"},
                                            {"+", "-"},
                                            {"*", "/", "%"}};
    for (int level = 0; token->kind == HNBRDF_TOKEN_SIGN && level < 10; level++)
        for (int k = 0; levels[level][k]; k++)
            if (hnbrdf_span_is(token->text, levels[level][k]))
                return level + 1;
    return 0;
}

static hnbrdf_node *parse_binary(hnbrdf_parser *p, int level)
{
    hnbrdf_node *left = parse_unary(p);
    for (;;) {
        const hnbrdf_token sign = *hnbrdf_peek(p);
        const int tight = binds(&sign);
        if (tight == 0 || tight < level || p->t->result)
            return left;
        hnbrdf_take(p);
        hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_BINARY, &sign);
        const int own_line = hnbrdf_peek(p)->own_line;
        hnbrdf_node *right = parse_binary(p, tight + 1);
        node->breaks = sign.own_line != 0;
        right->own_line = own_line != 0;
        hnbrdf_add_child(node, left);
        hnbrdf_add_child(node, right);
        if (!p->t->result)
            hnbrdf_type_binary(p->t, node);
        left = node;
    }
}

hnbrdf_node *hnbrdf_parse_expression(hnbrdf_parser *p)
{
    const int deep = too_deep(p);
    p->depth++;
    hnbrdf_node *condition = parse_binary(p, 1);
    const hnbrdf_token sign = *hnbrdf_peek(p);
    if (!deep && hnbrdf_take_if(p, "?")) {
        hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_CHOICE, &sign);
        hnbrdf_add_child(node, condition);
        for (int k = 0; k < 2; k++) {
            const hnbrdf_token before = *hnbrdf_peek(p);
            hnbrdf_node *value = hnbrdf_parse_expression(p);
            value->own_line = before.own_line != 0;
            hnbrdf_add_child(node, value);
            if (k == 0)
                hnbrdf_expect(p, ":");
        }
        node->type = node->last->type;
        if (!p->t->result) {
            must_be(p, condition, boolean(), "a condition");
            must_be(p, condition->next, node->type, "one of two choices");
        }
        condition = node;
    }
    p->depth--;
    return condition;
}

hnbrdf_node *hnbrdf_parse_assignment(hnbrdf_parser *p)
{
    static const char *const signs[] = {"=", "+=", "-=", "*=", "/=", "&=", "|="};
    hnbrdf_node *target = hnbrdf_parse_expression(p);
    const hnbrdf_token sign = *hnbrdf_peek(p);
    if (hnbrdf_take_if(p, "++") || hnbrdf_take_if(p, "--")) {
        hnbrdf_node *step = hnbrdf_make_node(p, HNBRDF_NODE_STEP, &sign);
        hnbrdf_add_child(step, target);
        step->type = target->type;
        assign(p, target);
        return step;
    }
    for (size_t k = 0; k < sizeof signs / sizeof signs[0]; k++) {
        if (!hnbrdf_take_if(p, signs[k]))
            continue;
        hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_ASSIGN, &sign);
        hnbrdf_add_child(node, target);
        const int own_line = hnbrdf_peek(p)->own_line;
        hnbrdf_node *value = hnbrdf_parse_expression(p);
        value->own_line = own_line != 0;
        hnbrdf_add_child(node, value);
        node->type = target->type;
        if (!p->t->result)
            assign(p, target);
        if (!p->t->result && (k == 0 || value->type.width != 1))
            must_be(p, value, target->type, "what is assigned");
        return node;
    }
    return target;
}
