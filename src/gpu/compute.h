/* compute.h: buffers, pipelines and dispatches on one device. Every call waits until it is done. */
#ifndef HNBRDF_GPU_COMPUTE_H
#define HNBRDF_GPU_COMPUTE_H

#include "gpu/device.h"

#include <stdint.h>

enum { GPU_MAX_BUFFERS = 4, GPU_GROUP_SIZE = 64 };

/* A buffer in device memory, and where the host does not see that a second one it does see. */
typedef struct gpu_buffer {
    VkDescriptorType type; /* storage or uniform buffer */
    VkBuffer handle, staging;
    VkDeviceMemory memory, staging_memory;
    void *mapped;
    size_t size;
} gpu_buffer;

hnbrdf_result gpu_buffer_open(const gpu_device *device, size_t size, gpu_buffer *buffer,
                              hnbrdf_error *error);
/* A uniform buffer with these bytes. HNBRDF_ERROR_UNSUPPORTED if the device takes no uniform
 * block of this size. */
hnbrdf_result gpu_uniform_open(const gpu_device *device, const void *data, size_t size,
                               gpu_buffer *buffer, hnbrdf_error *error);
void gpu_buffer_close(const gpu_device *device, gpu_buffer *buffer);
/* The first `size` bytes, at most buffer->size. */
hnbrdf_result gpu_upload(const gpu_device *device, gpu_buffer *buffer, const void *data,
                         size_t size, hnbrdf_error *error);
hnbrdf_result gpu_download(const gpu_device *device, gpu_buffer *buffer, void *data, size_t size,
                           hnbrdf_error *error);

/* A shader with its buffers at set 0, binding 0, 1 ... and push constants. */
typedef struct gpu_program {
    VkShaderModule module;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkShaderStageFlagBits stage;
    uint32_t push_size;
    uint32_t slots; /* invocations in y of every one in x; 1 unless the caller sets it */
} gpu_program;

hnbrdf_result gpu_program_open(const gpu_device *device, const uint32_t *spirv, size_t spirv_size,
                               const gpu_buffer *const *buffers, uint32_t buffer_count,
                               uint32_t push_size, gpu_program *program, hnbrdf_error *error);
/* The same for another stage, see fragment.h. */
hnbrdf_result gpu_program_open_at(const gpu_device *device, VkShaderStageFlagBits stage,
                                  const uint32_t *spirv, size_t spirv_size,
                                  const gpu_buffer *const *buffers, uint32_t buffer_count,
                                  uint32_t push_size, gpu_program *program, hnbrdf_error *error);
void gpu_program_close(const gpu_device *device, gpu_program *program);

/* Entry point main with specialisation constant 0 set to `constant`. Destroy with
 * vkDestroyPipeline. */
hnbrdf_result gpu_pipeline_open(const gpu_device *device, const gpu_program *program,
                                int32_t constant, VkPipeline *pipeline, hnbrdf_error *error);

/* Runs at least `invocations` in groups of GPU_GROUP_SIZE, `repeats` times one after the other.
 * ns, if not NULL, receives the device's time for all of it, or NaN on a device without
 * timestamps. */
hnbrdf_result gpu_dispatch(const gpu_device *device, const gpu_program *program,
                           VkPipeline pipeline, const void *push, size_t invocations, int repeats,
                           double *ns, hnbrdf_error *error);

#endif
