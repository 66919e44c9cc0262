/* model_support.c: what the tests of model files share. */
#include "model_support.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MAX_EXAMPLE = 256 };

static float *random_floats(rng *r, int count)
{
    float *values = malloc((size_t)count * sizeof *values);
    assert_non_null(values);
    for (int i = 0; i < count; i++)
        values[i] = rng_normal(r);
    return values;
}

hnbrdf_model *example_model(uint64_t seed, hnbrdf_kind kind, int hidden, int layers, int latent,
                            int materials, int special)
{
    static const char *const SPECIAL[] = {"gold \"24\"", "back\\slash",
                                          "\xc3\xa9t\xc3\xa9 \xf0\x9f\x8e\xa8", "[a, b]"};
    rng r = rng_make(seed);
    hnbrdf_material table[MAX_EXAMPLE];
    char text[MAX_EXAMPLE][32];
    const char *names[MAX_EXAMPLE];
    float *owned[2 * (HNBRDF_MAX_LAYERS + 1)] = {NULL};
    hnbrdf_model_desc desc = {.kind = kind, .hidden = hidden, .layers = layers, .latent = latent};
    assert_in_range(materials, 1, MAX_EXAMPLE);
    for (int k = 0; k <= layers && kind != HNBRDF_KIND_GGX; k++) {
        const int in = k == 0 ? 6 + latent : hidden;
        const int out = k < layers ? hidden : kind == HNBRDF_KIND_HYBRID ? 6 : 3;
        desc.weights[k] = owned[2 * k] = random_floats(&r, in * out);
        desc.biases[k] = owned[2 * k + 1] = random_floats(&r, out);
    }
    for (int i = 0; i < materials; i++) {
        snprintf(text[i], sizeof text[i], "m%d", i);
        names[i] = special && i < 4 ? SPECIAL[i] : text[i];
        table[i] = random_material(&r, i % 2);
        table[i].rotation = special ? rng_normal(&r) : 0;
    }
    if (special) {
        desc.encoding = HNBRDF_ENCODING_HALF_DIFFERENCE;
        desc.scale = 0.7f;
        desc.shift = -1.1f;
        desc.floor = 0.003f;
    }
    desc.material_count = materials;
    desc.materials = table;
    desc.names = names;
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_model_create(&desc, NULL, &model, &error))
        fail_msg("example model: %s", error.text);
    for (int k = 0; k < 2 * (HNBRDF_MAX_LAYERS + 1); k++)
        free(owned[k]);
    return model;
}

void assert_same_model(const hnbrdf_model *a, const hnbrdf_model *b)
{
    hnbrdf_model_desc x, y;
    hnbrdf_model_describe(a, &x);
    hnbrdf_model_describe(b, &y);
    assert_int_equal(x.kind, y.kind);
    assert_int_equal(x.encoding, y.encoding);
    assert_int_equal(x.hidden, y.hidden);
    assert_int_equal(x.layers, y.layers);
    assert_int_equal(x.latent, y.latent);
    assert_int_equal(x.material_count, y.material_count);
    assert_same_bits(&x.scale, &y.scale, 1);
    assert_same_bits(&x.shift, &y.shift, 1);
    assert_same_bits(&x.floor, &y.floor, 1);
    for (int k = 0; k <= x.layers && x.kind != HNBRDF_KIND_GGX; k++) {
        const int in = k == 0 ? 6 + x.latent : x.hidden;
        const int out = k < x.layers ? x.hidden : x.kind == HNBRDF_KIND_HYBRID ? 6 : 3;
        assert_same_bits(x.weights[k], y.weights[k], in * out);
        assert_same_bits(x.biases[k], y.biases[k], out);
    }
    for (int i = 0; i < x.material_count; i++) {
        assert_string_equal(x.names[i], y.names[i]);
        assert_memory_equal(&x.materials[i], &y.materials[i], sizeof x.materials[i]);
    }
}

int write_bytes(void *user, const void *data, size_t size)
{
    bytes *b = user;
    unsigned char *larger = realloc(b->data, b->size + size + 1);
    assert_non_null(larger);
    memcpy(larger + b->size, data, size);
    b->data = larger;
    b->size += size;
    return 0;
}

bytes model_bytes(const hnbrdf_model *model)
{
    bytes b = {NULL, 0};
    hnbrdf_error error = {""};
    if (hnbrdf_model_write(model, write_bytes, &b, &error))
        fail_msg("write: %s", error.text);
    return b;
}

static void write_length(bytes *b, uint64_t length)
{
    unsigned char text[8];
    for (int i = 0; i < 8; i++)
        text[i] = (unsigned char)(length >> 8 * i);
    write_bytes(b, text, sizeof text);
}

bytes file_with_header(const char *header, size_t data_size)
{
    bytes b = {NULL, 0};
    write_length(&b, strlen(header));
    write_bytes(&b, header, strlen(header));
    for (size_t i = 0; i < data_size; i++)
        write_bytes(&b, "", 1);
    return b;
}

void free_bytes(bytes *b)
{
    free(b->data);
    b->data = NULL;
    b->size = 0;
}

bytes with_replaced(const bytes *file, const char *old, const char *new_text)
{
    const size_t length = file->data[0] | (size_t)file->data[1] << 8 | (size_t)file->data[2] << 16;
    const unsigned char *header = file->data + 8;
    for (size_t i = 0; i + strlen(old) <= length; i++) {
        if (memcmp(header + i, old, strlen(old)) == 0) {
            bytes b = {NULL, 0};
            const size_t rest = i + strlen(old);
            write_length(&b, length - strlen(old) + strlen(new_text));
            write_bytes(&b, header, i);
            write_bytes(&b, new_text, strlen(new_text));
            write_bytes(&b, header + rest, file->size - 8 - rest);
            return b;
        }
    }
    fail_msg("no \"%s\" in the header", old);
    return *file;
}

/* A mark before each block, so that a foreign or freed pointer is noticed. */
typedef union block_head {
    counting *owner;
    max_align_t alignment;
} block_head;

static void *count_allocate(void *user, size_t size)
{
    counting *state = user;
    block_head *head;
    if (state->calls++ == state->fail_at)
        return NULL;
    assert_true(size > 0);
    head = malloc(sizeof *head + size);
    assert_non_null(head);
    head->owner = state;
    state->alive++;
    state->largest = size > state->largest ? size : state->largest;
    memset(head + 1, 0xa5, size);
    return head + 1;
}

static void count_release(void *user, void *pointer)
{
    counting *state = user;
    block_head *head = (block_head *)pointer - 1;
    assert_non_null(pointer);
    assert_ptr_equal(head->owner, state);
    head->owner = NULL;
    state->alive--;
    free(head);
}

hnbrdf_allocator counting_allocator(counting *state)
{
    const hnbrdf_allocator allocator = {count_allocate, count_release, state};
    return allocator;
}
