/* scene_support.h: what the tests of scenes share: scenes from text, pictures, their means. */
#ifndef HNBRDF_TESTS_SCENE_SUPPORT_H
#define HNBRDF_TESTS_SCENE_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/describe.h"
#include "scene/film.h"

/* Skips the test where there is no Embree. */
void test_need_embree(void);
/* A scene from text; fails the test with the reader's message. */
void test_load(const char *text, render_loaded *loaded);
/* All samples of a picture. */
render_film test_render(const render_scene *scene, render_strategy strategy, int bounces, int spp,
                        uint64_t seed, int threads);

/* Mean of a sum over all pixels and its standard error, from two pictures with independent seeds:
 * pixels are independent of each other. */
typedef struct test_estimate {
    double mean, error;
} test_estimate;
test_estimate test_estimate_mean(const render_scene *scene, render_strategy strategy, int bounces,
                                 int spp, int channel);

#endif
