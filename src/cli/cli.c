/* cli.c: how a command describes itself once (cli.h) becomes parsing, --help and messages. */
#include "cli/cli.h"

#include "base/guess.h"
#include "base/text.h"
#include "base/threads.h"

#include <limits.h>
#include <math.h>
#include <string.h>

enum { HELP_COLUMNS = 100, MOST_GIVEN = 64 };

int cli_processors(void)
{
    return hnbrdf_processors();
}

/* ---- Help ------------------------------------------------------------------------------------ */

/* Does the table hold that of the options for reading measured files? */
static int reads_measured(const cli_option *options)
{
    for (const cli_option *option = options; option->name; option++)
        if (option->type == CLI_TABLE && option->value == (const void *)cli_reading_table(0))
            return 1;
    return 0;
}

/* Words of text from `column` on, wrapped at HELP_COLUMNS and indented to `column`. */
static void print_wrapped(const char *text, int column)
{
    int at = column;
    while (*text) {
        int length = (int)strcspn(text, " \n");
        if (at > column && at + 1 + length > HELP_COLUMNS) {
            printf("\n%*s", column, "");
            at = column;
        } else if (at > column) {
            putchar(' ');
            at++;
        }
        printf("%.*s", length, text);
        at += length;
        text += length;
        text += strspn(text, " \n");
    }
    putchar('\n');
}

/* "--out FILE" */
static void spell_option(const cli_option *option, char *text, size_t size)
{
    snprintf(text, size, "--%s%s%s", option->name, option->type == CLI_FLAG ? "" : " ",
             option->type == CLI_FLAG ? "" : option->argument);
}

static void print_option(const cli_option *option, int width)
{
    char text[96];
    spell_option(option, text, sizeof text);
    if (option->letter)
        printf("  -%c, %-*s  ", option->letter, width, text);
    else
        printf("      %-*s  ", width, text);
    print_wrapped(option->help, width + 8);
}

static void print_indented(const char *text)
{
    while (*text) {
        text += strspn(text, " ");
        int length = (int)strcspn(text, "\n");
        printf("  %.*s\n", length, text);
        text += length + (text[length] == '\n');
    }
}

static void print_measured_files(void)
{
    char files[256];
    cli_measured_files(files, sizeof files, " and ");
    int column = printf("\nMeasured files: ");
    print_wrapped(files, column - 1);
}

static void print_help(const cli_command *command, const cli_option *options)
{
    static const cli_option help = {"help", 'h', CLI_FLAG, NULL, 0, 0, NULL, "show this help"};
    const cli_option *option;
    int width = (int)strlen("--help");
    for (int k = 0; (option = cli_option_at(options, k)); k++) {
        char text[96];
        spell_option(option, text, sizeof text);
        width = (int)strlen(text) > width ? (int)strlen(text) : width;
    }
    int column = printf("usage: hnbrdf %s ", command->name);
    print_wrapped(command->synopsis, column);
    printf("\n%s\n", command->about);
    if (reads_measured(options))
        print_measured_files();
    printf("\noptions:\n");
    for (int k = 0; (option = cli_option_at(options, k)); k++)
        print_option(option, width);
    print_option(&help, width);
    printf("\nexamples:\n");
    print_indented(command->examples);
}

/* ---- Parsing --------------------------------------------------------------------------------- */

int cli_parse_real(const char *text, double *value)
{
    const char *end = text + strlen(text);
    return hnbrdf_parse_double(text, end, value) == end;
}

static int parse_whole(const char *text, double *value)
{
    double limit = LONG_MAX < 9007199254740992 ? (double)LONG_MAX : 9007199254740992.0;
    return cli_parse_real(text, value) && fabs(*value) <= limit && *value == floor(*value);
}

const char *cli_parse_net(const char *text, int net[2])
{
    int parts[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        size_t digits = strspn(text, "0123456789");
        if (digits < 1 || digits > 4)
            return NULL;
        for (; digits > 0; digits--)
            parts[k] = 10 * parts[k] + (*text++ - '0');
        if (k == 0 && *text++ != 'x')
            return NULL;
    }
    if (parts[0] < 1 || parts[0] > HNBRDF_MAX_HIDDEN || parts[1] < 1 ||
        parts[1] > HNBRDF_MAX_LAYERS)
        return NULL;
    net[0] = parts[0];
    net[1] = parts[1];
    return text;
}

static int set_net(const cli_command *command, const cli_option *option, const char *text)
{
    int net[2];
    const char *end = cli_parse_net(text, net);
    if (!end || *end)
        return cli_usage(
            command,
            "--%s: '%s' is not HxN, as in 32x2: H units from 1 to %d in each of N hidden "
            "layers from 1 to %d",
            option->name, text, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
    memcpy(option->value, net, sizeof net);
    return -1;
}

/* The number of text among the words of "a|b|c", or -1. */
static int find_choice(const char *words, const char *text)
{
    size_t length = strlen(text);
    for (int index = 0;; index++) {
        size_t word = strcspn(words, "|");
        if (word == length && strncmp(words, text, length) == 0)
            return index;
        if (words[word] == '\0')
            return -1;
        words += word + 1;
    }
}

/* "a, b or c" of all names. */
static const char *list_words(const cli_word *word, char *text, size_t size)
{
    size_t length = 0;
    text[0] = '\0';
    for (int k = 0; word->name(k) && length < size; k++) {
        const char *before = k == 0 ? "" : word->name(k + 1) ? ", " : " or ";
        length += (size_t)snprintf(text + length, size - length, "%s%s", before, word->name(k));
    }
    return text;
}

static int fail_word(const cli_command *command, const cli_option *option, const char *text)
{
    char words[256];
    const cli_word *word = option->value;
    hnbrdf_guess guess;
    hnbrdf_guess_begin(&guess, text);
    for (int k = 0; word->name(k); k++)
        hnbrdf_guess_offer(&guess, word->name(k));
    const char *nearest = hnbrdf_guess_nearest(&guess);
    return cli_usage(command, "--%s: found '%s', expected %s%s%s%s", option->name, text,
                     list_words(word, words, sizeof words), nearest ? " (did you mean " : "",
                     nearest ? nearest : "", nearest ? "?)" : "");
}

static int set_word(const cli_command *command, const cli_option *option, const char *text)
{
    cli_word *word = option->value;
    for (int k = 0; word->name(k); k++)
        if (strcmp(word->name(k), text) == 0) {
            word->value = k;
            return -1;
        }
    return fail_word(command, option, text);
}

static int set_choice(const cli_command *command, const cli_option *option, const char *text)
{
    int choice = find_choice(option->argument, text);
    if (choice < 0)
        return cli_usage(command, "--%s: found '%s', expected %s", option->name, text,
                         option->argument);
    *(int *)option->value = choice;
    return -1;
}

static int set_number(const cli_command *command, const cli_option *option, const char *text)
{
    const char *what = option->type == CLI_INT ? "a whole number" : "a finite number";
    double value;
    if (!(option->type == CLI_INT ? parse_whole(text, &value) : cli_parse_real(text, &value)))
        return cli_usage(command, "--%s: '%s' is not %s", option->name, text, what);
    int any = option->low == 0.0 && option->high == 0.0;
    if (!any && (value < option->low || value > option->high))
        return cli_usage(command, "--%s: %s is out of range, expected %s from %.10g to %.10g",
                         option->name, text, what, option->low, option->high);
    if (option->type == CLI_INT)
        *(long *)option->value = (long)value;
    else
        *(double *)option->value = value;
    return -1;
}

static int set_option(const cli_command *command, const cli_option *option, const char *text)
{
    switch (option->type) {
    case CLI_FLAG:
        *(int *)option->value = 1;
        return -1;
    case CLI_TEXT:
    case CLI_READ:
    case CLI_WRITE_TEXT:
    case CLI_WRITE_BYTES:
    case CLI_WRITE_MODEL:
    case CLI_WRITE_PICTURE:
    case CLI_WRITE_FOLDER:
        *(const char **)option->value = text;
        return -1;
    case CLI_NET:
        return set_net(command, option, text);
    case CLI_CHOICE:
        return set_choice(command, option, text);
    case CLI_WORD:
        return set_word(command, option, text);
    case CLI_INT:
    case CLI_REAL:
    case CLI_TABLE: /* never found */
        break;
    }
    return set_number(command, option, text);
}

static const cli_option *find_option(const cli_option *options, const char *argument)
{
    const cli_option *option;
    for (int k = 0; (option = cli_option_at(options, k)); k++) {
        size_t length = strlen(option->name);
        if (argument[1] == '-') {
            if (strncmp(argument + 2, option->name, length) == 0 &&
                (argument[2 + length] == '\0' || argument[2 + length] == '='))
                return option;
        } else if (option->letter && argument[1] == option->letter && argument[2] == '\0') {
            return option;
        }
    }
    return NULL;
}

static int fail_unknown(const cli_command *command, const cli_option *options, const char *argument)
{
    char name[HNBRDF_MAX_NAME + 1];
    hnbrdf_guess guess;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(argument, "="), argument);
    hnbrdf_guess_begin(&guess, name + strspn(name, "-"));
    const cli_option *option;
    for (int k = 0; (option = cli_option_at(options, k)); k++)
        hnbrdf_guess_offer(&guess, option->name);
    hnbrdf_guess_offer(&guess, "help");
    const char *nearest = hnbrdf_guess_nearest(&guess);
    if (nearest)
        return cli_usage(command, "unknown option %s, did you mean --%s?", name, nearest);
    return cli_usage(command, "unknown option %s", name);
}

/* An option's value must not look like another option: `-o --seed 3` is a forgotten file name. */
static int is_value(const char *text)
{
    return text && text[0] && (text[0] != '-' || text[1] == '\0' || strchr("0123456789.", text[1]));
}

/* The options that have had a value: the second of two would be the one that counts, silently. */
typedef struct given_options {
    const cli_option *options[MOST_GIVEN];
    int count;
} given_options;

static int note_given(const cli_command *command, const cli_option *option, given_options *given)
{
    for (int k = 0; k < given->count; k++)
        if (given->options[k] == option)
            return cli_usage(command, "--%s is given twice", option->name);
    if (option->type != CLI_FLAG && given->count < MOST_GIVEN)
        given->options[given->count++] = option;
    return -1;
}

/* The option argv[*k], whose value may be the argument after it. */
static int parse_option(const cli_command *command, const cli_option *options, int argc,
                        char **argv, int *k, given_options *given)
{
    const char *argument = argv[*k];
    const cli_option *option = find_option(options, argument);
    if (!option)
        return fail_unknown(command, options, argument);
    const char *equals = argument[1] == '-' ? strchr(argument, '=') : NULL;
    const char *value = equals ? equals + 1 : NULL;
    if (option->type == CLI_FLAG && value)
        return cli_usage(command, "--%s takes no value", option->name);
    if (option->type != CLI_FLAG && !value && *k + 1 < argc)
        value = argv[++*k];
    if (option->type != CLI_FLAG && (equals ? !*value : !is_value(value)))
        return cli_usage(command, "--%s needs a value: --%s %s", option->name, option->name,
                         option->argument);
    const int code = note_given(command, option, given);
    return code < 0 ? set_option(command, option, value) : code;
}

int cli_parse(const cli_command *command, const cli_option *options, int argc, char **argv,
              int *positionals)
{
    given_options given = {.count = 0};
    int count = 0, only_positionals = 0, code = -1;
    for (int k = 1; k < argc && code < 0; k++) {
        char *argument = argv[k];
        if (!argument[0])
            return cli_usage(command, "argument %d is empty", k);
        if (only_positionals || argument[0] != '-' || argument[1] == '\0')
            argv[++count] = argument;
        else if (strcmp(argument, "--") == 0)
            only_positionals = 1;
        else if (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0)
            return print_help(command, options), CLI_OK;
        else
            code = parse_option(command, options, argc, argv, &k, &given);
    }
    *positionals = count;
    return code < 0 ? cli_check_files(command, options, argv + 1, count) : code;
}
