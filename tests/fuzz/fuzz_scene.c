/* fuzz_scene.c: the bytes are a scene as text. What is read keeps to its limits; no file is
 * opened. */
#include "fuzz.h"

#include "scene/describe.h"

static void check_shape(const render_description *d, const render_text_shape *shape)
{
    FUZZ_CHECK(shape->material >= -1 && shape->material < d->material_count);
    FUZZ_CHECK(shape->options.profile_count >= 0 &&
               shape->options.profile_count <= RENDER_MAX_PROFILE);
    FUZZ_CHECK(shape->use_count >= 0 && shape->use_count <= RENDER_MAX_USES);
    for (int u = 0; u < shape->use_count; u++)
        FUZZ_CHECK(shape->uses[u].material >= 0 && shape->uses[u].material < d->material_count);
    for (int i = 0; i < 3; i++)
        FUZZ_CHECK(shape->emission[i] >= 0.0f && shape->emission[i] <= 1e6f);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    render_description d = {.bounces = -1};
    hnbrdf_error error = {""};
    void *copy = fuzz_copy(data, size);
    const hnbrdf_result result = render_description_parse(copy, size, "a.scene", &d, &error);
    FUZZ_CHECK((result == HNBRDF_OK) == (d.bounces != -1));
    free(copy);
    if (result) {
        fuzz_check_refusal(result, &error);
        return 0;
    }
    FUZZ_CHECK(d.shape_count > 0 && d.camera.width >= 0 && d.camera.width <= 16384);
    FUZZ_CHECK(d.portal_count >= 0 && d.portal_count <= RENDER_MAX_PORTALS);
    for (int i = 0; i < d.material_count; i++)
        FUZZ_CHECK(hnbrdf_material_check(&d.materials[i].ggx, NULL) == HNBRDF_OK);
    for (int i = 0; i < d.shape_count; i++)
        check_shape(&d, &d.shapes[i]);
    render_description_free(&d);
    return 0;
}
