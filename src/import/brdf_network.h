/* brdf_network.h: the network that is written out in the GLSL of a published .brdf file. */
#ifndef HNBRDF_IMPORT_BRDF_NETWORK_H
#define HNBRDF_IMPORT_BRDF_NETWORK_H

#include "core/model.h"
#include "import/brdf_text.h"

enum { HNBRDF_BRDF_LAYERS = HNBRDF_MAX_LAYERS + 1, HNBRDF_BRDF_WIDTH = HNBRDF_MAX_HIDDEN };

/* Matrices as in hnbrdf_model_desc: weights[k] is [outputs[k]][inputs[k]], row-major and dense. */
typedef struct hnbrdf_brdf_network {
    int layers; /* matrices; 0 is none */
    int inputs[HNBRDF_BRDF_LAYERS], outputs[HNBRDF_BRDF_LAYERS];
    float weights[HNBRDF_BRDF_LAYERS][HNBRDF_BRDF_WIDTH * HNBRDF_BRDF_WIDTH];
    float biases[HNBRDF_BRDF_LAYERS][HNBRDF_BRDF_WIDTH];
} hnbrdf_brdf_network;

/* Reads the body of mlp_eval, from behind its '{' to behind its '}'. Every statement that
 * multiplies by a matrix of numbers is some rows of a layer, vecR NAME = [hardGeLU(]
 * matCxR(numbers) * OPERAND + ... + vecR(numbers) [)]; one column can also be written
 * vecR(numbers) * OPERAND. Operands of the first layer are its inputs in the order in which they
 * first appear, of the others the names of the layer before; all other statements are passed
 * over. Hidden layers are those with hardGeLU, the last has none. */
hnbrdf_result hnbrdf_brdf_read_network(hnbrdf_words *words, hnbrdf_brdf_network *network,
                                       hnbrdf_error *error);

#endif
