/* test_obj.c: OBJ files of any origin: what is read, noted and refused. */
#include "scene/obj.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

typedef struct told {
    char text[2048]; /* lines */
} told;

static void keep(void *user, const char *text)
{
    told *all = user;
    const size_t length = strlen(all->text);
    snprintf(all->text + length, sizeof all->text - length, "%s\n", text);
}

/* What is told must be exactly `notes`. */
static render_mesh read_told(const char *text, const char *notes, render_transform *place)
{
    render_mesh mesh;
    told all = {""};
    hnbrdf_error error = {""};
    const render_obj_options options = {.notes = {keep, &all}};
    if (render_obj_decode(text, strlen(text), "a.obj", &options, &mesh, place, &error))
        fail_msg("'%s': %s", text, error.text);
    assert_string_equal(all.text, notes);
    return mesh;
}

static render_mesh read_obj(const char *text)
{
    return read_told(text, "", NULL);
}

/* ---- What is read ---------------------------------------------------------------------------- */

static void reads_all_forms_of_corners(void **state)
{
    (void)state;
    render_mesh mesh = read_told(
        "v 0 0 0\r\nv 1 0 0 1.0\nv 0 1 0 0.5 0.5 0.5 # a colour\nvt 0.25 0.5\nvt 1 0 0\nvt 0.5\n"
        "vn 0 0 2\nvn 0 3 4\n\n# comment\nmtllib x.mtl\ns 1\n"
        "f 1 2 3\nf 1/1 2/2 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/2/2 3/1/1\n"
        "f -3/-3/-2 -2/-2/-1 -1/-3/-2\nf 1 2 \\\n 3\nf 1/ 2/ 3/\nfo 1 2 3\n",
        "a.obj:13: a face without normals, which others have (5 faces): drawn with the normals of "
        "their planes\na.obj:13: a face without texture coordinates, which others have (5 faces): "
        "drawn without\n",
        NULL);
    assert_int_equal(mesh.triangle_count, 8);
    assert_int_equal(mesh.part_count, 1);
    for (int i = 0; i < 8; i++)
        for (uint32_t k = 0; k < 3; k++)
            assert_int_equal(mesh.triangles[i].position[k], k);
    assert_true(mesh.triangles[0].uv[0] == RENDER_NONE &&
                mesh.triangles[0].normal[2] == RENDER_NONE);
    assert_true(mesh.triangles[1].uv[1] == 1 && mesh.triangles[1].normal[0] == RENDER_NONE);
    assert_true(mesh.triangles[2].uv[1] == RENDER_NONE && mesh.triangles[2].normal[0] == 0);
    for (int i = 3; i < 5; i++)
        assert_true(mesh.triangles[i].uv[1] == 1 && mesh.triangles[i].normal[1] == 1);
    assert_true(mesh.uvs[0][0] == 0.25f && mesh.uvs[2][0] == 0.5f && mesh.uvs[2][1] == 0.0f);
    assert_true(mesh.normals[0][2] == 1.0f && mesh.normals[1][1] == 0.6f);
    render_mesh_free(&mesh);
}

/* The last usemtl names a part; before any, g and o do. */
static void parts_are_named_by_usemtl_or_group(void **state)
{
    (void)state;
    render_mesh mesh = read_obj(TRIANGLE "o body\nf 1 2 3\ng lid a\nf 1 2 3\nusemtl Gold#1 x \n"
                                         "f 1 2 3\ng spout\nf 1 2 3\nusemtl body\nf 1 2 3\n");
    static const char *const expected[] = {"body", "lid a", "Gold#1 x", "Gold#1 x", "body"};
    for (int i = 0; i < 5; i++)
        assert_string_equal(mesh.parts[mesh.triangles[i].part].name, expected[i]);
    render_mesh_free(&mesh);
}

static void there_may_be_any_number_of_groups(void **state)
{
    (void)state;
    enum { GROUPS = 20000 };
    char *text = malloc(64 + 32 * GROUPS * 2), name[16];
    assert_non_null(text);
    int at = sprintf(text, TRIANGLE);
    for (int i = 0; i < 2 * GROUPS; i++)
        at += sprintf(text + at, "g part%d\nf 1 2 3\n", i % GROUPS);
    render_mesh mesh = read_obj(text);
    assert_int_equal(mesh.part_count, GROUPS + 1); /* and the one before any */
    for (int i = 0; i < 2 * GROUPS; i++) {
        sprintf(name, "part%d", i % GROUPS);
        assert_string_equal(mesh.parts[mesh.triangles[i].part].name, name);
    }
    render_mesh_free(&mesh);
    free(text);
}

static void a_byte_order_mark_is_no_letter(void **state)
{
    (void)state;
    render_mesh mesh = read_obj("\xef\xbb\xbf" TRIANGLE "v 5 5 5\nf 1 2 3\n");
    assert_int_equal(mesh.position_count, 3);
    assert_true(mesh.positions[1][0] == 1.0f && mesh.positions[2][1] == 1.0f);
    render_mesh_free(&mesh);
}

/* LF, CR LF, and CR alone; the number of a line is that of an editor. */
static void lines_end_as_on_any_system(void **state)
{
    (void)state;
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    for (int i = 0; i < 3; i++) {
        char text[128];
        sprintf(text, "v 0 0 0%sv 1 0 0%s%sv 0 1 \\%s0%sf 1 2%s f 1 2 3", ends[i], ends[i], ends[i],
                ends[i], ends[i], ends[i]);
        render_mesh mesh =
            read_told(text, "a.obj:6: a face of fewer than 3 corners (1 face): skipped\n", NULL);
        assert_int_equal(mesh.triangle_count, 1);
        render_mesh_free(&mesh);
    }
}

/* Indices from the front count through the whole file, those from the back from their line. */
static void faces_may_come_first(void **state)
{
    (void)state;
    render_mesh mesh = read_obj("vn 0 0 1\nf 1//2 2//2 3//2\n" TRIANGLE "f -3//-1 -2//-1 -1//-1\n"
                                "vn 0 1 0\n");
    assert_int_equal(mesh.triangle_count, 2);
    assert_int_equal(mesh.triangles[0].normal[0], 1);
    assert_int_equal(mesh.triangles[1].normal[0], 0);
    assert_memory_equal(mesh.triangles[0].position, mesh.triangles[1].position,
                        sizeof mesh.triangles[0].position);
    render_mesh_free(&mesh);
}

/* A concave face, a hole, a corner given twice: triangles without area are left out. */
static void faces_are_split(void **state)
{
    (void)state;
    render_mesh mesh = read_obj("v -3 -2 0\nv 3 -2 0\nv 0 3 0\nv -1 -1 0\nv 0 1 0\nv 1 -1 0\n"
                                "f 1 2 3 1 4 5 6 4\nf 1 2 2 3\n");
    assert_int_equal(mesh.triangle_count, 7);
    render_mesh_free(&mesh);
}

/* ---- Where it is ----------------------------------------------------------------------------- */

static int is_identity(const render_transform *place)
{
    return memcmp(place, &render_identity, sizeof *place) == 0;
}

/* Near 1 in size and place nothing is changed, and vertices that no triangle uses are left out. */
static void ordinary_vertices_stay(void **state)
{
    (void)state;
    render_transform place;
    render_mesh mesh = read_told("v 1e18 0 0\nv -1 -1 0\nv 1 -1 0\nv 7 7 7\nv 0 1 0.1\nf 2 3 5\n"
                                 "f 2 3 4 3\n",
                                 "", &place);
    assert_int_equal(mesh.position_count, 3);
    assert_true(mesh.positions[0][0] == -1.0f && mesh.positions[2][2] == 0.1f);
    assert_true(is_identity(&place));
    render_mesh_free(&mesh);
    mesh = read_told("v 10 10 0\nv 11 10 0\nv 10 11 0\nv 9 9 9\nf 1 2 3\nf 2 2 4\n", "", &place);
    assert_int_equal(mesh.position_count, 3);
    assert_true(mesh.positions[2][1] == 11.0f && is_identity(&place));
    render_mesh_free(&mesh);
}

/* However far, large or small: the mesh is about 1 in size, near the origin, and in its place off
 * by no more than the rounding of single precision there. */
static void other_vertices_are_moved_and_scaled(void **state)
{
    (void)state;
    static const struct {
        double at, size;
    } cases[] = {{4e6, 1.0},  {-3e8, 0.01}, {0.0, 1e10},  {0.0, 1e-12}, {1e18, 1e18},
                 {0.0, 1e30}, {5e29, 1e20}, {0.0, 1e-60}, {1.0, 1e-9},  {-1e-20, 1e-30}};
    static const double corners[4][3] = {{0, 0, 0}, {1, 0.3, 0}, {0.1, 1, 0}, {0.2, 0.3, 0.9}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        char text[1024];
        double expected[4][3];
        int at = 0;
        for (int i = 0; i < 4; i++) {
            for (int k = 0; k < 3; k++)
                expected[i][k] = cases[c].at + cases[c].size * corners[i][k];
            at += sprintf(text + at, "v %.17g %.17g %.17g\n", expected[i][0], expected[i][1],
                          expected[i][2]);
        }
        sprintf(text + at, "f 1 2 3\nf 1 2 4\n");
        render_transform place;
        render_mesh mesh = read_told(text, "", &place);
        assert_int_equal(mesh.triangle_count, 2);
        const double room = fabs(cases[c].at) > 16.0 * cases[c].size ? 1.0 : 18.0;
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 3; k++) {
                const double x = (double)mesh.positions[i][k];
                assert_true(fabs(x) <= 2.0 * room);
                const double back = place.m[k][k] * x + place.m[k][3];
                /* the float's half ulp, and what double precision loses where it is */
                assert_true(fabs(back - expected[i][k]) <=
                            0x1p-24 * 2.0 * room * cases[c].size + 0x1p-51 * fabs(cases[c].at));
            }
        render_mesh_free(&mesh);
    }
}

/* ---- What is noted --------------------------------------------------------------------------- */

static void what_is_left_aside_is_noted_once(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {TRIANGLE "f 1//1 2//2 3//3\nf 1//1 2//2 3//3\n",
         "a.obj:4: normal '1' of a face is not in the file (2 faces): drawn with the normals of "
         "their planes\n"},
        {TRIANGLE "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 2/2 3/4\nf 1/-4 2/2 3/3\n",
         "a.obj:8: texture coordinate '4' of a face is not in the file (2 faces): drawn without\n"},
        {TRIANGLE "vn 0 0 1\nf 1//1 2//1 3//1\nf 1 2 3\nf 1//1 2//1 3\n",
         "a.obj:6: a face without normals, which others have (2 faces): drawn with the normals of "
         "their planes\n"},
        {TRIANGLE "vt 0 0\nf 1/1 2/1 3/1\nf 1 2 3\n",
         "a.obj:6: a face without texture coordinates, which others have (1 face): drawn "
         "without\n"},
        {TRIANGLE "vt nan 0\nvt 0 -nan(ind)\nvt 1.#QNAN 1\nvt 0 inf\nvt 1e31 0\nf 1/1 2/2 3/3\n",
         "a.obj:4: vt: found 'nan 0', expected finite numbers (5 lines): faces with it are drawn "
         "without texture coordinates\n"},
        {TRIANGLE "vn 0 0 1\nvn 0 0 0\nvn NaN 0 1\nf 1//1 2//2 3//3\nf 1//1 2//1 3//1\n",
         "a.obj:5: vn: found '0 0 0', expected a direction (2 lines): faces with it are drawn with "
         "the normals of their planes\n"},
        {TRIANGLE "f 1 2 3\nf 1 2\nf 1\nf\n",
         "a.obj:5: a face of fewer than 3 corners (3 faces): skipped\n"},
        {TRIANGLE "l 1 2\np 1\nf 1 2 3\n",
         "a.obj:4: 'l': lines and points are no surface (2 statements): not drawn\n"},
        {TRIANGLE "cstype bezier\ncurv 0 1 1 2\nsurf 0 1 0 1 1 2 3\nend\nf 1 2 3\n",
         "a.obj:5: 'curv': curves and free-form surfaces are not read (2 statements): not drawn\n"},
        {TRIANGLE "F 1 2 3\nwhat\nf 1 2 3\n",
         "a.obj:4: 'F' is no statement of OBJ files (2 lines): passed over\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        render_mesh mesh = read_told(cases[i][0], cases[i][1], NULL);
        render_mesh_free(&mesh);
    }
}

/* Where a corner has none, the whole triangle has none. */
static void what_is_no_number_is_not_used(void **state)
{
    (void)state;
    render_mesh mesh;
    const char text[] = TRIANGLE "vt 0 nan\nvt 1 0\nvn 0 0 0\nvn 0 0 1\n"
                                 "f 1/1/1 2/2/2 3/2/2\nf 1/2/2 2/2/2 3/2/2\nf 1/9/9 2/2/2 3/2/2\n";
    assert_int_equal(render_obj_decode(text, strlen(text), "a.obj", NULL, &mesh, NULL, NULL),
                     HNBRDF_OK);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            assert_int_equal(mesh.triangles[i].uv[k], i == 1 ? 1 : RENDER_NONE);
            assert_int_equal(mesh.triangles[i].normal[k], i == 1 ? 1 : RENDER_NONE);
        }
    render_mesh_free(&mesh);
}

/* Normals that are averaged need none in the file. */
static void smooth_meshes_lack_no_normals(void **state)
{
    (void)state;
    render_mesh mesh;
    told all = {""};
    const char text[] = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nvn 0 0 0\nvn 0 0 1\n"
                        "f 1//2 3//2 2//2\nf 1 2 4\nf 1//9 4//1 3//1\n";
    const render_obj_options options = {.smooth = 1, .notes = {keep, &all}};
    assert_int_equal(render_obj_decode(text, strlen(text), "a.obj", &options, &mesh, NULL, NULL),
                     HNBRDF_OK);
    assert_string_equal(all.text, "");
    assert_int_equal(mesh.normal_count, 4);
    for (int k = 0; k < 3; k++) /* at the corner of a cube: all angles are alike */
        assert_true(fabs((double)mesh.normals[mesh.triangles[1].normal[0]][k] + sqrt(1.0 / 3.0)) <
                    1e-6);
    render_mesh_free(&mesh);
}

/* ---- What is refused ------------------------------------------------------------------------- */

/* Messages name file, line, what was found and what was expected. */
static void refuses_with_file_and_line(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"", "no face"},
        {"v 0 0 0\n", "a.obj: no face in 1 lines"},
        {"\xff\xfev", "a.obj: found UTF-16, expected UTF-8"},
        {"v 0 0\n", "a.obj:1: v: found ''"},
        {"v 0 0 nan\n", "a.obj:1: v: found '0 0 nan', expected 3 finite numbers"},
        {"v 0 -Infinity 0\n", "a.obj:1: v: found '0 -Infinity 0'"},
        {"v 0 0 1e31\n", "expected 3 finite numbers"},
        {"v 0 0 0x\n", "found '0x'"},
        {"\nvt\n", "a.obj:2: vt: found '', expected 1 finite"},
        {"\nvt 1 b\n", "a.obj:2: vt: found 'b'"},
        {"vn 1 2 a\n", "a.obj:1: vn"},
        {"vn 1 2\n", "a.obj:1: vn"},
        {"v 0 0 0\nf 1 1\n", "a.obj: no face of 3 corners or more"},
        {"v 0 0 0\nf 1 1 2\n", "a.obj:2: vertex '2' of a face: expected 1 to 1, or -1 to -1"},
        {"v 0 0 0\nf 1 1 0\n", "vertex '0'"},
        {"v 0 0 0\nf 1 1 -2\n", "vertex '-2'"},
        {"f 1 1 -1\nv 0 0 0\n", "vertex '-1' of a face: expected 1 to 1"},
        {"f 1 2 3\n", "vertex '1' of a face: expected a vertex, but there is none"},
        {"v 0 0 0\nf 1 1 99999999999999999999\n", "expected 1 to 1, or -1 to -1"},
        {"v 0 0 0\nf 1 1 x\n", "vertex 'x' of a face: expected a whole number"},
        {"v 0 0 0\nf 1/x 1 1\n", "texture coordinate 'x 1 1' of a face"},
        {"v 0 0 0\nvn 0 0 1\nf 1//1/ 1 1\n", "not v, v/t, v//n or v/t/n"},
        {"v 0 0 0\nf 1,1,1\n", "not v, v/t"},
        {"v 1 2 3\nf 1 1 1\nf -1 -1 -1\n", "a.obj: its 2 faces have no area"},
        {"v 0 0 0\nv 1 2 3\nv 2 4 6\nf 1 2 3\n", "a.obj: its 1 face has no area"},
        {"v 0 0 0\nv 0.1 0.2 0.3\nv 0.3 0.6 0.9\nf 1 2 3\n",
         "a line or a point: expected a surface"},
        {"v 0 0 0\nv 1 0 0\nv 1 1e-9 0\nf 1 2 3\n", "a line or a point: expected a surface"},
        {"v 1 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\n", "a line or a point: expected a surface"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        render_mesh mesh = {0};
        hnbrdf_error error = {""};
        assert_int_not_equal(
            render_obj_decode(cases[i][0], strlen(cases[i][0]), "a.obj", NULL, &mesh, NULL, &error),
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
    const render_obj_options one = {.max_triangles = 1}, two = {.max_triangles = 2};
    render_mesh mesh;
    hnbrdf_error error;
    assert_int_equal(render_obj_decode(text, strlen(text), "a", &one, &mesh, NULL, &error),
                     HNBRDF_ERROR_LIMIT);
    assert_non_null(strstr(error.text, "a:5: expected at most 1 triangles"));
    assert_int_equal(render_obj_decode(text, strlen(text), "a", &two, &mesh, NULL, &error),
                     HNBRDF_OK);
    render_mesh_free(&mesh);
    assert_int_equal(render_obj_read("/nonexistent/a.obj", NULL, &mesh, NULL, &error),
                     HNBRDF_ERROR_IO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_all_forms_of_corners),
        cmocka_unit_test(parts_are_named_by_usemtl_or_group),
        cmocka_unit_test(there_may_be_any_number_of_groups),
        cmocka_unit_test(a_byte_order_mark_is_no_letter),
        cmocka_unit_test(lines_end_as_on_any_system),
        cmocka_unit_test(faces_may_come_first),
        cmocka_unit_test(faces_are_split),
        cmocka_unit_test(ordinary_vertices_stay),
        cmocka_unit_test(other_vertices_are_moved_and_scaled),
        cmocka_unit_test(what_is_left_aside_is_noted_once),
        cmocka_unit_test(what_is_no_number_is_not_used),
        cmocka_unit_test(smooth_meshes_lack_no_normals),
        cmocka_unit_test(refuses_with_file_and_line),
        cmocka_unit_test(limits_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
