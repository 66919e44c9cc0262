/* hlsl.c: HLSL of Shader Model 5.0 (FXC) and 6 (DXC), and Slang, which takes nearly all of it. */
#include "language/c_like.h"

#include "language/type.h"

static const char *const types[][5] = {
    [HNBRDF_VOID] = {NULL, "void"},
    [HNBRDF_BOOL] = {NULL, "bool", "bool2", "bool3", "bool4"},
    [HNBRDF_INT] = {NULL, "int", "int2", "int3", "int4"},
    [HNBRDF_UINT] = {NULL, "uint", "uint2", "uint3", "uint4"},
    [HNBRDF_FLOAT] = {NULL, "float", "float2", "float3", "float4"},
    [HNBRDF_FLOAT16] = {NULL, "HNBRDF_HALF", "HNBRDF_HALF2", "HNBRDF_HALF3", "HNBRDF_HALF4"},
};

/* Words of HLSL that are names in GLSL. */
static const char *const reserved[] = {
    "abstract",     "auto",       "catch",     "cbuffer",     "char",          "class",
    "column_major", "compile",    "delete",    "double",      "dword",         "enum",
    "explicit",     "export",     "extern",    "friend",      "goto",          "half",
    "groupshared",  "interface",  "indices",   "line",        "lineadj",       "linear",
    "long",         "matrix",     "mutable",   "namespace",   "new",           "noperspective",
    "operator",     "packoffset", "pass",      "payload",     "pixelfragment", "point",
    "primitives",   "private",    "protected", "public",      "register",      "row_major",
    "sample",       "sampler",    "shared",    "short",       "signed",        "sizeof",
    "snorm",        "static",     "string",    "technique",   "template",      "texture",
    "this",         "throw",      "triangle",  "triangleadj", "try",           "typedef",
    "typename",     "union",      "unorm",     "unsigned",    "using",         "vector",
    "vertices",     "virtual",    NULL};

/* ---- Expressions ----------------------------------------------------------------------------- */

static const char *hlsl_builtin(const hnbrdf_builtin *builtin)
{
    return builtin->hlsl;
}

/* (float3)x of a single number; NAME_init(a, b) of a struct. */
static int write_construct(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *only = node->first;
    if (node->type.structure) {
        hnbrdf_write_type(p, node->type);
        hnbrdf_write(p, "_init(");
        hnbrdf_write_list(p, only);
        hnbrdf_write(p, ")");
        return 1;
    }
    if (only->next || only->type.width > 1 || node->type.width == 1)
        return 0;
    hnbrdf_write(p, "(");
    hnbrdf_write_type(p, node->type);
    hnbrdf_write(p, hnbrdf_is_single(only) ? ")" : ")(");
    hnbrdf_write_expression(p, only);
    hnbrdf_write(p, hnbrdf_is_single(only) ? "" : ")");
    return 1;
}

static int hlsl_expression(hnbrdf_print *p, const hnbrdf_node *node)
{
    return node->kind == HNBRDF_NODE_CONSTRUCT && write_construct(p, node);
}

static int hlsl_statement(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->kind == HNBRDF_NODE_FOR && (node->loop || node->unroll))
        hnbrdf_write(p, node->loop ? "[loop] " : "[unroll] ");
    return 0;
}

/* ---- Items ----------------------------------------------------------------------------------- */

static int hlsl_item(hnbrdf_print *p, const hnbrdf_node *node)
{
    return hnbrdf_c_item(p, node, "static const ");
}

/* Neither FXC nor DXC has constructors of structs. */
static void write_initialiser(hnbrdf_print *p, const hnbrdf_node *node)
{
    const char *before = "";
    hnbrdf_new_line(p, 1);
    hnbrdf_write_name(p, node->token.text);
    hnbrdf_write(p, " ");
    hnbrdf_write_name(p, node->token.text);
    hnbrdf_write(p, "_init(");
    for (const hnbrdf_node *list = node->first; list; list = list->next)
        for (const hnbrdf_node *member = list->first; member; member = member->next) {
            hnbrdf_write(p, before);
            hnbrdf_write_type(p, member->type);
            hnbrdf_write(p, " ");
            hnbrdf_write_name(p, member->token.text);
            before = ", ";
        }
    hnbrdf_write(p, ")");
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "{");
    p->indent++;
    hnbrdf_new_line(p, 0);
    hnbrdf_write_name(p, node->token.text);
    hnbrdf_write(p, " made;");
    for (const hnbrdf_node *list = node->first; list; list = list->next)
        for (const hnbrdf_node *member = list->first; member; member = member->next) {
            hnbrdf_new_line(p, 0);
            hnbrdf_write(p, "made.");
            hnbrdf_write_name(p, member->token.text);
            hnbrdf_write(p, " = ");
            hnbrdf_write_name(p, member->token.text);
            hnbrdf_write(p, ";");
        }
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "return made;");
    p->indent--;
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "}");
}

static void hlsl_structure(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_c_struct(p, node);
    write_initialiser(p, node);
}

static void hlsl_function(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_c_head(p, node, "out ", "inout ", " ");
    hnbrdf_write(p, ")");
    hnbrdf_c_body(p, node);
}

static void hlsl_block(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *array = node->last;
    hnbrdf_write(p, "#ifndef ");
    hnbrdf_write_setting(p, node->token.text, "_REGISTER");
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "#define ");
    hnbrdf_write_setting(p, node->token.text, "_REGISTER");
    hnbrdf_write(p, " b0");
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "#endif");
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "cbuffer ");
    hnbrdf_write_name(p, node->token.text);
    hnbrdf_write(p, " : register(");
    hnbrdf_write_setting(p, node->token.text, "_REGISTER");
    hnbrdf_write(p, ")");
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "{");
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "    ");
    hnbrdf_write_type(p, array->type);
    hnbrdf_write(p, " ");
    hnbrdf_write_name(p, array->token.text);
    hnbrdf_write(p, "[");
    hnbrdf_write_expression(p, array->type.length);
    hnbrdf_write(p, "];");
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "};");
}

static const char half[] =
    "// Half precision: float16_t where the compiler was told to have it (DXC: "
    "-enable-16bit-types), else min16float.\n"
    "#ifndef HNBRDF_HALF\n"
    "#if defined(__HLSL_ENABLE_16_BIT)\n"
    "#define HNBRDF_HALF float16_t\n"
    "#define HNBRDF_HALF2 float16_t2\n"
    "#define HNBRDF_HALF3 float16_t3\n"
    "#define HNBRDF_HALF4 float16_t4\n"
    "#else\n"
    "#define HNBRDF_HALF min16float\n"
    "#define HNBRDF_HALF2 min16float2\n"
    "#define HNBRDF_HALF3 min16float3\n"
    "#define HNBRDF_HALF4 min16float4\n"
    "#endif\n"
    "#endif\n";

/* Slang has half without ado. */
static const char *const slang_types[][5] = {
    [HNBRDF_VOID] = {NULL, "void"},
    [HNBRDF_BOOL] = {NULL, "bool", "bool2", "bool3", "bool4"},
    [HNBRDF_INT] = {NULL, "int", "int2", "int3", "int4"},
    [HNBRDF_UINT] = {NULL, "uint", "uint2", "uint3", "uint4"},
    [HNBRDF_FLOAT] = {NULL, "float", "float2", "float3", "float4"},
    [HNBRDF_FLOAT16] = {NULL, "half", "half2", "half3", "half4"},
};

const hnbrdf_dialect hnbrdf_hlsl = {.name = "hlsl",
                                    .capital = "HLSL",
                                    .types = types,
                                    .suffix = "f",
                                    .reserved = reserved,
                                    .preprocessor = 1,
                                    .loops_leak = 1,
                                    .precise = 1,
                                    .half = half,
                                    .item = hlsl_item,
                                    .statement = hlsl_statement,
                                    .expression = hlsl_expression,
                                    .function = hlsl_function,
                                    .structure = hlsl_structure,
                                    .block = hlsl_block,
                                    .builtin = hlsl_builtin};

/* It takes `precise`, but 2025.15 makes nothing of it. */
static const char slang_exact[] =
    "\n// Exact where operations are neither fused nor reordered: compile with -fp-mode precise.\n";

const hnbrdf_dialect hnbrdf_slang = {.name = "slang",
                                     .capital = "SLANG",
                                     .types = slang_types,
                                     .suffix = "f",
                                     .reserved = reserved,
                                     .preprocessor = 1,
                                     .exact = slang_exact,
                                     .item = hlsl_item,
                                     .statement = hlsl_statement,
                                     .expression = hlsl_expression,
                                     .function = hlsl_function,
                                     .structure = hlsl_structure,
                                     .block = hlsl_block,
                                     .builtin = hlsl_builtin};
