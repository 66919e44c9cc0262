/* exr_layers.c: which channels of which part of an OpenEXR file are the picture.
 *
 * Channels of one part that share what stands before the last dot of their names form a layer.
 * Layers without a name are preferred, then there has to be a single one, or a single one of the
 * default view. */
#include "image/exr.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

/* Most channels of a part; those of more than one value a pixel and layer rarely reach 200. */
enum { MAX_CHANNELS = 1024 };

typedef enum layer_use {
    LAYER_NONE,    /* no picture */
    LAYER_ASKED,   /* one if it is asked for by name: vectors, masks */
    LAYER_PARTIAL, /* one if there is no better: not all of R, G and B, with plain names */
    LAYER_PICTURE
} layer_use;

typedef struct layer {
    int part;
    const char *part_name;            /* "": none */
    const char *prefix;               /* of its channels' names, not terminated */
    size_t length;                    /* of the prefix, 0: the channels have plain names */
    const char *view;                 /* its view, "": none */
    int is_default;                   /* of the default view, or of none */
    const char *channels[EXR_PLANES]; /* names, as the planes of an exr_picture */
    layer_use use;
    exr_colours colours;
} layer;

typedef struct layers {
    const exr_input *in;
    layer *items;
    int count;
    int deep;                 /* parts of deep data, which are passed over */
    const char *default_view; /* of a file of several parts: that of the first one that has any */
} layers;

/* ---- One layer ------------------------------------------------------------------------------- */

/* Length of what stands before the last dot, and the dot's place is there. */
static size_t prefix_of(const char *channel)
{
    const char *dot = strrchr(channel, '.');
    return dot ? (size_t)(dot - channel) : 0;
}

static int has_prefix(const char *channel, const char *prefix, size_t length)
{
    return prefix_of(channel) == length && memcmp(channel, prefix, length) == 0 &&
           (length == 0) == (strchr(channel, '.') == NULL);
}

/* The layer's channel of this name without prefix, or NULL. */
static const char *find(const exr_attr_chlist_t *list, const layer *l, const char *name)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *channel = list->entries[i].name.str;
        if (has_prefix(channel, l->prefix, l->length) &&
            strcmp(channel + l->length + (strchr(channel, '.') != NULL), name) == 0)
            return channel;
    }
    return NULL;
}

static void take(layer *l, layer_use use, exr_colours colours, const char *a, const char *b,
                 const char *c)
{
    l->use = use;
    l->colours = colours;
    l->channels[0] = a;
    l->channels[1] = b;
    l->channels[2] = c;
}

/* Decides what a layer is from the names of its channels. X, Y, Z and parts of RGB count as a
 * picture where they have plain names; in layers they are directions, places and masks. */
static void classify(const exr_attr_chlist_t *list, layer *l)
{
    const char *r = find(list, l, "R"), *g = find(list, l, "G"), *b = find(list, l, "B");
    const char *y = find(list, l, "Y"), *ry = find(list, l, "RY"), *by = find(list, l, "BY");
    const char *x = find(list, l, "X"), *z = find(list, l, "Z");
    const int plain = l->length == 0;
    l->channels[EXR_ALPHA] = find(list, l, "A");
    l->use = LAYER_NONE;
    if (r && g && b)
        take(l, LAYER_PICTURE, EXR_RGB, r, g, b);
    else if (y && ry && by)
        take(l, LAYER_PICTURE, EXR_CHROMA, y, ry, by);
    else if (x && y && z)
        take(l, plain ? LAYER_PICTURE : LAYER_ASKED, EXR_XYZ, x, y, z);
    else if (y && !ry && !by && !x && !r && !g && !b)
        take(l, LAYER_PICTURE, EXR_GREY, y, NULL, NULL);
    else if ((r || g || b) && !y && !ry && !by && !x)
        take(l, plain ? LAYER_PARTIAL : LAYER_ASKED, EXR_RGB, r, g, b);
}

/* ---- All of a file --------------------------------------------------------------------------- */

static const char *text_attribute(const exr_input *in, int part, const char *name)
{
    int32_t length;
    const char *text = NULL;
    return exr_attr_get_string(in->context, part, name, &length, &text) == EXR_ERR_SUCCESS && text
               ? text
               : "";
}

static int is_view(const layer *l, const char *view)
{
    const size_t length = strlen(view);
    return length > 0 && l->length >= length &&
           memcmp(l->prefix + l->length - length, view, length) == 0 &&
           (l->length == length || l->prefix[l->length - length - 1] == '.');
}

/* The view of a layer: that of its part, or, where one part holds several, the last word of its
 * prefix; plain names are of the default view, the first of the list. */
static void find_view(const exr_input *in, layer *l)
{
    const exr_attribute_t *views;
    l->view = text_attribute(in, l->part, "view");
    l->is_default = 1;
    if (exr_get_attribute_by_name(in->context, l->part, "multiView", &views) != EXR_ERR_SUCCESS ||
        views->type != EXR_ATTR_STRING_VECTOR)
        return;
    for (int32_t i = 0; i < views->stringvector->n_strings; i++)
        if (is_view(l, views->stringvector->strings[i].str)) {
            l->view = views->stringvector->strings[i].str;
            l->is_default = i == 0;
        }
}

static int add(layers *all, const layer *l)
{
    if ((all->count & (all->count - 1)) == 0) { /* a power of 2: the next one needs room */
        const size_t room = all->count ? 2 * (size_t)all->count : 1;
        layer *grown = realloc(all->items, room * sizeof *grown);
        if (!grown)
            return -1;
        all->items = grown;
    }
    all->items[all->count++] = *l;
    return 0;
}

static hnbrdf_result list_channels(layers *all, int part, const char *part_name)
{
    const exr_input *in = all->in;
    const exr_attr_chlist_t *list;
    exr_result_t got = exr_get_channels(in->context, part, &list);
    if (got != EXR_ERR_SUCCESS)
        return exr_library_error(in, got);
    if (list->num_channels < 1 || list->num_channels > MAX_CHANNELS)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_LIMIT, "%s: %d channels: expected 1 to %d",
                           in->name, list->num_channels, MAX_CHANNELS);
    for (int i = 0; i < list->num_channels; i++) {
        const char *channel = list->entries[i].name.str;
        layer l = {
            .part = part, .part_name = part_name, .prefix = channel, .length = prefix_of(channel)};
        int known = 0;
        for (int k = 0; k < i && !known; k++)
            known = has_prefix(list->entries[k].name.str, l.prefix, l.length);
        if (known)
            continue;
        classify(list, &l);
        find_view(in, &l);
        if (l.use != LAYER_NONE && add(all, &l))
            return hnbrdf_fail(in->error, HNBRDF_ERROR_MEMORY, "%s: no memory", in->name);
    }
    return HNBRDF_OK;
}

static hnbrdf_result list_layers(layers *all)
{
    const exr_input *in = all->in;
    int parts;
    hnbrdf_result result = HNBRDF_OK;
    exr_result_t got = exr_get_count(in->context, &parts);
    if (got != EXR_ERR_SUCCESS)
        return exr_library_error(in, got);
    for (int part = 0; part < parts && result == HNBRDF_OK; part++) {
        exr_storage_t storage;
        const char *name = NULL;
        got = exr_get_storage(in->context, part, &storage);
        if (got != EXR_ERR_SUCCESS)
            return exr_library_error(in, got);
        if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) {
            all->deep++;
            continue;
        }
        if (parts == 1 || exr_get_name(in->context, part, &name) != EXR_ERR_SUCCESS || !name)
            name = "";
        result = list_channels(all, part, name);
    }
    return result;
}

/* ---- The choice ------------------------------------------------------------------------------ */

/* What a layer is called: its prefix, or its part where it has none; where both say something
 * else, both. */
static void name_of(const layer *l, char *text, size_t size)
{
    const size_t part = strlen(l->part_name);
    if (l->length == 0)
        snprintf(text, size, "%s", l->part_name);
    else if (part == 0 || (l->length >= part && memcmp(l->prefix, l->part_name, part) == 0))
        snprintf(text, size, "%.*s", (int)l->length, l->prefix);
    else
        snprintf(text, size, "%s.%.*s", l->part_name, (int)l->length, l->prefix);
}

static int is_called(const layer *l, const char *name)
{
    char text[512];
    name_of(l, text, sizeof text);
    return strcmp(text, name) == 0 ||
           (l->length > 0 && strlen(name) == l->length && memcmp(l->prefix, name, l->length) == 0);
}

/* Keeps the layers that `fits` likes, if there are any; returns how many there are. */
static int prefer(layers *all, int (*fits)(const layers *all, const layer *l))
{
    int kept = 0;
    for (int i = 0; i < all->count; i++)
        kept += fits(all, &all->items[i]);
    if (kept == 0)
        return 0;
    kept = 0;
    for (int i = 0; i < all->count; i++)
        if (fits(all, &all->items[i]))
            all->items[kept++] = all->items[i];
    all->count = kept;
    return kept;
}

static int is_picture(const layers *all, const layer *l)
{
    (void)all;
    return l->use == LAYER_PICTURE;
}

static int is_partial(const layers *all, const layer *l)
{
    (void)all;
    return l->use == LAYER_PARTIAL;
}

static int is_plain(const layers *all, const layer *l)
{
    (void)all;
    return l->length == 0;
}

static int is_default_view(const layers *all, const layer *l)
{
    return l->is_default && (!l->view[0] || strcmp(l->view, all->default_view) == 0);
}

static void prefer_default_view(layers *all)
{
    all->default_view = "";
    for (int i = 0; i < all->count && !all->default_view[0]; i++)
        if (all->items[i].is_default)
            all->default_view = all->items[i].view;
    prefer(all, is_default_view);
}

/* Their names in quotes, as many as there is room for. */
static void name_all(const layers *all, char *text, size_t size)
{
    size_t at = 0;
    text[0] = 0;
    for (int i = 0; i < all->count; i++) {
        char name[512];
        name_of(&all->items[i], name, sizeof name);
        const int written =
            at + 24 < size ? snprintf(text + at, size - at, "%s'%s'", i ? ", " : "", name) : -1;
        if (written < 0 || (size_t)written >= size - at - 16) {
            snprintf(text + at, size - at, "%s%d more", i ? ", " : "", all->count - i);
            return;
        }
        at += (size_t)written;
    }
}

/* The names of all channels of the parts that are not deep, for the message that none will do. */
static hnbrdf_result no_picture(const exr_input *in)
{
    char text[200] = "";
    size_t at = 0;
    int parts = 0;
    exr_get_count(in->context, &parts);
    for (int part = 0; part < parts; part++) {
        const exr_attr_chlist_t *list;
        if (exr_get_channels(in->context, part, &list) != EXR_ERR_SUCCESS)
            continue;
        for (int i = 0; i < list->num_channels && at < sizeof text; i++)
            at += (size_t)snprintf(text + at, sizeof text - at, "%s%s", at ? ", " : "",
                                   list->entries[i].name.str);
    }
    if (at >= sizeof text)
        memcpy(text + sizeof text - 4, "...", 4);
    return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                       "%s: no colour picture: its channels are %s, expected R, G, B or Y, RY, BY "
                       "or X, Y, Z or Y alone",
                       in->name, text);
}

static hnbrdf_result choose_named(layers *all, const char *name)
{
    const exr_input *in = all->in;
    char names[240];
    int kept = 0;
    name_all(all, names, sizeof names);
    for (int i = 0; i < all->count; i++)
        if (is_called(&all->items[i], name))
            all->items[kept++] = all->items[i];
    if (kept == 0)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_ARGUMENT, "%s: no layer '%s': there %s %s",
                           in->name, name, all->count == 1 ? "is" : "are",
                           all->count ? names : "none");
    all->count = kept;
    return HNBRDF_OK;
}

/* Leaves one layer. */
static hnbrdf_result choose(layers *all)
{
    const exr_input *in = all->in;
    char names[240];
    if (all->count == 0 && all->deep)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: deep data, several samples a pixel: expected a flat picture",
                           in->name);
    if (in->limits.layer) {
        const hnbrdf_result result = choose_named(all, in->limits.layer);
        if (result != HNBRDF_OK)
            return result;
    } else {
        if (!prefer(all, is_picture))
            prefer(all, is_partial);
        if (all->count == 0 || all->items[0].use == LAYER_ASKED)
            return no_picture(in);
        prefer(all, is_plain);
    }
    const int before = all->count;
    prefer_default_view(all);
    if (all->count > 1) {
        name_all(all, names, sizeof names);
        return hnbrdf_fail(in->error, HNBRDF_ERROR_ARGUMENT,
                           "%s: several layers, %s: choose one with --layer", in->name, names);
    }
    if (before > 1)
        hnbrdf_note(&in->limits.notes, "%s: view '%s' taken, the first of %d", in->name,
                    all->items[0].view, before);
    return HNBRDF_OK;
}

/* ---- Its channels ---------------------------------------------------------------------------- */

static const exr_attr_chlist_entry_t *entry_of(const exr_attr_chlist_t *list, const char *channel)
{
    for (int i = 0; i < list->num_channels; i++)
        if (list->entries[i].name.str == channel)
            return &list->entries[i];
    return NULL;
}

static hnbrdf_result check_channel(const exr_input *in, const exr_attr_chlist_entry_t *entry,
                                   int may_skip, int *step)
{
    *step = entry->x_sampling;
    if (entry->pixel_type != EXR_PIXEL_HALF && entry->pixel_type != EXR_PIXEL_FLOAT)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: channel %s is of integers: expected half or float", in->name,
                           entry->name.str);
    if (entry->x_sampling == entry->y_sampling && (*step == 1 || (*step == 2 && may_skip)))
        return HNBRDF_OK;
    return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                       "%s: channel %s has values at every %d. pixel of every %d. line: expected "
                       "at every pixel%s",
                       in->name, entry->name.str, entry->x_sampling, entry->y_sampling,
                       may_skip ? ", or every second one both ways" : "");
}

static hnbrdf_result take_layer(const exr_input *in, const layer *l, exr_picture *picture)
{
    const exr_attr_chlist_t *list;
    hnbrdf_result result = HNBRDF_OK;
    exr_get_channels(in->context, l->part, &list);
    picture->part = l->part;
    picture->colours = l->colours;
    for (int k = 0; k < EXR_PLANES && result == HNBRDF_OK; k++) {
        exr_plane *plane = &picture->planes[k];
        *plane = (exr_plane){.channel = l->channels[k], .step = 1};
        if (plane->channel)
            result = check_channel(in, entry_of(list, plane->channel),
                                   l->colours == EXR_CHROMA && (k == 1 || k == 2), &plane->step);
    }
    if (result == HNBRDF_OK && picture->colours == EXR_CHROMA &&
        picture->planes[1].step != picture->planes[2].step)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: RY has %s values than BY: expected as many", in->name,
                           picture->planes[1].step < picture->planes[2].step ? "more" : "fewer");
    if (result == HNBRDF_OK && picture->colours == EXR_RGB)
        for (int k = 0; k < 3; k++)
            if (!l->channels[k])
                hnbrdf_note(&in->limits.notes, "%s: no channel %c, taken as 0", in->name, "RGB"[k]);
    return result;
}

hnbrdf_result exr_choose_layer(const exr_input *in, exr_picture *picture)
{
    layers all = {.in = in};
    hnbrdf_result result = list_layers(&all);
    if (result == HNBRDF_OK)
        result = choose(&all);
    if (result == HNBRDF_OK)
        result = take_layer(in, &all.items[0], picture);
    free(all.items);
    return result;
}
