/* glsl.h: write a model's network and materials as a shader include. Part of libhnbrdf.
 *
 * The include works together with shaders/hybrid_brdf.glsl, which holds the functions that do not
 * depend on the model. Both are GLSL for Vulkan (450), desktop GL (330) and GL ES (300); HLSL and
 * other languages are made from these texts. examples/shaders.md tells how to use them. */
#ifndef HNBRDF_GLSL_H
#define HNBRDF_GLSL_H

#include "hnbrdf/hnbrdf.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Names in the texts: what they define begins with hnbrdf_ or HNBRDF_; locals and members have an
 * underscore or are component letters (x y z w, r g b a, s t p q), but for the members a shader
 * uses (kd, eta, alpha, rotation, latent0, ..., wi, pdf, weight). Macros of the program around may
 * have other plain names. hnbrdf_material holds numbers and vectors alone: it can be a varying in
 * GLSL ES 300 too. */

/* How a shader holds the network. The sums go in the same order in each: the same bits, where the
 * device rounds + and * correctly and HNBRDF_EXACT is 1. */
typedef enum hnbrdf_glsl_weights {
    /* literals, every unit an expression of its own: one shader a network; compilers take the
     * longer the larger it is, 64x3 many seconds */
    HNBRDF_GLSL_CONSTANTS = 0,
    /* the same literals, four units at a time as vec4 columns: less SPIR-V, as fast on llvmpipe,
     * twice as long on SwiftShader */
    HNBRDF_GLSL_COLUMNS,
    /* a uniform buffer read in loops: compiles soon whatever the size, ten times slower to run on
     * a CPU driver; one shader for every network of the same kind, encoding, hidden, layers and
     * latent, see hnbrdf_export_weights() */
    HNBRDF_GLSL_UNIFORM
} hnbrdf_glsl_weights;

/* What the hidden layers compute in. Encoding, last layer, exp, sigmoid and the analytic part are
 * in single precision either way. */
typedef enum hnbrdf_glsl_precision {
    HNBRDF_GLSL_FLOAT = 0, /* single: the values of hnbrdf_eval() */
    /* float16_t in Vulkan GLSL (the device needs shaderFloat16), mediump in GLSL ES, single
     * elsewhere or where HNBRDF_HALF_NATIVE is defined as 0. Weights are rounded to half, those
     * of hidden layers clamped to 2048, biases to 8192, and units to what the next layer can sum
     * without passing 65504: finite whatever the weights. SMAPE against measurements grew by at
     * most 0.0003 on the models tried; the tests allow 0.002. */
    HNBRDF_GLSL_HALF
} hnbrdf_glsl_precision;

/* "constants", "columns", "uniform"; "float", "half"; NULL for any other value. */
HNBRDF_EXPERIMENTAL const char *hnbrdf_glsl_weights_name(hnbrdf_glsl_weights weights);
HNBRDF_EXPERIMENTAL const char *hnbrdf_glsl_precision_name(hnbrdf_glsl_precision precision);
/* The way back: 1 and *weights or *precision, or 0 for any other name, and then it is untouched. */
HNBRDF_EXPERIMENTAL int hnbrdf_glsl_weights_from_name(const char *name,
                                                      hnbrdf_glsl_weights *weights);
HNBRDF_EXPERIMENTAL int hnbrdf_glsl_precision_from_name(const char *name,
                                                        hnbrdf_glsl_precision *precision);

/* What a shader calls; the rest is left out. Each takes what its namesake in C takes. */
typedef enum hnbrdf_glsl_only {
    HNBRDF_GLSL_EVERYTHING = 0, /* hnbrdf_eval, hnbrdf_eval_analytic, hnbrdf_sample, hnbrdf_pdf */
    HNBRDF_GLSL_EVAL,           /* hnbrdf_eval */
    HNBRDF_GLSL_EVAL_SAMPLE     /* hnbrdf_eval, hnbrdf_sample, hnbrdf_pdf */
} hnbrdf_glsl_only;

/* What the text is written in. All are made from the GLSL, so that no formula stands twice;
 * directives are resolved, and names, order and comments are those of the GLSL. */
typedef enum hnbrdf_shading_language {
    HNBRDF_LANGUAGE_GLSL = 0, /* Vulkan GLSL 450, desktop GL 330, GL ES 300 */
    HNBRDF_LANGUAGE_HLSL,     /* Shader Model 5.0 (FXC) and 6 (DXC) */
    /* Metal. What reads the uniform block has it as its last parameter, constant float4 * */
    HNBRDF_LANGUAGE_MSL,
    /* WebGPU. A function of several forms has a name for each: the first form its own, others end
     * in the types in which they differ */
    HNBRDF_LANGUAGE_WGSL,
    HNBRDF_LANGUAGE_SLANG,
    /* one material as a .brdf file of BRDF Explorer, whose sliders edit it, without a line that
     * begins with '#': such programs pass those over. hnbrdf_model_import_brdf() gives the same
     * model back. Single precision, and none of fixed, packing, library */
    HNBRDF_LANGUAGE_BRDF
} hnbrdf_shading_language;

/* "glsl", "hlsl", "msl", "wgsl", "slang", "brdf": also the ending of files; NULL for any other
 * value. */
HNBRDF_EXPERIMENTAL const char *hnbrdf_shading_language_name(hnbrdf_shading_language language);
/* The way back: 1 and *language, or 0 for any other name, and then it is untouched. */
HNBRDF_EXPERIMENTAL int hnbrdf_shading_language_from_name(const char *name,
                                                          hnbrdf_shading_language *language);
/* The style that compilers of this language take best: constants in GLSL; else columns, as FXC
 * takes many seconds for constants. */
HNBRDF_EXPERIMENTAL hnbrdf_glsl_weights
hnbrdf_shading_language_weights(hnbrdf_shading_language language);

/* Zero-initialise for defaults. */
typedef struct hnbrdf_glsl_options {
    const int *materials; /* indices of the materials to export; NULL means all */
    int material_count;   /* how many; ignored when materials is NULL */
    int standalone;       /* 1: put the text of shaders/hybrid_brdf.glsl first, so that the result
                               can be pasted as it is; 0: the includer includes that file before */
    const hnbrdf_packing *packing; /* if set: write hnbrdf_material_unpack() for materials from
                               textures too; analytic and latent are those of the model */
    hnbrdf_glsl_weights weights;
    hnbrdf_glsl_precision precision;
    /* a standalone text also leaves out of hybrid_brdf.glsl what it does not use */
    hnbrdf_glsl_only only;
    /* 1: the materials are constants that the shader does not change. What depends on the
     * material alone is worked out here, and its latent code is folded into the first layer's
     * bias (but for half precision and uniform weights): the same bits for less. hnbrdf_material
     * then has no kd and eta to edit; hnbrdf_eval_NAME(wi, wo) takes none at all, NAME as in
     * HNBRDF_MATERIAL_NAME. Not together with packing. */
    int fixed;
    /* 1: hnbrdf_material of a hybrid holds what it was fitted with, m.fitted_kd, m.fitted_eta and
     * m.fitted_alpha, which a shader leaves as they are, and one that
     * changes m.kd, m.eta or m.alpha edits the whole material, as C does. Always so where an
     * exported material is edited, or a packing says so; a fixed scene has it for those alone. 0:
     * such a change moves f_a alone */
    int editable;
    hnbrdf_shading_language language;
    /* 1: an exact build, as with HNBRDF_EXACT 1. In GLSL a standalone text or the shared part then
     * begins with that definition; elsewhere exp and log are made of exact operations in the text,
     * and arithmetic is marked `precise` where the language has that */
    int exact;
    /* 1: the shared part alone, what hybrid_brdf.glsl is in GLSL; texts that are not standalone
     * need it before them. The model may be NULL; of the options language and exact matter */
    int library;
    /* NULL: hnbrdf. Any other name takes the place of hnbrdf, in capitals of HNBRDF, in all names
     * that the text defines, so that many texts can stand in one shader: NAME_eval,
     * NAME_scene_material, struct NAME_material, NAME_MATERIAL_GOLD, NAME_weights_block,
     * NAME_WEIGHTS_BINDING. A letter, then letters, digits and single underscores, 40 at most.
     * The names of hybrid_brdf.glsl stay (hnbrdf_sample_result), and so do HNBRDF_HALF_NATIVE and
     * HNBRDF_LOOP: that is there once, included before all of them or, of standalone texts, each
     * of its parts in the first text that needs it. Then all of them have to have a prefix; it may
     * be hnbrdf. */
    const char *prefix;
    int without_comments; /* 1: no comments and no empty lines */
} hnbrdf_glsl_options;

/* Write one shader include with the network, the chosen materials, and the functions
 *   hnbrdf_material hnbrdf_scene_material(int index)
 *   vec3 hnbrdf_eval(hnbrdf_material m, vec3 wi, vec3 wo)
 *   hnbrdf_sample_result hnbrdf_sample(hnbrdf_material m, vec3 wo, vec2 u)
 *   float hnbrdf_pdf(hnbrdf_material m, vec3 wi, vec3 wo)
 * whose values are those of their namesakes in C, and hnbrdf_eval_world, hnbrdf_sample_world and
 * hnbrdf_pdf_world, which take the normal and the tangent behind m and all directions in the
 * coordinates of these. Its first lines state what it holds. options
 * may be NULL.
 *
 * HNBRDF_MATERIAL_NAME is the index of a material: its name in capitals, with one '_' for what is
 * neither an ASCII letter nor a digit. Where several materials of the model come to the same, that
 * belongs to the one whose name differs by capitals only, or to none, and the others end in '_'
 * and a hash of their name: a_b is A_B, a-b beside it A_B_2A89DF63, in whatever order, and also
 * where one of them is exported alone. */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_export_shader(const hnbrdf_model *model,
                                                       const hnbrdf_glsl_options *options,
                                                       hnbrdf_write_fn write, void *user,
                                                       hnbrdf_error *error);

/* Bytes of the uniform block of a shader exported with HNBRDF_GLSL_UNIFORM; 0 for a ggx model,
 * which has none. At most 58000; every Vulkan, GL and GL ES 3 device takes 16384, desktop ones
 * 65536. */
HNBRDF_EXPERIMENTAL size_t hnbrdf_weights_size(const hnbrdf_model *model);

/* Write the contents of that block, std140: vec4 after vec4, floats in the byte order of this
 *   machine.
 *   vec4 0, 1         s, m, b of the model, and for half precision the largest input and the
 *                     largest unit of each hidden layer (else 0). The fourth number is never
 *                     negative: outside of Vulkan the loops start at what the shader makes of
 *                     that, 0, which no compiler knows, so that none unrolls them
 *   then a layer      for every four outputs, the last group filled with zeros: their biases,
 *                     then one vec4
 *   after the other   an input, the weights of that input to the four outputs. Inputs of the
 *                     first layer: the latent code, then the encoded directions; of the others
 *                     the units of the layer before, filled with zeros to a multiple of four.
 * The shader's block is hnbrdf_weights_block; in Vulkan at set HNBRDF_WEIGHTS_SET, binding
 * HNBRDF_WEIGHTS_BINDING, both 0 unless defined before the include; in HLSL and Slang at
 * HNBRDF_WEIGHTS_REGISTER, b0 unless defined; in WGSL these are constants of the text; in MSL it
 * is a parameter. Of the options, which may be
 * NULL, only the precision matters: it must be that of the shader. HNBRDF_ERROR_ARGUMENT for a
 * ggx model. */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_export_weights(const hnbrdf_model *model,
                                                        const hnbrdf_glsl_options *options,
                                                        hnbrdf_write_fn write, void *user,
                                                        hnbrdf_error *error);

#ifdef __cplusplus
}
#endif

#endif
