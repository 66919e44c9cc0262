/* export_brdf.h: one material as a file of BRDF Explorer, in the form of the published ones. */
#ifndef HNBRDF_GLSL_EXPORT_BRDF_H
#define HNBRDF_GLSL_EXPORT_BRDF_H

#include "glsl/export_scene.h"
#include "hnbrdf/glsl.h"

/* What hnbrdf_model_import_brdf() needs to know, the material as parameters, then as a shader what
 * is needed of shaders/hybrid_brdf.glsl without its directives, hardGeLU, mlp_eval and BRDF(L, V,
 * N, X, Y): programs that read such files pass over every line that begins with '#', in the shader
 * too. */
hnbrdf_result hnbrdf_write_brdf(const hnbrdf_scene *s, const hnbrdf_glsl_options *options,
                                const hnbrdf_allocator *memory, hnbrdf_write_fn write, void *user,
                                hnbrdf_error *error);

#endif
