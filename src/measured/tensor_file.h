/* tensor_file.h: the container of RGL .bsdf files: named n-dimensional arrays. Every bound is
 * checked here, so that whoever uses a tensor may trust its shape and its bytes. */
#ifndef HNBRDF_MEASURED_TENSOR_FILE_H
#define HNBRDF_MEASURED_TENSOR_FILE_H

#include "hnbrdf/hnbrdf.h"

#include <stdint.h>

enum {
    TENSOR_MAX_FIELDS = 256, /* real files have 11 */
    TENSOR_MAX_DIMS = 8,
    TENSOR_NAME_SHOWN = 32
};

typedef enum tensor_type {
    TENSOR_U8 = 1,
    TENSOR_I8,
    TENSOR_U16,
    TENSOR_I16,
    TENSOR_U32,
    TENSOR_I32,
    TENSOR_U64,
    TENSOR_I64,
    TENSOR_F16,
    TENSOR_F32,
    TENSOR_F64
} tensor_type;

/* "u8" ... "f64". */
const char *hnbrdf_tensor_type_name(tensor_type type);

/* A C-order array whose bytes lie inside the file. */
typedef struct tensor {
    const unsigned char *name; /* not NUL-terminated */
    size_t name_length;
    char shown[TENSOR_NAME_SHOWN + 1]; /* the name for messages: its beginning, printable */
    tensor_type type;
    int dims;                      /* 1 to TENSOR_MAX_DIMS */
    size_t shape[TENSOR_MAX_DIMS]; /* each >= 1 */
    size_t count;                  /* elements: the product of shape */
    const unsigned char *data;     /* count elements, not aligned */
} tensor;

typedef struct tensor_file {
    tensor *fields;
    size_t count;
    unsigned minor; /* version 1.minor */
} tensor_file;

/* The magic, or as much of it as there is. */
int hnbrdf_tensor_file_recognise(const unsigned char *bytes, size_t size);

/* Points into bytes. `label` names the file in messages. */
hnbrdf_result hnbrdf_tensor_file_parse(const unsigned char *bytes, size_t size, const char *label,
                                       tensor_file *file, hnbrdf_error *error);
void hnbrdf_tensor_file_free(tensor_file *file);

/* NULL if there is none of this name. */
const tensor *hnbrdf_tensor_file_find(const tensor_file *file, const char *name);

#endif
