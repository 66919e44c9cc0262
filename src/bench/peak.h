/* peak.h: the arithmetic limit of this machine, to say how near to it a kernel runs. */
#ifndef HNBRDF_BENCH_PEAK_H
#define HNBRDF_BENCH_PEAK_H

/* FLOP/s in single precision, of the widest vectors this processor has, on `threads` threads at
 * once (0: one a processor); an FMA counts as two. Measured for about 50 ms, the best of many
 * short runs in processor time, so that other programs hardly matter. Where there is no fused
 * multiply-add, the same as bench_muladd_peak(). 0 when memory is short. */
double bench_fma_peak(int threads);
/* The same for separate multiplications and additions: the limit of code that must round as plain C
 * does, as all of this library's. Equal to the first on some processors, half of it on others. */
double bench_muladd_peak(int threads);
/* Both on one thread with the instructions of this name (see below); 0 where the machine lacks
 * them. */
void bench_peaks_of(const char *name, double *fma, double *muladd);
/* What the first two measure: "avx512", "avx2", "neon", "sse2" or "plain". */
const char *bench_peak_name(void);

#endif
