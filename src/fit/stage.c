/* stage.c: how far a stage of the fit is, as the caller hears of it. */
#include "fit/trainer.h"

#include "base/clock.h"

#include <math.h>

void hnbrdf_fit_stage_begin(trainer *t)
{
    atomic_store(&t->finished, 0);
    t->stage_started = hnbrdf_seconds();
    t->shown = 0.0;
}

double hnbrdf_fit_stage_seconds(const trainer *t)
{
    return hnbrdf_seconds() - t->stage_started;
}

void hnbrdf_fit_tell(trainer *t, const char *stage, double done, double loss, double pairs,
                     int always)
{
    double now = hnbrdf_seconds(), elapsed = now - t->stage_started;
    if (!t->options.progress || (!always && now - t->shown < 0.1 && done < 1.0))
        return;
    t->shown = now;
    hnbrdf_fit_progress p = {stage, done,   loss, elapsed > 0.0 ? pairs / elapsed : 0.0,
                             NAN,   t->step};
    if (done > 0.01 || elapsed > 2.0)
        p.seconds_left = elapsed * (1.0 - done) / fmax(done, 1e-6);
    if (t->options.progress(t->options.progress_user, &p))
        t->asked = 1;
    if (hnbrdf_fit_is_alone(t)) /* others hear of it first */
        t->stopped = t->asked;
}
