/* sort.h: heapsort. qsort() may allocate, which the library must do through its caller's
 * allocator. */
#ifndef HNBRDF_BASE_SORT_H
#define HNBRDF_BASE_SORT_H

#include <stddef.h>

typedef int (*hnbrdf_compare_fn)(const void *a, const void *b);

static inline void hnbrdf_sort_swap(unsigned char *a, unsigned char *b, size_t size)
{
    for (size_t i = 0; i < size; ++i) {
        const unsigned char byte = a[i];
        a[i] = b[i];
        b[i] = byte;
    }
}

static inline void hnbrdf_sort_sift(unsigned char *items, size_t parent, size_t count, size_t size,
                                    hnbrdf_compare_fn compare)
{
    size_t child;
    while ((child = 2 * parent + 1) < count) {
        if (child + 1 < count && compare(items + child * size, items + (child + 1) * size) < 0)
            ++child;
        if (compare(items + parent * size, items + child * size) >= 0)
            return;
        hnbrdf_sort_swap(items + parent * size, items + child * size, size);
        parent = child;
    }
}

/* Ascending, not stable, O(n log n) whatever the input. */
static inline void hnbrdf_sort(void *array, size_t count, size_t size, hnbrdf_compare_fn compare)
{
    unsigned char *items = (unsigned char *)array;
    for (size_t i = count / 2; i-- > 0;)
        hnbrdf_sort_sift(items, i, count, size, compare);
    for (size_t last = count; last-- > 1;) {
        hnbrdf_sort_swap(items, items + last * size, size);
        hnbrdf_sort_sift(items, 0, last, size, compare);
    }
}

#endif
