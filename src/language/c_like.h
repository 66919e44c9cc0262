/* c_like.h: what HLSL, Slang and MSL have in common. */
#ifndef HNBRDF_LANGUAGE_C_LIKE_H
#define HNBRDF_LANGUAGE_C_LIKE_H

#include "language/print.h"

/* #define and global constants; the latter begin with these words. 0: something else. */
int hnbrdf_c_item(hnbrdf_print *p, const hnbrdf_node *node, const char *constant);
void hnbrdf_c_struct(hnbrdf_print *p, const hnbrdf_node *node);
/* "float3 wi, wo;" of a struct, on a line of its own. */
void hnbrdf_c_member(hnbrdf_print *p, const hnbrdf_node *declaration);
/* "float3 f(float3 a" without the bracket, out parameters as `out` and `behind` say. */
void hnbrdf_c_head(hnbrdf_print *p, const hnbrdf_node *function, const char *out, const char *inout,
                   const char *behind);
/* The body on lines of its own. */
void hnbrdf_c_body(hnbrdf_print *p, const hnbrdf_node *function);

#endif
