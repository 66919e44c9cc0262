/* fuzz_hdf5.c: the bytes are a Keras HDF5 file of a Neural-BRDF network, read through libhdf5 (in
 * builds that have it), and without it. */
#include "fuzz_measured.h"

#include "hnbrdf/hdf5.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const hnbrdf_measured_options with = {.read_hdf5 = hnbrdf_hdf5_read}, without = {0};
    fuzz_measured(data, size, "network.h5", &with);
    fuzz_measured(data, size, "network.h5", &without);
    return 0;
}
