/* strerror.c: the words for results and for the choices a caller has, and the version. */
#include "hnbrdf/hnbrdf.h"

const char *hnbrdf_version(void)
{
    return HNBRDF_VERSION_STRING;
}

const char *hnbrdf_strerror(hnbrdf_result result)
{
    switch (result) {
    case HNBRDF_OK:
        return "success";
    case HNBRDF_ERROR_ARGUMENT:
        return "an argument is out of its range";
    case HNBRDF_ERROR_IO:
        return "a file cannot be opened, read or written";
    case HNBRDF_ERROR_FORMAT:
        return "the data are not in the expected format";
    case HNBRDF_ERROR_UNSUPPORTED:
        return "the data are well-formed but not supported";
    case HNBRDF_ERROR_LIMIT:
        return "a limit is exceeded";
    case HNBRDF_ERROR_MEMORY:
        return "out of memory";
    case HNBRDF_ERROR_CANCELLED:
        return "cancelled";
    }
    return "unknown result";
}

const char *hnbrdf_kind_name(hnbrdf_kind kind)
{
    switch (kind) {
    case HNBRDF_KIND_HYBRID:
        return "hybrid";
    case HNBRDF_KIND_NEURAL:
        return "neural";
    case HNBRDF_KIND_GGX:
        return "ggx";
    }
    return NULL;
}

const char *hnbrdf_encoding_name(hnbrdf_encoding encoding)
{
    switch (encoding) {
    case HNBRDF_ENCODING_DIRECTIONS:
        return "directions";
    case HNBRDF_ENCODING_HALF_DIFFERENCE:
        return "half-difference";
    case HNBRDF_ENCODING_ANGLES_DIRECTED:
        return "angles-directed";
    case HNBRDF_ENCODING_ANGLES:
        return "angles";
    case HNBRDF_ENCODING_ANGLES_ANISOTROPIC:
        return "angles-anisotropic";
    }
    return NULL;
}

const char *hnbrdf_glsl_weights_name(hnbrdf_glsl_weights weights)
{
    switch (weights) {
    case HNBRDF_GLSL_CONSTANTS:
        return "constants";
    case HNBRDF_GLSL_COLUMNS:
        return "columns";
    case HNBRDF_GLSL_UNIFORM:
        return "uniform";
    }
    return NULL;
}

const char *hnbrdf_glsl_precision_name(hnbrdf_glsl_precision precision)
{
    switch (precision) {
    case HNBRDF_GLSL_FLOAT:
        return "float";
    case HNBRDF_GLSL_HALF:
        return "half";
    }
    return NULL;
}
