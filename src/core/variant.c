/* variant.c: the names of the variants, and which of them this build holds and this machine runs.
 * */
#include "core/kernel.h"

#include <string.h>

static const char names[][16] = {
    [HNBRDF_VARIANT_AUTO] = "auto",
    [HNBRDF_VARIANT_PLAIN] = "plain",
    [HNBRDF_VARIANT_SSE2] = "sse2",
    [HNBRDF_VARIANT_AVX2] = "avx2",
    [HNBRDF_VARIANT_AVX512] = "avx512",
    [HNBRDF_VARIANT_NEON] = "neon",
    [HNBRDF_VARIANT_AVX2_FUSED] = "avx2-fused",
    [HNBRDF_VARIANT_AVX512_FUSED] = "avx512-fused",
    [HNBRDF_VARIANT_NEON_FUSED] = "neon-fused",
};
enum { VARIANTS = sizeof names / sizeof names[0] };

const char *hnbrdf_variant_name(hnbrdf_variant variant)
{
    return (unsigned)variant < VARIANTS ? names[variant] : NULL;
}

int hnbrdf_variant_from_name(const char *name, hnbrdf_variant *variant)
{
    for (int k = 0; k < VARIANTS; k++)
        if (strcmp(name, names[k]) == 0) {
            *variant = (hnbrdf_variant)k;
            return 1;
        }
    return 0;
}

int hnbrdf_variant_is_exact(hnbrdf_variant variant)
{
    return variant >= HNBRDF_VARIANT_AUTO && variant <= HNBRDF_VARIANT_NEON;
}

/* NULL: not in this build, or not on this machine. */
static const hnbrdf_kernel *fused_kernel(hnbrdf_variant variant)
{
#ifdef HNBRDF_HAVE_AVX2_FUSED
    if (variant == HNBRDF_VARIANT_AVX2_FUSED && __builtin_cpu_supports("avx2") &&
        __builtin_cpu_supports("fma"))
        return &hnbrdf_kernel_avx2_fused;
#endif
#ifdef HNBRDF_HAVE_AVX512_FUSED
    if (variant == HNBRDF_VARIANT_AVX512_FUSED && __builtin_cpu_supports("avx512f") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("fma"))
        return &hnbrdf_kernel_avx512_fused;
#endif
#ifdef HNBRDF_HAVE_NEON_FUSED
    if (variant == HNBRDF_VARIANT_NEON_FUSED)
        return &hnbrdf_kernel_neon_fused;
#endif
    (void)variant;
    return NULL;
}

/* From slow to fast. */
const hnbrdf_kernel *hnbrdf_kernel_of(hnbrdf_variant variant)
{
    const hnbrdf_kernel *best = fused_kernel(variant);
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
