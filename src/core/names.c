/* names.c: the words for the kinds and the encodings, and the way back from a word. */
#include "core/encoding.h"
#include "hnbrdf/hnbrdf.h"

#include <string.h>

/* Arrays of bytes, not pointers: nothing for the linker to write when the library is loaded. */
static const char kinds[][8] = {
    [HNBRDF_KIND_HYBRID] = "hybrid",
    [HNBRDF_KIND_NEURAL] = "neural",
    [HNBRDF_KIND_GGX] = "ggx",
};

typedef struct encoding_row {
    char name[22];
    char reciprocal, sees_azimuth;
} encoding_row;

#define ROW(ENUM, function, name, reciprocal, azimuth) \
    [HNBRDF_ENCODING_##ENUM] = {name, reciprocal, azimuth},
static const encoding_row encodings[] = {HNBRDF_ENCODINGS(ROW)};

enum { KINDS = sizeof kinds / sizeof kinds[0], ENCODINGS = sizeof encodings / sizeof encodings[0] };

const char *hnbrdf_kind_name(hnbrdf_kind kind)
{
    return (unsigned)kind < KINDS ? kinds[kind] : NULL;
}

int hnbrdf_kind_from_name(const char *name, hnbrdf_kind *kind)
{
    for (int k = 0; k < KINDS; k++)
        if (strcmp(name, kinds[k]) == 0) {
            *kind = (hnbrdf_kind)k;
            return 1;
        }
    return 0;
}

static const encoding_row *row_of(hnbrdf_encoding encoding)
{
    return (unsigned)encoding < ENCODINGS ? &encodings[encoding] : NULL;
}

const char *hnbrdf_encoding_name(hnbrdf_encoding encoding)
{
    const encoding_row *row = row_of(encoding);
    return row ? row->name : NULL;
}

int hnbrdf_encoding_from_name(const char *name, hnbrdf_encoding *encoding)
{
    for (int k = 0; k < ENCODINGS; k++)
        if (strcmp(name, encodings[k].name) == 0) {
            *encoding = (hnbrdf_encoding)k;
            return 1;
        }
    return 0;
}

int hnbrdf_encoding_is_reciprocal(hnbrdf_encoding encoding)
{
    const encoding_row *row = row_of(encoding);
    return row && row->reciprocal;
}

int hnbrdf_encoding_sees_azimuth(hnbrdf_encoding encoding)
{
    const encoding_row *row = row_of(encoding);
    return row && row->sees_azimuth;
}
