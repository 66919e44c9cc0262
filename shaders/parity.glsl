// parity.glsl: the functions of an exported scene for one row of inputs, to be compared with the C library. Included
// after the scene, whose names are those without a prefix. One body for every language and API: `hnbrdf verify` runs it,
// `hnbrdf verify --hand-out` gives it to other programs, with probe.glsl behind it.

// A row of inputs, 16 numbers:
//   a  index of the material, wi      b  wo, u.x      c  u.y, 0, encoded[0..1]      d  encoded[2..5]
// Outputs, 8 slots of four:
//   0  encoding[0..2], 0              1  encoding[3..5], 0
//   2  network c, 0                   3  network g, 0        of the encoded inputs of the row; g of a hybrid alone
//   4  analytic part, pdf of wi       5  value, 0
//   6  sampled wi, its pdf            7  its weight, 1 if the order of operations is kept (`precise`), else 0
// What the kind of model does not have is 0.
vec4 hnbrdf_parity(vec4 a, vec4 b, vec4 c, vec4 d, int slot)
{
    hnbrdf_material m = hnbrdf_scene_material(int(a.x + 0.5));
    vec3 wi = a.yzw;
    vec3 wo = b.xyz;
    if (slot == 4)
        return vec4(hnbrdf_eval_analytic(m, wi, wo), hnbrdf_pdf(m, wi, wo));
    if (slot == 5)
        return vec4(hnbrdf_eval(m, wi, wo), 0.0);
    if (slot >= 6) {
        hnbrdf_sample_result drawn = hnbrdf_sample(m, wo, vec2(b.w, c.x));
#if HNBRDF_EXACT == 1 && ((defined(GL_ES) && __VERSION__ >= 320) || (!defined(GL_ES) && __VERSION__ >= 400))
        float ordered = 1.0;
#else
        float ordered = 0.0;
#endif
        return slot == 6 ? vec4(drawn.wi, drawn.pdf) : vec4(drawn.weight, ordered);
    }
#ifdef HNBRDF_SCENE_GGX
    return vec4(0.0);
#else
    vec3 x0 = vec3(0.0);
    vec3 x1 = vec3(0.0);
    if (slot < 2) {
        hnbrdf_pair p = hnbrdf_scene_pair(m, wi, wo);
#ifdef HNBRDF_SCENE_EDITED
        hnbrdf_edit edit = hnbrdf_scene_edit(m);
        p = hnbrdf_scene_seen(edit, p, hnbrdf_scene_specular(m, p));
#endif
        HNBRDF_SCENE_ENCODE(p, x0, x1);
    } else {
#ifdef HNBRDF_SCENE_HYBRID
        hnbrdf_network(m, vec3(c.zw, d.x), d.yzw, x0, x1);
#else
        hnbrdf_network(m, vec3(c.zw, d.x), d.yzw, x0);
#endif
    }
    return slot == 0 || slot == 2 ? vec4(x0, 0.0) : vec4(x1, 0.0);
#endif
}
