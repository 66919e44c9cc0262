/* image.h: pictures in memory and in files: linear float RGB, OpenEXR and Radiance in, OpenEXR and
 * PNG out. */
#ifndef HNBRDF_IMAGE_IMAGE_H
#define HNBRDF_IMAGE_IMAGE_H

#include "hnbrdf/hnbrdf.h"

#define RENDER_MAX_SIDE 65536
#define RENDER_MAX_PIXELS ((size_t)1 << 26)
#define RENDER_MAX_FILE ((size_t)1 << 30)
#define RENDER_MAX_LAYERS 16

/* How a picture file is read, and what it may ask for: files that claim more are refused before
 * anything is allocated for them. Zero-initialise for the defaults, and pass NULL for those; more
 * than a default is taken as the default. Memory while reading is at most the file, 32 bytes a
 * pixel (with repair 17 more for those that need it), and 16 bytes times max_pixels for one block
 * of compressed lines. */
typedef struct render_read_options {
    size_t max_bytes;   /* of the file; 0 stands for RENDER_MAX_FILE */
    size_t max_pixels;  /* of the picture; 0 stands for RENDER_MAX_PIXELS */
    hnbrdf_notes notes; /* told of what was converted or passed over */
    const char *layer;  /* of an OpenEXR file, by its name; NULL: the only one, or the main one */
    int repair;         /* pixels that are not finite become the mean of their neighbours */
} render_read_options;

/* What a picture says that it is a map of. */
typedef enum render_map {
    RENDER_MAP_UNSAID, /* anything, or all directions by latitude and longitude */
    RENDER_MAP_LATLONG,
    RENDER_MAP_CUBE /* six square faces one below the other, see cube.c */
} render_map;

/* A further RGB picture of the same size inside an image; EXR channels NAME.R, NAME.G, NAME.B. */
typedef struct render_layer {
    char name[32];
    float *rgb; /* [height][width][3] */
} render_layer;

/* Linear Rec. 709, top row first. With alpha the colour is premultiplied by it. */
typedef struct render_image {
    int width, height;
    float *rgb;   /* [height][width][3] */
    float *alpha; /* coverage in [0, 1], [height][width]; NULL: opaque */
    render_layer layers[RENDER_MAX_LAYERS];
    int layer_count;
    render_map map;
} render_image;

/* Black, opaque or (alpha = 1) with an alpha plane of 0. Each side 1 to RENDER_MAX_SIDE. */
hnbrdf_result render_image_create(int width, int height, int alpha, render_image *image,
                                  hnbrdf_error *error);
/* Adds a layer and takes rgb, which must come from malloc; on failure rgb stays the caller's. */
hnbrdf_result render_image_add_layer(render_image *image, const char *name, float *rgb,
                                     hnbrdf_error *error);
/* Frees what the image holds and zeroes it; an all-zero image is allowed. */
void render_image_free(render_image *image);

/* Zero-initialise for defaults. */
typedef struct render_write_options {
    double exposure;      /* PNG: stops, values are multiplied by 2^exposure */
    int half;             /* EXR: half floats (clamped to +-65504, rounded to nearest even) */
    const char *comments; /* EXR: the standard attribute `comments`; NULL for none */
} render_write_options;

/* By the path's extension, .exr or .png (any case). Written aside and renamed. options may be
 * NULL. */
hnbrdf_result render_image_write(const render_image *image, const char *path,
                                 const render_write_options *options, hnbrdf_error *error);
/* EXR or Radiance .hdr, recognised by content. One layer is read, with its alpha if there is
 * any. */
hnbrdf_result render_image_read(const char *path, const render_read_options *options,
                                render_image *image, hnbrdf_error *error);
/* options with its zeros settled; options may be NULL. */
render_read_options render_read_options_settle(const render_read_options *options);
/* Refuses a picture with values that are not finite: how many, and where the first one is. */
hnbrdf_result render_image_check(const render_image *image, const char *name, hnbrdf_error *error);
/* Replaces pixels that have a value that is not finite by the mean of those next to them that are
 * finite, from the rim of each hole inward, and tells a note of `name`. Where none is finite
 * nothing changes. */
hnbrdf_result render_image_repair(render_image *image, const char *name, const hnbrdf_notes *notes,
                                  hnbrdf_error *error);
/* Turns the faces of a cube map into a map by latitude and longitude of twice as many columns as
 * rows; other pictures stay as they are. */
hnbrdf_result render_image_unfold(render_image *image, const char *name, hnbrdf_error *error);

/* 0 when the program was built without OpenEXR: every EXR call then fails with a message saying
 * so. */
int render_has_exr(void);

/* ---- One function a format, on bytes in memory; `name` is used in messages ------------------- */

typedef struct render_bytes {
    unsigned char *data; /* from malloc */
    size_t size, capacity;
} render_bytes;

/* Puts size bytes at offset, growing with zeros as needed. 0, or -1 when memory is out. */
int render_bytes_put(render_bytes *bytes, size_t offset, const void *data, size_t size);

/* A whole file of at most `limit` bytes; bytes must be empty, its data is the caller's to free. */
hnbrdf_result render_file_read(const char *path, size_t limit, render_bytes *bytes,
                               hnbrdf_error *error);

/* ZIP-compressed scanlines, channels B, G, R (A) and those of the layers. */
hnbrdf_result render_exr_encode(const render_image *image, const render_write_options *options,
                                render_bytes *bytes, hnbrdf_error *error);
/* One layer of any flat part, scanlines or the largest level of tiles, half or float: R, G, B; Y
 * with RY and BY; X, Y, Z; Y alone; of any primaries, converted to Rec. 709. The picture is what
 * display window shows, black where there are no data; of a map, all of the data. Layers of
 * several names or parts are refused unless one has the plain names, and so are deep data and
 * channels of integers. DWAA and DWAB need OpenEXR's C++ library, or its C library of version
 * 3.2. */
hnbrdf_result render_exr_decode(const void *data, size_t size, const char *name,
                                const render_read_options *options, render_image *image,
                                hnbrdf_error *error);
/* Do these bytes begin a Radiance picture? */
int render_is_radiance(const void *data, size_t size);
/* RGBE or XYZE, flat or with old or new run lengths, of any orientation; pixels come out the right
 * way round. RGB is Rec. 709 unless a PRIMARIES line says other primaries, which are converted
 * and their white made white; XYZ goes to the primaries of Radiance, or by such a line. EXPOSURE
 * and COLORCORR, which say what the pixels were multiplied by, stay in them: a note tells. */
hnbrdf_result render_radiance_decode(const void *data, size_t size, const char *name,
                                     const render_read_options *options, render_image *image,
                                     hnbrdf_error *error);
/* 8 bits a channel: value * 2^exposure, clamped to [0, 1], the sRGB curve (IEC 61966-2-1), rounded.
 * NaN becomes 0. With alpha the PNG is RGBA, its colour divided by alpha as PNG asks. */
hnbrdf_result render_png_encode(const render_image *image, double exposure, render_bytes *bytes,
                                hnbrdf_error *error);

#endif
