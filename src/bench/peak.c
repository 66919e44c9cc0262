/* peak.c: chains of multiply-adds that never leave the registers, for every instruction set. */
#include "bench/peak.h"

#include "base/clock.h"
#include "base/threads.h"

#include <string.h>

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

enum { PEAK_CHAINS = 12, PEAK_STEPS = 1 << 16, PEAK_RUNS_AT_LEAST = 8 };
#define PEAK_SECONDS 0.05

/* Twelve chains x = x a + b hide the latency of an operation and fit sixteen registers; a < 1 keeps
 * them near 1. Returns a number that depends on all. */
#define PEAK_EACH(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) DO(8) DO(9) DO(10) DO(11)
#define PEAK_DECLARE(k) vector x##k = {(float)((k) + 1)};
#define PEAK_STEP(k) x##k = STEP(x##k);
#define PEAK_SUM(k) sum += x##k[0];
#define PEAK_CHAIN                                                   \
    const vector zero = {0}, a = zero + 0.999999f, b = zero + 1e-6f; \
    float sum = 0.0f;                                                \
    PEAK_EACH(PEAK_DECLARE)                                          \
    for (long n = 0; n < PEAK_STEPS; n++) {                          \
        PEAK_EACH(PEAK_STEP)                                         \
    }                                                                \
    PEAK_EACH(PEAK_SUM)                                              \
    return sum;
#define PEAK_VECTOR(WIDTH) \
    typedef float vector __attribute__((vector_size((WIDTH) * sizeof(float))))

typedef struct peak_chains {
    const char *name;
    int width; /* numbers in a vector */
    float (*muladd)(void), (*fma)(void);
} peak_chains;

#define STEP(x) ((x)*a + b)
static float chain_plain(void)
{
    PEAK_VECTOR(4);
    PEAK_CHAIN
}
#if defined(__x86_64__)
__attribute__((target("avx2"))) static float chain_avx2(void)
{
    PEAK_VECTOR(8);
    PEAK_CHAIN
}
__attribute__((target("avx512f"))) static float chain_avx512(void)
{
    PEAK_VECTOR(16);
    PEAK_CHAIN
}
#endif
#undef STEP

#if defined(__x86_64__)
#define STEP(x) _mm256_fmadd_ps((x), a, b)
__attribute__((target("avx2,fma"))) static float chain_avx2_fma(void)
{
    PEAK_VECTOR(8);
    PEAK_CHAIN
}
#undef STEP
#define STEP(x) _mm512_fmadd_ps((x), a, b)
__attribute__((target("avx512f"))) static float chain_avx512_fma(void)
{
    PEAK_VECTOR(16);
    PEAK_CHAIN
}
#undef STEP
#elif defined(__aarch64__)
#define STEP(x) vfmaq_f32(b, (x), a)
static float chain_neon_fma(void)
{
    typedef float32x4_t vector;
    PEAK_CHAIN
}
#undef STEP
#endif

/* From the narrowest to the widest; all but the first are run only where the processor has them. */
static const peak_chains all_chains[] = {
    {"plain", 4, chain_plain, chain_plain},
#if defined(__x86_64__)
    {"sse2", 4, chain_plain, chain_plain},
    {"avx2", 8, chain_avx2, chain_avx2_fma},
    {"avx512", 16, chain_avx512, chain_avx512_fma},
#elif defined(__aarch64__)
    {"neon", 4, chain_plain, chain_neon_fma},
#endif
};

static int is_available(const peak_chains *chains)
{
#if defined(__x86_64__)
    if (chains->width == 16)
        return __builtin_cpu_supports("avx512f");
    if (chains->width == 8)
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
    return chains->name != NULL;
}

/* 1: `name` is that of a variant with these instructions, fused or not. */
static int is_of(const peak_chains *chains, const char *name)
{
    size_t length = strlen(chains->name);
    return strncmp(chains->name, name, length) == 0 &&
           (name[length] == '\0' || strcmp(name + length, "-fused") == 0);
}

/* By the name of a variant, or the widest; NULL: none. */
static const peak_chains *choose(const char *name)
{
    const peak_chains *found = NULL;
    for (size_t k = 0; k < sizeof all_chains / sizeof all_chains[0]; k++)
        if (is_available(&all_chains[k]) && (!name || is_of(&all_chains[k], name)))
            found = &all_chains[k];
    return found;
}

typedef struct run {
    float (*chain)(void);
    volatile float *results; /* [threads]: what a compiler cannot leave out */
} run;

static void run_one(void *context, int index, int worker)
{
    run *r = context;
    (void)worker;
    r->results[index] = r->chain();
}

static double measure(float (*chain)(void), int width, int threads)
{
    hnbrdf_threads *workers = hnbrdf_threads_start(threads);
    if (!workers)
        return 0.0;
    volatile float results[256];
    run r = {chain, results};
    int count = hnbrdf_threads_count(workers);
    double begun = hnbrdf_seconds(), best = 1e9;
    for (int runs = 0; runs < PEAK_RUNS_AT_LEAST || hnbrdf_seconds() - begun < PEAK_SECONDS;
         runs++) {
        double before = hnbrdf_threads_busy(workers);
        hnbrdf_threads_run(workers, count, run_one, &r);
        double seconds = (hnbrdf_threads_busy(workers) - before) / count;
        best = seconds < best ? seconds : best;
    }
    hnbrdf_threads_stop(workers);
    return best > 0.0 ? 2.0 * count * width * PEAK_CHAINS * (double)PEAK_STEPS / best : 0.0;
}

double bench_fma_peak(int threads)
{
    const peak_chains *chains = choose(NULL);
    return measure(chains->fma, chains->width, threads);
}

double bench_muladd_peak(int threads)
{
    const peak_chains *chains = choose(NULL);
    return measure(chains->muladd, chains->width, threads);
}

void bench_peaks_of(const char *name, double *fma, double *muladd)
{
    const peak_chains *chains = choose(name);
    *fma = chains ? measure(chains->fma, chains->width, 1) : 0.0;
    *muladd = chains ? measure(chains->muladd, chains->width, 1) : 0.0;
}

const char *bench_peak_name(void)
{
    return choose(NULL)->name;
}
