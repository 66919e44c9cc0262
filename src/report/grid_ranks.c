/* grid_ranks.c: the entries of a report made by several processes: the first one together, as all
 * need it, then each process one in turn. */
#include "report/grid.h"

#include "base/error.h"

#include <string.h>

int report_rank(const report *r)
{
    return r->ranks ? r->ranks->rank : 0;
}

int report_rank_count(const report *r)
{
    return r->ranks ? r->ranks->size : 1;
}

hnbrdf_result report_agree(const report *r, hnbrdf_result mine, int *flag)
{
    return hnbrdf_ranks_agree(r->ranks, mine, flag, r->error);
}

static hnbrdf_result spread(const report *r, int from, void *data, size_t bytes)
{
    if (!r->ranks || !r->ranks->broadcast(r->ranks->user, data, bytes, from))
        return HNBRDF_OK;
    return hnbrdf_fail(r->error, HNBRDF_ERROR_IO,
                       "another of %d ranks has ended or cannot be reached", r->ranks->size);
}

hnbrdf_result report_spread_entry(const report *r, int from, report_entry *e)
{
    const size_t count = (size_t)r->data.count;
    hnbrdf_comparison *errors = e->errors;
    report_picture *pictures = e->pictures;
    unsigned char *judged = e->judged;
    hnbrdf_result result = spread(r, from, e, sizeof *e);
    e->errors = errors; /* not those of another process */
    e->pictures = pictures;
    e->judged = judged;
    if (result == HNBRDF_OK)
        result = spread(r, from, errors, REPORT_SAMPLERS * count * sizeof *errors);
    if (result == HNBRDF_OK)
        result = spread(r, from, judged, count * sizeof *judged);
    return result == HNBRDF_OK ? spread(r, from, pictures, count * sizeof *pictures) : result;
}
