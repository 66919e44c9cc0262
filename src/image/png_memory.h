/* png_memory.h: memory for stb_image_write, which writes through what malloc returned without
 * looking: when there is no more, everything it holds is freed and control leaves it by longjmp.
 * For png.c alone. */
#ifndef HNBRDF_IMAGE_PNG_MEMORY_H
#define HNBRDF_IMAGE_PNG_MEMORY_H

#include <setjmp.h>
#include <stddef.h>
#include <stdlib.h>

typedef union png_block {
    struct {
        union png_block *previous, *next;
    } link;
    max_align_t alignment;
} png_block;

/* One call of the compressor; a thread has one at a time. */
typedef struct png_memory {
    png_block *blocks;
    jmp_buf exhausted;
} png_memory;

static _Thread_local png_memory *png_current;

static void png_unlink(png_block *block)
{
    if (block->link.previous)
        block->link.previous->link.next = block->link.next;
    else
        png_current->blocks = block->link.next;
    if (block->link.next)
        block->link.next->link.previous = block->link.previous;
}

static void png_free(void *pointer)
{
    if (!pointer)
        return;
    png_block *block = (png_block *)pointer - 1;
    png_unlink(block);
    free(block);
}

/* malloc where pointer is NULL; returns only with memory. */
static void *png_realloc(void *pointer, size_t size)
{
    png_block *old = pointer ? (png_block *)pointer - 1 : NULL;
    if (old)
        png_unlink(old);
    png_block *block =
        size <= (size_t)-1 - sizeof *block ? realloc(old, sizeof *block + size) : NULL;
    if (!block) {
        free(old);
        while (png_current->blocks)
            png_free(png_current->blocks + 1);
        longjmp(png_current->exhausted, 1);
    }
    block->link.previous = NULL;
    block->link.next = png_current->blocks;
    if (block->link.next)
        block->link.next->link.previous = block;
    png_current->blocks = block;
    return block + 1;
}

#define STBIW_MALLOC(size) png_realloc(NULL, (size_t)(size))
#define STBIW_REALLOC(pointer, size) png_realloc(pointer, (size_t)(size))
#define STBIW_FREE(pointer) png_free(pointer)

#endif
