/* exr_layers.h: the layers of an OpenEXR file. Channels of one part that share what stands before
 * the last dot of their names form one. Private to the room. */
#ifndef HNBRDF_IMAGE_EXR_LAYERS_H
#define HNBRDF_IMAGE_EXR_LAYERS_H

#include "image/exr.h"

typedef enum exr_layer_use {
    EXR_LAYER_NONE,    /* no picture */
    EXR_LAYER_ASKED,   /* one if it is asked for by name: vectors, masks */
    EXR_LAYER_PARTIAL, /* one if there is no better: not all of R, G and B, with plain names */
    EXR_LAYER_PICTURE
} exr_layer_use;

typedef struct exr_layer {
    int part;
    const char *part_name;            /* "": none */
    const char *prefix;               /* of its channels' names, not terminated */
    size_t length;                    /* of the prefix, 0: the channels have plain names */
    const char *view;                 /* its view, "": none */
    int is_default;                   /* of the default view, or of none */
    const char *channels[EXR_PLANES]; /* names, as the planes of an exr_picture */
    exr_layer_use use;
    exr_colours colours;
} exr_layer;

typedef struct exr_layers {
    const exr_input *in;
    exr_layer *items;
    int count;
    int deep;                 /* parts of deep data, which are passed over */
    const char *default_view; /* of a file of several parts: that of the first one that has any */
} exr_layers;

/* All layers of the parts that are not deep which may be a picture; all->in is set, the rest 0.
 * all->items is to be freed, after a failure too. */
hnbrdf_result exr_list_layers(exr_layers *all);

#endif
