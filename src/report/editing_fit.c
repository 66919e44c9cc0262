/* editing_fit.c: the models that are edited, their members and cases, and the frozen fits. */
#include "report/editing.h"

#include "base/error.h"
#include "report/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double editing_alphas[EDITING_ALPHAS] = {0.08, 0.16, 0.3};

void editing_member_name(int family, double alpha, char *text, size_t size)
{
    snprintf(text, size, "%s-%s", hnbrdf_family_name(family), HNBRDF_NUMBER(alpha));
}

hnbrdf_result editing_interrupted(const editing_report *r)
{
    int done = 0;
    for (int m = 0; m < r->count; m++)
        done += r->members[m].done;
    return hnbrdf_fail(r->error, HNBRDF_ERROR_CANCELLED,
                       "%s: interrupted after %d of %d members; what is done is there",
                       r->directory, done, r->count);
}

void editing_show(const editing_report *r, double share)
{
    report_show(&r->watch, r->total > 0.0 ? (r->done + share * r->current) / r->total : 0.0,
                r->detail);
}

/* ---- Fits ------------------------------------------------------------------------------------ */

static int show_fit(void *user, const hnbrdf_fit_progress *p)
{
    static const struct {
        const char *stage;
        double begin, end;
    } stages[] = {
        {"sampling", 0.0, 0.1}, {"ggx", 0.1, 0.3}, {"network", 0.3, 0.95}, {"lobes", 0.95, 1.0}};
    const editing_report *r = user;
    for (size_t k = 0; k < sizeof stages / sizeof stages[0]; k++)
        if (strcmp(p->stage, stages[k].stage) == 0)
            editing_show(r, stages[k].begin + p->done * (stages[k].end - stages[k].begin));
    return report_stop(&r->watch);
}

hnbrdf_result editing_fit(editing_report *r, hnbrdf_measured *const *data, int count,
                          const hnbrdf_fit_options *options, hnbrdf_model **model,
                          hnbrdf_fit_report *made)
{
    hnbrdf_fit_options o = *options;
    hnbrdf_error error;
    hnbrdf_model *fitted = NULL;
    o.pool = (int)r->pool;
    o.seed = (uint64_t)r->seed;
    o.threads = (int)r->threads;
    o.progress = show_fit;
    o.progress_user = r;
    hnbrdf_result result =
        hnbrdf_fit((const hnbrdf_measured *const *)data, count, &o, &fitted, made, &error);
    if (result == HNBRDF_ERROR_CANCELLED || (result == HNBRDF_OK && made->stopped)) {
        hnbrdf_model_free(fitted);
        return editing_interrupted(r);
    }
    if (result)
        return hnbrdf_fail(r->error, result, "%s", error.text);
    *model = fitted;
    return HNBRDF_OK;
}

hnbrdf_result editing_fit_frozen(editing_report *r, int model, hnbrdf_measured *const *data,
                                 int count, hnbrdf_material *materials)
{
    hnbrdf_model *fitted;
    hnbrdf_fit_report made;
    const hnbrdf_fit_options options = {.freeze = r->models[model].model, .steps = r->frozen_steps};
    hnbrdf_result result = editing_fit(r, data, count, &options, &fitted, &made);
    if (result)
        return result;
    for (int k = 0; k < count; k++)
        materials[k] = *hnbrdf_model_material(
            fitted, hnbrdf_model_find(fitted, hnbrdf_measured_name(data[k])));
    hnbrdf_model_free(fitted);
    return HNBRDF_OK;
}

/* ---- The models ------------------------------------------------------------------------------ */

static int is_brushed(int family)
{
    return (hnbrdf_family_has(family) & HNBRDF_FAMILY_BRUSHED) != 0;
}

/* Isotropic members are fitted with isotropic materials alone, whose encoding sees no azimuth. */
static hnbrdf_result open_data(editing_report *r, int model, hnbrdf_measured **data, int *count)
{
    hnbrdf_result result = HNBRDF_OK;
    int anisotropic = 0;
    for (int m = 0; m < r->count && !result; m++) {
        const editing_member *member = &r->members[m];
        hnbrdf_family_parameters parameters;
        if (member->model != model)
            continue;
        anisotropic |= is_brushed(member->family);
        hnbrdf_family_member(member->family, member->alpha, &parameters);
        result =
            hnbrdf_family_open(member->family, &parameters, member->name, &data[*count], r->error);
        *count += !result;
    }
    for (int k = 0; k < hnbrdf_measured_builtin_count() && !r->alone && !result; k++) {
        result = hnbrdf_measured_open_builtin(k, &data[*count], r->error);
        if (!result && !anisotropic && !hnbrdf_measured_is_isotropic(data[*count]))
            hnbrdf_measured_close(data[*count]);
        else
            *count += !result;
    }
    return result;
}

static hnbrdf_result save_model(const editing_report *r, const editing_model *model)
{
    char name[80];
    snprintf(name, sizeof name, "%s.safetensors", model->name);
    char *path = report_path_join(r->directory, name, r->error);
    hnbrdf_result result =
        path ? hnbrdf_model_save(model->model, path, r->error) : HNBRDF_ERROR_MEMORY;
    free(path);
    return result;
}

static hnbrdf_result fit_model(editing_report *r, int index)
{
    editing_model *model = &r->models[index];
    hnbrdf_fit_report made;
    const hnbrdf_fit_options options = {
        .hidden = r->net[0], .layers = r->net[1], .steps = r->steps};
    int most = r->count + hnbrdf_measured_builtin_count(), count = 0;
    hnbrdf_measured **data = calloc((size_t)most, sizeof *data);
    if (!data)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    r->detail = model->name;
    hnbrdf_result result = open_data(r, index, data, &count);
    if (!result)
        result = editing_fit(r, data, count, &options, &model->model, &made);
    if (!result) {
        model->steps = made.steps;
        model->seconds = made.seconds;
        model->loss = made.best_loss;
        result = r->directory ? save_model(r, model) : HNBRDF_OK;
    }
    for (int k = 0; k < count; k++)
        hnbrdf_measured_close(data[k]);
    free(data);
    return result;
}

/* ---- Members and their cases ----------------------------------------------------------------- */

static hnbrdf_result make_cases(editing_report *r, editing_member *m)
{
    const hnbrdf_model *model = r->models[m->model].model;
    const hnbrdf_material *material =
        hnbrdf_model_material(model, hnbrdf_model_find(model, m->name));
    m->cases = calloc((size_t)editing_edit_count, sizeof *m->cases);
    if (!m->cases)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int e = 0; e < editing_edit_count; e++) {
        const editing_edit *edit = &editing_edits[e];
        editing_case *c = &m->cases[m->count];
        hnbrdf_family_parameters parameters;
        hnbrdf_family_member(m->family, m->alpha, &parameters);
        if (!editing_makes_sense(edit, m->family) ||
            !editing_edit_truth(edit, m->family, &parameters))
            continue;
        char name[HNBRDF_MAX_NAME + 1], what[48];
        editing_edit_name(edit, what, sizeof what);
        snprintf(name, sizeof name, "%s, %s", m->name, what);
        c->edit = e;
        c->materials[EDITING_UNEDITED] = c->materials[EDITING_EDITED] = *material;
        hnbrdf_result result = editing_edit_material(edit, m->family, &c->materials[EDITING_EDITED],
                                                     &c->stopped, r->error);
        if (!result)
            result = hnbrdf_family_open(m->family, &parameters, name, &c->truth, r->error);
        if (result)
            return result;
        c->materials[EDITING_GGX] = c->materials[EDITING_EDITED];
        m->count++;
    }
    return HNBRDF_OK;
}

static int is_asked_for(const editing_report *r, int family)
{
    return !r->families || r->families[family];
}

/* Of a given model those members that it has. */
static hnbrdf_result list_members(editing_report *r)
{
    int families = 0;
    while (hnbrdf_family_name(families))
        families++;
    r->members = calloc((size_t)families * EDITING_ALPHAS, sizeof *r->members);
    if (!r->members)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int pass = 0; pass < EDITING_MODELS; pass++) {
        int before = r->count;
        for (int k = 0; k < families * EDITING_ALPHAS; k++) {
            editing_member *m = &r->members[r->count];
            int family = k / EDITING_ALPHAS;
            *m = (editing_member){.family = family, .alpha = editing_alphas[k % EDITING_ALPHAS]};
            editing_member_name(family, m->alpha, m->name, sizeof m->name);
            m->model = r->given ? 0 : r->model_count;
            r->count += is_asked_for(r, family) && is_brushed(family) == pass &&
                        (!r->given || hnbrdf_model_find(r->given, m->name) >= 0);
        }
        if (!r->given && r->count > before)
            snprintf(r->models[r->model_count++].name, sizeof r->models[0].name,
                     pass ? "anisotropic" : "isotropic");
    }
    return HNBRDF_OK;
}

static hnbrdf_result take_given(editing_report *r)
{
    editing_model *m = &r->models[0];
    r->model_count = 1;
    snprintf(m->name, sizeof m->name, "%.60s", report_base_name(r->given_name));
    /* A copy, so that all models are freed alike. */
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(r->given, &desc);
    return hnbrdf_model_create(&desc, NULL, &m->model, r->error);
}

/* Rough costs of a fit and of a member's measurement, in the same unit. */
static double fit_cost(const editing_report *r)
{
    return 0.4 * (double)r->steps / 1000.0 + 3.0;
}

hnbrdf_result editing_begin(editing_report *r)
{
    hnbrdf_result result = list_members(r);
    r->total = r->count * 6.0 + (r->given ? 0.0 : r->model_count * fit_cost(r)) + 10.0;
    if (!result && r->given)
        result = take_given(r);
    for (int k = 0; k < r->model_count && !r->given && !result; k++) {
        r->current = fit_cost(r);
        result = fit_model(r, k);
        r->done += r->current;
    }
    for (int m = 0; m < r->count && !result; m++)
        result = make_cases(r, &r->members[m]);
    return result;
}

void editing_free(editing_report *r)
{
    for (int m = 0; m < r->count; m++) {
        for (int k = 0; k < r->members[m].count; k++)
            hnbrdf_measured_close(r->members[m].cases[k].truth);
        free(r->members[m].cases);
    }
    free(r->members);
    for (int k = 0; k < EDITING_MODELS; k++) {
        hnbrdf_model_free(r->models[k].model);
        free(r->pair_sets[k].list);
    }
    free(r->halves);
    report_spheres_close(&r->spheres);
}
