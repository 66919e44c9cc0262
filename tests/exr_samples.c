/* exr_samples.c: writes OpenEXR files of the kinds that people have, DIRECTORY/NAME.exr, for the
 * tests of the command. */
#include "exr_writer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Y, RY, BY of a colour that changes along the columns; with less than three channels Y alone. */
static float chroma(const void *user, int channel, int x, int y)
{
    (void)user;
    return channel == 0 ? 0.5f + 0.125f * (float)(x + y) : channel == 1 ? 0.5f : -0.25f;
}

static float bright(const void *user, int channel, int x, int y)
{
    (void)user;
    return 1.0f + (float)(channel + x + 4 * y);
}

static float with_holes(const void *user, int channel, int x, int y)
{
    return x == 2 && y == 1 && channel == 0   ? NAN
           : x == 5 && y == 2 && channel == 2 ? INFINITY
                                              : bright(user, channel, x, y);
}

/* Red above, green below, blue ahead: faces in the order +x, -x, +y, -y, +z, -z. */
static float faces(const void *user, int channel, int x, int y)
{
    (void)user, (void)x;
    const int face = y / 2;
    return channel == 0 ? face == 2 : channel == 1 ? face == 3 : face == 4;
}

int main(int argc, char **argv)
{
    const struct {
        const char *name;
        exr_part_description part;
    } files[] = {
        {"chroma_half", {.data = {0, 0, 8, 4}, .channels = "Y:h RY:h2 BY:h2", .value = chroma}},
        {"chroma_float", {.data = {0, 0, 8, 4}, .channels = "Y:f RY:f2 BY:f2", .value = chroma}},
        {"xyz", {.data = {0, 0, 8, 4}, .channels = "X:h Y:h Z:h", .value = bright}},
        {"plain", {.data = {0, 0, 8, 4}, .channels = "R:f G:f B:f", .value = bright}},
        {"crop_left",
         {.data = {1, 2, 4, 2},
          .display = {0, 0, 16, 8},
          .channels = "R:f G:f B:f",
          .value = bright}},
        {"crop_right",
         {.data = {9, 2, 4, 2},
          .display = {0, 0, 16, 8},
          .channels = "R:f G:f B:f",
          .value = bright}},
        {"layer", {.data = {0, 0, 8, 4}, .channels = "a~b.R:f a~b.G:f a~b.B:f", .value = bright}},
        {"layers", {.data = {0, 0, 8, 4}, .channels = "a.R:f a.G:f a.B:f b.Y:f", .value = bright}},
        {"b44_float",
         {.compression = 6, .data = {0, 0, 8, 4}, .channels = "R:f G:f B:f", .value = bright}},
        {"b44_row",
         {.compression = 6, .data = {0, 0, 8, 1}, .channels = "R:h G:h B:h", .value = bright}},
        {"row", {.data = {0, 0, 8, 1}, .channels = "R:h G:h B:h", .value = bright}},
        {"dwaa",
         {.compression = 8, .data = {0, 0, 8, 4}, .channels = "R:h G:h B:h", .value = bright}},
        {"holes", {.data = {0, 0, 8, 4}, .channels = "R:f G:f B:f", .value = with_holes}},
        {"cube", {.data = {0, 0, 2, 12}, .channels = "R:f G:f B:f", .envmap = 2, .value = faces}},
        {"square", {.data = {0, 0, 8, 8}, .channels = "R:f G:f B:f", .value = bright}},
        {"deep",
         {.compression = 2,
          .layout = EXR_DEEP,
          .data = {0, 0, 8, 4},
          .channels = "R:h G:h B:h",
          .name = "d"}},
        {"integers", {.data = {0, 0, 8, 4}, .channels = "R:u G:u B:u", .value = bright}},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files && argc == 2; i++) {
        char path[1000];
        snprintf(path, sizeof path, "%s/%s.exr", argv[1], files[i].name);
        render_bytes bytes = exr_write_parts(&files[i].part, 1);
        FILE *file = fopen(path, "wb");
        if (!file || bytes.size == 0 || fwrite(bytes.data, 1, bytes.size, file) != bytes.size ||
            fclose(file) != 0)
            return fprintf(stderr, "%s: not written\n", path), 1;
        free(bytes.data);
    }
    return argc != 2;
}
