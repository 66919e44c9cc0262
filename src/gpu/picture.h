/* picture.h: the picture of a sphere on a Vulkan device that is given by its number. */
#ifndef HNBRDF_GPU_PICTURE_H
#define HNBRDF_GPU_PICTURE_H

#include "render/render.h"

typedef struct gpu_picture {
    long device; /* its number, as `hnbrdf verify --list` shows it */
    const hnbrdf_model *model;
    int material;
    const render_environment *environment;
    render_options options; /* as gpu_sphere_render() takes them */
    /* called before it is rendered, with the device's name; may be NULL */
    void (*begin)(void *user, const char *device);
    void *begin_user;
} gpu_picture;

typedef struct gpu_picture_report {
    char device[256];
    double sample_ns; /* time of a sample */
    int exact;        /* + - * / sqrt are rounded as C does: the picture must be the CPU's */
} gpu_picture_report;

/* Renders with directions of hnbrdf_sample(). */
hnbrdf_result gpu_picture_render(const gpu_picture *job, render_image *image,
                                 gpu_picture_report *report, hnbrdf_error *error);

#endif
