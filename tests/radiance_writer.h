/* radiance_writer.h: Radiance pictures of every coding and orientation for the tests, and what was
 * told and read of them. */
#ifndef HNBRDF_TESTS_RADIANCE_WRITER_H
#define HNBRDF_TESTS_RADIANCE_WRITER_H

#include "image/image.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef enum radiance_coding { RADIANCE_FLAT, RADIANCE_OLD_RUNS, RADIANCE_PLANES } radiance_coding;

/* Orientation 0 to 7: bit 0 columns from the right, bit 1 rows from below, bit 2 scanlines are
 * columns. 0 is the usual one. */
enum { RADIANCE_ORIENTATIONS = 8 };

/* Pixel (x, y) of a picture, counted from its left and its top. */
typedef void radiance_pixel(int x, int y, unsigned char rgbe[4]);

/* A file: the header up to its empty line, the resolution, the pixels. Scanlines that cannot be in
 * planes (fewer than 8 pixels, more than 32767) are flat, as Radiance has it. */
render_bytes radiance_write(const char *header, int width, int height, int orientation,
                            radiance_coding coding, radiance_pixel *pixel);
void radiance_put(render_bytes *bytes, const void *data, size_t size);

/* Reads a block of exactly this size, so that ASan sees the first byte beyond; notes are kept, a
 * line each. A refusal is one line. */
hnbrdf_result radiance_read(const void *data, size_t size, render_image *image,
                            hnbrdf_error *error);
extern char radiance_notes[2000];
/* The picture, or the test fails. */
render_image radiance_expect(const void *data, size_t size);
/* Refused so, in words that have `text` in them. */
void radiance_expect_refused(const void *data, size_t size, hnbrdf_result expected,
                             const char *text);

#endif
