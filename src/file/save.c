/* save.c: write a model as a safetensors file. Identical models give identical bytes.
 * The header is walked twice, once to count its bytes, so that nothing is allocated for it. */
#include "base/error.h"
#include "base/files.h"
#include "core/compose.h"
#include "file/safetensors.h"
#include "base/text.h"

#include <stdio.h>
#include <string.h>

/* ---- Bytes on their way ---------------------------------------------------------------------- */

typedef struct sink {
    hnbrdf_write_fn write; /* NULL: only count */
    void *user;
    uint64_t count;
    size_t held;
    int failed;
    unsigned char buffer[4096];
} sink;

static void flush(sink *s)
{
    if (s->write && s->held > 0 && !s->failed)
        s->failed = s->write(s->user, s->buffer, s->held) != 0;
    s->held = 0;
}

/* An hnbrdf_write_fn, so that escaped text can go into a sink. */
static int put(void *user, const void *data, size_t size)
{
    sink *s = (sink *)user;
    const unsigned char *bytes = (const unsigned char *)data;
    s->count += size;
    while (size > 0) {
        const size_t free_bytes = sizeof s->buffer - s->held;
        const size_t part = size < free_bytes ? size : free_bytes;
        memcpy(s->buffer + s->held, bytes, part);
        s->held += part;
        bytes += part;
        size -= part;
        if (s->held == sizeof s->buffer)
            flush(s);
    }
    return s->failed;
}

static void put_text(sink *s, const char *text)
{
    put(s, text, strlen(text));
}

static void put_u64(sink *s, uint64_t value)
{
    unsigned char bytes[8];
    for (int i = 0; i < 8; ++i)
        bytes[i] = (unsigned char)(value >> 8 * i);
    put(s, bytes, sizeof bytes);
}

static void put_floats(sink *s, const float *values, uint64_t count)
{
    for (uint64_t i = 0; i < count; ++i) {
        uint32_t bits;
        unsigned char bytes[4];
        memcpy(&bits, &values[i], sizeof bits);
        for (int k = 0; k < 4; ++k)
            bytes[k] = (unsigned char)(bits >> 8 * k);
        put(s, bytes, sizeof bytes);
    }
}

/* ---- Header ---------------------------------------------------------------------------------- */

static void put_key(sink *s, int key, const char *value)
{
    put_text(s, key == HNBRDF_KEY_FORMAT ? "\"" : ",\"");
    put_text(s, hnbrdf_key_names[key]);
    put_text(s, "\":\"");
    put_text(s, value);
    put_text(s, "\"");
}

static void put_number_key(sink *s, int key, float value, float standard)
{
    char text[HNBRDF_NUMBER_TEXT];
    if (value != standard) {
        hnbrdf_format_float(text, sizeof text, value);
        put_key(s, key, text);
    }
}

/* Text inside a JSON list that is itself the text of a JSON string. */
static int put_nested(void *user, const void *data, size_t size)
{
    return hnbrdf_json_escape((const char *)data, size, put, user);
}

static void put_names(sink *s, const hnbrdf_model_desc *desc)
{
    put_text(s, ",\"");
    put_text(s, hnbrdf_key_names[HNBRDF_KEY_MATERIALS]);
    put_text(s, "\":\"[");
    for (int i = 0; i < desc->material_count; ++i) {
        put_text(s, i ? ", \\\"" : "\\\"");
        hnbrdf_json_escape(desc->names[i], strlen(desc->names[i]), put_nested, s);
        put_text(s, "\\\"");
    }
    put_text(s, "]\"");
}

static void put_metadata(sink *s, const hnbrdf_model_desc *desc)
{
    put_text(s, "\"__metadata__\":{");
    put_key(s, HNBRDF_KEY_FORMAT, HNBRDF_FILE_FORMAT);
    put_key(s, HNBRDF_KEY_KIND, hnbrdf_kind_name(desc->kind));
    if (desc->kind != HNBRDF_KIND_GGX)
        put_key(s, HNBRDF_KEY_ENCODING, hnbrdf_encoding_name(desc->encoding));
    put_number_key(s, HNBRDF_KEY_SCALE, desc->scale, 1);
    put_number_key(s, HNBRDF_KEY_SHIFT, desc->shift, 0);
    put_number_key(s, HNBRDF_KEY_FLOOR, desc->floor, 0);
    put_names(s, desc);
    put_text(s, "}");
}

/* Lobes and factors on energy that no material has are left out, and what materials were fitted
 * with if none is edited. */
static int is_written(const hnbrdf_model_desc *desc, int tensor)
{
    int wanted = tensor != HNBRDF_TENSOR_LOBES && tensor != HNBRDF_TENSOR_FITTED &&
                 tensor != HNBRDF_TENSOR_ENERGY;
    for (int i = 0; i < desc->material_count && !wanted; ++i) {
        const hnbrdf_material *material = &desc->materials[i];
        wanted = tensor == HNBRDF_TENSOR_LOBES    ? material->lobes.scale[0] != 0.0f
                 : tensor == HNBRDF_TENSOR_FITTED ? hnbrdf_material_is_edited(material)
                                                  : hnbrdf_has_energy(&material->energy);
    }
    return wanted;
}

/* Returns the bytes of the tensor. */
static uint64_t put_entry(sink *s, int tensor, int rank, const uint64_t shape[2], uint64_t offset)
{
    const uint64_t size = shape[0] * (rank == 2 ? shape[1] : 1) * sizeof(float);
    char text[96];
    put_text(s, ",\"");
    put_text(s, hnbrdf_tensor_names[tensor]);
    put_text(s, "\":{\"dtype\":\"F32\",\"shape\":[");
    snprintf(text, sizeof text, rank == 2 ? "%llu,%llu" : "%llu", (unsigned long long)shape[0],
             (unsigned long long)shape[1]);
    put_text(s, text);
    snprintf(text, sizeof text, "],\"data_offsets\":[%llu,%llu]}", (unsigned long long)offset,
             (unsigned long long)(offset + size));
    put_text(s, text);
    return size;
}

static void put_header(sink *s, const hnbrdf_model_desc *desc)
{
    uint64_t offset = 0;
    put_text(s, "{");
    put_metadata(s, desc);
    for (int i = 0; i < HNBRDF_TENSOR_COUNT; ++i) {
        uint64_t shape[2] = {0, 0};
        const int rank = hnbrdf_tensor_shape(desc, i, shape);
        if (rank > 0 && is_written(desc, i))
            offset += put_entry(s, i, rank, shape, offset);
    }
    put_text(s, "}");
}

/* ---- Data ------------------------------------------------------------------------------------ */

static void put_data(sink *s, const hnbrdf_model_desc *desc)
{
    for (int i = 0; i < HNBRDF_TENSOR_COUNT; ++i) {
        uint64_t shape[2] = {0, 0};
        const int rank = hnbrdf_tensor_shape(desc, i, shape);
        const uint64_t width = rank == 2 ? shape[1] : 1;
        if (!is_written(desc, i))
            continue;
        if (i < HNBRDF_TENSOR_KD) {
            put_floats(s, i % 2 ? desc->biases[i / 2] : desc->weights[i / 2], shape[0] * width);
            continue;
        }
        for (int m = 0; m < desc->material_count; ++m) {
            hnbrdf_material material = desc->materials[m];
            put_floats(s, hnbrdf_tensor_row(&material, i), width);
        }
    }
}

hnbrdf_result hnbrdf_model_write(const hnbrdf_model *model, hnbrdf_write_fn write, void *user,
                                 hnbrdf_error *error)
{
    if (!model || !write)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s is NULL", model ? "write" : "model");
    sink counting = {.write = NULL};
    put_header(&counting, &model->desc);
    const uint64_t length = (counting.count + 7) / 8 * 8; /* the data begin at a multiple of 8 */
    sink s = {.write = write, .user = user};
    put_u64(&s, length);
    put_header(&s, &model->desc);
    while (s.count < 8 + length)
        put_text(&s, " ");
    put_data(&s, &model->desc);
    flush(&s);
    return s.failed ? hnbrdf_fail(
                          error, HNBRDF_ERROR_IO,
                          "the model was not written: the writing callback stopped after at most "
                          "%llu bytes",
                          (unsigned long long)s.count)
                    : HNBRDF_OK;
}

/* ---- Files ----------------------------------------------------------------------------------- */

hnbrdf_result hnbrdf_model_save(const hnbrdf_model *model, const char *path, hnbrdf_error *error)
{
    hnbrdf_output output;
    if (!model || !path)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s is NULL", model ? "path" : "model");
    const hnbrdf_result result = hnbrdf_output_open(path, &output, error);
    if (result)
        return result;
    hnbrdf_model_write(model, hnbrdf_write_stream, output.stream, NULL); /* closing tells */
    return hnbrdf_output_close(&output, error);
}
