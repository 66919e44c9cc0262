/* sample.c: importance sampling in a white furnace: how much of uniform light from everywhere
 * comes back, by the angle of view.
 *
 *   build/examples/sample MODEL.safetensors [MATERIAL]
 *
 * With wi drawn by hnbrdf_sample(), the mean of weight = f cos/pdf is the integral of f cos: the
 * albedo. */
#include <hnbrdf/hnbrdf.h>

#include <math.h>
#include <stdint.h>
#include <stdio.h>

enum { DRAWS = 100000 };

/* A number in [0, 1) as the library wants it: 24 bits, never 1 (xorshift32, Marsaglia 2003). */
static float uniform(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return (float)(*state >> 8) * (1.0f / 16777216.0f);
}

int main(int argc, char **argv)
{
    static const double degrees[] = {0, 15, 30, 45, 60, 75, 85};
    hnbrdf_model *model;
    hnbrdf_error error;
    uint32_t state = 1;
    if (argc < 2) {
        fprintf(stderr, "usage: %s MODEL.safetensors [MATERIAL]\n", argv[0]);
        return 2;
    }
    if (hnbrdf_model_load(argv[1], NULL, &model, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    int index = argc > 2 ? hnbrdf_model_find(model, argv[2]) : 0;
    if (index < 0) {
        fprintf(stderr, "%s has no material %s\n", argv[1], argv[2]);
        hnbrdf_model_free(model);
        return 1;
    }

    printf("%s: albedo by the angle of view, %d samples each\n",
           hnbrdf_model_material_name(model, index), DRAWS);
    printf("degrees        R        G        B  standard error of G\n");
    for (size_t k = 0; k < sizeof degrees / sizeof degrees[0]; k++) {
        double theta = degrees[k] * 3.14159265358979 / 180, sum[3] = {0, 0, 0}, square = 0;
        const float wo[3] = {(float)sin(theta), 0.0f, (float)cos(theta)};
        for (int n = 0; n < DRAWS; n++) {
            const float u[2] = {uniform(&state), uniform(&state)};
            hnbrdf_sample_result s;
            hnbrdf_sample(model, hnbrdf_model_material(model, index), wo, u, &s);
            for (int c = 0; c < 3; c++)
                sum[c] += (double)s.weight[c];
            square += (double)s.weight[1] * (double)s.weight[1];
        }
        double mean = sum[1] / DRAWS;
        printf("%7.0f %8.4f %8.4f %8.4f  %.4f\n", degrees[k], sum[0] / DRAWS, mean, sum[2] / DRAWS,
               sqrt(fmax(0.0, square / DRAWS - mean * mean) / DRAWS));
    }
    hnbrdf_model_free(model);
    return 0;
}
