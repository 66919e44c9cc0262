/* bake_device.c: run times of a Vulkan device for `hnbrdf bake --device`. */
#include "cli/bake_device.h"

#include "cli/cli.h"

#include <stdlib.h>

#ifdef HNBRDF_WITH_VULKAN
#include "base/text_buffer.h"
#include "gpu/compile.h"
#include "gpu/timed.h"
#include "hnbrdf/glsl.h"

#include <math.h>
#include <string.h>

struct bake_device {
    gpu_instance instance;
    gpu_device device;
    int is_open;
    char name[96];
};

/* Two materials, told apart when the shader runs, so that none is folded into the weights. */
static hnbrdf_model *twice(const hnbrdf_model *model)
{
    static const char *const names[] = {"first", "second"};
    hnbrdf_model_desc desc;
    hnbrdf_model *made;
    hnbrdf_model_describe(model, &desc);
    const hnbrdf_material materials[] = {desc.materials[0], desc.materials[0]};
    desc.material_count = 2;
    desc.materials = materials;
    desc.names = names;
    return hnbrdf_model_create(&desc, NULL, &made, NULL) == HNBRDF_OK ? made : NULL;
}

/* ns of the exported shader; those of its buffers are subtracted, and what is left of GGX may be
 * nothing. */
static double time_model(void *user, const hnbrdf_model *model, int half)
{
    bake_device *d = user;
    const hnbrdf_glsl_options options = {.standalone = 1,
                                         .weights =
                                             half ? HNBRDF_GLSL_CONSTANTS : HNBRDF_GLSL_COLUMNS,
                                         .precision = half ? HNBRDF_GLSL_HALF : HNBRDF_GLSL_FLOAT};
    if (half && !d->device.has_half)
        return (double)NAN;
    hnbrdf_text_buffer text = {0};
    hnbrdf_model *pair = twice(model);
    check_timing timing = {.value_ns = (double)NAN};
    if (pair &&
        hnbrdf_export_shader(pair, &options, hnbrdf_text_buffer_append, &text, NULL) == HNBRDF_OK) {
        const gpu_scene scene = {.text = text.bytes};
        (void)gpu_time_scene(&d->device, &scene, &timing, NULL);
    }
    hnbrdf_model_free(pair);
    free(text.bytes);
    return fmax(timing.value_ns - timing.copy_ns, 0.01);
}

int bake_device_open(long number, hnbrdf_bake_options *options, bake_device **opened)
{
    hnbrdf_error error;
    bake_device *d = *opened = calloc(1, sizeof *d);
    if (!d)
        return cli_fail("out of memory");
    if (!gpu_compiler_found())
        return cli_fail("--device: no glslangValidator (Debian: apt-get install glslang-tools)");
    if (gpu_open(GPU_NOT_VALIDATED, &d->instance, &error))
        return cli_fail("--device %ld: %s", number, error.text);
    if (number >= d->instance.count)
        return cli_fail("--device %ld: expected a number below %d (hnbrdf verify --list)", number,
                        d->instance.count);
    if (gpu_device_open(&d->instance, (int)number, &d->device, &error))
        return cli_fail("--device %ld: %s", number, error.text);
    d->is_open = 1;
    const char *device = d->device.properties.deviceName, *bracket = strstr(device, " (");
    snprintf(d->name, sizeof d->name, "vulkan:%.*s", bracket ? (int)(bracket - device) : 80,
             device);
    options->time = time_model;
    options->time_user = d;
    options->timed_on = d->name;
    return CLI_OK;
}

void bake_device_close(bake_device *d)
{
    if (d && d->is_open)
        gpu_device_close(&d->device);
    if (d && d->instance.handle)
        gpu_close(&d->instance);
    free(d);
}

#else

struct bake_device {
    int unused;
};

int bake_device_open(long number, hnbrdf_bake_options *options, bake_device **device)
{
    (void)options;
    *device = NULL;
    return cli_fail("--device %ld: built without Vulkan (HNBRDF_WITH_VULKAN)", number);
}

void bake_device_close(bake_device *device)
{
    free(device);
}

#endif
