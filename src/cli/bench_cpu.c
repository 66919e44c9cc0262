/* bench_cpu.c: what the C library takes on one thread: single evaluations, batches, the network
 * alone. */
#include "cli/bench.h"
#include "core/network.h"

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
    float wi[PAIRS][3], wo[PAIRS][3], f[PAIRS][3];
    float inputs[BLOCKS][HNBRDF_ENCODING_SIZE][HNBRDF_LANES],
        outputs[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES];
    cpu_work *works; /* all that were made */
};

/* ---- What is timed --------------------------------------------------------------------------- */

static double run_single(void *context, long repeats)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    double started = bench_thread_ns();
    for (long n = 0; n < repeats; n++)
        for (int k = 0; k < PAIRS; k++)
            hnbrdf_eval(w->model, w->material, cpu->wi[k], cpu->wo[k], cpu->f[k]);
    return bench_thread_ns() - started;
}

static double run_prepared(void *context, long repeats)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    double started = bench_thread_ns();
    for (long n = 0; n < repeats; n++)
        for (int k = 0; k < PAIRS; k++)
            hnbrdf_prepared_eval(&w->prepared, cpu->wi[k], cpu->wo[k], cpu->f[k]);
    return bench_thread_ns() - started;
}

static double run_batch(void *context, long repeats)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    double started = bench_thread_ns();
    for (long n = 0; n < repeats; n++)
        hnbrdf_eval_batch(w->model, w->material, PAIRS, cpu->wi[0], 0, cpu->wo[0], 0, cpu->f[0], 0);
    return bench_thread_ns() - started;
}

static double run_many(void *context, long repeats)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    double started = bench_thread_ns();
    for (long n = 0; n < repeats; n++)
        hnbrdf_eval_many(w->model, w->table, w->index, PAIRS, cpu->wi[0], 0, cpu->wo[0], 0,
                         cpu->f[0], 0);
    return bench_thread_ns() - started;
}

static double run_network(void *context, long repeats)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    double started = bench_thread_ns();
    for (long n = 0; n < repeats; n++)
        for (int k = 0; k < BLOCKS; k++)
            hnbrdf_network_block(&w->prepared, cpu->inputs[k], cpu->outputs);
    return bench_thread_ns() - started;
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
        for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++)
            cpu->inputs[k / HNBRDF_LANES][i][k % HNBRDF_LANES] =
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

/* NULL after a message. */
static cpu_work *add_work(struct bench_cpu *cpu, const bench_model *model, hnbrdf_variant variant)
{
    hnbrdf_model_desc desc = model->desc;
    hnbrdf_error error;
    cpu_work *work = calloc(1, sizeof *work);
    if (!work) {
        cli_fail("out of memory");
        return NULL;
    }
    work->next = cpu->works;
    cpu->works = work;
    work->cpu = cpu;
    desc.variant = variant;
    if (hnbrdf_model_create(&desc, NULL, &work->model, &error)) {
        cli_fail("%s", error.text);
        return NULL;
    }
    work->material = hnbrdf_model_material(work->model, 0);
    hnbrdf_prepare(work->model, work->material, &work->prepared);
    fill_table(work);
    return work;
}

typedef double (*runner)(void *context, long repeats);

static int add_row(bench *b, const bench_model *model, cpu_work *work, hnbrdf_variant variant,
                   const char *backend, runner whole, int with_network)
{
    bench_row *row =
        bench_add_row(b, model, backend, hnbrdf_variant_name(variant), "model", "float");
    if (!row)
        return CLI_FAILURE;
    row->threads = 1;
    row->bytes = hnbrdf_model_weight_count(model->model) * sizeof(float);
    row->whole = bench_probe_make(whole, work, PAIRS);
    if (with_network && model->desc.kind != HNBRDF_KIND_GGX)
        row->network = bench_probe_make(run_network, work, PAIRS);
    return CLI_OK;
}

/* Batches with every variant, the rest with the one that is in use. */
static int add_model(bench *b, struct bench_cpu *cpu, const bench_model *model)
{
    int code = CLI_OK;
    for (int v = HNBRDF_VARIANT_PLAIN; hnbrdf_variant_name((hnbrdf_variant)v) && code == CLI_OK;
         v++) {
        hnbrdf_variant variant = (hnbrdf_variant)v;
        int in_use = variant == model->desc.variant;
        if (!hnbrdf_variant_available(variant))
            continue;
        cpu_work *work = add_work(cpu, model, variant);
        if (!work)
            return CLI_FAILURE;
        if (in_use)
            code = add_row(b, model, work, variant, "c-single", run_single, 0);
        if (in_use && code == CLI_OK)
            code = add_row(b, model, work, variant, "c-single-prepared", run_prepared, 0);
        if (code == CLI_OK)
            code = add_row(b, model, work, variant, "c-batch", run_batch, 1);
        if (in_use && code == CLI_OK)
            code = add_row(b, model, work, variant, "c-many", run_many, 1);
    }
    return code;
}

bench_cpu *bench_cpu_open(bench *b)
{
    struct bench_cpu *cpu = calloc(1, sizeof *cpu);
    int code = cpu ? CLI_OK : cli_fail("out of memory");
    if (code == CLI_OK)
        fill(cpu);
    for (int k = 0; k < b->model_count && code == CLI_OK; k++)
        code = add_model(b, cpu, &b->models[k]);
    if (code == CLI_OK)
        return cpu;
    bench_cpu_close(cpu);
    return NULL;
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

const char *bench_cpu_name(void)
{
    static char name[BENCH_NAME] = "unknown processor";
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file)) {
        const char *value = strchr(line, ':');
        if (value && strncmp(line, "model name", 10) == 0) {
            snprintf(name, sizeof name, "%.*s", (int)strcspn(value + 2, "\n"), value + 2);
            break;
        }
    }
    if (file)
        fclose(file);
    return name;
}
