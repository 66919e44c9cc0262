/* obj.c: read Wavefront OBJ files of any origin. */
#include "scene/mesh.h"

#include "base/error.h"
#include "base/text.h"
#include "image/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CORNERS = 65536, MAX_PARTS = 1024 };

typedef struct corner {
    uint32_t position, uv, normal;
} corner;

typedef struct reader {
    const char *at, *end; /* of the statement, blanks and a comment gone */
    const char *next, *last;
    const char *name;
    long line, next_line;
    size_t max_triangles;
    render_mesh *mesh;
    uint32_t part;
    int has_usemtl;
    corner *corners; /* of one polygon, with its positions and triangles: room for corner_room */
    float (*positions)[3];
    uint32_t (*triangles)[3];
    uint32_t corner_room;
    hnbrdf_error *error;
} reader;

static hnbrdf_result bad(const reader *in, hnbrdf_result result, const char *what)
{
    return hnbrdf_fail(in->error, result, "%s:%ld: %s", in->name, in->line, what);
}

static hnbrdf_result no_memory(const reader *in)
{
    return bad(in, HNBRDF_ERROR_MEMORY, "no memory for what was read so far");
}

/* ---- Words ----------------------------------------------------------------------------------- */

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == '\\' || c == '\n';
}

/* Steps to the next line; a backslash before its end joins the one after it, both blanks then. 0
 * at the end of the file. */
static int next_line(reader *in)
{
    if (in->next == in->last)
        return 0;
    in->line = in->next_line;
    in->at = in->next;
    for (;;) {
        const char *end = memchr(in->next, '\n', (size_t)(in->last - in->next));
        in->end = end ? end : in->last;
        in->next = end ? end + 1 : in->last;
        in->next_line++;
        const char *before = in->end;
        while (before > in->at && (before[-1] == '\r'))
            before--;
        if (before == in->at || before[-1] != '\\' || in->next == in->last)
            break;
    }
    /* "Material#1" is a name that some programs give */
    for (const char *c = in->at; c < in->end; c++)
        if (*c == '#' && (c == in->at || is_blank(c[-1])))
            in->end = c;
    return 1;
}

static void skip_blanks(reader *in)
{
    while (in->at < in->end && is_blank(*in->at))
        in->at++;
}

/* The next word: its start, *length bytes; NULL at the end of the line. */
static const char *word(reader *in, size_t *length)
{
    skip_blanks(in);
    const char *start = in->at;
    while (in->at < in->end && !is_blank(*in->at))
        in->at++;
    *length = (size_t)(in->at - start);
    return *length ? start : NULL;
}

static int is_word(const char *start, size_t length, const char *expected)
{
    return length == strlen(expected) && memcmp(start, expected, length) == 0;
}

/* count finite numbers that floats can hold. */
static hnbrdf_result numbers(reader *in, const char *what, int count, double *values)
{
    for (int k = 0; k < count; k++) {
        skip_blanks(in);
        const char *end = hnbrdf_parse_double(in->at, in->end, &values[k]);
        if (!end || (end < in->end && !is_blank(*end)) || !(fabs(values[k]) <= 1e30))
            return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT,
                               "%s:%ld: %s: found '%.*s', expected %d finite numbers up to 1e30",
                               in->name, in->line, what,
                               (int)(in->end - in->at < 40 ? in->end - in->at : 40), in->at, count);
        in->at = end;
    }
    return HNBRDF_OK;
}

/* ---- Statements ------------------------------------------------------------------------------ */

/* An index from 1, or from -1 backwards, to *value from 0. */
static hnbrdf_result read_index(reader *in, size_t count, const char *what, uint32_t *value)
{
    int negative = in->at < in->end && *in->at == '-';
    const char *digit = in->at + negative;
    size_t number = 0;
    while (digit < in->end && *digit >= '0' && *digit <= '9' && number <= UINT32_MAX)
        number = 10 * number + (size_t)(*digit++ - '0');
    if (number < 1 || number > count)
        return hnbrdf_fail(
            in->error, HNBRDF_ERROR_FORMAT,
            "%s:%ld: %s '%.*s' of a face: expected 1 to %zu, or -1 to -%zu", in->name, in->line,
            what, (int)(in->end - in->at < 24 ? in->end - in->at : 24), in->at, count, count);
    *value = (uint32_t)(negative ? count - number : number - 1);
    in->at = digit;
    return HNBRDF_OK;
}

/* v, v/t, v//n or v/t/n. */
static hnbrdf_result read_corner(reader *in, corner *c)
{
    c->uv = c->normal = RENDER_NONE;
    hnbrdf_result result = read_index(in, in->mesh->position_count, "vertex", &c->position);
    if (result == HNBRDF_OK && in->at < in->end && *in->at == '/') {
        in->at++;
        if (in->at < in->end && *in->at != '/' && !is_blank(*in->at))
            result = read_index(in, in->mesh->uv_count, "texture coordinate", &c->uv);
        if (result == HNBRDF_OK && in->at < in->end && *in->at == '/') {
            in->at++;
            if (in->at < in->end && !is_blank(*in->at)) /* "v/t/" has none, as some write it */
                result = read_index(in, in->mesh->normal_count, "normal", &c->normal);
        }
    }
    if (result == HNBRDF_OK && in->at < in->end && !is_blank(*in->at))
        return bad(in, HNBRDF_ERROR_FORMAT, "a corner of a face is not v, v/t, v//n or v/t/n");
    return result;
}

static hnbrdf_result more_corners(reader *in)
{
    uint32_t room = in->corner_room ? 2 * in->corner_room : 16;
    corner *corners = realloc(in->corners, room * sizeof *corners);
    in->corners = corners ? corners : in->corners;
    float(*positions)[3] = realloc(in->positions, room * sizeof *positions);
    in->positions = positions ? positions : in->positions;
    uint32_t(*triangles)[3] = realloc(in->triangles, room * sizeof *triangles);
    in->triangles = triangles ? triangles : in->triangles;
    if (!corners || !positions || !triangles)
        return no_memory(in);
    in->corner_room = room;
    return HNBRDF_OK;
}

static hnbrdf_result add_triangle(reader *in, const uint32_t which[3])
{
    render_triangle triangle = {.part = in->part};
    int uvs = 1, normals = 1;
    for (int k = 0; k < 3; k++) {
        const corner *c = &in->corners[which[k]];
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
    if (in->mesh->triangle_count == in->max_triangles)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_LIMIT, "%s:%ld: expected at most %zu triangles",
                           in->name, in->line, in->max_triangles);
    return render_mesh_triangle(in->mesh, &triangle) == RENDER_NONE ? no_memory(in) : HNBRDF_OK;
}

static hnbrdf_result read_face(reader *in)
{
    uint32_t count = 0;
    for (skip_blanks(in); in->at < in->end; skip_blanks(in)) {
        hnbrdf_result result = count == in->corner_room ? more_corners(in) : HNBRDF_OK;
        if (result == HNBRDF_OK)
            result = read_corner(in, &in->corners[count]);
        if (result != HNBRDF_OK)
            return result;
        memcpy(in->positions[count], in->mesh->positions[in->corners[count].position],
               sizeof *in->positions);
        if (++count > MAX_CORNERS)
            return bad(in, HNBRDF_ERROR_LIMIT, "a face of more than 65536 corners");
    }
    if (count < 3)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT,
                           "%s:%ld: a face of %u corners: expected 3 or more", in->name, in->line,
                           count);
    if (render_polygon_split((const float(*)[3])in->positions, count, in->triangles))
        return hnbrdf_fail(
            in->error, HNBRDF_ERROR_LIMIT,
            "%s:%ld: a concave face of %u corners: expected at most %d; triangulate it", in->name,
            in->line, count, RENDER_MAX_CONCAVE);
    hnbrdf_result result = HNBRDF_OK;
    for (uint32_t i = 0; i + 2 < count && result == HNBRDF_OK; i++)
        result = add_triangle(in, in->triangles[i]);
    return result;
}

/* The rest of the line names what follows. */
static hnbrdf_result read_part(reader *in)
{
    skip_blanks(in);
    while (in->end > in->at && is_blank(in->end[-1]))
        in->end--;
    in->part = render_mesh_part(in->mesh, in->at, (size_t)(in->end - in->at));
    if (in->part == RENDER_NONE)
        return no_memory(in);
    return in->mesh->part_count > MAX_PARTS
               ? bad(in, HNBRDF_ERROR_LIMIT, "more than 1024 materials or groups")
               : HNBRDF_OK;
}

static hnbrdf_result read_normal(reader *in)
{
    double n[3];
    hnbrdf_result result = numbers(in, "vn", 3, n);
    if (result != HNBRDF_OK)
        return result;
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++)
        n[k] = length > 0.0 ? n[k] / length : k == 2; /* some exporters write 0 0 0 */
    return render_mesh_normal(in->mesh, n) == RENDER_NONE ? no_memory(in) : HNBRDF_OK;
}

static hnbrdf_result read_statement(reader *in)
{
    size_t length;
    double values[3];
    hnbrdf_result result = HNBRDF_OK;
    const char *start = word(in, &length);
    if (!start)
        return HNBRDF_OK;
    if (is_word(start, length, "v")) {
        result = numbers(in, "v", 3, values);
        if (result == HNBRDF_OK && render_mesh_position(in->mesh, values) == RENDER_NONE)
            result = no_memory(in);
    } else if (is_word(start, length, "vt")) {
        result = numbers(in, "vt", 2, values);
        if (result == HNBRDF_OK && render_mesh_uv(in->mesh, values) == RENDER_NONE)
            result = no_memory(in);
    } else if (is_word(start, length, "vn")) {
        result = read_normal(in);
    } else if (is_word(start, length, "f")) {
        result = read_face(in);
    } else if (is_word(start, length, "usemtl")) {
        in->has_usemtl = 1;
        result = read_part(in);
    } else if (!in->has_usemtl && (is_word(start, length, "g") || is_word(start, length, "o"))) {
        result = read_part(in);
    }
    return result;
}

hnbrdf_result render_obj_decode(const void *data, size_t size, const char *name,
                                const render_obj_limits *limits, render_mesh *mesh,
                                hnbrdf_error *error)
{
    static const size_t most = (size_t)1 << 25;
    size_t wanted = limits ? limits->max_triangles : 0;
    render_mesh result_mesh = {0};
    reader in = {.next = data,
                 .last = (const char *)data + size,
                 .name = name,
                 .next_line = 1,
                 .max_triangles = wanted && wanted < most ? wanted : most,
                 .mesh = &result_mesh,
                 .error = error};
    in.part = render_mesh_part(&result_mesh, "", 0);
    hnbrdf_result result = in.part == RENDER_NONE ? no_memory(&in) : HNBRDF_OK;
    while (result == HNBRDF_OK && next_line(&in))
        result = read_statement(&in);
    free(in.corners);
    free(in.positions);
    free(in.triangles);
    if (result == HNBRDF_OK && result_mesh.triangle_count == 0)
        result = hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                             "%s: no face in %ld lines: expected an OBJ file", name, in.line);
    if (result == HNBRDF_OK)
        *mesh = result_mesh;
    else
        render_mesh_free(&result_mesh);
    return result;
}

hnbrdf_result render_obj_read(const char *path, const render_obj_limits *limits, render_mesh *mesh,
                              hnbrdf_error *error)
{
    static const size_t most = (size_t)1 << 29;
    size_t wanted = limits ? limits->max_bytes : 0;
    render_bytes bytes = {0};
    hnbrdf_result result =
        render_file_read(path, wanted && wanted < most ? wanted : most, &bytes, error);
    if (result == HNBRDF_OK)
        result = render_obj_decode(bytes.data, bytes.size, path, limits, mesh, error);
    free(bytes.data);
    return result;
}
