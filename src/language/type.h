/* type.h: types of expressions. */
#ifndef HNBRDF_LANGUAGE_TYPE_H
#define HNBRDF_LANGUAGE_TYPE_H

#include "language/translation.h"
#include "language/tree.h"

/* What a built-in function takes and gives. T: a float, float16 or vector of them. */
typedef enum hnbrdf_shape {
    HNBRDF_SHAPE_T, /* T f(T, ...), the same or a single number for arguments after the first */
    HNBRDF_SHAPE_NUMBERS,  /* the same, also of whole numbers */
    HNBRDF_SHAPE_SCALAR,   /* float f(T, ...) */
    HNBRDF_SHAPE_BITS,     /* the same bits as another type */
    HNBRDF_SHAPE_RELATION, /* bvec f(T, T) */
    HNBRDF_SHAPE_ANY       /* bool f(bvec) */
} hnbrdf_shape;

/* Its names; NULL: as in GLSL; "": there is none. For comparisons an operator. */
typedef struct hnbrdf_builtin {
    const char *name;
    hnbrdf_shape shape;
    int arguments;
    const char *hlsl, *msl, *wgsl;
    hnbrdf_scalar result; /* of BITS */
} hnbrdf_builtin;

/* NULL if there is none that is known. */
const hnbrdf_builtin *hnbrdf_find_builtin(hnbrdf_span name, int arguments);

int hnbrdf_same_type(hnbrdf_type a, hnbrdf_type b);
int hnbrdf_is_number(hnbrdf_type type);
/* float, int, vec3, ...; width 0: no such name. */
hnbrdf_type hnbrdf_type_of_name(hnbrdf_span name);
/* Its name in GLSL, as in messages and in the names of functions with several forms. */
hnbrdf_span hnbrdf_type_name(hnbrdf_type type);

/* Each sets node->type from those of its children, or refuses. */
void hnbrdf_type_binary(hnbrdf_translation *t, hnbrdf_node *node);
void hnbrdf_type_unary(hnbrdf_translation *t, hnbrdf_node *node);
void hnbrdf_type_builtin(hnbrdf_translation *t, hnbrdf_node *node);
void hnbrdf_type_construct(hnbrdf_translation *t, hnbrdf_node *node);
void hnbrdf_type_swizzle(hnbrdf_translation *t, hnbrdf_node *node);

#endif
