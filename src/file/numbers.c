/* numbers.c: numbers of tensors: single, half, bfloat16 and double precision. */
#include "file/numbers.h"

#include "core/half.h"
#include "core/math.h"

#include <stdint.h>
#include <string.h>

static const struct {
    const char *name;
    size_t size;
} TYPES[] = {
    [HNBRDF_NUMBER_F32] = {"F32", 4},
    [HNBRDF_NUMBER_F16] = {"F16", 2},
    [HNBRDF_NUMBER_BF16] = {"BF16", 2},
    [HNBRDF_NUMBER_F64] = {"F64", 8},
};
enum { COUNT = sizeof TYPES / sizeof TYPES[0] };

const char *hnbrdf_number_name(hnbrdf_number_type type)
{
    return TYPES[type].name;
}

int hnbrdf_number_type_find(hnbrdf_json_text name, hnbrdf_number_type *type)
{
    for (int k = 0; k < COUNT; ++k) {
        if (hnbrdf_json_equals(name, TYPES[k].name)) {
            *type = (hnbrdf_number_type)k;
            return 1;
        }
    }
    return 0;
}

size_t hnbrdf_number_size(hnbrdf_number_type type)
{
    return TYPES[type].size;
}

double hnbrdf_number_read(hnbrdf_number_type type, const unsigned char *bytes)
{
    uint64_t bits = 0;
    double value;
    for (size_t k = TYPES[type].size; k-- > 0;)
        bits = bits << 8 | bytes[k];
    switch (type) {
    case HNBRDF_NUMBER_F32:
        return (double)hnbrdf_bits_to_float((int32_t)(uint32_t)bits);
    case HNBRDF_NUMBER_F16:
        return (double)hnbrdf_float_of_half((uint16_t)bits);
    case HNBRDF_NUMBER_BF16: /* the upper half of a float */
        return (double)hnbrdf_bits_to_float((int32_t)((uint32_t)bits << 16));
    case HNBRDF_NUMBER_F64:
        break;
    }
    memcpy(&value, &bits, sizeof value);
    return value;
}
