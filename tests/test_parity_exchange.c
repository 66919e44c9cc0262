/* test_parity_exchange.c: the folder of `hnbrdf verify --hand-out` and `--hand-in`. The C library
 * itself takes the part of the program that runs the shader: every bit is right then, and whatever
 * is changed must be found. */
#include "gpu_support.h"

#include "check/exchange.h"
#include "check/probe.h"
#include "core/network.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PAIRS = 128, ROWS = PAIRS * SCENE_MATERIALS };

typedef struct bench {
    char folder[256];
    hnbrdf_model *model;
    float inputs[ROWS][CHECK_PARITY_INPUTS], outputs[ROWS][CHECK_PARITY_OUTPUTS];
} bench;

static const scene_shape SHAPE = {.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
                                  .hidden = 8,
                                  .layers = 2,
                                  .latent = 4,
                                  .anisotropic = 1,
                                  .rotated = 1};

/* ---- Files ----------------------------------------------------------------------------------- */

static FILE *open_in(const bench *b, const char *name, const char *mode)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", b->folder, name);
    return fopen(path, mode);
}

static void read_floats(const bench *b, const char *name, float *to, size_t count)
{
    FILE *file = open_in(b, name, "rb");
    assert_non_null(file);
    assert_int_equal(fread(to, sizeof *to, count, file), count);
    assert_int_equal(fgetc(file), EOF);
    fclose(file);
}

static void write_floats(const bench *b, const char *name, const float *from, size_t count)
{
    FILE *file = open_in(b, name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(from, sizeof *from, count, file), count);
    assert_int_equal(fclose(file), 0);
}

static void remove_in(const bench *b, const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", b->folder, name);
    assert_int_equal(unlink(path), 0);
}

/* ---- The program ----------------------------------------------------------------------------- */

static void compute_row(const hnbrdf_model *model, const float *row, float *out)
{
    const hnbrdf_material *m = hnbrdf_model_material(model, (int)row[0]);
    const float *wi = row + 1, *wo = row + 4;
    hnbrdf_model_desc desc;
    hnbrdf_sample_result drawn;
    float network[HNBRDF_MAX_OUTPUTS];
    hnbrdf_model_describe(model, &desc);
    hnbrdf_network(&desc, m->latent, row + 10, network);
    memset(out, 0, CHECK_PARITY_OUTPUTS * sizeof *out);
    memcpy(out, row + 10, 3 * sizeof *out);
    memcpy(out + 4, row + 13, 3 * sizeof *out);
    memcpy(out + 8, network, 3 * sizeof *out);
    memcpy(out + 12, network + 3, 3 * sizeof *out);
    hnbrdf_eval_analytic(model, m, wi, wo, out + 16);
    out[19] = hnbrdf_pdf(model, m, wi, wo);
    hnbrdf_eval(model, m, wi, wo, out + 20);
    hnbrdf_sample(model, m, wo, row + 7, &drawn);
    memcpy(out + 24, drawn.wi, 3 * sizeof *out);
    out[27] = drawn.pdf;
    memcpy(out + 28, drawn.weight, 3 * sizeof *out);
    out[31] = 1.0f;
}

static void probe(const bench *b)
{
    float(*in)[CHECK_PROBE_OPERANDS] = calloc(CHECK_PROBE_COUNT, sizeof *in);
    float(*out)[CHECK_PROBE_RESULTS] = calloc(CHECK_PROBE_COUNT, sizeof *out);
    assert_true(in && out);
    read_floats(b, "probe.f32", in[0], CHECK_PROBE_COUNT * CHECK_PROBE_OPERANDS);
    for (int k = 0; k < CHECK_PROBE_COUNT; k++) {
        const float x = in[k][0], y = in[k][1];
        const float results[CHECK_PROBE_RESULTS] = {
            x + y, x - y,           x * y,          x * y + in[k][2],
            x / y, sqrtf(fabsf(x)), expf(in[k][2]), logf(in[k][3])};
        memcpy(out[k], results, sizeof results);
    }
    write_floats(b, "probe_results.f32", out[0], CHECK_PROBE_COUNT * CHECK_PROBE_RESULTS);
    free(in);
    free(out);
}

/* ---- Before and after ------------------------------------------------------------------------ */

static bench *begin(void)
{
    static const int all[SCENE_MATERIALS] = {0, 1, 2};
    const char *base = getenv("TMPDIR");
    bench *b = calloc(1, sizeof *b);
    hnbrdf_error error = {""};
    assert_non_null(b);
    snprintf(b->folder, sizeof b->folder, "%s/hnbrdf-XXXXXX", base && *base ? base : "/tmp");
    assert_non_null(mkdtemp(b->folder));
    b->model = scene_model(&SHAPE);
    const check_exchange exchange = {
        .folder = b->folder,
        .check = {.materials = all, .material_count = SCENE_MATERIALS, .pairs = PAIRS, .seed = 7}};
    if (check_hand_out(b->model, &exchange, &error))
        fail_msg("%s", error.text);
    read_floats(b, "inputs.f32", b->inputs[0], ROWS * CHECK_PARITY_INPUTS);
    for (int k = 0; k < ROWS; k++)
        compute_row(b->model, b->inputs[k], b->outputs[k]);
    probe(b);
    write_floats(b, "outputs.f32", b->outputs[0], ROWS * CHECK_PARITY_OUTPUTS);
    write_floats(b, "outputs_exact.f32", b->outputs[0], ROWS * CHECK_PARITY_OUTPUTS);
    return b;
}

static void end(bench *b)
{
    DIR *directory = opendir(b->folder);
    struct dirent *entry;
    assert_non_null(directory);
    while ((entry = readdir(directory)))
        if (entry->d_name[0] != '.')
            remove_in(b, entry->d_name);
    closedir(directory);
    rmdir(b->folder);
    hnbrdf_model_free(b->model);
    free(b);
}

static check_handed_in judge(const bench *b)
{
    check_handed_in found;
    hnbrdf_error error = {""};
    if (check_hand_in(b->model, b->folder, NULL, NULL, &found, &error))
        fail_msg("%s", error.text);
    return found;
}

static check_comparison sum_of(const check_handed_in *found, check_build build, int stage)
{
    check_comparison sum = {0};
    for (int k = 0; k < found->report.material_count; k++)
        check_comparison_add(&sum, &found->report.comparisons[k][build][stage]);
    return sum;
}

/* ---- Tests ----------------------------------------------------------------------------------- */

static void every_bit_of_c_is_within(void **state)
{
    (void)state;
    bench *b = begin();
    FILE *file = open_in(b, "device.txt", "w");
    fputs("a careful program\nand more\n", file);
    fclose(file);
    check_handed_in found = judge(b);
    assert_true(found.report.within && found.report.ordered);
    assert_string_equal(found.device, "a careful program");
    for (int build = 0; build < CHECK_BUILDS; build++)
        for (int stage = 0; stage < CHECK_STAGES; stage++) {
            check_comparison all = sum_of(&found, (check_build)build, stage);
            assert_true(all.values > 0 && all.identical == all.values);
        }
    check_handed_in_free(&found);
    end(b);
}

/* One number of every slot, moved by 1 % or, in the exact build, by one ulp. */
static void a_changed_number_is_found(void **state)
{
    (void)state;
    static const int places[][2] = {{1, CHECK_STAGE_ENCODING},  {6, CHECK_STAGE_ENCODING},
                                    {8, CHECK_STAGE_NETWORK},   {14, CHECK_STAGE_NETWORK},
                                    {17, CHECK_STAGE_ANALYTIC}, {19, CHECK_STAGE_DENSITY},
                                    {22, CHECK_STAGE_VALUE},    {24, CHECK_STAGE_DIRECTION},
                                    {27, CHECK_STAGE_DENSITY},  {30, CHECK_STAGE_WEIGHT}};
    static const char *const names[CHECK_BUILDS] = {"outputs_exact.f32", "outputs.f32"};
    bench *b = begin();
    for (int build = 0; build < CHECK_BUILDS; build++)
        for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
            const int row = PAIRS + 4; /* a uniform pair of the second material */
            float *number = &b->outputs[row][places[i][0]], before = *number;
            assert_true(before != 0.0f);
            *number = build == CHECK_BUILD_EXACT ? nextafterf(before, INFINITY) : before * 1.01f;
            write_floats(b, names[build], b->outputs[0], ROWS * CHECK_PARITY_OUTPUTS);
            check_handed_in found = judge(b);
            assert_false(found.report.within);
            assert_true(sum_of(&found, (check_build)build, places[i][1]).outside > 0);
            assert_int_equal(sum_of(&found, (check_build)!build, places[i][1]).outside, 0);
            check_handed_in_free(&found);
            *number = before;
            write_floats(b, names[build], b->outputs[0], ROWS * CHECK_PARITY_OUTPUTS);
        }
    end(b);
}

static void the_exact_build_may_be_left_out(void **state)
{
    (void)state;
    bench *b = begin();
    remove_in(b, "outputs_exact.f32");
    check_handed_in found = judge(b);
    assert_true(found.report.within && !found.report.ordered);
    assert_false(sum_of(&found, CHECK_BUILD_EXACT, CHECK_STAGE_VALUE).applies);
    assert_true(sum_of(&found, CHECK_BUILD_FAST, CHECK_STAGE_VALUE).applies);
    check_handed_in_free(&found);
    end(b);
}

/* Refused, with these words, and nothing to free. */
static void is_refused(const bench *b, const hnbrdf_model *model, const char *words)
{
    check_handed_in found;
    hnbrdf_error error = {""};
    assert_int_not_equal(check_hand_in(model, b->folder, NULL, NULL, &found, &error), HNBRDF_OK);
    if (!strstr(error.text, words) || strchr(error.text, '\n'))
        fail_msg("found '%s', expected one line with '%s'", error.text, words);
    assert_null(found.materials);
}

static void what_is_missing_or_short_is_named(void **state)
{
    (void)state;
    bench *b = begin();
    write_floats(b, "outputs_exact.f32", b->outputs[0], ROWS * CHECK_PARITY_OUTPUTS - 1);
    is_refused(b, b->model, "outputs_exact.f32: 49148 bytes, expected 49152");
    remove_in(b, "outputs_exact.f32");
    remove_in(b, "probe_results.f32");
    is_refused(b, b->model, "probe_results.f32");
    remove_in(b, "outputs.f32");
    is_refused(b, b->model, "outputs.f32");
    FILE *file = open_in(b, "case.json", "w");
    fputs("{\"format\": \"hnbrdf-parity/1\", \"weights\": \"stone\"}", file);
    fclose(file);
    is_refused(b, b->model, "case.json: at byte 40: expected constants, columns or uniform");
    file = open_in(b, "case.json", "w");
    fputs("{}", file);
    fclose(file);
    is_refused(b, b->model, "case.json: not written by");
    remove_in(b, "case.json");
    is_refused(b, b->model, "case.json");
    end(b);
}

static void another_model_is_refused(void **state)
{
    (void)state;
    bench *b = begin();
    hnbrdf_model *other = NULL;
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(b->model, &desc);
    desc.floor = 0.25f;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &other, NULL), HNBRDF_OK);
    is_refused(b, other, "scene_exact.glsl: not what this model exports now");
    b->inputs[5][1] += 0.125f;
    write_floats(b, "inputs.f32", b->inputs[0], ROWS * CHECK_PARITY_INPUTS);
    is_refused(b, b->model, "inputs.f32: not what this model gives now");
    hnbrdf_model_free(other);
    end(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_bit_of_c_is_within),
        cmocka_unit_test(a_changed_number_is_found),
        cmocka_unit_test(the_exact_build_may_be_left_out),
        cmocka_unit_test(what_is_missing_or_short_is_named),
        cmocka_unit_test(another_model_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
