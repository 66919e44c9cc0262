/* loader.h: what the files that load a scene share. Inside load only. */
#ifndef HNBRDF_SCENE_LOADER_H
#define HNBRDF_SCENE_LOADER_H

#include "scene/describe.h"

#include "base/error.h"

typedef struct loader {
    const render_description *d;
    render_show show;
    const char *folder;
    render_reading reading;
    render_loaded *out;
    const char **model_files; /* of out->models */
    hnbrdf_error *error;
} loader;

/* Puts "FILE:LINE: " before the message that there is. */
static inline hnbrdf_result loader_at(const loader *l, long line, hnbrdf_result result)
{
    if (result != HNBRDF_OK && l->error) {
        hnbrdf_error cause = *l->error;
        hnbrdf_fail(l->error, result, "%s:%ld: %s", l->d->name, line, cause.text);
    }
    return result;
}

/* Makes and places all shapes. */
hnbrdf_result loader_shapes(const loader *l);

#endif
