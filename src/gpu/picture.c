/* picture.c: the picture of a sphere on a Vulkan device that is given by its number. */
#include "gpu/picture.h"

#include "base/error.h"
#include "gpu/compile.h"
#include "gpu/probe.h"
#include "gpu/sphere.h"

static hnbrdf_result render(const gpu_picture *job, const gpu_device *device, render_image *image,
                            double *sample_ns, hnbrdf_error *error)
{
    gpu_sphere sphere;
    hnbrdf_result result =
        gpu_sphere_open(device, job->model, job->material, job->environment, job->options.strategy,
                        CHECK_BUILD_EXACT, GPU_SPHERE_PICTURE, &sphere, error);
    if (result)
        return result;
    if (job->begin)
        job->begin(job->begin_user, device->properties.deviceName);
    result = gpu_sphere_render(&sphere, &job->options, image, sample_ns, error);
    gpu_sphere_close(&sphere);
    return result;
}

static hnbrdf_result render_on(const gpu_picture *job, const gpu_device *device,
                               render_image *image, gpu_picture_report *report, hnbrdf_error *error)
{
    check_arithmetic a;
    hnbrdf_result result = gpu_probe(device, &a, error);
    if (!result)
        result = render(job, device, image, &report->sample_ns, error);
    if (result)
        return result;
    report->exact = a.exact_basic && a.exact_divide && a.exact_sqrt && a.keeps_denormals;
    snprintf(report->device, sizeof report->device, "%s", device->properties.deviceName);
    return HNBRDF_OK;
}

static hnbrdf_result check_number(const gpu_instance *instance, long number, hnbrdf_error *error)
{
    if (instance->count == 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "no Vulkan device found (Debian: apt-get install mesa-vulkan-drivers "
                           "brings one in software)");
    if (number < 0 || number >= instance->count)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "--device %ld: this machine has devices 0 to %d (hnbrdf verify --list)",
                           number, instance->count - 1);
    return HNBRDF_OK;
}

hnbrdf_result gpu_picture_render(const gpu_picture *job, render_image *image,
                                 gpu_picture_report *report, hnbrdf_error *error)
{
    gpu_instance instance;
    gpu_device device;
    hnbrdf_result result = gpu_open(GPU_NOT_VALIDATED, &instance, error);
    if (result)
        return result;
    result = check_number(&instance, job->device, error);
    if (!result)
        result = gpu_device_open(&instance, (int)job->device, &device, error);
    if (!result) {
        result = render_on(job, &device, image, report, error);
        gpu_device_close(&device);
    }
    gpu_close(&instance);
    return result;
}
