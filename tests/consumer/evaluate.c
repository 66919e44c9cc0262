/* evaluate.c: a C program that knows nothing but the installed hnbrdf.h. */
#include <hnbrdf/hnbrdf.h>

#include <stdio.h>
#include <string.h>

int main(void)
{
    static const char *const name = "plain";
    const float n[3] = {0.0f, 0.0f, 1.0f};
    hnbrdf_material material;
    hnbrdf_model_desc desc;
    hnbrdf_model *model;
    hnbrdf_error error;
    float f[3], expected = 0.5f * 0.318309886f + 0.04f / (4 * 3.14159265f * 0.25f);

    if (strcmp(hnbrdf_version(), HNBRDF_VERSION_STRING) != 0) {
        fprintf(stderr, "header %s, library %s\n", HNBRDF_VERSION_STRING, hnbrdf_version());
        return 1;
    }
    hnbrdf_material_init(&material);
    memset(&desc, 0, sizeof desc);
    desc.kind = HNBRDF_KIND_GGX;
    desc.material_count = 1;
    desc.materials = &material;
    desc.names = &name;
    if (hnbrdf_model_create(&desc, NULL, &model, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    hnbrdf_eval(model, &material, n, n, f);
    hnbrdf_model_free(model);
    if (!(f[0] > expected - 1e-6f && f[0] < expected + 1e-6f)) {
        fprintf(stderr, "got %g, expected %g\n", (double)f[0], (double)expected);
        return 1;
    }
    return 0;
}
