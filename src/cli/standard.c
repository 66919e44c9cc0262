/* standard.c: standard input, output and error as a shell hands them over: closed, full, or a pipe
 * whose reader has gone. */
#include "cli/cli.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

static volatile sig_atomic_t pipe_broken;

static void on_broken_pipe(int number)
{
    (void)number;
    pipe_broken = 1;
}

/* A closed descriptor would be given to the first file that is opened, and what is printed would
 * land in that. What stands there instead can be neither read from nor written to. */
static void fill_closed(void)
{
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; descriptor++)
        if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF)
            (void)!open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void cli_standard_begin(void)
{
    const struct sigaction note = {.sa_handler = on_broken_pipe, .sa_flags = SA_RESTART};
    struct sigaction before;
    fill_closed();
    /* A reader that has seen enough (`| head`) does not end the work that goes to files. */
    if (sigaction(SIGPIPE, NULL, &before) == 0 && before.sa_handler == SIG_DFL)
        sigaction(SIGPIPE, &note, NULL);
    signal(SIGXFSZ, SIG_IGN); /* a file that may grow no further: EFBIG, with a message */
}

static int stdout_has_data;

void cli_give_stdout_to_data(void)
{
    stdout_has_data = 1;
}

FILE *cli_words(void)
{
    return stdout_has_data ? stderr : stdout;
}

int cli_standard_gone(void)
{
    return pipe_broken != 0;
}

int cli_standard_end(int code)
{
    const int failed = fflush(stdout) != 0 || ferror(stdout);
    if (pipe_broken) { /* as any program that is piped into `head` ends: silently, by the signal */
        signal(SIGPIPE, SIG_DFL);
        raise(SIGPIPE);
    }
    if (failed && code == CLI_OK)
        return cli_fail("standard output: cannot write: %s", strerror(errno));
    return code;
}
