/* bake_device.h: run times of a Vulkan device for `hnbrdf bake --device`. */
#ifndef HNBRDF_CLI_BAKE_DEVICE_H
#define HNBRDF_CLI_BAKE_DEVICE_H

#include "hnbrdf/bake.h"

typedef struct bake_device bake_device;

/* Opens device `number` and lets the bake be timed on it; prints a message on failure. Close when
 * the report is no longer needed. */
int bake_device_open(long number, hnbrdf_bake_options *options, bake_device **device);
void bake_device_close(bake_device *device);

#endif
