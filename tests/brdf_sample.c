/* brdf_sample.c: .brdf files in the syntax of the published ones, made up from a seed. */
#include "brdf_sample.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

int brdf_sample_inputs(const brdf_sample *s, int layer)
{
    return layer == 0 ? 6 + s->latent : s->hidden;
}

int brdf_sample_outputs(const brdf_sample *s, int layer)
{
    return layer < s->layers ? s->hidden : 6;
}

void make_brdf_sample(brdf_sample *s, uint64_t seed, int hidden, int layers, int latent)
{
    rng r = rng_make(seed);
    memset(s, 0, sizeof *s);
    s->hidden = hidden;
    s->layers = layers;
    s->latent = latent;
    s->exponent = "0.75*(neural_output) + -1.25";
    for (int k = 0; k <= layers; k++) {
        const int in = brdf_sample_inputs(s, k), out = brdf_sample_outputs(s, k);
        for (int i = 0; i < in * out; i++)
            s->weights[k][i] = 0.5f * rng_normal(&r);
        for (int i = 0; i < out; i++)
            s->biases[k][i] = 0.2f * rng_normal(&r);
    }
}

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
print(bytes *to, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    write_bytes(to, text, (size_t)vsnprintf(text, sizeof text, format, arguments));
    va_end(arguments);
}

static void print_parameters(bytes *to, const brdf_sample *s, const hnbrdf_material *m)
{
    static const char LETTERS[] = "rgb";
    print(to, "analytic\n\n# A made-up material in the syntax of the published files.\n::begin "
              "parameters\n");
    for (int c = 0; c < 3; c++)
        print(to, "float diffuse_%c 0.0 1.0 %.9g\n", LETTERS[c], (double)m->kd[c]);
    for (int c = 0; c < 3; c++)
        print(to, "float eta_%c 1.0 10.0 %.9g\n", LETTERS[c], (double)m->eta[c]);
    if (s->anisotropic)
        print(to, "float alpha_x 0.0001 1.0 %.9g\nfloat alpha_y 0.0001 1.0 %.9g\n",
              (double)m->alpha[0], (double)m->alpha[1]);
    else
        print(to, "float alpha 0.0001 1.0 %.9g\n", (double)m->alpha[0]);
    for (int i = 0; i < s->latent; i++)
        print(to, "float latent_%d -5.0 5.0 %.9g\n", i, (double)m->latent[i]);
    print(to, "float gamma 0.1 4.0 2.2\nbool mirror 0\n::end parameters\n\n");
}

static int group_size(int total, int group)
{
    return total - 4 * group < 4 ? total - 4 * group : 4;
}

/* Rows [4 group, ...) and columns [4 part, ...) of a layer, column by column. */
static void print_block(bytes *to, const brdf_sample *s, int layer, int group, int part)
{
    const int in = brdf_sample_inputs(s, layer);
    const int rows = group_size(brdf_sample_outputs(s, layer), group),
              columns = group_size(in, part);
    const char *gap = s->dense ? "" : " ";
    if (columns == 1 && s->dense)
        print(to, "f%d_%d*", layer, part);
    if (columns == 1)
        print(to, "vec%d(", rows);
    else if (columns == rows)
        print(to, "mat%d(", rows);
    else
        print(to, "mat%dx%d(", columns, rows);
    for (int c = 0; c < columns; c++)
        for (int r = 0; r < rows; r++)
            print(to, "%s%s%.9g", c + r == 0 ? "" : ",", c + r == 0 ? "" : gap,
                  (double)s->weights[layer][(4 * group + r) * in + 4 * part + c]);
    if (columns == 1 && s->dense)
        print(to, ")");
    else
        print(to, s->dense ? ")*f%d_%d" : ") * f%d_%d", layer, part);
}

/* The bias, in the dense style with its sign turned twice. */
static void print_bias(bytes *to, const brdf_sample *s, int layer, int group)
{
    const int rows = group_size(brdf_sample_outputs(s, layer), group);
    print(to, s->dense ? "\n  - // the bias, negated\n vec%d(" : " + vec%d(", rows);
    for (int r = 0; r < rows; r++)
        print(to, s->dense ? "%s- %.9g" : "%s%.9g", r ? ", " : "",
              (double)s->biases[layer][4 * group + r]);
    print(to, ")");
}

static void print_statement(bytes *to, const brdf_sample *s, int layer, int group)
{
    const int in = brdf_sample_inputs(s, layer);
    const int hidden = layer < s->layers;
    print(to, s->dense ? "const vec%d/*rows*/f%d_%d=%s" : "    vec%d f%d_%d = %s",
          group_size(brdf_sample_outputs(s, layer), group), layer + 1, group,
          hidden ? "hardGeLU(" : "");
    for (int part = 0; 4 * part < in; part++) {
        print(to, part == 0 ? "" : s->dense ? "+\n" : " + ");
        print_block(to, s, layer, group, part);
    }
    print_bias(to, s, layer, group);
    print(to, hidden ? ");\n" : ";\n");
}

static void print_inputs(bytes *to, const brdf_sample *s)
{
    static const char *const DIRECTIONS[] = {"wi.x", "wi.y", "wi.z", "wo.x", "wo.y", "wo.z"};
    for (int part = 0; 4 * part < 6 + s->latent; part++) {
        const int size = group_size(6 + s->latent, part);
        if (size == 1)
            print(to, "    float f0_%d = ", part);
        else
            print(to, "    vec%d f0_%d = vec%d(", size, part, size);
        for (int i = 4 * part; i < 4 * part + size; i++) {
            print(to, i > 4 * part ? ", " : "");
            if (i < 6)
                print(to, "%s", DIRECTIONS[i]);
            else
                print(to, "latent_%d", i - 6);
        }
        print(to, size == 1 ? ";\n" : ");\n");
    }
}

bytes brdf_sample_text(const brdf_sample *s, const hnbrdf_material *material)
{
    bytes to = {NULL, 0};
    print_parameters(&to, s, material);
    print(&to, "::begin shader\n\n#define PI 3.14159265\n"
               "vec4 hardGeLU(vec4 x) { return x * clamp(x / 3.0 + 0.5, 0.0, 1.0); }\n"
               "void mlp_eval(vec3 wi, vec3 wo, out vec3 c, out vec3 g);\n\n"
               "void mlp_eval(vec3 wi, vec3 wo, out vec3 c, out vec3 g)\n{\n");
    print_inputs(&to, s);
    for (int layer = 0; layer <= s->layers; layer++)
        for (int group = 0; 4 * group < brdf_sample_outputs(s, layer); group++)
            print_statement(&to, s, layer, group);
    const int last = s->layers + 1;
    print(&to, "    c = f%d_0.xyz;\n    g = vec3(f%d_0.w, f%d_1.xy);\n}\n\n", last, last, last);
    print(&to, "vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)\n{\n"
               "    mat3 frame = mat3(X, Y, N);\n    vec3 neural_output, gate;\n"
               "    mlp_eval(L * frame, V * frame, neural_output, gate);\n");
    print(&to, "    neural_output = exp(%s);\n", s->exponent);
    print(&to, "    return neural_output + gate;\n}\n\n::end shader\n");
    return to;
}
