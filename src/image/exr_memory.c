/* exr_memory.c: OpenEXR files in memory, and what the library says when it fails. */
#include "image/exr.h"

#include "base/error.h"

#include <string.h>

/* Of the call under way. The library may hold its lock while it reports, and would wait for
 * itself if it were asked for its user data then. */
static _Thread_local exr_memory *reporting;

static void keep_message(exr_const_context_t context, exr_result_t code, const char *text)
{
    (void)context;
    if (reporting && code == EXR_ERR_OUT_OF_MEMORY)
        reporting->out_of_memory = 1;        /* what is returned in the end may be another error */
    if (reporting && !reporting->message[0]) /* the first one names the cause */
        snprintf(reporting->message, sizeof reporting->message, "%s", text ? text : "");
}

/* Like pread: fewer bytes near the end, 0 beyond it; the library asks for headers block by
 * block. */
static int64_t read_memory(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    const exr_memory *memory = user;
    (void)context, (void)fail;
    if (offset >= memory->size)
        return 0;
    if (size > memory->size - offset)
        size = memory->size - offset;
    memcpy(buffer, memory->data + offset, size);
    return (int64_t)size;
}

static int64_t memory_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const exr_memory *)user)->size;
}

static int64_t write_memory(exr_const_context_t context, void *user, const void *buffer,
                            uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    exr_memory *memory = user;
    if (render_bytes_put(memory->bytes, offset, buffer, size)) {
        memory->out_of_memory = 1;
        fail(context, EXR_ERR_OUT_OF_MEMORY, "no memory");
        return -1;
    }
    return (int64_t)size;
}

exr_context_initializer_t exr_memory_start(exr_memory *memory)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.user_data = memory;
    init.error_handler_fn = keep_message;
    if (memory->bytes) {
        init.write_fn = write_memory;
    } else {
        init.read_fn = read_memory;
        init.size_fn = memory_size;
    }
    reporting = memory;
    init.max_image_width = init.max_image_height = RENDER_MAX_SIDE;
    init.max_tile_width = init.max_tile_height = RENDER_MAX_SIDE;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return init;
}

void exr_memory_done(void)
{
    reporting = NULL;
}

hnbrdf_result exr_library_error(const exr_input *in, exr_result_t result)
{
    const exr_memory *memory = in->memory;
    const int exhausted = memory->out_of_memory || result == EXR_ERR_OUT_OF_MEMORY;
    return hnbrdf_fail(
        in->error, exhausted ? HNBRDF_ERROR_MEMORY : HNBRDF_ERROR_FORMAT, "%s: OpenEXR: %s",
        in->name, memory->message[0] ? memory->message : exr_get_default_error_message(result));
}
