/* message.c: what commands say on stderr: one line each. */
#include "cli/cli.h"

#include "base/error.h"

#include <stdarg.h>
#include <string.h>

enum { MESSAGE_SIZE = 1024 };

static char last[MESSAGE_SIZE];

const char *cli_last_message(void)
{
    return last;
}

static void print_line(const char *before, const char *format, va_list arguments)
{
    char text[MESSAGE_SIZE] = "";
    vsnprintf(text, sizeof text, format, arguments);
    hnbrdf_one_line(text);
    memcpy(last, text, sizeof last);
    fprintf(stderr, "hnbrdf%s: %s\n", before, text);
}

int cli_fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line("", format, arguments);
    va_end(arguments);
    return CLI_FAILURE;
}

void cli_warn(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line(": warning", format, arguments);
    va_end(arguments);
}

void cli_note(void *user, const char *line)
{
    (void)user;
    cli_warn("%s", line);
}

int cli_usage(const cli_command *command, const char *format, ...)
{
    char before[32];
    va_list arguments;
    snprintf(before, sizeof before, " %s", command->name);
    va_start(arguments, format);
    print_line(before, format, arguments);
    va_end(arguments);
    fprintf(stderr, "try: hnbrdf %s --help\n", command->name);
    return CLI_USAGE;
}
