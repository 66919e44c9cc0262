/* measured.h: measured and procedural BRDFs behind one interface (libhnbrdf_measured).
 *
 * Convention, units and errors are those of hnbrdf.h: wi towards the light, wo towards the viewer,
 * both away from the surface; f in 1/sr without the cosine, linear RGB, never NaN, and never
 * negative unless rgl_signed asks for it.
 *
 * Formats: MERL .binary (Matusik et al. 2003; also with phi_d over the full circle, 90 90 360,
 * where f(wi, wo) = f(wo, wi) but for rounding in single precision), RGL .bsdf, isotropic and
 * anisotropic, RGB and spectral (Dupuy and Jakob 2018), UTIA .bin (Filip and Vavra 2014; the set of
 * 150 anisotropic materials, not the dense one of 1.5 GB a file), networks of Neural-BRDF
 * (Sztrajman et al. 2021; .h5 as published with the part of hdf5.h, and the six .npy of its own
 * renderer), and built-in procedural materials. A file is recognised by its content; a UTIA file,
 * which has no header, by its size.
 */
#ifndef HNBRDF_MEASURED_H
#define HNBRDF_MEASURED_H

#include "hnbrdf/hnbrdf.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Where the values come from. */
typedef enum hnbrdf_measured_format {
    HNBRDF_MEASURED_BUILTIN = 0,
    HNBRDF_MEASURED_MERL,
    HNBRDF_MEASURED_RGL,
    HNBRDF_MEASURED_UTIA,
    HNBRDF_MEASURED_CUSTOM,
    HNBRDF_MEASURED_NBRDF
} hnbrdf_measured_format;

/* "builtin", "MERL", "RGL", "UTIA", "custom", "NBRDF"; NULL for any other value. So do the other
 * functions that name a value of an enum here: its word, and NULL for a value that is none. */
HNBRDF_API const char *hnbrdf_measured_format_name(hnbrdf_measured_format format);

/* One measured material. Immutable after opening, may be shared between threads. */
typedef struct hnbrdf_measured hnbrdf_measured;

/* Which bins of a MERL file give a value. */
typedef enum hnbrdf_merl_lookup {
    HNBRDF_MERL_NEAREST = 0, /* the bin that holds the directions, as the database's own code */
    HNBRDF_MERL_TRILINEAR    /* between 8 bins; those without a measurement are left out */
} hnbrdf_merl_lookup;

/* "nearest", "trilinear" */
HNBRDF_API const char *hnbrdf_merl_lookup_name(hnbrdf_merl_lookup lookup);

/* Where in its bin a sample counts as taken, for the trilinear lookup. No source settles it; the
 * choice moves theta_h by half a bin (21 % at 0.3, 5 % at 4.4 degrees), enough to bias a fitted
 * roughness. */
typedef enum hnbrdf_merl_node {
    HNBRDF_MERL_CENTRE = 0,
    HNBRDF_MERL_EDGE /* the lower edge in all three angles */
} hnbrdf_merl_node;

/* "centre", "edge" */
HNBRDF_API const char *hnbrdf_merl_node_name(hnbrdf_merl_node node);

/* What the numbers of a UTIA file mean. Public readers disagree, so the absolute scale of UTIA
 * data is uncertain. v: a sample; f is never negative. */
typedef enum hnbrdf_utia_mode {
    /* f = 100 decode(max(v, 0) / 140), decoded after interpolation (J. Dupuy's dj_brdf, which
     * credits the data's author): v > 0.0375 ? ((v+0.055)/1.055)^2.4 : v/12.92 */
    HNBRDF_UTIA_DJB = 0,
    HNBRDF_UTIA_RAW, /* f = v */
    HNBRDF_UTIA_SRGB /* f = v through the inverse sRGB curve, sample by sample */
} hnbrdf_utia_mode;

/* "djb", "raw", "srgb" */
HNBRDF_API const char *hnbrdf_utia_mode_name(hnbrdf_utia_mode mode);

/* What read_hdf5 below fills in; only the library looks inside. */
typedef struct hnbrdf_hdf5_arrays hnbrdf_hdf5_arrays;

/* Zero-initialise for defaults. A value outside its range is HNBRDF_ERROR_ARGUMENT on opening. */
typedef struct hnbrdf_measured_options {
    /* refuse larger files; 0 stands for 1 GiB. Whatever a file claims of itself, opening takes at
     * most 20 times its size in memory (RGL as published: about 4 times) */
    size_t max_bytes;
    hnbrdf_merl_lookup merl_lookup;
    hnbrdf_merl_node merl_node;
    int merl_identify; /* 1: compare the SHA-256 of a MERL file with the published ones, see
                          hnbrdf_measured_published(); takes about 0.2 s a file */
    /* 1: keep negative colours, which lie outside the gamut, for colour transforms and for
     * export; models and fits know no negative f */
    int rgl_signed;
    /* 1: where a file has spectra, use them even if it has RGB too, and keep them for
     * hnbrdf_measured_eval_spectrum() (as much memory as the file). 0: RGB if there is, otherwise
     * spectra made RGB and dropped */
    int rgl_spectra;
    hnbrdf_utia_mode utia_mode;
    double utia_scale; /* f is multiplied by it; 0 stands for 1, negative is refused */
    /* 1: beyond the last sample at 75 degrees use its value. 0: go on linearly from the last two,
     * as all readers that descend from the author's do */
    int utia_no_extrapolate;
    /* Reads HDF5 files (NBRDF .h5): hnbrdf_hdf5_read of hdf5.h, a part of its own, so that nobody
     * links libhdf5 who does not want it. NULL: such files are refused. */
    hnbrdf_result (*read_hdf5)(const void *bytes, size_t size, const char *label,
                               hnbrdf_hdf5_arrays *arrays, hnbrdf_error *error);
} hnbrdf_measured_options;

/* Open a file; its material's name is the file's name without directory, extension and a trailing
 * "_rgb", cut to HNBRDF_MAX_NAME bytes; control characters and what is not UTF-8 become '_'. The
 * file is read whole, and never beyond the limit by more than the buffer that holds it. options
 * may be NULL. An NBRDF material in six files, NAME_fc1.npy to NAME_b3.npy, is opened by the path
 * of any of them, or by NAME where no file is called so. */
HNBRDF_API hnbrdf_result hnbrdf_measured_open(const char *path,
                                              const hnbrdf_measured_options *options,
                                              hnbrdf_measured **measured, hnbrdf_error *error);

/* The same from bytes in memory; `path` gives the name and is used in messages. The bytes are
 * copied. Not for materials in several files. */
HNBRDF_API hnbrdf_result hnbrdf_measured_open_memory(const void *data, size_t size,
                                                     const char *path,
                                                     const hnbrdf_measured_options *options,
                                                     hnbrdf_measured **measured,
                                                     hnbrdf_error *error);

/* ---- The formats, for tools that look for files and offer options ---------------------------- */

/* One option of a format: a member of hnbrdf_measured_options as a command line offers it. */
typedef struct hnbrdf_measured_option {
    const char *name; /* "merl-node" */
    const char *help; /* one line with the default */
    size_t offset;    /* of the member: an enum, a double or an int that is 0 or 1 */
    /* Of an enum: the word of each of its values, from 0 on, and NULL past the last; else NULL. */
    const char *(*word)(int value);
    /* Of a double: what 0 stands for, and the range that makes sense; else all 0. */
    double usual, low, high;
    const char *needs;  /* the option without which this one has no effect, or NULL */
    int makes_negative; /* 1: it allows negative values, which models and fits do not know */
} hnbrdf_measured_option;

/* A format as tools see it. */
typedef struct hnbrdf_measured_format_info {
    hnbrdf_measured_format format;
    const char *name;  /* as hnbrdf_measured_format_name() */
    const char *files; /* what messages call its files: "MERL .binary"; NULL: it has none */
    /* How the names of its files end (".binary"), the last NULL. NULL: it has no files. */
    const char *const *endings;
    /* The same where one material lies in several files: any of them opens all. NULL: never. */
    const char *const *part_endings;
    const hnbrdf_measured_option *options;
    int option_count;
} hnbrdf_measured_format_info;

/* The formats in the order in which files are tried, index 0 on; NULL past the last. */
HNBRDF_API const hnbrdf_measured_format_info *hnbrdf_measured_format_at(int index);
/* The format whose files end like this name, or NULL. *stem is the length of the name without its
 * ending, *part the number of the ending among part_endings, or -1 for a file that is whole; both
 * may be NULL. For looking through directories; opening goes by content. */
HNBRDF_API const hnbrdf_measured_format_info *
hnbrdf_measured_format_of_file(const char *name, size_t *stem, int *part);

/* ---- Built-in materials and your own --------------------------------------------------------- */

/* The built-in procedural materials, index 0 to hnbrdf_measured_builtin_count() - 1: formulas
 * that hold what measurements contain and one GGX lobe cannot follow. A second set has the next
 * hnbrdf_measured_builtin_anisotropic_count() indices: cloth, brushed and grooved metal, wood,
 * hair, all anisotropic. NULL name when index is out of range. */
HNBRDF_API int hnbrdf_measured_builtin_count(void);
HNBRDF_API int hnbrdf_measured_builtin_anisotropic_count(void);
HNBRDF_API const char *hnbrdf_measured_builtin_name(int index);
HNBRDF_API hnbrdf_result hnbrdf_measured_open_builtin(int index, hnbrdf_measured **measured,
                                                      hnbrdf_error *error);

/* Procedural materials without end, number 0 to HNBRDF_MAX_PROCEDURAL: random mixtures of lobes,
 * interference films, flakes, coats, fibres and diffuse parts, three of four as RGL's goniometer
 * would measure them, interpolation and all. They are what a network that shall describe unknown
 * materials is trained on besides measurements. The same on every machine, but for the last bits of
 * its mathematical functions. Opening computes tables: some milliseconds, and 1.2 MB. The name is
 * "procedural-" and the number. Isotropic. */
#define HNBRDF_MAX_PROCEDURAL 999999
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_measured_open_procedural(int number,
                                                                  hnbrdf_measured **measured,
                                                                  hnbrdf_error *error);

/* A BRDF of your own, to be fitted and compared like a measurement: a formula, another renderer's
 * table, a larger model that a smaller one shall learn from. */
typedef struct hnbrdf_measured_custom {
    const char *name; /* of the material, UTF-8, 1 to HNBRDF_MAX_NAME bytes; copied */
    /* one line for hnbrdf_measured_summary(), cut to 255 bytes; NULL: "custom"; copied */
    const char *summary;
    int isotropic; /* 1: turning wi and wo together about n never changes the value */
    /* f of unit vectors above the horizon, convention as above. Returns 1, or 0 where there is no
     * value. f is clamped to [0, HNBRDF_MAX_VALUE]; where a channel is not finite there is no
     * value. Called from several threads at once. Never NULL. */
    int (*eval)(const void *user, const float wi[3], const float wo[3], float f[3]);
    void (*release)(void *user); /* called once by hnbrdf_measured_close(); may be NULL */
    void *user;
} hnbrdf_measured_custom;

/* On failure `user` stays the caller's. */
HNBRDF_API hnbrdf_result hnbrdf_measured_create_custom(const hnbrdf_measured_custom *custom,
                                                       hnbrdf_measured **measured,
                                                       hnbrdf_error *error);

/* Free; NULL is allowed. */
HNBRDF_API void hnbrdf_measured_close(hnbrdf_measured *measured);

/* The name of the material, and the format; both as long as the material lives. */
HNBRDF_API const char *hnbrdf_measured_name(const hnbrdf_measured *measured);
HNBRDF_API hnbrdf_measured_format hnbrdf_measured_format_of(const hnbrdf_measured *measured);
/* 1 if turning wi and wo together about n never changes the value. Of an RGL file: whether its
 * tables leave out the azimuth of wi altogether. */
HNBRDF_API int hnbrdf_measured_is_isotropic(const hnbrdf_measured *measured);
/* One line about what the file holds and how it is read (grid sizes, valid share, negatives; of a
 * UTIA file also its directional albedo); for people. */
HNBRDF_API const char *hnbrdf_measured_summary(const hnbrdf_measured *measured);
/* The material of the MERL database whose published file this is, to the last bit
 * ("alum-bronze"); NULL if it is none of the 100, or was opened without merl_identify. */
HNBRDF_API const char *hnbrdf_measured_published(const hnbrdf_measured *measured);

/* The bytes that a program with this material has to store: of its file, or of an NBRDF network's
 * numbers in single precision. 0 of built-in materials and of your own. */
HNBRDF_EXPERIMENTAL size_t hnbrdf_measured_bytes(const hnbrdf_measured *measured);

/* f(wi, wo). Returns 1 if this is a valid measurement; 0 with f = 0 if it is not: below the
 * horizon, a bin that was never measured, a half vector that an RGL file calls invisible,
 * directions that are not finite. Fits and error metrics skip those. Colours outside the gamut
 * are clipped to 0 per channel (unless rgl_signed) and are valid. The length of the directions is
 * divided out. Spectra become linear sRGB by the CIE 1931 2-degree observer under D65; a flat one
 * has R = G = B. */
HNBRDF_API int hnbrdf_measured_eval(const hnbrdf_measured *measured, const float wi[3],
                                    const float wo[3], float f[3]);

/* The wavelengths in nm, increasing, of an RGL material opened with rgl_spectra; 0 if it has no
 * spectra. *nm lives as long as the material; it is untouched if there is none, and nm may be
 * NULL. */
HNBRDF_API size_t hnbrdf_measured_wavelengths(const hnbrdf_measured *measured, const float **nm);
/* f at `count` wavelengths in nm, finite, in any order: linear between those of the file, the end
 * values beyond them. Never clipped at 0: noise makes some negative. Returns as
 * hnbrdf_measured_eval(); 0 with f = 0 also if there are no spectra. */
HNBRDF_API int hnbrdf_measured_eval_spectrum(const hnbrdf_measured *measured, const float wi[3],
                                             const float wo[3], size_t count, const float *nm,
                                             float *f);

/* ---- Where to look: the three samplers every error figure must name -------------------------- */

/* How pairs of directions are drawn. */
typedef enum hnbrdf_sampler {
    HNBRDF_SAMPLER_UNIFORM = 0, /* wi and wo uniform in solid angle over the hemisphere */
    HNBRDF_SAMPLER_COSINE,      /* wi and wo cosine-distributed */
    HNBRDF_SAMPLER_GRID         /* theta_h = u^2 pi/2, theta_d and phi_d uniform: MERL's own grid.
                                   phi_h uniform too, which only anisotropic data notice. */
} hnbrdf_sampler;

/* "uniform", "cosine", "grid" */
HNBRDF_API const char *hnbrdf_sampler_name(hnbrdf_sampler sampler);

/* PCG32 (O'Neill 2014); any state is valid, the lowest bit of the stream counts as set. */
typedef struct hnbrdf_rng {
    uint64_t state, stream; /* set by hnbrdf_rng_seed() */
} hnbrdf_rng;

/* Different (seed, sequence) pairs give independent streams; the top bit of sequence is not used.
 * */
HNBRDF_API void hnbrdf_rng_seed(hnbrdf_rng *rng, uint64_t seed, uint64_t sequence);
HNBRDF_API uint32_t hnbrdf_rng_u32(hnbrdf_rng *rng);
/* (u32 >> 8) * 2^-24, in [0, 1). */
HNBRDF_API float hnbrdf_rng_float(hnbrdf_rng *rng);

/* Draw one pair of unit vectors with wi.z >= 0.01 and wo.z >= 0.01. */
HNBRDF_API void hnbrdf_sampler_draw(hnbrdf_sampler sampler, hnbrdf_rng *rng, float wi[3],
                                    float wo[3]);

#ifdef __cplusplus
}
#endif

#endif
