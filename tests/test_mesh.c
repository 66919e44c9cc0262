/* test_mesh.c: OBJ files of any origin, polygons, shapes from formulas, transforms. */
#include "scene/shapes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

/* ---- OBJ files ------------------------------------------------------------------------------- */

static render_mesh read_obj(const char *text)
{
    render_mesh mesh;
    hnbrdf_error error = {""};
    if (render_obj_decode(text, strlen(text), "a.obj", NULL, &mesh, &error))
        fail_msg("%s", error.text);
    return mesh;
}

static void reads_all_forms_of_corners(void **state)
{
    (void)state;
    render_mesh mesh =
        read_obj("v 0 0 0\r\nv 1 0 0 1.0\nv 0 1 0 0.5 0.5 0.5 # a colour\nvt 0.25 0.5\nvt 1 0 0\n"
                 "vn 0 0 2\nvn 0 0 0\n\n# comment\nmtllib x.mtl\ns 1\n"
                 "f 1 2 3\nf 1/1 2/2 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/2/2 3/1/1\n"
                 "f -3/-2/-2 -2/-1/-1 -1/-2/-2\nf 1 2 \\\n 3\nf 1/ 2/ 3/\n");
    assert_int_equal(mesh.triangle_count, 7);
    assert_int_equal(mesh.part_count, 1);
    for (int i = 0; i < 7; i++)
        for (uint32_t k = 0; k < 3; k++)
            assert_int_equal(mesh.triangles[i].position[k], k);
    assert_true(mesh.triangles[0].uv[0] == RENDER_NONE &&
                mesh.triangles[0].normal[2] == RENDER_NONE);
    assert_true(mesh.triangles[1].uv[1] == 1 && mesh.triangles[1].normal[0] == RENDER_NONE);
    assert_true(mesh.triangles[2].uv[1] == RENDER_NONE && mesh.triangles[2].normal[0] == 0);
    for (int i = 3; i < 5; i++)
        assert_true(mesh.triangles[i].uv[1] == 1 && mesh.triangles[i].normal[1] == 1);
    assert_true(mesh.uvs[0][0] == 0.25f && mesh.normals[0][2] == 1.0f &&
                mesh.normals[1][2] == 1.0f);
    render_mesh_free(&mesh);
}

/* The last usemtl names a part; before any, g and o do. */
static void parts_are_named_by_usemtl_or_group(void **state)
{
    (void)state;
    render_mesh mesh =
        read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\no body\nf 1 2 3\ng lid a\nf 1 2 3\nusemtl Gold#1 x \n"
                 "f 1 2 3\ng spout\nf 1 2 3\nusemtl body\nf 1 2 3\n");
    static const char *const expected[] = {"body", "lid a", "Gold#1 x", "Gold#1 x", "body"};
    for (int i = 0; i < 5; i++)
        assert_string_equal(mesh.parts[mesh.triangles[i].part].name, expected[i]);
    render_mesh_free(&mesh);
}

/* Messages name file, line, what was found and what was expected. */
static void refuses_with_file_and_line(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"", "no face"},
        {"v 0 0 0\n", "no face in 1 lines"},
        {"v 0 0\n", "a.obj:1: v: found ''"},
        {"v 0 0 nan\n", "a.obj:1: v: found 'nan'"},
        {"v 0 0 1e31\n", "expected 3 finite numbers"},
        {"v 0 0 0x\n", "found '0x'"},
        {"\nvt 1\n", "a.obj:2: vt"},
        {"vn 1 2 a\n", "a.obj:1: vn"},
        {"v 0 0 0\nf 1 1\n", "a.obj:2: a face of 2 corners"},
        {"v 0 0 0\nf 1 1 2\n", "a.obj:2: vertex '2"},
        {"v 0 0 0\nf 1 1 0\n", "vertex '0"},
        {"v 0 0 0\nf 1 1 -2\n", "vertex '-2"},
        {"v 0 0 0\nf 1 1 99999999999999999999\n", "expected 1 to 1, or -1 to -1"},
        {"v 0 0 0\nf 1/1 1/1 1/1\n", "texture coordinate '1"},
        {"v 0 0 0\nf 1//1 1//1 1//1\n", "normal '1"},
        {"v 0 0 0\nvn 0 0 1\nf 1//1/ 1 1\n", "not v, v/t, v//n or v/t/n"},
        {"v 0 0 0\nf 1,1,1\n", "not v, v/t"},
        {"v 0 0 0\nf 1 1 \\\n\n\nf x\n", "a.obj:2: a face of 2"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        render_mesh mesh = {0};
        hnbrdf_error error = {""};
        assert_int_not_equal(
            render_obj_decode(cases[i][0], strlen(cases[i][0]), "a.obj", NULL, &mesh, &error),
            HNBRDF_OK);
        if (!strstr(error.text, cases[i][1]))
            fail_msg("'%s': '%s', expected '%s'", cases[i][0], error.text, cases[i][1]);
        assert_null(mesh.triangles);
    }
}

static void limits_hold(void **state)
{
    (void)state;
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    const render_obj_limits one = {.max_triangles = 1}, two = {.max_triangles = 2};
    render_mesh mesh;
    hnbrdf_error error;
    assert_int_equal(render_obj_decode(text, strlen(text), "a", &one, &mesh, &error),
                     HNBRDF_ERROR_LIMIT);
    assert_non_null(strstr(error.text, "a:5: expected at most 1 triangles"));
    assert_int_equal(render_obj_decode(text, strlen(text), "a", &two, &mesh, &error), HNBRDF_OK);
    render_mesh_free(&mesh);
    assert_int_equal(render_obj_read("/nonexistent/a.obj", NULL, &mesh, &error), HNBRDF_ERROR_IO);
}

/* ---- Polygons -------------------------------------------------------------------------------- */

static double area_of(const float (*p)[3], const uint32_t t[3])
{
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)p[t[1]][k] - (double)p[t[0]][k];
        b[k] = (double)p[t[2]][k] - (double)p[t[0]][k];
    }
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2],
           z = a[0] * b[1] - a[1] * b[0];
    return 0.5 * sqrt(x * x + y * y + z * z) * (y > 0.0 ? -1.0 : 1.0);
}

/* A star of any number of points in the plane y = 2, seen from below or above: its triangles have
 * the star's area, and none is turned over: all signs are alike. */
static void concave_polygons_are_covered_once(void **state)
{
    (void)state;
    static float p[RENDER_MAX_CONCAVE + 2][3];
    static uint32_t t[RENDER_MAX_CONCAVE + 2][3];
    for (int turn = -1; turn <= 1; turn += 2)
        for (uint32_t count = 6; count <= RENDER_MAX_CONCAVE; count += 10) {
            for (uint32_t i = 0; i < count; i++) {
                double angle = turn * 2.0 * pi * i / count, radius = i % 2 ? 0.4 : 1.0;
                p[i][0] = (float)(radius * cos(angle));
                p[i][1] = 2.0f;
                p[i][2] = (float)(radius * sin(angle));
            }
            assert_int_equal(render_polygon_split((const float(*)[3])p, count, t), 0);
            double sum = 0.0, expected = 0.5 * 0.4 * sin(2.0 * pi / count) * count;
            for (uint32_t i = 0; i + 2 < count; i++) {
                double area = area_of((const float(*)[3])p, t[i]) * turn;
                assert_true(area >= 0.0);
                sum += area;
            }
            assert_true(fabs(sum - expected) < 1e-5);
        }
    assert_int_equal(render_polygon_split((const float(*)[3])p, RENDER_MAX_CONCAVE + 2, t), -1);
}

/* Convex ones may have any number of corners, and all sorts of nonsense ends. */
static void any_polygon_ends(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    static float p[COUNT][3];
    static uint32_t t[COUNT][3];
    for (int i = 0; i < COUNT; i++) {
        p[i][0] = (float)cos(2.0 * pi * i / COUNT);
        p[i][2] = (float)sin(2.0 * pi * i / COUNT);
    }
    assert_int_equal(render_polygon_split((const float(*)[3])p, 64, t), 0);
    memset(p, 0, sizeof p);
    assert_int_equal(render_polygon_split((const float(*)[3])p, 100, t), 0);
    for (int i = 0; i < 100; i++)
        for (int k = 0; k < 3; k++)
            p[i][k] = (float)((i * 7919 + k * 104729) % 101);
    assert_int_equal(render_polygon_split((const float(*)[3])p, 100, t), 0);
    for (int i = 0; i < 98; i++)
        for (int k = 0; k < 3; k++)
            assert_true(t[i][k] < 100);
}

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
        cmocka_unit_test(reads_all_forms_of_corners),
        cmocka_unit_test(parts_are_named_by_usemtl_or_group),
        cmocka_unit_test(refuses_with_file_and_line),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(concave_polygons_are_covered_once),
        cmocka_unit_test(any_polygon_ends),
        cmocka_unit_test(shapes_face_outwards_and_have_their_volume),
        cmocka_unit_test(smooth_normals_follow_the_shape),
        cmocka_unit_test(mirrored_shapes_keep_their_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
