/* fuzz_nbrdf.c: six NumPy files of a Neural-BRDF network, one after the other, each after two bytes
 * that say how long it is; a file that is not there is empty. */
#include "fuzz_measured.h"

#include "measured/nbrdf.h"

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

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    nbrdf_arrays *arrays = calloc(1, sizeof *arrays);
    hnbrdf_result result = HNBRDF_OK;
    hnbrdf_error error = {""};
    measured_body body = {0};
    FUZZ_CHECK(arrays != NULL);
    for (int k = 0; k < NBRDF_ARRAYS && !result; k++) {
        size_t length = size >= 2 ? (size_t)(data[0] | data[1] << 8) : 0;
        data += size >= 2 ? 2 : size;
        size -= size >= 2 ? 2 : size;
        length = length < size ? length : size;
        unsigned char *part = fuzz_copy(data, length);
        result = hnbrdf_npy_parse(part, length, "a.npy", &arrays->array[k], &error);
        FUZZ_CHECK((result == HNBRDF_OK) == (arrays->array[k].values != NULL));
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
    return 0;
}
