/* mix_fit.c: the place on the path that comes nearest to its goal: least squares after Levenberg
 * and Marquardt.
 *
 * The cost is the mean of ((f - g)/(f + g))^2 over pairs and channels, a smooth relative of SMAPE,
 * plus the squared logarithm by which an albedo is out of bounds, plus the squared distance from
 * the prior. Derivatives of f are differences, one evaluation a group of unknowns. Plain arithmetic
 * and the library's own exp and log: the same place on every machine. */
#include "edit/mix.h"

#include "core/math.h"
#include "core/model.h"

#include <math.h>
#include <string.h>

enum { MAX_STEPS = 30, MAX_TRIES = 6 };
static const double tiny = 1e-4;           /* added to f + g: darker values weigh less */
static const double albedo_weight = 900.0; /* 1 % out of bounds costs as much as 30 % in all f */
static const double difference = 2e-3;     /* of an unknown; f is known to 1e-7 relative */
static const double least_gain = 1e-4;     /* of the cost: the end of the search */

/* A place that was looked at. */
typedef struct place {
    double shift[MIX_MAX_UNKNOWNS], cost;
    mix_values f;
    mix_albedo albedo;
} place;

struct mix_work {
    place now, tried;
    mix_values moved[MIX_MAX_GROUPS];
    double slope[MIX_BOUNDED][3][MIX_MAX_UNKNOWNS]; /* of the albedo */
    double normal[MIX_MAX_UNKNOWNS][MIX_MAX_UNKNOWNS], gradient[MIX_MAX_UNKNOWNS];
    double damped[MIX_MAX_UNKNOWNS][MIX_MAX_UNKNOWNS], step[MIX_MAX_UNKNOWNS];
};
const size_t hnbrdf_mix_work_size = sizeof(mix_work);

/* ---- Residuals ------------------------------------------------------------------------------- */

static double residual(double f, double g, double *slope)
{
    double sum = f + g + tiny;
    *slope = (2.0 * g + tiny) / (sum * sum);
    return (f - g) / sum;
}

/* 0 within the bounds; the slope is by the albedo. */
static double albedo_residual(const mix_goal *goal, const mix_albedo *albedo, int view, int channel,
                              double *slope)
{
    double low = goal->low.at[view][channel], high = goal->high.at[view][channel];
    double value = fmax(albedo->at[view][channel], 1e-5), bound = fmin(fmax(value, low), high);
    *slope = value != bound ? 1.0 / value : 0.0;
    return value != bound ? (double)hnbrdf_log((float)(value / bound)) : 0.0;
}

static double value_share(const mix_goal *goal)
{
    return 1.0 / (3.0 * goal->pairs.count);
}

static double albedo_share(void)
{
    return albedo_weight / (3.0 * MIX_BOUNDED);
}

/* Fills everything of the place but the shift. */
static void look(const mix_goal *goal, const mix_prior *prior, place *p)
{
    const hnbrdf_material material = hnbrdf_mix_material(goal, p->shift);
    double slope, values = 0.0, albedos = 0.0, away = 0.0;
    hnbrdf_mix_eval(goal->model, &material, &goal->pairs, p->f);
    p->albedo = hnbrdf_mix_albedo_of(&goal->pairs, p->f[0]);
    for (int n = 0; n < goal->pairs.count; n++)
        for (int c = 0; c < 3; c++) {
            double r = residual((double)p->f[n][c], (double)goal->target[n][c], &slope);
            values += r * r;
        }
    for (int v = 0; v < MIX_BOUNDED; v++)
        for (int c = 0; c < 3; c++) {
            double r = albedo_residual(goal, &p->albedo, v, c, &slope);
            albedos += r * r;
        }
    for (int i = 0; i < goal->unknowns; i++)
        away += (p->shift[i] - prior->shift[i]) * (p->shift[i] - prior->shift[i]);
    p->cost = values * value_share(goal) + albedos * albedo_share() + away * prior->weight;
}

/* ---- Normal equations ------------------------------------------------------------------------ */

static void evaluate_moved(const mix_goal *goal, mix_work *w)
{
    for (int g = 0; g < goal->groups; g++) {
        double shift[MIX_MAX_UNKNOWNS];
        memcpy(shift, w->now.shift, sizeof shift);
        for (int c = 0; c < 3; c++) {
            int i = hnbrdf_mix_unknown(goal, g, c);
            shift[i] = w->now.shift[i] + difference;
        }
        const hnbrdf_material material = hnbrdf_mix_material(goal, shift);
        hnbrdf_mix_eval(goal->model, &material, &goal->pairs, w->moved[g]);
    }
}

/* One value: of pair n, in a channel. */
static void add_value(const mix_goal *goal, mix_work *w, int n, int channel, const int *unknowns)
{
    double slope, row[MIX_MAX_GROUPS], f = (double)w->now.f[n][channel];
    double r = residual(f, (double)goal->target[n][channel], &slope), share = value_share(goal);
    const int view = goal->pairs.view[n];
    for (int g = 0; g < goal->groups; g++) {
        double d = ((double)w->moved[g][n][channel] - f) / difference;
        row[g] = slope * d;
        if (view < MIX_BOUNDED)
            w->slope[view][channel][unknowns[g]] += d * goal->pairs.weight[n];
    }
    for (int g = 0; g < goal->groups; g++) {
        double *line = w->normal[unknowns[g]];
        w->gradient[unknowns[g]] += share * r * row[g];
        for (int k = 0; k <= g; k++) /* unknowns ascend with groups: the lower triangle */
            line[unknowns[k]] += share * row[g] * row[k];
    }
}

static void add_albedo(const mix_goal *goal, mix_work *w, int view, int channel)
{
    double slope, r = albedo_residual(goal, &w->now.albedo, view, channel, &slope);
    const double share = albedo_share();
    const double *of = w->slope[view][channel];
    for (int i = 0; slope != 0.0 && i < goal->unknowns; i++) {
        w->gradient[i] += share * r * slope * of[i];
        for (int k = 0; k <= i; k++)
            w->normal[i][k] += share * slope * slope * of[i] * of[k];
    }
}

static void make_equations(const mix_goal *goal, const mix_prior *prior, mix_work *w)
{
    memset(w->slope, 0, sizeof w->slope);
    memset(w->normal, 0, sizeof w->normal);
    memset(w->gradient, 0, sizeof w->gradient);
    evaluate_moved(goal, w);
    for (int c = 0; c < 3; c++) {
        int unknowns[MIX_MAX_GROUPS];
        for (int g = 0; g < goal->groups; g++)
            unknowns[g] = hnbrdf_mix_unknown(goal, g, c);
        for (int n = 0; n < goal->pairs.count; n++)
            add_value(goal, w, n, c, unknowns);
    }
    for (int v = 0; v < MIX_BOUNDED; v++)
        for (int c = 0; c < 3; c++)
            add_albedo(goal, w, v, c);
    for (int i = 0; i < goal->unknowns; i++) {
        w->gradient[i] += prior->weight * (w->now.shift[i] - prior->shift[i]);
        w->normal[i][i] += prior->weight;
    }
}

/* Cholesky, of the lower triangle; the diagonal is at least the prior's weight. 0 where rounding or
 * an overflow took that away. */
static int solve(int count, double a[MIX_MAX_UNKNOWNS][MIX_MAX_UNKNOWNS], double *x)
{
    for (int i = 0; i < count; i++)
        for (int j = 0; j <= i; j++) {
            double sum = a[i][j];
            for (int k = 0; k < j; k++)
                sum -= a[i][k] * a[j][k];
            if (i == j && !(sum > 0.0))
                return 0;
            a[i][j] = i == j ? sqrt(sum) : sum / a[j][j];
        }
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < i; k++)
            x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    for (int i = count - 1; i >= 0; i--) {
        for (int k = i + 1; k < count; k++)
            x[i] -= a[k][i] * x[k];
        x[i] /= a[i][i];
    }
    return 1;
}

/* ---- Search ---------------------------------------------------------------------------------- */

/* Fills w->tried; 1 if it costs less. */
static int try_step(const mix_goal *goal, const mix_prior *prior, double damping, mix_work *w)
{
    memcpy(w->damped, w->normal, sizeof w->damped);
    for (int i = 0; i < goal->unknowns; i++) {
        w->damped[i][i] *= 1.0 + damping;
        w->step[i] = -w->gradient[i];
    }
    if (!solve(goal->unknowns, w->damped, w->step))
        return 0;
    for (int i = 0; i < goal->unknowns; i++)
        w->tried.shift[i] = w->now.shift[i] + w->step[i];
    look(goal, prior, &w->tried);
    return w->tried.cost < w->now.cost;
}

double hnbrdf_mix_fit(const mix_goal *goal, mix_work *w, const mix_prior *prior,
                      double shift[MIX_MAX_UNKNOWNS])
{
    double damping = 1e-2, gain = 1.0;
    memset(&w->now, 0, sizeof w->now);
    memset(&w->tried, 0, sizeof w->tried);
    memcpy(w->now.shift, shift, (size_t)goal->unknowns * sizeof *shift);
    look(goal, prior, &w->now);
    for (int step = 0; step < MAX_STEPS && gain > least_gain * w->now.cost; step++) {
        int better = 0;
        make_equations(goal, prior, w);
        for (int k = 0; k < MAX_TRIES && !better; k++) {
            better = try_step(goal, prior, damping, w);
            damping *= better ? 0.2 : 6.0;
        }
        if (!better)
            break;
        gain = w->now.cost - w->tried.cost;
        w->now = w->tried;
    }
    memcpy(shift, w->now.shift, (size_t)goal->unknowns * sizeof *shift);
    return w->now.cost;
}
