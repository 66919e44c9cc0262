/* nbrdf_support.h: networks of Neural-BRDF for the tests: made from a seed, written as files. */
#ifndef NBRDF_SUPPORT_H
#define NBRDF_SUPPORT_H

#include "measured_support.h"

enum { TEST_MOST_UNITS = 32, TEST_PARTS = 6 };

/* Kernel k / 2 if k is even, [rows][columns]; its bias if k is odd, one row. */
typedef struct test_network {
    size_t rows[TEST_PARTS], columns[TEST_PARTS];
    float values[TEST_PARTS][TEST_MOST_UNITS * TEST_MOST_UNITS];
} test_network;

/* 6, first, second and 3 units; weights from the seed, of the size that published ones have. */
void test_network_make(test_network *network, size_t first, size_t second, uint64_t seed);
/* 675 floats of a published network, 6-21-21-3, as shared/data/nbrdf has them. */
void test_network_from_floats(test_network *network, const unsigned char bytes[2700]);

/* How the file of a part ends: "_fc1.npy". */
const char *test_part_ending(int part);
/* The bytes of part k as a NumPy file; type "<f4", ">f4", "<f8" or ">f8". */
test_bytes test_npy(const test_network *network, int part, const char *type, int fortran,
                    int version);
/* Writes DIRECTORY/NAME_fc1.npy and the five others. */
void test_write_npy(const char *directory, const char *name, const test_network *network);
void test_write_file(const char *path, const void *data, size_t size);
void test_remove_npy(const char *directory, const char *name);

/* f by the formulas in double precision from spherical angles, and how far arithmetic in floats may
 * be from it (a running bound on the rounding of every sum). */
void test_network_eval(const test_network *network, const double wi[3], const double wo[3],
                       double f[3], double bound[3]);

#endif
