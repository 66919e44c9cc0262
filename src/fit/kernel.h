/* kernel.h: forward and backward pass over one tile of pairs, the arithmetic of the trainer.
 *
 * A tile is FIT_TILE direction pairs of one material. Parameters lie in one flat array (layout
 * below), gradients in another of the same layout, so that a sum is one loop. Hidden
 * layers are padded to a multiple of FIT_LANES units; padding is zero and stays zero.
 *
 * Every sum has one fixed order whatever the vector width: over inputs in index order, over pairs
 * in index order, so all instruction sets give the same bits. */
#ifndef HNBRDF_FIT_KERNEL_H
#define HNBRDF_FIT_KERNEL_H

#include "hnbrdf/hnbrdf.h"

enum { FIT_TILE = 64, FIT_LANES = 16, FIT_INPUTS = 6 };

/* Analytic parameters of one material, unconstrained where that helps: kd, ln(eta - 1), ln alpha,
 * rotation. */
enum { FIT_KD = 0, FIT_ETA = 3, FIT_ALPHA = 6, FIT_ROTATION = 8, FIT_ANALYTIC = 9 };

/* The longest side of a matrix that training turns: a layer's inputs and its bias. */
enum { FIT_MATRIX = HNBRDF_MAX_HIDDEN + 1 };

/* What a material has of its own, beside a network that stays: its latent code, then, from number
 * FIT_LANES on, its analytic parameters. */
enum { FIT_OWN = 2 * FIT_LANES, FIT_LIGHTS = 3 };

/* Layout of the flat arrays, in numbers (not bytes); all offsets are multiples of FIT_LANES but
 * those
 * of single materials. first    [6][padded]          layer 0, directions:  transposed, input-major
 *   latent   [l][padded]          layer 0, latent code: transposed
 *   bias[0]  [padded]
 *   hidden   [padded][padded]     layers 1 .. N-1, transposed; bias[k] [padded]
 *   last     [outputs][padded]    output-major; bias[N] [FIT_LANES]
 *   codes    [materials][l]       latent codes
 *   analytic [materials][FIT_ANALYTIC] */
typedef struct fit_layout {
    hnbrdf_kind kind;
    int latent_size, hidden_size, padded, layers, outputs, materials;
    int train_analytic; /* 1: the gradient of the analytic part is wanted */
    float floor;
    float lift; /* see FIT_LIFT_BELOW; hnbrdf_fit_layout_make() sets 0 */
    size_t first, latent, bias[HNBRDF_MAX_LAYERS + 1], hidden[HNBRDF_MAX_LAYERS], last, codes,
        analytic;
    size_t network_count; /* numbers before codes: all shared by the materials */
    size_t count;
    size_t derived_count; /* numbers of the derived array, see fit_kernel.derive */
    size_t scratch_count; /* numbers of scratch one thread needs */
} fit_layout;

void hnbrdf_fit_layout_make(fit_layout *layout, hnbrdf_kind kind, int hidden, int layers,
                            int latent, int materials, int train_analytic, float floor);

/* The numbers that training changes: the analytic part, at the end, only where it is trained. */
size_t hnbrdf_fit_trained(const fit_layout *layout);

/* Columns of what fit_kernel.own adds up: FIT_OWN where the analytic part is trained, else
 * FIT_LANES. */
static inline int hnbrdf_fit_own_stride(const fit_layout *l)
{
    return l->train_analytic && l->kind == HNBRDF_KIND_HYBRID ? FIT_OWN : FIT_LANES;
}

/* Where the weight from `input` to `output` of layer k lies, both counted as in a model: the
 * inputs of layer 0 are the six encoded directions, then the latent code, whose rows follow on. */
size_t hnbrdf_fit_weight_at(const fit_layout *layout, int k, int output, int input);
void hnbrdf_fit_layer_size(const fit_layout *layout, int k, int *outputs, int *inputs);

/* One tile of training data, all float: x [FIT_TILE][6] encoded; analytic [3][FIT_TILE] f_a where
 * the analytic part is frozen; wi and wo [3][FIT_TILE] in the shading frame where it is trained;
 * target [3][FIT_TILE] the measured f. Pointers that are not needed may be NULL. */
typedef struct fit_tile {
    const float *x, *analytic, *wi, *wo, *target;
} fit_tile;

/* Loss per channel of value f against target F, f = max(0, u) with u the unclipped value:
 *   (1 - mix) |ln((f + 1e-3)/(F + 1e-3))| + mix 2 |f - F| / (f + F + 1e-4).
 * The gradient is passed to u unchanged, so a clipped value below a positive target is pulled up.
 */
#define FIT_LOG_OFFSET 1e-3
#define FIT_SMAPE_OFFSET 1e-4
/* Where GGX is too low even with an open gate, exp(c) has to add what is missing. But its
 * derivative is exp(c) itself: once it is small beside the gated GGX, as it is in a highlight, it
 * stays small whatever the loss. So where f is below the target by more than this factor, the
 * derivative of exp(c) is taken as at least `lift` of the gated GGX. Nearer to the target, and
 * above it, the derivative is the true one. */
#define FIT_LIFT_BELOW 1.25
/* Values and targets end here: their squares must be floats. At the roughness floor of 1e-4 GGX
 * itself stays below 1/(pi alpha^2) / (4 cos cos) = 8e10 where the samplers draw. */
#define FIT_MOST 1e15f

/* The kernels of one instruction set. loss returned is the sum over the tile's pairs and
 * channels. The gradient of that sum by the network is added to gradient [network_count], by what
 * the tile's material has of its own to own: [latent_size] its code, then, where that is trained,
 * [FIT_ANALYTIC]. A tile adds one number to each of them, so that it is all the same whether tiles
 * are added up here or by the caller. */
typedef struct fit_kernel {
    const char *name;
    /* Layouts of the weights that the backward pass wants, once a step. */
    void (*derive)(const fit_layout *layout, const float *parameters, float *derived);
    double (*network)(const fit_layout *layout, const float *parameters, const float *derived,
                      const fit_tile *tile, int material, float mix, float *scratch,
                      float *gradient, float *own);
    /* The analytic part alone, wi, wo and target of the tile; parameters and gradient
     * [FIT_ANALYTIC]. */
    double (*analytic)(const float *parameters, const fit_tile *tile, float mix, float *scratch,
                       float *gradient);
    /* What own() wants of the network: rows [padded][FIT_LANES]. */
    void (*own_rows)(const fit_layout *layout, const float *parameters, float *rows);
    /* The loss with the numbers own [FIT_OWN] of the tile's material; its gradient by them and
     * the matrix of Gauss and Newton are added to normal: [stride], then [stride][stride], of which
     * only rows of numbers that there are get filled. NULL: the loss alone. The loss is a sum of
     * absolute values; the matrix is that of a sum of squares with the same gradient, where f is
     * off by less than width (f + F + 1e-4) that of a square so wide. Rotation stays. Where the
     * analytic part is trained, its SMAPE alone is added to *alone, and a second set of numbers,
     * after those of normal, is the same of it; alone may be NULL. */
    double (*own)(const fit_layout *layout, const float *parameters, const float *derived,
                  const float *rows, const fit_tile *tile, const float *own, float mix, float width,
                  float *scratch, float *normal, double *alone);
    /* The same of one pixel of a picture, whose pairs the tile holds: under light s, of FIT_LIGHTS,
     * it sends the sum of lights [s][FIT_TILE] times f. The squared error of each light, summed
     * over the channels, is added to squares, and what the sum of these times weights is made of to
     * normal. */
    void (*pixel)(const fit_layout *layout, const float *parameters, const float *derived,
                  const float *rows, const fit_tile *tile, const float *lights,
                  const float *weights, const float *own, float *scratch, float *normal,
                  double *squares);
    /* c = a b, row by row: a [rows][depth], b [depth][columns]; rows and depth <= FIT_MATRIX. */
    void (*matrix)(const float *a, const float *b, float *c, int rows, int depth, int columns);
} fit_kernel;

/* The best one this machine runs; all give the same bits. */
const fit_kernel *hnbrdf_fit_kernel_choose(void);

extern const fit_kernel hnbrdf_fit_kernel_plain;
/* Not GCC for Windows, which aligns no stack to more than 16 bytes. */
#if (defined(__x86_64__) || defined(__i386__)) && (!defined(__MINGW32__) || defined(__clang__))
#define FIT_KERNEL_X86 1
extern const fit_kernel hnbrdf_fit_kernel_avx2, hnbrdf_fit_kernel_avx512;
#endif

/* The same text compiled in double, for the gradient tests. */
typedef struct fit_kernel_double_table {
    void (*derive)(const fit_layout *layout, const double *parameters, double *derived);
    double (*network)(const fit_layout *layout, const double *parameters, const double *derived,
                      const fit_tile *tile, int material, double mix, double *scratch,
                      double *gradient, double *own);
    double (*analytic)(const double *parameters, const fit_tile *tile, double mix, double *scratch,
                       double *gradient);
    void (*own_rows)(const fit_layout *layout, const double *parameters, double *rows);
    double (*own)(const fit_layout *layout, const double *parameters, const double *derived,
                  const double *rows, const fit_tile *tile, const double *own, double mix,
                  double width, double *scratch, double *normal, double *alone);
    void (*pixel)(const fit_layout *layout, const double *parameters, const double *derived,
                  const double *rows, const fit_tile *tile, const float *lights,
                  const float *weights, const double *own, double *scratch, double *normal,
                  double *squares);
    void (*matrix)(const double *a, const double *b, double *c, int rows, int depth, int columns);
} fit_kernel_double_table;
extern const fit_kernel_double_table hnbrdf_fit_kernel_double;

#endif
