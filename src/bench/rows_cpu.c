/* rows_cpu.c: what the C library takes on one thread: single evaluations, batches, the network
 * alone. */
#include "base/error.h"
#include "bench/bench.h"
#include "core/kernel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Few enough that directions and values stay in the nearest cache. */
enum { PAIRS = 512, BLOCKS = PAIRS / HNBRDF_LANES, TABLE = 16 };

/* One model with one variant. */
typedef struct cpu_work {
    struct bench_cpu *cpu;
    hnbrdf_model *model;
    const hnbrdf_material *material;
    hnbrdf_prepared prepared;
    const hnbrdf_material *table; /* for hnbrdf_eval_many() */
    int index[PAIRS];
    struct cpu_work *next;
} cpu_work;

struct bench_cpu {
    float wi[PAIRS][3], wo[PAIRS][3], f[PAIRS][3], u[PAIRS][2], pdf[PAIRS];
    float inputs[BLOCKS][HNBRDF_ENCODING_SIZE][HNBRDF_LANES],
        outputs[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES];
    float input[PAIRS][HNBRDF_ENCODING_SIZE], output[HNBRDF_MAX_HIDDEN]; /* one at a time */
    cpu_work *works;                                                     /* all that were made */
};

/* ---- What is timed --------------------------------------------------------------------------- */

static void run_single(void *context)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    for (int k = 0; k < PAIRS; k++)
        hnbrdf_eval(w->model, w->material, cpu->wi[k], cpu->wo[k], cpu->f[k]);
}

static void run_prepared(void *context)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    for (int k = 0; k < PAIRS; k++)
        hnbrdf_prepared_eval(&w->prepared, cpu->wi[k], cpu->wo[k], cpu->f[k]);
}

static void run_draw(void *context)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    for (int k = 0; k < PAIRS; k++)
        cpu->pdf[k] = hnbrdf_prepared_draw(&w->prepared, cpu->wo[k], cpu->u[k], cpu->f[k]);
}

static void run_density(void *context)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    for (int k = 0; k < PAIRS; k++)
        cpu->pdf[k] = hnbrdf_prepared_pdf(&w->prepared, cpu->wi[k], cpu->wo[k]);
}

static void run_batch(void *context)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    hnbrdf_eval_batch(w->model, w->material, PAIRS, cpu->wi[0], 0, cpu->wo[0], 0, cpu->f[0], 0);
}

static void run_many(void *context)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    hnbrdf_eval_many(w->model, w->table, w->index, PAIRS, cpu->wi[0], 0, cpu->wo[0], 0, cpu->f[0],
                     0);
}

static void run_network(void *context)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    for (int k = 0; k < BLOCKS; k++)
        hnbrdf_network_block(&w->prepared, cpu->inputs[k], cpu->outputs);
}

static void run_network_singly(void *context)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    for (int k = 0; k < PAIRS; k++)
        w->model->kernel->outputs(&w->prepared, cpu->input[k], cpu->output);
}

/* ---- Rows ------------------------------------------------------------------------------------ */

/* Directions as a renderer has them, and inputs as a network sees them: numbers between -1 and 1.
 * */
static void fill(struct bench_cpu *cpu)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < PAIRS; k++) {
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, cpu->wi[k], cpu->wo[k]);
        cpu->u[k][0] = hnbrdf_rng_float(&rng);
        cpu->u[k][1] = hnbrdf_rng_float(&rng);
        for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++)
            cpu->inputs[k / HNBRDF_LANES][i][k % HNBRDF_LANES] = cpu->input[k][i] =
                2.0f * hnbrdf_rng_float(&rng) - 1.0f;
    }
}

/* Some of the model's materials without any order, as the hits of a scattered ray batch have
 * them. */
static void fill_table(cpu_work *work)
{
    int count = hnbrdf_model_material_count(work->model);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 2, 0);
    work->table = hnbrdf_model_material(work->model, 0);
    for (int k = 0; k < PAIRS; k++)
        work->index[k] = (int)(hnbrdf_rng_u32(&rng) % (uint32_t)(count < TABLE ? count : TABLE));
}

static hnbrdf_result add_work(struct bench_cpu *cpu, const bench_model *model,
                              hnbrdf_variant variant, cpu_work **made, hnbrdf_error *error)
{
    hnbrdf_model_desc desc = model->desc;
    cpu_work *work = *made = calloc(1, sizeof *work);
    if (!work)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    work->next = cpu->works;
    cpu->works = work;
    work->cpu = cpu;
    desc.variant = variant;
    hnbrdf_result result = hnbrdf_model_create(&desc, NULL, &work->model, error);
    if (result)
        return result;
    work->material = hnbrdf_model_material(work->model, 0);
    hnbrdf_prepare(work->model, work->material, &work->prepared);
    fill_table(work);
    return HNBRDF_OK;
}

typedef void (*runner)(void *context);

static hnbrdf_result add_row(bench *b, const bench_model *model, cpu_work *work,
                             hnbrdf_variant variant, const char *backend, runner whole,
                             runner network, hnbrdf_error *error)
{
    bench_row *row;
    hnbrdf_result result = bench_add_row(b, model, backend, hnbrdf_variant_name(variant), "model",
                                         "float", &row, error);
    if (result)
        return result;
    row->threads = 1;
    row->bytes = hnbrdf_model_weight_count(model->model) * sizeof(float);
    row->whole = hnbrdf_probe_of_thread(whole, work, PAIRS);
    if (network && model->desc.kind != HNBRDF_KIND_GGX)
        row->network = hnbrdf_probe_of_thread(network, work, PAIRS);
    if (whole == run_prepared) {
        row->draw = hnbrdf_probe_of_thread(run_draw, work, PAIRS);
        row->density = hnbrdf_probe_of_thread(run_density, work, PAIRS);
    }
    return HNBRDF_OK;
}

/* Batches with every variant, the rest with the one that is in use. */
static hnbrdf_result add_model(bench *b, struct bench_cpu *cpu, const bench_model *model,
                               hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int v = HNBRDF_VARIANT_PLAIN; hnbrdf_variant_name((hnbrdf_variant)v) && !result; v++) {
        hnbrdf_variant variant = (hnbrdf_variant)v;
        int in_use = variant == model->desc.variant;
        if (!hnbrdf_variant_available(variant))
            continue;
        cpu_work *work;
        result = add_work(cpu, model, variant, &work, error);
        if (in_use && !result)
            result = add_row(b, model, work, variant, "c-single", run_single, NULL, error);
        if (in_use && !result)
            result = add_row(b, model, work, variant, "c-single-prepared", run_prepared,
                             run_network_singly, error);
        if (!result)
            result = add_row(b, model, work, variant, "c-batch", run_batch, run_network, error);
        if (in_use && !result)
            result = add_row(b, model, work, variant, "c-many", run_many, run_network, error);
    }
    return result;
}

hnbrdf_result bench_cpu_open(bench *b, bench_cpu **opened, hnbrdf_error *error)
{
    struct bench_cpu *cpu = *opened = calloc(1, sizeof *cpu);
    hnbrdf_result result = HNBRDF_OK;
    if (!cpu)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    fill(cpu);
    for (int k = 0; k < b->model_count && !result; k++)
        result = add_model(b, cpu, &b->models[k], error);
    return result;
}

void bench_cpu_close(bench_cpu *cpu)
{
    for (cpu_work *work = cpu ? cpu->works : NULL; work;) {
        cpu_work *next = work->next;
        hnbrdf_model_free(work->model);
        free(work);
        work = next;
    }
    free(cpu);
}

const char *bench_cpu_name(char name[BENCH_NAME])
{
    char line[256];
    snprintf(name, BENCH_NAME, "unknown processor");
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file)) {
        const char *value = strchr(line, ':');
        if (value && strncmp(line, "model name", 10) == 0) {
            snprintf(name, BENCH_NAME, "%.*s", (int)strcspn(value + 2, "\n"), value + 2);
            break;
        }
    }
    if (file)
        fclose(file);
    return name;
}
