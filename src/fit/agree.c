/* agree.c: what every rank came to, told to all. */
#include "base/error.h"
#include "hnbrdf/fit.h"

#include <stdlib.h>

typedef struct verdict {
    int32_t result, flag;
} verdict;

static hnbrdf_result fail_lost(const hnbrdf_communicator *ranks, hnbrdf_error *error)
{
    return hnbrdf_fail(error, HNBRDF_ERROR_IO, "another of %d ranks has ended or cannot be reached",
                       ranks->size);
}

/* all and bytes [ranks] are room. */
static hnbrdf_result agree(const hnbrdf_communicator *ranks, hnbrdf_result mine, int *flag,
                           verdict *all, size_t *bytes, hnbrdf_error *error)
{
    const verdict own = {(int32_t)mine, flag ? *flag : 0};
    hnbrdf_error text = {""};
    int failed = -1;
    for (int r = 0; r < ranks->size; r++)
        bytes[r] = sizeof *all;
    if (ranks->gather(ranks->user, &own, all, bytes))
        return fail_lost(ranks, error);
    for (int r = ranks->size - 1; r >= 0; r--) {
        failed = all[r].result ? r : failed;
        if (flag)
            *flag |= all[r].flag;
    }
    if (failed < 0)
        return HNBRDF_OK;
    if (failed == ranks->rank && error)
        text = *error;
    if (ranks->broadcast(ranks->user, &text, sizeof text, failed))
        return fail_lost(ranks, error);
    return hnbrdf_fail(error, (hnbrdf_result)all[failed].result, "%s", text.text);
}

hnbrdf_result hnbrdf_ranks_agree(const hnbrdf_communicator *ranks, hnbrdf_result mine, int *flag,
                                 hnbrdf_error *error)
{
    if (!ranks || ranks->size == 1)
        return mine;
    const size_t size = (size_t)ranks->size;
    verdict *all = calloc(size, sizeof *all);
    size_t *bytes = calloc(size, sizeof *bytes);
    hnbrdf_result result = HNBRDF_ERROR_MEMORY;
    if (all && bytes)
        result = agree(ranks, mine, flag, all, bytes, error);
    else
        hnbrdf_fail(error, result, "out of memory for %d ranks", ranks->size);
    free(all);
    free(bytes);
    return result;
}
