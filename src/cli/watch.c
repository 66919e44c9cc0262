/* watch.c: progress, Ctrl-C and results of library functions, as a command shows them. */
#include "cli/cli.h"

#include "base/interrupt.h"

int cli_code(hnbrdf_result result, const hnbrdf_error *error)
{
    return result == HNBRDF_OK ? CLI_OK : cli_fail("%s", error->text);
}

static void show(void *progress, double share, const char *detail)
{
    cli_progress_update(progress, share, detail);
}

static int stop(void *progress)
{
    (void)progress;
    return hnbrdf_interrupted();
}

static void tell(void *progress, const char *line)
{
    cli_progress_end(progress);
    fprintf(cli_words(), "%s\n", line);
}

report_watch cli_watch(cli_progress *progress)
{
    return (report_watch){.show = show, .stop = stop, .tell = tell, .user = progress};
}
