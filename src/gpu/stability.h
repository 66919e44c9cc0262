/* stability.h: the exported shaders on Vulkan devices as backends of `hnbrdf stability`. */
#ifndef HNBRDF_GPU_STABILITY_H
#define HNBRDF_GPU_STABILITY_H

#include "check/stability.h"

enum { STABILITY_GPU_BACKENDS = 64 };

typedef struct stability_gpus stability_gpus;

/* Opens device `text`: a number, "all", or "none"; none is also what is found without a
 * device or glslangValidator, and then `note` says so. `styles`: 1 for all styles of weights, 0
 * for constants alone. backends receives *count of them, at most STABILITY_GPU_BACKENDS. *gpus is
 * to be closed also after a failure; HNBRDF_ERROR_ARGUMENT: `text` is none of the three. */
hnbrdf_result stability_gpus_open(const char *text, int styles, stability_gpus **gpus,
                                  stability_backend *backends, int *count, char note[128],
                                  hnbrdf_error *error);
/* NULL is allowed. */
void stability_gpus_close(stability_gpus *gpus);

#endif
