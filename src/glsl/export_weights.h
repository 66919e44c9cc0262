/* export_weights.h: where the uniform block of a scene keeps what. The layout is told in
 * hnbrdf.h. */
#ifndef HNBRDF_GLSL_EXPORT_WEIGHTS_H
#define HNBRDF_GLSL_EXPORT_WEIGHTS_H

#include "core/model.h"
#include "hnbrdf/glsl.h"

enum { HNBRDF_WEIGHTS_HEADER = 2 }; /* vec4 before the first layer */

/* Groups of four outputs, columns of a group without its bias, first vec4 of a layer; of layer
 * layers + 1: one behind the last. */
int hnbrdf_layer_groups(const hnbrdf_model_desc *desc, int layer);
int hnbrdf_layer_columns(const hnbrdf_model_desc *desc, int layer);
int hnbrdf_layer_start(const hnbrdf_model_desc *desc, int layer);

/* Column i of a layer in the order of summation (latent code, then encoded directions) as a
 * column of desc->weights. */
int hnbrdf_summed_column(const hnbrdf_model_desc *desc, int layer, int i);

#endif
