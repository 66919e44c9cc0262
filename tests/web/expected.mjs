// expected.mjs: what the C library says about pixels of the examples' picture: a sphere of radius 1 seen from a camera
// on the z axis, under one light, in 8-bit sRGB.
import { execFileSync } from 'node:child_process';

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const scale = (a, s) => a.map((x) => x * s);
const add = (a, b) => a.map((x, i) => x + b[i]);
const normalize = (a) => scale(a, 1 / Math.hypot(...a));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

const view = {
  camera: [0, 0, 4], field: Math.tan(Math.PI / 12), // tan of half of 30 degrees
  toLight: [0.4364358, 0.5345225, 0.7237469], irradiance: 3,
};

function toFrame(n, v) {
  const t = normalize(cross(Math.abs(n[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0], n));
  return [dot(v, t), dot(v, cross(n, t)), dot(v, n)];
}

// The two directions where the ray through (x, y), -1 to 1, meets a sphere of this radius at the origin; null beside
// it.
function directions(x, y, radius) {
  const ray = normalize([x * view.field, y * view.field, -1]);
  const along = -dot(view.camera, ray);
  const inside = along * along - dot(view.camera, view.camera) + radius * radius;
  if (inside <= 0) return null;
  const n = normalize(add(view.camera, scale(ray, along - Math.sqrt(inside))));
  return { wi: toFrame(n, normalize(view.toLight)), wo: toFrame(n, scale(ray, -1)) };
}

const toDisplay = (c) => {
  c = Math.min(Math.max(c, 0), 1);
  return 255 * (c < 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);
};

// For pixels [x, y] of a picture of size x size: { pixel, low, high }, three numbers each, between which a picture must
// lie. A mesh is no sphere: its points lie on the ray between spheres of radius `inner` and `outer`, their interpolated
// normal still points from the centre. Rasterizers move vertices by up to `snap` pixels. 4e-6 is what a dozen roundings
// of floats of size 4 (the camera) may move a point. Formats with 8 bits are 0.6 of a step off at most (Vulkan, 3.9;
// GL rounds to the nearest).
export function expect(hnbrdf, model, material, size, pixels, { inner = 1, outer = 1, snap = 0 } = {}) {
  const rows = [];
  const owners = [];
  const edge = snap + 4e-6 * size;
  for (const [index, [x, y]] of pixels.entries())
    for (const dx of [-edge, 0, edge])
      for (const dy of [-edge, 0, edge])
        for (const step of inner === outer ? [0] : [0, 0.25, 0.5, 0.75, 1]) {
          const radius = inner + (outer - inner) * step;
          const d = directions(2 * (x + 0.5 + dx) / size - 1, 1 - 2 * (y + 0.5 + dy) / size, radius);
          if (!d) throw new Error(`pixel ${x}, ${y} is too near to the edge of the sphere`);
          rows.push(d);
          owners.push(index);
        }
  const csv = rows.map(({ wi, wo }) => [...wi, ...wo].join(',')).join('\n') + '\n';
  const out = execFileSync(hnbrdf, ['eval', model, '--material', material],
    { input: csv, encoding: 'utf8', maxBuffer: 1 << 26 });
  const values = out.trim().split('\n').slice(1).map((line) => line.split(',').map(Number));
  if (values.length !== rows.length)
    throw new Error(`hnbrdf eval gave ${values.length} lines, expected ${rows.length}`);
  const result = pixels.map((pixel) => ({ pixel, low: [255, 255, 255], high: [0, 0, 0] }));
  values.forEach((f, row) => f.forEach((value, c) => {
    const shown = toDisplay(value * view.irradiance * Math.max(rows[row].wi[2], 0));
    const { low, high } = result[owners[row]];
    low[c] = Math.min(low[c], shown - 0.6);
    high[c] = Math.max(high[c], shown + 0.6);
  }));
  return result;
}
