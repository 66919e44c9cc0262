/* batch.c: evaluate many pairs of directions at once, and time it: nanoseconds per evaluation,
 * one thread.
 *
 *   build/examples/batch MODEL.safetensors
 *
 * Prints CSV: material,single_ns,batch_ns. */
#include <hnbrdf/hnbrdf.h>

#include <math.h>
#include <stdio.h>
#include <time.h>

enum { PAIRS = 16384, TIMES = 12 };

/* What a renderer keeps per hit: the directions lie in its own struct, strides tell where. */
typedef struct hit {
    float wi[3], wo[3];
    float f[3];
    int pixel;
} hit;

static hit hits[PAIRS];

/* Directions all over the hemisphere, without a random number: the golden ratio and its like. */
static void spread(float w[3], int k, double step1, double step2)
{
    double z = fmod(0.5 + k * step1, 1.0) * 0.98 + 0.01, phi = 6.283185307 * fmod(k * step2, 1.0);
    w[0] = (float)(sqrt(1.0 - z * z) * cos(phi));
    w[1] = (float)(sqrt(1.0 - z * z) * sin(phi));
    w[2] = (float)z;
}

/* Nanoseconds per evaluation; the shortest of a few runs is the one least disturbed. */
static double shortest(const hnbrdf_model *model, const hnbrdf_material *material, int batch)
{
    double best = 1e30;
    for (int run = 0; run < TIMES; run++) {
        clock_t start = clock();
        if (batch)
            hnbrdf_eval_batch(model, material, PAIRS, hits[0].wi, sizeof(hit), hits[0].wo,
                              sizeof(hit), hits[0].f, sizeof(hit));
        else
            for (int k = 0; k < PAIRS; k++)
                hnbrdf_eval(model, material, hits[k].wi, hits[k].wo, hits[k].f);
        double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
        best = seconds < best ? seconds : best;
    }
    return best * 1e9 / PAIRS;
}

int main(int argc, char **argv)
{
    hnbrdf_model *model;
    hnbrdf_error error;
    if (argc != 2) {
        fprintf(stderr, "usage: %s MODEL.safetensors\n", argv[0]);
        return 2;
    }
    if (hnbrdf_model_load(argv[1], NULL, &model, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    for (int k = 0; k < PAIRS; k++) {
        spread(hits[k].wi, k, 0.7548776662, 0.5698402910);
        spread(hits[k].wo, k, 0.6180339887, 0.3247179572);
    }
    printf("material,single_ns,batch_ns\n");
    for (int i = 0; i < hnbrdf_model_material_count(model); i++) {
        const hnbrdf_material *material = hnbrdf_model_material(model, i);
        printf("%s,%.1f,%.1f\n", hnbrdf_model_material_name(model, i), shortest(model, material, 0),
               shortest(model, material, 1));
    }
    hnbrdf_model_free(model);
    return 0;
}
