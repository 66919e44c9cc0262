/* export_library.c: the text of shaders/hybrid_brdf.glsl, whole or as far as a scene needs it.
 * The text is taken apart into its top-level pieces, which blank lines separate; what defines a
 * function or a struct stays only if something that stays names it. */
#include "glsl/export_library.h"

#include "base/text.h"

#include <string.h>

enum { MAX_PIECES = 128, MAX_WORD = 64 };

/* name is what the piece defines, of length 0 for pieces that define nothing. */
typedef struct piece {
    const char *text, *name;
    size_t size, name_size;
    int needed, read;
} piece;

typedef struct library {
    piece pieces[MAX_PIECES];
    int count;
    char word[MAX_WORD]; /* begun at the end of what was read last */
    size_t word_size;
} library;

/* ---- Taking apart ---------------------------------------------------------------------------- */

static int in_word(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/* The word in front of the first of "({" on the first line that is neither comment nor directive.
 * */
static void find_name(piece *p)
{
    const char *line = p->text, *end = p->text + p->size;
    while (line < end && (*line == '/' || *line == '#' || *line == '\n')) {
        const char *next = memchr(line, '\n', (size_t)(end - line));
        line = next ? next + 1 : end;
    }
    const char *after = line;
    while (after < end && *after != '(' && *after != '{' && *after != '\n')
        after++;
    if (after == end || *after == '\n')
        return;
    while (after > line && !in_word(after[-1]))
        after--;
    p->name = after;
    while (p->name > line && in_word(p->name[-1]))
        p->name--;
    p->name_size = (size_t)(after - p->name);
}

/* One line ends where the next begins; a piece ends at an empty line outside of all braces. */
static const char *piece_end(const char *text)
{
    int depth = 0;
    for (; *text; text++) {
        depth += (*text == '{') - (*text == '}');
        if (depth == 0 && text[0] == '\n' && text[1] == '\n')
            return text + 2;
    }
    return text;
}

static void take_apart(library *lib)
{
    const char *text = hnbrdf_hybrid_brdf_glsl;
    memset(lib, 0, sizeof *lib);
    while (*text && lib->count < MAX_PIECES) {
        const char *end = lib->count + 1 < MAX_PIECES ? piece_end(text) : text + strlen(text);
        piece *p = &lib->pieces[lib->count++];
        p->text = text;
        p->size = (size_t)(end - text);
        find_name(p);
        text = end;
    }
}

/* ---- What is needed -------------------------------------------------------------------------- */

/* HNBRDF_EXP(x) may stand for hnbrdf_exp(x): letters count as equal whatever their case. */
static void need_word(library *lib)
{
    for (size_t i = 0; i < lib->word_size; i++)
        lib->word[i] = hnbrdf_lower(lib->word[i]);
    for (int k = 0; k < lib->count; k++) {
        piece *p = &lib->pieces[k];
        if (p->name_size == lib->word_size && memcmp(p->name, lib->word, p->name_size) == 0)
            p->needed = 1;
    }
}

/* An hnbrdf_write_fn: marks what these bytes name. */
static int need_words(void *user, const void *data, size_t size)
{
    library *lib = user;
    const char *text = data;
    for (size_t i = 0; i < size; i++) {
        if (in_word(text[i])) {
            if (lib->word_size < MAX_WORD)
                lib->word[lib->word_size] = text[i];
            lib->word_size++;
        } else {
            if (lib->word_size > 0 && lib->word_size <= MAX_WORD)
                need_word(lib);
            lib->word_size = 0;
        }
    }
    return 0;
}

static void need_what_is_needed(library *lib)
{
    for (int found = 1; found;) {
        found = 0;
        for (int k = 0; k < lib->count; k++) {
            piece *p = &lib->pieces[k];
            if (p->needed && !p->read) {
                found = p->read = 1;
                need_words(lib, p->text, p->size);
            }
        }
    }
}

/* "// ---- Encodings ---- ...": a heading, which is dropped with what stood under it. */
static int is_heading(const piece *p)
{
    return p->size > 7 && memcmp(p->text, "// ----", 7) == 0 && p->name_size == 0;
}

/* All of it, but for the section on edits where nothing is edited. */
static void put_whole(hnbrdf_printer *out, int edited)
{
    const char *text = hnbrdf_hybrid_brdf_glsl, *end = text + strlen(text);
    const char *edits = strstr(text, "// ---- Edits ");
    const char *after = edits ? strstr(edits + 1, "\n// ---- ") : NULL;
    if (edited || !after) {
        hnbrdf_put_bytes(out, text, (size_t)(end - text));
        return;
    }
    hnbrdf_put_bytes(out, text, (size_t)(edits - text));
    hnbrdf_put_bytes(out, after + 1, (size_t)(end - after - 1));
}

void hnbrdf_put_library(hnbrdf_printer *out, const hnbrdf_scene *s, hnbrdf_put_scene_fn put_scene)
{
    library lib;
    if (s->only == HNBRDF_GLSL_EVERYTHING && !s->fixed) {
        put_whole(out, s->edited);
        return;
    }
    take_apart(&lib);
    hnbrdf_printer reader = {.write = need_words, .user = &lib};
    put_scene(&reader, s);
    hnbrdf_put_flush(&reader);
    need_what_is_needed(&lib);
    for (int k = 0; k < lib.count; k++)
        if (lib.pieces[k].needed || (lib.pieces[k].name_size == 0 && !is_heading(&lib.pieces[k])))
            hnbrdf_put_bytes(out, lib.pieces[k].text, lib.pieces[k].size);
}
