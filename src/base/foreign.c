/* foreign.c: what files of other kinds begin with, and how their names end. */
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
    {BYTES("<?xml"), 1, "an XML text: matrices of Radiance or WINDOW and scenes are not read"},
    {BYTES("<WindowElement"), 1,
     "an XML text of matrices of Radiance or WINDOW, which are not read"},
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
    {BYTES("MATLAB "), 0, "a MATLAB file, which is not read"},
    {BYTES("IESNA"), 1, "photometric data of a lamp (IES), which are no reflectance"},
    {BYTES("NVIDIA ARC MBSDF"), 0, "an MBSDF measurement of MDL, which is not read"},
    {BYTES("II*\0"), 0, "a TIFF picture"},
    {BYTES("MM\0*"), 0, "a TIFF picture"},
};

static const beginning OWN[] = {
    {BYTES("\x76\x2f\x31\x01"), 0, "an OpenEXR picture"},
    {BYTES("#?RADIANCE"), 0, "a Radiance picture"},
    {BYTES("#?RGBE"), 0, "a Radiance picture"},
    {BYTES("tensor_file"), 0, "measured data in a tensor file (RGL .bsdf)"},
    {BYTES("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0"), 0, "measured data of MERL (.binary)"},
    {BYTES("\x93NUMPY"), 0, "a NumPy array"},
    {BYTES("\x89HDF\r\n\x1a\n"), 0, "an HDF5 file"},
};

/* Formats of reflectance data by the endings of their names, and what their bytes may be: anything
 * that is not recognised, a text, or also what looks like a format that is read. */
enum { ANYTHING, TEXT, LOOKALIKE };
static const struct {
    const char *ending;
    int bytes;
    const char *what;
} NAMES[] = {
    {".pbsdf", LOOKALIKE, "a polarised BRDF (Baek et al. 2020, Mitsuba's measured_polarized)"},
    {".hpbrdf", LOOKALIKE, "a hyperspectral polarised BRDF"},
    {".axf", LOOKALIKE, "an AxF material"},
    {".astm", ANYTHING, "a BRDF as ASTM E1392"},
    {".ddr", ANYTHING, "a BRDF of Integra"},
    {".sdr", ANYTHING, "a specular BRDF of Integra"},
    {".ddt", ANYTHING, "a BTDF of Integra"},
    {".sdt", ANYTHING, "a specular BTDF of Integra"},
    {".ssdd", ANYTHING, "surface scattering distribution data (SSDD)"},
    {".bsdf", TEXT, "a text, not RGL's .bsdf: LightTools and Zemax have others"},
    {".mat", ANYTHING, "a MATLAB file"},
    {".ies", ANYTHING, "photometric data of a lamp (IES)"},
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

/* Behind a byte order mark and white space. */
static const char *text_of(const char *start, const char *end)
{
    start += hnbrdf_byte_order_mark(start, (size_t)(end - start));
    while (start < end && (*start == ' ' || (*start >= '\t' && *start <= '\r')))
        start++;
    return start;
}

static const char *find_beginning(const beginning *list, size_t count, const char *start,
                                  const char *end)
{
    const char *text = text_of(start, end);
    for (size_t k = 0; k < count; k++) {
        const char *from = list[k].text ? text : start;
        if (begins(from, (size_t)(end - from), &list[k]))
            return list[k].what;
    }
    return NULL;
}

const char *hnbrdf_foreign_file(const unsigned char *bytes, size_t size)
{
    const char *start = (const char *)bytes, *end = start + size, *text = text_of(start, end);
    const char *what =
        find_beginning(BEGINNINGS, sizeof BEGINNINGS / sizeof BEGINNINGS[0], start, end);
    if (what)
        return what;
    if (is_index(text, (size_t)(end - text)))
        return "the index of a model in several files, which are not read: save it as one";
    return NULL;
}

/* ---- What is read ---------------------------------------------------------------------------- */

/* Eight bytes of length, then the header, a JSON object with the format among its metadata. */
static int is_safetensors(const unsigned char *bytes, size_t size)
{
    return size > 9 && bytes[6] == 0 && bytes[7] == 0 && bytes[8] == '{' && bytes[9] == '"';
}

int hnbrdf_is_brdf_text(const unsigned char *bytes, size_t size)
{
    static const beginning FIRST[] = {{BYTES("analytic"), 1, ""}, {BYTES("::begin"), 1, ""}};
    const char *start = (const char *)bytes;
    return find_beginning(FIRST, sizeof FIRST / sizeof FIRST[0], start, start + size) != NULL;
}

const char *hnbrdf_own_file(const unsigned char *bytes, size_t size)
{
    const char *start = (const char *)bytes;
    if (is_safetensors(bytes, size))
        return "a model file (safetensors)";
    if (hnbrdf_is_brdf_text(bytes, size))
        return "a published .brdf shader; make a model of it first: hnbrdf import";
    return find_beginning(OWN, sizeof OWN / sizeof OWN[0], start, start + size);
}

/* Judged by its first bytes. */
static int is_text(const unsigned char *bytes, size_t size)
{
    for (size_t k = 0; k < size && k < 64; k++)
        if (bytes[k] < ' ' && (bytes[k] < '\t' || bytes[k] > '\r'))
            return 0;
    return size > 0;
}

int hnbrdf_foreign_lookalike(const char *path)
{
    for (size_t k = 0; k < sizeof NAMES / sizeof NAMES[0]; k++)
        if (NAMES[k].bytes == LOOKALIKE && hnbrdf_ends_with(path, NAMES[k].ending))
            return 1;
    return 0;
}

const char *hnbrdf_foreign_name(const char *path, const unsigned char *bytes, size_t size)
{
    for (size_t k = 0; k < sizeof NAMES / sizeof NAMES[0]; k++)
        if (hnbrdf_ends_with(path, NAMES[k].ending) &&
            (NAMES[k].bytes != TEXT || is_text(bytes, size)))
            return NAMES[k].what;
    return NULL;
}
