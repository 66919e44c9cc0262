/* export_evaluate.c: the functions a shader calls: evaluate, its analytic part alone, sample,
 * pdf. Each does what the C function of the same name does, in the same order of operations. */
#include "glsl/export_evaluate.h"

#include "glsl/export_material.h"
#include "glsl/export_network.h"

static const char HORIZON[] = "    if (!(wi.z > 0.0 && wo.z > 0.0))\n        return vec3(0.0);\n"
                              "    hnbrdf_pair p = hnbrdf_scene_pair(m, wi, wo);\n";

/* Both directions into the tangent frame, as far as any material is turned. */
static void put_pair(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "// Both directions in the tangent frame of the material.\n");
    hnbrdf_put(out, "hnbrdf_pair hnbrdf_scene_pair(hnbrdf_material m, vec3 wi, vec3 wo)\n{\n");
    hnbrdf_put(out, s->rotated
                        ? "    return hnbrdf_pair_make(hnbrdf_to_tangent(m.rotation, wi),\n"
                          "                            hnbrdf_to_tangent(m.rotation, wo));\n}\n\n"
                        : "    return hnbrdf_pair_make(wi, wo);\n}\n\n");
}

/* The exponent s c + m; a scale of 1 and a shift of 0 change no bit and are left out. */
static void put_exponent(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int loaded = s->style == HNBRDF_GLSL_UNIFORM;
    hnbrdf_put(out, "    HNBRDF_PRECISE vec3 exponent = ");
    if (loaded || s->desc->scale != 1.0f) {
        hnbrdf_put_constant(out, s, 0);
        hnbrdf_put(out, " * ");
    }
    hnbrdf_put(out, "c");
    if (loaded || s->desc->shift != 0.0f) {
        hnbrdf_put(out, " + ");
        hnbrdf_put_constant(out, s, 1);
    }
    hnbrdf_put(out, ";\n");
}

/* On every value, where the scene asks for it. */
static const char *factor(const hnbrdf_scene *s)
{
    return s->energy ? "m.energy * " : "";
}

static void put_analytic(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "// f_a before it is clamped to what f may be.\n");
    hnbrdf_put(out, "vec3 hnbrdf_analytic(hnbrdf_material m, hnbrdf_pair p)\n{\n");
    hnbrdf_put(out, s->fixed
                        ? "    float specular = hnbrdf_specular_of_area(p, m.alpha, m.area);\n"
                          "    return hnbrdf_microfacet_of(m.diffuse, m.e, p.c, specular);\n}\n\n"
                        : "    float specular = hnbrdf_specular(p, m.alpha);\n"
                          "    return hnbrdf_microfacet(m.kd, m.eta, p.c, specular);\n}\n\n");
}

static void put_eval_analytic(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int analytic = hnbrdf_scene_has_analytic(s);
    hnbrdf_put(out, "// f_a alone: Lambert + GGX, the cheapest level of detail%s.\n",
               analytic ? "" : "; this kind of model has none");
    hnbrdf_put(out, "vec3 hnbrdf_eval_analytic(hnbrdf_material m, vec3 wi, vec3 wo)\n{\n");
    if (analytic)
        hnbrdf_put(out, "%s    return %shnbrdf_finish(hnbrdf_analytic(m, p));\n}\n\n", HORIZON,
                   factor(s));
    else
        hnbrdf_put(out, "    return vec3(0.0);\n}\n\n");
}

/* What an edit of a material comes to; the specular part of f_a; and the pair that its network then
 * sees. */
static void put_edits(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "hnbrdf_edit hnbrdf_scene_edit(hnbrdf_material m)\n{\n    return ");
    hnbrdf_put(out, s->fixed ? "m.edit;\n}\n\n"
                    : s->anisotropic
                        ? "hnbrdf_edit_make(m.kd, m.eta, m.alpha, m.fitted);\n}\n\n"
                        : "hnbrdf_edit_make(m.kd, m.eta, vec2(m.alpha), m.fitted);\n}\n\n");
    hnbrdf_put(out, "vec3 hnbrdf_scene_specular(hnbrdf_material m, hnbrdf_pair p)\n{\n");
    hnbrdf_put(out, s->fixed ? "    HNBRDF_PRECISE vec3 f = hnbrdf_fresnel_of_e(m.e, p.c) * "
                               "hnbrdf_specular_of_area(p, m.alpha, m.area);\n"
                             : "    HNBRDF_PRECISE vec3 f = hnbrdf_fresnel_dielectric(m.eta, p.c) "
                               "* hnbrdf_specular(p, m.alpha);\n");
    hnbrdf_put(out, "    return f;\n}\n\n");
    hnbrdf_put(out,
               "hnbrdf_pair hnbrdf_scene_seen(hnbrdf_edit edit, hnbrdf_pair p, vec3 specular)\n{\n"
               "    float part = hnbrdf_specular_part(specular, edit.carried);\n    return ");
    hnbrdf_put(out, s->desc->encoding == HNBRDF_ENCODING_DIRECTIONS
                        ? "hnbrdf_turn_pair(p, hnbrdf_warped(p, edit.warp, part));\n}\n\n"
                        : "hnbrdf_raise_pair(p, hnbrdf_warped(p, edit.warp, part));\n}\n\n");
}

/* In hnbrdf_eval(): f_a of what the material is and of what it was fitted with. */
static void put_edited(hnbrdf_printer *out)
{
    hnbrdf_put(out, "    hnbrdf_edit edit = hnbrdf_scene_edit(m);\n"
                    "    vec3 specular = hnbrdf_scene_specular(m, p);\n"
                    "    HNBRDF_PRECISE vec3 edited = edit.carried + specular;\n"
                    "    hnbrdf_pair seen = hnbrdf_scene_seen(edit, p, specular);\n"
                    "    vec3 fitted = hnbrdf_microfacet_fitted(p, seen, edit);\n");
}

static void put_eval(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "// f(wi, wo) in 1/sr without the cosine; 0 below the horizon.\n");
    hnbrdf_put(out, "vec3 hnbrdf_eval(hnbrdf_material m, vec3 wi, vec3 wo)\n{\n%s", HORIZON);
    if (!hnbrdf_scene_has_network(s)) {
        hnbrdf_put(out, "    return %shnbrdf_finish(hnbrdf_analytic(m, p));\n}\n", factor(s));
        return;
    }
    int hybrid = s->desc->kind == HNBRDF_KIND_HYBRID;
    if (s->edited)
        put_edited(out);
    hnbrdf_put(out, "    vec3 x0, x1, c%s;\n", hybrid ? ", g" : "");
    hnbrdf_put(out, "    HNBRDF_SCENE_ENCODE(%s, x0, x1);\n", s->edited ? "seen" : "p");
    hnbrdf_put(out, "    hnbrdf_network(m, x0, x1, c%s);\n", hybrid ? ", g" : "");
    put_exponent(out, s);
    hnbrdf_put(out, "    return %s%s", factor(s),
               s->edited ? "hnbrdf_compose_edited(exponent, g, edited, fitted, edit.added, "
               : hybrid  ? "hnbrdf_compose_hybrid(exponent, g, hnbrdf_analytic(m, p), "
                         : "hnbrdf_compose_neural(exponent, ");
    hnbrdf_put_constant(out, s, 2);
    hnbrdf_put(out, ");\n}\n");
}

/* ---- Sampling -------------------------------------------------------------------------------- */

/* Roughness that the scales of lobes refer to. */
static const char *alpha_text(const hnbrdf_scene *s)
{
    return !hnbrdf_scene_has_analytic(s) ? "vec2(1.0)"
           : s->anisotropic              ? "m.alpha"
                                         : "vec2(m.alpha)";
}

static void put_pdf(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "\n// Density in 1/sr with which hnbrdf_sample() draws wi given wo; 0 below "
                    "the horizon.\n");
    hnbrdf_put(out, "float hnbrdf_pdf(hnbrdf_material m, vec3 wi, vec3 wo)\n{\n"
                    "    if (!(wi.z > 0.0 && wo.z > 0.0))\n        return 0.0;\n");
    if (s->rotated)
        hnbrdf_put(out, "    wi = hnbrdf_to_tangent(m.rotation, wi);\n"
                        "    wo = hnbrdf_to_tangent(m.rotation, wo);\n");
    hnbrdf_put(out, "    return hnbrdf_density(%s, m.lobes, wi, wo);\n}\n", alpha_text(s));
}

static void put_sample_direction(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "\n// Draws wi alone, for renderers that weigh it otherwise; u is two "
                    "numbers in [0, 1): make "
                    "them as\n// float(u32 >> 8) * 2^-24. Returns its density; 0: no direction, "
                    "(0, 0, 1).\n");
    hnbrdf_put(out,
               "float hnbrdf_sample_direction(hnbrdf_material m, vec3 wo, vec2 u, out vec3 wi)\n{\n"
               "    wi = vec3(0.0, 0.0, 1.0);\n"
               "    if (!(wo.z > 0.0))\n        return 0.0;\n");
    hnbrdf_put(out, "    vec3 drawn = hnbrdf_draw(%s, m.lobes, %s, u);\n", alpha_text(s),
               s->rotated ? "hnbrdf_to_tangent(m.rotation, wo)" : "wo");
    if (s->rotated)
        hnbrdf_put(out, "    drawn = hnbrdf_from_tangent(m.rotation, drawn);\n");
    hnbrdf_put(out, "    float pdf = hnbrdf_pdf(m, drawn, wo);\n"
                    "    if (!(pdf > 0.0))\n        return 0.0;\n"
                    "    wi = drawn;\n    return pdf;\n}\n");
}

static void put_sample(hnbrdf_printer *out)
{
    hnbrdf_put(out, "\n// Draws wi given wo and weighs it.\n");
    hnbrdf_put(
        out,
        "hnbrdf_sample_result hnbrdf_sample(hnbrdf_material m, vec3 wo, vec2 u)\n{\n"
        "    hnbrdf_sample_result drawn;\n"
        "    drawn.pdf = hnbrdf_sample_direction(m, wo, u, drawn.wi);\n"
        "    drawn.weight = vec3(0.0);\n"
        "    if (!(drawn.pdf > 0.0))\n        return drawn;\n"
        "    HNBRDF_PRECISE vec3 weight = hnbrdf_eval(m, drawn.wi, wo) * drawn.wi.z / drawn.pdf;\n"
        "    drawn.weight = hnbrdf_finish(weight);\n    return drawn;\n}\n");
}

/* ---- All of it ------------------------------------------------------------------------------- */

static void put_named(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    for (int k = 0; k < s->count; k++) {
        hnbrdf_put(out, "\nvec3 hnbrdf_eval_%s(vec3 wi, vec3 wo)\n{\n    return hnbrdf_eval(",
                   s->names[k]);
        hnbrdf_put_material(out, s, k);
        hnbrdf_put(out, ", wi, wo);\n}\n");
    }
}

void hnbrdf_put_evaluate(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    put_pair(out, s);
    if (hnbrdf_scene_has_analytic(s))
        put_analytic(out, s);
    if (s->only == HNBRDF_GLSL_EVERYTHING)
        put_eval_analytic(out, s);
    if (s->edited)
        put_edits(out, s);
    put_eval(out, s);
    if (hnbrdf_scene_has_sampling(s)) {
        put_pdf(out, s);
        put_sample_direction(out, s);
        put_sample(out);
    }
    if (s->fixed)
        put_named(out, s);
}
