/* fuzz_measured.h: what the targets for measured files share: open, ask, close. */
#ifndef HNBRDF_TESTS_FUZZ_MEASURED_H
#define HNBRDF_TESTS_FUZZ_MEASURED_H

#include "fuzz.h"

#include "hnbrdf/measured.h"

/* The bytes at `data` opened under the name `path`; what opens gives values within the promised
 * range. */
static inline void fuzz_measured(const uint8_t *data, size_t size, const char *path,
                                 const hnbrdf_measured_options *options)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    const hnbrdf_result result =
        hnbrdf_measured_open_memory(data, size, path, options, &measured, &error);
    FUZZ_CHECK((result == HNBRDF_OK) == (measured != NULL));
    if (result) {
        fuzz_check_refusal(result, &error);
        return;
    }
    FUZZ_CHECK(strlen(hnbrdf_measured_summary(measured)) > 10);
    for (int k = 0; k < FUZZ_PAIRS; k++) {
        float wi[3], wo[3], f[3], nm[2] = {550.0f, -1e30f}, spectrum[2];
        fuzz_pair(k, wi, wo);
        const int valid = hnbrdf_measured_eval(measured, wi, wo, f);
        FUZZ_CHECK(valid == 0 || valid == 1);
        for (int c = 0; c < 3; c++) {
            FUZZ_CHECK(fabsf(f[c]) <= HNBRDF_MAX_VALUE);
            FUZZ_CHECK(f[c] >= 0.0f || options->rgl_signed);
            FUZZ_CHECK(valid || f[c] == 0.0f);
        }
        hnbrdf_measured_eval_spectrum(measured, wi, wo, 2, nm, spectrum);
        FUZZ_CHECK(isfinite(spectrum[0]) && isfinite(spectrum[1]));
    }
    hnbrdf_measured_close(measured);
}

#endif
