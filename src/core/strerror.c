/* strerror.c: the words for results, and the version. */
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
