/* kernel_body.h: the text of the evaluation kernels, included once per instruction set.
 *
 * The includer defines KERNEL_TABLE and KERNEL_VARIANT, the table to fill and what it is called;
 * KERNEL_WIDTH, the floats in a vector (1: plain loops, no compiler extension), KERNEL_ROWS x
 * KERNEL_WIDE vectors, the register tile of the network, and KERNEL_SINGLE, the floats in a vector
 * of the network of one evaluation. Everything else in a batch is loops over lanes of the same
 * inline functions that define it, which compilers vectorise. */
/* clang-format off: in this order */
#include "core/kernel_network.h"
#if KERNEL_WIDTH > 1
#include "core/kernel_vector.h"
#endif
#include "core/kernel_lanes.h"
#include "core/kernel_blocks.h"
/* clang-format on */

/* ---- One pair -------------------------------------------------------------------------------- */

#if KERNEL_WIDTH > 1
#include "core/kernel_single.h"
#else
/* The network first: its sums are one long wait, and f_a is worked out in its shadow. */
static void kernel_single(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3],
                          float f[3])
{
    const hnbrdf_model_desc *desc = &prepared->model->desc;
    const float scale = desc->scale, shift = desc->shift, lowest = desc->floor;
    float f_a[4], value[4], out[HNBRDF_MAX_HIDDEN]; /* the fourth channel is filling */
    hnbrdf_pair pair = hnbrdf_pair_in_frame(prepared, wi, wo);
    if (desc->kind != HNBRDF_KIND_GGX) {
        float x[HNBRDF_ENCODING_SIZE];
        out[3] = out[6] = 0.0f;
        hnbrdf_encode(desc->encoding, &pair, x);
        network_single(prepared, x, out);
    }
    if (desc->kind != HNBRDF_KIND_NEURAL)
        hnbrdf_prepared_analytic(prepared, &pair, f_a);
    if (desc->kind == HNBRDF_KIND_HYBRID)
        for (int c = 0; c < 4; c++)
            value[c] = hnbrdf_compose_hybrid(out[c], out[c + 3], f_a[c], scale, shift, lowest);
    else if (desc->kind == HNBRDF_KIND_NEURAL)
        for (int c = 0; c < 4; c++)
            value[c] = hnbrdf_compose_neural(out[c], scale, shift, lowest);
    else
        for (int c = 0; c < 4; c++)
            value[c] = hnbrdf_finish(f_a[c]);
    memcpy(f, value, 3 * sizeof *f);
}
#endif

/* ---- Batches --------------------------------------------------------------------------------- */

static void kernel_analytic(const hnbrdf_prepared *prepared, const hnbrdf_pairs *pairs)
{
    const int none = prepared->model->desc.kind == HNBRDF_KIND_NEURAL;
    lane_materials materials;
    lane_pairs block;
    for (int l = 0; l < LANES; l++)
        put_material(prepared, l, &materials);
    for (size_t k = 0; k < pairs->count; k += LANES) {
        size_t count = smaller(LANES, pairs->count - k);
        gather(pairs, k, count, &block);
        mark_lanes(&block);
        make_pairs(&materials, &block);
        specular_lanes(&materials, &block);
        fresnel_lanes(&materials, &block);
        finish_lanes(&block);
        if (none)
            memset(block.above, 0, sizeof block.above);
        scatter(pairs, k, count, &block);
    }
}

static void kernel_eval(const hnbrdf_materials *of, const hnbrdf_pairs *pairs)
{
    lane_block block;
    if (of->model->desc.kind != HNBRDF_KIND_GGX) {
        evaluate_blocks(of, pairs);
        return;
    }
    begin_materials(of, 0, &block.materials);
    for (size_t k = 0; k < pairs->count; k += LANES) {
        size_t count = smaller(LANES, pairs->count - k);
        take_materials(&block.materials, k, count, &block.pairs);
        gather(pairs, k, count, &block.pairs);
        mark_lanes(&block.pairs);
        evaluate_lanes(of->model, &block);
        if (block.materials.conserved)
            conserve_lanes(&block.materials, &block.pairs);
        scatter(pairs, k, count, &block.pairs);
    }
}

static void kernel_pdf(const hnbrdf_materials *of, const hnbrdf_pairs *pairs)
{
    lane_block b;
    block_materials *materials = &b.materials;
    lane_pairs *block = &b.pairs;
    begin_materials(of, 1, materials);
    for (size_t k = 0; k < pairs->count; k += LANES) {
        size_t count = smaller(LANES, pairs->count - k);
        take_materials(materials, k, count, block);
        gather(pairs, k, count, block);
        mark_lanes(block);
        make_pairs(&materials->by_lane, block);
        lane pdf;
        density_lanes(&materials->lobes, block, pdf);
        for (size_t l = 0; l < count; l++)
            *(float *)((char *)pairs->f + (k + l) * pairs->f_stride) =
                block->above[l] ? pdf[l] : 0.0f;
    }
}

/* Draws, then evaluates what was drawn. */
static void kernel_sample(const hnbrdf_materials *of, const hnbrdf_draws *draws)
{
    lane_block b;
    block_materials *materials = &b.materials;
    lane_pairs *block = &b.pairs;
    begin_materials(of, 1, materials);
    for (size_t k = 0; k < draws->count; k += LANES) {
        size_t count = smaller(LANES, draws->count - k);
        lane_choices choices;
        lane wi[3], wo[3], pdf;
        take_materials(materials, k, count, block);
        gather_draws(draws, k, count, block);
        memcpy(wo, block->wo, sizeof wo);
        choose_lanes(&materials->lobes, block, &choices);
        draw_lanes(&materials->by_lane, &choices, block);
        memcpy(wi, block->wi, sizeof wi);
        make_pairs(&materials->by_lane, block);
        density_lanes(&materials->lobes, block, pdf);
        for (int l = 0; l < LANES; l++)
            block->above[l] &= pdf[l] > 0.0f;
        memcpy(block->wi, wi, sizeof wi);
        memcpy(block->wo, wo, sizeof wo);
        evaluate_lanes(of->model, &b);
        if (materials->conserved)
            conserve_lanes(materials, block);
        for (size_t l = 0; l < count; l++) {
            hnbrdf_sample_result *to =
                (hnbrdf_sample_result *)(void *)((char *)draws->results +
                                                 (k + l) * draws->result_stride);
            const int drawn = block->above[l];
            to->pdf = drawn ? pdf[l] : 0.0f;
            for (int c = 0; c < 3; c++) {
                to->wi[c] = drawn ? wi[c][l] : c == 2 ? 1.0f : 0.0f;
                to->weight[c] = drawn ? hnbrdf_finish(block->f[c][l] * wi[2][l] / pdf[l]) : 0.0f;
            }
        }
    }
}

const hnbrdf_kernel KERNEL_TABLE = {.variant = KERNEL_VARIANT,
                                    .fold = kernel_fold,
                                    .single = kernel_single,
                                    .outputs = network_single,
                                    .eval = kernel_eval,
                                    .analytic = kernel_analytic,
                                    .pdf = kernel_pdf,
                                    .sample = kernel_sample,
                                    .network = kernel_network};
