/* generate_exr.c: OpenEXR files of one to three parts: any channels, layers and views, lines or
 * tiles with their levels, windows, colours, every compression. Blocks are stored as they are,
 * which every compression allows, or are run lengths of zeros. */
#include "generate.h"

#include <string.h>

enum { MOST_PARTS = 3, MOST_CHANNELS = 12, LEVELS_ONE = 0, LEVELS_MIP = 1, LEVELS_RIP = 2 };

/* In the order of their names, which the format asks for; 2: every second pixel both ways. */
static const char *const channel_sets[] = {
    "B G R",
    "A B G R",
    "A B G R Z id",
    "B G N.X N.Y N.Z R diffuse.B diffuse.G diffuse.R",
    "BY2 RY2 Y",
    "A BY2 RY2 Y",
    "BY RY Y",
    "X Y Z",
    "Y",
    "A Y",
    "Y Z u",
    "G",
    "G Z",
    "a.B a.G a.R",
    "a.A a.B a.G a.R b.Y",
    "a.BY2 a.RY2 a.Y",
    "left.B left.G left.R right.B right.G right.R",
    "a.left.B a.left.G a.left.R a.right.B a.right.G a.right.R",
    "Z",
    "X Y",
    "a.X a.Y a.Z",
    "BY2 RY Y",
    "a~.Y b~.Y c~.Y d~.Y",
    "p~ q~ r~ s~",
};
/* What a ~ stands for: names of more than 31 bytes, which a bit in the beginning allows. */
static const char long_name[] =
    "_of_a_name_that_says_more_of_what_it_holds_than_messages_have_room";
static const char *const part_names[MOST_PARTS] = {"a", "b", "c"};

typedef struct channel {
    char name[96];
    int step, type; /* 0 integers, 1 half, 2 float */
} channel;

typedef struct part {
    channel channels[MOST_CHANNELS];
    int channel_count;
    int x, y, width, height;
    int compression, tile, levels, deep;
    int long_names;
    int zeros;         /* its blocks hold nothing else */
    fuzz_bytes blocks; /* of all its chunks */
    size_t starts[600], count;
} part;

typedef struct writer {
    fuzz_choices *c;
    fuzz_bytes *out;
    part parts[MOST_PARTS];
    int part_count;
    uint64_t shared; /* where the choices begin that all parts have in common */
} writer;

/* ---- Attributes ------------------------------------------------------------------------------ */

static void put_text(fuzz_bytes *out, const char *text)
{
    fuzz_put(out, text, strlen(text) + 1);
}

/* One attribute of `size` bytes that the caller puts next. */
static void begin(writer *w, const char *name, const char *type, size_t size)
{
    put_text(w->out, fuzz_word(w->c, name));
    put_text(w->out, fuzz_word(w->c, type));
    fuzz_put_le(w->out, fuzz_whole(w->c, size), 4);
}

static void put_string(writer *w, const char *name, const char *text)
{
    begin(w, name, "string", strlen(text));
    fuzz_put_text(w->out, text);
}

static void put_byte(writer *w, const char *name, const char *type, uint64_t value)
{
    begin(w, name, type, 1);
    fuzz_put_le(w->out, fuzz_whole(w->c, value), 1);
}

static void put_floats(writer *w, const char *name, const char *type, int count,
                       const double *values)
{
    begin(w, name, type, 4 * (size_t)count);
    for (int i = 0; i < count; i++)
        fuzz_put_float(w->out, fuzz_real(w->c, values[i]));
}

static void put_box(writer *w, const char *name, const int window[4])
{
    begin(w, name, "box2i", 16);
    fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)(int64_t)window[0]), 4);
    fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)(int64_t)window[1]), 4);
    fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)(int64_t)(window[0] + window[2] - 1)), 4);
    fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)(int64_t)(window[1] + window[3] - 1)), 4);
}

static void put_channels(writer *w, part *p)
{
    const int more = fuzz_odd(w->c) ? fuzz_between(w->c, 1000, 1100) : 0;
    size_t size = 1 + (size_t)more * (6 + 16);
    for (int i = 0; i < p->channel_count; i++)
        size += strlen(p->channels[i].name) + 1 + 16;
    begin(w, "channels", "chlist", size);
    for (int i = 0; i < p->channel_count; i++) {
        const channel *c = &p->channels[i];
        put_text(w->out, fuzz_word(w->c, c->name));
        fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)c->type), 4);
        fuzz_put_le(w->out, 0, 4); /* linear, reserved */
        fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)c->step), 4);
        fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)c->step), 4);
    }
    for (int i = 0; i < more; i++) {
        fuzz_printf(w->out, "z%04d", i);
        fuzz_put_le(w->out, 0, 1);
        fuzz_put_le(w->out, 1, 8);
        fuzz_put_le(w->out, (uint64_t)1 << 32 | 1, 8);
    }
    fuzz_put_le(w->out, 0, 1);
}

static void put_views(writer *w)
{
    static const char *const views[2] = {"right", "left"};
    begin(w, "multiView", "stringvector", 4 + 5 + 4 + 4);
    for (int i = 0; i < 2; i++) {
        fuzz_put_le(w->out, fuzz_whole(w->c, strlen(views[i])), 4);
        fuzz_put_text(w->out, views[i]);
    }
}

static void put_colours(writer *w)
{
    static const double spaces[4][8] = {{.64, .33, .3, .6, .15, .06, .3127, .329},
                                        {.708, .292, .17, .797, .131, .046, .3127, .329},
                                        {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3},
                                        {.1, .2, .2, .3, .3, .4, .4, .5}}; /* on a line */
    if (fuzz_below(w->c, 2))
        put_floats(w, "chromaticities", "chromaticities", 8, spaces[fuzz_below(w->c, 4)]);
    if (fuzz_below(w->c, 4) == 0)
        put_floats(w, "adoptedNeutral", "v2f", 2, (const double[2]){.32168, .33767});
}

static void put_display(writer *w, const part *p)
{
    int window[4] = {p->x, p->y, p->width, p->height};
    if (fuzz_below(w->c, 2))
        for (int i = 0; i < 4; i++)
            window[i] += fuzz_between(w->c, i < 2 ? -6 : 1 - window[i], 6);
    if (fuzz_below(w->c, 32) == 0)
        window[0] += 1000;
    put_box(w, "displayWindow", window);
}

/* Display window and colours, which have to be the same in all parts. */
static void put_shared(writer *w)
{
    const uint64_t own = w->c->state;
    w->c->state = w->shared;
    put_display(w, &w->parts[0]);
    put_colours(w);
    w->c->state = own;
}

static void put_header(writer *w, int index)
{
    part *p = &w->parts[index];
    const char *kind = p->deep ? "deepscanline" : p->tile ? "tiledimage" : "scanlineimage";
    const int cube = fuzz_below(w->c, 8) == 0;
    put_channels(w, p);
    put_byte(w, "compression", "compression", (uint64_t)p->compression);
    const int far = fuzz_odd(w->c) ? 60000 : 0; /* more pixels than may be */
    put_box(w, "dataWindow", (const int[4]){p->x, p->y, p->width + far, p->height});
    if (cube || fuzz_below(w->c, 16) == 0)
        put_byte(w, "envmap", "envmap", (uint64_t)cube);
    put_byte(w, "lineOrder", "lineOrder", fuzz_below(w->c, 2));
    put_floats(w, "pixelAspectRatio", "float", 1, (const double[1]){1});
    put_floats(w, "screenWindowCenter", "v2f", 2, (const double[2]){0, 0});
    put_floats(w, "screenWindowWidth", "float", 1, (const double[1]){1});
    put_shared(w);
    if (fuzz_below(w->c, 2))
        put_views(w);
    if (p->tile) {
        begin(w, "tiles", "tiledesc", 9);
        fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)p->tile), 4);
        fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)p->tile), 4);
        fuzz_put_le(w->out, fuzz_whole(w->c, (uint64_t)p->levels), 1);
    }
    if (w->part_count > 1 || p->deep) {
        put_string(w, "name", part_names[index]);
        put_string(w, "type", kind);
        begin(w, "chunkCount", "int", 4);
        fuzz_put_le(w->out, fuzz_whole(w->c, p->count), 4);
        if (p->deep) {
            begin(w, "version", "int", 4);
            fuzz_put_le(w->out, fuzz_whole(w->c, 1), 4);
        }
        if (fuzz_below(w->c, 2))
            put_string(w, "view", index ? "left" : "right");
    }
    fuzz_put_le(w->out, 0, 1);
}

/* ---- Blocks ---------------------------------------------------------------------------------- */

/* One value; any bits now and then, else a small number. */
static void put_value(writer *w, part *p, int type, int odd)
{
    static const uint16_t halves[] = {0,      0x3c00, 0x4000, 0x3800, 0x4200,
                                      0x0001, 0x7bff, 0xbc00, 0x2e66};
    static const uint16_t strange[] = {0x7c00, 0xfc00, 0x7e00, 0x7c01};
    if (type == 1)
        fuzz_put_le(&p->blocks,
                    p->zeros ? 0
                    : odd    ? strange[fuzz_below(w->c, 4)]
                             : halves[fuzz_below(w->c, sizeof halves / sizeof halves[0])],
                    2);
    else if (type == 2)
        fuzz_put_float(&p->blocks, p->zeros ? 0.0
                                   : odd    ? fuzz_hostile(w->c, 1.0)
                                            : fuzz_real_between(w->c, -0.5, 4.0));
    else
        fuzz_put_le(&p->blocks, p->zeros ? 0 : fuzz_below(w->c, 1000), 4);
}

/* Run lengths of `size` zeros: the first byte is itself, the others the difference 0, as 128. */
static void put_runs(part *p, size_t size)
{
    fuzz_put(&p->blocks, "\0", 2);
    for (size_t left = size - 1; left > 0;) {
        const size_t run = left < 128 ? left : 128;
        fuzz_put_le(&p->blocks, run - 1, 1);
        fuzz_put_le(&p->blocks, 128, 1);
        left -= run;
    }
}

static void set_le(unsigned char *at, uint64_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

/* The lines of a block whose corner is (x, y), after a place for their size. */
static void put_pixels(writer *w, part *p, int y, int width, int height)
{
    const size_t at = p->blocks.size;
    const int odd = fuzz_odd(w->c) || fuzz_below(w->c, 64) == 0;
    const int odd_line = fuzz_between(w->c, 0, height - 1);
    fuzz_put_le(&p->blocks, 0, 4);
    for (int line = 0; line < height; line++)
        for (int i = 0; i < p->channel_count; i++) {
            const channel *c = &p->channels[i];
            const int is_there = (y + line) % c->step == 0;
            for (int x = 0; is_there && x < width / c->step; x++)
                put_value(w, p, c->type, odd && line == odd_line && x == 0);
        }
    const size_t size = p->blocks.size - at - 4;
    if (p->zeros && p->compression == 1 && size > 8) {
        p->blocks.size = at + 4;
        put_runs(p, size);
    }
    set_le(p->blocks.data + at, fuzz_whole(w->c, p->blocks.size - at - 4));
}

static void begin_block(writer *w, part *p, int index)
{
    p->starts[p->count++] = p->blocks.size;
    if (w->part_count > 1)
        fuzz_put_le(&p->blocks, fuzz_whole(w->c, (uint64_t)index), 4);
}

static void put_tiles(writer *w, part *p, int index, int u, int v)
{
    const int width = p->width >> u > 0 ? p->width >> u : 1;
    const int height = p->height >> v > 0 ? p->height >> v : 1;
    for (int y = 0; y < height; y += p->tile)
        for (int x = 0; x < width; x += p->tile) {
            const uint64_t where[4] = {(uint64_t)(x / p->tile), (uint64_t)(y / p->tile),
                                       (uint64_t)u, (uint64_t)v};
            begin_block(w, p, index);
            for (int i = 0; i < 4; i++)
                fuzz_put_le(&p->blocks, fuzz_whole(w->c, where[i]), 4);
            put_pixels(w, p, p->y + y, width - x < p->tile ? width - x : p->tile,
                       height - y < p->tile ? height - y : p->tile);
        }
}

static int levels_of(int size)
{
    int levels = 1;
    for (; size > 1; size /= 2)
        levels++;
    return levels;
}

static void put_levels(writer *w, part *p, int index)
{
    const int columns = levels_of(p->width), rows = levels_of(p->height);
    const int most = columns > rows ? columns : rows;
    if (p->levels == LEVELS_RIP) {
        for (int v = 0; v < rows; v++)
            for (int u = 0; u < columns; u++)
                put_tiles(w, p, index, u, v);
        return;
    }
    for (int level = 0; level < (p->levels == LEVELS_MIP ? most : 1); level++)
        put_tiles(w, p, index, level, level);
}

static void put_lines(writer *w, part *p, int index)
{
    static const int lines[10] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    for (int y = 0; y < p->height; y += lines[p->compression]) {
        const int left = p->height - y, most = lines[p->compression];
        begin_block(w, p, index);
        fuzz_put_le(&p->blocks, fuzz_whole(w->c, (uint64_t)(int64_t)(p->y + y)), 4);
        put_pixels(w, p, p->y + y, p->width, left < most ? left : most);
    }
}

/* ---- Files ----------------------------------------------------------------------------------- */

static void set_name(part *p, channel *c, const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (text[i] == '~') {
            strcat(c->name, long_name);
            p->long_names = 1;
        } else {
            strncat(c->name, text + i, 1);
        }
}

/* Reads one of the sets; returns whether any channel is subsampled. */
static int choose_channels(writer *w, part *p)
{
    const char *text = channel_sets[fuzz_below(w->c, sizeof channel_sets / sizeof *channel_sets)];
    const int type = fuzz_between(w->c, 1, 3); /* 3: mixed */
    int is_subsampled = 0;
    while (*text) {
        channel *c = &p->channels[p->channel_count++];
        size_t length = strcspn(text, " ");
        c->step = text[length - 1] == '2' ? 2 : 1;
        is_subsampled |= c->step == 2;
        set_name(p, c, text, length - (size_t)(c->step - 1));
        c->type = strncmp(text, "id", 2) == 0 ? 0 : type < 3 ? type : fuzz_between(w->c, 1, 2);
        text += length + (text[length] == ' ');
    }
    return is_subsampled;
}

static void choose_part(writer *w, part *p)
{
    const int is_subsampled = choose_channels(w, p), step = is_subsampled ? 2 : 1;
    p->x = step * fuzz_between(w->c, -4, 4);
    p->y = step * fuzz_between(w->c, -4, 4);
    p->width = step * fuzz_between(w->c, 1, 20 / step);
    p->height = step * fuzz_between(w->c, 1, 20 / step);
    if (fuzz_odd(w->c))
        *(fuzz_below(w->c, 2) ? &p->width : &p->height) += 1;
    if (fuzz_below(w->c, 8) == 0) /* faces of a cube, perhaps */
        p->height = 6 * (p->width = step * fuzz_between(w->c, 1, 3));
    p->deep = fuzz_below(w->c, 32) == 0;
    p->compression = fuzz_between(w->c, 0, p->deep ? 2 : 9);
    p->zeros = fuzz_below(w->c, 4) == 0;
    if (!is_subsampled && !p->deep && fuzz_below(w->c, 2)) {
        p->tile = fuzz_between(w->c, 4, 16);
        p->levels = fuzz_between(w->c, LEVELS_ONE, LEVELS_RIP);
    }
}

static void put_table(writer *w, const part *p, uint64_t first)
{
    for (size_t i = 0; i < p->count; i++)
        fuzz_put_le(w->out, fuzz_whole(w->c, first + p->starts[i]), 8);
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    static writer w; /* large */
    memset(&w, 0, sizeof w);
    w.c = c;
    w.out = out;
    w.part_count = fuzz_below(c, 3) ? 1 : fuzz_between(c, 2, MOST_PARTS);
    int is_tiled = 0, is_deep = 0, long_names = 0;
    for (int i = 0; i < w.part_count; i++) {
        part *p = &w.parts[i];
        choose_part(&w, p);
        if (p->tile)
            put_levels(&w, p, i);
        else if (!p->deep)
            put_lines(&w, p, i);
        is_tiled |= p->tile != 0;
        is_deep |= p->deep;
        long_names |= p->long_names;
    }
    const int many = w.part_count > 1;
    w.shared = c->state ^ 0x5555; /* other choices than those that follow */
    fuzz_put_le(out, fuzz_whole(c, 20000630), 4);
    fuzz_put_le(out, fuzz_whole(c, 2), 1);
    fuzz_put_le(out,
                fuzz_whole(c, (uint64_t)((is_tiled && !many ? 2 : 0) | (long_names ? 4 : 0) |
                                         (is_deep ? 8 : 0) | (many ? 16 : 0))),
                1);
    fuzz_put_le(out, 0, 2);
    uint64_t tables = 0;
    for (int i = 0; i < w.part_count; i++) {
        put_header(&w, i);
        tables += 8 * w.parts[i].count;
    }
    if (many)
        fuzz_put_le(out, 0, 1);
    uint64_t first = out->size + tables;
    for (int i = 0; i < w.part_count; i++) {
        put_table(&w, &w.parts[i], first);
        first += w.parts[i].blocks.size;
    }
    for (int i = 0; i < w.part_count; i++) {
        fuzz_put(out, w.parts[i].blocks.data, w.parts[i].blocks.size);
        fuzz_free(&w.parts[i].blocks);
    }
}

FUZZ_GENERATOR(generate)
