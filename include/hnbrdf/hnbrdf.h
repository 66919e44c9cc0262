/* hnbrdf.h: evaluate, sample, load and save hybrid neural-microfacet BRDFs.
 *
 * This one header is enough to put measured materials into a renderer. It needs libhnbrdf and
 * libm, nothing else. In the same library: export to shaders (glsl.h) and editing the materials of
 * a model (edit.h). Libraries of their own: measured data (measured.h), errors (metrics.h),
 * fitting (fit.h) and finding the smallest network for a scene (bake.h).
 *
 *   Frame       Right-handed local shading frame, surface normal n = +z, tangent +x, bitangent +y.
 *   Directions  wi points towards the light, wo towards the viewer; both are unit vectors and both
 *               point away from the surface. float[3] is (x, y, z).
 *   Value       f(wi, wo) in 1/sr for the channels R, G, B, WITHOUT the cosine: multiply by wi.z.
 *               f = 0 when wi.z <= 0 or wo.z <= 0. f is always finite and never negative.
 *   Density     pdf in 1/sr of wi given wo, with respect to solid angle.
 *   Colour      linear RGB in whatever primaries the measurement had (RGL and MERL: Rec. 709).
 *   Angles      radians.
 *
 * The model (De Oliveira et al., A Hybrid Neural-Microfacet BRDF Model for Real-Time Rendering,
 * EGSR 2026):
 *
 *   f = max(0, exp(s c + m) + sigmoid(g) f_a - b),   (c, g) = MLP(encode(wi, wo), z)
 *
 * f_a is Lambert plus GGX (Walter et al. 2007; Heitz 2014), z the latent code of the material, s, m
 * and b constants of the model. One network serves every material of a model.
 *
 * Threads: a loaded model never changes and may be shared. Every function that evaluates is pure:
 * no allocation, no I/O, no errno, no locale, no global state. No function of the library prints,
 * exits, or reads the environment.
 *
 * Options: every options struct is zero-initialised for defaults. 0 is the default of each field;
 * where 0 is a value that one may ask for, an enum or a flag named ..._none asks for it.
 *
 * Stability: versions are numbers major.minor.patch (semantic versioning, semver.org). A patch
 * changes no declaration. From 1.0 on a minor version only adds: programs that compiled and linked
 * go on doing so, but for what is marked HNBRDF_EXPERIMENTAL. Before 1.0 a minor version may change
 * the rest too; the README then says what. Bits of values, samples,
 * models and shaders change only where the README says so. Files of format "hnbrdf/1" are read
 * for ever. */
#ifndef HNBRDF_H
#define HNBRDF_H

#include <stddef.h>

/* The version of these headers. */
#define HNBRDF_VERSION_MAJOR 0
#define HNBRDF_VERSION_MINOR 2
#define HNBRDF_VERSION_PATCH 0
#define HNBRDF_VERSION_STRING "0.2.0"

/* Marks what the shared library exports. Define HNBRDF_STATIC to link the static one. */
#if defined(HNBRDF_STATIC)
#define HNBRDF_API
#elif defined(_WIN32)
#if defined(HNBRDF_BUILD)
#define HNBRDF_API __declspec(dllexport)
#else
#define HNBRDF_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define HNBRDF_API __attribute__((visibility("default")))
#else
#define HNBRDF_API
#endif

/* Marks what may still change in a minor version, see "Stability" above. */
#define HNBRDF_EXPERIMENTAL HNBRDF_API

#ifdef __cplusplus
extern "C" {
#endif

/* The version of the library that is running, as text: compare with HNBRDF_VERSION_STRING. */
HNBRDF_API const char *hnbrdf_version(void);

/* ---- Limits ---------------------------------------------------------------------------------- */

#define HNBRDF_MAX_HIDDEN 64       /* units H of a hidden layer in an HxN network */
#define HNBRDF_MAX_LAYERS 4        /* hidden layers N */
#define HNBRDF_MAX_LATENT 16       /* floats of a latent code, l */
#define HNBRDF_MAX_NAME 127        /* bytes of a material's name */
#define HNBRDF_MAX_MATERIALS 65536 /* of a model */

/* The smallest roughness. Below it the GGX peak 1/(pi alpha^2) passes 3e7 and the half vector of
 * two float directions, known to about 1e-7 rad, no longer resolves the lobe. */
#define HNBRDF_MIN_ALPHA 1e-4f
#define HNBRDF_MAX_ALPHA 1.0f /* the largest roughness */
#define HNBRDF_MAX_ETA 1e3f   /* the largest index of refraction */

/* The exponent s c + m is clamped to [-HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT] before exp(). */
#define HNBRDF_MAX_EXPONENT 80.0f
/* Every value returned is clamped to [0, HNBRDF_MAX_VALUE]; a NaN becomes 0. */
#define HNBRDF_MAX_VALUE 3.0e38f

/* ---- Results --------------------------------------------------------------------------------- */

/* Evaluate, sample and pdf cannot fail. Everything else returns one of these, 0 for success, and
 * leaves its out-parameters untouched on failure. */
typedef enum hnbrdf_result {
    HNBRDF_OK = 0,            /* done */
    HNBRDF_ERROR_ARGUMENT,    /* a parameter is out of its documented range */
    HNBRDF_ERROR_IO,          /* a file cannot be opened, read or written */
    HNBRDF_ERROR_FORMAT,      /* the bytes are not what the format asks for */
    HNBRDF_ERROR_UNSUPPORTED, /* well-formed, but outside what this version reads or writes */
    HNBRDF_ERROR_LIMIT,       /* larger than a limit */
    HNBRDF_ERROR_MEMORY,      /* an allocation failed */
    HNBRDF_ERROR_CANCELLED    /* a callback asked to stop */
} hnbrdf_result;

/* A short English phrase for a result; never NULL. */
HNBRDF_API const char *hnbrdf_strerror(hnbrdf_result result);

/* A message for a person: one line naming the file, the place, what was found and what was
 * expected, NUL-terminated, control characters made '?'. Filled on failure only. Pass NULL
 * wherever an hnbrdf_error is taken to go without. */
typedef struct hnbrdf_error {
    char text[384]; /* the line, without an end of line */
} hnbrdf_error;

/* Where a reader tells what it converted, clamped or left aside of an input that it takes all the
 * same: `note` is called once for each kind, with one line for a person like that of an
 * hnbrdf_error, which is gone after the call. All zeros: nobody is told. */
typedef struct hnbrdf_notes {
    void (*note)(void *user, const char *line); /* told a line */
    void *user;
} hnbrdf_notes;

/* ---- Materials ------------------------------------------------------------------------------- */

#define HNBRDF_LOBES 2      /* GGX lobes of a material, for sampling */
#define HNBRDF_LOBE_KNOTS 4 /* views at which the share of a lobe is given */

/* Where hnbrdf_sample() looks for light besides the cosine lobe: two GGX lobes about the mirror
 * direction, of roughness clamp(|scale| alpha) (|scale| itself in a neural model, whose alpha
 * means nothing) and in the material's tangent frame. Each gets a share of the samples that
 * depends on the view: given at wo.z = 0, 1/9, 4/9 and 1, linear in sqrt(wo.z) between; what is
 * left of 1 is cosine. The value f does not depend on them. Made by hnbrdf_lobes_fit(); an edit
 * of alpha carries them along. All zeros, as hnbrdf_material_init() has them: one lobe of
 * roughness alpha, whose share is guessed from kd and eta (none in a neural model). 40 bytes. */
typedef struct hnbrdf_lobes {
    /* > 0: visible normals (bounded, Eto and Tokuyoshi 2023); < 0: all normals, as the paper
     * draws them; 0: no such lobe. |scale| in [1e-4, 1e4] */
    float scale[HNBRDF_LOBES];
    float share[HNBRDF_LOBES][HNBRDF_LOBE_KNOTS]; /* [0, 1]; at each knot they sum to at most 1 */
} hnbrdf_lobes;

/* What kd, eta and alpha of a material were when the network was fitted to it. Where they differ
 * from what they are, the material is edited: the network's correction is carried along with f_a,
 * as src/core/carry.h says. All zeros: they were what they are. hnbrdf_model_create() fills that in
 * in a hybrid model, so that whoever copies a material of a model and changes its kd, eta or alpha
 * edits the whole of it, and whoever changes them back has the fitted bits again. Other kinds of
 * model do not look at it. 32 bytes. */
typedef struct hnbrdf_fitted {
    float kd[3], eta[3], alpha[2]; /* all 0, or each in the range of its namesake */
} hnbrdf_fitted;

/* What keeps a material from giving off more light than it gets: f is multiplied by k(wi.z)
 * k(wo.z), k(z) = min(1, horizon + slope z), which is reciprocal, at most 1, and 1 but near the
 * horizon. Made by hnbrdf_energy_fit() (metrics.h) from the albedo of the material as it is: an
 * edit of the material leaves it as it is, so make it again. The analytic part alone,
 * hnbrdf_eval_analytic(), is without it. Both 0: f as it is. 8 bytes. */
typedef struct hnbrdf_energy {
    float horizon; /* k at the horizon, [0, 1] */
    float slope;   /* [0, 1e4] */
} hnbrdf_energy;

/* One material. Plain data that the caller owns, copies and edits; 45 floats.
 * Evaluation trusts these ranges: call hnbrdf_material_check() after an edit. Out of range it still
 * returns finite values, without a promise which. */
typedef struct hnbrdf_material {
    float kd[3];    /* diffuse albedo per channel, [0, 1] */
    float eta[3];   /* index of refraction per channel, (1, HNBRDF_MAX_ETA] */
    float alpha[2]; /* GGX roughness along x and y, [HNBRDF_MIN_ALPHA, 1]; equal when isotropic */
    float rotation; /* of the tangent frame about n, radians counter-clockwise; finite */
    float latent[HNBRDF_MAX_LATENT]; /* latent code z; the model uses the first l floats */
    hnbrdf_lobes lobes;              /* for sampling alone */
    hnbrdf_fitted fitted;            /* an edit leaves it as it is */
    hnbrdf_energy energy;
} hnbrdf_material;

/* kd 0.5, eta 1.5, alpha 0.5, no rotation, latent 0, lobes 0, fitted 0, energy 0. */
HNBRDF_API void hnbrdf_material_init(hnbrdf_material *material);

/* HNBRDF_OK if every field is finite and in its range; else HNBRDF_ERROR_ARGUMENT and a message
 * naming the first field that is not. */
HNBRDF_API hnbrdf_result hnbrdf_material_check(const hnbrdf_material *material,
                                               hnbrdf_error *error);

/* 1 if kd, eta or alpha are not what they were fitted with, 0 where that is unknown. */
HNBRDF_API int hnbrdf_material_is_edited(const hnbrdf_material *material);

/* The material between a and b: at t <= 0 (or NaN) *a and at t >= 1 *b, bit by bit. Each kd, the
 * latent code and the reflectance at normal incidence ((eta - 1)/(eta + 1))^2 go linearly: eta
 * itself would turn to metal within the first steps. alpha goes linearly in its logarithm;
 * rotation the short way modulo pi, a half turn being the same GGX lobe, and all at once where
 * one end is isotropic and has none to speak of. Lobes go like alpha, their shares linearly;
 * where only one end has such a lobe, all are 0: fit them again. fitted goes like kd, eta and
 * alpha, an end without it counting as unedited. energy goes linearly, an end without it counting
 * as k = 1: make it again where it matters. Every field stays between its two ends, so two
 * legal materials give a legal one. out may be a or b. Cheap, but straight through the latent
 * space: hnbrdf_mix_path_fit() in edit.h goes around what looks like neither end. */
HNBRDF_API void hnbrdf_material_mix(const hnbrdf_material *a, const hnbrdf_material *b, float t,
                                    hnbrdf_material *out);

/* ---- Models ---------------------------------------------------------------------------------- */

/* What f is made of. */
typedef enum hnbrdf_kind {
    /* f = max(0, exp(s c + m) + sigmoid(g) f_a - b), 6 network outputs c, g */
    HNBRDF_KIND_HYBRID = 0,
    /* f = max(0, exp(s c + m) - b), 3 network outputs (Zeltner et al. 2024) */
    HNBRDF_KIND_NEURAL,
    HNBRDF_KIND_GGX /* f = f_a, no network */
} hnbrdf_kind;

/* What the network sees of a pair of directions: six numbers. th is the angle between n and the
 * half vector h, td that between h and wi. All but the first and the third are unchanged to the
 * last bit when wi and wo swap: reciprocal by construction. */
typedef enum hnbrdf_encoding {
    HNBRDF_ENCODING_DIRECTIONS = 0,  /* wi, wo: the paper's; not reciprocal */
    HNBRDF_ENCODING_HALF_DIFFERENCE, /* functions of th, td, wi.z wo.z and wi.z + wo.z */
    /* functions of th and td, then wi.z, wo.z; not reciprocal: for measurements that are not */
    HNBRDF_ENCODING_ANGLES_DIRECTED,
    HNBRDF_ENCODING_ANGLES, /* the same with the smaller and the larger of wi.z, wo.z */
    /* with |h.x|, |h.y|: sees the azimuth of h, mirror-symmetric */
    HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
    /* with |h.x| and |wi.x - wo.x|: sees the azimuths of h and of wi - wo, mirror-symmetric */
    HNBRDF_ENCODING_ANGLES_AZIMUTHS
} hnbrdf_encoding;

/* "hybrid", "neural", "ggx"; "directions", "half-difference", "angles-directed", "angles",
 * "angles-anisotropic", "angles-azimuths"; NULL for any other value. */
HNBRDF_API const char *hnbrdf_kind_name(hnbrdf_kind kind);
HNBRDF_API const char *hnbrdf_encoding_name(hnbrdf_encoding encoding);
/* The way back: 1 and *kind or *encoding, or 0 for any other name, *kind and *encoding untouched.
 * */
HNBRDF_API int hnbrdf_kind_from_name(const char *name, hnbrdf_kind *kind);
HNBRDF_API int hnbrdf_encoding_from_name(const char *name, hnbrdf_encoding *encoding);
/* 1 if swapping wi and wo changes no bit of what the network sees. */
HNBRDF_API int hnbrdf_encoding_is_reciprocal(hnbrdf_encoding encoding);
/* 1 if turning both directions about the normal changes what the network sees. */
HNBRDF_API int hnbrdf_encoding_sees_azimuth(hnbrdf_encoding encoding);

/* Which instructions evaluation uses. All but the fused ones give the same bits; only the time
 * differs. Chosen once, when a model is made: HNBRDF_VARIANT_AUTO takes the fastest exact one that
 * this machine runs.
 *
 * The fused ones round a product together with the sum that it goes into. That is half of the
 * instructions of a network, where the processor starts as many fused operations as others, and no
 * larger an error; but the values differ by rounding from those of all other variants and of
 * shaders, and between the calls for one pair, for batches and for many materials. A bound is
 * derived for every pair of directions, and tested. They are used where they are asked for, never
 * by AUTO. */
typedef enum hnbrdf_variant {
    HNBRDF_VARIANT_AUTO = 0,
    HNBRDF_VARIANT_PLAIN, /* portable C, the reference; always there */
    HNBRDF_VARIANT_SSE2,
    HNBRDF_VARIANT_AVX2,
    HNBRDF_VARIANT_AVX512,     /* F, DQ and VL */
    HNBRDF_VARIANT_NEON,       /* 64-bit Arm */
    HNBRDF_VARIANT_AVX2_FUSED, /* AVX2 and FMA */
    HNBRDF_VARIANT_AVX512_FUSED,
    HNBRDF_VARIANT_NEON_FUSED
} hnbrdf_variant;

/* "auto", "plain", "sse2", "avx2", "avx512", "neon", "avx2-fused", "avx512-fused", "neon-fused";
 * NULL for any other value. */
HNBRDF_API const char *hnbrdf_variant_name(hnbrdf_variant variant);
/* The way back: 1 and *variant, or 0 for any other name, *variant untouched. */
HNBRDF_API int hnbrdf_variant_from_name(const char *name, hnbrdf_variant *variant);
/* 1 if this build holds the variant and this machine runs it (HNBRDF_VARIANT_AUTO: always), else
 * 0. */
HNBRDF_API int hnbrdf_variant_available(hnbrdf_variant variant);
/* 1 for variants that all give the same bits; 0 for the fused ones and any other value. */
HNBRDF_API int hnbrdf_variant_is_exact(hnbrdf_variant variant);

/* An immutable network with its materials. */
typedef struct hnbrdf_model hnbrdf_model;

/* Everything a model holds, as plain data: to build one, or to look into one. */
typedef struct hnbrdf_model_desc {
    hnbrdf_kind kind;
    hnbrdf_encoding encoding; /* unused for HNBRDF_KIND_GGX */
    int hidden;               /* H in HxN; 0 for ggx */
    int layers;               /* N in HxN; 0 for ggx */
    int latent;               /* l; 0 for ggx */
    float scale;              /* s; 0 stands for 1 */
    float shift;              /* m */
    float floor;              /* b, >= 0 */
    /* layers + 1 matrices and biases. weights[k] is [out][in], row-major: in = 6 + l for k = 0 (the
     * encoded directions in order, then the latent code), else hidden; out = hidden, for the last
     * one 6 (hybrid: c then g) or 3 (neural). biases[k] is [out]. All finite. */
    const float *weights[HNBRDF_MAX_LAYERS + 1];
    const float *biases[HNBRDF_MAX_LAYERS + 1]; /* see weights */
    int material_count;                         /* >= 1 */
    const hnbrdf_material *materials; /* [material_count], each passes hnbrdf_material_check() */
    /* [material_count], UTF-8, unique, 1 to HNBRDF_MAX_NAME bytes, no control characters */
    const char *const *names;
    /* asked for; from hnbrdf_model_describe() the one in use, never AUTO. It belongs to the
     * process: model files do not hold it */
    hnbrdf_variant variant;
} hnbrdf_model_desc;

/* Memory for a model. Both functions or neither; zero means malloc and free. */
typedef struct hnbrdf_allocator {
    void *(*allocate)(void *user, size_t size); /* as malloc(): NULL where there is none */
    void (*release)(void *user, void *pointer); /* as free(); NULL is allowed */
    void *user;
} hnbrdf_allocator;

/* Where a model's bytes come from when they are not a file: fill buffer with up to size bytes and
 * return how many, 0 at the end, (size_t)-1 on failure. */
typedef size_t (*hnbrdf_read_fn)(void *user, void *buffer, size_t size);
/* Where bytes go: return 0 on success, anything else to stop with HNBRDF_ERROR_IO. */
typedef int (*hnbrdf_write_fn)(void *user, const void *data, size_t size);

/* Zero-initialise for defaults. */
typedef struct hnbrdf_load_options {
    hnbrdf_allocator allocator;
    /* refuse larger input; 0 stands for 256 MiB. Whatever a file claims of itself, no block asked
     * for while loading is larger than 24 times the input and 200000 bytes */
    size_t max_bytes;
    hnbrdf_read_fn read; /* if set, bytes come from here and `path` is only a name for messages */
    void *read_user;
    hnbrdf_variant variant;
    hnbrdf_notes notes; /* told of tensors that were converted */
} hnbrdf_load_options;

/* Build a model from a description; everything is checked and copied. allocator may be NULL. A
 * variant that is not available here is HNBRDF_ERROR_UNSUPPORTED. */
HNBRDF_API hnbrdf_result hnbrdf_model_create(const hnbrdf_model_desc *desc,
                                             const hnbrdf_allocator *allocator,
                                             hnbrdf_model **model, hnbrdf_error *error);

/* Read a model file (safetensors with hnbrdf metadata, see src/README.md, "Model files"). options
 * may be NULL. A file is read whole, every size is checked against the bytes that are there.
 * Tensors of type F16, BF16 or F64 become float, rounded to nearest; one that is beyond the range
 * of float is refused, and so is every other type. */
HNBRDF_API hnbrdf_result hnbrdf_model_load(const char *path, const hnbrdf_load_options *options,
                                           hnbrdf_model **model, hnbrdf_error *error);
HNBRDF_API hnbrdf_result hnbrdf_model_load_memory(const void *data, size_t size,
                                                  const hnbrdf_load_options *options,
                                                  hnbrdf_model **model, hnbrdf_error *error);

/* Write a model file. It is written aside, as PATH.hnbrdf-part, and renamed: an old file stays
 * whole until the new one is complete, whenever the process ends, and keeps its mode and owner; of
 * a symbolic link the file it names is replaced. A pipe or device is written as it is. Identical
 * models give identical bytes. */
HNBRDF_API hnbrdf_result hnbrdf_model_save(const hnbrdf_model *model, const char *path,
                                           hnbrdf_error *error);
HNBRDF_API hnbrdf_result hnbrdf_model_write(const hnbrdf_model *model, hnbrdf_write_fn write,
                                            void *user, hnbrdf_error *error);

/* Zero-initialise for defaults. */
typedef struct hnbrdf_import_options {
    hnbrdf_allocator allocator;
    hnbrdf_notes notes;       /* told of values that were moved into their range */
    const char *const *files; /* [count], what messages call the texts; NULL: their names */
} hnbrdf_import_options;

/* Import published BRDF-Explorer .brdf shaders of this method: every text carries one material and
 * the same network, which is checked. names[i] becomes the material's name. 1 to
 * HNBRDF_MAX_MATERIALS texts of any size; memory depends on their number alone. options may be
 * NULL. A diffuse colour or an alpha above 1 by at most 0.01 becomes 1, an alpha below
 * HNBRDF_MIN_ALPHA becomes that, an eta of 1 the next float above. Files that hnbrdf wrote
 * (HNBRDF_LANGUAGE_BRDF in glsl.h) say in their heading what the published ones all are: the kind,
 * the encoding, s, m, b, what the material was fitted with, its lobes. */
HNBRDF_API hnbrdf_result hnbrdf_model_import_brdf(const char *const *texts, const size_t *sizes,
                                                  const char *const *names, int count,
                                                  const hnbrdf_import_options *options,
                                                  hnbrdf_model **model, hnbrdf_error *error);

/* The material that the file of a published shader stands for, into name[size], cut to fit: the
 * file's name without folder and ending and, where it begins like Ours_ld4_32x2_ with any numbers,
 * without that and a last _rgb. So measurements of that material have the same name. Returns 1 in
 * the second case, else 0. */
HNBRDF_EXPERIMENTAL int hnbrdf_import_name(const char *path, char *name, size_t size);

/* Free a model; NULL is allowed. */
HNBRDF_API void hnbrdf_model_free(hnbrdf_model *model);

/* Look into a model. The pointers live as long as the model. */
HNBRDF_API void hnbrdf_model_describe(const hnbrdf_model *model, hnbrdf_model_desc *desc);
HNBRDF_API int hnbrdf_model_material_count(const hnbrdf_model *model);
/* Index of a material by name, or -1. */
HNBRDF_API int hnbrdf_model_find(const hnbrdf_model *model, const char *name);
/* NULL when index is outside [0, count). */
HNBRDF_API const hnbrdf_material *hnbrdf_model_material(const hnbrdf_model *model, int index);
HNBRDF_API const char *hnbrdf_model_material_name(const hnbrdf_model *model, int index);
/* Numbers shared by all materials: weights and biases. */
HNBRDF_API size_t hnbrdf_model_weight_count(const hnbrdf_model *model);
/* Multiplications the network needs for one evaluation. */
HNBRDF_API size_t hnbrdf_model_multiplications(const hnbrdf_model *model);

/* ---- Evaluation ------------------------------------------------------------------------------
 * material need not belong to the model: any edited or interpolated copy will do.
 *
 * Edges: wi.z <= 0 or wo.z <= 0 (or a NaN there) gives 0. wi = -wo cannot happen above the horizon.
 * Directions that are not unit length give the value of the formulas as they stand (c = |wi +
 * wo|/2 for wi.h), as long as squares of their lengths are floats, clamped to [0,
 * HNBRDF_MAX_VALUE]; a subnormal wi.z or wo.z is below the horizon where the caller or the device
 * flushes those; NaN or infinity in any argument gives a finite value, 0 where undefined.
 * Swapping wi and wo gives the same bits if the encoding is reciprocal
 * (hnbrdf_encoding_is_reciprocal()) or there is no network. */

/* f(wi, wo) without the cosine. */
HNBRDF_API void hnbrdf_eval(const hnbrdf_model *model, const hnbrdf_material *material,
                            const float wi[3], const float wo[3], float f[3]);

/* f_a alone: Lambert + GGX with the material's kd, eta and alpha. The cheapest level of detail.
 * For a neural model, which has none, it is 0. */
HNBRDF_API void hnbrdf_eval_analytic(const hnbrdf_model *model, const hnbrdf_material *material,
                                     const float wi[3], const float wo[3], float f[3]);

/* Batches: wi, wo and f point to the first of count float[3]; strides are in bytes from one to
 * the next, a multiple of sizeof(float), 0 stands for 3 * sizeof(float). f must not overlap what
 * is read. Each value has the bits that the call for a single pair gives. Side by side, 16 pairs
 * at a time: several times faster than pair by pair; best with some hundred pairs a call. */

/* count evaluations of one material. */
HNBRDF_API void hnbrdf_eval_batch(const hnbrdf_model *model, const hnbrdf_material *material,
                                  size_t count, const float *wi, size_t wi_stride, const float *wo,
                                  size_t wo_stride, float *f, size_t f_stride);

/* count evaluations, each of a material of its own: pair k has materials[index[k]], or
 * materials[k] where index is NULL. Fastest where neighbours share a material, but needs no
 * order. */
HNBRDF_API void hnbrdf_eval_many(const hnbrdf_model *model, const hnbrdf_material *materials,
                                 const int *index, size_t count, const float *wi, size_t wi_stride,
                                 const float *wo, size_t wo_stride, float *f, size_t f_stride);

/* count values of hnbrdf_eval_analytic(). */
HNBRDF_API void hnbrdf_eval_analytic_batch(const hnbrdf_model *model,
                                           const hnbrdf_material *material, size_t count,
                                           const float *wi, size_t wi_stride, const float *wo,
                                           size_t wo_stride, float *f, size_t f_stride);

/* ---- Sampling --------------------------------------------------------------------------------
 * A mixture of a cosine lobe and the two GGX lobes of material->lobes: visible normals (Heitz
 * 2018; spherical caps of Dupuy and Benyoub 2023, bounded after Eto and Tokuyoshi 2023).
 * hnbrdf_sample() and hnbrdf_pdf() share one density function and agree to the last bit. */

/* A direction drawn by hnbrdf_sample(). */
typedef struct hnbrdf_sample_result {
    float wi[3];     /* unit direction towards the light, wi.z > 0; (0, 0, 1) when pdf is 0 */
    float pdf;       /* 1/sr; 0 means: no direction, weight is 0 */
    float weight[3]; /* f wi.z / pdf per channel, finite, >= 0 */
} hnbrdf_sample_result;

/* Draw wi given wo. u is two numbers in [0, 1): make them as (u32 >> 8) * 2^-24. u[0] chooses a
 * lobe, and what is left of it becomes the azimuth: pairs that are stratified (Sobol and the
 * like) stay so in every lobe. A lobe has a share of at least 1/64 where it has any that was
 * fitted, so 18 bits or more are left for the azimuth. Numbers outside [0, 1) and NaN count as
 * the nearest that is inside, NaN as 0. */
HNBRDF_API void hnbrdf_sample(const hnbrdf_model *model, const hnbrdf_material *material,
                              const float wo[3], const float u[2], hnbrdf_sample_result *result);

/* Density with which hnbrdf_sample() draws wi given wo; 0 below the horizon. Integrates to at
 * most 1 (GGX reflections that would go below the horizon are rejected). */
HNBRDF_API float hnbrdf_pdf(const hnbrdf_model *model, const hnbrdf_material *material,
                            const float wi[3], const float wo[3]);

/* The lobes with which samples of this material have the least variance under even light:
 * roughnesses and shares that minimise the sum over views of the integral of (f wi.z)^2 / pdf,
 * each view against its albedo. No share is under 1/64, so that no weight exceeds 64 pi f. A
 * material that is black everywhere gets none: all zeros. Always the same lobes for the same
 * material; some tens of milliseconds. Memory comes from the model's allocator. */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_lobes_fit(const hnbrdf_model *model,
                                                   const hnbrdf_material *material,
                                                   hnbrdf_lobes *lobes, hnbrdf_error *error);
/* The paper's scheme, to compare with: half of the samples cosine, half GGX with normals drawn
 * from D, all of them and not only the visible ones; the density is that of the mixture
 * (one-sample MIS, balance heuristic). */
HNBRDF_EXPERIMENTAL void hnbrdf_lobes_paper(hnbrdf_lobes *lobes);

/* ---- Prepared materials ----------------------------------------------------------------------
 * For renderers that shade one hit at a time: what depends on the material alone is worked out
 * once. The functions below give the bits of their namesakes above, and are as pure. */

/* Of an edited material: what it was fitted with, as hnbrdf_prepared has what it is. */
typedef struct hnbrdf_prepared_edit {
    float warp[2];                          /* fitted alpha over alpha */
    float alpha[2], area, diffuse[4], e[4]; /* as in hnbrdf_prepared */
    float carried[4], added[4]; /* of kd / pi: what carries the correction along, and the rest */
} hnbrdf_prepared_edit;

/* Plain data that the caller owns; copy it freely. It holds what it needs of the material, and
 * stays valid as long as the model. The fields are the library's business and may change. */
typedef struct hnbrdf_prepared {
    const hnbrdf_model *model;
    float cosine, sine;                /* of the rotation */
    float alpha[2];                    /* of f_a */
    float area;                        /* pi alpha_x alpha_y */
    float lobe_alpha[HNBRDF_LOBES][2]; /* of the lobes for sampling */
    float lobe_area[HNBRDF_LOBES];     /* pi times their product */
    hnbrdf_lobes lobes;                /* never unfitted here */
    float diffuse[4];                  /* kd / pi; [3] repeats [2] */
    float e[4];                        /* eta^2 - 1; [3] repeats [2] */
    float first[HNBRDF_MAX_HIDDEN];    /* bias of the first layer with the latent code folded in */
    int edited;                        /* 1: `edit` is set, and wanted */
    hnbrdf_prepared_edit edit;
    int conserved; /* 1: f is multiplied by what `energy` says */
    hnbrdf_energy energy;
} hnbrdf_prepared;

/* Works out what depends on the material alone; material need not belong to the model. */
HNBRDF_API void hnbrdf_prepare(const hnbrdf_model *model, const hnbrdf_material *material,
                               hnbrdf_prepared *prepared);

/* The namesakes of hnbrdf_eval(), hnbrdf_sample() and hnbrdf_pdf(). */
HNBRDF_API void hnbrdf_prepared_eval(const hnbrdf_prepared *prepared, const float wi[3],
                                     const float wo[3], float f[3]);
HNBRDF_API void hnbrdf_prepared_sample(const hnbrdf_prepared *prepared, const float wo[3],
                                       const float u[2], hnbrdf_sample_result *result);
/* hnbrdf_prepared_sample() without the weight, for renderers that evaluate in batches: wi and the
 * pdf, which is returned; 0 with wi = (0, 0, 1) where there is no direction. */
HNBRDF_API float hnbrdf_prepared_draw(const hnbrdf_prepared *prepared, const float wo[3],
                                      const float u[2], float wi[3]);
HNBRDF_API float hnbrdf_prepared_pdf(const hnbrdf_prepared *prepared, const float wi[3],
                                     const float wo[3]);

/* Batches of a prepared material, for renderers that work in waves. Strides are in bytes, a
 * multiple of sizeof(float); 0 stands for items that follow each other without gaps: float[3]
 * directions, float[2] random numbers, float densities, hnbrdf_sample_result. What is written must
 * not overlap what is read. Each item has the bits of the single call. */
HNBRDF_API void hnbrdf_prepared_eval_batch(const hnbrdf_prepared *prepared, size_t count,
                                           const float *wi, size_t wi_stride, const float *wo,
                                           size_t wo_stride, float *f, size_t f_stride);
HNBRDF_API void hnbrdf_prepared_sample_batch(const hnbrdf_prepared *prepared, size_t count,
                                             const float *wo, size_t wo_stride, const float *u,
                                             size_t u_stride, hnbrdf_sample_result *results,
                                             size_t result_stride);
HNBRDF_API void hnbrdf_prepared_pdf_batch(const hnbrdf_prepared *prepared, size_t count,
                                          const float *wi, size_t wi_stride, const float *wo,
                                          size_t wo_stride, float *pdf, size_t pdf_stride);

/* The same with a material for each item, as hnbrdf_eval_many() has it: materials[index[k]], or
 * materials[k] where index is NULL. */
HNBRDF_API void hnbrdf_sample_many(const hnbrdf_model *model, const hnbrdf_material *materials,
                                   const int *index, size_t count, const float *wo,
                                   size_t wo_stride, const float *u, size_t u_stride,
                                   hnbrdf_sample_result *results, size_t result_stride);
HNBRDF_API void hnbrdf_pdf_many(const hnbrdf_model *model, const hnbrdf_material *materials,
                                const int *index, size_t count, const float *wi, size_t wi_stride,
                                const float *wo, size_t wo_stride, float *pdf, size_t pdf_stride);

/* ---- Materials in textures -------------------------------------------------------------------
 * For scenes with a material of its own in every pixel: a material as a few RGBA texels, which
 * the caller keeps in as many textures (or layers) and samples as he likes. C packs; C or the
 * exported shader unpacks to the same material.
 *
 * Channels follow each other through the texels without gaps: kd (3), eta (3), alpha (1, or 2 if
 * anisotropic), rotation (2, if rotated), fitted kd, eta and alpha (if edited: as before), latent
 * (l), lobes (10, if stored: both scales, then the four shares of each), energy (2, if stored). An
 * isotropic material with l = 4 takes 11 channels: 3 texels; everything there is takes it to 9.
 * Numbers outside of a field's range are clamped to it.
 *
 *               RGBA16F                             RGBA8 (UNORM, linear, never sRGB)
 *   stored      the number itself                   its place in the range of the field
 *   kd          kd, within 2^-12                    sqrt(kd), within w/510
 *   eta         r = (eta - 1)/(eta + 1),            sqrt(r), within w/510
 *               relative 2^-11
 *   alpha       alpha, relative 2^-11               ln(alpha), within w/510
 *   rotation    (cos, sin), 3.5e-4 rad              (cos, sin), 5.6e-3 rad
 *   latent      the number, relative 2^-11          the number, within w/510
 *   lobes       v = s/(1 + |s|), within 2^-12       v, within 1/254
 *     shares    the share, within 2^-12             the share, within 1/510
 *   energy      horizon, within 2^-12               horizon, within 1/510
 *     slope     slope, relative 2^-11               sqrt(slope), within 1/32, slope at most 256
 *
 * w is the width of the range along the curve, r^2 the reflectance at normal incidence. r is kept
 * in [1e-4, 0.998]: eta from 1.0002 to 999. Scales s of lobes reach 499 and 126. Beside what is
 * stated stands the rounding of float, 1e-6 relative; half floats below 2^-14 are within 2^-25. The
 * curves of RGBA8 are those that cost the fitted model in examples/models least. Linear filtering
 * of either gives a legal material, near hnbrdf_material_mix(). */
/* How channels are stored. */
typedef enum hnbrdf_texel_format {
    HNBRDF_TEXEL_RGBA16F = 0, /* 8 bytes a texel, IEEE half floats of the machine's byte order */
    HNBRDF_TEXEL_RGBA8        /* 4 bytes a texel */
} hnbrdf_texel_format;

/* Of one material: 3 + 3 + 2 + 2 + 8 + HNBRDF_MAX_LATENT + 10 + 2 channels. */
#define HNBRDF_MAX_TEXELS 12

/* Which fields of a material are stored, and how. */
typedef struct hnbrdf_packing {
    hnbrdf_texel_format format;
    int analytic;    /* 1: kd, eta and alpha are stored; 0 for a neural model */
    int anisotropic; /* 1: alpha_x and alpha_y; 0: one for both, alpha_x */
    int rotated;     /* 1: rotation is stored */
    int edited;      /* 1: fitted is stored; one of a material that has none is what it is */
    int latent;      /* l numbers of the latent code */
    /* Smallest and largest of each field, equal where all are. RGBA16F needs and looks at none. */
    float kd[2], eta[2], alpha[2], latent_range[HNBRDF_MAX_LATENT][2];
    int lobes;  /* 1: what is sampled is stored, guessed lobes too; 0: what comes back has none */
    int energy; /* 1: energy is stored; k = 1 of one that has none */
} hnbrdf_packing;

/* What these materials of the model need (NULL: all): fields, and ranges that just hold them; no
 * lobes. Widen the ranges for materials that are yet to be drawn, and set anisotropic, rotated,
 * edited and lobes for a layout that does not depend on the materials. */
HNBRDF_API hnbrdf_result hnbrdf_packing_init(const hnbrdf_model *model, const int *materials,
                                             int material_count, hnbrdf_texel_format format,
                                             hnbrdf_packing *packing, hnbrdf_error *error);
/* HNBRDF_OK if something is stored and every range is in order and legal, as the functions below
 * trust. */
HNBRDF_API hnbrdf_result hnbrdf_packing_check(const hnbrdf_packing *packing, hnbrdf_error *error);

/* Texels of one material, 1 to HNBRDF_MAX_TEXELS; bytes of one texel. */
HNBRDF_API int hnbrdf_packing_texels(const hnbrdf_packing *packing);
HNBRDF_API size_t hnbrdf_texel_bytes(hnbrdf_texel_format format);

/* texels: hnbrdf_packing_texels() times hnbrdf_texel_bytes() bytes, any alignment. What a
 * material does not store comes back as hnbrdf_material_init() has it. Whatever bits texels hold,
 * what comes back passes hnbrdf_material_check(). */
HNBRDF_API void hnbrdf_material_pack(const hnbrdf_packing *packing, const hnbrdf_material *material,
                                     void *texels);
HNBRDF_API void hnbrdf_material_unpack(const hnbrdf_packing *packing, const void *texels,
                                       hnbrdf_material *material);
/* The same from what a texture's sampler returns, filtered or not: channels is [4 * texels]. */
HNBRDF_API void hnbrdf_material_unpack_channels(const hnbrdf_packing *packing,
                                                const float *channels, hnbrdf_material *material);

#ifdef __cplusplus
}
#endif

#endif
