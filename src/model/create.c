/* create.c: build a model from a description, look into it, free it.
 * Every model, loaded, imported or fitted, passes the checks made here. */
#include "base/error.h"
#include "core/kernel.h"
#include "base/memory.h"
#include "base/sort.h"
#include "model/check_name.h"
#include "model/choose_kernel.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { ALIGNMENT = 64 };

static int matrix_count(const hnbrdf_model_desc *desc)
{
    return desc->kind == HNBRDF_KIND_GGX ? 0 : desc->layers + 1;
}

static size_t packed_size(const hnbrdf_model_desc *desc, int layer)
{
    return (size_t)hnbrdf_layer_inputs(desc, layer) * (size_t)hnbrdf_packed_outputs(desc, layer);
}

static size_t weight_size(const hnbrdf_model_desc *desc, int layer)
{
    return (size_t)hnbrdf_layer_inputs(desc, layer) * (size_t)hnbrdf_layer_outputs(desc, layer);
}

/* ---- Checks ---------------------------------------------------------------------------------- */

static hnbrdf_result check_size(const char *what, int value, int low, int high, hnbrdf_error *error)
{
    if (value >= low && value <= high)
        return HNBRDF_OK;
    return hnbrdf_fail(error, value > high ? HNBRDF_ERROR_LIMIT : HNBRDF_ERROR_ARGUMENT,
                       "%s is %d, expected %d to %d", what, value, low, high);
}

static hnbrdf_result check_shape(const hnbrdf_model_desc *desc, hnbrdf_error *error)
{
    hnbrdf_result result;
    if (!hnbrdf_kind_name(desc->kind)) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "kind is %d, expected hybrid, neural or ggx", (int)desc->kind);
    }
    if (desc->kind == HNBRDF_KIND_GGX) {
        if (desc->hidden != 0 || desc->layers != 0 || desc->latent != 0) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "a ggx model has hidden %d, layers %d, latent %d, expected 0, 0, 0",
                               desc->hidden, desc->layers, desc->latent);
        }
        return HNBRDF_OK;
    }
    if (!hnbrdf_encoding_name(desc->encoding)) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "encoding is %d, expected an HNBRDF_ENCODING_ constant",
                           (int)desc->encoding);
    }
    if ((result = check_size("hidden", desc->hidden, 1, HNBRDF_MAX_HIDDEN, error)) ||
        (result = check_size("layers", desc->layers, 1, HNBRDF_MAX_LAYERS, error)) ||
        (result = check_size("latent", desc->latent, 0, HNBRDF_MAX_LATENT, error)))
        return result;
    return HNBRDF_OK;
}

static hnbrdf_result check_constants(const hnbrdf_model_desc *desc, hnbrdf_error *error)
{
    if (!isfinite(desc->scale) || !isfinite(desc->shift)) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "scale is %s and shift is %s, expected finite numbers",
                           HNBRDF_NUMBER(desc->scale), HNBRDF_NUMBER(desc->shift));
    }
    if (!(desc->floor >= 0) || !isfinite(desc->floor)) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "floor is %s, expected a finite number of at least 0",
                           HNBRDF_NUMBER(desc->floor));
    }
    return HNBRDF_OK;
}

static hnbrdf_result check_finite(const char *what, int layer, const float *values, size_t count,
                                  hnbrdf_error *error)
{
    if (!values) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s[%d] is NULL, expected %zu numbers",
                           what, layer, count);
    }
    for (size_t i = 0; i < count; ++i) {
        if (!isfinite(values[i])) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "%s[%d] holds %s at index %zu, expected finite numbers", what, layer,
                               HNBRDF_NUMBER(values[i]), i);
        }
    }
    return HNBRDF_OK;
}

static hnbrdf_result check_network(const hnbrdf_model_desc *desc, hnbrdf_error *error)
{
    for (int k = 0; k < matrix_count(desc); ++k) {
        const size_t outputs = (size_t)hnbrdf_layer_outputs(desc, k);
        hnbrdf_result result;
        if ((result = check_finite("weights", k, desc->weights[k], weight_size(desc, k), error)) ||
            (result = check_finite("biases", k, desc->biases[k], outputs, error)))
            return result;
    }
    return HNBRDF_OK;
}

static hnbrdf_result check_materials(const hnbrdf_model_desc *desc, hnbrdf_error *error)
{
    hnbrdf_result result =
        check_size("material_count", desc->material_count, 1, HNBRDF_MAX_MATERIALS, error);
    if (result)
        return result;
    if (!desc->materials || !desc->names) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s is NULL, expected %d of them",
                           desc->materials ? "names" : "materials", desc->material_count);
    }
    for (int i = 0; i < desc->material_count; ++i) {
        hnbrdf_error inner;
        if ((result = hnbrdf_check_name(desc->names[i], &inner)))
            return hnbrdf_fail(error, result, "the name of material %d %s", i, inner.text);
        if ((result = hnbrdf_material_check(&desc->materials[i], &inner))) {
            return hnbrdf_fail(error, result, "material %d (%s): %s", i, desc->names[i],
                               inner.text);
        }
    }
    return HNBRDF_OK;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(**(const char *const *const *)a, **(const char *const *const *)b);
}

/* Fills `sorted`, which also brings two names that are equal together. */
static hnbrdf_result sort_names(const char *const *names, int count, const char *const **sorted,
                                hnbrdf_error *error)
{
    for (int i = 0; i < count; ++i)
        sorted[i] = &names[i];
    hnbrdf_sort(sorted, (size_t)count, sizeof *sorted, compare_names);
    for (int i = 1; i < count; ++i) {
        if (strcmp(*sorted[i - 1], *sorted[i]) == 0) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "two materials are named %s, expected every name once", *sorted[i]);
        }
    }
    return HNBRDF_OK;
}

/* ---- Creation -------------------------------------------------------------------------------- */

/* Rounded up so that the next array is aligned like this one. */
static size_t padded(size_t bytes)
{
    return (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

/* The limits, checked before, keep this below 32 MiB: no sum can overflow. */
static size_t model_size(const hnbrdf_model_desc *desc)
{
    const size_t count = (size_t)desc->material_count;
    size_t size = sizeof(hnbrdf_model) + ALIGNMENT - 1;
    for (int k = 0; k < matrix_count(desc); ++k) {
        size += padded(weight_size(desc, k) * sizeof(float));
        size += padded((size_t)hnbrdf_layer_outputs(desc, k) * sizeof(float));
        size += padded(packed_size(desc, k) * sizeof(float));
        size += padded((size_t)hnbrdf_packed_outputs(desc, k) * sizeof(float));
    }
    size += padded(count * sizeof(hnbrdf_material)) + 2 * count * sizeof(char *);
    for (size_t i = 0; i < count; ++i)
        size += strlen(desc->names[i]) + 1;
    return size;
}

static const float *take_floats(unsigned char **at, const float *source, size_t count)
{
    float *copy = (float *)(void *)*at;
    memcpy(copy, source, count * sizeof *copy);
    *at += padded(count * sizeof *copy);
    return copy;
}

/* `outputs` rows of `inputs` weights, input-major and padded; the first `last` inputs go last. */
static const float *take_packed(unsigned char **at, const float *source, int outputs, int inputs,
                                int last, int stride)
{
    float *packed = (float *)(void *)*at;
    const size_t count = (size_t)inputs * (size_t)stride;
    for (int i = 0; i < inputs; ++i) {
        const int from = i < inputs - last ? i + last : i - (inputs - last);
        for (int o = 0; o < stride; ++o)
            packed[i * stride + o] = o < outputs ? source[o * inputs + from] : 0.0f;
    }
    *at += padded(count * sizeof *packed);
    return packed;
}

static void pack_layer(unsigned char **at, int layer, hnbrdf_model *model)
{
    const hnbrdf_model_desc *own = &model->desc;
    const int inputs = hnbrdf_layer_inputs(own, layer), outputs = hnbrdf_layer_outputs(own, layer);
    const int stride = hnbrdf_packed_outputs(own, layer),
              directions = layer == 0 ? HNBRDF_ENCODING_SIZE : 0;
    model->packed[layer] =
        take_packed(at, own->weights[layer], outputs, inputs, directions, stride);
    model->packed_biases[layer] = take_packed(at, own->biases[layer], outputs, 1, 0, stride);
}

/* A material of which nothing else is said was fitted as it is. */
static void take_fitted(hnbrdf_material *material, hnbrdf_kind kind)
{
    hnbrdf_fitted *fitted = &material->fitted;
    if (kind != HNBRDF_KIND_HYBRID) {
        memset(fitted, 0, sizeof *fitted);
    } else if (fitted->alpha[0] == 0.0f) {
        memcpy(fitted->kd, material->kd, sizeof fitted->kd);
        memcpy(fitted->eta, material->eta, sizeof fitted->eta);
        memcpy(fitted->alpha, material->alpha, sizeof fitted->alpha);
    }
}

static const hnbrdf_material *take_materials(unsigned char **at, const hnbrdf_model_desc *desc)
{
    const size_t count = (size_t)desc->material_count;
    hnbrdf_material *copy = (hnbrdf_material *)(void *)*at;
    memcpy(copy, desc->materials, count * sizeof *copy);
    for (size_t i = 0; i < count; ++i) {
        for (int k = desc->latent; k < HNBRDF_MAX_LATENT; ++k)
            copy[i].latent[k] = 0;
        if (copy[i].lobes.scale[0] == 0.0f) /* as a file gives them back */
            memset(&copy[i].lobes, 0, sizeof copy[i].lobes);
        take_fitted(&copy[i], desc->kind);
    }
    *at += padded(count * sizeof *copy);
    return copy;
}

static void copy_names(const char **names, char *text, const hnbrdf_model_desc *desc)
{
    for (int i = 0; i < desc->material_count; ++i) {
        const size_t size = strlen(desc->names[i]) + 1;
        names[i] = (const char *)memcpy(text, desc->names[i], size);
        text += size;
    }
}

/* Lays the description out behind the model; see model_size(). */
static hnbrdf_result fill(hnbrdf_model *model, const hnbrdf_model_desc *desc, hnbrdf_error *error)
{
    hnbrdf_model_desc *own = &model->desc;
    unsigned char *at = (unsigned char *)(model + 1);
    at += (ALIGNMENT - (uintptr_t)at % ALIGNMENT) % ALIGNMENT;
    *own = *desc;
    own->scale = desc->scale == 0 ? 1.0f : desc->scale;
    own->shift = desc->shift + 0.0f; /* -0 becomes 0, as a file gives it back */
    own->floor = desc->floor + 0.0f;
    if (desc->kind == HNBRDF_KIND_GGX)
        own->encoding = HNBRDF_ENCODING_DIRECTIONS;
    for (int k = 0; k <= HNBRDF_MAX_LAYERS; ++k) {
        const int used = k < matrix_count(desc);
        own->weights[k] = used ? take_floats(&at, desc->weights[k], weight_size(desc, k)) : NULL;
        own->biases[k] =
            used ? take_floats(&at, desc->biases[k], (size_t)hnbrdf_layer_outputs(desc, k)) : NULL;
        model->packed[k] = model->packed_biases[k] = NULL;
        if (used)
            pack_layer(&at, k, model);
    }
    own->materials = take_materials(&at, desc);
    const char **names = (const char **)(void *)at;
    const char *const **sorted = (const char *const **)(void *)(names + desc->material_count);
    copy_names(names, (char *)(sorted + desc->material_count), desc);
    const hnbrdf_result result = sort_names(names, desc->material_count, sorted, error);
    if (result)
        return result;
    model->by_name = sorted;
    own->names = names;
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_model_create(const hnbrdf_model_desc *desc, const hnbrdf_allocator *allocator,
                                  hnbrdf_model **model, hnbrdf_error *error)
{
    const hnbrdf_kernel *kernel = NULL;
    hnbrdf_allocator memory;
    hnbrdf_result result;
    if (!desc || !model)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s is NULL", desc ? "model" : "desc");
    if ((result = hnbrdf_choose_allocator(allocator, &memory, error)) ||
        (result = check_shape(desc, error)) || (result = check_constants(desc, error)) ||
        (result = check_network(desc, error)) || (result = check_materials(desc, error)) ||
        (result = hnbrdf_choose_kernel(desc->variant, &kernel, error)))
        return result;
    const size_t size = model_size(desc);
    hnbrdf_model *made = (hnbrdf_model *)hnbrdf_allocate(&memory, size);
    if (!made)
        return hnbrdf_fail_memory(error, size, "the model");
    made->allocator = memory;
    if ((result = fill(made, desc, error))) {
        hnbrdf_release(&memory, made);
        return result;
    }
    made->kernel = kernel;
    made->desc.variant = kernel->variant;
    *model = made;
    return HNBRDF_OK;
}

void hnbrdf_model_free(hnbrdf_model *model)
{
    if (model) {
        const hnbrdf_allocator allocator = model->allocator;
        hnbrdf_release(&allocator, model);
    }
}

/* ---- Looking in ------------------------------------------------------------------------------ */

int hnbrdf_model_find(const hnbrdf_model *model, const char *name)
{
    int low = 0, high = name ? model->desc.material_count : 0;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        const int order = strcmp(*model->by_name[middle], name);
        if (order == 0)
            return (int)(model->by_name[middle] - model->desc.names);
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return -1;
}

size_t hnbrdf_model_multiplications(const hnbrdf_model *model)
{
    size_t count = 0;
    for (int k = 0; k < matrix_count(&model->desc); ++k)
        count += weight_size(&model->desc, k);
    return count;
}

size_t hnbrdf_model_weight_count(const hnbrdf_model *model)
{
    size_t count = hnbrdf_model_multiplications(model);
    for (int k = 0; k < matrix_count(&model->desc); ++k)
        count += (size_t)hnbrdf_layer_outputs(&model->desc, k);
    return count;
}
