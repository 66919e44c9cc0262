/* guide.c: fit a mixture of GGX densities to a BRDF, to know where to look for light. */
#include "render/render.h"

#include "core/prepared.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Drawing from a mixture ------------------------------------------------------------------ */

/* Turned by half a turn about the normal, the mirror direction becomes the view direction. */
static float lobe_pdf(const hnbrdf_prepared *prepared, int retro, const float wi[3],
                      const float wo[3])
{
    float w[3] = {retro ? -wi[0] : wi[0], retro ? -wi[1] : wi[1], wi[2]};
    return hnbrdf_prepared_pdf(prepared, w, wo);
}

/* With the azimuth turned by `turn`, in [0, 1). */
static int lobe_sample(const hnbrdf_prepared *prepared, int retro, const float wo[3], float u0,
                       float u1, float turn, float wi[3])
{
    float pdf = hnbrdf_prepared_draw_turned(prepared, wo, u0, u1, turn, wi);
    wi[0] = retro ? -wi[0] : wi[0];
    wi[1] = retro ? -wi[1] : wi[1];
    return pdf > 0.0f;
}

static float guide_pdf(const render_surface *surface, const float wi[3], const float wo[3])
{
    const render_guide *guide = &surface->guide;
    float pdf = 0.0f;
    for (int k = 0; k < guide->count; k++)
        pdf += guide->lobes[k].share *
               lobe_pdf(&guide->lobes[k].prepared, guide->lobes[k].retro, wi, wo);
    return pdf;
}

/* u[0] chooses the lobe; what is left of it is a uniform number again. */
static float guide_sample(const render_surface *surface, const float wo[3], const float u[3],
                          float wi[3])
{
    const render_guide *guide = &surface->guide;
    /* u[1] and u[2] are stratified together, and stay so in each lobe: see hnbrdf_sample() */
    float left = u[1];
    int k = 0;
    while (k < guide->count - 1 && left >= guide->lobes[k].share)
        left -= guide->lobes[k++].share;
    float rest = left / guide->lobes[k].share, last = 1.0f - 0x1p-24f;
    if (!lobe_sample(&guide->lobes[k].prepared, guide->lobes[k].retro, wo,
                     rest < last ? rest : last, u[2], 0.0f, wi))
        return 0.0f;
    return guide_pdf(surface, wi, wo);
}

void render_surface_guide(render_surface *surface, const render_guide *guide)
{
    surface->guide = *guide;
    for (int k = 0; k < guide->count; k++)
        hnbrdf_prepare(guide->model, &guide->lobes[k].material, &surface->guide.lobes[k].prepared);
    surface->sample = guide_sample;
    surface->pdf = guide_pdf;
}

/* ---- Candidates ------------------------------------------------------------------------------ */

static const struct candidate {
    float alpha[2];
    int retro;
} candidates[] = {
    {{1.0f, 1.0f}, 0},   {{0.005f, 0.005f}, 0}, {{0.012f, 0.012f}, 0}, {{0.03f, 0.03f}, 0},
    {{0.06f, 0.06f}, 0}, {{0.11f, 0.11f}, 0},   {{0.2f, 0.2f}, 0},     {{0.4f, 0.4f}, 0},
    {{0.12f, 0.03f}, 0}, {{0.03f, 0.12f}, 0},   {{0.35f, 0.08f}, 0},   {{0.08f, 0.35f}, 0},
    {{0.02f, 0.02f}, 1}, {{0.06f, 0.06f}, 1},   {{0.15f, 0.15f}, 1},   {{0.35f, 0.35f}, 1},
};
enum {
    CANDIDATES = sizeof candidates / sizeof *candidates,
    VIEWS = 12,
    DRAWS = 32 * CANDIDATES, /* a view */
    STEPS = 30
};

/* The first one is as good as a cosine lobe; the others are metals, which put 9 of 10 samples in
 * GGX. */
static hnbrdf_material candidate_material(int k)
{
    hnbrdf_material material;
    hnbrdf_material_init(&material);
    memcpy(material.alpha, candidates[k].alpha, sizeof material.alpha);
    for (int c = 0; c < 3; c++) {
        material.kd[c] = k == 0 ? 1.0f : 0.0f;
        material.eta[c] = k == 0 ? 1.1f : 10.0f;
    }
    return material;
}

hnbrdf_result render_guide_model(hnbrdf_model **model, hnbrdf_error *error)
{
    hnbrdf_material material = candidate_material(0);
    const char *name = "guide";
    hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = 1, .materials = &material, .names = &name};
    return hnbrdf_model_create(&desc, NULL, model, error);
}

/* ---- Fitting --------------------------------------------------------------------------------- */

/* One direction: the density of every candidate there, and the share of f wi.z it stands for. */
typedef struct observation {
    float pdf[CANDIDATES];
    double weight;
} observation;

/* Observes one view with directions from the even mixture of all candidates, which misses no lobe
 * that any of them has. The weights of a view sum to 1, or are 0 if it reflects nothing. */
static int observe(const render_surface *surface, const hnbrdf_prepared prepared[CANDIDATES],
                   const float wo[3], hnbrdf_rng *rng, observation *observations)
{
    int count = 0;
    double total = 0.0;
    for (int draw = 0; draw < DRAWS; draw++) {
        float u[3] = {hnbrdf_rng_float(rng), hnbrdf_rng_float(rng), hnbrdf_rng_float(rng)}, wi[3],
              f[3];
        observation *o = &observations[count];
        double mixture = 0.0;
        int from = draw % CANDIDATES;
        if (!lobe_sample(&prepared[from], candidates[from].retro, wo, u[0], u[2], u[1], wi))
            continue;
        for (int k = 0; k < CANDIDATES; k++) {
            o->pdf[k] = lobe_pdf(&prepared[k], candidates[k].retro, wi, wo);
            mixture += (double)o->pdf[k] / CANDIDATES;
        }
        surface->eval(surface, 1, wi, wo, f);
        o->weight = ((double)f[0] + (double)f[1] + (double)f[2]) * (double)wi[2] / mixture;
        total += o->weight;
        count++;
    }
    for (int i = 0; i < count; i++)
        observations[i].weight = total > 0.0 ? observations[i].weight / total : 0.0;
    return count;
}

static void maximise(const observation *observations, int count, double shares[CANDIDATES])
{
    for (int k = 0; k < CANDIDATES; k++)
        shares[k] = 1.0 / CANDIDATES;
    for (int step = 0; step < STEPS; step++) {
        double sums[CANDIDATES] = {0.0}, total = 0.0;
        for (int i = 0; i < count; i++) {
            const observation *o = &observations[i];
            double mixture = 0.0;
            for (int k = 0; k < CANDIDATES; k++)
                mixture += shares[k] * (double)o->pdf[k];
            for (int k = 0; k < CANDIDATES && mixture > 0.0; k++)
                sums[k] += o->weight * shares[k] * (double)o->pdf[k] / mixture;
        }
        for (int k = 0; k < CANDIDATES; k++)
            total += sums[k];
        for (int k = 0; k < CANDIDATES && total > 0.0; k++)
            shares[k] = sums[k] / total;
    }
}

/* The largest shares; the first candidate always keeps a tenth, for what no lobe has found. */
static render_guide strongest(const hnbrdf_model *model, double shares[CANDIDATES])
{
    render_guide guide = {.model = model};
    double total = 0.0;
    shares[0] = fmax(shares[0], 0.1);
    for (int n = 0; n < RENDER_LOBES; n++) {
        int best = 0;
        for (int k = 1; k < CANDIDATES && n > 0; k++)
            best = shares[k] > shares[best] ? k : best;
        if (n > 0 && shares[best] < 0.02)
            break;
        guide.lobes[n].material = candidate_material(best);
        guide.lobes[n].retro = candidates[best].retro;
        guide.lobes[n].share = (float)shares[best];
        total += shares[best];
        shares[best] = 0.0;
        guide.count++;
    }
    for (int n = 0; n < guide.count; n++)
        guide.lobes[n].share /= (float)total;
    return guide;
}

render_guide render_guide_fit(const render_surface *const *surfaces, int count,
                              const hnbrdf_model *model)
{
    static const double golden_angle = 2.39996322972865332;
    double shares[CANDIDATES] = {1.0};
    hnbrdf_prepared prepared[CANDIDATES];
    for (int k = 0; k < CANDIDATES; k++) {
        hnbrdf_material material = candidate_material(k);
        hnbrdf_prepare(model, &material, &prepared[k]);
    }
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    observation *observations = malloc(sizeof *observations * VIEWS * DRAWS * (size_t)count);
    int observed = 0;
    for (int view = 0; view < VIEWS * count && observations; view++) {
        double z = sqrt((view / count + 0.5) / VIEWS),
               r = sqrt(1.0 - z * z); /* even in the area a sphere shows */
        float wo[3] = {(float)(r * cos(view * golden_angle)), (float)(r * sin(view * golden_angle)),
                       (float)z};
        observed += observe(surfaces[view % count], prepared, wo, &rng, observations + observed);
    }
    if (observations)
        maximise(observations, observed, shares);
    free(observations);
    return strongest(model, shares);
}
