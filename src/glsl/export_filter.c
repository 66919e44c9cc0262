/* export_filter.c: what an exported text goes through on its way to the caller: names with another
 * prefix, and no comments. */
#include "glsl/export_filter.h"

#include "base/text.h"
#include "glsl/export_library.h"

#include <string.h>

/* ---- Names ----------------------------------------------------------------------------------- */

int hnbrdf_prefix_is_valid(const char *prefix)
{
    const size_t length = strlen(prefix);
    if (length < 1 || length > HNBRDF_MAX_PREFIX || prefix[0] == '_' ||
        (prefix[0] >= '0' && prefix[0] <= '9') || prefix[length - 1] == '_' || strstr(prefix, "__"))
        return 0;
    for (size_t i = 0; i < length; i++)
        if (!hnbrdf_in_word(prefix[i]))
            return 0;
    char small[8] = "";
    for (size_t i = 0; i < 7 && i < length; i++)
        small[i] = hnbrdf_lower(prefix[i]);
    return strcmp(small, "gl") != 0 && strncmp(small, "gl_", 3) != 0 &&
           strcmp(small, "hnbrdf_") != 0;
}

static int begins(const char *word, size_t size, const char *with)
{
    return size >= strlen(with) && memcmp(word, with, strlen(with)) == 0;
}

/* The same for all scenes of a shader: switches, and what guards the parts of hybrid_brdf.glsl. */
static int is_shared_switch(const char *word, size_t size)
{
    static const char *const shared[] = {"HNBRDF_HALF_NATIVE", "HNBRDF_HALF",      "HNBRDF_HALF2",
                                         "HNBRDF_HALF3",       "HNBRDF_HALF4",     "HNBRDF_H",
                                         "HNBRDF_H2",          "HNBRDF_H3",        "HNBRDF_H4",
                                         "HNBRDF_LOOP",        "HNBRDF_LOOP_START"};
    for (size_t i = 0; i < sizeof shared / sizeof shared[0]; i++)
        if (strlen(shared[i]) == size && memcmp(shared[i], word, size) == 0)
            return 1;
    return begins(word, size, "HNBRDF_HYBRID_BRDF_") || begins(word, size, "HNBRDF_HAS_");
}

/* Does hybrid_brdf.glsl have this word, outside of comments? */
static int is_of_library(const char *word, size_t size)
{
    const char *text = hnbrdf_hybrid_brdf_glsl;
    for (const char *at = text; (at = strchr(at, word[0])) != NULL; at++) {
        if (strncmp(at, word, size) != 0 || hnbrdf_in_word(at[size]) ||
            (at > text && hnbrdf_in_word(at[-1])))
            continue;
        const char *line = at;
        while (line > text && line[-1] != '\n' && !(line[0] == '/' && line[1] == '/'))
            line--;
        if (!(line[0] == '/' && line[1] == '/'))
            return 1;
    }
    return 0;
}

/* A whole word, or as much of a long one as fits: longer than any that is shared. */
static int put_word(hnbrdf_renamer *r)
{
    enum { OLD = 6 }; /* "hnbrdf", "HNBRDF" */
    const size_t size = r->size;
    const int capitals = size > OLD + 1 && begins(r->word, size, "HNBRDF_");
    const int small = size > OLD + 1 && begins(r->word, size, "hnbrdf_");
    r->size = 0;
    if (r->passing || !(capitals || small) || is_shared_switch(r->word, size) ||
        is_of_library(r->word, size))
        return r->write(r->user, r->word, size);
    char prefix[HNBRDF_MAX_PREFIX];
    const size_t length = strlen(r->prefix);
    for (size_t i = 0; i < length; i++) {
        const char c = r->prefix[i];
        prefix[i] = capitals && c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
    }
    return r->write(r->user, prefix, length) || r->write(r->user, r->word + OLD, size - OLD);
}

int hnbrdf_rename_end(hnbrdf_renamer *r)
{
    const int failed = r->size > 0 && put_word(r);
    r->passing = 0;
    return failed;
}

int hnbrdf_rename(void *renamer, const void *data, size_t size)
{
    hnbrdf_renamer *r = (hnbrdf_renamer *)renamer;
    const char *text = (const char *)data;
    for (size_t i = 0; i < size; i++) {
        if (!hnbrdf_in_word(text[i])) {
            if (hnbrdf_rename_end(r) || r->write(r->user, text + i, 1))
                return 1;
            continue;
        }
        if (r->size == HNBRDF_FILTER_WORD) {
            if (put_word(r))
                return 1;
            r->passing = 1;
        }
        r->word[r->size++] = text[i];
    }
    return 0;
}

/* ---- Comments -------------------------------------------------------------------------------- */

/* Blanks and a slash that were held back belong to what comes now. */
static int put_held(hnbrdf_stripper *s)
{
    for (; s->blanks > 0; s->blanks--)
        if (s->write(s->user, " ", 1))
            return 1;
    const int slash = s->slash;
    s->slash = 0;
    s->written |= slash;
    return slash && s->write(s->user, "/", 1);
}

static int end_line(hnbrdf_stripper *s)
{
    const int written = s->written || s->slash;
    if (!s->in_comment && s->slash && put_held(s))
        return 1;
    s->blanks = 0;
    s->slash = s->in_comment = s->written = 0;
    return written && s->write(s->user, "\n", 1);
}

static int put_other(hnbrdf_stripper *s, const char *c)
{
    if (put_held(s))
        return 1;
    s->written = 1;
    return s->write(s->user, c, 1);
}

int hnbrdf_strip(void *stripper, const void *data, size_t size)
{
    hnbrdf_stripper *s = (hnbrdf_stripper *)stripper;
    const char *text = (const char *)data;
    int failed = 0;
    for (size_t i = 0; i < size && !failed; i++)
        if (text[i] == '\n')
            failed = end_line(s);
        else if (s->in_comment)
            continue;
        else if (text[i] == '/' && s->slash)
            s->in_comment = 1, s->slash = 0;
        else if (text[i] == '/')
            s->slash = 1; /* the blanks before it stay held */
        else if (text[i] == ' ' && !s->slash)
            s->blanks++;
        else
            failed = put_other(s, text + i);
    return failed;
}
