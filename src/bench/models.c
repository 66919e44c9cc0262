/* models.c: the models that are compared: given, fitted here, and GGX alone. */
#include "base/error.h"
#include "bench/bench.h"
#include "hnbrdf/fit.h"

#include <string.h>

static int has_name(const bench *b, const char *name)
{
    for (int k = 1; k < b->model_count; k++)
        if (strcmp(b->models[k].name, name) == 0)
            return 1;
    return 0;
}

static void set_model(bench_model *m, hnbrdf_model *model, const char *name)
{
    m->model = model;
    m->material = hnbrdf_model_material(model, 0);
    m->smape = m->psnr = m->half_smape = m->peer_smape = m->peer_psnr = (double)NAN;
    hnbrdf_model_describe(model, &m->desc);
    snprintf(m->name, sizeof m->name, "%s", name);
}

static hnbrdf_result add(bench *b, hnbrdf_model *model, const char *name, hnbrdf_error *error)
{
    b->model_count = b->model_count ? b->model_count : 1; /* room for GGX */
    const int full = b->model_count == BENCH_MODELS;
    if (full || has_name(b, name)) {
        hnbrdf_model_free(model);
        return full
                   ? hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "more than %d models", BENCH_MODELS - 1)
                   : hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "two models are called %s", name);
    }
    set_model(&b->models[b->model_count++], model, name);
    return HNBRDF_OK;
}

hnbrdf_result bench_add_model(bench *b, hnbrdf_model *model, const char *path, hnbrdf_error *error)
{
    char name[BENCH_NAME];
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    snprintf(name, sizeof name, "%.*s", dot && dot > base ? (int)(dot - base) : BENCH_NAME - 1,
             base);
    return add(b, model, name, error);
}

typedef struct fit_watch {
    const bench_watch *watch;
    const char *what;
} fit_watch;

static int show_fit(void *user, const hnbrdf_fit_progress *p)
{
    const fit_watch *w = user;
    return bench_show(w->watch, w->what, strcmp(p->stage, "network") == 0 ? p->done : 0.0, p->stage,
                      NULL) != HNBRDF_OK;
}

hnbrdf_result bench_fit_model(bench *b, hnbrdf_measured *const *data, int count,
                              const bench_fit *fit, hnbrdf_error *error)
{
    char name[BENCH_NAME], what[BENCH_NAME + 16];
    fit_watch w = {&b->watch, what};
    hnbrdf_model *model;
    snprintf(name, sizeof name, "hybrid-%dx%d", fit->net[0], fit->net[1]);
    snprintf(what, sizeof what, "fitting %s", name);
    const hnbrdf_fit_options options = {.hidden = fit->net[0],
                                        .layers = fit->net[1],
                                        .steps = fit->steps,
                                        .seconds = fit->steps ? 0.0 : fit->seconds,
                                        .pool = fit->pool,
                                        .seed = 1,
                                        .progress = show_fit,
                                        .progress_user = &w};
    hnbrdf_result result =
        hnbrdf_fit((const hnbrdf_measured *const *)data, count, &options, &model, NULL, error);
    return result ? result : add(b, model, name, error);
}

hnbrdf_result bench_add_ggx(bench *b, hnbrdf_error *error)
{
    hnbrdf_model_desc ggx = {.kind = HNBRDF_KIND_GGX};
    hnbrdf_model *model;
    const bench_model *from = &b->models[1];
    for (int k = b->model_count - 1; k > 0; k--)
        if (b->models[k].desc.kind != HNBRDF_KIND_NEURAL)
            from = &b->models[k];
    ggx.material_count = from->desc.material_count;
    ggx.materials = from->desc.materials;
    ggx.names = from->desc.names;
    hnbrdf_result result = hnbrdf_model_create(&ggx, NULL, &model, error);
    if (result)
        return result;
    set_model(&b->models[0], model, "ggx");
    return HNBRDF_OK;
}
