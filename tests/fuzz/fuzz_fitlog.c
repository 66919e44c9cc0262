/* fuzz_fitlog.c: the bytes are the log of a fit that is gone on with. What is kept of it has steps
 * before the one that the fit has reached, and the new rows follow. */
#include "fuzz.h"

#include "report/fit_log.h"

#include <sys/resource.h>
#include <unistd.h>

static char folder[] = "/tmp/hnbrdf_fuzz_XXXXXX", path[64];

static void remove_folder(void)
{
    remove(path);
    rmdir(folder);
}

/* A log that is there and cannot be opened. */
static void open_without_descriptors(void)
{
    struct rlimit before, none;
    loss_curve curve = {0};
    fit_log log;
    hnbrdf_error error = {""};
    FUZZ_CHECK(getrlimit(RLIMIT_NOFILE, &before) == 0);
    none = (struct rlimit){0, before.rlim_max};
    FUZZ_CHECK(setrlimit(RLIMIT_NOFILE, &none) == 0);
    const hnbrdf_result result = fit_log_open(path, 1, &curve, &log, &error);
    FUZZ_CHECK(setrlimit(RLIMIT_NOFILE, &before) == 0);
    FUZZ_CHECK(result == HNBRDF_ERROR_IO);
    fuzz_check_refusal(result, &error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const hnbrdf_fit_progress progress = {.step = 500, .done = 0.5, .loss = 0.25};
    loss_curve curve = {0};
    fit_log log;
    hnbrdf_error error = {""};
    if (!path[0]) {
        FUZZ_CHECK(mkdtemp(folder) != NULL && atexit(remove_folder) == 0);
        snprintf(path, sizeof path, "%s/log.csv", folder);
    }
    FILE *file = fopen(path, "wb");
    FUZZ_CHECK(file && fwrite(data, 1, size, file) == size && fclose(file) == 0);
    open_without_descriptors();
    const hnbrdf_result result = fit_log_open(path, 1, &curve, &log, &error);
    if (result) {
        fuzz_check_refusal(result, &error);
        return 0;
    }
    if (size % 2) /* else it ends before a step */
        fit_log_row(&log, &progress);
    FUZZ_CHECK(fit_log_close(&log, (int)(size / 2 % 2), &error) == HNBRDF_OK);
    for (int i = 1; i < curve.count; i++)
        FUZZ_CHECK(curve.points[i].step > curve.points[i - 1].step);
    for (int i = 0; i < curve.count; i++)
        FUZZ_CHECK(isfinite(curve.points[i].loss));
    loss_curve_free(&curve);
    return 0;
}
