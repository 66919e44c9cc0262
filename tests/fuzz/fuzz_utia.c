/* fuzz_utia.c: the bytes are a UTIA .bin file as they stand, and patches of one of full size: a
 * byte of options, a float for utia_scale, then records of 12 bytes, each a place and a double
 * for the sample there. Options: 3 the mode, 4 not extrapolated, 8 another size, 16 the size of the
 * dense set, of which nothing behind the table may be looked at. */
#include "fuzz_measured.h"

enum { SAMPLES = 3 * 288 * 288, START = 5, RECORD = 12, MOST_RECORDS = 64 };

static const size_t DENSE_FILE_SIZE = 1505433600;

static unsigned char *place(unsigned char *table, const uint8_t *record)
{
    const size_t at =
        record[0] | (size_t)record[1] << 8 | (size_t)record[2] << 16 | (size_t)record[3] << 24;
    return table + 8 * (at % SAMPLES);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static unsigned char table[8 * SAMPLES]; /* zeros between two calls */
    hnbrdf_measured_options options = {0};
    float scale;
    fuzz_measured(data, size, "material.bin", &options);
    if (size < START + RECORD)
        return 0;
    memcpy(&scale, data + 1, sizeof scale);
    options.utia_mode = data[0] % 4; /* 3 is none: refused */
    options.utia_no_extrapolate = data[0] >> 2 & 1;
    options.utia_scale = (double)scale;
    size_t count = (size - START) / RECORD;
    count = count < MOST_RECORDS ? count : MOST_RECORDS;
    for (size_t r = 0; r < count; r++)
        memcpy(place(table, data + START + RECORD * r), data + START + RECORD * r + 4, 8);
    options.max_bytes = data[0] & 16 ? SIZE_MAX : 0;
    fuzz_measured(table, data[0] & 16 ? DENSE_FILE_SIZE : sizeof table - (data[0] >> 3 & 1),
                  "material.bin", &options);
    for (size_t r = 0; r < count; r++)
        memset(place(table, data + START + RECORD * r), 0, 8);
    return 0;
}
