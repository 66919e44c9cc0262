/* nbrdf_npy.c: a network of Neural-BRDF from the six .npy files that its own renderer reads:
 * NAME_fc1.npy, NAME_b1.npy ... NAME_b3.npy. NumPy's format: numpy.lib.format, versions 1 to 3. */
#include "measured/nbrdf.h"
#include "measured/read_file.h"
#include "base/bytes.h"
#include "base/error.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const hnbrdf_nbrdf_part_endings[NBRDF_ARRAYS + 1] = {
    "_fc1.npy", "_b1.npy", "_fc2.npy", "_b2.npy", "_fc3.npy", "_b3.npy", NULL};

/* ---- One file -------------------------------------------------------------------------------- */

/* What a header says: {'descr': '<f4', 'fortran_order': False, 'shape': (6, 21), } */
typedef struct npy_header {
    int big_endian, bytes; /* bytes: 4 or 8 */
    int columns_first;
    int axes;
    size_t shape[2];
} npy_header;

/* A place in the header's text. `bad` says what was expected there; once it is set nothing
 * moves. */
typedef struct cursor {
    const char *at, *end, *bad;
} cursor;

static void skip_spaces(cursor *c)
{
    while (c->at < c->end && (*c->at == ' ' || *c->at == '\n'))
        c->at++;
}

/* Moves over the word if it comes next. */
static int take(cursor *c, const char *word)
{
    size_t length = strlen(word);
    skip_spaces(c);
    if (c->bad || (size_t)(c->end - c->at) < length || memcmp(c->at, word, length) != 0)
        return 0;
    c->at += length;
    return 1;
}

static void expect(cursor *c, const char *word)
{
    if (!take(c, word) && !c->bad)
        c->bad = word;
}

static void read_type(cursor *c, npy_header *header)
{
    static const struct {
        const char *word;
        int big_endian, bytes;
    } types[] = {{"'<f4'", 0, 4}, {"'>f4'", 1, 4}, {"'<f8'", 0, 8}, {"'>f8'", 1, 8}};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        if (take(c, types[i].word)) {
            header->big_endian = types[i].big_endian;
            header->bytes = types[i].bytes;
            return;
        }
    if (!c->bad)
        c->bad = "a type '<f4', '>f4', '<f8' or '>f8'";
}

static void read_shape(cursor *c, npy_header *header)
{
    int axes = 0;
    expect(c, "(");
    while (!c->bad && !take(c, ")")) {
        size_t value = 0;
        const char *digits = c->at; /* take() has skipped spaces */
        for (; c->at < c->end && *c->at >= '0' && *c->at <= '9' && value <= NBRDF_MAX_UNITS;
             c->at++)
            value = 10 * value + (size_t)(*c->at - '0');
        if (c->at == digits || value == 0 || value > NBRDF_MAX_UNITS || axes == 2) {
            c->bad = "a shape of one or two sizes from 1 to 1024";
            return;
        }
        header->shape[axes++] = value;
        if (!take(c, ",")) {
            expect(c, ")");
            break;
        }
    }
    if (!c->bad && axes == 0)
        c->bad = "a shape of one or two sizes from 1 to 1024";
    header->axes = axes;
}

static void read_order(cursor *c, npy_header *header)
{
    if (take(c, "True"))
        header->columns_first = 1;
    else
        expect(c, "False");
}

/* Each of the three keys once, in any order. */
static void read_dictionary(cursor *c, npy_header *header)
{
    int seen = 0;
    expect(c, "{");
    while (!c->bad && !take(c, "}")) {
        int key = take(c, "'descr':") ? 1 : take(c, "'fortran_order':") ? 2 : 4;
        if (key == 4)
            expect(c, "'shape':");
        if (seen & key)
            c->bad = "each key once";
        seen |= key;
        if (key == 1)
            read_type(c, header);
        else if (key == 2)
            read_order(c, header);
        else
            read_shape(c, header);
        if (!take(c, ",")) {
            expect(c, "}");
            break;
        }
    }
    if (!c->bad && seen != 7)
        c->bad = "the keys 'descr', 'fortran_order' and 'shape'";
    skip_spaces(c);
    if (!c->bad && c->at != c->end)
        c->bad = "nothing after the dictionary";
}

/* Where the numbers begin. */
static hnbrdf_result read_header(const unsigned char *bytes, size_t size, const char *label,
                                 npy_header *header, size_t *data, hnbrdf_error *error)
{
    if (size < 10 || memcmp(bytes, "\223NUMPY", 6) != 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: %zu bytes, expected a NumPy file (starts with \\x93NUMPY)", label,
                           size);
    unsigned version = bytes[6];
    if (version < 1 || version > 3)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: NumPy file of version %u.%u, expected 1 to 3", label, version,
                           (unsigned)bytes[7]);
    size_t start = version == 1 ? 10 : 12;
    size_t length = version == 1    ? (size_t)(bytes[8] | bytes[9] << 8)
                    : size >= start ? (size_t)le32(bytes + 8)
                                    : SIZE_MAX;
    if (size < start || length > size - start)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: NumPy file of %zu bytes ends within its header", label, size);
    cursor c = {(const char *)bytes + start, (const char *)bytes + start + length, NULL};
    read_dictionary(&c, header);
    if (c.bad)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: byte %zu of the NumPy header: found '%.*s', expected %s", label,
                           (size_t)(c.at - (const char *)bytes),
                           (int)(c.end - c.at < 16 ? c.end - c.at : 16), c.at, c.bad);
    *data = start + length;
    return HNBRDF_OK;
}

static double number_at(const npy_header *header, const unsigned char *p)
{
    unsigned char swapped[8] = {0};
    for (int i = 0; header->big_endian && i < header->bytes; i++)
        swapped[i] = p[header->bytes - 1 - i];
    p = header->big_endian ? swapped : p;
    return header->bytes == 4 ? (double)le_float(p) : le_double(p);
}

hnbrdf_result hnbrdf_npy_parse(const unsigned char *bytes, size_t size, const char *label,
                               nbrdf_array *array, hnbrdf_error *error)
{
    npy_header header = {.shape = {1, 1}};
    size_t data = 0;
    hnbrdf_result result = read_header(bytes, size, label, &header, &data, error);
    if (result)
        return result;
    size_t rows = header.shape[0], columns = header.shape[1], count = rows * columns;
    size_t expected = data + count * (size_t)header.bytes;
    if (size != expected)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: %zu bytes, expected %zu for %zu numbers of %d bytes", label, size,
                           expected, count, header.bytes);
    float *values = malloc(count * sizeof *values);
    if (!values)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", label);
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < columns; j++) {
            size_t place = header.columns_first ? j * rows + i : i * columns + j;
            values[i * columns + j] =
                (float)number_at(&header, bytes + data + place * (size_t)header.bytes);
        }
    array->axes = header.axes;
    array->shape[0] = rows;
    array->shape[1] = columns;
    array->values = values;
    return HNBRDF_OK;
}

/* ---- Six files ------------------------------------------------------------------------------- */

/* `text` with the ending of part `from` replaced by that of part `to`, in new memory. */
static char *sibling(const char *text, int from, int to)
{
    const char *ending = hnbrdf_nbrdf_part_endings[to];
    size_t stem = strlen(text) - strlen(hnbrdf_nbrdf_part_endings[from]);
    char *made = malloc(stem + strlen(ending) + 1);
    if (made) {
        memcpy(made, text, stem);
        memcpy(made + stem, ending, strlen(ending) + 1);
    }
    return made;
}

/* Which of the six the path names, or -1. */
static int part_of(const char *path)
{
    size_t length = strlen(path);
    for (int k = 0; k < NBRDF_ARRAYS; k++) {
        size_t tail = strlen(hnbrdf_nbrdf_part_endings[k]);
        if (length >= tail && strcmp(path + length - tail, hnbrdf_nbrdf_part_endings[k]) == 0)
            return k;
    }
    return -1;
}

static hnbrdf_result read_part(const measured_file *file, int given, int k, size_t limit,
                               nbrdf_arrays *arrays, hnbrdf_error *error)
{
    char *path = sibling(file->path, given, k), *label = sibling(file->label, given, k);
    unsigned char *bytes = NULL;
    size_t size = 0;
    hnbrdf_result result = HNBRDF_OK;
    if (!path || !label)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", file->label);
    if (!result)
        snprintf(arrays->label[k], sizeof arrays->label[k], "%s", label);
    if (!result && k == given)
        result = hnbrdf_npy_parse(file->bytes, file->size, label, &arrays->array[k], error);
    else if (!result) {
        result = hnbrdf_read_file(path, limit, label, &bytes, &size, error);
        if (!result)
            result = hnbrdf_npy_parse(bytes, size, label, &arrays->array[k], error);
    }
    free(bytes);
    free(label);
    free(path);
    return result;
}

hnbrdf_result hnbrdf_nbrdf_read_npy(const measured_file *file,
                                    const hnbrdf_measured_options *options, nbrdf_arrays *arrays,
                                    hnbrdf_error *error)
{
    int given = part_of(file->path ? file->path : file->label);
    if (given < 0 || part_of(file->label) != given)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: a NumPy file, expected one of the six of an NBRDF material: "
                           "NAME_fc1.npy, NAME_b1.npy ... NAME_fc3.npy, NAME_b3.npy",
                           file->label);
    if (!file->path)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: one of the six files of a material, which are opened by a path and "
                           "not from memory",
                           file->label);
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; !result && k < NBRDF_ARRAYS; k++)
        result = read_part(file, given, k, options->max_bytes, arrays, error);
    return result;
}
