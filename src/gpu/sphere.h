/* sphere.h: the sphere of `hnbrdf render` on one Vulkan device, with the random numbers and
 * arithmetic of src/render: where the device rounds + - * / sqrt correctly, the directions, BRDF
 * values and contributions of every sample have the bits that the CPU gives. */
#ifndef HNBRDF_GPU_SPHERE_H
#define HNBRDF_GPU_SPHERE_H

#include "check/verify.h"
#include "gpu/compute.h"
#include "render/render.h"

typedef struct gpu_sphere {
    const gpu_device *device;
    gpu_buffer texels, places, results, caps;
    gpu_program program;
    VkPipeline pipeline;
    int width, height; /* of the map */
    float turn;
    double compile_ms; /* GLSL to SPIR-V */
} gpu_sphere;

/* What the shader shall do beside drawing a picture: nothing, or write down what it draws. */
typedef enum gpu_sphere_mode { GPU_SPHERE_PICTURE = 0, GPU_SPHERE_RECORD } gpu_sphere_mode;

/* Exports and compiles one material and uploads the map, neither of which is needed afterwards.
 * Directions are those of hnbrdf_sample(), as render_surface_model() has them.
 * HNBRDF_ERROR_UNSUPPORTED if the map is too large for a buffer of the device. */
hnbrdf_result gpu_sphere_open(const gpu_device *device, const hnbrdf_model *model, int material,
                              const render_environment *environment, render_strategy strategy,
                              check_build build, gpu_sphere_mode mode, gpu_sphere *sphere,
                              hnbrdf_error *error);
void gpu_sphere_close(gpu_sphere *sphere);

/* render_sphere() of a sphere opened for pictures; threads and strategy of the options are not
 * read. Dispatches are kept near 50 ms, so that no watchdog of a driver fires. *sample_ns, which
 * may be NULL, receives the time of a sample, in the device's timestamps where it has them, else
 * by the clock. */
hnbrdf_result gpu_sphere_render(gpu_sphere *sphere, const render_options *options,
                                render_image *image, double *sample_ns, hnbrdf_error *error);

/* One direction of a sample. */
typedef struct gpu_sphere_draw {
    float wi[3], wo[3], f[3], counts; /* counts 0: no direction, or not above the horizon */
} gpu_sphere_draw;

/* Every draw of `pixels` pixels from `first` on, of a sphere opened for recording: draws is
 * [pixels][spp][2], the environment's and then the BRDF's; zeros where the ray or the strategy
 * has none. At most GPU_SPHERE_DRAWS in all. */
enum { GPU_SPHERE_DRAWS = 1 << 16 };
hnbrdf_result gpu_sphere_record(gpu_sphere *sphere, const render_options *options, uint32_t first,
                                uint32_t pixels, gpu_sphere_draw *draws, hnbrdf_error *error);

#endif
