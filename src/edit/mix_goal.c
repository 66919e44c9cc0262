/* mix_goal.c: what a place on the path between two materials should be.
 *
 * Both ends, edited to kd, eta and alpha of the straight line, have their lobes in the same place
 * and of the same width; the network carries along what it knows of each. Their values are blended
 * in the logarithm. The albedo stays between those of the ends as they are. */
#include "edit/mix.h"

#include "core/math.h"
#include "core/model.h"

#include <math.h>
#include <string.h>

/* What is added before the logarithm: values below count as nearly black. */
static const float dark = 1e-5f;
/* Bounds of the albedo: what is below counts as this, and how far beyond may be. */
static const double dark_albedo = 1e-3, widened = 1.03;
/* A shift of kd and the like is a factor of at most exp(3). */
static const double most_shift = 3.0;

/* ---- Reflectance ----------------------------------------------------------------------------- */

static double reflectance(float eta)
{
    double r = ((double)eta - 1.0) / ((double)eta + 1.0);
    return r * r;
}

/* eta of this reflectance, in (1, HNBRDF_MAX_ETA]: 1e-13 gives 1 + 6e-7, 0.995 gives 799. */
static float eta_of(double reflectance)
{
    double r = sqrt(fmin(fmax(reflectance, 1e-13), 0.995));
    return (float)((1.0 + r) / (1.0 - r));
}

static double log_ratio(double a, double b)
{
    if (a == b)
        return 0.0;
    double x = (double)hnbrdf_log((float)fmax(a, 1e-9)) - (double)hnbrdf_log((float)fmax(b, 1e-9));
    return fmin(fmax(x, -most_shift), most_shift);
}

static double shifted(double value, double shift)
{
    shift = fmin(fmax(shift, -most_shift), most_shift);
    return shift != 0.0 ? value * (double)hnbrdf_exp((float)shift) : value;
}

/* ---- Shifts ---------------------------------------------------------------------------------- */

static hnbrdf_fitted analytic_of(const hnbrdf_material *m)
{
    hnbrdf_fitted now;
    memcpy(now.kd, m->kd, sizeof now.kd);
    memcpy(now.eta, m->eta, sizeof now.eta);
    memcpy(now.alpha, m->alpha, sizeof now.alpha);
    return now;
}

static hnbrdf_fitted fitted_of(const hnbrdf_material *m)
{
    return m->fitted.alpha[0] != 0.0f ? m->fitted : analytic_of(m);
}

static void shift_analytic(hnbrdf_fitted *values, const double *kd, const double *eta, double alpha)
{
    for (int c = 0; c < 3; c++) {
        values->kd[c] = (float)fmin(shifted((double)values->kd[c], kd[c]), 1.0);
        if (eta[c] != 0.0)
            values->eta[c] = eta_of(shifted(reflectance(values->eta[c]), eta[c]));
    }
    for (int k = 0; k < 2; k++)
        values->alpha[k] = hnbrdf_clamp((float)shifted((double)values->alpha[k], alpha),
                                        HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
}

int hnbrdf_mix_unknown(const mix_goal *goal, int group, int channel)
{
    const int latent = goal->model->desc.latent, behind = group - latent;
    if (behind < 0)
        return group;
    return latent + (behind < MIX_CHANNEL_GROUPS
                         ? 3 * behind + channel
                         : 3 * MIX_CHANNEL_GROUPS + behind - MIX_CHANNEL_GROUPS);
}

hnbrdf_material hnbrdf_mix_material(const mix_goal *goal, const double shift[MIX_MAX_UNKNOWNS])
{
    hnbrdf_material m = goal->straight;
    const int latent = goal->model->desc.latent;
    const double *of = shift + latent;
    for (int i = 0; i < latent; i++)
        m.latent[i] = (float)((double)m.latent[i] + shift[i]);
    if (goal->unknowns == latent)
        return m;
    hnbrdf_fitted now = analytic_of(&m);
    m.fitted = fitted_of(&m);
    shift_analytic(&now, of, of + 3, of[12]);
    shift_analytic(&m.fitted, of + 6, of + 9, of[13]);
    memcpy(m.kd, now.kd, sizeof m.kd);
    memcpy(m.eta, now.eta, sizeof m.eta);
    memcpy(m.alpha, now.alpha, sizeof m.alpha);
    return m;
}

void hnbrdf_mix_shift_to(const mix_goal *goal, const hnbrdf_material *end,
                         double shift[MIX_MAX_UNKNOWNS])
{
    const int latent = goal->model->desc.latent;
    const hnbrdf_fitted to = fitted_of(end), from = fitted_of(&goal->straight);
    double *of = shift + latent;
    memset(shift, 0, MIX_MAX_UNKNOWNS * sizeof *shift);
    for (int i = 0; i < latent; i++)
        shift[i] = (double)end->latent[i] - (double)goal->straight.latent[i];
    if (goal->unknowns == latent)
        return;
    for (int c = 0; c < 3; c++) {
        of[6 + c] = log_ratio((double)to.kd[c], (double)from.kd[c]);
        of[9 + c] = log_ratio(reflectance(to.eta[c]), reflectance(from.eta[c]));
    }
    of[13] = 0.5 * (log_ratio((double)to.alpha[0], (double)from.alpha[0]) +
                    log_ratio((double)to.alpha[1], (double)from.alpha[1]));
}

/* ---- Target ---------------------------------------------------------------------------------- */

static hnbrdf_material edited_to(const hnbrdf_material *end, const hnbrdf_material *straight)
{
    hnbrdf_material m = *straight;
    memcpy(m.latent, end->latent, sizeof m.latent);
    m.fitted = fitted_of(end);
    return m;
}

/* Between a and b in the logarithm above `dark`. */
static float blend(float a, float b, float t)
{
    float x = (1.0f - t) * hnbrdf_log(a + dark) + t * hnbrdf_log(b + dark);
    return a == b ? a : fmaxf(hnbrdf_exp(x) - dark, 0.0f);
}

static void set_bounds(const mix_albedo *a, const mix_albedo *b, mix_goal *goal)
{
    for (int v = 0; v < MIX_BOUNDED; v++)
        for (int c = 0; c < 3; c++) {
            goal->low.at[v][c] = fmax(fmin(a->at[v][c], b->at[v][c]), dark_albedo) / widened;
            goal->high.at[v][c] = fmax(fmax(a->at[v][c], b->at[v][c]), dark_albedo) * widened;
        }
}

void hnbrdf_mix_goal_make(const hnbrdf_model *model, const hnbrdf_material *a,
                          const hnbrdf_material *b, const mix_albedo albedos[2], float t,
                          mix_goal *goal)
{
    const hnbrdf_material *ends[2] = {a, b};
    const int latent = model->desc.latent, analytic = model->desc.kind == HNBRDF_KIND_HYBRID;
    goal->model = model;
    goal->unknowns = latent + analytic * MIX_SHIFTS;
    goal->groups = latent + analytic * (MIX_CHANNEL_GROUPS + MIX_ALPHA_GROUPS);
    hnbrdf_material_mix(a, b, t, &goal->straight);
    hnbrdf_mix_pairs_make(model, &goal->straight, MIX_SIDE, 0, &goal->pairs);
    for (int e = 0; e < 2; e++) {
        const hnbrdf_material edited = edited_to(ends[e], &goal->straight);
        hnbrdf_mix_eval(model, &edited, &goal->pairs, goal->ends[e]);
    }
    for (int n = 0; n < goal->pairs.count; n++)
        for (int c = 0; c < 3; c++)
            goal->target[n][c] = blend(goal->ends[0][n][c], goal->ends[1][n][c], t);
    set_bounds(&albedos[0], &albedos[1], goal);
}
