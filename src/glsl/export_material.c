/* export_material.c: the material of a scene as a GLSL struct, and the scene's materials as
 * constants. */
#include "glsl/export_material.h"

#include "core/prepared.h"

void hnbrdf_put_material_struct(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "struct hnbrdf_material {\n");
    if (hnbrdf_scene_has_analytic(s)) {
        hnbrdf_put(out, s->fixed ? "    vec3 kd_pi;    // kd / pi\n"
                                   "    vec3 eta_e;    // eta^2 - 1\n"
                                 : "    vec3 kd;       // diffuse albedo\n"
                                   "    vec3 eta;      // index of refraction, above 1\n");
        hnbrdf_put(out, s->anisotropic
                            ? "    vec2 alpha;    // GGX roughness along x and y, at least 1e-4\n"
                            : "    float alpha;   // GGX roughness, at least 1e-4\n");
        if (s->fixed)
            hnbrdf_put(out, "    float ggx_area; // pi alpha alpha\n");
        if (s->edited)
            hnbrdf_put(out, s->fixed ? "    vec2 edit_warp, edit_alpha;  // hnbrdf_edit\n"
                                       "    float edit_area;\n"
                                       "    vec3 edit_kd, edit_e, edit_carried, edit_added;\n"
                                     : "    vec3 fitted_kd, fitted_eta; // hnbrdf_fitted, an edit "
                                       "leaves it as it is\n"
                                       "    vec2 fitted_alpha;\n");
    }
    if (hnbrdf_scene_has_rotation(s))
        hnbrdf_put(out, "    vec2 rotation; // cosine and sine of the tangent frame's angle\n");
    for (int v = 0; v < hnbrdf_scene_latent_vectors(s); v++)
        hnbrdf_put(out, "    vec4 latent%d;\n", v);
    for (int v = 0; v < hnbrdf_scene_bias_vectors(s); v++)
        hnbrdf_put(out, "    vec4 bias_%d;%s\n", v,
                   v == 0 ? "    // of the first layer, the latent code folded in" : "");
    if (hnbrdf_scene_has_sampling(s))
        hnbrdf_put(out, "    vec2 lobe_scale;           // hnbrdf_lobes, for sampling alone\n"
                        "    vec4 lobe_share_0, lobe_share_1;\n");
    if (s->energy)
        hnbrdf_put(out, "    vec2 energy_ramp; // of hnbrdf_energy_factor(), (1, 0): none\n");
    hnbrdf_put(out, "};\n\n");
}

/* The separator of a list that begins with put_next(out, 0). */
static void put_next(hnbrdf_printer *out, int *fields)
{
    if ((*fields)++ > 0)
        hnbrdf_put(out, ", ");
}

static void put_edit(hnbrdf_printer *out, const hnbrdf_prepared *prepared)
{
    const hnbrdf_prepared_edit edit = hnbrdf_edit_of(prepared);
    const float *const vectors[] = {edit.diffuse, edit.e, edit.carried, edit.added};
    hnbrdf_put_vector(out, 2, edit.warp, 2);
    hnbrdf_put(out, ", ");
    hnbrdf_put_vector(out, 2, edit.alpha, 2);
    hnbrdf_put(out, ", ");
    hnbrdf_put_float(out, edit.area);
    for (int k = 0; k < 4; k++) {
        hnbrdf_put(out, ", ");
        hnbrdf_put_vector(out, 3, vectors[k], 3);
    }
}

static void put_fitted(hnbrdf_printer *out, const hnbrdf_fitted *fitted)
{
    hnbrdf_put_vector(out, 3, fitted->kd, 3);
    hnbrdf_put(out, ", ");
    hnbrdf_put_vector(out, 3, fitted->eta, 3);
    hnbrdf_put(out, ", ");
    hnbrdf_put_vector(out, 2, fitted->alpha, 2);
}

static void put_analytic_fields(hnbrdf_printer *out, const hnbrdf_scene *s,
                                const hnbrdf_material *material, const hnbrdf_prepared *prepared,
                                int *fields)
{
    put_next(out, fields);
    hnbrdf_put_vector(out, 3, s->fixed ? prepared->diffuse : material->kd, 3);
    put_next(out, fields);
    hnbrdf_put_vector(out, 3, s->fixed ? prepared->e : material->eta, 3);
    put_next(out, fields);
    if (s->anisotropic)
        hnbrdf_put_vector(out, 2, material->alpha, 2);
    else
        hnbrdf_put_float(out, material->alpha[0]);
    if (s->fixed) {
        put_next(out, fields);
        hnbrdf_put_float(out, prepared->area);
    }
    if (s->edited) {
        put_next(out, fields);
        if (s->fixed)
            put_edit(out, prepared);
        else
            put_fitted(out, &material->fitted);
    }
}

static void put_lobes(hnbrdf_printer *out, const hnbrdf_lobes *lobes)
{
    hnbrdf_put_vector(out, 2, lobes->scale, HNBRDF_LOBES);
    for (int k = 0; k < HNBRDF_LOBES; k++) {
        hnbrdf_put(out, ", ");
        hnbrdf_put_vector(out, 4, lobes->share[k], HNBRDF_LOBE_KNOTS);
    }
}

void hnbrdf_put_material(hnbrdf_printer *out, const hnbrdf_scene *s, int k)
{
    const hnbrdf_material *material = hnbrdf_scene_material(s, k);
    hnbrdf_prepared prepared;
    int fields = 0;
    hnbrdf_prepare(s->model, material, &prepared);
    hnbrdf_put(out, "hnbrdf_material(");
    if (hnbrdf_scene_has_analytic(s))
        put_analytic_fields(out, s, material, &prepared, &fields);
    if (hnbrdf_scene_has_rotation(s)) {
        const float turned[2] = {prepared.cosine, prepared.sine};
        put_next(out, &fields);
        hnbrdf_put_vector(out, 2, turned, 2);
    }
    for (int v = 0; v < hnbrdf_scene_latent_vectors(s); v++) {
        put_next(out, &fields);
        hnbrdf_put_vector(out, 4, material->latent + 4 * v, s->desc->latent - 4 * v);
    }
    for (int v = 0; v < hnbrdf_scene_bias_vectors(s); v++) {
        put_next(out, &fields);
        hnbrdf_put_vector(out, 4, prepared.first + 4 * v, s->desc->hidden - 4 * v);
    }
    if (hnbrdf_scene_has_sampling(s)) {
        put_next(out, &fields);
        put_lobes(out, &prepared.lobes);
    }
    if (s->energy) {
        const float ramp[2] = {prepared.energy.horizon, prepared.energy.slope};
        put_next(out, &fields);
        hnbrdf_put_vector(out, 2, ramp, 2);
    }
    hnbrdf_put(out, ")");
}

/* A name in a comment, where some engines end a line at a semicolon. */
static void put_name(hnbrdf_printer *out, const char *name)
{
    for (; *name; name++)
        hnbrdf_put_bytes(out, *name == ';' ? "," : name, 1);
}

static void put_indent(hnbrdf_printer *out, int depth)
{
    for (int k = 0; k < depth; k++)
        hnbrdf_put(out, "    ");
}

/* Halves, by turns: through a chain of comparisons a shader with a thousand materials takes longer
 * than its network. Constants in an array are no way: drivers copy all of it for every evaluation,
 * or compile for minutes. */
static void put_range(hnbrdf_printer *out, const hnbrdf_scene *s, int first, int count, int depth)
{
    const int half = count / 2, middle = first + half, lone = half == 1;
    if (count == 1) {
        put_indent(out, depth);
        hnbrdf_put(out, "return ");
        hnbrdf_put_material(out, s, first);
        hnbrdf_put(out, ";\n");
        return;
    }
    put_indent(out, depth);
    hnbrdf_put(out, "if (material_place < %d)%s\n", middle, lone ? "" : " {");
    put_range(out, s, first, half, depth + 1);
    if (!lone) {
        put_indent(out, depth);
        hnbrdf_put(out, "}\n");
    }
    put_range(out, s, middle, count - half, depth);
}

void hnbrdf_put_materials(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    for (int k = 0; k < s->count; k++) {
        hnbrdf_put(out, "#define HNBRDF_MATERIAL_%s %d // \"", s->names[k], k);
        put_name(out, s->desc->names[hnbrdf_scene_index(s, k)]);
        hnbrdf_put(out, "\"\n");
    }
    hnbrdf_put(out, "#define HNBRDF_MATERIAL_COUNT %d\n\n", s->count);
    hnbrdf_put(out,
               "// Any number outside of [0, HNBRDF_MATERIAL_COUNT) stands for the last one.\n");
    hnbrdf_put(out, "hnbrdf_material hnbrdf_scene_material(int material_index)\n{\n");
    if (s->count > 1)
        hnbrdf_put(out, "    int material_place = material_index < 0 ? %d : material_index;\n",
                   s->count - 1);
    put_range(out, s, 0, s->count, 1);
    hnbrdf_put(out, "}\n\n");
}
