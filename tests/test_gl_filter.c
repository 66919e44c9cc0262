/* test_gl_filter.c: packed materials in textures with linear filtering, in every GL and GL ES
 * context of this machine: between two materials the shader has the material that C unpacks from
 * the filtered texels. Skipped where there is no context. */
#include "gpu_support.h"

#include "check/rules.h"
#include "core/half.h"
#include "core/pack.h"
#include "gl/draw.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static gl_context context;

/* A result a place: the filtered texels, then kd, eta, alpha, the latent code, f. */
enum { PLACES = 200, MATERIAL_SLOTS = 5, SLOTS = HNBRDF_MAX_TEXELS + MATERIAL_SLOTS };

static const scene_shape SHAPE = {
    .encoding = HNBRDF_ENCODING_ANGLES, .hidden = 4, .layers = 1, .latent = 4, .anisotropic = 1};

typedef struct bench {
    hnbrdf_model *model;
    hnbrdf_packing packing;
    int texels;
    GLuint textures[HNBRDF_MAX_TEXELS];
    float places[PLACES][4], results[PLACES][SLOTS][4];
} bench;

/* The order of operations is kept, by a driver that test_gl_verify knows to round as C does. */
static int is_exact(void)
{
    return (context.dialect == GL_DIALECT_450 || context.dialect == GL_DIALECT_ES_320) &&
           strncmp(context.name, "llvmpipe", 8) == 0;
}

/* ---- The shader ------------------------------------------------------------------------------ */

/* Texel number t of every material is in a texture of its own, so that neighbours are of one
 * kind. */
static char *make_shader(const bench *b)
{
    char *text = malloc(8192);
    int length = 0;
    assert_non_null(text);
    for (int t = 0; t < b->texels; t++)
        length += snprintf(text + length, 256, "uniform highp sampler2D map%d;\n", t);
    length += snprintf(text + length, 512,
                       GL_FRAME "void main()\n{\n    vec2 at = vec2(texel(0, 1).x, 0.5);\n");
    for (int t = 0; t < b->texels; t++)
        length += snprintf(text + length, 256,
                           "    vec4 t%d = texture(map%d, at);\n    if (slot == %d)\n        "
                           "result = t%d;\n",
                           t, t, t, t);
    length += snprintf(text + length, 256, "    hnbrdf_material m = hnbrdf_material_unpack(");
    for (int t = 0; t < b->texels; t++)
        length += snprintf(text + length, 16, t ? ", t%d" : "t%d", t);
    snprintf(text + length, 1024,
             ");\n    int field = slot - %d;\n"
             "    if (field == 0)\n        result = vec4(m.kd, 0.0);\n"
             "    if (field == 1)\n        result = vec4(m.eta, 0.0);\n"
             "    if (field == 2)\n        result = vec4(vec2(m.alpha), 0.0, 0.0);\n"
             "    if (field == 3)\n        result = m.latent0;\n"
             "    if (field == 4)\n        result = vec4(hnbrdf_eval(m, vec3(0.6, 0.0, 0.8), "
             "vec3(-0.48, 0.36, 0.8)), 0.0);\n}\n",
             b->texels);
    return text;
}

/* Two materials side by side. */
static void make_textures(bench *b)
{
    const gl_functions *f = &context.f;
    const int half = b->packing.format == HNBRDF_TEXEL_RGBA16F;
    const size_t size = hnbrdf_texel_bytes(b->packing.format);
    unsigned char packed[2][HNBRDF_MAX_TEXELS * 8], pixels[16];
    for (int m = 0; m < 2; m++)
        hnbrdf_material_pack(&b->packing, hnbrdf_model_material(b->model, m), packed[m]);
    f->GenTextures(b->texels, b->textures);
    for (int t = 0; t < b->texels; t++) {
        memcpy(pixels, packed[0] + (size_t)t * size, size);
        memcpy(pixels + size, packed[1] + (size_t)t * size, size);
        f->ActiveTexture(GL_TEXTURE0 + 1 + (GLenum)t);
        f->BindTexture(GL_TEXTURE_2D, b->textures[t]);
        f->TexImage2D(GL_TEXTURE_2D, 0, half ? GL_RGBA16F : GL_RGBA8, 2, 1, 0, GL_RGBA,
                      half ? GL_HALF_FLOAT : GL_UNSIGNED_BYTE, pixels);
        f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
}

static void run(bench *b)
{
    hnbrdf_error error = {""};
    gl_sheet sheet;
    GLuint program = 0;
    const hnbrdf_glsl_options options = {.standalone = 1, .packing = &b->packing};
    char *scene = styled_text(b->model, &options), *body = make_shader(b);
    const char *const texts[] = {"#define HNBRDF_EXACT 1\n", scene, body};
    if (gl_sheet_open(&context, 1, PLACES, &sheet, &error) ||
        gl_program_open(&context, texts, 3, &program, &error))
        fail_msg("%s", error.text);
    make_textures(b);
    context.f.UseProgram(program);
    for (int t = 0; t < b->texels; t++) {
        char name[16];
        snprintf(name, sizeof name, "map%d", t);
        context.f.Uniform1i(context.f.GetUniformLocation(program, name), 1 + t);
    }
    assert_int_equal(gl_sheet_upload(&context, &sheet, b->places[0], PLACES, &error), 0);
    for (int slot = 0; slot < b->texels + MATERIAL_SLOTS; slot++)
        if (gl_draw(&context, &sheet, program, slot, PLACES, &error) ||
            gl_sheet_download(&context, &sheet, PLACES, b->results[0][slot], 4 * SLOTS, &error))
            fail_msg("%s", error.text);
    context.f.DeleteTextures(b->texels, b->textures);
    context.f.DeleteProgram(program);
    gl_sheet_close(&context, &sheet);
    free(scene);
    free(body);
}

/* ---- What it must give ----------------------------------------------------------------------- */

static double channel_of(const bench *b, int material, int channel)
{
    unsigned char packed[HNBRDF_MAX_TEXELS * 8];
    uint16_t half;
    hnbrdf_material_pack(&b->packing, hnbrdf_model_material(b->model, material), packed);
    if (b->packing.format == HNBRDF_TEXEL_RGBA8)
        return packed[channel] / 255.0;
    memcpy(&half, packed + 2 * channel, sizeof half);
    return (double)hnbrdf_float_of_half(half);
}

/* A filtered channel lies between its two; where, GL leaves to the driver: weights of 4 bits at
 * least (as Vulkan's subTexelPrecisionBits), results of the precision of the format, 8 bits or
 * 11. */
static void check_filtered(const bench *b, int place, int channel)
{
    const double unit = b->packing.format == HNBRDF_TEXEL_RGBA8 ? 1.0 / 255.0 : 0x1p-10;
    double first = channel_of(b, 0, channel), second = channel_of(b, 1, channel);
    double weight = fmin(fmax(2.0 * (double)b->places[place][0] - 0.5, 0.0), 1.0);
    double expected = first + weight * (second - first);
    double size = b->packing.format == HNBRDF_TEXEL_RGBA8 ? 1.0 : fmax(fabs(first), fabs(second));
    double bound = fabs(second - first) / 16.0 + unit * size;
    double found = (double)b->results[place][channel / 4][channel % 4];
    if (!(fabs(found - expected) <= bound))
        fail_msg("place %d, channel %d: %.9g, expected %.9g within %g", place, channel, found,
                 expected, bound);
}

/* offset + scale code in another order or as one operation, code and offset as given. */
static double error_of_place(const hnbrdf_field *field, float code)
{
    return 3 * 0x1p-24 * (fabs((double)field->offset) + fabs((double)field->scale * (double)code));
}

/* How far a field may be off. */
static double error_of(const hnbrdf_field *field, float code, float value)
{
    const check_arithmetic arithmetic = {0};
    const check_rules rules = check_rules_unordered(&arithmetic);
    double e = error_of_place(field, code), v = fabs((double)value);
    if (is_exact())
        return 0.0;
    if (field->curve == HNBRDF_CURVE_SQUARE) /* of a root: (s + e)^2, rounded */
        return 2.0 * sqrt(v) * e + e * e + 0x1p-24 * v;
    if (field->curve == HNBRDF_CURVE_EXP)
        return v * expm1(e) + 2.0 * check_exp_error(&rules, log(v) - e, v * exp(e));
    return e;
}

static void check_number(const char *what, int place, float found, float expected, double bound)
{
    if (!(fabs((double)found - (double)expected) <= bound))
        fail_msg("%s %s, place %d: %.9g, C %.9g, bound %g", gl_dialect_name(context.dialect), what,
                 place, (double)found, (double)expected, bound);
}

/* eta = (1 + r)/(1 - r), its derivative 2/(1 - r)^2; two sums and a quotient are rounded. */
static double error_of_eta(const hnbrdf_field *field, float code, float eta)
{
    double r = ((double)eta - 1.0) / ((double)eta + 1.0);
    double e = error_of(field, code, (float)r);
    return is_exact() ? 0.0 : 2.0 * e / ((1.0 - r - e) * (1.0 - r)) + 7 * 0x1p-24 * (double)eta;
}

static void check_material(const bench *b, int place)
{
    const float(*slots)[4] = b->results[place], *channels = slots[0];
    const float(*fields)[4] = slots + b->texels;
    const float wi[3] = {0.6f, 0.0f, 0.8f}, wo[3] = {-0.48f, 0.36f, 0.8f};
    hnbrdf_texel_layout layout;
    hnbrdf_material m;
    float f[3];
    hnbrdf_texel_layout_make(&b->packing, &layout);
    hnbrdf_material_unpack_channels(&b->packing, channels, &m);
    for (int c = 0; c < 3; c++) {
        check_number("kd", place, fields[0][c], m.kd[c],
                     error_of(&layout.kd, channels[layout.kd.first + c], m.kd[c]));
        check_number("eta", place, fields[1][c], m.eta[c],
                     error_of_eta(&layout.r, channels[layout.r.first + c], m.eta[c]));
    }
    for (int c = 0; c < 2; c++)
        check_number("alpha", place, fields[2][c], m.alpha[c],
                     error_of(&layout.alpha, channels[layout.alpha.first + c], m.alpha[c]));
    for (int i = 0; i < b->packing.latent; i++)
        check_number("latent", place, fields[3][i], m.latent[i],
                     error_of(&layout.latent[i], channels[layout.latent[i].first], m.latent[i]));
    /* the same material then has the same f, see test_gl_verify */
    hnbrdf_eval(b->model, &m, wi, wo, f);
    for (int c = 0; c < 3; c++)
        check_number("f", place, fields[4][c], f[c], is_exact() ? 0.0 : (double)INFINITY);
}

static void filters_as_in_c(hnbrdf_texel_format format)
{
    bench *b = calloc(1, sizeof *b);
    assert_non_null(b);
    b->model = scene_model(&SHAPE);
    assert_int_equal(hnbrdf_packing_init(b->model, NULL, 0, format, &b->packing, NULL), HNBRDF_OK);
    b->texels = hnbrdf_packing_texels(&b->packing);
    for (int k = 0; k < PLACES; k++) /* from the middle of one to that of the other and beyond */
        b->places[k][0] = (float)k / (PLACES - 1);
    run(b);
    int between = 0;
    for (int k = 0; k < PLACES; k++) {
        for (int c = 0; c < 4 * b->texels; c++)
            check_filtered(b, k, c);
        check_material(b, k);
        const float kd = b->results[k][b->texels][0];
        between += kd != b->results[0][b->texels][0] && kd != b->results[PLACES - 1][b->texels][0];
    }
    assert_true(between > PLACES / 4); /* and did filter */
    hnbrdf_model_free(b->model);
    free(b);
}

static void half_floats_filter_as_in_c(void **state)
{
    (void)state;
    filters_as_in_c(HNBRDF_TEXEL_RGBA16F);
}

static void bytes_filter_as_in_c(void **state)
{
    (void)state;
    filters_as_in_c(HNBRDF_TEXEL_RGBA8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_floats_filter_as_in_c),
        cmocka_unit_test(bytes_filter_as_in_c),
    };
    gl_instance instance;
    int failed = 0, tried = 0;
    gl_open(&instance);
    for (int display = 0; display < instance.count; display++)
        for (int dialect = 0; dialect < GL_DIALECTS; dialect++) {
            if (gl_context_open(&instance, display, (gl_dialect)dialect, &context, NULL))
                continue;
            tried++;
            failed +=
                cmocka_run_group_tests_name(gl_dialect_name(context.dialect), tests, NULL, NULL);
            gl_context_close(&context);
        }
    gl_close(&instance);
    if (!tried)
        printf("skipped: no GL context\n");
    return tried ? failed : 77;
}
