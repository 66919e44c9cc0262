/* formats.c: the table of the measured formats, and what follows from it alone: names, endings of
 * file names, options and the list of what can be opened. A row stands in its format's own file. */
#include "measured/format.h"
#include "base/error.h"
#include "base/text.h"

#include <stdio.h>
#include <string.h>

extern const measured_reader hnbrdf_rgl_reader, hnbrdf_merl_reader, hnbrdf_utia_reader,
    hnbrdf_nbrdf_reader, hnbrdf_builtin_reader, hnbrdf_custom_reader;

/* In the order in which a file's content is tried: those with a magic number first. */
static const measured_reader *const readers[] = {
    &hnbrdf_rgl_reader,   &hnbrdf_merl_reader,    &hnbrdf_utia_reader,
    &hnbrdf_nbrdf_reader, &hnbrdf_builtin_reader, &hnbrdf_custom_reader,
};
enum { READERS = sizeof readers / sizeof readers[0] };

static const size_t DEFAULT_MAX_BYTES = (size_t)1 << 30;

/* ---- The table ------------------------------------------------------------------------------- */

const measured_reader *hnbrdf_measured_reader_at(int index)
{
    return index >= 0 && index < READERS ? readers[index] : NULL;
}

const hnbrdf_measured_format_info *hnbrdf_measured_format_at(int index)
{
    return index >= 0 && index < READERS ? &readers[index]->info : NULL;
}

const char *hnbrdf_measured_format_name(hnbrdf_measured_format format)
{
    for (int k = 0; k < READERS; k++)
        if (readers[k]->info.format == format)
            return readers[k]->info.name;
    return NULL;
}

void hnbrdf_measured_expected(char *text, size_t size)
{
    int last = READERS - 1;
    size_t length = 0;
    while (!readers[last]->expected)
        last--;
    for (int k = 0; k <= last && length < size; k++) {
        const char *before = k == 0 ? "expected " : k == last ? " or " : ", ";
        if (readers[k]->expected)
            length += (size_t)snprintf(text + length, size - length, "%s%s", before,
                                       readers[k]->expected);
    }
}

/* ---- Names of files -------------------------------------------------------------------------- */

/* Which of the endings the name has, and more than it; -1: none. Whatever their case, as other
 * systems spell it: .BSDF in a folder is not left out silently. */
static int find_ending(const char *const *endings, const char *name, size_t *stem)
{
    size_t length = strlen(name);
    for (int k = 0; endings && endings[k]; k++) {
        size_t tail = strlen(endings[k]);
        if (length > tail && hnbrdf_ends_with(name, endings[k])) {
            *stem = length - tail;
            return k;
        }
    }
    return -1;
}

const hnbrdf_measured_format_info *hnbrdf_measured_format_of_file(const char *name, size_t *stem,
                                                                  int *part)
{
    size_t found = 0;
    for (int k = 0; k < READERS; k++) {
        const hnbrdf_measured_format_info *info = &readers[k]->info;
        int number = find_ending(info->part_endings, name, &found);
        if (number < 0 && find_ending(info->endings, name, &found) < 0)
            continue;
        if (stem)
            *stem = found;
        if (part)
            *part = number;
        return info;
    }
    return NULL;
}

/* ---- Options --------------------------------------------------------------------------------- */

/* The words of an enum with '|' between them. */
static void list_words(const hnbrdf_measured_option *option, char *text, size_t size)
{
    size_t length = 0;
    for (int value = 0; option->word(value) && length < size; value++)
        length += (size_t)snprintf(text + length, size - length, "%s%s", value ? "|" : "",
                                   option->word(value));
}

static hnbrdf_result settle_option(const hnbrdf_measured_option *option,
                                   hnbrdf_measured_options *settled, hnbrdf_error *error)
{
    char *member = (char *)settled + option->offset, words[128];
    if (option->word) {
        int value;
        memcpy(&value, member, sizeof value);
        if (value >= 0 && option->word(value))
            return HNBRDF_OK;
        list_words(option, words, sizeof words);
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "measured options: %s is %d, expected a value of its enum (%s)",
                           option->name, value, words);
    }
    if (option->usual != 0.0) {
        double value;
        memcpy(&value, member, sizeof value);
        if (!(value >= 0.0 && value <= (double)HNBRDF_MAX_VALUE))
            return hnbrdf_fail(
                error, HNBRDF_ERROR_ARGUMENT,
                "measured options: %s is negative, too large or not finite, expected a factor",
                option->name);
        if (value == 0.0)
            memcpy(member, &option->usual, sizeof value);
    }
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_measured_settle(const hnbrdf_measured_options *given,
                                     hnbrdf_measured_options *settled, hnbrdf_error *error)
{
    hnbrdf_measured_options options = {0};
    if (given)
        options = *given;
    for (int k = 0; k < READERS; k++)
        for (int i = 0; i < readers[k]->info.option_count; i++) {
            hnbrdf_result result = settle_option(&readers[k]->info.options[i], &options, error);
            if (result)
                return result;
        }
    if (options.max_bytes == 0)
        options.max_bytes = DEFAULT_MAX_BYTES;
    *settled = options;
    return HNBRDF_OK;
}
