/* tensor_file.c: parse the container of RGL .bsdf files with one bounds-checked cursor. No size
 * in the file is believed before it was compared with the bytes that are there. */
#include "measured/tensor_file.h"
#include "base/bytes.h"
#include "base/error.h"

#include <stdlib.h>

enum {
    MAGIC_SIZE = 12, /* with the NUL */
    HEADER_SIZE = MAGIC_SIZE + 2 + 4,
    MIN_RECORD_SIZE = 2 + 2 + 1 + 8
};
static const char MAGIC[MAGIC_SIZE] = "tensor_file";

static const struct {
    const char *name;
    size_t size;
} TYPES[] = {{NULL, 0},  {"u8", 1},  {"i8", 1},  {"u16", 2}, {"i16", 2}, {"u32", 4},
             {"i32", 4}, {"u64", 8}, {"i64", 8}, {"f16", 2}, {"f32", 4}, {"f64", 8}};

/* What parsing one file needs at hand. */
typedef struct cursor {
    const unsigned char *bytes;
    size_t size, at;
    const char *label;
    hnbrdf_error *error;
} cursor;

static size_t left(const cursor *c)
{
    return c->size - c->at;
}

static const unsigned char *take(cursor *c, size_t count)
{
    const unsigned char *p = c->bytes + c->at;
    c->at += count;
    return p;
}

const char *hnbrdf_tensor_type_name(tensor_type type)
{
    return TYPES[type].name;
}

int hnbrdf_tensor_file_recognise(const unsigned char *bytes, size_t size)
{
    return size > 0 && memcmp(bytes, MAGIC, size < MAGIC_SIZE ? size : MAGIC_SIZE) == 0;
}

static hnbrdf_result truncated_record(const cursor *c, size_t index, const char *what)
{
    return hnbrdf_fail(
        c->error, HNBRDF_ERROR_FORMAT,
        "%s: truncated in the record of field %zu: %zu bytes left at byte %zu, expected %s",
        c->label, index, left(c), c->at, what);
}

static void show_name(tensor *field)
{
    size_t n = field->name_length < TENSOR_NAME_SHOWN ? field->name_length : TENSOR_NAME_SHOWN;
    for (size_t i = 0; i < n; i++)
        field->shown[i] =
            (char)(field->name[i] >= 0x20 && field->name[i] < 0x7f ? field->name[i] : '?');
    field->shown[n] = 0;
}

static hnbrdf_result parse_shape(cursor *c, tensor *field)
{
    field->count = 1;
    for (int axis = 0; axis < field->dims; axis++) {
        uint64_t dim = le64(take(c, 8));
        if (dim == 0)
            return hnbrdf_fail(c->error, HNBRDF_ERROR_FORMAT,
                               "%s: field \"%s\" has size 0 along axis %d, expected at least 1",
                               c->label, field->shown, axis);
        if (dim > c->size / field->count)
            return hnbrdf_fail(
                c->error, HNBRDF_ERROR_FORMAT,
                "%s: field \"%s\" claims size %llu along axis %d, more than the whole "
                "file of %zu bytes holds",
                c->label, field->shown, (unsigned long long)dim, axis, c->size);
        field->shape[axis] = (size_t)dim;
        field->count *= (size_t)dim;
    }
    return HNBRDF_OK;
}

static hnbrdf_result locate_data(const cursor *c, tensor *field, uint64_t offset)
{
    size_t element = TYPES[field->type].size;
    if (field->count > c->size / element || offset > c->size - field->count * element)
        return hnbrdf_fail(
            c->error, HNBRDF_ERROR_FORMAT,
            "%s: field \"%s\" has %zu elements of %s at byte %llu, expected them inside the "
            "file of %zu bytes",
            c->label, field->shown, field->count, TYPES[field->type].name,
            (unsigned long long)offset, c->size);
    field->data = c->bytes + offset;
    return HNBRDF_OK;
}

static hnbrdf_result parse_record(cursor *c, size_t index, tensor *field)
{
    if (left(c) < 2)
        return truncated_record(c, index, "the length of its name");
    field->name_length = le16(take(c, 2));
    if (left(c) < field->name_length)
        return truncated_record(c, index, "its name");
    field->name = take(c, field->name_length);
    show_name(field);

    if (left(c) < 2 + 1 + 8)
        return truncated_record(c, index, "rank, type and offset");
    unsigned dims = le16(take(c, 2)), type = *take(c, 1);
    uint64_t offset = le64(take(c, 8));
    if (dims < 1 || dims > TENSOR_MAX_DIMS)
        return hnbrdf_fail(c->error, HNBRDF_ERROR_FORMAT,
                           "%s: field \"%s\" has %u axes, expected 1 to %d", c->label, field->shown,
                           dims, TENSOR_MAX_DIMS);
    if (type < TENSOR_U8 || type > TENSOR_F64)
        return hnbrdf_fail(c->error, HNBRDF_ERROR_FORMAT,
                           "%s: field \"%s\" has element type %u, expected %d to %d", c->label,
                           field->shown, type, TENSOR_U8, TENSOR_F64);
    if (left(c) < (size_t)dims * 8)
        return truncated_record(c, index, "its shape");
    field->dims = (int)dims;
    field->type = (tensor_type)type;
    hnbrdf_result result = parse_shape(c, field);
    return result ? result : locate_data(c, field, offset);
}

static hnbrdf_result parse_header(cursor *c, size_t *count, unsigned *minor)
{
    if (c->size < HEADER_SIZE)
        return hnbrdf_fail(c->error, HNBRDF_ERROR_FORMAT,
                           "%s: truncated tensor file: %zu bytes, expected a header of %d",
                           c->label, c->size, HEADER_SIZE);
    take(c, MAGIC_SIZE);
    unsigned major = *take(c, 1);
    *minor = *take(c, 1);
    *count = le32(take(c, 4));
    if (major != 1)
        return hnbrdf_fail(c->error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: tensor file of version %u.%u, expected 1.0", c->label, major,
                           *minor);
    if (*count > left(c) / MIN_RECORD_SIZE)
        return hnbrdf_fail(
            c->error, HNBRDF_ERROR_FORMAT,
            "%s: header claims %zu fields, expected at most %zu in the %zu bytes after it",
            c->label, *count, left(c) / MIN_RECORD_SIZE, left(c));
    if (*count > TENSOR_MAX_FIELDS)
        return hnbrdf_fail(c->error, HNBRDF_ERROR_LIMIT, "%s: %zu fields, expected at most %d",
                           c->label, *count, TENSOR_MAX_FIELDS);
    return HNBRDF_OK;
}

static int same_name(const tensor *a, const tensor *b)
{
    return a->name_length == b->name_length && memcmp(a->name, b->name, a->name_length) == 0;
}

static hnbrdf_result parse_records(cursor *c, tensor *fields, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        hnbrdf_result result = parse_record(c, i, &fields[i]);
        if (result)
            return result;
        for (size_t j = 0; j < i; j++)
            if (same_name(&fields[i], &fields[j]))
                return hnbrdf_fail(
                    c->error, HNBRDF_ERROR_FORMAT,
                    "%s: fields %zu and %zu are both named \"%s\", expected each name once",
                    c->label, j, i, fields[i].shown);
    }
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_tensor_file_parse(const unsigned char *bytes, size_t size, const char *label,
                                       tensor_file *file, hnbrdf_error *error)
{
    cursor c = {bytes, size, 0, label, error};
    size_t count = 0;
    unsigned minor = 0;
    hnbrdf_result result = parse_header(&c, &count, &minor);
    if (result)
        return result;
    tensor *fields = calloc(count ? count : 1, sizeof *fields);
    if (!fields)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", label);
    result = parse_records(&c, fields, count);
    if (result) {
        free(fields);
        return result;
    }
    *file = (tensor_file){fields, count, minor};
    return HNBRDF_OK;
}

void hnbrdf_tensor_file_free(tensor_file *file)
{
    free(file->fields);
    *file = (tensor_file){NULL, 0, 0};
}

const tensor *hnbrdf_tensor_file_find(const tensor_file *file, const char *name)
{
    size_t length = strlen(name);
    for (size_t i = 0; i < file->count; i++)
        if (file->fields[i].name_length == length &&
            memcmp(file->fields[i].name, name, length) == 0)
            return &file->fields[i];
    return NULL;
}
