/* parse_tokens.c: what all of the parser reads with: the next token, a new node, names, types. */
#include "language/parse.h"

#include "language/type.h"

/* ---- Tokens and nodes ------------------------------------------------------------------------ */

const hnbrdf_token *hnbrdf_peek(hnbrdf_parser *p)
{
    const hnbrdf_tokens *tokens = &p->t->tokens;
    if (p->t->result)
        p->at = tokens->count - 1;
    while (tokens->list[p->at].kind == HNBRDF_TOKEN_COMMENT) {
        hnbrdf_node **last = &p->comments;
        while (*last)
            last = &(*last)->next;
        *last = hnbrdf_make_node(p, HNBRDF_NODE_COMMENT, &tokens->list[p->at++]);
        (*last)->own_line = 1;
    }
    return &tokens->list[p->at];
}

hnbrdf_token hnbrdf_take(hnbrdf_parser *p)
{
    const hnbrdf_token token = *hnbrdf_peek(p);
    p->at += token.kind != HNBRDF_TOKEN_END;
    return token;
}

int hnbrdf_next_is(hnbrdf_parser *p, const char *sign)
{
    const hnbrdf_token *token = hnbrdf_peek(p);
    return (token->kind == HNBRDF_TOKEN_SIGN || token->kind == HNBRDF_TOKEN_NAME) &&
           hnbrdf_span_is(token->text, sign);
}

int hnbrdf_take_if(hnbrdf_parser *p, const char *sign)
{
    const int found = hnbrdf_next_is(p, sign);
    p->at += (size_t)found;
    return found;
}

void hnbrdf_expect(hnbrdf_parser *p, const char *sign)
{
    const hnbrdf_token *token = hnbrdf_peek(p);
    if (hnbrdf_take_if(p, sign))
        return;
    if (token->kind == HNBRDF_TOKEN_END)
        hnbrdf_refuse(p->t, token, "found the end, expected '%s'", sign);
    else
        hnbrdf_refuse(p->t, token, "found '%.*s', expected '%s'", HNBRDF_SPAN(token->text), sign);
}

hnbrdf_node *hnbrdf_make_node(hnbrdf_parser *p, hnbrdf_node_kind kind, const hnbrdf_token *token)
{
    hnbrdf_translation *t = p->t;
    if (t->node_count == t->node_room) {
        hnbrdf_refuse(t, token, "more nodes than tokens");
        t->node_count--;
    }
    hnbrdf_node *node = &t->nodes[t->node_count++];
    *node = (hnbrdf_node){.kind = kind, .token = *token, .after_blank = token->after_blank != 0};
    return node;
}

void hnbrdf_add_child(hnbrdf_node *parent, hnbrdf_node *child)
{
    if (parent->last)
        parent->last->next = child;
    else
        parent->first = child;
    parent->last = child;
}

hnbrdf_node *hnbrdf_find_name(const hnbrdf_parser *p, hnbrdf_span name)
{
    for (size_t k = p->name_count; k-- > 0;)
        if (hnbrdf_span_same(p->names[k]->token.text, name))
            return p->names[k];
    return NULL;
}

void hnbrdf_add_name(hnbrdf_parser *p, hnbrdf_node *node)
{
    if (!p->t->result)
        p->names[p->name_count++] = node;
}

hnbrdf_node *hnbrdf_parse_comment(hnbrdf_parser *p)
{
    const hnbrdf_token *token = &p->t->tokens.list[p->at];
    if (token->kind != HNBRDF_TOKEN_COMMENT || p->t->result)
        return NULL;
    hnbrdf_node *node = hnbrdf_make_node(p, HNBRDF_NODE_COMMENT, token);
    node->own_line = token->own_line != 0;
    p->at++;
    return node;
}

void hnbrdf_add_comments(hnbrdf_parser *p, hnbrdf_node *parent)
{
    while (p->comments) {
        hnbrdf_node *comment = p->comments;
        p->comments = comment->next;
        comment->next = NULL;
        hnbrdf_add_child(parent, comment);
    }
}

/* ---- Types ----------------------------------------------------------------------------------- */

static int take_precision(hnbrdf_parser *p)
{
    return hnbrdf_take_if(p, "highp") || hnbrdf_take_if(p, "mediump") || hnbrdf_take_if(p, "lowp");
}

int hnbrdf_at_type(hnbrdf_parser *p)
{
    static const char *const before[] = {"const", "precise", "highp", "mediump", "lowp"};
    const hnbrdf_token token = *hnbrdf_peek(p);
    if (token.kind != HNBRDF_TOKEN_NAME)
        return 0;
    for (size_t k = 0; k < sizeof before / sizeof before[0]; k++)
        if (hnbrdf_span_is(token.text, before[k]))
            return 1;
    const hnbrdf_node *named = hnbrdf_find_name(p, token.text);
    return p->t->tokens.list[p->at + 1].kind == HNBRDF_TOKEN_NAME &&
           (hnbrdf_type_of_name(token.text).width > 0 ||
            (named && named->kind == HNBRDF_NODE_STRUCT));
}

void hnbrdf_parse_length(hnbrdf_parser *p, hnbrdf_type *type)
{
    const hnbrdf_token sign = *hnbrdf_peek(p);
    if (!hnbrdf_take_if(p, "["))
        return;
    if (type->length)
        hnbrdf_refuse(p->t, &sign, "an array of arrays");
    const hnbrdf_token token = *hnbrdf_peek(p);
    type->length = hnbrdf_make_node(p, HNBRDF_NODE_NUMBER, &sign);
    if (token.kind == HNBRDF_TOKEN_NUMBER) {
        type->length->token = hnbrdf_take(p);
        type->length->type = (hnbrdf_type){.scalar = HNBRDF_INT, .width = 1};
    } else if (!hnbrdf_next_is(p, "]")) {
        hnbrdf_refuse(p->t, &token, "'%.*s' as a length of an array, expected a number",
                      HNBRDF_SPAN(token.text));
    }
    hnbrdf_expect(p, "]");
}

hnbrdf_type hnbrdf_parse_type(hnbrdf_parser *p)
{
    while (take_precision(p)) {
    }
    const hnbrdf_token token = hnbrdf_take(p);
    const hnbrdf_node *named = hnbrdf_find_name(p, token.text);
    hnbrdf_type type = hnbrdf_type_of_name(token.text);
    if (named && named->kind == HNBRDF_NODE_STRUCT)
        type = (hnbrdf_type){.scalar = HNBRDF_STRUCTURE, .width = 1, .structure = named};
    else if (type.width == 0)
        hnbrdf_refuse(p->t, &token, "found '%.*s', expected a type", HNBRDF_SPAN(token.text));
    if (type.scalar == HNBRDF_FLOAT16)
        p->text->half = 1;
    hnbrdf_parse_length(p, &type);
    return type;
}
