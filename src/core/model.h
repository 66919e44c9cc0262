/* model.h: what a model holds in memory. Shared by evaluation, model files and export; not
 * public. */
#ifndef HNBRDF_CORE_MODEL_H
#define HNBRDF_CORE_MODEL_H

#include "hnbrdf/hnbrdf.h"

enum { HNBRDF_ENCODING_SIZE = 6, HNBRDF_MAX_OUTPUTS = 6 };

/* Outputs of a packed layer come in multiples of this, the widest vector there is. */
enum { HNBRDF_PACK = 16 };

struct hnbrdf_kernel;

struct hnbrdf_model {
    hnbrdf_model_desc desc;     /* scale is never 0 here; all pointers point into this allocation */
    hnbrdf_allocator allocator; /* both functions set */
    const struct hnbrdf_kernel *kernel;
    /* [desc.material_count] pointers into desc.names, in the order of strcmp() */
    const char *const **by_name;
    /* The same layers as vectors want them. packed[k] is input-major,
     * [inputs][hnbrdf_packed_outputs()], in the canonical order of summation: for k = 0 the latent
     * inputs come before the directions. packed_biases[k] is [hnbrdf_packed_outputs()]. What pads
     * is 0. NULL where there is no layer. */
    const float *packed[HNBRDF_MAX_LAYERS + 1];
    const float *packed_biases[HNBRDF_MAX_LAYERS + 1];
};

/* Columns of weights[layer], rows of weights[layer]; layer 0 to desc->layers. */
int hnbrdf_layer_inputs(const hnbrdf_model_desc *desc, int layer);
int hnbrdf_layer_outputs(const hnbrdf_model_desc *desc, int layer);

/* Rounded up to a multiple of HNBRDF_PACK. */
static inline int hnbrdf_padded(int outputs)
{
    return (outputs + HNBRDF_PACK - 1) & -HNBRDF_PACK;
}

/* The outputs of a packed layer. */
static inline int hnbrdf_packed_outputs(const hnbrdf_model_desc *desc, int layer)
{
    return hnbrdf_padded(hnbrdf_layer_outputs(desc, layer));
}

#endif
