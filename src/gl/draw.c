/* draw.c: a fragment shader over rows of numbers. */
#include "gl/draw.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

/* ---- Rows and results ------------------------------------------------------------------------ */

static GLuint make_texture(const gl_functions *f, int width, int height)
{
    GLuint texture;
    f->GenTextures(1, &texture);
    f->ActiveTexture(GL_TEXTURE0);
    f->BindTexture(GL_TEXTURE_2D, texture);
    f->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, NULL);
    f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

static int lines_of(size_t count)
{
    return (int)((count + GL_ROW_LENGTH - 1) / GL_ROW_LENGTH);
}

hnbrdf_result gl_sheet_open(const gl_context *context, int texels, size_t count, gl_sheet *sheet,
                            hnbrdf_error *error)
{
    const gl_functions *f = &context->f;
    GLint most = 0;
    f->GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    *sheet = (gl_sheet){.texels = texels, .height = lines_of(count)};
    if (sheet->height > most || texels * GL_ROW_LENGTH > most)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: %zu rows, a texture has at most %d lines of %d", context->name,
                           count, (int)most, GL_ROW_LENGTH);
    sheet->image = make_texture(f, GL_ROW_LENGTH, sheet->height);
    sheet->rows = make_texture(f, texels * GL_ROW_LENGTH, sheet->height);
    f->GenFramebuffers(1, &sheet->framebuffer);
    f->BindFramebuffer(GL_FRAMEBUFFER, sheet->framebuffer);
    f->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, sheet->image, 0);
    f->GenVertexArrays(1, &sheet->vertices);
    hnbrdf_result result = gl_check(context, "making textures", error);
    if (!result && f->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        result = hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                             "%s: cannot render into RGBA32F images", context->name);
    if (result)
        gl_sheet_close(context, sheet);
    return result;
}

void gl_sheet_close(const gl_context *context, gl_sheet *sheet)
{
    const GLuint textures[] = {sheet->rows, sheet->image};
    context->f.DeleteTextures(2, textures);
    context->f.DeleteFramebuffers(1, &sheet->framebuffer);
    context->f.DeleteVertexArrays(1, &sheet->vertices);
    memset(sheet, 0, sizeof *sheet);
}

hnbrdf_result gl_sheet_upload(const gl_context *context, gl_sheet *sheet, const float *rows,
                              size_t count, hnbrdf_error *error)
{
    const gl_functions *f = &context->f;
    const size_t numbers = 4 * (size_t)sheet->texels, whole = count / GL_ROW_LENGTH;
    const int rest = (int)(count % GL_ROW_LENGTH);
    f->ActiveTexture(GL_TEXTURE0); /* others may hold textures of the caller */
    f->BindTexture(GL_TEXTURE_2D, sheet->rows);
    if (whole > 0)
        f->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, sheet->texels * GL_ROW_LENGTH, (GLsizei)whole,
                         GL_RGBA, GL_FLOAT, rows);
    if (rest > 0)
        f->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)whole, sheet->texels * rest, 1, GL_RGBA,
                         GL_FLOAT, rows + whole * GL_ROW_LENGTH * numbers);
    return gl_check(context, "writing a texture", error);
}

hnbrdf_result gl_sheet_download(const gl_context *context, const gl_sheet *sheet, size_t count,
                                float *to, size_t stride, hnbrdf_error *error)
{
    const int lines = lines_of(count);
    float *image = malloc((size_t)lines * GL_ROW_LENGTH * 4 * sizeof *image);
    if (!image)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", context->name);
    context->f.BindFramebuffer(GL_FRAMEBUFFER, sheet->framebuffer);
    context->f.ReadPixels(0, 0, GL_ROW_LENGTH, lines, GL_RGBA, GL_FLOAT, image);
    for (size_t k = 0; k < count; k++)
        memcpy(to + k * stride, image + 4 * k, 4 * sizeof *to);
    free(image);
    return gl_check(context, "reading an image", error);
}

/* ---- Programs -------------------------------------------------------------------------------- */

enum { LOG = 4096, LINE = 200 };

/* The first line of a log that tells an error, else its first line. */
static hnbrdf_result explain(const gl_context *context, const char *what, const char *log,
                             hnbrdf_error *error)
{
    const char *line = log;
    for (const char *at = log; *at; at += strcspn(at, "\n"), at += *at == '\n') {
        size_t length = strcspn(at, "\n");
        const char *found = strstr(at, "rror");
        if (found && found < at + length) {
            line = at;
            break;
        }
    }
    size_t length = strcspn(line, "\r\n");
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: %s: %.*s",
                       gl_dialect_name(context->dialect), what,
                       (int)(length < LINE ? length : LINE), length ? line : "no message");
}

/* `texts` behind the version line, and the frame of every fragment shader. */
static hnbrdf_result compile(const gl_context *context, GLenum stage, const char *const *texts,
                             int count, GLuint *shader, hnbrdf_error *error)
{
    const gl_functions *f = &context->f;
    const char *all[8] = {gl_dialect_version(context->dialect)};
    char log[LOG] = "";
    GLint compiled = 0;
    for (int i = 0; i < count; i++)
        all[1 + i] = texts[i];
    *shader = f->CreateShader(stage);
    f->ShaderSource(*shader, 1 + count, all, NULL);
    f->CompileShader(*shader);
    f->GetShaderiv(*shader, GL_COMPILE_STATUS, &compiled);
    if (compiled)
        return HNBRDF_OK;
    f->GetShaderInfoLog(*shader, LOG, NULL, log);
    return explain(context, stage == GL_FRAGMENT_SHADER ? "fragment shader" : "vertex shader", log,
                   error);
}

/* One triangle over everything. */
static const char VERTICES[] =
    "void main()\n{\n    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 "
    ": -1.0, 0.0, 1.0);\n}\n";

static hnbrdf_result link(const gl_context *context, GLuint program, hnbrdf_error *error)
{
    char log[LOG] = "";
    GLint linked = 0;
    context->f.LinkProgram(program);
    context->f.GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked)
        return gl_check(context, "linking", error);
    context->f.GetProgramInfoLog(program, LOG, NULL, log);
    return explain(context, "linking", log, error);
}

hnbrdf_result gl_program_open(const gl_context *context, const char *const *texts, int count,
                              GLuint *program, hnbrdf_error *error)
{
    const gl_functions *f = &context->f;
    const char *const vertices[] = {VERTICES};
    GLuint shaders[2] = {0, 0};
    *program = f->CreateProgram();
    hnbrdf_result result = compile(context, GL_VERTEX_SHADER, vertices, 1, &shaders[0], error);
    if (!result)
        result = compile(context, GL_FRAGMENT_SHADER, texts, count, &shaders[1], error);
    for (int i = 0; i < 2 && !result; i++)
        f->AttachShader(*program, shaders[i]);
    if (!result)
        result = link(context, *program, error);
    for (int i = 0; i < 2; i++)
        f->DeleteShader(shaders[i]);
    if (result) {
        f->DeleteProgram(*program);
        *program = 0;
    }
    return result;
}

hnbrdf_result gl_weights_open(const gl_context *context, const void *bytes, size_t size,
                              GLuint *buffer, hnbrdf_error *error)
{
    const gl_functions *f = &context->f;
    GLint most = 0;
    f->GetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &most);
    if (size > (size_t)most)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: a uniform block of %zu bytes, this device takes up to %d",
                           context->name, size, (int)most);
    f->GenBuffers(1, buffer);
    f->BindBuffer(GL_UNIFORM_BUFFER, *buffer);
    f->BufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)size, bytes, GL_STATIC_DRAW);
    f->BindBufferBase(GL_UNIFORM_BUFFER, 0, *buffer);
    return gl_check(context, "writing a uniform buffer", error);
}

void gl_weights_use(const gl_context *context, GLuint program)
{
    GLuint block = context->f.GetUniformBlockIndex(program, "hnbrdf_weights_block");
    if (block != GL_INVALID_INDEX)
        context->f.UniformBlockBinding(program, block, 0);
}

/* ---- Drawing --------------------------------------------------------------------------------- */

hnbrdf_result gl_draw(const gl_context *context, const gl_sheet *sheet, GLuint program, int slot,
                      size_t count, hnbrdf_error *error)
{
    const gl_functions *f = &context->f;
    f->UseProgram(program);
    f->ActiveTexture(GL_TEXTURE0);
    f->BindTexture(GL_TEXTURE_2D, sheet->rows);
    f->Uniform1i(f->GetUniformLocation(program, "rows"), 0);
    f->Uniform1i(f->GetUniformLocation(program, "slot"), slot);
    f->BindFramebuffer(GL_FRAMEBUFFER, sheet->framebuffer);
    f->BindVertexArray(sheet->vertices);
    if (count < GL_ROW_LENGTH)
        f->Viewport(0, 0, (GLsizei)count, 1);
    else
        f->Viewport(0, 0, GL_ROW_LENGTH, lines_of(count));
    f->DrawArrays(GL_TRIANGLES, 0, 3);
    f->Finish();
    return gl_check(context, "drawing", error);
}
