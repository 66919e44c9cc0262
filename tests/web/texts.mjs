// texts.mjs: shaders of the exported texts that glsl_scenes wrote into a folder: NAME.alone.glsl for the names in
// FOLDER/names, each with everything its scene has.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

export const namesIn = (folder) => readFileSync(join(folder, 'names'), 'utf8').trim().split('\n');

// Statements that call what the text has, with m, wi, wo and a vec3 `sum`.
function calls(text) {
  const has = (name) => new RegExp(`^[a-z_0-9]+ ${name}\\(`, 'm').test(text);
  const list = ['sum += hnbrdf_eval(m, wi, wo);'];
  if (has('hnbrdf_eval_analytic')) list.push('sum += hnbrdf_eval_analytic(m, wi, wo);');
  if (has('hnbrdf_sample')) list.push('sum += hnbrdf_sample(m, wo, wi.xy).weight * hnbrdf_pdf(m, wi, wo);');
  const texels = Number(/^#define HNBRDF_TEXELS (\d+)/m.exec(text)?.[1] ?? 0);
  const texelList = Array.from({ length: texels }, (_, i) => (i % 2 ? 'wo.zyxz' : 'wi.xyzx')).join(', ');
  if (texels) list.push(`sum += hnbrdf_eval(hnbrdf_material_unpack(${texelList}), wi, wo);`);
  return list.join('\n    ');
}

// A fragment shader: head, the text as it was exported, declarations of wi, wo and colour, and main.
export function fragment(folder, name, head, declarations) {
  const text = readFileSync(join(folder, `${name}.alone.glsl`), 'utf8');
  return `${head}
${text}
${declarations}
void main() {
    hnbrdf_material m = hnbrdf_scene_material(HNBRDF_MATERIAL_GOLD_PAINT);
    vec3 sum = vec3(0.0);
    ${calls(text)}
    colour = vec4(sum, 1.0);
}
`;
}
