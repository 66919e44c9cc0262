/* gallery_choose.c: which materials make a good gallery, where nobody says: by what their values do
 * over the same pairs of directions. */
#include "report/gallery.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>

enum { PAIRS = 768 };

typedef struct directions {
    float wi[PAIRS][3], wo[PAIRS][3];
} directions;

static void draw(directions *d)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < PAIRS; k++)
        do
            hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &rng, d->wi[k], d->wo[k]);
        while (d->wi[k][2] < 0.01f || d->wo[k][2] < 0.01f);
}

static void evaluate(const report_gallery *g, const directions *d, const hnbrdf_material *material,
                     float (*f)[3])
{
    hnbrdf_eval_batch(g->model, material, PAIRS, d->wi[0], 0, d->wo[0], 0, f[0], 0);
}

static double distance(float (*f)[3], float (*h)[3])
{
    double sum = 0.0;
    for (int k = 0; k < PAIRS; k++)
        for (int c = 0; c < 3; c++)
            sum += hnbrdf_smape((double)f[k][c], (double)h[k][c]);
    return sum / (3.0 * PAIRS);
}

/* How much a material changes with twice the roughness, the opposite colour, and more refraction;
 * times how far it is from its GGX part, which by itself needs no network. */
static double answer(const report_gallery *g, const directions *d, const hnbrdf_material *material)
{
    float before[PAIRS][3], after[PAIRS][3];
    double sum = 0.0;
    evaluate(g, d, material, before);
    for (int edit = 0; edit < 3; edit++) {
        hnbrdf_material edited = *material;
        for (int k = 0; k < 2 && edit == 0; k++)
            edited.alpha[k] = fminf(2.0f * edited.alpha[k], HNBRDF_MAX_ALPHA);
        for (int c = 0; c < 3 && edit == 1; c++)
            edited.kd[c] = 1.0f - edited.kd[c];
        for (int c = 0; c < 3 && edit == 2; c++)
            edited.eta[c] = fminf(edited.eta[c] + 1.0f, HNBRDF_MAX_ETA);
        evaluate(g, d, &edited, after);
        sum += distance(before, after);
    }
    hnbrdf_eval_analytic_batch(g->model, material, PAIRS, d->wi[0], 0, d->wo[0], 0, after[0], 0);
    return sum * (g->desc.kind == HNBRDF_KIND_HYBRID ? distance(before, after) : 1.0);
}

hnbrdf_result report_gallery_choose_materials(report_gallery *g, int most, hnbrdf_error *error)
{
    int count = hnbrdf_model_material_count(g->model);
    directions *d = malloc(sizeof *d);
    double *answers = malloc((size_t)count * sizeof *answers);
    const int has_memory = d && answers;
    if (has_memory) {
        draw(d);
        for (int m = 0; m < count; m++)
            answers[m] = answer(g, d, hnbrdf_model_material(g->model, m));
        while (g->material_count < most && g->material_count < count) {
            int best = 0;
            for (int m = 1; m < count; m++)
                best = answers[m] > answers[best] ? m : best;
            answers[best] = -1.0;
            g->materials[g->material_count++] = best;
        }
    }
    free(d);
    free(answers);
    return has_memory ? HNBRDF_OK : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
}

/* The pair of unused materials farthest apart; 0 if there is none. */
static int farthest(float (*values)[PAIRS][3], const char *used, int count, int pair[2])
{
    double most = -1.0;
    for (int a = 0; a < count; a++)
        for (int b = a + 1; b < count && !used[a]; b++) {
            double apart = used[b] ? -1.0 : distance(values[a], values[b]);
            if (apart > most) {
                most = apart;
                pair[0] = a;
                pair[1] = b;
            }
        }
    return most >= 0.0;
}

hnbrdf_result report_gallery_choose_pairs(report_gallery *g, int most, hnbrdf_error *error)
{
    /* Of a large database the first ones are enough to choose from. */
    enum { CANDIDATES = 48 };
    int count = hnbrdf_model_material_count(g->model);
    count = count < CANDIDATES ? count : CANDIDATES;
    directions *d = malloc(sizeof *d);
    float(*values)[PAIRS][3] = malloc((size_t)count * sizeof *values);
    char used[CANDIDATES] = {0};
    const int has_memory = d && values;
    if (has_memory) {
        draw(d);
        for (int m = 0; m < count; m++)
            evaluate(g, d, hnbrdf_model_material(g->model, m), values[m]);
        while (g->pair_count < most && farthest(values, used, count, g->pairs[g->pair_count])) {
            for (int k = 0; k < 2; k++)
                used[g->pairs[g->pair_count][k]] = 1;
            g->pair_count++;
        }
    }
    free(d);
    free(values);
    return has_memory ? HNBRDF_OK : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
}
