/* pack.c: a material as texels, for scenes whose materials come from textures, and back.
 * The curves are those that cost least on fitted models: see hnbrdf_packing in hnbrdf.h. */
#include "core/pack.h"

#include "base/error.h"
#include "core/half.h"
#include "core/prepared.h"

#include <math.h>
#include <string.h>

/* eta from 1.0002 to 999: below, the reflectance is under 1e-8; above, 1 - r has too few digits. */
#define MIN_R 1e-4f
#define MAX_R 0.998f

enum { ROTATION_UNIT = 127, ROTATION_ZERO = 128 }; /* of a byte: 0 and 1 are met exactly */

/* Scales of lobes are s = v / (1 - |v|), at most 499 of half floats and 126 of bytes. */
#define MAX_HALF_V 0.998f
#define MAX_BYTE_V 126.0f

/* Slopes of energy: what is legal, and the largest of bytes, where k is 1 from 0.2 degrees on. */
#define MAX_HALF_SLOPE 1e4f
#define MAX_BYTE_SLOPE 256.0f

/* ---- Ranges ---------------------------------------------------------------------------------- */

HNBRDF_DIVIDES_AS_IEEE /* eta = -1 is refused elsewhere; here the infinity is clamped */
    static float
    amplitude(float eta)
{
    return hnbrdf_clamp((eta - 1.0f) / (eta + 1.0f), MIN_R, MAX_R);
}

static void widen(float range[2], float value)
{
    range[0] = value < range[0] ? value : range[0];
    range[1] = value > range[1] ? value : range[1];
}

static void widen_analytic(hnbrdf_packing *packing, const float kd[3], const float eta[3],
                           const float alpha[2])
{
    for (int c = 0; c < 3; c++) {
        widen(packing->kd, kd[c]);
        widen(packing->eta, eta[c]);
    }
    for (int c = 0; c < 2; c++)
        widen(packing->alpha, alpha[c]);
    packing->anisotropic |= packing->analytic && alpha[0] != alpha[1];
}

static int any_edited(const hnbrdf_model *model, const int *materials, int count)
{
    int edited = 0;
    for (int k = 0; k < count; k++) {
        const hnbrdf_material *material =
            hnbrdf_model_material(model, materials ? materials[k] : k);
        edited |= material && hnbrdf_material_is_edited(material);
    }
    return edited;
}

static void widen_by(hnbrdf_packing *packing, const hnbrdf_material *material)
{
    const hnbrdf_fitted *fitted = &material->fitted;
    widen_analytic(packing, material->kd, material->eta, material->alpha);
    if (packing->edited && fitted->alpha[0] != 0.0f)
        widen_analytic(packing, fitted->kd, fitted->eta, fitted->alpha);
    for (int i = 0; i < packing->latent; i++)
        widen(packing->latent_range[i], material->latent[i]);
    packing->rotated |= material->rotation != 0.0f;
    packing->energy |= hnbrdf_has_energy(&material->energy);
}

hnbrdf_result hnbrdf_packing_init(const hnbrdf_model *model, const int *materials,
                                  int material_count, hnbrdf_texel_format format,
                                  hnbrdf_packing *packing, hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    int count = materials ? material_count : desc.material_count;
    hnbrdf_packing made = {.format = format,
                           .analytic = desc.kind != HNBRDF_KIND_NEURAL,
                           .edited = desc.kind == HNBRDF_KIND_HYBRID &&
                                     any_edited(model, materials, count),
                           .latent = desc.kind == HNBRDF_KIND_GGX ? 0 : desc.latent};
    if (count < 1)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "packing: %d materials, expected at least 1", count);
    for (int k = 0; k < count; k++) {
        const hnbrdf_material *material =
            hnbrdf_model_material(model, materials ? materials[k] : k);
        if (!material)
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "packing: materials[%d] is %d, expected 0 to %d", k, materials[k],
                               desc.material_count - 1);
        if (k == 0) {
            made.kd[0] = made.kd[1] = material->kd[0];
            made.eta[0] = made.eta[1] = material->eta[0];
            made.alpha[0] = made.alpha[1] = material->alpha[0];
            for (int i = 0; i < made.latent; i++)
                made.latent_range[i][0] = made.latent_range[i][1] = material->latent[i];
        }
        widen_by(&made, material);
    }
    hnbrdf_result result = hnbrdf_packing_check(&made, error);
    if (!result)
        *packing = made;
    return result;
}

static hnbrdf_result check_range(const char *field, const float range[2], float low, float high,
                                 hnbrdf_error *error)
{
    if (range[0] >= low && range[0] <= range[1] && range[1] <= high)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                       "packing: the range of %s is %s to %s, expected to lie within %s to %s",
                       field, HNBRDF_NUMBER(range[0]), HNBRDF_NUMBER(range[1]), HNBRDF_NUMBER(low),
                       HNBRDF_NUMBER(high));
}

hnbrdf_result hnbrdf_packing_check(const hnbrdf_packing *packing, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    if (packing->format != HNBRDF_TEXEL_RGBA16F && packing->format != HNBRDF_TEXEL_RGBA8)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "packing: format is %d, expected 0 or 1",
                           (int)packing->format);
    if (packing->latent < 0 || packing->latent > HNBRDF_MAX_LATENT)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "packing: latent is %d, expected 0 to %d",
                           packing->latent, HNBRDF_MAX_LATENT);
    if (hnbrdf_packing_texels(packing) == 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "packing: there is nothing to store");
    if (packing->format == HNBRDF_TEXEL_RGBA16F)
        return HNBRDF_OK;
    if (packing->analytic) {
        result = check_range("kd", packing->kd, 0.0f, 1.0f, error);
        if (!result)
            result = check_range("eta", packing->eta, 1.0f, HNBRDF_MAX_ETA, error);
        if (!result)
            result =
                check_range("alpha", packing->alpha, HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA, error);
    }
    for (int i = 0; i < packing->latent && !result; i++)
        result = check_range("latent", packing->latent_range[i], -HNBRDF_MAX_HALF, HNBRDF_MAX_HALF,
                             error);
    return result;
}

/* ---- Layout ---------------------------------------------------------------------------------- */

static float to_curve(hnbrdf_curve curve, float value)
{
    if (curve == HNBRDF_CURVE_SQUARE)
        return sqrtf(value);
    return curve == HNBRDF_CURVE_EXP ? hnbrdf_log(value) : value;
}

static float from_curve(hnbrdf_curve curve, float value)
{
    if (curve == HNBRDF_CURVE_SQUARE)
        return value * value;
    return curve == HNBRDF_CURVE_EXP ? hnbrdf_exp(hnbrdf_clamp(value, -HNBRDF_MAX_EXPONENT, 0.0f))
                                     : value;
}

/* Half floats hold the number itself; bytes its place in the range, along the curve. */
static hnbrdf_field make_field(const hnbrdf_packing *packing, int *next, int count,
                               hnbrdf_curve curve, float range_low, float range_high, float low,
                               float high)
{
    hnbrdf_field field = {.first = *next, .count = count, .scale = 1.0f, .low = low, .high = high};
    *next += count;
    if (packing->format == HNBRDF_TEXEL_RGBA8) {
        field.curve = curve;
        field.offset = to_curve(curve, range_low);
        field.scale = to_curve(curve, range_high) - field.offset;
    }
    return field;
}

void hnbrdf_texel_layout_make(const hnbrdf_packing *packing, hnbrdf_texel_layout *layout)
{
    int next = 0, bytes = packing->format == HNBRDF_TEXEL_RGBA8;
    const float unit = bytes ? (float)ROTATION_UNIT : 1.0f;
    memset(layout, 0, sizeof *layout);
    if (packing->analytic) {
        layout->kd = make_field(packing, &next, 3, HNBRDF_CURVE_SQUARE, packing->kd[0],
                                packing->kd[1], 0.0f, 1.0f);
        layout->r = make_field(packing, &next, 3, HNBRDF_CURVE_SQUARE, amplitude(packing->eta[0]),
                               amplitude(packing->eta[1]), MIN_R, MAX_R);
        layout->alpha =
            make_field(packing, &next, packing->anisotropic ? 2 : 1, HNBRDF_CURVE_EXP,
                       packing->alpha[0], packing->alpha[1], HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
    }
    if (packing->rotated) {
        layout->rotation = make_field(packing, &next, 2, HNBRDF_CURVE_LINEAR, -(float)ROTATION_ZERO,
                                      255.0f - (float)ROTATION_ZERO, -unit, unit);
        layout->shortest2 = 1e-4f * (unit * unit);
    }
    if (packing->analytic && packing->edited) {
        const hnbrdf_field *fields[] = {&layout->kd, &layout->r, &layout->alpha};
        hnbrdf_field *fitted[] = {&layout->fitted_kd, &layout->fitted_r, &layout->fitted_alpha};
        for (int k = 0; k < 3; k++) {
            *fitted[k] = *fields[k];
            fitted[k]->first = next;
            next += fitted[k]->count;
        }
    }
    for (int i = 0; i < packing->latent; i++)
        layout->latent[i] =
            make_field(packing, &next, 1, HNBRDF_CURVE_LINEAR, packing->latent_range[i][0],
                       packing->latent_range[i][1], -HNBRDF_MAX_HALF, HNBRDF_MAX_HALF);
    if (packing->lobes) {
        const float most = bytes ? MAX_BYTE_V : MAX_HALF_V;
        layout->lobe_unit = unit;
        layout->lobe_scale =
            make_field(packing, &next, 2, HNBRDF_CURVE_LINEAR, -(float)ROTATION_ZERO,
                       255.0f - (float)ROTATION_ZERO, -most, most);
        for (int k = 0; k < HNBRDF_LOBES; k++)
            layout->lobe_share[k] = make_field(packing, &next, HNBRDF_LOBE_KNOTS,
                                               HNBRDF_CURVE_LINEAR, 0.0f, 1.0f, 0.0f, 1.0f);
    }
    if (packing->energy) {
        const float most = bytes ? MAX_BYTE_SLOPE : MAX_HALF_SLOPE;
        layout->horizon =
            make_field(packing, &next, 1, HNBRDF_CURVE_LINEAR, 0.0f, 1.0f, 0.0f, 1.0f);
        layout->slope = make_field(packing, &next, 1, HNBRDF_CURVE_SQUARE, 0.0f, most, 0.0f, most);
    }
    layout->channels = next;
}

int hnbrdf_packing_texels(const hnbrdf_packing *packing)
{
    int analytic = packing->analytic ? (packing->anisotropic ? 8 : 7) : 0;
    int lobes = packing->lobes ? HNBRDF_LOBES * (1 + HNBRDF_LOBE_KNOTS) : 0;
    int channels = analytic * (packing->edited ? 2 : 1) + (packing->rotated ? 2 : 0) +
                   packing->latent + lobes + (packing->energy ? 2 : 0);
    return (channels + 3) / 4;
}

/* ---- Packing --------------------------------------------------------------------------------- */

/* Channel number `channel` of the texels. */
static void store(const hnbrdf_packing *packing, void *texels, int channel,
                  const hnbrdf_field *field, float value)
{
    unsigned char *bytes = (unsigned char *)texels;
    value = hnbrdf_clamp(value, field->low, field->high);
    if (packing->format == HNBRDF_TEXEL_RGBA16F) {
        uint16_t half = hnbrdf_half_of(value);
        memcpy(bytes + 2 * channel, &half, sizeof half);
        return;
    }
    float code =
        field->scale > 0.0f ? (to_curve(field->curve, value) - field->offset) / field->scale : 0.0f;
    bytes[channel] = (unsigned char)(hnbrdf_clamp(code, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/* kd, eta and alpha of a material or of what it was fitted with. */
typedef struct stored_fields {
    const hnbrdf_field *kd, *r, *alpha;
} stored_fields;

static stored_fields fields_of(const hnbrdf_texel_layout *layout, int fitted)
{
    return fitted ? (stored_fields){&layout->fitted_kd, &layout->fitted_r, &layout->fitted_alpha}
                  : (stored_fields){&layout->kd, &layout->r, &layout->alpha};
}

static void store_analytic(const hnbrdf_packing *packing, void *texels, stored_fields fields,
                           const float kd[3], const float eta[3], const float alpha[2])
{
    for (int c = 0; c < fields.kd->count; c++)
        store(packing, texels, fields.kd->first + c, fields.kd, kd[c]);
    for (int c = 0; c < fields.r->count; c++)
        store(packing, texels, fields.r->first + c, fields.r, amplitude(eta[c]));
    for (int c = 0; c < fields.alpha->count; c++)
        store(packing, texels, fields.alpha->first + c, fields.alpha, alpha[c]);
}

/* A lobe that is there stays so: its v is no less than what a byte tells from 0. */
static void store_lobes(const hnbrdf_packing *packing, void *texels,
                        const hnbrdf_texel_layout *layout, const hnbrdf_material *material)
{
    const hnbrdf_field *field = &layout->lobe_scale;
    hnbrdf_lobes lobes;
    hnbrdf_lobes_used(!packing->analytic, material, &lobes);
    for (int k = 0; k < field->count; k++) {
        const float s = lobes.scale[k], size = fabsf(s);
        float v = layout->lobe_unit * (size / (1.0f + size));
        if (packing->format == HNBRDF_TEXEL_RGBA8 && size > 0.0f && v < 1.0f)
            v = 1.0f;
        store(packing, texels, field->first + k, field, copysignf(v, s));
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
            store(packing, texels, layout->lobe_share[k].first + j, &layout->lobe_share[k],
                  lobes.share[k][j]);
    }
}

void hnbrdf_material_pack(const hnbrdf_packing *packing, const hnbrdf_material *material,
                          void *texels)
{
    hnbrdf_texel_layout layout;
    hnbrdf_texel_layout_make(packing, &layout);
    memset(texels, 0, (size_t)hnbrdf_packing_texels(packing) * hnbrdf_texel_bytes(packing->format));
    const hnbrdf_fitted *fitted = &material->fitted;
    store_analytic(packing, texels, fields_of(&layout, 0), material->kd, material->eta,
                   material->alpha);
    if (fitted->alpha[0] != 0.0f)
        store_analytic(packing, texels, fields_of(&layout, 1), fitted->kd, fitted->eta,
                       fitted->alpha);
    else
        store_analytic(packing, texels, fields_of(&layout, 1), material->kd, material->eta,
                       material->alpha);
    if (layout.rotation.count > 0) {
        const hnbrdf_field *field = &layout.rotation;
        double angle = isfinite(material->rotation) ? (double)material->rotation : 0.0;
        store(packing, texels, field->first, field, (float)cos(angle) * field->high);
        store(packing, texels, field->first + 1, field, (float)sin(angle) * field->high);
    }
    for (int i = 0; i < packing->latent; i++)
        store(packing, texels, layout.latent[i].first, &layout.latent[i], material->latent[i]);
    store_lobes(packing, texels, &layout, material);
    if (packing->energy) {
        const hnbrdf_energy energy = hnbrdf_energy_used(&material->energy);
        store(packing, texels, layout.horizon.first, &layout.horizon, energy.horizon);
        store(packing, texels, layout.slope.first, &layout.slope, energy.slope);
    }
}

/* ---- Unpacking ------------------------------------------------------------------------------- */

static float decode(const hnbrdf_field *field, float code)
{
    float value = field->offset + field->scale * code;
    return hnbrdf_clamp(from_curve(field->curve, value), field->low, field->high);
}

static void decode_analytic(const float *channels, stored_fields fields, float kd[3], float eta[3],
                            float alpha[2])
{
    for (int c = 0; c < fields.kd->count; c++)
        kd[c] = decode(fields.kd, channels[fields.kd->first + c]);
    for (int c = 0; c < fields.r->count; c++) {
        float r = decode(fields.r, channels[fields.r->first + c]);
        eta[c] = (1.0f + r) / (1.0f - r);
    }
    for (int c = 0; c < fields.alpha->count; c++)
        alpha[c] = decode(fields.alpha, channels[fields.alpha->first + c]);
    if (fields.alpha->count == 1)
        alpha[1] = alpha[0];
}

/* Filtered too: no sum of shares above 1, and no scale that is not legal. */
static void decode_lobes(const float *channels, const hnbrdf_texel_layout *layout,
                         hnbrdf_lobes *lobes)
{
    for (int k = 0; k < layout->lobe_scale.count; k++) {
        const float v = decode(&layout->lobe_scale, channels[layout->lobe_scale.first + k]);
        const float s = v / (layout->lobe_unit - fabsf(v));
        lobes->scale[k] = fabsf(s) < HNBRDF_PACKED_MIN_SCALE ? 0.0f : s;
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
            lobes->share[k][j] =
                decode(&layout->lobe_share[k], channels[layout->lobe_share[k].first + j]);
    }
    for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
        lobes->share[1][j] = hnbrdf_clamp(lobes->share[1][j], 0.0f, 1.0f - lobes->share[0][j]);
}

void hnbrdf_material_unpack_channels(const hnbrdf_packing *packing, const float *channels,
                                     hnbrdf_material *material)
{
    hnbrdf_texel_layout layout;
    hnbrdf_texel_layout_make(packing, &layout);
    hnbrdf_material_init(material);
    hnbrdf_fitted *fitted = &material->fitted;
    decode_analytic(channels, fields_of(&layout, 0), material->kd, material->eta, material->alpha);
    decode_analytic(channels, fields_of(&layout, 1), fitted->kd, fitted->eta, fitted->alpha);
    if (layout.rotation.count > 0) {
        float cosine = decode(&layout.rotation, channels[layout.rotation.first]);
        float sine = decode(&layout.rotation, channels[layout.rotation.first + 1]);
        if (cosine * cosine + sine * sine > layout.shortest2)
            material->rotation = (float)atan2((double)sine, (double)cosine);
    }
    for (int i = 0; i < packing->latent; i++)
        material->latent[i] = decode(&layout.latent[i], channels[layout.latent[i].first]);
    decode_lobes(channels, &layout, &material->lobes);
    if (packing->energy) {
        material->energy.horizon = decode(&layout.horizon, channels[layout.horizon.first]);
        material->energy.slope = decode(&layout.slope, channels[layout.slope.first]);
    }
}

void hnbrdf_material_unpack(const hnbrdf_packing *packing, const void *texels,
                            hnbrdf_material *material)
{
    float channels[HNBRDF_MAX_TEXELS * 4];
    const unsigned char *bytes = (const unsigned char *)texels;
    int count = 4 * hnbrdf_packing_texels(packing);
    for (int c = 0; c < count && c < HNBRDF_MAX_TEXELS * 4; c++) {
        uint16_t half;
        if (packing->format == HNBRDF_TEXEL_RGBA16F) {
            memcpy(&half, bytes + 2 * c, sizeof half);
            channels[c] = hnbrdf_float_of_half(half);
        } else {
            channels[c] = (float)bytes[c] / 255.0f;
        }
    }
    hnbrdf_material_unpack_channels(packing, channels, material);
}

size_t hnbrdf_texel_bytes(hnbrdf_texel_format format)
{
    return format == HNBRDF_TEXEL_RGBA16F ? 8 : 4;
}
