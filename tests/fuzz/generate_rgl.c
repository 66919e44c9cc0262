/* generate_rgl.c: RGL .bsdf files: a tensor file with the fields of a material, isotropic or over a
 * part of the circle, of RGB or spectra. */
#include "generate.h"

#include <string.h>

enum { MOST_FIELDS = 12, UINT8 = 1, FLOAT32 = 10, MOST_AXES = 5, STEPS = 2 };

typedef struct field {
    const char *name;
    uint64_t type, dims, shape[MOST_AXES], offset;
} field;

typedef struct writer {
    fuzz_choices *c;
    fuzz_bytes data;
    field fields[MOST_FIELDS];
    int count;
} writer;

static size_t product(const size_t *shape, int dims)
{
    size_t count = 1;
    for (int axis = 0; axis < dims; axis++)
        count *= shape[axis];
    return count;
}

/* From low to high, in order for axes, else at random; one value may be odd. */
static void put_values(writer *w, size_t count, double low, double high, int ordered)
{
    const size_t odd = fuzz_odd(w->c) ? fuzz_below(w->c, (unsigned)count) : count;
    const int all_low = fuzz_odd(w->c);
    for (size_t i = 0; i < count; i++) {
        double value = ordered
                           ? low + (high - low) * (double)i / (double)(count > 1 ? count - 1 : 1)
                           : fuzz_real_between(w->c, low, high);
        if (i == odd)
            value = fuzz_hostile(w->c, value);
        fuzz_put_float(&w->data, all_low ? low : value);
    }
}

/* The record is written later, when it is known where the data begin. */
static void put_field(writer *w, const char *name, int dims, const size_t *shape, double low,
                      double high, int ordered)
{
    if (fuzz_odd(w->c) || w->count == MOST_FIELDS)
        return;
    field *f = &w->fields[w->count++];
    const size_t count = product(shape, dims);
    *f = (field){.name = fuzz_word(w->c, name),
                 .type = fuzz_whole(w->c, FLOAT32),
                 .dims = fuzz_whole(w->c, (uint64_t)dims),
                 .offset = w->data.size};
    for (int axis = 0; axis < dims; axis++)
        f->shape[axis] = fuzz_whole(w->c, shape[axis]);
    put_values(w, count, low, high, ordered);
}

static void put_bytes(writer *w, const char *name, const char *bytes)
{
    field *f = &w->fields[w->count++];
    *f = (field){.name = name,
                 .type = UINT8,
                 .dims = 1,
                 .shape = {fuzz_whole(w->c, strlen(bytes))},
                 .offset = w->data.size};
    fuzz_put_text(&w->data, bytes);
}

/* One axis of one field is a step longer or shorter than those that must match it. */
static size_t size_of(writer *w, size_t usual)
{
    return fuzz_odd(w->c) ? (fuzz_below(w->c, 2) ? usual + 1 : usual - (usual > 1)) : usual;
}

static void put_colours(writer *w, size_t phi, size_t theta, size_t side)
{
    const unsigned kinds = fuzz_below(w->c, 4); /* RGB, RGB, spectra, both */
    const size_t waves = 1 + fuzz_below(w->c, 5);
    if (kinds != 2) {
        const size_t shape[5] = {size_of(w, phi), size_of(w, theta), size_of(w, 3),
                                 size_of(w, side), size_of(w, side)};
        put_field(w, "rgb", 5, shape, -0.1, 1.0, 0);
    }
    if (kinds >= 2) {
        const size_t shape[5] = {size_of(w, phi), size_of(w, theta), size_of(w, waves),
                                 size_of(w, side), size_of(w, side)};
        put_field(w, "spectra", 5, shape, -0.1, 1.0, 0);
        put_field(w, "wavelengths", 1, &waves, 360.0, 800.0, 1);
    }
}

static void put_material(writer *w)
{
    static const double turns[] = {6.2831853, 6.2831853, 3.14159265, 1.57079633};
    const size_t theta = 2 + fuzz_below(w->c, 2), side = 2 + fuzz_below(w->c, 2);
    const size_t phi = FUZZ_PICK(w->c, size_t, 1, 1, 2, 3, 4);
    double turn = turns[fuzz_below(w->c, 4)];
    if (fuzz_odd(w->c))
        turn = 6.28318 / FUZZ_PICK(w->c, double, 3.0, 100.0, 0.2, -1.0);
    const double first = fuzz_odd(w->c) ? -0.1 : 0.0;
    const double last = fuzz_odd(w->c) ? 1.6 : 1.5707963;
    put_field(w, "phi_i", 1, &phi, -turn / 2, turn / 2, 1);
    put_field(w, "theta_i", 1, &theta, first, last, 1);
    put_field(w, "ndf", 2, (size_t[]){size_of(w, 2), size_of(w, 3)}, 0.0, 1.0, 0);
    put_field(w, "sigma", 2, (size_t[]){size_of(w, phi > 2 ? 4 : 2), size_of(w, 2)}, 0.1, 1.0, 0);
    put_field(w, "vndf", 4,
              (size_t[]){size_of(w, phi), size_of(w, theta), size_of(w, side), size_of(w, 3)}, 0.0,
              1.0, 0);
    put_field(w, "luminance", 4,
              (size_t[]){size_of(w, phi), size_of(w, theta), size_of(w, side), size_of(w, side)},
              0.0, 1.0, 0);
    put_colours(w, phi, theta, side);
    if (fuzz_below(w->c, 2))
        put_bytes(w, "jacobian", fuzz_below(w->c, 2) ? "\x01" : "\x02\x01");
    if (fuzz_below(w->c, 2))
        put_bytes(w, "description", "made by a generator");
}

static size_t header_size(const writer *w)
{
    size_t size = 12 + 2 + 4;
    for (int k = 0; k < w->count; k++) {
        const uint64_t dims = w->fields[k].dims;
        size +=
            2 + strlen(w->fields[k].name) + 2 + 1 + 8 + 8 * (dims < MOST_AXES ? dims : MOST_AXES);
    }
    return size;
}

static void put_record(const writer *w, const field *f, size_t start, fuzz_bytes *out)
{
    fuzz_put_le(out, fuzz_whole(w->c, strlen(f->name)), 2);
    fuzz_put_text(out, f->name);
    fuzz_put_le(out, f->dims, 2);
    fuzz_put_le(out, f->type, 1);
    fuzz_put_le(out, fuzz_whole(w->c, start + f->offset), 8);
    for (uint64_t axis = 0; axis < f->dims && axis < MOST_AXES; axis++)
        fuzz_put_le(out, f->shape[axis], 8);
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    writer w = {.c = c};
    put_material(&w);
    const size_t start = header_size(&w);
    fuzz_put(out, "tensor_file", 12);
    fuzz_put_le(out, fuzz_whole(c, 1), 1);
    fuzz_put_le(out, fuzz_below(c, 8) ? 0 : 1, 1);
    const int crowded = fuzz_odd(c); /* more fields than anybody needs */
    fuzz_put_le(out, crowded ? 300 : fuzz_whole(c, (uint64_t)w.count), 4);
    const int twice = fuzz_odd(c) ? (int)fuzz_below(c, (unsigned)w.count) : -1;
    for (int k = 0; k < w.count; k++)
        put_record(&w, &w.fields[k == twice ? 0 : k], start, out);
    fuzz_put(out, w.data.data, w.data.size);
    for (int k = 0; crowded && k < 500; k++)
        fuzz_put_le(out, 0, 8);
    if (fuzz_odd(c))
        out->size = FUZZ_PICK(c, size_t, 12, 17, 18, 19, start - 1, start - 5, start - 20,
                              start - 30, out->size - 1);
    if (fuzz_odd(c))
        out->size = start - fuzz_below(c, 60);
    fuzz_free(&w.data);
}

FUZZ_GENERATOR(generate)
