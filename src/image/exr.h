/* exr.h: what the files of the OpenEXR reader and writer share. Private to the room.
 *
 *   exr_memory.c   files in memory, messages of the library
 *   exr_write.c    writing
 *   exr_layers.c   which channels of which part form a layer; exr_choose.c: which is the picture
 *   exr_planes.c   their values, by the C library; exr_planes_cxx.cc: by the C++ library
 *   exr_colour.c   rows of linear Rec. 709 from them
 *   exr_read.c     all of it in order; windows */
#ifndef HNBRDF_IMAGE_EXR_H
#define HNBRDF_IMAGE_EXR_H

#include "image/image.h"

#include <openexr.h>

/* What the library's callbacks see: the bytes, and where its own message goes. */
typedef struct exr_memory {
    const unsigned char *data; /* reading */
    size_t size;
    render_bytes *bytes; /* writing */
    int out_of_memory;
    char message[160];
} exr_memory;

/* How to open a file in memory. Messages go to it until exr_memory_done(). */
exr_context_initializer_t exr_memory_start(exr_memory *memory);
void exr_memory_done(void);

/* A file that is being read. */
typedef struct exr_input {
    exr_context_t context;
    exr_memory *memory;
    const char *name; /* for messages */
    render_read_options options;
    hnbrdf_error *error;
} exr_input;

/* What the library says, as an error. */
hnbrdf_result exr_library_error(const exr_input *in, exr_result_t result);

/* A channel of the picture: one float for each of its samples. */
typedef struct exr_plane {
    const char *channel; /* its name in the file, which the context keeps; NULL: there is none */
    int step;            /* samples at every pixel (1), or at every second one both ways (2) */
    int width, height;   /* in samples */
    float *values;       /* [height][width]; NULL: all 0 */
} exr_plane;

typedef enum exr_colours {
    EXR_RGB,    /* planes: R, G, B; one that is missing is 0 */
    EXR_XYZ,    /* X, Y, Z */
    EXR_CHROMA, /* Y, RY, BY */
    EXR_GREY    /* Y */
} exr_colours;

enum { EXR_ALPHA = 3, EXR_PLANES = 4 };

/* What is read of a file. */
typedef struct exr_picture {
    int part;
    exr_colours colours;
    exr_plane planes[EXR_PLANES]; /* three of colour, then alpha */
    exr_attr_box2i_t window;      /* of the data */
    exr_attr_box2i_t display;
    int width, height; /* of that window */
    exr_storage_t storage;
    exr_compression_t compression;
} exr_picture;

/* exr_choose.c: finds part, channels and colours; messages name all there are. */
hnbrdf_result exr_choose_layer(const exr_input *in, exr_picture *picture);

/* exr_planes.c: fills the planes; on failure exr_free_planes() is still due. */
hnbrdf_result exr_read_planes(const exr_input *in, exr_picture *picture);
void exr_free_planes(exr_picture *picture);

/* exr_planes_cxx.cc, where that is built: 0, or EXR_CXX_... and a message of `room` bytes. */
enum { EXR_CXX_REFUSED = 1, EXR_CXX_MEMORY = 2 };
#ifdef __cplusplus
extern "C"
#endif
    int
    exr_read_planes_cxx(const void *data, size_t size, const exr_picture *picture, char *message,
                        size_t room);

/* exr_colour.c */
typedef struct exr_colour {
    const exr_picture *picture;
    int converts;       /* by matrix */
    float matrix[3][3]; /* to linear Rec. 709 */
    float weights[3];   /* of R, G and B in Y */
    float *chroma;      /* RY and BY [lines][width][2] */
    float *rows;        /* the last three rows [3][width][3], and which ones they are */
    int row[3];
} exr_colour;

/* Reads what the file says of its colours; tells a note if they are converted. */
hnbrdf_result exr_colour_open(const exr_input *in, const exr_picture *picture, exr_colour *colour);
/* A row of the data window, counted from its top: [width][3]. */
void exr_colour_row(exr_colour *colour, int y, float *rgb);
void exr_colour_close(exr_colour *colour);

#endif
