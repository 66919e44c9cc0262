/* fuzz_obj.c: the bytes are a Wavefront OBJ file. What is read has indices within its arrays,
 * coordinates that suit single precision, and unit normals once they are averaged; no kind of note
 * is told twice. */
#include "fuzz.h"

#include "scene/obj.h"

enum { MOST_TRIANGLES = 600 };

static void check_corners(const uint32_t corners[3], size_t count, int may_lack)
{
    const int lacks = corners[0] == RENDER_NONE;
    FUZZ_CHECK(!lacks || may_lack);
    for (int k = 0; k < 3; k++)
        FUZZ_CHECK(lacks ? corners[k] == RENDER_NONE : corners[k] < count);
}

static void check_mesh(render_mesh *mesh, const render_transform *place)
{
    FUZZ_CHECK(mesh->triangle_count > 0 && mesh->triangle_count <= MOST_TRIANGLES);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        check_corners(mesh->triangles[i].position, mesh->position_count, 0);
        check_corners(mesh->triangles[i].normal, mesh->normal_count, 1);
        check_corners(mesh->triangles[i].uv, mesh->uv_count, 1);
        FUZZ_CHECK(mesh->triangles[i].part < mesh->part_count);
    }
    for (size_t i = 0; i < mesh->position_count; i++)
        for (int k = 0; k < 3; k++) {
            const double x = (double)mesh->positions[i][k];
            FUZZ_CHECK(fabs(x) <= 0x1p28);
            FUZZ_CHECK(fabs(place->m[k][k] * x + place->m[k][3]) <= 1.1e30);
        }
    FUZZ_CHECK(render_mesh_smooth(mesh) == 0);
    for (size_t i = 0; i < mesh->normal_count; i++) {
        const float *n = mesh->normals[i];
        FUZZ_CHECK(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-4f);
    }
}

static void check_note(void *user, const char *text)
{
    FUZZ_CHECK(strlen(text) > 10 && ++*(int *)user <= 10); /* there are 10 kinds */
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int notes = 0;
    const render_obj_options options = {.max_triangles = MOST_TRIANGLES,
                                        .notes = {check_note, &notes}};
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
        check_mesh(&mesh, &place);
    render_mesh_free(&mesh);
    free(copy);
    return 0;
}
