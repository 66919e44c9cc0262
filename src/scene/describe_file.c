/* describe_file.c: the text of a scene from its file, and the files that it names. */
#include "scene/describe.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

hnbrdf_result render_description_read(const char *path, render_description *description,
                                      hnbrdf_error *error)
{
    render_bytes bytes = {0};
    if (strlen(path) >= RENDER_MAX_PATH)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "%s: a path of more than %d bytes", path,
                           RENDER_MAX_PATH - 1);
    hnbrdf_result result = render_file_read(path, RENDER_MAX_TEXT, &bytes, error);
    if (result == HNBRDF_OK)
        result = render_description_parse(bytes.data, bytes.size, path, description, error);
    free(bytes.data);
    return result;
}

void render_description_path(const render_description *description, const char *file,
                             char path[2 * RENDER_MAX_PATH])
{
    const char *slash = strrchr(description->name, '/');
    int folder = slash && file[0] != '/' ? (int)(slash - description->name) + 1 : 0;
    snprintf(path, (size_t)2 * RENDER_MAX_PATH, "%.*s%s", folder, description->name, file);
}
