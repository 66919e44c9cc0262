// probe.glsl: every operation that the BRDF is made of, on its own: how does this device round? Included after
// hybrid_brdf.glsl in the exact build.

// Of operands a, b, c, d, slot 0: a + b, a - b, a * b, a * b + c, which must not become one operation;
// slot 1: a / b, sqrt |a|, exp c, log d, the last two built in.
vec4 hnbrdf_probe(vec4 operands, int slot)
{
    float a = operands.x;
    float b = operands.y;
    HNBRDF_PRECISE float sum = a + b;
    HNBRDF_PRECISE float difference = a - b;
    HNBRDF_PRECISE float product = a * b;
    HNBRDF_PRECISE float product_sum = a * b + operands.z;
    HNBRDF_PRECISE float quotient = a / b;
    HNBRDF_PRECISE float root = sqrt(abs(a));
    return slot == 0 ? vec4(sum, difference, product, product_sum)
                     : vec4(quotient, root, exp(operands.z), log(operands.w));
}
