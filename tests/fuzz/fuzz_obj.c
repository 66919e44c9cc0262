/* fuzz_obj.c: the bytes are a Wavefront OBJ file. What is read has indices within its arrays,
 * finite coordinates and unit normals. */
#include "fuzz.h"

#include "scene/obj.h"

static void check_corners(const uint32_t corners[3], size_t count, int may_lack)
{
    const int lacks = corners[0] == RENDER_NONE;
    FUZZ_CHECK(!lacks || may_lack);
    for (int k = 0; k < 3; k++)
        FUZZ_CHECK(lacks ? corners[k] == RENDER_NONE : corners[k] < count);
}

static void check_mesh(render_mesh *mesh)
{
    FUZZ_CHECK(mesh->triangle_count > 0 && mesh->triangle_count <= 4096);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        check_corners(mesh->triangles[i].position, mesh->position_count, 0);
        check_corners(mesh->triangles[i].normal, mesh->normal_count, 1);
        check_corners(mesh->triangles[i].uv, mesh->uv_count, 1);
        FUZZ_CHECK(mesh->triangles[i].part < mesh->part_count);
    }
    for (size_t i = 0; i < mesh->position_count; i++)
        for (int k = 0; k < 3; k++)
            FUZZ_CHECK(fabsf(mesh->positions[i][k]) <= 1.1e30f);
    FUZZ_CHECK(render_mesh_smooth(mesh) == 0);
    for (size_t i = 0; i < mesh->normal_count; i++) {
        const float *n = mesh->normals[i];
        FUZZ_CHECK(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-4f);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const render_obj_options options = {.max_triangles = 4096};
    render_mesh mesh = {0};
    render_transform place;
    hnbrdf_error error = {""};
    void *copy = fuzz_copy(data, size);
    const hnbrdf_result result =
        render_obj_decode(copy, size, "mesh.obj", &options, &mesh, &place, &error);
    FUZZ_CHECK((result == HNBRDF_OK) == (mesh.triangles != NULL));
    if (result)
        fuzz_check_refusal(result, &error);
    else
        check_mesh(&mesh);
    render_mesh_free(&mesh);
    free(copy);
    return 0;
}
