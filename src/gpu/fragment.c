/* fragment.c: fragment shaders on one device: a float image that is drawn into. */
#include "gpu/fragment.h"

#include "base/error.h"
#include "gpu/commands.h"

#include <string.h>

static const VkFormat FORMAT = VK_FORMAT_R32G32B32A32_SFLOAT;
enum { PIXEL = 4 * sizeof(float) };

size_t gpu_canvas_size(const gpu_canvas *canvas)
{
    return (size_t)GPU_CANVAS_WIDTH * canvas->height * PIXEL;
}

/* ---- The image ------------------------------------------------------------------------------- */

static hnbrdf_result make_image(const gpu_device *device, gpu_canvas *canvas, hnbrdf_error *error)
{
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = FORMAT,
                              .extent = {GPU_CANVAS_WIDTH, canvas->height, 1},
                              .mipLevels = 1,
                              .arrayLayers = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .tiling = VK_IMAGE_TILING_OPTIMAL,
                              .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                       VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    hnbrdf_result result = gpu_check(vkCreateImage(device->handle, &info, NULL, &canvas->image),
                                     "creating an image", error);
    if (result)
        return result;
    VkMemoryRequirements required;
    vkGetImageMemoryRequirements(device->handle, canvas->image, &required);
    int type =
        gpu_memory_type(device, required.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    if (type < 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED, "Vulkan: no memory type for an image");
    VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .allocationSize = required.size,
                                     .memoryTypeIndex = (uint32_t)type};
    result = gpu_check(vkAllocateMemory(device->handle, &allocate, NULL, &canvas->memory),
                       "allocating memory", error);
    if (result)
        return result;
    return gpu_check(vkBindImageMemory(device->handle, canvas->image, canvas->memory, 0),
                     "binding memory", error);
}

static hnbrdf_result make_view(const gpu_device *device, gpu_canvas *canvas, hnbrdf_error *error)
{
    VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = canvas->image,
                                  .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                  .format = FORMAT,
                                  .subresourceRange = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT,
                                                       .levelCount = 1,
                                                       .layerCount = 1}};
    return gpu_check(vkCreateImageView(device->handle, &info, NULL, &canvas->view),
                     "creating an image view", error);
}

/* What is drawn is copied afterwards. */
static hnbrdf_result make_pass(const gpu_device *device, gpu_canvas *canvas, hnbrdf_error *error)
{
    VkAttachmentDescription colour = {.format = FORMAT,
                                      .samples = VK_SAMPLE_COUNT_1_BIT,
                                      .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                      .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                      .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                      .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                      .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                      .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    VkAttachmentReference reference = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &reference};
    const VkPipelineStageFlags output = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                               transfer = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkSubpassDependency order[] = {{.srcSubpass = VK_SUBPASS_EXTERNAL,
                                          .dstSubpass = 0,
                                          .srcStageMask = transfer,
                                          .dstStageMask = output,
                                          .srcAccessMask = VK_ACCESS_TRANSFER_READ_BIT,
                                          .dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT},
                                         {.srcSubpass = 0,
                                          .dstSubpass = VK_SUBPASS_EXTERNAL,
                                          .srcStageMask = output,
                                          .dstStageMask = transfer,
                                          .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                          .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT}};
    VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                   .attachmentCount = 1,
                                   .pAttachments = &colour,
                                   .subpassCount = 1,
                                   .pSubpasses = &subpass,
                                   .dependencyCount = 2,
                                   .pDependencies = order};
    hnbrdf_result result = gpu_check(vkCreateRenderPass(device->handle, &info, NULL, &canvas->pass),
                                     "creating a render pass", error);
    if (result)
        return result;
    VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                           .renderPass = canvas->pass,
                                           .attachmentCount = 1,
                                           .pAttachments = &canvas->view,
                                           .width = GPU_CANVAS_WIDTH,
                                           .height = canvas->height,
                                           .layers = 1};
    return gpu_check(vkCreateFramebuffer(device->handle, &framebuffer, NULL, &canvas->framebuffer),
                     "creating a framebuffer", error);
}

hnbrdf_result gpu_canvas_open(const gpu_device *device, size_t pixels, gpu_canvas *canvas,
                              hnbrdf_error *error)
{
    memset(canvas, 0, sizeof *canvas);
    const size_t height = (pixels + GPU_CANVAS_WIDTH - 1) / GPU_CANVAS_WIDTH;
    const uint32_t most = device->properties.limits.maxFramebufferHeight;
    if (!device->draws)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED, "%s: no queue that draws and computes",
                           device->properties.deviceName);
    if (height > most)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: %zu pixels, an image has at most %u lines of %d",
                           device->properties.deviceName, pixels, most, GPU_CANVAS_WIDTH);
    canvas->height = (uint32_t)height;
    hnbrdf_result result = make_image(device, canvas, error);
    if (!result)
        result = make_view(device, canvas, error);
    if (!result)
        result = make_pass(device, canvas, error);
    if (result)
        gpu_canvas_close(device, canvas);
    return result;
}

void gpu_canvas_close(const gpu_device *device, gpu_canvas *canvas)
{
    vkDestroyFramebuffer(device->handle, canvas->framebuffer, NULL);
    vkDestroyRenderPass(device->handle, canvas->pass, NULL);
    vkDestroyImageView(device->handle, canvas->view, NULL);
    vkDestroyImage(device->handle, canvas->image, NULL);
    vkFreeMemory(device->handle, canvas->memory, NULL);
    memset(canvas, 0, sizeof *canvas);
}

/* ---- Pipelines ------------------------------------------------------------------------------- */

static hnbrdf_result make_pipeline(const gpu_device *device, const gpu_canvas *canvas,
                                   const gpu_program *program, VkShaderModule vertex,
                                   VkPipeline *pipeline, hnbrdf_error *error)
{
    const VkPipelineShaderStageCreateInfo stages[] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = program->module,
         .pName = "main"}};
    const VkPipelineVertexInputStateCreateInfo none = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo triangles = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkRect2D area = {.extent = {GPU_CANVAS_WIDTH, canvas->height}};
    const VkViewport port = {
        .width = GPU_CANVAS_WIDTH, .height = (float)canvas->height, .maxDepth = 1.0f};
    const VkPipelineViewportStateCreateInfo ports = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &port,
        .scissorCount = 1,
        .pScissors = &area};
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .cullMode = VK_CULL_MODE_NONE,
        .lineWidth = 1.0f};
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineColorBlendAttachmentState as_it_is = {
        .colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                          VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &as_it_is};
    const VkGraphicsPipelineCreateInfo info = {.sType =
                                                   VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                               .stageCount = 2,
                                               .pStages = stages,
                                               .pVertexInputState = &none,
                                               .pInputAssemblyState = &triangles,
                                               .pViewportState = &ports,
                                               .pRasterizationState = &raster,
                                               .pMultisampleState = &samples,
                                               .pColorBlendState = &blend,
                                               .layout = program->layout,
                                               .renderPass = canvas->pass};
    return gpu_check(
        vkCreateGraphicsPipelines(device->handle, VK_NULL_HANDLE, 1, &info, NULL, pipeline),
        "creating a graphics pipeline", error);
}

hnbrdf_result gpu_canvas_pipeline(const gpu_device *device, const gpu_canvas *canvas,
                                  const gpu_program *program, const uint32_t *vertex_spirv,
                                  size_t vertex_size, VkPipeline *pipeline, hnbrdf_error *error)
{
    VkShaderModuleCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                     .codeSize = vertex_size,
                                     .pCode = vertex_spirv};
    VkShaderModule vertex = VK_NULL_HANDLE;
    hnbrdf_result result = gpu_check(vkCreateShaderModule(device->handle, &info, NULL, &vertex),
                                     "creating a shader module", error);
    if (!result)
        result = make_pipeline(device, canvas, program, vertex, pipeline, error);
    vkDestroyShaderModule(device->handle, vertex, NULL);
    return result;
}

/* ---- Drawing --------------------------------------------------------------------------------- */

hnbrdf_result gpu_canvas_draw(const gpu_device *device, const gpu_canvas *canvas,
                              const gpu_program *program, VkPipeline pipeline, const void *push,
                              const gpu_buffer *to, size_t offset, hnbrdf_error *error)
{
    VkCommandBuffer commands;
    const VkClearValue black = {0};
    const VkRenderPassBeginInfo pass = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = canvas->pass,
        .framebuffer = canvas->framebuffer,
        .renderArea = {.extent = {GPU_CANVAS_WIDTH, canvas->height}},
        .clearValueCount = 1,
        .pClearValues = &black};
    const VkBufferImageCopy region = {
        .bufferOffset = offset,
        .imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1},
        .imageExtent = {GPU_CANVAS_WIDTH, canvas->height, 1}};
    hnbrdf_result result = gpu_commands_begin(device, &commands, error);
    if (result)
        return result;
    vkCmdBeginRenderPass(commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, program->layout, 0, 1,
                            &program->set, 0, NULL);
    vkCmdPushConstants(commands, program->layout, program->stage, 0, program->push_size, push);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    vkCmdCopyImageToBuffer(commands, canvas->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           to->handle, 1, &region);
    gpu_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT);
    return gpu_commands_end(device, commands, error);
}
