/* fuzz_brdf.c: the bytes are a published BRDF-Explorer shader; after a NUL byte may follow a
 * second one of the same data set. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[2] = {"one", "two"};
    const uint8_t *end = size ? memchr(data, 0, size) : NULL;
    const size_t first = end ? (size_t)(end - data) : size, second = end ? size - first - 1 : 0;
    const size_t sizes[2] = {first, second};
    char *copies[2] = {fuzz_copy(data, first), fuzz_copy(end ? end + 1 : data, second)};
    const char *texts[2] = {copies[0], copies[1]};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    const hnbrdf_result result =
        hnbrdf_model_import_brdf(texts, sizes, names, end ? 2 : 1, NULL, &model, &error);
    FUZZ_CHECK((result == HNBRDF_OK) == (model != NULL));
    if (result)
        fuzz_check_refusal(result, &error);
    for (int m = 0; model && m < hnbrdf_model_material_count(model); m++)
        for (int k = 0; k < FUZZ_PAIRS; k++) {
            float wi[3], wo[3], f[3];
            fuzz_pair(k, wi, wo);
            hnbrdf_eval(model, hnbrdf_model_material(model, m), wi, wo, f);
            fuzz_check_value(f);
        }
    hnbrdf_model_free(model);
    free(copies[0]);
    free(copies[1]);
    return 0;
}
