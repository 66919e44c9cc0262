/* describe_lists.c: the lists of a scene's text: they grow, and materials are found by name. */
#include "scene/words.h"

#include <stdlib.h>
#include <string.h>

int describe_find_material(const render_description *out, const char *name)
{
    for (int i = 0; i < out->material_count; i++)
        if (strcmp(out->materials[i].name, name) == 0)
            return i;
    return -1;
}

/* Room for one more element of an array that doubles at powers of two. */
void *describe_grown(void *array, int count, size_t element)
{
    if (count & (count - 1))
        return array;
    return realloc(array, (count ? 2 * (size_t)count : 1) * element);
}
