/* options.c: the options of a fit, with what 0 stands for. */
#include "fit/trainer.h"

#include "base/error.h"
#include "core/encoding.h"

#include <float.h>
#include <math.h>

enum {
    DEFAULT_STEPS = 32000,
    DEFAULT_FROZEN_STEPS = 48,
    DEFAULT_BATCH = 2048,
    DEFAULT_POOL = 131072,
    DEFAULT_FROZEN_POOL = 16384 /* what a search looks at in the end */
};
/* The peak rate of networks with up to RATE_UNITS hidden units in all; larger ones need less in
 * proportion, or units die early and for good (64x3 on 100 materials, 8000 steps: SMAPE 0.098 at
 * 0.06, 0.075 at 0.02, 0.081 at 0.01). */
#define DEFAULT_RATE 6e-2f
#define RATE_UNITS 64
#define DEFAULT_FLOOR 0.003f
#define DEFAULT_UNIFORM_SHARE 0.667f
#define DEFAULT_BRIGHT_SHARE 0.25f
#define DEFAULT_HORIZON_SHARE 0.03f
#define DEFAULT_LIFT 1.0f
#define POOL_LIMIT 1.25e9 /* bytes of training data; beyond, fewer pairs a material */

/* Kind, sizes, encoding and floor are those of the network that stays. */
static hnbrdf_result take_frozen(hnbrdf_fit_options *o, hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(o->freeze, &desc);
    if (desc.kind == HNBRDF_KIND_GGX)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "the model to freeze is a ggx model: it has no network; fit with kind ggx instead");
    if (desc.scale != 1.0f || desc.shift != 0.0f)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "the model to freeze has scale %s and shift %s, expected 1 and 0",
                           HNBRDF_NUMBER(desc.scale), HNBRDF_NUMBER(desc.shift));
    o->kind = desc.kind;
    o->hidden = desc.hidden;
    o->layers = desc.layers;
    o->latent = desc.latent;
    o->latent_none = desc.latent == 0;
    o->encoding = hnbrdf_encoding_name(desc.encoding);
    o->floor = desc.floor;
    o->floor_none = desc.floor == 0.0f;
    return HNBRDF_OK;
}

static float default_rate(float units)
{
    return DEFAULT_RATE * fminf(1.0f, (float)RATE_UNITS / units);
}

/* A number and the flag that asks for none exclude each other. */
static hnbrdf_result check_flags(const hnbrdf_fit_options *o, hnbrdf_error *error)
{
    const struct {
        const char *number, *flag;
        double value;
        int none;
    } pairs[] = {{"latent", "latent_none", o->latent, o->latent_none},
                 {"floor", "floor_none", (double)o->floor, o->floor_none},
                 {"uniform_share", "uniform_none", (double)o->uniform_share, o->uniform_none},
                 {"bright_share", "bright_none", (double)o->bright_share, o->bright_none},
                 {"horizon_share", "horizon_none", (double)o->horizon_share, o->horizon_none},
                 {"lift", "lift_none", (double)o->lift, o->lift_none}};
    hnbrdf_encoding encoding;
    for (size_t k = 0; k < sizeof pairs / sizeof pairs[0]; k++)
        if (pairs[k].value != 0.0 && pairs[k].none)
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "fit options: %s is %s and %s is set, expected one of them",
                               pairs[k].number, HNBRDF_NUMBER(pairs[k].value), pairs[k].flag);
    if (o->encoding && !hnbrdf_encoding_from_name(o->encoding, &encoding))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "fit options: encoding is \"%.40s\", expected one of %s", o->encoding,
                           HNBRDF_ENCODING_LIST);
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_fit_fill_options(hnbrdf_fit_options *o, int count, hnbrdf_error *error)
{
    if (o->freeze) {
        hnbrdf_result result = take_frozen(o, error);
        if (result)
            return result;
    }
    hnbrdf_result flags = check_flags(o, error);
    if (flags)
        return flags;
    o->hidden = o->hidden ? o->hidden : 32;
    o->layers = o->layers ? o->layers : 2;
    if (o->latent == 0 && !o->latent_none)
        o->latent = o->kind == HNBRDF_KIND_NEURAL ? 12 : 4;
    if (o->floor == 0.0f && !o->floor_none)
        o->floor = DEFAULT_FLOOR;
    o->steps = o->steps ? o->steps : (o->freeze ? DEFAULT_FROZEN_STEPS : DEFAULT_STEPS);
    o->batch = o->batch ? o->batch : DEFAULT_BATCH;
    if (o->pool == 0)
        o->pool =
            (int)fmin(o->freeze ? DEFAULT_FROZEN_POOL : DEFAULT_POOL,
                      POOL_LIMIT / ((double)count * FIT_POOL_TILE / FIT_TILE * sizeof(float)));
    o->learning_rate = o->learning_rate == 0.0f ? default_rate((float)o->hidden * (float)o->layers)
                                                : o->learning_rate;
    if (o->uniform_share == 0.0f && !o->uniform_none)
        o->uniform_share = DEFAULT_UNIFORM_SHARE;
    if (o->bright_share == 0.0f && !o->bright_none)
        o->bright_share = DEFAULT_BRIGHT_SHARE;
    if (o->horizon_share == 0.0f && !o->horizon_none)
        o->horizon_share = DEFAULT_HORIZON_SHARE;
    if (o->lift == 0.0f && !o->lift_none)
        o->lift = DEFAULT_LIFT;
    if (o->hidden < 1 || o->hidden > HNBRDF_MAX_HIDDEN || o->layers < 1 ||
        o->layers > HNBRDF_MAX_LAYERS)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "network %dx%d, expected 1x1 to %dx%d",
                           o->hidden, o->layers, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
    if (o->latent < 0 || o->latent > HNBRDF_MAX_LATENT)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "latent code of %d floats, expected 0 to %d", o->latent,
                           HNBRDF_MAX_LATENT);
    if (o->steps < 1 || o->batch < 1 || o->batch > 1 << 24 || o->pool > 1 << 26 || o->threads < 0 ||
        !(o->seconds >= 0.0) || !(o->learning_rate > 0.0f && o->learning_rate <= FLT_MAX) ||
        !(o->floor >= 0.0f && o->floor < 1.0f) ||
        !(o->uniform_share >= 0.0f && o->uniform_share <= 1.0f) ||
        !(o->bright_share >= 0.0f && o->bright_share <= 1.0f) ||
        !(o->horizon_share >= 0.0f && o->horizon_share <= 1.0f) ||
        !(o->lift >= 0.0f && o->lift <= 1.0f) || (unsigned)o->loss > HNBRDF_FIT_SMAPE ||
        (unsigned)o->schedule > HNBRDF_FIT_CONSTANT || !hnbrdf_kind_name(o->kind))
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "a fit option is out of its range: steps, batch and pool at least 1, learning "
            "rate above 0 and finite, floor, shares and lift from 0 to 1, seconds and threads not "
            "negative");
    if (o->resume && !o->checkpoint)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "nothing to resume from: no checkpoint is named");
    if (o->kind == HNBRDF_KIND_GGX)
        o->latent = 0;
    return HNBRDF_OK;
}
