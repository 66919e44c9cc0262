/* eval.c: load a model, evaluate one material for one pair of directions, print the value.
 *
 *   build/examples/eval MODEL.safetensors [MATERIAL] */
#include <hnbrdf/hnbrdf.h>

#include <stdio.h>

int main(int argc, char **argv)
{
    hnbrdf_model *model;
    hnbrdf_error error;
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
        fprintf(stderr, "%s has no material %s; it has\n", argv[1], argv[2]);
        for (int i = 0; i < hnbrdf_model_material_count(model); i++)
            fprintf(stderr, "  %s\n", hnbrdf_model_material_name(model, i));
        hnbrdf_model_free(model);
        return 1;
    }

    /* A material is a plain struct: copy it, edit it, check it. */
    hnbrdf_material material = *hnbrdf_model_material(model, index), rougher = material;
    for (int i = 0; i < 2; i++)
        rougher.alpha[i] = material.alpha[i] < 0.5f ? 2.0f * material.alpha[i] : 1.0f;
    if (hnbrdf_material_check(&rougher, &error))
        fprintf(stderr, "%s\n", error.text);

    /* n = +z; wi towards the light, wo towards the viewer: 30 degrees on either side of the
     * normal. */
    const float wi[3] = {0.5f, 0.0f, 0.8660254f}, wo[3] = {-0.5f, 0.0f, 0.8660254f};
    float f[3], f_a[3], f_rougher[3];
    hnbrdf_eval(model, &material, wi, wo, f);
    hnbrdf_eval_analytic(model, &material, wi, wo, f_a);
    hnbrdf_eval(model, &rougher, wi, wo, f_rougher);

    printf("%s, mirror direction at 30 degrees, 1/sr without the cosine\n",
           hnbrdf_model_material_name(model, index));
    printf("  f                   %9.5f %9.5f %9.5f\n", (double)f[0], (double)f[1], (double)f[2]);
    printf("  GGX part alone      %9.5f %9.5f %9.5f\n", (double)f_a[0], (double)f_a[1],
           (double)f_a[2]);
    printf("  f, twice as rough   %9.5f %9.5f %9.5f\n", (double)f_rougher[0], (double)f_rougher[1],
           (double)f_rougher[2]);
    hnbrdf_model_free(model);
    return 0;
}
