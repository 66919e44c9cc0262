/* radiance.h: what the files of the Radiance reader share. Private to the room.
 *
 *   radiance_header.c   lines of the header, the resolution
 *   radiance_pixels.c   scanlines: flat, old and new run lengths
 *   radiance.c          both in order; where pixels belong, their colours */
#ifndef HNBRDF_IMAGE_RADIANCE_H
#define HNBRDF_IMAGE_RADIANCE_H

#include "image/colour_space.h"
#include "image/image.h"

/* A file that is being read. */
typedef struct radiance_input {
    const unsigned char *data;
    size_t size, at;
    const char *name; /* for messages */
    hnbrdf_notes notes;
    hnbrdf_error *error;
} radiance_input;

/* An error at the place that is read. */
hnbrdf_result radiance_bad(const radiance_input *in, const char *what);

typedef struct radiance_header {
    int width, height;           /* of the picture */
    int by_columns;              /* scanlines are columns */
    int from_right, from_bottom; /* where columns and rows begin; 0: left, top */
    int is_xyz;
    int has_primaries; /* that are not those that every picture has without the line */
    colour_primaries primaries;
} radiance_header;

/* The primaries and the white that a picture has that does not say. */
extern const colour_primaries radiance_primaries;

/* Reads all that is before the pixels; what is not applied it tells a note. */
hnbrdf_result radiance_read_header(radiance_input *in, radiance_header *header);

/* What `lines` scanlines of `length` pixels take at least, in bytes. */
size_t radiance_least_size(size_t lines, int length);
/* The next scanline as [length][4]: three mantissas and the exponent. is_flat: the rest of the file
 * is as long as pixels without any run. */
hnbrdf_result radiance_read_scanline(radiance_input *in, int is_flat, int length,
                                     unsigned char *rgbe);

#endif
