/* probe.h: how one device rounds: every operation of a shader compared with C. */
#ifndef HNBRDF_GPU_PROBE_H
#define HNBRDF_GPU_PROBE_H

#include "check/rules.h"
#include "gpu/device.h"

hnbrdf_result gpu_probe(const gpu_device *device, check_arithmetic *arithmetic,
                        hnbrdf_error *error);

#endif
