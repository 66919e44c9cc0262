/* commands.c: command buffers of one device, recorded once, submitted, waited for; its memory. */
#include "gpu/commands.h"

hnbrdf_result gpu_commands_begin(const gpu_device *device, VkCommandBuffer *commands,
                                 hnbrdf_error *error)
{
    VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                        .commandPool = device->pool,
                                        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                        .commandBufferCount = 1};
    VkCommandBufferBeginInfo once = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                     .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    hnbrdf_result result = gpu_check(vkAllocateCommandBuffers(device->handle, &info, commands),
                                     "allocating a command buffer", error);
    if (result)
        return result;
    return gpu_check(vkBeginCommandBuffer(*commands, &once), "recording", error);
}

hnbrdf_result gpu_commands_end(const gpu_device *device, VkCommandBuffer commands,
                               hnbrdf_error *error)
{
    VkFenceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                           .commandBufferCount = 1,
                           .pCommandBuffers = &commands};
    VkFence fence = VK_NULL_HANDLE;
    hnbrdf_result result = gpu_check(vkEndCommandBuffer(commands), "recording", error);
    if (!result)
        result = gpu_check(vkCreateFence(device->handle, &info, NULL, &fence), "creating a fence",
                           error);
    if (!result)
        result =
            gpu_check(vkQueueSubmit(device->queue, 1, &submit, fence), "submitting work", error);
    if (!result)
        result = gpu_check(vkWaitForFences(device->handle, 1, &fence, VK_TRUE, UINT64_MAX),
                           "waiting for the device", error);
    vkDestroyFence(device->handle, fence, NULL);
    vkFreeCommandBuffers(device->handle, device->pool, 1, &commands);
    return result;
}

void gpu_barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written,
                 VkPipelineStageFlags to, VkAccessFlags read)
{
    VkMemoryBarrier memory = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = written, .dstAccessMask = read};
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, NULL, 0, NULL);
}

int gpu_memory_type(const gpu_device *device, uint32_t types, VkMemoryPropertyFlags needed,
                    VkMemoryPropertyFlags wished)
{
    const VkMemoryPropertyFlags masks[] = {needed | wished, needed};
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < device->memory.memoryTypeCount; i++)
            if ((types >> i & 1) &&
                (device->memory.memoryTypes[i].propertyFlags & masks[k]) == masks[k])
                return (int)i;
    return -1;
}
