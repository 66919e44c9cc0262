/* growth_files.c: how files, edits, look-ups by name, export and `info` grow with a model. */
#include "base/clock.h"
#include "base/error.h"
#include "base/text_buffer.h"
#include "bench/growth.h"
#include "hnbrdf/edit.h"
#include "hnbrdf/glsl.h"
#include "report/info.h"

#include <stdlib.h>

typedef struct subject {
    hnbrdf_model *model;
    hnbrdf_text_buffer file; /* the model's */
    FILE *nowhere;
    hnbrdf_error *error;
} subject;

/* ---- What is timed: once -------------------------------------------------------------------- */

static hnbrdf_result save(subject *s)
{
    hnbrdf_text_buffer file = {0};
    hnbrdf_result result = hnbrdf_model_write(s->model, hnbrdf_text_buffer_append, &file, s->error);
    free(s->file.bytes);
    s->file = file;
    return result;
}

static hnbrdf_result load(subject *s)
{
    hnbrdf_model *model;
    hnbrdf_result result =
        hnbrdf_model_load_memory(s->file.bytes, s->file.size, NULL, &model, s->error);
    if (!result)
        hnbrdf_model_free(model);
    return result;
}

/* One material replaced: a new model. */
static hnbrdf_result edit(subject *s)
{
    hnbrdf_model *model;
    const hnbrdf_material_change change = {.kind = HNBRDF_CHANGE_PUT,
                                           .name = "paint_00000",
                                           .material = hnbrdf_model_material(s->model, 0),
                                           .lobes = HNBRDF_LOBES_GUESS};
    hnbrdf_result result =
        hnbrdf_model_with_materials(s->model, &change, 1, NULL, &model, s->error);
    if (!result)
        hnbrdf_model_free(model);
    return result;
}

enum { LOOKUPS = 1000 };

/* Of all materials, in an order without order. */
static hnbrdf_result find(subject *s)
{
    const int count = hnbrdf_model_material_count(s->model);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 4, 0);
    for (int k = 0; k < LOOKUPS; k++) {
        const int m = (int)(hnbrdf_rng_u32(&rng) % (uint32_t)count);
        if (hnbrdf_model_find(s->model, hnbrdf_model_material_name(s->model, m)) != m)
            return hnbrdf_fail(s->error, HNBRDF_ERROR_ARGUMENT, "material %d not found", m);
    }
    return HNBRDF_OK;
}

static hnbrdf_result export(subject *s)
{
    hnbrdf_text_buffer text = {0};
    const hnbrdf_glsl_options options = {.standalone = 1};
    hnbrdf_result result =
        hnbrdf_export_shader(s->model, &options, hnbrdf_text_buffer_append, &text, s->error);
    free(text.bytes);
    return result;
}

static hnbrdf_result info(subject *s)
{
    rewind(s->nowhere);
    info_print_model("model", s->model, NULL, s->nowhere);
    return HNBRDF_OK;
}

/* ---- Series ---------------------------------------------------------------------------------- */

typedef struct task {
    const char *what, *unit;
    hnbrdf_result (*run)(subject *s);
    double per;       /* divides milliseconds */
    int of_materials; /* 1: against the number of materials alone */
    double constant;  /* 1: the arithmetic does not grow */
} task;

static const task tasks[] = {
    {"saving", "ms", save, 1.0, 0, 0},
    {"loading", "ms", load, 1.0, 0, 0},
    {"export to GLSL", "ms", export, 1.0, 0, 0},
    {"edit of one material", "ms", edit, 1.0, 1, 0},
    {"look-up by name", "ns", find, 1e-6 * LOOKUPS, 1, 1},
    {"info without physics", "ms", info, 1.0, 1, 0},
};
enum { TASKS = sizeof tasks / sizeof tasks[0] };

/* The least of some runs, in processor time, together at least `least` seconds. */
static hnbrdf_result time_task(const task *t, subject *s, double least, double *ms)
{
    double best = INFINITY, sum = 0.0;
    for (int runs = 0; runs < 200 && (runs < 2 || sum < least); runs++) {
        const double started = hnbrdf_thread_seconds();
        hnbrdf_result result = t->run(s);
        const double took = hnbrdf_thread_seconds() - started;
        if (result)
            return result;
        best = fmin(best, took);
        sum += took;
    }
    *ms = 1e3 * best / t->per;
    return HNBRDF_OK;
}

/* Numbers of the network and of all materials. */
static double numbers_of(const subject *s, const growth_shape *shape)
{
    return (double)hnbrdf_model_weight_count(s->model) +
           (double)shape->materials * (9.0 + shape->latent);
}

static hnbrdf_result measure(const growth *g, const growth_shape *shape, growth_axis axis,
                             growth_series *const *series, hnbrdf_error *error)
{
    subject s = {.nowhere = tmpfile(), .error = error};
    hnbrdf_result result = s.nowhere ? bench_growth_model(shape, &s.model, error)
                                     : hnbrdf_fail(error, HNBRDF_ERROR_IO, "no temporary file");
    for (int t = 0; t < TASKS && !result; t++) {
        double ms = (double)NAN;
        if (!series[t])
            continue;
        result = time_task(&tasks[t], &s, g->quick ? 0.001 : 0.1, &ms);
        bench_growth_point(series[t], bench_growth_size(axis, shape), ms,
                           tasks[t].constant != 0.0 ? 1.0 : numbers_of(&s, shape));
    }
    if (s.nowhere)
        fclose(s.nowhere);
    free(s.file.bytes);
    hnbrdf_model_free(s.model);
    return result;
}

hnbrdf_result bench_growth_files(growth *g, const bench_watch *watch, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (growth_axis axis = GROWTH_H; axis < GROWTH_AXES && !result; axis++) {
        growth_series *series[TASKS] = {NULL};
        growth_shape shape;
        for (int t = 0; t < TASKS; t++)
            if (axis == GROWTH_MATERIALS || !tasks[t].of_materials)
                series[t] =
                    bench_growth_add(g, tasks[t].what, tasks[t].unit, bench_growth_axis_name(axis));
        for (int k = 0; !result && bench_growth_shape(g, axis, k, &shape); k++) {
            result = bench_show(watch, "files, names and edits",
                                ((int)axis + 0.2 * k) / GROWTH_AXES, "", error);
            if (!result)
                result = measure(g, &shape, axis, series, error);
        }
    }
    return result;
}
