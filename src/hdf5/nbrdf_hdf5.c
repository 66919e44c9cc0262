/* nbrdf_hdf5.c: a network of Neural-BRDF from the HDF5 file of weights that Keras wrote, through
 * libhdf5: dense_K/dense_K/kernel:0 and bias:0, three layers in the order of K. This room
 * alone knows libhdf5; it is a part of its own, hnbrdf_hdf5. */
#include "hnbrdf/hdf5.h"
#include "hdf5/image_driver.h"
#include "measured/nbrdf.h"
#include "base/error.h"

#include <hdf5.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LINKS = 256, NAME_SIZE = 32, PATH_SIZE = 96 };

typedef struct reader {
    hid_t file;
    size_t file_size;
    const char *label;
    hnbrdf_error *error;
} reader;

/* ---- Layers ---------------------------------------------------------------------------------- */

/* The number of a layer's name: "dense" 0, "dense_12" 12; -1 for any other. */
static long layer_number(const char *name)
{
    if (strcmp(name, "dense") == 0)
        return 0;
    size_t digits = strncmp(name, "dense_", 6) == 0 ? strspn(name + 6, "0123456789") : 0;
    if (digits < 1 || digits > 8 || name[6 + digits])
        return -1;
    return strtol(name + 6, NULL, 10);
}

/* 1 if `path` is there and no link into another place or another file. */
static int is_hard_link(hid_t where, const char *path)
{
    H5L_info_t info;
    return H5Lexists(where, path, H5P_DEFAULT) > 0 &&
           H5Lget_info(where, path, &info, H5P_DEFAULT) >= 0 && info.type == H5L_TYPE_HARD;
}

/* The layers of the group by their number; returns how many there are, at most NBRDF_LAYERS + 1. */
static int find_layers(hid_t group, char names[NBRDF_LAYERS + 1][NAME_SIZE])
{
    H5G_info_t info;
    int count = 0;
    if (H5Gget_info(group, &info) < 0)
        return 0;
    hsize_t links = info.nlinks < MOST_LINKS ? info.nlinks : MOST_LINKS;
    for (hsize_t i = 0; i < links && count <= NBRDF_LAYERS; i++) {
        char name[NAME_SIZE];
        ssize_t length = H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name,
                                            sizeof name, H5P_DEFAULT);
        if (length < 0 || length >= NAME_SIZE || layer_number(name) < 0 ||
            !is_hard_link(group, name))
            continue;
        int at = count++;
        for (; at > 0 && layer_number(names[at - 1]) > layer_number(name); at--)
            memcpy(names[at], names[at - 1], NAME_SIZE);
        memcpy(names[at], name, NAME_SIZE);
    }
    return count;
}

/* ---- Arrays ---------------------------------------------------------------------------------- */

static hnbrdf_result refuse(const reader *r, const char *path, const char *what)
{
    return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT, "%s: %s %s", r->label, path, what);
}

/* Its shape, if it has one that a kernel or a bias can have. */
static hnbrdf_result read_shape(const reader *r, hid_t set, nbrdf_array *array)
{
    hid_t space = H5Dget_space(set);
    hsize_t shape[2] = {1, 1};
    int axes = space >= 0 ? H5Sget_simple_extent_ndims(space) : -1;
    int good = axes >= 1 && axes <= 2 && H5Sget_simple_extent_dims(space, shape, NULL) == axes;
    if (space >= 0)
        H5Sclose(space);
    if (!good)
        return refuse(r, array->what, "has no shape of 1 or 2 axes");
    for (int k = 0; k < 2; k++)
        if (shape[k] < 1 || shape[k] > NBRDF_MAX_UNITS)
            return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                               "%s: %s has size %llu along axis %d, expected 1 to %d", r->label,
                               array->what, (unsigned long long)shape[k], k, NBRDF_MAX_UNITS);
    array->axes = axes;
    array->shape[0] = (size_t)shape[0];
    array->shape[1] = (size_t)shape[1];
    return HNBRDF_OK;
}

/* Are its numbers floats that lie in this file as they are: no filter that would have to be loaded,
 * no other file. */
static hnbrdf_result check_storage(const reader *r, hid_t set, const nbrdf_array *array)
{
    hid_t type = H5Dget_type(set), plist = H5Dget_create_plist(set);
    size_t bytes = type >= 0 ? H5Tget_size(type) : 0;
    int is_float = type >= 0 && H5Tget_class(type) == H5T_FLOAT && (bytes == 4 || bytes == 8);
    H5D_layout_t layout = plist >= 0 ? H5Pget_layout(plist) : H5D_LAYOUT_ERROR;
    int plain = (layout == H5D_CONTIGUOUS || layout == H5D_COMPACT) &&
                H5Pget_external_count(plist) == 0 && H5Pget_nfilters(plist) == 0;
    hsize_t stored = H5Dget_storage_size(set);
    size_t expected = array->shape[0] * array->shape[1] * bytes;
    if (type >= 0)
        H5Tclose(type);
    if (plist >= 0)
        H5Pclose(plist);
    if (!is_float)
        return refuse(r, array->what, "has no floats of 4 or 8 bytes");
    if (!plain)
        return refuse(r, array->what,
                      "is in pieces, filtered or in another file, expected numbers in one piece");
    if (stored != expected || expected > r->file_size)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                           "%s: %s has %llu bytes in a file of %zu, expected %zu", r->label,
                           array->what, (unsigned long long)stored, r->file_size, expected);
    return HNBRDF_OK;
}

static hnbrdf_result read_set(const reader *r, hid_t set, nbrdf_array *array)
{
    hnbrdf_result result = read_shape(r, set, array);
    if (!result)
        result = check_storage(r, set, array);
    if (result)
        return result;
    array->values = malloc(array->shape[0] * array->shape[1] * sizeof *array->values);
    if (!array->values)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "%s: out of memory", r->label);
    if (H5Dread(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, array->values) < 0)
        return refuse(r, array->what, "cannot be read: damaged or truncated");
    return HNBRDF_OK;
}

/* The data set LAYER/LAYER/word. */
static hnbrdf_result read_array(const reader *r, hid_t group, const char *layer, const char *word,
                                nbrdf_array *array)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", layer, layer);
    int there = is_hard_link(group, path);
    snprintf(array->what, sizeof array->what, "%s/%s/%s", layer, layer, word);
    hid_t set = there && is_hard_link(group, array->what)
                    ? H5Dopen2(group, array->what, H5P_DEFAULT)
                    : H5I_INVALID_HID;
    if (set < 0)
        return refuse(r, array->what, "is missing, expected a data set");
    hnbrdf_result result = read_set(r, set, array);
    H5Dclose(set);
    return result;
}

static hnbrdf_result read_layers(const reader *r, hid_t group, nbrdf_arrays *arrays)
{
    char names[NBRDF_LAYERS + 1][NAME_SIZE];
    int count = find_layers(group, names);
    if (count != NBRDF_LAYERS)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_FORMAT,
                           "%s: %s%d groups dense_1, dense_2 ..., expected the %d layers of an "
                           "NBRDF network",
                           r->label, count > NBRDF_LAYERS ? "more than " : "",
                           count > NBRDF_LAYERS ? NBRDF_LAYERS : count, NBRDF_LAYERS);
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; !result && k < NBRDF_ARRAYS; k++)
        result =
            read_array(r, group, names[k / 2], k % 2 ? "bias:0" : "kernel:0", &arrays->array[k]);
    return result;
}

/* ---- The file -------------------------------------------------------------------------------- */

static hnbrdf_result read_opened(const reader *r, nbrdf_arrays *arrays)
{
    /* A file of weights has the layers at its root, a file of a whole model in a group. */
    const char *where = is_hard_link(r->file, "model_weights") ? "model_weights" : "/";
    hid_t group = H5Gopen2(r->file, where, H5P_DEFAULT);
    hnbrdf_result result = group >= 0 ? read_layers(r, group, arrays)
                                      : refuse(r, where, "is no group: damaged or truncated");
    if (group >= 0)
        H5Gclose(group);
    H5Fclose(r->file);
    return result;
}

static hnbrdf_result read_file(const void *bytes, size_t size, const char *label,
                               nbrdf_arrays *arrays, hnbrdf_error *error)
{
    hid_t driver = H5I_INVALID_HID;
    reader r = {hnbrdf_hdf5_open_image(bytes, size, &driver), size, label, error};
    hnbrdf_result result = HNBRDF_OK;
    if (r.file < 0)
        result = hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                             "%s: HDF5 file of %zu bytes cannot be opened: damaged or truncated",
                             label, size);
    else
        result = read_opened(&r, arrays);
    if (driver >= 0)
        H5FDunregister(driver);
    return result;
}

hnbrdf_result hnbrdf_hdf5_read(const void *bytes, size_t size, const char *label,
                               hnbrdf_hdf5_arrays *arrays, hnbrdf_error *error)
{
    unsigned major = 0, minor = 0, release = 0;
    H5E_auto2_t handler = NULL;
    void *handler_data = NULL;
    for (int k = 0; k < NBRDF_ARRAYS; k++)
        snprintf(arrays->label[k], sizeof arrays->label[k], "%s", label);
    /* No cleaning up at exit: this library may be unloaded before, and after some damaged files
     * libhdf5 would print then that it cannot. Without effect if the program has used libhdf5
     * already. */
    H5dont_atexit();
    /* libhdf5 ends the program when it is not the one that this was built with. */
    if (H5get_libversion(&major, &minor, &release) < 0 || major != H5_VERS_MAJOR ||
        minor != H5_VERS_MINOR || release != H5_VERS_RELEASE)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "%s: libhdf5 %u.%u.%u is here, expected %d.%d.%d as when this was built",
                           label, major, minor, release, H5_VERS_MAJOR, H5_VERS_MINOR,
                           H5_VERS_RELEASE);
    /* Its own messages would go to stderr. */
    int silenced = H5Eget_auto2(H5E_DEFAULT, &handler, &handler_data) >= 0 &&
                   H5Eset_auto2(H5E_DEFAULT, NULL, NULL) >= 0;
    hnbrdf_result result = read_file(bytes, size, label, arrays, error);
    if (silenced)
        H5Eset_auto2(H5E_DEFAULT, handler, handler_data);
    return result;
}
