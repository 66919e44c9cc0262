/* device.h: Vulkan instance and devices for compute; nothing here knows what is computed. */
#ifndef HNBRDF_GPU_DEVICE_H
#define HNBRDF_GPU_DEVICE_H

#include "hnbrdf/hnbrdf.h"

#include <vulkan/vulkan.h>

enum { GPU_MAX_DEVICES = 32 };

typedef struct gpu_instance {
    VkInstance handle;
    VkDebugUtilsMessengerEXT messenger; /* VK_NULL_HANDLE unless validating */
    int messages;                       /* warnings and errors the validation layer has reported */
    int count;
    VkPhysicalDevice devices[GPU_MAX_DEVICES];
    VkPhysicalDeviceProperties properties[GPU_MAX_DEVICES];
    VkDriverId driver_ids[GPU_MAX_DEVICES]; /* 0 where the device does not tell */
    char drivers[GPU_MAX_DEVICES][VK_MAX_DRIVER_NAME_SIZE + VK_MAX_DRIVER_INFO_SIZE + 2];
} gpu_instance;

/* With the Khronos validation layer or not; its messages are printed to stderr and counted. */
typedef enum gpu_validation {
    GPU_NOT_VALIDATED = 0,
    GPU_VALIDATED,
    /* synchronization too; the layer leaks when it does that (seen in 1.3.239) */
    GPU_VALIDATED_SYNC
} gpu_validation;

/* HNBRDF_ERROR_UNSUPPORTED if validation is asked for and not installed. The instance must stay
 * where it is. No Vulkan loader or no device is no error: count is then 0. */
hnbrdf_result gpu_open(gpu_validation validation, gpu_instance *instance, hnbrdf_error *error);
void gpu_close(gpu_instance *instance);

/* "discrete", "integrated", "virtual", "cpu" or "other". */
const char *gpu_kind_name(const gpu_instance *instance, int index);

/* One device with one queue that computes and copies. */
typedef struct gpu_device {
    VkDevice handle;
    VkQueue queue;
    VkCommandPool pool;
    VkPhysicalDeviceProperties properties;
    VkDriverId driver_id;
    VkPhysicalDeviceMemoryProperties memory;
    int has_half;           /* shaders may compute in half precision (shaderFloat16) */
    int draws;              /* the queue draws too */
    double tick_ns;         /* of a timestamp; 0 if the queue has none */
    VkQueryPool timestamps; /* two */
} gpu_device;

hnbrdf_result gpu_device_open(const gpu_instance *instance, int index, gpu_device *device,
                              hnbrdf_error *error);
void gpu_device_close(gpu_device *device);

/* Fails with what was being done and the name of the code, unless it is VK_SUCCESS. */
hnbrdf_result gpu_check(VkResult code, const char *what, hnbrdf_error *error);

#endif
