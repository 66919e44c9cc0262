/* device.c: Vulkan instance and devices for compute. */
#include "gpu/device.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

static const char *const VALIDATION_LAYER = "VK_LAYER_KHRONOS_validation";

static const char *code_name(VkResult code)
{
    switch (code) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialisation failed";
    case VK_ERROR_DEVICE_LOST:
        return "device lost";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "extension not present";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "incompatible driver";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "too many objects";
    case VK_ERROR_INVALID_SHADER_NV:
        return "invalid shader";
    case VK_TIMEOUT:
        return "timeout";
    default:
        return "unknown";
    }
}

hnbrdf_result gpu_check(VkResult code, const char *what, hnbrdf_error *error)
{
    if (code == VK_SUCCESS)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED, "Vulkan: %s failed: %s (VkResult %d)", what,
                       code_name(code), (int)code);
}

/* ---- Instance -------------------------------------------------------------------------------- */

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user)
{
    gpu_instance *instance = user;
    (void)types;
    instance->messages++;
    fprintf(stderr, "validation %s: %s\n",
            severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT ? "error" : "warning",
            data->pMessage);
    return VK_FALSE;
}

static int has_layer(const char *name)
{
    uint32_t count = 0;
    if (vkEnumerateInstanceLayerProperties(&count, NULL) != VK_SUCCESS || count == 0)
        return 0;
    VkLayerProperties *layers = calloc(count, sizeof *layers);
    int found = 0;
    if (layers && vkEnumerateInstanceLayerProperties(&count, layers) >= VK_SUCCESS)
        for (uint32_t i = 0; i < count; i++)
            found |= strcmp(layers[i].layerName, name) == 0;
    free(layers);
    return found;
}

static void list_devices(gpu_instance *instance)
{
    uint32_t count = GPU_MAX_DEVICES;
    if (vkEnumeratePhysicalDevices(instance->handle, &count, instance->devices) < VK_SUCCESS)
        count = 0;
    instance->count = (int)count;
    for (int i = 0; i < instance->count; i++) {
        VkPhysicalDeviceDriverProperties driver = {
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
        VkPhysicalDeviceProperties2 properties = {
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
        vkGetPhysicalDeviceProperties(instance->devices[i], &instance->properties[i]);
        if (instance->properties[i].apiVersion >= VK_API_VERSION_1_2)
            properties.pNext = &driver;
        vkGetPhysicalDeviceProperties2(instance->devices[i], &properties);
        instance->driver_ids[i] = driver.driverID;
        snprintf(instance->drivers[i], sizeof instance->drivers[i], "%s%s%s", driver.driverName,
                 driver.driverInfo[0] ? " " : "", driver.driverInfo);
    }
}

static void make_messenger(gpu_instance *instance, const VkDebugUtilsMessengerCreateInfoEXT *info)
{
    PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance->handle,
                                                                  "vkCreateDebugUtilsMessengerEXT");
    if (!create || create(instance->handle, info, NULL, &instance->messenger) != VK_SUCCESS)
        instance->messenger = VK_NULL_HANDLE;
}

hnbrdf_result gpu_open(gpu_validation validation, gpu_instance *instance, hnbrdf_error *error)
{
    static const char *const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    static const VkValidationFeatureEnableEXT enables[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    memset(instance, 0, sizeof *instance);
    if (validation && !has_layer(VALIDATION_LAYER))
        return hnbrdf_fail(
            error, HNBRDF_ERROR_UNSUPPORTED,
            "Vulkan: %s is not installed (Debian: apt-get install vulkan-validationlayers)",
            VALIDATION_LAYER);
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .pApplicationName = "hnbrdf",
                                     .apiVersion = VK_API_VERSION_1_2};
    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = instance};
    VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                        .pNext = &messenger,
                                        .enabledValidationFeatureCount =
                                            validation == GPU_VALIDATED_SYNC,
                                        .pEnabledValidationFeatures = enables};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application};
    if (validation) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &VALIDATION_LAYER;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = extensions;
    }
    VkResult code = vkCreateInstance(&info, NULL, &instance->handle);
    if (code == VK_ERROR_INCOMPATIBLE_DRIVER) /* no driver installed at all */
        return HNBRDF_OK;
    hnbrdf_result result = gpu_check(code, "creating an instance", error);
    if (result)
        return result;
    if (validation)
        make_messenger(instance, &messenger);
    list_devices(instance);
    return HNBRDF_OK;
}

void gpu_close(gpu_instance *instance)
{
    if (instance->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                instance->handle, "vkDestroyDebugUtilsMessengerEXT");
        destroy(instance->handle, instance->messenger, NULL);
    }
    if (instance->handle)
        vkDestroyInstance(instance->handle, NULL);
    memset(instance, 0, sizeof *instance);
}

const char *gpu_kind_name(const gpu_instance *instance, int index)
{
    switch (instance->properties[index].deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "cpu";
    default:
        return "other";
    }
}

/* ---- Device ---------------------------------------------------------------------------------- */

/* The first family that computes: such a queue can always copy. -1 if there is none. */
static int compute_family(VkPhysicalDevice physical, uint32_t *timestamp_bits, int *draws)
{
    VkQueueFamilyProperties families[64];
    uint32_t count = 64;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    const VkQueueFlags wanted[] = {VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT,
                                   VK_QUEUE_COMPUTE_BIT};
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < count; i++)
            if ((families[i].queueFlags & wanted[k]) == wanted[k]) {
                *timestamp_bits = families[i].timestampValidBits;
                *draws = k == 0;
                return (int)i;
            }
    return -1;
}

static hnbrdf_result make_pools(gpu_device *device, uint32_t family, hnbrdf_error *error)
{
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                    .queueFamilyIndex = family};
    VkQueryPoolCreateInfo queries = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = 2};
    hnbrdf_result result =
        gpu_check(vkCreateCommandPool(device->handle, &pool, NULL, &device->pool),
                  "creating a command pool", error);
    if (result || device->tick_ns == 0)
        return result;
    return gpu_check(vkCreateQueryPool(device->handle, &queries, NULL, &device->timestamps),
                     "creating a query pool", error);
}

/* What to ask for: half precision in arithmetic where the device has it, and no more. */
static VkPhysicalDeviceShaderFloat16Int8Features
offered_half(VkPhysicalDevice physical, const VkPhysicalDeviceProperties *properties)
{
    VkPhysicalDeviceShaderFloat16Int8Features half = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &half};
    if (properties->apiVersion >= VK_API_VERSION_1_2)
        vkGetPhysicalDeviceFeatures2(physical, &features);
    half.shaderInt8 = VK_FALSE;
    return half;
}

hnbrdf_result gpu_device_open(const gpu_instance *instance, int index, gpu_device *device,
                              hnbrdf_error *error)
{
    VkPhysicalDevice physical = instance->devices[index];
    memset(device, 0, sizeof *device);
    device->properties = instance->properties[index];
    device->driver_id = instance->driver_ids[index];
    vkGetPhysicalDeviceMemoryProperties(physical, &device->memory);
    uint32_t timestamp_bits = 0;
    int family = compute_family(physical, &timestamp_bits, &device->draws);
    if (family < 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED, "%s: no queue that computes",
                           device->properties.deviceName);
    if (timestamp_bits > 0)
        device->tick_ns = (double)device->properties.limits.timestampPeriod;
    float priority = 1.0f;
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                     .queueFamilyIndex = (uint32_t)family,
                                     .queueCount = 1,
                                     .pQueuePriorities = &priority};
    VkPhysicalDeviceShaderFloat16Int8Features half = offered_half(physical, &device->properties);
    device->has_half = half.shaderFloat16 == VK_TRUE;
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = device->has_half ? &half : NULL,
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue};
    hnbrdf_result result = gpu_check(vkCreateDevice(physical, &info, NULL, &device->handle),
                                     "creating a device", error);
    if (result)
        return result;
    vkGetDeviceQueue(device->handle, (uint32_t)family, 0, &device->queue);
    result = make_pools(device, (uint32_t)family, error);
    if (result)
        gpu_device_close(device);
    return result;
}

void gpu_device_close(gpu_device *device)
{
    if (device->handle) {
        vkDestroyQueryPool(device->handle, device->timestamps, NULL);
        vkDestroyCommandPool(device->handle, device->pool, NULL);
        vkDestroyDevice(device->handle, NULL);
    }
    memset(device, 0, sizeof *device);
}
