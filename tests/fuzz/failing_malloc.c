/* failing_malloc.c: see failing_malloc.h. Several threads may call. */
#include "failing_malloc.h"

#include <stdatomic.h>
#include <stdint.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *pointer, size_t size);
void __real_free(void *pointer);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *pointer, size_t size);
void __wrap_free(void *pointer);

static atomic_long calls, alive, fail_at;
static atomic_int counting, foreign;

void failing_malloc_begin(long number)
{
    atomic_store(&calls, 0);
    atomic_store(&alive, 0);
    atomic_store(&fail_at, number);
    atomic_store(&foreign, 0);
    atomic_store(&counting, 1);
}

long failing_malloc_end(long *still_alive)
{
    atomic_store(&counting, 0);
    *still_alive = atomic_load(&alive);
    return atomic_load(&calls);
}

static int fails(void)
{
    return atomic_load(&counting) && atomic_fetch_add(&calls, 1) == atomic_load(&fail_at);
}

static void *made(void *pointer)
{
    if (pointer && atomic_load(&counting))
        atomic_fetch_add(&alive, 1);
    return pointer;
}

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : made(__real_malloc(size));
}

void *__wrap_calloc(size_t count, size_t size)
{
    return fails() ? NULL : made(__real_calloc(count, size));
}

void *__wrap_realloc(void *pointer, size_t size)
{
    if (fails())
        return NULL;
    return pointer ? __real_realloc(pointer, size) : made(__real_malloc(size));
}

void __wrap_free(void *pointer)
{
    if (pointer && atomic_load(&counting))
        atomic_fetch_sub(&alive, 1);
    __real_free(pointer);
}

void *failing_malloc(size_t size)
{
    void *pointer = __wrap_malloc(size);
    if (!pointer)
        atomic_store(&foreign, 1);
    return pointer;
}

int failing_malloc_was_foreign(void)
{
    return atomic_load(&foreign);
}

void failing_free(void *pointer)
{
    __wrap_free(pointer);
}
