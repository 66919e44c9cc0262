/* test_language.c: the translator of our GLSL, construct by construct. */
#include "base/error.h"
#include "base/memory.h"
#include "base/text_buffer.h"
#include "language/language.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const hnbrdf_allocator memory = {hnbrdf_malloc, hnbrdf_free, NULL};

/* What `text` is in this language, malloc'ed; NULL and *error if it was refused. */
static char *translated_after(const char *before, const char *text, const hnbrdf_dialect *dialect,
                              int exact, hnbrdf_error *error)
{
    const hnbrdf_source sources[] = {{"before", before, strlen(before), 0, NULL},
                                     {"text", text, strlen(text), 1, NULL}};
    hnbrdf_text_buffer buffer = {0};
    error->text[0] = '\0';
    const hnbrdf_result result = hnbrdf_translate(sources, 2, dialect, exact, &memory,
                                                  hnbrdf_text_buffer_append, &buffer, error);
    if (result && buffer.size > 0)
        fail_msg("a text was refused after half of it was written: %s", error->text);
    if (result) {
        assert_int_equal(result, HNBRDF_ERROR_FORMAT);
        return NULL;
    }
    hnbrdf_text_buffer_append(&buffer, "", 0);
    return hnbrdf_text_buffer_take(&buffer);
}

static void expect(const hnbrdf_dialect *dialect, int exact, const char *text, const char *expected)
{
    hnbrdf_error error;
    char *found = translated_after("", text, dialect, exact, &error);
    if (!found || strcmp(found, expected) != 0)
        fail_msg("%s:\n%s\nbecomes\n%s\nexpected\n%s", hnbrdf_dialect_name(dialect), text,
                 found ? found : error.text, expected);
    free(found);
}

static void expect_refused(const char *text, const char *message)
{
    hnbrdf_error error;
    char *found = translated_after("", text, &hnbrdf_hlsl, 0, &error);
    if (found || !strstr(error.text, message))
        fail_msg("\n%s\nbecomes\n%s\nexpected the message\n%s", text, found ? found : error.text,
                 message);
    free(found);
}

/* ---- Directives ------------------------------------------------------------------------------ */

static void conditions_choose_branches(void **state)
{
    (void)state;
    static const struct {
        const char *condition;
        int holds;
    } cases[] = {{"1", 1},
                 {"0", 0},
                 {"defined(VULKAN)", 1},
                 {"defined GL_ES", 0},
                 {"!defined(GL_ES) && __VERSION__ >= 400", 1},
                 {"defined(GL_ES) && UNKNOWN >= 320", 0},
                 {"HNBRDF_EXACT == 1", 0},
                 {"HNBRDF_EXACT || 3 > 2", 1},
                 {"(1 + 1 == 2) && !(2 < 1)", 1},
                 {"1 - 1 || 1 != 1", 0},
                 {"2 <= 2 && 2 >= 3", 0},
                 {"0x10 == 16", 1}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        char text[256];
        snprintf(text, sizeof text, "#if %s\n#define A 1\n#else\n#define A 2\n#endif\n",
                 cases[k].condition);
        expect(&hnbrdf_hlsl, 0, text, cases[k].holds ? "#define A 1\n" : "#define A 2\n");
    }
    expect(&hnbrdf_hlsl, 1, "#if HNBRDF_EXACT == 1\n#define A 1.5\n#endif\n", "#define A 1.5f\n");
    expect(&hnbrdf_hlsl, 0,
           "#if 0\n#define A 1\n#elif 1\n#define A 2\n#elif 1\n#define A 3\n#else\n#define A "
           "4\n#endif\n",
           "#define A 2\n");
    expect(&hnbrdf_hlsl, 0, "#ifdef A\n#if 1\n#define B 1\n#endif\n#else\n#define B 2\n#endif\n",
           "#define B 2\n");
}

static void macros_are_replaced_and_constants_stay(void **state)
{
    (void)state;
    expect(&hnbrdf_hlsl, 0,
           "#define F(x) exp(min(x, LARGE))\n#define LARGE 3.0e38\n#define TYPE float\n"
           "TYPE f(TYPE x)\n{\n    return F((x + 1.0)) * LARGE;\n}\n",
           "#define LARGE 3.0e38f\n"
           "float f(float x)\n{\n    return exp(min((x + 1.0f), LARGE)) * LARGE;\n}\n");
    expect(&hnbrdf_hlsl, 0,
           "#ifndef P\n#define P\n#endif\nP float f()\n{\n    P float a = 1.0;\n    return a;\n}\n",
           "float f()\n{\n    float a = 1.0f;\n    return a;\n}\n");
    expect(&hnbrdf_hlsl, 0, "#define A 2 // two\n#define B (A * 3)\n#define SCENE_KIND\n",
           "#define A 2 // two\n#define B (A * 3)\n#define SCENE_KIND\n");
}

/* What can be defined before an include is settled here; its comment goes with it. */
static void settings_leave_nothing(void **state)
{
    (void)state;
    expect(&hnbrdf_hlsl, 0,
           "// About G.\n#ifndef X_GLSL\n#define X_GLSL\n\n// About S.\n#ifndef S\n#define S "
           "1\n#endif\n\n// About f.\nint f()\n{\n    return S;\n}\n\n#endif\n",
           "// About G.\n#ifndef X_HLSL\n#define X_HLSL\n\n// About f.\nint f()\n{\n    return "
           "1;\n}\n\n#endif\n");
    hnbrdf_error error;
    char *found = translated_after(
        "#define X_GLSL\n", "// Scene.\n#ifndef X_GLSL\n#error include x.glsl first\n#endif\n",
        &hnbrdf_hlsl, 0, &error);
    if (!found)
        fail_msg("%s", error.text);
    assert_string_equal(found, "// Scene.\n#ifndef X_HLSL\n#error include x.hlsl first\n#endif\n");
    free(found);
}

/* ---- Statements ------------------------------------------------------------------------------ */

static void hlsl_has_its_own_words(void **state)
{
    (void)state;
    expect(&hnbrdf_hlsl, 0,
           "struct pair {\n    vec3 a, b; // two\n    float half; // of them\n};\n\n"
           "pair make(vec3 a, out float line)\n{\n    line = fract(a.x);\n"
           "    if (a == vec3(line))\n        return pair(a, vec3(0.0), 1.0);\n"
           "    return pair(mix(a, a, 0.5), clamp(a, 0.0, 1.0), inversesqrt(line));\n}\n",
           "struct pair {\n    float3 a, b; // two\n    float half_; // of them\n};\n\n"
           "pair pair_init(float3 a, float3 b, float half_)\n{\n    pair made;\n    made.a = a;\n"
           "    made.b = b;\n    made.half_ = half_;\n    return made;\n}\n\n"
           "pair make(float3 a, out float line_)\n{\n    line_ = frac(a.x);\n"
           "    if (all(a == (float3)line_))\n"
           "        return pair_init(a, (float3)0.0f, 1.0f);\n"
           "    return pair_init(lerp(a, a, (float3)0.5f), clamp(a, (float3)0.0f, (float3)1.0f), "
           "rsqrt(line_));\n}\n");
    expect(&hnbrdf_hlsl, 1,
           "float f(float x)\n{\n    precise float y = x;\n    int k = floatBitsToInt(y) >> 23;\n"
           "    for (int i = 0; i < 3; i++)\n        k += i;\n"
           "    [[dont_unroll]] for (int i = 0; i < 3; i++) {\n        k = k + i;\n    }\n"
           "    return intBitsToFloat(k);\n}\n",
           "float f(float x)\n{\n    precise float y = x;\n    int k = asint(y) >> 23;\n"
           "    for (int i = 0; i < 3; i++)\n        k += i;\n"
           "    [loop] for (int i2 = 0; i2 < 3; i2++) {\n        k = k + i2;\n    }\n"
           "    return asfloat(k);\n}\n");
    expect(&hnbrdf_hlsl, 0,
           "layout(std140, set = 0, binding = 1) uniform a_weights_block { vec4 a_weights[3]; };\n"
           "float f(int i)\n{\n    return a_weights[i].x;\n}\n",
           "#ifndef A_WEIGHTS_REGISTER\n#define A_WEIGHTS_REGISTER b0\n#endif\n"
           "cbuffer a_weights_block : register(A_WEIGHTS_REGISTER)\n{\n    float4 a_weights[3];\n"
           "};\nfloat f(int i)\n{\n    return a_weights[i].x;\n}\n");
}

static void wgsl_has_its_own_words(void **state)
{
    (void)state;
    expect(&hnbrdf_wgsl, 0,
           "#define SCENE\n#define PI 3.14\n#define LARGEST 3.40282347e38\n"
           "struct s {\n    vec3 a, b; // two\n    bool c;\n};\n\n"
           "float f(float x)\n{\n    return x == PI ? 1.0 : x;\n}\n\n"
           "vec2 f(vec2 x)\n{\n    return vec2(f(x.x), f(x.y));\n}\n\n"
           "float f(vec2 x, s y)\n{\n    return f(x).x;\n}\n",
           "const PI: f32 = 3.14;\nconst LARGEST: f32 = 3.4028234663852886e+38;\n"
           "struct s {\n    a: vec3f, b: vec3f, // two\n    c: bool,\n}\n\n"
           "fn f(x: f32) -> f32 {\n    return select(x, 1.0, x == PI);\n}\n\n"
           "fn f_vec2(x: vec2f) -> vec2f {\n    return vec2f(f(x.x), f(x.y));\n}\n\n"
           "fn f_vec2_s(x: vec2f, y: s) -> f32 {\n    return f_vec2(x).x;\n}\n");
    expect(&hnbrdf_wgsl, 1, /* no `precise` */
           "#if __VERSION__ < 400\nint f(int x, uint n)\n{\n    x += 1 & 2;\n    int y = 3, z;\n"
           "    z = (x >> n) + (y << 2);\n    bool a = true;\n"
           "    if (a && z == 1 || (x & 1) != 0 && !a)\n        return z;\n    else if (a)\n"
           "        y++;\n    return z;\n}\n#endif\n",
           "fn f(x_in: i32, n: u32) -> i32 {\n    var x = x_in;\n    x += 1 & 2;\n"
           "    var y = 3;\n    var z: i32;\n    z = (x >> u32(n)) + (y << 2);\n"
           "    let a = true;\n    if ((a && z == 1) || ((x & 1) != 0 && !a)) {\n"
           "        return z;\n    } else if (a) {\n        y++;\n    }\n    return z;\n}\n");
    expect(&hnbrdf_wgsl, 0,
           "struct s {\n    vec3 a;\n};\nvoid g(out vec3 x, inout float y)\n{\n    x = vec3(y);\n"
           "    x.y = y + x.z;\n}\nvoid f(out vec3 x)\n{\n    s t;\n    float y = 0.0;\n"
           "    g(x, y);\n    g(t.a, y);\n    x = y > 0.0 ? t.a : vec3(y);\n}\n",
           "struct s {\n    a: vec3f,\n}\nfn g(x: ptr<function, vec3f>, y: ptr<function, f32>) {\n"
           "    *x = vec3f((*y));\n    (*x).y = (*y) + (*x).z;\n}\n"
           "fn f(x: ptr<function, vec3f>) {\n    var t: s;\n    var y = 0.0;\n    g(x, &y);\n"
           "    {\n        var a_out: vec3f;\n        g(&a_out, &y);\n        t.a = a_out;\n    }\n"
           "    *x = select(vec3f(y), t.a, y > 0.0);\n}\n");
    expect(&hnbrdf_wgsl, 0,
           "float g(float x)\n{\n    return x;\n}\nfloat f(float x)\n{\n"
           "    float y = x > 0.0 ? g(x) : 0.0;\n    y = x > 1.0 ? y : g(y);\n"
           "    for (int i = 0; i < 3; i++)\n        y = y * float(i);\n"
           "    return x > 2.0 ? g(x) : g(y);\n}\n",
           "fn g(x: f32) -> f32 {\n    return x;\n}\nfn f(x: f32) -> f32 {\n    var y: f32;\n"
           "    if (x > 0.0) {\n        y = g(x);\n    } else {\n        y = 0.0;\n    }\n"
           "    if (x > 1.0) {\n        y = y;\n    } else {\n        y = g(y);\n    }\n"
           "    for (var i: i32 = 0; i < 3; i++) {\n        y = y * f32(i);\n    }\n"
           "    if (x > 2.0) {\n        return g(x);\n    } else {\n        return g(y);\n    }\n"
           "}\n");
    expect(&hnbrdf_wgsl, 0,
           "layout(std140, set = 2, binding = 1) uniform b { vec4 w[3]; };\n"
           "int f(float target)\n{\n    f16vec4 h = f16vec4(vec3(target), target);\n"
           "    return floatBitsToInt(w[1].x);\n}\n",
           "const B_SET: i32 = 2;\nconst B_BINDING: i32 = 1;\n"
           "@group(B_SET) @binding(B_BINDING) var<uniform> w: array<vec4f, 3>;\n"
           "fn f(target_: f32) -> i32 {\n"
           "    let h = vec4h(vec3h(vec3f(target_)), f16(target_));\n"
           "    return bitcast<i32>(w[1].x);\n}\n");
}

static void msl_has_its_own_words(void **state)
{
    (void)state;
    expect(&hnbrdf_msl, 0,
           "struct s {\n    vec3 a;\n    float kernel;\n};\n"
           "s f(float x, out vec3 y, inout int k)\n{\n    y = vec3(x);\n"
           "    k = floatBitsToInt(x) & k;\n    f16vec2 h = f16vec2(float16_t(0.5));\n"
           "    return s(min(y, x), inversesqrt(x));\n}\n",
           "struct s {\n    float3 a;\n    float kernel_;\n};\n"
           "inline s f(float x, thread float3 &y, thread int &k)\n{\n    y = float3(x);\n"
           "    k = as_type<int>(x) & k;\n    half2 h = half2(half(0.5f));\n"
           "    return s{min(y, float3(x)), rsqrt(x)};\n}\n");
    expect(&hnbrdf_msl, 0,
           "layout(std140) uniform b { vec4 w[3]; };\nfloat g()\n{\n    return w[1].x;\n}\n"
           "float h(float x)\n{\n    return x;\n}\n"
           "float f(float x)\n{\n    return h(x) * g();\n}\nfloat e()\n{\n    return "
           "f(1.0);\n}\n",
           "// w: a buffer of 3 float4, the last parameter of each function that reads it.\n"
           "inline float g(constant float4 *w)\n{\n    return w[1].x;\n}\n"
           "inline float h(float x)\n{\n    return x;\n}\n"
           "inline float f(float x, constant float4 *w)\n{\n    return h(x) * g(w);\n}\n"
           "inline float e(constant float4 *w)\n{\n    return f(1.0f, w);\n}\n");
    expect(&hnbrdf_msl, 0, "const float a[2] = float[](1.0, 2.0);\n",
           "constant float a[2] = {1.0f, 2.0f};\n");
}

static void slang_has_half(void **state)
{
    (void)state;
    expect(&hnbrdf_slang, 1,
           "f16vec3 f(float x)\n{\n    precise float y = x;\n    return f16vec3(vec3(y));\n}\n",
           "half3 f(float x)\n{\n    float y = x;\n    return half3((float3)y);\n}\n");
    expect(&hnbrdf_slang, 0, "const float a[2] = float[2](1.0, 2.0);\n",
           "static const float a[2] = {1.0f, 2.0f};\n");
}

static void comments_and_lines_stay(void **state)
{
    (void)state;
    static const char text[] =
        "// First.\n\n// Of f.\n// More of it.\nfloat f(float x)\n{\n    // Within.\n"
        "    float y = x; // behind\n\n    float z = (x\n        + y\n        + 2.0f);\n"
        "    if (x > 0.0f) {\n        return x; /* also this */\n    }\n    else\n"
        "        return -x;\n    // The end.\n}\n";
    char glsl[sizeof text];
    size_t to = 0;
    for (const char *c = text; *c; c++) /* without the suffix of numbers */
        if (*c != 'f' || c[-1] != '0')
            glsl[to++] = *c;
    glsl[to] = '\0';
    char *found = NULL;
    hnbrdf_error error;
    found = translated_after("", glsl, &hnbrdf_hlsl, 0, &error);
    assert_non_null(found);
    assert_non_null(strstr(found, "// First.\n\n// Of f.\n// More of it.\nfloat f(float x)\n{\n"
                                  "    // Within.\n    float y = x; // behind\n\n"
                                  "    float z = (x\n        + y\n        + 2.0f);\n"));
    assert_non_null(strstr(found, "return x; /* also this */\n"));
    assert_non_null(strstr(found, "    // The end.\n}\n"));
    free(found);
}

/* ---- Refusals -------------------------------------------------------------------------------- */

static void what_is_not_known_is_refused(void **state)
{
    (void)state;
    static const char *const within[][2] = {
        {"mat3 m;", "line 2, as hlsl: 'mat3' is not known"},
        {"while (true) x = 1.0;", "'while' is not translated"},
        {"do x = 1.0; while (true);", "'do' is not translated"},
        {"switch (1) { }", "'switch' is not translated"},
        {"discard;", "'discard' is not translated"},
        {"x = 1;", "what is assigned is int, expected float"},
        {"x = v;", "what is assigned is vec3, expected float"},
        {"x = x + 1;", "float + int"},
        {"x = y;", "'y' is not known"},
        {"x = g(x);", "no function g for these arguments"},
        {"x = dFdx(x);", "no function dFdx"},
        {"x = v.q;", "vec3 has no .q"},
        {"x = v.xyw.x;", "vec3 has no .xyw"},
        {"v.xy = vec2(x);", "several components '.xy' assigned to at once"},
        {"x = x ? 1.0 : 2.0;", "a condition is float, expected bool"},
        {"x = true ? 1.0 : 2;", "one of two choices is float, expected int"},
        {"x = (1.0;", "expected ')'"},
        {"x = 1.0f;", "a number with a letter"},
        {"v = vec3(1.0, 2.0);", "vec3(...) with other arguments"},
        {"v = vec3(v, 2.0);", "vec3(...) with other arguments"},
        {"return v;", "vec3 returned from f"},
        {"const float k = 1.0; k = 2.0;", "'k' cannot be assigned to"},
        {"if (x) x = 1.0;", "a condition that is no bool"},
        {"x += v;", "what is assigned is vec3"},
        {"x = 1.0, x = 2.0;", "expected ';'"},
        {"x = sin(1);", "sin(int, ...)"},
        {"x = @;", "found '@', expected an expression"},
        {"float a[2] = b;", "'b' is not known"},
        {"x = x[0];", "an index of what is no array"},
    };
    static const char *const outside[][2] = {
        {"float f(float x) { return x; }\n#include \"a.glsl\"\n", "line 2, as hlsl: #include"},
        {"#if 1\nfloat f;\n", "an #if without #endif"},
        {"#endif\n", "#endif without #if"},
        {"#if UNKNOWN\n#endif\n", "'UNKNOWN', which is no number and not defined"},
        {"#define A 1\n#define A 2\n", "A is defined already"},
        {"#error stop here\n", "#error stop here"},
        {"#define F(a, b) a\nfloat f() { return F(1.0); }\n", "F takes 2 arguments"},
        {"#define F(a) a\nfloat f() { return F(1.0; }\n", "no end of them"},
        {"float f();\n", "found ';', expected '{'"},
        {"uniform sampler2D t;\n", "expected '{'"},
        {"layout(std140) uniform b { float a[3]; };\n", "not one array of vec4"},
        {"float f() { return 1.0; ", "found the end"},
        {"float g = 1.0;\n", "expected '('"},
        {"struct s { mat4 m; };\n", "found 'mat4', expected a type"},
    };
    for (size_t k = 0; k < sizeof within / sizeof within[0]; k++) {
        char text[512];
        snprintf(text, sizeof text, "float f(float x, vec3 v)\n{ %s return x; }\n", within[k][0]);
        expect_refused(text, within[k][1]);
    }
    for (size_t k = 0; k < sizeof outside / sizeof outside[0]; k++)
        expect_refused(outside[k][0], outside[k][1]);
}

static void what_is_too_deep_is_refused(void **state)
{
    (void)state;
    enum { DEEP = 5000 };
    char *text = malloc(4 * DEEP);
    assert_non_null(text);
    for (int kind = 0; kind < 3; kind++) {
        strcpy(text, "float f(float x)\n{ return ");
        size_t at = strlen(text);
        for (int k = 0; k < DEEP; k++)
            text[at++] = "(!{"[kind];
        strcpy(text + at, kind == 2 ? "" : "x");
        if (kind == 2)
            memcpy(strstr(text, "return"), "      ", 6);
        expect_refused(text, "within each other");
    }
    free(text);
}

/* Texts that are translated one by one fit those that are translated together. */
static void a_text_sees_what_was_before(void **state)
{
    (void)state;
    hnbrdf_error error;
    char *found = translated_after("#define A 3\n#define F(x) exp(x)\nstruct s { vec2 a; };\n"
                                   "float g(s x) { return x.a.x; }\n",
                                   "#if A == 3\nfloat f(s x)\n{\n    return g(x) * F(1.0);\n}\n"
                                   "#endif\n",
                                   &hnbrdf_hlsl, 0, &error);
    if (!found)
        fail_msg("%s", error.text);
    assert_string_equal(found, "float f(s x)\n{\n    return g(x) * exp(1.0f);\n}\n");
    free(found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conditions_choose_branches),
        cmocka_unit_test(macros_are_replaced_and_constants_stay),
        cmocka_unit_test(settings_leave_nothing),
        cmocka_unit_test(hlsl_has_its_own_words),
        cmocka_unit_test(wgsl_has_its_own_words),
        cmocka_unit_test(msl_has_its_own_words),
        cmocka_unit_test(slang_has_half),
        cmocka_unit_test(comments_and_lines_stay),
        cmocka_unit_test(what_is_not_known_is_refused),
        cmocka_unit_test(what_is_too_deep_is_refused),
        cmocka_unit_test(a_text_sees_what_was_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
