/* export_evaluate.c: the functions a shader calls: evaluate, its analytic part alone, sample,
 * pdf. Each does what the C function of the same name does, in the same order of operations. */
#include "glsl/export_evaluate.h"

#include "glsl/export_material.h"
#include "glsl/export_network.h"

static const char HORIZON[] = "    if (!(wi.z > 0.0 && wo.z > 0.0))\n        return vec3(0.0);\n"
                              "    hnbrdf_pair p = hnbrdf_scene_pair(material_in, wi, wo);\n";

/* Roughness that the scales of lobes refer to. */
static const char *alpha_text(const hnbrdf_scene *s)
{
    return !hnbrdf_scene_has_analytic(s) ? "vec2(1.0)"
           : s->anisotropic              ? "material_in.alpha"
                                         : "vec2(material_in.alpha)";
}

/* Both directions into the tangent frame, as far as any material is turned. */
static void put_pair(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "// Both directions in the tangent frame of the material.\n");
    hnbrdf_put(out,
               "hnbrdf_pair hnbrdf_scene_pair(hnbrdf_material material_in, vec3 wi, vec3 wo)\n{\n");
    hnbrdf_put(
        out,
        s->rotated
            ? "    return hnbrdf_pair_make(hnbrdf_to_tangent(material_in.rotation, wi),\n"
              "                            hnbrdf_to_tangent(material_in.rotation, wo));\n}\n\n"
            : "    return hnbrdf_pair_make(wi, wo);\n}\n\n");
}

/* The exponent s c + m; a scale of 1 and a shift of 0 change no bit and are left out. */
static void put_exponent(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int loaded = s->style == HNBRDF_GLSL_UNIFORM;
    hnbrdf_put(out, "    HNBRDF_PRECISE vec3 exp_arg = ");
    if (loaded || s->desc->scale != 1.0f) {
        hnbrdf_put_constant(out, s, 0);
        hnbrdf_put(out, " * ");
    }
    hnbrdf_put(out, "c_net");
    if (loaded || s->desc->shift != 0.0f) {
        hnbrdf_put(out, " + ");
        hnbrdf_put_constant(out, s, 1);
    }
    hnbrdf_put(out, ";\n");
}

/* On every value, where the scene has materials that conserve energy. */
static const char *factor(const hnbrdf_scene *s)
{
    return s->energy ? "hnbrdf_conserve(hnbrdf_energy_factor(material_in.energy_ramp, wi.z, wo.z), "
                     : "";
}

static void put_analytic(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "// f_a before it is clamped to what f may be.\n");
    hnbrdf_put(out, "vec3 hnbrdf_analytic(hnbrdf_material material_in, hnbrdf_pair p)\n{\n");
    hnbrdf_put(out, s->fixed
                        ? "    float d_v_v = hnbrdf_specular_of_area(p, material_in.alpha, "
                          "material_in.ggx_area);\n"
                          "    return hnbrdf_microfacet_of(material_in.kd_pi, material_in.eta_e, "
                          "p.cos_d, d_v_v);\n}\n\n"
                        : "    float d_v_v = hnbrdf_specular(p, material_in.alpha);\n"
                          "    return hnbrdf_microfacet(material_in.kd, material_in.eta, p.cos_d, "
                          "d_v_v);\n}\n\n");
}

static void put_eval_analytic(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int analytic = hnbrdf_scene_has_analytic(s);
    hnbrdf_put(out, "// f_a alone: Lambert + GGX, the cheapest level of detail%s.\n",
               analytic ? "" : ". This kind of model has none");
    hnbrdf_put(out,
               "vec3 hnbrdf_eval_analytic(hnbrdf_material material_in, vec3 wi, vec3 wo)\n{\n");
    if (analytic)
        hnbrdf_put(out, "%s    return hnbrdf_finish(hnbrdf_analytic(material_in, p));\n}\n\n",
                   HORIZON);
    else
        hnbrdf_put(out, "    return vec3(0.0);\n}\n\n");
}

/* What an edit of a material comes to; the specular part of f_a; and the pair that its network then
 * sees. */
static void put_edits(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "hnbrdf_edit hnbrdf_scene_edit(hnbrdf_material material_in)\n{\n    return ");
    if (s->fixed)
        hnbrdf_put(out, "hnbrdf_edit(material_in.edit_warp, material_in.edit_alpha, "
                        "material_in.edit_area, material_in.edit_kd,\n"
                        "                       material_in.edit_e, material_in.edit_carried, "
                        "material_in.edit_added);\n}\n\n");
    else
        hnbrdf_put(out,
                   "hnbrdf_edit_make(material_in.kd, material_in.eta, %s,\n"
                   "                            hnbrdf_fitted(material_in.fitted_kd, "
                   "material_in.fitted_eta, material_in.fitted_alpha));\n}\n\n",
                   alpha_text(s));
    hnbrdf_put(out, "vec3 hnbrdf_scene_specular(hnbrdf_material material_in, hnbrdf_pair p)\n{\n");
    hnbrdf_put(out, s->fixed ? "    HNBRDF_PRECISE vec3 f_specular = "
                               "hnbrdf_fresnel_of_e(material_in.eta_e, p.cos_d) *\n"
                               "                                     hnbrdf_specular_of_area(p, "
                               "material_in.alpha, material_in.ggx_area);\n"
                             : "    HNBRDF_PRECISE vec3 f_specular = "
                               "hnbrdf_fresnel_dielectric(material_in.eta, p.cos_d) *\n"
                               "                                     hnbrdf_specular(p, "
                               "material_in.alpha);\n");
    hnbrdf_put(out, "    return f_specular;\n}\n\n");
    hnbrdf_put(out, "hnbrdf_pair hnbrdf_scene_seen(hnbrdf_edit edit_in, hnbrdf_pair p, vec3 "
                    "f_specular)\n{\n"
                    "    float part_specular = hnbrdf_specular_part(f_specular, "
                    "edit_in.kd_carried);\n    return ");
    hnbrdf_put(out, "%s(p, hnbrdf_warped(p, edit_in.warp_by, part_specular));\n}\n\n",
               hnbrdf_scene_seen_function(s));
}

/* In hnbrdf_eval(): f_a of what the material is and of what it was fitted with. */
static void put_edited(hnbrdf_printer *out)
{
    hnbrdf_put(out, "    hnbrdf_edit edit_in = hnbrdf_scene_edit(material_in);\n"
                    "    vec3 f_specular = hnbrdf_scene_specular(material_in, p);\n"
                    "    HNBRDF_PRECISE vec3 f_edited = edit_in.kd_carried + f_specular;\n"
                    "    hnbrdf_pair pair_seen = hnbrdf_scene_seen(edit_in, p, f_specular);\n"
                    "    vec3 f_fitted = hnbrdf_microfacet_fitted(p, pair_seen, edit_in);\n");
}

static void put_eval(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "// f(wi, wo) in 1/sr without the cosine, 0 below the horizon.\n");
    hnbrdf_put(out, "vec3 hnbrdf_eval(hnbrdf_material material_in, vec3 wi, vec3 wo)\n{\n%s",
               HORIZON);
    if (!hnbrdf_scene_has_network(s)) {
        hnbrdf_put(out, "    return %shnbrdf_finish(hnbrdf_analytic(material_in, p))%s;\n}\n",
                   factor(s), s->energy ? ")" : "");
        return;
    }
    int hybrid = s->desc->kind == HNBRDF_KIND_HYBRID;
    if (s->edited)
        put_edited(out);
    hnbrdf_put(out, "    vec3 x_0, x_1, c_net%s;\n", hybrid ? ", g_net" : "");
    hnbrdf_put(out, "    HNBRDF_SCENE_ENCODE(%s, x_0, x_1);\n", s->edited ? "pair_seen" : "p");
    hnbrdf_put(out, "    hnbrdf_network(material_in, x_0, x_1, c_net%s);\n",
               hybrid ? ", g_net" : "");
    put_exponent(out, s);
    hnbrdf_put(out, "    return %s%s", factor(s),
               s->edited ? "hnbrdf_compose_edited(exp_arg, g_net, f_edited, f_fitted, "
                           "edit_in.kd_added, "
               : hybrid  ? "hnbrdf_compose_hybrid(exp_arg, g_net, hnbrdf_analytic(material_in, p), "
                         : "hnbrdf_compose_neural(exp_arg, ");
    hnbrdf_put_constant(out, s, 2);
    hnbrdf_put(out, ")%s;\n}\n", s->energy ? ")" : "");
}

/* ---- Sampling -------------------------------------------------------------------------------- */

#define LOBES \
    "hnbrdf_lobes(material_in.lobe_scale, material_in.lobe_share_0, material_in.lobe_share_1)"

static void put_pdf(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "\n// Density in 1/sr with which hnbrdf_sample() draws wi given wo, 0 below "
                    "the horizon.\n");
    hnbrdf_put(out, "float hnbrdf_pdf(hnbrdf_material material_in, vec3 wi, vec3 wo)\n{\n"
                    "    if (!(wi.z > 0.0 && wo.z > 0.0))\n        return 0.0;\n");
    if (s->rotated)
        hnbrdf_put(out, "    wi = hnbrdf_to_tangent(material_in.rotation, wi);\n"
                        "    wo = hnbrdf_to_tangent(material_in.rotation, wo);\n");
    hnbrdf_put(out, "    return hnbrdf_density(%s, " LOBES ", wi, wo);\n}\n", alpha_text(s));
}

static void put_sample_direction(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "\n// Draws wi alone, for renderers that weigh it otherwise. u_rand is two "
                    "numbers in [0, 1), "
                    "made as\n// float(u32 >> 8) * 2^-24. Returns its density. 0 means: no "
                    "direction, (0, 0, 1).\n");
    hnbrdf_put(
        out,
        "float hnbrdf_sample_direction(hnbrdf_material material_in, vec3 wo, vec2 u_rand, out vec3 "
        "wi)\n{\n"
        "    wi = vec3(0.0, 0.0, 1.0);\n"
        "    if (!(wo.z > 0.0))\n        return 0.0;\n");
    hnbrdf_put(out, "    vec3 wi_drawn = hnbrdf_draw(%s, " LOBES ", %s, u_rand);\n", alpha_text(s),
               s->rotated ? "hnbrdf_to_tangent(material_in.rotation, wo)" : "wo");
    if (s->rotated)
        hnbrdf_put(out, "    wi_drawn = hnbrdf_from_tangent(material_in.rotation, wi_drawn);\n");
    hnbrdf_put(out, "    float pdf = hnbrdf_pdf(material_in, wi_drawn, wo);\n"
                    "    if (!(pdf > 0.0))\n        return 0.0;\n"
                    "    wi = wi_drawn;\n    return pdf;\n}\n");
}

static void put_sample(hnbrdf_printer *out)
{
    hnbrdf_put(out, "\n// Draws wi given wo and weighs it.\n");
    hnbrdf_put(
        out,
        "hnbrdf_sample_result hnbrdf_sample(hnbrdf_material material_in, vec3 wo, vec2 u_rand)\n{\n"
        "    hnbrdf_sample_result s;\n"
        "    s.pdf = hnbrdf_sample_direction(material_in, wo, u_rand, s.wi);\n"
        "    s.weight = vec3(0.0);\n"
        "    if (!(s.pdf > 0.0))\n        return s;\n"
        "    HNBRDF_PRECISE vec3 weight = hnbrdf_eval(material_in, s.wi, wo) * s.wi.z / s.pdf;\n"
        "    s.weight = hnbrdf_finish(weight);\n    return s;\n}\n");
}

/* ---- World space ----------------------------------------------------------------------------- */

static const char EVAL_WORLD[] =
    "\n// The same with directions of the world, of length 1, and the normal and tangent there, of "
    "any length and\n"
    "// angle. Where the normal is bent (normal maps, interpolation) so that wo is behind it, f is "
    "0: black seams.\n"
    "// Turn it towards the viewer then, of unit vectors: n += wo * max(0.0, 0.01 - dot(n, wo)).\n"
    "vec3 hnbrdf_eval_world(hnbrdf_material material_in, vec3 n_world, vec3 t_world, vec3 wi, vec3 "
    "wo)\n{\n"
    "    hnbrdf_world_frame frame_in = hnbrdf_world_frame_make(n_world, t_world);\n"
    "    return hnbrdf_eval(material_in, hnbrdf_to_frame(frame_in, wi), "
    "hnbrdf_to_frame(frame_in, wo));\n}\n";

static const char SAMPLE_WORLD[] =
    "\nfloat hnbrdf_pdf_world(hnbrdf_material material_in, vec3 n_world, vec3 t_world, vec3 wi, "
    "vec3 wo)\n{\n"
    "    hnbrdf_world_frame frame_in = hnbrdf_world_frame_make(n_world, t_world);\n"
    "    return hnbrdf_pdf(material_in, hnbrdf_to_frame(frame_in, wi), hnbrdf_to_frame(frame_in, "
    "wo));\n}\n"
    "\nhnbrdf_sample_result hnbrdf_sample_world(hnbrdf_material material_in, vec3 n_world, vec3 "
    "t_world, vec3 wo,\n"
    "                                         vec2 u_rand)\n{\n"
    "    hnbrdf_world_frame frame_in = hnbrdf_world_frame_make(n_world, t_world);\n"
    "    hnbrdf_sample_result s = hnbrdf_sample(material_in, hnbrdf_to_frame(frame_in, wo), "
    "u_rand);\n"
    "    s.wi = hnbrdf_from_frame(frame_in, s.wi);\n"
    "    return s;\n}\n";

static void put_world(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put_bytes(out, EVAL_WORLD, sizeof EVAL_WORLD - 1);
    if (hnbrdf_scene_has_sampling(s))
        hnbrdf_put_bytes(out, SAMPLE_WORLD, sizeof SAMPLE_WORLD - 1);
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
    put_world(out, s);
    if (s->fixed)
        put_named(out, s);
}
