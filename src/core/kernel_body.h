/* kernel_body.h: the text of the evaluation kernels, included once per instruction set.
 *
 * The includer defines KERNEL_TABLE and KERNEL_VARIANT, the table to fill and what it is called;
 * KERNEL_WIDTH, the floats in a vector (1: plain loops, no compiler extension), KERNEL_ROWS x
 * KERNEL_WIDE vectors, the register tile of the network, and KERNEL_SINGLE, the floats in a
 * vector of the network of one evaluation. Everything else in a batch is loops over lanes of the
 * same inline functions that define it, which compilers vectorise. */
#include "core/kernel_network.h"
#include "core/kernel_lanes.h"

/* ---- One pair -------------------------------------------------------------------------------- */

#if KERNEL_WIDTH > 1
#include "core/kernel_vector.h"
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

static void spread_material(const hnbrdf_prepared *prepared, lane_materials *m)
{
    for (int l = 0; l < LANES; l++)
        put_material(prepared, l, m);
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

static void kernel_analytic(const hnbrdf_prepared *prepared, const hnbrdf_pairs *pairs)
{
    const int none = prepared->model->desc.kind == HNBRDF_KIND_NEURAL;
    lane_materials materials;
    lane_pairs block;
    spread_material(prepared, &materials);
    for (size_t k = 0; k < pairs->count; k += LANES) {
        size_t count = smaller(LANES, pairs->count - k);
        gather(pairs, k, count, &block);
        make_pairs(&materials, &block);
        analytic_lanes(&materials, &block);
        finish_lanes(&block);
        if (none)
            memset(block.above, 0, sizeof block.above);
        scatter(pairs, k, count, &block);
    }
}

/* The materials of the blocks of one batch, by lane. */
typedef struct block_materials {
    const hnbrdf_materials *of;
    const hnbrdf_prepared *shared; /* that of all lanes, or NULL */
    const hnbrdf_material *held;   /* what `prepared` was made from, or NULL */
    hnbrdf_prepared prepared;
    lane_materials by_lane;
    lane_edits edits;
    lane_lobes lobes;
    int sampled; /* 1: the lobes are wanted */
    int edited;  /* 1: some lane is, and `edits` is set */
} block_materials;

/* That of lane l. */
static void take_material(block_materials *m, int l, const hnbrdf_prepared *prepared)
{
    put_material(prepared, l, &m->by_lane);
    if (m->sampled)
        put_lobes(prepared, l, &m->lobes);
}

static void begin_materials(const hnbrdf_materials *of, int sampled, block_materials *m)
{
    m->of = of;
    m->held = NULL;
    m->sampled = sampled;
    m->shared = of->prepared;
    m->edited = 0;
    if (!m->shared)
        return;
    m->edited = m->shared->edited;
    for (int l = 0; l < LANES; l++) {
        take_material(m, l, m->shared);
        if (m->edited)
            put_edit(m->shared, l, &m->edits);
    }
}

/* Some lane is edited: what that adds, of all. */
KERNEL_APART void take_edits(block_materials *m, const hnbrdf_material *const own[LANES], int same)
{
    hnbrdf_prepared prepared = m->prepared;
    for (int l = 0; l < LANES; l++) {
        if (!same && (l == 0 || own[l] != own[l - 1]))
            hnbrdf_prepare_analytic(m->of->model, own[l], &prepared);
        put_edit(&prepared, l, &m->edits);
    }
}

/* Those of items first to first + count of the batch. Where all lanes have the same one, that is
 * prepared (unless it is already) and `shared`; else the latent codes are put before what will be
 * encoded. */
static void take_materials(block_materials *m, size_t first, size_t count, lane_pairs *b)
{
    const hnbrdf_materials *of = m->of;
    const hnbrdf_material *own[LANES];
    int same = 1;
    if (of->prepared)
        return;
    for (size_t l = 0; l < LANES; l++) {
        size_t item = first + smaller(l, count - 1);
        own[l] = of->index ? of->materials + of->index[item] : of->materials + item;
        same &= own[l] == own[0];
    }
    m->shared = same ? &m->prepared : NULL;
    if (same && m->held == own[0])
        return;
    m->held = same ? own[0] : NULL;
    m->edited = 0;
    for (int l = 0; l < LANES; l++) {
        if (l == 0 && same)
            hnbrdf_prepare(of->model, own[0], &m->prepared);
        else if (l == 0 || own[l] != own[l - 1]) {
            hnbrdf_prepare_analytic(of->model, own[l], &m->prepared);
            if (m->sampled)
                hnbrdf_prepare_lobes(of->model, own[l], &m->prepared);
        }
        take_material(m, l, &m->prepared);
        m->edited |= m->prepared.edited;
        for (int i = 0; i < of->model->desc.latent && !same; i++)
            b->x[i][l] = own[l]->latent[i];
    }
    if (m->edited)
        take_edits(m, own, same);
}

/* b->out of what is encoded in b->x behind the latent codes. */
static void block_network(const hnbrdf_model *model, const block_materials *m, lane_pairs *b)
{
    const int latent = model->desc.latent;
    if (m->shared)
        network_folded(m->shared, b->x + latent, b->out);
    else
        network_lanes(model, model->packed[0], latent + HNBRDF_ENCODING_SIZE, b->x,
                      model->packed_biases[0], b->out);
}

KERNEL_APART void evaluate_edited_lanes(const hnbrdf_model *model, const block_materials *m,
                                        lane_pairs *b)
{
    const hnbrdf_model_desc *desc = &model->desc;
    lane_pairs seen;
    lane_shine shine;
    edited_lanes(&m->by_lane, &m->edits, b, &shine);
    seen_lanes(desc->encoding, &m->edits, &shine, b, &seen);
    fitted_lanes(&m->edits, &shine, b, &seen);
    encode_lanes(desc->encoding, &seen, b->x + desc->latent);
    block_network(model, m, b);
    compose_edited_lanes(desc, &m->edits, &seen, b);
}

/* Everything between gather and scatter. */
KERNEL_APART void evaluate_lanes(const hnbrdf_model *model, const block_materials *m, lane_pairs *b)
{
    const hnbrdf_model_desc *desc = &model->desc;
    make_pairs(&m->by_lane, b);
    if (m->edited) {
        evaluate_edited_lanes(model, m, b);
        return;
    }
    if (desc->kind != HNBRDF_KIND_NEURAL)
        analytic_lanes(&m->by_lane, b);
    if (desc->kind == HNBRDF_KIND_GGX) {
        finish_lanes(b);
        return;
    }
    encode_lanes(desc->encoding, b, b->x + desc->latent);
    block_network(model, m, b);
    compose_lanes(desc, b);
}

static void kernel_eval(const hnbrdf_materials *of, const hnbrdf_pairs *pairs)
{
    block_materials materials;
    lane_pairs block;
    begin_materials(of, 0, &materials);
    for (size_t k = 0; k < pairs->count; k += LANES) {
        size_t count = smaller(LANES, pairs->count - k);
        take_materials(&materials, k, count, &block);
        gather(pairs, k, count, &block);
        evaluate_lanes(of->model, &materials, &block);
        scatter(pairs, k, count, &block);
    }
}

static void kernel_pdf(const hnbrdf_materials *of, const hnbrdf_pairs *pairs)
{
    block_materials materials;
    lane_pairs block;
    begin_materials(of, 1, &materials);
    for (size_t k = 0; k < pairs->count; k += LANES) {
        size_t count = smaller(LANES, pairs->count - k);
        take_materials(&materials, k, count, &block);
        gather(pairs, k, count, &block);
        make_pairs(&materials.by_lane, &block);
        lane pdf;
        density_lanes(&materials.lobes, &block, pdf);
        for (size_t l = 0; l < count; l++)
            *(float *)((char *)pairs->f + (k + l) * pairs->f_stride) =
                block.above[l] ? pdf[l] : 0.0f;
    }
}

/* Draws, then evaluates what was drawn. */
static void kernel_sample(const hnbrdf_materials *of, const hnbrdf_draws *draws)
{
    block_materials materials;
    lane_pairs block;
    begin_materials(of, 1, &materials);
    for (size_t k = 0; k < draws->count; k += LANES) {
        size_t count = smaller(LANES, draws->count - k);
        lane_choices choices;
        lane wi[3], wo[3], pdf;
        take_materials(&materials, k, count, &block);
        gather_draws(draws, k, count, &block);
        memcpy(wo, block.wo, sizeof wo);
        choose_lanes(&materials.lobes, &block, &choices);
        draw_lanes(&materials.by_lane, &choices, &block);
        memcpy(wi, block.wi, sizeof wi);
        make_pairs(&materials.by_lane, &block);
        density_lanes(&materials.lobes, &block, pdf);
        for (int l = 0; l < LANES; l++)
            block.above[l] &= pdf[l] > 0.0f;
        memcpy(block.wi, wi, sizeof wi);
        memcpy(block.wo, wo, sizeof wo);
        evaluate_lanes(of->model, &materials, &block);
        for (size_t l = 0; l < count; l++) {
            hnbrdf_sample_result *to =
                (hnbrdf_sample_result *)(void *)((char *)draws->results +
                                                 (k + l) * draws->result_stride);
            const int drawn = block.above[l];
            to->pdf = drawn ? pdf[l] : 0.0f;
            for (int c = 0; c < 3; c++) {
                to->wi[c] = drawn ? wi[c][l] : c == 2 ? 1.0f : 0.0f;
                to->weight[c] = drawn ? hnbrdf_finish(block.f[c][l] * wi[2][l] / pdf[l]) : 0.0f;
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
