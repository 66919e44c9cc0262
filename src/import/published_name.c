/* published_name.c: the material that a published shader's file name stands for. */
#include "hnbrdf/hnbrdf.h"

#include <string.h>

/* Behind one or more digits, or NULL. */
static const char *skip_number(const char *text)
{
    const size_t digits = strspn(text, "0123456789");
    return digits ? text + digits : NULL;
}

/* Behind "Ours_ld4_32x2_", whatever the numbers, or NULL. */
static const char *skip_prefix(const char *name)
{
    static const char METHOD[] = "Ours_ld";
    const char *at =
        strncmp(name, METHOD, sizeof METHOD - 1) == 0 ? name + sizeof METHOD - 1 : NULL;
    at = at ? skip_number(at) : NULL;
    at = at && *at == '_' ? skip_number(at + 1) : NULL;
    at = at && *at == 'x' ? skip_number(at + 1) : NULL;
    return at && *at == '_' ? at + 1 : NULL;
}

int hnbrdf_import_name(const char *path, char *name, size_t size)
{
    static const char COLOUR[] = "_rgb";
    const size_t ending = sizeof COLOUR - 1;
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    size_t length = dot && dot != base ? (size_t)(dot - base) : strlen(base);
    const char *prefix = skip_prefix(base);
    const int published = prefix && prefix < base + length;
    if (published) {
        length -= (size_t)(prefix - base);
        base = prefix;
        if (length > ending && memcmp(base + length - ending, COLOUR, ending) == 0)
            length -= ending;
    }
    if (size > 0) {
        const size_t copied = length < size ? length : size - 1;
        memcpy(name, base, copied);
        name[copied] = '\0';
    }
    return published;
}
