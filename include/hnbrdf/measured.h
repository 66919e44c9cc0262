/* measured.h: measured and procedural BRDFs behind one interface (libhnbrdf_measured).
 *
 * Convention, units and errors are those of hnbrdf.h: wi towards the light, wo towards the viewer,
 * both away from the surface; f in 1/sr without the cosine, linear RGB, never negative or NaN.
 *
 * Formats: MERL .binary (Matusik et al. 2003; nearest bin), RGL .bsdf in the RGB editions, isotropic and
 * anisotropic (Dupuy and Jakob 2018), and built-in procedural materials. Spectral RGL files are refused
 * with HNBRDF_ERROR_UNSUPPORTED. A file is recognised by its content, not by its name.
 */
#ifndef HNBRDF_MEASURED_H
#define HNBRDF_MEASURED_H

#include "hnbrdf/hnbrdf.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hnbrdf_measured_format {
    HNBRDF_MEASURED_BUILTIN = 0,
    HNBRDF_MEASURED_MERL,
    HNBRDF_MEASURED_RGL
} hnbrdf_measured_format;

/* "builtin", "MERL", "RGL". */
HNBRDF_API const char *hnbrdf_measured_format_name(hnbrdf_measured_format format);

/* One measured material. Immutable after opening, may be shared between threads. */
typedef struct hnbrdf_measured hnbrdf_measured;

/* Zero-initialise for defaults. */
typedef struct hnbrdf_measured_options {
    size_t max_bytes; /* refuse larger files; 0 stands for 1 GiB */
} hnbrdf_measured_options;

/* Open a file; its material's name is the file's name without directory, extension and a trailing
 * "_rgb", cut to HNBRDF_MAX_NAME bytes; control characters and what is not UTF-8 become '_'. The file is
 * read whole, and never beyond the limit by more than the buffer that holds it. options may be NULL. */
HNBRDF_API hnbrdf_result hnbrdf_measured_open(const char *path, const hnbrdf_measured_options *options,
                                              hnbrdf_measured **measured, hnbrdf_error *error);

/* The same from bytes in memory; `path` gives the name and is used in messages. The bytes are copied. */
HNBRDF_API hnbrdf_result hnbrdf_measured_open_memory(const void *data, size_t size, const char *path,
                                                     const hnbrdf_measured_options *options,
                                                     hnbrdf_measured **measured, hnbrdf_error *error);

/* The built-in procedural materials, index 0 to hnbrdf_measured_builtin_count() - 1: formulas that hold
 * what measurements contain and one GGX lobe cannot follow. NULL name when index is out of range. */
HNBRDF_API int hnbrdf_measured_builtin_count(void);
HNBRDF_API const char *hnbrdf_measured_builtin_name(int index);
HNBRDF_API hnbrdf_result hnbrdf_measured_open_builtin(int index, hnbrdf_measured **measured,
                                                      hnbrdf_error *error);

/* Free; NULL is allowed. */
HNBRDF_API void hnbrdf_measured_close(hnbrdf_measured *measured);

HNBRDF_API const char *hnbrdf_measured_name(const hnbrdf_measured *measured);
HNBRDF_API hnbrdf_measured_format hnbrdf_measured_format_of(const hnbrdf_measured *measured);
/* 1 if turning wi and wo together about n never changes the value. Of an RGL file: whether its tables
 * leave out the azimuth of wi altogether. */
HNBRDF_API int hnbrdf_measured_is_isotropic(const hnbrdf_measured *measured);
/* One line about what the file holds (grid sizes, valid share, negatives); for people. */
HNBRDF_API const char *hnbrdf_measured_summary(const hnbrdf_measured *measured);

/* f(wi, wo). Returns 1 if this is a valid measurement; 0 with f = 0 if it is not: below the horizon,
 * a bin that was never measured, a half vector that an RGL file calls invisible, directions that are not
 * finite. Fits and error metrics skip those. Colours outside the gamut are clipped to 0 per channel and
 * are valid. The length of the directions is divided out. */
HNBRDF_API int hnbrdf_measured_eval(const hnbrdf_measured *measured, const float wi[3],
                                    const float wo[3], float f[3]);

/* ---- Where to look: the three samplers every error figure must name ----------------------------- */

typedef enum hnbrdf_sampler {
    HNBRDF_SAMPLER_UNIFORM = 0, /* wi and wo uniform in solid angle over the hemisphere */
    HNBRDF_SAMPLER_COSINE,      /* wi and wo cosine-distributed */
    HNBRDF_SAMPLER_GRID         /* theta_h = u^2 pi/2, theta_d and phi_d uniform: MERL's own grid.
                                   phi_h uniform too, which only anisotropic data notice. */
} hnbrdf_sampler;

/* "uniform", "cosine", "grid"; NULL for any other value. */
HNBRDF_API const char *hnbrdf_sampler_name(hnbrdf_sampler sampler);

/* PCG32 (O'Neill 2014); any state is valid, the lowest bit of the stream counts as set. */
typedef struct hnbrdf_rng {
    uint64_t state, stream;
} hnbrdf_rng;

/* Different (seed, sequence) pairs give independent streams; the top bit of sequence is not used. */
HNBRDF_API void hnbrdf_rng_seed(hnbrdf_rng *rng, uint64_t seed, uint64_t sequence);
HNBRDF_API uint32_t hnbrdf_rng_u32(hnbrdf_rng *rng);
/* (u32 >> 8) * 2^-24, in [0, 1). */
HNBRDF_API float hnbrdf_rng_float(hnbrdf_rng *rng);

/* Draw one pair of unit vectors with wi.z >= 0.01 and wo.z >= 0.01. */
HNBRDF_API void hnbrdf_sampler_draw(hnbrdf_sampler sampler, hnbrdf_rng *rng, float wi[3], float wo[3]);

#ifdef __cplusplus
}
#endif

#endif
