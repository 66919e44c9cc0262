/* parse_statement.c: statements and declarations of variables. */
#include "language/parse.h"

#include "language/type.h"

/* ---- Declarations ---------------------------------------------------------------------------- */

static hnbrdf_node *parse_variable(hnbrdf_parser *p, hnbrdf_type type)
{
    const hnbrdf_token name = hnbrdf_take(p);
    hnbrdf_node *variable = hnbrdf_make_node(p, HNBRDF_NODE_VARIABLE, &name);
    variable->own_line = name.own_line != 0;
    if (name.kind != HNBRDF_TOKEN_NAME)
        hnbrdf_refuse(p->t, &name, "found '%.*s', expected a name", HNBRDF_SPAN(name.text));
    hnbrdf_parse_length(p, &type);
    variable->type = type;
    if (hnbrdf_take_if(p, "=")) {
        const int own_line = hnbrdf_peek(p)->own_line;
        hnbrdf_node *value = hnbrdf_parse_expression(p);
        value->own_line = own_line != 0;
        if (!p->t->result && !hnbrdf_same_type(value->type, type))
            hnbrdf_refuse(p->t, &name, "%.*s is %.*s, its value %.*s", HNBRDF_SPAN(name.text),
                          HNBRDF_SPAN(hnbrdf_type_name(type)),
                          HNBRDF_SPAN(hnbrdf_type_name(value->type)));
        hnbrdf_add_child(variable, value);
    }
    hnbrdf_add_name(p, variable);
    return variable;
}

hnbrdf_node *hnbrdf_parse_declaration(hnbrdf_parser *p)
{
    const hnbrdf_token begin = *hnbrdf_peek(p);
    hnbrdf_node *declaration = hnbrdf_make_node(p, HNBRDF_NODE_DECLARATION, &begin);
    int constant = 0, precise = 0;
    for (int taken = 1; taken;) {
        const int is_constant = hnbrdf_take_if(p, "const");
        const int is_precise = hnbrdf_take_if(p, "precise");
        constant |= is_constant;
        precise |= is_precise;
        taken = is_constant || is_precise;
    }
    declaration->type = hnbrdf_parse_type(p);
    do {
        hnbrdf_node *variable = parse_variable(p, declaration->type);
        variable->constant = constant != 0;
        variable->precise = precise != 0;
        hnbrdf_add_child(declaration, variable);
    } while (hnbrdf_take_if(p, ","));
    hnbrdf_expect(p, ";");
    return declaration;
}

/* ---- Statements ------------------------------------------------------------------------------ */

static hnbrdf_node *parse_statement(hnbrdf_parser *p);

static hnbrdf_node *parse_condition(hnbrdf_parser *p)
{
    hnbrdf_node *condition = hnbrdf_parse_expression(p);
    if (!p->t->result && condition->type.scalar != HNBRDF_BOOL)
        hnbrdf_refuse(p->t, &condition->token, "a condition that is no bool");
    return condition;
}

static hnbrdf_node *parse_if(hnbrdf_parser *p, const hnbrdf_token *word)
{
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_IF, word);
    hnbrdf_expect(p, "(");
    hnbrdf_add_child(node, parse_condition(p));
    hnbrdf_expect(p, ")");
    hnbrdf_add_child(node, parse_statement(p));
    if (p->t->tokens.list[p->at].kind != HNBRDF_TOKEN_COMMENT && hnbrdf_take_if(p, "else"))
        hnbrdf_add_child(node, parse_statement(p));
    return node;
}

/* Nodes stand in the order of the text: those from the function on are of it. */
static void count_loops(hnbrdf_parser *p, hnbrdf_node *variable)
{
    for (hnbrdf_node *node = p->function; node && node < variable; node++)
        variable->form += node->kind == HNBRDF_NODE_VARIABLE && node->loop &&
                          hnbrdf_span_same(node->token.text, variable->token.text);
    variable->loop = 1;
}

static hnbrdf_node *parse_for(hnbrdf_parser *p, const hnbrdf_token *word)
{
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_FOR, word);
    const size_t names = p->name_count;
    hnbrdf_expect(p, "(");
    hnbrdf_add_child(node, hnbrdf_parse_declaration(p));
    if (!p->t->result)
        count_loops(p, node->first->first);
    hnbrdf_add_child(node, parse_condition(p));
    hnbrdf_expect(p, ";");
    hnbrdf_add_child(node, hnbrdf_parse_assignment(p));
    hnbrdf_expect(p, ")");
    hnbrdf_add_child(node, parse_statement(p));
    p->name_count = names;
    return node;
}

/* "[[dont_unroll]] for ..." */
static hnbrdf_node *parse_attribute(hnbrdf_parser *p)
{
    hnbrdf_take(p);
    hnbrdf_expect(p, "[");
    const hnbrdf_token word = hnbrdf_take(p);
    hnbrdf_expect(p, "]");
    hnbrdf_expect(p, "]");
    const hnbrdf_token loop = hnbrdf_take(p);
    const int kept = hnbrdf_span_is(word.text, "dont_unroll");
    if (!hnbrdf_span_is(loop.text, "for") || !(kept || hnbrdf_span_is(word.text, "unroll")))
        hnbrdf_refuse(p->t, &word, "[[%.*s]]", HNBRDF_SPAN(word.text));
    hnbrdf_node *node = parse_for(p, &loop);
    node->loop = kept != 0;
    node->unroll = !kept;
    return node;
}

static hnbrdf_node *parse_return(hnbrdf_parser *p, const hnbrdf_token *word)
{
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_RETURN, word);
    hnbrdf_type type = {.scalar = HNBRDF_VOID, .width = 1};
    if (!hnbrdf_next_is(p, ";")) {
        const int own_line = hnbrdf_peek(p)->own_line;
        hnbrdf_add_child(node, hnbrdf_parse_expression(p));
        node->first->own_line = own_line != 0;
        type = node->first->type;
    }
    if (!p->t->result && p->function && !hnbrdf_same_type(type, p->function->type))
        hnbrdf_refuse(p->t, word, "%.*s returned from %.*s", HNBRDF_SPAN(hnbrdf_type_name(type)),
                      HNBRDF_SPAN(p->function->token.text));
    hnbrdf_expect(p, ";");
    return node;
}

/* do, while, switch and discard are in none of our texts. */
static void refuse_words(hnbrdf_parser *p, const hnbrdf_token *token)
{
    static const char *const words[] = {"do", "while", "switch", "case", "discard", "default"};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++)
        if (hnbrdf_span_is(token->text, words[k]))
            hnbrdf_refuse(p->t, token, "'%s' is not translated", words[k]);
}

static hnbrdf_node *parse_plain(hnbrdf_parser *p)
{
    const hnbrdf_token token = *hnbrdf_peek(p);
    if (hnbrdf_take_if(p, "if"))
        return parse_if(p, &token);
    if (hnbrdf_take_if(p, "for"))
        return parse_for(p, &token);
    if (hnbrdf_take_if(p, "return"))
        return parse_return(p, &token);
    if (hnbrdf_take_if(p, "break") || hnbrdf_take_if(p, "continue")) {
        hnbrdf_expect(p, ";");
        return hnbrdf_make_node(p, HNBRDF_NODE_JUMP, &token);
    }
    if (hnbrdf_next_is(p, "{"))
        return hnbrdf_parse_compound(p);
    if (hnbrdf_next_is(p, "["))
        return parse_attribute(p);
    if (hnbrdf_at_type(p))
        return hnbrdf_parse_declaration(p);
    refuse_words(p, &token);
    hnbrdf_node *expression = hnbrdf_parse_assignment(p);
    const hnbrdf_token end = *hnbrdf_peek(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_EXPRESSION, &end);
    hnbrdf_add_child(node, expression);
    hnbrdf_expect(p, ";");
    return node;
}

static hnbrdf_node *parse_statement(hnbrdf_parser *p)
{
    const hnbrdf_token token = *hnbrdf_peek(p);
    if (++p->depth > HNBRDF_MAX_DEPTH)
        hnbrdf_refuse(p->t, &token, "more than %d statements within each other", HNBRDF_MAX_DEPTH);
    hnbrdf_node *node = parse_plain(p);
    p->depth--;
    node->after_blank = token.after_blank != 0;
    return node;
}

hnbrdf_node *hnbrdf_parse_compound(hnbrdf_parser *p)
{
    const hnbrdf_token token = *hnbrdf_peek(p);
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_COMPOUND, &token);
    const size_t names = p->name_count;
    hnbrdf_expect(p, "{");
    while (!p->t->result) {
        hnbrdf_node *comment = hnbrdf_parse_comment(p);
        if (comment) {
            hnbrdf_add_child(node, comment);
        } else if (hnbrdf_next_is(p, "}")) {
            break;
        } else {
            hnbrdf_node *statement = parse_statement(p);
            hnbrdf_add_comments(p, node);
            hnbrdf_add_child(node, statement);
        }
    }
    hnbrdf_expect(p, "}");
    p->name_count = names;
    return node;
}
