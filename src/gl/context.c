/* context.c: contexts of OpenGL and OpenGL ES through EGL, without a window or a surface. */
#include "gl/context.h"

#include "base/error.h"

#include <EGL/eglext.h>
#include <stdio.h>
#include <string.h>

typedef struct dialect_facts {
    const char *name, *version;
    int is_es, major, minor;
} dialect_facts;

static const dialect_facts DIALECTS[GL_DIALECTS] = {{"gl 330", "#version 330 core\n", 0, 3, 3},
                                                    {"gl 450", "#version 450 core\n", 0, 4, 5},
                                                    {"gles 300", "#version 300 es\n", 1, 3, 0},
                                                    {"gles 320", "#version 320 es\n", 1, 3, 2}};

const char *gl_dialect_name(gl_dialect dialect)
{
    return DIALECTS[dialect].name;
}

const char *gl_dialect_version(gl_dialect dialect)
{
    return DIALECTS[dialect].version;
}

int gl_dialect_is_es(gl_dialect dialect)
{
    return DIALECTS[dialect].is_es;
}

/* ---- Displays -------------------------------------------------------------------------------- */

/* 1 if the name is one of the words of a list. */
static int has_word(const char *list, const char *name)
{
    size_t length = strlen(name);
    for (const char *at = list; at && (at = strstr(at, name)); at += length)
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0'))
            return 1;
    return 0;
}

static void add_display(gl_instance *instance, EGLDisplay display)
{
    if (display == EGL_NO_DISPLAY || instance->count == GL_MAX_DISPLAYS ||
        !eglInitialize(display, NULL, NULL))
        return;
    instance->displays[instance->count++] = display;
}

static EGLDisplay platform_display(EGLenum platform, void *native)
{
    PFNEGLGETPLATFORMDISPLAYEXTPROC get =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    return get ? get(platform, native, NULL) : EGL_NO_DISPLAY;
}

static void add_devices(gl_instance *instance)
{
    PFNEGLQUERYDEVICESEXTPROC query =
        (PFNEGLQUERYDEVICESEXTPROC)eglGetProcAddress("eglQueryDevicesEXT");
    EGLDeviceEXT devices[GL_MAX_DISPLAYS];
    EGLint count = 0;
    if (!query || !query(GL_MAX_DISPLAYS, devices, &count))
        return;
    for (EGLint i = 0; i < count; i++)
        add_display(instance, platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i]));
}

void gl_open(gl_instance *instance)
{
    memset(instance, 0, sizeof *instance);
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (has_word(extensions, "EGL_EXT_platform_device"))
        add_devices(instance);
    if (instance->count == 0 && has_word(extensions, "EGL_MESA_platform_surfaceless"))
        add_display(instance, platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY));
}

void gl_close(gl_instance *instance)
{
    for (int i = 0; i < instance->count; i++)
        eglTerminate(instance->displays[i]);
    eglReleaseThread();
    memset(instance, 0, sizeof *instance);
}

/* ---- Contexts -------------------------------------------------------------------------------- */

static hnbrdf_result unsupported(const gl_context *context, const char *what, hnbrdf_error *error)
{
    return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED, "%s: %s", DIALECTS[context->dialect].name,
                       what);
}

static hnbrdf_result create(gl_context *context, hnbrdf_error *error)
{
    const dialect_facts *facts = &DIALECTS[context->dialect];
    const EGLint es[] = {EGL_CONTEXT_MAJOR_VERSION, facts->major, EGL_CONTEXT_MINOR_VERSION,
                         facts->minor, EGL_NONE};
    const EGLint core[] = {EGL_CONTEXT_MAJOR_VERSION,
                           facts->major,
                           EGL_CONTEXT_MINOR_VERSION,
                           facts->minor,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_NONE};
    const char *extensions = eglQueryString(context->display, EGL_EXTENSIONS);
    if (!has_word(extensions, "EGL_KHR_surfaceless_context") ||
        !has_word(extensions, "EGL_KHR_no_config_context"))
        return unsupported(context, "EGL offers no context without a surface", error);
    if (eglBindAPI(facts->is_es ? EGL_OPENGL_ES_API : EGL_OPENGL_API))
        context->handle = eglCreateContext(context->display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT,
                                           facts->is_es ? es : core);
    if (context->handle == EGL_NO_CONTEXT)
        return unsupported(context, "not offered by this driver", error);
    if (!eglMakeCurrent(context->display, EGL_NO_SURFACE, EGL_NO_SURFACE, context->handle))
        return unsupported(context, "a context that cannot be used without a surface", error);
    return HNBRDF_OK;
}

static hnbrdf_result load_functions(gl_context *context, hnbrdf_error *error)
{
    int complete = 1;
#define X(type, name)                                      \
    context->f.name = (type)eglGetProcAddress("gl" #name); \
    complete = complete && context->f.name;
    GL_FUNCTIONS(X)
#undef X
    return complete ? HNBRDF_OK : unsupported(context, "the driver lacks functions of it", error);
}

static int has_extension(const gl_context *context, const char *name)
{
    GLint count = 0;
    context->f.GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; i++)
        if (strcmp((const char *)context->f.GetStringi(GL_EXTENSIONS, (GLuint)i), name) == 0)
            return 1;
    return 0;
}

static void copy_name(char to[GL_NAME], const GLubyte *from)
{
    snprintf(to, GL_NAME, "%s", from ? (const char *)from : "unknown");
}

hnbrdf_result gl_context_open(const gl_instance *instance, int display, gl_dialect dialect,
                              gl_context *context, hnbrdf_error *error)
{
    memset(context, 0, sizeof *context);
    context->display = instance->displays[display];
    context->dialect = dialect;
    hnbrdf_result result = create(context, error);
    if (!result)
        result = load_functions(context, error);
    if (!result && gl_dialect_is_es(dialect) &&
        !has_extension(context, "GL_EXT_color_buffer_float"))
        result = unsupported(context, "no GL_EXT_color_buffer_float, which results need", error);
    if (result) {
        gl_context_close(context);
        return result;
    }
    copy_name(context->name, context->f.GetString(GL_RENDERER));
    copy_name(context->version, context->f.GetString(GL_VERSION));
    return HNBRDF_OK;
}

void gl_context_close(gl_context *context)
{
    if (context->handle != EGL_NO_CONTEXT) {
        eglMakeCurrent(context->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(context->display, context->handle);
    }
    memset(context, 0, sizeof *context);
}

hnbrdf_result gl_check(const gl_context *context, const char *what, hnbrdf_error *error)
{
    GLenum code = context->f.GetError();
    return code == GL_NO_ERROR ? HNBRDF_OK
                               : hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED, "%s: %s: error 0x%x",
                                             DIALECTS[context->dialect].name, what, code);
}
