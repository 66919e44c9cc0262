/* verify.h: an exported scene in a GL or GL ES context against the C library, stage by stage. */
#ifndef HNBRDF_GL_VERIFY_H
#define HNBRDF_GL_VERIFY_H

#include "check/verify.h"
#include "gl/draw.h"

/* text: of hnbrdf_export_shader(), standalone; weights: of hnbrdf_export_weights(), or NULL. */
typedef struct gl_verify_options {
    const char *text;
    const void *weights;
    size_t weights_size;
    check_verify_options check;
    int without_timing;
} gl_verify_options;

/* As check_verify(), with fragment shaders. */
hnbrdf_result gl_verify(const gl_context *context, const hnbrdf_model *model,
                        const gl_verify_options *options, check_report *report,
                        hnbrdf_error *error);

/* ---- In steps, so that one program serves several networks ----------------------------------- */

typedef struct gl_verifier {
    const gl_context *context;
    const char *text;
    gl_sheet sheet;
    GLuint programs[CHECK_BUILDS], weights;
} gl_verifier;

/* For up to `pairs` pairs. The text must outlive it. */
hnbrdf_result gl_verifier_open(const gl_context *context, const char *text, size_t pairs,
                               gl_verifier *verifier, hnbrdf_error *error);
/* What the uniform block holds from now on. */
hnbrdf_result gl_verifier_load(gl_verifier *verifier, const void *weights, size_t size,
                               hnbrdf_error *error);
hnbrdf_result gl_verifier_check(gl_verifier *verifier, const hnbrdf_model *model,
                                const check_verify_options *options, check_report *report,
                                hnbrdf_error *error);
void gl_verifier_close(gl_verifier *verifier);

#endif
