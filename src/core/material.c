/* material.c: make, check and interpolate a material. */
#include "base/error.h"
#include "core/carry.h"

#include <math.h>
#include <string.h>

void hnbrdf_material_init(hnbrdf_material *material)
{
    memset(material, 0, sizeof *material);
    for (int c = 0; c < 3; c++) {
        material->kd[c] = 0.5f;
        material->eta[c] = 1.5f;
    }
    material->alpha[0] = material->alpha[1] = 0.5f;
}

static hnbrdf_result range(const char *field, int index, float value, float low, float high,
                           hnbrdf_error *error)
{
    if (value >= low && value <= high)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s[%d] is %s, expected %s to %s", field,
                       index, HNBRDF_NUMBER(value), HNBRDF_NUMBER(low), HNBRDF_NUMBER(high));
}

static hnbrdf_result check_lobes(const hnbrdf_lobes *lobes, hnbrdf_error *error)
{
    hnbrdf_result result;
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        float size = fabsf(lobes->scale[k]);
        if (size != 0.0f && (result = range("lobes.scale", k, size, 1e-4f, 1e4f, error)))
            return result;
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
            if ((result = range(k ? "lobes.share[1]" : "lobes.share[0]", j, lobes->share[k][j],
                                0.0f, 1.0f, error)))
                return result;
    }
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
        if ((result = range("sum of lobes.share", j, lobes->share[0][j] + lobes->share[1][j], 0.0f,
                            1.0f, error)))
            return result;
    return HNBRDF_OK;
}

static hnbrdf_result check_energy(const hnbrdf_energy *energy, hnbrdf_error *error)
{
    if (!(energy->horizon >= 0.0f && energy->horizon <= 1.0f))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "energy.horizon is %s, expected 0 to 1",
                           HNBRDF_NUMBER(energy->horizon));
    if (!(energy->slope >= 0.0f && energy->slope <= 1e4f))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "energy.slope is %s, expected 0 to 10000",
                           HNBRDF_NUMBER(energy->slope));
    return HNBRDF_OK;
}

/* names: of the three fields. */
static hnbrdf_result check_analytic(const char *const names[3], const float kd[3],
                                    const float eta[3], const float alpha[2], hnbrdf_error *error)
{
    hnbrdf_result result;
    for (int c = 0; c < 3; c++)
        if ((result = range(names[0], c, kd[c], 0.0f, 1.0f, error)))
            return result;
    for (int c = 0; c < 3; c++)
        if (!(eta[c] > 1.0f && eta[c] <= HNBRDF_MAX_ETA))
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "%s[%d] is %s, expected above 1, at most %s", names[1], c,
                               HNBRDF_NUMBER(eta[c]), HNBRDF_NUMBER(HNBRDF_MAX_ETA));
    for (int c = 0; c < 2; c++)
        if ((result = range(names[2], c, alpha[c], HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA, error)))
            return result;
    return HNBRDF_OK;
}

static int is_zero(const hnbrdf_fitted *fitted)
{
    float sum = 0.0f;
    for (int c = 0; c < 3; c++)
        sum += fabsf(fitted->kd[c]) + fabsf(fitted->eta[c]);
    return sum + (fabsf(fitted->alpha[0]) + fabsf(fitted->alpha[1])) == 0.0f;
}

hnbrdf_result hnbrdf_material_check(const hnbrdf_material *material, hnbrdf_error *error)
{
    static const char *const names[3] = {"kd", "eta", "alpha"};
    static const char *const fitted_names[3] = {"fitted.kd", "fitted.eta", "fitted.alpha"};
    const hnbrdf_fitted *fitted = &material->fitted;
    hnbrdf_result result =
        check_analytic(names, material->kd, material->eta, material->alpha, error);
    if (!result && !is_zero(fitted))
        result = check_analytic(fitted_names, fitted->kd, fitted->eta, fitted->alpha, error);
    if (result)
        return result;
    if (!isfinite(material->rotation))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "rotation is %s, expected a finite angle",
                           HNBRDF_NUMBER(material->rotation));
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        if (!isfinite(material->latent[i]))
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "latent[%d] is %s, expected a finite number", i,
                               HNBRDF_NUMBER(material->latent[i]));
    result = check_lobes(&material->lobes, error);
    return result ? result : check_energy(&material->energy, error);
}

int hnbrdf_material_is_edited(const hnbrdf_material *material)
{
    return hnbrdf_is_edited(material);
}

/* Never outside its two ends, whatever rounding does; a where both are equal. */
static float between(float value, float a, float b)
{
    return a < b ? hnbrdf_clamp(value, a, b) : hnbrdf_clamp(value, b, a);
}

static float mix_linear(float a, float b, float t)
{
    return between((1.0f - t) * a + t * b, a, b);
}

static float mix_log(float a, float b, float t)
{
    return between(hnbrdf_exp(mix_linear(hnbrdf_log(a), hnbrdf_log(b), t)), a, b);
}

/* Amplitude r = (eta - 1)/(eta + 1), reflectance r^2 and transmittance 1 - r^2 = 4 eta/(eta +
 * 1)^2, so that eta = (1 + r)^2/(1 - r^2) is free of cancellation for metals too. */
static float mix_eta(float a, float b, float t)
{
    float ra = (a - 1.0f) / (a + 1.0f), rb = (b - 1.0f) / (b + 1.0f);
    float ta = 4.0f * a / ((a + 1.0f) * (a + 1.0f)), tb = 4.0f * b / ((b + 1.0f) * (b + 1.0f));
    float r = sqrtf(mix_linear(ra * ra, rb * rb, t));
    return between((1.0f + r) * (1.0f + r) / mix_linear(ta, tb, t), a, b);
}

static int is_isotropic(const hnbrdf_material *material)
{
    return material->alpha[0] == material->alpha[1];
}

static float mix_rotation(const hnbrdf_material *a, const hnbrdf_material *b, float t)
{
    const double pi = 3.14159265358979324, to_whole = 6755399441055744.0; /* 1.5 * 2^52 */
    if (is_isotropic(a) != is_isotropic(b))
        return is_isotropic(a) ? b->rotation : a->rotation;
    double angle = (double)b->rotation - (double)a->rotation;
    double half_turns = (angle / pi + to_whole) - to_whole; /* rounded to nearest */
    return (float)((double)a->rotation + (double)t * (angle - half_turns * pi));
}

/* Lobes of the same kind at both ends, or none. */
static void mix_lobes(const hnbrdf_lobes *a, const hnbrdf_lobes *b, float t, hnbrdf_lobes *out)
{
    memset(out, 0, sizeof *out);
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        float x = a->scale[k], y = b->scale[k];
        if ((x > 0.0f) != (y > 0.0f) || (x < 0.0f) != (y < 0.0f)) {
            memset(out, 0, sizeof *out);
            return;
        }
        if (x != 0.0f)
            out->scale[k] = copysignf(mix_log(fabsf(x), fabsf(y), t), x);
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
            out->share[k][j] = mix_linear(a->share[k][j], b->share[k][j], t);
    }
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++) /* rounding must not take the sum above 1 */
        out->share[1][j] = hnbrdf_clamp(out->share[1][j], 0.0f, 1.0f - out->share[0][j]);
}

static void mix_analytic(const hnbrdf_fitted *a, const hnbrdf_fitted *b, float t,
                         hnbrdf_fitted *out)
{
    for (int c = 0; c < 3; c++) {
        out->kd[c] = mix_linear(a->kd[c], b->kd[c], t);
        out->eta[c] = mix_eta(a->eta[c], b->eta[c], t);
    }
    for (int c = 0; c < 2; c++)
        out->alpha[c] = mix_log(a->alpha[c], b->alpha[c], t);
}

/* An end without it has k = 1. */
static void mix_energy(const hnbrdf_energy *a, const hnbrdf_energy *b, float t, hnbrdf_energy *out)
{
    const hnbrdf_energy from = hnbrdf_energy_used(a), to = hnbrdf_energy_used(b);
    memset(out, 0, sizeof *out);
    if (!hnbrdf_has_energy(a) && !hnbrdf_has_energy(b))
        return;
    out->horizon = mix_linear(from.horizon, to.horizon, t);
    out->slope = mix_linear(from.slope, to.slope, t);
}

static hnbrdf_fitted now_of(const hnbrdf_material *m)
{
    return (hnbrdf_fitted){{m->kd[0], m->kd[1], m->kd[2]},
                           {m->eta[0], m->eta[1], m->eta[2]},
                           {m->alpha[0], m->alpha[1]}};
}

static hnbrdf_fitted fitted_of(const hnbrdf_material *m)
{
    return m->fitted.alpha[0] != 0.0f ? m->fitted : now_of(m);
}

void hnbrdf_material_mix(const hnbrdf_material *a, const hnbrdf_material *b, float t,
                         hnbrdf_material *out)
{
    hnbrdf_material mixed;
    if (!(t > 0.0f && t < 1.0f)) {
        *out = t >= 1.0f ? *b : *a;
        return;
    }
    const hnbrdf_fitted now[2] = {now_of(a), now_of(b)}, then[2] = {fitted_of(a), fitted_of(b)};
    hnbrdf_fitted made;
    mix_analytic(&now[0], &now[1], t, &made);
    memcpy(mixed.kd, made.kd, sizeof mixed.kd);
    memcpy(mixed.eta, made.eta, sizeof mixed.eta);
    memcpy(mixed.alpha, made.alpha, sizeof mixed.alpha);
    memset(&mixed.fitted, 0, sizeof mixed.fitted);
    if (a->fitted.alpha[0] != 0.0f || b->fitted.alpha[0] != 0.0f)
        mix_analytic(&then[0], &then[1], t, &mixed.fitted);
    mixed.rotation = mix_rotation(a, b, t);
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        mixed.latent[i] = mix_linear(a->latent[i], b->latent[i], t);
    mix_lobes(&a->lobes, &b->lobes, t, &mixed.lobes);
    mix_energy(&a->energy, &b->energy, t, &mixed.energy);
    *out = mixed;
}
