// One material in three.js, in two ways. Left: a ShaderMaterial of one's own, with one light. Right: a
// MeshStandardMaterial whose lights loop calls the BRDF, so that all lights and shadows of three.js work.
import * as THREE from 'three';

const brdf = await (await fetch('scene.glsl')).text(); // hnbrdf export --standalone

function shaderMaterial(toLight, irradiance) {
  return new THREE.ShaderMaterial({
    uniforms: { toLight: { value: toLight }, irradiance: { value: irradiance } }, // in world space, of length 1
    vertexShader: `
      varying vec3 worldNormal;
      varying vec3 worldPosition;
      void main() {
          vec4 position4 = modelMatrix * vec4(position, 1.0);
          worldPosition = position4.xyz;
          worldNormal = mat3(modelMatrix) * normal; // of a mesh that is moved and turned, not stretched
          gl_Position = projectionMatrix * viewMatrix * position4;
      }`,
    fragmentShader: `
      ${brdf}
      uniform vec3 toLight, irradiance;
      varying vec3 worldNormal;
      varying vec3 worldPosition;
      void main() {
          vec3 n = normalize(worldNormal);
          vec3 t = vec3(0.0); // no tangent: any does for a material that is isotropic
          vec3 toViewer = normalize(cameraPosition - worldPosition);
          vec3 f = hnbrdf_eval_world(hnbrdf_scene_material(0), n, t, toLight, toViewer);
          gl_FragColor = vec4(f * irradiance * max(dot(n, toLight), 0.0), 1.0);
          #include <tonemapping_fragment>
          #include <colorspace_fragment>
      }`,
  });
}

// RE_Direct is what the lights loop of three.js calls for each light. Indirect light (environment maps) still sees
// the standard material, here a black one.
function standardMaterial() {
  const material = new THREE.MeshStandardMaterial({ color: 0x000000 });
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace('#include <lights_physical_pars_fragment>', `
      #include <lights_physical_pars_fragment>
      ${brdf}
      void hnbrdfDirect(const in IncidentLight directLight, const in vec3 geometryPosition,
              const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal,
              const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
          vec3 toLight = directLight.direction; // in the space of the view, as the normal
          vec3 f = hnbrdf_eval_world(hnbrdf_scene_material(0), geometryNormal, vec3(0.0), toLight, geometryViewDir);
          reflectedLight.directSpecular += f * directLight.color * max(dot(geometryNormal, toLight), 0.0);
      }
      #undef RE_Direct
      #define RE_Direct hnbrdfDirect`);
  };
  return material;
}

const renderer = new THREE.WebGLRenderer({ canvas: document.querySelector('canvas'), antialias: true });
renderer.setSize(512, 256);
renderer.setScissorTest(true);
renderer.debug.onShaderError = (gl, program, vertex, fragment) => {
  throw new Error(gl.getShaderInfoLog(vertex) + gl.getShaderInfoLog(fragment) + gl.getProgramInfoLog(program));
};
const camera = new THREE.PerspectiveCamera(30, 1, 0.1, 100);
camera.position.z = 4;
const sphere = new THREE.SphereGeometry(1, 128, 64);
const light = new THREE.DirectionalLight(0xffffff, 3); // irradiance of a surface that faces it
light.position.set(0.4364358, 0.5345225, 0.7237469);

const left = new THREE.Scene();
const irradiance = light.color.clone().multiplyScalar(light.intensity);
left.add(new THREE.Mesh(sphere, shaderMaterial(light.position, irradiance)));
const right = new THREE.Scene();
right.add(new THREE.Mesh(sphere, standardMaterial()), light);

function draw() {
  for (const [place, scene] of [left, right].entries()) {
    renderer.setViewport(256 * place, 0, 256, 256);
    renderer.setScissor(256 * place, 0, 256, 256);
    renderer.render(scene, camera);
  }
}
draw();
renderer.domElement.addEventListener('pointermove', ({ offsetX, offsetY }) => { // the light follows the pointer
  light.position.set(offsetX % 256 / 128 - 1, 1 - offsetY / 128, 0.7).normalize();
  draw();
});
