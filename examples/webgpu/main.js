// A sphere of one material under one light, drawn by a fragment shader of WebGPU without any library.
// The light follows the pointer.
const scene = await (await fetch('scene.wgsl')).text(); // hnbrdf export --language wgsl --standalone

const code = `${scene}
struct Frame {
    toLight: vec3f,    // of length 1
    size: f32,         // of the picture in pixels, which is a square
    irradiance: vec3f, // on a surface that faces the light
}
@group(0) @binding(0) var<uniform> frame: Frame;

const camera = vec3f(0.0, 0.0, 4.0);
const field = 0.26794919; // tan of half the field of view, 30 degrees

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f { // one triangle that covers the picture
    return vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

fn toDisplay(radiance: vec3f) -> vec3f { // sRGB
    let c = clamp(radiance, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c < vec3f(0.0031308));
}

@fragment
fn colour(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let place = (2.0 * pixel.xy / frame.size - 1.0) * vec2f(field, -field); // rows count downwards
    let ray = normalize(vec3f(place, -1.0));
    let along = -dot(camera, ray); // to where the ray is nearest to the centre of the sphere of radius 1
    let inside = along * along - dot(camera, camera) + 1.0;
    if (inside <= 0.0) {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    let n = camera + ray * (along - sqrt(inside)); // the point is its own normal
    let t = vec3f(0.0); // no tangent: any does for a material that is isotropic
    let f = hnbrdf_eval_world(hnbrdf_scene_material(0), n, t, frame.toLight, -ray);
    return vec4f(toDisplay(f * frame.irradiance * max(dot(n, frame.toLight), 0.0)), 1.0);
}`;

const canvas = document.querySelector('canvas');
const adapter = await navigator.gpu?.requestAdapter();
if (!adapter) throw new Error('this browser has no WebGPU');
const device = await adapter.requestDevice();
const context = canvas.getContext('webgpu');
const format = navigator.gpu.getPreferredCanvasFormat();
context.configure({ device, format, alphaMode: 'opaque' });

const module = device.createShaderModule({ code });
const { messages } = await module.getCompilationInfo();
for (const { type, lineNum, message } of messages) if (type === 'error') throw new Error(`line ${lineNum}: ${message}`);
const pipeline = await device.createRenderPipelineAsync({
  layout: 'auto',
  vertex: { module },
  fragment: { module, targets: [{ format }] },
});
const uniforms = device.createBuffer({ size: 32, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
const group = device.createBindGroup({
  layout: pipeline.getBindGroupLayout(0),
  entries: [{ binding: 0, resource: { buffer: uniforms } }],
});

function draw(toLight) {
  device.queue.writeBuffer(uniforms, 0, new Float32Array([...toLight, canvas.width, 3, 3, 3, 0]));
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginRenderPass({
    colorAttachments: [{ view: context.getCurrentTexture().createView(), loadOp: 'clear', storeOp: 'store' }],
  });
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, group);
  pass.draw(3);
  pass.end();
  device.queue.submit([encoder.finish()]);
}
draw([0.4364358, 0.5345225, 0.7237469]);
canvas.addEventListener('pointermove', ({ offsetX, offsetY }) => {
  const [x, y] = [2 * offsetX / canvas.width - 1, 1 - 2 * offsetY / canvas.height];
  const length = Math.hypot(x, y, 0.7);
  draw([x / length, y / length, 0.7 / length]);
});
