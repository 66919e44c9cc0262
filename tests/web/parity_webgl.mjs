// parity_webgl.mjs: runs a case of `hnbrdf verify --hand-out` (GLSL) in a page, by a fragment shader of WebGL2 that
// draws numbers: a pixel of a float texture for every row, once for every slot.

// Rows lie side by side in textures this wide; every implementation has 2048.
const WIDTH = 512;

const vertexText = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`;

// Around the exported texts: the number of the row from the place of the pixel, its inputs from the texture. `call`
// takes v0, v1, ... and slot. The text of the exact build says #define HNBRDF_EXACT 1 itself.
function fragmentText(texts, inputs, call) {
  let fetches = '';
  for (let i = 0; i < inputs; i++) fetches += `    vec4 v${i} = texelFetch(rows, at + ivec2(${i}, 0), 0);\n`;
  return `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
${texts.join('\n')}
uniform sampler2D rows;
uniform int slot;
out vec4 result;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) * ivec2(${inputs}, 1);
${fetches}    result = ${call};
}`;
}

// Programs by their text: a case that has the text of one before runs its program, with its own weights.
const programs = new Map();

function compile(gl, text) {
  if (programs.has(text)) return programs.get(text);
  const program = gl.createProgram();
  const shaders = [vertexText, text].map((text, i) => {
    const shader = gl.createShader([gl.VERTEX_SHADER, gl.FRAGMENT_SHADER][i]);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    return shader;
  });
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS))
    throw new Error(shaders.map((s) => gl.getShaderInfoLog(s)).join('') + gl.getProgramInfoLog(program));
  programs.set(text, program);
  return program;
}

function floatTexture(gl, width, height, data) {
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
  if (data) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RGBA, gl.FLOAT, data);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return gl.getParameter(gl.TEXTURE_BINDING_2D);
}

// The weights of a scene that reads them from a buffer; every block of the program sees them.
function bindWeights(gl, program, weights) {
  const blocks = gl.getProgramParameter(program, gl.ACTIVE_UNIFORM_BLOCKS);
  if (!weights && blocks) throw new Error('the shader has a uniform block, the case has no weights');
  if (!blocks) return;
  gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, gl.createBuffer());
  gl.bufferData(gl.UNIFORM_BUFFER, weights, gl.STATIC_DRAW);
  for (let i = 0; i < blocks; i++) gl.uniformBlockBinding(program, i, 0);
}

// What the shader makes of `numbers`, `inputs` vec4 a row: a Float32Array of `slots` vec4 a row.
function run(gl, program, numbers, inputs, slots, weights) {
  const rows = numbers.length / (4 * inputs);
  const height = Math.ceil(rows / WIDTH);
  const padded = new Float32Array(4 * inputs * WIDTH * height);
  padded.set(numbers);
  gl.useProgram(program);
  bindWeights(gl, program, weights);
  const target = floatTexture(gl, WIDTH, height, null);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  floatTexture(gl, inputs * WIDTH, height, padded);
  gl.viewport(0, 0, WIDTH, height);
  const drawn = new Float32Array(4 * WIDTH * height);
  const results = new Float32Array(4 * slots * rows);
  for (let slot = 0; slot < slots; slot++) {
    gl.uniform1i(gl.getUniformLocation(program, 'slot'), slot);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.readPixels(0, 0, WIDTH, height, gl.RGBA, gl.FLOAT, drawn);
    for (let row = 0; row < rows; row++)
      results.set(drawn.subarray(4 * row, 4 * row + 4), 4 * (slots * row + slot));
  }
  const error = gl.getError();
  if (error) throw new Error(`WebGL error 0x${error.toString(16)}`);
  return results;
}

let context = null;

// read(name) gives a file of the case as an ArrayBuffer. Gives { device, compiled: how many
// programs, files: { name: Float32Array } }.
export async function runCase(read) {
  const text = async (name) => new TextDecoder().decode(await read(name));
  const floats = async (name) => new Float32Array(await read(name));
  const about = JSON.parse(await text('case.json'));
  context ??= document.createElement('canvas').getContext('webgl2');
  const gl = context;
  if (!gl?.getExtension('EXT_color_buffer_float')) throw new Error('no WebGL2 with float targets');
  const known = programs.size;
  const weights = about.weights_bytes ? await read('weights.bin') : null;
  const inputs = await floats('inputs.f32');
  const files = {};
  for (const build of ['', '_exact']) {
    const texts = [await text(`scene${build}.glsl`), await text(`parity${build}.glsl`)];
    const parity = compile(gl, fragmentText(texts, 4, 'hnbrdf_parity(v0, v1, v2, v3, slot)'));
    files[`outputs${build}.f32`] = run(gl, parity, inputs, 4, about.slots, weights);
    if (!build) continue;
    const probe = compile(gl, fragmentText(texts, 1, 'hnbrdf_probe(v0, slot)'));
    files['probe_results.f32'] = run(gl, probe, await floats('probe.f32'), 1, about.probe_slots, weights);
  }
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const device = `WebGL2: ${gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER)}`;
  return { device, compiled: programs.size - known, files };
}
