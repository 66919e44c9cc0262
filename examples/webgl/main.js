// A sphere of one material under one light, drawn by a fragment shader of WebGL2 without any library.
// The light follows the pointer.
const scene = await (await fetch('scene.glsl')).text(); // hnbrdf export --standalone

const vertex = `#version 300 es
void main() { // one triangle that covers the picture
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}`;

const fragment = `#version 300 es
precision highp float;
${scene}
uniform vec3 toLight;    // of length 1
uniform vec3 irradiance; // on a surface that faces the light
uniform vec2 size;       // of the picture in pixels
out vec4 colour;

const vec3 camera = vec3(0.0, 0.0, 4.0);
const float field = 0.26794919; // tan of half the field of view, 30 degrees

vec3 toDisplay(vec3 c) { // sRGB
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
    colour = vec4(0.0, 0.0, 0.0, 1.0);
    vec3 ray = normalize(vec3((2.0 * gl_FragCoord.xy / size - 1.0) * field, -1.0));
    float along = -dot(camera, ray); // to where the ray is nearest to the centre of the sphere of radius 1
    float inside = along * along - dot(camera, camera) + 1.0;
    if (inside <= 0.0)
        return;
    vec3 n = camera + ray * (along - sqrt(inside)); // the point is its own normal
    vec3 t = vec3(0.0); // no tangent: any does for a material that is isotropic
    vec3 f = hnbrdf_eval_world(hnbrdf_scene_material(0), n, t, toLight, -ray);
    colour.rgb = toDisplay(f * irradiance * max(dot(n, toLight), 0.0));
}`;

const canvas = document.querySelector('canvas');
const gl = canvas.getContext('webgl2');
if (!gl) throw new Error('this browser has no WebGL2');

function compile(type, text) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  return shader;
}
const program = gl.createProgram();
const shaders = [compile(gl.VERTEX_SHADER, vertex), compile(gl.FRAGMENT_SHADER, fragment)];
for (const shader of shaders) gl.attachShader(program, shader);
gl.linkProgram(program);
if (!gl.getProgramParameter(program, gl.LINK_STATUS))
  throw new Error(shaders.map((s) => gl.getShaderInfoLog(s)).join('') + gl.getProgramInfoLog(program));

function draw(toLight) {
  gl.useProgram(program);
  gl.uniform3fv(gl.getUniformLocation(program, 'toLight'), toLight);
  gl.uniform3f(gl.getUniformLocation(program, 'irradiance'), 3, 3, 3);
  gl.uniform2f(gl.getUniformLocation(program, 'size'), canvas.width, canvas.height);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}
draw([0.4364358, 0.5345225, 0.7237469]);
canvas.addEventListener('pointermove', ({ offsetX, offsetY }) => {
  const [x, y] = [2 * offsetX / canvas.width - 1, 1 - 2 * offsetY / canvas.height];
  const length = Math.hypot(x, y, 0.7);
  draw([x / length, y / length, 0.7 / length]);
});
