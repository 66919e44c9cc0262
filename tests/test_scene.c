/* test_scene.c: path tracing against closed forms, against the sphere renderer, and against
 * itself. */
#include "scene_support.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Energy ---------------------------------------------------------------------------------- */

/* The six walls of a room from -1 to 1, facing inwards. */
#define ROOM(rest)                                               \
    "shape quad scale 2 move 0 -1 0 " rest "\n"                  \
    "shape quad scale 2 rotate 1 0 0 180 move 0 1 0 " rest "\n"  \
    "shape quad scale 2 rotate 1 0 0 90 move 0 0 -1 " rest "\n"  \
    "shape quad scale 2 rotate 1 0 0 -90 move 0 0 1 " rest "\n"  \
    "shape quad scale 2 rotate 0 0 1 -90 move -1 0 0 " rest "\n" \
    "shape quad scale 2 rotate 0 0 1 90 move 1 0 0 " rest "\n"

/* Every wall gives off 1 and reflects r: after N reflections radiance is the sum of r^k, k to N,
 * in all directions; without end 1/(1 - r). */
static void closed_diffuse_room_has_the_radiance_of_its_series(void **state)
{
    (void)state;
    test_need_embree();
    static const struct {
        int bounces;
        double expected;
    } cases[] = {{1, 1.5}, {2, 1.75}, {4, 1.9375}, {1024, 2.0}};
    render_loaded loaded;
    test_load("camera from 0.3 0.2 0.4 to -1 -0.4 -1 fov 90\nsize 20 20\n"
              "material wall diffuse 0.5 0.5 0.5\n" ROOM("material wall emit 1 1 1"),
              &loaded);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int strategy = RENDER_MIS; strategy <= RENDER_BRDF; strategy++) {
            test_estimate e = test_estimate_mean(&loaded.scene, (render_strategy)strategy,
                                                 cases[i].bounces, 32, RENDER_RADIANCE);
            assert_true(e.error < 0.02);
            /* Rays that start 2^-18 off a wall and the rounding of a sum of floats. */
            assert_true(fabs(e.mean - cases[i].expected) < 5.0 * e.error + 1e-5);
        }
    render_loaded_free(&loaded);
}

/* A white body in a white furnace cannot be seen, whatever its shape. Flat triangles: nothing is
 * lost to interpolated normals. */
static void white_knot_vanishes_in_a_furnace(void **state)
{
    (void)state;
    test_need_embree();
    render_loaded loaded;
    test_load("camera from 0 1 6 to 0 0 0 fov 35\nsize 32 32\nenvironment furnace\n"
              "material white diffuse 1 1 1\nshape knot detail 16 material white\n",
              &loaded);
    render_mesh *mesh = &loaded.scene.shapes[0].mesh;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        memset(mesh->triangles[i].normal, 0xff, sizeof mesh->triangles[i].normal);
    for (int strategy = RENDER_MIS; strategy <= RENDER_BRDF; strategy++) {
        test_estimate e = test_estimate_mean(&loaded.scene, (render_strategy)strategy, 1024, 64,
                                             RENDER_RADIANCE + 1);
        assert_true(e.error < 0.005);
        assert_true(fabs(e.mean - 1.0) < 5.0 * e.error + 1e-5);
    }
    render_loaded_free(&loaded);
}

/* What the GGX sphere sends back in a furnace is its albedo: never more than came, mesh or not. */
static void nothing_gives_off_more_than_it_gets(void **state)
{
    (void)state;
    test_need_embree();
    render_loaded loaded;
    test_load("camera from 0 1 6 to 0 0 0 fov 35\nsize 32 32\nenvironment furnace\n"
              "material m ggx kd 0 0 0 eta 30 30 30 alpha 0.2\n"
              "shape torus detail 12 material m rotate 1 0 0 50\n",
              &loaded);
    render_film film = test_render(&loaded.scene, RENDER_MIS, 1024, 64, 3, 0);
    for (int i = 0; i < 32 * 32;
         i++) /* F < 0.88 at normal incidence, 1 at grazing; noise of 64 samples */
        assert_true(film.sums[i][RENDER_RADIANCE] / 64 < 1.05);
    render_film_free(&film);
    render_loaded_free(&loaded);
}

/* ---- Against the sphere renderer ------------------------------------------------------------- */

/* The camera of sphere.c: 8 radii away, the sphere fills 1 / RENDER_FRAME of the picture. */
static void check_against_sphere(const char *shape, double geometry)
{
    char text[512];
    render_loaded loaded;
    double fov = 360.0 / 3.14159265358979323846 * atan(RENDER_FRAME / sqrt(63.0));
    snprintf(text, sizeof text,
             "camera from 0 0 8 to 0 0 0 fov %.9g\nsize 32 32\nenvironment sky\n"
             "material m ggx kd 0.3 0.2 0.1 eta 1.6 1.7 1.8 alpha 0.2 0.4\n%s\n",
             fov, shape);
    test_load(text, &loaded);
    const render_surface *surface = &loaded.scene.surfaces[0].surface;
    test_estimate e = {0.0, 0.0}, s = {0.0, 0.0};
    render_film film[2];
    render_image image[2];
    for (int k = 0; k < 2; k++) {
        const render_scene_options options = {
            .path = {.seed = 20 + (uint64_t)k, .bounces = 1, .transparent = 1}, .spp = 256};
        const render_options sphere = {.size = 32, .spp = 256, .seed = 20 + (uint64_t)k};
        int complete;
        assert_int_equal(render_film_create(32, 32, &film[k], NULL), HNBRDF_OK);
        assert_int_equal(render_scene_run(&loaded.scene, &options, &film[k], &complete, NULL),
                         HNBRDF_OK);
        assert_int_equal(render_sphere(surface, loaded.scene.environment, &sphere, &image[k], NULL),
                         HNBRDF_OK);
    }
    for (int i = 0; i < 32 * 32; i++) {
        double a = film[0].sums[i][RENDER_RADIANCE] / 256,
               b = film[1].sums[i][RENDER_RADIANCE] / 256;
        double c = (double)image[0].rgb[3 * i], d = (double)image[1].rgb[3 * i];
        e.mean += 0.5 * (a + b);
        e.error += 0.25 * (a - b) * (a - b);
        s.mean += 0.5 * (c + d);
        s.error += 0.25 * (c - d) * (c - d);
    }
    assert_true(sqrt(e.error) < 0.01 * e.mean);
    assert_true(fabs(e.mean - s.mean) < 5.0 * sqrt(e.error + s.error) + geometry * s.mean);
    for (int k = 0; k < 2; k++) {
        render_film_free(&film[k]);
        render_image_free(&image[k]);
    }
    render_loaded_free(&loaded);
}

static void sphere_equals_the_sphere_view(void **state)
{
    (void)state;
    test_need_embree();
    check_against_sphere("shape sphere material m", 0.0);
}

/* The outline of a polygon of 256 corners misses 2 pi^2 / (3 256^2) of the circle's area, 1e-4;
 * what interpolated normals lose is of the same order. */
static void sphere_mesh_equals_the_sphere_view(void **state)
{
    (void)state;
    test_need_embree();
    check_against_sphere("shape superellipsoid detail 128 material m", 5e-4);
}

/* ---- Strategies ------------------------------------------------------------------------------ */

/* A window to the sky, a lamp of triangles and a glowing ball: light and BRDF sampling alone, and
 * both joined, agree within 5 standard errors of the difference, whatever the number of
 * reflections. */
static void strategies_agree(void **state)
{
    (void)state;
    test_need_embree();
    render_loaded loaded;
    test_load("camera from 0 0.2 2.6 to 0 -0.1 0 fov 45\nsize 24 24\nenvironment sky gain 3\n"
              "portal corner -1 -1 1 edge 2 0 0 edge 0 2 0\n"
              "material wall diffuse 0.6 0.5 0.4\nmaterial shiny ggx kd 0.1 0.1 0.2 eta 2 2 2 "
              "alpha 0.35\n"
              "shape quad scale 2 move 0 -1 0 material wall\n"
              "shape quad scale 2 rotate 1 0 0 180 move 0 1 0 material wall\n"
              "shape quad scale 2 rotate 1 0 0 90 move 0 0 -1 material wall\n"
              "shape quad scale 2 rotate 0 0 1 -90 move -1 0 0 material wall\n"
              "shape quad scale 2 rotate 0 0 1 90 move 1 0 0 material wall\n"
              "shape torus scale 0.4 tube 0.4 move 0.3 -0.6 0 material shiny\n"
              "shape sphere scale 0.2 move -0.5 0.3 0 emit 4 3 2\n"
              "shape quad scale 0.8 rotate 1 0 0 180 move 0 0.95 0 emit 3 3 3\n",
              &loaded);
    for (int bounces = 1; bounces <= 4; bounces += 3) {
        test_estimate mis =
            test_estimate_mean(&loaded.scene, RENDER_MIS, bounces, 64, RENDER_RADIANCE);
        test_estimate light =
            test_estimate_mean(&loaded.scene, RENDER_LIGHT, bounces, 128, RENDER_RADIANCE);
        test_estimate brdf =
            test_estimate_mean(&loaded.scene, RENDER_BRDF, bounces, 256, RENDER_RADIANCE);
        assert_true(mis.error < 0.01 * mis.mean && light.error < 0.03 * mis.mean &&
                    brdf.error < 0.03 * mis.mean);
        assert_true(fabs(mis.mean - light.mean) < 5.0 * hypot(mis.error, light.error));
        assert_true(fabs(mis.mean - brdf.mean) < 5.0 * hypot(mis.error, brdf.error));
    }
    render_loaded_free(&loaded);
}

/* ---- Shading normals ------------------------------------------------------------------------- */

/* A room without a light in a bright environment, a coarse smooth ball in a corner through its
 * walls: not one sample finds light. */
static void nothing_leaks_through_walls(void **state)
{
    (void)state;
    test_need_embree();
    render_loaded loaded;
    test_load(
        "camera from 0.3 0.2 0.9 to 0 -0.4 0 fov 80\nsize 32 32\nenvironment furnace gain 1000\n"
        "material wall diffuse 0.5 0.5 0.5\nmaterial shiny ggx kd 0.2 0.2 0.2 eta 3 3 3 alpha "
        "0.3\n" ROOM("material wall") "shape superellipsoid detail 5 scale 0.6 move 0 -0.8 0 "
                                      "material shiny\n",
        &loaded);
    render_film film = test_render(&loaded.scene, RENDER_MIS, 8, 64, 1, 0);
    for (int i = 0; i < 32 * 32; i++)
        assert_true(film.sums[i][RENDER_RADIANCE] == 0.0 && film.sums[i][RENDER_COVERAGE] == 64.0);
    render_film_free(&film);
    render_loaded_free(&loaded);
}

/* The edge of a coarse ball with normals far from those of its triangles, in a furnace. Without
 * bent normals all light at the outline would be lost. What is lost with them is what a diffuse
 * lobe has below the horizon of a triangle: (1 - cos t)/2 for normals t apart, 0.1 for the 36
 * degrees of half a facet; of a narrow lobe, whose middle is kept above it, half. Noise: 6
 * standard errors of a sample that is 0 or 1, 6 sqrt(0.1 0.9 / 256) = 0.11. */
static void outlines_are_not_black(void **state)
{
    (void)state;
    test_need_embree();
    static const struct {
        const char *text;
        double albedo, lost;
    } materials[] = {{"diffuse 0.8 0.8 0.8", 0.8, 0.1},
                     {"ggx kd 0 0 0 eta 30 30 30 alpha 0.1", 0.86, 0.5}};
    for (int m = 0; m < 2; m++) {
        char text[512];
        render_loaded loaded;
        snprintf(text, sizeof text,
                 "camera from 0 1 6 to 0.9 0 0 fov 4\nsize 32 32\nenvironment furnace\n"
                 "material m %s\nshape superellipsoid detail 5 turn 10 material m\n",
                 materials[m].text);
        test_load(text, &loaded);
        render_film film = test_render(&loaded.scene, RENDER_MIS, 1, 256, 1, 0);
        int covered = 0;
        double least = 1.0, most = 0.0;
        for (int i = 0; i < 32 * 32; i++)
            if (film.sums[i][RENDER_COVERAGE] == 256.0) {
                double value = film.sums[i][RENDER_RADIANCE] / 256;
                covered++;
                least = fmin(least, value);
                most = fmax(most, value);
            }
        if (!(covered > 200 && least > materials[m].albedo * (1.0 - materials[m].lost) - 0.11 &&
              most < 1.11))
            fail_msg("%s: %d pixels, %.3f to %.3f", materials[m].text, covered, least, most);
        render_film_free(&film);
        render_loaded_free(&loaded);
    }
}

/* ---- Seeds, threads, interruptions ----------------------------------------------------------- */

static const char small_scene[] =
    "camera from 0 1 5 to 0 0.3 0 fov 35 lens 0.05\nsize 40 24\nenvironment sky\n"
    "material floor diffuse 0.5 0.5 0.5\nmaterial m builtin clear-coat-red\n"
    "shape quad scale 8 material floor\nshape teapot detail 12 scale 0.4 material m\n"
    "shape sphere scale 0.3 move -1.2 0.3 0 material m\nshape box scale 0.3 move 1.4 0.15 0 emit 2 "
    "2 "
    "2\n";

static void assert_same(const render_film *a, const render_film *b)
{
    assert_memory_equal(a->sums, b->sums, sizeof *a->sums * (size_t)(a->width * a->height));
    assert_memory_equal(a->samples, b->samples, sizeof *a->samples * (size_t)a->tiles);
}

static void picture_depends_on_the_seed_alone(void **state)
{
    (void)state;
    test_need_embree();
    render_loaded loaded;
    test_load(small_scene, &loaded);
    render_film one = test_render(&loaded.scene, RENDER_MIS, 6, 9, 7, 1);
    for (int threads = 2; threads <= 5; threads += 3) {
        render_film other = test_render(&loaded.scene, RENDER_MIS, 6, 9, 7, threads);
        assert_same(&one, &other);
        render_film_free(&other);
    }
    render_film different = test_render(&loaded.scene, RENDER_MIS, 6, 9, 8, 2);
    assert_memory_not_equal(one.sums, different.sums, sizeof *one.sums * 40 * 24);
    render_film_free(&different);
    render_film_free(&one);
    render_loaded_free(&loaded);
}

typedef struct stopper {
    int calls, stop_at;
} stopper;

static int stop(void *user, double share)
{
    stopper *s = user;
    assert_true(share >= 0.0 && share <= 1.0);
    return ++s->calls == s->stop_at;
}

/* Stopped after any number of tiles, gone on with from the file: the bits of one that was not. */
static void resumed_rendering_ends_with_the_same_bits(void **state)
{
    (void)state;
    test_need_embree();
    render_loaded loaded;
    char path[] = "/tmp/hnbrdf_scene_XXXXXX";
    close(mkstemp(path));
    test_load(small_scene, &loaded);
    render_film whole = test_render(&loaded.scene, RENDER_MIS, 6, 9, 7, 2);
    for (int stop_at = 1; stop_at <= 13; stop_at += 3) {
        stopper s = {0, stop_at};
        render_scene_options options = {.path = {.seed = 7, .bounces = 6},
                                        .spp = 9,
                                        .threads = 1,
                                        .state = path,
                                        .progress = stop,
                                        .progress_user = &s};
        int complete = 1, runs = 0;
        for (; runs == 0 || !complete; runs++, s.calls = 0, s.stop_at += 2) {
            render_film film;
            assert_int_equal(render_film_create(40, 24, &film, NULL), HNBRDF_OK);
            options.resume = runs > 0;
            assert_int_equal(render_scene_run(&loaded.scene, &options, &film, &complete, NULL),
                             HNBRDF_OK);
            if (complete)
                assert_same(&film, &whole);
            render_film_free(&film);
        }
        assert_true(runs > 1);
    }
    /* Other options are another picture. */
    render_film film;
    hnbrdf_error error;
    int complete;
    const render_scene_options other = {
        .path = {.seed = 8, .bounces = 6}, .spp = 9, .state = path, .resume = 1};
    assert_int_equal(render_film_create(40, 24, &film, NULL), HNBRDF_OK);
    assert_int_equal(render_scene_run(&loaded.scene, &other, &film, &complete, &error),
                     HNBRDF_ERROR_FORMAT);
    assert_non_null(strstr(error.text, "other options"));
    render_film_free(&film);
    render_film_free(&whole);
    render_loaded_free(&loaded);
    remove(path);
}

/* The first sums of a tile are there whatever the time is; each tile knows how many. */
static void time_budget_ends_a_rendering(void **state)
{
    (void)state;
    test_need_embree();
    render_loaded loaded;
    test_load(small_scene, &loaded);
    const render_scene_options options = {
        .path = {.seed = 7, .bounces = 6}, .spp = 1 << 20, .seconds = 0.3};
    render_film film;
    render_image image;
    int complete;
    assert_int_equal(render_film_create(40, 24, &film, NULL), HNBRDF_OK);
    assert_int_equal(render_scene_run(&loaded.scene, &options, &film, &complete, NULL), HNBRDF_OK);
    assert_false(complete);
    assert_int_equal(render_film_develop(&film, 1, &image, NULL), HNBRDF_OK);
    assert_int_equal(image.layer_count, 3);
    assert_string_equal(image.layers[2].name, "samples");
    assert_true(image.layers[2].rgb[0] == (float)film.samples[0] && film.samples[0] > 0);
    for (int i = 0; i < 3 * 40 * 24; i++)
        assert_true(isfinite(image.rgb[i]) && image.rgb[i] >= 0.0f);
    render_image_free(&image);
    render_film_free(&film);
    render_loaded_free(&loaded);
}

/* ---- Layers ---------------------------------------------------------------------------------- */

static void layers_show_albedo_and_normal(void **state)
{
    (void)state;
    test_need_embree();
    render_loaded loaded;
    test_load("camera from 0 3 0 to 0 0 0 up 0 0 -1 fov 20\nsize 8 8\nenvironment furnace\n"
              "material m diffuse 0.25 0.5 0.75\nshape quad scale 9 material m\n",
              &loaded);
    render_film film = test_render(&loaded.scene, RENDER_MIS, 1, 16, 1, 1);
    for (int i = 0; i < 64; i++) {
        const double *sums = film.sums[i];
        assert_true(fabs(sums[RENDER_NORMAL + 1] / 16 - 1.0) < 1e-6 &&
                    fabs(sums[RENDER_NORMAL]) < 1e-6);
        for (int k = 0; k < 3;
             k++) /* cosine sampling of a diffuse material: f cos / pdf is nearly kd */
            assert_true(fabs(sums[RENDER_ALBEDO + k] / 16 - 0.25 * (k + 1)) < 0.03);
    }
    render_film_free(&film);
    render_loaded_free(&loaded);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_diffuse_room_has_the_radiance_of_its_series),
        cmocka_unit_test(white_knot_vanishes_in_a_furnace),
        cmocka_unit_test(nothing_gives_off_more_than_it_gets),
        cmocka_unit_test(sphere_equals_the_sphere_view),
        cmocka_unit_test(sphere_mesh_equals_the_sphere_view),
        cmocka_unit_test(strategies_agree),
        cmocka_unit_test(nothing_leaks_through_walls),
        cmocka_unit_test(outlines_are_not_black),
        cmocka_unit_test(picture_depends_on_the_seed_alone),
        cmocka_unit_test(resumed_rendering_ends_with_the_same_bits),
        cmocka_unit_test(time_budget_ends_a_rendering),
        cmocka_unit_test(layers_show_albedo_and_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
