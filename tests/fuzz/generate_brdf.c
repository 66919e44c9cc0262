/* generate_brdf.c: published BRDF-Explorer shaders, or those that hnbrdf writes, with a heading:
 * parameter lines, then GLSL with the network written out in matrices and vectors; sometimes two of
 * one data set, with a NUL between. */
#include "generate.h"

#include <stdio.h>

typedef struct writer {
    fuzz_choices *c;
    fuzz_bytes *out;
    int latent;
    int outputs; /* of the network; 0: none */
} writer;

static void put_space(writer *w)
{
    if (fuzz_below(w->c, 30) == 0)
        fuzz_put_text(w->out,
                      FUZZ_PICK(w->c, char *, " ", "\n", "\t", " // x\n", "/* y\n */", "# z\n"));
    if (fuzz_odd(w->c))
        fuzz_put_text(w->out, FUZZ_PICK(w->c, char *, ";", ")", "(", "{", "}", "*", "/*", "//", ",",
                                        "x", "1", ".", "-", "= exp(", "\x01", "\xff", "1e99",
                                        "mat4(", "vec2(1)"));
}

static void put_word(writer *w, const char *word)
{
    put_space(w);
    fuzz_put_text(w->out, fuzz_word(w->c, word));
}

/* ---- Headings of files that hnbrdf wrote ----------------------------------------------------- */

static void put_heading(writer *w)
{
    static const char *const kinds[3] = {"ggx", "neural", "hybrid"};
    static const char *const keys[6] = {"kind", "encoding", "scale", "shift", "fitted", "lobes"};
    static const int counts[6] = {0, 0, 1, 1, 8, 10};
    for (int k = 0; k < 6; k++) {
        if (k == 4 && fuzz_below(w->c, 2))
            continue;
        fuzz_put_text(w->out, "# hnbrdf/1 ");
        fuzz_put_text(w->out, fuzz_word(w->c, keys[k]));
        fuzz_put_text(w->out, " ");
        if (k == 0)
            fuzz_put_text(w->out, fuzz_word(w->c, kinds[w->outputs / 3]));
        if (k == 1)
            fuzz_put_text(w->out, fuzz_word(w->c, FUZZ_PICK(w->c, char *, "angles", "directions",
                                                            "half-difference")));
        for (int i = fuzz_odd(w->c) ? 1 : 0; i < counts[k]; i++) {
            fuzz_put_number(w->out, w->c, k == 4 && i > 2 && i < 6 ? 1.5 : k == 2 ? 0.75 : 0.2);
            fuzz_put_text(w->out, " ");
        }
        fuzz_put_text(w->out, fuzz_odd(w->c) ? "floor" : fuzz_below(w->c, 4) ? "\n" : "\r\n");
    }
    fuzz_put_text(w->out, "# hnbrdf/1 floor 0.003\n");
}

/* ---- Parameters ------------------------------------------------------------------------------ */

static void put_parameter(writer *w, const char *name, double low, double high)
{
    const int times = fuzz_odd(w->c) ? 2 * (int)fuzz_below(w->c, 2) : 1;
    for (int k = 0; k < times; k++) {
        fuzz_put_text(w->out, "float ");
        put_word(w, name);
        fuzz_printf(w->out, " %g %g ", low, high);
        fuzz_put_number(w->out, w->c, fuzz_real_between(w->c, low, high));
        fuzz_put_text(w->out, fuzz_below(w->c, 4) ? "\n" : "\r\n");
    }
}

static void put_parameters(writer *w)
{
    static const char *const names[6] = {"diffuse_r", "diffuse_g", "diffuse_b",
                                         "eta_r",     "eta_g",     "eta_b"};
    fuzz_put_text(w->out, "analytic\n# made\n");
    if (w->outputs != 6 || fuzz_below(w->c, 4) == 0)
        put_heading(w);
    fuzz_put_text(w->out, "::begin parameters\n");
    if (fuzz_below(w->c, 8) == 0)
        put_parameter(w, "rotation", -3.0, 3.0);
    for (int k = 0; k < 6; k++)
        put_parameter(w, names[k], k < 3 ? 0.01 : 1.1, k < 3 ? 1.0 : 4.0);
    const unsigned two = fuzz_below(w->c, 2);
    if (two)
        put_parameter(w, fuzz_odd(w->c) ? "alpha" : "alpha_x", 0.01, 1.0);
    put_parameter(w, two ? "alpha_y" : "alpha", fuzz_below(w->c, 4) ? 0.01 : 1e-6,
                  fuzz_below(w->c, 4) ? 1.0 : 2e-6);
    for (int k = 0; k < w->latent; k++) {
        char name[32];
        const int number = fuzz_odd(w->c) ? FUZZ_PICK(w->c, int, 15, 16, 17, 99, 9999, 99999) : k;
        snprintf(name, sizeof name, fuzz_odd(w->c) ? "latent_%dx" : "latent_%d", number);
        put_parameter(w, name, -5.0, 5.0);
    }
    fuzz_put_text(w->out,
                  "float gamma 0.1 4 2.2\nbool mirror 0\n::end parameters\n\n::begin shader\n");
}

/* ---- The network ----------------------------------------------------------------------------- */

static void put_numbers(writer *w, int count)
{
    if (fuzz_odd(w->c))
        count += fuzz_below(w->c, 2) ? 1 : -1;
    for (int k = 0; k < count; k++) {
        if (k > 0)
            put_word(w, ", ");
        if (fuzz_below(w->c, 40) == 0)
            fuzz_put_text(w->out, FUZZ_PICK(w->c, char *, "+", "--", "- "));
        fuzz_put_number(w->out, w->c, fuzz_real_between(w->c, -0.5, 0.5));
        if (fuzz_below(w->c, 20) == 0)
            fuzz_put_text(w->out, "f");
    }
}

/* Inputs of a layer are groups of up to four; the last one may be smaller. */
static int group_size(int total, int group)
{
    return total - 4 * group < 4 ? total - 4 * group : 4;
}

static void put_constructor(writer *w, int columns, int rows)
{
    if (fuzz_odd(w->c))
        rows = fuzz_between(w->c, 1, 5);
    if (fuzz_odd(w->c))
        columns = fuzz_between(w->c, 1, 5);
    if (columns == rows && fuzz_below(w->c, 2))
        fuzz_printf(w->out, "mat%d(", rows);
    else
        fuzz_printf(w->out, "mat%dx%d(", columns, rows);
    put_numbers(w, columns * rows);
    fuzz_put_text(w->out, ")");
}

static void put_operand(writer *w, int layer, int group, int component)
{
    char name[32];
    if (layer == 0 && component >= 0)
        snprintf(name, sizeof name, "i%d_%d", group, component);
    else
        snprintf(name, sizeof name, component < 0 ? "f%d_%d" : "f%d_%d.%c", layer, group,
                 "xyzw"[component & 3]);
    put_word(w, name);
    if (fuzz_odd(w->c))
        fuzz_put_text(w->out, FUZZ_PICK(w->c, char *, ".x", ".w", ".xy", ".", ".q", "_",
                                        "a_name_longer_than_thirty_letters"));
}

/* A group of one, or perhaps of more, is multiplied component by component with vectors. */
static void put_products(writer *w, int layer, int inputs, int rows)
{
    for (int g = 0; 4 * g < inputs; g++) {
        const int size = group_size(inputs, g),
                  apart = size == 1 || (layer > 0 && fuzz_below(w->c, 8) == 0);
        for (int k = 0; k < (apart ? size : 1); k++) {
            fuzz_put_text(w->out, g + k == 0 ? "" : fuzz_below(w->c, 6) ? " + " : " - ");
            if (!apart) {
                put_constructor(w, size, rows);
                put_word(w, " * ");
                put_operand(w, layer, g, -1);
                continue;
            }
            const int component = size == 1 && layer > 0 && fuzz_below(w->c, 2) ? -1 : k;
            put_operand(w, layer, g, component);
            put_word(w, " * ");
            if (fuzz_odd(w->c))
                put_constructor(w, 1, rows);
            fuzz_printf(w->out, "vec%d(", rows);
            put_numbers(w, fuzz_below(w->c, 6) ? rows : 1);
            fuzz_put_text(w->out, ")");
        }
    }
}

static void put_statement(writer *w, int layer, int group, int inputs, int rows, int activated)
{
    if (fuzz_odd(w->c))
        activated = !activated;
    if (fuzz_odd(w->c))
        inputs += fuzz_between(w->c, -4, 4);
    fuzz_printf(w->out, "    %svec%d f%d_%d ", fuzz_below(w->c, 6) ? "" : "const ", rows, layer + 1,
                group);
    put_word(w, "= ");
    if (activated)
        put_word(w, fuzz_below(w->c, 4) ? "hardGeLU(" : "HardGELU(");
    put_products(w, layer, inputs, rows);
    for (int biases = fuzz_odd(w->c) ? 2 : 1; biases > 0; biases--) {
        fuzz_printf(w->out, " + %s%d(", fuzz_odd(w->c) ? "mat" : "vec", rows);
        put_numbers(w, rows);
        fuzz_put_text(w->out, ")");
    }
    fuzz_put_text(w->out, activated ? ");\n" : ";\n");
}

static void put_network(writer *w)
{
    int layers = fuzz_between(w->c, 1, 3), inputs = 6 + w->latent;
    const int hidden = FUZZ_PICK(w->c, int, 2, 3, 4, 5, 6, 8);
    if (fuzz_odd(w->c))
        layers = FUZZ_PICK(w->c, int, 0, 4, 5, 6);
    fuzz_put_text(w->out, "void ");
    put_word(w, "mlp_eval");
    fuzz_put_text(w->out, "(vec3 wi, vec3 wo, out vec3 c, out vec3 g)\n{\n");
    fuzz_put_text(w->out, "    vec4 f0_0 = vec4(wi.x, wi.y, wi.z, wo.x);\n");
    for (int k = 0; k <= layers; k++) {
        int outputs = k < layers ? hidden : w->outputs;
        if (fuzz_odd(w->c))
            outputs = FUZZ_PICK(w->c, int, 2, 3, 5, 64, 65, 68);
        for (int g = 0; 4 * g < outputs; g++)
            if (group_size(outputs, g) > 1)
                put_statement(w, k, g, inputs, group_size(outputs, g), k < layers);
        inputs = outputs % 4 == 1 ? outputs - 1 : outputs;
    }
    put_word(w, "    c = f3_0.xyz;\n}\n");
}

static void put_shader(writer *w)
{
    put_parameters(w);
    fuzz_put_text(w->out, "void mlp_eval(vec3 wi, vec3 wo, out vec3 c, out vec3 g);\n");
    const int networks = w->outputs ? 1 : 0, exponents = w->outputs == 6 ? 1 : 0;
    for (int times = fuzz_odd(w->c) ? 2 * (int)fuzz_below(w->c, 2) : networks; times > 0; times--)
        put_network(w);
    fuzz_put_text(
        w->out,
        "vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)\n{\n    vec3 neural_output, gate;\n");
    for (int times = fuzz_odd(w->c) ? 2 * (int)fuzz_below(w->c, 2) : exponents; times > 0;
         times--) {
        fuzz_put_text(w->out, "    neural_output ");
        put_word(w, "= exp(");
        fuzz_put_number(w->out, w->c, fuzz_odd(w->c) ? 0.0 : 0.75);
        put_word(w, fuzz_below(w->c, 2) ? " * (neural_output)" : " * neural_output");
        fuzz_put_text(w->out, fuzz_below(w->c, 2) ? " - " : " + ");
        fuzz_put_number(w->out, w->c, -1.25);
        put_word(w, ");\n");
    }
    fuzz_put_text(w->out, "    return neural_output + gate;\n}\n\n::end shader\n");
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    writer w = {c, out, fuzz_between(c, 0, 4), fuzz_below(c, 4) ? 6 : FUZZ_PICK(c, int, 0, 3)};
    const uint64_t start = c->state;
    put_shader(&w);
    if (fuzz_below(c, 3) == 0) { /* the same network, one place of it odd */
        const uint64_t end = c->state;
        fuzz_put(out, "", 1);
        c->state = start;
        put_shader(&w);
        c->state = end;
    }
}

FUZZ_GENERATOR(generate)
