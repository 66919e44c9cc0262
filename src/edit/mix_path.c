/* mix_path.c: a path from one material to another that can be walked: knots, from the middle
 * out. */
#include "hnbrdf/edit.h"

#include "base/error.h"
#include "base/memory.h"
#include "core/model.h"
#include "edit/mix.h"

#include <math.h>
#include <string.h>

/* Weight of the distance from the straight line. */
static const double loose = 1e-3;
/* The same from half way between two knots that are half of the path apart; 4 times as
 * much wherever they are half as far. */
static const double smooth = 3e-2;

/* A cost beyond this: an albedo that is out of its bounds by a tenth or more. */
static const double lost = 1.0;

enum { LAST = HNBRDF_MIX_KNOTS - 1, MIDDLE = LAST / 2 };

typedef struct path_work {
    const hnbrdf_model *model;
    const hnbrdf_material *ends[2];
    mix_albedo albedos[2];
    double shifts[HNBRDF_MIX_KNOTS][MIX_MAX_UNKNOWNS]; /* 0 at both ends */
    mix_goal goal;
    mix_work *fit;
} path_work;

static void measure_ends(path_work *p)
{
    for (int e = 0; e < 2; e++) {
        hnbrdf_mix_pairs_make(p->model, p->ends[e], MIX_END_SIDE, 1, &p->goal.pairs);
        hnbrdf_mix_eval(p->model, p->ends[e], &p->goal.pairs, p->goal.ends[e]);
        p->albedos[e] = hnbrdf_mix_albedo_of(&p->goal.pairs, p->goal.ends[e][0]);
    }
}

static void aim(path_work *p, int knot)
{
    hnbrdf_mix_goal_make(p->model, p->ends[0], p->ends[1], p->albedos, (float)knot / LAST,
                         &p->goal);
}

/* From the straight line and from both ends: the best. */
static hnbrdf_material fit_middle(path_work *p)
{
    const mix_prior prior = {.weight = loose};
    double best = INFINITY;
    aim(p, MIDDLE);
    for (int start = 0; start < 3; start++) {
        double shift[MIX_MAX_UNKNOWNS] = {0.0};
        if (start > 0)
            hnbrdf_mix_shift_to(&p->goal, p->ends[start - 1], shift);
        double cost = hnbrdf_mix_fit(&p->goal, p->fit, &prior, shift);
        if (cost < best) {
            best = cost;
            memcpy(p->shifts[MIDDLE], shift, sizeof shift);
        }
    }
    return hnbrdf_mix_material(&p->goal, p->shifts[MIDDLE]);
}

/* From half way between two knots: the path does not leap to another valley. There may be none
 * there: the network's exponent can be beyond what is computed, where nothing has a slope. Then
 * from the knots, and from the straight line. */
static hnbrdf_material fit_between(path_work *p, int knot, int distance)
{
    const double *a = p->shifts[knot - distance], *b = p->shifts[knot + distance];
    mix_prior prior = {.weight = smooth * MIDDLE / distance * MIDDLE / distance};
    double best = INFINITY;
    aim(p, knot);
    for (int i = 0; i < MIX_MAX_UNKNOWNS; i++)
        prior.shift[i] = 0.5 * (a[i] + b[i]);
    for (int start = 0; start < 4 && best > lost; start++) {
        double shift[MIX_MAX_UNKNOWNS] = {0.0};
        const double *from[] = {prior.shift, a, b, shift};
        memcpy(shift, from[start], sizeof shift);
        double cost = hnbrdf_mix_fit(&p->goal, p->fit, &prior, shift);
        if (cost < best) {
            best = cost;
            memcpy(p->shifts[knot], shift, sizeof shift);
        }
    }
    return hnbrdf_mix_material(&p->goal, p->shifts[knot]);
}

static void straight_path(const hnbrdf_material *a, const hnbrdf_material *b,
                          hnbrdf_material knots[HNBRDF_MIX_KNOTS])
{
    for (int k = 0; k <= LAST; k++)
        hnbrdf_material_mix(a, b, (float)k / LAST, &knots[k]);
}

static void fit_path(path_work *p, hnbrdf_material knots[HNBRDF_MIX_KNOTS])
{
    measure_ends(p);
    knots[MIDDLE] = fit_middle(p);
    for (int distance = MIDDLE / 2; distance > 0; distance /= 2)
        for (int k = distance; k < LAST; k += 2 * distance)
            knots[k] = fit_between(p, k, distance);
}

hnbrdf_result hnbrdf_mix_path_fit(const hnbrdf_model *model, const hnbrdf_material *a,
                                  const hnbrdf_material *b, hnbrdf_material knots[HNBRDF_MIX_KNOTS],
                                  hnbrdf_error *error)
{
    hnbrdf_error inner;
    if (!model || !a || !b || !knots)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s is NULL",
                           !model ? "model"
                           : !a   ? "a"
                           : !b   ? "b"
                                  : "path");
    const hnbrdf_material ends[2] = {*a, *b}; /* of the path, perhaps */
    hnbrdf_material made[HNBRDF_MIX_KNOTS];
    for (int e = 0; e < 2; e++) {
        hnbrdf_result result = hnbrdf_material_check(&ends[e], &inner);
        if (result)
            return hnbrdf_fail(error, result, "material %c: %s", "ab"[e], inner.text);
    }
    straight_path(&ends[0], &ends[1], made);
    if (model->desc.kind != HNBRDF_KIND_GGX) {
        const size_t size = sizeof(path_work) + hnbrdf_mix_work_size;
        path_work *p = (path_work *)hnbrdf_allocate(&model->allocator, size);
        if (!p)
            return hnbrdf_fail_memory(error, size, "a path between two materials");
        memset(p, 0, sizeof *p);
        p->model = model;
        p->ends[0] = &ends[0];
        p->ends[1] = &ends[1];
        p->fit = (mix_work *)(p + 1);
        fit_path(p, made);
        hnbrdf_release(&model->allocator, p);
    }
    memcpy(knots, made, sizeof made);
    return HNBRDF_OK;
}

void hnbrdf_mix_path_at(const hnbrdf_material path[HNBRDF_MIX_KNOTS], float t, hnbrdf_material *out)
{
    if (!(t > 0.0f && t < 1.0f)) {
        *out = path[t >= 1.0f ? LAST : 0];
        return;
    }
    const int knot = (int)(t * LAST); /* exact: LAST is a power of 2 */
    hnbrdf_material_mix(&path[knot], &path[knot + 1], t * LAST - (float)knot, out);
}
