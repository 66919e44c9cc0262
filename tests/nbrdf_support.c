/* nbrdf_support.c: networks of Neural-BRDF for the tests. */
#include "nbrdf_support.h"

#include <unistd.h>

static const double PI = 3.14159265358979323846;

void test_network_make(test_network *network, size_t first, size_t second, uint64_t seed)
{
    const size_t units[4] = {6, first, second, 3};
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, seed, 0);
    for (int k = 0; k < TEST_PARTS; k++) {
        size_t rows = k % 2 ? 1 : units[k / 2], columns = units[k / 2 + 1];
        network->rows[k] = rows;
        network->columns[k] = columns;
        for (size_t i = 0; i < rows * columns; i++)
            network->values[k][i] = 1.4f * hnbrdf_rng_float(&rng) - 0.6f;
    }
}

void test_network_from_floats(test_network *network, const unsigned char bytes[2700])
{
    test_network_make(network, 21, 21, 0);
    for (int k = 0; k < TEST_PARTS; k++)
        for (size_t i = 0; i < network->rows[k] * network->columns[k]; i++, bytes += 4) {
            uint32_t bits = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 |
                            (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
            memcpy(&network->values[k][i], &bits, sizeof bits);
        }
}

/* ---- Files ----------------------------------------------------------------------------------- */

const char *test_part_ending(int part)
{
    static const char *const endings[TEST_PARTS] = {"_fc1.npy", "_b1.npy",  "_fc2.npy",
                                                    "_b2.npy",  "_fc3.npy", "_b3.npy"};
    return endings[part];
}

test_bytes test_npy(const test_network *network, int part, const char *type, int fortran,
                    int version)
{
    const size_t rows = network->rows[part], columns = network->columns[part];
    const int width = type[2] - '0', start = version == 1 ? 10 : 12;
    char shape[32], text[256];
    if (part % 2)
        snprintf(shape, sizeof shape, "(%zu,)", columns);
    else
        snprintf(shape, sizeof shape, "(%zu, %zu)", rows, columns);
    int length = snprintf(text, sizeof text, "{'descr': '%s', 'fortran_order': %s, 'shape': %s, }",
                          type, fortran ? "True" : "False", shape);
    while ((start + length + 1) % 64 != 0)
        text[length++] = ' ';
    text[length++] = '\n';
    size_t data = (size_t)(start + length);
    test_bytes file = {NULL, data + rows * columns * (size_t)width};
    file.data = calloc(1, file.size);
    assert_non_null(file.data);
    memcpy(file.data, "\223NUMPY", 6);
    file.data[6] = (unsigned char)version;
    put_le(file.data + 8, (uint64_t)length, version == 1 ? 2 : 4);
    memcpy(file.data + start, text, (size_t)length);
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < columns; j++) {
            unsigned char number[8],
                *p = file.data + data + (size_t)width * (fortran ? j * rows + i : i * columns + j);
            float value = network->values[part][i * columns + j];
            if (width == 4)
                put_float(number, value);
            else
                put_double(number, (double)value);
            for (int b = 0; b < width; b++)
                p[b] = number[type[0] == '>' ? width - 1 - b : b];
        }
    return file;
}

void test_write_file(const char *path, const void *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

void test_write_npy(const char *directory, const char *name, const test_network *network)
{
    for (int k = 0; k < TEST_PARTS; k++) {
        char path[600];
        test_bytes file = test_npy(network, k, "<f4", 0, 1);
        snprintf(path, sizeof path, "%s/%s%s", directory, name, test_part_ending(k));
        test_write_file(path, file.data, file.size);
        free(file.data);
    }
}

void test_remove_npy(const char *directory, const char *name)
{
    for (int k = 0; k < TEST_PARTS; k++) {
        char path[600];
        snprintf(path, sizeof path, "%s/%s%s", directory, name, test_part_ending(k));
        remove(path);
    }
}

/* ---- Values ---------------------------------------------------------------------------------- */

/* The half vector turned to phi_h = 0, and the difference vector, by angles. */
static void coordinates(const double wi[3], const double wo[3], double x[6])
{
    double h[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
    double theta = atan2(hypot(h[0], h[1]), h[2]), phi = atan2(h[1], h[0]);
    double u = cos(phi) * wi[0] + sin(phi) * wi[1], v = cos(phi) * wi[1] - sin(phi) * wi[0];
    double length_h = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    x[0] = hypot(h[0], h[1]) / length_h;
    x[1] = 0.0;
    x[2] = h[2] / length_h;
    x[3] = cos(theta) * u - sin(theta) * wi[2];
    x[4] = v;
    x[5] = sin(theta) * u + cos(theta) * wi[2];
    (void)PI;
}

void test_network_eval(const test_network *network, const double wi[3], const double wo[3],
                       double f[3], double bound[3])
{
    const double U = 0x1p-24; /* half an ulp of a float, relative */
    double value[TEST_MOST_UNITS], error[TEST_MOST_UNITS];
    coordinates(wi, wo, value);
    for (int i = 0; i < 6; i++)
        error[i] = U * fabs(value[i]) + 1e-15;
    for (int k = 0; k < TEST_PARTS; k += 2) {
        double next[TEST_MOST_UNITS], next_error[TEST_MOST_UNITS];
        for (size_t j = 0; j < network->columns[k]; j++) {
            double sum = 0.0, magnitude = 0.0, carried = 0.0;
            for (size_t i = 0; i < network->rows[k]; i++) {
                double w = (double)network->values[k][i * network->columns[k] + j];
                sum += value[i] * w;
                magnitude += (fabs(value[i]) + error[i]) * fabs(w);
                carried += error[i] * fabs(w);
            }
            double b = (double)network->values[k + 1][j];
            /* n products, n additions and one of the bias: Higham, (n + 2) u */
            next_error[j] = carried + (double)(network->rows[k] + 2) * U * (magnitude + fabs(b));
            next[j] = sum + b;
            if (k < 4 && next[j] < 0.0)
                next[j] = 0.0;
        }
        memcpy(value, next, sizeof value);
        memcpy(error, next_error, sizeof error);
    }
    for (int c = 0; c < 3; c++) {
        f[c] = value[c] > 0.0 ? expm1(value[c]) : 0.0;
        bound[c] = (f[c] + 1.0) * expm1(error[c]) + 2 * U * f[c];
    }
}
