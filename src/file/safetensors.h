/* safetensors.h: the container of model files: what lies where in it, shared by loading and saving.
 * u64 little-endian header length, JSON header, tensors one after the other. */
#ifndef HNBRDF_FILE_SAFETENSORS_H
#define HNBRDF_FILE_SAFETENSORS_H

#include "core/model.h"
#include "base/json.h"
#include "file/numbers.h"

#define HNBRDF_FILE_FORMAT "hnbrdf/1"

/* The tensors of a model in file order; weights and biases of layer k are 2k and 2k + 1. */
enum {
    HNBRDF_TENSOR_KD = 2 * (HNBRDF_MAX_LAYERS + 1),
    HNBRDF_TENSOR_ETA,
    HNBRDF_TENSOR_ALPHA,
    HNBRDF_TENSOR_ROTATION,
    HNBRDF_TENSOR_LATENT,
    HNBRDF_TENSOR_LOBES,  /* scales, then the shares lobe by lobe */
    HNBRDF_TENSOR_FITTED, /* kd, eta, alpha */
    HNBRDF_TENSOR_ENERGY, /* horizon, slope */
    HNBRDF_TENSOR_COUNT
};
extern const char *const hnbrdf_tensor_names[HNBRDF_TENSOR_COUNT];

/* The keys of a model in __metadata__, in file order. */
enum {
    HNBRDF_KEY_FORMAT = 0,
    HNBRDF_KEY_KIND,
    HNBRDF_KEY_ENCODING,
    HNBRDF_KEY_SCALE,
    HNBRDF_KEY_SHIFT,
    HNBRDF_KEY_FLOOR,
    HNBRDF_KEY_MATERIALS,
    HNBRDF_KEY_COUNT
};
extern const char *const hnbrdf_key_names[HNBRDF_KEY_COUNT];

/* The shape of a tensor of this model; returns its rank, 0 if such a model does not have it. */
int hnbrdf_tensor_shape(const hnbrdf_model_desc *desc, int tensor, uint64_t shape[2]);
/* The numbers of one material that make a row of a material.* tensor. */
float *hnbrdf_tensor_row(hnbrdf_material *material, int tensor);

enum { HNBRDF_TENSOR_RANK = 4 }; /* dimensions that are kept of any tensor, for messages */

typedef struct hnbrdf_tensor {
    int present, rank; /* rank may be larger than HNBRDF_TENSOR_RANK */
    uint64_t shape[HNBRDF_TENSOR_RANK];
    hnbrdf_number_type type;
    uint64_t begin, end; /* bytes of data[]; as many numbers as the product of the shape */
} hnbrdf_tensor;

/* A file's header. Everything points into the bytes it was read from. */
typedef struct hnbrdf_safetensors {
    hnbrdf_tensor tensors[HNBRDF_TENSOR_COUNT];
    hnbrdf_json_text keys[HNBRDF_KEY_COUNT]; /* begin is NULL for a key that is not there */
    const unsigned char *data;
} hnbrdf_safetensors;

/* Reads and checks the header: syntax, types and extents of the tensors above, and that all tensors
 * together cover the data without holes and overlaps. `path` is for messages. */
hnbrdf_result hnbrdf_safetensors_read(const char *path, const unsigned char *bytes, size_t size,
                                      const hnbrdf_allocator *allocator, hnbrdf_safetensors *file,
                                      hnbrdf_error *error);

/* Makes a model of it; all numbers are decoded and checked. Tells `notes` if some were
 * converted. */
hnbrdf_result hnbrdf_safetensors_decode(const char *path, const hnbrdf_safetensors *file,
                                        const hnbrdf_allocator *allocator, hnbrdf_variant variant,
                                        const hnbrdf_notes *notes, hnbrdf_model **model,
                                        hnbrdf_error *error);

#endif
