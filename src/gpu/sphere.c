/* sphere.c: the sphere of `hnbrdf render` on one Vulkan device, in dispatches of a fraction of a
 * second. */
#include "gpu/sphere.h"

#include "base/clock.h"
#include "base/error.h"
#include "gpu/compile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The texts of shaders/sphere.comp and shaders/hybrid_brdf.glsl. */
extern const char hnbrdf_sphere_comp[], hnbrdf_hybrid_brdf_glsl[];

enum {
    NUMBERS = 8,            /* a pixel, see Results in shaders/sphere.comp */
    CAPACITY = 1 << 16,     /* most pixels of a dispatch */
    FIRST_SAMPLES = 1 << 14 /* of the first dispatch, of which nothing is known yet */
};
static const double DISPATCH_NS = 5e7;

/* As in shaders/sphere.comp. */
typedef struct push_constants {
    uint32_t pixels, first_pixel, first_sample, samples, spp;
    int32_t size, width, height;
    uint32_t seed_low, seed_high;
    float turn, frame2, distance, scale;
} push_constants;

/* ---- Opening --------------------------------------------------------------------------------- */

/* Opens a buffer and fills it by `fill`, which gets the environment and `size` bytes. */
static hnbrdf_result open_filled(const gpu_device *device, const render_environment *environment,
                                 size_t size, void (*fill)(const render_environment *, void *),
                                 gpu_buffer *buffer, hnbrdf_error *error)
{
    uint32_t most = device->properties.limits.maxStorageBufferRange;
    if (size > most)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_UNSUPPORTED,
            "%s: a map of %d x %d pixels takes a buffer of %zu bytes, this device has up to %u",
            device->properties.deviceName, environment->width, environment->height, size, most);
    void *data = malloc(size);
    if (!data)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "rendering: no memory for %zu bytes", size);
    fill(environment, data);
    hnbrdf_result result = gpu_buffer_open(device, size, buffer, error);
    if (!result)
        result = gpu_upload(device, buffer, data, size, error);
    free(data);
    return result;
}

static void fill_texels(const render_environment *environment, void *data)
{
    float(*texels)[4] = data;
    size_t count = (size_t)environment->width * (size_t)environment->height;
    for (size_t i = 0; i < count; i++) {
        memcpy(texels[i], environment->rgb + 3 * i, 3 * sizeof(float));
        texels[i][3] = (float)render_environment_density(environment, i);
    }
}

static void fill_places(const render_environment *environment, void *data)
{
    uint32_t(*places)[2] = data;
    size_t height = (size_t)environment->height, count = (size_t)environment->width * height;
    for (size_t y = 0; y < height; y++) {
        places[y][0] = environment->rows[y];
        places[y][1] = environment->row_start[y];
    }
    for (size_t i = 0; i < count; i++) {
        places[height + i][0] = environment->columns[i];
        places[height + i][1] = environment->column_start[i];
    }
}

static void fill_caps(const render_environment *environment, void *data)
{
    memcpy(data, environment->caps, ((size_t)environment->height + 1) * sizeof(float));
}

static hnbrdf_result open_buffers(gpu_sphere *s, const render_environment *environment,
                                  gpu_sphere_mode mode, hnbrdf_error *error)
{
    size_t height = (size_t)environment->height, texels = (size_t)environment->width * height;
    size_t results = mode == GPU_SPHERE_RECORD ? GPU_SPHERE_DRAWS * sizeof(gpu_sphere_draw)
                                               : CAPACITY * NUMBERS * sizeof(float);
    hnbrdf_result result = open_filled(s->device, environment, texels * 4 * sizeof(float),
                                       fill_texels, &s->texels, error);
    if (!result)
        result = open_filled(s->device, environment, (height + texels) * 2 * sizeof(uint32_t),
                             fill_places, &s->places, error);
    if (!result)
        result = open_filled(s->device, environment, (height + 1) * sizeof(float), fill_caps,
                             &s->caps, error);
    return result ? result : gpu_buffer_open(s->device, results, &s->results, error);
}

static hnbrdf_result open_program(gpu_sphere *s, const char *scene, check_build build,
                                  hnbrdf_error *error)
{
    const gpu_include includes[] = {{"hybrid_brdf.glsl", hnbrdf_hybrid_brdf_glsl},
                                    {"scene.glsl", scene}};
    const char *const defines[] = {build == CHECK_BUILD_EXACT ? "HNBRDF_EXACT=1" : "HNBRDF_EXACT=0",
                                   NULL};
    const gpu_buffer *const buffers[] = {&s->texels, &s->places, &s->results, &s->caps};
    uint32_t *spirv = NULL;
    size_t size = 0;
    hnbrdf_result result =
        gpu_compile(hnbrdf_sphere_comp, includes, 2, defines, &spirv, &size, error);
    if (!result)
        result = gpu_program_open(s->device, spirv, size, buffers, 4, sizeof(push_constants),
                                  &s->program, error);
    free(spirv);
    return result;
}

hnbrdf_result gpu_sphere_open(const gpu_device *device, const hnbrdf_model *model, int material,
                              const render_environment *environment, render_strategy strategy,
                              check_build build, gpu_sphere_mode mode, gpu_sphere *sphere,
                              hnbrdf_error *error)
{
    gpu_sphere s = {.device = device,
                    .width = environment->width,
                    .height = environment->height,
                    .turn = environment->turn};
    const hnbrdf_glsl_options options = {
        .materials = &material, .material_count = 1, .only = HNBRDF_GLSL_EVAL_SAMPLE, .fixed = 1};
    const int strategies = RENDER_BRDF + 1;
    gpu_text scene = {0};
    hnbrdf_result result = hnbrdf_export_shader(model, &options, gpu_text_append, &scene, error);
    if (!result)
        result = open_buffers(&s, environment, mode, error);
    if (!result)
        result = open_program(&s, scene.bytes, build, error);
    if (!result)
        result = gpu_pipeline_open(device, &s.program, (int)strategy + (int)mode * strategies,
                                   &s.pipeline, error);
    free(scene.bytes);
    if (result)
        gpu_sphere_close(&s);
    else
        *sphere = s;
    return result;
}

void gpu_sphere_close(gpu_sphere *s)
{
    if (!s->device)
        return;
    vkDestroyPipeline(s->device->handle, s->pipeline, NULL);
    gpu_program_close(s->device, &s->program);
    gpu_buffer_close(s->device, &s->texels);
    gpu_buffer_close(s->device, &s->places);
    gpu_buffer_close(s->device, &s->results);
    gpu_buffer_close(s->device, &s->caps);
    memset(s, 0, sizeof *s);
}

/* ---- Rendering ------------------------------------------------------------------------------- */

static hnbrdf_result dispatch(gpu_sphere *s, const render_options *options, uint32_t first_pixel,
                              uint32_t pixels, uint32_t first_sample, uint32_t samples, double *ns,
                              hnbrdf_error *error)
{
    const push_constants push = {.pixels = pixels,
                                 .first_pixel = first_pixel,
                                 .first_sample = first_sample,
                                 .samples = samples,
                                 .spp = (uint32_t)options->spp,
                                 .size = options->size,
                                 .width = s->width,
                                 .height = s->height,
                                 .seed_low = (uint32_t)options->seed,
                                 .seed_high = (uint32_t)(options->seed >> 32),
                                 .turn = s->turn,
                                 .frame2 = RENDER_FRAME * RENDER_FRAME,
                                 .distance = RENDER_DISTANCE,
                                 .scale = RENDER_SCALE};
    double started = hnbrdf_seconds();
    hnbrdf_result result =
        gpu_dispatch(s->device, &s->program, s->pipeline, &push, pixels, 1, ns, error);
    *ns = isnan(*ns) ? 1e9 * (hnbrdf_seconds() - started) : *ns;
    return result;
}

/* A picture on its way. */
typedef struct painting {
    gpu_sphere *sphere;
    render_options options;
    render_image *image;
    float *results;
    uint32_t pixels;
    double budget;   /* samples that a dispatch may take */
    double done, ns; /* samples, and what they took */
    hnbrdf_error *error;
} painting;

static uint32_t at_least(uint32_t least, double value, uint32_t most)
{
    value = value < (double)most ? value : (double)most;
    uint32_t whole = value > 0.0 ? (uint32_t)value : 0;
    return whole > least ? whole : least < most ? least : most;
}

/* The next dispatch gets what would have taken DISPATCH_NS, at most four times as much as this
 * one. */
static void learn(painting *p, double samples, double ns)
{
    double fits = ns > 0.0 ? samples * DISPATCH_NS / ns : 4.0 * samples;
    p->budget = fits < 4.0 * p->budget ? fits : 4.0 * p->budget;
    p->done += samples;
    p->ns += ns;
}

static hnbrdf_result report(const painting *p)
{
    double all = (double)p->pixels * p->options.spp;
    if (p->options.progress && p->options.progress(p->options.progress_user, p->done / all))
        return hnbrdf_fail(p->error, HNBRDF_ERROR_CANCELLED, "rendering was stopped");
    return HNBRDF_OK;
}

/* All samples of `pixels` pixels; dispatches begin at multiples of RENDER_BLOCK. */
static hnbrdf_result paint_band(painting *p, uint32_t first, uint32_t pixels)
{
    hnbrdf_result result = HNBRDF_OK;
    uint32_t spp = (uint32_t)p->options.spp;
    for (uint32_t sample = 0; sample < spp && !result;) {
        double ns, blocks = p->budget / pixels / RENDER_BLOCK;
        uint32_t count = at_least(1, blocks, (uint32_t)1 << 24) * RENDER_BLOCK;
        count = count < spp - sample ? count : spp - sample;
        result = dispatch(p->sphere, &p->options, first, pixels, sample, count, &ns, p->error);
        if (result)
            return result;
        learn(p, (double)pixels * count, ns);
        sample += count;
        result = report(p);
    }
    return result ? result
                  : gpu_download(p->sphere->device, &p->sphere->results, p->results,
                                 (size_t)pixels * NUMBERS * sizeof(float), p->error);
}

static void store_band(const painting *p, uint32_t first, uint32_t pixels)
{
    for (uint32_t i = 0; i < pixels; i++) {
        const float *sums = p->results + (size_t)i * NUMBERS;
        size_t pixel = (size_t)first + i;
        for (int k = 0; k < 3; k++)
            p->image->rgb[3 * pixel + (size_t)k] =
                (float)(((double)sums[k] + (double)sums[3 + k]) / p->options.spp);
        p->image->alpha[pixel] = sums[6] / (float)p->options.spp;
    }
}

static hnbrdf_result paint(painting *p)
{
    hnbrdf_result result = HNBRDF_OK;
    for (uint32_t first = 0, pixels; first < p->pixels && !result; first += pixels) {
        pixels = at_least(GPU_GROUP_SIZE, p->budget / RENDER_BLOCK, CAPACITY);
        pixels = pixels < p->pixels - first ? pixels : p->pixels - first;
        result = paint_band(p, first, pixels);
        if (!result)
            store_band(p, first, pixels);
    }
    return result;
}

hnbrdf_result gpu_sphere_render(gpu_sphere *sphere, const render_options *options,
                                render_image *image, double *sample_ns, hnbrdf_error *error)
{
    render_image result_image;
    painting p = {
        .sphere = sphere, .image = &result_image, .budget = FIRST_SAMPLES, .error = error};
    hnbrdf_result result = render_options_settle(options, &p.options, error);
    if (!result)
        result = render_image_create(p.options.size, p.options.size, 1, &result_image, error);
    if (result)
        return result;
    p.pixels = (uint32_t)p.options.size * (uint32_t)p.options.size;
    p.results = malloc(CAPACITY * NUMBERS * sizeof *p.results);
    result =
        p.results ? paint(&p) : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "rendering: no memory");
    free(p.results);
    if (result) {
        render_image_free(&result_image);
        return result;
    }
    if (sample_ns)
        *sample_ns = p.ns / p.done;
    *image = result_image;
    return HNBRDF_OK;
}

hnbrdf_result gpu_sphere_record(gpu_sphere *sphere, const render_options *options, uint32_t first,
                                uint32_t pixels, gpu_sphere_draw *draws, hnbrdf_error *error)
{
    render_options settled;
    double ns;
    hnbrdf_result result = render_options_settle(options, &settled, error);
    size_t count = (size_t)pixels * (size_t)settled.spp * 2;
    if (result)
        return result;
    if (count > GPU_SPHERE_DRAWS)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "recording: %zu draws, expected at most %d",
                           count, (int)GPU_SPHERE_DRAWS);
    memset(draws, 0, count * sizeof *draws);
    result = gpu_upload(sphere->device, &sphere->results, draws, count * sizeof *draws, error);
    if (!result)
        result = dispatch(sphere, &settled, first, pixels, 0, (uint32_t)settled.spp, &ns, error);
    return result ? result
                  : gpu_download(sphere->device, &sphere->results, draws, count * sizeof *draws,
                                 error);
}
