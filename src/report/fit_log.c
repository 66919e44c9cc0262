/* fit_log.c: the course of a training as CSV, a row every 100 steps, gone on with after a resume.
 * */
#include "report/fit_log.h"

#include "base/error.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char header[] = "step,share,loss,pairs_per_s\n";

/* The whole file as text, malloc'ed; NULL where there is no such file, and after a failure. */
static char *read_all(const char *path, hnbrdf_result *result, hnbrdf_error *error)
{
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode))
        return NULL;
    size_t size = (size_t)status.st_size;
    FILE *file = fopen(path, "rb");
    char *text = malloc(size + 1);
    if (!text) {
        *result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory (%zu bytes)", path,
                              size + 1);
    } else if (!file || fread(text, 1, size, file) != size) {
        *result =
            hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: the log to go on with cannot be read: %s",
                        path, strerror(errno));
        free(text);
        text = NULL;
    } else {
        text[size] = '\0';
    }
    if (file)
        fclose(file);
    return text;
}

hnbrdf_result fit_log_open(const char *path, int resume, loss_curve *curve, fit_log *log,
                           hnbrdf_error *error)
{
    hnbrdf_result code = HNBRDF_OK;
    memset(log, 0, sizeof *log);
    log->curve = curve;
    if (!path)
        return HNBRDF_OK;
    if (resume)
        log->before = read_all(path, &code, error);
    if (log->before && strncmp(log->before, header, sizeof header - 1) != 0)
        code = hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s:1: not the log of a fit, expected %.*s",
                           path, (int)sizeof header - 2, header);
    if (code == HNBRDF_OK)
        code = report_output_open(path, &log->output, error);
    if (code == HNBRDF_OK) {
        fputs(header, log->output.file);
    } else {
        free(log->before);
        log->before = NULL;
    }
    return code;
}

/* Copies the earlier rows up to step `end`: a fit that was killed may have logged more of them
 * than its checkpoint knows. The first row that does not go on from the one before ends them. */
static void copy_rows(fit_log *log, long end)
{
    char *next = log->before + sizeof header - 1;
    long last = -1;
    for (char *row = next; *row; row = next) {
        long step;
        double share, loss;
        next = row + strcspn(row, "\n");
        if (*next)
            *next++ = '\0';
        if (sscanf(row, "%ld,%lf,%lf", &step, &share, &loss) != 3 || step <= last || step >= end)
            break;
        last = step;
        fprintf(log->output.file, "%s\n", row);
        loss_curve_add(log->curve, step, loss);
    }
    free(log->before);
    log->before = NULL;
}

void fit_log_row(fit_log *log, const hnbrdf_fit_progress *p)
{
    if (log->before)
        copy_rows(log, p->step);
    if (log->output.file) {
        fprintf(log->output.file, "%ld,%.6f,%.6f,%.0f\n", p->step, p->done, p->loss,
                p->pairs_per_s);
        fflush(log->output.file); /* for who watches */
    }
    loss_curve_add(log->curve, p->step, p->loss);
}

hnbrdf_result fit_log_close(fit_log *log, int keep, hnbrdf_error *error)
{
    if (!log->output.file)
        return HNBRDF_OK;
    if (log->before)
        copy_rows(log, LONG_MAX);
    if (keep)
        return report_output_close(&log->output, error);
    report_output_discard(&log->output);
    return HNBRDF_OK;
}
