/* exr_choose.c: which layer of an OpenEXR file is the picture: the one that was asked for, else the
 * one with plain names, else the only one, or the only one of the default view. */
#include "image/exr_layers.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

/* ---- The choice ------------------------------------------------------------------------------ */

/* What a layer is called: its prefix, or its part where it has none; where both say something
 * else, both. */
static void name_of(const exr_layer *l, char *text, size_t size)
{
    const size_t part = strlen(l->part_name);
    if (l->length == 0)
        snprintf(text, size, "%s", l->part_name);
    else if (part == 0 || (l->length >= part && memcmp(l->prefix, l->part_name, part) == 0))
        snprintf(text, size, "%.*s", (int)l->length, l->prefix);
    else
        snprintf(text, size, "%s.%.*s", l->part_name, (int)l->length, l->prefix);
}

static int is_called(const exr_layer *l, const char *name)
{
    char text[512];
    name_of(l, text, sizeof text);
    return strcmp(text, name) == 0 ||
           (l->length > 0 && strlen(name) == l->length && memcmp(l->prefix, name, l->length) == 0);
}

/* Keeps the layers that `fits` likes, if there are any; returns how many there are. */
static int prefer(exr_layers *all, int (*fits)(const exr_layers *all, const exr_layer *l))
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

static int is_picture(const exr_layers *all, const exr_layer *l)
{
    (void)all;
    return l->use == EXR_LAYER_PICTURE;
}

static int is_partial(const exr_layers *all, const exr_layer *l)
{
    (void)all;
    return l->use == EXR_LAYER_PARTIAL;
}

static int is_plain(const exr_layers *all, const exr_layer *l)
{
    (void)all;
    return l->length == 0;
}

static int is_default_view(const exr_layers *all, const exr_layer *l)
{
    return l->is_default && (!l->view[0] || strcmp(l->view, all->default_view) == 0);
}

static void prefer_default_view(exr_layers *all)
{
    all->default_view = "";
    for (int i = 0; i < all->count && !all->default_view[0]; i++)
        if (all->items[i].is_default)
            all->default_view = all->items[i].view;
    prefer(all, is_default_view);
}

/* Their names in quotes, as many as there is room for. */
static void name_all(const exr_layers *all, char *text, size_t size)
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

static hnbrdf_result choose_named(exr_layers *all, const char *name)
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
static hnbrdf_result choose(exr_layers *all)
{
    const exr_input *in = all->in;
    char names[240];
    if (all->count == 0 && all->deep)
        return hnbrdf_fail(in->error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: deep data, several samples a pixel: expected a flat picture",
                           in->name);
    if (in->options.layer) {
        const hnbrdf_result result = choose_named(all, in->options.layer);
        if (result != HNBRDF_OK)
            return result;
    } else {
        if (!prefer(all, is_picture))
            prefer(all, is_partial);
        if (all->count == 0 || all->items[0].use == EXR_LAYER_ASKED)
            return no_picture(in);
        prefer(all, is_plain);
    }
    const int before = all->count;
    prefer_default_view(all);
    if (all->count > 1) {
        name_all(all, names, sizeof names);
        return hnbrdf_fail(
            in->error, HNBRDF_ERROR_ARGUMENT,
            "%s: several layers, %s: choose one: --layer NAME, or layer NAME in a scene", in->name,
            names);
    }
    if (before > 1)
        hnbrdf_note(&in->options.notes, "%s: view '%s' taken, the first of %d", in->name,
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

static hnbrdf_result take_layer(const exr_input *in, const exr_layer *l, exr_picture *picture)
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
                hnbrdf_note(&in->options.notes, "%s: no channel %c, taken as 0", in->name,
                            "RGB"[k]);
    return result;
}

hnbrdf_result exr_choose_layer(const exr_input *in, exr_picture *picture)
{
    exr_layers all = {.in = in};
    hnbrdf_result result = exr_list_layers(&all);
    if (result == HNBRDF_OK)
        result = choose(&all);
    if (result == HNBRDF_OK)
        result = take_layer(in, &all.items[0], picture);
    free(all.items);
    return result;
}
