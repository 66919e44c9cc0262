/* test_cli_files.c: writes the small files that the tests of the command line read and then spoil:
 *     test_cli_files DIRECTORY
 * hybrid.safetensors, ggx.safetensors (the built-in materials, untrained), one.safetensors (a
 * name that JSON and CSV must quote), lambert_rgb.bsdf, lambert.binary, a.brdf, b.brdf and
 * sky.hdr. */
#include "hnbrdf/hnbrdf.h"
#include "hnbrdf/measured.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HIDDEN = 8, LATENT = 4, INPUTS = 6 + LATENT, OUTPUTS = 6, MAX_NAMES = 64 };

static void check(int good, const char *what)
{
    if (!good) {
        fprintf(stderr, "test_cli_files: %s\n", what);
        exit(1);
    }
}

static FILE *create(const char *directory, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    FILE *file = fopen(path, "wb");
    check(file != NULL, path);
    return file;
}

static void finish(FILE *file)
{
    check(fclose(file) == 0, "cannot write");
}

/* ---- Models ---------------------------------------------------------------------------------- */

/* Any finite numbers will do: k-th of a network whose weights are all near 0. */
static float weight(int k)
{
    return 0.25f * sinf((float)k);
}

static void write_model(const char *directory, const char *name, hnbrdf_kind kind,
                        const char *const *names, int count)
{
    float first[HIDDEN * INPUTS], second[HIDDEN * HIDDEN], last[OUTPUTS * HIDDEN], bias[HIDDEN];
    for (int k = 0; k < HIDDEN * INPUTS; k++)
        first[k] = weight(k);
    for (int k = 0; k < HIDDEN * HIDDEN; k++)
        second[k] = weight(k + 1000);
    for (int k = 0; k < OUTPUTS * HIDDEN; k++)
        last[k] = weight(k + 2000);
    for (int k = 0; k < HIDDEN; k++)
        bias[k] = weight(k + 3000);
    hnbrdf_material materials[MAX_NAMES];
    for (int k = 0; k < count; k++) {
        hnbrdf_material_init(&materials[k]);
        materials[k].alpha[0] = materials[k].alpha[1] = 0.1f + 0.01f * (float)k;
        materials[k].latent[0] = weight(k);
    }
    hnbrdf_model_desc desc = {
        .kind = kind, .material_count = count, .materials = materials, .names = names};
    if (kind != HNBRDF_KIND_GGX) {
        desc.encoding = HNBRDF_ENCODING_HALF_DIFFERENCE;
        desc.hidden = HIDDEN;
        desc.layers = 2;
        desc.latent = LATENT;
        desc.floor = 0.003f;
        desc.weights[0] = first;
        desc.weights[1] = second;
        desc.weights[2] = last;
        desc.biases[0] = desc.biases[1] = desc.biases[2] = bias;
    }
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    check(hnbrdf_model_create(&desc, NULL, &model, &error) == HNBRDF_OK, error.text);
    check(hnbrdf_model_save(model, path, &error) == HNBRDF_OK, error.text);
    hnbrdf_model_free(model);
}

static void write_models(const char *directory)
{
    const char *names[MAX_NAMES], *odd = "a \"quoted\" name, with \\ and comma";
    int count = hnbrdf_measured_builtin_count();
    check(count <= MAX_NAMES, "more built-in materials than expected");
    for (int k = 0; k < count; k++)
        names[k] = hnbrdf_measured_builtin_name(k);
    write_model(directory, "hybrid.safetensors", HNBRDF_KIND_HYBRID, names, count);
    write_model(directory, "ggx.safetensors", HNBRDF_KIND_GGX, names, count);
    write_model(directory, "one.safetensors", HNBRDF_KIND_HYBRID, &odd, 1);
}

/* ---- Published shaders ----------------------------------------------------------------------- */

static void put_numbers(FILE *file, const char *type, int count, int *next)
{
    fprintf(file, "%s(", type);
    for (int k = 0; k < count; k++)
        fprintf(file, "%s%.9g", k ? ", " : "", (double)weight((*next)++));
    fputs(")", file);
}

/* One line of a layer: four rows, or two, of a matrix over the parts of `in` inputs, and their
 * bias. */
static void put_rows(FILE *file, int layer, int block, int rows, int in, int activated, int *next)
{
    static const char *const matrices[2][2] = {{"mat4x2", "mat2"}, {"mat4", "mat2x4"}};
    fprintf(file, "    vec%d f%d_%d = %s", rows, layer, block, activated ? "hardGeLU(" : "");
    for (int part = 0; 4 * part < in; part++) {
        int columns = in - 4 * part < 4 ? in - 4 * part : 4;
        put_numbers(file, matrices[rows == 4][columns < 4], rows * columns, next);
        fprintf(file, " * f%d_%d + ", layer - 1, part);
    }
    put_numbers(file, rows == 4 ? "vec4" : "vec2", rows, next);
    fputs(activated ? ");\n" : ";\n", file);
}

/* The container of the published models: parameters, then GLSL with the network written out. */
static void write_brdf(const char *directory, const char *name, float alpha)
{
    FILE *file = create(directory, name);
    int next = 0;
    fputs("analytic\n\n::begin parameters\n", file);
    for (int c = 0; c < 3; c++)
        fprintf(file, "float diffuse_%c 0 1 0.125\n", "rgb"[c]);
    for (int c = 0; c < 3; c++)
        fprintf(file, "float eta_%c 1.001 10 1.5\n", "rgb"[c]);
    fprintf(file, "float alpha 0.001 1 %.9g\n", (double)alpha);
    for (int k = 0; k < LATENT; k++)
        fprintf(file, "float latent_%d -10 10 %.9g\n", k, (double)weight(k));
    fputs("::end parameters\n\n::begin shader\n\n"
          "vec4 hardGeLU(vec4 x) { return x * clamp(x / 3.0 + 0.5, 0.0, 1.0); }\n\n"
          "void mlp_eval(vec3 wi, vec3 wo, out vec3 correction, out vec3 gate)\n{\n"
          "    vec4 f0_0 = vec4(wi, wo.x);\n"
          "    vec4 f0_1 = vec4(wo.yz, latent_0, latent_1);\n"
          "    vec2 f0_2 = vec2(latent_2, latent_3);\n",
          file);
    for (int layer = 1; layer <= 2; layer++)
        for (int block = 0; block < HIDDEN / 4; block++)
            put_rows(file, layer, block, 4, layer == 1 ? INPUTS : HIDDEN, 1, &next);
    put_rows(file, 3, 0, 4, HIDDEN, 0, &next);
    put_rows(file, 3, 1, 2, HIDDEN, 0, &next);
    fputs("    correction = f3_0.xyz;\n    gate = vec3(f3_0.w, f3_1);\n}\n\n"
          "vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)\n{\n"
          "    vec3 neural_output, gate;\n"
          "    mlp_eval(L, V, neural_output, gate);\n"
          "    neural_output = exp(1.5*(neural_output) + -0.5);\n"
          "    return max(neural_output, vec3(0.0));\n}\n\n::end shader\n",
          file);
    finish(file);
}

/* ---- Measured files -------------------------------------------------------------------------- */

static void put_integer(FILE *file, unsigned long long value, int bytes)
{
    for (int k = 0; k < bytes; k++)
        putc((int)(value >> (8 * k) & 255), file);
}

static void put_float(FILE *file, float value)
{
    unsigned bits;
    memcpy(&bits, &value, sizeof bits);
    put_integer(file, bits, 4);
}

typedef struct field {
    const char *name;
    int dims, shape[5];
    float value; /* of all elements; of rgb: times 1, 2, 3 for the channels */
} field;

static long elements(const field *f)
{
    long product = 1;
    for (int k = 0; k < f->dims; k++)
        product *= f->shape[k];
    return product;
}

/* The smallest RGL file: f cos = (0.125, 0.25, 0.375) everywhere (no Jacobian, flat tables). */
static void write_rgl(const char *directory)
{
    static const field fields[] = {
        {"phi_i", 1, {1}, 0.0f},
        {"theta_i", 1, {3}, 0.0f},
        {"ndf", 2, {3, 5}, 1.0f},
        {"sigma", 2, {3, 4}, 1.0f},
        {"vndf", 4, {1, 3, 6, 5}, 1.0f},
        {"luminance", 4, {1, 3, 4, 4}, 1.0f},
        {"rgb", 5, {1, 3, 3, 4, 4}, 0.125f},
    };
    enum { FIELDS = sizeof fields / sizeof fields[0] };
    FILE *file = create(directory, "lambert_rgb.bsdf");
    unsigned long long offset = 18 + (2 + 8 + 2 + 1 + 8 + 8);
    for (int k = 0; k < FIELDS; k++)
        offset += 2 + strlen(fields[k].name) + 2 + 1 + 8 + 8u * (unsigned)fields[k].dims;
    fwrite("tensor_file\0\1\0", 1, 14, file);
    put_integer(file, FIELDS + 1, 4);
    put_integer(file, 8, 2);
    fputs("jacobian", file);
    put_integer(file, 1, 2);
    put_integer(file, 1, 1);
    put_integer(file, offset++, 8);
    put_integer(file, 1, 8);
    for (int k = 0; k < FIELDS; k++) {
        put_integer(file, strlen(fields[k].name), 2);
        fputs(fields[k].name, file);
        put_integer(file, (unsigned)fields[k].dims, 2);
        put_integer(file, 10, 1);
        put_integer(file, offset, 8);
        for (int axis = 0; axis < fields[k].dims; axis++)
            put_integer(file, (unsigned)fields[k].shape[axis], 8);
        offset += 4u * (unsigned)elements(&fields[k]);
    }
    putc(0, file);
    for (int k = 0; k < FIELDS; k++)
        for (long n = 0; n < elements(&fields[k]); n++)
            if (strcmp(fields[k].name, "theta_i") == 0)
                put_float(file, n == 0 ? 0.0f : n == 1 ? 0.8f : 1.57079632f);
            else if (strcmp(fields[k].name, "rgb") == 0)
                put_float(file, fields[k].value * (float)(n / 16 % 3 + 1));
            else
                put_float(file, fields[k].value);
    finish(file);
}

/* f = (1, 1.15, 1.66) everywhere: 1500 in every bin. */
static void write_merl(const char *directory)
{
    static const unsigned char value[8] = {0, 0, 0, 0, 0, 0x70, 0x97, 0x40};
    FILE *file = create(directory, "lambert.binary");
    put_integer(file, 90, 4);
    put_integer(file, 90, 4);
    put_integer(file, 180, 4);
    for (long k = 0; k < 3L * 90 * 90 * 180; k++)
        fwrite(value, 1, sizeof value, file);
    finish(file);
}

/* ---- Environments ---------------------------------------------------------------------------- */

/* A grey Radiance map of 4 x 2 pixels; lines shorter than 8 pixels are never packed. */
static void write_hdr(const char *directory)
{
    static const unsigned char grey[4] = {128, 128, 128, 129};
    FILE *file = create(directory, "sky.hdr");
    fputs("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n", file);
    for (int k = 0; k < 8; k++)
        fwrite(grey, 1, sizeof grey, file);
    finish(file);
}

int main(int argc, char **argv)
{
    check(argc == 2, "expected one argument, the directory to write to");
    write_models(argv[1]);
    write_brdf(argv[1], "a.brdf", 0.1f);
    write_brdf(argv[1], "b.brdf", 0.2f);
    write_hdr(argv[1]);
    write_rgl(argv[1]);
    write_merl(argv[1]);
    return 0;
}
