/* image_driver.h: lets libhdf5 read a file that lies in memory. */
#ifndef HNBRDF_HDF5_IMAGE_DRIVER_H
#define HNBRDF_HDF5_IMAGE_DRIVER_H

#include <hdf5.h>

#include <stddef.h>

/* Opens the bytes for reading; they stay the caller's and must outlive the file. Negative where
 * that fails. *driver is to be given to H5FDunregister() once the file is closed, if it is not
 * negative. */
hid_t hnbrdf_hdf5_open_image(const void *bytes, size_t size, hid_t *driver);

#endif
