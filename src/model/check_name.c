/* check_name.c: what may be the name of a material. */
#include "model/check_name.h"

#include "base/error.h"
#include "base/text.h"

#include <string.h>

hnbrdf_result hnbrdf_check_name(const char *name, hnbrdf_error *error)
{
    const char *end = name ? (const char *)memchr(name, '\0', HNBRDF_MAX_NAME + 1) : NULL;
    if (!name || !end || end == name) {
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "is %s, expected 1 to %d bytes",
                           !name ? "NULL"
                           : end ? "empty"
                                 : "longer",
                           HNBRDF_MAX_NAME);
    }
    for (const char *at = name; at < end;) {
        const size_t length = hnbrdf_utf8_length(at, end);
        const unsigned char first = (unsigned char)at[0];
        if (length == 0) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "has byte 0x%02x at %d, expected UTF-8", (unsigned)first,
                               (int)(at - name));
        }
        if (first < 0x20 || first == 0x7f || (first == 0xc2 && (unsigned char)at[1] < 0xa0)) {
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "has a control character at byte %d, expected none",
                               (int)(at - name));
        }
        at += length;
    }
    return HNBRDF_OK;
}
