/* foreign.c: what files of other kinds begin with. */
#include "base/foreign.h"

#include "base/text.h"

#include <string.h>

/* Letters of either case; after a byte order mark and white space where `text` is set. */
typedef struct beginning {
    const char *bytes;
    size_t size;
    int text;
    const char *what;
} beginning;

#define BYTES(literal) literal, sizeof(literal) - 1

static const beginning BEGINNINGS[] = {
    {BYTES("<!doctype html"), 1, "an HTML page, as a failed download leaves"},
    {BYTES("<html"), 1, "an HTML page, as a failed download leaves"},
    {BYTES("<?xml"), 1, "an XML text: Klems matrices of WINDOW, scenes and the like are not read"},
    {BYTES("<WindowElement"), 1, "an XML text of Klems matrices, which are not read"},
    {BYTES("version https://git-lfs"), 1,
     "a pointer of Git LFS and not the file itself: run git lfs pull"},
    {BYTES("/annex/objects/"), 1, "a pointer of git-annex and not the file itself"},
    {BYTES("PK\3\4"), 0, "a zip archive (also .npz, PyTorch .pt): unpack or convert it"},
    {BYTES("\x1f\x8b"), 0, "compressed by gzip: unpack it"},
    {BYTES("\xfd"
           "7zXZ"),
     0, "compressed by xz: unpack it"},
    {BYTES("BZh"), 0, "compressed by bzip2: unpack it"},
    {BYTES("\x28\xb5\x2f\xfd"), 0, "compressed by zstd: unpack it"},
    {BYTES("7z\xbc\xaf\x27\x1c"), 0, "a 7z archive: unpack it"},
    {BYTES("Rar!"), 0, "a RAR archive: unpack it"},
    {BYTES("\x89PNG\r\n"), 0, "a PNG picture"},
    {BYTES("\xff\xd8\xff"), 0, "a JPEG picture"},
    {BYTES("%PDF-"), 0, "a PDF document"},
    {BYTES("GGUF"), 0, "a GGUF model"},
};

static int begins(const char *from, size_t size, const beginning *b)
{
    if (size < b->size)
        return 0;
    if (!b->text)
        return memcmp(from, b->bytes, b->size) == 0;
    for (size_t k = 0; k < b->size; k++)
        if (hnbrdf_lower(from[k]) != hnbrdf_lower(b->bytes[k]))
            return 0;
    return 1;
}

/* The list of the parts of a model that lies in several files, as large models do. */
static int is_index(const char *from, size_t size)
{
    static const char KEY[] = "\"weight_map\"";
    const size_t length = sizeof KEY - 1;
    if (size == 0 || *from != '{')
        return 0;
    for (size_t k = 0; k + length <= size && k < 4096; k++)
        if (memcmp(from + k, KEY, length) == 0)
            return 1;
    return 0;
}

const char *hnbrdf_foreign_file(const unsigned char *bytes, size_t size)
{
    const char *start = (const char *)bytes, *text = start, *end = start + size;
    text += hnbrdf_byte_order_mark(text, size);
    while (text < end && (*text == ' ' || (*text >= '\t' && *text <= '\r')))
        text++;
    for (size_t k = 0; k < sizeof BEGINNINGS / sizeof BEGINNINGS[0]; k++) {
        const beginning *b = &BEGINNINGS[k];
        const char *from = b->text ? text : start;
        if (begins(from, (size_t)(end - from), b))
            return b->what;
    }
    if (is_index(text, (size_t)(end - text)))
        return "the index of a model in several files, which are not read: save it as one";
    return NULL;
}
