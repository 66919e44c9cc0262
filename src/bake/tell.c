/* tell.c: the progress callback of a bake, one thread at a time. */
#include "bake/task.h"

#include <math.h>

int hnbrdf_bake_is_stopped(const bake_task *b)
{
    return atomic_load(&b->stopped);
}

static void call(bake_task *b, const hnbrdf_bake_progress *progress)
{
    hnbrdf_bake_progress copy = *progress;
    copy.report = &b->report;
    if (b->options.progress(b->options.progress_user, &copy))
        atomic_store(&b->stopped, 1);
}

int hnbrdf_bake_tell(bake_task *b, const hnbrdf_bake_progress *progress)
{
    if (b->options.progress && !atomic_flag_test_and_set(&b->telling)) {
        call(b, progress);
        atomic_flag_clear(&b->telling);
    }
    return hnbrdf_bake_is_stopped(b);
}

void hnbrdf_bake_tell_row(bake_task *b, hnbrdf_bake_stage stage)
{
    const hnbrdf_bake_size *size = &b->report.rows[b->report.row_count - 1].size;
    const hnbrdf_bake_progress progress = {
        .stage = stage, .done = 1.0, .loss = NAN, .first = size, .last = size, .new_row = 1};
    if (b->options.progress) /* no fit runs now */
        call(b, &progress);
}
