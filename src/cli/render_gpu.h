/* render_gpu.h: the sphere of `hnbrdf render` on a Vulkan device, and whether it is the CPU's. */
#ifndef HNBRDF_CLI_RENDER_GPU_H
#define HNBRDF_CLI_RENDER_GPU_H

#include "cli/cli.h"
#include "render/render.h"

typedef struct render_gpu {
    const char *device; /* its number, as text */
    int check;          /* 1: also on the CPU, with the same random numbers */
    const hnbrdf_model *model;
    int material;
    const render_environment *environment;
    render_options options; /* without progress */
} render_gpu;

/* Renders with directions of hnbrdf_sample(). Prints the device and its time a sample on stdout;
 * with `check` those of the CPU and how many numbers of the pictures differ. CLI_OK with *image,
 * or an exit code after a message: CLI_FAILURE also where a device of exact arithmetic gives
 * another picture than the CPU. */
int render_gpu_run(const render_gpu *job, render_image *image);

#endif
