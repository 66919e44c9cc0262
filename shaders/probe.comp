#version 450
// probe.comp: every operation that the BRDF is made of, on its own: how does this device round?

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Operands { vec4 operands[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Results { float results[]; };
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint k = gl_GlobalInvocationID.x;
    if (k >= count)
        return;
    float a = operands[k].x, b = operands[k].y; // exp is taken of z, log of w
    precise float sum = a + b;
    precise float difference = a - b;
    precise float product = a * b;
    precise float quotient = a / b;
    precise float root = sqrt(abs(a));
    precise float product_sum = a * b + operands[k].z; // must not become a fused operation
    uint at = 8 * k;
    results[at] = sum;
    results[at + 1] = difference;
    results[at + 2] = product;
    results[at + 3] = product_sum;
    results[at + 4] = quotient;
    results[at + 5] = root;
    results[at + 6] = exp(operands[k].z);
    results[at + 7] = log(operands[k].w);
}
