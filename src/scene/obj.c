/* obj.c: read Wavefront OBJ files: its statements, and the mesh that they make. */
#include "scene/obj_reader.h"

#include "base/error.h"
#include "base/text.h"
#include "scene/units.h"

#include <math.h>
#include <stdlib.h>

/* ---- Vertices, normals, texture coordinates -------------------------------------------------- */

static hnbrdf_result read_vertex(obj_reader *r)
{
    obj_lines *in = &r->in;
    if (r->position_count == r->position_room) {
        const size_t room = r->position_room + r->position_room / 2 + 64;
        void *all = room < RENDER_NONE ? realloc(r->positions, room * sizeof *r->positions) : NULL;
        if (!all)
            return obj_no_memory(in);
        r->positions = all;
        r->position_room = room;
    }
    double *p = r->positions[r->position_count];
    obj_skip_blanks(in);
    const obj_lines before = *in;
    hnbrdf_result result = obj_numbers(in, "v", 3, 3, p);
    if (result == HNBRDF_OK && isnan(p[0] + p[1] + p[2]))
        return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT,
                           "%s:%ld: v: found '%.*s', expected 3 finite numbers up to 1e30",
                           in->name, in->line, obj_rest(&before), before.at);
    r->position_count += result == HNBRDF_OK;
    return result;
}

static hnbrdf_result read_uv(obj_reader *r)
{
    double uv[2];
    obj_skip_blanks(&r->in);
    const obj_lines before = r->in;
    hnbrdf_result result = obj_numbers(&r->in, "vt", 1, 2, uv);
    if (result != HNBRDF_OK)
        return result;
    if (isnan(uv[0] + uv[1])) {
        uv[0] = (double)NAN;
        obj_count(&r->tallies[OBJ_UV_UNUSABLE], &before, before.at, obj_rest(&before));
    }
    return render_mesh_uv(r->mesh, uv) == RENDER_NONE ? obj_no_memory(&r->in) : HNBRDF_OK;
}

static hnbrdf_result read_normal(obj_reader *r)
{
    double n[3];
    obj_skip_blanks(&r->in);
    const obj_lines before = r->in;
    hnbrdf_result result = obj_numbers(&r->in, "vn", 3, 3, n);
    if (result != HNBRDF_OK)
        return result;
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++)
        n[k] = length > 0.0 ? n[k] / length : (double)NAN; /* some exporters write 0 0 0 */
    if (!(length > 0.0))
        obj_count(&r->tallies[OBJ_NORMAL_UNUSABLE], &before, before.at, obj_rest(&before));
    return render_mesh_normal(r->mesh, n) == RENDER_NONE ? obj_no_memory(&r->in) : HNBRDF_OK;
}

/* ---- Statements ------------------------------------------------------------------------------ */

/* The rest of the line names what follows. */
static hnbrdf_result read_part(obj_reader *r)
{
    obj_lines *in = &r->in;
    obj_skip_blanks(in);
    while (in->end > in->at && obj_is_blank(in->end[-1]))
        in->end--;
    r->part = render_mesh_part(r->mesh, in->at, (size_t)(in->end - in->at));
    return r->part == RENDER_NONE ? obj_no_memory(in) : HNBRDF_OK;
}

static int is_one_of(const char *start, size_t length, const char *const *words)
{
    while (*words && !obj_is_word(start, length, *words))
        words++;
    return *words != NULL;
}

/* Counts a statement that is not drawn though it might be missed. */
static void pass_over(obj_reader *r, const char *start, size_t length)
{
    static const char *const lines[] = {"l", "p", NULL}, *const free_form[] = {"curv", "curv2",
                                                                               "surf", "bzp",
                                                                               "bsp",  "cdc",
                                                                               "cdp",  "res",
                                                                               NULL},
                             *const harmless[] = {"s",      "mg",         "mtllib",    "usemap",
                                                  "maplib", "bevel",      "c_interp",  "d_interp",
                                                  "lod",    "shadow_obj", "trace_obj", "ctech",
                                                  "stech",  "vp",         "cstype",    "deg",
                                                  "bmat",   "step",       "parm",      "trim",
                                                  "hole",   "scrv",       "sp",        "end",
                                                  "con",    "call",       "csh",       NULL};
    const int room = (int)(length < 40 ? length : 40);
    if (is_one_of(start, length, lines))
        obj_count(&r->tallies[OBJ_LINES], &r->in, start, room);
    else if (is_one_of(start, length, free_form))
        obj_count(&r->tallies[OBJ_FREE_FORM], &r->in, start, room);
    else if (!is_one_of(start, length, harmless))
        obj_count(&r->tallies[OBJ_UNKNOWN], &r->in, start, room);
}

/* Reads all that faces name. */
static hnbrdf_result read_data(obj_reader *r)
{
    hnbrdf_result result = HNBRDF_OK;
    while (result == HNBRDF_OK && obj_next_line(&r->in)) {
        size_t length;
        const char *start = obj_word(&r->in, &length);
        if (!start)
            continue;
        if (obj_is_word(start, length, "v"))
            result = read_vertex(r);
        else if (obj_is_word(start, length, "vt"))
            result = read_uv(r);
        else if (obj_is_word(start, length, "vn"))
            result = read_normal(r);
    }
    return result;
}

/* A group names a part as long as no material does. */
static hnbrdf_result read_statement(obj_reader *r, const char *start, size_t length)
{
    hnbrdf_result result = HNBRDF_OK;
    if (obj_is_word(start, length, "v")) {
        r->positions_above++;
    } else if (obj_is_word(start, length, "vt")) {
        r->uvs_above++;
    } else if (obj_is_word(start, length, "vn")) {
        r->normals_above++;
    } else if (obj_is_word(start, length, "f") || obj_is_word(start, length, "fo")) {
        result = obj_read_face(r);
    } else if (obj_is_word(start, length, "usemtl")) {
        r->has_usemtl = 1;
        result = read_part(r);
    } else if (obj_is_word(start, length, "g") || obj_is_word(start, length, "o")) {
        result = r->has_usemtl ? HNBRDF_OK : read_part(r);
    } else {
        pass_over(r, start, length);
    }
    return result;
}

static hnbrdf_result read_faces(obj_reader *r)
{
    hnbrdf_result result = HNBRDF_OK;
    while (result == HNBRDF_OK && obj_next_line(&r->in)) {
        size_t length;
        const char *start = obj_word(&r->in, &length);
        if (start)
            result = read_statement(r, start, length);
    }
    return result;
}

/* ---- The file -------------------------------------------------------------------------------- */

/* Gives the mesh its vertices, or says why there is nothing to be drawn. */
static hnbrdf_result finish(obj_reader *r, render_transform *place)
{
    if (r->faces == 0)
        return hnbrdf_fail(r->in.error, HNBRDF_ERROR_FORMAT,
                           "%s: no face%s in %ld lines: expected an OBJ file", r->in.name,
                           r->tallies[OBJ_FACE_SHORT].count ? " of 3 corners or more" : "",
                           r->in.line);
    if (render_units_settle((const double(*)[3])r->positions, r->position_count, r->mesh, place))
        return obj_no_memory(&r->in);
    if (!render_units_resolve(r->mesh))
        return hnbrdf_fail(
            r->in.error, HNBRDF_ERROR_FORMAT,
            "%s: its %zu face%s no area, all corners lie in a line or a point: expected "
            "a surface",
            r->in.name, r->faces, r->faces == 1 ? " has" : "s have");
    return HNBRDF_OK;
}

static void tell(obj_reader *r, const render_obj_options *options)
{
    if (!r->has_normals || options->smooth)
        r->tallies[OBJ_NORMAL_WITHOUT].count = 0;
    if (options->smooth)
        r->tallies[OBJ_NORMAL_ABSENT].count = r->tallies[OBJ_NORMAL_UNUSABLE].count = 0;
    if (!r->has_uvs)
        r->tallies[OBJ_UV_WITHOUT].count = 0;
    obj_tell(r->tallies, r->in.name, &options->notes);
}

hnbrdf_result render_obj_decode(const void *data, size_t size, const char *name,
                                const render_obj_options *options, render_mesh *mesh,
                                render_transform *place, hnbrdf_error *error)
{
    static const size_t most = (size_t)1 << 25;
    const render_obj_options o = options ? *options : (render_obj_options){0};
    render_mesh made = {0};
    render_transform there = render_identity;
    obj_reader r = {.mesh = &made,
                    .max_triangles =
                        o.max_triangles && o.max_triangles < most ? o.max_triangles : most};
    obj_lines_begin(&r.in, data, size, name, error);
    hnbrdf_result result =
        hnbrdf_is_utf16(data, size)
            ? hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: found UTF-16, expected UTF-8", name)
            : read_data(&r);
    obj_lines_begin(&r.in, data, size, name, error);
    if (result == HNBRDF_OK && (r.part = render_mesh_part(&made, "", 0)) == RENDER_NONE)
        result = obj_no_memory(&r.in);
    if (result == HNBRDF_OK)
        result = read_faces(&r);
    if (result == HNBRDF_OK)
        tell(&r, &o);
    if (result == HNBRDF_OK)
        result = finish(&r, &there);
    if (result == HNBRDF_OK && o.smooth && render_mesh_smooth(&made))
        result = obj_no_memory(&r.in);
    free(r.positions);
    free(r.corners);
    free(r.outline);
    free(r.triangles);
    if (result != HNBRDF_OK) {
        render_mesh_free(&made);
        return result;
    }
    *mesh = made;
    if (place)
        *place = there;
    return HNBRDF_OK;
}
