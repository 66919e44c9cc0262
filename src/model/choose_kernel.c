/* choose_kernel.c: which kernel a model will use: as asked, as the environment says, or the
 * fastest. */
#include "model/choose_kernel.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST = HNBRDF_VARIANT_AUTO, LAST = HNBRDF_VARIANT_NEON };

/* The variant of a name, or -1. */
static int find(const char *name)
{
    for (int v = FIRST; v <= LAST; ++v)
        if (strcmp(name, hnbrdf_variant_name((hnbrdf_variant)v)) == 0)
            return v;
    return -1;
}

static hnbrdf_result fail(const char *source, const char *found, hnbrdf_error *error)
{
    char names[64] = "";
    for (int v = FIRST; v <= LAST; ++v) {
        if (hnbrdf_variant_available((hnbrdf_variant)v)) {
            if (names[0])
                strcat(names, ", ");
            strcat(names, hnbrdf_variant_name((hnbrdf_variant)v));
        }
    }
    return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                       "%s is %.40s, expected one that this build and machine have: %s", source,
                       found, names);
}

hnbrdf_result hnbrdf_choose_kernel(hnbrdf_variant variant, const hnbrdf_kernel **kernel,
                                   hnbrdf_error *error)
{
    const char *named = variant == HNBRDF_VARIANT_AUTO ? getenv("HNBRDF_VARIANT") : NULL;
    const char *source = "variant";
    int wanted = (int)variant;
    if (named && named[0]) {
        source = "the environment variable HNBRDF_VARIANT";
        wanted = find(named);
    } else {
        named = hnbrdf_variant_name(variant);
    }
    const hnbrdf_kernel *found = wanted >= FIRST ? hnbrdf_kernel_of((hnbrdf_variant)wanted) : NULL;
    if (!found)
        return fail(source, named ? named : "unknown", error);
    *kernel = found;
    return HNBRDF_OK;
}
