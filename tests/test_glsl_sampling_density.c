/* test_glsl_sampling_density.c: draws of an exported scene's hnbrdf_sample() follow its
 * hnbrdf_pdf() on every Vulkan device, for every material of the shipped model: the build that
 * renderers use, whose exp, log and order of operations are the driver's. */
#include "gpu_run.h"
#include "sampling_statistics.h"

#include "hnbrdf/measured.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of one invocation. In: wo, then u or wi, number of the material, 1 to draw; out: wi and pdf. */
enum { IN = 8, OUT = 4, WORK = SAMPLING_DRAWS + SAMPLING_POINTS, TOGETHER = 4 };

static const char BODY[] = "void main() {\n"
                           "    uint k = gl_GlobalInvocationID.x;\n"
                           "    if (k >= count)\n        return;\n"
                           "    uint at = 8 * k;\n"
                           "    hnbrdf_material m = hnbrdf_scene_material(int(in_words[at + 6]));\n"
                           "    vec3 wo = in_vec3(at), v = in_vec3(at + 3);\n"
                           "    if (in_words[at + 7] == 1u) {\n"
                           "        hnbrdf_sample_result r = hnbrdf_sample(m, wo, v.xy);\n"
                           "        store3(4 * k, r.wi);\n"
                           "        results[4 * k + 3] = r.pdf;\n"
                           "    } else {\n"
                           "        store3(4 * k, v);\n"
                           "        results[4 * k + 3] = hnbrdf_pdf(m, v, wo);\n"
                           "    }\n"
                           "}\n";

/* One material seen from one direction; what it is to the device begins at its part of the
 * buffers. */
typedef struct experiment {
    int material;
    float wo[3];
    sampling_chart chart;
    double areas[SAMPLING_POINTS];
} experiment;

static void write_words(const experiment *e, uint32_t draws, const float v[3], uint32_t *words)
{
    memcpy(words, e->wo, 3 * sizeof *words);
    memcpy(words + 3, v, 3 * sizeof *words);
    words[6] = (uint32_t)e->material;
    words[7] = draws;
}

static void prepare(const hnbrdf_model *model, int material, hnbrdf_rng *rng, experiment *e,
                    uint32_t *words)
{
    static const double views[][2] = {
        {1.0, 0.0}, {0.8, 1.0}, {0.3, 4.0}, {0.05, 2.5}}; /* cosine, azimuth */
    const int half = hnbrdf_model_material_count(model) / 2;
    const double *view = views[(material + material / half) % 4];
    const double sine = sqrt(1.0 - view[0] * view[0]);
    e->material = material;
    e->wo[0] = (float)(sine * cos(view[1]));
    e->wo[1] = (float)(sine * sin(view[1]));
    e->wo[2] = (float)view[0];
    e->chart = sampling_chart_make(hnbrdf_model_material(model, material), e->wo);
    for (int k = 0; k < SAMPLING_DRAWS; k++, words += IN) {
        const float u[3] = {hnbrdf_rng_float(rng), hnbrdf_rng_float(rng), 0.0f};
        write_words(e, 1, u, words);
    }
    for (int k = 0; k < SAMPLING_POINTS; k++, words += IN) {
        float wi[3] = {0.0f, 0.0f, -1.0f};
        e->areas[k] = sampling_chart_point(&e->chart, k, wi);
        write_words(e, 0, wi, words);
    }
}

static double deviate_of(const experiment *e, const float *results)
{
    static sampling_expected expected;
    static sampling_counted counted;
    memset(&expected, 0, sizeof expected);
    memset(&counted, 0, sizeof counted);
    for (int k = 0; k < SAMPLING_DRAWS; k++, results += OUT)
        if (results[3] > 0.0f)
            counted.counts[sampling_chart_cell(&e->chart, results)]++;
        else
            counted.rejected++;
    for (int k = 0; k < SAMPLING_POINTS; k++, results += OUT) {
        double share = e->areas[k] * (double)results[3];
        expected.share[sampling_chart_cell_of_point(k)] += share;
        expected.total += share;
    }
    return sampling_deviate(&expected, &counted);
}

static void samples_of_every_shipped_material_follow_the_density(void **state)
{
    (void)state;
    hnbrdf_model *model = sampling_shipped_model(HNBRDF_EXAMPLE_MODEL);
    experiment *experiments = calloc(TOGETHER, sizeof *experiments);
    uint32_t *words = calloc(TOGETHER * WORK, IN * sizeof *words);
    float *results = calloc(TOGETHER * WORK, OUT * sizeof *results);
    assert_true(experiments && words && results);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 61, 0);
    char *scene = gpu_run_export(model, NULL);
    size_t bytes;
    uint32_t *spirv = gpu_run_compile(scene, BODY, 0, &bytes);
    int count = hnbrdf_model_material_count(model);
    double worst = 0.0;
    for (int first = 0; first < count; first += TOGETHER) {
        int together = count - first < TOGETHER ? count - first : TOGETHER;
        size_t work = (size_t)together * WORK;
        for (int k = 0; k < together; k++)
            prepare(model, first + k, &rng, &experiments[k], words + (size_t)k * WORK * IN);
        gpu_run_compiled(spirv, bytes, 0, (uint32_t)work, words, work * IN, results, work * OUT);
        for (int k = 0; k < together; k++) {
            double deviate = deviate_of(&experiments[k], results + (size_t)k * WORK * OUT);
            if (!(deviate < SAMPLING_THRESHOLD))
                fail_msg("%s, cos %.2f: off by %.1f standard deviations",
                         hnbrdf_model_material_name(model, first + k), (double)experiments[k].wo[2],
                         deviate);
            worst = fmax(worst, deviate);
        }
    }
    print_message("    %d materials, worst deviate %.2f\n", count, worst);
    free(spirv);
    free(scene);
    free(results);
    free(words);
    free(experiments);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_of_every_shipped_material_follow_the_density),
    };
    return gpu_run_tests(tests, sizeof tests / sizeof tests[0]);
}
