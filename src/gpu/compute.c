/* compute.c: buffers, pipelines and dispatches on one device. */
#include "gpu/compute.h"

#include "base/error.h"
#include "gpu/commands.h"

#include <math.h>
#include <string.h>

/* ---- Buffers --------------------------------------------------------------------------------- */

static hnbrdf_result make_buffer(const gpu_device *device, size_t size, VkBufferUsageFlags usage,
                                 VkMemoryPropertyFlags needed, VkMemoryPropertyFlags wished,
                                 VkBuffer *buffer, VkDeviceMemory *memory,
                                 VkMemoryPropertyFlags *flags, hnbrdf_error *error)
{
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                               .size = size,
                               .usage = usage,
                               .sharingMode = VK_SHARING_MODE_EXCLUSIVE};
    hnbrdf_result result =
        gpu_check(vkCreateBuffer(device->handle, &info, NULL, buffer), "creating a buffer", error);
    if (result)
        return result;
    VkMemoryRequirements required;
    vkGetBufferMemoryRequirements(device->handle, *buffer, &required);
    int type = gpu_memory_type(device, required.memoryTypeBits, needed, wished);
    if (type < 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED, "Vulkan: no memory type for a buffer");
    *flags = device->memory.memoryTypes[type].propertyFlags;
    VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .allocationSize = required.size,
                                     .memoryTypeIndex = (uint32_t)type};
    result = gpu_check(vkAllocateMemory(device->handle, &allocate, NULL, memory),
                       "allocating memory", error);
    if (result)
        return result;
    return gpu_check(vkBindBufferMemory(device->handle, *buffer, *memory, 0), "binding memory",
                     error);
}

/* Host-visible, coherent and cached at once is what software and integrated devices offer;
 * elsewhere (discrete ones, even with a window onto their memory, are slow to read) a copy stands
 * between. */
static hnbrdf_result open_buffer(const gpu_device *device, VkDescriptorType type, size_t size,
                                 gpu_buffer *buffer, hnbrdf_error *error)
{
    const VkMemoryPropertyFlags visible =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags direct = visible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    const VkBufferUsageFlags copies =
        VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VkBufferUsageFlags use = type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                       ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT
                                       : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    VkMemoryPropertyFlags flags = 0;
    memset(buffer, 0, sizeof *buffer);
    buffer->type = type;
    buffer->size = size;
    hnbrdf_result result =
        make_buffer(device, size, use | copies, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, direct,
                    &buffer->handle, &buffer->memory, &flags, error);
    VkDeviceMemory mapped = buffer->memory;
    if (!result && (flags & direct) != direct) {
        result = make_buffer(device, size, copies, visible, VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
                             &buffer->staging, &buffer->staging_memory, &flags, error);
        mapped = buffer->staging_memory;
    }
    if (!result)
        result =
            gpu_check(vkMapMemory(device->handle, mapped, 0, VK_WHOLE_SIZE, 0, &buffer->mapped),
                      "mapping memory", error);
    if (result)
        gpu_buffer_close(device, buffer);
    return result;
}

hnbrdf_result gpu_buffer_open(const gpu_device *device, size_t size, gpu_buffer *buffer,
                              hnbrdf_error *error)
{
    return open_buffer(device, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, size, buffer, error);
}

void gpu_buffer_close(const gpu_device *device, gpu_buffer *buffer)
{
    vkDestroyBuffer(device->handle, buffer->handle, NULL);
    vkDestroyBuffer(device->handle, buffer->staging, NULL);
    vkFreeMemory(device->handle, buffer->memory, NULL);
    vkFreeMemory(device->handle, buffer->staging_memory, NULL);
    memset(buffer, 0, sizeof *buffer);
}

static hnbrdf_result copy(const gpu_device *device, VkBuffer from, VkBuffer to, size_t size,
                          hnbrdf_error *error)
{
    VkCommandBuffer commands;
    hnbrdf_result result = gpu_commands_begin(device, &commands, error);
    if (result)
        return result;
    VkBufferCopy region = {.size = size};
    vkCmdCopyBuffer(commands, from, to, 1, &region);
    gpu_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    return gpu_commands_end(device, commands, error);
}

hnbrdf_result gpu_upload(const gpu_device *device, gpu_buffer *buffer, const void *data,
                         size_t size, hnbrdf_error *error)
{
    memcpy(buffer->mapped, data, size);
    return buffer->staging ? copy(device, buffer->staging, buffer->handle, size, error) : HNBRDF_OK;
}

hnbrdf_result gpu_download(const gpu_device *device, gpu_buffer *buffer, void *data, size_t size,
                           hnbrdf_error *error)
{
    hnbrdf_result result =
        buffer->staging ? copy(device, buffer->handle, buffer->staging, size, error) : HNBRDF_OK;
    if (!result)
        memcpy(data, buffer->mapped, size);
    return result;
}

hnbrdf_result gpu_uniform_open(const gpu_device *device, const void *data, size_t size,
                               gpu_buffer *buffer, hnbrdf_error *error)
{
    uint32_t most = device->properties.limits.maxUniformBufferRange;
    if (size > most)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: a uniform block of %zu bytes, this device takes up to %u",
                           device->properties.deviceName, size, most);
    hnbrdf_result result =
        open_buffer(device, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, size, buffer, error);
    if (!result)
        result = gpu_upload(device, buffer, data, size, error);
    if (result)
        gpu_buffer_close(device, buffer);
    return result;
}

/* ---- Programs -------------------------------------------------------------------------------- */

static hnbrdf_result make_layouts(const gpu_device *device, const gpu_buffer *const *buffers,
                                  uint32_t buffer_count, gpu_program *program, hnbrdf_error *error)
{
    VkDescriptorSetLayoutBinding bindings[GPU_MAX_BUFFERS] = {{0}};
    for (uint32_t i = 0; i < buffer_count; i++) {
        bindings[i].binding = i;
        bindings[i].descriptorType = buffers[i]->type;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = program->stage;
    }
    VkDescriptorSetLayoutCreateInfo set = {.sType =
                                               VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                           .bindingCount = buffer_count,
                                           .pBindings = bindings};
    hnbrdf_result result =
        gpu_check(vkCreateDescriptorSetLayout(device->handle, &set, NULL, &program->set_layout),
                  "creating a descriptor set layout", error);
    if (result)
        return result;
    VkPushConstantRange push = {.stageFlags = program->stage, .size = program->push_size};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &program->set_layout,
                                         .pushConstantRangeCount = program->push_size > 0,
                                         .pPushConstantRanges = &push};
    return gpu_check(vkCreatePipelineLayout(device->handle, &layout, NULL, &program->layout),
                     "creating a pipeline layout", error);
}

static hnbrdf_result make_set(const gpu_device *device, const gpu_buffer *const *buffers,
                              uint32_t count, gpu_program *program, hnbrdf_error *error)
{
    const VkDescriptorPoolSize sizes[] = {
        {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .descriptorCount = count},
        {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, .descriptorCount = count}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    hnbrdf_result result =
        gpu_check(vkCreateDescriptorPool(device->handle, &pool, NULL, &program->pool),
                  "creating a descriptor pool", error);
    if (result)
        return result;
    VkDescriptorSetAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = program->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &program->set_layout};
    result = gpu_check(vkAllocateDescriptorSets(device->handle, &allocate, &program->set),
                       "allocating a descriptor set", error);
    if (result)
        return result;
    for (uint32_t i = 0; i < count; i++) {
        VkDescriptorBufferInfo range = {.buffer = buffers[i]->handle, .range = VK_WHOLE_SIZE};
        VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                      .dstSet = program->set,
                                      .dstBinding = i,
                                      .descriptorCount = 1,
                                      .descriptorType = buffers[i]->type,
                                      .pBufferInfo = &range};
        vkUpdateDescriptorSets(device->handle, 1, &write, 0, NULL);
    }
    return HNBRDF_OK;
}

hnbrdf_result gpu_program_open(const gpu_device *device, const uint32_t *spirv, size_t spirv_size,
                               const gpu_buffer *const *buffers, uint32_t buffer_count,
                               uint32_t push_size, gpu_program *program, hnbrdf_error *error)
{
    return gpu_program_open_at(device, VK_SHADER_STAGE_COMPUTE_BIT, spirv, spirv_size, buffers,
                               buffer_count, push_size, program, error);
}

hnbrdf_result gpu_program_open_at(const gpu_device *device, VkShaderStageFlagBits stage,
                                  const uint32_t *spirv, size_t spirv_size,
                                  const gpu_buffer *const *buffers, uint32_t buffer_count,
                                  uint32_t push_size, gpu_program *program, hnbrdf_error *error)
{
    memset(program, 0, sizeof *program);
    program->stage = stage;
    program->push_size = push_size;
    program->slots = 1;
    VkShaderModuleCreateInfo module = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                       .codeSize = spirv_size,
                                       .pCode = spirv};
    hnbrdf_result result =
        gpu_check(vkCreateShaderModule(device->handle, &module, NULL, &program->module),
                  "creating a shader module", error);
    if (!result)
        result = make_layouts(device, buffers, buffer_count, program, error);
    if (!result)
        result = make_set(device, buffers, buffer_count, program, error);
    if (result)
        gpu_program_close(device, program);
    return result;
}

void gpu_program_close(const gpu_device *device, gpu_program *program)
{
    vkDestroyDescriptorPool(device->handle, program->pool, NULL);
    vkDestroyPipelineLayout(device->handle, program->layout, NULL);
    vkDestroyDescriptorSetLayout(device->handle, program->set_layout, NULL);
    vkDestroyShaderModule(device->handle, program->module, NULL);
    memset(program, 0, sizeof *program);
}

hnbrdf_result gpu_pipeline_open(const gpu_device *device, const gpu_program *program,
                                int32_t constant, VkPipeline *pipeline, hnbrdf_error *error)
{
    VkSpecializationMapEntry entry = {.constantID = 0, .offset = 0, .size = sizeof constant};
    VkSpecializationInfo specialization = {
        .mapEntryCount = 1, .pMapEntries = &entry, .dataSize = sizeof constant, .pData = &constant};
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = program->module,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = program->layout};
    return gpu_check(
        vkCreateComputePipelines(device->handle, VK_NULL_HANDLE, 1, &info, NULL, pipeline),
        "creating a pipeline", error);
}

static void record(const gpu_device *device, VkCommandBuffer commands, const gpu_program *program,
                   VkPipeline pipeline, const void *push, size_t invocations, int repeats,
                   int timed)
{
    const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    uint32_t groups = (uint32_t)((invocations + GPU_GROUP_SIZE - 1) / GPU_GROUP_SIZE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program->layout, 0, 1,
                            &program->set, 0, NULL);
    if (program->push_size > 0)
        vkCmdPushConstants(commands, program->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           program->push_size, push);
    if (timed) {
        vkCmdResetQueryPool(commands, device->timestamps, 0, 2);
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, device->timestamps, 0);
    }
    for (int i = 0; i < repeats; i++) {
        vkCmdDispatch(commands, groups, program->slots, 1);
        gpu_barrier(commands, compute, VK_ACCESS_SHADER_WRITE_BIT, compute,
                    VK_ACCESS_SHADER_WRITE_BIT);
    }
    if (timed)
        vkCmdWriteTimestamp(commands, compute, device->timestamps, 1);
    gpu_barrier(commands, compute, VK_ACCESS_SHADER_WRITE_BIT,
                VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT);
}

hnbrdf_result gpu_dispatch(const gpu_device *device, const gpu_program *program,
                           VkPipeline pipeline, const void *push, size_t invocations, int repeats,
                           double *ns, hnbrdf_error *error)
{
    VkCommandBuffer commands;
    int timed = ns && device->tick_ns > 0;
    hnbrdf_result result = gpu_commands_begin(device, &commands, error);
    if (result)
        return result;
    record(device, commands, program, pipeline, push, invocations, repeats, timed);
    result = gpu_commands_end(device, commands, error);
    if (ns)
        *ns = (double)NAN;
    if (result || !timed)
        return result;
    uint64_t ticks[2] = {0, 0};
    result = gpu_check(vkGetQueryPoolResults(device->handle, device->timestamps, 0, 2, sizeof ticks,
                                             ticks, sizeof ticks[0],
                                             VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                       "reading timestamps", error);
    if (!result)
        *ns = (double)(ticks[1] - ticks[0]) * device->tick_ns;
    return result;
}
