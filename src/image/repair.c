/* repair.c: values that are not finite: found, or replaced by their neighbours. */
#include "image/image.h"

#include "base/error.h"
#include "base/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GOOD, BAD, QUEUED };

typedef struct repair {
    render_image *image;
    unsigned char *state; /* [pixels] */
    size_t *ring, *next;  /* pixels with a good neighbour; those behind them */
    size_t ring_count, next_count;
} repair;

static int is_finite(const render_image *image, size_t pixel)
{
    const float *rgb = image->rgb + 3 * pixel;
    return isfinite(rgb[0]) && isfinite(rgb[1]) && isfinite(rgb[2]) &&
           (!image->alpha || isfinite(image->alpha[pixel]));
}

hnbrdf_result render_image_check(const render_image *image, const char *name, hnbrdf_error *error)
{
    const size_t width = (size_t)image->width;
    size_t bad = 0, first = 0;
    for (size_t i = 0; i < width * (size_t)image->height; i++)
        if (!is_finite(image, i) && bad++ == 0)
            first = i;
    if (!bad)
        return HNBRDF_OK;
    const float *rgb = image->rgb + 3 * first;
    return hnbrdf_fail(
        error, HNBRDF_ERROR_FORMAT,
        "%s: %zu pixel%s not finite, the first at column %zu, row %zu: (%s, %s, %s); "
        "--repair, or repair in a scene, fills them from their neighbours",
        name, bad, bad == 1 ? " is" : "s are", first % width, first / width, HNBRDF_NUMBER(rgb[0]),
        HNBRDF_NUMBER(rgb[1]), HNBRDF_NUMBER(rgb[2]));
}

/* The pixels around one, itself left out; returns how many. */
static int neighbours(const render_image *image, size_t pixel, size_t out[8])
{
    const int width = image->width, height = image->height;
    const int x = (int)(pixel % (size_t)width), y = (int)(pixel / (size_t)width);
    int count = 0;
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++)
            if (u >= 0 && v >= 0 && u < width && v < height && (u != x || v != y))
                out[count++] = (size_t)v * (size_t)width + (size_t)u;
    return count;
}

/* Queues the bad neighbours of a pixel for the next ring. */
static void queue_around(repair *r, size_t pixel)
{
    size_t around[8];
    const int count = neighbours(r->image, pixel, around);
    for (int i = 0; i < count; i++)
        if (r->state[around[i]] == BAD) {
            r->state[around[i]] = QUEUED;
            r->next[r->next_count++] = around[i];
        }
}

/* The mean of the good neighbours of a pixel, which has some. */
static void fill(repair *r, size_t pixel)
{
    size_t around[8];
    const int count = neighbours(r->image, pixel, around);
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    int good = 0;
    for (int i = 0; i < count; i++) {
        if (r->state[around[i]] != GOOD)
            continue;
        good++;
        for (int k = 0; k < 3; k++)
            sum[k] += (double)r->image->rgb[3 * around[i] + (size_t)k];
        sum[3] += r->image->alpha ? (double)r->image->alpha[around[i]] : 0.0;
    }
    for (int k = 0; k < 3; k++)
        r->image->rgb[3 * pixel + (size_t)k] = (float)(sum[k] / good);
    if (r->image->alpha)
        r->image->alpha[pixel] = (float)(sum[3] / good);
}

/* Ring after ring, each from the pixels that were good before it; returns how many were filled. */
static size_t fill_rings(repair *r, size_t pixels)
{
    size_t filled = 0;
    for (size_t i = 0; i < pixels; i++)
        if (r->state[i] == GOOD)
            queue_around(r, i);
    while (r->next_count > 0) {
        size_t *swapped = r->ring;
        r->ring = r->next;
        r->ring_count = r->next_count;
        r->next = swapped;
        r->next_count = 0;
        for (size_t i = 0; i < r->ring_count; i++)
            fill(r, r->ring[i]);
        for (size_t i = 0; i < r->ring_count; i++)
            r->state[r->ring[i]] = GOOD;
        for (size_t i = 0; i < r->ring_count; i++)
            queue_around(r, r->ring[i]);
        filled += r->ring_count;
    }
    return filled;
}

hnbrdf_result render_image_repair(render_image *image, const char *name, const hnbrdf_notes *notes,
                                  hnbrdf_error *error)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    repair r = {.image = image};
    size_t bad = 0;
    for (size_t i = 0; i < pixels; i++)
        bad += !is_finite(image, i);
    if (bad == 0 || bad == pixels)
        return HNBRDF_OK;
    r.state = malloc(pixels);
    r.ring = malloc(bad * sizeof *r.ring);
    r.next = malloc(bad * sizeof *r.next);
    hnbrdf_result result = HNBRDF_OK;
    if (r.state && r.ring && r.next) {
        for (size_t i = 0; i < pixels; i++)
            r.state[i] = is_finite(image, i) ? GOOD : BAD;
        const size_t filled = fill_rings(&r, pixels);
        hnbrdf_note(notes, "%s: %zu pixel%s not finite, replaced by the mean of %s neighbours",
                    name, filled, filled == 1 ? " was" : "s were", filled == 1 ? "its" : "their");
    } else {
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: no memory to repair it", name);
    }
    free(r.state);
    free(r.ring);
    free(r.next);
    return result;
}
