/* radiance_header.c: the header of a Radiance picture and the line with its resolution.
 *
 * Of the lines only FORMAT and PRIMARIES change what is read; what EXPOSURE and COLORCORR say that
 * was multiplied into the pixels stays in them, as in the other programs that take such pictures
 * for light, and is told. PIXASPECT and VIEW are of cameras. Lines that begin with a blank are
 * headers of pictures that this one was made from. */
#include "image/radiance.h"

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LINE = 256 };

const colour_primaries radiance_primaries = {
    {.640f, .330f}, {.290f, .600f}, {.150f, .060f}, {1.0f / 3, 1.0f / 3}};

/* What has been multiplied into the pixels. */
typedef struct corrections {
    double exposure, colour[3];
} corrections;

hnbrdf_result radiance_bad(const radiance_input *in, const char *what)
{
    return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT, "%s: at byte %zu: %s", in->name, in->at,
                       what);
}

/* Copies one line without its end into text, truncated, control characters made '?' but for tabs,
 * which are blanks; 0 at the end of the file. */
static int header_line(radiance_input *in, char text[LINE])
{
    size_t length = 0;
    while (in->at < in->size) {
        const unsigned char c = in->data[in->at++];
        if (c == '\n') {
            if (length > 0 && in->data[in->at - 2] == '\r')
                length--;
            text[length] = 0;
            return 1;
        }
        if (length + 1 < LINE)
            text[length++] = (char)(c == '\t' ? ' ' : c < ' ' ? '?' : c);
    }
    return 0;
}

static const char *skip_blanks(const char *text)
{
    return text + strspn(text, " ");
}

/* Pictures from before 1992 have no first line "#?RADIANCE", but say their format. */
int render_is_radiance(const void *data, size_t size)
{
    radiance_input in = {.data = data, .size = size < 4096 ? size : 4096};
    char line[LINE];
    if (size >= 2 && memcmp(data, "#?", 2) == 0)
        return 1;
    while (header_line(&in, line) && line[0])
        if (strncmp(line, "FORMAT=32-bit_rle_", 18) == 0)
            return 1;
    return 0;
}

/* ---- The resolution -------------------------------------------------------------------------- */

static int positive(const char **text)
{
    long value = 0;
    const char *c = *text;
    while (*c >= '0' && *c <= '9' && value <= RENDER_MAX_SIDE)
        value = 10 * value + (*c++ - '0');
    const int complete = c != *text && !(*c >= '0' && *c <= '9');
    *text = c;
    return complete && value <= RENDER_MAX_SIDE ? (int)value : 0;
}

/* "-Y 512", with any blanks: returns the letter, or 0 if there is no such thing. */
static char axis(const char **text, char *sign, int *side)
{
    const char *c = skip_blanks(*text);
    *sign = *c;
    if (*c != '+' && *c != '-')
        return 0;
    const char letter = *++c;
    if (letter != 'X' && letter != 'Y')
        return 0;
    c = skip_blanks(c + 1);
    *side = positive(&c);
    *text = c;
    return (char)(*side ? letter : 0);
}

/* The axis that comes first is the slow one; x counts from the left, y from below. */
static hnbrdf_result resolution(radiance_input *in, radiance_header *header)
{
    char line[LINE], signs[2], letters[2];
    int sides[2];
    if (!header_line(in, line))
        return radiance_bad(in, "the file ends before the line with the resolution");
    const char *text = line;
    letters[0] = axis(&text, &signs[0], &sides[0]);
    letters[1] = (char)(letters[0] ? axis(&text, &signs[1], &sides[1]) : 0);
    if (!letters[1] || letters[0] == letters[1] || *skip_blanks(text))
        return hnbrdf_fail(in->error, HNBRDF_ERROR_FORMAT,
                           "%s: resolution '%s': expected '-Y HEIGHT +X WIDTH', or '+' or '-' and "
                           "the two in another order, with sides of 1 to %d",
                           in->name, line, RENDER_MAX_SIDE);
    const int x = letters[0] == 'X' ? 0 : 1, y = 1 - x;
    header->by_columns = x == 0;
    header->width = sides[x];
    header->height = sides[y];
    header->from_right = signs[x] == '-';
    header->from_bottom = signs[y] == '+';
    return HNBRDF_OK;
}

/* ---- Other lines ----------------------------------------------------------------------------- */

/* What stands behind KEY=, without blanks around it and with a NUL; NULL if the line is another. */
static char *value_of(char *line, const char *key)
{
    const size_t length = strlen(key);
    if (strncmp(line, key, length) != 0)
        return NULL;
    char *value = line + length + strspn(line + length, " ");
    for (size_t end = strlen(value); end > 0 && value[end - 1] == ' '; end--)
        value[end - 1] = 0;
    return value;
}

/* Numbers between blanks, each finite; what follows them does not matter. */
static int numbers(const char *text, int count, double *values)
{
    const char *end = text + strlen(text);
    for (int i = 0; i < count; i++) {
        text = hnbrdf_parse_double(skip_blanks(text), end, &values[i]);
        if (!text || (*text && *text != ' '))
            return 0;
    }
    return 1;
}

/* Multiplies by the numbers of the line, all positive; a note of others. */
static void multiply(const radiance_input *in, const char *key, const char *text, int count,
                     double *product)
{
    double values[3];
    int are_good = numbers(text, count, values);
    for (int i = 0; i < count && are_good; i++)
        are_good = values[i] > 0.0;
    if (!are_good)
        hnbrdf_note(&in->notes, "%s: passed over: %s%s", in->name, key, text);
    for (int i = 0; i < count && are_good; i++)
        product[i] *= values[i];
}

static void primaries(const radiance_input *in, const char *text, radiance_header *header)
{
    double v[8];
    float f[8];
    colour_matrix to_xyz;
    int are_good = numbers(text, 8, v);
    for (int i = 0; i < 8; i++)
        f[i] = are_good ? (float)v[i] : 0.0f;
    const colour_primaries own = {{f[0], f[1]}, {f[2], f[3]}, {f[4], f[5]}, {f[6], f[7]}};
    are_good = are_good && f[6] > 0.01f && f[6] < 1.0f && f[7] > 0.01f && f[7] < 1.0f &&
               colour_to_xyz(&own, to_xyz) == 0;
    if (!are_good)
        hnbrdf_note(&in->notes, "%s: passed over, since these are none: PRIMARIES=%s", in->name,
                    text);
    header->has_primaries = are_good && !colour_are_near(&own, &radiance_primaries);
    header->primaries = header->has_primaries ? own : radiance_primaries;
}

static hnbrdf_result other_line(const radiance_input *in, char *line, radiance_header *header,
                                corrections *applied)
{
    const char *value;
    if ((value = value_of(line, "FORMAT=")) != NULL) {
        header->is_xyz = strcmp(value, "32-bit_rle_xyze") == 0;
        if (!header->is_xyz && strcmp(value, "32-bit_rle_rgbe") != 0)
            return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                               "%s: FORMAT '%s': expected 32-bit_rle_rgbe or 32-bit_rle_xyze",
                               in->name, value);
    } else if ((value = value_of(line, "EXPOSURE=")) != NULL) {
        multiply(in, "EXPOSURE=", value, 1, &applied->exposure);
    } else if ((value = value_of(line, "COLORCORR=")) != NULL) {
        multiply(in, "COLORCORR=", value, 3, applied->colour);
    } else if ((value = value_of(line, "PRIMARIES=")) != NULL) {
        primaries(in, value, header);
    }
    return HNBRDF_OK;
}

static void tell(const radiance_input *in, const corrections *applied)
{
    const double *c = applied->colour;
    const int is_exposed = applied->exposure != 1.0;
    const int is_corrected = c[0] != 1.0 || c[1] != 1.0 || c[2] != 1.0;
    char exposure[64] = "", correction[128] = "";
    if (is_exposed)
        snprintf(exposure, sizeof exposure, "EXPOSURE %s", HNBRDF_NUMBER(applied->exposure));
    if (is_corrected)
        snprintf(correction, sizeof correction, "COLORCORR %s %s %s", HNBRDF_NUMBER(c[0]),
                 HNBRDF_NUMBER(c[1]), HNBRDF_NUMBER(c[2]));
    if (is_exposed || is_corrected)
        hnbrdf_note(&in->notes, "%s: not divided by its %s%s%s: the values are those in the file",
                    in->name, exposure, is_exposed && is_corrected ? " and " : "", correction);
}

hnbrdf_result radiance_read_header(radiance_input *in, radiance_header *header)
{
    corrections applied = {1.0, {1.0, 1.0, 1.0}};
    char line[LINE];
    *header = (radiance_header){.primaries = radiance_primaries};
    if (!render_is_radiance(in->data, in->size))
        return radiance_bad(in, "no Radiance header: expected a first line that starts with '#?'");
    for (;;) {
        if (!header_line(in, line))
            return radiance_bad(in, "the file ends inside the header");
        if (line[0] == 0)
            break;
        const hnbrdf_result result = other_line(in, line, header, &applied);
        if (result != HNBRDF_OK)
            return result;
    }
    tell(in, &applied);
    return resolution(in, header);
}
