/* options.c: which options of a bake are refused, and what 0 stands for. */
#include "bake/task.h"
#include "core/encoding.h"

#include <stdlib.h>
#include <string.h>

enum {
    PAIRS = 200000,
    STEPS = 32000,
    RESTARTS = 4,
    MOST_RESTARTS = 32,
    LEAST_POOL = 64,
    MOST_POOL = 1 << 26,
    MOST_THREADS = 256
};

static hnbrdf_result refuse(hnbrdf_error *error, const char *what, long long found, long long low,
                            long long high)
{
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                       "bake options: %s is %lld, expected a whole number from %lld to %lld", what,
                       found, low, high);
}

static hnbrdf_result check_range(const char *what, long long found, long long low, long long high,
                                 hnbrdf_error *error)
{
    return found >= low && found <= high ? HNBRDF_OK : refuse(error, what, found, low, high);
}

/* Above 0 and at most high; `or_zero` 1: 0 too. NaN is refused. */
static hnbrdf_result check_real(const char *what, double found, double high, int or_zero,
                                hnbrdf_error *error)
{
    if ((found > 0.0 && found <= high) || (or_zero && found == 0.0))
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                       "bake options: %s is %s, expected a number above 0 and at most %s", what,
                       HNBRDF_NUMBER(found), HNBRDF_NUMBER(high));
}

static hnbrdf_result check_wish(const hnbrdf_bake_options *o, hnbrdf_error *error)
{
    hnbrdf_result result;
    switch (o->wish) {
    case HNBRDF_BAKE_AUTO:
    case HNBRDF_BAKE_FRONT:
        return HNBRDF_OK;
    case HNBRDF_BAKE_ERROR:
        return check_real("max_error", o->max_error, 2.0, 0, error);
    case HNBRDF_BAKE_TIME:
        if (o->max_ggx != 0.0)
            return check_real("max_ggx", o->max_ggx, 1e6, 0, error);
        return check_real("max_ns", o->max_ns, 1e12, 0, error);
    case HNBRDF_BAKE_SIZE:
        if (o->max_multiplications > 0)
            return HNBRDF_OK;
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "bake options: max_multiplications is 0, expected at least 1");
    case HNBRDF_BAKE_NET:
        result = check_range("hidden", o->hidden, 1, HNBRDF_MAX_HIDDEN, error);
        return result ? result : check_range("layers", o->layers, 1, HNBRDF_MAX_LAYERS, error);
    }
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                       "bake options: wish is %d, expected an HNBRDF_BAKE_ constant", (int)o->wish);
}

static hnbrdf_result check_numbers(const hnbrdf_bake_options *o, hnbrdf_error *error)
{
    const struct {
        const char *what;
        long long found, low, high;
    } whole[] = {{"judge", o->judge, HNBRDF_BAKE_MEAN, HNBRDF_BAKE_WORST},
                 {"analytic", o->analytic, HNBRDF_BAKE_ANALYTIC_AUTO, HNBRDF_BAKE_ANALYTIC_FIT},
                 {"sampler", o->sampler, HNBRDF_SAMPLER_UNIFORM, HNBRDF_SAMPLER_GRID},
                 {"latent", o->latent, 0, HNBRDF_MAX_LATENT},
                 {"steps", o->steps, 0, 1000000000},
                 {"restarts", o->restarts, 0, MOST_RESTARTS},
                 {"pool", o->pool, o->pool ? LEAST_POOL : 0, MOST_POOL},
                 {"threads", o->threads, 0, MOST_THREADS}};
    hnbrdf_result result = HNBRDF_OK;
    for (size_t k = 0; k < sizeof whole / sizeof whole[0] && !result; k++)
        result = check_range(whole[k].what, whole[k].found, whole[k].low, whole[k].high, error);
    if (!result)
        result = check_real("seconds", o->seconds, 1e7, 1, error);
    if (!result && o->encoding && o->all_encodings)
        result = hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                             "bake options: encoding is %.40s and all_encodings is set, expected "
                             "one of them",
                             o->encoding);
    if (!result && o->latent && o->latent_none)
        result = hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                             "bake options: latent is %d and latent_none is set, expected one of "
                             "them",
                             o->latent);
    return result;
}

/* Every index of the model once. */
static hnbrdf_result choose_materials(bake_task *b, hnbrdf_error *error)
{
    const hnbrdf_bake_options *o = &b->options;
    int all = hnbrdf_model_material_count(b->model);
    b->count = o->materials ? o->material_count : all;
    hnbrdf_result result = check_range("material_count", b->count, 1, all, error);
    if (result)
        return result;
    b->chosen = malloc((size_t)b->count * sizeof *b->chosen);
    char *seen = calloc((size_t)all, 1);
    if (!b->chosen || !seen)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int m = 0; m < b->count && !result; m++) {
        int at = b->chosen[m] = o->materials ? o->materials[m] : m;
        result = check_range("an index in materials", at, 0, all - 1, error);
        if (!result && seen[at])
            result = hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                                 "bake options: materials has %s twice, expected each once",
                                 hnbrdf_model_material_name(b->model, at));
        if (!result)
            seen[at] = 1;
    }
    free(seen);
    return result;
}

static hnbrdf_result find_encoding(bake_task *b, hnbrdf_error *error)
{
    b->encoding = -1;
    if (!b->options.encoding)
        return HNBRDF_OK;
    hnbrdf_encoding encoding;
    if (hnbrdf_encoding_from_name(b->options.encoding, &encoding)) {
        b->encoding = (int)encoding;
        return HNBRDF_OK;
    }
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                       "bake options: encoding is %.40s, expected one of %s", b->options.encoding,
                       HNBRDF_ENCODING_LIST);
}

static hnbrdf_result choose_analytic(bake_task *b, hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(b->model, &desc);
    int neural = desc.kind == HNBRDF_KIND_NEURAL;
    b->keep = b->options.analytic == HNBRDF_BAKE_ANALYTIC_AUTO
                  ? !b->from_data && !neural
                  : b->options.analytic == HNBRDF_BAKE_ANALYTIC_KEEP;
    if (b->keep && neural)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "bake options: analytic is HNBRDF_BAKE_ANALYTIC_KEEP, but a neural "
                           "model has no analytic part to keep");
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_bake_take_options(bake_task *b, const hnbrdf_bake_options *options,
                                       hnbrdf_error *error)
{
    hnbrdf_bake_options *o = &b->options;
    if (options)
        *o = *options;
    hnbrdf_result result = check_wish(o, error);
    if (!result)
        result = check_numbers(o, error);
    if (!result)
        result = choose_materials(b, error);
    if (!result)
        result = find_encoding(b, error);
    b->from_data = o->data != NULL;
    if (!result)
        result = choose_analytic(b, error);
    b->latent = o->latent_none ? 0 : o->latent ? o->latent : -1;
    o->pairs = o->pairs ? o->pairs : PAIRS;
    o->steps = o->steps ? o->steps : STEPS;
    o->restarts = o->restarts ? o->restarts : RESTARTS;
    return result;
}
