/* edit.c: what the command `hnbrdf edit` and `mix` do, from C: a model with a rougher copy of one
 * material, and a mixture in the place of another.
 *
 *   build/examples/edit MODEL.safetensors MATERIAL OTHER OUT.safetensors
 *
 * OUT has MODEL's network and materials, but MATERIAL-rough more, and in the place of OTHER the
 * material halfway to it. */
#include <hnbrdf/edit.h>

#include <stdio.h>

static int fail(const char *text)
{
    fprintf(stderr, "%s\n", text);
    return 1;
}

/* The model with its changes as a new file. */
static int write_edited(const hnbrdf_model *model, const char *name, const char *other,
                        const char *path)
{
    hnbrdf_model *edited;
    hnbrdf_error error;
    char rough_name[HNBRDF_MAX_NAME + 16];
    const hnbrdf_material *material = hnbrdf_model_material(model, hnbrdf_model_find(model, name));
    const hnbrdf_material *second = hnbrdf_model_material(model, hnbrdf_model_find(model, other));
    if (!material || !second)
        return fail("the model has no material of this name");

    hnbrdf_material rough = *material, way[HNBRDF_MIX_KNOTS], halfway;
    rough.alpha[0] = rough.alpha[1] = 0.5f;
    if (hnbrdf_mix_path_fit(model, material, second, way, &error))
        return fail(error.text);
    hnbrdf_mix_path_at(way, 0.5f, &halfway);
    snprintf(rough_name, sizeof rough_name, "%s-rough", name);

    /* Fitted lobes cost tens of milliseconds and make sampling of the new materials quiet. */
    const hnbrdf_material_change changes[] = {
        {.kind = HNBRDF_CHANGE_ADD,
         .name = rough_name,
         .material = &rough,
         .lobes = HNBRDF_LOBES_FIT},
        {.kind = HNBRDF_CHANGE_REPLACE,
         .name = other,
         .material = &halfway,
         .lobes = HNBRDF_LOBES_FIT},
        {.kind = HNBRDF_CHANGE_RENAME, .name = other, .new_name = "halfway"},
    };
    if (hnbrdf_model_with_materials(model, changes, 3, NULL, &edited, &error))
        return fail(error.text);
    int failed = hnbrdf_model_save(edited, path, &error) ? fail(error.text) : 0;
    for (int k = 0; !failed && k < hnbrdf_model_material_count(edited); k++)
        printf("%s\n", hnbrdf_model_material_name(edited, k));
    hnbrdf_model_free(edited);
    return failed;
}

int main(int argc, char **argv)
{
    hnbrdf_model *model;
    hnbrdf_error error;
    if (argc != 5) {
        fprintf(stderr, "usage: %s MODEL.safetensors MATERIAL OTHER OUT.safetensors\n", argv[0]);
        return 2;
    }
    if (hnbrdf_model_load(argv[1], NULL, &model, &error))
        return fail(error.text);
    int failed = write_edited(model, argv[2], argv[3], argv[4]);
    hnbrdf_model_free(model);
    return failed;
}
