/* obj_lines.c: lines of an OBJ file, their words and numbers. */
#include "scene/obj_reader.h"

#include "base/error.h"
#include "base/text.h"

#include <math.h>
#include <string.h>

hnbrdf_result obj_bad(const obj_lines *in, hnbrdf_result result, const char *what)
{
    return hnbrdf_fail(in->error, result, "%s:%ld: %s", in->name, in->line, what);
}

hnbrdf_result obj_no_memory(const obj_lines *in)
{
    return obj_bad(in, HNBRDF_ERROR_MEMORY, "no memory for what was read so far");
}

int obj_rest(const obj_lines *in)
{
    return (int)(in->end - in->at < 40 ? in->end - in->at : 40);
}

int obj_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == '\\' || c == '\n';
}

void obj_lines_begin(obj_lines *in, const void *data, size_t size, const char *name,
                     hnbrdf_error *error)
{
    const char *text = data;
    *in = (obj_lines){.next = text ? text + hnbrdf_byte_order_mark(text, size) : text,
                      .last = text ? text + size : text,
                      .name = name,
                      .next_line = 1,
                      .error = error};
}

/* The end of a line that begins at `from`: LF, CR LF, or CR alone. */
static const char *line_end(const obj_lines *in, const char *from)
{
    while (from < in->last && *from != '\n' && *from != '\r')
        from++;
    return from;
}

int obj_next_line(obj_lines *in)
{
    if (in->next == in->last)
        return 0;
    in->line = in->next_line;
    in->at = in->next;
    do {
        in->end = line_end(in, in->next);
        in->next = in->end;
        if (in->next < in->last && *in->next == '\r')
            in->next++;
        if (in->next < in->last && *in->next == '\n')
            in->next++;
        in->next_line++;
    } while (in->end > in->at && in->end[-1] == '\\' && in->next < in->last);
    /* "Material#1" is a name that some programs give */
    for (const char *c = in->at; c < in->end; c++)
        if (*c == '#' && (c == in->at || obj_is_blank(c[-1])))
            in->end = c;
    return 1;
}

int obj_skip_blanks(obj_lines *in)
{
    while (in->at < in->end && obj_is_blank(*in->at))
        in->at++;
    return in->at < in->end;
}

const char *obj_word(obj_lines *in, size_t *length)
{
    obj_skip_blanks(in);
    const char *start = in->at;
    while (in->at < in->end && !obj_is_blank(*in->at))
        in->at++;
    *length = (size_t)(in->at - start);
    return *length ? start : NULL;
}

int obj_is_word(const char *start, size_t length, const char *expected)
{
    return length == strlen(expected) && memcmp(start, expected, length) == 0;
}

/* nan, inf, infinity, nan(ind), 1.#QNAN, -1.#IND00, 1.#INF: what the C libraries print. Returns
 * where it ends, or NULL. */
static const char *not_finite(const char *at, const char *end)
{
    static const char *const words[] = {"nan", "inf", "1.#"};
    at += at < end && (*at == '-' || *at == '+');
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        int same = end - at >= 3;
        for (int k = 0; k < 3 && same; k++)
            same = hnbrdf_lower(at[k]) == words[i][k];
        if (!same)
            continue;
        while (at < end && !obj_is_blank(*at))
            at++;
        return at;
    }
    return NULL;
}

hnbrdf_result obj_numbers(obj_lines *in, const char *what, int least, int most, double *values)
{
    for (int k = 0; k < most; k++) {
        values[k] = 0.0;
        if (!obj_skip_blanks(in) && k >= least)
            continue;
        const char *end = not_finite(in->at, in->end); /* first: 1.#INF begins with a number */
        if (end)
            values[k] = (double)NAN;
        else
            end = hnbrdf_parse_double(in->at, in->end, &values[k]);
        if (!end || (end < in->end && !obj_is_blank(*end)))
            return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT,
                               "%s:%ld: %s: found '%.*s', expected %d finite number%s up to 1e30",
                               in->name, in->line, what, obj_rest(in), in->at, least,
                               least == 1 ? "" : "s");
        if (!(fabs(values[k]) <= 1e30))
            values[k] = (double)NAN;
        in->at = end;
    }
    return HNBRDF_OK;
}
