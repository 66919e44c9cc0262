/* test_threads.c MODEL SCRATCH: one model, shared by eight threads that do everything with it at
 * once, gives each of them what it gives one thread alone, to the last bit; and evaluation leaves
 * errno alone.
 *
 * A plain program without cmocka: test_races.sh builds it again under ThreadSanitizer, which sees
 * races that happen to do no harm. */
#include "hnbrdf/glsl.h"

#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 8, ROUNDS = 2, PAIRS = 200, MARK = 4711 };

/* What all threads share and none changes. */
typedef struct shared {
    const hnbrdf_model *model;
    hnbrdf_material materials[PAIRS];
    hnbrdf_prepared prepared;
    int index[PAIRS];
    float wi[PAIRS][3], wo[PAIRS][3], u[PAIRS][2];
    const char *scratch;
} shared;

/* FNV-1a; a hnbrdf_write_fn. */
static int add(void *user, const void *data, size_t size)
{
    uint64_t *checksum = user;
    for (size_t i = 0; i < size; i++)
        *checksum = (*checksum ^ ((const unsigned char *)data)[i]) * 0x100000001b3u;
    return 0;
}

/* ---- What a thread does; each ends with a checksum of what came out -------------------------- */

static int single(const shared *s, int thread, uint64_t *sum)
{
    (void)thread;
    for (int k = 0; k < PAIRS; k++) {
        float f[3], a[3], pdf;
        hnbrdf_eval(s->model, &s->materials[k], s->wi[k], s->wo[k], f);
        hnbrdf_eval_analytic(s->model, &s->materials[k], s->wi[k], s->wo[k], a);
        pdf = hnbrdf_pdf(s->model, &s->materials[k], s->wi[k], s->wo[k]);
        add(sum, f, sizeof f);
        add(sum, a, sizeof a);
        add(sum, &pdf, sizeof pdf);
    }
    return 0;
}

static int prepared(const shared *s, int thread, uint64_t *sum)
{
    (void)thread;
    for (int k = 0; k < PAIRS; k++) {
        hnbrdf_prepared own;
        const hnbrdf_prepared *p = k % 2 ? &own : &s->prepared;
        hnbrdf_sample_result sample;
        float f[3], pdf;
        hnbrdf_prepare(s->model, &s->materials[k], &own);
        hnbrdf_prepared_eval(p, s->wi[k], s->wo[k], f);
        pdf = hnbrdf_prepared_pdf(p, s->wi[k], s->wo[k]);
        hnbrdf_prepared_sample(p, s->wo[k], s->u[k], &sample);
        add(sum, f, sizeof f);
        add(sum, &pdf, sizeof pdf);
        add(sum, &sample, sizeof sample);
    }
    return 0;
}

static int batches(const shared *s, int thread, uint64_t *sum)
{
    float f[PAIRS][3];
    (void)thread;
    hnbrdf_eval_batch(s->model, &s->materials[0], PAIRS, s->wi[0], 0, s->wo[0], 0, f[0], 0);
    add(sum, f, sizeof f);
    hnbrdf_eval_analytic_batch(s->model, &s->materials[1], PAIRS, s->wi[0], 0, s->wo[0], 0, f[0],
                               0);
    add(sum, f, sizeof f);
    hnbrdf_eval_many(s->model, s->materials, s->index, PAIRS, s->wi[0], 0, s->wo[0], 0, f[0], 0);
    add(sum, f, sizeof f);
    hnbrdf_eval_many(s->model, s->materials, NULL, PAIRS, s->wi[0], 0, s->wo[0], 0, f[0], 0);
    add(sum, f, sizeof f);
    return 0;
}

static int sampling(const shared *s, int thread, uint64_t *sum)
{
    (void)thread;
    for (int k = 0; k < PAIRS; k++) {
        hnbrdf_sample_result sample;
        hnbrdf_sample(s->model, &s->materials[k], s->wo[k], s->u[k], &sample);
        add(sum, &sample, sizeof sample);
    }
    return 0;
}

static int texels(const shared *s, int thread, uint64_t *sum)
{
    (void)thread;
    for (int format = HNBRDF_TEXEL_RGBA16F; format <= HNBRDF_TEXEL_RGBA8; format++) {
        hnbrdf_packing packing;
        unsigned char bytes[HNBRDF_MAX_TEXELS * 8] = {0};
        hnbrdf_material mixed;
        if (hnbrdf_packing_init(s->model, NULL, 0, (hnbrdf_texel_format)format, &packing, NULL))
            return 1;
        hnbrdf_material_mix(&s->materials[0], &s->materials[1], 0.25f, &mixed);
        hnbrdf_material_pack(&packing, &mixed, bytes);
        hnbrdf_material_unpack(&packing, bytes, &mixed);
        add(sum, bytes, sizeof bytes);
        add(sum, &mixed, sizeof mixed);
    }
    return 0;
}

static int exporting(const shared *s, int thread, uint64_t *sum)
{
    (void)thread;
    for (int weights = HNBRDF_GLSL_CONSTANTS; weights <= HNBRDF_GLSL_UNIFORM; weights++) {
        hnbrdf_glsl_options options = {.weights = (hnbrdf_glsl_weights)weights,
                                       .fixed = weights == 0};
        options.precision = weights == 1 ? HNBRDF_GLSL_HALF : HNBRDF_GLSL_FLOAT;
        if (hnbrdf_export_shader(s->model, &options, add, sum, NULL) ||
            hnbrdf_export_weights(s->model, &options, add, sum, NULL))
            return 1;
    }
    return 0;
}

/* To memory, to a file of its own, and back. */
static int saving(const shared *s, int thread, uint64_t *sum)
{
    char path[1024];
    hnbrdf_model *back = NULL;
    snprintf(path, sizeof path, "%s/thread%d.safetensors", s->scratch, thread);
    if (hnbrdf_model_write(s->model, add, sum, NULL) || hnbrdf_model_save(s->model, path, NULL) ||
        hnbrdf_model_load(path, NULL, &back, NULL) || remove(path))
        return 1;
    const int failed = hnbrdf_model_write(back, add, sum, NULL) != HNBRDF_OK;
    hnbrdf_model_free(back);
    return failed;
}

static int looking(const shared *s, int thread, uint64_t *sum)
{
    hnbrdf_error error = {""};
    hnbrdf_model_desc desc;
    hnbrdf_model *copy = NULL, *none = NULL;
    hnbrdf_material wrong = s->materials[0];
    (void)thread;
    for (int k = 0; k < hnbrdf_model_material_count(s->model); k++) {
        const char *name = hnbrdf_model_material_name(s->model, k);
        if (hnbrdf_model_find(s->model, name) != k)
            return 1;
        add(sum, name, strlen(name));
    }
    hnbrdf_model_describe(s->model, &desc);
    if (hnbrdf_model_create(&desc, NULL, &copy, NULL) || hnbrdf_model_write(copy, add, sum, NULL))
        return 1;
    hnbrdf_model_free(copy);
    wrong.kd[0] = 1.5f;
    if (!hnbrdf_material_check(&wrong, &error))
        return 1;
    add(sum, error.text, strlen(error.text));
    if (!hnbrdf_model_load_memory("nothing", 7, NULL, &none, &error))
        return 1;
    return add(sum, error.text, strlen(error.text));
}

/* The first four are pure: they also leave errno alone. */
typedef int activity(const shared *s, int thread, uint64_t *sum);
enum { PURE = 4, ACTIVITIES = 8 };
static activity *const activities[ACTIVITIES] = {single, prepared,  batches, sampling,
                                                 texels, exporting, saving,  looking};
static const char *const names[ACTIVITIES] = {"single", "prepared",  "batches", "sampling",
                                              "texels", "exporting", "saving",  "looking"};

static int run(const shared *s, int which, int thread, uint64_t *sum)
{
    *sum = 0xcbf29ce484222325u;
    errno = MARK;
    const int failed = activities[which](s, thread, sum);
    if (which < PURE && errno != MARK) {
        fprintf(stderr, "%s changes errno\n", names[which]);
        return 1;
    }
    if (failed)
        fprintf(stderr, "%s fails\n", names[which]);
    return failed;
}

/* ---- Threads --------------------------------------------------------------------------------- */

typedef struct worker {
    const shared *s;
    const uint64_t *expected; /* [ACTIVITIES] */
    pthread_barrier_t *start;
    pthread_t thread;
    int number, failures;
} worker;

/* Each begins with another activity, so that all of them meet. */
static void *work(void *user)
{
    worker *w = user;
    pthread_barrier_wait(w->start);
    for (int k = 0; k < ROUNDS * ACTIVITIES; k++) {
        const int which = (w->number + k) % ACTIVITIES;
        uint64_t sum;
        if (run(w->s, which, w->number, &sum) || sum != w->expected[which]) {
            fprintf(stderr, "thread %d: %s differs from one thread alone\n", w->number,
                    names[which]);
            w->failures++;
        }
    }
    return NULL;
}

static float unit(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) * 0x1p-24f;
}

/* Directions from the library's own sampling, so that they are unit vectors. */
static void fill(shared *s, const hnbrdf_model *model, const char *scratch)
{
    uint32_t state = 1;
    hnbrdf_sample_result sample = {.wi = {0.6f, 0.0f, 0.8f}};
    memset(s, 0, sizeof *s);
    s->model = model;
    s->scratch = scratch;
    for (int k = 0; k < PAIRS; k++) {
        s->index[k] = k % hnbrdf_model_material_count(model);
        s->materials[k] = *hnbrdf_model_material(model, s->index[k]);
        s->materials[k].rotation = k % 3 ? 0.0f : 0.5f;
        memcpy(s->wo[k], sample.wi, sizeof s->wo[k]);
        for (int i = 0; i < 2; i++)
            s->u[k][i] = unit(&state);
        hnbrdf_sample(model, &s->materials[k], s->wo[k], s->u[k], &sample);
        memcpy(s->wi[k], sample.wi, sizeof s->wi[k]);
    }
    hnbrdf_prepare(model, &s->materials[1], &s->prepared);
}

static int share(const hnbrdf_model *model, const char *scratch)
{
    static shared s;
    worker workers[THREADS];
    pthread_barrier_t start;
    uint64_t expected[ACTIVITIES];
    int failures = 0;
    fill(&s, model, scratch);
    for (int which = 0; which < ACTIVITIES; which++)
        failures += run(&s, which, 0, &expected[which]);
    if (pthread_barrier_init(&start, NULL, THREADS))
        return 1;
    for (int k = 0; k < THREADS; k++) {
        workers[k] = (worker){.s = &s, .expected = expected, .start = &start, .number = k};
        if (pthread_create(&workers[k].thread, NULL, work, &workers[k])) {
            perror("test_threads: a thread");
            exit(1);
        }
    }
    for (int k = 0; k < THREADS; k++) {
        pthread_join(workers[k].thread, NULL);
        failures += workers[k].failures;
    }
    pthread_barrier_destroy(&start);
    return failures;
}

int main(int argc, char **argv)
{
    int failures = 0;
    if (argc != 3)
        return 2;
    for (int v = HNBRDF_VARIANT_PLAIN; v <= HNBRDF_VARIANT_NEON; v++) {
        const hnbrdf_load_options options = {.variant = (hnbrdf_variant)v};
        hnbrdf_model *model = NULL;
        hnbrdf_error error = {""};
        if (!hnbrdf_variant_available((hnbrdf_variant)v))
            continue;
        if (hnbrdf_model_load(argv[1], &options, &model, &error)) {
            fprintf(stderr, "test_threads: %s\n", error.text);
            return 1;
        }
        const int found = share(model, argv[2]);
        printf("%s: %d threads, %d differences\n", hnbrdf_variant_name((hnbrdf_variant)v), THREADS,
               found);
        failures += found;
        hnbrdf_model_free(model);
    }
    return failures != 0;
}
