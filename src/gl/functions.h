/* functions.h: the functions of GL 3.3 and GL ES 3.0 that are called, as pointers: no GL library is
 * linked. */
#ifndef HNBRDF_GL_FUNCTIONS_H
#define HNBRDF_GL_FUNCTIONS_H

#include <GL/glcorearb.h>

/* X(type, name without gl) */
#define GL_FUNCTIONS(X)                                        \
    X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                   \
    X(PFNGLATTACHSHADERPROC, AttachShader)                     \
    X(PFNGLBINDBUFFERPROC, BindBuffer)                         \
    X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)                 \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)               \
    X(PFNGLBINDTEXTUREPROC, BindTexture)                       \
    X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)               \
    X(PFNGLBUFFERDATAPROC, BufferData)                         \
    X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus) \
    X(PFNGLCOMPILESHADERPROC, CompileShader)                   \
    X(PFNGLCREATEPROGRAMPROC, CreateProgram)                   \
    X(PFNGLCREATESHADERPROC, CreateShader)                     \
    X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                   \
    X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)         \
    X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                   \
    X(PFNGLDELETESHADERPROC, DeleteShader)                     \
    X(PFNGLDELETETEXTURESPROC, DeleteTextures)                 \
    X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)         \
    X(PFNGLDRAWARRAYSPROC, DrawArrays)                         \
    X(PFNGLFINISHPROC, Finish)                                 \
    X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D)     \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                         \
    X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)               \
    X(PFNGLGENTEXTURESPROC, GenTextures)                       \
    X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)               \
    X(PFNGLGETERRORPROC, GetError)                             \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                       \
    X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)           \
    X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                     \
    X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)             \
    X(PFNGLGETSHADERIVPROC, GetShaderiv)                       \
    X(PFNGLGETSTRINGPROC, GetString)                           \
    X(PFNGLGETSTRINGIPROC, GetStringi)                         \
    X(PFNGLGETUNIFORMBLOCKINDEXPROC, GetUniformBlockIndex)     \
    X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)         \
    X(PFNGLLINKPROGRAMPROC, LinkProgram)                       \
    X(PFNGLREADPIXELSPROC, ReadPixels)                         \
    X(PFNGLSHADERSOURCEPROC, ShaderSource)                     \
    X(PFNGLTEXIMAGE2DPROC, TexImage2D)                         \
    X(PFNGLTEXPARAMETERIPROC, TexParameteri)                   \
    X(PFNGLTEXSUBIMAGE2DPROC, TexSubImage2D)                   \
    X(PFNGLUNIFORM1IPROC, Uniform1i)                           \
    X(PFNGLUNIFORMBLOCKBINDINGPROC, UniformBlockBinding)       \
    X(PFNGLUSEPROGRAMPROC, UseProgram)                         \
    X(PFNGLVIEWPORTPROC, Viewport)

typedef struct gl_functions {
#define X(type, name) type name;
    GL_FUNCTIONS(X)
#undef X
} gl_functions;

#endif
