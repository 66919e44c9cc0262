/* nbrdf.h: one network of Neural-BRDF in memory, as its two containers give it to nbrdf.c. */
#ifndef HNBRDF_MEASURED_NBRDF_H
#define HNBRDF_MEASURED_NBRDF_H

#include "measured/format.h"

enum {
    NBRDF_LAYERS = 3,      /* 6 inputs, two hidden layers, 3 outputs */
    NBRDF_MAX_UNITS = 1024 /* of a hidden layer; the published networks have 21 */
};

/* The kernel or the bias of a layer: numbers in C order. */
typedef struct nbrdf_array {
    int axes; /* 1 or 2 */
    size_t shape[2];
    float *values; /* malloc'ed; NULL until the array was read */
    char what[96]; /* in messages, behind the label: "dense_1/dense_1/kernel:0", or empty */
} nbrdf_array;

/* Array k: the kernel of layer k / 2 if k is even, [inputs][outputs], otherwise its bias. */
enum { NBRDF_ARRAYS = 2 * NBRDF_LAYERS };

/* The containers: read all arrays. Values that were allocated are the caller's, also on failure;
 * labels[k] names the file of array k in messages. Shapes are checked by nbrdf.c. */
enum { NBRDF_LABEL_SIZE = 192 };
typedef struct hnbrdf_hdf5_arrays {
    nbrdf_array array[NBRDF_ARRAYS];
    char label[NBRDF_ARRAYS][NBRDF_LABEL_SIZE];
} nbrdf_arrays;
hnbrdf_result hnbrdf_nbrdf_read_npy(const measured_file *file,
                                    const hnbrdf_measured_options *options, nbrdf_arrays *arrays,
                                    hnbrdf_error *error);
/* nbrdf_hdf5.c, the other container, is a part of its own: hnbrdf/hdf5.h. */

/* One .npy file: NumPy's header and its numbers, four or eight bytes each, either byte order, rows
 * or columns first. */
hnbrdf_result hnbrdf_npy_parse(const unsigned char *bytes, size_t size, const char *label,
                               nbrdf_array *array, hnbrdf_error *error);

/* Checks shapes and numbers and makes the material; `container` for its summary. */
hnbrdf_result hnbrdf_nbrdf_open_arrays(const nbrdf_arrays *arrays, const char *container,
                                       measured_body *body, hnbrdf_error *error);
/* How the names of the six files end, in the order of nbrdf_arrays; NULL ends the list. */
extern const char *const hnbrdf_nbrdf_part_endings[NBRDF_ARRAYS + 1];

#endif
