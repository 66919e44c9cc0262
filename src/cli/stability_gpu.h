/* stability_gpu.h: the exported shaders on Vulkan devices as backends of `hnbrdf stability`. */
#ifndef HNBRDF_CLI_STABILITY_GPU_H
#define HNBRDF_CLI_STABILITY_GPU_H

#include "check/stability.h"

enum { STABILITY_GPU_BACKENDS = 64 };

typedef struct stability_gpus stability_gpus;

/* Opens device `text`: a number, "all", or "none"; none is also what is found without Vulkan, a
 * device or glslangValidator, and then `note` says so. `styles`: 1 for all styles of weights, 0
 * for constants alone. backends receives *count of them, at most STABILITY_GPU_BACKENDS. CLI_OK,
 * or an exit code after a message. */
int stability_gpus_open(const char *text, int styles, stability_gpus **gpus,
                        stability_backend *backends, int *count, char note[128]);
/* NULL is allowed. */
void stability_gpus_close(stability_gpus *gpus);

#endif
