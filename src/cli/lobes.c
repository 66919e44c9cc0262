/* lobes.c: the lobes with which a model's materials are sampled, of all materials at once. */
#include "cli/lobes.h"

#include <stdlib.h>
#include <string.h>

static hnbrdf_result set(const hnbrdf_model *model, lobes_scheme scheme, hnbrdf_material *material,
                         hnbrdf_error *error)
{
    memset(&material->lobes, 0, sizeof material->lobes);
    if (scheme == LOBES_PAPER)
        hnbrdf_lobes_paper(&material->lobes);
    return scheme == LOBES_FITTED ? hnbrdf_lobes_fit(model, material, &material->lobes, error)
                                  : HNBRDF_OK;
}

int lobes_set_all(hnbrdf_model **model, lobes_scheme scheme)
{
    hnbrdf_model_desc desc;
    hnbrdf_model *made = NULL;
    hnbrdf_error error;
    hnbrdf_result result = HNBRDF_OK;
    cli_progress progress;
    hnbrdf_model_describe(*model, &desc);
    size_t size = (size_t)desc.material_count * sizeof(hnbrdf_material);
    hnbrdf_material *materials = malloc(size);
    if (!materials)
        return cli_fail("out of memory");
    memcpy(materials, desc.materials, size);
    cli_progress_begin(&progress, "lobes");
    for (int m = 0; m < desc.material_count && !result; m++) {
        result = set(*model, scheme, &materials[m], &error);
        cli_progress_update(&progress, (m + 1.0) / desc.material_count, desc.names[m]);
    }
    cli_progress_end(&progress);
    desc.materials = materials;
    if (!result)
        result = hnbrdf_model_create(&desc, NULL, &made, &error);
    free(materials);
    if (result)
        return cli_fail("%s", error.text);
    hnbrdf_model_free(*model);
    *model = made;
    return CLI_OK;
}
