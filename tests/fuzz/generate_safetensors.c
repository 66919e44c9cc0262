/* generate_safetensors.c: model files. A header of JSON as several writers make it, and tensors of
 * the shapes that the kind of the model has. */
#include "generate.h"

#include "hnbrdf/hnbrdf.h"

#include <stdio.h>
#include <string.h>

typedef struct shape {
    int kind, layers, hidden, latent, materials;
} shape;

typedef struct writer {
    fuzz_choices *c;
    fuzz_bytes *header, *data;
    shape shape;
    int entries;
} writer;

/* ---- JSON ------------------------------------------------------------------------------------ */

static void put_space(writer *w)
{
    if (fuzz_below(w->c, 20) == 0)
        fuzz_put_text(w->header, FUZZ_PICK(w->c, char *, " ", "\n", "\t", "\r\n", "    "));
    if (fuzz_odd(w->c))
        fuzz_put_text(w->header, FUZZ_PICK(w->c, char *, ",", "}", "]", "{", "[", ":", "\"", "x",
                                           "\v", "\x01", "0", "/**/", "null", "\xff"));
}

/* A string's inside: every character may be written in several ways. */
static void put_inside(writer *w, const char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < 0x80 && fuzz_below(w->c, 40) == 0)
            fuzz_printf(w->header, fuzz_below(w->c, 2) ? "\\u%04x" : "\\u%04X", (unsigned)*text);
        else if (*text == '"' || *text == '\\')
            fuzz_printf(w->header, "\\%c", *text);
        else
            fuzz_put(w->header, text, 1);
    if (fuzz_odd(w->c))
        fuzz_put_text(w->header,
                      FUZZ_PICK(w->c, char *, "\\n", "\\t\\b\\f\\r\\/", "\\u00e9", "\\ud83d\\ude00",
                                "\\u20ac", "\\ud83d", "\\ude00", "\\ud83d\\u0041", "\\u12g4", "\\u",
                                "\\x", "\\", "\x1f", "\x7f", "\xc3\xa9", "\xe2\x82\xac",
                                "\xf0\x9f\x98\x80", "\xff", "\xc3", "\xed\xa0\x80", "\xc0\x80",
                                "\xf5\x80\x80\x80", "\\u0000", "\n"));
}

static void put_string(writer *w, const char *text)
{
    put_space(w);
    fuzz_put_text(w->header, "\"");
    put_inside(w, text);
    fuzz_put_text(w->header, "\"");
    put_space(w);
}

/* A value of another writer that is skipped. */
static void put_any(writer *w)
{
    if (fuzz_odd(w->c)) {
        const int depth = FUZZ_PICK(w->c, int, 1, 63, 64, 65, 500);
        for (int k = 0; k < depth; k++)
            fuzz_put_text(w->header, fuzz_below(w->c, 2) ? "[" : "{\"a\":");
        fuzz_put_text(w->header, "1");
        return; /* never closed */
    }
    const char *usual =
        FUZZ_PICK(w->c, char *, "1", "-0", "1.5e-3", "0.25", "1E+5", "true", "false", "null",
                  "\"\"", "[]", "{}", "[1, 2,[3]]", "{\"a\":{\"b\":[\"c\",{}]},\"d\":-1}",
                  "[[[[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]]]]");
    const char *odd = FUZZ_PICK(w->c, char *, "01", "-", "1.", ".5", "1e", "+1", "tru", "nul",
                                "fals", "[1,]", "[1 2]", "{1:2}", "{\"a\"}", "{\"a\":}", "NaN",
                                "\"", "'a'", "", "truex", "1e+", "--1", "[", "{");
    fuzz_put_text(w->header, fuzz_odd(w->c) ? odd : usual);
}

/* Before a key. */
static void put_comma(writer *w)
{
    if (w->entries++)
        fuzz_put_text(w->header, ",");
}

static void put_whole(writer *w, uint64_t usual)
{
    if (fuzz_odd(w->c))
        fuzz_put_text(w->header, FUZZ_PICK(w->c, char *, "-1", "1.0", "1e2", "18446744073709551615",
                                           "18446744073709551616", "99999999999999999999999", "007",
                                           "", "null", "\"1\"", "[1]"));
    else
        fuzz_printf(w->header, "%llu", (unsigned long long)fuzz_whole(w->c, usual));
}

/* ---- Metadata -------------------------------------------------------------------------------- */

/* A key that may be missing, doubled or of other text. */
static void put_key(writer *w, const char *key, const char *value)
{
    const int times = fuzz_odd(w->c) ? 2 * (int)fuzz_below(w->c, 2) : 1;
    for (int k = 0; k < times; k++) {
        put_comma(w);
        put_string(w, key);
        fuzz_put_text(w->header, ":");
        if (fuzz_odd(w->c))
            put_any(w);
        else
            put_string(w, fuzz_word(w->c, value));
    }
}

static void put_key_number(writer *w, const char *key, double usual)
{
    fuzz_bytes text = {0};
    if (fuzz_below(w->c, 3))
        return;
    fuzz_put_number(&text, w->c, usual);
    fuzz_put(&text, "", 1);
    put_key(w, key, (const char *)text.data);
    fuzz_free(&text);
}

/* JSON in a string of JSON. */
static void put_names(writer *w)
{
    fuzz_bytes list = {0};
    int count = w->shape.materials;
    if (fuzz_odd(w->c))
        count = FUZZ_PICK(w->c, int, 0, 1, 2, 3, 40);
    fuzz_put_text(&list, "[");
    for (int m = 0; m < count; m++) {
        fuzz_put_text(&list, m ? ", \"" : "\"");
        if (fuzz_odd(w->c))
            fuzz_put_text(&list, FUZZ_PICK(w->c, char *, "\\u0000", "\\u0001", "\\n", "\x7f", "\\",
                                           "\\ud800", "\"", "\", 1, \"", "name_0", "a/b", "\xff"));
        fuzz_put_text(&list, fuzz_word(w->c, m % 2 ? "brushed \\\"steel\\\"" : "caf\xc3\xa9"));
        fuzz_printf(&list, " %d\"", m);
    }
    fuzz_put(&list, "]", 2); /* and NUL */
    put_key(w, "materials", (const char *)list.data);
    fuzz_free(&list);
}

static void put_metadata(writer *w)
{
    const int entries = w->entries;
    const char *kind = hnbrdf_kind_name((hnbrdf_kind)w->shape.kind);
    put_comma(w);
    put_string(w, "__metadata__");
    fuzz_put_text(w->header, ":");
    put_space(w);
    fuzz_put_text(w->header, "{");
    w->entries = 0;
    put_key(w, "format",
            fuzz_odd(w->c) ? FUZZ_PICK(w->c, char *, "hnbrdf/2", "hnbrdf/", "hnbrdf/x", "pt", "tf")
            : fuzz_below(w->c, 4) ? "hnbrdf/1"
                                  : "hnbrdf/1.7");
    put_key(w, "kind", fuzz_odd(w->c) ? FUZZ_PICK(w->c, char *, "ggx", "neural", "hybrid") : kind);
    int encodings = 0;
    while (hnbrdf_encoding_name((hnbrdf_encoding)encodings))
        encodings++;
    const char *encoding =
        hnbrdf_encoding_name((hnbrdf_encoding)fuzz_below(w->c, (unsigned)encodings));
    if (w->shape.kind != HNBRDF_KIND_GGX || fuzz_below(w->c, 2))
        put_key(w, "encoding", encoding);
    put_key_number(w, "scale", 1.5);
    put_key_number(w, "shift", -0.25);
    put_key_number(w, "floor", 0.003);
    if (fuzz_below(w->c, 4))
        put_names(w);
    if (fuzz_below(w->c, 3) == 0)
        put_key(w, "training \"data\"", "{\"rgl\": [1, 2]}");
    fuzz_put_text(w->header, "}");
    w->entries = entries + 1;
}

/* ---- Tensors --------------------------------------------------------------------------------- */

static size_t type_size(const char *type)
{
    return strcmp(type, "F64") == 0 || strcmp(type, "I64") == 0    ? 8
           : strcmp(type, "F16") == 0 || strcmp(type, "BF16") == 0 ? 2
           : strcmp(type, "U8") == 0                               ? 1
                                                                   : 4;
}

static void put_numbers(writer *w, const char *type, size_t count, double low, double high)
{
    const size_t odd = fuzz_odd(w->c) ? fuzz_below(w->c, (unsigned)count) : count;
    for (size_t i = 0; i < count; i++) {
        double value = fuzz_real_between(w->c, low, high);
        if (i == odd)
            value = fuzz_hostile(w->c, value);
        if (strcmp(type, "F64") == 0)
            fuzz_put_double(w->data, value);
        else if (strcmp(type, "F32") == 0)
            fuzz_put_float(w->data, value);
        else /* 1 in bfloat16 is 1.875 in half floats */
            fuzz_put_le(w->data, i == odd ? 0x7c00 + fuzz_below(w->c, 0x400) : 0x3f80,
                        (int)type_size(type));
    }
}

static void put_shape(writer *w, int rank, const size_t axes[2])
{
    fuzz_put_text(w->header, "[");
    for (int k = 0; k < rank; k++) {
        fuzz_put_text(w->header, k ? "," : "");
        put_whole(w, axes[k]);
    }
    if (fuzz_odd(w->c))
        fuzz_put_text(w->header,
                      FUZZ_PICK(w->c, char *, ",1", ",1,1,1,1,1,1", ",0",
                                ",4294967296,4294967296,4294967296", ",4611686018427387904", ","));
    fuzz_put_text(w->header, "]");
}

typedef struct place {
    const char *type;
    int rank;
    size_t axes[2], begin, end;
} place;

static void put_field(writer *w, int field, const place *p)
{
    static const char *const names[3] = {"dtype", "shape", "data_offsets"};
    put_string(w, names[field]);
    fuzz_put_text(w->header, ":");
    put_space(w);
    if (field == 0) {
        put_string(w, fuzz_word(w->c, p->type));
    } else if (field == 1) {
        put_shape(w, p->rank, p->axes);
    } else {
        fuzz_put_text(w->header, "[");
        put_whole(w, p->begin);
        fuzz_put_text(w->header, ",");
        put_whole(w, p->end);
        fuzz_put_text(w->header, fuzz_odd(w->c) ? ",7]" : "]");
    }
}

/* Three fields in any order; a writer may have more. */
static void put_entry(writer *w, const char *name, const place *p)
{
    const unsigned first = fuzz_below(w->c, 3);
    put_comma(w);
    put_string(w, name);
    fuzz_put_text(w->header, ":");
    put_space(w);
    fuzz_put_text(w->header, "{");
    for (unsigned k = 0, fields = 0; k < 3; k++) {
        const int times = fuzz_odd(w->c) ? 2 * (int)fuzz_below(w->c, 2) : 1;
        for (int t = 0; t < times; t++) {
            fuzz_put_text(w->header, fields++ ? "," : "");
            put_field(w, (int)((first + k) % 3), p);
        }
    }
    if (fuzz_below(w->c, 10) == 0) {
        fuzz_put_text(w->header, ",\"note\":");
        put_any(w);
    }
    fuzz_put_text(w->header, "}");
}

static void put_tensor(writer *w, const char *name, int rank, size_t rows, size_t columns,
                       const double range[2])
{
    const char *type =
        fuzz_odd(w->c) ? FUZZ_PICK(w->c, char *, "F64", "F16", "BF16", "I64", "U8", "f32") : "F32";
    const size_t count = rank == 2 ? rows * columns : rows;
    place p = {type, rank, {rows, columns}, w->data->size, 0};
    if (fuzz_odd(w->c))
        return;
    put_numbers(w, type, count, range[0], range[1]);
    p.end = w->data->size;
    put_entry(w,
              fuzz_odd(w->c) ? FUZZ_PICK(w->c, char *, "net.5.weight", "net.99999999999.bias",
                                         "net.0.weight", "material.kd", "net.", "other")
                             : name,
              &p);
}

static void put_network(writer *w)
{
    static const double range[2] = {-0.4, 0.4};
    size_t inputs = 6 + (size_t)w->shape.latent, hidden = (size_t)w->shape.hidden;
    const size_t last = w->shape.kind == HNBRDF_KIND_NEURAL ? 3 : 6;
    for (int k = 0; k <= w->shape.layers; k++) {
        char name[32];
        const size_t outputs = k < w->shape.layers ? hidden : last;
        snprintf(name, sizeof name, "net.%d.weight", k);
        put_tensor(w, name, 2, outputs, inputs, range);
        snprintf(name, sizeof name, "net.%d.bias", k);
        put_tensor(w, name, 1, outputs, 0, range);
        inputs = hidden;
    }
}

static void put_materials(writer *w)
{
    static const double zero[2] = {0.0, 0.0}, unit[2] = {0.05, 0.95}, eta[2] = {1.1, 3.0},
                        turn[2] = {-3.1, 3.1};
    const size_t count = (size_t)w->shape.materials;
    if (w->shape.kind != HNBRDF_KIND_NEURAL || fuzz_below(w->c, 2)) {
        put_tensor(w, "material.kd", 2, count, 3, unit);
        put_tensor(w, "material.eta", 2, count, 3, eta);
        put_tensor(w, "material.alpha", 2, count, 2, unit);
    }
    if (fuzz_below(w->c, 2))
        put_tensor(w, "material.rotation", 1, count, 0, turn);
    if (w->shape.latent > 0)
        put_tensor(w, "material.latent", 2, count, (size_t)w->shape.latent, turn);
    if (fuzz_below(w->c, 3) == 0)
        put_tensor(w, "material.lobes", 2, count, 10, unit);
    if (fuzz_below(w->c, 3) == 0) /* all zeros: as it is; else out of range */
        put_tensor(w, "material.fitted", 2, count, 8, fuzz_below(w->c, 4) ? zero : unit);
    if (fuzz_below(w->c, 3) == 0)
        put_tensor(w, "optimiser.step", 1, 1, 0, unit);
}

/* ---- The file -------------------------------------------------------------------------------- */

static shape choose_shape(fuzz_choices *c)
{
    shape s = {(int)fuzz_below(c, 3), fuzz_between(c, 1, 4), fuzz_between(c, 1, 8),
               fuzz_between(c, 0, 3), fuzz_between(c, 1, 4)};
    if (fuzz_odd(c))
        s.layers = 0;
    if (fuzz_odd(c))
        s.hidden = FUZZ_PICK(c, int, 64, 65, 0);
    if (fuzz_odd(c))
        s.latent = FUZZ_PICK(c, int, 16, 17, -1);
    if (fuzz_odd(c))
        s.materials = FUZZ_PICK(c, int, 0, 300);
    s.latent = s.kind == HNBRDF_KIND_GGX ? 0 : s.latent;
    return s;
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    fuzz_bytes header = {0}, data = {0};
    writer w = {c, &header, &data, choose_shape(c), 0};
    const int metadata_last = fuzz_below(c, 3) == 0;
    const int times = fuzz_odd(c) ? 2 * (int)fuzz_below(c, 2) : 1;
    fuzz_put_text(&header,
                  fuzz_odd(c) ? FUZZ_PICK(c, char *, "[", "", " {", "\xef\xbb\xbf{") : "{");
    for (int k = 0; !metadata_last && k < times; k++)
        put_metadata(&w);
    if (w.shape.kind != HNBRDF_KIND_GGX)
        put_network(&w);
    put_materials(&w);
    for (int k = 0; metadata_last && k < times; k++)
        put_metadata(&w);
    fuzz_put_text(&header, fuzz_odd(c) ? FUZZ_PICK(c, char *, "", "}}", "},", "} x", "]") : "}");
    while (fuzz_below(c, 2) && header.size % 8)
        fuzz_put_text(&header, " ");
    if (fuzz_odd(c))
        fuzz_put(&data, "more", 1 + fuzz_below(c, 4));
    if (fuzz_odd(c))
        data.size -= data.size ? 1 + fuzz_below(c, (unsigned)data.size) : 0;
    fuzz_put_le(out, fuzz_whole(c, header.size), fuzz_odd(c) ? 7 : 8);
    fuzz_put(out, header.data, header.size);
    fuzz_put(out, data.data, data.size);
    fuzz_free(&header);
    fuzz_free(&data);
}

FUZZ_GENERATOR(generate)
