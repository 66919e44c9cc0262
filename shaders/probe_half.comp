#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
// probe_half.comp: how does this device round in half precision? Conversion, sum, product, sum of both.

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Operands { vec4 operands[]; }; // w is no half
layout(std430, set = 0, binding = 1) writeonly buffer Results { float results[]; };
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint k = gl_GlobalInvocationID.x;
    if (k >= count)
        return;
    float16_t a = float16_t(operands[k].x), b = float16_t(operands[k].y), c = float16_t(operands[k].z);
    precise float16_t sum = a + b;
    precise float16_t product = a * b;
    precise float16_t product_sum = a * b + c; // must not become a fused operation
    uint at = 4 * k;
    results[at] = float(float16_t(operands[k].w));
    results[at + 1] = float(sum);
    results[at + 2] = float(product);
    results[at + 3] = float(product_sum);
}
