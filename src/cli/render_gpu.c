/* render_gpu.c: the sphere of `hnbrdf render` on a Vulkan device, and whether it is the CPU's. */
#include "cli/render_gpu.h"

#ifdef HNBRDF_WITH_VULKAN
#include "cli/picture.h"
#include "gpu/compile.h"
#include "gpu/probe.h"
#include "gpu/sphere.h"

#include <stdlib.h>

/* ---- Against the CPU ------------------------------------------------------------------------- */

/* Numbers of two pictures. */
typedef struct difference {
    size_t count, differ, apart; /* all; not equal; not even neighbouring floats */
} difference;

static void add(difference *d, float a, float b)
{
    d->count++;
    d->differ += a != b;
    d->apart += a != b && nextafterf(a, b) != b;
}

static difference compare(const render_image *a, const render_image *b)
{
    difference d = {0};
    size_t pixels = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < pixels; i++) {
        for (size_t k = 0; k < 3; k++)
            add(&d, a->rgb[3 * i + k], b->rgb[3 * i + k]);
        add(&d, a->alpha[i], b->alpha[i]);
    }
    return d;
}

/* Sums are kept in doubles by the CPU, in pairs of floats by the device: neighbours may come out.
 * */
static int judge(const render_image *image, const render_image *cpu, int exact)
{
    difference d = compare(image, cpu);
    hnbrdf_image_error error;
    if (d.differ == 0) {
        printf("check: all %zu numbers of the picture are the CPU's, to the bit\n", d.count);
        return CLI_OK;
    }
    if (picture_compare(image, cpu, &error) != CLI_OK)
        return CLI_FAILURE;
    printf("check: %zu of %zu numbers of the picture differ from the CPU's, %zu by more than one "
           "step of a float; "
           "PSNR %.1f dB\n",
           d.differ, d.count, d.apart, error.psnr);
    if (exact && d.apart > 0)
        return cli_fail(
            "the device computes + - * / sqrt exactly, and its picture is not the CPU's");
    if (!exact)
        printf("check: this device does not round + - * / sqrt as C does, its samples are not the "
               "CPU's\n");
    return CLI_OK;
}

static int check(const render_gpu *job, const render_image *image, int exact)
{
    picture_progress progress = {.count = 1};
    render_options options = job->options;
    render_surface surface =
        render_surface_model(job->model, hnbrdf_model_material(job->model, job->material));
    render_image cpu;
    hnbrdf_error error;
    options.progress = picture_report;
    options.progress_user = &progress;
    cli_progress_begin(&progress.line, "rendering on the CPU");
    double started = cli_seconds();
    hnbrdf_result result = render_sphere(&surface, job->environment, &options, &cpu, &error);
    double seconds = cli_seconds() - started;
    cli_progress_end(&progress.line);
    if (result != HNBRDF_OK)
        return cli_fail("%s", error.text);
    int threads = options.threads > 0 ? options.threads : cli_processors();
    printf("CPU, %d thread%s: %.0f ns a sample\n", threads, threads == 1 ? "" : "s",
           seconds * 1e9 / ((double)options.size * options.size * options.spp));
    int code = judge(image, &cpu, exact);
    render_image_free(&cpu);
    return code;
}

/* ---- On the device --------------------------------------------------------------------------- */

static hnbrdf_result render(const render_gpu *job, const gpu_device *device, render_image *image,
                            double *sample_ns, hnbrdf_error *error)
{
    picture_progress progress = {.count = 1};
    render_options options = job->options;
    gpu_sphere sphere;
    hnbrdf_result result =
        gpu_sphere_open(device, job->model, job->material, job->environment, options.strategy,
                        GPU_BUILD_EXACT, GPU_SPHERE_PICTURE, &sphere, error);
    if (result)
        return result;
    options.progress = picture_report;
    options.progress_user = &progress;
    cli_progress_begin(&progress.line, device->properties.deviceName);
    result = gpu_sphere_render(&sphere, &options, image, sample_ns, error);
    cli_progress_end(&progress.line);
    gpu_sphere_close(&sphere);
    return result;
}

static int run_on(const render_gpu *job, const gpu_device *device, render_image *image)
{
    hnbrdf_error error;
    check_arithmetic a;
    render_image rendered;
    double ns;
    if (gpu_probe(device, &a, &error) || render(job, device, &rendered, &ns, &error))
        return cli_fail("%s", error.text);
    int exact = a.exact_basic && a.exact_divide && a.exact_sqrt && a.keeps_denormals;
    printf("%s: %.0f ns a sample\n", device->properties.deviceName, ns);
    int code = job->check ? check(job, &rendered, exact) : CLI_OK;
    if (code == CLI_OK)
        *image = rendered;
    else
        render_image_free(&rendered);
    return code;
}

/* CLI_OK, or an exit code after a message. */
static int choose(const gpu_instance *instance, const char *text, int *index)
{
    char *end;
    long number = strtol(text, &end, 10);
    if (end == text || *end)
        return cli_fail("--device: found '%s', expected a number (hnbrdf verify --list)", text),
               CLI_USAGE;
    if (instance->count == 0)
        return cli_fail(
            "no Vulkan device found (Debian: apt-get install mesa-vulkan-drivers brings one in "
            "software)");
    if (number < 0 || number >= instance->count)
        return cli_fail("--device %ld: this machine has devices 0 to %d (hnbrdf verify --list)",
                        number, instance->count - 1);
    *index = (int)number;
    return CLI_OK;
}

int render_gpu_run(const render_gpu *job, render_image *image)
{
    gpu_instance instance;
    gpu_device device;
    hnbrdf_error error;
    int index = 0;
    if (gpu_open(GPU_NOT_VALIDATED, &instance, &error) != HNBRDF_OK)
        return cli_fail("%s", error.text);
    int code = choose(&instance, job->device, &index);
    if (code == CLI_OK && gpu_device_open(&instance, index, &device, &error) != HNBRDF_OK) {
        code = cli_fail("%s", error.text);
    } else if (code == CLI_OK) {
        code = run_on(job, &device, image);
        gpu_device_close(&device);
    }
    gpu_close(&instance);
    return code;
}

#else

int render_gpu_run(const render_gpu *job, render_image *image)
{
    (void)job;
    (void)image;
    return cli_fail("--device: this hnbrdf was built without Vulkan (HNBRDF_WITH_VULKAN)");
}

#endif
