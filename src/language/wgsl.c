/* wgsl.c: WGSL. It has neither overloads nor out parameters nor ?:, and no preprocessor. */
#include "language/wgsl.h"

#include "language/type.h"

static const char *const types[][5] = {
    [HNBRDF_VOID] = {NULL, "void"},
    [HNBRDF_BOOL] = {NULL, "bool", "vec2<bool>", "vec3<bool>", "vec4<bool>"},
    [HNBRDF_INT] = {NULL, "i32", "vec2i", "vec3i", "vec4i"},
    [HNBRDF_UINT] = {NULL, "u32", "vec2u", "vec3u", "vec4u"},
    [HNBRDF_FLOAT] = {NULL, "f32", "vec2f", "vec3f", "vec4f"},
    [HNBRDF_FLOAT16] = {NULL, "f16", "vec2h", "vec3h", "vec4h"},
};

/* Keywords, reserved words, and functions of WGSL alone, that are names in GLSL. */
static const char *const reserved[] = {
    "abstract", "active",    "alias",    "as",        "asm",        "async",      "auto",
    "await",    "become",    "bitcast",  "cast",      "catch",      "class",      "common",
    "compile",  "concept",   "crate",    "debugger",  "delete",     "diagnostic", "enable",
    "enum",     "explicit",  "export",   "extends",   "extern",     "external",   "fallthrough",
    "filter",   "final",     "finally",  "fn",        "friend",     "from",       "get",
    "goto",     "impl",      "import",   "inline",    "instanceof", "interface",  "let",
    "line",     "loop",      "macro",    "match",     "meta",       "mod",        "module",
    "move",     "mut",       "mutable",  "namespace", "new",        "nil",        "null",
    "of",       "operator",  "override", "package",   "pass",       "patch",      "priv",
    "private",  "protected", "pub",      "public",    "ref",        "regardless", "register",
    "require",  "requires",  "resource", "select",    "self",       "set",        "shared",
    "sizeof",   "smooth",    "static",   "std",       "super",      "target",     "template",
    "this",     "throw",     "trait",    "try",       "type",       "typedef",    "typename",
    "union",    "unless",    "unsafe",   "use",       "using",      "var",        "virtual",
    "wgsl",     "where",     "with",     "yield",     NULL};

static const char *wgsl_builtin(const hnbrdf_builtin *builtin)
{
    return builtin->wgsl;
}

static void write_constant(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (!node->first)
        return; /* nobody can ask for it */
    hnbrdf_new_line(p, node->after_blank);
    hnbrdf_write(p, "const ");
    hnbrdf_write_name(p, node->token.text);
    hnbrdf_write(p, ": ");
    hnbrdf_write_type(p, node->type);
    hnbrdf_write(p, " = ");
    hnbrdf_write_expression(p, node->first);
    hnbrdf_write(p, ";");
}

static void write_globals(hnbrdf_print *p, const hnbrdf_node *node)
{
    for (const hnbrdf_node *variable = node->first; variable; variable = variable->next) {
        hnbrdf_new_line(p, variable == node->first && node->after_blank);
        hnbrdf_write(p, "const ");
        hnbrdf_write_variable(p, variable);
        hnbrdf_write(p, ": ");
        hnbrdf_wgsl_type(p, variable->type);
        hnbrdf_write(p, " = ");
        if (variable->first)
            hnbrdf_write_expression(p, variable->first);
        else
            hnbrdf_refuse(p->t, &variable->token, "a constant without a value");
        hnbrdf_write(p, ";");
    }
}

static int wgsl_item(hnbrdf_print *p, const hnbrdf_node *node)
{
    if (node->kind == HNBRDF_NODE_CONSTANT)
        write_constant(p, node);
    else if (node->kind == HNBRDF_NODE_DECLARATION)
        write_globals(p, node);
    else
        return 0;
    return 1;
}

static void write_member(hnbrdf_print *p, const hnbrdf_node *declaration)
{
    hnbrdf_new_line(p, declaration->after_blank);
    for (const hnbrdf_node *member = declaration->first; member; member = member->next) {
        hnbrdf_write(p, member == declaration->first ? "" : " ");
        hnbrdf_write_name(p, member->token.text);
        hnbrdf_write(p, ": ");
        hnbrdf_wgsl_type(p, member->type);
        hnbrdf_write(p, ",");
    }
}

static void wgsl_structure(hnbrdf_print *p, const hnbrdf_node *node)
{
    hnbrdf_write(p, "struct ");
    hnbrdf_write_name(p, node->token.text);
    hnbrdf_write(p, " {");
    p->indent++;
    hnbrdf_write_members(p, node, write_member);
    p->indent--;
    hnbrdf_new_line(p, 0);
    hnbrdf_write(p, "}");
}

/* Parameters do not change: what a function changes is a copy. */
static void write_copies(hnbrdf_print *p, const hnbrdf_node *function)
{
    p->indent++;
    for (const hnbrdf_node *q = function->first; q->kind == HNBRDF_NODE_VARIABLE; q = q->next)
        if (q->assigned && !q->output) {
            hnbrdf_new_line(p, 0);
            hnbrdf_write(p, "var ");
            hnbrdf_write_variable(p, q);
            hnbrdf_write(p, " = ");
            hnbrdf_write_variable(p, q);
            hnbrdf_write(p, "_in;");
        }
    p->indent--;
}

static void wgsl_function(hnbrdf_print *p, const hnbrdf_node *node)
{
    const hnbrdf_node *parameter = node->first;
    hnbrdf_write(p, "fn ");
    hnbrdf_wgsl_function_name(p, node);
    hnbrdf_write(p, "(");
    for (; parameter->kind == HNBRDF_NODE_VARIABLE; parameter = parameter->next) {
        if (parameter != node->first)
            hnbrdf_write(p, parameter->own_line ? "," : ", ");
        hnbrdf_write_break(p, parameter->own_line, "");
        hnbrdf_write_variable(p, parameter);
        hnbrdf_write(p, parameter->assigned && !parameter->output ? "_in: " : ": ");
        hnbrdf_write(p, parameter->output ? "ptr<function, " : "");
        hnbrdf_wgsl_type(p, parameter->type);
        hnbrdf_write(p, parameter->output ? ">" : "");
    }
    hnbrdf_write(p, ")");
    if (node->type.scalar != HNBRDF_VOID) {
        hnbrdf_write(p, " -> ");
        hnbrdf_write_type(p, node->type);
    }
    hnbrdf_write(p, " {");
    write_copies(p, node);
    hnbrdf_write_body(p, node->last);
}

/* const HNBRDF_WEIGHTS_BINDING: i32 = 0; on a line of its own, for whoever needs another one. */
static void write_place(hnbrdf_print *p, const hnbrdf_node *block, const char *glsl,
                        const char *ending)
{
    const hnbrdf_node *place = block->first;
    while (place && (place->kind != HNBRDF_NODE_INDEX || !hnbrdf_span_is(place->token.text, glsl)))
        place = place->next;
    hnbrdf_write(p, "const ");
    hnbrdf_write_setting(p, block->token.text, ending);
    hnbrdf_write(p, ": i32 = ");
    if (place)
        hnbrdf_write_expression(p, place->first);
    else
        hnbrdf_write(p, "0");
    hnbrdf_write(p, ";");
    hnbrdf_new_line(p, 0);
}

static void wgsl_block(hnbrdf_print *p, const hnbrdf_node *node)
{
    write_place(p, node, "set", "_SET");
    write_place(p, node, "binding", "_BINDING");
    hnbrdf_write(p, "@group(");
    hnbrdf_write_setting(p, node->token.text, "_SET");
    hnbrdf_write(p, ") @binding(");
    hnbrdf_write_setting(p, node->token.text, "_BINDING");
    hnbrdf_write(p, ") var<uniform> ");
    hnbrdf_write_name(p, node->last->token.text);
    hnbrdf_write(p, ": ");
    hnbrdf_wgsl_type(p, node->last->type);
    hnbrdf_write(p, ";");
}

static const char half[] = "// The module must begin with `enable f16;`.\n";

const hnbrdf_dialect hnbrdf_wgsl = {.name = "wgsl",
                                    .capital = "WGSL",
                                    .types = types,
                                    .suffix = "",
                                    .reserved = reserved,
                                    .half = half,
                                    .half_begin = "enable f16;\n\n",
                                    .item = wgsl_item,
                                    .statement = hnbrdf_wgsl_statement,
                                    .expression = hnbrdf_wgsl_expression,
                                    .function = wgsl_function,
                                    .structure = wgsl_structure,
                                    .block = wgsl_block,
                                    .builtin = wgsl_builtin};
