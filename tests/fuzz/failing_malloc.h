/* failing_malloc.h: malloc and its kin under test: they count, and fail on demand. The program is
 * linked with
 * --wrap for the four, which reaches every call from this project's code. */
#ifndef HNBRDF_TESTS_FAILING_MALLOC_H
#define HNBRDF_TESTS_FAILING_MALLOC_H

#include <stddef.h>

/* From now on allocation number `fail_at` (from 0) fails, none if it is negative. Counts start
 * anew. */
void failing_malloc_begin(long fail_at);
/* Ends that. How many allocations were asked for; *alive is how many more were made than freed. */
long failing_malloc_end(long *alive);

/* The same for a library that takes its allocator. */
void *failing_malloc(size_t size);
void failing_free(void *pointer);
/* 1 if the allocation that failed was that library's. */
int failing_malloc_was_foreign(void);

#endif
