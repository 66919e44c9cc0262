/* fit_log.h: the course of a training as CSV, a row every 100 steps, gone on with after a resume.
 * */
#ifndef HNBRDF_REPORT_FIT_LOG_H
#define HNBRDF_REPORT_FIT_LOG_H

#include "hnbrdf/fit.h"
#include "report/loss_plot.h"
#include "report/output.h"

typedef struct fit_log {
    report_output output; /* file NULL: no log is kept */
    char *before;         /* rows of an earlier part of the fit that are not yet copied, or NULL */
    loss_curve *curve;    /* gets those rows too */
} fit_log;

/* path NULL: no log. With `resume` the rows of an existing log are kept, up to where the fit goes
 * on. */
hnbrdf_result fit_log_open(const char *path, int resume, loss_curve *curve, fit_log *log,
                           hnbrdf_error *error);
void fit_log_row(fit_log *log, const hnbrdf_fit_progress *progress);
/* Completes the file, or drops what was written if !keep. */
hnbrdf_result fit_log_close(fit_log *log, int keep, hnbrdf_error *error);

#endif
