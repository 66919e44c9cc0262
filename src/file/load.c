/* load.c: read a model file whole, from a file, a callback or memory. */
#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "file/safetensors.h"
#include "model/choose_kernel.h"

#include <stdio.h>
#include <string.h>

static const size_t DEFAULT_MAX_BYTES = (size_t)256 << 20;
enum { FIRST_CHUNK = 1 << 16 };

/* ---- Bytes ----------------------------------------------------------------------------------- */

typedef struct source {
    const char *path;
    hnbrdf_allocator memory;
    hnbrdf_variant variant;
    hnbrdf_notes notes;
    size_t max_bytes;
    hnbrdf_read_fn read;
    void *read_user;
    hnbrdf_error *error;
} source;

static size_t read_stream(void *user, void *buffer, size_t size)
{
    const size_t count = fread(buffer, 1, size, (FILE *)user);
    return count < size && ferror((FILE *)user) ? (size_t)-1 : count;
}

static hnbrdf_result fail_size(const source *s)
{
    return hnbrdf_fail(s->error, HNBRDF_ERROR_LIMIT,
                       "%s: is larger than %zu bytes, the limit set for it", s->path, s->max_bytes);
}

/* Twice the room, with what is there. */
static hnbrdf_result grow(const source *s, unsigned char **bytes, size_t *room)
{
    const size_t wanted = *room == 0 ? (size_t)FIRST_CHUNK : *room * 2;
    void *larger = *room <= SIZE_MAX / 2 ? hnbrdf_allocate(&s->memory, wanted) : NULL;
    if (!larger)
        return hnbrdf_fail_memory(s->error, wanted, s->path);
    if (*bytes) {
        memcpy(larger, *bytes, *room);
        hnbrdf_release(&s->memory, *bytes);
    }
    *bytes = (unsigned char *)larger;
    *room = wanted;
    return HNBRDF_OK;
}

/* Everything up to the end. *bytes is the caller's to release, also on failure. */
static hnbrdf_result read_all(const source *s, unsigned char **bytes, size_t *size)
{
    size_t room = 0;
    *bytes = NULL;
    *size = 0;
    for (;;) {
        hnbrdf_result result;
        if (*size == room && (result = grow(s, bytes, &room)))
            return result;
        const size_t count = s->read(s->read_user, *bytes + *size, room - *size);
        if (count == 0)
            return HNBRDF_OK;
        if (count > room - *size) {
            return hnbrdf_fail(s->error, HNBRDF_ERROR_IO, "%s: cannot be read beyond byte %zu",
                               s->path, *size);
        }
        *size += count;
        if (*size > s->max_bytes)
            return fail_size(s);
    }
}

/* ---- Loading --------------------------------------------------------------------------------- */

static hnbrdf_result load_bytes(const source *s, const unsigned char *bytes, size_t size,
                                hnbrdf_model **model)
{
    hnbrdf_safetensors file;
    const hnbrdf_result result =
        hnbrdf_safetensors_read(s->path, bytes, size, &s->memory, &file, s->error);
    return result ? result
                  : hnbrdf_safetensors_decode(s->path, &file, &s->memory, s->variant, &s->notes,
                                              model, s->error);
}

static hnbrdf_result begin(const char *path, const hnbrdf_load_options *options,
                           hnbrdf_model **model, hnbrdf_error *error, source *s)
{
    static const hnbrdf_load_options defaults = {0};
    const hnbrdf_load_options *chosen = options ? options : &defaults;
    const hnbrdf_kernel *kernel = NULL;
    hnbrdf_result result;
    s->path = path;
    s->max_bytes = chosen->max_bytes ? chosen->max_bytes : DEFAULT_MAX_BYTES;
    s->read = chosen->read;
    s->read_user = chosen->read_user;
    s->notes = chosen->notes;
    s->error = error;
    if (!model) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "%s: model is NULL, expected a place for it", path);
    }
    if ((result = hnbrdf_choose_kernel(chosen->variant, &kernel, error)))
        return result; /* before anything is read */
    s->variant = kernel->variant;
    return hnbrdf_choose_allocator(&chosen->allocator, &s->memory, error);
}

hnbrdf_result hnbrdf_model_load_memory(const void *data, size_t size,
                                       const hnbrdf_load_options *options, hnbrdf_model **model,
                                       hnbrdf_error *error)
{
    source s;
    const hnbrdf_result result = begin("model in memory", options, model, error, &s);
    if (result)
        return result;
    if (!data)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s: data is NULL", s.path);
    return size > s.max_bytes ? fail_size(&s)
                              : load_bytes(&s, (const unsigned char *)data, size, model);
}

hnbrdf_result hnbrdf_model_load(const char *path, const hnbrdf_load_options *options,
                                hnbrdf_model **model, hnbrdf_error *error)
{
    FILE *file = NULL;
    unsigned char *bytes;
    size_t size;
    source s;
    hnbrdf_result result = begin(path ? path : "model", options, model, error, &s);
    if (result)
        return result;
    if (!s.read) {
        if (!path) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "path is NULL, expected a file's path");
        }
        if (!(file = hnbrdf_open_whole(path, path, error)))
            return HNBRDF_ERROR_IO;
        s.read = read_stream;
        s.read_user = file;
    }
    result = read_all(&s, &bytes, &size);
    if (file)
        fclose(file);
    if (!result)
        result = load_bytes(&s, bytes, size, model);
    hnbrdf_release(&s.memory, bytes);
    return result;
}
