/* exr_writer.h: OpenEXR files of every kind, written into memory by OpenEXR's own C++ library. */
#ifndef HNBRDF_TESTS_EXR_WRITER_H
#define HNBRDF_TESTS_EXR_WRITER_H

#include "image/image.h"

enum { EXR_COMPRESSIONS = 10 }; /* as the format numbers them, see exr_compression_name() */

typedef enum exr_layout {
    EXR_LINES,
    EXR_LINES_DOWN, /* the last line first */
    EXR_TILES,      /* of 16 x 16 pixels */
    EXR_MIPMAP,
    EXR_RIPMAP,
    EXR_DEEP, /* a header alone */
    EXR_LAYOUTS
} exr_layout;

/* One part of a file. What is 0 or NULL is left out of it. */
typedef struct exr_part_description {
    const char *name, *view; /* a file of several parts needs names */
    int compression;
    exr_layout layout;
    int data[4];    /* window: x, y, width, height */
    int display[4]; /* of width 0: the data window */
    /* "R:h G:f RY:h2": a name, h (half), f (float) or u (integers); 2: every second pixel both
     * ways. A ~ in a name stands for a blank. */
    const char *channels;
    int envmap;                  /* 1: by latitude and longitude, 2: a cube */
    const float *chromaticities; /* [8] */
    const float *neutral;        /* [2] */
    const char *views;           /* of all, "left right" */
    /* The value of a channel, by its place in `channels`, at a pixel of the data window. */
    float (*value)(const void *user, int channel, int x, int y);
    const void *user;
} exr_part_description;

/* Sets of channels that a picture may have. */
typedef enum exr_kind {
    EXR_KIND_RGB,
    EXR_KIND_RGBA,
    EXR_KIND_GREY,
    EXR_KIND_GREY_ALPHA,
    EXR_KIND_XYZ,
    EXR_KIND_CHROMA,
    EXR_KIND_CHROMA_ALPHA
} exr_kind;

typedef struct exr_channel_set {
    const char *channels; /* NULL past the last */
    exr_kind kind;
    int is_subsampled; /* then not in tiles, and even windows */
} exr_channel_set;

#ifdef __cplusplus
extern "C" {
#endif
extern const exr_channel_set exr_channel_sets[];
const char *exr_compression_name(int compression);
/* A file of these parts; an empty one if the library refuses to write it. */
render_bytes exr_write_parts(const exr_part_description *parts, int count);
#ifdef __cplusplus
}
#endif

#endif
