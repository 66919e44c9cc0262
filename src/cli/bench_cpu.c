/* bench_cpu.c: what the C library takes on one thread: single evaluations, batches, the network alone.
 */
#include "cli/bench.h"
#include "core/network.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Few enough that directions and values stay in the nearest cache. */
enum { PAIRS = 512, BLOCKS = PAIRS / HNBRDF_LANES };

typedef struct cpu_work {
    struct bench_cpu *cpu;
    const bench_model *model;
    struct cpu_work *next;
} cpu_work;

struct bench_cpu {
    float wi[PAIRS][3], wo[PAIRS][3], f[PAIRS][3];
    float inputs[BLOCKS][HNBRDF_ENCODING_SIZE][HNBRDF_LANES], outputs[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES];
    float input[PAIRS][HNBRDF_ENCODING_SIZE];
    cpu_work *works; /* all that were made */
};

/* ---- What is timed ------------------------------------------------------------------------------- */

static double run_single(void *context, long repeats)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    double started = bench_thread_ns();
    for (long n = 0; n < repeats; n++)
        for (int k = 0; k < PAIRS; k++)
            hnbrdf_eval(w->model->model, w->model->material, cpu->wi[k], cpu->wo[k], cpu->f[k]);
    return bench_thread_ns() - started;
}

static double run_batch(void *context, long repeats)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    double started = bench_thread_ns();
    for (long n = 0; n < repeats; n++)
        hnbrdf_eval_batch(w->model->model, w->model->material, PAIRS, cpu->wi[0], 0, cpu->wo[0], 0,
                          cpu->f[0], 0);
    return bench_thread_ns() - started;
}

static double run_network(void *context, long repeats)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    float out[HNBRDF_MAX_OUTPUTS];
    double started = bench_thread_ns();
    for (long n = 0; n < repeats; n++)
        for (int k = 0; k < PAIRS; k++)
            hnbrdf_network(&w->model->desc, w->model->material->latent, cpu->input[k], out);
    return bench_thread_ns() - started;
}

static double run_network_blocks(void *context, long repeats)
{
    cpu_work *w = context;
    struct bench_cpu *cpu = w->cpu;
    double started = bench_thread_ns();
    for (long n = 0; n < repeats; n++)
        for (int k = 0; k < BLOCKS; k++)
            hnbrdf_network_block(&w->model->desc, w->model->material->latent, cpu->inputs[k],
                                 cpu->outputs);
    return bench_thread_ns() - started;
}

/* ---- Rows ---------------------------------------------------------------------------------------- */

/* Directions as a renderer has them, and inputs as a network sees them: numbers between -1 and 1. */
static void fill(struct bench_cpu *cpu)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < PAIRS; k++) {
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, cpu->wi[k], cpu->wo[k]);
        for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++)
            cpu->input[k][i] = cpu->inputs[k / HNBRDF_LANES][i][k % HNBRDF_LANES] =
                2.0f * hnbrdf_rng_float(&rng) - 1.0f;
    }
}

static cpu_work *add_work(struct bench_cpu *cpu, const bench_model *model)
{
    cpu_work *work = calloc(1, sizeof *work);
    if (!work)
        return NULL;
    *work = (cpu_work){.cpu = cpu, .model = model, .next = cpu->works};
    return cpu->works = work;
}

typedef double (*runner)(void *context, long repeats);

static int add_row(bench *b, struct bench_cpu *cpu, const bench_model *model, const char *backend,
                   const char *variant, runner whole, runner network)
{
    bench_row *row = bench_add_row(b, model, backend, variant, "model", "float");
    cpu_work *work = row ? add_work(cpu, model) : NULL;
    if (!work)
        return row ? cli_fail("out of memory") : CLI_FAILURE;
    row->threads = 1;
    row->bytes = hnbrdf_model_weight_count(model->model) * sizeof(float);
    row->whole = bench_probe_make(whole, work, PAIRS);
    if (model->desc.kind != HNBRDF_KIND_GGX)
        row->network = bench_probe_make(network, work, PAIRS);
    return CLI_OK;
}

bench_cpu *bench_cpu_open(bench *b)
{
    struct bench_cpu *cpu = calloc(1, sizeof *cpu);
    int code = cpu ? CLI_OK : cli_fail("out of memory");
    if (code == CLI_OK)
        fill(cpu);
    for (int k = 0; k < b->model_count && code == CLI_OK; k++) {
        const bench_model *model = &b->models[k];
        code = add_row(b, cpu, model, "c-single", "plain", run_single, run_network);
        if (code == CLI_OK)
            code = add_row(b, cpu, model, "c-batch", "plain", run_batch, run_network_blocks);
    }
    if (code == CLI_OK)
        return cpu;
    bench_cpu_close(cpu);
    return NULL;
}

void bench_cpu_close(bench_cpu *cpu)
{
    for (cpu_work *work = cpu ? cpu->works : NULL; work;) {
        cpu_work *next = work->next;
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
