/* progress.c: one line on stderr about how far a long command is and how long it will still take.
 * */
#include "cli/cli.h"

#include "base/clock.h"

#include <string.h>
#include <unistd.h>

static const double quiet_seconds = 2.0;    /* nothing is said about what ends within these */
static const double terminal_seconds = 0.2; /* between rewrites of the line */
static const double log_seconds = 10.0;     /* between lines when stderr is no terminal */

double cli_seconds(void)
{
    return hnbrdf_seconds();
}

void cli_progress_begin(cli_progress *progress, const char *what)
{
    progress->started = cli_seconds();
    progress->shown = 0.0;
    progress->what = what;
}

/* "1:05" for 65 s, "2:00:09" for two hours and 9 s. */
static void format_duration(double seconds, char *text, size_t size)
{
    long whole = seconds < 3.6e6 ? (long)(seconds + 0.5) : 3600000L;
    if (whole < 3600)
        snprintf(text, size, "%ld:%02ld", whole / 60, whole % 60);
    else
        snprintf(text, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
}

void cli_progress_update(cli_progress *progress, double share, const char *detail)
{
    double now = cli_seconds(), elapsed = now - progress->started;
    int terminal = isatty(STDERR_FILENO);
    double pause = terminal ? terminal_seconds : log_seconds;
    if (elapsed < quiet_seconds || (progress->shown > 0.0 && now - progress->shown < pause))
        return;
    progress->shown = now;

    share = share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0; /* also for NaN */
    char line[128], left[32];
    int length = snprintf(line, sizeof line, "%s %3.0f %%", progress->what, 100.0 * share);
    if (share > 0.0 && length < (int)sizeof line) {
        format_duration(elapsed * (1.0 - share) / share, left, sizeof left);
        length += snprintf(line + length, sizeof line - (size_t)length, ", %s left", left);
    }
    if (detail && *detail && length < (int)sizeof line)
        snprintf(line + length, sizeof line - (size_t)length, ", %s", detail);
    if (terminal)
        fprintf(stderr, "\r%.78s\033[K", line);
    else
        fprintf(stderr, "%s\n", line);
    fflush(stderr);
}

int cli_progress_show(void *progress, double share, const char *detail)
{
    cli_progress_update(progress, share, detail);
    return 0;
}

void cli_progress_end(cli_progress *progress)
{
    if (progress->shown > 0.0 && isatty(STDERR_FILENO)) {
        fputs("\r\033[K", stderr);
        fflush(stderr);
    }
    progress->shown = 0.0;
}

void cli_stages_show(cli_stages *stages, const char *what, double share, const char *detail)
{
    if (strcmp(stages->what, what) != 0) {
        cli_stages_end(stages);
        snprintf(stages->what, sizeof stages->what, "%s", what);
        cli_progress_begin(&stages->line, stages->what);
    }
    cli_progress_update(&stages->line, share, detail);
}

void cli_stages_end(cli_stages *stages)
{
    if (stages->what[0])
        cli_progress_end(&stages->line);
    stages->what[0] = '\0';
}
