/* hdf5.h: lets hnbrdf_measured_open() read HDF5 files, through libhdf5 (libhnbrdf_hdf5):
 *
 *     hnbrdf_measured_options options = {.read_hdf5 = hnbrdf_hdf5_read};
 *
 * The part is there where libhdf5 was found (HNBRDF_WITH_HDF5). Files open one at a time, unless
 * libhdf5 was built for threads (that of Debian is). */
#ifndef HNBRDF_HDF5_H
#define HNBRDF_HDF5_H

#include "hnbrdf/measured.h"

#ifdef __cplusplus
extern "C" {
#endif

/* For hnbrdf_measured_options.read_hdf5; not to be called. libhdf5 prints nothing, and as this part
 * may be unloaded before the program ends it is told not to clean up then (H5dont_atexit), if the
 * program has not used it before. */
HNBRDF_API hnbrdf_result hnbrdf_hdf5_read(const void *bytes, size_t size, const char *label,
                                          hnbrdf_hdf5_arrays *arrays, hnbrdf_error *error);

#ifdef __cplusplus
}
#endif

#endif
