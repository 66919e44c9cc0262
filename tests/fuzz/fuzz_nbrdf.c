/* fuzz_nbrdf.c: six NumPy files of a Neural-BRDF network, one after the other, each after two bytes
 * that say how long it is; a file that is not there is empty. They are read from memory and, one
 * time in four since that is slow, as files by the name of one of them. */
#include "fuzz_measured.h"

#include "measured/nbrdf.h"

#include <unistd.h>

static void fuzz_body(const measured_body *body)
{
    for (int k = 0; k < FUZZ_PAIRS; k++) {
        float wi[3], wo[3];
        double i[3], o[3], f[3];
        fuzz_pair(k, wi, wo);
        for (int c = 0; c < 3; c++) {
            i[c] = (double)wi[c];
            o[c] = (double)wo[c];
        }
        if (!(wi[2] > 0.0f && wo[2] > 0.0f))
            continue;
        FUZZ_CHECK(body->eval(body->data, i, o, f) == 1);
        for (int c = 0; c < 3; c++)
            FUZZ_CHECK(!(f[c] < 0.0)); /* NaN is allowed here: the caller makes it 0 */
    }
}

/* A folder of this process, removed at its end with what is in it. */
static char folder[] = "/tmp/hnbrdf_fuzz_XXXXXX";

static void name_part(char path[64], int k)
{
    snprintf(path, 64, "%s/a%s", folder, hnbrdf_nbrdf_part_endings[k]);
}

static void remove_folder(void)
{
    for (int k = 0; k < NBRDF_ARRAYS; k++) {
        char path[64];
        name_part(path, k);
        remove(path);
    }
    rmdir(folder);
}

static void write_part(int k, const void *bytes, size_t size)
{
    static int made;
    char path[64];
    if (!made) {
        FUZZ_CHECK(mkdtemp(folder) != NULL && atexit(remove_folder) == 0);
        made = 1;
    }
    name_part(path, k);
    remove(path);
    FILE *file = size ? fopen(path, "wb") : NULL;
    FUZZ_CHECK((file != NULL) == (size > 0));
    if (file)
        FUZZ_CHECK(fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

/* By the first file or, where its first byte is odd, the last; and one alone, which is refused. */
static void open_files(const uint8_t *first, size_t size)
{
    const hnbrdf_measured_options options = {.max_bytes = 1 << 16};
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    char path[64];
    name_part(path, size && first[size - 1] & 1 ? NBRDF_ARRAYS - 1 : 0);
    const hnbrdf_result result = hnbrdf_measured_open(path, &options, &measured, &error);
    FUZZ_CHECK((result == HNBRDF_OK) == (measured != NULL));
    if (result)
        fuzz_check_refusal(result, &error);
    hnbrdf_measured_close(measured);
    fuzz_measured(first, size, size & 1 ? "a_fc1.npy" : "a.npy", &options);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    nbrdf_arrays *arrays = calloc(1, sizeof *arrays);
    hnbrdf_result result = HNBRDF_OK;
    hnbrdf_error error = {""};
    measured_body body = {0};
    FUZZ_CHECK(arrays != NULL);
    const int as_files = size % 4 == 0;
    const uint8_t *const first = data + (size >= 2 ? 2 : size);
    size_t first_size = 0;
    for (int k = 0; k < NBRDF_ARRAYS; k++) {
        size_t length = size >= 2 ? (size_t)(data[0] | data[1] << 8) : 0;
        data += size >= 2 ? 2 : size;
        size -= size >= 2 ? 2 : size;
        length = length < size ? length : size;
        unsigned char *part = fuzz_copy(data, length);
        first_size = k == 0 ? length : first_size;
        if (as_files)
            write_part(k, part, length);
        if (!result) {
            result = hnbrdf_npy_parse(part, length, "a.npy", &arrays->array[k], &error);
            FUZZ_CHECK((result == HNBRDF_OK) == (arrays->array[k].values != NULL));
        }
        snprintf(arrays->label[k], sizeof arrays->label[k], "a.npy");
        free(part);
        data += length;
        size -= length;
    }
    if (!result)
        result = hnbrdf_nbrdf_open_arrays(arrays, "files", &body, &error);
    if (result)
        fuzz_check_refusal(result, &error);
    else
        fuzz_body(&body);
    if (!result)
        body.release(body.data);
    for (int k = 0; k < NBRDF_ARRAYS; k++)
        free(arrays->array[k].values);
    free(arrays);
    if (as_files)
        open_files(first, first_size);
    return 0;
}
