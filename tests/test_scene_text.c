/* test_scene_text.c: scenes as text: what each statement means, and messages with file and line. */
#include "scene/describe.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#define CAMERA "camera from 0 0 5 to 0 0 0 fov 40\n"

static render_description parse(const char *text)
{
    render_description description;
    hnbrdf_error error = {""};
    if (render_description_parse(text, strlen(text), "a.scene", &description, &error))
        fail_msg("%s", error.text);
    return description;
}

static void statements_mean_what_they_say(void **state)
{
    (void)state;
    render_description d = parse(
        "\xef\xbb\xbf# a comment\n\ncamera from 1 2 3 to 4 5 6 fov 40 up 0 0 1 lens 0.1 focus 7\r\n"
        "size 320 200\nexposure -1.5\nbounces 7\n"
        "environment \"a map.exr\" rotate 90 gain 2 hidden layer \"a b\" repair\n"
        "portal corner 1 2 3 edge 1 0 0 edge 0 1 0\n"
        "material a model m.safetensors \"b c\" # named\n"
        "material d ggx kd 0.1 0.2 0.3 eta 1.5 1.6 1.7 alpha 0.1 0.2\n"
        "material e diffuse 0.5 0.6 0.7\nmaterial f builtin rough-clay\n"
        "material g measured x.bsdf\n"
        "shape obj a.obj material a use leg d smooth emit 1 2 3\n"
        "shape lathe profile 0 0 1 0.5 0 1 detail 12 material e\n"
        "shape knot turns 3 5 tube 0.2\n");
    assert_true(d.camera.from[2] == 3.0f && d.camera.to[0] == 4.0f && d.camera.up[2] == 1.0f &&
                d.camera.lens == 0.1f && d.camera.focus == 7.0f && d.camera.width == 320);
    assert_true(d.exposure == -1.5 && d.bounces == 7 && d.rotate == 90.0 && d.gain == 2.0 &&
                d.hidden);
    assert_string_equal(d.environment, "a map.exr");
    assert_string_equal(d.environment_layer, "a b");
    assert_int_equal(d.environment_repair, 1);
    assert_int_equal(d.portal_count, 1);
    assert_int_equal(d.material_count, 5);
    assert_string_equal(d.materials[0].which, "b c");
    assert_true(d.materials[1].ggx.alpha[1] == 0.2f && d.materials[1].ggx.eta[2] == 1.7f);
    assert_true(d.materials[2].ggx.kd[0] == 0.5f && d.materials[2].source == RENDER_FROM_GGX);
    assert_int_equal(d.shape_count, 3);
    assert_true(d.shapes[0].smooth && d.shapes[0].uses[0].material == 1 &&
                d.shapes[0].emission[2] == 3.0f);
    assert_true(d.shapes[1].options.profile_count == 3 && d.shapes[1].material == 2);
    assert_true(d.shapes[2].options.turns[1] == 5.0 && d.shapes[2].material == -1);
    render_description_free(&d);
}

/* Scale, then turn, then move: (1, 0, 0) goes to (2, 0, 0), (0, 0, -2), (1, 1, -1). */
static void placing_goes_from_left_to_right(void **state)
{
    (void)state;
    static const double expected[] = {1.0, 1.0, -1.0};
    render_description d =
        parse(CAMERA "shape box scale 2 turn 90 move 1 1 1\n"
                     "shape box scale 2 rotate 0 3 0 90 move 1 1 1\n"
                     "shape box move 0.5 0 0 stretch 1 1 2 turn 90 move 1 1 0.5\n");
    for (int s = 0; s < 2; s++)
        for (int k = 0; k < 3; k++)
            assert_true(fabs(d.shapes[s].place.m[k][0] + d.shapes[s].place.m[k][3] - expected[k]) <
                        1e-12);
    static const double third[] = {1.0, 1.0, -1.0}; /* (1.5, 0, 0), (0, 0, -1.5), (1, 1, -1) */
    for (int k = 0; k < 3; k++)
        assert_true(fabs(d.shapes[2].place.m[k][0] + d.shapes[2].place.m[k][3] - third[k]) < 1e-12);
    render_description_free(&d);
}

static void refuses_with_file_and_line(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"", "no camera in 0 lines"},
        {"\xfe\xff", "a.scene: found UTF-16, expected UTF-8"},
        {CAMERA, "no shape in 1 lines"},
        {"shape box\n", "no camera"},
        {"lamp 1\n", "a.scene:1: found 'lamp', expected camera, size"},
        {"\n\ncamera from 0 0\n", "a.scene:3: from: found 'the end of the line'"},
        {"camera from 0 0 1 fov 40\n", "a camera needs"},
        {CAMERA CAMERA, "a.scene:2: a second camera"},
        {"camera from 0 0 1e7 to 0 0 0 fov 3\n", "expected a number from -1000000 to 1000000"},
        {"size 10\n", "height"},
        {"size 10.5 10\n", "a whole number"},
        {"size 10 10 10\n", "found '10', expected the end of the line"},
        {"environment\n", "environment: found 'the end of the line'"},
        {"environment sky turn 3\n",
         "found 'turn', expected rotate, gain, hidden, layer or repair"},
        {"environment sky\nenvironment sky\n",
         "a.scene:2: a second environment; the first is on line 1"},
        {"portal corner 0 0 0 edge 1 0 0\n", "expected edge X Y Z"},
        {"material a wood\n", "expected model, measured, builtin, ggx or diffuse"},
        {"material a diffuse 1 1\n", "diffuse: found 'the end of the line'"},
        {"material a diffuse 1 1 2\n", "expected a number from 0 to 1"},
        {"material a ggx eta 1 2 3\n", "eta: found '1'"},
        {"material a diffuse 0 0 0\nmaterial a diffuse 0 0 0\n",
         "a second material 'a'; the first is on line 1"},
        {"shape cone\n", "expected sphere, quad"},
        {"shape box material a\n", "no material 'a' above"},
        {"shape box tube 1\n", "expected a parameter of this kind"},
        {"shape box stretch 1 0 1\n", "stretch by 0"},
        {"shape box rotate 0 0 0 1\n", "an axis of length 0"},
        {"shape lathe profile 1 1\n", "2 points or more"},
        {"shape lathe profile -1 1\n", "radius of a profile"},
        {"shape obj\n", "obj: found 'the end of the line'"},
        {"shape obj a.obj use x\n", "use PART MATERIAL"},
        {"shape \"box\n", "a '\"' that is not closed"},
        {"shape box emit 1 nan 1\n", "found 'nan'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        render_description d = {.bounces = -1};
        hnbrdf_error error = {""};
        assert_int_not_equal(
            render_description_parse(cases[i][0], strlen(cases[i][0]), "a.scene", &d, &error),
            HNBRDF_OK);
        if (!strstr(error.text, cases[i][1]))
            fail_msg("'%s': '%s', expected '%s'", cases[i][0], error.text, cases[i][1]);
        assert_int_equal(d.bounces, -1); /* untouched */
    }
    hnbrdf_error error;
    render_description d;
    static char line[10000];
    memset(line, 'x', sizeof line);
    assert_int_not_equal(render_description_parse(line, sizeof line, "a", &d, &error), HNBRDF_OK);
    assert_non_null(strstr(error.text, "a:1: a line of more than"));
    assert_int_not_equal(render_description_parse("size\0 1", 7, "a", &d, &error), HNBRDF_OK);
    assert_non_null(strstr(error.text, "a:1: a NUL byte"));
}

/* What the files that a scene names do not hold, with the line that names them. */
static void loading_refuses_with_file_and_line(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {CAMERA "environment sky\nmaterial a model none.safetensors\nshape box\n",
         "dir/a.scene:3: dir/none.safetensors:"},
        {CAMERA "environment sky\nmaterial a builtin none\nshape box\n",
         "a.scene:3: no built-in material"},
        {CAMERA "environment sky\nmaterial a measured /none.bsdf\nshape box\n",
         "a.scene:3: /none.bsdf"},
        {CAMERA "environment sky\n\nshape obj none.obj\n",
         "a.scene:4: dir/none.obj: cannot be opened"},
        {CAMERA "environment sky\nshape sphere stretch 1 2 1\n", "a.scene:3: a stretched sphere"},
        {CAMERA "environment none.exr\nshape box\n", "a.scene:2: dir/none.exr"},
        {CAMERA "shape box\n", "a scene without light"},
        {"camera from 0 1 0 to 0 0 0 fov 40\nenvironment sky\nshape box\n",
         "along its up direction"},
        {CAMERA "environment sky\nportal corner 0 0 0 edge 1 0 0 edge 2 0 0\nshape box\n",
         "portal 1 has no area"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        render_description d;
        render_loaded loaded;
        hnbrdf_error error = {""};
        assert_int_equal(
            render_description_parse(cases[i][0], strlen(cases[i][0]), "dir/a.scene", &d, NULL),
            HNBRDF_OK);
        assert_int_not_equal(
            render_description_load(&d, RENDER_SHOW_MODEL, NULL, NULL, &loaded, &error), HNBRDF_OK);
        if (!strstr(error.text, cases[i][1]))
            fail_msg("case %zu: '%s', expected '%s'", i, error.text, cases[i][1]);
        render_description_free(&d);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statements_mean_what_they_say),
        cmocka_unit_test(placing_goes_from_left_to_right),
        cmocka_unit_test(refuses_with_file_and_line),
        cmocka_unit_test(loading_refuses_with_file_and_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
