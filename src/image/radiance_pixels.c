/* radiance_pixels.c: the scanlines of a Radiance picture, each flat or in one of two codings.
 *
 * New run lengths begin with (2, 2) and the length in two bytes, of 8 to 32767 pixels; the four
 * bytes of the pixels follow in planes. Else pixels stand one after the other, and (1, 1, 1, n),
 * which is no pixel since a mantissa of a pixel is at least 128, means n of the one before. */
#include "image/radiance.h"

#include "base/error.h"

#include <string.h>

enum { MOST_CODED = 32767 };

static hnbrdf_result cut_short(const radiance_input *in)
{
    return radiance_bad(in, "the file ends inside a scanline");
}

static hnbrdf_result too_long(const radiance_input *in)
{
    return radiance_bad(in, "a run that does not fit its scanline");
}

/* A pixel and its run: counts of one byte, or of two in two runs. */
size_t radiance_least_size(size_t lines, int length)
{
    return lines * (length == 1 ? 4 : length <= 256 ? 8 : 12);
}

/* One of the four planes of a scanline, to every fourth byte of row. */
static hnbrdf_result plane(radiance_input *in, int length, unsigned char *row)
{
    for (int x = 0; x < length;) {
        if (in->size - in->at < 2)
            return cut_short(in);
        int count = in->data[in->at++];
        const int is_run = count > 128;
        count = is_run ? count - 128 : count;
        if (count == 0 || count > length - x)
            return too_long(in);
        if (!is_run && in->size - in->at < (size_t)count)
            return cut_short(in);
        for (int i = 0; i < count; i++, x++)
            row[4 * x] = in->data[in->at + (size_t)(is_run ? 0 : i)];
        in->at += is_run ? 1 : (size_t)count;
    }
    return HNBRDF_OK;
}

static hnbrdf_result planes(radiance_input *in, int length, unsigned char *rgbe)
{
    const unsigned char *start = in->data + in->at;
    if (start[2] * 256 + start[3] != length)
        return radiance_bad(in, "a scanline of another length than the picture's");
    in->at += 4;
    for (int k = 0; k < 4; k++) {
        const hnbrdf_result result = plane(in, length, rgbe + k);
        if (result != HNBRDF_OK)
            return result;
    }
    return HNBRDF_OK;
}

/* Of the runs that follow each other each counts 256 times as much as the one before. */
static hnbrdf_result run(radiance_input *in, int length, unsigned char *rgbe, int *x, int *shift)
{
    const int n = in->data[in->at + 3];
    if (*x == 0)
        return radiance_bad(in, "a run (1, 1, 1, n) without a pixel before it in its scanline");
    if (n > 0 && (*shift > 16 || n << *shift > length - *x))
        return too_long(in);
    for (int i = 0, count = n > 0 ? n << *shift : 0; i < count; i++, ++*x)
        memcpy(rgbe + 4 * *x, rgbe + 4 * (*x - 1), 4);
    *shift += *shift > 16 ? 0 : 8;
    in->at += 4;
    return HNBRDF_OK;
}

static hnbrdf_result pixels(radiance_input *in, int is_flat, int length, unsigned char *rgbe)
{
    int shift = 0;
    for (int x = 0; x < length;) {
        if (in->size - in->at < 4)
            return cut_short(in);
        const unsigned char *next = in->data + in->at;
        if (!is_flat && next[0] == 1 && next[1] == 1 && next[2] == 1) {
            const hnbrdf_result result = run(in, length, rgbe, &x, &shift);
            if (result != HNBRDF_OK)
                return result;
        } else {
            memcpy(rgbe + 4 * x++, next, 4);
            in->at += 4;
            shift = 0;
        }
    }
    return HNBRDF_OK;
}

/* Some programs also write scanlines of fewer than 8 pixels in planes: (2, 2, 0, length) would be a
 * pixel of less than 1e-38. Longer ones than can be told have such pixels if (2, 2) begins them. */
static int is_in_planes(const radiance_input *in, int length)
{
    const unsigned char *start = in->data + in->at;
    return in->size - in->at >= 4 && start[0] == 2 && start[1] == 2 && start[2] < 128 &&
           length <= MOST_CODED && (length >= 8 || (start[2] == 0 && start[3] == length));
}

hnbrdf_result radiance_read_scanline(radiance_input *in, int is_flat, int length,
                                     unsigned char *rgbe)
{
    return is_in_planes(in, length) ? planes(in, length, rgbe) : pixels(in, is_flat, length, rgbe);
}
