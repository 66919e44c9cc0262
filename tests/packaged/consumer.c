/* consumer.c MODEL: prints the bits of values and samples of all materials. Compiled in every way
 * that a project can have the library; ONE_FILE: as hnbrdf.c and hnbrdf.h. */
#ifdef ONE_FILE
#include "hnbrdf.h"
#else
#include <hnbrdf/glsl.h>
#include <hnbrdf/hnbrdf.h>
#endif

#include <stdint.h>
#include <stdio.h>
#include <string.h>

static void print(const float *values, int count)
{
    for (int k = 0; k < count; k++) {
        uint32_t bits;
        memcpy(&bits, values + k, sizeof bits);
        printf(" %08lx", (unsigned long)bits);
    }
}

int main(int argc, char **argv)
{
    const float wi[3] = {0.6f, 0.0f, 0.8f}, wo[3] = {-0.48f, 0.36f, 0.8f}, u[2] = {0.1f, 0.6f};
    hnbrdf_model *model;
    hnbrdf_error error;
    if (argc != 2 || hnbrdf_model_load(argv[1], NULL, &model, &error)) {
        fprintf(stderr, "%s\n", argc == 2 ? error.text : "usage: consumer MODEL");
        return 1;
    }
    printf("%s", hnbrdf_version());
    for (int m = 0; m < hnbrdf_model_material_count(model); m++) {
        hnbrdf_sample_result sample;
        float f[3];
        hnbrdf_eval(model, hnbrdf_model_material(model, m), wi, wo, f);
        hnbrdf_sample(model, hnbrdf_model_material(model, m), wo, u, &sample);
        print(f, 3);
        print(sample.weight, 3);
    }
    printf(" %lu\n", (unsigned long)hnbrdf_weights_size(model));
    hnbrdf_model_free(model);
    return 0;
}
