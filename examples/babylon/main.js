// One material in Babylon.js: a ShaderMaterial of one's own, with one light that follows the pointer.
// With ?webgpu behind the address the same GLSL runs on WebGPU: Babylon translates it.
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { WebGPUEngine } from '@babylonjs/core/Engines/webgpuEngine.js';
import { ShaderMaterial } from '@babylonjs/core/Materials/shaderMaterial.js';
import { Color3, Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { CreateSphere } from '@babylonjs/core/Meshes/Builders/sphereBuilder.js';
import { Scene } from '@babylonjs/core/scene.js';

const brdf = await (await fetch('scene.glsl')).text(); // hnbrdf export --standalone

const vertexSource = `
precision highp float;
attribute vec3 position;
attribute vec3 normal;
uniform mat4 world;
uniform mat4 viewProjection;
varying vec3 worldNormal;
varying vec3 worldPosition;
void main() {
    vec4 p = world * vec4(position, 1.0);
    worldPosition = p.xyz;
    worldNormal = mat3(world) * normal; // of a mesh that is moved and turned, not stretched
    gl_Position = viewProjection * p;
}`;

const fragmentSource = `
precision highp float;
${brdf}
uniform vec3 cameraPosition;
uniform vec3 toLight;
uniform vec3 irradiance;
varying vec3 worldNormal;
varying vec3 worldPosition;

vec3 toDisplay(vec3 c) { // sRGB
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
    vec3 n = normalize(worldNormal);
    vec3 t = vec3(0.0); // no tangent: any does for a material that is isotropic
    vec3 toViewer = normalize(cameraPosition - worldPosition);
    vec3 f = hnbrdf_eval_world(hnbrdf_scene_material(0), n, t, toLight, toViewer);
    gl_FragColor = vec4(toDisplay(f * irradiance * max(dot(n, toLight), 0.0)), 1.0);
}`;

async function createEngine(canvas) {
  if (!location.search.includes('webgpu')) return new Engine(canvas, true);
  const assets = new URL('node_modules/@babylonjs/core/assets/', location.href).href;
  const engine = new WebGPUEngine(canvas, { antialias: true });
  await engine.initAsync({ jsPath: `${assets}glslang/glslang.js`, wasmPath: `${assets}glslang/glslang.wasm` },
    { jsPath: `${assets}twgsl/twgsl.js`, wasmPath: `${assets}twgsl/twgsl.wasm` });
  return engine;
}

const canvas = document.querySelector('canvas');
const engine = await createEngine(canvas);
const scene = new Scene(engine);
scene.useRightHandedSystem = true; // x to the right, y up, z towards the viewer
scene.clearColor = new Color4(0, 0, 0, 1);
const camera = new FreeCamera('camera', new Vector3(0, 0, 4), scene);
camera.setTarget(Vector3.Zero());
camera.fov = Math.PI / 6;
camera.minZ = 0.1;

const material = new ShaderMaterial('hnbrdf', scene, { vertexSource, fragmentSource }, {
  attributes: ['position', 'normal'],
  uniforms: ['world', 'viewProjection', 'cameraPosition', 'toLight', 'irradiance'],
});
material.setVector3('cameraPosition', camera.position);
material.setVector3('toLight', new Vector3(0.4364358, 0.5345225, 0.7237469)); // in world space, of length 1
material.setColor3('irradiance', new Color3(3, 3, 3)); // of a surface that faces the light
material.onError = (effect, errors) => { document.body.textContent = errors; };
CreateSphere('sphere', { diameter: 2, segments: 62 }, scene).material = material;

function draw() { // on demand; engine.runRenderLoop() would draw all the time
  engine.beginFrame();
  scene.render();
  engine.endFrame();
}
await material.forceCompilationAsync(scene.meshes[0]);
draw();
canvas.addEventListener('pointermove', ({ offsetX, offsetY }) => {
  material.setVector3('toLight', new Vector3(offsetX / 128 - 1, 1 - offsetY / 128, 0.7).normalize());
  draw();
});
