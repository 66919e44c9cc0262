/* decode.c: make a model of the header and the data of a safetensors file. */
#include "base/error.h"
#include "base/memory.h"
#include "core/encoding.h"
#include "file/safetensors.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DEFAULT_NAME_SIZE = 24 };

/* A file on its way to a model: the description and the memory behind it. */
typedef struct loading {
    const char *path;
    hnbrdf_allocator memory;
    hnbrdf_error *error;
    const hnbrdf_safetensors *file;
    const hnbrdf_notes *notes;
    hnbrdf_model_desc desc;
    char *text; /* of the names */
    const char **names;
    float *weights;
    hnbrdf_material *materials;
} loading;

/* ---- Metadata -------------------------------------------------------------------------------- */

static hnbrdf_result fail_key(const loading *l, hnbrdf_result result, int key, const char *expected)
{
    const hnbrdf_json_text found = l->file->keys[key];
    if (!found.begin) {
        return hnbrdf_fail(l->error, result, "%s: __metadata__ has no key %s, expected %s", l->path,
                           hnbrdf_key_names[key], expected);
    }
    return hnbrdf_fail(l->error, result, "%s: __metadata__: %s is \"%.*s\", expected %s", l->path,
                       hnbrdf_key_names[key], hnbrdf_json_shown(found), found.begin, expected);
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* hnbrdf/1 and hnbrdf/1.anything are read; a later major version is another format. */
static hnbrdf_result check_format(const loading *l)
{
    static const char FAMILY[] = "hnbrdf/";
    const size_t family = sizeof FAMILY - 1, version = sizeof HNBRDF_FILE_FORMAT - 1;
    const hnbrdf_json_text found = l->file->keys[HNBRDF_KEY_FORMAT];
    const size_t length = found.begin ? (size_t)(found.end - found.begin) : 0;
    if (found.begin && hnbrdf_json_equals(found, HNBRDF_FILE_FORMAT))
        return HNBRDF_OK;
    if (length > version && memcmp(found.begin, HNBRDF_FILE_FORMAT ".", version + 1) == 0)
        return HNBRDF_OK;
    const int later = length > family && memcmp(found.begin, FAMILY, family) == 0 &&
                      is_digit(found.begin[family]);
    return fail_key(l, later ? HNBRDF_ERROR_UNSUPPORTED : HNBRDF_ERROR_FORMAT, HNBRDF_KEY_FORMAT,
                    "\"" HNBRDF_FILE_FORMAT "\" as in every model file");
}

static hnbrdf_result read_kind(loading *l)
{
    const hnbrdf_json_text found = l->file->keys[HNBRDF_KEY_KIND];
    const char *name;
    for (int i = 0; found.begin && (name = hnbrdf_kind_name((hnbrdf_kind)i)); ++i) {
        if (hnbrdf_json_equals(found, name)) {
            l->desc.kind = (hnbrdf_kind)i;
            return HNBRDF_OK;
        }
    }
    return fail_key(l, HNBRDF_ERROR_FORMAT, HNBRDF_KEY_KIND, "hybrid, neural or ggx");
}

static hnbrdf_result read_encoding(loading *l)
{
    const hnbrdf_json_text found = l->file->keys[HNBRDF_KEY_ENCODING];
    const char *name;
    if (l->desc.kind == HNBRDF_KIND_GGX)
        return HNBRDF_OK;
    for (int i = 0; found.begin && (name = hnbrdf_encoding_name((hnbrdf_encoding)i)); ++i) {
        if (hnbrdf_json_equals(found, name)) {
            l->desc.encoding = (hnbrdf_encoding)i;
            return HNBRDF_OK;
        }
    }
    return fail_key(l, HNBRDF_ERROR_FORMAT, HNBRDF_KEY_ENCODING, HNBRDF_ENCODING_LIST);
}

/* An optional number; *value stays when the key is not there. */
static hnbrdf_result read_number(loading *l, int key, float *value)
{
    const hnbrdf_json_text found = l->file->keys[key];
    if (found.begin && hnbrdf_parse_float(found.begin, found.end, value) != found.end)
        return fail_key(l, HNBRDF_ERROR_FORMAT, key, "a decimal number");
    return HNBRDF_OK;
}

static hnbrdf_result read_metadata(loading *l)
{
    hnbrdf_model_desc *desc = &l->desc;
    hnbrdf_result result;
    desc->scale = 1;
    if ((result = check_format(l)) || (result = read_kind(l)) || (result = read_encoding(l)) ||
        (result = read_number(l, HNBRDF_KEY_SCALE, &desc->scale)) ||
        (result = read_number(l, HNBRDF_KEY_SHIFT, &desc->shift)) ||
        (result = read_number(l, HNBRDF_KEY_FLOOR, &desc->floor)))
        return result;
    return desc->scale != 0
               ? HNBRDF_OK
               : fail_key(l, HNBRDF_ERROR_FORMAT, HNBRDF_KEY_SCALE, "a number that is not 0");
}

/* ---- Names ----------------------------------------------------------------------------------- */

static hnbrdf_result check_count(const loading *l, uint64_t count)
{
    if (count >= 1 && count <= HNBRDF_MAX_MATERIALS)
        return HNBRDF_OK;
    return hnbrdf_fail(l->error, count ? HNBRDF_ERROR_LIMIT : HNBRDF_ERROR_FORMAT,
                       "%s: holds %llu materials, expected 1 to %d", l->path,
                       (unsigned long long)count, HNBRDF_MAX_MATERIALS);
}

static hnbrdf_result allocate_names(loading *l, size_t text_size, uint64_t count)
{
    const size_t size = (size_t)count * sizeof *l->names;
    if (!l->text && !(l->text = (char *)hnbrdf_allocate(&l->memory, text_size)))
        return hnbrdf_fail_memory(l->error, text_size, "the names of materials");
    if (size > 0 && !(l->names = (const char **)hnbrdf_allocate(&l->memory, size)))
        return hnbrdf_fail_memory(l->error, size, "the names of materials");
    l->desc.names = l->names;
    l->desc.material_count = (int)count;
    return HNBRDF_OK;
}

static uint64_t count_items(hnbrdf_json list)
{
    uint64_t count = 0;
    if (hnbrdf_json_open(&list, '['))
        while (hnbrdf_json_more(&list, ']') && hnbrdf_json_skip(&list))
            ++count;
    return count;
}

/* Names become C strings where they stand: unescaped over themselves, the NUL over the quotation
 * mark. */
static hnbrdf_result take_names(loading *l, hnbrdf_json *list)
{
    hnbrdf_json_text item;
    int index = 0;
    if (hnbrdf_json_open(list, '[')) {
        while (hnbrdf_json_more(list, ']') && hnbrdf_json_string(list, &item)) {
            char *name = l->text + (item.begin - l->text);
            const size_t length = hnbrdf_json_unescape(item, name);
            if (memchr(name, '\0', length)) {
                return hnbrdf_fail(
                    l->error, HNBRDF_ERROR_FORMAT,
                    "%s: __metadata__: the name of material %d has a control character, "
                    "expected none",
                    l->path, index);
            }
            name[length] = '\0';
            l->names[index++] = name;
        }
    }
    if (!hnbrdf_json_finish(list)) {
        return hnbrdf_fail(l->error, HNBRDF_ERROR_FORMAT,
                           "%s: __metadata__: materials, byte %zu of the list: expected %s",
                           l->path, (size_t)(list->at - list->begin), list->expected);
    }
    return HNBRDF_OK;
}

static hnbrdf_result read_names(loading *l)
{
    const hnbrdf_json_text found = l->file->keys[HNBRDF_KEY_MATERIALS];
    const size_t room = (size_t)(found.end - found.begin) + 1;
    hnbrdf_json list;
    hnbrdf_result result = allocate_names(l, room, 0);
    if (result)
        return result;
    hnbrdf_json_begin(&list, l->text, hnbrdf_json_unescape(found, l->text));
    const uint64_t count = count_items(list);
    if (count > 0 &&
        ((result = check_count(l, count)) || (result = allocate_names(l, room, count))))
        return result;
    result = take_names(l, &list);
    return result ? result : check_count(l, count);
}

/* material_0, material_1 ... for a file that says nothing, as many as its tensors have rows. */
static hnbrdf_result default_names(loading *l)
{
    uint64_t count = 0;
    hnbrdf_result result;
    for (int i = HNBRDF_TENSOR_KD; i < HNBRDF_TENSOR_COUNT && count == 0; ++i)
        count = l->file->tensors[i].rank > 0 ? l->file->tensors[i].shape[0] : 0;
    if ((result = check_count(l, count)) ||
        (result = allocate_names(l, (size_t)count * DEFAULT_NAME_SIZE, count)))
        return result;
    for (int i = 0; i < (int)count; ++i) {
        char *name = l->text + (size_t)i * DEFAULT_NAME_SIZE;
        snprintf(name, DEFAULT_NAME_SIZE, "material_%d", i);
        l->names[i] = name;
    }
    return HNBRDF_OK;
}

/* ---- Shapes ---------------------------------------------------------------------------------- */

static void print_shape(char *text, size_t size, int rank, const uint64_t *shape)
{
    int used = snprintf(text, size, "[");
    for (int i = 0; i < rank && i < HNBRDF_TENSOR_RANK; ++i) {
        used += snprintf(text + used, size - (size_t)used, "%s%llu", i ? ", " : "",
                         (unsigned long long)shape[i]);
    }
    snprintf(text + used, size - (size_t)used, rank > HNBRDF_TENSOR_RANK ? ", ...]" : "]");
}

static hnbrdf_result fail_shape(const loading *l, int tensor, hnbrdf_result result,
                                const char *expected)
{
    const hnbrdf_tensor *t = &l->file->tensors[tensor];
    char found[128];
    print_shape(found, sizeof found, t->rank, t->shape);
    return hnbrdf_fail(l->error, result, "%s: tensor %s has shape %s, expected %s", l->path,
                       hnbrdf_tensor_names[tensor], found, expected);
}

/* H, N and l from the first matrix and the number of matrices. */
static hnbrdf_result derive_network(loading *l)
{
    const hnbrdf_tensor *first = &l->file->tensors[0];
    int count = 0;
    if (l->desc.kind == HNBRDF_KIND_GGX)
        return HNBRDF_OK;
    while (count <= HNBRDF_MAX_LAYERS && l->file->tensors[2 * count].present)
        ++count;
    if (count < 2) {
        return hnbrdf_fail(l->error, HNBRDF_ERROR_FORMAT,
                           "%s: has no tensor %s, expected at least 2 layers in a %s model",
                           l->path, hnbrdf_tensor_names[2 * count], hnbrdf_kind_name(l->desc.kind));
    }
    if (first->rank != 2 || first->shape[0] < 1 || first->shape[1] < HNBRDF_ENCODING_SIZE)
        return fail_shape(l, 0, HNBRDF_ERROR_FORMAT, "[hidden, 6 + latent]");
    if (first->shape[0] > HNBRDF_MAX_HIDDEN ||
        first->shape[1] > HNBRDF_ENCODING_SIZE + HNBRDF_MAX_LATENT)
        return fail_shape(l, 0, HNBRDF_ERROR_LIMIT, "at most [64, 22]");
    l->desc.hidden = (int)first->shape[0];
    l->desc.latent = (int)first->shape[1] - HNBRDF_ENCODING_SIZE;
    l->desc.layers = count - 1;
    return HNBRDF_OK;
}

static int is_optional(const hnbrdf_model_desc *desc, int tensor)
{
    return tensor == HNBRDF_TENSOR_ROTATION || tensor == HNBRDF_TENSOR_LOBES ||
           tensor == HNBRDF_TENSOR_FITTED || tensor == HNBRDF_TENSOR_ENERGY ||
           (tensor == HNBRDF_TENSOR_LATENT && desc->latent == 0) ||
           (desc->kind == HNBRDF_KIND_NEURAL && tensor >= HNBRDF_TENSOR_KD &&
            tensor < HNBRDF_TENSOR_LATENT);
}

static hnbrdf_result check_tensors(const loading *l)
{
    const hnbrdf_model_desc *desc = &l->desc;
    for (int i = 0; i < HNBRDF_TENSOR_COUNT; ++i) {
        const hnbrdf_tensor *t = &l->file->tensors[i];
        uint64_t shape[2] = {0, 0};
        const int rank = hnbrdf_tensor_shape(desc, i, shape);
        if (!t->present && (rank == 0 || is_optional(desc, i)))
            continue;
        if (!t->present || rank == 0) {
            return hnbrdf_fail(l->error, HNBRDF_ERROR_FORMAT,
                               "%s: tensor %s is %s in a %s model of %d layers", l->path,
                               hnbrdf_tensor_names[i], t->present ? "not expected" : "missing",
                               hnbrdf_kind_name(desc->kind), desc->layers ? desc->layers + 1 : 0);
        }
        if (t->rank != rank || t->shape[0] != shape[0] || (rank == 2 && t->shape[1] != shape[1])) {
            char expected[128];
            print_shape(expected, sizeof expected, rank, shape);
            return fail_shape(l, i, HNBRDF_ERROR_FORMAT, expected);
        }
    }
    return HNBRDF_OK;
}

/* ---- Values ---------------------------------------------------------------------------------- */

/* Numbers [first, first + count) of a tensor. */
static hnbrdf_result decode(const loading *l, int tensor, size_t first, size_t count, float *to)
{
    const hnbrdf_tensor *t = &l->file->tensors[tensor];
    const size_t size = hnbrdf_number_size(t->type);
    const unsigned char *bytes = l->file->data + t->begin + size * first;
    for (size_t i = 0; i < count; ++i, bytes += size) {
        const double exact = hnbrdf_number_read(t->type, bytes);
        to[i] = (float)exact;
        if (!isfinite(to[i])) {
            return hnbrdf_fail(l->error, HNBRDF_ERROR_FORMAT,
                               "%s: tensor %s holds %s at index %zu, expected finite numbers%s",
                               l->path, hnbrdf_tensor_names[tensor],
                               isnan(exact)   ? "nan"
                               : isinf(exact) ? "an infinity"
                                              : HNBRDF_NUMBER(exact),
                               first + i, isfinite(exact) ? " that fit in F32" : "");
        }
    }
    return HNBRDF_OK;
}

static size_t number_count(const hnbrdf_tensor *t)
{
    return (size_t)((t->end - t->begin) / hnbrdf_number_size(t->type));
}

/* One line for all tensors that are not F32. */
static void tell_converted(const loading *l)
{
    int present = 0, converted = 0, first = 0;
    for (int i = HNBRDF_TENSOR_COUNT - 1; i >= 0; --i) {
        const hnbrdf_tensor *t = &l->file->tensors[i];
        const int is_other = t->present && t->type != HNBRDF_NUMBER_F32;
        present += t->present;
        converted += is_other;
        first = is_other ? i : first;
    }
    if (converted > 0) {
        hnbrdf_note(l->notes, "%s: %d of %d tensors were converted to F32, the first %s from %s",
                    l->path, converted, present, hnbrdf_tensor_names[first],
                    hnbrdf_number_name(l->file->tensors[first].type));
    }
}

static hnbrdf_result read_weights(loading *l)
{
    size_t count = 0;
    for (int i = 0; i < HNBRDF_TENSOR_KD; ++i)
        count += number_count(&l->file->tensors[i]);
    if (count > 0 && !(l->weights = (float *)hnbrdf_allocate(&l->memory, count * sizeof(float))))
        return hnbrdf_fail_memory(l->error, count * sizeof(float), "weights");
    float *to = l->weights;
    for (int i = 0; i < HNBRDF_TENSOR_KD; ++i) {
        const size_t size = number_count(&l->file->tensors[i]);
        hnbrdf_result result;
        if (size == 0)
            continue;
        if ((result = decode(l, i, 0, size, to)))
            return result;
        *(i % 2 ? &l->desc.biases[i / 2] : &l->desc.weights[i / 2]) = to;
        to += size;
    }
    return HNBRDF_OK;
}

static hnbrdf_result read_materials(loading *l)
{
    const size_t count = (size_t)l->desc.material_count, size = count * sizeof *l->materials;
    if (!(l->materials = (hnbrdf_material *)hnbrdf_allocate(&l->memory, size)))
        return hnbrdf_fail_memory(l->error, size, "materials");
    for (size_t m = 0; m < count; ++m) {
        hnbrdf_material_init(&l->materials[m]);
        for (int i = HNBRDF_TENSOR_KD; i < HNBRDF_TENSOR_COUNT; ++i) {
            const size_t width = number_count(&l->file->tensors[i]) / count;
            const hnbrdf_result result =
                decode(l, i, m * width, width, hnbrdf_tensor_row(&l->materials[m], i));
            if (result)
                return result;
        }
    }
    l->desc.materials = l->materials;
    return HNBRDF_OK;
}

/* ---- The whole ------------------------------------------------------------------------------- */

static hnbrdf_result read_model(loading *l)
{
    hnbrdf_result result;
    if ((result = read_metadata(l)) || (result = derive_network(l)))
        return result;
    result = l->file->keys[HNBRDF_KEY_MATERIALS].begin ? read_names(l) : default_names(l);
    if (result || (result = check_tensors(l)) || (result = read_weights(l)))
        return result;
    return read_materials(l);
}

hnbrdf_result hnbrdf_safetensors_decode(const char *path, const hnbrdf_safetensors *file,
                                        const hnbrdf_allocator *allocator, hnbrdf_variant variant,
                                        const hnbrdf_notes *notes, hnbrdf_model **model,
                                        hnbrdf_error *error)
{
    loading l = {.path = path, .memory = *allocator, .error = error, .file = file, .notes = notes};
    hnbrdf_result result = read_model(&l);
    if (!result) {
        hnbrdf_error inner;
        l.desc.variant = variant;
        result = hnbrdf_model_create(&l.desc, allocator, model, &inner);
        if (result) {
            /* What a caller must not pass is here what the file must not hold. */
            result = result == HNBRDF_ERROR_ARGUMENT ? HNBRDF_ERROR_FORMAT : result;
            hnbrdf_fail(error, result, "%s: %s", path, inner.text);
        } else {
            tell_converted(&l);
        }
    }
    hnbrdf_release(allocator, l.text);
    hnbrdf_release(allocator, l.names);
    hnbrdf_release(allocator, l.weights);
    hnbrdf_release(allocator, l.materials);
    return result;
}
