/* test_render_shared.c: real environment maps. Skipped without the shared data: HNBRDF_DATA_DIR,
 * or the folder beside the checkout. */
#include "render/environment.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char *shared;

static hnbrdf_result open_map(const char *name, render_environment *environment,
                              hnbrdf_error *error)
{
    char path[600];
    snprintf(path, sizeof path, "%s/data/env/%s", shared, name);
    return render_environment_open(path, 0.0, NULL, environment, error);
}

static void radiance_maps_of_the_wild_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int width, height;
    } maps[] = {{"studio_small_03_1k.hdr", 1024, 512}, {"uffizi.hdr", 1200, 600}};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        render_environment environment;
        hnbrdf_error error;
        if (open_map(maps[i].name, &environment, &error) != HNBRDF_OK)
            fail_msg("%s", error.text);
        assert_int_equal(environment.width, maps[i].width);
        assert_int_equal(environment.height, maps[i].height);
        assert_true(render_environment_level(&environment) > 0.01);
        render_environment_free(&environment);
    }
}

/* Read where OpenEXR's C++ library is built in. */
static void dwab_maps_are_read_or_refused_with_advice(void **state)
{
    (void)state;
    static const char *const names[] = {"city.exr", "studio.exr", "sunset.exr"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        render_environment environment;
        hnbrdf_error error;
        const hnbrdf_result result = open_map(names[i], &environment, &error);
        if (result == HNBRDF_OK) {
            assert_int_equal(environment.width, 2 * environment.height);
            assert_true(render_environment_level(&environment) > 0.01);
            render_environment_free(&environment);
            continue;
        }
        assert_int_equal(result, HNBRDF_ERROR_UNSUPPORTED);
        assert_non_null(strstr(error.text, names[i]));
        assert_non_null(strstr(error.text, render_has_exr() ? "DWAB" : "without OpenEXR"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radiance_maps_of_the_wild_are_read),
        cmocka_unit_test(dwab_maps_are_read_or_refused_with_advice),
    };
    char path[600];
    const char *given = getenv("HNBRDF_DATA_DIR");
    shared = given && *given ? given : HNBRDF_SHARED_DEFAULT;
    snprintf(path, sizeof path, "%s/data/env/uffizi.hdr", shared);
    if (access(path, R_OK) != 0) {
        printf("skipped: no shared data in %s\n", shared);
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
