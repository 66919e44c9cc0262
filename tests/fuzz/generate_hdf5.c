/* generate_hdf5.c: files of weights as Keras writes them, made by libhdf5: layers by many names, in
 * the root or in a group, as data sets of several types and layouts. */
#include "generate.h"

#include "fuzz.h"

#include <hdf5.h>

enum { ROOM = 64 * 64 };

static float numbers[ROOM];

/* Types that are read, and in the odd place one that is not. */
static hid_t choose_type(fuzz_choices *c)
{
    const hid_t usual = FUZZ_PICK(c, hid_t, H5T_IEEE_F32LE, H5T_IEEE_F32BE, H5T_IEEE_F64LE);
    const hid_t odd = FUZZ_PICK(c, hid_t, H5T_STD_I32LE, H5T_STD_U8LE, H5T_NATIVE_LDOUBLE);
    return fuzz_odd(c) ? odd : usual;
}

static void set_layout(fuzz_choices *c, hid_t plist, int axes, const hsize_t *shape)
{
    if (fuzz_odd(c))
        H5Pset_chunk(plist, axes, shape);
    else if (fuzz_odd(c))
        H5Pset_external(plist, "/nowhere/elsewhere.raw", 0, H5F_UNLIMITED);
    else if (fuzz_below(c, 3) == 0)
        H5Pset_layout(plist, H5D_COMPACT);
}

static void put_set(fuzz_choices *c, hid_t group, const char *name, int axes, hsize_t rows,
                    hsize_t columns)
{
    hsize_t shape[3] = {rows, columns, 1};
    if (axes == 1)
        shape[0] = columns;
    if (fuzz_odd(c))
        shape[fuzz_below(c, 2)] = FUZZ_PICK(c, hsize_t, 0, 1, 2, 7, 2000);
    if (fuzz_odd(c))
        axes = FUZZ_PICK(c, int, 0, 1, 2, 3);
    for (int i = 0; i < ROOM; i++)
        numbers[i] = (float)fuzz_real_between(c, -0.5, 0.5);
    if (fuzz_odd(c))
        numbers[fuzz_below(c, 6)] = FUZZ_PICK(c, float, NAN, INFINITY, -INFINITY, 3e38f);
    hid_t plist = H5Pcreate(H5P_DATASET_CREATE);
    hid_t space = axes ? H5Screate_simple(axes, shape, NULL) : H5Screate(H5S_SCALAR);
    set_layout(c, plist, axes, shape);
    hid_t set = H5Dcreate2(group, name, choose_type(c), space, H5P_DEFAULT, plist, H5P_DEFAULT);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (set >= 0 && count <= ROOM && !fuzz_odd(c))
        H5Dwrite(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers);
    if (set >= 0)
        H5Dclose(set);
    H5Sclose(space);
    H5Pclose(plist);
}

/* A group with a group of the same name in it, and in that the two data sets. */
static void put_layer(fuzz_choices *c, hid_t where, const char *name, hsize_t inputs, hsize_t units)
{
    static const char *const parts[2] = {"kernel:0", "bias:0"};
    hid_t outer = H5Gcreate2(where, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    hid_t group = outer < 0 ? outer
                            : H5Gcreate2(outer, fuzz_odd(c) ? "other" : name, H5P_DEFAULT,
                                         H5P_DEFAULT, H5P_DEFAULT);
    for (int k = 0; group >= 0 && k < 2; k++)
        if (fuzz_odd(c))
            H5Lcreate_soft("/nowhere", group, parts[k], H5P_DEFAULT, H5P_DEFAULT);
        else if (fuzz_odd(c))
            H5Lcreate_external("other.h5", "/x", group, parts[k], H5P_DEFAULT, H5P_DEFAULT);
        else if (fuzz_odd(c))
            H5Gclose(H5Gcreate2(group, parts[k], H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
        else if (!fuzz_odd(c))
            put_set(c, group, parts[k], k ? 1 : 2, inputs, units);
    if (group >= 0)
        H5Gclose(group);
    if (outer >= 0)
        H5Gclose(outer);
}

static void put_layers(fuzz_choices *c, hid_t where)
{
    static const char *const names[4][4] = {{"dense", "dense_1", "dense_2", "dense_3"},
                                            {"dense_1", "dense_2", "dense_3", "dense_4"},
                                            {"dense_9", "dense_10", "dense_11", "dense_12"},
                                            {"dense_12", "dense_13", "dense_100", "dense_101"}};
    const unsigned set = fuzz_below(c, 4);
    const int layers = fuzz_odd(c) ? FUZZ_PICK(c, int, 0, 2, 4) : 3;
    hsize_t inputs = 6;
    H5Gclose(H5Gcreate2(where, fuzz_below(c, 2) ? "lambda_1" : "dense_x", H5P_DEFAULT, H5P_DEFAULT,
                        H5P_DEFAULT));
    for (int k = 0; k < layers; k++) {
        const hsize_t units = k == 2 ? 3 : 1 + fuzz_below(c, 21);
        const char *name = fuzz_odd(c) ? "dense_1234567890" : names[set][k];
        if (fuzz_odd(c))
            H5Lcreate_soft("/lambda_1", where, name, H5P_DEFAULT, H5P_DEFAULT);
        else
            put_layer(c, where, name, inputs, units);
        inputs = units;
    }
}

static void generate(fuzz_choices *c, fuzz_bytes *out)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    FUZZ_CHECK(H5Pset_fapl_core(access, 4096, 0) >= 0);
    if (fuzz_below(c, 4) == 0) /* another version of the format */
        H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    hid_t file = H5Fcreate("generated.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access), where = file;
    FUZZ_CHECK(file >= 0);
    if (fuzz_odd(c))
        H5Lcreate_soft("/", file, "model_weights", H5P_DEFAULT, H5P_DEFAULT);
    else if (fuzz_odd(c))
        put_set(c, file, "model_weights", 1, 3, 3);
    else if (fuzz_below(c, 2))
        where = H5Gcreate2(file, "model_weights", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    put_layers(c, where);
    if (where != file)
        H5Gclose(where);
    H5Fflush(file, H5F_SCOPE_GLOBAL);
    const ssize_t size = H5Fget_file_image(file, NULL, 0);
    FUZZ_CHECK(size > 0);
    void *image = malloc((size_t)size);
    FUZZ_CHECK(image && H5Fget_file_image(file, image, (size_t)size) == size);
    fuzz_put(out, image, (size_t)size);
    free(image);
    H5Fclose(file);
    H5Pclose(access);
    if (fuzz_odd(c))
        out->size = fuzz_below(c, (unsigned)out->size);
}

FUZZ_GENERATOR(generate)
