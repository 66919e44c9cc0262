/* csv.c: read comma-separated text line by line (RFC 4180, one record a line), from people and
 * pipes. */
#include "base/csv.h"

#include "base/error.h"
#include "base/text.h"

#include <errno.h>
#include <string.h>

void hnbrdf_csv_begin(hnbrdf_csv_reader *reader, FILE *file, const char *name)
{
    reader->file = file;
    reader->name = name;
    reader->line = 0;
    reader->blank = 0;
    reader->count = 0;
}

static int fail_line(const hnbrdf_csv_reader *reader, const char *what, hnbrdf_error *error)
{
    hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s:%ld: %s", reader->name, reader->line, what);
    return -1;
}

/* One line into text, without its end: 1, 0 at the end of the file, -1 with *error filled. */
static int read_line(hnbrdf_csv_reader *reader, hnbrdf_error *error)
{
    size_t length = 0;
    int c = getc(reader->file);
    reader->line++;
    if (c == EOF && !ferror(reader->file))
        return 0;
    for (; c != EOF && c != '\n'; c = getc(reader->file)) {
        if (c == '\0') /* in UTF-16, as spreadsheets write it, the first letter brings one */
            return fail_line(reader,
                             reader->line == 1 && hnbrdf_is_utf16(reader->text, length)
                                 ? "found UTF-16, expected UTF-8"
                                 : "found a NUL byte, expected text",
                             error);
        if (length == HNBRDF_CSV_LINE - 1)
            return fail_line(reader, "the line is longer than 8191 bytes", error);
        reader->text[length++] = (char)c;
    }
    if (ferror(reader->file)) {
        hnbrdf_fail(error, HNBRDF_ERROR_IO, "%s: cannot read: %s", reader->name, strerror(errno));
        return -1;
    }
    if (length > 0 && reader->text[length - 1] == '\r')
        length--;
    reader->text[length] = '\0';
    if (strchr(reader->text, '\r'))
        return fail_line(
            reader, "found a CR inside a line, expected lines that end with LF or CRLF", error);
    if (reader->line == 1) {
        const size_t mark = hnbrdf_byte_order_mark(reader->text, length);
        memmove(reader->text, reader->text + mark, length + 1 - mark);
    }
    return 1;
}

static int is_space(char c)
{
    return c == ' ' || c == '\t';
}

/* Both take a field from *in on in place, end it with NUL and leave *in at the comma or the end. */
static void take_plain(char **in)
{
    char *end = *in;
    size_t length = strcspn(end, ",");
    *in += length;
    end += length;
    while (length-- > 0 && is_space(end[-1]))
        end--;
    if (end < *in)
        *end = '\0';
}

static int take_quoted(char **in)
{
    char *from = *in + 1, *to = *in;
    for (; *from && (*from != '"' || from[1] == '"'); from++) {
        from += *from == '"';
        *to++ = *from;
    }
    if (*from++ != '"')
        return -1;
    while (is_space(*from))
        from++;
    if (*from && *from != ',')
        return -1;
    *in = from;
    *to = '\0';
    return 0;
}

static int split(hnbrdf_csv_reader *reader, hnbrdf_error *error)
{
    char *in = reader->text;
    reader->count = 0;
    for (;;) {
        while (is_space(*in))
            in++;
        if (reader->count == HNBRDF_CSV_FIELDS)
            return fail_line(reader, "found more than 256 fields", error);
        reader->fields[reader->count++] = in;
        if (*in != '"')
            take_plain(&in);
        else if (take_quoted(&in) != 0)
            return fail_line(reader, "a quoted field is not closed by '\"' and a comma", error);
        if (*in != ',')
            return 1;
        *in++ = '\0';
    }
}

int hnbrdf_csv_next(hnbrdf_csv_reader *reader, hnbrdf_error *error)
{
    for (reader->blank = 0;; reader->blank++) {
        int result = read_line(reader, error);
        if (result <= 0)
            return result;
        if (reader->text[strspn(reader->text, " \t")] != '\0')
            return split(reader, error);
    }
}

int hnbrdf_csv_has(const hnbrdf_csv_reader *reader, char c)
{
    for (int k = 0; k < reader->count; k++)
        if (strchr(reader->fields[k], c))
            return 1;
    return 0;
}

int hnbrdf_csv_number(const hnbrdf_csv_reader *reader, int index, const char *what, float *value,
                      hnbrdf_error *error)
{
    const char *text = reader->fields[index];
    const char *end = text + strlen(text);
    if (*text && hnbrdf_parse_float(text, end, value) == end)
        return 0;
    hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                "%s:%ld: %s: found '%.40s', expected a finite decimal number", reader->name,
                reader->line, what, text);
    return -1;
}
