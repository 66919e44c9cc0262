/* parse.h: tokens into a tree, names to what they stand for, types of all expressions. */
#ifndef HNBRDF_LANGUAGE_PARSE_H
#define HNBRDF_LANGUAGE_PARSE_H

#include "language/translation.h"
#include "language/tree.h"

typedef struct hnbrdf_parser {
    hnbrdf_translation *t;
    size_t at;
    hnbrdf_node **names; /* what can be named here, the innermost last */
    size_t name_count;
    hnbrdf_node *text;
    hnbrdf_node *function; /* that is being read; NULL outside */
    hnbrdf_node *comments; /* found within what is being read, to be printed before it */
    int depth;             /* brackets and statements within each other */
} hnbrdf_parser;

enum { HNBRDF_MAX_DEPTH = 200 };

/* Reads the next text: a TEXT. names has room for as many as there are tokens. */
hnbrdf_node *hnbrdf_parse_text(hnbrdf_parser *p);

/* ---- Between the files of this step ---------------------------------------------------------- */

/* The next token that is no comment; the end after a failure. */
const hnbrdf_token *hnbrdf_peek(hnbrdf_parser *p);
hnbrdf_token hnbrdf_take(hnbrdf_parser *p);
int hnbrdf_next_is(hnbrdf_parser *p, const char *sign);
/* Takes it if it is the next one. */
int hnbrdf_take_if(hnbrdf_parser *p, const char *sign);
void hnbrdf_expect(hnbrdf_parser *p, const char *sign);

hnbrdf_node *hnbrdf_make_node(hnbrdf_parser *p, hnbrdf_node_kind kind, const hnbrdf_token *token);
void hnbrdf_add_child(hnbrdf_node *parent, hnbrdf_node *child);

/* The innermost thing of this name, or NULL. */
hnbrdf_node *hnbrdf_find_name(const hnbrdf_parser *p, hnbrdf_span name);
void hnbrdf_add_name(hnbrdf_parser *p, hnbrdf_node *node);

/* 1 where a type begins that is no constructor. */
int hnbrdf_at_type(hnbrdf_parser *p);
/* "highp float", "hnbrdf_pair", perhaps with "[3]" behind. */
hnbrdf_type hnbrdf_parse_type(hnbrdf_parser *p);
void hnbrdf_parse_length(hnbrdf_parser *p, hnbrdf_type *type);

hnbrdf_node *hnbrdf_parse_expression(hnbrdf_parser *p);
/* "x = 1", "x++", "f(x)": what can be a statement. */
hnbrdf_node *hnbrdf_parse_assignment(hnbrdf_parser *p);
/* "const precise float a = 1.0, b;" with its ';'. */
hnbrdf_node *hnbrdf_parse_declaration(hnbrdf_parser *p);
hnbrdf_node *hnbrdf_parse_compound(hnbrdf_parser *p);
/* The next comment as a node of its own; NULL: none is next. */
hnbrdf_node *hnbrdf_parse_comment(hnbrdf_parser *p);
/* Those that were set aside become children. */
void hnbrdf_add_comments(hnbrdf_parser *p, hnbrdf_node *parent);

#endif
