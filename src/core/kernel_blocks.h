/* kernel_blocks.h: a batch in blocks of LANES, each in steps, and which steps of one block are done
 * beside the network of another. Part of kernel_body.h, after kernel_lanes.h. */

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* ---- The materials of a block ---------------------------------------------------------------- */

typedef struct block_materials {
    const hnbrdf_materials *of;
    const hnbrdf_prepared *shared; /* that of all lanes, or NULL */
    const hnbrdf_material *held;   /* what `prepared` was made from, or NULL */
    const hnbrdf_material *own[LANES];
    hnbrdf_prepared prepared;
    lane_materials by_lane;
    lane_edits edits;
    lane_lobes lobes;
    lane horizon, slope; /* of energy */
    int sampled;         /* 1: the lobes are wanted */
    int edited;          /* 1: some lane is, and `edits` is set */
    int conserved;       /* 1: some lane is, and `horizon` and `slope` are set */
    int taken;           /* 1: by_lane is what it shall be */
} block_materials;

static void put_energy(const hnbrdf_energy *energy, int l, block_materials *m)
{
    const hnbrdf_energy used = hnbrdf_energy_used(energy);
    m->horizon[l] = used.horizon;
    m->slope[l] = used.slope;
}

/* The same one for all lanes. */
static void spread_material(const hnbrdf_prepared *prepared, block_materials *m)
{
    m->edited = prepared->edited;
    m->conserved = prepared->conserved;
    for (int l = 0; l < LANES; l++) {
        put_material(prepared, l, &m->by_lane);
        if (m->sampled)
            put_lobes(prepared, l, &m->lobes);
        if (m->edited)
            put_edit(prepared, l, &m->edits);
        if (m->conserved)
            put_energy(&prepared->energy, l, m);
    }
}

static void begin_materials(const hnbrdf_materials *of, int sampled, block_materials *m)
{
    m->of = of;
    m->held = NULL;
    m->sampled = sampled;
    m->shared = of->prepared;
    m->edited = m->conserved = 0;
    m->taken = of->prepared != NULL;
    if (m->shared)
        spread_material(m->shared, m);
}

/* Those of items first to first + count of the batch: whose they are. Where all lanes have the same
 * one, that is prepared, unless it is already. */
static void find_materials(block_materials *m, size_t first, size_t count)
{
    const hnbrdf_materials *of = m->of;
    int same = 1;
    if (of->prepared)
        return;
    for (size_t l = 0; l < LANES; l++) {
        size_t item = first + smaller(l, count - 1);
        m->own[l] = of->index ? of->materials + of->index[item] : of->materials + item;
        same &= m->own[l] == m->own[0];
    }
    m->shared = same ? &m->prepared : NULL;
    m->taken = same;
    if (same && m->held == m->own[0])
        return;
    m->held = same ? m->own[0] : NULL;
    m->edited = m->conserved = 0;
    if (same) {
        hnbrdf_prepare(of->model, m->own[0], &m->prepared);
        spread_material(&m->prepared, m);
    }
}

/* Where kd, eta and alpha, eight numbers that follow each other, are not those it was fitted with,
 * for many materials together. */
#if KERNEL_WIDTH > 1
typedef quad_bits differences;

KERNEL_INLINE differences differs(const hnbrdf_material *material)
{
    const float *now = material->kd, *then = material->fitted.kd;
    return (quad_at(now) != quad_at(then)) | (quad_at(now + 4) != quad_at(then + 4));
}

static int any_differs(differences d)
{
    return (d[0] | d[1] | d[2] | d[3]) != 0;
}
#else
typedef int differences;

static int differs(const hnbrdf_material *material)
{
    return hnbrdf_is_edited(material);
}

static int any_differs(differences d)
{
    return d;
}
#endif

/* Lanes `from` to `to` of a block of several materials: their numbers as they are, and their latent
 * codes before what will be encoded. */
KERNEL_APART void take_lanes(block_materials *m, int from, int to, lane_pairs *b)
{
    const hnbrdf_model_desc *desc = &m->of->model->desc;
    const int latent = desc->latent, hybrid = desc->kind == HNBRDF_KIND_HYBRID;
    lane_materials *by_lane = &m->by_lane;
    differences differ = {0};
    for (int l = from; l < to; l++) {
        const hnbrdf_material *own = m->own[l];
        for (int c = 0; c < 3; c++) {
            by_lane->diffuse[c][l] = own->kd[c];
            by_lane->e[c][l] = own->eta[c];
        }
        by_lane->ax[l] = own->alpha[0];
        by_lane->ay[l] = own->alpha[1];
        by_lane->cosine[l] = own->rotation;
        differ |= differs(own);
        m->conserved |= hnbrdf_has_energy(&own->energy);
        for (int i = 0; i < latent; i++)
            b->x[i][l] = own->latent[i];
    }
    for (int l = from; l < to && hybrid && any_differs(differ); l++)
        m->edited |= hnbrdf_is_edited(m->own[l]);
}

/* What hnbrdf_prepare_analytic() makes of those numbers. */
KERNEL_APART void derive_lanes(lane_materials *m)
{
    int turned = 0;
    for (int l = 0; l < LANES; l++) {
        turned |= m->cosine[l] != 0.0f;
        m->sine[l] = m->cosine[l];
        m->cosine[l] = 1.0f;
        m->area[l] = hnbrdf_ggx_area(m->ax[l], m->ay[l]);
        for (int c = 0; c < 3; c++) {
            m->diffuse[c][l] = m->diffuse[c][l] * HNBRDF_INV_PI;
            m->e[c][l] = hnbrdf_fresnel_e(m->e[c][l]);
        }
    }
    for (int l = 0; l < LANES && turned; l++) {
        const hnbrdf_frame frame = hnbrdf_frame_of_angle(m->sine[l]);
        m->cosine[l] = frame.cosine;
        m->sine[l] = frame.sine;
    }
}

/* Some lane is edited, or lobes are wanted: what that adds, of all. */
KERNEL_APART void take_the_rest(block_materials *m)
{
    hnbrdf_prepared prepared;
    for (int l = 0; l < LANES; l++) {
        if (l == 0 || m->own[l] != m->own[l - 1]) {
            hnbrdf_prepare_analytic(m->of->model, m->own[l], &prepared);
            if (m->sampled)
                hnbrdf_prepare_lobes(m->of->model, m->own[l], &prepared);
        }
        if (m->edited)
            put_edit(&prepared, l, &m->edits);
        if (m->sampled)
            put_lobes(&prepared, l, &m->lobes);
    }
}

static void derive_materials(block_materials *m)
{
    derive_lanes(&m->by_lane);
    for (int l = 0; l < LANES && m->conserved; l++)
        put_energy(&m->own[l]->energy, l, m);
    if (m->edited || m->sampled)
        take_the_rest(m);
    m->taken = 1;
}

/* All of it. */
static void take_materials(block_materials *m, size_t first, size_t count, lane_pairs *b)
{
    find_materials(m, first, count);
    if (m->taken)
        return;
    take_lanes(m, 0, LANES, b);
    derive_materials(m);
}

/* ---- A block --------------------------------------------------------------------------------- */

typedef struct lane_block {
    block_materials materials;
    lane_pairs pairs;
    lane_pairs seen; /* by networks of edited materials */
    lane_shine shine;
    size_t first, count; /* items of the batch; count 0: none */
} lane_block;

/* b->out of what is encoded in b->x behind the latent codes. */
static void block_network(const hnbrdf_model *model, const block_materials *m, lane_pairs *b,
                          lane_work *work)
{
    const int latent = model->desc.latent;
    if (m->shared)
        network_folded(m->shared, b->x + latent, b->out, work);
    else
        network_lanes(model, model->packed[0], latent + HNBRDF_ENCODING_SIZE, b->x,
                      model->packed_biases[0], b->out, work);
}

/* The steps of a block: those after its network, then, with the next items, those before. */
enum {
    STEP_COMPOSE, /* a step a channel */
    STEP_SCATTER = STEP_COMPOSE + 3,
    STEP_FIND,
    STEP_TAKE, /* a step a quarter of the lanes */
    STEP_DERIVE = STEP_TAKE + 4,
    STEP_GATHER,
    STEP_PAIR, /* not at once: what was stored number by number is slow to load as
                vectors */
    STEP_SPECULAR,
    STEP_FRESNEL,
    STEP_ENCODE,
    STEPS
};

/* Before the network: f_a, and what the network sees. */
static void analytic_step(const hnbrdf_model_desc *desc, int step, lane_block *b)
{
    const block_materials *m = &b->materials;
    lane_pairs *p = &b->pairs;
    const int edited = m->edited, neural = desc->kind == HNBRDF_KIND_NEURAL;
    if (step == STEP_PAIR)
        make_pairs(&m->by_lane, p);
    else if (step == STEP_ENCODE)
        encode_lanes(desc->encoding, edited ? &b->seen : p, p->x + desc->latent);
    else if (step == STEP_SPECULAR && edited)
        edited_lanes(&m->by_lane, &m->edits, p, &b->shine);
    else if (step == STEP_SPECULAR && !neural)
        specular_lanes(&m->by_lane, p);
    else if (step == STEP_FRESNEL && edited) {
        seen_lanes(desc->encoding, &m->edits, &b->shine, p, &b->seen);
        fitted_lanes(&m->edits, &b->shine, p, &b->seen);
    } else if (step == STEP_FRESNEL && !neural)
        fresnel_lanes(&m->by_lane, p);
}

static void compose_step(const hnbrdf_model_desc *desc, int channel, lane_block *b)
{
    if (b->materials.edited)
        compose_edited_lanes(desc, channel, &b->materials.edits, &b->seen, &b->pairs);
    else if (channel == 0)
        compose_lanes(desc, &b->pairs);
}

/* f of lanes of which some conserve energy; the others are multiplied by 1. */
KERNEL_APART void conserve_lanes(const block_materials *m, lane_pairs *b)
{
    for (int l = 0; l < LANES; l++) {
        const float k = hnbrdf_energy_factor(m->horizon[l], m->slope[l], b->wi[2][l], b->wo[2][l]);
        for (int c = 0; c < 3; c++)
            b->f[c][l] = b->f[c][l] * k;
    }
}

/* Everything between gather and scatter, but conserve_lanes(). */
KERNEL_APART void evaluate_lanes(const hnbrdf_model *model, lane_block *b)
{
    const hnbrdf_model_desc *desc = &model->desc;
    for (int step = STEP_PAIR; step <= STEP_FRESNEL; step++)
        analytic_step(desc, step, b);
    if (desc->kind == HNBRDF_KIND_GGX) {
        finish_lanes(&b->pairs);
        return;
    }
    analytic_step(desc, STEP_ENCODE, b);
    block_network(model, &b->materials, &b->pairs, NULL);
    for (int c = 0; c < 3; c++)
        compose_step(desc, c, b);
}

/* ---- Beside the network ---------------------------------------------------------------------- */

struct lane_work {
    lane_block *block;
    const hnbrdf_pairs *pairs;
    size_t next; /* first item that no block has had */
    int step, last;
    int price, due; /* of a step, in products of a lane; how many are not yet paid
                     with steps */
};

static void begin_items(lane_work *work)
{
    size_t left = work->pairs->count - work->next;
    work->block->first = work->next;
    work->block->count = smaller(LANES, left);
    work->next += work->block->count;
    if (work->block->count == 0)
        work->step = STEPS;
}

static void take_step(const hnbrdf_model_desc *desc, lane_work *work)
{
    lane_block *b = work->block;
    block_materials *m = &b->materials;
    const int step = work->step++;
    if (step < STEP_SCATTER) {
        compose_step(desc, step - STEP_COMPOSE, b);
        if (!m->edited)
            work->step = STEP_SCATTER;
    } else if (step == STEP_SCATTER) {
        if (m->conserved)
            conserve_lanes(m, &b->pairs);
        scatter(work->pairs, b->first, b->count, &b->pairs);
    } else if (step == STEP_FIND) {
        begin_items(work);
        if (b->count > 0)
            find_materials(m, b->first, b->count);
        if (b->count > 0 && m->taken)
            work->step = STEP_GATHER;
    } else if (step < STEP_DERIVE) {
        const int from = (step - STEP_TAKE) * (LANES / 4);
        take_lanes(m, from, from + LANES / 4, &b->pairs);
    } else if (step == STEP_DERIVE) {
        derive_materials(m);
    } else if (step == STEP_GATHER) {
        gather(work->pairs, b->first, b->count, &b->pairs);
    } else {
        if (step == STEP_PAIR)
            mark_lanes(&b->pairs);
        analytic_step(desc, step, b);
    }
}

KERNEL_APART void work_beside(lane_work *work, int products)
{
    const hnbrdf_model_desc *desc = &work->block->materials.of->model->desc;
    for (work->due += products; work->due >= work->price && work->step < STEPS;) {
        work->due -= work->price;
        take_step(desc, work);
        if (work->step == STEP_PAIR || work->step == STEP_DERIVE)
            break;
    }
}

static void finish_work(lane_work *work)
{
    const hnbrdf_model_desc *desc = &work->block->materials.of->model->desc;
    while (work->step < STEPS)
        take_step(desc, work);
}

/* Two blocks in turn: while the network of one is worked out, the other one ends and begins
 * anew. */
static void evaluate_blocks(const hnbrdf_materials *of, const hnbrdf_pairs *pairs)
{
    const hnbrdf_model_desc *desc = &of->model->desc;
    const int products = desc->hidden * (HNBRDF_ENCODING_SIZE + HNBRDF_MAX_OUTPUTS +
                                         (desc->layers - 1) * desc->hidden);
    const int blocks = pairs->count > LANES ? 2 : 1;
    lane_block block[2];
    lane_work work = {.pairs = pairs, .price = products / (of->prepared ? 9 : 14) + 1};
    for (int k = 0; k < blocks; k++) {
        begin_materials(of, 0, &block[k].materials);
        block[k].count = 0;
    }
    work.block = &block[0];
    work.step = STEP_FIND;
    finish_work(&work);
    for (int k = 0; block[k].count > 0; k = blocks - 1 - k) {
        work.block = &block[blocks - 1 - k];
        work.step = blocks == 1 ? STEPS : work.block->count > 0 ? STEP_COMPOSE : STEP_FIND;
        work.due = 0;
        block_network(of->model, &block[k].materials, &block[k].pairs, &work);
        finish_work(&work);
        if (work.block->count > 0 && blocks == 2)
            continue;
        work.block = &block[k];
        work.step = STEP_COMPOSE;
        finish_work(&work);
    }
}
