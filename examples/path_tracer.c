/* path_tracer.c: three spheres on a floor under a lamp and an even sky, by path tracing with
 * hnbrdf_sample(); examples/path-tracer.md explains it, path_tracer.scene is the same scene.
 *   build/examples/path_tracer MODEL.safetensors [WIDTH [SAMPLES [SEED]]] > OUT.hdr */
#include <hnbrdf/hnbrdf.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { SPHERES = 4, LAMP = 3, FLOOR = 4, MISS = 5, REFLECTIONS = 6 };
static const double SKY = 0.35, EMITTED = 4, HALF_FLOOR = 20;
static const char *const names[FLOOR + 1] = {"vch_silk_blue", "vch_golden_yellow",
                                             "irid_flake_paint1", "paper_white", "paper_white"};
static const hnbrdf_material *materials[FLOOR + 1];
static hnbrdf_model *model;
/* clang-format off */
typedef struct vec { double x, y, z; } vec;
static double dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static vec add(vec a, double t, vec b) {
    return (vec){a.x + t * b.x, a.y + t * b.y, a.z + t * b.z}; }
static vec world(double a, vec x, double b, vec y, double c, vec z) { /* of length 1 */
    vec v = add(add(add((vec){0, 0, 0}, a, x), b, y), c, z);
    return add((vec){0, 0, 0}, 1 / sqrt(dot(v, v)), v); }
static vec unit(vec a) { return world(1, a, 0, a, 0, a); }
static vec cross(vec a, vec b) {
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
static float uniform(uint32_t *state) { /* 24 bits, [0, 1): xorshift32 */
    *state ^= *state << 13, *state ^= *state >> 17, *state ^= *state << 5;
    return (float)(*state >> 8) * (1.0f / 16777216.0f); }
static const struct { vec centre; double radius; } spheres[SPHERES] = {
    {{-2.2, 1, 0}, 1}, {{0, 1, 0}, 1}, {{2.2, 1, 0}, 1}, {{-3, 5, 4}, 2}};
/* clang-format on */
/* What a ray meets first, where, and the normal there. */
static int trace(vec *at, vec d, vec *normal)
{
    double nearest = -at->y / d.y;
    vec floor = add(*at, nearest, d), from = *at;
    int hit = nearest > 1e-6 && fmax(fabs(floor.x), fabs(floor.z)) < HALF_FLOOR ? FLOOR : MISS;
    *normal = (vec){0, 1, 0};
    for (int k = 0; k < SPHERES; k++) {
        vec c = add(from, -1, spheres[k].centre);
        double b = dot(c, d), under = b * b - dot(c, c) + spheres[k].radius * spheres[k].radius;
        double t = -b - sqrt(fmax(under, 0));
        if (under > 0 && t > 1e-6 && (hit == MISS || t < nearest))
            hit = k, nearest = t, *normal = unit(add(c, t, d));
    }
    *at = add(from, nearest, d);
    return hit;
}

/* Adds the light along one path. wo and wi are in the frame (x, y, n) of the surface. */
static void follow(vec at, vec d, uint32_t *state, double light[3])
{
    double through[3] = {1, 1, 1};
    hnbrdf_sample_result s;
    vec n;
    for (int bounce = 0;; bounce++) {
        int hit = trace(&at, d, &n);
        for (int c = 0; c < 3 && (hit == MISS || hit == LAMP); c++)
            light[c] += through[c] * (hit == LAMP ? EMITTED : SKY);
        if (hit == MISS || hit == LAMP || bounce == REFLECTIONS)
            return;
        vec x = unit(cross(fabs(n.x) < 0.5 ? (vec){1, 0, 0} : (vec){0, 1, 0}, n)), y = cross(n, x);
        const float wo[3] = {(float)-dot(d, x), (float)-dot(d, y), (float)-dot(d, n)};
        hnbrdf_sample(model, materials[hit], wo, (float[2]){uniform(state), uniform(state)}, &s);
        for (int c = 0; c < 3; c++)
            through[c] *= (double)s.weight[c]; /* f cos / pdf; 0 where there is no direction */
        d = world(s.wi[0], x, s.wi[1], y, s.wi[2], n);
    }
}

int main(int argc, char **argv)
{
    int width = argc > 2 ? atoi(argv[2]) : 480, height = width * 9 / 16, exponent;
    int samples = argc > 3 ? atoi(argv[3]) : 64;
    uint32_t state = 2654435761u * (uint32_t)(argc > 4 ? atoi(argv[4]) : 1) + 1;
    hnbrdf_error error = {"usage: path_tracer MODEL [WIDTH [SAMPLES [SEED]]] > OUT.hdr"};
    if (argc < 2 || height < 1 || samples < 1 || hnbrdf_model_load(argv[1], NULL, &model, &error))
        return fprintf(stderr, "%s\n", error.text), 1;
    for (int k = 0; k <= FLOOR; k++)
        if (!(materials[k] = hnbrdf_model_material(model, hnbrdf_model_find(model, names[k]))))
            return fprintf(stderr, "%s has no material %s\n", argv[1], names[k]), 1;
    printf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", height, width);
    const double step = 2 * tan(0.2617993878) / height; /* 30 degrees from top to bottom */
    for (int row = 0; row < height; row++)
        for (int column = 0; column < width; column++) {
            double light[3] = {0, 0, 0};
            for (int k = 0; k < samples; k++) {
                double right = step * (column + (double)uniform(&state) - width / 2.0);
                double up = step * (height / 2.0 - row - (double)uniform(&state));
                follow((vec){0, 1.3, 8}, unit((vec){right, up, -1}), &state, light);
            }
            frexp(fmax(light[0], fmax(light[1], light[2])) / samples, &exponent);
            for (int c = 0; c < 3; c++) /* Radiance: three mantissas and their exponent */
                putchar((int)fmin(255, light[c] / samples * ldexp(1, 8 - exponent) + 0.5));
            putchar(exponent + 128);
        }
    hnbrdf_model_free(model);
    return fflush(stdout) ? perror("path_tracer"), 1 : 0;
}
