/* numbers.h: the types of numbers that tensors of a model file may have. */
#ifndef HNBRDF_FILE_NUMBERS_H
#define HNBRDF_FILE_NUMBERS_H

#include "base/json.h"

typedef enum hnbrdf_number_type {
    HNBRDF_NUMBER_F32 = 0,
    HNBRDF_NUMBER_F16,
    HNBRDF_NUMBER_BF16,
    HNBRDF_NUMBER_F64
} hnbrdf_number_type;

/* All of them, for messages. */
#define HNBRDF_NUMBER_TYPES "F32, F16, BF16 or F64"

/* The name in a header ("BF16"), and the way back: 1 and *type, or 0 for any other text. */
const char *hnbrdf_number_name(hnbrdf_number_type type);
int hnbrdf_number_type_find(hnbrdf_json_text name, hnbrdf_number_type *type);
/* Bytes of one number. */
size_t hnbrdf_number_size(hnbrdf_number_type type);
/* The little-endian number that begins here, exactly. */
double hnbrdf_number_read(hnbrdf_number_type type, const unsigned char *bytes);

#endif
