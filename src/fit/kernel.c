/* kernel.c: the trainer's kernel for any machine, the layout of its parameters, and the choice
 * among instruction sets. */
#define KERNEL_WIDTH 4
#include "fit/kernel_float.h"

const fit_kernel hnbrdf_fit_kernel_plain = {"plain",         kernel_derive,   kernel_network,
                                            kernel_analytic, kernel_own_rows, kernel_own,
                                            kernel_pixel,    kernel_matrix};

const fit_kernel *hnbrdf_fit_kernel_choose(void)
{
#ifdef FIT_KERNEL_X86
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
        return &hnbrdf_fit_kernel_avx512;
    if (__builtin_cpu_supports("avx2"))
        return &hnbrdf_fit_kernel_avx2;
#endif
    return &hnbrdf_fit_kernel_plain;
}

void hnbrdf_fit_layout_make(fit_layout *layout, hnbrdf_kind kind, int hidden, int layers,
                            int latent, int materials, int train_analytic, float floor)
{
    fit_layout l = {0};
    l.kind = kind;
    l.latent_size = latent;
    l.hidden_size = hidden;
    l.layers = layers;
    l.outputs = kind == HNBRDF_KIND_HYBRID ? 6 : 3;
    l.materials = materials;
    l.train_analytic = train_analytic;
    l.floor = floor;
    l.padded = (hidden + FIT_LANES - 1) / FIT_LANES * FIT_LANES;
    size_t n = (size_t)l.padded, at = 0;
    if (kind != HNBRDF_KIND_GGX) {
        l.first = at, at += FIT_INPUTS * n;
        l.latent = at, at += (size_t)latent * n;
        l.bias[0] = at, at += n;
        for (int k = 1; k < layers; k++) {
            l.hidden[k] = at, at += n * n;
            l.bias[k] = at, at += n;
        }
        l.last = at, at += (size_t)l.outputs * n;
        l.bias[layers] = at, at += FIT_LANES;
        l.derived_count = (size_t)(layers - 1) * n * n + n * FIT_LANES;
        l.scratch_count =
            (size_t)(2 * layers + 2) * FIT_TILE * n + FIT_TILE * (FIT_INPUTS + 2 * FIT_LANES) + n;
    }
    l.network_count = l.codes = at;
    at += (size_t)materials * (size_t)latent;
    l.analytic = at, at += (size_t)materials * FIT_ANALYTIC;
    l.count = at;
    *layout = l;
}

size_t hnbrdf_fit_trained(const fit_layout *l)
{
    return l->train_analytic ? l->count : l->analytic;
}

void hnbrdf_fit_layer_size(const fit_layout *l, int k, int *outputs, int *inputs)
{
    *outputs = k < l->layers ? l->hidden_size : l->outputs;
    *inputs = k > 0 ? l->hidden_size : FIT_INPUTS + l->latent_size;
}

size_t hnbrdf_fit_weight_at(const fit_layout *l, int k, int output, int input)
{
    size_t n = (size_t)l->padded, o = (size_t)output, i = (size_t)input;
    return k == l->layers ? l->last + o * n + i : (k > 0 ? l->hidden[k] : l->first) + i * n + o;
}
