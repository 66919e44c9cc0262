/* draw.h: a fragment shader over rows of numbers: a texture of them in, a float image out. Every
 * call waits until it is done. */
#ifndef HNBRDF_GL_DRAW_H
#define HNBRDF_GL_DRAW_H

#include "gl/context.h"

/* Rows of `texels` vec4, GL_ROW_LENGTH of them side by side, and one vec4 a row as result. */
enum { GL_ROW_LENGTH = 256 };

typedef struct gl_sheet {
    GLuint rows, image, framebuffer, vertices;
    int texels, height;
} gl_sheet;

/* For up to `count` rows. */
hnbrdf_result gl_sheet_open(const gl_context *context, int texels, size_t count, gl_sheet *sheet,
                            hnbrdf_error *error);
void gl_sheet_close(const gl_context *context, gl_sheet *sheet);
hnbrdf_result gl_sheet_upload(const gl_context *context, gl_sheet *sheet, const float *rows,
                              size_t count, hnbrdf_error *error);
/* The first `count` results, vec4 each, those of result k at to[k * stride]. */
hnbrdf_result gl_sheet_download(const gl_context *context, const gl_sheet *sheet, size_t count,
                                float *to, size_t stride, hnbrdf_error *error);

/* Behind a scene, whose first part gives GL ES its precision: what a fragment shader writes its
 * result to, and texel number i of its row of `texels`. */
#define GL_FRAME                                                        \
    "uniform highp sampler2D rows;\n"                                   \
    "uniform int slot;\n"                                               \
    "out vec4 result;\n"                                                \
    "vec4 texel(int i, int texels)\n"                                   \
    "{\n"                                                               \
    "    ivec2 at = ivec2(gl_FragCoord.xy);\n"                          \
    "    return texelFetch(rows, ivec2(texels * at.x + i, at.y), 0);\n" \
    "}\n"

/* A program with the fragment shader of these texts behind its #version line. HNBRDF_ERROR_FORMAT
 * with the first error line of the driver if it does not compile. */
hnbrdf_result gl_program_open(const gl_context *context, const char *const *texts, int count,
                              GLuint *program, hnbrdf_error *error);

/* Draws the first `count` rows, whole lines of them. */
hnbrdf_result gl_draw(const gl_context *context, const gl_sheet *sheet, GLuint program, int slot,
                      size_t count, hnbrdf_error *error);

/* Uniform buffer 0, and what of a program reads it: hnbrdf_weights_block. */
hnbrdf_result gl_weights_open(const gl_context *context, const void *bytes, size_t size,
                              GLuint *buffer, hnbrdf_error *error);
void gl_weights_use(const gl_context *context, GLuint program);

#endif
