/* msl.c: the Metal Shading Language, which is C++14. There are no global uniforms: functions that
 * reach the block of weights get a pointer to it. */
#include "language/c_like.h"

#include "language/type.h"

static const char *const types[][5] = {
    [HNBRDF_VOID] = {NULL, "void"},
    [HNBRDF_BOOL] = {NULL, "bool", "bool2", "bool3", "bool4"},
    [HNBRDF_INT] = {NULL, "int", "int2", "int3", "int4"},
    [HNBRDF_UINT] = {NULL, "uint", "uint2", "uint3", "uint4"},
    [HNBRDF_FLOAT] = {NULL, "float", "float2", "float3", "float4"},
    [HNBRDF_FLOAT16] = {NULL, "half", "half2", "half3", "half4"},
};

/* Words of C++ and of Metal that are names in GLSL. */
static const char *const reserved[] = {
    "access",    "alignas",      "alignof",     "and",         "array",    "as_type",   "asm",
    "atomic",    "auto",         "bitand",      "bitor",       "catch",    "char",      "class",
    "compl",     "constant",     "constexpr",   "decltype",    "delete",   "depth2d",   "device",
    "double",    "enum",         "explicit",    "export",      "extern",   "fragment",  "friend",
    "goto",      "half",         "inline",      "kernel",      "long",     "mutable",   "namespace",
    "new",       "noexcept",     "not",         "nullptr",     "operator", "or",        "private",
    "protected", "ptrdiff_t",    "public",      "register",    "sampler",  "short",     "signed",
    "size_t",    "sizeof",       "static",      "static_cast", "template", "texture2d", "this",
    "thread",    "thread_local", "threadgroup", "throw",       "try",      "typedef",   "typename",
    "union",     "unsigned",     "using",       "vec",         "vertex",   "virtual",   "visible",
    "volatile",  "wchar_t",      "xor",         NULL};

static const char *msl_builtin(const hnbrdf_builtin *builtin)
{
    return builtin->msl;
}

/* ---- Expressions ----------------------------------------------------------------------------- */

/* hnbrdf_lobes{a, b, c} */
static int write_structure(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (!node->type.structure)
        return 0;
    hnbrdf_write_type(p, node->type);
    hnbrdf_write(p, "{");
    hnbrdf_write_list(p, node->first);
    hnbrdf_write(p, "}");
    return 1;
}

/* as_type<float>(x) */
static int write_bits(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->builtin->shape != HNBRDF_SHAPE_BITS)
        return 0;
    hnbrdf_write(p, "as_type<");
    hnbrdf_write_type(p, node->type);
    hnbrdf_write(p, ">(");
    hnbrdf_write_list(p, node->first);
    hnbrdf_write(p, ")");
    return 1;
}

/* The pointer goes on to those that need it. */
static int write_call(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *block = node->symbol->block;
    if (!block)
        return 0;
    hnbrdf_write_name(p, node->token.text);
    hnbrdf_write(p, "(");
    hnbrdf_write_list(p, node->first);
    hnbrdf_write(p, node->first ? ", " : "");
    hnbrdf_write_name(p, block->last->token.text);
    hnbrdf_write(p, ")");
    return 1;
}

static int msl_expression(hnbrdf_print *p, const hnbrdf_node *node)
{
    switch (node->kind) {
    case HNBRDF_NODE_CONSTRUCT:
        return write_structure(p, node);
    case HNBRDF_NODE_BUILTIN:
        return write_bits(p, node);
    case HNBRDF_NODE_CALL:
        return write_call(p, node);
    default:
        return 0;
    }
}

static int msl_statement(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->kind == HNBRDF_NODE_FOR && (node->loop || node->unroll)) {
        hnbrdf_write(p, node->loop ? "#pragma clang loop unroll(disable)"
                                   : "#pragma clang loop unroll(full)");
        hnbrdf_new_line(p, 0);
    }
    return 0;
}

/* ---- Items ----------------------------------------------------------------------------------- */

static int msl_item(hnbrdf_print *p, const hnbrdf_node *node)
{
    return hnbrdf_c_item(p, node, "constant ");
}

/* inline: a text may be included in several files of a library. */
static void msl_function(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_write(p, "inline ");
    hnbrdf_c_head(p, node, "thread ", "thread ", " &");
    if (node->block) {
        hnbrdf_write(p, node->first->kind == HNBRDF_NODE_VARIABLE ? ", " : "");
        hnbrdf_write(p, "constant float4 *");
        hnbrdf_write_name(p, node->block->last->token.text);
    }
    hnbrdf_write(p, ")");
    hnbrdf_c_body(p, node);
}

/* A parameter, which its functions say; here its size. */
static void msl_block(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *array = node->last;
    hnbrdf_write(p, "// ");
    hnbrdf_write_span(p, array->token.text);
    hnbrdf_write(p, ": a buffer of ");
    hnbrdf_write_expression(p, array->type.length);
    hnbrdf_write(p, " float4, the last parameter of each function that reads it.");
}

static const char prelude[] = "\n#include <metal_stdlib>\nusing namespace metal;\n";

static const char exact[] =
    "\n// Exact where operations are neither fused nor reordered: compile with -fno-fast-math, or "
    "mathMode .safe.\n"
    "#pragma METAL fp contract(off)\n";

const hnbrdf_dialect hnbrdf_msl = {.name = "msl",
                                   .capital = "MSL",
                                   .types = types,
                                   .suffix = "f",
                                   .reserved = reserved,
                                   .preprocessor = 1,
                                   .prelude = prelude,
                                   .exact = exact,
                                   .item = msl_item,
                                   .statement = msl_statement,
                                   .expression = msl_expression,
                                   .function = msl_function,
                                   .structure = hnbrdf_c_struct,
                                   .block = msl_block,
                                   .builtin = msl_builtin};
