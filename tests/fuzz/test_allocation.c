/* test_allocation.c: whichever allocation of a call fails, first, second and so on up to the
 * last, the call says HNBRDF_ERROR_MEMORY in one line, leaves its result alone and leaks nothing.
 */
#include "failing_malloc.h"
#include "base/error.h"
#include "base/text.h"
#include "measured_support.h"
#include "nbrdf_support.h"

#include "hnbrdf/edit.h"
#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"
#include "render/environment.h"
#include "report/fit_log.h"
#include "scene/describe.h"
#include "scene/obj.h"
#include "hnbrdf/glsl.h"

#include <unistd.h>
#ifdef HNBRDF_WITH_OPENEXR
#include <openexr.h>
#endif

static const char MODEL[] = HNBRDF_EXAMPLE_MODEL;
enum { MOST_SITES = 200 };

/* Does its work once and frees what it made. */
typedef hnbrdf_result (*job)(const void *with, hnbrdf_error *error);

/* Runs it with allocation 0, 1, 2 ... failing until none is left to fail; there must be `least`
 * sites. */
static void survive(job work, const void *with, long least)
{
    long sites = 0, alive = 0;
    for (;; sites++) {
        hnbrdf_error error = {""};
        failing_malloc_begin(sites);
        const hnbrdf_result result = work(with, &error);
        const long calls = failing_malloc_end(&alive);
        if (alive != 0)
            fail_msg("allocation %ld fails: %ld blocks leak", sites, alive);
        if (calls <= sites) {
            assert_int_equal(result, HNBRDF_OK);
            break;
        }
        if (result == HNBRDF_OK && failing_malloc_was_foreign())
            continue; /* OpenEXR can go on without some; the job checks what comes out */
        if (result != HNBRDF_ERROR_MEMORY || strlen(error.text) < 10)
            fail_msg("allocation %ld fails: result %d \"%s\"", sites, (int)result, error.text);
        assert_true(sites < MOST_SITES);
    }
    if (sites < least)
        fail_msg("%ld allocations, expected at least %ld", sites, least);
}

static int count_bytes(void *user, const void *data, size_t size)
{
    (void)data;
    *(size_t *)user += size;
    return 0;
}

/* ---- Models ---------------------------------------------------------------------------------- */

/* Loads a file, describes it and makes the same again, saves and exports that. */
static hnbrdf_result use_model(const void *with, hnbrdf_error *error)
{
    const char *path = with;
    hnbrdf_model *model = NULL, *made = NULL;
    hnbrdf_model_desc desc;
    size_t count = 0;
    hnbrdf_result result = hnbrdf_model_load(MODEL, NULL, &model, error);
    assert_int_equal(result == HNBRDF_OK, model != NULL);
    if (!result) {
        hnbrdf_model_describe(model, &desc);
        result = hnbrdf_model_create(&desc, NULL, &made, error);
        assert_int_equal(result == HNBRDF_OK, made != NULL);
    }
    if (!result)
        result = hnbrdf_model_save(made, path, error);
    for (int style = 0; !result && style < 3; style++) {
        hnbrdf_glsl_options options = {.standalone = 1, .weights = (hnbrdf_glsl_weights)style};
        result = hnbrdf_export_shader(made, &options, count_bytes, &count, error);
        options.language = HNBRDF_LANGUAGE_HLSL;
        if (!result)
            result = hnbrdf_export_shader(made, &options, count_bytes, &count, error);
        if (!result)
            result = hnbrdf_export_weights(made, &options, count_bytes, &count, error);
    }
    hnbrdf_model_free(model);
    hnbrdf_model_free(made);
    return result;
}

static void models_survive(void **state)
{
    char path[] = "/tmp/hnbrdf_allocation_XXXXXX";
    int descriptor = mkstemp(path);
    (void)state;
    assert_true(descriptor >= 0);
    close(descriptor);
    survive(use_model, path, 6);
    remove(path);
}

/* A model with a material more, its lobes fitted. */
static hnbrdf_result edit_model(const void *with, hnbrdf_error *error)
{
    const hnbrdf_model *model = with;
    hnbrdf_material material = *hnbrdf_model_material(model, 0);
    const hnbrdf_material_change change = {
        .name = "new", .material = &material, .lobes = HNBRDF_LOBES_FIT};
    hnbrdf_model *made = NULL;
    material.alpha[0] = 0.5f;
    const hnbrdf_result result = hnbrdf_model_with_materials(model, &change, 1, NULL, &made, error);
    assert_int_equal(result == HNBRDF_OK, made != NULL);
    hnbrdf_model_free(made);
    return result;
}

static void edits_survive(void **state)
{
    hnbrdf_model *model = NULL;
    (void)state;
    assert_int_equal(hnbrdf_model_load(MODEL, NULL, &model, NULL), HNBRDF_OK);
    survive(edit_model, model, 3);
    hnbrdf_model_free(model);
}

static hnbrdf_result import_shader(const void *with, hnbrdf_error *error)
{
    static char text[1 << 16];
    const char *texts[] = {text}, *names[] = {"a"};
    hnbrdf_model *model = NULL;
    if (!text[0]) {
        FILE *file = fopen(with, "rb");
        assert_non_null(file);
        assert_true(fread(text, 1, sizeof text - 1, file) > 0);
        fclose(file);
    }
    const size_t sizes[] = {strlen(text)};
    const hnbrdf_result result =
        hnbrdf_model_import_brdf(texts, sizes, names, 1, NULL, &model, error);
    hnbrdf_model_free(model);
    return result;
}

static void imports_survive(void **state)
{
    (void)state;
    survive(import_shader, HNBRDF_TEST_DATA "/sample_plain.brdf", 2);
}

/* ---- Measurements ---------------------------------------------------------------------------- */

typedef struct measured_file {
    test_bytes bytes;
    const char *path; /* opened if there are no bytes */
    hnbrdf_measured_options options;
} measured_file;

static hnbrdf_result open_measured(const void *with, hnbrdf_error *error)
{
    const measured_file *file = with;
    hnbrdf_measured *measured = NULL;
    const hnbrdf_result result =
        file->bytes.data ? hnbrdf_measured_open_memory(file->bytes.data, file->bytes.size,
                                                       file->path, &file->options, &measured, error)
                         : hnbrdf_measured_open(file->path, &file->options, &measured, error);
    assert_int_equal(result == HNBRDF_OK, measured != NULL);
    hnbrdf_measured_close(measured);
    return result;
}

static void rgl_files_survive(void **state)
{
    (void)state;
    measured_file files[] = {{test_rgl(TEST_ISOTROPIC), "a.bsdf", {0}},
                             {test_rgl(TEST_WHOLE), "a.bsdf", {0}},
                             {test_rgl_spectral(1), "a.bsdf", {.rgl_spectra = 1}},
                             {test_rgl_spectral(0), "a.bsdf", {0}}};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        survive(open_measured, &files[i], 10);
        free(files[i].bytes.data);
    }
}

static void networks_survive(void **state)
{
    char directory[] = "/tmp/hnbrdf_allocation_XXXXXX", path[64];
    test_network network;
    (void)state;
    assert_non_null(mkdtemp(directory));
    test_network_make(&network, 21, 21, 1);
    test_write_npy(directory, "a", &network);
    snprintf(path, sizeof path, "%s/a_b2.npy", directory);
    const measured_file six = {{NULL, 0}, path, {0}};
    survive(open_measured, &six, 20);
    test_remove_npy(directory, "a");
    assert_int_equal(rmdir(directory), 0);
}

static void tables_survive(void **state)
{
    const size_t merl = 12 + (size_t)90 * 90 * 180 * 24, utia = (size_t)3 * 288 * 288 * 8;
    char path[] = "/tmp/hnbrdf_allocation_XXXXXX";
    unsigned char *zeros = calloc(1, merl);
    (void)state;
    assert_non_null(zeros);
    memcpy(zeros, "\132\0\0\0\132\0\0\0\264\0\0\0", 12);
    measured_file table = {{zeros, merl}, "a.binary", {.merl_identify = 0}};
    survive(open_measured, &table, 2);
    int descriptor = mkstemp(path); /* read from a file: a buffer that grows */
    assert_true(descriptor >= 0);
    assert_true(write(descriptor, zeros, merl) == (ssize_t)merl);
    close(descriptor);
    measured_file from_file = {{NULL, 0}, path, {0}};
    survive(open_measured, &from_file, 7);
    remove(path);
    memset(zeros, 0, 12);
    table = (measured_file){{zeros, utia}, "a.bin", {0}};
    survive(open_measured, &table, 2);
    free(zeros);
}

static int give_one(const void *user, const float wi[3], const float wo[3], float f[3])
{
    (void)user, (void)wi, (void)wo;
    f[0] = f[1] = f[2] = 1.0f;
    return 1;
}

static hnbrdf_result open_others(const void *with, hnbrdf_error *error)
{
    const hnbrdf_measured_custom custom = {.name = "one", .eval = give_one};
    hnbrdf_measured *builtin = NULL, *made = NULL;
    (void)with;
    hnbrdf_result result = hnbrdf_measured_open_builtin(0, &builtin, error);
    if (!result)
        result = hnbrdf_measured_create_custom(&custom, &made, error);
    hnbrdf_measured_close(builtin);
    hnbrdf_measured_close(made);
    return result;
}

static void built_in_and_custom_materials_survive(void **state)
{
    (void)state;
    survive(open_others, NULL, 3);
}

/* ---- Fitting --------------------------------------------------------------------------------- */

typedef struct fit_case {
    hnbrdf_measured *data[2];
    hnbrdf_fit_options options;
} fit_case;

static hnbrdf_result fit(const void *with, hnbrdf_error *error)
{
    const fit_case *c = with;
    hnbrdf_model *model = NULL;
    const hnbrdf_result result =
        hnbrdf_fit((const hnbrdf_measured *const *)c->data, 2, &c->options, &model, NULL, error);
    assert_int_equal(result == HNBRDF_OK, model != NULL);
    hnbrdf_model_free(model);
    return result;
}

static int stop(void *user, const hnbrdf_fit_progress *progress)
{
    (void)user;
    return progress->step > 0;
}

/* Materials are given so that no GGX fit takes its time; one case stops at a step and so writes a
 * checkpoint, the next goes on from one. */
static void fits_survive(void **state)
{
    char path[] = "/tmp/hnbrdf_allocation_XXXXXX";
    hnbrdf_material materials[2];
    hnbrdf_model *frozen = NULL;
    int descriptor = mkstemp(path);
    (void)state;
    assert_true(descriptor >= 0);
    close(descriptor);
    hnbrdf_material_init(&materials[0]);
    hnbrdf_material_init(&materials[1]);
    fit_case c = {{NULL, NULL},
                  {.hidden = 4,
                   .layers = 1,
                   .latent = 2,
                   .steps = 150,
                   .batch = 1024,
                   .pool = 1024,
                   .threads = 2,
                   .materials = materials}};
    assert_int_equal(hnbrdf_measured_open_builtin(2, &c.data[0], NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_measured_open_builtin(9, &c.data[1], NULL), HNBRDF_OK);
    c.options.checkpoint = path;
    c.options.progress = stop;
    survive(fit, &c, 18);
    c.options.progress = NULL;
    c.options.resume = 1;
    survive(fit, &c, 18);
    c.options.checkpoint = NULL;
    c.options.resume = 0;
    c.options.steps = 1;
    c.options.threads = 1;
    c.options.kind = HNBRDF_KIND_NEURAL;
    survive(fit, &c, 18);
    c.options.kind = HNBRDF_KIND_GGX;
    survive(fit, &c, 15);
    c.options.kind = HNBRDF_KIND_HYBRID;
    assert_int_equal(hnbrdf_model_load(MODEL, NULL, &frozen, NULL), HNBRDF_OK);
    c.options.freeze = frozen;
    survive(fit, &c, 18);
    hnbrdf_model_free(frozen);
    hnbrdf_measured_close(c.data[0]);
    hnbrdf_measured_close(c.data[1]);
    remove(path);
}

/* The log of a fit that is gone on with, and a row more. */
static hnbrdf_result use_log(const void *with, hnbrdf_error *error)
{
    const hnbrdf_fit_progress progress = {.step = 200, .done = 0.5, .loss = 0.25};
    loss_curve curve = {0};
    fit_log log;
    const hnbrdf_result result = fit_log_open(with, 1, &curve, &log, error);
    if (!result) {
        fit_log_row(&log, &progress); /* a point that cannot be held is left out of the curve */
        assert_int_equal(fit_log_close(&log, 0, error), HNBRDF_OK);
    }
    loss_curve_free(&curve);
    return result;
}

static void logs_survive(void **state)
{
    static const char text[] = "step,share,loss,pairs_per_s\n100,0.25,0.5,1000\n";
    char path[] = "/tmp/hnbrdf_allocation_XXXXXX";
    int descriptor = mkstemp(path);
    hnbrdf_error error = {""};
    (void)state;
    assert_true(descriptor >= 0);
    assert_true(write(descriptor, text, sizeof text - 1) == (ssize_t)sizeof text - 1);
    close(descriptor);
    failing_malloc_begin(0); /* the text */
    assert_int_equal(use_log(path, &error), HNBRDF_ERROR_MEMORY);
    long alive = 0;
    failing_malloc_end(&alive);
    assert_int_equal(alive, 0);
    assert_true(strlen(error.text) > 10);
    for (long site = 1; site < 4; site++) { /* points of the curve, which can do without */
        failing_malloc_begin(site);
        assert_int_equal(use_log(path, &error), HNBRDF_OK);
        failing_malloc_end(&alive);
        assert_int_equal(alive, 0);
    }
    remove(path);
}

/* ---- Pictures -------------------------------------------------------------------------------- */

/* A picture to a file and back, and light of it. `with` is the file's path. */
static hnbrdf_result use_picture(const void *with, hnbrdf_error *error)
{
    const char *path = with;
    render_image image = {0}, back = {0};
    render_environment environment = {0};
    hnbrdf_result result = render_image_create(20, 20, 1, &image, error);
    for (int i = 0; !result && i < 3 * 20 * 20; i++)
        image.rgb[i] = (float)(i % 5);
    if (!result)
        result = render_image_write(&image, path, NULL, error);
    if (!result && hnbrdf_ends_with(path, ".exr"))
        result = render_image_read(path, NULL, &back, error);
    if (!result && back.rgb) {
        assert_memory_equal(back.rgb, image.rgb, sizeof(float) * 3 * 20 * 20);
        result = render_environment_create(&back, 0.0, path, &environment, error);
    }
    render_image_free(&image);
    render_image_free(&back);
    render_environment_free(&environment);
    return result;
}

static hnbrdf_result decode_radiance(const void *with, hnbrdf_error *error)
{
    static const char flat[] = "#?RGBE\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x40\x20\x10\x82";
    render_image image = {0};
    (void)with;
    const hnbrdf_result result =
        render_radiance_decode(flat, sizeof flat - 1, "x.hdr", NULL, &image, error);
    render_image_free(&image);
    return result;
}

static void pictures_survive(void **state)
{
    char directory[] = "/tmp/hnbrdf_allocation_XXXXXX", path[64];
    (void)state;
    assert_non_null(mkdtemp(directory));
    snprintf(path, sizeof path, "%s/a.png", directory);
    survive(use_picture, path, 4);
    remove(path);
#ifdef HNBRDF_WITH_OPENEXR
    exr_set_default_memory_routines(failing_malloc, failing_free);
    snprintf(path, sizeof path, "%s/a.exr", directory);
    survive(use_picture, path, 10);
    remove(path);
#endif
    survive(decode_radiance, NULL, 2);
    assert_int_equal(rmdir(directory), 0); /* nothing was left beside the files */
}

/* ---- Meshes and scenes ----------------------------------------------------------------------- */

/* More vertices, normals, triangles and parts than fit the first blocks, a face with a hole, and
 * one of more corners than fit the first block. */
static const char *obj_text(void)
{
    static char text[1 << 14];
    size_t at = 0;
    for (int i = 0; i < 100; i++)
        at += (size_t)sprintf(text + at, "v %d %d 0\nvn 0 0 1\nvt 0 0\ng part%d\nf -1 1 -1\n",
                              i % 10, i / 10, i % 40);
    at += (size_t)sprintf(text + at, "f 1 10 100 91 1 45 46 36 45\nf");
    for (int i = 0; i < 40; i++)
        at += (size_t)sprintf(text + at, " %d//1", 1 + (i < 20 ? 5 * i : 98 - 5 * (i - 20)));
    for (int i = 0; i < 80; i++)
        at += (size_t)sprintf(text + at, "\nf 1 2 %d", 20 + i);
    assert_true(at < sizeof text);
    return text;
}

static hnbrdf_result decode_obj(const void *with, hnbrdf_error *error)
{
    render_mesh mesh = {0};
    hnbrdf_result result = render_obj_decode(with, strlen(with), "a.obj", NULL, &mesh, NULL, error);
    assert_int_equal(result == HNBRDF_OK, mesh.triangles != NULL);
    if (!result && render_mesh_smooth(&mesh))
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory to average normals");
    render_mesh_free(&mesh);
    return result;
}

static void meshes_survive(void **state)
{
    (void)state;
    survive(decode_obj, obj_text(), 20);
}

static hnbrdf_result parse_scene(const void *with, hnbrdf_error *error)
{
    render_description d = {.bounces = -1};
    const hnbrdf_result result = render_description_parse(with, strlen(with), "a.scene", &d, error);
    assert_int_equal(result == HNBRDF_OK, d.bounces != -1);
    if (!result)
        render_description_free(&d);
    return result;
}

/* Reads a scene with all its files and builds it. */
static hnbrdf_result load_scene(const void *with, hnbrdf_error *error)
{
    render_description d;
    render_loaded loaded;
    hnbrdf_result result = render_description_read(with, &d, error);
    if (result)
        return result;
    result = render_description_load(&d, RENDER_SHOW_MODEL, NULL, NULL, &loaded, error);
    if (!result)
        render_loaded_free(&loaded);
    render_description_free(&d);
    return result;
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void scenes_survive(void **state)
{
    static const char text[] = "camera from 0 0 5 to 0 0 0 fov 40\nsize 4 4\n"
                               "environment furnace\n"
                               "portal corner 0 0 3 edge 1 0 0 edge 0 1 0\n"
                               "material a diffuse 1 1 1\nmaterial b diffuse 0 0 0\n"
                               "material c model %s vch_silk_blue\n"
                               "shape obj a.obj use part1 a smooth material b\n"
                               "shape sphere material c emit 1 1 1\nshape box material a\n"
                               "shape lathe profile 0 0 1 1 0 2 material a\n";
    char directory[] = "/tmp/hnbrdf_allocation_XXXXXX", mesh[64], scene[64], all[2048];
    (void)state;
    snprintf(all, sizeof all, text, MODEL);
    survive(parse_scene, all, 4);
    if (!render_has_embree())
        return;
    assert_non_null(mkdtemp(directory));
    snprintf(mesh, sizeof mesh, "%s/a.obj", directory);
    snprintf(scene, sizeof scene, "%s/a.scene", directory);
    write_text(mesh, obj_text());
    write_text(scene, all);
    survive(load_scene, scene, 40);
    remove(mesh);
    remove(scene);
    assert_int_equal(rmdir(directory), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_survive),
        cmocka_unit_test(edits_survive),
        cmocka_unit_test(imports_survive),
        cmocka_unit_test(rgl_files_survive),
        cmocka_unit_test(networks_survive),
        cmocka_unit_test(tables_survive),
        cmocka_unit_test(built_in_and_custom_materials_survive),
        cmocka_unit_test(fits_survive),
        cmocka_unit_test(logs_survive),
        cmocka_unit_test(pictures_survive),
        cmocka_unit_test(meshes_survive),
        cmocka_unit_test(scenes_survive),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
