/* words.c: lines of a scene as text, cut into words, and what the words mean. */
#include "scene/words.h"

#include "base/text.h"

#include <math.h>
#include <string.h>

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Cuts a line into words, in place. */
hnbrdf_result words_split(words *in)
{
    char *c = in->text;
    in->count = in->at = 0;
    for (;;) {
        while (is_blank(*c))
            c++;
        if (!*c || *c == '#')
            return HNBRDF_OK;
        if (in->count == WORDS_MAX)
            return BAD(in, "%s:%ld: more than %d words", in->name, in->line, WORDS_MAX);
        if (*c == '"') {
            in->words[in->count++] = ++c;
            c = strchr(c, '"');
            if (!c)
                return BAD(in, "%s:%ld: a '\"' that is not closed", in->name, in->line);
        } else {
            in->words[in->count++] = c;
            while (*c && !is_blank(*c))
                c++;
        }
        if (*c)
            *c++ = '\0';
    }
}

/* The next word if it is this one. */
int words_take(words *in, const char *word)
{
    if (in->at == in->count || strcmp(in->words[in->at], word) != 0)
        return 0;
    in->at++;
    return 1;
}

hnbrdf_result words_number(words *in, const char *what, double low, double high, double *value)
{
    const char *word = in->at < in->count ? in->words[in->at] : "the end of the line";
    const char *end = in->at < in->count ? word + strlen(word) : word;
    if (hnbrdf_parse_double(word, end, value) != end || end == word ||
        !(*value >= low && *value <= high))
        return BAD(in, "%s:%ld: %s: found '%.40s', expected a number from %.9g to %.9g", in->name,
                   in->line, what, word, low, high);
    in->at++;
    return HNBRDF_OK;
}

hnbrdf_result words_numbers(words *in, const char *what, double low, double high, int count,
                            double *values)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; k < count && result == HNBRDF_OK; k++)
        result = words_number(in, what, low, high, &values[k]);
    return result;
}

hnbrdf_result words_vector(words *in, const char *what, double low, double high, float v[3])
{
    double values[3] = {0.0, 0.0, 0.0};
    hnbrdf_result result = words_numbers(in, what, low, high, 3, values);
    for (int k = 0; k < 3 && result == HNBRDF_OK; k++)
        v[k] = (float)values[k];
    return result;
}

hnbrdf_result words_whole(words *in, const char *what, int low, int high, int *value)
{
    double v = 0.0;
    hnbrdf_result result = words_number(in, what, low, high, &v);
    if (result == HNBRDF_OK && v != floor(v))
        return BAD(in, "%s:%ld: %s: expected a whole number", in->name, in->line, what);
    *value = result == HNBRDF_OK ? (int)v : *value;
    return result;
}

hnbrdf_result words_text(words *in, const char *what, size_t room, char *to)
{
    if (in->at == in->count || !in->words[in->at][0] || strlen(in->words[in->at]) >= room)
        return BAD(in, "%s:%ld: %s: found '%.40s', expected 1 to %zu bytes", in->name, in->line,
                   what, in->at < in->count ? in->words[in->at] : "the end of the line", room - 1);
    strcpy(to, in->words[in->at++]);
    return HNBRDF_OK;
}

hnbrdf_result words_unknown(const words *in, const char *expected)
{
    return BAD(in, "%s:%ld: found '%.40s', expected %s", in->name, in->line,
               in->at < in->count ? in->words[in->at] : "the end of the line", expected);
}
