/* describe_shape.c: shapes of a scene as text. */
#include "scene/words.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const kinds[RENDER_SHAPE_KINDS] = {
    "sphere", "quad", "box", "torus", "knot", "superellipsoid", "teapot", "lathe", "obj"};

static void place(render_text_shape *shape, const render_transform *next)
{
    shape->place = render_transform_then(&shape->place, next);
}

/* About an axis of length 1 (Rodrigues). */
static render_transform rotation(const double a[3], double degrees)
{
    double c = cos(degrees * 3.14159265358979323846 / 180.0),
           s = sin(degrees * 3.14159265358979323846 / 180.0);
    render_transform r = {{{0.0}}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.m[i][j] = (1.0 - c) * a[i] * a[j] + (i == j ? c : 0.0);
    for (int i = 0; i < 3; i++) {
        r.m[(i + 2) % 3][(i + 1) % 3] += s * a[i];
        r.m[(i + 1) % 3][(i + 2) % 3] -= s * a[i];
    }
    return r;
}

/* Returns 1 and sets *result if the next word places the shape. */
static int read_placing(words *in, render_text_shape *shape, hnbrdf_result *result)
{
    render_transform next = render_identity;
    double v[4] = {0.0, 0.0, 0.0, 0.0}, up[3] = {0.0, 1.0, 0.0};
    if (words_take(in, "scale")) {
        *result = words_number(in, "scale", 1e-6, WORDS_FAR, &v[0]);
        for (int k = 0; k < 3; k++)
            next.m[k][k] = v[0];
    } else if (words_take(in, "stretch")) {
        *result = words_numbers(in, "stretch", -WORDS_FAR, WORDS_FAR, 3, v);
        for (int k = 0; k < 3; k++)
            next.m[k][k] = v[k];
        if (*result == HNBRDF_OK && (v[0] == 0.0 || v[1] == 0.0 || v[2] == 0.0))
            *result = BAD(in, "%s:%ld: stretch by 0 leaves nothing", in->name, in->line);
    } else if (words_take(in, "turn")) {
        *result = words_number(in, "turn", -3600.0, 3600.0, &v[0]);
        next = rotation(up, v[0]);
    } else if (words_take(in, "rotate")) {
        *result = words_numbers(in, "rotate", -3600.0, 3600.0, 4, v);
        double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        if (*result == HNBRDF_OK && length == 0.0)
            *result = BAD(in, "%s:%ld: rotate: an axis of length 0", in->name, in->line);
        for (int k = 0; k < 3 && length > 0.0; k++)
            up[k] = v[k] / length;
        next = rotation(up, v[3]);
    } else if (words_take(in, "move")) {
        *result = words_numbers(in, "move", -WORDS_FAR, WORDS_FAR, 3, v);
        for (int k = 0; k < 3; k++)
            next.m[k][3] = v[k];
    } else {
        return 0;
    }
    place(shape, &next);
    return 1;
}

static hnbrdf_result read_profile(words *in, render_text_shape *shape)
{
    render_shape_options *options = &shape->options;
    hnbrdf_result result = HNBRDF_OK;
    while (result == HNBRDF_OK && in->at < in->count && in->words[in->at][0] &&
           strchr("0123456789.-+", in->words[in->at][0])) {
        if (options->profile_count == RENDER_MAX_PROFILE)
            return BAD(in, "%s:%ld: a profile of more than %d points", in->name, in->line,
                       RENDER_MAX_PROFILE);
        double *point = options->profile[options->profile_count++];
        result = words_number(in, "radius of a profile", 0.0, WORDS_FAR, &point[0]);
        if (result == HNBRDF_OK)
            result = words_number(in, "height of a profile", -WORDS_FAR, WORDS_FAR, &point[1]);
    }
    return result;
}

static hnbrdf_result read_use(words *in, render_text_shape *shape)
{
    char material[HNBRDF_MAX_NAME + 1];
    if (shape->use_count == RENDER_MAX_USES)
        return BAD(in, "%s:%ld: more than %d parts", in->name, in->line, RENDER_MAX_USES);
    hnbrdf_result result =
        words_text(in, "use PART", sizeof shape->uses[0].part, shape->uses[shape->use_count].part);
    if (result == HNBRDF_OK)
        result = words_text(in, "use PART MATERIAL", sizeof material, material);
    if (result != HNBRDF_OK)
        return result;
    int found = describe_find_material(in->out, material);
    if (found < 0)
        return BAD(in, "%s:%ld: no material '%s' above", in->name, in->line, material);
    shape->uses[shape->use_count++].material = found;
    return HNBRDF_OK;
}

static hnbrdf_result read_shape_material(words *in, render_text_shape *shape)
{
    char material[HNBRDF_MAX_NAME + 1];
    hnbrdf_result result = words_text(in, "material", sizeof material, material);
    if (result == HNBRDF_OK && (shape->material = describe_find_material(in->out, material)) < 0)
        return BAD(in, "%s:%ld: no material '%s' above", in->name, in->line, material);
    return result;
}

/* A parameter that belongs to the kind, or one that all have. */
static hnbrdf_result read_parameter(words *in, render_text_shape *shape)
{
    render_shape_options *options = &shape->options;
    hnbrdf_result result = HNBRDF_OK;
    render_shape_kind kind = shape->kind;
    if (read_placing(in, shape, &result))
        return result;
    if (words_take(in, "material"))
        return read_shape_material(in, shape);
    if (words_take(in, "emit"))
        return words_vector(in, "emit", 0.0, 1e6, shape->emission);
    if (words_take(in, "detail"))
        return words_whole(in, "detail", 3, 1024, &options->detail);
    if ((kind == RENDER_TORUS || kind == RENDER_KNOT) && words_take(in, "tube"))
        return words_number(in, "tube", 1e-3, 10.0, &options->tube);
    if (kind == RENDER_KNOT && words_take(in, "turns")) {
        int turns[2] = {2, 3};
        for (int k = 0; k < 2 && result == HNBRDF_OK; k++)
            result = words_whole(in, "turns", 1, 64, &turns[k]);
        options->turns[0] = turns[0];
        options->turns[1] = turns[1];
        return result;
    }
    if (kind == RENDER_SUPERELLIPSOID && words_take(in, "powers"))
        return words_numbers(in, "powers", 0.1, 1.9, 2, options->powers);
    if (kind == RENDER_LATHE && words_take(in, "profile"))
        return read_profile(in, shape);
    if (kind == RENDER_OBJ && words_take(in, "use"))
        return read_use(in, shape);
    if (kind == RENDER_OBJ && words_take(in, "smooth")) {
        shape->smooth = 1;
        return HNBRDF_OK;
    }
    return words_unknown(
        in, "a parameter of this kind of shape, material, emit, detail, scale, stretch, turn, "
            "rotate or move");
}

hnbrdf_result describe_shape(words *in)
{
    render_description *out = in->out;
    if (out->shape_count == RENDER_MAX_SHAPES)
        return BAD(in, "%s:%ld: more than %d shapes", in->name, in->line, RENDER_MAX_SHAPES);
    void *all = describe_grown(out->shapes, out->shape_count, sizeof *out->shapes);
    if (!all)
        return words_no_memory(in);
    out->shapes = all;
    render_text_shape *shape = &out->shapes[out->shape_count];
    memset(shape, 0, sizeof *shape);
    shape->line = in->line;
    shape->material = -1;
    shape->place = render_identity;
    int kind = 0;
    while (kind < RENDER_SHAPE_KINDS && !words_take(in, kinds[kind]))
        kind++;
    if (kind == RENDER_SHAPE_KINDS)
        return words_unknown(
            in, "sphere, quad, box, torus, knot, superellipsoid, teapot, lathe or obj");
    shape->kind = (render_shape_kind)kind;
    hnbrdf_result result =
        kind == RENDER_OBJ ? words_text(in, "obj", sizeof shape->file, shape->file) : HNBRDF_OK;
    while (in->at < in->count && result == HNBRDF_OK)
        result = read_parameter(in, shape);
    if (result == HNBRDF_OK && kind == RENDER_LATHE && shape->options.profile_count < 2)
        return BAD(in, "%s:%ld: a lathe needs a profile of 2 points or more", in->name, in->line);
    out->shape_count += result == HNBRDF_OK;
    return result;
}
