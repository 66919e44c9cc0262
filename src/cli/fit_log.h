/* fit_log.h: the course of a training as CSV, a row every 100 steps, gone on with after a resume.
 * */
#ifndef HNBRDF_CLI_FIT_LOG_H
#define HNBRDF_CLI_FIT_LOG_H

#include "cli/cli.h"
#include "cli/loss_plot.h"
#include "hnbrdf/fit.h"

typedef struct fit_log {
    cli_output output; /* file NULL: no log is kept */
    char *before;      /* rows of an earlier part of the fit that are not yet copied, or NULL */
    loss_curve *curve; /* gets those rows too */
} fit_log;

/* path NULL: no log. With `resume` the rows of an existing log are kept, up to where the fit goes
 * on. 0, or CLI_FAILURE after a message. */
int fit_log_open(const char *path, int resume, loss_curve *curve, fit_log *log);
void fit_log_row(fit_log *log, const hnbrdf_fit_progress *progress);
/* Completes the file, or drops what was written if !keep. 0, or CLI_FAILURE after a message. */
int fit_log_close(fit_log *log, int keep);

#endif
