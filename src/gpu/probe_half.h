/* probe_half.h: how one device rounds in half precision. */
#ifndef HNBRDF_GPU_PROBE_HALF_H
#define HNBRDF_GPU_PROBE_HALF_H

#include "gpu/probe.h"

/* Fills has_half, exact_half and keeps_half_denormals. */
hnbrdf_result gpu_probe_half(const gpu_device *device, check_arithmetic *arithmetic,
                             hnbrdf_error *error);

#endif
