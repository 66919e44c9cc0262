/* watch.c: telling how far the long functions are. */
#include "base/error.h"
#include "bench/bench.h"

hnbrdf_result bench_show(const bench_watch *watch, const char *what, double share,
                         const char *detail, hnbrdf_error *error)
{
    if (!watch->show || watch->show(watch->user, what, share, detail) == 0)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED, "interrupted while %s", what);
}
