/* growth_series.c: series of costs, their exponents, and the models that are measured. */
#include "bench/growth.h"
#include "base/error.h"

#include <stdlib.h>
#include <string.h>

/* ---- Series ---------------------------------------------------------------------------------- */

growth_series *bench_growth_add(growth *g, const char *what, const char *unit, const char *against)
{
    growth_series *s = &g->series[g->count < GROWTH_SERIES ? g->count++ : GROWTH_SERIES - 1];
    *s = (growth_series){.what = what, .unit = unit, .against = against};
    return s;
}

void bench_growth_point(growth_series *s, double size, double cost, double work)
{
    if (s->count < GROWTH_POINTS)
        s->points[s->count++] = (growth_point){size, cost, work};
}

/* The slope of log y against log x; y is the cost or the work. */
static double slope(const growth_point *p, int count, int of_work)
{
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (int k = 0; k < count; k++) {
        const double value = of_work ? p[k].work : p[k].cost;
        if (!(p[k].size > 0.0) || !(value > 0.0) || !(p[k].cost > 0.0))
            continue;
        const double u = log(p[k].size), v = log(value);
        n += 1.0;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    const double spread = n * xx - x * x;
    return n > 1.0 && spread > 0.0 ? (n * xy - x * y) / spread : (double)NAN;
}

growth_exponents bench_growth_exponents(const growth_series *s)
{
    const int from = s->count > 2 ? s->count - 2 : 0;
    return (growth_exponents){.cost = slope(s->points, s->count, 0),
                              .work = slope(s->points, s->count, 1),
                              .last_cost = slope(s->points + from, s->count - from, 0),
                              .last_work = slope(s->points + from, s->count - from, 1)};
}

/* ---- Sizes ----------------------------------------------------------------------------------- */

const char *bench_growth_axis_name(growth_axis axis)
{
    static const char *const names[GROWTH_AXES] = {"H", "N", "l", "materials"};
    return names[axis];
}

double bench_growth_size(growth_axis axis, const growth_shape *s)
{
    const int sizes[GROWTH_AXES] = {s->hidden, s->layers, s->latent, s->materials};
    return sizes[axis];
}

int bench_growth_shape(const growth *g, growth_axis axis, int k, growth_shape *shape)
{
    enum { MOST = 5 };
    static const int sizes[GROWTH_AXES][MOST] = {
        {8, 16, 32, 64}, {1, 2, 3, 4}, {1, 2, 4, 8, 16}, {1, 10, 100, 1000, 10000}};
    if (k >= (g->quick ? 3 : MOST) || sizes[axis][k] == 0)
        return 0;
    *shape = g->quick ? (growth_shape){8, 1, 4, 2} : (growth_shape){32, 2, 4, 2};
    int *const places[GROWTH_AXES] = {&shape->hidden, &shape->layers, &shape->latent,
                                      &shape->materials};
    *places[axis] = sizes[axis][k];
    return 1;
}

/* Numbers for every matrix of a network; layers share them. */
static float *make_numbers(void)
{
    enum { MOST = HNBRDF_MAX_HIDDEN * (HNBRDF_MAX_HIDDEN + 32) };
    float *numbers = malloc(MOST * sizeof *numbers);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; numbers && k < MOST; k++)
        numbers[k] = 0.2f * (hnbrdf_rng_float(&rng) - 0.5f);
    return numbers;
}

/* Pointers, then the texts they point to. */
static const char **make_names(int count)
{
    enum { LENGTH = 24 };
    const size_t n = (size_t)count;
    const char **names = malloc(n * (sizeof *names + LENGTH));
    for (int k = 0; names && k < count; k++) {
        char *text = (char *)(names + n) + LENGTH * (size_t)k;
        snprintf(text, LENGTH, "paint_%05d", k);
        names[k] = text;
    }
    return names;
}

static hnbrdf_material *make_materials(int count, int latent)
{
    hnbrdf_material *materials = malloc((size_t)count * sizeof *materials);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 2, 0);
    for (int k = 0; materials && k < count; k++) {
        hnbrdf_material_init(&materials[k]);
        materials[k].alpha[0] = materials[k].alpha[1] = 0.1f + 0.8f * hnbrdf_rng_float(&rng);
        for (int c = 0; c < 3; c++)
            materials[k].kd[c] = hnbrdf_rng_float(&rng);
        for (int i = 0; i < latent; i++)
            materials[k].latent[i] = hnbrdf_rng_float(&rng) - 0.5f;
    }
    return materials;
}

hnbrdf_result bench_growth_model(const growth_shape *shape, hnbrdf_model **model,
                                 hnbrdf_error *error)
{
    float *numbers = make_numbers();
    const char **names = make_names(shape->materials);
    hnbrdf_material *materials = make_materials(shape->materials, shape->latent);
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_HYBRID,
                              .encoding = HNBRDF_ENCODING_ANGLES,
                              .hidden = shape->hidden,
                              .layers = shape->layers,
                              .latent = shape->latent,
                              .scale = 1.0f,
                              .material_count = shape->materials,
                              .materials = materials,
                              .names = names};
    hnbrdf_result result = numbers && names && materials
                               ? HNBRDF_OK
                               : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int k = 0; k <= shape->layers; k++)
        desc.weights[k] = desc.biases[k] = numbers;
    if (!result)
        result = hnbrdf_model_create(&desc, NULL, model, error);
    free(numbers);
    free((void *)names);
    free(materials);
    return result;
}
