/* export_unpack.c: the GLSL function that makes a material from texels: src/core/pack.c's
 * decoding, in the same order of operations, with the layout and the ranges as constants. */
#include "glsl/export_unpack.h"

#include "core/pack.h"

#include <stdio.h>

static const char *format_name(const hnbrdf_packing *packing)
{
    return packing->format == HNBRDF_TEXEL_RGBA16F ? "RGBA16F" : "RGBA8";
}

void hnbrdf_put_texel_summary(hnbrdf_printer *out, const hnbrdf_packing *packing)
{
    int texels = hnbrdf_packing_texels(packing);
    hnbrdf_put(out, "//   texels     %d of %s a material, %d bytes\n", texels, format_name(packing),
               texels * (int)hnbrdf_texel_bytes(packing->format));
}

/* `count` channels from number `first` on: t0.xyz, or vec3(t0.w, t1.xy) where they lie in two
 * texels. */
static void put_channels(hnbrdf_printer *out, int first, int count)
{
    int split = first / 4 != (first + count - 1) / 4;
    if (split)
        hnbrdf_put(out, "vec%d(", count);
    while (count > 0) {
        int part = 4 - first % 4 < count ? 4 - first % 4 : count;
        hnbrdf_put(out, "t_%d.%.*s%s", first / 4, part, &"xyzw"[first % 4],
                   part < count ? ", " : "");
        first += part;
        count -= part;
    }
    if (split)
        hnbrdf_put(out, ")");
}

/* Declares `name`, decoded up to its curve: a float or a vector of field->count. */
static void put_decoded(hnbrdf_printer *out, const char *name, const hnbrdf_field *field)
{
    static const char *const types[] = {"", "float", "vec2", "vec3", "vec4"};
    hnbrdf_put(out, "    HNBRDF_PRECISE %s %s = ", types[field->count], name);
    if (field->offset != 0.0f || field->scale != 1.0f) {
        hnbrdf_put_float(out, field->offset);
        hnbrdf_put(out, " + ");
        hnbrdf_put_float(out, field->scale);
        hnbrdf_put(out, " * ");
    }
    put_channels(out, field->first, field->count);
    hnbrdf_put(out, ";\n");
    if (field->curve == HNBRDF_CURVE_SQUARE)
        hnbrdf_put(out, "    %s = %s * %s;\n", name, name, name);
}

/* hnbrdf_clamp(expression, low, high) of a float or vec3. */
static void put_clamped(hnbrdf_printer *out, const char *expression, const hnbrdf_field *field)
{
    hnbrdf_put(out, "hnbrdf_clamp(%s, ", expression);
    hnbrdf_put_float(out, field->low);
    hnbrdf_put(out, ", ");
    hnbrdf_put_float(out, field->high);
    hnbrdf_put(out, ")");
}

/* kd, eta and alpha of a material, or of what it was fitted with. */
typedef struct unpacked {
    const char *to;     /* "material_out." */
    const char *prefix; /* of the variables they are decoded in */
    const hnbrdf_field *kd, *r, *alpha;
    int vector; /* alpha is a vec2 */
} unpacked;

/* alpha, exponential where the format says so, clamped. */
static void put_alpha(hnbrdf_printer *out, const unpacked *u)
{
    int isotropic = u->alpha->count == 1;
    char name[32], part[40];
    snprintf(name, sizeof name, "%salpha", u->prefix);
    put_decoded(out, name, u->alpha);
    if (u->alpha->curve == HNBRDF_CURVE_EXP) {
        hnbrdf_put(out,
                   "    %s = HNBRDF_EXP(hnbrdf_clamp(vec3(%s%s), -HNBRDF_MAX_EXPONENT, 0.0)).%s;\n",
                   name, name, isotropic ? "" : ", 0.0", isotropic ? "x" : "xy");
    }
    hnbrdf_put(out, u->vector ? "    %salpha = vec2(" : "    %salpha = ", u->to);
    snprintf(part, sizeof part, isotropic ? "%s" : "%s.x", name);
    put_clamped(out, part, u->alpha);
    if (!isotropic) {
        snprintf(part, sizeof part, "%s.y", name);
        hnbrdf_put(out, ", ");
        put_clamped(out, part, u->alpha);
    }
    hnbrdf_put(out, u->vector ? ");\n" : ";\n");
}

static void put_analytic_fields(hnbrdf_printer *out, const unpacked *u)
{
    char kd[32], r[32];
    snprintf(kd, sizeof kd, "%skd", u->prefix);
    snprintf(r, sizeof r, "%sr", u->prefix); /* the amplitude (eta - 1)/(eta + 1) */
    put_decoded(out, kd, u->kd);
    hnbrdf_put(out, "    %skd = ", u->to);
    put_clamped(out, kd, u->kd);
    hnbrdf_put(out, ";\n");
    put_decoded(out, r, u->r);
    hnbrdf_put(out, "    %s = ", r);
    put_clamped(out, r, u->r);
    hnbrdf_put(out,
               ";\n    HNBRDF_PRECISE vec3 %seta = (1.0 + %s) / (1.0 - %s);\n    %seta = "
               "%seta;\n",
               u->prefix, r, r, u->to, u->prefix);
    put_alpha(out, u);
}

static void put_fitted(hnbrdf_printer *out, const hnbrdf_scene *s,
                       const hnbrdf_texel_layout *layout)
{
    if (s->packing->edited) {
        const unpacked fitted = {"material_out.fitted_", "fitted_",
                                 &layout->fitted_kd,     &layout->fitted_r,
                                 &layout->fitted_alpha,  1};
        put_analytic_fields(out, &fitted);
    } else { /* others of the scene are edited */
        hnbrdf_put(out,
                   "    material_out.fitted_kd = material_out.kd;\n"
                   "    material_out.fitted_eta = material_out.eta;\n"
                   "    material_out.fitted_alpha = %s;\n",
                   s->anisotropic ? "material_out.alpha" : "vec2(material_out.alpha)");
    }
}

static void put_rotation(hnbrdf_printer *out, const hnbrdf_texel_layout *layout)
{
    put_decoded(out, "turn_cs", &layout->rotation);
    hnbrdf_put(out, "    turn_cs = vec2(");
    put_clamped(out, "turn_cs.x", &layout->rotation);
    hnbrdf_put(out, ", ");
    put_clamped(out, "turn_cs.y", &layout->rotation);
    hnbrdf_put(out, ");\n    HNBRDF_PRECISE float length_2 = turn_cs.x * turn_cs.x + turn_cs.y * "
                    "turn_cs.y;\n"
                    "    material_out.rotation = length_2 > ");
    hnbrdf_put_float(out, layout->shortest2);
    hnbrdf_put(out, " ? turn_cs / sqrt(length_2) : vec2(1.0, 0.0);\n");
}

/* Number i of the latent code, as an expression of its own. */
static void put_latent_number(hnbrdf_printer *out, const hnbrdf_field *field, int i)
{
    char name[16];
    snprintf(name, sizeof name, "z_%d", i);
    put_clamped(out, name, field);
}

static void put_latent(hnbrdf_printer *out, const hnbrdf_packing *packing,
                       const hnbrdf_texel_layout *layout)
{
    for (int i = 0; i < packing->latent; i++) {
        char name[16];
        snprintf(name, sizeof name, "z_%d", i);
        put_decoded(out, name, &layout->latent[i]);
    }
    for (int v = 0; v < (packing->latent + 3) / 4; v++) {
        hnbrdf_put(out, "    material_out.latent%d = vec4(", v);
        for (int i = 4 * v; i < 4 * v + 4; i++) {
            hnbrdf_put(out, i > 4 * v ? ", " : "");
            if (i < packing->latent)
                put_latent_number(out, &layout->latent[i], i);
            else
                hnbrdf_put(out, "0.0");
        }
        hnbrdf_put(out, ");\n");
    }
}

/* lobes_out: those of a material that has none. */
static void put_guess(hnbrdf_printer *out, const hnbrdf_packing *packing)
{
    hnbrdf_put(out, "    hnbrdf_lobes lobes_out = ");
    hnbrdf_put(out, packing->analytic ? "hnbrdf_lobes_guess(material_out.kd, material_out.eta);\n"
                                      : "hnbrdf_lobes(vec2(1.0, 0.0), vec4(0.0), vec4(0.0));\n");
}

/* The lobes that are stored, as far as they are legal. */
static void put_stored_lobes(hnbrdf_printer *out, const hnbrdf_texel_layout *layout)
{
    const char *const share[] = {"share_0", "share_1"};
    put_decoded(out, "scale_v", &layout->lobe_scale);
    hnbrdf_put(out, "    scale_v = vec2(");
    put_clamped(out, "scale_v.x", &layout->lobe_scale);
    hnbrdf_put(out, ", ");
    put_clamped(out, "scale_v.y", &layout->lobe_scale);
    hnbrdf_put(out, ");\n    scale_v = scale_v / (");
    hnbrdf_put_float(out, layout->lobe_unit);
    hnbrdf_put(out, " - abs(scale_v));\n");
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        put_decoded(out, share[k], &layout->lobe_share[k]);
        hnbrdf_put(out, "    %s = hnbrdf_clamp_shares(%s, vec4(1.0));\n", share[k], share[k]);
    }
    hnbrdf_put(out, "    share_1 = hnbrdf_clamp_shares(share_1, 1.0 - share_0);\n"
                    "    if (abs(scale_v.x) >= ");
    hnbrdf_put_float(out, HNBRDF_PACKED_MIN_SCALE);
    hnbrdf_put(out, ") {\n        bool has_second = abs(scale_v.y) >= ");
    hnbrdf_put_float(out, HNBRDF_PACKED_MIN_SCALE);
    hnbrdf_put(out,
               ";\n        lobes_out.lobe_scale = vec2(scale_v.x, has_second ? scale_v.y : 0.0);\n"
               "        lobes_out.share_0 = share_0;\n"
               "        lobes_out.share_1 = has_second ? share_1 : vec4(0.0);\n    }\n");
}

static void put_lobes(hnbrdf_printer *out, const hnbrdf_packing *packing,
                      const hnbrdf_texel_layout *layout)
{
    put_guess(out, packing);
    if (packing->lobes)
        put_stored_lobes(out, layout);
    hnbrdf_put(out, "    material_out.lobe_scale = lobes_out.lobe_scale;\n"
                    "    material_out.lobe_share_0 = lobes_out.share_0;\n"
                    "    material_out.lobe_share_1 = lobes_out.share_1;\n");
}

static void put_energy(hnbrdf_printer *out, const hnbrdf_packing *packing,
                       const hnbrdf_texel_layout *layout)
{
    if (!packing->energy) { /* others of the scene conserve it */
        hnbrdf_put(out, "    material_out.energy_ramp = vec2(1.0, 0.0);\n");
        return;
    }
    put_decoded(out, "energy_horizon", &layout->horizon);
    put_decoded(out, "energy_slope", &layout->slope);
    hnbrdf_put(out, "    material_out.energy_ramp = vec2(");
    put_clamped(out, "energy_horizon", &layout->horizon);
    hnbrdf_put(out, ", ");
    put_clamped(out, "energy_slope", &layout->slope);
    hnbrdf_put(out, ");\n");
}

void hnbrdf_put_unpack(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    const hnbrdf_packing *packing = s->packing;
    hnbrdf_texel_layout layout;
    int texels = hnbrdf_packing_texels(packing);
    hnbrdf_texel_layout_make(packing, &layout);
    hnbrdf_put(out,
               "// A material from its %d texel%s of %s, as `hnbrdf export --texels` writes them, "
               "filtered or not.\n"
               "// In GLSL ES sample them through highp sampler2D: mediump rounds more than they "
               "do.\n",
               texels, texels == 1 ? "" : "s", format_name(packing));
    hnbrdf_put(out, "#define HNBRDF_TEXELS %d\nhnbrdf_material hnbrdf_material_unpack(", texels);
    for (int t = 0; t < texels; t++)
        hnbrdf_put(out, "%svec4 t_%d", t > 0 ? ", " : "", t);
    hnbrdf_put(out, ")\n{\n    hnbrdf_material material_out;\n");
    if (packing->analytic) {
        const unpacked own = {"material_out.", "", &layout.kd, &layout.r, &layout.alpha,
                              s->anisotropic};
        put_analytic_fields(out, &own);
    }
    if (s->edited)
        put_fitted(out, s, &layout);
    if (packing->rotated)
        put_rotation(out, &layout);
    else if (hnbrdf_scene_has_rotation(s))
        hnbrdf_put(out, "    material_out.rotation = vec2(1.0, 0.0);\n");
    put_latent(out, packing, &layout);
    if (hnbrdf_scene_has_sampling(s))
        put_lobes(out, packing, &layout);
    if (s->energy)
        put_energy(out, packing, &layout);
    hnbrdf_put(out, "    return material_out;\n}\n\n");
}
