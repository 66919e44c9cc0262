/* safetensors.c: read and check the header of a safetensors file.
 * Nothing in it is trusted: every offset and product is checked against the bytes that are there.
 */
#include "file/safetensors.h"

#include "base/foreign.h"
#include "base/memory.h"
#include "base/sort.h"

#include <string.h>

/* The reference implementation's limit. */
static const uint64_t MAX_HEADER = 100000000;
/* No tensor's entry in a header is shorter: "":{"dtype":"","shape":[],"data_offsets":[0,0]} */
enum { MIN_ENTRY = 40 };

const char *const hnbrdf_tensor_names[HNBRDF_TENSOR_COUNT] = {
    "net.0.weight",   "net.0.bias",      "net.1.weight",    "net.1.bias",        "net.2.weight",
    "net.2.bias",     "net.3.weight",    "net.3.bias",      "net.4.weight",      "net.4.bias",
    "material.kd",    "material.eta",    "material.alpha",  "material.rotation", "material.latent",
    "material.lobes", "material.fitted", "material.energy",
};

const char *const hnbrdf_key_names[HNBRDF_KEY_COUNT] = {
    "format", "kind", "encoding", "scale", "shift", "floor", "materials",
};

/* ---- What a model's tensors look like -------------------------------------------------------- */

int hnbrdf_tensor_shape(const hnbrdf_model_desc *desc, int tensor, uint64_t shape[2])
{
    const int layer = tensor / 2;
    if (tensor >= HNBRDF_TENSOR_KD) {
        shape[0] = (uint64_t)desc->material_count;
        shape[1] = tensor == HNBRDF_TENSOR_LATENT   ? (uint64_t)desc->latent
                   : tensor == HNBRDF_TENSOR_LOBES  ? sizeof(hnbrdf_lobes) / sizeof(float)
                   : tensor == HNBRDF_TENSOR_FITTED ? sizeof(hnbrdf_fitted) / sizeof(float)
                   : tensor == HNBRDF_TENSOR_ENERGY ? sizeof(hnbrdf_energy) / sizeof(float)
                   : tensor == HNBRDF_TENSOR_ALPHA  ? 2
                                                    : 3;
        return tensor == HNBRDF_TENSOR_ROTATION ? 1 : 2;
    }
    if (desc->kind == HNBRDF_KIND_GGX || layer > desc->layers)
        return 0;
    shape[0] = (uint64_t)hnbrdf_layer_outputs(desc, layer);
    shape[1] = (uint64_t)hnbrdf_layer_inputs(desc, layer);
    return tensor % 2 ? 1 : 2;
}

float *hnbrdf_tensor_row(hnbrdf_material *material, int tensor)
{
    switch (tensor) {
    case HNBRDF_TENSOR_KD:
        return material->kd;
    case HNBRDF_TENSOR_ETA:
        return material->eta;
    case HNBRDF_TENSOR_ALPHA:
        return material->alpha;
    case HNBRDF_TENSOR_ROTATION:
        return &material->rotation;
    case HNBRDF_TENSOR_LOBES:
        return material->lobes.scale; /* the struct is floats throughout */
    case HNBRDF_TENSOR_FITTED:
        return material->fitted.kd; /* likewise */
    case HNBRDF_TENSOR_ENERGY:
        return &material->energy.horizon; /* likewise */
    default:
        return material->latent;
    }
}

/* ---- Reading --------------------------------------------------------------------------------- */

typedef struct extent {
    uint64_t begin, end;
} extent;

typedef struct header {
    const char *path;
    hnbrdf_json json;
    uint64_t data_size;
    extent *extents; /* of every tensor, known or not */
    size_t extent_count;
    hnbrdf_safetensors *file;
    hnbrdf_error *error;
} header;

static hnbrdf_result fail_json(const header *h)
{
    const hnbrdf_json *json = &h->json;
    const size_t place = 8 + (size_t)(json->at - json->begin);
    const unsigned char found = json->at < json->end ? (unsigned char)*json->at : 0;
    if (json->at >= json->end) {
        return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                           "%s: the header ends at byte %zu, expected %s", h->path, place,
                           json->expected);
    }
    return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                       found > 0x20 && found < 0x7f
                           ? "%s: header, byte %zu: found '%c', expected %s"
                           : "%s: header, byte %zu: found 0x%02x, expected %s",
                       h->path, place, (int)found, json->expected);
}

/* The index of a name in a table, or -1. */
static int find_name(hnbrdf_json_text name, const char *const *names, int count)
{
    for (int i = 0; i < count; ++i)
        if (hnbrdf_json_equals(name, names[i]))
            return i;
    return -1;
}

/* All of __metadata__: text to text, the known keys once. */
static hnbrdf_result read_metadata(header *h)
{
    hnbrdf_json *json = &h->json;
    hnbrdf_json_text key, value;
    if (!hnbrdf_json_open(json, '{'))
        return fail_json(h);
    while (hnbrdf_json_more(json, '}')) {
        if (!hnbrdf_json_key(json, &key) || !hnbrdf_json_string(json, &value))
            return fail_json(h);
        const int known = find_name(key, hnbrdf_key_names, HNBRDF_KEY_COUNT);
        if (known >= 0 && h->file->keys[known].begin) {
            return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                               "%s: __metadata__ has the key %s twice, expected it once", h->path,
                               hnbrdf_key_names[known]);
        }
        if (known >= 0)
            h->file->keys[known] = value;
    }
    return json->expected ? fail_json(h) : HNBRDF_OK;
}

/* A list of whole numbers: all are counted and multiplied, the first `capacity` kept. */
typedef struct numbers {
    uint64_t *values;
    int capacity, count;
    uint64_t product;
    int overflow;
} numbers;

static void read_numbers(hnbrdf_json *json, numbers *list)
{
    uint64_t value = 0;
    list->product = 1;
    if (!hnbrdf_json_open(json, '['))
        return;
    while (hnbrdf_json_more(json, ']') && hnbrdf_json_integer(json, &value)) {
        if (list->count < list->capacity)
            list->values[list->count] = value;
        ++list->count;
        list->overflow |= value != 0 && list->product > UINT64_MAX / value;
        list->product *= value;
    }
}

/* Where a tensor lies and, if it is one of ours, that its type and size are right. */
static hnbrdf_result check_tensor(const header *h, hnbrdf_json_text name, int known,
                                  hnbrdf_json_text dtype, const numbers *shape, const extent *place,
                                  hnbrdf_number_type *type)
{
    if (place->begin > place->end || place->end > h->data_size) {
        return hnbrdf_fail(
            h->error, HNBRDF_ERROR_FORMAT,
            "%s: tensor %.*s: data_offsets are [%llu, %llu], expected a range within the "
            "%llu bytes of data",
            h->path, hnbrdf_json_shown(name), name.begin, (unsigned long long)place->begin,
            (unsigned long long)place->end, (unsigned long long)h->data_size);
    }
    if (shape->overflow || (known >= 0 && shape->product > UINT64_MAX / sizeof(double))) {
        return hnbrdf_fail(
            h->error, HNBRDF_ERROR_FORMAT,
            "%s: tensor %.*s: the product of its shape is above 2^64, expected the size "
            "of its data, %llu bytes",
            h->path, hnbrdf_json_shown(name), name.begin,
            (unsigned long long)(place->end - place->begin));
    }
    if (known < 0)
        return HNBRDF_OK;
    if (!hnbrdf_number_type_find(dtype, type)) {
        return hnbrdf_fail(h->error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: tensor %.*s: dtype is %.*s, expected " HNBRDF_NUMBER_TYPES, h->path,
                           hnbrdf_json_shown(name), name.begin, hnbrdf_json_shown(dtype),
                           dtype.begin);
    }
    const uint64_t size = (uint64_t)hnbrdf_number_size(*type);
    if (shape->product * size != place->end - place->begin) {
        return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                           "%s: tensor %.*s: data_offsets span %llu bytes, expected %llu for %llu "
                           "numbers of %llu bytes",
                           h->path, hnbrdf_json_shown(name), name.begin,
                           (unsigned long long)(place->end - place->begin),
                           (unsigned long long)(shape->product * size),
                           (unsigned long long)shape->product, (unsigned long long)size);
    }
    return HNBRDF_OK;
}

/* net.5.weight and the like, which a reader that ignores unknown tensors would drop silently. */
static int is_layer_too_many(hnbrdf_json_text name)
{
    int layer = 0;
    if (name.end - name.begin < 5 || memcmp(name.begin, "net.", 4) != 0)
        return 0;
    for (const char *at = name.begin + 4; at < name.end && *at >= '0' && *at <= '9'; ++at)
        layer = layer > HNBRDF_MAX_LAYERS ? layer : layer * 10 + (*at - '0');
    return layer > HNBRDF_MAX_LAYERS;
}

enum { FIELD_DTYPE, FIELD_SHAPE, FIELD_OFFSETS, FIELD_COUNT };
static const char *const FIELD_NAMES[FIELD_COUNT] = {"dtype", "shape", "data_offsets"};

/* Every field once; fields the format does not know are skipped. */
static hnbrdf_result read_fields(header *h, hnbrdf_json_text name, hnbrdf_json_text *dtype,
                                 numbers *shape, numbers *offsets)
{
    hnbrdf_json *json = &h->json;
    hnbrdf_json_text key;
    int seen[FIELD_COUNT] = {0};
    if (!hnbrdf_json_open(json, '{'))
        return fail_json(h);
    while (hnbrdf_json_more(json, '}') && hnbrdf_json_key(json, &key)) {
        const int field = find_name(key, FIELD_NAMES, FIELD_COUNT);
        if (field >= 0 && seen[field]++) {
            return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                               "%s: tensor %.*s: %s appears twice, expected once", h->path,
                               hnbrdf_json_shown(name), name.begin, FIELD_NAMES[field]);
        }
        if (field == FIELD_DTYPE)
            hnbrdf_json_string(json, dtype);
        else if (field >= 0)
            read_numbers(json, field == FIELD_SHAPE ? shape : offsets);
        else
            hnbrdf_json_skip(json);
    }
    if (json->expected)
        return fail_json(h);
    for (int field = 0; field < FIELD_COUNT; ++field) {
        if (!seen[field]) {
            return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                               "%s: tensor %.*s has no %s, expected one", h->path,
                               hnbrdf_json_shown(name), name.begin, FIELD_NAMES[field]);
        }
    }
    if (offsets->count != 2) {
        return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                           "%s: tensor %.*s: data_offsets has %d numbers, expected 2", h->path,
                           hnbrdf_json_shown(name), name.begin, offsets->count);
    }
    return HNBRDF_OK;
}

/* The value of one entry of the header. */
static hnbrdf_result read_tensor(header *h, hnbrdf_json_text name)
{
    const int known = find_name(name, hnbrdf_tensor_names, HNBRDF_TENSOR_COUNT);
    hnbrdf_tensor tensor = {.present = 1};
    uint64_t range[2] = {0, 0};
    numbers shape = {.values = tensor.shape, .capacity = HNBRDF_TENSOR_RANK};
    numbers offsets = {.values = range, .capacity = 2};
    hnbrdf_json_text dtype = {NULL, NULL};
    hnbrdf_result result;
    if ((result = read_fields(h, name, &dtype, &shape, &offsets)))
        return result;
    const extent place = {range[0], range[1]};
    if ((result = check_tensor(h, name, known, dtype, &shape, &place, &tensor.type)))
        return result;
    h->extents[h->extent_count++] = place;
    if (known < 0)
        return HNBRDF_OK;
    if (h->file->tensors[known].present) {
        return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                           "%s: tensor %s appears twice, expected once", h->path,
                           hnbrdf_tensor_names[known]);
    }
    tensor.rank = shape.count;
    tensor.begin = place.begin;
    tensor.end = place.end;
    h->file->tensors[known] = tensor;
    return HNBRDF_OK;
}

static hnbrdf_result read_entries(header *h)
{
    hnbrdf_json *json = &h->json;
    hnbrdf_json_text key;
    int metadata_count = 0;
    if (!hnbrdf_json_open(json, '{'))
        return fail_json(h);
    while (hnbrdf_json_more(json, '}') && hnbrdf_json_key(json, &key)) {
        const int metadata = hnbrdf_json_equals(key, "__metadata__");
        metadata_count += metadata;
        if (metadata_count > 1) {
            return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                               "%s: __metadata__ appears twice, expected once", h->path);
        }
        if (!metadata && is_layer_too_many(key)) {
            return hnbrdf_fail(
                h->error, HNBRDF_ERROR_LIMIT,
                "%s: tensor %.*s: expected at most %d hidden layers, net.0 to net.%d", h->path,
                hnbrdf_json_shown(key), key.begin, HNBRDF_MAX_LAYERS, HNBRDF_MAX_LAYERS);
        }
        const hnbrdf_result result = metadata ? read_metadata(h) : read_tensor(h, key);
        if (result)
            return result;
    }
    return hnbrdf_json_finish(json) ? HNBRDF_OK : fail_json(h);
}

static int compare_extents(const void *a, const void *b)
{
    const extent *x = (const extent *)a, *y = (const extent *)b;
    return x->begin != y->begin ? (x->begin < y->begin ? -1 : 1)
                                : (x->end > y->end) - (x->end < y->end);
}

/* The tensors lie one behind the other, from the first byte of the data to the last. */
static hnbrdf_result check_coverage(header *h)
{
    uint64_t covered = 0;
    hnbrdf_sort(h->extents, h->extent_count, sizeof *h->extents, compare_extents);
    for (size_t i = 0; i < h->extent_count; ++i) {
        if (h->extents[i].begin != covered) {
            return hnbrdf_fail(
                h->error, HNBRDF_ERROR_FORMAT,
                "%s: a tensor begins at byte %llu of the data, expected %llu where the one "
                "before it ends",
                h->path, (unsigned long long)h->extents[i].begin, (unsigned long long)covered);
        }
        covered = h->extents[i].end;
    }
    if (covered != h->data_size) {
        return hnbrdf_fail(h->error, HNBRDF_ERROR_FORMAT,
                           "%s: the tensors cover %llu bytes, expected all %llu bytes of data",
                           h->path, (unsigned long long)covered, (unsigned long long)h->data_size);
    }
    return HNBRDF_OK;
}

/* The first 8 bytes. */
static hnbrdf_result read_length(const char *path, const unsigned char *bytes, size_t size,
                                 size_t *length, hnbrdf_error *error)
{
    uint64_t value = 0;
    const char *foreign = hnbrdf_foreign_file(bytes, size);
    if (size < 8) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: has %zu bytes, expected a safetensors file: 8 bytes and a header",
                           path, size);
    }
    if (foreign) {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %s, expected a safetensors file", path,
                           foreign);
    }
    for (int i = 7; i >= 0; --i)
        value = value << 8 | bytes[i];
    if (value < 2 || value > MAX_HEADER || value > size - 8) {
        const uint64_t limit = size - 8 < MAX_HEADER ? size - 8 : MAX_HEADER;
        const int has_header = size > 8 && bytes[8] == '{'; /* it is one, with another length */
        const char *own = has_header ? NULL : hnbrdf_own_file(bytes, size);
        if (own)
            return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %s, expected a safetensors file",
                               path, own);
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: not a safetensors file: its first 8 bytes give a header of %llu "
                           "bytes, expected 2 to "
                           "%llu in %zu bytes",
                           path, (unsigned long long)value, (unsigned long long)limit, size);
    }
    if (bytes[8] != '{') {
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: the header begins with byte 0x%02x, expected '{'", path,
                           (unsigned)bytes[8]);
    }
    *length = (size_t)value;
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_safetensors_read(const char *path, const unsigned char *bytes, size_t size,
                                      const hnbrdf_allocator *allocator, hnbrdf_safetensors *file,
                                      hnbrdf_error *error)
{
    size_t length = 0;
    hnbrdf_result result = read_length(path, bytes, size, &length, error);
    if (result)
        return result;
    header h = {.path = path, .data_size = size - 8 - length, .file = file, .error = error};
    const size_t room = (length / MIN_ENTRY + 1) * sizeof *h.extents;
    h.extents = (extent *)hnbrdf_allocate(allocator, room);
    if (!h.extents)
        return hnbrdf_fail_memory(error, room, "the header of a model file");
    memset(file, 0, sizeof *file);
    file->data = bytes + 8 + length;
    hnbrdf_json_begin(&h.json, (const char *)bytes + 8, length);
    result = read_entries(&h);
    if (!result)
        result = check_coverage(&h);
    hnbrdf_release(allocator, h.extents);
    return result;
}
