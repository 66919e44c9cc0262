/* obj_file.c: read an OBJ file by its path. */
#include "scene/obj.h"

#include "image/image.h"

#include <stdlib.h>

hnbrdf_result render_obj_read(const char *path, const render_obj_options *options,
                              render_mesh *mesh, render_transform *place, hnbrdf_error *error)
{
    static const size_t most = (size_t)1 << 29;
    size_t wanted = options ? options->max_bytes : 0;
    render_bytes bytes = {0};
    hnbrdf_result result =
        render_file_read(path, wanted && wanted < most ? wanted : most, &bytes, error);
    if (result == HNBRDF_OK)
        result = render_obj_decode(bytes.data, bytes.size, path, options, mesh, place, error);
    free(bytes.data);
    return result;
}
