/* custom.c: a BRDF that the caller evaluates, behind the same interface as measurements. */
#include "base/error.h"
#include "measured/format.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int eval(const void *data, const double wi[3], const double wo[3], double f[3])
{
    const hnbrdf_measured_custom *custom = data;
    float i[3], o[3], value[3] = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < 3; k++) {
        i[k] = (float)wi[k];
        o[k] = (float)wo[k];
    }
    if (!custom->eval(custom->user, i, o, value))
        return 0;
    for (int c = 0; c < 3; c++) {
        if (!isfinite(value[c]))
            return 0; /* neither black nor a measurement: who fits or compares must not learn it */
        f[c] = (double)value[c];
    }
    return 1;
}

static void release(void *data)
{
    hnbrdf_measured_custom *custom = data;
    if (custom && custom->release)
        custom->release(custom->user);
    free(custom);
}

hnbrdf_result hnbrdf_custom_open(const hnbrdf_measured_custom *custom, measured_body *body,
                                 hnbrdf_error *error)
{
    hnbrdf_measured_custom *copy = malloc(sizeof *copy);
    if (!copy)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for a custom material");
    *copy = *custom;
    copy->name = copy->summary = NULL; /* the caller's; measured.c and body have their own */
    snprintf(body->summary, sizeof body->summary, "%s",
             custom->summary ? custom->summary : "custom");
    body->data = copy;
    body->eval = eval;
    body->release = release;
    body->isotropic = custom->isotropic != 0;
    return HNBRDF_OK;
}

const measured_reader hnbrdf_custom_reader = {
    .info = {.format = HNBRDF_MEASURED_CUSTOM, .name = "custom"},
};
