/* colour_space.h: linear Rec. 709 from linear RGB of other primaries and from CIE XYZ; what the
 * readers of pictures share. Private to the room. */
#ifndef HNBRDF_IMAGE_COLOUR_SPACE_H
#define HNBRDF_IMAGE_COLOUR_SPACE_H

#include "hnbrdf/hnbrdf.h"

/* CIE 1931 (x, y) chromaticities. */
typedef struct colour_primaries {
    float red[2], green[2], blue[2], white[2];
} colour_primaries;

typedef double colour_matrix[3][3];

extern const colour_primaries colour_rec709;

/* Two chromaticities that are equal but for what writers round: four decimals. */
int colour_is_near(const float a[2], const float b[2]);
int colour_are_near(const colour_primaries *a, const colour_primaries *b);

/* Linear RGB to CIE XYZ: the primaries, so scaled that their sum is the white of luminance 1. 0, or
 * -1 if these are no primaries. */
int colour_to_xyz(const colour_primaries *primaries, colour_matrix out);
/* CIE XYZ to linear RGB, likewise. */
int colour_from_xyz(const colour_primaries *primaries, colour_matrix out);

/* Linear Rec. 709 from what to_xyz takes to CIE XYZ, as the bits of a float matrix. With neutral,
 * a chromaticity, colours are adapted (Bradford): what has it becomes white. */
void colour_to_rec709(colour_matrix to_xyz, const float neutral[2], float out[3][3]);
/* out = matrix rgb, in place, for count pixels. */
void colour_convert(float matrix[3][3], float *rgb, int count);

/* Tells a note that a picture was converted from these primaries. */
void colour_tell(const hnbrdf_notes *notes, const char *name, const colour_primaries *primaries,
                 const char *more);

#endif
