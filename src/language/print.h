/* print.h: a tree as the text of another language. */
#ifndef HNBRDF_LANGUAGE_PRINT_H
#define HNBRDF_LANGUAGE_PRINT_H

#include "base/printer.h"
#include "language/translation.h"
#include "language/tree.h"

typedef struct hnbrdf_print {
    hnbrdf_translation *t;
    const hnbrdf_dialect *dialect;
    hnbrdf_printer *out;
    const hnbrdf_source *source;
    const hnbrdf_node *text; /* that is being printed */
    int indent, column;
    int started;        /* 1: something stands on the line */
    int measured;       /* 1: nothing is written, only `widest` is found */
    int widest;         /* column that the widest line before a comment reaches */
    int comment_column; /* where comments behind something begin; 0: one space behind it */
} hnbrdf_print;

/* A language: its words, and what it says differently. */
struct hnbrdf_dialect {
    const char *name;    /* "hlsl": the ending of files */
    const char *capital; /* "HLSL": the ending of guards */
    const char *const (*types)[5];
    const char *suffix; /* of numbers with a point */
    const char *const *reserved;
    int preprocessor;       /* 1: #define and #ifndef */
    int loops_leak;         /* 1: variables of loops are known behind them too (FXC) */
    int precise;            /* 1: there is `precise`; else the text is that of GLSL 330 */
    const char *prelude;    /* behind the guard of a text; NULL: nothing */
    const char *exact;      /* the same in exact builds */
    const char *half;       /* what a text with half precision needs, behind its check */
    const char *half_begin; /* and before everything else; NULL: nothing */
    /* Each returns 0 where the common form will do. */
    int (*item)(hnbrdf_print *p, const hnbrdf_node *node);
    int (*statement)(hnbrdf_print *p, const hnbrdf_node *node);
    int (*expression)(hnbrdf_print *p, const hnbrdf_node *node);
    void (*function)(hnbrdf_print *p, const hnbrdf_node *node);
    void (*structure)(hnbrdf_print *p, const hnbrdf_node *node);
    void (*block)(hnbrdf_print *p, const hnbrdf_node *node);
    const char *(*builtin)(const struct hnbrdf_builtin *builtin);
};

/* All items of a text. */
void hnbrdf_print_text(hnbrdf_print *p, const hnbrdf_node *text);

/* ---- Between the files of this step ---------------------------------------------------------- */

/* Text within a line. */
void hnbrdf_write(hnbrdf_print *p, const char *text);
void hnbrdf_write_span(hnbrdf_print *p, hnbrdf_span span);
/* Lines of their own, as they are. */
void hnbrdf_write_lines(hnbrdf_print *p, const char *text);
/* Ends the line that is open, and begins another one. */
void hnbrdf_new_line(hnbrdf_print *p, int after_blank);
/* A line break within an expression, where the text it is from has one; else `otherwise`. */
void hnbrdf_write_break(hnbrdf_print *p, int breaks, const char *otherwise);

void hnbrdf_write_name(hnbrdf_print *p, hnbrdf_span name); /* kept from meaning something else */
void hnbrdf_write_variable(hnbrdf_print *p, const hnbrdf_node *variable);
void hnbrdf_write_type(hnbrdf_print *p, hnbrdf_type type);
void hnbrdf_write_comment(hnbrdf_print *p, const hnbrdf_node *node);
void hnbrdf_write_guard(hnbrdf_print *p, hnbrdf_span name); /* HNBRDF_HYBRID_BRDF_HLSL */
/* HNBRDF_WEIGHTS_REGISTER for a block hnbrdf_weights_block. */
void hnbrdf_write_setting(hnbrdf_print *p, hnbrdf_span block, const char *ending);
/* Members of a struct, comments in a column. */
void hnbrdf_write_members(hnbrdf_print *p, const hnbrdf_node *structure,
                          void (*member)(hnbrdf_print *p, const hnbrdf_node *declaration));

void hnbrdf_write_expression(hnbrdf_print *p, const hnbrdf_node *node);
/* "a, b" of what is a list of nodes. */
void hnbrdf_write_list(hnbrdf_print *p, const hnbrdf_node *first);
/* Of a single number or a vector, a vector of this width. */
void hnbrdf_write_widened(hnbrdf_print *p, const hnbrdf_node *node, hnbrdf_type type);

void hnbrdf_write_statement(hnbrdf_print *p, const hnbrdf_node *node);
/* Statements between braces; the first brace is there already. */
void hnbrdf_write_body(hnbrdf_print *p, const hnbrdf_node *compound);

/* 1 where an expression is a function call or the like, that nothing around it can split. */
int hnbrdf_is_single(const hnbrdf_node *node);

#endif
