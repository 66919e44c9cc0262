/* descent.c: steps of Levenberg and Marquardt. In double, by additions, multiplications, divisions
 * and square roots alone: the same bits everywhere. */
#include "fit/descent.h"

#include "fit/ggx.h"

#include <math.h>
#include <string.h>

#define FIRST_DAMPING 0.03
#define LEAST_DAMPING 1e-7
#define MOST_DAMPING 1e7
#define BETTER 0.25 /* damping after a step that went well */
#define WORSE 4.0   /* and after one that did not */

/* ---- Numbers --------------------------------------------------------------------------------- */

int hnbrdf_fit_unknowns_count(const fit_unknowns *u)
{
    return u->latent + (u->analytic ? FIT_ROTATION - u->isotropic : 0);
}

/* Where the unknown of number `own` stands; -1: it is none. */
static int place(const fit_unknowns *u, int own)
{
    if (own < FIT_LANES)
        return own < u->latent ? own : -1;
    const int a = own - FIT_LANES;
    if (!u->analytic || a >= FIT_ROTATION)
        return -1;
    return u->latent + (u->isotropic && a > FIT_ALPHA ? FIT_ALPHA : a);
}

void hnbrdf_fit_normal_add(fit_normal *normal, const fit_unknowns *u, const float *sums, int stride,
                           double scale)
{
    for (int i = 0; i < stride; i++) {
        const int row = place(u, i);
        if (row < 0)
            continue;
        normal->gradient[row] += (double)sums[i] * scale;
        for (int j = 0; j < stride; j++)
            if (place(u, j) >= 0)
                normal->matrix[row][place(u, j)] += (double)sums[(i + 1) * stride + j] * scale;
    }
}

/* ---- Steps ----------------------------------------------------------------------------------- */

/* x = -m^-1 g by Cholesky, m with its diagonal times 1 + damping. 0 where it has no root. */
static int solve(const fit_normal *normal, int count, double damping, double *x)
{
    double root[FIT_UNKNOWNS][FIT_UNKNOWNS], most = 0.0;
    for (int i = 0; i < count; i++)
        most = fmax(most, normal->matrix[i][i]);
    for (int i = 0; i < count; i++)
        for (int j = 0; j <= i; j++) {
            double sum = normal->matrix[i][j];
            if (i == j)
                sum += damping * (sum + 1e-4 * most) + 1e-12 * most;
            for (int k = 0; k < j; k++)
                sum -= root[i][k] * root[j][k];
            if (i == j && !(sum > 0.0))
                return 0;
            root[i][j] = i == j ? sqrt(sum) : sum / root[j][j];
        }
    for (int i = 0; i < count; i++) {
        x[i] = -normal->gradient[i];
        for (int k = 0; k < i; k++)
            x[i] -= root[i][k] * x[k];
        x[i] /= root[i][i];
    }
    for (int i = count - 1; i >= 0; i--) {
        for (int k = i + 1; k < count; k++)
            x[i] -= root[k][i] * x[k];
        x[i] /= root[i][i];
    }
    return 1;
}

static void propose(fit_point *p, const fit_unknowns *u)
{
    double step[FIT_UNKNOWNS];
    const int count = hnbrdf_fit_unknowns_count(u);
    memcpy(p->trial, p->at, sizeof p->trial);
    while (!solve(&p->normal, count, p->damping, step)) {
        if (p->damping >= MOST_DAMPING)
            return;
        p->damping *= WORSE;
    }
    for (int i = 0; i < FIT_OWN; i++)
        if (place(u, i) >= 0)
            p->trial[i] = (float)((double)p->at[i] + step[place(u, i)]);
    for (int i = 0; i < FIT_OWN; i++)
        if (!(fabsf(p->trial[i]) <= 1e6f))
            p->trial[i] = p->at[i];
    p->trial[0] = u->latent > 0 ? fminf(p->trial[0], u->most) : 0.0f;
    if (u->analytic)
        hnbrdf_fit_ggx_project(p->trial + FIT_LANES, u->isotropic);
}

void hnbrdf_fit_point_start(fit_point *p, const float *own)
{
    memset(p, 0, sizeof *p);
    p->damping = FIRST_DAMPING;
    memcpy(p->at, own, sizeof p->at);
    memcpy(p->trial, own, sizeof p->trial);
}

void hnbrdf_fit_point_renew(fit_point *p)
{
    p->known = 0;
    p->damping = FIRST_DAMPING;
    memcpy(p->trial, p->at, sizeof p->trial);
}

void hnbrdf_fit_point_settle(fit_point *p, const fit_unknowns *u, const fit_normal *trial)
{
    if (!p->known || !isfinite(p->normal.loss) || trial->loss < p->normal.loss) {
        p->normal = *trial;
        memcpy(p->at, p->trial, sizeof p->at);
        p->damping = p->known ? fmax(p->damping * BETTER, LEAST_DAMPING) : p->damping;
        p->known = 1;
    } else {
        p->damping = fmin(p->damping * WORSE, MOST_DAMPING);
    }
    propose(p, u);
}
