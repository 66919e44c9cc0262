/* scene_support.c: scenes from text, pictures, their means. */
#include "scene_support.h"

#include <math.h>
#include <string.h>

void test_need_embree(void)
{
    if (!render_has_embree())
        skip();
}

void test_load(const char *text, render_loaded *loaded)
{
    render_description description;
    hnbrdf_error error = {""};
    if (render_description_parse(text, strlen(text), "test.scene", &description, &error) ||
        render_description_load(&description, RENDER_SHOW_MODEL, NULL, NULL, loaded, &error))
        fail_msg("%s", error.text);
    render_description_free(&description);
}

render_film test_render(const render_scene *scene, render_strategy strategy, int bounces, int spp,
                        uint64_t seed, int threads)
{
    render_film film;
    int complete;
    const render_scene_options options = {
        .path = {.seed = seed, .bounces = bounces, .strategy = strategy},
        .spp = spp,
        .threads = threads};
    assert_int_equal(render_film_create(scene->camera.width, scene->camera.height, &film, NULL),
                     HNBRDF_OK);
    assert_int_equal(render_scene_run(scene, &options, &film, &complete, NULL), HNBRDF_OK);
    assert_true(complete);
    return film;
}

test_estimate test_estimate_mean(const render_scene *scene, render_strategy strategy, int bounces,
                                 int spp, int channel)
{
    render_film a = test_render(scene, strategy, bounces, spp, 11, 0);
    render_film b = test_render(scene, strategy, bounces, spp, 12, 0);
    double sum = 0.0, squares = 0.0;
    size_t pixels = (size_t)a.width * (size_t)a.height;
    for (size_t i = 0; i < pixels; i++) {
        double va = a.sums[i][channel] / spp, vb = b.sums[i][channel] / spp;
        sum += 0.5 * (va + vb);
        squares += 0.25 * (va - vb) * (va - vb);
    }
    render_film_free(&a);
    render_film_free(&b);
    return (test_estimate){sum / (double)pixels, sqrt(squares) / (double)pixels};
}
