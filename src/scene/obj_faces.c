/* obj_faces.c: faces of an OBJ file, split into triangles. */
#include "scene/obj_reader.h"

#include "base/error.h"
#include "scene/polygon.h"
#include "scene/turn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CORNERS = 65536 };

/* What one face lacks; each kind counts once a face. */
typedef struct lacking {
    const char *absent[2]; /* as the face names it: a normal, a texture coordinate; or NULL */
    int absent_length[2];
    int without[2];
} lacking;

/* ---- Corners --------------------------------------------------------------------------------- */

/* An index from 1, or from -1 backwards, to *value from 0; RENDER_NONE if there is no such. */
static hnbrdf_result read_index(obj_reader *r, size_t count, size_t above, const char *what,
                                uint32_t *value)
{
    obj_lines *in = &r->in;
    int negative = in->at < in->end && *in->at == '-';
    const char *digit = in->at + negative;
    size_t number = 0;
    while (digit < in->end && *digit >= '0' && *digit <= '9' && number <= UINT32_MAX)
        number = 10 * number + (size_t)(*digit++ - '0');
    if (digit == in->at + negative)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT,
                           "%s:%ld: %s '%.*s' of a face: expected a whole number", in->name,
                           in->line, what, obj_rest(in), in->at);
    const int there = number >= 1 && number <= (negative ? above : count);
    *value = !there ? RENDER_NONE : (uint32_t)(negative ? above - number : number - 1);
    in->at = digit;
    return HNBRDF_OK;
}

static hnbrdf_result read_position(obj_reader *r, uint32_t *value)
{
    const char *start = r->in.at;
    hnbrdf_result result = read_index(r, r->position_count, r->positions_above, "vertex", value);
    if (result != HNBRDF_OK || *value != RENDER_NONE)
        return result;
    char expected[96] = "a vertex, but there is none";
    if (r->position_count && r->positions_above)
        snprintf(expected, sizeof expected, "1 to %zu, or -1 to -%zu", r->position_count,
                 r->positions_above);
    else if (r->position_count)
        snprintf(expected, sizeof expected, "1 to %zu", r->position_count);
    return hnbrdf_fail(r->in.error, HNBRDF_ERROR_FORMAT,
                       "%s:%ld: vertex '%.*s' of a face: expected %s", r->in.name, r->in.line,
                       (int)(r->in.at - start < 40 ? r->in.at - start : 40), start, expected);
}

/* A normal (which 0) or a texture coordinate (1) that the file may lack. */
static hnbrdf_result read_other(obj_reader *r, int which, uint32_t *value, lacking *lacks)
{
    const char *start = r->in.at;
    const size_t count = which ? r->mesh->uv_count : r->mesh->normal_count;
    hnbrdf_result result = read_index(r, count, which ? r->uvs_above : r->normals_above,
                                      which ? "texture coordinate" : "normal", value);
    if (result != HNBRDF_OK)
        return result;
    if (*value == RENDER_NONE && !lacks->absent[which]) {
        lacks->absent[which] = start;
        lacks->absent_length[which] = (int)(r->in.at - start < 40 ? r->in.at - start : 40);
    } else if (*value != RENDER_NONE &&
               isnan(which ? r->mesh->uvs[*value][0] : r->mesh->normals[*value][0])) {
        *value = RENDER_NONE;
    }
    return HNBRDF_OK;
}

/* Whether an index comes now. */
static int has_index(const obj_lines *in)
{
    return in->at < in->end && *in->at != '/' && !obj_is_blank(*in->at);
}

static int take_slash(obj_lines *in)
{
    const int there = in->at < in->end && *in->at == '/';
    in->at += there;
    return there;
}

/* v, v/t, v//n or v/t/n; "v/t/" has no normal, as some write it. */
static hnbrdf_result read_corner(obj_reader *r, obj_corner *c, lacking *lacks)
{
    c->uv = c->normal = RENDER_NONE;
    hnbrdf_result result = read_position(r, &c->position);
    for (int which = 1; which >= 0 && result == HNBRDF_OK; which--)
        if (take_slash(&r->in) && has_index(&r->in))
            result = read_other(r, which, which ? &c->uv : &c->normal, lacks);
        else
            lacks->without[which] = 1;
    if (result == HNBRDF_OK && r->in.at < r->in.end && !obj_is_blank(*r->in.at))
        return obj_bad(&r->in, HNBRDF_ERROR_FORMAT,
                       "a corner of a face is not v, v/t, v//n or v/t/n");
    return result;
}

static hnbrdf_result more_corners(obj_reader *r)
{
    uint32_t room = r->corner_room ? 2 * r->corner_room : 16;
    obj_corner *corners = realloc(r->corners, room * sizeof *corners);
    r->corners = corners ? corners : r->corners;
    double(*outline)[3] = realloc(r->outline, room * sizeof *outline);
    r->outline = outline ? outline : r->outline;
    uint32_t(*triangles)[3] = realloc(r->triangles, room * sizeof *triangles);
    r->triangles = triangles ? triangles : r->triangles;
    if (!corners || !outline || !triangles)
        return obj_no_memory(&r->in);
    r->corner_room = room;
    return HNBRDF_OK;
}

/* ---- Triangles ------------------------------------------------------------------------------- */

/* Whether its corners lie exactly on one line. */
static int is_flat(const obj_reader *r, const uint32_t which[3])
{
    for (int k = 0; k < 3; k++) {
        double p[3][2];
        for (int i = 0; i < 3; i++) {
            p[i][0] = r->outline[which[i]][k];
            p[i][1] = r->outline[which[i]][(k + 1) % 3];
        }
        if (render_turn(p[0], p[1], p[2]) != 0)
            return 0;
    }
    return 1;
}

static hnbrdf_result add_triangle(obj_reader *r, const uint32_t which[3])
{
    render_triangle triangle = {.part = r->part};
    int uvs = 1, normals = 1;
    if (is_flat(r, which))
        return HNBRDF_OK;
    for (int k = 0; k < 3; k++) {
        const obj_corner *c = &r->corners[which[k]];
        triangle.position[k] = c->position;
        triangle.uv[k] = c->uv;
        triangle.normal[k] = c->normal;
        uvs &= c->uv != RENDER_NONE;
        normals &= c->normal != RENDER_NONE;
    }
    for (int k = 0; k < 3; k++) {
        triangle.uv[k] = uvs ? triangle.uv[k] : RENDER_NONE;
        triangle.normal[k] = normals ? triangle.normal[k] : RENDER_NONE;
    }
    r->has_uvs |= uvs;
    r->has_normals |= normals;
    if (r->mesh->triangle_count == r->max_triangles)
        return hnbrdf_fail(r->in.error, HNBRDF_ERROR_LIMIT,
                           "%s:%ld: expected at most %zu triangles", r->in.name, r->in.line,
                           r->max_triangles);
    return render_mesh_triangle(r->mesh, &triangle) == RENDER_NONE ? obj_no_memory(&r->in)
                                                                   : HNBRDF_OK;
}

static void count_lacking(obj_reader *r, const lacking *lacks)
{
    static const obj_note absent[2] = {OBJ_NORMAL_ABSENT, OBJ_UV_ABSENT},
                          without[2] = {OBJ_NORMAL_WITHOUT, OBJ_UV_WITHOUT};
    for (int k = 0; k < 2; k++)
        if (lacks->absent[k])
            obj_count(&r->tallies[absent[k]], &r->in, lacks->absent[k], lacks->absent_length[k]);
        else if (lacks->without[k])
            obj_count(&r->tallies[without[k]], &r->in, "", 0);
}

hnbrdf_result obj_read_face(obj_reader *r)
{
    uint32_t count = 0;
    lacking lacks = {.absent = {NULL, NULL}};
    while (obj_skip_blanks(&r->in)) {
        hnbrdf_result result = count == r->corner_room ? more_corners(r) : HNBRDF_OK;
        if (result == HNBRDF_OK)
            result = read_corner(r, &r->corners[count], &lacks);
        if (result != HNBRDF_OK)
            return result;
        memcpy(r->outline[count], r->positions[r->corners[count].position], sizeof *r->outline);
        if (++count > MAX_CORNERS)
            return obj_bad(&r->in, HNBRDF_ERROR_LIMIT, "a face of more than 65536 corners");
    }
    if (count < 3) {
        obj_count(&r->tallies[OBJ_FACE_SHORT], &r->in, "", 0);
        return HNBRDF_OK;
    }
    r->faces++;
    count_lacking(r, &lacks);
    if (render_polygon_split((const double(*)[3])r->outline, count, r->triangles))
        return obj_no_memory(&r->in);
    hnbrdf_result result = HNBRDF_OK;
    for (uint32_t i = 0; i + 2 < count && result == HNBRDF_OK; i++)
        result = add_triangle(r, r->triangles[i]);
    return result;
}
