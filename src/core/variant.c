/* variant.c: the names of the variants, and which of them this build holds and this machine runs.
 * */
#include "core/kernel.h"

const char *hnbrdf_variant_name(hnbrdf_variant variant)
{
    switch (variant) {
    case HNBRDF_VARIANT_AUTO:
        return "auto";
    case HNBRDF_VARIANT_PLAIN:
        return "plain";
    case HNBRDF_VARIANT_SSE2:
        return "sse2";
    case HNBRDF_VARIANT_AVX2:
        return "avx2";
    case HNBRDF_VARIANT_AVX512:
        return "avx512";
    case HNBRDF_VARIANT_NEON:
        return "neon";
    }
    return NULL;
}

/* From slow to fast. */
const hnbrdf_kernel *hnbrdf_kernel_of(hnbrdf_variant variant)
{
    const hnbrdf_kernel *best = NULL;
    int automatic = variant == HNBRDF_VARIANT_AUTO;
    if (automatic || variant == HNBRDF_VARIANT_PLAIN)
        best = &hnbrdf_kernel_plain;
#ifdef HNBRDF_HAVE_SSE2
    if ((automatic || variant == HNBRDF_VARIANT_SSE2) && __builtin_cpu_supports("sse2"))
        best = &hnbrdf_kernel_sse2;
#endif
#ifdef HNBRDF_HAVE_AVX2
    if ((automatic || variant == HNBRDF_VARIANT_AVX2) && __builtin_cpu_supports("avx2"))
        best = &hnbrdf_kernel_avx2;
#endif
#ifdef HNBRDF_HAVE_AVX512
    if ((automatic || variant == HNBRDF_VARIANT_AVX512) && __builtin_cpu_supports("avx512f") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        best = &hnbrdf_kernel_avx512;
#endif
#ifdef HNBRDF_HAVE_NEON
    if (automatic || variant == HNBRDF_VARIANT_NEON)
        best = &hnbrdf_kernel_neon;
#endif
    return best;
}

int hnbrdf_variant_available(hnbrdf_variant variant)
{
    return hnbrdf_kernel_of(variant) != NULL;
}
