/* fuzz_merl.c: the bytes are a MERL .binary file as they stand, and, where a whole header of the
 * right sizes is there, one of full size: a byte of options, then records of 12 bytes, each a
 * place and a double that replaces the sample there. Options: 1 trilinear, 2 from lower edges, 4 no
 * sample is valid, 8 a byte after the table, 16 a byte less, 32 over the full circle of phi_d. A
 * full table takes tens of milliseconds, so most of the search is cheap. */
#include "fuzz_measured.h"

enum { ROWS = 90 * 90, HALF = 180, BINS = ROWS * HALF, HEADER = 12, RECORD = 12 };
enum { MOST_RECORDS = 64 };

/* Of a table whose rows, along phi_d, have so many bins. */
static size_t file_size(size_t row)
{
    return HEADER + ROWS * row * 24;
}

static void put_double(unsigned char *p, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; i++)
        p[i] = (unsigned char)(bits >> 8 * i);
}

/* 0.1 per sample; three quarters are valid, as in the published files. Both halves of a full circle
 * are equal, as 4 divides 180. */
static unsigned char *make_table(size_t row)
{
    unsigned char *table = calloc(1, file_size(row) + 1);
    FUZZ_CHECK(table != NULL);
    memcpy(table, "\132\0\0\0\132\0\0\0\264\0\0\0", HEADER);
    table[8] = (unsigned char)row;
    table[9] = (unsigned char)(row >> 8);
    for (size_t i = 0; i < 3 * ROWS * row; i++)
        put_double(table + HEADER + 8 * i, i % 4 ? 0.1 : -1.0);
    return table;
}

/* Where record r goes, of a full circle in the first half; bins near the fixed pairs of fuzz_pair()
 * are as likely as any. */
static unsigned char *place(unsigned char *table, size_t row, const uint8_t *record)
{
    size_t at =
        record[0] | (size_t)record[1] << 8 | (size_t)record[2] << 16 | (size_t)record[3] << 24;
    at %= 3 * (size_t)BINS;
    return table + HEADER + 8 * (at / HALF * row + at % HALF);
}

/* A header, and -1 for every sample. */
static void open_invalid(const hnbrdf_measured_options *options)
{
    const size_t size = file_size(HALF);
    unsigned char *invalid = malloc(size);
    FUZZ_CHECK(invalid != NULL);
    memset(invalid, 0xff, size);
    memcpy(invalid, "\132\0\0\0\132\0\0\0\264\0\0\0", HEADER);
    fuzz_measured(invalid, size, "material.binary", options);
    free(invalid);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static unsigned char *tables[2];
    hnbrdf_measured_options options = {.merl_identify = 1};
    fuzz_measured(data, size, "material.binary", &options);
    if (size < HEADER + 1 + RECORD || memcmp(data, "\132\0\0\0\132\0\0\0\264\0\0\0", HEADER) != 0)
        return 0;
    const unsigned full = data[HEADER] >> 5 & 1;
    const size_t row = full ? 2 * HALF : HALF;
    unsigned char *table = tables[full] ? tables[full] : (tables[full] = make_table(row));
    const uint8_t *records = data + HEADER + 1;
    size_t count = (size - HEADER - 1) / RECORD;
    unsigned char saved[MOST_RECORDS][8];
    count = count < MOST_RECORDS ? count : MOST_RECORDS;
    for (size_t r = 0; r < count; r++) {
        unsigned char *to = place(table, row, records + RECORD * r);
        memcpy(saved[r], to, 8);
        memcpy(to, records + RECORD * r + 4, 8);
    }
    options.merl_lookup = data[HEADER] & 1 ? HNBRDF_MERL_TRILINEAR : HNBRDF_MERL_NEAREST;
    options.merl_node = data[HEADER] & 2 ? HNBRDF_MERL_EDGE : HNBRDF_MERL_CENTRE;
    if (data[HEADER] & 4)
        open_invalid(&options);
    else
        fuzz_measured(table, file_size(row) + (data[HEADER] >> 3 & 1) - (data[HEADER] >> 4 & 1),
                      "material.binary", &options);
    for (size_t r = count; r-- > 0;)
        memcpy(place(table, row, records + RECORD * r), saved[r], 8);
    return 0;
}
