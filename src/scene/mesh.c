/* mesh.c: build meshes, transform them, smooth their normals. */
#include "scene/mesh.h"

#include "base/hash.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const render_transform render_identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

void render_mesh_free(render_mesh *mesh)
{
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs);
    free(mesh->triangles);
    free(mesh->parts);
    free(mesh->part_slots);
    memset(mesh, 0, sizeof *mesh);
}

/* Room for one more element. */
static void *grown(void *array, size_t count, size_t *room, size_t element)
{
    if (count < *room)
        return array;
    size_t wanted = *room + *room / 2 + 64;
    void *larger = wanted < RENDER_NONE ? realloc(array, wanted * element) : NULL;
    if (larger)
        *room = wanted;
    return larger;
}

uint32_t render_mesh_position(render_mesh *mesh, const double p[3])
{
    void *all =
        grown(mesh->positions, mesh->position_count, &mesh->position_room, sizeof *mesh->positions);
    if (!all)
        return RENDER_NONE;
    mesh->positions = all;
    for (int k = 0; k < 3; k++)
        mesh->positions[mesh->position_count][k] = (float)p[k];
    return (uint32_t)mesh->position_count++;
}

uint32_t render_mesh_normal(render_mesh *mesh, const double n[3])
{
    void *all = grown(mesh->normals, mesh->normal_count, &mesh->normal_room, sizeof *mesh->normals);
    if (!all)
        return RENDER_NONE;
    mesh->normals = all;
    for (int k = 0; k < 3; k++)
        mesh->normals[mesh->normal_count][k] = (float)n[k];
    return (uint32_t)mesh->normal_count++;
}

uint32_t render_mesh_uv(render_mesh *mesh, const double uv[2])
{
    void *all = grown(mesh->uvs, mesh->uv_count, &mesh->uv_room, sizeof *mesh->uvs);
    if (!all)
        return RENDER_NONE;
    mesh->uvs = all;
    for (int k = 0; k < 2; k++)
        mesh->uvs[mesh->uv_count][k] = (float)uv[k];
    return (uint32_t)mesh->uv_count++;
}

uint32_t render_mesh_triangle(render_mesh *mesh, const render_triangle *triangle)
{
    void *all =
        grown(mesh->triangles, mesh->triangle_count, &mesh->triangle_room, sizeof *mesh->triangles);
    if (!all)
        return RENDER_NONE;
    mesh->triangles = all;
    mesh->triangles[mesh->triangle_count] = *triangle;
    return (uint32_t)mesh->triangle_count++;
}

/* Where a part of that name stands in the slots, or would: open addressing, step by step. */
static size_t find_slot(const render_mesh *mesh, const char *name, size_t length)
{
    size_t slot = (size_t)hnbrdf_hash(HNBRDF_HASH_START, name, length) % mesh->part_slot_count;
    for (;; slot = (slot + 1) % mesh->part_slot_count) {
        const uint32_t number = mesh->part_slots[slot];
        if (!number)
            return slot;
        const char *other = mesh->parts[number - 1].name;
        if (strncmp(other, name, length) == 0 && !other[length])
            return slot;
    }
}

/* Keeps half of the slots free. 0, or -1 when memory is out. */
static int grow_slots(render_mesh *mesh)
{
    if (2 * (mesh->part_count + 1) <= mesh->part_slot_count)
        return 0;
    const size_t count = mesh->part_slot_count ? 2 * mesh->part_slot_count : 16;
    uint32_t *slots = calloc(count, sizeof *slots);
    if (!slots)
        return -1;
    free(mesh->part_slots);
    mesh->part_slots = slots;
    mesh->part_slot_count = count;
    for (size_t i = 0; i < mesh->part_count; i++) {
        const char *name = mesh->parts[i].name;
        slots[find_slot(mesh, name, strlen(name))] = (uint32_t)i + 1;
    }
    return 0;
}

uint32_t render_mesh_part(render_mesh *mesh, const char *name, size_t length)
{
    length = length < HNBRDF_MAX_NAME ? length : HNBRDF_MAX_NAME;
    const char *nul = memchr(name, '\0', length);
    length = nul ? (size_t)(nul - name) : length;
    if (grow_slots(mesh))
        return RENDER_NONE;
    const size_t slot = find_slot(mesh, name, length);
    if (mesh->part_slots[slot])
        return mesh->part_slots[slot] - 1;
    void *all = grown(mesh->parts, mesh->part_count, &mesh->part_room, sizeof *mesh->parts);
    if (!all)
        return RENDER_NONE;
    mesh->parts = all;
    memset(&mesh->parts[mesh->part_count], 0, sizeof *mesh->parts);
    memcpy(mesh->parts[mesh->part_count].name, name, length);
    mesh->part_slots[slot] = (uint32_t)++mesh->part_count;
    return (uint32_t)mesh->part_count - 1;
}

/* ---- Normals --------------------------------------------------------------------------------- */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* Adds the triangle's normal to its corners, weighted by the angles there. */
static void add_corners(const render_mesh *mesh, const render_triangle *triangle, double (*sums)[3])
{
    for (int corner = 0; corner < 3; corner++) {
        const float *p = mesh->positions[triangle->position[corner]];
        const float *q = mesh->positions[triangle->position[(corner + 1) % 3]];
        const float *r = mesh->positions[triangle->position[(corner + 2) % 3]];
        double a[3], b[3], n[3];
        for (int k = 0; k < 3; k++) {
            a[k] = (double)q[k] - (double)p[k];
            b[k] = (double)r[k] - (double)p[k];
        }
        cross(a, b, n);
        double length = sqrt(dot(n, n));
        if (!(length > 0.0))
            continue;
        double angle = atan2(length, dot(a, b));
        for (int k = 0; k < 3; k++)
            sums[triangle->position[corner]][k] += angle * n[k] / length;
    }
}

int render_mesh_smooth(render_mesh *mesh)
{
    double(*sums)[3] = calloc(mesh->position_count + 1, sizeof *sums);
    float(*normals)[3] = malloc((mesh->position_count + 1) * sizeof *normals);
    if (!sums || !normals) {
        free(sums);
        free(normals);
        return -1;
    }
    for (size_t i = 0; i < mesh->triangle_count; i++)
        add_corners(mesh, &mesh->triangles[i], sums);
    for (size_t i = 0; i < mesh->position_count; i++) {
        double length = sqrt(dot(sums[i], sums[i]));
        for (int k = 0; k < 3; k++)
            normals[i][k] = length > 0.0 ? (float)(sums[i][k] / length) : (float)(k == 2);
    }
    for (size_t i = 0; i < mesh->triangle_count; i++)
        memcpy(mesh->triangles[i].normal, mesh->triangles[i].position,
               sizeof mesh->triangles[i].normal);
    free(sums);
    free(mesh->normals);
    mesh->normals = normals;
    mesh->normal_count = mesh->position_count;
    mesh->normal_room = mesh->position_count + 1;
    return 0;
}

/* ---- Transforms ------------------------------------------------------------------------------ */

render_transform render_transform_then(const render_transform *a, const render_transform *b)
{
    render_transform result;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            double sum = j == 3 ? b->m[i][3] : 0.0;
            for (int k = 0; k < 3; k++)
                sum += b->m[i][k] * a->m[k][j];
            result.m[i][j] = sum;
        }
    return result;
}

/* Cofactors: the inverse transpose times the determinant. */
static void cofactors(const render_transform *transform, double c[3][3])
{
    const double(*m)[4] = transform->m;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (i + 1) % 3, b = (i + 2) % 3, p = (j + 1) % 3, q = (j + 2) % 3;
            c[i][j] = m[a][p] * m[b][q] - m[a][q] * m[b][p];
        }
}

double render_transform_determinant(const render_transform *transform)
{
    double c[3][3];
    cofactors(transform, c);
    return transform->m[0][0] * c[0][0] + transform->m[0][1] * c[0][1] +
           transform->m[0][2] * c[0][2];
}

static void transform_normal(double c[3][3], double sign, float n[3])
{
    double turned[3], length = 0.0;
    for (int i = 0; i < 3; i++) {
        turned[i] =
            sign * (c[i][0] * (double)n[0] + c[i][1] * (double)n[1] + c[i][2] * (double)n[2]);
        length += turned[i] * turned[i];
    }
    for (int i = 0; i < 3 && length > 0.0; i++)
        n[i] = (float)(turned[i] / sqrt(length));
}

static void mirror_corners(render_triangle *triangle)
{
    uint32_t *const corners[] = {triangle->position, triangle->normal, triangle->uv};
    for (int i = 0; i < 3; i++) {
        uint32_t swap = corners[i][1];
        corners[i][1] = corners[i][2];
        corners[i][2] = swap;
    }
}

static void transform_point(const render_transform *transform, const float p[3], double to[3])
{
    double x = (double)p[0], y = (double)p[1], z = (double)p[2];
    for (int k = 0; k < 3; k++)
        to[k] = transform->m[k][0] * x + transform->m[k][1] * y + transform->m[k][2] * z +
                transform->m[k][3];
}

double render_mesh_reach(const render_mesh *mesh, const render_transform *transform)
{
    double reach = 0.0, p[3];
    for (size_t i = 0; i < mesh->position_count; i++) {
        transform_point(transform, mesh->positions[i], p);
        for (int k = 0; k < 3; k++)
            if (!isnan(reach) && !(fabs(p[k]) <= reach))
                reach = fabs(p[k]);
    }
    return reach;
}

void render_mesh_transform(render_mesh *mesh, const render_transform *transform)
{
    double c[3][3], sign = render_transform_determinant(transform) < 0.0 ? -1.0 : 1.0;
    cofactors(transform, c);
    for (size_t i = 0; i < mesh->position_count; i++) {
        double p[3];
        transform_point(transform, mesh->positions[i], p);
        for (int k = 0; k < 3; k++)
            mesh->positions[i][k] = (float)p[k];
    }
    for (size_t i = 0; i < mesh->normal_count; i++)
        transform_normal(c, sign, mesh->normals[i]);
    for (size_t i = 0; i < mesh->triangle_count && sign < 0.0; i++)
        mirror_corners(&mesh->triangles[i]);
}

void render_mesh_bounds(const render_mesh *mesh, float low[3], float high[3])
{
    memcpy(low, mesh->positions[0], 3 * sizeof *low);
    memcpy(high, mesh->positions[0], 3 * sizeof *high);
    for (size_t i = 1; i < mesh->position_count; i++)
        for (int k = 0; k < 3; k++) {
            float x = mesh->positions[i][k];
            low[k] = x < low[k] ? x : low[k];
            high[k] = x > high[k] ? x : high[k];
        }
}
