/* reading.c: the options with which commands read measured files, and what they call those files;
 * all from the library's table of formats. */
#include "cli/cli.h"
#ifdef HNBRDF_WITH_HDF5
#include "hnbrdf/hdf5.h"
#endif

#include <string.h>

enum { MOST_OPTIONS = 32, WORDS_SIZE = 256 };

#ifdef HNBRDF_WITH_HDF5
hnbrdf_measured_options cli_read = {.read_hdf5 = hnbrdf_hdf5_read};
#else
hnbrdf_measured_options cli_read;
#endif

/* The argument of an option for the help: "djb|raw|srgb", "X", or NULL of a flag. */
static const char *argument_of(const hnbrdf_measured_option *option, char *words, size_t *used)
{
    if (!option->word)
        return option->usual != 0.0 ? "X" : NULL;
    char *start = words + *used;
    for (int value = 0; option->word(value) && *used < WORDS_SIZE; value++)
        *used += (size_t)snprintf(words + *used, WORDS_SIZE - *used, "%s%s", value ? "|" : "",
                                  option->word(value));
    *used += 1; /* the NUL */
    return *used <= WORDS_SIZE ? start : NULL;
}

/* One option of the table into one of the command's. */
static cli_option make_option(const hnbrdf_measured_option *option, char *words, size_t *used)
{
    cli_type type = option->word ? CLI_CHOICE : option->usual != 0.0 ? CLI_REAL : CLI_FLAG;
    return (cli_option){.name = option->name,
                        .type = type,
                        .value = (char *)&cli_read + option->offset,
                        .low = option->low,
                        .high = option->high,
                        .argument = argument_of(option, words, used),
                        .help = option->help};
}

/* Number k of the options of all formats, or NULL. */
static const hnbrdf_measured_option *option_at(int k)
{
    const hnbrdf_measured_format_info *info;
    for (int row = 0; (info = hnbrdf_measured_format_at(row)); row++) {
        if (k < info->option_count)
            return &info->options[k];
        k -= info->option_count;
    }
    return NULL;
}

const cli_option *cli_reading_table(int negative)
{
    static cli_option tables[2][MOST_OPTIONS + 1];
    static char words[2][WORDS_SIZE];
    const hnbrdf_measured_option *option;
    int count = 0;
    size_t used = 0;
    negative = negative != 0;
    for (int k = 0; (option = option_at(k)) && count < MOST_OPTIONS; k++)
        if (option->makes_negative == negative)
            tables[negative][count++] = make_option(option, words[negative], &used);
    return tables[negative];
}

static int is_set(const hnbrdf_measured_option *option)
{
    const char *member = (const char *)&cli_read + option->offset;
    if (option->usual != 0.0) {
        double value = *(const double *)(const void *)member;
        return value != 0.0 && value != option->usual;
    }
    return *(const int *)(const void *)member != 0;
}

/* Set, or of use because the option that it needs is set. */
static int matters(const hnbrdf_measured_option *option)
{
    const hnbrdf_measured_option *other;
    if (!option->needs)
        return is_set(option);
    for (int k = 0; (other = option_at(k)); k++)
        if (strcmp(other->name, option->needs) == 0)
            return is_set(other);
    return 0;
}

void cli_print_reading(void)
{
    const hnbrdf_measured_option *option;
    FILE *words = cli_words();
    int shown = 0;
    for (int k = 0; (option = option_at(k)); k++) {
        const char *member = (const char *)&cli_read + option->offset;
        if (!matters(option))
            continue;
        fprintf(words, "%s --%s", shown++ ? "" : "measured files read with", option->name);
        if (option->word)
            fprintf(words, " %s", option->word(*(const int *)(const void *)member));
        else if (option->usual != 0.0)
            fprintf(words, " %.9g", *(const double *)(const void *)member);
    }
    if (shown)
        fputc('\n', words);
}

/* "MERL .binary, RGL .bsdf or UTIA .bin" with `last` before the last. */
void cli_measured_files(char *text, size_t size, const char *last)
{
    const hnbrdf_measured_format_info *info;
    const char *names[MOST_OPTIONS];
    int count = 0;
    size_t length = 0;
    for (int row = 0; (info = hnbrdf_measured_format_at(row)) && count < MOST_OPTIONS; row++)
        if (info->files)
            names[count++] = info->files;
    for (int k = 0; k < count && length < size; k++) {
        const char *between = k == 0 ? "" : k == count - 1 ? last : ", ";
        length += (size_t)snprintf(text + length, size - length, "%s%s", between, names[k]);
    }
}
