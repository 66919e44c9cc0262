/* brdf_heading.c: the comment lines in which hnbrdf tells of a model that it wrote as .brdf. */
#include "import/brdf_heading.h"

#include "base/error.h"
#include "base/text.h"

#include <string.h>

/* One line, from behind "# hnbrdf/1 " on. */
typedef struct heading_line {
    const char *file;
    int number; /* from 1 */
    const char *at, *end;
} heading_line;

static hnbrdf_result fail(const heading_line *line, const char *expected, hnbrdf_error *error)
{
    const int length = line->end - line->at > 40 ? 40 : (int)(line->end - line->at);
    return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: line %d: found '%.*s', expected %s",
                       line->file, line->number, length, line->at, expected);
}

/* ---- Words and numbers ----------------------------------------------------------------------- */

static void skip_spaces(heading_line *line)
{
    while (line->at < line->end && (*line->at == ' ' || *line->at == '\t'))
        line->at++;
}

/* Moves behind the word; its length, 0 at the end of the line. */
static size_t take_word(heading_line *line, const char **word)
{
    skip_spaces(line);
    *word = line->at;
    while (line->at < line->end && *line->at != ' ' && *line->at != '\t')
        line->at++;
    return (size_t)(line->at - *word);
}

static int take_numbers(heading_line *line, float *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        skip_spaces(line);
        const char *stop = hnbrdf_parse_float(line->at, line->end, &numbers[i]);
        if (!stop)
            return 0;
        line->at = stop;
    }
    return 1;
}

static int is_word(const char *word, size_t length, const char *name)
{
    return strlen(name) == length && memcmp(word, name, length) == 0;
}

/* ---- Keys ------------------------------------------------------------------------------------ */

static hnbrdf_result take_kind(heading_line *line, hnbrdf_kind *kind, hnbrdf_error *error)
{
    const char *word;
    const heading_line start = *line;
    const size_t length = take_word(line, &word);
    for (int k = 0; hnbrdf_kind_name((hnbrdf_kind)k); k++)
        if (is_word(word, length, hnbrdf_kind_name((hnbrdf_kind)k))) {
            *kind = (hnbrdf_kind)k;
            return HNBRDF_OK;
        }
    return fail(&start, "hybrid, neural or ggx", error);
}

static hnbrdf_result take_encoding(heading_line *line, hnbrdf_encoding *encoding,
                                   hnbrdf_error *error)
{
    const char *word;
    const heading_line start = *line;
    const size_t length = take_word(line, &word);
    for (int k = 0; hnbrdf_encoding_name((hnbrdf_encoding)k); k++)
        if (is_word(word, length, hnbrdf_encoding_name((hnbrdf_encoding)k))) {
            *encoding = (hnbrdf_encoding)k;
            return HNBRDF_OK;
        }
    return fail(&start, "the name of an encoding", error);
}

static hnbrdf_result take_fitted(heading_line *line, hnbrdf_brdf_heading *h, hnbrdf_error *error)
{
    float n[8];
    if (!take_numbers(line, n, 8))
        return fail(line, "kd, eta and alpha as they were fitted, eight numbers", error);
    h->has_fitted = 1;
    memcpy(h->fitted.kd, n, sizeof h->fitted.kd);
    memcpy(h->fitted.eta, n + 3, sizeof h->fitted.eta);
    memcpy(h->fitted.alpha, n + 6, sizeof h->fitted.alpha);
    return HNBRDF_OK;
}

static hnbrdf_result take_lobes(heading_line *line, hnbrdf_brdf_heading *h, hnbrdf_error *error)
{
    float n[HNBRDF_LOBES * (1 + HNBRDF_LOBE_KNOTS)];
    if (!take_numbers(line, n, HNBRDF_LOBES * (1 + HNBRDF_LOBE_KNOTS)))
        return fail(line, "two scales of lobes and four shares of each, ten numbers", error);
    h->has_lobes = 1;
    memcpy(h->lobes.scale, n, sizeof h->lobes.scale);
    memcpy(h->lobes.share, n + HNBRDF_LOBES, sizeof h->lobes.share);
    return HNBRDF_OK;
}

static hnbrdf_result take_energy(heading_line *line, hnbrdf_brdf_heading *h, hnbrdf_error *error)
{
    float n[2];
    if (!take_numbers(line, n, 2))
        return fail(line, "the horizon and slope of a factor on energy, two numbers", error);
    h->energy.horizon = n[0];
    h->energy.slope = n[1];
    return HNBRDF_OK;
}

static hnbrdf_result take_key(heading_line *line, hnbrdf_brdf_heading *h, hnbrdf_error *error)
{
    const heading_line start = *line;
    const char *key;
    const size_t length = take_word(line, &key);
    hnbrdf_result result = HNBRDF_OK;
    if (is_word(key, length, "kind"))
        result = take_kind(line, &h->kind, error);
    else if (is_word(key, length, "encoding"))
        result = take_encoding(line, &h->encoding, error);
    else if (is_word(key, length, "scale"))
        result = take_numbers(line, &h->scale, 1) ? HNBRDF_OK : fail(line, "a number", error);
    else if (is_word(key, length, "shift"))
        result = take_numbers(line, &h->shift, 1) ? HNBRDF_OK : fail(line, "a number", error);
    else if (is_word(key, length, "floor"))
        result = take_numbers(line, &h->floor, 1) ? HNBRDF_OK : fail(line, "a number", error);
    else if (is_word(key, length, "fitted"))
        result = take_fitted(line, h, error);
    else if (is_word(key, length, "lobes"))
        result = take_lobes(line, h, error);
    else if (is_word(key, length, "energy"))
        result = take_energy(line, h, error);
    else
        return fail(&start, "kind, encoding, scale, shift, floor, fitted, lobes or energy", error);
    if (result)
        return result;
    skip_spaces(line);
    return line->at == line->end ? HNBRDF_OK : fail(line, "the end of the line", error);
}

/* ---- Lines ----------------------------------------------------------------------------------- */

hnbrdf_result hnbrdf_brdf_read_heading(const char *file, const char *text, size_t size,
                                       hnbrdf_brdf_heading *heading, hnbrdf_error *error)
{
    static const char MARK[] = HNBRDF_BRDF_HEADING, SECTION[] = "::begin";
    const size_t mark = sizeof MARK - 1, section = sizeof SECTION - 1;
    const char *end = text + size, *at = text;
    hnbrdf_result result = HNBRDF_OK;
    *heading = (hnbrdf_brdf_heading){.encoding = HNBRDF_ENCODING_DIRECTIONS, .scale = 1};
    for (int number = 1; !result && at < end; number++) {
        const char *stop = (const char *)memchr(at, '\n', (size_t)(end - at));
        const char *last = stop ? stop : end;
        heading_line line = {file, number, at, last};
        if (line.end > at && line.end[-1] == '\r')
            line.end--;
        const size_t length = (size_t)(line.end - at);
        if (length >= section && memcmp(at, SECTION, section) == 0)
            break;
        if (length >= mark && memcmp(at, MARK, mark) == 0) {
            line.at += mark;
            heading->present = 1;
            result = take_key(&line, heading, error);
        }
        at = stop ? stop + 1 : end;
    }
    return result;
}
