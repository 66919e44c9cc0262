/* fuzz_safetensors.c: the bytes are a model file. What loads is sound: it evaluates, exports, and
 * saved and loaded again it is the same. */
#include "fuzz.h"
#include "hnbrdf/glsl.h"

/* Largest block asked for while loading. */
static void *allocate(void *user, size_t size)
{
    size_t *largest = user;
    *largest = size > *largest ? size : *largest;
    return malloc(size);
}

static void release(void *user, void *pointer)
{
    (void)user;
    free(pointer);
}

typedef struct bytes {
    unsigned char *data;
    size_t size, capacity;
} bytes;

static int append(void *user, const void *data, size_t size)
{
    bytes *b = user;
    if (size > b->capacity - b->size) {
        b->capacity = 2 * (b->size + size);
        b->data = realloc(b->data, b->capacity);
        FUZZ_CHECK(b->data != NULL);
    }
    memcpy(b->data + b->size, data, size);
    b->size += size;
    return 0;
}

static void check_values(const hnbrdf_model *model)
{
    const hnbrdf_material *material = hnbrdf_model_material(model, 0);
    FUZZ_CHECK(hnbrdf_material_check(material, NULL) == HNBRDF_OK);
    for (int k = 0; k < FUZZ_PAIRS; k++) {
        const float u[2] = {0.25f, 0.75f};
        float wi[3], wo[3], f[3];
        hnbrdf_sample_result sample;
        fuzz_pair(k, wi, wo);
        hnbrdf_eval(model, material, wi, wo, f);
        fuzz_check_value(f);
        hnbrdf_sample(model, material, wo, u, &sample);
        fuzz_check_value(sample.weight);
        FUZZ_CHECK(isfinite(hnbrdf_pdf(model, material, wi, wo)));
    }
}

/* Identical models give identical bytes. */
static void check_round_trip(const hnbrdf_model *model)
{
    bytes first = {NULL, 0, 0}, second = {NULL, 0, 0};
    hnbrdf_model *again = NULL;
    FUZZ_CHECK(hnbrdf_model_write(model, append, &first, NULL) == HNBRDF_OK);
    FUZZ_CHECK(hnbrdf_model_load_memory(first.data, first.size, NULL, &again, NULL) == HNBRDF_OK);
    FUZZ_CHECK(hnbrdf_model_write(again, append, &second, NULL) == HNBRDF_OK);
    FUZZ_CHECK(first.size == second.size && memcmp(first.data, second.data, first.size) == 0);
    hnbrdf_model_free(again);
    free(first.data);
    free(second.data);
}

static void check_export(const hnbrdf_model *model)
{
    static const int only_first[1] = {0};
    const hnbrdf_glsl_options options = {.materials = only_first, .material_count = 1, .fixed = 1};
    size_t count = 0;
    hnbrdf_error error;
    const hnbrdf_result result =
        hnbrdf_export_shader(model, &options, fuzz_count_bytes, &count, &error);
    if (result)
        fuzz_check_refusal(result, &error);
    else
        FUZZ_CHECK(count > 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    size_t largest = 0;
    const hnbrdf_load_options options = {.allocator = {allocate, release, &largest}};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    const hnbrdf_result result = hnbrdf_model_load_memory(data, size, &options, &model, &error);
    FUZZ_CHECK(largest <= 24 * size + 200000); /* as in test_model_hostile.c */
    FUZZ_CHECK((result == HNBRDF_OK) == (model != NULL));
    if (result) {
        fuzz_check_refusal(result, &error);
        return 0;
    }
    check_values(model);
    check_round_trip(model);
    check_export(model);
    hnbrdf_model_free(model);
    return 0;
}
