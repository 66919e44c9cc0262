/* exr_layers.c: lists the layers of an OpenEXR file: what each of them is, and of which view. */
#include "image/exr_layers.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

/* Most channels of a part; those of more than one value a pixel and layer rarely reach 200. */
enum { MAX_CHANNELS = 1024 };

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
static const char *find(const exr_attr_chlist_t *list, const exr_layer *l, const char *name)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *channel = list->entries[i].name.str;
        if (has_prefix(channel, l->prefix, l->length) &&
            strcmp(channel + l->length + (strchr(channel, '.') != NULL), name) == 0)
            return channel;
    }
    return NULL;
}

static void take(exr_layer *l, exr_layer_use use, exr_colours colours, const char *a, const char *b,
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
static void classify(const exr_attr_chlist_t *list, exr_layer *l)
{
    const char *r = find(list, l, "R"), *g = find(list, l, "G"), *b = find(list, l, "B");
    const char *y = find(list, l, "Y"), *ry = find(list, l, "RY"), *by = find(list, l, "BY");
    const char *x = find(list, l, "X"), *z = find(list, l, "Z");
    const int plain = l->length == 0;
    l->channels[EXR_ALPHA] = find(list, l, "A");
    l->use = EXR_LAYER_NONE;
    if (r && g && b)
        take(l, EXR_LAYER_PICTURE, EXR_RGB, r, g, b);
    else if (y && ry && by)
        take(l, EXR_LAYER_PICTURE, EXR_CHROMA, y, ry, by);
    else if (x && y && z)
        take(l, plain ? EXR_LAYER_PICTURE : EXR_LAYER_ASKED, EXR_XYZ, x, y, z);
    else if (y && !ry && !by && !x && !r && !g && !b)
        take(l, EXR_LAYER_PICTURE, EXR_GREY, y, NULL, NULL);
    else if ((r || g || b) && !y && !ry && !by && !x)
        take(l, plain ? EXR_LAYER_PARTIAL : EXR_LAYER_ASKED, EXR_RGB, r, g, b);
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

static int is_view(const exr_layer *l, const char *view)
{
    const size_t length = strlen(view);
    return length > 0 && l->length >= length &&
           memcmp(l->prefix + l->length - length, view, length) == 0 &&
           (l->length == length || l->prefix[l->length - length - 1] == '.');
}

/* The view of a layer: that of its part, or, where one part holds several, the last word of its
 * prefix; plain names are of the default view, the first of the list. */
static void find_view(const exr_input *in, exr_layer *l)
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

static int add(exr_layers *all, const exr_layer *l)
{
    if ((all->count & (all->count - 1)) == 0) { /* a power of 2: the next one needs room */
        const size_t room = all->count ? 2 * (size_t)all->count : 1;
        exr_layer *grown = realloc(all->items, room * sizeof *grown);
        if (!grown)
            return -1;
        all->items = grown;
    }
    all->items[all->count++] = *l;
    return 0;
}

static hnbrdf_result list_channels(exr_layers *all, int part, const char *part_name)
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
        exr_layer l = {
            .part = part, .part_name = part_name, .prefix = channel, .length = prefix_of(channel)};
        int known = 0;
        for (int k = 0; k < i && !known; k++)
            known = has_prefix(list->entries[k].name.str, l.prefix, l.length);
        if (known)
            continue;
        classify(list, &l);
        find_view(in, &l);
        if (l.use != EXR_LAYER_NONE && add(all, &l))
            return hnbrdf_fail(in->error, HNBRDF_ERROR_MEMORY, "%s: no memory", in->name);
    }
    return HNBRDF_OK;
}

hnbrdf_result exr_list_layers(exr_layers *all)
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
