/* model.h: what a model holds in memory. Shared by evaluation, model files and export; not public. */
#ifndef HNBRDF_CORE_MODEL_H
#define HNBRDF_CORE_MODEL_H

#include "hnbrdf/hnbrdf.h"

enum { HNBRDF_ENCODING_SIZE = 6, HNBRDF_MAX_OUTPUTS = 6 };

struct hnbrdf_model {
    hnbrdf_model_desc desc;     /* scale is never 0 here; all pointers point into this allocation */
    hnbrdf_allocator allocator; /* both functions set */
};

/* Columns of weights[layer], rows of weights[layer]; layer 0 to desc->layers. */
int hnbrdf_layer_inputs(const hnbrdf_model_desc *desc, int layer);
int hnbrdf_layer_outputs(const hnbrdf_model_desc *desc, int layer);

#endif
