/* test_golden.c: model files that version 0.1 wrote are read for ever, with the same numbers in
 * them and the same values out of them, to the last bit.
 *
 * The files are tests/data/golden_*.safetensors, one for each kind and encoding, and one of a
 * foreign writer. What they hold and give is in tests/data/golden_values.txt, as version 0.1 gave
 * it. Neither may ever change; a new release may add files. Called with the path of a model file,
 * this program prints the lines to add for it. */
#include "core_support.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define DIRECTORY HNBRDF_TEST_DATA
enum { PAIRS = 6, LINE = 512 };

/* A value in the middle, two mirror directions, a turned pair, one grazing, one below. */
static const float PAIR[PAIRS][2][3] = {
    {{0.48f, 0.36f, 0.8f}, {-0.6f, 0.0f, 0.8f}},
    {{0.28f, 0.0f, 0.96f}, {-0.28f, 0.0f, 0.96f}},
    {{0.36f, 0.48f, 0.8f}, {-0.36f, -0.48f, 0.8f}},
    {{0.0f, 0.6f, 0.8f}, {0.0f, 0.28f, 0.96f}},
    {{0.8f, 0.59999f, 0.0044721f}, {-0.64f, -0.48f, 0.6f}},
    {{0.0f, 0.6f, -0.8f}, {0.0f, 0.0f, 1.0f}},
};

/* ---- What a file holds and gives, as lines --------------------------------------------------- */

/* FNV-1a over the bits of floats, low byte first, whatever the machine. */
static uint64_t add_floats(uint64_t sum, const float *values, int count)
{
    for (int i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        for (int b = 0; b < 4; b++)
            sum = (sum ^ (bits >> 8 * b & 0xff)) * 0x100000001b3u;
    }
    return sum;
}

static uint64_t numbers(const hnbrdf_model_desc *desc)
{
    const float constants[] = {desc->scale, desc->shift, desc->floor};
    uint64_t sum = add_floats(0xcbf29ce484222325u, constants, 3);
    for (int k = 0; k <= desc->layers && desc->kind != HNBRDF_KIND_GGX; k++) {
        const int in = k == 0 ? 6 + desc->latent : desc->hidden;
        const int out = k < desc->layers ? desc->hidden : desc->kind == HNBRDF_KIND_HYBRID ? 6 : 3;
        sum = add_floats(sum, desc->weights[k], in * out);
        sum = add_floats(sum, desc->biases[k], out);
    }
    for (int i = 0; i < desc->material_count; i++) {
        const hnbrdf_material *m = &desc->materials[i];
        sum = add_floats(sum, m->kd, 3);
        sum = add_floats(sum, m->eta, 3);
        sum = add_floats(sum, m->alpha, 2);
        sum = add_floats(sum, &m->rotation, 1);
        sum = add_floats(sum, m->latent, desc->latent);
        sum = add_floats(sum, m->lobes.scale, HNBRDF_LOBES);
        sum = add_floats(sum, m->lobes.share[0], HNBRDF_LOBES * HNBRDF_LOBE_KNOTS);
    }
    return sum;
}

static void file_line(const char *name, const hnbrdf_model_desc *desc, char line[LINE])
{
    const char *encoding =
        desc->kind == HNBRDF_KIND_GGX ? "none" : hnbrdf_encoding_name(desc->encoding);
    int at = snprintf(line, LINE, "file %s %s %s %dx%d l=%d %016" PRIx64, name,
                      hnbrdf_kind_name(desc->kind), encoding, desc->hidden, desc->layers,
                      desc->latent, numbers(desc));
    for (int i = 0; i < desc->material_count; i++)
        at += snprintf(line + at, (size_t)(LINE - at), " [%s]", desc->names[i]);
}

/* f, f_a and the density of one pair, as the bits of seven floats. */
static void value_line(const hnbrdf_model *model, int material, int pair, char line[LINE])
{
    const hnbrdf_material *m = hnbrdf_model_material(model, material);
    float v[7];
    int at = snprintf(line, LINE, "value %d %d", material, pair);
    hnbrdf_eval(model, m, PAIR[pair][0], PAIR[pair][1], v);
    hnbrdf_eval_analytic(model, m, PAIR[pair][0], PAIR[pair][1], v + 3);
    v[6] = hnbrdf_pdf(model, m, PAIR[pair][0], PAIR[pair][1]);
    for (int i = 0; i < 7; i++) {
        uint32_t bits;
        memcpy(&bits, &v[i], sizeof bits);
        at += snprintf(line + at, (size_t)(LINE - at), " %08" PRIx32, bits);
    }
}

static hnbrdf_model *load(const char *path, hnbrdf_variant variant)
{
    const hnbrdf_load_options options = {.variant = variant};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_model_load(path, &options, &model, &error))
        fail_msg("%s", error.text);
    return model;
}

/* ---- Against what was written down ----------------------------------------------------------- */

/* The next line of the expected ones that is no comment, without its end. 0 at the end. */
static int next_line(FILE *file, char line[LINE])
{
    while (fgets(line, LINE, file)) {
        line[strcspn(line, "\n")] = '\0';
        if (line[0] != '#' && line[0] != '\0')
            return 1;
    }
    return 0;
}

/* Every line, with the models made for one variant. Returns the number of files. */
static int check_all(hnbrdf_variant variant)
{
    FILE *expected = fopen(DIRECTORY "/golden_values.txt", "r");
    hnbrdf_model *model = NULL;
    char line[LINE], found[LINE], name[128], path[LINE];
    int files = 0, material, pair, values = 0;
    assert_non_null(expected);
    while (next_line(expected, line)) {
        if (sscanf(line, "file %127s", name) == 1) {
            hnbrdf_model_desc desc;
            hnbrdf_model_free(model);
            snprintf(path, sizeof path, "%s/%s", DIRECTORY, name);
            model = load(path, variant);
            hnbrdf_model_describe(model, &desc);
            file_line(name, &desc, found);
            files++;
        } else if (sscanf(line, "value %d %d", &material, &pair) == 2 && model) {
            assert_in_range(material, 0, hnbrdf_model_material_count(model) - 1);
            assert_in_range(pair, 0, PAIRS - 1);
            value_line(model, material, pair, found);
            values++;
        } else {
            fail_msg("golden_values.txt: a line that is neither file nor value: %s", line);
        }
        if (strcmp(line, found) != 0)
            fail_msg("%s, %s:\nexpected %s\nfound    %s", name, hnbrdf_variant_name(variant), line,
                     found);
    }
    assert_true(values >= 3 * PAIRS * files); /* three materials a file, every pair of each */
    hnbrdf_model_free(model);
    fclose(expected);
    return files;
}

static void files_of_version_0_1_keep_their_numbers_and_values(void **state)
{
    (void)state;
    for (hnbrdf_variant v = HNBRDF_VARIANT_PLAIN; hnbrdf_variant_name(v); v++)
        if (hnbrdf_variant_available(v) && hnbrdf_variant_is_exact(v))
            assert_int_equal(check_all(v), 12);
}

/* A golden file rewritten and read again is the same model: the writer loses nothing either. */
static void golden_files_survive_being_written_again(void **state)
{
    static const char *const NAMES[] = {
        "golden_ggx.safetensors", "golden_hybrid_angles.safetensors",
        "golden_neural_angles.safetensors", "golden_foreign.safetensors"};
    static const char COPY[] = "test_golden_copy.safetensors";
    (void)state;
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) {
        char path[LINE], before[LINE], after[LINE];
        hnbrdf_model_desc desc;
        snprintf(path, sizeof path, "%s/%s", DIRECTORY, NAMES[i]);
        hnbrdf_model *model = load(path, HNBRDF_VARIANT_AUTO);
        hnbrdf_model_describe(model, &desc);
        file_line(NAMES[i], &desc, before);
        assert_int_equal(hnbrdf_model_save(model, COPY, NULL), HNBRDF_OK);
        hnbrdf_model_free(model);
        model = load(COPY, HNBRDF_VARIANT_AUTO);
        hnbrdf_model_describe(model, &desc);
        file_line(NAMES[i], &desc, after);
        assert_string_equal(before, after);
        hnbrdf_model_free(model);
        remove(COPY);
    }
}

/* The lines that belong to one file, for golden_values.txt. */
static int print_lines(const char *path)
{
    const char *slash = strrchr(path, '/');
    hnbrdf_model *model = NULL;
    hnbrdf_model_desc desc;
    hnbrdf_error error = {""};
    char line[LINE];
    if (hnbrdf_model_load(path, NULL, &model, &error)) {
        fprintf(stderr, "test_golden: %s\n", error.text);
        return 1;
    }
    hnbrdf_model_describe(model, &desc);
    file_line(slash ? slash + 1 : path, &desc, line);
    puts(line);
    for (int i = 0; i < desc.material_count; i++)
        for (int k = 0; k < PAIRS; k++) {
            value_line(model, i, k, line);
            puts(line);
        }
    hnbrdf_model_free(model);
    return 0;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_of_version_0_1_keep_their_numbers_and_values),
        cmocka_unit_test(golden_files_survive_being_written_again),
    };
    if (argc > 1)
        return print_lines(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
