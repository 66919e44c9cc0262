// examples.mjs: where the pages in examples/ have their spheres, from left to right, 256 pixels each.
//
// A mesh of cells of 2 pi/128 by pi/64 has triangles whose corners lie on a circle of half a diagonal, r = 0.0347: on
// the ray of a pixel, their points lie between the sphere of radius 1 and one of cos r. With multisampling a pixel at
// the edge of a triangle is shaded as far outside of it as half a diagonal of a pixel, 0.015 where the surface is
// turned away by 66 degrees: there the triangle's plane is sqrt(cos^2 r + (r + 0.015)^2) from the centre.
// SwiftShader puts vertices on a grid of 1/16 pixel.
const r = 0.0347;
const mesh = { inner: Math.cos(r), outer: Math.sqrt(Math.cos(r) ** 2 + (r + 0.015) ** 2), snap: 1 / 32 };

const shader = { name: 'ShaderMaterial', ...mesh };

export const examples = {
  webgl: { spheres: [{ name: 'fragment shader' }] },
  three: { spheres: [shader, { name: 'MeshStandardMaterial', ...mesh }] },
  babylon: { spheres: [shader] },
  babylon_webgpu: { spheres: [shader], address: '?webgpu' },
  webgpu: { spheres: [{ name: 'fragment shader' }] },
};
