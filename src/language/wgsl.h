/* wgsl.h: between the files that print WGSL. */
#ifndef HNBRDF_LANGUAGE_WGSL_H
#define HNBRDF_LANGUAGE_WGSL_H

#include "language/print.h"

/* The first function of a name has it; others add the types in which their parameters differ, so
 * that the name follows from the text in which they stand: hnbrdf_clamp_vec3. */
void hnbrdf_wgsl_function_name(hnbrdf_print *p, const hnbrdf_node *function);
/* vec3f, array<vec4f, 3> */
void hnbrdf_wgsl_type(hnbrdf_print *p, hnbrdf_type type);
/* The variable for an argument that is part of another one: wi_out. */
void hnbrdf_wgsl_temporary(hnbrdf_print *p, const hnbrdf_node *argument);

int hnbrdf_wgsl_expression(hnbrdf_print *p, const hnbrdf_node *node);
int hnbrdf_wgsl_statement(hnbrdf_print *p, const hnbrdf_node *node);

#endif
