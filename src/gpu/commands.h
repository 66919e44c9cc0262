/* commands.h: command buffers of one device, recorded once, submitted, waited for; its memory. */
#ifndef HNBRDF_GPU_COMMANDS_H
#define HNBRDF_GPU_COMMANDS_H

#include "gpu/device.h"

hnbrdf_result gpu_commands_begin(const gpu_device *device, VkCommandBuffer *commands,
                                 hnbrdf_error *error);
hnbrdf_result gpu_commands_end(const gpu_device *device, VkCommandBuffer commands,
                               hnbrdf_error *error);
void gpu_barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written,
                 VkPipelineStageFlags to, VkAccessFlags read);

/* A memory type among `types` with all of `needed`, with `wished` too if there is one; -1 if
 * none. */
int gpu_memory_type(const gpu_device *device, uint32_t types, VkMemoryPropertyFlags needed,
                    VkMemoryPropertyFlags wished);

#endif
