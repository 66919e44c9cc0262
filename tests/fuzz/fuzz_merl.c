/* fuzz_merl.c: the bytes are a MERL .binary file as they stand, and, where a whole header of the
 * right sizes is there, one of full size: a byte of options, then records of 12 bytes, each a
 * place and a double that replaces the sample there. Options: 1 trilinear, 2 from lower edges, 4 no
 * sample is valid, 8 a byte after the table, 16 a byte less. A full table takes tens of
 * milliseconds, so most of the search is cheap. */
#include "fuzz_measured.h"

enum { BINS = 90 * 90 * 180, HEADER = 12, RECORD = 12, MOST_RECORDS = 64 };
static const size_t FILE_SIZE = HEADER + (size_t)BINS * 24;

static void put_double(unsigned char *p, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; i++)
        p[i] = (unsigned char)(bits >> 8 * i);
}

/* 0.1 per sample; three quarters are valid, as in the published files. */
static unsigned char *make_table(void)
{
    unsigned char *table = calloc(1, FILE_SIZE + 1);
    FUZZ_CHECK(table != NULL);
    memcpy(table, "\132\0\0\0\132\0\0\0\264\0\0\0", HEADER);
    for (size_t i = 0; i < 3 * (size_t)BINS; i++)
        put_double(table + HEADER + 8 * i, i % 4 ? 0.1 : -1.0);
    return table;
}

/* Where record r goes; bins near the fixed pairs of fuzz_pair() are as likely as any. */
static unsigned char *place(unsigned char *table, const uint8_t *record)
{
    const size_t at =
        record[0] | (size_t)record[1] << 8 | (size_t)record[2] << 16 | (size_t)record[3] << 24;
    return table + HEADER + 8 * (at % (3 * (size_t)BINS));
}

/* A header, and -1 for every sample. */
static void open_invalid(const hnbrdf_measured_options *options)
{
    unsigned char *invalid = malloc(FILE_SIZE);
    FUZZ_CHECK(invalid != NULL);
    memset(invalid, 0xff, FILE_SIZE);
    memcpy(invalid, "\132\0\0\0\132\0\0\0\264\0\0\0", HEADER);
    fuzz_measured(invalid, FILE_SIZE, "material.binary", options);
    free(invalid);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static unsigned char *table;
    hnbrdf_measured_options options = {.merl_identify = 1};
    fuzz_measured(data, size, "material.binary", &options);
    if (size < HEADER + 1 + RECORD || memcmp(data, "\132\0\0\0\132\0\0\0\264\0\0\0", HEADER) != 0)
        return 0;
    if (!table)
        table = make_table();
    const uint8_t *records = data + HEADER + 1;
    size_t count = (size - HEADER - 1) / RECORD;
    unsigned char saved[MOST_RECORDS][8];
    count = count < MOST_RECORDS ? count : MOST_RECORDS;
    for (size_t r = 0; r < count; r++) {
        memcpy(saved[r], place(table, records + RECORD * r), 8);
        memcpy(place(table, records + RECORD * r), records + RECORD * r + 4, 8);
    }
    options.merl_lookup = data[HEADER] & 1 ? HNBRDF_MERL_TRILINEAR : HNBRDF_MERL_NEAREST;
    options.merl_node = data[HEADER] & 2 ? HNBRDF_MERL_EDGE : HNBRDF_MERL_CENTRE;
    if (data[HEADER] & 4)
        open_invalid(&options);
    else
        fuzz_measured(table, FILE_SIZE + (data[HEADER] >> 3 & 1) - (data[HEADER] >> 4 & 1),
                      "material.binary", &options);
    for (size_t r = count; r-- > 0;)
        memcpy(place(table, records + RECORD * r), saved[r], 8);
    return 0;
}
