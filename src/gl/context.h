/* context.h: contexts of OpenGL and OpenGL ES through EGL, without a window or a surface. */
#ifndef HNBRDF_GL_CONTEXT_H
#define HNBRDF_GL_CONTEXT_H

#include "gl/functions.h"
#include "hnbrdf/hnbrdf.h"

#include <EGL/egl.h>

/* What a shader is written in, and the context it needs. */
typedef enum gl_dialect {
    GL_DIALECT_330 = 0, /* desktop GL 3.3 core */
    GL_DIALECT_450,     /* desktop GL 4.5 core: has `precise` */
    GL_DIALECT_ES_300,  /* GL ES 3.0 with float render targets */
    GL_DIALECT_ES_320,  /* GL ES 3.2, likewise: has `precise` */
    GL_DIALECTS
} gl_dialect;

/* "gl 330", "gl 450", "gles 300", "gles 320". */
const char *gl_dialect_name(gl_dialect dialect);
/* The line "#version ..." with its end. */
const char *gl_dialect_version(gl_dialect dialect);
int gl_dialect_is_es(gl_dialect dialect);

enum { GL_MAX_DISPLAYS = 8, GL_NAME = 128 };

/* The displays of this machine: one a device, or Mesa's without a surface. */
typedef struct gl_instance {
    int count;
    EGLDisplay displays[GL_MAX_DISPLAYS];
} gl_instance;

/* No EGL, or no display, is no error: count is then 0. */
void gl_open(gl_instance *instance);
void gl_close(gl_instance *instance);

/* A context that is current while it is open; one at a time. */
typedef struct gl_context {
    EGLDisplay display;
    EGLContext handle;
    gl_dialect dialect;
    gl_functions f;
    char name[GL_NAME], version[GL_NAME]; /* of the renderer; of the driver */
} gl_context;

/* HNBRDF_ERROR_UNSUPPORTED if the display does not offer it. */
hnbrdf_result gl_context_open(const gl_instance *instance, int display, gl_dialect dialect,
                              gl_context *context, hnbrdf_error *error);
void gl_context_close(gl_context *context);

/* Fails with what was being done if GL reports an error since the last call. */
hnbrdf_result gl_check(const gl_context *context, const char *what, hnbrdf_error *error);

#endif
