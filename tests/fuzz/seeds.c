/* seeds.c: writes the seed corpora of the fuzz targets, DIRECTORY/TARGET/NAME: small files of
 * each kind that are read without a complaint, made by the library's own writers where it has
 * one. */
#include "fuzz.h"

#include "measured_support.h"
#include "nbrdf_support.h"
#include "exr_writer.h"

#include <sys/stat.h>

static const char *directory, *target;

/* Opens DIRECTORY/target/name for writing. */
static FILE *create(const char *name)
{
    char path[4096];
    FUZZ_CHECK((size_t)snprintf(path, sizeof path, "%s/%s", directory, target) < sizeof path);
    mkdir(path, 0777);
    FUZZ_CHECK((size_t)snprintf(path, sizeof path, "%s/%s/%s", directory, target, name) <
               sizeof path);
    FILE *file = fopen(path, "wb");
    FUZZ_CHECK(file != NULL);
    return file;
}

static void put(const char *name, const void *data, size_t size)
{
    FILE *file = create(name);
    FUZZ_CHECK(size == 0 || fwrite(data, 1, size, file) == size);
    FUZZ_CHECK(fclose(file) == 0);
}

static void put_text(const char *name, const char *text)
{
    put(name, text, strlen(text));
}

/* ---- Models ---------------------------------------------------------------------------------- */

static int write_stream(void *user, const void *data, size_t size)
{
    return fwrite(data, 1, size, user) != size;
}

static void put_model(const char *name, hnbrdf_kind kind, hnbrdf_encoding encoding, int layers)
{
    static float numbers[256];
    static const char *const names[2] = {"plain", "with \"quotes\" and \xc3\xa9"};
    hnbrdf_material materials[2];
    hnbrdf_model_desc desc = {.kind = kind,
                              .encoding = encoding,
                              .material_count = 2,
                              .materials = materials,
                              .names = names};
    hnbrdf_model *model = NULL;
    for (int i = 0; i < 256; i++)
        numbers[i] = (float)(i % 7 - 3) / 8.0f;
    hnbrdf_material_init(&materials[0]);
    materials[1] = materials[0];
    materials[1].alpha[1] = 0.25f;
    materials[1].rotation = 0.5f;
    if (kind != HNBRDF_KIND_GGX) {
        desc.hidden = 4;
        desc.layers = layers;
        desc.latent = 2;
        desc.scale = 1.5f;
        desc.floor = 0.003f;
        materials[1].latent[0] = 1.0f;
        materials[1].energy = (hnbrdf_energy){0.5f, 4.0f};
        materials[1].fitted = (hnbrdf_fitted){{0.25f}, {2.0f, 2.0f, 2.0f}, {0.5f, 0.5f}};
        for (int k = 0; k <= layers; k++)
            desc.weights[k] = desc.biases[k] = numbers + k;
    }
    FUZZ_CHECK(hnbrdf_model_create(&desc, NULL, &model, NULL) == HNBRDF_OK);
    FILE *file = create(name);
    FUZZ_CHECK(hnbrdf_model_write(model, write_stream, file, NULL) == HNBRDF_OK);
    FUZZ_CHECK(fclose(file) == 0);
    hnbrdf_model_free(model);
}

static void write_models(void)
{
    target = "safetensors";
    put_model("hybrid", HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES, 2);
    put_model("neural", HNBRDF_KIND_NEURAL, HNBRDF_ENCODING_DIRECTIONS, 1);
    put_model("ggx", HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0);
}

static size_t read_file(const char *path, char *text, size_t room)
{
    FILE *file = fopen(path, "rb");
    FUZZ_CHECK(file != NULL);
    const size_t size = fread(text, 1, room, file);
    FUZZ_CHECK(size > 0 && size < room);
    fclose(file);
    return size;
}

/* The samples of the import test, alone and both in one. */
static void write_shaders(void)
{
    static char text[1 << 16];
    target = "brdf";
    const size_t first = read_file(HNBRDF_TEST_DATA "/sample_plain.brdf", text, sizeof text / 2);
    put("plain", text, first);
    const size_t second =
        read_file(HNBRDF_TEST_DATA "/sample_brushed.brdf", text + first + 1, sizeof text / 2);
    put("brushed", text + first + 1, second);
    text[first] = '\0';
    put("both", text, first + 1 + second);
    char *output = strstr(text, "neural_output");
    FUZZ_CHECK(output != NULL);
    for (; output; output = strstr(output, "neural_output"))
        *output = 'x';
    put("no_output", text, first);
    put("picture", "\211PNG\r\n\032\n\0\0\0\rIHDR", 16);
}

/* ---- Measurements ---------------------------------------------------------------------------- */

static void put_bytes(const char *name, test_bytes file)
{
    put(name, file.data, file.size);
    free(file.data);
}

static void write_measured(void)
{
    static const unsigned char merl[12] = {90, 0, 0, 0, 90, 0, 0, 0, 180, 0, 0, 0};
    unsigned char patch[12 + 1 + 24] = {0};
    target = "rgl";
    put_bytes("isotropic", test_rgl(TEST_ISOTROPIC));
    put_bytes("quarter", test_rgl(TEST_QUARTER));
    put_bytes("spectral", test_rgl_spectral(0));
    put_bytes("both", test_rgl_spectral(1));
    target = "merl";
    put("header", merl, sizeof merl);
    memcpy(patch, merl, sizeof merl);
    patch[12] = 1;
    put_double(patch + 17, 0.5);
    put_le(patch + 25, 1000000, 4);
    put_double(patch + 29, -1.0);
    put("patched", patch, sizeof patch);
    patch[12] = 32; /* the halves of the full circle differ */
    put_le(patch + 13, 1, 4);
    put("circle", patch, sizeof patch);
    patch[12] = 32 | 16;
    put("circle_short", patch, sizeof patch);
    put_double(patch + 17, 0.1); /* they agree */
    put_double(patch + 29, 0.1);
    patch[12] = 32 | 8;
    put("circle_long", patch, sizeof patch);
    target = "utia";
    memset(patch, 0, sizeof patch);
    put_float(patch + 1, 1.0f);
    put_double(patch + 9, 0.5);
    put("djb", patch, 5 + 24);
    patch[0] = 2 | 4;
    put("srgb", patch, 5 + 24);
}

/* As fuzz_nbrdf.c has it. */
static void put_network(const char *name, size_t first, size_t second, const char *type,
                        int version)
{
    test_network network;
    test_network_make(&network, first, second, 1);
    FILE *file = create(name);
    for (int k = 0; k < TEST_PARTS; k++) {
        unsigned char length[2];
        test_bytes part = test_npy(&network, k, type, k == 2, version);
        put_le(length, part.size, 2);
        FUZZ_CHECK(fwrite(length, 1, 2, file) == 2);
        FUZZ_CHECK(fwrite(part.data, 1, part.size, file) == part.size);
        free(part.data);
    }
    FUZZ_CHECK(fclose(file) == 0);
}

static void write_networks(void)
{
    target = "nbrdf";
    put_network("usual", 21, 21, "<f4", 1);
    put_network("small", 2, 1, ">f8", 2);
}

/* ---- Pictures -------------------------------------------------------------------------------- */

/* The file, and as one of every other compression: a block that does not get smaller is stored as
 * it is, whatever the compression. */
static void put_compressions(const char *name, render_bytes *file)
{
    static const char attribute[] =
        "compression\0compression\0\1\0\0"; /* and the NUL is the fourth byte */
    size_t at = 0;
    while (memcmp(file->data + at, attribute, sizeof attribute) != 0)
        FUZZ_CHECK(++at + sizeof attribute < file->size);
    for (int compression = 0; compression < 10; compression++) {
        char title[64];
        snprintf(title, sizeof title, "%s_%d", name, compression);
        file->data[at + sizeof attribute] = (unsigned char)compression;
        put(title, file->data, file->size);
    }
}

static void put_exr(const char *name, int width, int height, int alpha, int half)
{
    render_image image;
    render_bytes bytes = {0};
    const render_write_options options = {.half = half};
    FUZZ_CHECK(render_image_create(width, height, alpha, &image, NULL) == HNBRDF_OK);
    for (int i = 0; i < 3 * width * height; i++)
        image.rgb[i] = (float)(i % 11) / 4.0f;
    if (render_exr_encode(&image, &options, &bytes, NULL) == HNBRDF_OK)
        put_compressions(name, &bytes);
    else
        put(name, "\x76\x2f\x31\x01", 4); /* built without OpenEXR */
    free(bytes.data);
    render_image_free(&image);
}

#if defined(HNBRDF_WITH_OPENEXR_CXX)
static float picture_value(const void *user, int channel, int x, int y)
{
    (void)user;
    return (float)((channel + 3 * x + 5 * y) % 11) / 4.0f;
}

/* Every compression with every set of channels, in lines, tiles and with levels, each in one of the
 * windows. */
static void put_exr_kinds(void)
{
    static const struct {
        int data[4], display[4];
    } windows[] = {{{0, 0, 6, 4}, {0, 0, 6, 4}},
                   {{2, 4, 6, 4}, {0, 0, 9, 9}},
                   {{-4, -2, 6, 4}, {0, 0, 5, 5}},
                   {{-2, -2, 18, 4}, {1, 0, 3, 1}}};
    static const exr_layout layouts[] = {EXR_LINES, EXR_TILES, EXR_MIPMAP, EXR_LINES_DOWN};
    int window = 0;
    for (int compression = 0; compression < EXR_COMPRESSIONS; compression++)
        for (const exr_channel_set *set = exr_channel_sets; set->channels; set++)
            for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
                exr_part_description part = {.compression = compression,
                                             .layout = layouts[i],
                                             .channels = set->channels,
                                             .value = picture_value};
                if (set->is_subsampled && part.layout != EXR_LINES && part.layout != EXR_LINES_DOWN)
                    continue;
                memcpy(part.data, windows[window % 4].data, sizeof part.data);
                memcpy(part.display, windows[window % 4].display, sizeof part.display);
                window++;
                char name[64];
                snprintf(name, sizeof name, "%s_%d_%d", exr_compression_name(compression),
                         (int)(set - exr_channel_sets), (int)i);
                render_bytes bytes = exr_write_parts(&part, 1);
                FUZZ_CHECK(bytes.size > 0);
                put(name, bytes.data, bytes.size);
                free(bytes.data);
            }
}
#endif

static void write_pictures(void)
{
    static const char flat[] =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 1 +X 2\n\x80\x80\x80\x81\x40\x20\x10\x82";
    static const char runs[] =
        "#?RGBE\n# a comment\nEXPOSURE=1\n\n-Y 2 +X 8\n"
        "\x02\x02\x00\x08\x88\x40\x88\x50\x88\x60\x88\x81"
        "\x02\x02\x00\x08\x04\x01\x02\x03\x04\x84\x07\x88\x50\x88\x60\x88\x81";
    target = "exr";
    put_exr("half", 4, 2, 0, 1);
    put_exr("float_alpha", 3, 18, 1, 0);
    put_exr("line", 5, 1, 0, 0);
#if defined(HNBRDF_WITH_OPENEXR_CXX)
    put_exr_kinds();
#endif
    target = "radiance";
    put("flat", flat, sizeof flat - 1);
    put("runs", runs, sizeof runs - 1);
}

/* ---- The rest -------------------------------------------------------------------------------- */

static void write_pairs(void)
{
    target = "csv";
    put_text("builtin", " 0,0,1,0.6,0,0.8\r\n0.6,0,0.8,0,0,1\n");
    put_text(
        "header",
        " \xef\xbb\xbfwo_z,\"wo_y\",wo_x, wi_z ,wi_y,wi_x,note\n1,0,0,1,0,0,\"a \"\"b\"\"\"\n\n");
    put_text("material", "\1wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,material\n0,0,1,0,0,1,a\n0,0,1,1e-3,0,1,"
                         "\"b, \"\"c\"\"\"\n");
    put_text("named", "\3"
                      "0,0,1,-.5,+0.5,7.0710678E-1\n");
}

static void write_logs(void)
{
    target = "fitlog";
    put_text("log", "step,share,loss,pairs_per_s\n100,0.25,0.5,1000\n200,0.5,0.25,1000\n");
}

/* Whole files of it are generated, where libhdf5 is. */
static void write_hdf5(void)
{
    target = "hdf5";
    put_text("start", "\x89HDF\r\n\x1a\n");
}

static void write_texels(void)
{
    unsigned char bytes[96];
    target = "texels";
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char)(37 * i);
    bytes[0] = 2 | 4 | 8; /* half floats, all fields */
    bytes[1] = 5;
    put("half", bytes, sizeof bytes);
    bytes[0] = 1 | 2 | 16; /* bytes, isotropic */
    bytes[1] = 1;
    put("bytes", bytes, sizeof bytes);
}

/* As fuzz_checkpoint.c has it: 5 numbers, 2 materials, 4 tiles each; after magic and fingerprint.
 * */
static void write_checkpoint(void)
{
    enum { NUMBERS_AT = 16 + 3 * 8 + 2 * 8 + 4 * 8 + 8, ORDER_AT = NUMBERS_AT + 4 * 5 * 4 };
    unsigned char bytes[ORDER_AT + 4 * 4] = {0};
    target = "checkpoint";
    put_double(bytes + 16, 0.5);
    put_double(bytes + 24, 0.06);
    put_double(bytes + 32, 0.3);
    put_le(bytes + 40, 100, 8);
    put_le(bytes + 64, 75, 8);   /* the best step */
    put_double(bytes + 88, 0.2); /* its loss */
    put_le(bytes + ORDER_AT + 4, 1, 4);
    for (int i = 0; i < 20; i++)
        put_float(bytes + NUMBERS_AT + 4 * i, 0.25f);
    put("half_way", bytes, sizeof bytes);
}

/* ---- Scenes ---------------------------------------------------------------------------------- */

static void write_scenes(void)
{
    /* As fuzz_film.c has it: fingerprint 7, 17 x 2 pixels, two tiles. */
    unsigned char film[32 + 2 * 4 + 17 * 2 * 10 * 8] = "hnbrdf-render/1";
    memcpy(film + 16, "\7\0\0\0\0\0\0\0\21\0\0\0\2\0\0\0\4\0\0\0\3", 21);
    target = "obj";
    put_text("corners",
             "# all forms\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvn 0 0 1\n"
             "f 1 2 3\nf 1/1 2/2 3/1\nf 1//1 2//1 4//1\nf -1/1/1 -2/1/1 -3/2/1\n");
    put_text("polygons",
             "o a\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 .5 0\nv 0 2 0\nusemtl b c\nf 1 2 3 4 5\n"
             "g d\nf 5 4 \\\r\n 3 2\n");
    target = "scene";
    put_text("room", "camera from 0 1 4 to 0 0 0 fov 40 up 0 1 0 lens 0.1 focus 4\nsize 64 48\n"
                     "environment sky rotate 30 gain 2 hidden\nexposure 1\nbounces 4\n"
                     "portal corner 0 0 0 edge 1 0 0 edge 0 1 0\nmaterial a diffuse 0.5 0.5 0.5\n"
                     "material b ggx kd 0 0 0 eta 2 3 4 alpha 0.1 0.3\nmaterial c model \"m x\" y\n"
                     "shape quad scale 4 material a\nshape lathe profile 0 0 1 0 1 0 0.5 1 "
                     "material b move 1 0 0\n");
    put_text("shapes",
             "camera from 0 0 4 to 0 0 0 fov 40\nmaterial a builtin rough-clay\n"
             "material b measured x.bsdf\nshape sphere emit 1 2 3\nshape box stretch 1 2 3\n"
             "shape torus tube 0.2 detail 12 turn 30\nshape knot turns 2 5 tube 0.1\n"
             "shape superellipsoid powers 0.2 1.5 rotate 1 1 0 40\nshape teapot material a\n"
             "shape obj a.obj use part a smooth material b\n");
    target = "film";
    put("film", film, sizeof film);
}

int main(int argc, char **argv)
{
    FUZZ_CHECK(argc == 2);
    directory = argv[1];
    mkdir(directory, 0777);
    write_models();
    write_shaders();
    write_measured();
    write_networks();
    write_pictures();
    write_pairs();
    write_logs();
    write_hdf5();
    write_texels();
    write_checkpoint();
    write_scenes();
    return 0;
}
