/* generate_scene.c: scenes as text: every statement, its options in any order. */
#include "generate.h"

#include <string.h>

static void put_word(fuzz_choices *c, fuzz_bytes *out, const char *usual)
{
    const char *word = fuzz_word(c, usual);
    fuzz_printf(out, strchr(word, ' ') || fuzz_below(c, 16) == 0 ? " \"%s\"" : " %s", word);
}

static void put_numbers(fuzz_choices *c, fuzz_bytes *out, int count, double low, double high)
{
    for (int k = 0; k < count; k++) {
        fuzz_put_text(out, fuzz_below(c, 16) ? " " : "\t ");
        fuzz_put_number(out, c, fuzz_real_between(c, low, high));
    }
}

static void put_whole(fuzz_choices *c, fuzz_bytes *out, int low, int high)
{
    fuzz_printf(out, " %lld", (long long)fuzz_whole(c, (uint64_t)fuzz_between(c, low, high)));
    if (fuzz_odd(c))
        fuzz_put_text(out, ".5");
}

static void end_line(fuzz_choices *c, fuzz_bytes *out)
{
    if (fuzz_odd(c)) {
        const int length = FUZZ_PICK(c, int, 1, 254, 257, 4000, 8200);
        for (int k = 0; k < length; k++)
            fuzz_put_text(out, " x");
    }
    if (fuzz_odd(c))
        fuzz_put(out, "", 1);
    if (fuzz_odd(c))
        fuzz_put_text(out, FUZZ_PICK(c, char *, " \"open", " \"\"", " lens", " move", " 1"));
    if (fuzz_below(c, 16) == 0)
        fuzz_put_text(out, FUZZ_PICK(c, char *, " # a comment", " ", "\t", "\r"));
    fuzz_put_text(out, "\n");
}

static void put_camera(fuzz_choices *c, fuzz_bytes *out)
{
    fuzz_put_text(out, "camera");
    if (!fuzz_odd(c)) {
        fuzz_put_text(out, " from");
        put_numbers(c, out, 3, -10.0, 10.0);
    }
    fuzz_put_text(out, " to");
    put_numbers(c, out, 3, -1.0, 1.0);
    fuzz_put_text(out, " fov");
    put_numbers(c, out, 1, 10.0, 90.0);
    if (fuzz_below(c, 3) == 0) {
        fuzz_put_text(out, " up");
        put_numbers(c, out, 3, -1.0, 1.0);
    }
    if (fuzz_below(c, 3) == 0) {
        fuzz_put_text(out, " lens");
        put_numbers(c, out, 1, 0.0, 0.5);
        fuzz_put_text(out, " focus");
        put_numbers(c, out, 1, 1.0, 9.0);
    }
    end_line(c, out);
}

static void put_environment(fuzz_choices *c, fuzz_bytes *out)
{
    fuzz_put_text(out, "environment");
    put_word(c, out, FUZZ_PICK(c, char *, "sky", "furnace", "a map.exr"));
    if (fuzz_below(c, 2)) {
        fuzz_put_text(out, " rotate");
        put_numbers(c, out, 1, -180.0, 180.0);
    }
    if (fuzz_below(c, 2)) {
        fuzz_put_text(out, " gain");
        put_numbers(c, out, 1, 0.1, 4.0);
    }
    if (fuzz_below(c, 4) == 0) {
        fuzz_put_text(out, " hidden repair layer");
        put_word(c, out, "sun");
    }
    end_line(c, out);
}

static void put_portal(fuzz_choices *c, fuzz_bytes *out)
{
    fuzz_put_text(out, fuzz_odd(c) ? "portal" : "portal corner");
    put_numbers(c, out, 3, -2.0, 2.0);
    for (int k = 0; k < 2; k++) {
        fuzz_put_text(out, fuzz_odd(c) ? "" : " edge");
        put_numbers(c, out, 3, -2.0, 2.0);
    }
    end_line(c, out);
}

/* How many there are; their names are m0, m1, ... */
static int put_materials(fuzz_choices *c, fuzz_bytes *out)
{
    const int count = fuzz_between(c, 0, 6);
    for (int i = 0; i < count; i++) {
        fuzz_printf(out, "material m%d", fuzz_odd(c) ? 0 : i);
        switch (fuzz_below(c, 5)) {
        case 0:
            fuzz_put_text(out, " model");
            put_word(c, out, "a.safetensors");
            if (fuzz_below(c, 2))
                put_word(c, out, "red wax");
            break;
        case 1:
            fuzz_put_text(out, " measured");
            put_word(c, out, "b.bsdf");
            break;
        case 2:
            fuzz_put_text(out, " builtin");
            put_word(c, out, "rough-clay");
            break;
        case 3:
            fuzz_put_text(out, " diffuse");
            put_numbers(c, out, 3, 0.0, 1.0);
            break;
        default:
            fuzz_put_text(out, " ggx kd");
            put_numbers(c, out, 3, 0.0, 1.0);
            fuzz_put_text(out, " eta");
            put_numbers(c, out, 3, 1.1, 2.5);
            fuzz_put_text(out, " alpha");
            put_numbers(c, out, (int)fuzz_below(c, 2) + 1, 0.01, 1.0);
        }
        end_line(c, out);
    }
    return count;
}

static void put_placing(fuzz_choices *c, fuzz_bytes *out)
{
    static const struct {
        const char *word;
        int count;
        double low, high;
    } ways[] = {{" scale", 1, 0.1, 3.0},
                {" stretch", 3, -2.0, 2.0},
                {" turn", 1, -180.0, 180.0},
                {" rotate", 4, -90.0, 90.0},
                {" move", 3, -5.0, 5.0}};
    const unsigned way = fuzz_below(c, sizeof ways / sizeof *ways);
    fuzz_put_text(out, ways[way].word);
    if (fuzz_odd(c))
        fuzz_put_text(out, " 0 0 0 0");
    put_numbers(c, out, ways[way].count, ways[way].low, ways[way].high);
}

static void put_material_of(fuzz_choices *c, fuzz_bytes *out, const char *word, int materials)
{
    fuzz_printf(out, " %s m%d", word,
                fuzz_odd(c) ? materials : (int)fuzz_below(c, (unsigned)materials));
}

/* What only one kind of shape has; in the odd place what another has. */
static void put_parameters(fuzz_choices *c, fuzz_bytes *out, unsigned kind, int materials)
{
    switch (fuzz_odd(c) ? fuzz_below(c, 9) : kind) {
    case 3:
        fuzz_put_text(out, " tube");
        put_numbers(c, out, 1, 0.1, 0.9);
        break;
    case 4:
        fuzz_put_text(out, " turns");
        put_whole(c, out, 1, 5);
        put_whole(c, out, 1, 5);
        break;
    case 5:
        fuzz_put_text(out, " powers");
        put_numbers(c, out, 2, 0.2, 1.8);
        break;
    case 7:
        fuzz_put_text(out, " profile");
        for (int k = fuzz_odd(c) ? FUZZ_PICK(c, int, 1, 64, 65) : fuzz_between(c, 2, 6); k > 0; k--)
            put_numbers(c, out, 2, 0.0, 2.0);
        break;
    case 8:
        for (int k = fuzz_odd(c) ? 33 : fuzz_between(c, 0, 3); k > 0 && materials > 0; k--)
            put_material_of(c, out, "use part", materials);
        if (fuzz_below(c, 2))
            fuzz_put_text(out, " smooth");
        break;
    default:
        break;
    }
}

static void put_shape(fuzz_choices *c, fuzz_bytes *out, int materials)
{
    static const char *const kinds[] = {"sphere",         "quad",   "box",   "torus", "knot",
                                        "superellipsoid", "teapot", "lathe", "obj"};
    const unsigned kind = fuzz_below(c, sizeof kinds / sizeof *kinds);
    fuzz_put_text(out, "shape");
    put_word(c, out, kinds[kind]);
    if (kind == 8)
        put_word(c, out, "a.obj");
    put_parameters(c, out, kind, materials);
    if (materials > 0 && fuzz_below(c, 4))
        put_material_of(c, out, "material", materials);
    if (fuzz_below(c, 4) == 0) {
        fuzz_put_text(out, " emit");
        put_numbers(c, out, 3, 0.0, 10.0);
    }
    if (fuzz_below(c, 4) == 0) {
        fuzz_put_text(out, " detail");
        put_whole(c, out, 3, 64);
    }
    for (int k = fuzz_between(c, 0, 3); k > 0; k--)
        put_placing(c, out);
    end_line(c, out);
}

static void put_frame(fuzz_choices *c, fuzz_bytes *out)
{
    fuzz_put_text(out, "size");
    put_whole(c, out, 8, 640);
    put_whole(c, out, 8, 480);
    end_line(c, out);
    fuzz_put_text(out, "exposure");
    put_numbers(c, out, 1, -4.0, 4.0);
    end_line(c, out);
    fuzz_put_text(out, "bounces");
    put_whole(c, out, 1, 16);
    end_line(c, out);
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    if (fuzz_below(c, 8) == 0)
        fuzz_put_text(out, FUZZ_PICK(c, char *, "\xef\xbb\xbf", "\n", "# a scene\n", "\xff\xfe"));
    if (!fuzz_odd(c))
        put_camera(c, out);
    if (fuzz_odd(c))
        put_camera(c, out);
    if (fuzz_below(c, 2))
        put_frame(c, out);
    for (int k = fuzz_odd(c) ? 2 : fuzz_between(c, 0, 1); k > 0; k--)
        put_environment(c, out);
    for (int k = fuzz_odd(c) ? 65 : fuzz_between(c, 0, 2); k > 0; k--)
        put_portal(c, out);
    const int materials = put_materials(c, out);
    for (int k = fuzz_odd(c) ? 0 : fuzz_between(c, 1, 6); k > 0; k--)
        put_shape(c, out, materials);
    if (fuzz_odd(c))
        for (int k = FUZZ_PICK(c, int, 1, 1025, 4097); k > 0; k--)
            fuzz_printf(out, fuzz_below(c, 2) ? "shape box\n" : "material n%d diffuse 0 0 0\n", k);
    if (fuzz_odd(c)) {
        fuzz_put_text(out, fuzz_word(c, "lamp"));
        end_line(c, out);
    }
}

FUZZ_GENERATOR(generate)
