/* test_math_bits.c: the bits that core/math.h, core/encoding.h and core/compose.h give are fixed:
 * models are trained, and shaders exported, against them. Checksums over sweeps, where functions
 * change branch above all; test_math.c holds the same functions to their errors. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/compose.h"
#include "core/encoding.h"
#include "core/half.h"

#include <math.h>

static uint64_t sum;

static void begin(void)
{
    sum = 0xcbf29ce484222325u;
}

/* FNV-1a over the bits, low byte first on every machine. */
static void add(float value)
{
    uint32_t bits = (uint32_t)hnbrdf_float_to_bits(value);
    for (int b = 0; b < 32; b += 8)
        sum = (sum ^ ((bits >> b) & 0xff)) * 0x100000001b3u;
}

static void expect(uint64_t expected)
{
    if (sum != expected)
        fail_msg("checksum %08lx%08lx", (unsigned long)(sum >> 32),
                 (unsigned long)(sum & 0xffffffffu));
}

/* A few floats on either side of x. */
static void around(float x, void (*visit)(float))
{
    for (int i = -4; i <= 4; i++)
        visit(hnbrdf_bits_to_float(hnbrdf_float_to_bits(x) + i));
}

static void visit_exp(float x)
{
    if (x >= -80.0f && x <= 80.0f)
        add(hnbrdf_exp(x));
}

static void exp_has_its_bits(void **state)
{
    (void)state;
    begin();
    for (int k = -40000; k <= 40000; k++)
        visit_exp((float)k * 0.002f);
    for (int k = -115; k <= 115; k++) /* where the nearest integer changes */
        around(((float)k + 0.5f) * 0.693147181f, visit_exp);
    around(80.0f, visit_exp);
    around(-80.0f, visit_exp);
    expect(0xbe6f42a805ac234au);
}

static void visit_log(float x)
{
    add(hnbrdf_log(x));
}

static void log_has_its_bits(void **state)
{
    (void)state;
    begin();
    for (int32_t bits = 0x00800000; bits < 0x7f800000; bits += 39989)
        visit_log(hnbrdf_bits_to_float(bits));
    for (int e = -120; e <= 120; e++) { /* where the exponent changes, and powers of two */
        around(ldexpf(1.41421356f, e), visit_log);
        around(ldexpf(1.0f, e), visit_log);
    }
    const float odd[] = {0.0f, -0.0f, -1.0f, 1e-45f, 1.17549435e-38f, 3.402e38f, INFINITY, NAN};
    for (size_t k = 0; k < sizeof odd / sizeof odd[0]; k++)
        visit_log(odd[k]);
    expect(0x96b83d3cd41b9a69u);
}

static void visit_turn(float u)
{
    float sine, cosine;
    if (!(u >= 0.0f && u <= 1.0f))
        return;
    hnbrdf_sincos_turn(u, &sine, &cosine);
    add(sine);
    add(cosine);
}

static void sine_and_cosine_have_their_bits(void **state)
{
    (void)state;
    begin();
    for (int k = 0; k <= 1 << 16; k++)
        visit_turn((float)k * 0x1p-16f);
    for (int k = 0; k <= 8; k++) /* eighths of a turn: where the quadrant changes, and where not */
        around(0.125f * (float)k + 0x1p-60f, visit_turn);
    expect(0x96710d2e438d2893u);
}

/* Zeros have signs: at an end it is the end that is given. */
static void clamps_have_their_bits(void **state)
{
    (void)state;
    const float values[] = {-INFINITY, -2.0f, -1e-45f, -0.0f,    0.0f, 1e-45f,
                            0.5f,      1.0f,  2.0f,    INFINITY, NAN};
    begin();
    for (size_t a = 0; a < sizeof values / sizeof values[0]; a++) {
        add(hnbrdf_clamp(values[a], 0.0f, 1.0f));
        add(hnbrdf_clamp(values[a], -0.0f, 1.0f));
        add(hnbrdf_clamp(values[a], -1.0f, 0.0f));
        add(hnbrdf_clamp(values[a], -1.0f, -0.0f));
        add(hnbrdf_finish(values[a]));
        for (size_t b = 0; b < sizeof values / sizeof values[0]; b++) {
            add(hnbrdf_compose_hybrid(values[a], values[b], 0.75f, 1.5f, -0.25f, 0.003f));
            add(hnbrdf_compose_neural(values[a], 0.75f, values[b], 0.003f));
        }
    }
    expect(0x5fff650e5925c4fcu);
}

static void encodings_have_their_bits(void **state)
{
    (void)state;
    begin();
    for (int k = 0; k < 4000; k++) {
        float i[3], o[3], x[6];
        int32_t n = k * 40503 % 4096, m = k * 9301 % 4096;
        i[2] = (float)(n + 1) * 0x1p-12f;
        o[2] = (float)(m + 1) * 0x1p-12f;
        float ri = sqrtf(1.0f - i[2] * i[2]), ro = sqrtf(1.0f - o[2] * o[2]);
        hnbrdf_sincos_turn((float)(k % 61) / 61.0f, &i[1], &i[0]);
        hnbrdf_sincos_turn((float)(k % 53) / 53.0f, &o[1], &o[0]);
        for (int c = 0; c < 2; c++) {
            i[c] *= ri;
            o[c] *= ro;
            if (k % 16 == 0)
                o[c] = i[c]; /* looking along the light */
        }
        if (k % 16 == 0)
            o[2] = i[2];
        hnbrdf_pair pair = hnbrdf_pair_make(i, o);
        for (int e = 0; e < 5; e++) {
            hnbrdf_encode((hnbrdf_encoding)e, &pair, x);
            for (int c = 0; c < 6; c++)
                add(x[c]);
        }
        float specular = hnbrdf_specular(&pair, 0.3f, 0.2f);
        add(specular);
        add(hnbrdf_microfacet(0.4f, 1.5f, pair.c, specular));
    }
    expect(0x1df517b4eac1a53eu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exp_has_its_bits),
        cmocka_unit_test(log_has_its_bits),
        cmocka_unit_test(sine_and_cosine_have_their_bits),
        cmocka_unit_test(clamps_have_their_bits),
        cmocka_unit_test(encodings_have_their_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
