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

/* The word in front of the first of "({" on the first line that is neither comment nor directive.
 * */
static void find_name(piece *p)
{
    const char *line = p->text, *end = p->text + p->size;
    while (line < end && (*line == '/' || *line == '#' || *line == '\n')) {
        const char *next = (const char *)memchr(line, '\n', (size_t)(end - line));
        line = next ? next + 1 : end;
    }
    const char *after = line;
    while (after < end && *after != '(' && *after != '{' && *after != '\n')
        after++;
    if (after == end || *after == '\n')
        return;
    while (after > line && !hnbrdf_in_word(after[-1]))
        after--;
    p->name = after;
    while (p->name > line && hnbrdf_in_word(p->name[-1]))
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
    library *lib = (library *)user;
    const char *text = (const char *)data;
    for (size_t i = 0; i < size; i++) {
        if (hnbrdf_in_word(text[i])) {
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

/* Says that parts are missing, so that a text which needs them can say so. */
static const char LEAN[] = "#define HNBRDF_HYBRID_BRDF_LEAN\n\n";

/* All of it, but for the section on edits where nothing is edited. */
static void put_whole(hnbrdf_printer *out, int edited)
{
    const char *text = hnbrdf_hybrid_brdf_glsl, *end = text + strlen(text);
    const char *first = piece_end(text), *edits = strstr(text, "// ---- Edits ");
    const char *after = edits ? strstr(edits + 1, "\n// ---- ") : NULL;
    if (edited || !after) {
        hnbrdf_put_bytes(out, text, (size_t)(end - text));
        return;
    }
    hnbrdf_put_bytes(out, text, (size_t)(first - text));
    hnbrdf_put_bytes(out, LEAN, sizeof LEAN - 1);
    hnbrdf_put_bytes(out, first, (size_t)(edits - first));
    hnbrdf_put_bytes(out, after + 1, (size_t)(end - after - 1));
}

/* ---- Parts that several texts share ---------------------------------------------------------- */

static const char PARTS[] =
    "//\n// Here are the parts that this text needs. Each is there once, however many texts with a "
    "prefix have it.\n"
    "#ifdef HNBRDF_HYBRID_BRDF_LEAN\n"
    "#error a standalone text without a prefix came before this one: export it with --prefix too\n"
    "#endif\n"
    "#ifndef HNBRDF_HYBRID_BRDF_GLSL\n"
    "#define HNBRDF_HYBRID_BRDF_PARTS\n\n";

/* The comment on top of the library. */
static void put_top(hnbrdf_printer *out, const piece *p)
{
    const char *end = p->text;
    while (end[0] == '/')
        end = strchr(end, '\n') + 1;
    hnbrdf_put_bytes(out, p->text, (size_t)(end - p->text));
    hnbrdf_put_bytes(out, PARTS, sizeof PARTS - 1);
}

/* HNBRDF_HAS_CLAMP for hnbrdf_clamp, with its number where several have the name. */
static void put_guard(hnbrdf_printer *out, const library *lib, int index)
{
    const piece *p = &lib->pieces[index];
    char name[MAX_WORD + 1] = "";
    int same = 1;
    for (int k = 0; k < index; k++)
        same += lib->pieces[k].name_size == p->name_size &&
                memcmp(lib->pieces[k].name, p->name, p->name_size) == 0;
    for (size_t i = sizeof "hnbrdf_" - 1; i < p->name_size && i < MAX_WORD; i++) {
        const char c = p->name[i];
        name[i - (sizeof "hnbrdf_" - 1)] = c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
    }
    hnbrdf_put(out, same > 1 ? "HNBRDF_HAS_%s_%d\n" : "HNBRDF_HAS_%s\n", name, same);
}

static void put_part(hnbrdf_printer *out, const library *lib, int index)
{
    const piece *p = &lib->pieces[index];
    size_t size = p->size;
    while (size > 0 && p->text[size - 1] == '\n')
        size--;
    hnbrdf_put(out, "#ifndef ");
    put_guard(out, lib, index);
    hnbrdf_put(out, "#define ");
    put_guard(out, lib, index);
    hnbrdf_put_bytes(out, p->text, size);
    hnbrdf_put(out, "\n#endif\n\n");
}

/* ---- All of it ------------------------------------------------------------------------------- */

static void put_pieces(hnbrdf_printer *out, const library *lib, int shared)
{
    for (int k = 0; k < lib->count; k++) {
        const piece *p = &lib->pieces[k];
        if (k == 0 && shared) {
            put_top(out, p);
        } else if (p->needed && shared) {
            put_part(out, lib, k);
        } else if (p->needed || (p->name_size == 0 && !is_heading(p))) {
            hnbrdf_put_bytes(out, p->text, p->size);
            if (k == 0)
                hnbrdf_put_bytes(out, LEAN, sizeof LEAN - 1);
        }
    }
}

void hnbrdf_put_library(hnbrdf_printer *out, const hnbrdf_scene *s, hnbrdf_put_scene_fn put_scene)
{
    library lib;
    if (s->whole || (s->only == HNBRDF_GLSL_EVERYTHING && !s->fixed && !s->parts)) {
        put_whole(out, s->whole || s->edited);
        return;
    }
    take_apart(&lib);
    hnbrdf_printer reader = {.write = need_words, .user = &lib};
    put_scene(&reader, s);
    hnbrdf_put_flush(&reader);
    need_what_is_needed(&lib);
    put_pieces(out, &lib, s->parts);
}
