/* test_fit_axis.c: the direction of an anisotropic material is found where its highlight has none,
 * and its GGX part lies along it, its x where the lobe is narrower. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fit/axis.h"
#include "hnbrdf/fit.h"

#include <math.h>
#include <string.h>

static hnbrdf_measured *open_builtin(const char *name)
{
    hnbrdf_measured *measured = NULL;
    int index = 0;
    while (strcmp(hnbrdf_measured_builtin_name(index), name) != 0)
        index++;
    assert_int_equal(hnbrdf_measured_open_builtin(index, &measured, NULL), HNBRDF_OK);
    return measured;
}

/* From an angle to the nearest quarter turn from another one. */
static double quarters_apart(double angle, double other)
{
    return fabs(remainder(angle - other, 1.57079632679489662));
}

/* The search ends with steps of 90/36/64 = 0.04 degrees, 0.0007 radians. */
static void axes_are_found(void **state)
{
    static const struct {
        const char *name;
        double axis;
    } known[] = {{"brushed-steel", 0.523598776}, {"satin-weave", 0.0},
                 {"carbon-fibre", 0.0},          {"corduroy", 0.0},
                 {"brushed-aluminium", 0.0},     {"combed-hair", 0.0}};
    (void)state;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        hnbrdf_measured *measured = open_builtin(known[k].name);
        double axis = hnbrdf_fit_axis(measured);
        if (quarters_apart(axis, known[k].axis) > 0.002)
            fail_msg("%s: axis at %.4f, expected %.4f", known[k].name, axis, known[k].axis);
        hnbrdf_measured_close(measured);
    }
}

/* Crossed fibres: the best lobe is as wide along as across. */
static void a_round_lobe_lies_along_the_axis(void **state)
{
    hnbrdf_measured *data[] = {open_builtin("carbon-fibre"), open_builtin("corduroy")};
    const hnbrdf_fit_options options = {.kind = HNBRDF_KIND_GGX, .pool = 4096};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    (void)state;
    if (hnbrdf_fit((const hnbrdf_measured *const *)data, 2, &options, &model, NULL, &error))
        fail_msg("%s", error.text);
    for (int m = 0; m < 2; m++) {
        double rotation = (double)hnbrdf_model_material(model, m)->rotation;
        if (quarters_apart(rotation, 0.0) > 0.03)
            fail_msg("%s: rotation %.4f", hnbrdf_model_material_name(model, m), rotation);
        hnbrdf_measured_close(data[m]);
    }
    hnbrdf_model_free(model);
}

/* Of the two frames of a lobe, a quarter turn apart, always the same one. */
static void x_is_where_a_lobe_is_narrower(void **state)
{
    static const char *const names[] = {"brushed-steel", "satin-weave", "turned-brass",
                                        "rolled-steel", "grooved-vinyl"};
    enum { COUNT = sizeof names / sizeof names[0] };
    hnbrdf_measured *data[COUNT];
    const hnbrdf_fit_options options = {.kind = HNBRDF_KIND_GGX, .pool = 4096};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    (void)state;
    for (int m = 0; m < COUNT; m++)
        data[m] = open_builtin(names[m]);
    if (hnbrdf_fit((const hnbrdf_measured *const *)data, COUNT, &options, &model, NULL, &error))
        fail_msg("%s", error.text);
    for (int m = 0; m < COUNT; m++) {
        const hnbrdf_material *found = hnbrdf_model_material(model, m);
        if (!(found->alpha[0] < found->alpha[1] && fabsf(found->rotation) <= 1.5708f))
            fail_msg("%s: alpha %.4f %.4f, rotation %.4f", names[m], (double)found->alpha[0],
                     (double)found->alpha[1], (double)found->rotation);
        hnbrdf_measured_close(data[m]);
    }
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(axes_are_found),
        cmocka_unit_test(a_round_lobe_lies_along_the_axis),
        cmocka_unit_test(x_is_where_a_lobe_is_narrower),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
