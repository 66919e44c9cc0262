/* procedural_open.c: a procedural material behind the interface of measured data. */
#include "base/error.h"
#include "measured/format.h"
#include "measured/procedural.h"

#include <stdio.h>
#include <stdlib.h>

/* Every fourth is as it is, the others as they would be measured. */
static int is_measured(int number)
{
    return number % 4 != 3;
}

static int eval(const void *data, const double wi[3], const double wo[3], double f[3])
{
    hnbrdf_procedural_eval(data, wi, wo, f);
    return 1;
}

hnbrdf_result hnbrdf_procedural_open(int number, measured_body *body, hnbrdf_error *error)
{
    procedural *drawn = calloc(1, sizeof *drawn);
    rgl *tables = NULL;
    if (drawn) {
        hnbrdf_procedural_draw(number, drawn);
        tables = is_measured(number) ? hnbrdf_procedural_measure(drawn) : NULL;
    }
    if (!drawn || (is_measured(number) && !tables)) {
        free(drawn);
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "procedural-%d: out of memory", number);
    }
    body->isotropic = 1;
    snprintf(body->summary, sizeof body->summary, "procedural: %d random terms%s%s", drawn->count,
             drawn->coated ? ", below a coat" : "", tables ? ", as RGL would measure it" : "");
    body->data = drawn;
    body->eval = eval;
    body->release = free;
    if (tables) {
        free(drawn);
        body->data = tables;
        body->eval = hnbrdf_rgl_eval;
        body->release = hnbrdf_rgl_release;
    }
    return HNBRDF_OK;
}
