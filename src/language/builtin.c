/* builtin.c: the built-in functions of GLSL that our texts may use, and what others call them. */
#include "language/type.h"

static const hnbrdf_builtin builtins[] = {
    {"abs", HNBRDF_SHAPE_NUMBERS, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"sign", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"min", HNBRDF_SHAPE_NUMBERS, 2, NULL, NULL, NULL, HNBRDF_VOID},
    {"max", HNBRDF_SHAPE_NUMBERS, 2, NULL, NULL, NULL, HNBRDF_VOID},
    {"clamp", HNBRDF_SHAPE_NUMBERS, 3, NULL, NULL, NULL, HNBRDF_VOID},
    {"mix", HNBRDF_SHAPE_T, 3, "lerp", NULL, NULL, HNBRDF_VOID},
    {"step", HNBRDF_SHAPE_T, 2, NULL, NULL, NULL, HNBRDF_VOID},
    {"smoothstep", HNBRDF_SHAPE_T, 3, NULL, NULL, NULL, HNBRDF_VOID},
    {"floor", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"ceil", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"fract", HNBRDF_SHAPE_T, 1, "frac", NULL, NULL, HNBRDF_VOID},
    {"sqrt", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"inversesqrt", HNBRDF_SHAPE_T, 1, "rsqrt", "rsqrt", "inverseSqrt", HNBRDF_VOID},
    {"exp", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"exp2", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"log", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"log2", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"pow", HNBRDF_SHAPE_T, 2, NULL, NULL, NULL, HNBRDF_VOID},
    {"sin", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"cos", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"tan", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"acos", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"asin", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"atan", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"atan", HNBRDF_SHAPE_T, 2, "atan2", "atan2", "atan2", HNBRDF_VOID},
    {"normalize", HNBRDF_SHAPE_T, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"reflect", HNBRDF_SHAPE_T, 2, NULL, NULL, NULL, HNBRDF_VOID},
    {"cross", HNBRDF_SHAPE_T, 2, NULL, NULL, NULL, HNBRDF_VOID},
    {"dot", HNBRDF_SHAPE_SCALAR, 2, NULL, NULL, NULL, HNBRDF_VOID},
    {"length", HNBRDF_SHAPE_SCALAR, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"distance", HNBRDF_SHAPE_SCALAR, 2, NULL, NULL, NULL, HNBRDF_VOID},
    {"floatBitsToInt", HNBRDF_SHAPE_BITS, 1, "asint", "as_type", "bitcast", HNBRDF_INT},
    {"floatBitsToUint", HNBRDF_SHAPE_BITS, 1, "asuint", "as_type", "bitcast", HNBRDF_UINT},
    {"intBitsToFloat", HNBRDF_SHAPE_BITS, 1, "asfloat", "as_type", "bitcast", HNBRDF_FLOAT},
    {"uintBitsToFloat", HNBRDF_SHAPE_BITS, 1, "asfloat", "as_type", "bitcast", HNBRDF_FLOAT},
    {"lessThan", HNBRDF_SHAPE_RELATION, 2, "<", "<", "<", HNBRDF_VOID},
    {"lessThanEqual", HNBRDF_SHAPE_RELATION, 2, "<=", "<=", "<=", HNBRDF_VOID},
    {"greaterThan", HNBRDF_SHAPE_RELATION, 2, ">", ">", ">", HNBRDF_VOID},
    {"greaterThanEqual", HNBRDF_SHAPE_RELATION, 2, ">=", ">=", ">=", HNBRDF_VOID},
    {"equal", HNBRDF_SHAPE_RELATION, 2, "==", "==", "==", HNBRDF_VOID},
    {"notEqual", HNBRDF_SHAPE_RELATION, 2, "!=", "!=", "!=", HNBRDF_VOID},
    {"any", HNBRDF_SHAPE_ANY, 1, NULL, NULL, NULL, HNBRDF_VOID},
    {"all", HNBRDF_SHAPE_ANY, 1, NULL, NULL, NULL, HNBRDF_VOID},
};

const hnbrdf_builtin *hnbrdf_find_builtin(hnbrdf_span name, int arguments)
{
    for (size_t k = 0; k < sizeof builtins / sizeof builtins[0]; k++)
        if (hnbrdf_span_is(name, builtins[k].name) && builtins[k].arguments == arguments)
            return &builtins[k];
    return NULL;
}
