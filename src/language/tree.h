/* tree.h: a translated text as a tree. Every node was made for a token of its own, so that there
 * are never more nodes than tokens. */
#ifndef HNBRDF_LANGUAGE_TREE_H
#define HNBRDF_LANGUAGE_TREE_H

#include "language/token.h"

typedef enum hnbrdf_scalar {
    HNBRDF_VOID = 0,
    HNBRDF_BOOL,
    HNBRDF_INT,
    HNBRDF_UINT,
    HNBRDF_FLOAT,
    HNBRDF_FLOAT16,
    HNBRDF_STRUCTURE
} hnbrdf_scalar;

struct hnbrdf_node;

typedef struct hnbrdf_type {
    hnbrdf_scalar scalar;
    int width;                           /* 1, or 2 to 4 for vectors */
    struct hnbrdf_node *length;          /* of an array: an expression; else NULL */
    const struct hnbrdf_node *structure; /* NULL, or the STRUCT */
} hnbrdf_type;

/* What the children of a node are stands behind it. */
typedef enum hnbrdf_node_kind {
    /* Of a text */
    HNBRDF_NODE_TEXT, /* all that follow */
    HNBRDF_NODE_COMMENT,
    HNBRDF_NODE_CONSTANT, /* #define: nothing, or an expression */
    HNBRDF_NODE_GUARD,    /* what it guards */
    HNBRDF_NODE_CHECK,    /* NAME with the message */
    HNBRDF_NODE_STRUCT,   /* DECLARATIONs and COMMENTs */
    HNBRDF_NODE_BLOCK,    /* a uniform block: one VARIABLE */
    HNBRDF_NODE_FUNCTION, /* parameters as VARIABLE, COMPOUND */
    /* Statements */
    HNBRDF_NODE_DECLARATION, /* VARIABLEs */
    HNBRDF_NODE_VARIABLE,    /* nothing, or its first value */
    HNBRDF_NODE_COMPOUND,    /* { statements } */
    HNBRDF_NODE_EXPRESSION,  /* an expression as a statement */
    HNBRDF_NODE_IF,          /* condition, statement, perhaps another one */
    HNBRDF_NODE_FOR,         /* DECLARATION or EXPRESSION, condition, expression, statement */
    HNBRDF_NODE_RETURN,      /* nothing, or an expression */
    HNBRDF_NODE_JUMP,        /* break, continue */
    /* Expressions */
    HNBRDF_NODE_NUMBER, /* also true and false */
    HNBRDF_NODE_NAME,   /* of a VARIABLE or CONSTANT: its symbol */
    HNBRDF_NODE_BRACKET,
    HNBRDF_NODE_UNARY,
    HNBRDF_NODE_STEP, /* x++, x-- */
    HNBRDF_NODE_BINARY,
    HNBRDF_NODE_ASSIGN,
    HNBRDF_NODE_CHOICE,    /* condition, if so, if not */
    HNBRDF_NODE_MEMBER,    /* of a structure */
    HNBRDF_NODE_SWIZZLE,   /* of a vector */
    HNBRDF_NODE_INDEX,     /* array or vector, number */
    HNBRDF_NODE_CALL,      /* arguments; its symbol is the FUNCTION */
    HNBRDF_NODE_BUILTIN,   /* arguments; its builtin */
    HNBRDF_NODE_CONSTRUCT, /* arguments of the constructor of its type */
} hnbrdf_node_kind;

typedef struct hnbrdf_node {
    hnbrdf_node_kind kind;
    hnbrdf_type type;
    hnbrdf_token token; /* its name, operator, text */
    struct hnbrdf_node *first, *last, *next;
    struct hnbrdf_node *symbol;
    const struct hnbrdf_builtin *builtin;
    struct hnbrdf_node *block; /* of a FUNCTION: the uniform block it reads, itself or in calls */
    /* Of a FUNCTION: how many of its name come before it; symbol is the first. Of the VARIABLE of a
     * loop: how many loops before it in the function have one of its name */
    int form;
    unsigned own_line : 1; /* begins a line of the text it is from */
    unsigned breaks : 1;   /* of BINARY: a line ends before the operator */
    unsigned after_blank : 1;
    unsigned precise : 1; /* of VARIABLEs ... */
    unsigned constant : 1;
    unsigned output : 1; /* out */
    unsigned input : 1;  /* with output: inout */
    unsigned global : 1;
    unsigned parameter : 1;
    unsigned assigned : 1; /* after its first value */
    unsigned loop : 1;     /* of FOR: [[dont_unroll]]; of VARIABLE: of a loop */
    unsigned unroll : 1;   /* of FOR: [[unroll]] */
    unsigned half : 1;     /* of TEXT: uses half precision */
} hnbrdf_node;

#endif
