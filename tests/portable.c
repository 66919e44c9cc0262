/* portable.c SEEDS MODEL SCRATCH [locale]: what comes of the same files, as text that has to be the
 * same on every machine, whatever its byte order and width, and under every locale. SEEDS is the
 * directory that fuzz_seeds writes, MODEL a model file, SCRATCH a directory to write into. With
 * `locale` the program takes that of the environment, which must write the decimal point otherwise.
 *
 * A plain program without cmocka: it is also compiled for other machines and run in an emulator. It
 * prints whole numbers only; values go in as checksums of their bits, low byte first. */
#include "hnbrdf/measured.h"
#include "variants_sweep.h"
#include "hnbrdf/glsl.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t EMPTY = 0xcbf29ce484222325u;
static const char *scratch;

static void stop(const char *what, const char *why)
{
    fprintf(stderr, "portable: %s: %s\n", what, why);
    exit(1);
}

static void need(int holds, const char *what, const hnbrdf_error *error)
{
    if (!holds)
        stop(what, error && error->text[0] ? error->text : "does not hold");
}

/* ---- Checksums ------------------------------------------------------------------------------- */

/* FNV-1a; a hnbrdf_write_fn. */
static int add_bytes(void *user, const void *data, size_t size)
{
    uint64_t *checksum = user;
    for (size_t i = 0; i < size; i++)
        *checksum = (*checksum ^ ((const unsigned char *)data)[i]) * 0x100000001b3u;
    return 0;
}

/* Halves or floats, or whole numbers of their size, in this machine's order. */
static void add_words(uint64_t *checksum, const void *data, size_t count, size_t width)
{
    for (size_t i = 0; i < count; i++) {
        unsigned char bytes[4];
        uint16_t half;
        uint32_t word;
        if (width == 2) {
            memcpy(&half, (const char *)data + 2 * i, 2);
            word = half;
        } else {
            memcpy(&word, (const char *)data + 4 * i, 4);
        }
        for (size_t b = 0; b < width; b++)
            bytes[b] = (unsigned char)(word >> 8 * b);
        add_bytes(checksum, bytes, width);
    }
}

/* A hnbrdf_write_fn for floats. */
static int add_floats(void *user, const void *data, size_t size)
{
    if (size % 4)
        return 1;
    add_words(user, data, size / 4, 4);
    return 0;
}

static void show(const char *what, const char *detail, uint64_t checksum)
{
    printf("%s %s %08lx%08lx\n", what, detail, (unsigned long)(checksum >> 32),
           (unsigned long)(checksum & 0xffffffffu));
}

/* ---- Files ----------------------------------------------------------------------------------- */

static char *read_file(const char *directory, const char *name, size_t *size)
{
    char path[1024];
    char *data = malloc(1 << 20);
    snprintf(path, sizeof path, "%s/%s", directory, name);
    FILE *file = fopen(path, "rb");
    if (!data || !file)
        stop(path, "cannot be read");
    *size = fread(data, 1, 1 << 20, file);
    fclose(file);
    return data;
}

static uint64_t file_checksum(const char *directory, const char *name)
{
    size_t size;
    uint64_t checksum = EMPTY;
    char *data = read_file(directory, name, &size);
    add_bytes(&checksum, data, size);
    free(data);
    return checksum;
}

/* ---- Models ---------------------------------------------------------------------------------- */

/* Values, samples and densities of every material; single calls here, test_core_variants has the
 * batches. */
static uint64_t values_of(const hnbrdf_model *model)
{
    sweep s = {42};
    uint64_t checksum = EMPTY;
    for (int k = 0; k < 400; k++) {
        const hnbrdf_material *material =
            hnbrdf_model_material(model, k % hnbrdf_model_material_count(model));
        const float u[2] = {sweep_unit(&s), sweep_unit(&s)};
        float wi[3], wo[3], out[3];
        hnbrdf_sample_result sample;
        sweep_pair(&s, wi, wo);
        hnbrdf_eval(model, material, wi, wo, out);
        add_words(&checksum, out, 3, 4);
        out[0] = hnbrdf_pdf(model, material, wi, wo);
        add_words(&checksum, out, 1, 4);
        hnbrdf_sample(model, material, wo, u, &sample);
        add_words(&checksum, sample.wi, 3, 4);
        add_words(&checksum, &sample.pdf, 1, 4);
        add_words(&checksum, sample.weight, 3, 4);
    }
    return checksum;
}

/* Written to a file and read back: the same bytes as in memory, the same values. */
static void write_and_read(const char *name, const hnbrdf_model *model)
{
    char path[1024];
    uint64_t written = EMPTY;
    hnbrdf_error error = {""};
    hnbrdf_model *back = NULL;
    snprintf(path, sizeof path, "%s/portable.safetensors", scratch);
    need(!hnbrdf_model_save(model, path, &error), name, &error);
    need(!hnbrdf_model_write(model, add_bytes, &written, &error), name, &error);
    need(file_checksum(scratch, "portable.safetensors") == written, "file and memory agree", NULL);
    need(!hnbrdf_model_load(path, NULL, &back, &error), name, &error);
    need(values_of(back) == values_of(model), "values survive a file", NULL);
    show("model", name, written);
    show("values", name, values_of(back));
    hnbrdf_model_free(back);
    remove(path);
}

static void pack(const hnbrdf_model *model, const char *name, hnbrdf_texel_format format)
{
    hnbrdf_packing packing;
    hnbrdf_error error = {""};
    uint64_t texels_sum = EMPTY, unpacked_sum = EMPTY;
    need(!hnbrdf_packing_init(model, NULL, 0, format, &packing, &error), name, &error);
    const size_t size = (size_t)hnbrdf_packing_texels(&packing) * hnbrdf_texel_bytes(format);
    for (int k = 0; k < hnbrdf_model_material_count(model); k++) {
        unsigned char texels[HNBRDF_MAX_TEXELS * 8];
        hnbrdf_material unpacked;
        hnbrdf_material_pack(&packing, hnbrdf_model_material(model, k), texels);
        if (format == HNBRDF_TEXEL_RGBA16F)
            add_words(&texels_sum, texels, size / 2, 2);
        else
            add_bytes(&texels_sum, texels, size);
        hnbrdf_material_unpack(&packing, texels, &unpacked);
        add_floats(&unpacked_sum, &unpacked, sizeof unpacked);
    }
    show(format == HNBRDF_TEXEL_RGBA16F ? "half texels" : "byte texels", name, texels_sum);
    show("unpacked", name, unpacked_sum);
}

static void export_as(const hnbrdf_model *model, const char *name,
                      const hnbrdf_glsl_options *options)
{
    uint64_t text = EMPTY;
    hnbrdf_error error = {""};
    need(!hnbrdf_export_shader(model, options, add_bytes, &text, &error), name, &error);
    show("shader", name, text);
    if (options->weights == HNBRDF_GLSL_UNIFORM && hnbrdf_weights_size(model)) {
        uint64_t weights = EMPTY;
        need(!hnbrdf_export_weights(model, options, add_floats, &weights, &error), name, &error);
        show("uniform", name, weights);
    }
}

static void export_shaders(const hnbrdf_model *model, const char *name)
{
    hnbrdf_packing packing;
    need(!hnbrdf_packing_init(model, NULL, 0, HNBRDF_TEXEL_RGBA8, &packing, NULL), name, NULL);
    for (int weights = 0; weights < 3; weights++)
        for (int precision = 0; precision < 2; precision++) {
            const hnbrdf_glsl_options options = {.weights = (hnbrdf_glsl_weights)weights,
                                                 .precision = (hnbrdf_glsl_precision)precision};
            export_as(model, name, &options);
        }
    export_as(model, name,
              &(hnbrdf_glsl_options){.fixed = 1, .standalone = 1, .only = HNBRDF_GLSL_EVAL});
    export_as(model, name, &(hnbrdf_glsl_options){.packing = &packing});
}

static void check_model(const char *name, const hnbrdf_model *model)
{
    write_and_read(name, model);
    export_shaders(model, name);
    pack(model, name, HNBRDF_TEXEL_RGBA16F);
    pack(model, name, HNBRDF_TEXEL_RGBA8);
}

static void check_models(const char *seeds, const char *shipped)
{
    static const char *const files[] = {"safetensors/hybrid", "safetensors/neural",
                                        "safetensors/ggx"};
    static const char *const shaders[] = {"brdf/plain", "brdf/brushed"};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    size_t size;
    need(!hnbrdf_model_load(shipped, NULL, &model, &error), shipped, &error);
    check_model("shipped", model);
    hnbrdf_model_free(model);
    for (int k = 0; k < 3; k++) {
        char *data = read_file(seeds, files[k], &size);
        need(!hnbrdf_model_load_memory(data, size, NULL, &model, &error), files[k], &error);
        check_model(files[k], model);
        hnbrdf_model_free(model);
        free(data);
    }
    for (int k = 0; k < 2; k++) {
        static const char *const material = "imported";
        char *data = read_file(seeds, shaders[k], &size);
        const char *text = data;
        need(!hnbrdf_model_import_brdf(&text, &size, &material, 1, NULL, &model, &error),
             shaders[k], &error);
        check_model(shaders[k], model);
        hnbrdf_model_free(model);
        free(data);
    }
}

/* ---- Messages -------------------------------------------------------------------------------- */

/* Every message with a number in it that has a fraction. */
static void check_messages(const char *shipped)
{
    hnbrdf_error error = {""};
    hnbrdf_material material;
    hnbrdf_model *model = NULL;
    hnbrdf_model_desc desc;
    hnbrdf_packing packing;
    float *const fields[] = {&material.kd[1], &material.eta[2], &material.alpha[0]};
    for (int k = 0; k < 3; k++) {
        hnbrdf_material_init(&material);
        *fields[k] = k == 2 ? 1e-5f : k == 1 ? 0.5f : 1.25f;
        need(hnbrdf_material_check(&material, &error) == HNBRDF_ERROR_ARGUMENT, "range", NULL);
        puts(error.text);
    }
    need(!hnbrdf_model_load(shipped, NULL, &model, &error), shipped, &error);
    hnbrdf_model_describe(model, &desc);
    desc.floor = -0.5f;
    need(hnbrdf_model_create(&desc, NULL, &(hnbrdf_model *){NULL}, &error) != HNBRDF_OK, "floor",
         NULL);
    puts(error.text);
    material = *desc.materials;
    material.energy.horizon = 1.5f;
    need(hnbrdf_material_check(&material, &error) == HNBRDF_ERROR_ARGUMENT, "energy", NULL);
    puts(error.text);
    need(!hnbrdf_packing_init(model, NULL, 0, HNBRDF_TEXEL_RGBA8, &packing, &error), "packing",
         &error);
    packing.kd[1] = 1.75f;
    need(hnbrdf_packing_check(&packing, &error) != HNBRDF_OK, "packing range", NULL);
    puts(error.text);
    hnbrdf_model_free(model);
}

/* ---- Measurements ---------------------------------------------------------------------------- */

/* The C library's atan2() and pow() may differ by an ulp of double from machine to machine. f,
 * rounded to float, does not for these directions and tables. */
static void ask(const char *name, const hnbrdf_measured *measured)
{
    sweep s = {7};
    uint64_t checksum = EMPTY;
    int valid = 0;
    for (int k = 0; k < 300; k++) {
        float wi[3], wo[3], f[3];
        sweep_pair(&s, wi, wo);
        valid += hnbrdf_measured_eval(measured, wi, wo, f);
        add_words(&checksum, f, 3, 4);
    }
    printf("%s: %s; %d of 300 valid\n", name, hnbrdf_measured_summary(measured), valid);
    show("measured", name, checksum);
}

static void open_and_ask(const char *name, const void *data, size_t size, const char *path,
                         const hnbrdf_measured_options *options)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    need(!hnbrdf_measured_open_memory(data, size, path, options, &measured, &error), name, &error);
    ask(name, measured);
    hnbrdf_measured_close(measured);
}

/* Doubles with more than one digit, low byte first as all these files are; a quarter of them not
 * measured. */
static unsigned char *table_of(size_t header, size_t count)
{
    unsigned char *data = malloc(header + 8 * count);
    sweep s = {3};
    if (!data)
        stop("table", "out of memory");
    for (size_t k = 0; k < count; k++) {
        double value = k % 4 == 3 ? -1.0 : (double)sweep_unit(&s) / 3.0;
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        for (int b = 0; b < 8; b++)
            data[header + 8 * k + (size_t)b] = (unsigned char)(bits >> 8 * b);
    }
    return data;
}

static void check_measured(const char *seeds)
{
    static const char *const rgl[] = {"rgl/isotropic", "rgl/quarter", "rgl/spectral", "rgl/both"};
    static const char *const modes[] = {"utia djb", "utia raw", "utia srgb"};
    enum { BINS = 90 * 90 * 180, UTIA = 3 * 288 * 288 };
    size_t size;
    for (int k = 0; k < 4; k++) {
        char *data = read_file(seeds, rgl[k], &size);
        open_and_ask(rgl[k], data, size, "material_rgb.bsdf", NULL);
        free(data);
    }
    unsigned char *merl = table_of(12, 3 * BINS);
    memcpy(merl, "\132\0\0\0\132\0\0\0\264\0\0\0", 12);
    open_and_ask("merl nearest", merl, 12 + 24 * (size_t)BINS, "material.binary", NULL);
    open_and_ask("merl trilinear", merl, 12 + 24 * (size_t)BINS, "material.binary",
                 &(hnbrdf_measured_options){.merl_lookup = HNBRDF_MERL_TRILINEAR});
    free(merl);
    unsigned char *utia = table_of(0, UTIA);
    for (int mode = 0; mode < 3; mode++)
        open_and_ask(modes[mode], utia, 8 * (size_t)UTIA, "material.bin",
                     &(hnbrdf_measured_options){.utia_mode = (hnbrdf_utia_mode)mode});
    free(utia);
}

int main(int argc, char **argv)
{
    if (argc < 4 || argc > 5)
        stop("usage", "portable SEEDS MODEL SCRATCH [locale]");
    if (argc == 5 && (!setlocale(LC_ALL, "") || strcmp(localeconv()->decimal_point, ".") == 0))
        stop("locale", "the environment gives none that writes the point otherwise");
    scratch = argv[3];
    check_models(argv[1], argv[2]);
    check_messages(argv[2]);
    check_measured(argv[1]);
    return 0;
}
