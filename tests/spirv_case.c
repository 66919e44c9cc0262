/* spirv_case.c: runs a compute shader in SPIR-V on the first Vulkan device: what another compiler
 * made of a case of `hnbrdf verify --hand-out`.
 *   spirv_case SHADER.spv INPUTS.f32 VECTORS SLOTS OUTPUTS.f32 [WEIGHTS]
 * VECTORS vec4 are a row of inputs; the shader is run for each row and slot (x and y) and writes a
 * vec4 to row * SLOTS + slot. Buffers 0 and 1, WEIGHTS is the uniform block 2. Prints the device;
 * exit status 77 without one. */
#include "gpu/compute.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct bytes {
    void *data;
    size_t size;
} bytes;

static bytes read_file(const char *path)
{
    bytes read = {NULL, 0};
    FILE *file = fopen(path, "rb");
    long size = -1;
    if (file && fseek(file, 0, SEEK_END) == 0)
        size = ftell(file);
    if (size > 0 && fseek(file, 0, SEEK_SET) == 0)
        read.data = malloc((size_t)size);
    if (!read.data || fread(read.data, 1, (size_t)size, file) != (size_t)size) {
        fprintf(stderr, "spirv_case: %s: cannot be read\n", path);
        exit(1);
    }
    fclose(file);
    read.size = (size_t)size;
    return read;
}

static void write_file(const char *path, const bytes *written)
{
    FILE *file = fopen(path, "wb");
    const int ok = file && fwrite(written->data, 1, written->size, file) == written->size;
    if (!file || fclose(file) != 0 || !ok) {
        fprintf(stderr, "spirv_case: %s: cannot be written\n", path);
        exit(1);
    }
}

typedef struct job {
    bytes spirv, inputs, outputs, weights;
    size_t rows;
    unsigned slots;
} job;

static hnbrdf_result dispatch(const gpu_device *device, const job *j, gpu_buffer *buffers,
                              gpu_program *program, VkPipeline *pipeline, hnbrdf_error *error)
{
    const gpu_buffer *const all[] = {&buffers[0], &buffers[1], &buffers[2]};
    const uint32_t push = (uint32_t)j->rows;
    hnbrdf_result result = gpu_buffer_open(device, j->inputs.size, &buffers[0], error);
    if (!result)
        result = gpu_buffer_open(device, j->outputs.size, &buffers[1], error);
    if (!result && j->weights.size > 0)
        result = gpu_uniform_open(device, j->weights.data, j->weights.size, &buffers[2], error);
    if (!result)
        result = gpu_upload(device, &buffers[0], j->inputs.data, j->inputs.size, error);
    if (!result)
        result = gpu_program_open(device, j->spirv.data, j->spirv.size, all,
                                  j->weights.size > 0 ? 3 : 2, sizeof push, program, error);
    program->slots = j->slots;
    if (!result)
        result = gpu_pipeline_open(device, program, 0, pipeline, error);
    if (!result)
        result = gpu_dispatch(device, program, *pipeline, &push, j->rows, 1, NULL, error);
    if (!result)
        result = gpu_download(device, &buffers[1], j->outputs.data, j->outputs.size, error);
    return result;
}

static hnbrdf_result run(const gpu_device *device, const job *j, hnbrdf_error *error)
{
    gpu_buffer buffers[3] = {{0}};
    gpu_program program = {0};
    VkPipeline pipeline = VK_NULL_HANDLE;
    const hnbrdf_result result = dispatch(device, j, buffers, &program, &pipeline, error);
    vkDestroyPipeline(device->handle, pipeline, NULL);
    gpu_program_close(device, &program);
    for (int k = 0; k < 3; k++)
        gpu_buffer_close(device, &buffers[k]);
    return result;
}

int main(int argc, char **argv)
{
    gpu_instance instance;
    gpu_device device;
    hnbrdf_error error;
    /* Kept loaded, or LeakSanitizer cannot tell what the driver still holds from a leak. */
    dlopen("libvulkan_lvp.so", RTLD_NOW | RTLD_NODELETE);
    if (argc != 6 && argc != 7)
        return 2;
    const unsigned vectors = (unsigned)atoi(argv[3]);
    job j = {.spirv = read_file(argv[1]),
             .inputs = read_file(argv[2]),
             .slots = (unsigned)atoi(argv[4])};
    if (argc == 7)
        j.weights = read_file(argv[6]);
    if (vectors == 0 || j.slots == 0)
        return 2;
    j.rows = j.inputs.size / (16 * vectors);
    j.outputs.size = j.rows * j.slots * 16;
    j.outputs.data = calloc(1, j.outputs.size);
    if (gpu_open(GPU_NOT_VALIDATED, &instance, &error) || instance.count == 0) {
        puts("skipped: no Vulkan device");
        return 77;
    }
    hnbrdf_result result = gpu_device_open(&instance, 0, &device, &error);
    if (!result) {
        result = run(&device, &j, &error);
        printf("%s\n", device.properties.deviceName);
        gpu_device_close(&device);
    }
    gpu_close(&instance);
    if (!result)
        write_file(argv[5], &j.outputs);
    else
        fprintf(stderr, "spirv_case: %s\n", error.text);
    free(j.spirv.data);
    free(j.inputs.data);
    free(j.outputs.data);
    free(j.weights.data);
    return result != HNBRDF_OK;
}
