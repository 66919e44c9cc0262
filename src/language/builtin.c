/* builtin.c: the built-in functions of GLSL that our texts may use, and what others call them. */
#include "language/type.h"

static const hnbrdf_builtin builtins[] = {
    {"abs", HNBRDF_SHAPE_NUMBERS, 1, NULL, NULL, NULL, 0},
    {"sign", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"min", HNBRDF_SHAPE_NUMBERS, 2, NULL, NULL, NULL, 0},
    {"max", HNBRDF_SHAPE_NUMBERS, 2, NULL, NULL, NULL, 0},
    {"clamp", HNBRDF_SHAPE_NUMBERS, 3, NULL, NULL, NULL, 0},
    {"mix", HNBRDF_SHAPE_T, 3, "lerp", NULL, NULL, 0},
    {"step", HNBRDF_SHAPE_T, 2, NULL, NULL, NULL, 0},
    {"smoothstep", HNBRDF_SHAPE_T, 3, NULL, NULL, NULL, 0},
    {"floor", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"ceil", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"fract", HNBRDF_SHAPE_T, 1, "frac", NULL, NULL, 0},
    {"sqrt", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"inversesqrt", HNBRDF_SHAPE_T, 1, "rsqrt", "rsqrt", "inverseSqrt", 0},
    {"exp", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"exp2", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"log", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"log2", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"pow", HNBRDF_SHAPE_T, 2, NULL, NULL, NULL, 0},
    {"sin", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"cos", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"tan", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"acos", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"asin", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"atan", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"atan", HNBRDF_SHAPE_T, 2, "atan2", "atan2", "atan2", 0},
    {"normalize", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, 0},
    {"reflect", HNBRDF_SHAPE_T, 2, NULL, NULL, NULL, 0},
    {"cross", HNBRDF_SHAPE_T, 2, NULL, NULL, NULL, 0},
    {"dot", HNBRDF_SHAPE_SCALAR, 2, NULL, NULL, NULL, 0},
    {"length", HNBRDF_SHAPE_SCALAR, 1, NULL, NULL, NULL, 0},
    {"distance", HNBRDF_SHAPE_SCALAR, 2, NULL, NULL, NULL, 0},
    {"floatBitsToInt", HNBRDF_SHAPE_BITS, 1, "asint", "as_type", "bitcast", HNBRDF_INT},
    {"floatBitsToUint", HNBRDF_SHAPE_BITS, 1, "asuint", "as_type", "bitcast", HNBRDF_UINT},
    {"intBitsToFloat", HNBRDF_SHAPE_BITS, 1, "asfloat", "as_type", "bitcast", HNBRDF_FLOAT},
    {"uintBitsToFloat", HNBRDF_SHAPE_BITS, 1, "asfloat", "as_type", "bitcast", HNBRDF_FLOAT},
    {"lessThan", HNBRDF_SHAPE_RELATION, 2, "<", "<", "<", 0},
    {"lessThanEqual", HNBRDF_SHAPE_RELATION, 2, "<=", "<=", "<=", 0},
    {"greaterThan", HNBRDF_SHAPE_RELATION, 2, ">", ">", ">", 0},
    {"greaterThanEqual", HNBRDF_SHAPE_RELATION, 2, ">=", ">=", ">=", 0},
    {"equal", HNBRDF_SHAPE_RELATION, 2, "==", "==", "==", 0},
    {"notEqual", HNBRDF_SHAPE_RELATION, 2, "!=", "!=", "!=", 0},
    {"any", HNBRDF_SHAPE_ANY, 1, NULL, NULL, NULL, 0},
    {"all", HNBRDF_SHAPE_ANY, 1, NULL, NULL, NULL, 0},
};

const hnbrdf_builtin *hnbrdf_find_builtin(hnbrdf_span name, int arguments)
{
    for (size_t k = 0; k < sizeof builtins / sizeof builtins[0]; k++)
        if (hnbrdf_span_is(name, builtins[k].name) && builtins[k].arguments == arguments)
            return &builtins[k];
    return NULL;
}
