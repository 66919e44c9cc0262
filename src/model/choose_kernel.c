/* choose_kernel.c: which kernel a model will use: the one asked for, or the fastest. */
#include "model/choose_kernel.h"

#include "base/error.h"

#include <string.h>

hnbrdf_result hnbrdf_choose_kernel(hnbrdf_variant variant, const hnbrdf_kernel **kernel,
                                   hnbrdf_error *error)
{
    const hnbrdf_kernel *found = hnbrdf_kernel_of(variant);
    if (found) {
        *kernel = found;
        return HNBRDF_OK;
    }
    const char *name = hnbrdf_variant_name(variant);
    char names[96] = "";
    for (int v = HNBRDF_VARIANT_AUTO; hnbrdf_variant_name((hnbrdf_variant)v); ++v) {
        if (hnbrdf_variant_available((hnbrdf_variant)v)) {
            if (names[0])
                strcat(names, ", ");
            strcat(names, hnbrdf_variant_name((hnbrdf_variant)v));
        }
    }
    return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                       "variant is %s, expected one that this build and machine have: %s",
                       name ? name : "unknown", names);
}
