/* published.h: a network in the style of the published shaders: matrices times vectors of four. */
#ifndef HNBRDF_GLSL_PUBLISHED_H
#define HNBRDF_GLSL_PUBLISHED_H

#include "core/model.h"
#include "glsl/printer.h"

/* The body of a function: vectors f0_0, f0_1, ... of the inputs, of each of which inputs(i) is an
 * expression, then fL_K of every layer L, in groups of four or less. hardGeLU() must exist for the
 * vectors of all sizes from 2 to 4. Expects at least two units a layer. */
typedef void (*hnbrdf_put_input_fn)(hnbrdf_printer *out, const hnbrdf_model_desc *desc, int i);
void hnbrdf_put_published_network(hnbrdf_printer *out, const hnbrdf_model_desc *desc,
                                  hnbrdf_put_input_fn put_input);

#endif
