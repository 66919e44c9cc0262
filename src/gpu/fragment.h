/* fragment.h: fragment shaders on one device: a float image that is drawn into. Every call waits
 * until it is done. */
#ifndef HNBRDF_GPU_FRAGMENT_H
#define HNBRDF_GPU_FRAGMENT_H

#include "gpu/compute.h"

enum { GPU_CANVAS_WIDTH = 256 };

/* An image of RGBA32F, GPU_CANVAS_WIDTH wide. */
typedef struct gpu_canvas {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    uint32_t height;
} gpu_canvas;

/* Of at least `pixels`. HNBRDF_ERROR_UNSUPPORTED if the device has no queue that draws. */
hnbrdf_result gpu_canvas_open(const gpu_device *device, size_t pixels, gpu_canvas *canvas,
                              hnbrdf_error *error);
void gpu_canvas_close(const gpu_device *device, gpu_canvas *canvas);
/* Bytes of its pixels, line by line. */
size_t gpu_canvas_size(const gpu_canvas *canvas);

/* Entry points main of a vertex shader, which makes one triangle of three vertices without inputs,
 * and of the program, which is of the fragment stage. Destroy with vkDestroyPipeline. */
hnbrdf_result gpu_canvas_pipeline(const gpu_device *device, const gpu_canvas *canvas,
                                  const gpu_program *program, const uint32_t *vertex_spirv,
                                  size_t vertex_size, VkPipeline *pipeline, hnbrdf_error *error);

/* Draws, and copies the pixels to the buffer from byte `offset` on. */
hnbrdf_result gpu_canvas_draw(const gpu_device *device, const gpu_canvas *canvas,
                              const gpu_program *program, VkPipeline pipeline, const void *push,
                              const gpu_buffer *to, size_t offset, hnbrdf_error *error);

#endif
