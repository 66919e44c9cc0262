/* look.c: what the searches of materials on a network that stays come to, over pairs and in the
 * pixels of a picture, summed in one order whatever the threads. */
#include "fit/frozen.h"

#include <math.h>
#include <string.h>

enum { CHUNK = 16 }; /* tiles or pixels that are added up before they join the sum */
#define HOLD 30.0    /* of the analytic part, see below */

/* Logarithms at first, which find the way from afar; SMAPE in the end. What a code costs in
 * pictures is found by pulls of several strengths: the least one that suffices is taken. */
const fit_phase hnbrdf_fit_phases[FIT_PHASES] = {
    {0.4, FIT_STARTS, 32, 0.0f, 0.2f, {0.0}},
    {0.7, 4, 128, 0.5f, 0.1f, {0.05, 0.05, 0.05, 0.05}},
    {1.0, FIT_PULLS, 256, 1.0f, 0.03f, {0.05, 0.2, 0.8, 3.0}}};

/* ---- How much -------------------------------------------------------------------------------- */

fit_unknowns hnbrdf_fit_unknowns_of(const trainer *t, int material)
{
    const int analytic = hnbrdf_fit_own_stride(&t->layout) > FIT_LANES;
    return (fit_unknowns){t->layout.latent_size, analytic, t->known[material].isotropic,
                          t->frozen->most};
}

static int chunks_of(int things)
{
    return (things + CHUNK - 1) / CHUNK;
}

int hnbrdf_fit_slots(void)
{
    int most = 0;
    for (int p = 0; p < FIT_PHASES; p++) {
        const fit_phase *phase = &hnbrdf_fit_phases[p];
        const int views = phase->pulls[0] > 0.0 ? chunks_of(FIT_VIEWS_MOST) : 0;
        const int slots = phase->searches * (chunks_of(phase->tiles) + views);
        most = slots > most ? slots : most;
    }
    return most;
}

float hnbrdf_fit_phase_mix(const trainer *t, int phase)
{
    if (t->options.loss == HNBRDF_FIT_LOG_TO_SMAPE)
        return hnbrdf_fit_phases[phase].mix;
    return t->options.loss == HNBRDF_FIT_SMAPE ? 1.0f : 0.0f;
}

static int tiles_now(const trainer *t)
{
    const int most = hnbrdf_fit_phases[t->frozen->phase].tiles;
    return t->pool.tiles < most ? t->pool.tiles : most;
}

static int views_now(const trainer *t, int held)
{
    const int seen = hnbrdf_fit_phases[t->frozen->phase].pulls[0] > 0.0;
    return seen ? t->frozen->views[held].count : 0;
}

static fit_searches *searches_of(const trainer *t, int held)
{
    return &t->frozen->of[t->held[held]];
}

/* ---- One tile -------------------------------------------------------------------------------- */

static size_t slot_of(const trainer *t, int held, int chunk, int search)
{
    const int count = (int)searches_of(t, held)->count;
    return (size_t)held * (size_t)t->frozen->slots + (size_t)(chunk * count + search);
}

/* The pairs of a tile, by all searches. */
static void look_at_tile(trainer *t, int held, int chunk, const fit_tile *tile, float *scratch)
{
    struct fit_frozen *f = t->frozen;
    const fit_searches *s = searches_of(t, held);
    const float mix = hnbrdf_fit_phase_mix(t, f->phase);
    for (int i = 0; i < s->count; i++) {
        const size_t slot = slot_of(t, held, chunk, i);
        f->sums[slot].loss +=
            t->kernel->own(&t->layout, t->parameters, t->derived, f->rows, tile, s->point[i].trial,
                           mix, hnbrdf_fit_phases[f->phase].width, scratch,
                           f->normals + slot * f->normal_size, &f->sums[slot].alone);
    }
}

static void look_at_view(trainer *t, int held, int chunk, const fit_view *view, float *scratch)
{
    struct fit_frozen *f = t->frozen;
    const fit_searches *s = searches_of(t, held);
    const fit_tile tile = hnbrdf_fit_tile_view(view->tile);
    for (int i = 0; i < s->count; i++) {
        const size_t slot = slot_of(t, held, chunk, i);
        const double pull = s->point[i].pull * (double)view->share / FIT_LIGHTS;
        double squares[FIT_LIGHTS] = {0.0};
        float weights[FIT_LIGHTS];
        for (int k = 0; k < FIT_LIGHTS; k++)
            weights[k] = (float)(pull / f->views[held].ggx[k]);
        t->kernel->pixel(&t->layout, t->parameters, t->derived, f->rows, &tile, view->lights[0],
                         weights, s->point[i].trial, scratch, f->normals + slot * f->normal_size,
                         squares);
        for (int k = 0; k < FIT_LIGHTS; k++)
            f->sums[slot].squares[k] += (double)view->share * squares[k];
    }
}

double hnbrdf_fit_loss_of(trainer *t, const float *own, const float *const *tiles, int count,
                          float *scratch)
{
    double loss = 0.0;
    for (int k = 0; k < count; k++) {
        const fit_tile tile = hnbrdf_fit_tile_view(tiles[k]);
        loss += t->kernel->own(&t->layout, t->parameters, t->derived, t->frozen->rows, &tile, own,
                               hnbrdf_fit_phase_mix(t, 0), 1.0f, scratch, NULL, NULL);
    }
    return loss;
}

/* ---- Chunks ---------------------------------------------------------------------------------- */

static void look_at_chunk(trainer *t, int held, int chunk, float *scratch)
{
    struct fit_frozen *f = t->frozen;
    const int tiles = tiles_now(t), view_chunk = chunk - chunks_of(tiles);
    float room[FIT_POOL_TILE];
    for (int i = 0; i < searches_of(t, held)->count; i++) {
        const size_t slot = slot_of(t, held, chunk, i);
        memset(f->normals + slot * f->normal_size, 0, f->normal_size * sizeof(float));
        memset(&f->sums[slot], 0, sizeof f->sums[slot]);
    }
    for (int k = chunk * CHUNK; k < (chunk + 1) * CHUNK && k < tiles; k++) {
        const fit_tile tile = hnbrdf_fit_tile_view(hnbrdf_fit_pool_fetch(&t->pool, held, k, room));
        look_at_tile(t, held, chunk, &tile, scratch);
    }
    if (view_chunk < 0)
        return;
    for (int k = view_chunk * CHUNK; k < (view_chunk + 1) * CHUNK && k < views_now(t, held); k++)
        look_at_view(t, held, chunk, &f->views[held].of[k], scratch);
}

static void look_at_unit(void *context, int index, int worker)
{
    trainer *t = context;
    const fit_unit *u = &t->frozen->units[index];
    for (int c = u->first; c < u->first + u->chunks; c++)
        look_at_chunk(t, u->held, c, t->scratch + (size_t)worker * t->layout.scratch_count);
}

/* A material whose pairs are drawn again is one unit: they come in turn. */
static void list_units(trainer *t)
{
    struct fit_frozen *f = t->frozen;
    f->unit_count = 0;
    for (int k = 0; k < t->held_count; k++) {
        const int chunks = chunks_of(tiles_now(t)) + chunks_of(views_now(t, k));
        const int each = k < t->pool.kept ? 1 : chunks;
        for (int c = 0; c < chunks; c += each)
            f->units[f->unit_count++] = (fit_unit){k, c, each};
        f->pairs +=
            (double)FIT_TILE * (tiles_now(t) + views_now(t, k)) * (double)searches_of(t, k)->count;
    }
}

/* ---- Sums ------------------------------------------------------------------------------------ */

/* What keeps the analytic part near GGX: half of HOLD times the square of what its SMAPE is above
 * that of GGX, in shares of it. */
static void hold_alone(const trainer *t, int held, int search, const fit_unknowns *unknowns,
                       double scale, fit_normal *normal)
{
    const struct fit_frozen *f = t->frozen;
    const size_t second = (size_t)(FIT_OWN + 1) * FIT_OWN;
    const int count = hnbrdf_fit_unknowns_count(unknowns);
    fit_normal alone;
    memset(&alone, 0, sizeof alone);
    for (int c = 0; c < chunks_of(tiles_now(t)); c++) {
        const size_t slot = slot_of(t, held, c, search);
        normal->alone += f->sums[slot].alone * scale / f->ggx[held];
        hnbrdf_fit_normal_add(&alone, unknowns, f->normals + slot * f->normal_size + second,
                              FIT_OWN, scale / f->ggx[held]);
    }
    const double more = fmax(normal->alone - 1.0, 0.0);
    normal->loss += 0.5 * HOLD * more * more;
    for (int i = 0; i < count && more > 0.0; i++) {
        normal->gradient[i] += HOLD * more * alone.gradient[i];
        for (int j = 0; j < count; j++)
            normal->matrix[i][j] +=
                HOLD * (more * alone.matrix[i][j] + alone.gradient[i] * alone.gradient[j]);
    }
}

static void add_up(const trainer *t, int held, int search, const fit_unknowns *unknowns,
                   fit_normal *normal)
{
    const struct fit_frozen *f = t->frozen;
    const double scale = 1.0 / (3.0 * FIT_TILE * tiles_now(t));
    const int before = chunks_of(tiles_now(t)), all = before + chunks_of(views_now(t, held));
    memset(normal, 0, sizeof *normal);
    for (int c = 0; c < all; c++) {
        const size_t slot = slot_of(t, held, c, search);
        hnbrdf_fit_normal_add(normal, unknowns, f->normals + slot * f->normal_size,
                              hnbrdf_fit_own_stride(&t->layout), c < before ? scale : 1.0);
        normal->pairs += f->sums[slot].loss * scale;
        for (int k = 0; k < FIT_LIGHTS && c >= before; k++)
            normal->worth[k] += f->sums[slot].squares[k] / f->views[held].ggx[k];
    }
    normal->loss = normal->pairs;
    if (unknowns->analytic)
        hold_alone(t, held, search, unknowns, scale, normal);
    for (int k = 0; k < FIT_LIGHTS; k++)
        normal->loss += searches_of(t, held)->point[search].pull * normal->worth[k] / FIT_LIGHTS;
}

/* SMAPE of GGX over the tiles of a phase. */
static double ggx_smape(const trainer *t, int held)
{
    float room[FIT_POOL_TILE];
    double sum = 0.0;
    for (int k = 0; k < tiles_now(t); k++) {
        const float *tile = hnbrdf_fit_pool_fetch(&t->pool, held, k, room);
        for (int i = 0; i < 3 * FIT_TILE; i++) {
            const double f = (double)tile[FIT_POOL_ANALYTIC + i];
            const double g = (double)tile[FIT_POOL_TARGET + i];
            sum += 2.0 * fabs(f - g) / (f + g + FIT_SMAPE_OFFSET);
        }
    }
    return fmax(sum / (3.0 * FIT_TILE * tiles_now(t)), 1e-4);
}

static void measure_ggx(void *context, int held, int worker)
{
    trainer *t = context;
    (void)worker;
    t->frozen->ggx[held] = ggx_smape(t, held);
}

static void settle(void *context, int held, int worker)
{
    trainer *t = context;
    fit_searches *s = searches_of(t, held);
    const fit_unknowns unknowns = hnbrdf_fit_unknowns_of(t, t->held[held]);
    (void)worker;
    for (int i = 0; i < s->count; i++) {
        fit_normal normal;
        add_up(t, held, i, &unknowns, &normal);
        hnbrdf_fit_point_settle(&s->point[i], &unknowns, &normal);
    }
}

void hnbrdf_fit_look(trainer *t)
{
    if (hnbrdf_fit_own_stride(&t->layout) > FIT_LANES && t->frozen->ggx_phase != t->frozen->phase) {
        hnbrdf_threads_run(t->workers, t->held_count, measure_ggx, t);
        t->frozen->ggx_phase = t->frozen->phase;
    }
    list_units(t);
    hnbrdf_threads_run(t->workers, t->frozen->unit_count, look_at_unit, t);
    hnbrdf_threads_run(t->workers, t->held_count, settle, t);
}

double hnbrdf_fit_own_flops(const fit_layout *l)
{
    const double h = l->hidden_size, hidden = (l->layers - 1) * h * h;
    const double each = l->outputs / 3.0 * h + hidden + h * l->latent_size;
    const double own = l->latent_size;
    return 2.0 * (FIT_INPUTS * h + hidden + h * l->outputs + 3.0 * (each + own * own));
}
