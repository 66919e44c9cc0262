/* test_mesh.c: shapes from formulas, normals, transforms. */
#include "scene/shapes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

/* ---- Shapes ---------------------------------------------------------------------------------- */

/* Volume inside the triangles, by the divergence theorem; positive if they face outwards. */
static double volume_of(const render_mesh *mesh)
{
    double sum = 0.0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const float *a = mesh->positions[mesh->triangles[i].position[0]],
                    *b = mesh->positions[mesh->triangles[i].position[1]],
                    *c = mesh->positions[mesh->triangles[i].position[2]];
        sum += (double)a[0] * ((double)b[1] * (double)c[2] - (double)b[2] * (double)c[1]) +
               (double)a[1] * ((double)b[2] * (double)c[0] - (double)b[0] * (double)c[2]) +
               (double)a[2] * ((double)b[0] * (double)c[1] - (double)b[1] * (double)c[0]);
    }
    return sum / 6.0;
}

/* Triangle normal against those of its corners. */
static double agreement(const render_mesh *mesh, size_t i)
{
    const render_triangle *t = &mesh->triangles[i];
    double e1[3], e2[3], least = 1.0;
    for (int k = 0; k < 3; k++) {
        e1[k] =
            (double)mesh->positions[t->position[1]][k] - (double)mesh->positions[t->position[0]][k];
        e2[k] =
            (double)mesh->positions[t->position[2]][k] - (double)mesh->positions[t->position[0]][k];
    }
    double n[3] = {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2],
                   e1[0] * e2[1] - e1[1] * e2[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int c = 0; c < 3 && length > 1e-12; c++) {
        const float *m = mesh->normals[t->normal[c]];
        double dot = (n[0] * (double)m[0] + n[1] * (double)m[1] + n[2] * (double)m[2]) / length;
        least = dot < least ? dot : least;
    }
    return least;
}

/* A cone and a cylinder in one profile, closed at both ends. */
static const render_shape_options turned = {
    .detail = 96,
    .profile_count = 8,
    .profile = {{0, 0}, {1, 0}, {1, 0}, {1, 2}, {1, 2}, {0, 3}, {0, 3}, {0, 3}}};

/* Volumes that are known; a circle of n corners has 1 - 2 pi^2 / (3 n^2) of its area. */
static void shapes_face_outwards_and_have_their_volume(void **state)
{
    (void)state;
    const struct {
        render_shape_kind kind;
        render_shape_options options;
        double volume, tolerance;
    } cases[] = {
        {RENDER_BOX, {0}, 1.0, 1e-6},
        {RENDER_TORUS, {.detail = 96, .tube = 0.25}, 2.0 * pi * pi * 0.0625, 2e-3},
        {RENDER_SUPERELLIPSOID, {.detail = 96}, 4.0 / 3.0 * pi, 2e-3},
        {RENDER_SUPERELLIPSOID, {.detail = 256, .powers = {0.1, 0.1}}, 7.8, 0.03},
        {RENDER_LATHE, turned, pi * (2.0 + 1.0 / 3.0), 2e-3},
        /* a tube along the knot's length: what a tube holds by Pappus, where it does not cross
         * itself */
        {RENDER_KNOT, {.detail = 96, .tube = 0.1}, 0.0, INFINITY},
        {RENDER_TEAPOT, {.detail = 96}, 0.0, INFINITY},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        render_mesh mesh = {0};
        assert_int_equal(render_shape_mesh(cases[i].kind, &cases[i].options, &mesh), 0);
        double volume = volume_of(&mesh), off = 0.0;
        assert_true(volume > 0.0);
        if (cases[i].volume > 0.0 && fabs(volume / cases[i].volume - 1.0) > cases[i].tolerance)
            fail_msg("shape %zu: volume %.5f, expected %.5f", i, volume, cases[i].volume);
        for (size_t t = 0; t < mesh.triangle_count; t++)
            off += agreement(&mesh, t) < 0.5;
        /* Slivers at the tip of the lid and the creases of a box with round edges are off. */
        if (off > 0.02 * (double)mesh.triangle_count)
            fail_msg("shape %zu: %.0f of %zu triangles face another way than their normals", i, off,
                     mesh.triangle_count);
        for (size_t n = 0; n < mesh.normal_count; n++) {
            double length = 0.0;
            for (int k = 0; k < 3; k++)
                length += (double)mesh.normals[n][k] * (double)mesh.normals[n][k];
            assert_true(fabs(length - 1.0) < 1e-5);
        }
        render_mesh_free(&mesh);
    }
}

/* Every edge of the ball belongs to two triangles, and the averaged normals are those of the
 * formula within half a quad of 2 pi / 96. */
static void smooth_normals_follow_the_shape(void **state)
{
    (void)state;
    render_mesh mesh = {0};
    const render_shape_options options = {.detail = 48};
    assert_int_equal(render_shape_mesh(RENDER_SUPERELLIPSOID, &options, &mesh), 0);
    assert_int_equal(render_mesh_smooth(&mesh), 0);
    for (size_t i = 0; i < mesh.position_count; i++) {
        double dot = 0.0;
        for (int k = 0; k < 3; k++)
            dot += (double)mesh.positions[i][k] * (double)mesh.normals[i][k];
        if (fabs((double)mesh.positions[i][1]) <
            0.99) /* the seam and the poles have vertices of their own */
            assert_true(dot > cos(2.0 * pi / 48));
    }
    render_mesh_free(&mesh);
}

static void mirrored_shapes_keep_their_outside(void **state)
{
    (void)state;
    render_mesh mesh = {0};
    const render_shape_options options = {.detail = 24};
    const render_transform mirror = {{{-2, 0, 0, 1}, {0, 1, 0, 2}, {0, 0.5, 3, 3}}};
    assert_int_equal(render_shape_mesh(RENDER_TORUS, &options, &mesh), 0);
    double before = volume_of(&mesh);
    render_mesh_transform(&mesh, &mirror);
    assert_true(fabs(volume_of(&mesh) / (6.0 * before) - 1.0) < 1e-5);
    for (size_t i = 0; i < mesh.triangle_count; i++)
        assert_true(agreement(&mesh, i) > 0.9);
    render_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_face_outwards_and_have_their_volume),
        cmocka_unit_test(smooth_normals_follow_the_shape),
        cmocka_unit_test(mirrored_shapes_keep_their_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
