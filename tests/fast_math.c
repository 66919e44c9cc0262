/* fast_math.c MODEL: samples and values as bits, for comparing builds of the caller. Built twice,
 * plainly and with -ffast-math, against the same library. Nothing is computed here: directions come
 * from the library and from tables, as arithmetic of this file may differ between the two. */
#include "hnbrdf/hnbrdf.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static uint32_t state = 1;

/* A multiple of 2^-24: exact in every arithmetic. */
static float next(void)
{
    state = state * 1664525u + 1013904223u;
    return (float)(state >> 8) * 0x1p-24f;
}

static void print_bits(const float *values, int count)
{
    for (int i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        printf("%08" PRIx32 "%c", bits, i + 1 < count ? ' ' : '\n');
    }
}

int main(int argc, char **argv)
{
    static const uint32_t broken[] = {0x7fc00000, 0x7f800000, 0xff800000, 0x80000000, 0x7f7fffff};
    hnbrdf_model *model;
    hnbrdf_error error;
    if (argc != 2 || hnbrdf_model_load(argv[1], NULL, &model, &error) != HNBRDF_OK)
        return 1;
    float wo[3] = {0.6f, 0.0f, 0.8f};
    for (int k = 0; k < 1000; k++) {
        const hnbrdf_material *material =
            hnbrdf_model_material(model, k % hnbrdf_model_material_count(model));
        const float u[2] = {next(), next()};
        hnbrdf_sample_result sample;
        float f[3], pdf;
        hnbrdf_sample(model, material, wo, u, &sample);
        hnbrdf_eval(model, material, sample.wi, wo, f);
        pdf = hnbrdf_pdf(model, material, wo, sample.wi);
        print_bits(sample.wi, 3);
        print_bits(sample.weight, 3);
        print_bits(f, 3);
        print_bits(&pdf, 1);
        /* NaN, infinities, -0, the largest */
        memcpy(&sample.wi[k % 3], &broken[k % 5], sizeof(float));
        hnbrdf_eval(model, material, sample.wi, wo, f);
        print_bits(f, 3);
        hnbrdf_sample(model, material, wo, u, &sample);
        if (k % 7 < 5)
            memcpy(wo, sample.wi, sizeof wo); /* on from there: grazing directions come up too */
    }
    hnbrdf_model_free(model);
    return 0;
}
